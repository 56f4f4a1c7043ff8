#include "rvelab/study/measures.hpp"

#include <Eigen/LU>
#include <cmath>

#include "rvelab/calibrate/mohr.hpp"
#include "rvelab/study/piece.hpp"

namespace rvelab::study {
namespace {

/// Half of the window around the peak that the dilation is taken over.
constexpr double dilation_window = 0.005;

/// The secant stiffness is that up to this driving strain.
constexpr double secant_strain = 1e-3;

double peak_friction_angle(const records::TestResult& test, int dimension) {
  const auto records = calibrate::last_stage(test);
  return records.empty() ? no_value : calibrate::friction_angle_deg(calibrate::peak(records, dimension).stresses);
}

/// Slope of ln det F, expansion positive, over the size of the driving strain: least squares around the peak.
double dilation_at_peak(const records::TestResult& test, int dimension) {
  const auto records = calibrate::last_stage(test);
  if (records.empty()) return no_value;
  const double middle = calibrate::peak(records, dimension).strain;
  double count = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (const records::Record& record : records) {
    const double strain = std::abs(record.strain), volume = record.deformation_gradient.determinant();
    if (std::abs(record.strain - middle) > dilation_window || !(volume > 0)) continue;
    const double expansion = std::log(volume);
    count += 1;
    x += strain;
    y += expansion;
    xx += strain * strain;
    xy += strain * expansion;
  }
  const double spread = count * xx - x * x;
  return count < 3 || !(spread > 0) ? no_value : (count * xy - x * y) / spread;
}

double void_ratio_at_end(const records::TestResult& test, int) {
  if (test.records.empty() || (test.records.back().quantities & records::asked<records::VoidRatio>) == 0)
    return no_value;
  return test.records.back().void_ratio;
}

/// Change of sigma_1 - sigma_3 from the start of the last stage to secant_strain, straight between records, over it.
double small_strain_stiffness(const records::TestResult& test, int dimension) {
  const auto records = calibrate::last_stage(test);
  const auto difference = [&](const records::Record& record) {
    return 2 * calibrate::principal_stresses(record.stress, dimension).t();
  };
  for (std::size_t k = 1; k < records.size(); ++k) {
    const double before = std::abs(records[k - 1].strain), strain = std::abs(records[k].strain);
    if (strain < secant_strain * (1 - 1e-9) || !(strain > before)) continue;
    const double part = (secant_strain - before) / (strain - before);
    const double at = (1 - part) * difference(records[k - 1]) + part * difference(records[k]);
    return (at - difference(records.front())) / secant_strain;
  }
  return no_value;
}

}  // namespace

const std::vector<Measure>& measures() {
  static const std::vector<Measure> all{
      {"peak_friction_angle_deg", "degrees", "of the largest sigma_1 - sigma_3 of the last stage", peak_friction_angle},
      {"dilation_at_peak", "1", "slope of ln det F over the driving strain within 0.5 % of the peak", dilation_at_peak},
      {"end_void_ratio", "1", "void ratio of the last record", void_ratio_at_end},
      {"small_strain_stiffness_Pa", "Pa", "secant of sigma_1 - sigma_3 to 0.1 % of the last stage's driving strain",
       small_strain_stiffness},
  };
  return all;
}

}  // namespace rvelab::study
