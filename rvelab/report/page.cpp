#include "rvelab/report/page.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>

#include "rvelab/error.hpp"
#include "rvelab/io/hdf5/specimen_file.hpp"
#include "rvelab/io/version.hpp"
#include "rvelab/report/mpm_run.hpp"
#include "rvelab/report/states.hpp"
#include "rvelab/report/tables.hpp"
#include "rvelab/report/template.hpp"
#include "rvelab/report/words.hpp"

namespace rvelab::report {
namespace {

namespace fs = std::filesystem;
using ensemble::Spread;

struct Inputs {
  struct File {
    std::string path, group;
    bool named;  ///< given directly, not by its folder
  };
  std::vector<File> records;
  std::vector<std::string> runs;  ///< folders of rvelab-mpm
};

std::string name_of(const fs::path& folder) {
  const fs::path whole = fs::absolute(folder).lexically_normal();
  return (whole.filename().empty() ? whole.parent_path() : whole).filename().string();
}

Inputs sorted_inputs(const std::vector<std::string>& inputs) {
  Inputs found;
  for (const std::string& input : inputs) {
    if (!fs::exists(input) && !fs::exists(input + ".journal"))
      throw InputError(input +
                       ": is not there; give record files that rvelab run -o or calibrate -o wrote, their folder, "
                       "or a folder of rvelab-mpm");
    if (!fs::is_directory(input)) {
      found.records.push_back({input, name_of(fs::absolute(input).parent_path()), true});
      continue;
    }
    if (is_mpm_run(input)) {
      found.runs.push_back(input);
      continue;
    }
    std::vector<std::string> here;
    for (const auto& entry : fs::directory_iterator(input))
      if (entry.path().extension() == ".h5") here.push_back(entry.path().string());
    if (here.empty())
      throw InputError(input +
                       ": has no *.h5, nor history.csv and points_*.h5 of rvelab-mpm; give a folder that rvelab "
                       "run -o, calibrate -o or rvelab-mpm -o wrote");
    std::sort(here.begin(), here.end());
    for (const std::string& path : here) found.records.push_back({path, name_of(input), false});
  }
  return found;
}

/// Whether a file contains only a specimen, which is allowed beside the records of a folder.
bool is_specimen(const std::string& path) { return fs::exists(path) && io::file_kind(path) == io::FileKind::specimen; }

Json as_json(const std::vector<Column>& columns) {
  Json list = Json::array();
  for (const Column& column : columns) {
    Json each{{"key", column.key},
              {"label", column.label},
              {"unit", column.unit},
              {"meaning", column.meaning},
              {"values", numbers(column.values)}};
    if (!column.errors.empty()) each["errors"] = numbers(column.errors);
    list.push_back(std::move(each));
  }
  return list;
}

/// Quantities of x and y of each chart.
using Curves = std::vector<std::array<std::string, 2>>;

/// Axes of the first curves, by the kind of the last stage.
Curves curves_of(const Test& test) {
  const auto last = calibrate::last_stage(test.recorded.result);
  const protocol::Stage& stage = test.protocol.stages.at(std::size_t(last.front().stage));
  const bool cyclic = !test.recorded.result.axis.empty() && [&] {
    int turns = 0;
    for (std::size_t k = 2; k < last.size(); ++k)
      turns += (last[k].strain - last[k - 1].strain) * (last[k - 1].strain - last[k - 2].strain) < 0 ? 1 : 0;
    return turns > 0;
  }();
  const std::string axis = test.recorded.result.axis;
  const std::string shear = axis.size() == 2 ? "sigma_" + axis : "q";
  if (stage.kind == "isotropic" || stage.kind == "pressure_path")
    return {{"p", "void_ratio"}, {"total_volumetric", "p"}};
  if (test.protocol.name.find("oedometer") != std::string::npos) return {{"p", "void_ratio"}, {"strain", "q_over_p"}};
  if (stage.kind == "envelope") return {{"sigma_xx", "sigma_yy"}, {"record", "q"}};
  if (cyclic) return {{"strain", shear}, {"p", shear}};
  const double volume = std::abs(1 - last.back().deformation_gradient.determinant());
  if (volume < 1e-6) return {{"strain", "q_over_p"}, {"p", "q"}};
  return {{"strain", "q_over_p"}, {"strain", "volumetric_strain"}};
}

/// These, and one for each recorded kind of interaction: bonds, bridges of water, adhesive pairs.
Curves with_interactions(Curves curves, const std::vector<Column>& columns) {
  for (const std::string key : {"bonds", "bridges", "adhesive_pairs"})
    if (std::any_of(columns.begin(), columns.end(), [&](const Column& column) { return column.key == key; }))
      curves.push_back({curves.front()[0] == "strain" ? "strain" : "record", key});
  return curves;
}

Json run_of(const Test& test, std::size_t kind, std::size_t every) {
  Json run{{"file", test.file}, {"kind", kind}, {"dimension", test.dimension}, {"complete", test.recorded.complete}};
  Json stages = Json::array();
  for (const records::Record& record : test.records()) stages.push_back(record.stage);
  run["stage"] = std::move(stages);
  run["columns"] = as_json(columns_of(test));
  run["found"] = test.recorded.snapshots.size();
  run["states"] = states_of(test, chosen_states(test, every));
  return run;
}

const Spread* spread_of(const Results& results, std::size_t set, const std::string& name) {
  for (const ensemble::Row& row : results.summary.rows)
    if (row.group == set && std::isnan(row.pressure) && row.name == name) return &row.spread;
  return nullptr;
}

/// Mean angle at large strain over all tests of the set; NaN if one ends before.
double large_strain_angle(const std::vector<Test>& tests, const std::vector<Kind>& kinds, std::size_t set) {
  std::size_t place = 0;
  while (ensemble::measures()[place].name != "large_strain_friction_angle_deg") ++place;
  double sum = 0;
  int n = 0;
  for (const Kind& kind : kinds)
    if (kind.set == set)
      for (const std::size_t k : kind.of) sum += tests[k].measured[place], ++n;
  return sum / n;
}

std::string angle_in_words(const Spread& spread) {
  return with_its_error(spread.mean, spread.standard_error) + " degrees";
}

/// Mohr circles of the peaks and the friction angle of each set of tests: circles, angle, cohesion, interval, and a
/// sentence with these values. The angle is the mean over the specimens of the angle that rvelab run prints.
Json strength_of(const std::vector<Test>& tests, const std::vector<Kind>& kinds, const Results& results) {
  Json sets = Json::array();
  const std::vector<std::string> names = names_of_sets(kinds);
  for (std::size_t set = 0; set < names.size(); ++set) {
    const bool cohesive = results.summary.cohesive_groups.at(set) != calibrate::Cohesive::no;
    const Spread* angle =
        spread_of(results, set, cohesive ? "cohesive_friction_angle_deg" : "secant_friction_angle_deg");
    if (angle == nullptr) continue;
    const Spread* cohesion = cohesive ? spread_of(results, set, "cohesion_Pa") : nullptr;
    std::size_t rising = 0, count = 0;
    Json circles = Json::array();
    for (std::size_t k = 0; k < kinds.size(); ++k) {
      if (kinds[k].set != set) continue;
      Json each = Json::array();
      for (const std::size_t row : kinds[k].of) {
        const Test& test = tests[row];
        if (!std::isfinite(test.strength.major)) continue;
        ++count;
        const auto last = calibrate::last_stage(test.recorded.result);
        rising += calibrate::rising_at_end(last, calibrate::peak(last, test.dimension)) &&
                          std::abs(last.back().strain) < 0.15 - 1e-9
                      ? 1
                      : 0;
        each.push_back({number(test.strength.s() / 1e3), number(test.strength.t() / 1e3)});
      }
      if (!each.empty()) circles.push_back({{"kind", k}, {"states", std::move(each)}});
    }
    std::string words =
        (names[set].empty() ? "F" : names[set] + ": f") + std::string("riction angle ") + angle_in_words(*angle);
    if (angle->n > 1)
      words += ", mean and standard error of " + counted(angle->n, "specimen") +
               (angle->n < 3 ? "" : " (95 % interval of the mean " + interval_in_words(angle->low, angle->high) + ")");
    if (cohesion != nullptr)
      words += ", the tangent of a cohesive soil with c = " +
               with_its_error(cohesion->mean / 1e3, cohesion->standard_error / 1e3) + " kPa";
    else
      words += ", a secant through the origin at the largest \u03c3\u2081 \u2212 \u03c3\u2083";
    const double large = large_strain_angle(tests, kinds, set);
    if (std::isfinite(large)) words += "; at large strain " + in_three_digits(large) + " degrees";
    words += ".";
    if (rising > 0)
      words += " " + std::to_string(rising) + " of " + counted(count, "test") +
               " still rose at the end: the angle is a lower bound; run further (to_strain), to 15 % at most.";
    sets.push_back({{"name", names[set]},
                    {"set", set},
                    {"circles", std::move(circles)},
                    {"angle", number(angle->mean)},
                    {"low", number(angle->mean - angle->standard_error)},
                    {"high", number(angle->mean + angle->standard_error)},
                    {"text", angle_in_words(*angle)},
                    {"cohesion_kPa", number(cohesion != nullptr ? cohesion->mean / 1e3 : 0)},
                    {"large_strain", number(large)},
                    {"words", words}});
  }
  return sets;
}

Json section_of(const std::string& name, const std::vector<Test>& tests, std::size_t every, Page& page) {
  const std::vector<Kind> kinds = kinds_of(tests);
  const Results results = results_of(tests, kinds);
  Json section{{"name", name}, {"kind", "test"}, {"dimension", tests.front().dimension}};
  section["stages"] = tests.front().recorded.result.stages;
  section["last_stage"] = calibrate::last_stage(tests.front().recorded.result).front().stage;
  section["curves"] = with_interactions(curves_of(tests.front()), columns_of(tests.front()));
  section["kinds"] = Json::array();
  for (const Kind& kind : kinds)
    section["kinds"].push_back(
        {{"label", kind.label}, {"set", kind.set}, {"pressure_kPa", number(kind.pressure / 1e3)}});
  section["runs"] = Json::array();
  for (std::size_t k = 0; k < kinds.size(); ++k)
    for (const std::size_t row : kinds[k].of) {
      section["runs"].push_back(run_of(tests[row], k, every));
      page.states += section["runs"].back()["states"]["states"].size();
    }
  section["strength"] = strength_of(tests, kinds, results);
  section["asked"] = asked_of(tests, kinds);
  section["specimen"] = specimen_of(tests.front());
  section["protocol"] = tests.front().recorded.provenance.protocol;
  section["means"] = results.means;
  section["differences"] = results.differences;
  section["loops"] = loops_of(tests);
  section["errors"] = errors_of(tests);
  section["errors_in_words"] = errors_in_words(tests);
  return section;
}

}  // namespace

std::vector<std::string> files_of(const std::vector<std::string>& inputs) {
  std::vector<std::string> files;
  for (const Inputs::File& file : sorted_inputs(inputs).records) files.push_back(file.path);
  return files;
}

Page page_of(const std::vector<std::string>& inputs, const PageOptions& options) {
  const Inputs found = sorted_inputs(inputs);
  Page page;
  std::map<std::string, std::vector<Test>> tests;
  std::vector<std::string> order;
  double bytes = 0;
  for (const auto& [path, group, named] : found.records) {
    if (!named && is_specimen(path)) continue;
    std::optional<Test> read = read_test(path, group);
    if (!read) {
      page.remarks.push_back("left out: " + path + " holds no record");
      continue;
    }
    Test& test = *read;
    bytes += bytes_of_states(test);
    const std::string name = test.recorded.result.protocol + ", " + std::to_string(test.dimension) + "D";
    if (!tests.contains(name)) order.push_back(name);
    tests[name].push_back(std::move(test));
  }
  const auto every = std::max<std::size_t>(1, std::size_t(std::ceil(bytes / options.largest_states)));
  if (order.empty() && found.runs.empty())
    throw InputError(found.records.front().path + (found.records.size() > 1 ? " and the others hold" : ": holds") +
                     " no record; give tests that have made one (a test of probes alone makes none)");
  if (every > 1)
    page.remarks.push_back("one of " + std::to_string(every) + " states that the tests kept is in the page, " +
                           in_three_digits(options.largest_states / 1e6) + " MB of states; --states-MB raises that");
  Json data{{"version", std::string(io::version)}, {"every", every}, {"sections", Json::array()}};
  for (const std::string& name : order) {
    std::vector<Test>& own = tests[name];
    std::stable_sort(own.begin(), own.end(), [](const Test& one, const Test& other) {
      return std::round(one.pressure / 10) < std::round(other.pressure / 10);
    });
    data["sections"].push_back(section_of(name, own, every, page));
    page.tests += own.size();
  }
  for (const std::string& folder : found.runs) {
    MpmRun run = read_mpm_run(folder, options.largest_states / double(found.runs.size()));
    const std::string name = run.json["file"];
    order.push_back(name);
    page.states += run.states;
    ++page.mpm_runs;
    Json section{{"name", name},
                 {"kind", "mpm"},
                 {"dimension", run.json["dimension"]},
                 {"curves", Curves{{"time_s", "kinetic_J"}, {"time_s", "potential_J"}}},
                 {"kinds", Json::array({Json{{"label", name}, {"set", 0}}})}};
    run.json["kind"] = 0;
    section["runs"].push_back(std::move(run.json));
    data["sections"].push_back(std::move(section));
  }
  std::string title = options.title;
  if (title.empty()) {
    for (std::size_t k = 0; k < order.size() && order.size() < 4; ++k) title += (k > 0 ? "; " : "") + order[k];
    title = "Laboratory report" + (title.empty() ? "" : ": " + title);
  }
  data["title"] = title;
  page.html = filled(page_template(), title, data);
  return page;
}

}  // namespace rvelab::report
