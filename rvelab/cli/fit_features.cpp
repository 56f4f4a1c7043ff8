#include "rvelab/cli/fit_features.hpp"

#include <algorithm>
#include <cmath>

#include "rvelab/cli/columns.hpp"
#include "rvelab/cli/fit_reach.hpp"
#include "rvelab/ensemble/statistics.hpp"
#include "rvelab/error.hpp"
#include "rvelab/keys/table_reader.hpp"

namespace rvelab::cli {
namespace {

using fit::MeasuredFeature;

/// The kind of a test, with the parameters at the low ends of their ranges.
ensemble::TestKind kind_of(const FitSetup& setup, const ComparedTest& test, protocol::Protocol& protocol) {
  Eigen::VectorXd values(Eigen::Index(setup.parameters.size()));
  for (Eigen::Index k = 0; k < values.size(); ++k) values[k] = setup.parameters[std::size_t(k)].low;
  protocol = protocol_of(setup, test, values);
  const bool over_stress = !test.curves.empty() && test.curves.front().abscissa != "strain";
  return ensemble::test_kind(protocol, over_stress);
}

void take_from_curves(ComparedTest& test, ensemble::TestKind kind) {
  std::vector<ensemble::Feature> features;
  for (const std::string& name : test.feature_names) features.push_back(ensemble::feature_of(name, kind).value());
  if (features.empty()) features = ensemble::usual_features(kind);
  std::vector<std::vector<fit::Curve>> tests{test.curves};
  tests.insert(tests.end(), test.repetitions.begin(), test.repetitions.end());
  std::vector<std::string> left_out;
  test.features = fit::measured_features(features, tests, left_out);
  if (test.features.empty())
    throw InputError(test.curves.front().file + ": has none of the features " + keys::listed(left_out) +
                     "; allowed: at least one; give the columns deviator, volumetric_strain or p over axial_strain, or "
                     "axial_strain over axial_stress, or set compare = \"curves\" for " +
                     test.name);
  if (!left_out.empty()) tell(test.name + " has no " + keys::listed(left_out) + ": left out");
}

void take_from_targets(ComparedTest& test) {
  std::erase_if(test.targets, [&](const fit::ScalarTarget& target) {
    const auto& known = ensemble::measures();
    const bool is_measure =
        std::any_of(known.begin(), known.end(), [&](const auto& each) { return each.name == target.measure; });
    if (is_measure) return false;
    test.features.push_back({ensemble::feature_of(target.measure).value(), target.value, target.error, {target.value}});
    return true;
  });
}

void use_repetitions(FitSetup& setup) {
  std::vector<std::vector<MeasuredFeature>> all;
  for (const ComparedTest& test : setup.tests) all.push_back(test.features);
  const auto factors = fit::scatter_factors(all);
  std::string words;
  for (const auto& [quantity, factor] : factors)
    words += (words.empty() ? "" : ", ") + quantity + " " + in_digits(factor, 3);
  if (!factors.empty()) tell("repeated tests scatter as the assumed ones times: " + words);
  for (ComparedTest& test : setup.tests) {
    if (!test.by_features) continue;
    for (MeasuredFeature& each : test.features)
      if (const auto found = factors.find(each.feature.quantity); found != factors.end()) each.error *= found->second;
  }
}

/// A measured feature beside the predictions.
struct ComparedFeature {
  const ComparedTest& test;
  const MeasuredFeature& measured;
  ensemble::Spread found;
  double percent() const { return 100 * (found.mean - measured.value) / std::abs(measured.value); }
  double errors() const { return (found.mean - measured.value) / std::hypot(measured.error, found.standard_deviation); }
};

std::vector<ComparedFeature> compared_features(const FitSetup& setup, const std::vector<FitResult>& predictions) {
  std::vector<ComparedFeature> all;
  for (std::size_t number = 0; number < setup.tests.size(); ++number) {
    const ComparedTest& test = setup.tests[number];
    for (std::size_t k = 0; k < test.features.size(); ++k) {
      std::vector<double> values;
      for (const FitResult& result : predictions)
        if (result.failure.empty()) values.push_back(result.compared.at(number).at(k));
      all.push_back({test, test.features[k], ensemble::spread_of(values)});
    }
  }
  return all;
}

}  // namespace

void take_features(FitSetup& setup) {
  for (ComparedTest& test : setup.tests) {
    protocol::Protocol protocol;
    const ensemble::TestKind kind = kind_of(setup, test, protocol);
    if (test.by_features) take_from_curves(test, kind);
    take_from_targets(test);
    for (const MeasuredFeature& each : test.features)
      if (!each.feature.over_stress()) expect_reach(each.feature, protocol);
  }
  use_repetitions(setup);
}

std::string features_text(const FitSetup& setup, const std::vector<FitResult>& predictions) {
  std::vector<std::vector<std::string>> rows{
      {"test", "", "feature", "measured +- scatter", "model: mean +- sd", "off, %", "off, errors"}};
  for (const ComparedFeature& each : compared_features(setup, predictions))
    rows.push_back({each.test.name, each.test.predict ? "predicted" : "fitted", each.measured.feature.name,
                    ensemble::with_error(each.measured.value, each.measured.error),
                    ensemble::with_error(each.found.mean, each.found.standard_deviation), two_digits(each.percent()),
                    two_digits(each.errors())});
  return rows.size() > 1 ? "\n" + aligned(rows, 3, 150) : "";
}

std::string features_csv(const FitSetup& setup, const std::vector<FitResult>& predictions) {
  std::string text = "test,predicted,feature,measured,error,tests,mean,standard_deviation,n\n";
  for (const ComparedFeature& each : compared_features(setup, predictions)) {
    text += csv_cell(each.test.name) + "," + (each.test.predict ? "1," : "0,") + each.measured.feature.name;
    for (const double value : {each.measured.value, each.measured.error, double(each.measured.tests.size()),
                               each.found.mean, each.found.standard_deviation})
      text += "," + csv_cell(value);
    text += "," + std::to_string(each.found.n) + "\n";
  }
  return text;
}

Json features_json(const FitSetup& setup, const std::vector<FitResult>& predictions) {
  Json list = Json::array();
  for (const ComparedFeature& each : compared_features(setup, predictions))
    list.push_back({{"test", each.test.name},
                    {"predicted", each.test.predict},
                    {"feature", each.measured.feature.name},
                    {"off_percent", each.percent()},
                    {"off_standard_errors", each.errors()},
                    {"measured", each.measured.value},
                    {"standard_error", each.measured.error},
                    {"mean", each.found.mean},
                    {"standard_deviation", each.found.standard_deviation},
                    {"n", each.found.n}});
  return list;
}

}  // namespace rvelab::cli
