// What was measured beside what the parameters of a fit give. Declared in fit_report.hpp.
#include <array>
#include <cmath>

#include "rvelab/cli/columns.hpp"
#include "rvelab/cli/fit_report.hpp"
#include "rvelab/ensemble/statistics.hpp"
#include "rvelab/error.hpp"

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

/// A measured value beside the predictions.
struct ComparedValue {
  const ComparedTest& test;
  const fit::ScalarTarget& measured;
  ensemble::Spread found;
  double percent() const { return 100 * std::abs(found.mean - measured.value) / std::abs(measured.value); }
  double errors() const {
    return std::abs(found.mean - measured.value) / std::hypot(measured.error, found.standard_deviation);
  }
};

std::vector<ComparedValue> compared_values(const FitSetup& setup, const std::vector<FitResult>& predictions) {
  std::vector<ComparedValue> all;
  for (std::size_t number = 0; number < setup.tests.size(); ++number)
    for (const fit::ScalarTarget& target : setup.tests[number].targets)
      all.push_back({setup.tests[number], target, spread_over(predictions, [&](const FitResult& r) {
                       return measure_of(r, number, target.measure);
                     })});
  return all;
}

/// " (3 of 8)" where the others do not reach a measure: cycles to an end that did not come.
std::string of_all(std::size_t n, std::size_t all) {
  return n == all ? "" : " (" + std::to_string(n) + " of " + std::to_string(all) + ")";
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
      rows.back().push_back(ensemble::with_error(each.features[f].mean, each.features[f].standard_deviation));
    }
  }
  for (const ComparedValue& each : compared_values(setup, predictions))
    rows.push_back({each.test.name, role(each.test), each.measured.measure, two_digits(each.percent()),
                    two_digits(each.errors()), in_digits(each.measured.value, 3),
                    ensemble::with_error(each.found.mean, each.found.standard_deviation) +
                        of_all(each.found.n, predictions.size()),
                    "", "", "", "", "", ""});
  return "\n" + aligned(rows, 3, 150);
}

std::string predictions_csv(const FitSetup& setup, const std::vector<FitResult>& predictions) {
  std::string text = "test,predicted,quantity,abscissa,x,measured,error,mean,standard_deviation,n\n";
  for (const ComparedCurve& each : compared(setup, predictions))
    for (std::size_t k = 0; k < each.points.size(); ++k) {
      text += csv_cell(each.test.name) + "," + (each.test.predict ? "1" : "0") + "," + each.measured.name + "," +
              each.measured.abscissa;
      for (const double value : {each.measured.x[k], each.measured.y[k], each.measured.error[k], each.points[k].mean,
                                 each.points[k].standard_deviation})
        text += "," + csv_cell(value);
      text += "," + std::to_string(each.points[k].n) + "\n";
    }
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
    list.push_back({{"test", each.test.name},
                    {"predicted", each.test.predict},
                    {"measure", each.measured.measure},
                    {"off_percent", each.percent()},
                    {"off_standard_errors", each.errors()},
                    {"measured", each.measured.value},
                    {"mean", each.found.mean},
                    {"standard_deviation", each.found.standard_deviation},
                    {"n", each.found.n}});
  return list;
}

}  // namespace rvelab::cli
