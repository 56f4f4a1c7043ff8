// What was measured beside what the parameters of a fit give. Declared in fit_report.hpp.
#include <array>
#include <cmath>

#include "rvelab/cli/columns.hpp"
#include "rvelab/cli/fit_report.hpp"
#include "rvelab/ensemble/statistics.hpp"

namespace rvelab::cli {
namespace {

/// Values of one quantity over the predictions that could be made.
ensemble::Spread spread_over(const std::vector<FitResult>& predictions, auto value_of) {
  std::vector<double> values;
  for (const FitResult& result : predictions)
    if (result.failure.empty()) values.push_back(value_of(result));
  return ensemble::spread_of(values);
}

struct FeatureText {
  const char *name, *label;
  double fit::Features::*of;
};
constexpr std::array feature_texts{FeatureText{"largest", "largest", &fit::Features::largest},
                                   FeatureText{"at_largest", "at strain", &fit::Features::at_largest},
                                   FeatureText{"at_strain_0.001", "at 0.1 %", &fit::Features::early},
                                   FeatureText{"last", "last", &fit::Features::last}};

/// A measured curve beside the predictions.
struct ComparedCurve {
  const ComparedTest& test;
  const fit::Curve& measured;
  std::vector<ensemble::Spread> points;
  std::array<ensemble::Spread, feature_texts.size()> features;
  double percent = 0;  ///< root mean square of mean less measured, over the largest measured
  double errors = 0;   ///< the same over sqrt(e^2 + s^2)
};

std::vector<ComparedCurve> compared(const FitSetup& setup, const std::vector<FitResult>& predictions) {
  std::vector<ComparedCurve> all;
  std::size_t number = 0;
  for (const ComparedTest& test : setup.tests) {
    for (const fit::Curve& curve : test.curves) {
      ComparedCurve one{test, curve, {}, {}};
      double largest = 0;
      for (std::size_t k = 0; k < curve.x.size(); ++k) {
        one.points.push_back(spread_over(predictions, [&](const FitResult& r) { return r.curves.at(number).at(k); }));
        const ensemble::Spread& found = one.points.back();
        const double off = found.mean - curve.y[k];
        one.percent += off * off;
        one.errors +=
            off * off / (curve.error[k] * curve.error[k] + found.standard_deviation * found.standard_deviation);
        largest = std::max(largest, std::abs(curve.y[k]));
      }
      one.percent = 100 * std::sqrt(one.percent / double(curve.x.size())) / largest;
      one.errors = std::sqrt(one.errors / double(curve.x.size()));
      for (std::size_t f = 0; f < feature_texts.size(); ++f)
        one.features[f] =
            spread_over(predictions, [&](const FitResult& r) { return r.features.at(number).*feature_texts[f].of; });
      all.push_back(std::move(one));
      ++number;
    }
  }
  return all;
}

/// A measured value, or feature of curves, beside the predictions.
struct ComparedValue {
  const ComparedTest& test;
  std::string name;
  double value, error;
  std::size_t tests;  ///< that were measured
  ensemble::Spread found;
  double percent() const { return 100 * (found.mean - value) / std::abs(value); }
  double errors() const { return (found.mean - value) / std::hypot(error, found.standard_deviation); }
};

std::vector<ComparedValue> compared_values(const FitSetup& setup, const std::vector<FitResult>& predictions) {
  std::vector<ComparedValue> all;
  for (std::size_t number = 0; number < setup.tests.size(); ++number)
    for (const fit::ScalarTarget& target : setup.tests[number].targets)
      all.push_back(
          {setup.tests[number], target.measure, target.value, target.error, 1,
           spread_over(predictions, [&](const FitResult& r) { return measure_of(r, number, target.measure); })});
  return all;
}

std::vector<ComparedValue> compared_features(const FitSetup& setup, const std::vector<FitResult>& predictions) {
  std::vector<ComparedValue> all;
  for (std::size_t number = 0; number < setup.tests.size(); ++number) {
    const ComparedTest& test = setup.tests[number];
    for (std::size_t k = 0; k < test.features.size(); ++k) {
      const fit::MeasuredFeature& measured = test.features[k];
      all.push_back({test, measured.feature.name, measured.value, measured.error, measured.tests.size(),
                     spread_over(predictions, [&](const FitResult& r) { return r.compared.at(number).at(k); })});
    }
  }
  return all;
}

/// How far the mean of the predictions is off: `percent` of what was measured, `errors` over measurement and scatter.
Json json_of(const ComparedValue& each, const char* kind, double percent, double errors) {
  return {{"test", each.test.name},
          {"predicted", each.test.predict},
          {kind, each.name},
          {"off_percent", percent},
          {"off_standard_errors", errors},
          {"measured", each.value},
          {"standard_error", each.error},
          {"mean", each.found.mean},
          {"standard_deviation", each.found.standard_deviation},
          {"n", each.found.n}};
}

std::string with_deviation(const ensemble::Spread& found) {
  return ensemble::with_error(found.mean, found.standard_deviation);
}

/// " (3 of 8)" where the others do not reach a measure: cycles to an end that did not come.
std::string of_all(std::size_t n, std::size_t all) {
  return n == all ? "" : " (" + std::to_string(n) + " of " + std::to_string(all) + ")";
}

/// The last cells of a row: numbers, then the predictions.
std::string csv_end(std::initializer_list<double> numbers, const ensemble::Spread& found) {
  std::string text;
  for (const double number : numbers) text += "," + csv_cell(number);
  return text + "," + csv_cell(found.mean) + "," + csv_cell(found.standard_deviation) + "," + std::to_string(found.n) +
         "\n";
}

std::string role(const ComparedTest& test) { return test.predict ? "predicted" : "fitted"; }

}  // namespace

std::string predictions_text(const FitSetup& setup, const std::vector<FitResult>& predictions) {
  if (predictions.empty()) return "";
  std::vector<std::vector<std::string>> rows{{"test", "", "curve", "off, %", "off, errors"}};
  for (const FeatureText& feature : feature_texts) {
    rows[0].push_back(feature.label);
    rows[0].push_back("model");
  }
  for (const ComparedCurve& each : compared(setup, predictions)) {
    rows.push_back(
        {each.test.name, role(each.test), each.measured.name, two_digits(each.percent), two_digits(each.errors)});
    for (std::size_t f = 0; f < feature_texts.size(); ++f) {
      rows.back().push_back(in_digits(each.measured.features.*feature_texts[f].of, 3));
      rows.back().push_back(with_deviation(each.features[f]));
    }
  }
  for (const ComparedValue& each : compared_values(setup, predictions))
    rows.push_back({each.test.name, role(each.test), each.name, two_digits(std::abs(each.percent())),
                    two_digits(std::abs(each.errors())), in_digits(each.value, 3),
                    with_deviation(each.found) + of_all(each.found.n, predictions.size()), "", "", "", "", "", ""});
  return "\n" + aligned(rows, 3, 150);
}

std::string predictions_csv(const FitSetup& setup, const std::vector<FitResult>& predictions) {
  std::string text = "test,predicted,quantity,abscissa,x,measured,error,mean,standard_deviation,n\n";
  for (const ComparedCurve& each : compared(setup, predictions))
    for (std::size_t k = 0; k < each.points.size(); ++k)
      text += csv_cell(each.test.name) + (each.test.predict ? ",1," : ",0,") + each.measured.name + "," +
              each.measured.abscissa +
              csv_end({each.measured.x[k], each.measured.y[k], each.measured.error[k]}, each.points[k]);
  return text;
}

Json predictions_json(const FitSetup& setup, const std::vector<FitResult>& predictions) {
  Json list = Json::array();
  for (const ComparedCurve& each : compared(setup, predictions)) {
    Json one{{"test", each.test.name},
             {"predicted", each.test.predict},
             {"curve", each.measured.name},
             {"off_percent", each.percent},
             {"off_standard_errors", each.errors}};
    for (std::size_t f = 0; f < feature_texts.size(); ++f)
      one[feature_texts[f].name] = {{"measured", each.measured.features.*feature_texts[f].of},
                                    {"mean", each.features[f].mean},
                                    {"standard_deviation", each.features[f].standard_deviation}};
    list.push_back(one);
  }
  for (const ComparedValue& each : compared_values(setup, predictions))
    list.push_back(json_of(each, "measure", std::abs(each.percent()), std::abs(each.errors())));
  return list;
}

std::string features_text(const FitSetup& setup, const std::vector<FitResult>& predictions) {
  std::vector<std::vector<std::string>> rows{
      {"test", "", "feature", "measured +- scatter", "model: mean +- sd", "off, %", "off, errors"}};
  for (const ComparedValue& each : compared_features(setup, predictions))
    rows.push_back({each.test.name, role(each.test), each.name, ensemble::with_error(each.value, each.error),
                    with_deviation(each.found), two_digits(each.percent()), two_digits(each.errors())});
  return rows.size() > 1 ? "\n" + aligned(rows, 3, 150) : "";
}

std::string features_csv(const FitSetup& setup, const std::vector<FitResult>& predictions) {
  std::string text = "test,predicted,feature,measured,error,tests,mean,standard_deviation,n\n";
  for (const ComparedValue& each : compared_features(setup, predictions))
    text += csv_cell(each.test.name) + (each.test.predict ? ",1," : ",0,") + each.name +
            csv_end({each.value, each.error, double(each.tests)}, each.found);
  return text;
}

Json features_json(const FitSetup& setup, const std::vector<FitResult>& predictions) {
  Json list = Json::array();
  for (const ComparedValue& each : compared_features(setup, predictions))
    list.push_back(json_of(each, "feature", each.percent(), each.errors()));
  return list;
}

}  // namespace rvelab::cli
