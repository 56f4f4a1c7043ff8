// rvelab fit: parameters whose tests give what was measured; without a target a sweep. Declared in command.hpp.
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <optional>

#include "rvelab/cli/command.hpp"
#include "rvelab/cli/ensemble.hpp"
#include "rvelab/cli/fit_report.hpp"
#include "rvelab/cli/fit_tests.hpp"
#include "rvelab/cli/protocol_input.hpp"
#include "rvelab/error.hpp"
#include "rvelab/fit/search.hpp"
#include "rvelab/io/hdf5/specimen_file.hpp"
#include "rvelab/io/publish.hpp"

namespace rvelab::cli {
namespace {

namespace fs = std::filesystem;

struct FitArguments {
  std::string protocol;
  std::vector<std::string> specimens, more, settings, vary, targets, curves;
  std::optional<std::string> recipe;
  std::optional<long> count, tests, batch;
  std::string folder;
  unsigned threads = 0;
  bool same_specimens = false, force = false, resume = false, json = false;
};

/// "data.csv@50e3": a file and its pressure.
std::vector<MeasuredCurve> measured_curves(const std::vector<std::string>& words) {
  std::vector<MeasuredCurve> curves;
  for (const std::string& word : words) {
    const auto at = word.rfind('@');
    double pressure = 0;
    if (at != std::string::npos) {
      std::istringstream text(word.substr(at + 1));
      if (!(text >> pressure) || !text.eof() || !(pressure > 0))
        throw InputError("--curve " + word + " has no pressure behind @; allowed: FILE.csv@pressure in Pa");
    }
    for (fit::Curve& curve : fit::read_curves(word.substr(0, at))) curves.push_back({std::move(curve), pressure});
  }
  return curves;
}

void read_specimens(FitSetup& setup, const FitArguments& arguments) {
  auto words = arguments.specimens;
  words.insert(words.end(), arguments.more.begin(), arguments.more.end());
  if (arguments.recipe.has_value() == !words.empty())
    throw InputError(std::string("fit: ") +
                     (words.empty() ? "no specimen is given" : "--recipe and --specimen are both given") +
                     "; allowed: --specimen 'S_*.h5', or --recipe RECIPE with --count; give one of them");
  if (arguments.recipe && arguments.same_specimens)
    throw InputError(
        "--same-specimens is given with --recipe, which packs other specimens; allowed: with --specimen; "
        "leave it out, or give the specimens that were measured");
  setup.same_specimens = arguments.same_specimens;
  if (arguments.recipe) {
    setup.recipe = input_path(*arguments.recipe, InputKind::recipe);
    setup.specimen_count = std::size_t(arguments.count.value_or(5));
    return;
  }
  if (arguments.count) throw InputError("--count is given without --recipe; allowed: with --recipe; leave it out");
  setup.files = files_of(words);
  for (const std::string& file : setup.files) setup.specimens.push_back(io::read_specimen(file));
  setup.specimen_count = setup.specimens.size();
}

FitSetup setup_of(const FitArguments& arguments) {
  FitSetup setup;
  setup.protocol = protocol_path(arguments.protocol);
  setup.settings = arguments.settings;
  for (const std::string& text : arguments.vary) setup.parameters.push_back(fit::parsed_parameter(text));
  for (const std::string& text : arguments.targets) setup.targets.push_back(fit::parsed_target(text));
  setup.curves = measured_curves(arguments.curves);
  if (setup.parameters.empty())
    throw InputError("fit: nothing is varied; allowed: --vary KEY=low:high, up to 8 of them; give one");
  if (setup.parameters.size() > 8) throw InputError("fit: more than 8 keys are varied; allowed: 8; leave some out");
  const bool sweep = setup.targets.empty() && setup.curves.empty();
  if (sweep && arguments.same_specimens)
    throw InputError("--same-specimens is given without a target; allowed: with --target or --curve; leave it out");
  for (const fit::Parameter& parameter : setup.parameters) {
    if (sweep && parameter.grid == 0)
      throw InputError("--vary " + parameter.key +
                       " has no number of values, and no target is given; allowed: "
                       "KEY=low:high:n for a sweep, or --target or --curve for a fit");
    if (!sweep && parameter.grid != 0)
      throw InputError("--vary " + parameter.key +
                       " has a number of values; allowed: without a target only; leave "
                       "it out");
  }
  const auto add_pressure = [&](double pressure) {
    if (setup.pressure_number(pressure) == setup.pressures.size()) setup.pressures.push_back(pressure);
  };
  for (const fit::ScalarTarget& target : setup.targets) add_pressure(target.pressure);
  for (const MeasuredCurve& curve : setup.curves) add_pressure(curve.pressure);
  if (sweep) add_pressure(0);
  read_specimens(setup, arguments);
  expect_runnable(setup);
  return setup;
}

/// What a folder was made for, so that --resume goes on with nothing else.
std::string described(const FitArguments& arguments, const FitSetup& setup) {
  const auto text_of = [](const std::string& path) {
    std::ifstream input(path, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(input), {});
  };
  Json json{{"protocol", text_of(setup.protocol)},
            {"settings", setup.settings},
            {"vary", arguments.vary},
            {"targets", arguments.targets},
            {"curves", arguments.curves},
            {"specimens", setup.files},
            {"recipe", setup.recipe.empty() ? "" : text_of(setup.recipe)},
            {"specimen_count", setup.specimen_count},
            {"batch", arguments.batch.value_or(8)}};
  if (arguments.same_specimens) json["same_specimens"] = true;
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

void prepare_folder(const FitArguments& arguments, const FitSetup& setup) {
  if (arguments.folder.empty()) {
    if (arguments.force || arguments.resume)
      throw InputError(std::string(arguments.force ? "--force" : "--resume") +
                       " is given without -o; allowed: with -o; name the folder");
    return;
  }
  const std::string own = (fs::path(arguments.folder) / "asked.json").string();
  const std::string text = described(arguments, setup);
  if (arguments.resume && fs::exists(own)) {
    std::ifstream input(own, std::ios::binary);
    if (std::string(std::istreambuf_iterator<char>(input), {}) != text)
      throw InputError(own +
                       ": is of another fit; allowed with --resume: the same options (--tests may grow); give "
                       "them, or another folder, or start anew with --force");
    return;
  }
  io::expect_output(own, arguments.force, {}, ", --resume to go on with the fit");
  make_folder((fs::path(arguments.folder) / "tests").string());
  for (const auto& entry : fs::directory_iterator(fs::path(arguments.folder) / "tests"))
    if (entry.path().extension() == ".json") fs::remove(entry.path());
  io::publish_text(own, text);
}

/// The targets of the search: scalars, then the points of the curves.
std::vector<fit::Target> targets_of(const FitSetup& setup) {
  std::vector<fit::Target> targets;
  for (const fit::ScalarTarget& each : setup.targets) {
    std::string name = each.measure;
    if (each.pressure > 0) name += "@" + in_words(each.pressure);
    targets.push_back({name, each.value, each.error, -1});
  }
  for (std::size_t k = 0; k < setup.curves.size(); ++k) {
    const auto points = fit::targets_of(setup.curves[k].curve, int(k));
    targets.insert(targets.end(), points.begin(), points.end());
  }
  return targets;
}

fit::Answer answer_of(const FitSetup& setup, const FitResult& result) {
  fit::Answer answer;
  if (!result.failure.empty()) return answer;
  for (const fit::ScalarTarget& target : setup.targets) {
    for (std::size_t k = 0; k < ensemble::measures().size(); ++k)
      if (ensemble::measures()[k].name == target.measure)
        answer.push_back(result.measures.at(setup.pressure_number(target.pressure)).at(k));
  }
  for (const auto& curve : result.curves) answer.insert(answer.end(), curve.begin(), curve.end());
  return answer;
}

void run_search(const FitArguments& arguments, const FitSetup& setup) {
  const auto begin = std::chrono::steady_clock::now();
  fit::Problem problem;
  problem.parameters = Eigen::Index(setup.parameters.size());
  problem.targets = targets_of(setup);
  problem.specimens = setup.specimen_count;
  problem.same_specimens = setup.same_specimens;
  problem.tests = std::size_t(arguments.tests.value_or(long(fit::usual_tests(problem.parameters))));
  problem.batch = std::size_t(arguments.batch.value_or(8));
  FitOutcome outcome;
  outcome.targets = problem.targets;
  outcome.finding = fit::search(problem, [&](const std::vector<fit::Candidate>& candidates) {
    std::vector<FitTest> tests;
    for (const fit::Candidate& candidate : candidates) {
      FitTest test{candidate.number, candidate.point, candidate.specimen};
      for (Eigen::Index k = 0; k < test.values.size(); ++k)
        test.values[k] = setup.parameters[std::size_t(k)].value(candidate.point[k]);
      tests.push_back(test);
    }
    std::vector<fit::Answer> answers;
    for (FitResult& result : made(setup, tests, arguments.folder, arguments.threads, problem.tests)) {
      answers.push_back(answer_of(setup, result));
      outcome.results.push_back(std::move(result));
    }
    return answers;
  });
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

void run_fit(const FitArguments& arguments) {
  const FitSetup setup = setup_of(arguments);
  prepare_folder(arguments, setup);
  if (setup.targets.empty() && setup.curves.empty()) return run_sweep(arguments, setup);
  run_search(arguments, setup);
}

}  // namespace

void add_fit(CLI::App& app) {
  CLI::App& command =
      *app.add_subcommand("fit", "Find parameters whose tests give what was measured; without a target: a sweep");
  const auto arguments = std::make_shared<FitArguments>();
  command.add_option("protocol", arguments->protocol, "PROTOCOL.toml, or the name of an installed test: biaxial")
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
  command.add_option("--specimen", arguments->specimens, "specimens that all tests share, \"S_*.h5\"")
      ->allow_extra_args(false);
  command.add_flag("--same-specimens", arguments->same_specimens,
                   "the targets were measured on these very specimens (their mean), as those of\n"
                   "another code or of a scan; else on others of their kind");
  command.add_option("--recipe", arguments->recipe,
                     "or a recipe: each test packs its own specimen, whose keys may be varied");
  command.add_option("--count", arguments->count, "specimens of the recipe, one a seed; default 5")
      ->check(CLI::Range(1, 1'000'000));
  command.add_option("--tests", arguments->tests, "tests to spend; default 24 and 16 for each parameter")
      ->check(CLI::Range(8, 100'000));
  command.add_option("--batch", arguments->batch, "tests between two evaluations of the results, default 8")
      ->check(CLI::Range(1, 10'000));
  command.add_option("-o,--output", arguments->folder,
                     "folder for fit.json, fit.csv, curves.csv (sweep.csv) and tests/");
  add_set(command, arguments->settings, "stage.compression.to_strain=0.05");
  add_threads(command, arguments->threads, "tests at a time; default: one per core");
  command.add_flag("--force", arguments->force, "start anew in a folder that holds a fit");
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
