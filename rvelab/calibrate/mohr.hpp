// Mohr circles and what soil mechanics reads off them: peak, friction angle, cohesion, bearing capacity factors.
//
// Pure functions of records; this module's calibrate.hpp runs the tests. Everything here is compression positive and in
// Pa, angles in degrees. s = (sigma_1 + sigma_3)/2, t = (sigma_1 - sigma_3)/2. What cannot be had from the records
// given (no record in a strain range, a minor stress in tension beyond s) is NaN.
#pragma once

#include <span>

#include "rvelab/records/record.hpp"

namespace rvelab::calibrate {

/// Largest and smallest principal stress, Pa, compression positive.
struct PrincipalStresses {
  double major = 0, minor = 0;
  double s() const { return 0.5 * (major + minor); }
  double t() const { return 0.5 * (major - minor); }
};

/// Of a Cauchy stress (Pa, tension positive), symmetrised; in 2D within the plane.
PrincipalStresses principal_stresses(const Matrix3& stress, int dimension);

/// asin(t/s), degrees: the circle alone, without cohesion.
double friction_angle_deg(const PrincipalStresses& stresses);

/// Of an increment of strain (tension positive), symmetrised; in 2D within the plane: sin psi = -eps_v/(2 eps_1 -
/// eps_v), compression positive, degrees (Vermeer and de Borst 1984).
double dilation_angle_deg(const Matrix3& strain, int dimension);

struct Peak {
  std::size_t record = 0;  ///< index into the records
  double strain = 0;
  PrincipalStresses stresses;
  double left = 1;  ///< deviator of the last record over that of this one
};

/// The record with the largest deviator sigma_1 - sigma_3, unsmoothed; the first of several. With a held lateral stress
/// that is the largest axial stress of a compression and the smallest of an extension. InputError without records.
Peak peak(std::span<const records::Record> records, int dimension);

/// True if the peak lies within the last twentieth of the strain of the records: still rising at the end, or on a
/// plateau, the test shows no peak. One that has lost a tenth of it since then does: it broke.
bool rising_at_end(std::span<const records::Record> records, const Peak& peak);

/// The moving mean of the principal stresses over `window` of strain (as many records as lie in it at their median
/// spacing), where its ratio major/minor is largest. NaN if there are fewer records than the window takes.
PrincipalStresses peak_of_moving_mean(std::span<const records::Record> records, int dimension, double window = 0.01);

/// Mean of the principal stresses over the records with from <= |strain| <= to. NaN if the records end before `to`.
PrincipalStresses large_strain_mean(std::span<const records::Record> records, int dimension, double from = 0.12,
                                    double to = 0.15);

/// Least squares of t in s over several tests, through the origin: sin phi = sum(s t)/sum(s s). Degrees.
double friction_angle_through_origin_deg(std::span<const PrincipalStresses> tests);

struct CohesionFit {
  double friction_angle_deg;
  double cohesion;                  ///< Pa; may come out negative
  double friction_angle_error_deg;  ///< standard errors, from what the points are off the line; NaN below three points
  double cohesion_error;            ///< Pa
};

/// Straight envelope: least squares of t = s sin phi + c cos phi. NaN for fewer than two different s.
CohesionFit fit_with_cohesion(std::span<const PrincipalStresses> tests);

/// Whether the strength of a soil has a part that does not grow with the stress, and by what that is known.
enum class Cohesive {
  no,
  by_law,  ///< its grains stick: their contacts pull
  by_line  ///< c of the straight envelope is above twice its standard error, and above 5 % of the mean s of the tests
};
inline constexpr double cohesive_errors = 2, cohesive_share = 0.05;

/// `grains_stick`: the contact law pulls. Fewer than three tests have no standard error: then by the law alone.
Cohesive cohesive(std::span<const PrincipalStresses> tests, bool grains_stick);

/// The angle that factors of a footing go with. Not cohesive: through the origin (a secant, the same for all tests).
/// Cohesive: the tangent, that of the straight envelope; a secant would count c as friction, and fall as the stress
/// rises. NaN as the fits.
double strength_angle_deg(std::span<const PrincipalStresses> tests, Cohesive cohesive);

/// N_c = (N_q - 1) cot phi (Prandtl 1920), the factor of the cohesion of a footing in general shear; pi + 2 at 0.
double bearing_capacity_Nc(double friction_angle_deg);

/// N_q = tan^2(45 + phi/2) exp(pi tan phi) (Prandtl 1920, Reissner 1924), general shear.
double bearing_capacity_Nq(double friction_angle_deg);

/// N_q with the angle atan(2/3 tan phi) of local shear (Terzaghi 1943).
double local_shear_Nq(double friction_angle_deg);

/// Angle of the active wedge under a footing against the horizontal, 45 + phi/2.
double wedge_angle_deg(double friction_angle_deg);

/// The largest tension of the minor principal stress, Pa; 0 where it never pulls. InputError without records.
double tensile_strength(std::span<const records::Record> records, int dimension);

/// c cot(phi), the tension on all sides at which a straight envelope ends, Pa; NaN without friction or cohesion.
double apex_tension(double friction_angle_deg, double cohesion);

/// The records of the last stage that has any.
std::span<const records::Record> last_stage(const records::TestResult& result);

/// Slopes of the normal stresses over the axial strain, and the moduli of an isotropic solid that has them, Pa. NaN
/// where there are no two records.
struct OedometerStiffness {
  double C11;   ///< d sigma_axial / d eps_axial, = K_3D + 4 G/3
  double C12;   ///< d sigma_lateral (mean) / d eps_axial, = K_3D - 2 G/3
  double G;     ///< (C11 - C12)/2
  double K_3D;  ///< C12 + 2 G/3 (Liang et al. 2023)
  double K_2D;  ///< (C11 + C12)/2 = K_3D + G/3
};

/// Least squares through the first record, over the records of one stage with |strain| <= up_to; `axis`: "x", "y", "z".
OedometerStiffness oedometer_stiffness(std::span<const records::Record> stage, const std::string& axis, int dimension,
                                       double up_to = 1e-5);

}  // namespace rvelab::calibrate
