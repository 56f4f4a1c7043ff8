#include "rvelab/cli/fit_tests.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <optional>
#include <thread>

#include "rvelab/cli/doubts.hpp"
#include "rvelab/cli/interrupt.hpp"
#include "rvelab/cli/progress_line.hpp"
#include "rvelab/error.hpp"
#include "rvelab/io/publish.hpp"
#include "rvelab/pack/read_recipe.hpp"
#include "rvelab/pack/search.hpp"
#include "rvelab/protocol/run.hpp"

namespace rvelab::cli {
namespace {

namespace fs = std::filesystem;

/// Whether a key "table.key" goes to the recipe: its own tables, and with a recipe the parameters of its specimens.
bool of_recipe(const std::string& assignment, const FitSetup& setup) {
  const std::string table = assignment.substr(0, assignment.find('.'));
  const auto one_of = [&](std::initializer_list<const char*> tables) {
    return std::any_of(tables.begin(), tables.end(), [&](const char* each) { return table == each; });
  };
  return one_of({"pack", "grains", "target", "preparation"}) ||
         (!setup.recipe.empty() && one_of({"contact", "damping", "solver", "material"}));
}

/// Assignments of a test for its recipe, or for its protocol.
std::vector<std::string> assignments_of(const FitSetup& setup, const Eigen::VectorXd& values, bool for_recipe) {
  std::vector<std::string> chosen;
  for (const std::string& setting : setup.settings)
    if (of_recipe(setting, setup) == for_recipe) chosen.push_back(setting);
  for (std::size_t k = 0; k < setup.parameters.size(); ++k) {
    const std::string assignment = setup.parameters[k].assignment(values[Eigen::Index(k)]);
    if (of_recipe(assignment, setup) == for_recipe) chosen.push_back(assignment);
  }
  return chosen;
}

std::vector<protocol::Protocol> protocols_of(const FitSetup& setup, const Eigen::VectorXd& values) {
  std::vector<protocol::Protocol> protocols;
  for (const double pressure : setup.pressures) {
    std::vector<std::string> assignments = assignments_of(setup, values, false);
    if (pressure > 0) assignments.push_back("test.pressure_Pa=" + io::exact(pressure));
    protocols.push_back(protocol::read_protocol(setup.protocol, assignments));
  }
  return protocols;
}

Specimen specimen_of(const FitSetup& setup, const FitTest& test) {
  if (setup.recipe.empty()) return setup.specimens.at(test.specimen);
  const pack::RecipeFile file = pack::read_recipe(setup.recipe, assignments_of(setup, test.values, true));
  Workers alone(1);
  pack::PackWatch watch;
  watch.stop = &stop_on_signals();
  return pack::pack(file.member(file.recipe.seed + test.specimen).recipe, alone, watch).specimen;
}

/// Makes one test; none: it was stopped.
std::optional<FitResult> carried_out(const FitSetup& setup, const FitTest& test, ProgressLine& progress) {
  FitResult result;
  try {
    const Specimen specimen = specimen_of(setup, test);
    const int dimension = specimen.cell.dimension;
    std::vector<records::TestResult> runs;
    for (const protocol::Protocol& protocol : protocols_of(setup, test.values)) {
      protocol::Watch watch;
      watch.stop = &stop_on_signals();
      watch.on_path_point = [&](const protocol::PathPoint& reached) {
        progress.show(test.number, "test " + std::to_string(test.number + 1), reached);
      };
      const protocol::TestRun run = protocol::run_protocol(protocol, specimen, watch);
      if (!run.complete) return std::nullopt;
      result.measures.push_back(ensemble::measured(protocol, run.result, dimension));
      runs.push_back(run.result);
    }
    for (const MeasuredCurve& measured : setup.curves)
      result.curves.push_back(
          fit::curve_of(runs.at(setup.pressure_number(measured.pressure)), dimension, measured.curve));
  } catch (const Interrupted&) {
    return std::nullopt;
  } catch (const Error& error) {
    result = {{}, {}, error.what()};
  }
  return result;
}

Json numbers(const std::vector<std::vector<double>>& lists) {
  Json rows = Json::array();
  for (const auto& list : lists) rows.push_back(list);
  return rows;
}

std::vector<std::vector<double>> read_numbers(const Json& rows) {
  std::vector<std::vector<double>> lists;
  for (const Json& row : rows) {
    lists.emplace_back();
    for (const Json& value : row)
      lists.back().push_back(value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>());
  }
  return lists;
}

std::string file_of(const std::string& folder, std::size_t number) {
  const std::string digits = std::to_string(number + 1);
  const std::string zeros(digits.size() < 4 ? 4 - digits.size() : 0, '0');
  return (fs::path(folder) / "tests" / (zeros + digits + ".json")).string();
}

void keep(const std::string& path, const FitTest& test, const FitResult& result) {
  Json json{{"values", std::vector<double>(test.values.begin(), test.values.end())},
            {"specimen", test.specimen + 1},
            {"measures", numbers(result.measures)},
            {"curves", numbers(result.curves)},
            {"failure", result.failure}};
  io::publish_text(path, json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
}

/// The result of a test that was made before; none: there is no file. InputError if it is of another test.
std::optional<FitResult> kept(const std::string& path, const FitTest& test) {
  std::ifstream input(path, std::ios::binary);
  if (!input) return std::nullopt;
  try {
    const Json json = Json::parse(input);
    const bool same =
        json.at("values").get<std::vector<double>>() == std::vector<double>(test.values.begin(), test.values.end()) &&
        json.at("specimen").get<std::size_t>() == test.specimen + 1;
    if (!same)
      throw InputError(path + ": is of another test; allowed with --resume: the same fit; start anew with --force");
    return FitResult{read_numbers(json.at("measures")), read_numbers(json.at("curves")),
                     json.at("failure").get<std::string>()};
  } catch (const Json::exception&) {
    throw InputError(path + ": is damaged; allowed: what `rvelab fit` wrote; remove the file, and go on with --resume");
  }
}

}  // namespace

std::size_t FitSetup::pressure_number(double pressure) const {
  return std::size_t(std::find(pressures.begin(), pressures.end(), pressure) - pressures.begin());
}

void expect_runnable(const FitSetup& setup) {
  const auto count = Eigen::Index(setup.parameters.size());
  for (const bool high : {false, true}) {
    Eigen::VectorXd values(count);
    for (Eigen::Index k = 0; k < count; ++k)
      values[k] = high ? setup.parameters[std::size_t(k)].high : setup.parameters[std::size_t(k)].low;
    for (const std::string& assignment : assignments_of(setup, values, true))
      if (setup.recipe.empty())
        throw InputError(assignment +
                         " is a key of a recipe; allowed: with --recipe; name one, or vary a key of the "
                         "protocol");
    const auto protocols = protocols_of(setup, values);
    if (!setup.recipe.empty())
      tell_of_units(setup.recipe, pack::read_recipe(setup.recipe, assignments_of(setup, values, true)).doubts);
    for (const protocol::Protocol& each : protocols) tell_of_units(setup.protocol, each.doubts);
    for (const Specimen& specimen : setup.specimens)
      tell_of_units(setup.protocol, protocol::unusual_in(protocols.front(), specimen));
  }
}

std::vector<FitResult> made(const FitSetup& setup, const std::vector<FitTest>& tests, const std::string& folder,
                            unsigned threads, std::size_t planned) {
  const unsigned cores = std::max(1u, std::thread::hardware_concurrency());
  const unsigned at_a_time = unsigned(std::min<std::size_t>(threads > 0 ? threads : cores, tests.size()));
  std::vector<std::optional<FitResult>> results(tests.size());
  ProgressLine progress(planned);
  for (std::size_t k = 0; k < tests.front().number; ++k) progress.done(k);
  Workers(at_a_time).for_each_in_turn(tests.size(), [&](std::size_t k) {
    if (stop_on_signals().load()) return;
    if (!folder.empty()) results[k] = kept(file_of(folder, tests[k].number), tests[k]);
    if (!results[k]) {
      results[k] = carried_out(setup, tests[k], progress);
      if (results[k] && !folder.empty()) keep(file_of(folder, tests[k].number), tests[k], *results[k]);
    }
    if (results[k]) progress.done(tests[k].number);
  });
  std::vector<FitResult> found;
  for (auto& result : results) {
    if (!result) {
      end_stopped(std::string("; ") +
                  (folder.empty() ? "the tests are not kept without -o" : "continue with --resume"));
    }
    found.push_back(std::move(*result));
  }
  return found;
}

}  // namespace rvelab::cli
