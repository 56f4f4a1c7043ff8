#include "rvelab/fit/measured_features.hpp"

#include <algorithm>
#include <cmath>

namespace rvelab::fit {
namespace {

using ensemble::Feature;
using ensemble::TestPath;

/// Part of the variance of a feature that the others of its quantity share: density and load cell, not the seating.
constexpr double common = 0.5;

double strain_of_largest(const TestPath& path) {
  return path.strain[std::size_t(std::max_element(path.q.begin(), path.q.end()) - path.q.begin())];
}

/// Whether p falls and rises again by more than the noise of a sensor: else it transforms before or after the test.
bool transforms(const TestPath& path) {
  if (path.p.empty()) return false;
  constexpr double noise = 0.02;  // of p at the start
  const double least = *std::min_element(path.p.begin(), path.p.end()), step = noise * path.p.front();
  return path.p.front() - least > step && path.p.back() - least > step;
}

double measured(const Feature& feature, const TestPath& path) {
  using Kind = Feature::Kind;
  const bool after_peak = feature.kind == Kind::at_strain && feature.quantity == "deviator" && !path.q.empty() &&
                          feature.at > strain_of_largest(path) * (1 + 1e-9);
  if (after_peak || (feature.kind == Kind::transformation && !transforms(path))) return Features::nan();
  return ensemble::value_of(feature, path);
}

}  // namespace

TestPath path_of(const std::vector<Curve>& curves) {
  TestPath path;
  for (const Curve& curve : curves) {
    if (curve.abscissa != "strain") {
      if (curve.abscissa != "axial_stress" || curve.name != "strain") continue;
      path.loading = curve.all_x;
      path.loading_strain = curve.all_y;
      path.unloading = curve.unloaded_x;
      path.unloading_strain = curve.unloaded_y;
      if (path.unloading.empty() || path.unloading.front() == path.loading.back()) continue;
      path.unloading.insert(path.unloading.begin(), path.loading.back());
      path.unloading_strain.insert(path.unloading_strain.begin(), path.loading_strain.back());
      continue;
    }
    path.strain = curve.all_x;
    if (curve.name == "deviator") path.q = curve.all_y;
    if (curve.name == "p") path.p = curve.all_y;
    if (curve.name == "volumetric_strain") path.eps_v = curve.all_y;
  }
  return path;
}

std::vector<MeasuredFeature> measured_features(const std::vector<Feature>& features,
                                               const std::vector<std::vector<Curve>>& tests,
                                               std::vector<std::string>& left_out) {
  std::vector<TestPath> paths;
  for (const auto& curves : tests) paths.push_back(path_of(curves));
  std::vector<MeasuredFeature> found;
  for (const Feature& feature : features) {
    MeasuredFeature one{feature};
    for (const TestPath& path : paths)
      if (const double value = measured(feature, path); std::isfinite(value)) one.tests.push_back(value);
    if (!std::isfinite(measured(feature, paths.front()))) {
      left_out.push_back(feature.name);
      continue;
    }
    for (const double value : one.tests) one.value += value / double(one.tests.size());
    one.error = feature.scatter_of(one.value) / std::sqrt(double(one.tests.size()));
    found.push_back(std::move(one));
  }
  return found;
}

std::map<std::string, double> scatter_factors(const std::vector<std::vector<MeasuredFeature>>& tests) {
  constexpr double assumed = 4;  // weight of the assumption, in repetitions
  struct Sums {
    double squares = 0, freedom = 0, features = 0;
  };
  std::map<std::string, Sums> all;
  for (const auto& features : tests) {
    std::map<std::string, Sums> own;
    for (const MeasuredFeature& each : features) {
      if (each.tests.size() < 2) continue;
      Sums& sums = own[each.feature.quantity];
      sums.features += 1;
      sums.freedom += double(each.tests.size() - 1);
      for (const double value : each.tests)
        sums.squares += std::pow((value - each.value) / each.feature.scatter_of(each.value), 2);
    }
    for (const auto& [quantity, sums] : own) {
      all[quantity].squares += sums.squares / sums.features;
      all[quantity].freedom += sums.freedom / sums.features;
    }
  }
  std::map<std::string, double> factors;
  for (const auto& [quantity, sums] : all)
    factors[quantity] = std::sqrt((assumed + sums.squares) / (assumed + sums.freedom));
  return factors;
}

std::vector<Target> targets_of(const std::vector<MeasuredFeature>& features, int& number, const std::string& test) {
  std::map<std::string, int> groups;
  std::vector<Target> targets;
  for (const MeasuredFeature& each : features) {
    if (!groups.contains(each.feature.quantity)) groups.emplace(each.feature.quantity, number++);
    targets.push_back({(test.empty() ? "" : test + ": ") + each.feature.name, each.value, each.error,
                       groups[each.feature.quantity], common});
  }
  return targets;
}

}  // namespace rvelab::fit
