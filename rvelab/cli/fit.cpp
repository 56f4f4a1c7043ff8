// rvelab fit: parameters whose tests give what was measured; without a target a sweep. Declared in command.hpp.
#include <chrono>
#include <filesystem>
#include <memory>

#include "rvelab/cli/command.hpp"
#include "rvelab/cli/fit_input.hpp"
#include "rvelab/cli/fit_report.hpp"
#include "rvelab/cli/fit_tests.hpp"
#include "rvelab/cli/protocol_input.hpp"
#include "rvelab/error.hpp"
#include "rvelab/fit/search.hpp"
#include "rvelab/io/publish.hpp"
#include "rvelab/keys/regular_file.hpp"

namespace rvelab::cli {
namespace {

namespace fs = std::filesystem;

std::string text_of(const std::string& path) { return keys::whole_file<std::string>(path, "a text"); }

/// The tests as their protocols and measured points say.
Json described(const std::vector<ComparedTest>& tests) {
  Json list = Json::array();
  for (const ComparedTest& test : tests) {
    Json one{{"name", test.name},         {"protocol", text_of(test.protocol)},
             {"settings", test.settings}, {"targets", Json::array()},
             {"curves", Json::array()},   {"predict", test.predict}};
    for (const fit::ScalarTarget& target : test.targets)
      one["targets"].push_back({target.measure, target.value, target.error});
    for (const fit::Curve& curve : test.curves)
      one["curves"].push_back({curve.name, curve.abscissa, curve.x, curve.y, curve.error});
    for (const fit::MeasuredFeature& each : test.features)
      one["features"].push_back({each.feature.name, each.value, each.error});
    list.push_back(one);
  }
  return list;
}

/// What a folder was made for, so that --resume goes on with nothing else.
std::string described(const FitArguments& arguments, const FitSetup& setup) {
  Json vary = Json::array();
  for (const fit::Parameter& parameter : setup.parameters)
    vary.push_back({parameter.key, parameter.low, parameter.high, parameter.logarithmic, parameter.grid});
  const Json json{{"settings", setup.settings},
                  {"vary", vary},
                  {"tests", described(setup.tests)},
                  {"specimens", setup.files},
                  {"same_specimens", setup.same_specimens},
                  {"recipe", setup.recipe.empty() ? "" : text_of(setup.recipe)},
                  {"specimen_count", setup.specimen_count},
                  {"batch", arguments.batch.value_or(8)}};
  return json_text(json);
}

void prepare_folder(const FitArguments& arguments, const FitSetup& setup) {
  expect_output_given(arguments.folder, {{"--force", arguments.force}, {"--resume", arguments.resume}}, "folder");
  if (arguments.folder.empty()) return;
  const std::string own = (fs::path(arguments.folder) / "asked.json").string();
  const std::string text = described(arguments, setup);
  if (arguments.resume && fs::exists(own)) {
    if (text_of(own) != text)
      throw InputError(own +
                       ": is of another fit; allowed with --resume: the same options (--tests may grow); give "
                       "them, or another folder, or start again with --force");
    return;
  }
  io::expect_output(own, arguments.force, {}, ", --resume to go on with the fit");
  for (const char* part : {"tests", "predictions"}) {
    if (part == std::string("predictions") && !setup.predicts) continue;
    make_folder_without_json((fs::path(arguments.folder) / part).string());
  }
  io::publish_text(own, text);
}

/// The targets of the search: scalars, then the points of the curves, then features, of the tests that are fitted.
std::vector<fit::Target> targets_of(const FitSetup& setup) {
  std::vector<fit::Target> targets;
  int curves = 0;
  for (const ComparedTest& test : setup.tests) {
    if (test.predict) continue;
    for (const fit::ScalarTarget& each : test.targets) {
      const std::string of = !test.name.empty() ? test.name + ": " : "";
      const std::string at = test.name.empty() && each.pressure > 0 ? "@" + in_words(each.pressure) : "";
      targets.push_back({of + each.measure + at, each.value, each.error, -1});
    }
  }
  for (const ComparedTest& test : setup.tests) {
    if (test.predict || test.by_features) continue;
    for (const fit::Curve& curve : test.curves) {
      const auto points = fit::targets_of(curve, curves++, test.name);
      targets.insert(targets.end(), points.begin(), points.end());
    }
  }
  for (const ComparedTest& test : setup.tests) {
    if (test.predict) continue;
    const auto features = fit::targets_of(test.features, curves, test.name);
    targets.insert(targets.end(), features.begin(), features.end());
  }
  return targets;
}

fit::Answer answer_of(const FitSetup& setup, const FitResult& result) {
  fit::Answer answer;
  if (!result.failure.empty()) return answer;
  std::size_t made = 0;
  for (const ComparedTest& test : setup.tests) {
    if (test.predict) continue;
    for (const fit::ScalarTarget& target : test.targets) answer.push_back(measure_of(result, made, target.measure));
    ++made;
  }
  std::size_t number = 0;  // of the curve, over the tests that were made
  for (const ComparedTest& test : setup.tests) {
    if (test.predict) continue;
    for (std::size_t k = 0; k < test.curves.size(); ++k, ++number) {
      const auto& curve = result.curves.at(number);
      if (!test.by_features) answer.insert(answer.end(), curve.begin(), curve.end());
    }
  }
  for (const auto& features : result.compared) answer.insert(answer.end(), features.begin(), features.end());
  return answer;
}

/// Values of the parameters at a point of their unit cube.
Eigen::VectorXd values_at(const FitSetup& setup, const Eigen::VectorXd& point) {
  Eigen::VectorXd values = point;
  for (Eigen::Index k = 0; k < values.size(); ++k) values[k] = setup.parameters[std::size_t(k)].value(point[k]);
  return values;
}

/// All tests once more, at points of the posterior, on each specimen in turn: twice as many as there are specimens, so
/// that both scatter and parameters are in what they give.
std::vector<FitResult> predictions(const FitArguments& arguments, const FitSetup& setup, const fit::Finding& finding) {
  const std::size_t count = 2 * setup.specimen_count;
  std::vector<FitTest> tests;
  for (std::size_t k = 0; k < count; ++k) {
    const auto row = Eigen::Index(k) * finding.sample.rows() / Eigen::Index(count);
    tests.push_back({k, values_at(setup, finding.sample.row(row).transpose()), k % setup.specimen_count, true});
  }
  return made(setup, tests, arguments.folder, arguments.threads, count);
}

void run_search(const FitArguments& arguments, const FitSetup& setup) {
  const auto begin = std::chrono::steady_clock::now();
  fit::Problem problem;
  problem.parameters = Eigen::Index(setup.parameters.size());
  problem.targets = targets_of(setup);
  problem.specimens = setup.specimen_count;
  problem.same_specimens = setup.same_specimens;
  const bool by_features = setup.has_features() && !setup.has_curves();
  problem.tests = std::size_t(arguments.tests.value_or(
      long(by_features ? fit::usual_tests_of_features(problem.parameters) : fit::usual_tests(problem.parameters))));
  problem.batch = std::size_t(arguments.batch.value_or(8));
  CostNotice cost(setup, problem.tests, arguments.threads);
  FitOutcome outcome;
  outcome.targets = problem.targets;
  outcome.finding = fit::search(problem, [&](const std::vector<fit::Candidate>& candidates) {
    std::vector<FitTest> tests;
    for (const fit::Candidate& candidate : candidates) {
      tests.push_back({candidate.number, values_at(setup, candidate.point), candidate.specimen});
    }
    std::vector<fit::Answer> answers;
    for (FitResult& result : made(setup, tests, arguments.folder, arguments.threads, problem.tests, &cost)) {
      answers.push_back(answer_of(setup, result));
      outcome.results.push_back(std::move(result));
    }
    return answers;
  });
  if (setup.predicts) outcome.predictions = predictions(arguments, setup, outcome.finding);
  outcome.wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  report_fit(setup, outcome, arguments.folder, arguments.json);
}

/// Every combination of the values, on every specimen.
void run_sweep(const FitArguments& arguments, const FitSetup& setup) {
  std::vector<FitTest> tests;
  std::size_t points = 1;
  for (const fit::Parameter& parameter : setup.parameters) points *= std::size_t(parameter.grid);
  for (std::size_t point = 0; point < points; ++point) {
    Eigen::VectorXd values(Eigen::Index(setup.parameters.size()));
    std::size_t rest = point;
    for (std::size_t k = setup.parameters.size(); k-- > 0;) {
      const auto grid = std::size_t(setup.parameters[k].grid);
      values[Eigen::Index(k)] = setup.parameters[k].value(double(rest % grid) / double(grid - 1));
      rest /= grid;
    }
    for (std::size_t specimen = 0; specimen < setup.specimen_count; ++specimen)
      tests.push_back({tests.size(), values, specimen});
  }
  const std::vector<FitResult> results = made(setup, tests, arguments.folder, arguments.threads, tests.size());
  report_sweep(setup, tests, results, arguments.folder, arguments.json);
}

void run_fit(FitArguments arguments) {
  const FitSetup setup = setup_of(arguments);
  prepare_folder(arguments, setup);
  if (!setup.has_targets()) return run_sweep(arguments, setup);
  run_search(arguments, setup);
}

}  // namespace

void add_fit(CLI::App& app) {
  CLI::App& command =
      *app.add_subcommand("fit", "Find parameters whose tests give what was measured; without a target: a sweep");
  const auto arguments = std::make_shared<FitArguments>();
  command
      .add_option("protocol", arguments->what,
                  "PROTOCOL.toml, or the name of an installed test: biaxial;\nor a file of several measured tests "
                  "([fit], [[measured]])")
      ->required();
  command
      .add_option("--vary", arguments->vary,
                  "KEY=low:high, or with :log behind it; up to 8 times;\nKEY=low:high:n without a target: a sweep")
      ->allow_extra_args(false);
  command
      .add_option(
          "--target", arguments->targets,
          "MEASURE=value, =value+-standard error, MEASURE@pressure=value;\nfor example friction_angle_deg=30+-0.5")
      ->allow_extra_args(false);
  command.add_option("--curve", arguments->curves, "measured curve, DATA.csv or DATA.csv@pressure")
      ->allow_extra_args(false);
  command
      .add_option("--column", arguments->columns,
                  "column of it to read, the abscissa first: deviator_kPa, or deviator_kPa=q\nfor one that is called "
                  "q; else all")
      ->allow_extra_args(false);
  command.add_option("--predict", arguments->predict,
                     "of a file of several tests: names of those to predict instead of to fit");
  command.add_option("--specimen", arguments->specimens, "specimens that all tests share, \"S_*.h5\"")
      ->allow_extra_args(false);
  command.add_flag("--same-specimens", arguments->same_specimens,
                   "the targets were measured on these very specimens (their mean), as those of\n"
                   "another code or of a scan; else on others of their kind");
  command.add_option("--recipe", arguments->recipe,
                     "or a recipe: each test packs its own specimen, whose keys may be varied");
  command.add_option("--count", arguments->count, "specimens of the recipe, one a seed; default 5")
      ->check(CLI::Range(1, 1'000'000));
  command
      .add_option("--tests", arguments->tests,
                  "tests to spend; default 24 and 16 for each parameter, 8 where only features are fitted")
      ->check(CLI::Range(8, 100'000));
  command.add_option("--batch", arguments->batch, "tests between two evaluations of the results, default 8")
      ->check(CLI::Range(1, 10'000));
  command.add_option("-o,--output", arguments->folder,
                     "folder for fit.json, fit.csv, curves.csv (sweep.csv) and tests/");
  add_set(command, arguments->settings, "stage.compression.to_strain=0.05");
  add_threads(command, arguments->threads, "tests at a time; default: one per core");
  command.add_flag("--force", arguments->force, "start again in a folder that holds a fit");
  command.add_flag("--resume", arguments->resume, "continue a fit that was stopped, or spend more tests")
      ->excludes("--force");
  add_json(command, arguments->json);
  command.add_option("specimens", arguments->more, "further specimens");
  command.footer(
      "Tests scatter: fit learns the mean of each target as a function of the parameters (Gaussian processes), makes\n"
      "further tests where the parameters are likely, and prints mean and 95 % interval of each parameter, of a prior\n"
      "that is uniform in its range. The interval contains the error of the targets and that of the mean over\n"
      "specimens; use ten specimens or more. Measures: protocols/README.md. Columns of a curve:\n"
      "axial_strain (or _percent), shear_strain, p_kPa first; q_over_p, deviator_kPa (sigma_1 - sigma_3),\n"
      "volumetric_strain, void_ratio; standard errors in NAME_error. Any number of threads gives the same bits.\n"
      "Examples:\n"
      "  rvelab fit biaxial --specimen 'S_*.h5' --target friction_angle_deg=30+-0.5 --vary material.friction=0.1:1 -o "
      "F\n"
      "  rvelab fit triaxial --recipe mine.toml --count 10 --curve data.csv@100e3 -o F \\\n"
      "    --vary material.friction=0.1:1 --vary target.void_ratio=0.6:0.75\n"
      "  rvelab fit biaxial --specimen 'S_*.h5' --vary material.friction=0.1:0.9:5 -o F");
  command.callback([arguments] { run_fit(*arguments); });
}

}  // namespace rvelab::cli
