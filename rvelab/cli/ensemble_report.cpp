// The summary of an ensemble as JSON, CSV and table. Declared in ensemble.hpp.
#include <cmath>
#include <filesystem>

#include "rvelab/cli/columns.hpp"
#include "rvelab/cli/ensemble.hpp"
#include "rvelab/error.hpp"
#include "rvelab/io/publish.hpp"

namespace rvelab::cli {
namespace {

namespace fs = std::filesystem;
using ensemble::Spread;

/// "p = 20000 Pa", or of all pressures.
std::string at_pressure(double pressure) {
  return std::isnan(pressure) ? "all tests of a specimen together" : "p = " + in_words(pressure) + " Pa";
}

/// "29.1 to 31.2".
std::string interval(double low, double high) {
  if (!std::isfinite(low)) return "-";
  const double reach = 0.5 * (high - low);
  return ensemble::in_digits_of(low, reach) + " to " + ensemble::in_digits_of(high, reach);
}

}  // namespace

Json as_json(const Ensemble& ensemble, const std::vector<ensemble::TestOf>& tests, const ensemble::Summary& summary,
             const std::vector<std::string>& failures) {
  Json json;
  json["protocol"] = ensemble.protocols.front().name;
  json["groups"] = ensemble.names;
  json["tests"] = Json::array();
  for (const ensemble::TestOf& test : tests) {
    Json one{{"specimen", ensemble.files[test.specimen]},
             {"group", ensemble.names[test.group]},
             {"pressure_Pa", test.pressure}};
    for (std::size_t k = 0; k < test.values.size(); ++k)
      if (std::isfinite(test.values[k])) one[ensemble::measures()[k].name] = test.values[k];
    json["tests"].push_back(std::move(one));
  }
  json["summary"] = Json::array();
  for (const ensemble::Row& row : summary.rows) {
    const Spread& spread = row.spread;
    json["summary"].push_back({{"group", ensemble.names[row.group]},
                               {"pressure_Pa", row.pressure},
                               {"measure", row.name},
                               {"unit", row.unit},
                               {"n", spread.n},
                               {"mean", spread.mean},
                               {"standard_deviation", spread.standard_deviation},
                               {"standard_error", spread.standard_error},
                               {"low_95", spread.low},
                               {"high_95", spread.high}});
  }
  json["differences"] = Json::array();
  for (const ensemble::Comparison& each : summary.comparisons) {
    json["differences"].push_back({{"pressure_Pa", each.pressure},
                                   {"measure", each.name},
                                   {"unit", each.unit},
                                   {"difference", each.difference.value},
                                   {"standard_error", each.difference.standard_error},
                                   {"low_95", each.difference.low},
                                   {"high_95", each.difference.high}});
  }
  json["cohesive"] = Json::array();  // of each group: its factors of a footing go with the tangent angle
  for (const calibrate::Cohesive cohesive : summary.cohesive_groups)
    json["cohesive"].push_back(cohesive != calibrate::Cohesive::no);
  json["failures"] = failures;
  return json;
}

std::string as_csv(const Ensemble& ensemble, const ensemble::Summary& summary) {
  std::string text = "group,pressure_Pa,measure,unit,n,mean,standard_deviation,standard_error,low_95,high_95\n";
  for (const ensemble::Row& row : summary.rows) {
    const Spread& spread = row.spread;
    text += csv_cell(ensemble.names[row.group]) + "," + csv_cell(row.pressure) + "," + row.name + "," + row.unit + "," +
            std::to_string(spread.n) + "," + csv_cell(spread.mean) + "," + csv_cell(spread.standard_deviation) + "," +
            csv_cell(spread.standard_error) + "," + csv_cell(spread.low) + "," + csv_cell(spread.high) + "\n";
  }
  for (const ensemble::Comparison& each : summary.comparisons) {
    const ensemble::Difference& difference = each.difference;
    text += "difference," + csv_cell(each.pressure) + "," + each.name + "," + each.unit + ",," +
            csv_cell(difference.value) + ",," + csv_cell(difference.standard_error) + "," + csv_cell(difference.low) +
            "," + csv_cell(difference.high) + "\n";
  }
  return text;
}

std::string as_table(const Ensemble& ensemble, const ensemble::Summary& summary) {
  std::string text = ensemble.protocols.front().name + "\n";
  std::vector<std::vector<std::string>> rows;
  const auto finish = [&] {
    if (!rows.empty()) text += aligned(rows);
    rows.clear();
  };
  const ensemble::Row* before = nullptr;
  for (const ensemble::Row& row : summary.rows) {
    const bool goes_on =
        before != nullptr && before->group == row.group && at_pressure(before->pressure) == at_pressure(row.pressure);
    if (!goes_on) {
      finish();
      text +=
          "\n" + (ensemble.several_groups() ? ensemble.names[row.group] + ", " : "") + at_pressure(row.pressure) + "\n";
      rows.push_back({"measure", "n", "mean +- standard error", "sd", "95 % interval of the mean"});
    }
    const Spread& spread = row.spread;
    rows.push_back({row.name, std::to_string(spread.n), ensemble::with_error(spread.mean, spread.standard_error),
                    two_digits(spread.standard_deviation), interval(spread.low, spread.high)});
    before = &row;
  }
  finish();
  for (std::size_t k = 0; k < summary.cohesive_groups.size(); ++k)
    if (summary.cohesive_groups[k] != calibrate::Cohesive::no)
      text += "\n" + ensemble.names[k] +
              (summary.cohesive_groups[k] == calibrate::Cohesive::by_law
                   ? ": cohesive, the grains stick"
                   : ": cohesive, c is beyond twice its standard error and 5 % of the mean "
                     "stress") +
              "; factors of a footing take the tangent angle (cohesive_friction_angle_deg), not a secant\n";
  if (summary.comparisons.empty()) return text;
  text += "\n" + ensemble.names[0] + " less " + ensemble.names[1] + "\n";
  rows.push_back({"measure", "at", "difference +- standard error", "95 % interval"});
  for (const ensemble::Comparison& each : summary.comparisons) {
    const ensemble::Difference& difference = each.difference;
    rows.push_back({each.name, at_pressure(each.pressure),
                    ensemble::with_error(difference.value, difference.standard_error),
                    interval(difference.low, difference.high)});
  }
  finish();
  return text;
}

void write_summary(const std::string& folder, const Ensemble& ensemble, const std::vector<ensemble::TestOf>& tests,
                   const ensemble::Summary& summary, const std::vector<std::string>& failures) {
  const auto file = [&](const char* name) { return (fs::path(folder) / name).string(); };
  io::publish_text(file("summary.json"), json_text(as_json(ensemble, tests, summary, failures)));
  io::publish_text(file("summary.csv"), as_csv(ensemble, summary));
}

}  // namespace rvelab::cli
