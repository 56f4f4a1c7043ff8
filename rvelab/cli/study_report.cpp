#include "rvelab/cli/study_report.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>

#include "rvelab/cli/columns.hpp"
#include "rvelab/cli/protocol_input.hpp"
#include "rvelab/cli/report.hpp"
#include "rvelab/ensemble/statistics.hpp"
#include "rvelab/error.hpp"
#include "rvelab/io/publish.hpp"
#include "rvelab/io/utf8.hpp"
#include "rvelab/keys/key.hpp"
#include "rvelab/study/measures.hpp"

namespace rvelab::cli {

namespace {

using study::ErrorSummary;
using study::PointSummary;
using study::Study;
using study::StudySummary;

/// A number of a run by its name; the same in JSON and CSV.
using Named = std::vector<std::pair<std::string, Json>>;

void add_errors(Named& row, const ErrorSummary& errors, const std::string& over) {
  row.emplace_back("rms_error_over_" + over, errors.rms);
  row.emplace_back("median_error_over_" + over, errors.median);
  row.emplace_back("percentile_95_error_over_" + over, errors.percentile_95);
  row.emplace_back("largest_error_over_" + over, errors.largest);
}

Named numbers_of(const Study& study, const PointSummary& point) {
  Named row;
  if (study.increments > 0) {
    row.emplace_back("increments", point.increments);
    row.emplace_back("failed_increments", point.failed);
    add_errors(row, point.of_pressure, "p");
    add_errors(row, point.of_increment, "stress_increment");
    row.emplace_back("median_estimate_over_error", point.estimate.median_over_error);
    row.emplace_back("share_of_errors_within_estimate", point.estimate.covered);
    row.emplace_back("share_of_errors_within_allowed", point.estimate.allowed);
    row.emplace_back("processor_s_per_increment", point.seconds);
    row.emplace_back("grain_steps_per_increment", point.grain_steps);
    row.emplace_back("on_front_of_processor_time", point.front_seconds);
    row.emplace_back("on_front_of_grain_steps", point.front_grain_steps);
  }
  if (study.repeats > 0) {
    for (std::size_t k = 0; k < point.means.size(); ++k) {
      row.emplace_back(study::measures()[k].name + "_mean", point.means[k]);
      row.emplace_back(study::measures()[k].name + "_standard_error", point.standard_errors[k]);
    }
    row.emplace_back("failed_paths", point.failed_paths);
    row.emplace_back("processor_s_per_path", point.path_seconds);
    row.emplace_back("grain_steps_per_path", point.path_grain_steps);
  }
  return row;
}

Json json_of(const Study& study, const PointSummary& point) {
  Json json;
  Json values = Json::object();
  for (std::size_t k = 0; k < point.values.size(); ++k) values[study.grid[k].key] = point.values[k];
  json["values"] = values;
  for (const auto& [name, number] : numbers_of(study, point)) json[name] = number;
  if (!point.failure.empty()) json["failure"] = point.failure;
  return json;
}

std::string rounded(double value, int digits = 3) { return in_digits(value, digits); }

std::vector<std::string> name_cells(const Study& study, const PointSummary& point) {
  std::vector<std::string> cells;
  for (const std::string& value : point.values) cells.push_back(io::printable(value));
  if (point.values.empty()) cells.assign(std::max<std::size_t>(study.grid.size(), 1), "");
  if (point.values.empty()) cells[0] = study.grid.empty() ? "protocol" : "reference";
  return cells;
}

/// The varied keys, without their tables if they differ without them.
std::vector<std::string> short_keys(const Study& study) {
  std::vector<std::string> keys, names;
  for (const auto& one : study.grid) {
    keys.push_back(one.key);
    names.push_back(one.key.substr(one.key.rfind('.') + 1));
  }
  const bool apart = std::set(names.begin(), names.end()).size() == names.size();
  return apart ? names : keys;
}

/// Breaks a long name after the underscore nearest to its middle; a short name is the second line.
std::pair<std::string, std::string> on_two_lines(const std::string& name) {
  constexpr std::size_t longest = 15;
  std::size_t best = 0;
  for (std::size_t k = 1; k < name.size(); ++k) {
    const auto off = [&](std::size_t at) { return std::max(at, name.size() - at); };
    if (name[k - 1] == '_' && (best == 0 || off(k) < off(best))) best = k;
  }
  if (name.size() <= longest || best == 0) return {"", name};
  return {name.substr(0, best), name.substr(best)};
}

/// One line a run under a header that begins with the varied keys; `cells` gives the rest.
template <class Cells>
std::string table(const Study& study, const StudySummary& summary, const std::vector<std::string>& header,
                  Cells cells) {
  std::vector<std::string> names = short_keys(study);
  if (study.grid.empty()) names.emplace_back("run");
  names.insert(names.end(), header.begin(), header.end());
  std::vector<std::vector<std::string>> rows(2);
  for (const std::string& name : names) {
    const auto [first, second] = on_two_lines(name);
    rows[0].push_back(first);
    rows[1].push_back(second);
  }
  if (std::all_of(rows[0].begin(), rows[0].end(), [](const auto& name) { return name.empty(); }))
    rows.erase(rows.begin());
  const auto add = [&](const PointSummary& point, bool is_reference) {
    rows.push_back(name_cells(study, point));
    if (is_reference) rows.back()[0] = "reference";
    const std::vector<std::string> rest = cells(point);
    rows.back().insert(rows.back().end(), rest.begin(), rest.end());
  };
  add(summary.reference, true);
  for (const PointSummary& point : summary.points) add(point, false);
  return aligned(rows, std::max<std::size_t>(study.grid.size(), 1), 1000);
}

std::string increments_table(const Study& study, const StudySummary& summary) {
  const auto cost = [](double value, bool front) { return rounded(value) + (front ? "*" : " "); };
  return "Errors of the stress over p, " + std::to_string(summary.reference.increments) +
         " increments; estimate over error, median, and shares of errors within estimate and\n"
         "tolerance; cost of an increment, * on the Pareto front with the median error\n" +
         table(study, summary,
               {"median", "95 %", "rms", "est./err.", "in est.", "in tol.", "processor s", "grain-steps", "failed"},
               [&](const PointSummary& point) {
                 const ErrorSummary& errors = point.of_pressure;
                 return std::vector<std::string>{rounded(errors.median, 2),
                                                 rounded(errors.percentile_95, 2),
                                                 rounded(errors.rms, 2),
                                                 rounded(point.estimate.median_over_error, 2),
                                                 rounded(point.estimate.covered, 2),
                                                 rounded(point.estimate.allowed, 2),
                                                 cost(point.seconds, point.front_seconds),
                                                 cost(point.grain_steps, point.front_grain_steps),
                                                 std::to_string(point.failed)};
               });
}

/// Shows the cost of paths if there are no increments, whose table shows theirs.
std::string paths_table(const Study& study, const StudySummary& summary) {
  std::vector<std::string> header;
  for (const study::Measure& measure : study::measures()) header.push_back(measure.name);
  if (study.increments == 0) header.insert(header.end(), {"processor s", "grain-steps"});
  header.emplace_back("failed");
  return "Whole paths, means of " + std::to_string(study.repeats) +
         (study.repeats == 1 ? " path" : " repeats, with their standard errors") + "\n" +
         table(study, summary, header, [&](const PointSummary& point) {
           std::vector<std::string> cells;
           for (std::size_t k = 0; k < point.means.size(); ++k) {
             cells.push_back(ensemble::with_error(point.means[k], point.standard_errors[k]));
           }
           if (study.increments == 0)
             cells.insert(cells.end(), {rounded(point.path_seconds), rounded(point.path_grain_steps)});
           cells.push_back(std::to_string(point.failed_paths));
           return cells;
         });
}

}  // namespace

Json as_json(const Study& study, const StudySummary& summary) {
  Json json;
  Json vary = Json::array();
  for (const auto& one : study.grid) vary.push_back({{"key", one.key}, {"values", one.values}});
  json["study"] = {{"specimens", study.specimens}, {"settings", study.settings}, {"vary", vary},
                   {"reference", study.reference}, {"repeats", study.repeats},   {"increments", study.increments},
                   {"made_with", study.made_with}};
  Json measures = Json::array();
  for (const study::Measure& measure : study::measures()) {
    measures.push_back({{"name", measure.name}, {"unit", measure.unit}, {"meaning", measure.meaning}});
  }
  json["measures"] = measures;
  json["reference"] = json_of(study, summary.reference);
  json["reference_answers_not_at_rest"] = summary.not_at_rest;
  json["points"] = Json::array();
  for (const PointSummary& point : summary.points) json["points"].push_back(json_of(study, point));
  return json;
}

std::string as_csv(const Study& study, const StudySummary& summary) {
  std::string text = "run";
  for (const auto& one : study.grid) text += "," + csv_cell(one.key);
  for (const auto& [name, number] : numbers_of(study, summary.reference)) text += "," + name;
  text += "\n";
  const auto add = [&](const std::string& run, const PointSummary& point) {
    text += run;
    for (std::size_t k = 0; k < study.grid.size(); ++k)
      text += "," + (point.values.empty() ? "" : csv_cell(point.values[k]));
    for (const auto& [name, number] : numbers_of(study, point)) {
      const bool real = number.is_number_float();
      if (real) text += "," + (std::isnan(number.get<double>()) ? "" : io::exact(number.get<double>()));
      if (number.is_boolean()) text += number.get<bool>() ? ",1" : ",0";
      if (!real && !number.is_boolean()) text += "," + number.dump();
    }
    text += "\n";
  };
  add("reference", summary.reference);
  for (std::size_t k = 0; k < summary.points.size(); ++k) add(std::to_string(k + 1), summary.points[k]);
  return text;
}

std::string as_tables(const Study& study, const StudySummary& summary) {
  std::string text;
  if (study.increments > 0) text += increments_table(study, summary);
  if (study.repeats > 0) text += (text.empty() ? "" : "\n") + paths_table(study, summary);
  return text;
}

namespace fs = std::filesystem;

namespace {

const std::vector<std::string> results{"study.csv", "study.json"};

/// A path as it is called from another folder.
std::string seen_from(const fs::path& folder, const std::string& path) {
  return fs::weakly_canonical(path).lexically_proximate(fs::weakly_canonical(folder)).string();
}

/// InputError unless the folder holds the same study.
void expect_same(const std::string& path, const study::Study& study) {
  const study::Study there = study::read_study(keys::parse_toml_file(path), path);
  const std::string found = study::difference(there, study);
  if (found.empty()) return;
  throw InputError(path + ": is another study: " + found +
                   "; allowed with --resume: the same; give it, or another folder, or start again with --force");
}

}  // namespace

StudyFolder::StudyFolder(const std::string& path, const study::Study& study, io::IfExists existing,
                         const std::vector<std::string>& inputs)
    : path_(path) {
  const std::string own = file("study.toml");
  const bool there = fs::exists(own);
  for (const std::string& name : results) {
    io::expect_output(file(name), existing != io::IfExists::refuse, inputs, ", --resume to go on with a study");
  }
  if (there && existing == io::IfExists::resume) {
    expect_same(own, study);
    return;
  }
  io::expect_output(own, existing == io::IfExists::overwrite, inputs, ", --resume to go on with the study");
  make_folder_without_json(file("pieces"));
  for (const std::string& name : results) fs::remove(file(name));
  study::Study kept = study;
  for (std::string& specimen : kept.specimens) specimen = seen_from(path_, specimen);
  io::publish_text(own, study::written(kept));
}

std::string StudyFolder::file(const std::string& name) const { return (fs::path(path_) / name).string(); }

std::optional<study::Piece> StudyFolder::piece(const std::string& name) const {
  const std::string path = file("pieces/" + name + ".json");
  std::ifstream input(path, std::ios::binary);
  if (!input) return std::nullopt;
  try {
    const Json json = Json::parse(input);
    study::Piece piece;
    piece.failure = json.at("failure").get<std::string>();
    for (const auto& [column, values] : json.at("columns").items()) piece.columns[column] = numbers_in(values);
    return piece;
  } catch (const Json::exception&) {
    throw InputError(path +
                     ": is damaged; allowed: what `rvelab study` wrote; remove the file, and go on with --resume");
  }
}

void StudyFolder::put(const std::string& name, const study::Piece& piece) const {
  Json json;
  json["failure"] = piece.failure;
  json["columns"] = piece.columns;
  io::publish_text(file("pieces/" + name + ".json"), json_text(json));
}

}  // namespace rvelab::cli
