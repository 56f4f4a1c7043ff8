// From soft grains to rigid ones at dt = 0: the solver's own increments must find what a well-resolved run finds,
// however unlike the stiffnesses of normal, tangential and rolling springs are.
#include <cmath>

#include "rvelab/error.hpp"
#include "tests/extreme/matrix.hpp"
#include "tests/extreme/specimens.hpp"

namespace rvelab::test {

namespace {

Path path_of(const Case& asked, int dimension, double kappa) {
  Path path;
  path.direction = asked("shear") != 0 ? shear_direction(dimension) : biaxial_direction(dimension);
  path.strain = asked("strain_times_kappa") / kappa;
  return path;
}

void agrees_with_resolved_run(const Case& asked, Verdict& verdict) {
  const int d = int(asked("dimension"));
  const double kappa = asked("kappa");
  Specimen s = jammed_linear(d, 64, kappa, 0.5, asked("friction"), asked("aspect_ratio"));
  s.contacts.clear();
  Material& grain = s.materials[0];
  grain.tangential_stiffness = asked("kt_over_kn") * grain.normal_stiffness;
  s.contact.rolling = asked("rolling_stiffness") > 0;
  grain.rolling_stiffness = asked("rolling_stiffness");
  grain.rolling_friction = s.contact.rolling ? 0.1 : 0;
  s.damping.local_quasi_static = asked("local_damping");
  set_restitution(s, asked("restitution"));
  if (asked("adhesion") > 0) {
    // Grains of radius 1 keep their stiffness; the pull-off force is so much of p times the cross-section.
    s.contact.law = Law::linear_adhesive;
    grain.young_modulus = grain.normal_stiffness;
    grain.stiffness_ratio = asked("kt_over_kn");
    grain.adhesion_pressure = asked("adhesion") * pressure_at(d, kappa);
  }
  compare_with_resolved(s, path_of(asked, d, kappa), asked.tolerance, verdict);
}

void hertz_agrees_with_resolved_run(const Case& asked, Verdict& verdict) {
  const int d = int(asked("dimension"));
  const double young = asked("young_modulus"), nu = asked("poisson_ratio"), p = asked("pressure");
  const Specimen s = jammed_hertz(d, 64, young, nu, 0.5, p);
  const double kappa = std::pow(pressure_of_ratio(s, 1) / p, 2.0 / 3);
  compare_with_resolved(s, path_of(asked, d, kappa), asked.tolerance, verdict);
}

void does_not_see_density(const Case& asked, Verdict& verdict) {
  // At dt = 0 inertia is scaled from the contacts: the density must not appear in one bit.
  const int d = int(asked("dimension"));
  const Specimen usual_density = usual(d, asked("hertz") != 0);
  Specimen other = usual_density;
  for (Material& m : other.materials) m.density = asked("density");
  Tested a(usual_density, verdict), b(other, verdict);
  for (int k = 0; k < 20; ++k) {
    const Matrix3 increment = 5e-4 * biaxial_direction(d) + 1e-4 * shear_direction(d);
    verdict.law("bitwise the same stress", a.apply(increment, 0).stress == b.apply(increment, 0).stress);
  }
  a.check_laws();
}

void refuses_orphaned_history(const Case&, Verdict& verdict) {
  // Tangential forces without a spring to carry them: f_t^2/2kt is no energy, and the force could never change.
  Rve rve(usual(2, false));
  rve.apply(2e-4 * shear_direction(2), 0);
  Specimen s = rve.specimen();
  for (Material& m : s.materials) m.tangential_stiffness = 0;
  const std::string text = error_text<Error>([&] { Rve{s}; });
  verdict.law("a tangential force where kt = 0 is refused on opening", !text.empty());
  if (!text.empty()) verdict.refusal("opening", Refused{text, true});
  if (!text.empty()) verdict.law("the refusal names the contact (" + text + ")", text.find("grains ") != text.npos);
}

}  // namespace

std::vector<Experiment> stiffness_experiments() {
  return {{"stiffness/linear", agrees_with_resolved_run,
           "dimension 2, kappa 1e3, kt_over_kn 0.5, friction 0.5, rolling_stiffness 0, local_damping 0.3, "
           "restitution 1, adhesion 0, shear 0, strain_times_kappa 0.5, aspect_ratio 1"},
          {"stiffness/hertz", hertz_agrees_with_resolved_run,
           "dimension 3, young_modulus 1e9, pressure 1e5, poisson_ratio 0.2, shear 0, strain_times_kappa 0.5"},
          {"stiffness/density", does_not_see_density, "dimension 2, hertz 0, density 1"},
          {"stiffness/orphaned_history", refuses_orphaned_history, ""}};
}

}  // namespace rvelab::test
