#include "rvelab/ensemble/measures.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "rvelab/cell/cell.hpp"
#include "rvelab/ensemble/cyclic.hpp"
#include "rvelab/ensemble/statistics.hpp"
#include "rvelab/protocol/stage_kinds.hpp"

namespace rvelab::ensemble {
namespace {

using calibrate::PrincipalStresses;
using protocol::CompressionStage;
using protocol::SimpleShearStage;
using Records = std::span<const records::Record>;

constexpr double degree = std::numbers::pi / 180;

double volumetric_strain(const records::Record& record) { return 1 - record.deformation_gradient.determinant(); }

/// Least squares slope of eps_v in the driving strain around `at`; NaN with fewer than three records.
double slope_of_volume(Records records, double at, double window) {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (const records::Record& record : records) {
    const double from = record.strain - at, volume = volumetric_strain(record);
    if (std::abs(from) > 0.5 * window * (1 + 1e-9)) continue;
    n += 1, x += from, y += volume, xx += from * from, xy += from * volume;
  }
  const double variance = n * xx - x * x;
  return n >= 3 && variance > 0 ? (n * xy - x * y) / variance : nan;
}

/// The last stage that recorded, and its records.
struct LastStage {
  Records records;
  const protocol::Stage* stage = nullptr;
  const CompressionStage* compression = nullptr;
  const SimpleShearStage* shear = nullptr;
  int axis = 0;  ///< of a compression

