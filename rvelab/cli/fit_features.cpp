#include "rvelab/cli/fit_features.hpp"

#include <algorithm>

#include "rvelab/cli/columns.hpp"
#include "rvelab/cli/fit_reach.hpp"
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

}  // namespace rvelab::cli
