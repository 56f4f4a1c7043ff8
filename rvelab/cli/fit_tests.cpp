#include "rvelab/cli/fit_tests.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <optional>
#include <thread>

#include "rvelab/cli/fit_reach.hpp"
#include "rvelab/cli/interrupt.hpp"
#include "rvelab/cli/progress_line.hpp"
#include "rvelab/cli/warnings.hpp"
#include "rvelab/error.hpp"
#include "rvelab/io/publish.hpp"
#include "rvelab/pack/read_recipe.hpp"
#include "rvelab/pack/search.hpp"

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

/// An assignment as this test takes it: "measured.NAME.key=value" is of the test NAME alone; none: of another one.
std::optional<std::string> own_of(const std::string& assignment, const ComparedTest& compared) {
  if (!assignment.starts_with(of_one_test)) return assignment;
  const std::string own = of_one_test + compared.name + ".";
  return assignment.starts_with(own) ? std::optional(assignment.substr(own.size())) : std::nullopt;
}

/// Assignments of a test for its recipe, or for its protocol.
std::vector<std::string> assignments_of(const FitSetup& setup, const ComparedTest& compared,
                                        const Eigen::VectorXd& values, bool for_recipe) {
  std::vector<std::string> all = setup.settings;
  all.insert(all.end(), compared.settings.begin(), compared.settings.end());
  for (std::size_t k = 0; k < setup.parameters.size(); ++k)
    all.push_back(setup.parameters[k].assignment(values[Eigen::Index(k)]));
  std::vector<std::string> chosen;
  for (const std::string& assignment : all)
    if (const auto own = own_of(assignment, compared); own && of_recipe(*own, setup) == for_recipe)
      chosen.push_back(*own);
  return chosen;
}

/// The specimens of one set of parameters: given, or packed once for each set of assignments.
class Specimens {
 public:
  Specimens(const FitSetup& setup, const FitTest& test) : setup_(setup), test_(test) {}

  const Specimen& of(const ComparedTest& compared) {
    if (setup_.recipe.empty()) return setup_.specimens.at(test_.specimen);
    const std::vector<std::string> assignments = assignments_of(setup_, compared, test_.values, true);
    if (const auto found = packed_.find(assignments); found != packed_.end()) return found->second;
    const pack::RecipeFile file = pack::read_recipe(setup_.recipe, assignments);
    Workers alone(1);
    pack::PackWatch watch;
    watch.stop = &stop_on_signals();
    const auto begin = Clock::now();
    Specimen specimen = pack::pack(file.member(file.recipe.seed + test_.specimen).recipe, alone, watch).specimen;
    seconds_ += std::chrono::duration<double>(Clock::now() - begin).count();
    return packed_.emplace(assignments, std::move(specimen)).first->second;
  }
  double seconds() const { return seconds_; }  ///< for packing

 private:
  const FitSetup& setup_;
  const FitTest& test_;
  std::map<std::vector<std::string>, Specimen> packed_;
  double seconds_ = 0;
};

/// Values of the features of a test, up to the end of its measured curve.
std::vector<double> features_in(const ComparedTest& compared, const records::TestResult& test, int dimension) {
  const bool ends = !compared.curves.empty() && compared.curves.front().abscissa == "strain";
  const double to_strain = ends ? compared.curves.front().x.back() : std::numeric_limits<double>::infinity();
  std::optional<ensemble::TestPath> paths[2];
  std::vector<double> values;
  for (const fit::MeasuredFeature& each : compared.features) {
    const bool over_stress = each.feature.over_stress();
    auto& path = paths[over_stress ? 1 : 0];
    if (!path) path = ensemble::path_of(test, dimension, over_stress, to_strain);
    values.push_back(ensemble::value_of(each.feature, *path));
  }
  return values;
}

/// Runs one test and adds what it gave; false: it was stopped.
bool add_test(const FitSetup& setup, const FitTest& test, const ComparedTest& compared, Specimens& specimens,
              const protocol::Runner& runner, FitResult& result) {
  const Specimen& specimen = specimens.of(compared);
  const int dimension = specimen.cell.dimension;
  const protocol::Protocol protocol = protocol_of(setup, compared, test.values);
  const std::string label =
      "test " + std::to_string(test.number + 1) + (compared.name.empty() ? "" : ", " + compared.name);
  const protocol::TestRun run = protocol::run_protocol(protocol, specimen, runner.watch(test.number, label));
  if (!run.complete) return false;
  result.measures.push_back(ensemble::measured(protocol, run.result, dimension));
  for (const fit::Curve& measured : compared.curves) {
    fit::TestCurve curve = fit::curve_of(run.result, dimension, measured);
    result.curves.push_back(std::move(curve.y));
    result.features.push_back(curve.features);
  }
  result.compared.push_back(features_in(compared, run.result, dimension));
  return true;
}