  bool cyclic() const {
    return (compression != nullptr && compression->cycles.count > 0) || (shear != nullptr && shear->cycles.count > 0);
  }
  bool undrained() const {
    return (compression != nullptr && compression->lateral == CompressionStage::Lateral::constant_volume) ||
           (shear != nullptr && shear->normal == SimpleShearStage::Normal::constant_volume);
  }
  bool oedometric() const {
    return compression != nullptr && compression->lateral == CompressionStage::Lateral::zero_strain;
  }
  bool leads_to_strength() const {
    return stage != nullptr && !cyclic() && !oedometric() &&
           (compression != nullptr || shear != nullptr || stage->kind == "deviatoric" || stage->kind == "flow");
  }
};

LastStage last_of(const protocol::Protocol& protocol, const records::TestResult& test, int dimension) {
  LastStage last;
  if (test.records.empty()) return last;
  last.records = calibrate::last_stage(test);
  last.stage = &protocol.stages.at(static_cast<std::size_t>(last.records.front().stage));
  last.compression = protocol::settings_of<CompressionStage>(*last.stage);
  last.shear = protocol::settings_of<SimpleShearStage>(*last.stage);
  if (last.compression != nullptr)
    last.axis = last.compression->axis.empty() ? dimension - 1 : last.compression->axis[0] - 'x';
  return last;
}

/// Mean angle at large strain: 12 to 15 % of a compression; of simple shear the last three fifths of a strain of 1 or
/// more, which leave the start behind.
double large_strain_angle(const LastStage& last, int dimension) {
  const double end = std::abs(last.records.back().strain);
  if (last.shear != nullptr && end < 1) return nan;
  const auto mean = last.shear == nullptr ? calibrate::large_strain_mean(last.records, dimension)
                                          : calibrate::large_strain_mean(last.records, dimension, 0.4 * end, end);
  return calibrate::friction_angle_deg(mean);
}

/// Shear modulus of a probe, the mean of the diagonal, or of an oedometer stage at small strain.
double largest_shear_modulus(const protocol::Protocol& protocol, const records::TestResult& test, int dimension) {
  if (!test.probes.empty()) {
    const Eigen::MatrixXd& stiffness = test.probes.front().stiffness;
    return stiffness.diagonal().tail(stiffness.rows() - dimension).mean();
  }
  for (std::size_t k = 0; k < protocol.stages.size(); ++k) {
    const protocol::StageRole role = protocol::role_of(protocol.stages[k]);
    if (role.gives != protocol::StageRole::Gives::oedometric_stiffness) continue;
    std::vector<records::Record> stage;
    for (const records::Record& record : test.records)
      if (record.stage == static_cast<int>(k)) stage.push_back(record);
    const double found = calibrate::oedometer_stiffness(stage,
                                                        !role.axis.empty() ? role.axis
                                                        : dimension == 2   ? "y"
                                                                           : "z",
                                                        dimension)
                             .G;
    if (std::isfinite(found)) return found;
  }
  return nan;
}

/// The values by their names; what is not named is NaN.
std::vector<double> in_order(const std::vector<std::pair<const char*, double>>& named) {
  std::vector<double> values(measures().size(), nan);
  for (const auto& given : named) {
    const auto place = std::find_if(measures().begin(), measures().end(),
                                    [&](const Measure& each) { return each.name == given.first; });
    values.at(static_cast<std::size_t>(place - measures().begin())) = given.second;
  }
  return values;
}

}  // namespace

const std::vector<Measure>& measures() {
  static const std::vector<Measure> all{
      {"friction_angle_deg", "degrees", "secant through the origin, at the largest sigma_1 - sigma_3"},
      {"large_strain_friction_angle_deg", "degrees", "mean from 12 to 15 % of strain; simple shear: of its last 60 %"},
      {"dilation_angle_deg", "degrees", "at the peak, over 1 % of strain"},
      {"peak_strain", "", "driving strain at the largest sigma_1 - sigma_3"},
      {"E50_Pa", "Pa", "secant modulus at half of the largest deviator"},
      {"poisson_ratio", "", "secant at half of the largest deviator"},
      {"G_max_Pa", "Pa", "shear modulus of a probe, or of an oedometer at small strain"},
      {"undrained_strength_Pa", "Pa", "largest (sigma_1 - sigma_3)/2 at constant volume"},
      {"stress_ratio", "", "cyclic: amplitude of the stress over p at the start"},
      {"cycles_to_liquefaction", "", "cyclic: until p falls below its limit; not defined where it does not"},
      {"start_void_ratio", "", "at the first record of the last stage"},
      {"end_void_ratio", "", "at the last record"},
      {"cycles_to_r_u_0.95", "", "cyclic at constant volume: until the pore pressure ratio r_u is 0.95"},
      {"cycles_to_2.5_percent", "", "the same, stress-controlled: until a single amplitude of 2.5 % of strain"}};
  return all;
}

double dilation_angle_deg(Records records, double at, double window) {
  const double slope = slope_of_volume(records, at, window);
  return std::asin(-slope / (2 - slope)) / degree;
}

Secant secant_at_half(Records records, int axis, int dimension) {
  const auto deviator = [&](const records::Record& record) {
    double axial_less_lateral = -record.stress(axis, axis);
    for (int k = 0; k < dimension; ++k)
      if (k != axis) axial_less_lateral += record.stress(k, k) / (dimension - 1);
    return axial_less_lateral;
  };
  const double start = records.empty() ? 0 : deviator(records.front());
  double largest = 0;
  for (const records::Record& record : records) largest = std::max(largest, deviator(record) - start);
  for (std::size_t k = 1; k < records.size(); ++k) {
    const double before = deviator(records[k - 1]) - start, after = deviator(records[k]) - start;
    if (after < 0.5 * largest || !(largest > 0)) continue;
    const double part = (0.5 * largest - before) / (after - before);
    const auto between = [&](double first, double second) { return first + part * (second - first); };
    const double strain = between(records[k - 1].strain, records[k].strain) - records.front().strain;
    const double volume =
        between(volumetric_strain(records[k - 1]), volumetric_strain(records[k])) - volumetric_strain(records.front());
    return {0.5 * largest / strain, (1 - volume / strain) / (dimension - 1)};
  }
  return {nan, nan};
}

PrincipalStresses strength_of(const protocol::Protocol& protocol, const records::TestResult& test, int dimension) {
  const LastStage last = last_of(protocol, test, dimension);
  if (!last.leads_to_strength()) return {nan, nan};
  return calibrate::peak(last.records, dimension).stresses;
}

Liquefaction liquefaction_of(const protocol::Protocol& protocol, const records::TestResult& test, int dimension) {
  const LastStage last = last_of(protocol, test, dimension);
  Liquefaction found;
  const double amplitude = last.shear != nullptr         ? last.shear->cycles.reverse_at
                           : last.compression != nullptr ? last.compression->cycles.reverse_at
                                                         : 0;
  if (!last.cyclic() || amplitude <= 0) return found;
  found.cyclic = true;
  found.limit = 0.05;
  for (const protocol::Event& event : last.stage->until)
    if (event.quantity == "p_over_first" && event.when == protocol::Event::When::below) found.limit = event.value;
  const double first = mean_pressure(last.records.front().stress, dimension);
  found.stress_ratio = amplitude / first;
  found.least_p = 1;
  double before = 0;  // the strain increment before
  for (std::size_t k = 1; k < last.records.size() && !found.liquefied; ++k) {
    const double step = last.records[k].strain - last.records[k - 1].strain;
    if (step * before < 0) found.cycles += 0.5;
    before = step;
    found.least_p = std::min(found.least_p, mean_pressure(last.records[k].stress, dimension) / first);
    found.liquefied = found.least_p < found.limit;
  }
  return found;
}

std::vector<double> measured(const protocol::Protocol& protocol, const records::TestResult& test, int dimension) {
  const LastStage last = last_of(protocol, test, dimension);
  std::vector<std::pair<const char*, double>> found{{"G_max_Pa", largest_shear_modulus(protocol, test, dimension)}};
  if (last.stage == nullptr) return in_order(found);
  if ((last.records.back().quantities & records::asked<records::VoidRatio>) != 0) {
    found.emplace_back("start_void_ratio", last.records.front().void_ratio);
    found.emplace_back("end_void_ratio", last.records.back().void_ratio);
  }
  const Liquefaction cyclic = liquefaction_of(protocol, test, dimension);
  if (cyclic.cyclic) {
    found.emplace_back("stress_ratio", cyclic.stress_ratio);
    if (cyclic.liquefied) found.emplace_back("cycles_to_liquefaction", cyclic.cycles);
  }
  if (last.cyclic() && last.undrained()) {
    const CyclesTo cycles =
        last.shear != nullptr
            ? cycles_to(last.records, test.axis, last.shear->cycles, last.shear->to_strain, dimension)
            : cycles_to(last.records, test.axis, last.compression->cycles, last.compression->to_strain, dimension);
    found.emplace_back("cycles_to_r_u_0.95", cycles.pore_pressure);
    found.emplace_back("cycles_to_2.5_percent", cycles.strain);
  }
  if (!last.leads_to_strength()) return in_order(found);
  const calibrate::Peak peak = calibrate::peak(last.records, dimension);
  found.emplace_back("peak_strain", peak.strain);
  found.emplace_back("friction_angle_deg", calibrate::friction_angle_deg(peak.stresses));
  found.emplace_back("large_strain_friction_angle_deg", large_strain_angle(last, dimension));
  if (last.undrained()) {
    found.emplace_back("undrained_strength_Pa", peak.stresses.t());
    return in_order(found);
  }
  if (last.shear != nullptr)  // the plane of shear does not stretch: tan psi = -d eps_v/d gamma
    found.emplace_back("dilation_angle_deg", std::atan(-slope_of_volume(last.records, peak.strain, 0.01)) / degree);
  if (last.compression != nullptr) {
    found.emplace_back("dilation_angle_deg", dilation_angle_deg(last.records, peak.strain));
    const Secant secant = secant_at_half(last.records, last.axis, dimension);
    found.emplace_back("E50_Pa", secant.modulus);
    found.emplace_back("poisson_ratio", secant.poisson_ratio);
  }
  return in_order(found);
}

double bearing_capacity_Ngamma(double friction_angle_deg) {
  return 2 * (calibrate::bearing_capacity_Nq(friction_angle_deg) + 1) * std::tan(friction_angle_deg * degree);
}

double spiral_ratio(double friction_angle_deg) {
  return std::exp(0.5 * std::numbers::pi * std::tan(friction_angle_deg * degree));
}

}  // namespace rvelab::ensemble
