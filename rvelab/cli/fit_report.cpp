#include "rvelab/cli/fit_report.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <optional>

#include "rvelab/cli/columns.hpp"
#include "rvelab/ensemble/statistics.hpp"
#include "rvelab/error.hpp"
#include "rvelab/fit/posterior.hpp"
#include "rvelab/io/publish.hpp"

namespace rvelab::cli {
namespace {

namespace fs = std::filesystem;

/// Mean and quantiles of a sample.
struct Interval {
  double mean, deviation, low, high;
};

Interval interval_of(const Eigen::VectorXd& sample) {
  const double mean = sample.mean();
  const double deviation = std::sqrt((sample.array() - mean).square().mean());
  return {mean, deviation, fit::quantile(sample, 0.025), fit::quantile(sample, 0.975)};
}

Eigen::VectorXd values_of(const fit::Parameter& parameter, const Eigen::VectorXd& points) {
  Eigen::VectorXd values = points;
  for (double& value : values) value = parameter.value(value);
  return values;
}

void publish(const std::string& folder, const char* name, const std::string& text) {
  io::publish_text((fs::path(folder) / name).string(), text);
}

Json json_of(const Interval& found) {
  return {
      {"mean", found.mean}, {"standard_deviation", found.deviation}, {"low_95", found.low}, {"high_95", found.high}};
}

/// Void ratio of the model = intercept + slope (that of the sand), where limits of the recipe are fitted: both stand
/// for the same relative density.
struct DensityMap {
  Interval intercept, slope;
};
std::optional<DensityMap> density_map(const FitSetup& setup, const fit::Finding& finding) {
  const auto limit = [&](const char* key) -> std::optional<Eigen::VectorXd> {
    for (std::size_t k = 0; k < setup.parameters.size(); ++k)
      if (setup.parameters[k].key == std::string("target.") + key)
        return values_of(setup.parameters[k], finding.sample.col(Eigen::Index(k)));
    return std::nullopt;
  };
  const auto e_min = limit("e_min"), e_max = limit("e_max");
  if (!setup.sand || !e_min || !e_max) return std::nullopt;
  const Eigen::VectorXd slope = (*e_max - *e_min) / (setup.sand->e_max - setup.sand->e_min);
  return DensityMap{interval_of(*e_max - slope * setup.sand->e_max), interval_of(slope)};
}

std::vector<std::string> row_of(const std::string& name, const Interval& found) {
  return {name, ensemble::with_error(found.mean, found.deviation),
          ensemble::in_digits_of(found.low, found.deviation) + " to " +
              ensemble::in_digits_of(found.high, found.deviation)};
}

std::string tests_csv(const FitSetup& setup, const FitOutcome& outcome) {
  std::string text = "test,specimen";
  for (const fit::Parameter& parameter : setup.parameters) text += "," + parameter.key;
  for (const fit::Target& target : outcome.targets) text += "," + target.name;
  text += "\n";
  for (std::size_t k = 0; k < outcome.finding.candidates.size(); ++k) {
    const fit::Candidate& candidate = outcome.finding.candidates[k];
    text += std::to_string(k + 1) + "," + std::to_string(candidate.specimen + 1);
    for (std::size_t p = 0; p < setup.parameters.size(); ++p)
      text += "," + csv_cell(setup.parameters[p].value(candidate.point[Eigen::Index(p)]));
    const fit::Answer& answer = outcome.finding.answers[k];
    for (std::size_t t = 0; t < outcome.targets.size(); ++t)
      text += "," + (t < answer.size() ? csv_cell(answer[t]) : "");
    text += "\n";
  }
  return text;
}

std::string curves_csv(const FitSetup& setup, const FitOutcome& outcome) {
  std::string text = "curve,pressure_Pa,quantity,abscissa,x,measured,error,fit,low_95,high_95,test\n";
  Eigen::Index column = 0;
  for (const fit::Target& target : outcome.targets) column += target.curve < 0 ? 1 : 0;  // features stand last
  int number = 0;
  for (const ComparedTest& test : setup.tests) {
    if (test.predict || test.by_features) continue;
    for (const fit::Curve& curve : test.curves) {
      ++number;
      for (std::size_t point = 0; point < curve.x.size(); ++point, ++column) {
        const Interval found = interval_of(outcome.finding.predicted.col(column));
        text += std::to_string(number) + "," + csv_cell(test.pressure) + "," + curve.name + "," + curve.abscissa;
        for (const double value :
             {curve.x[point], curve.y[point], curve.error[point], found.mean, found.low, found.high})
          text += "," + csv_cell(value);
        text += "," + csv_cell(test.name) + "\n";
      }
    }
  }
  return text;
}

Json as_json(const FitSetup& setup, const FitOutcome& outcome) {
  const fit::Finding& finding = outcome.finding;
  Json json{{"measured", Json::array()}, {"parameters", Json::array()}, {"targets", Json::array()}};
  for (const ComparedTest& test : setup.tests)
    json["measured"].push_back({{"name", test.name}, {"protocol", test.protocol}, {"predict", test.predict}});
  for (std::size_t k = 0; k < setup.parameters.size(); ++k) {
    const fit::Parameter& parameter = setup.parameters[k];
    Json one{{"key", parameter.key}, {"range", {parameter.low, parameter.high}}};
    one.update(json_of(interval_of(values_of(parameter, finding.sample.col(Eigen::Index(k))))));
    json["parameters"].push_back(one);
  }
  for (std::size_t k = 0; k < outcome.targets.size(); ++k) {
    const fit::Target& target = outcome.targets[k];
    json["targets"].push_back({{"name", target.name},
                               {"value", target.value},
                               {"standard_error", target.error},
                               {"of_curve", target.curve >= 0 && !target.common},
                               {"fit", json_of(interval_of(finding.predicted.col(Eigen::Index(k))))}});
  }
  if (const auto map = density_map(setup, finding))
    json["density_map"] = {{"intercept", json_of(map->intercept)}, {"slope", json_of(map->slope)}};
  json["misfit"] = finding.misfit;
  json["widening"] = finding.widening;
  json["specimens"] = setup.specimen_count;
  json["same_specimens"] = setup.same_specimens;
  json["tests"] = Json::array();
  for (std::size_t k = 0; k < finding.candidates.size(); ++k) {
    Json one{{"specimen", finding.candidates[k].specimen + 1}, {"values", Json::object()}};
    for (std::size_t p = 0; p < setup.parameters.size(); ++p)
      one["values"][setup.parameters[p].key] = setup.parameters[p].value(finding.candidates[k].point[Eigen::Index(p)]);
    one["targets"] = finding.answers[k];
    if (!outcome.results[k].failure.empty()) one["failure"] = outcome.results[k].failure;
    json["tests"].push_back(one);
  }
  Json sample = Json::object();
  for (std::size_t p = 0; p < setup.parameters.size(); ++p) {
    const Eigen::VectorXd values = values_of(setup.parameters[p], finding.sample.col(Eigen::Index(p)));
    sample[setup.parameters[p].key] = std::vector<double>(values.begin(), values.end());
  }
  json["posterior_sample"] = sample;
  if (!outcome.predictions.empty()) {
    json["predictions"] = predictions_json(setup, outcome.predictions);
    if (setup.has_features()) json["features"] = features_json(setup, outcome.predictions);
  }
  return json;
}

std::string as_text(const FitSetup& setup, const FitOutcome& outcome) {
  const fit::Finding& finding = outcome.finding;
  std::vector<std::vector<std::string>> rows{{"parameter", "mean +- sd", "95 % interval", "range"}};
  for (std::size_t k = 0; k < setup.parameters.size(); ++k) {
    const fit::Parameter& parameter = setup.parameters[k];
    rows.push_back(row_of(parameter.key, interval_of(values_of(parameter, finding.sample.col(Eigen::Index(k))))));
    rows.back().push_back(in_words(parameter.low) + " to " + in_words(parameter.high));
  }
  std::string text = aligned(rows) + "\n";
  if (const auto map = density_map(setup, finding))
    text += "density map: void ratio of the model = a + b (that of the sand)\n" +
            aligned({{"", "mean +- sd", "95 % interval"}, row_of("a", map->intercept), row_of("b", map->slope)}) + "\n";
  rows = {{"target", "measured", "fit: mean +- sd"}};
  for (std::size_t k = 0; k < outcome.targets.size(); ++k) {
    const fit::Target& target = outcome.targets[k];
    if (setup.predicts && target.curve >= 0) continue;  // in curves.csv; the tests as a whole are compared below
    const Interval found = interval_of(finding.predicted.col(Eigen::Index(k)));
    rows.push_back({target.name, ensemble::with_error(target.value, target.error),
                    ensemble::with_error(found.mean, found.deviation)});
  }
  if (rows.size() == 1) text.pop_back();
  return rows.size() > 1 ? text + aligned(rows) : text;
}

void warn_fit(const FitSetup& setup, const FitOutcome& outcome, std::size_t failed) {
  if (setup.specimen_count == 1 && !setup.same_specimens)
    tell(
        "one specimen: how much others differ is assumed, a third of how much the tests differ; give ten, or "
        "--same-specimens if the targets were measured on this one");
  if (outcome.finding.misfit > 2)
    tell("the best parameters in their ranges miss the targets by " +
         ensemble::with_error(outcome.finding.misfit, std::nan("")) +
         " standard deviations; widen the ranges, vary another key, or give the targets a standard error");
  std::size_t incomplete = 0;
  for (const fit::Answer& answer : outcome.finding.answers)
    if (std::any_of(answer.begin(), answer.end(), [](double value) { return !std::isfinite(value); })) ++incomplete;
  if (incomplete > 0)
    tell(std::to_string(incomplete) + " of " + std::to_string(outcome.results.size()) +
         " sets of parameters did not give every target, and were left out" +
         fit::most_often_missing(outcome.targets, outcome.finding.answers));
  if (failed == 0) return;
  const auto first = std::find_if(outcome.results.begin(), outcome.results.end(),
                                  [](const FitResult& result) { return !result.failure.empty(); });
  tell(std::to_string(failed) + " of " + std::to_string(outcome.results.size()) +
       " tests could not be carried out, the first: " + first->failure);
}

}  // namespace

void report_fit(const FitSetup& setup, const FitOutcome& outcome, const std::string& folder, bool json) {
  const auto failed = std::size_t(std::count_if(outcome.results.begin(), outcome.results.end(),
                                                [](const FitResult& result) { return !result.failure.empty(); }));
  const std::string object = json_text(as_json(setup, outcome));
  if (!folder.empty()) {
    publish(folder, "fit.json", object);
    publish(folder, "fit.csv", tests_csv(setup, outcome));
    if (setup.has_curves()) publish(folder, "curves.csv", curves_csv(setup, outcome));
    if (setup.predicts) publish(folder, "predictions.csv", predictions_csv(setup, outcome.predictions));
    if (setup.predicts && setup.has_features())
      publish(folder, "features.csv", features_csv(setup, outcome.predictions));
  }
  if (json) {
    std::cout << object << std::flush;
  } else {
    std::cout << as_text(setup, outcome) << predictions_text(setup, outcome.predictions)
              << features_text(setup, outcome.predictions) << "\ntests   " << outcome.results.size() << " on "
              << setup.specimen_count << " specimens" << (failed > 0 ? ", " + std::to_string(failed) + " failed" : "")
              << "\nwall_s  " << in_words(outcome.wall_seconds) << "\n";
    if (!folder.empty())
      std::cout << "files   " << folder << "/fit.json, fit.csv" << (setup.has_curves() ? ", curves.csv" : "")
                << (setup.predicts ? ", predictions.csv" : "")
                << (setup.predicts && setup.has_features() ? ", features.csv" : "")
                << "\nfigure  /usr/bin/python3 tools/plot/fit.py " << folder << " -o fit.png\n";
    std::cout << std::flush;
  }
  warn_fit(setup, outcome, failed);
}

void report_sweep(const FitSetup& setup, const std::vector<FitTest>& tests, const std::vector<FitResult>& results,
                  const std::string& folder, bool json) {
  const auto& measures = ensemble::measures();
  // Spreads at each point, and the measures that any test gives.
  std::vector<Eigen::VectorXd> points;
  std::vector<std::vector<ensemble::Spread>> spreads;
  std::vector<bool> given(measures.size(), false);
  for (std::size_t begin = 0; begin < tests.size(); begin += setup.specimen_count) {
    points.push_back(tests[begin].values);
    spreads.emplace_back();
    for (std::size_t m = 0; m < measures.size(); ++m) {
      std::vector<double> values;
      for (std::size_t k = begin; k < begin + setup.specimen_count; ++k)
        if (results[k].failure.empty()) values.push_back(results[k].measures.front().at(m));
      spreads.back().push_back(ensemble::spread_of(values));
      given[m] = given[m] || spreads.back().back().n > 0;
    }
  }
  std::string csv;
  std::vector<std::vector<std::string>> rows(1);
  Json list = Json::array();
  for (const fit::Parameter& parameter : setup.parameters) {
    csv += (csv.empty() ? "" : ",") + parameter.key;
    rows[0].push_back(parameter.key.substr(parameter.key.rfind('.') + 1));
  }
  for (std::size_t m = 0; m < measures.size(); ++m) {
    if (!given[m]) continue;
    csv += "," + measures[m].name + "," + measures[m].name + "_standard_error," + measures[m].name + "_n";
    rows[0].push_back(measures[m].name);
  }
  csv += "\n";
  for (std::size_t point = 0; point < points.size(); ++point) {
    rows.emplace_back();
    Json one = Json::object();
    std::string line;
    for (std::size_t p = 0; p < setup.parameters.size(); ++p) {
      const double value = points[point][Eigen::Index(p)];
      line += (line.empty() ? "" : ",") + csv_cell(value);
      rows.back().push_back(in_words(value));
      one[setup.parameters[p].key] = value;
    }
    for (std::size_t m = 0; m < measures.size(); ++m) {
      if (!given[m]) continue;
      const ensemble::Spread& spread = spreads[point][m];
      line += "," + csv_cell(spread.mean) + "," + csv_cell(spread.standard_error) + "," + std::to_string(spread.n);
      rows.back().push_back(ensemble::with_error(spread.mean, spread.standard_error));
      one[measures[m].name] = {{"mean", spread.mean}, {"standard_error", spread.standard_error}, {"n", spread.n}};
    }
    csv += line + "\n";
    list.push_back(one);
  }
  if (!folder.empty()) publish(folder, "sweep.csv", csv);
  if (json)
    std::cout << json_text(Json{{"sweep", list}}) << std::flush;
  else
    std::cout << aligned(rows, 1000, 150) << (folder.empty() ? "" : "file  " + folder + "/sweep.csv\n") << std::flush;
  const auto failed =
      std::find_if(results.begin(), results.end(), [](const auto& each) { return !each.failure.empty(); });
  if (failed != results.end()) tell("a test could not be carried out, the first: " + failed->failure);
}

}  // namespace rvelab::cli