/// Makes the tests of one set of parameters; none: they were stopped.
std::optional<FitResult> carried_out(const FitSetup& setup, const FitTest& test, const protocol::Runner& runner,
                                     CostNotice* cost) {
  FitResult result;
  Specimens specimens(setup, test);
  const auto begin = Clock::now();
  for (const ComparedTest& compared : setup.tests) {
    if (compared.predict && !test.predicting) continue;
    try {
      if (!add_test(setup, test, compared, specimens, runner, result)) return std::nullopt;
    } catch (const Interrupted&) {
      return std::nullopt;
    } catch (const Error& error) {
      return FitResult{{}, {}, {}, {}, (compared.name.empty() ? "" : compared.name + ": ") + error.what()};
    }
  }
  if (cost != nullptr) cost->took(std::chrono::duration<double>(Clock::now() - begin).count(), specimens.seconds());
  return result;
}

Json numbers(const std::vector<std::vector<double>>& lists) {
  Json rows = Json::array();
  for (const auto& list : lists) rows.push_back(list);
  return rows;
}

std::vector<std::vector<double>> read_numbers(const Json& rows) {
  std::vector<std::vector<double>> lists;
  for (const Json& row : rows) lists.push_back(numbers_in(row));
  return lists;
}

Json features_of(const FitResult& result) {
  Json rows = Json::array();
  for (const fit::Features& each : result.features)
    rows.push_back({each.largest, each.at_largest, each.early, each.last});
  return rows;
}

std::vector<fit::Features> read_features(const Json& rows) {
  std::vector<fit::Features> features;
  for (std::vector<double> row : read_numbers(rows)) {
    row.resize(4, fit::Features::nan());
    features.push_back({row[0], row[1], row[2], row[3]});
  }
  return features;
}

std::string file_of(const std::string& folder, const FitTest& test) {
  const std::string digits = std::to_string(test.number + 1);
  const std::string zeros(digits.size() < 4 ? 4 - digits.size() : 0, '0');
  return (fs::path(folder) / (test.predicting ? "predictions" : "tests") / (zeros + digits + ".json")).string();
}

void keep(const std::string& path, const FitTest& test, const FitResult& result) {
  Json json{{"values", std::vector<double>(test.values.begin(), test.values.end())},
            {"specimen", test.specimen + 1},
            {"measures", numbers(result.measures)},
            {"curves", numbers(result.curves)},
            {"features", features_of(result)},
            {"compared", numbers(result.compared)},
            {"failure", result.failure}};
  io::publish_text(path, json_text(json));
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
      throw InputError(path + ": is of another test; allowed with --resume: the same fit; start again with --force");
    return FitResult{read_numbers(json.at("measures")), read_numbers(json.at("curves")),
                     read_features(json.at("features")), read_numbers(json.value("compared", Json::array())),
                     json.at("failure").get<std::string>()};
  } catch (const Json::exception&) {
    throw InputError(path + ": is damaged; allowed: what `rvelab fit` wrote; remove the file, and go on with --resume");
  }
}

}  // namespace

protocol::Protocol protocol_of(const FitSetup& setup, const ComparedTest& compared, const Eigen::VectorXd& values) {
  return protocol::read_protocol(compared.protocol, assignments_of(setup, compared, values, false));
}

bool FitSetup::has_targets() const {
  return std::any_of(tests.begin(), tests.end(), [](const ComparedTest& test) {
    return !test.targets.empty() || !test.curves.empty() || !test.features.empty();
  });
}
bool FitSetup::has_curves() const {
  return std::any_of(tests.begin(), tests.end(),
                     [](const ComparedTest& test) { return !test.curves.empty() && !test.by_features; });
}

