// Contact parameters as a user states them: materials, law, slip convention, rolling, damping; and what a pair of
// grains makes of them. Which law does what stands in the law's own file; here are names, units, ranges and mixing.
//
// This room knows two grains at a time: no list, no cell, no step loop.
#pragma once

#include <string>
#include <vector>

#include "rvelab/contact/kinds.hpp"
#include "rvelab/contact/laws.hpp"

namespace rvelab {

/// One grain material. Of the laws' constants only those that the specimen's law uses are read; the others keep zero.
struct Material : LawConstants {
  std::string name = "grain";
  double density = 2650;         ///< kg/m^3, > 0
  double friction = 0;           ///< Coulomb coefficient mu = tan(phi_mu), 0 to 1e6 (1e6: no slip)
  double rolling_stiffness = 0;  ///< beta of k_r = kt ri rj beta, >= 0
  double rolling_friction = 0;   ///< eta of the cap min(eta_i ri, eta_j rj) fn, >= 0
};

/// What holds for every contact of a specimen.
struct ContactModel {
  Law law = Law::linear;
  Slip slip = Slip::consistent;
  bool rolling = false;        ///< rolling moment between grains (its parameters stand in the materials)
  bool unload_rescale = true;  ///< hertz_mindlin: f_t scales by sqrt(delta/delta_old) as delta falls
  HertzRadius hertz_radius = HertzRadius::equivalent;  ///< hertz_mindlin, ellipses (hertz_curvature.hpp)
};

/// Damping, apart from the law. All of it acts on fluctuation velocities v' and spins w'.
struct Damping {
  double local = 0;                 ///< Cundall's coefficient for dt > 0, 0 to < 1
  double local_quasi_static = 0.3;  ///< the same for dt = 0, > 0 to < 1
  LocalDampingForm local_form = LocalDampingForm::vector;
  Dashpot dashpot = Dashpot::none;
  double normal_coefficient = 0;  ///< coefficient: N s/m; viscoelastic: 1/(m s) (force eta sqrt(r* delta) m* v)
  double restitution = 1;         ///< restitution: coefficient of restitution of two grains, 0 < e <= 1; tsuji: that of
                                  ///< LAMMPS' fit, which is met at 1 only
  double tangential_ratio = 0;    ///< tangential over normal dashpot coefficient, >= 0
  bool no_tension = false;        ///< cuts the normal force at zero, so that a dashpot never attracts
  double global_viscous = 0;      ///< N s/m, force -c v' on each grain, dt > 0 only
};

/// A number of a material that a law reads, and where it stands.
struct LawParameter {
  Law law;
  Parameter parameter;
  double Material::*value;
};

/// "> 0", "0 to 10", "above 0 to below 1".
std::string in_words(const Interval& interval);

/// Those of all laws, in the order of the laws.
const std::vector<LawParameter>& law_parameters();

/// Parameters of one pair of grains, computed once when the pair is listed.
struct PairParameters {
  double kn = 0;            ///< constant of f_n: linear N/m, Hertz N/m^1.5 (contact/laws.hpp)
  double kt = 0;            ///< constant of k_t: N/m; hertz_mindlin N/m^1.5
  double law_constant = 0;  ///< one more, of laws that have one
  double friction = 0;      ///< the smaller of the two
  double kr = 0;            ///< constant of k_r = kt ri rj beta: N m; hertz_mindlin N m/m^0.5
  double moment_cap = 0;    ///< min(eta_i ri, eta_j rj), m
  double cn = 0;            ///< dashpot: c_n = cn delta^dashpot_power
};

/// Power of the overlap in the dashpot coefficient: 0 (coefficient, linear), 1/2 (viscoelastic), 1/4 (restitution and
/// tsuji with a Hertz law).
double dashpot_power(Law law, Dashpot dashpot);

/// Mixes two materials for grains of radii ri, rj (m) and masses mi, mj (kg). `section`: cross-section of the smaller
/// grain, m^2 (grain_section).
PairParameters mix(const ContactModel& model, const Damping& damping, const Material& a, double ri, double mi,
                   const Material& b, double rj, double mj, double section);

/// Checks every parameter that the model uses. Throws InputError naming key, value and range, one line each.
void check_parameters(const ContactModel& model, const Damping& damping, const std::vector<Material>& materials);

const char* name(Law);
const char* name(Slip);
const char* name(HertzRadius);
const char* name(Dashpot);
const char* name(LocalDampingForm);
Law law_from(const std::string&);  ///< throws InputError listing the names
std::string law_names();           ///< "linear, linear_given, ..."
Slip slip_from(const std::string&);
HertzRadius hertz_radius_from(const std::string&);
Dashpot dashpot_from(const std::string&);
LocalDampingForm local_damping_form_from(const std::string&);

}  // namespace rvelab
