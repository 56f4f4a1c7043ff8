#include "rvelab/calibrate/mohr.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "rvelab/error.hpp"

namespace rvelab::calibrate {

namespace {

using std::numbers::pi;
constexpr double degree = pi / 180;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double strain_slack = 1e-9;  // recorded strains are round numbers up to round-off
constexpr double range_slack = 1e-3;   // a range of strains counts as covered up to the spacing of records

double median_spacing(std::span<const records::Record> records) {
  std::vector<double> spacings;
  for (std::size_t k = 1; k < records.size(); ++k) {
    spacings.push_back(std::abs(records[k].strain - records[k - 1].strain));
  }
  const auto middle = spacings.begin() + long(spacings.size() / 2);
  std::nth_element(spacings.begin(), middle, spacings.end());
  return *middle;
}

}  // namespace

PrincipalStresses principal_stresses(const Matrix3& stress, int dimension) {
  const Eigen::MatrixXd compression = -0.5 * (stress + stress.transpose()).topLeftCorner(dimension, dimension);
  const Eigen::VectorXd values =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(compression, Eigen::EigenvaluesOnly).eigenvalues();
  return {values[dimension - 1], values[0]};
}

double friction_angle_deg(const PrincipalStresses& stresses) { return std::asin(stresses.t() / stresses.s()) / degree; }

double dilation_angle_deg(const Matrix3& strain, int dimension) {
  const double dilation = strain.topLeftCorner(dimension, dimension).trace();
  return std::asin(dilation / (2 * principal_stresses(strain, dimension).major + dilation)) / degree;
}

Peak peak(std::span<const records::Record> records, int dimension) {
  if (records.empty()) throw InputError("peak: 0 records; allowed: at least 1; give a test that records");
  Peak highest;
  for (std::size_t k = 0; k < records.size(); ++k) {
    const PrincipalStresses stresses = principal_stresses(records[k].stress, dimension);
    if (k == 0 || stresses.t() > highest.stresses.t()) highest = {k, records[k].strain, stresses};
    if (highest.stresses.t() > 0) highest.left = stresses.t() / highest.stresses.t();
  }
  return highest;
}

bool rising_at_end(std::span<const records::Record> records, const Peak& peak) {
  constexpr double end = 0.95, held = 0.9;
  return peak.record > 0 && peak.left > held && std::abs(peak.strain) > end * std::abs(records.back().strain);
}

PrincipalStresses peak_of_moving_mean(std::span<const records::Record> records, int dimension, double window) {
  PrincipalStresses highest{nan, nan};
  const double spacing = records.size() < 2 ? 0 : median_spacing(records);
  if (spacing <= 0) return highest;
  const auto width = std::size_t(std::max(1L, std::lround(window / spacing)));
  std::vector<PrincipalStresses> stresses;
  for (const auto& record : records) stresses.push_back(principal_stresses(record.stress, dimension));
  for (std::size_t begin = 0; begin + width <= stresses.size(); ++begin) {
    PrincipalStresses mean;
    for (std::size_t k = begin; k < begin + width; ++k) {
      mean.major += stresses[k].major / double(width);
      mean.minor += stresses[k].minor / double(width);
    }
    // t/s grows with major/minor and needs no division by a minor stress that may vanish.
    if (begin == 0 || mean.t() * highest.s() > highest.t() * mean.s()) highest = mean;
  }
  return highest;
}

PrincipalStresses large_strain_mean(std::span<const records::Record> records, int dimension, double from, double to) {
  PrincipalStresses sum;
  double count = 0, reached = 0;
  for (const auto& record : records) {
    const double strain = std::abs(record.strain);
    reached = std::max(reached, strain);
    if (strain < from - strain_slack || strain > to + strain_slack) continue;
    const PrincipalStresses stresses = principal_stresses(record.stress, dimension);
    sum.major += stresses.major;
    sum.minor += stresses.minor;
    ++count;
  }
  if (count == 0 || reached < to - range_slack) return {nan, nan};
  return {sum.major / count, sum.minor / count};
}

double friction_angle_through_origin_deg(std::span<const PrincipalStresses> tests) {
  double st = 0, ss = 0;
  for (const auto& test : tests) {
    st += test.s() * test.t();
    ss += test.s() * test.s();
  }
  return std::asin(st / ss) / degree;
}

CohesionFit fit_with_cohesion(std::span<const PrincipalStresses> tests) {
  const auto count = double(tests.size());
  double mean_s = 0, mean_t = 0, st = 0, ss = 0;
  for (const auto& test : tests) {
    mean_s += test.s() / count;
    mean_t += test.t() / count;
  }
  for (const auto& test : tests) {
    st += (test.s() - mean_s) * (test.t() - mean_t);
    ss += (test.s() - mean_s) * (test.s() - mean_s);
  }
  if (tests.size() < 2 || !(ss > 0)) return {nan, nan, nan, nan};
  const double slope = st / ss, intercept = mean_t - slope * mean_s;
  const double angle = std::asin(slope), cosine = std::cos(angle);
  double squares = 0;
  for (const auto& test : tests) {
    const double off = test.t() - (intercept + slope * test.s());
    squares += off * off;
  }
  // c = a/cos phi of intercept a and slope b = sin phi, whose errors go together: cov(a, b) = -mean_s var(b).
  const double variance = tests.size() > 2 ? squares / (count - 2) : nan, of_slope = variance / ss;
  const double of_intercept = variance / count + mean_s * mean_s * of_slope;
  const double by_a = 1 / cosine, by_b = intercept * slope / (cosine * cosine * cosine);
  const double of_cohesion = by_a * by_a * of_intercept + by_b * by_b * of_slope - 2 * by_a * by_b * mean_s * of_slope;
  return {angle / degree, intercept / cosine, std::sqrt(of_slope) / cosine / degree,
          std::sqrt(of_cohesion < 0 ? 0 : of_cohesion)};
}

Cohesive cohesive(std::span<const PrincipalStresses> tests, bool grains_stick) {
  if (grains_stick) return Cohesive::by_law;
  const CohesionFit fit = fit_with_cohesion(tests);
  double mean_s = 0;
  for (const auto& test : tests) mean_s += test.s() / double(tests.size());
  const bool is_beyond = fit.cohesion > cohesive_errors * fit.cohesion_error && fit.cohesion > cohesive_share * mean_s;
  return is_beyond ? Cohesive::by_line : Cohesive::no;  // NaN is not beyond
}

double strength_angle_deg(std::span<const PrincipalStresses> tests, Cohesive cohesive) {
  return cohesive == Cohesive::no ? friction_angle_through_origin_deg(tests)
                                  : fit_with_cohesion(tests).friction_angle_deg;
}

double tensile_strength(std::span<const records::Record> records, int dimension) {
  if (records.empty()) throw InputError("tensile_strength: 0 records; allowed: at least 1; give a test that records");
  double largest = 0;
  for (const auto& record : records) largest = std::max(largest, -principal_stresses(record.stress, dimension).minor);
  return largest;
}

double apex_tension(double friction_angle_deg, double cohesion) {
  return friction_angle_deg > 0 && cohesion > 0 ? cohesion / std::tan(friction_angle_deg * degree) : nan;
}

double bearing_capacity_Nc(double friction_angle_deg) {
  if (friction_angle_deg == 0) return pi + 2;
  return (bearing_capacity_Nq(friction_angle_deg) - 1) / std::tan(friction_angle_deg * degree);
}

double bearing_capacity_Nq(double friction_angle_deg) {
  const double root = std::tan((45 + 0.5 * friction_angle_deg) * degree);
  return root * root * std::exp(pi * std::tan(friction_angle_deg * degree));
}

double local_shear_Nq(double friction_angle_deg) {
  return bearing_capacity_Nq(std::atan(2.0 / 3.0 * std::tan(friction_angle_deg * degree)) / degree);
}

double wedge_angle_deg(double friction_angle_deg) { return 45 + 0.5 * friction_angle_deg; }

std::span<const records::Record> last_stage(const records::TestResult& result) {
  const auto& records = result.records;
  std::size_t begin = records.size();
  while (begin > 0 && records[begin - 1].stage == records.back().stage) --begin;
  return std::span<const records::Record>(records).subspan(begin);
}

OedometerStiffness oedometer_stiffness(std::span<const records::Record> stage, const std::string& axis, int dimension,
                                       double up_to) {
  const int a = axis[0] - 'x';
  double squares = 0, axial = 0, lateral = 0;
  for (const records::Record& record : stage) {
    if (std::abs(record.strain) > up_to * (1 + 1e-9)) break;
    // Compression positive in both.
    const Matrix3 change = stage.front().stress - record.stress;
    const double strain = record.strain - stage.front().strain;
    squares += strain * strain;
    axial += strain * change(a, a);
    for (int k = 0; k < dimension; ++k) {
      if (k != a) lateral += strain * change(k, k) / (dimension - 1);
    }
  }
  constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
  if (squares == 0) return {nothing, nothing, nothing, nothing, nothing};
  const double c11 = axial / squares, c12 = lateral / squares, g = 0.5 * (c11 - c12);
  return {c11, c12, g, c12 + 2 * g / 3, 0.5 * (c11 + c12)};
}

}  // namespace rvelab::calibrate