double measure_of(const FitResult& result, std::size_t made, const std::string& measure) {
  const auto& known = ensemble::measures();
  const auto found =
      std::find_if(known.begin(), known.end(), [&](const ensemble::Measure& each) { return each.name == measure; });
  return result.measures.at(made).at(std::size_t(found - known.begin()));
}

void expect_runnable(const FitSetup& setup) {
  const auto count = Eigen::Index(setup.parameters.size());
  for (const bool high : {false, true}) {
    Eigen::VectorXd values(count);
    for (Eigen::Index k = 0; k < count; ++k)
      values[k] = high ? setup.parameters[std::size_t(k)].high : setup.parameters[std::size_t(k)].low;
    for (const ComparedTest& compared : setup.tests) {
      const std::vector<std::string> of_packing = assignments_of(setup, compared, values, true);
      if (setup.recipe.empty() && !of_packing.empty())
        throw InputError(of_packing.front() +
                         " is a key of a recipe; allowed: with --recipe; name one, or vary a key of the "
                         "protocol");
      const protocol::Protocol protocol = protocol_of(setup, compared, values);
      expect_reach(compared, protocol);
      if (!setup.recipe.empty()) warn_of_units(setup.recipe, pack::read_recipe(setup.recipe, of_packing).doubts);
      warn_of_units(compared.protocol, protocol.doubts);
      for (const Specimen& specimen : setup.specimens)
        warn_of_units(compared.protocol, protocol::unusual_in(protocol, specimen));
    }
  }
}

bool FitSetup::has_features() const {
  return std::any_of(tests.begin(), tests.end(), [](const ComparedTest& test) { return !test.features.empty(); });
}
std::size_t FitSetup::fitted_tests() const {
  return std::size_t(std::count_if(tests.begin(), tests.end(), [](const ComparedTest& test) { return !test.predict; }));
}

CostNotice::CostNotice(const FitSetup& setup, std::size_t sets, unsigned threads)
    : setup_(setup),
      sets_(sets),
      lanes_(std::min<std::size_t>(threads > 0 ? threads : std::max(1u, std::thread::hardware_concurrency()), sets)) {}

void CostNotice::took(double seconds, double packing) {
  const std::lock_guard lock(mutex_);
  seconds_ += seconds;
  packing_ += packing;
  if (++made_ != lanes_) return;
  const std::size_t tests = setup_.fitted_tests(), all = setup_.tests.size(),
                    predictions = setup_.predicts ? 2 * setup_.specimen_count : 0;
  const double each = seconds_ / double(lanes_);
  const double rest =
      each * (double(sets_ - lanes_) + double(predictions) * double(all) / double(tests)) / double(lanes_);
  constexpr double worth_saying = 30;  // s
  if (rest < worth_saying) return;
  const auto count = [](std::size_t n, const char* noun) {
    return std::to_string(n) + " " + noun + (n == 1 ? "" : "s");
  };
  tell(count(sets_, "set") + " of parameters x " + count(tests, "test") + ", each on one of " +
       count(setup_.specimen_count, "specimen") +
       (predictions > 0 ? ", then " + count(predictions, "prediction") + " x " + count(all, "test") : "") + ": about " +
       duration_in_words(rest) + " on " + count(lanes_, "thread") + ", since a set took " +
       in_words(std::round(10 * each) / 10) + " s" +
       (setup_.recipe.empty()
            ? ""
            : ", " + in_words(std::round(10 * packing_ / double(lanes_)) / 10) + " s of it for packing") +
       "; to shorten it: --tests, pack.number, target.void_ratio_tolerance");
}

std::vector<FitResult> made(const FitSetup& setup, const std::vector<FitTest>& tests, const std::string& folder,
                            unsigned threads, std::size_t planned, CostNotice* cost) {
  std::vector<std::optional<FitResult>> results(tests.size());
  {
    ProgressLine progress(planned);
    protocol::Runner runner({threads, &stop_on_signals(), &progress}, tests.size());
    for (std::size_t k = 0; k < tests.front().number; ++k) runner.done(k);
    runner.each(tests.size(), [&](std::size_t k) {
      if (!folder.empty()) results[k] = kept(file_of(folder, tests[k]), tests[k]);
      if (!results[k]) {
        results[k] = carried_out(setup, tests[k], runner, cost);
        if (results[k] && !folder.empty()) keep(file_of(folder, tests[k]), tests[k], *results[k]);
      }
      if (results[k]) runner.done(tests[k].number);
    });
  }
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
