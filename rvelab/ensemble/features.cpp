#include "rvelab/ensemble/features.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <charconv>
#include <cmath>

#include "rvelab/calibrate/mohr.hpp"
#include "rvelab/cell/cell.hpp"
#include "rvelab/ensemble/statistics.hpp"
#include "rvelab/protocol/stage_kinds.hpp"

namespace rvelab::ensemble {
namespace {

using Kind = Feature::Kind;
using Column = std::vector<double>;

constexpr double of_void_ratio = 0.05, of_load_cell = 0.04, of_seating = 1.5e-4, of_undrained = 0.1;

/// Names with a number in them: what stands before and behind it.
struct Form {
  const char *before, *behind;
  Kind kind;
  const char* quantity;
  double unit;  ///< of the number, in SI
};
constexpr Form forms[] = {
    {"q_at_", "_percent_Pa", Kind::at_strain, "deviator", 0.01},
    {"p_at_", "_percent_Pa", Kind::at_strain, "p", 0.01},
    {"eps_v_at_", "_percent", Kind::at_strain, "volumetric_strain", 0.01},
    {"loading_strain_at_", "_kPa", Kind::loading, "strain", 1e3},
    {"unloading_strain_at_", "_kPa", Kind::unloading, "strain", 1e3},
};

const std::vector<Feature>& named_features() {
  static const std::vector<Feature> all{
      {"E50_Pa", Kind::secant, "deviator", 0, 0.09, 0},
      {"strain_at_95_percent_of_q", Kind::near_largest, "strain_of_deviator", 0, 0.1, 0},
      {"largest_q_Pa", Kind::largest, "deviator", 0, 0.045, 0},
      {"last_q_Pa", Kind::last, "deviator", 0, 0.045, 0},
      {"q_at_phase_transformation_Pa", Kind::transformation, "deviator", 0, 0.1, 0},
      {"p_at_phase_transformation_Pa", Kind::transformation, "p", 0, 0.1, 0}};
  return all;
}

Feature with_scatter(Feature feature, TestKind kind) {
  if (feature.over_stress()) {
    feature.relative = 0.05;
    feature.absolute = 0.001;
  } else if (feature.quantity == "volumetric_strain") {
    feature.relative = 0.05;
    feature.absolute = 0.04 * feature.at;
  } else if (feature.kind == Kind::at_strain) {
    feature.relative = std::hypot(of_void_ratio, of_load_cell, of_seating / feature.at);
  }
  if (kind == TestKind::undrained) feature.relative = std::max(feature.relative, of_undrained);
  return feature;
}

/// Where a rising column passes a value: number of the row behind, and the part of the way from the row before.
struct Crossing {
  std::size_t row = 0;
  double part = 0;
  double in(const Column& y) const { return y[row - 1] + part * (y[row] - y[row - 1]); }
};
std::optional<Crossing> crossing(const Column& x, double at, bool logarithm = false) {
  const double slack = 1e-9 * std::abs(at);
  for (std::size_t k = 1; k < x.size(); ++k) {
    const double low = std::min(x[k - 1], x[k]), high = std::max(x[k - 1], x[k]);
    if (!(low < high) || at < low - slack || at > high + slack) continue;
    const double part =
        logarithm ? std::log(at / x[k - 1]) / std::log(x[k] / x[k - 1]) : (at - x[k - 1]) / (x[k] - x[k - 1]);
    return Crossing{k, std::clamp(part, 0.0, 1.0)};
  }
  return std::nullopt;
}

const Column& column_of(const std::string& quantity, const TestPath& path) {
  return quantity == "p" ? path.p : quantity == "volumetric_strain" ? path.eps_v : path.q;
}

double at_strain(const Column& y, const TestPath& path, double at) {
  if (path.flows && at > path.strain.back()) return y.back();
  const auto found = crossing(path.strain, at);
  return found ? found->in(y) : nan;
}

double at_stress(const Column& stress, const Column& strain, double at) {
  constexpr double missed = 0.01;  // a test is at a stress within a tolerance
  if (stress.size() < 2) return nan;
  const auto [least, largest] = std::minmax_element(stress.begin(), stress.end());
  if (at < *least * (1 - missed) || at > *largest * (1 + missed)) return nan;
  const auto found = crossing(stress, std::clamp(at, *least, *largest), true);
  return found ? found->in(strain) : nan;
}

/// The largest mean of q over strains within a quarter of each strain, 1 % at most. That of single records of 300
/// spheres is 10 % above the largest q of the mean of many specimens.
double largest_q(const TestPath& path) {
  const Column &y = path.q, &strain = path.strain;
  constexpr double part = 0.25, most = 0.01;
  Column area(y.size(), 0.0);  // below y
  for (std::size_t k = 1; k < y.size(); ++k)
    area[k] = area[k - 1] + 0.5 * (y[k] + y[k - 1]) * (strain[k] - strain[k - 1]);
  const auto up_to = [&](double x) {
    const auto k = std::size_t(std::lower_bound(strain.begin() + 1, strain.end() - 1, x) - strain.begin()) - 1;
    const double step = x - strain[k], slope = (y[k + 1] - y[k]) / (strain[k + 1] - strain[k]);
    return area[k] + step * (y[k] + 0.5 * step * slope);
  };
  double largest = 0;
  for (std::size_t k = 1; k < y.size(); ++k) {
    const double reach = std::min(most, part * (strain[k] - strain.front()));
    const double low = strain[k] - reach, high = std::min(strain[k] + reach, strain.back());
    largest = std::max(largest, (up_to(high) - up_to(low)) / (high - low));
  }
  return largest;
}

double secant_at_half(const TestPath& path) {
  const double start = path.q.front();
  const double half = 0.5 * (largest_q(path) - start);
  const auto found = crossing(path.q, start + half);
  return found && half > 0 ? half / (found->in(path.strain) - path.strain.front()) : nan;
}

double near_largest(const TestPath& path) {
  const auto found = crossing(path.q, 0.95 * largest_q(path));
  return found ? found->in(path.strain) : nan;
}

/// The stages at the end of a test that only shorten or lengthen its axis.
TestPath oedometric_path(const records::TestResult& test, int dimension) {
  const int axis = test.axis.size() == 1 ? test.axis[0] - 'x' : dimension - 1;
  const auto is_oedometric = [&](const records::Record& record) {
    Matrix3 lateral = record.deformation_gradient;
    lateral(axis, axis) = 1;
    const double axial = std::abs(record.deformation_gradient(axis, axis) - 1);
    return (lateral - Matrix3::Identity()).cwiseAbs().maxCoeff() < 1e-5 + 0.01 * axial;  // a path drifts by round-off
  };
  std::size_t begin = test.records.size();
  while (begin > 0 && is_oedometric(test.records[begin - 1])) --begin;
  Column stress, strain;
  double stretch_before = 1, stretch = 1;  // of the stages before, and in all
  for (std::size_t k = begin; k < test.records.size(); ++k) {
    const records::Record& record = test.records[k];
    if (k > begin && record.stage != test.records[k - 1].stage) stretch_before = stretch;
    stretch = stretch_before * record.deformation_gradient(axis, axis);
    stress.push_back(-record.stress(axis, axis));
    strain.push_back(1 - stretch);
  }
  const auto turn = std::size_t(std::max_element(stress.begin(), stress.end()) - stress.begin());
  TestPath path;
  for (std::size_t k = 0; k < stress.size(); ++k) {
    if (k <= turn && (path.loading.empty() || stress[k] > path.loading.back())) {
      path.loading.push_back(stress[k]);
      path.loading_strain.push_back(strain[k]);
    }
    if (k < turn) continue;
    path.unloading.push_back(stress[k]);
    path.unloading_strain.push_back(strain[k]);
  }
  return path;
}

}  // namespace

double Feature::scatter_of(double value) const { return std::hypot(relative * value, absolute); }

std::optional<Feature> feature_of(const std::string& name, TestKind kind) {
  for (const Feature& each : named_features())
    if (each.name == name) return with_scatter(each, kind);
  for (const Form& form : forms) {
    if (!name.starts_with(form.before) || !name.ends_with(form.behind)) continue;
    const std::string before = form.before, behind = form.behind;
    if (name.size() <= before.size() + behind.size()) continue;
    const std::string digits = name.substr(before.size(), name.size() - before.size() - behind.size());
    double number = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
    if (error != std::errc() || end != digits.data() + digits.size() || !(number > 0) || !std::isfinite(number))
      continue;
    return with_scatter({name, form.kind, form.quantity, form.unit * number}, kind);
  }
  return std::nullopt;
}

const std::vector<std::string>& feature_names() {
  static const std::vector<std::string> all = [] {
    std::vector<std::string> names;
    for (const Form& form : forms) names.push_back(std::string(form.before) + "X" + form.behind);
    for (const Feature& each : named_features()) names.push_back(each.name);
    return names;
  }();
  return all;
}

std::vector<Feature> usual_features(TestKind kind) {
  std::vector<Feature> features;
  const auto add = [&](std::initializer_list<const char*> names) {
    for (const char* name : names) features.push_back(feature_of(name, kind).value());
  };
  if (kind == TestKind::drained)
    add({"q_at_0.1_percent_Pa", "q_at_0.5_percent_Pa", "q_at_1_percent_Pa", "q_at_2_percent_Pa", "q_at_5_percent_Pa",
         "E50_Pa", "largest_q_Pa", "last_q_Pa", "strain_at_95_percent_of_q", "eps_v_at_2_percent", "eps_v_at_5_percent",
         "eps_v_at_15_percent"});
  if (kind == TestKind::undrained)
    add({"q_at_phase_transformation_Pa", "q_at_0.1_percent_Pa", "q_at_1_percent_Pa", "q_at_2_percent_Pa",
         "q_at_5_percent_Pa", "q_at_10_percent_Pa", "p_at_phase_transformation_Pa", "p_at_0.1_percent_Pa",
         "p_at_1_percent_Pa", "p_at_2_percent_Pa", "p_at_5_percent_Pa", "p_at_10_percent_Pa"});
  if (kind == TestKind::oedometer)
    add({"loading_strain_at_12.5_kPa", "loading_strain_at_25_kPa", "loading_strain_at_50_kPa",
         "loading_strain_at_100_kPa", "loading_strain_at_200_kPa", "loading_strain_at_400_kPa",
         "loading_strain_at_800_kPa", "loading_strain_at_1600_kPa", "unloading_strain_at_800_kPa",
         "unloading_strain_at_400_kPa", "unloading_strain_at_200_kPa", "unloading_strain_at_100_kPa",
         "unloading_strain_at_50_kPa", "unloading_strain_at_25_kPa", "unloading_strain_at_12.5_kPa"});
  return features;
}

TestKind test_kind(const protocol::Protocol& protocol, bool over_stress) {
  if (over_stress) return TestKind::oedometer;
  const auto last = std::find_if(protocol.stages.rbegin(), protocol.stages.rend(),
                                 [](const protocol::Stage& stage) { return stage.what->planned_records() > 0; });
  if (last == protocol.stages.rend()) return TestKind::drained;
  const auto* compression = protocol::settings_of<protocol::CompressionStage>(*last);
  const auto* shear = protocol::settings_of<protocol::SimpleShearStage>(*last);
  const bool keeps_volume =
      (compression != nullptr && compression->lateral == protocol::CompressionStage::Lateral::constant_volume) ||
      (shear != nullptr && shear->normal == protocol::SimpleShearStage::Normal::constant_volume);
  return keeps_volume ? TestKind::undrained : TestKind::drained;
}

TestPath path_of(const records::TestResult& test, int dimension, bool over_stress, double to_strain) {
  if (test.records.empty()) return {};
  if (over_stress) return oedometric_path(test, dimension);
  TestPath path;
  const auto stage = calibrate::last_stage(test);
  for (const records::Record& record : stage) {
    const double strain = std::abs(record.strain);
    if (strain > to_strain * (1 + 1e-9) || (!path.strain.empty() && !(strain > path.strain.back()))) break;
    path.strain.push_back(strain);
    path.q.push_back(2 * calibrate::principal_stresses(record.stress, dimension).t());
    path.p.push_back(mean_pressure(record.stress, dimension));
    path.eps_v.push_back(1 - record.deformation_gradient.determinant());
  }
  constexpr double without_stress = 0.01;  // of p at the start; protocols end below 0.001
  path.flows = path.strain.size() == stage.size() && path.p.back() < without_stress * path.p.front();
  return path;
}

double value_of(const Feature& feature, const TestPath& path) {
  if (feature.kind == Kind::loading) return at_stress(path.loading, path.loading_strain, feature.at);
  if (feature.kind == Kind::unloading) return at_stress(path.unloading, path.unloading_strain, feature.at);
  const Column& y = column_of(feature.quantity, path);
  if (path.strain.size() < 2 || y.size() != path.strain.size()) return nan;
  switch (feature.kind) {
    case Kind::at_strain:
      return at_strain(y, path, feature.at);
    case Kind::secant:
      return secant_at_half(path);
    case Kind::near_largest:
      return near_largest(path);
    case Kind::largest:
      return largest_q(path);
    case Kind::last:
      return y.back();
    default:
      break;
  }
  if (path.p.size() != path.strain.size()) return nan;
  return y[std::size_t(std::min_element(path.p.begin(), path.p.end()) - path.p.begin())];
}

}  // namespace rvelab::ensemble
