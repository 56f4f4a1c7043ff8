#include "rvelab/cli/fit_input.hpp"

#include <algorithm>
#include <filesystem>
#include <set>
#include <sstream>

#include "rvelab/cli/ensemble.hpp"
#include "rvelab/cli/fit_features.hpp"
#include "rvelab/cli/protocol_input.hpp"
#include "rvelab/error.hpp"
#include "rvelab/fit/soil_file.hpp"
#include "rvelab/io/hdf5/specimen_file.hpp"
#include "rvelab/keys/key.hpp"

namespace rvelab::cli {
namespace {

namespace fs = std::filesystem;

/// Gives curves without standard errors those of a laboratory, unless they are of the very specimens.
void assume_errors(FitSetup& setup) {
  std::set<std::string> told;
  for (ComparedTest& test : setup.tests) {
    for (fit::Curve& curve : test.curves) {
      const bool exact = std::all_of(curve.error.begin(), curve.error.end(), [](double error) { return error == 0; });
      if (!exact || setup.same_specimens) continue;
      fit::assume_scatter(curve);
      if (test.by_features || !told.insert(curve.name).second) continue;
      tell(curve.name + " has no standard error" + (test.name.empty() ? "" : " in " + test.name) +
           "; that of repeated tests is assumed, " + fit::laboratory_scatter(curve.name) +
           "; a column with _error behind its name gives it");
    }
  }
}

/// "data.csv@50e3": a file and its pressure.
struct NamedCurve {
  std::string path;
  double pressure = 0;
};
NamedCurve named_curve(const std::string& word) {
  const auto at = word.rfind('@');
  NamedCurve named{word.substr(0, at)};
  if (at == std::string::npos) return named;
  std::istringstream text(word.substr(at + 1));
  if (!(text >> named.pressure) || !text.eof() || !(named.pressure > 0))
    throw InputError("--curve " + word + " has no pressure behind @; allowed: FILE.csv@pressure in Pa");
  return named;
}

void read_specimens(FitSetup& setup, const FitArguments& arguments) {
  const bool named = !arguments.specimens.empty() || !arguments.more.empty();
  if (arguments.recipe.has_value() == named)
    throw InputError(std::string("fit: ") +
                     (!named ? "no specimen is given" : "--recipe and --specimen are both given") +
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
  setup.files = files_of(arguments.specimens, arguments.more);
  for (const std::string& file : setup.files) setup.specimens.push_back(io::read_specimen(file));
  setup.specimen_count = setup.specimens.size();
}

void expect_parameters(const FitSetup& setup) {
  if (setup.parameters.empty())
    throw InputError("fit: nothing is varied; allowed: --vary KEY=low:high, up to 8 of them; give one");
  if (setup.parameters.size() > 8) throw InputError("fit: more than 8 keys are varied; allowed: 8; leave some out");
  const bool sweep = !setup.has_targets();
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
}

/// The tests of one protocol, one for each pressure that a target names.
void add_tests_of_protocol(FitSetup& setup, const FitArguments& arguments) {
  const std::string path = protocol_path(arguments.what);
  const auto test_at = [&](double pressure) -> ComparedTest& {
    for (ComparedTest& test : setup.tests)
      if (test.pressure == pressure) return test;
    ComparedTest test;
    test.protocol = path;
    test.pressure = pressure;
    if (pressure > 0) test.settings.push_back("test.pressure_Pa=" + io::exact(pressure));
    setup.tests.push_back(test);
    return setup.tests.back();
  };
  for (const std::string& text : arguments.targets) {
    const fit::ScalarTarget target = fit::parsed_target(text);
    test_at(target.pressure).targets.push_back(target);
  }
  for (const std::string& word : arguments.curves) {
    const NamedCurve named = named_curve(word);
    auto& curves = test_at(named.pressure).curves;
    for (fit::Curve& curve : fit::read_curves(named.path, {arguments.columns, {}, {}}, tell))
      curves.push_back(std::move(curve));
  }
  if (arguments.curves.empty() && !arguments.columns.empty())
    throw InputError("--column is given without --curve; allowed: with --curve; leave it out");
  if (setup.tests.empty()) test_at(0);
}

/// A path in a file, relative to the present folder; the name of something installed stays.
std::string path_or_name(const std::string& file, const std::string& path) {
  const bool is_name = path.find('/') == std::string::npos && path.find('.') == std::string::npos;
  return is_name ? path : from_folder_of(file, path);
}

/// InputError for options that the file stands for.
void expect_options_of_file(const FitArguments& arguments) {
  const auto refuse = [](const char* option, const char* instead) {
    throw InputError(std::string(option) + " is given with a file of several tests; allowed: " + instead +
                     "; write it there");
  };
  if (!arguments.targets.empty()) refuse("--target", "targets of a [[measured]]");
  if (!arguments.curves.empty()) refuse("--curve", "curve of a [[measured]]");
  if (!arguments.columns.empty()) refuse("--column", "columns of a [[measured]]");
  if (arguments.same_specimens || !arguments.specimens.empty() || !arguments.more.empty())
    refuse("--specimen", "recipe in [fit]");
}

/// What the command line says over what the file says.
void merge(fit::SoilFile& file, FitArguments& arguments, const std::string& path) {
  if (!arguments.recipe) arguments.recipe = path_or_name(path, file.recipe);
  if (!arguments.count) arguments.count = file.count;
  if (!arguments.tests) arguments.tests = file.tests;
  for (const std::string& text : arguments.vary) {
    const fit::Parameter given = fit::parsed_parameter(text);
    const auto same = std::find_if(file.parameters.begin(), file.parameters.end(),
                                   [&](const fit::Parameter& own) { return own.key == given.key; });
    if (same != file.parameters.end())
      *same = given;
    else
      file.parameters.push_back(given);
  }
  // A key that is set is held.
  std::erase_if(file.parameters, [&](const fit::Parameter& own) {
    return std::any_of(arguments.settings.begin(), arguments.settings.end(),
                       [&](const std::string& setting) { return setting.starts_with(own.key + "="); });
  });
  std::set<std::string> names;
  for (fit::MeasuredTest& test : file.measured) {
    if (!test.repeats.empty()) continue;  // made with the test that it repeats
    names.insert(test.name);
    if (std::find(arguments.predict.begin(), arguments.predict.end(), test.name) != arguments.predict.end())
      test.predict = true;
  }
  for (const std::string& name : arguments.predict)
    if (!names.contains(name))
      throw InputError("--predict " + name + ": " + path + " has no test of this name" +
                       keys::nearest_in_words(name, {names.begin(), names.end()}) + "; name one of it");
}

/// InputError for a key of one test, "measured.NAME.key", of a test that the file does not have.
void expect_own_keys(const FitSetup& setup, const std::string& path) {
  std::vector<std::string> own = setup.settings, names;
  for (const fit::Parameter& parameter : setup.parameters) own.push_back(parameter.key);
  for (const ComparedTest& test : setup.tests) names.push_back(test.name);
  for (const std::string& key : own) {
    if (!key.starts_with(of_one_test)) continue;
    const std::string rest = key.substr(of_one_test.size());
    const bool known =
        std::any_of(names.begin(), names.end(), [&](const std::string& name) { return rest.starts_with(name + "."); });
    if (!known)
      throw InputError(key + ": " + path + " has no such test to make" +
                       keys::nearest_in_words(rest.substr(0, rest.find('.')), names) +
                       "; allowed: measured.NAME.key of one of its tests; correct the name");
  }
}

void add_tests_of_file(FitSetup& setup, FitArguments& arguments, const std::string& path) {
  expect_options_of_file(arguments);
  fit::SoilFile file = fit::read_soil_file(keys::parse_toml_file(path), path);
  merge(file, arguments, path);
  setup.parameters = file.parameters;
  setup.settings.insert(setup.settings.begin(), file.settings.begin(), file.settings.end());
  setup.predicts = true;
  setup.sand = file.sand;
  for (const fit::MeasuredTest& measured : file.measured) {
    std::vector<fit::Curve> curves;
    if (!measured.curve.empty())
      curves = fit::read_curves(path_or_name(path, measured.curve), measured.selection, tell);
    if (!measured.repeats.empty()) {
      const auto original = std::find_if(setup.tests.begin(), setup.tests.end(),
                                         [&](const ComparedTest& test) { return test.name == measured.repeats; });
      original->repetitions.push_back(std::move(curves));
      continue;
    }
    setup.tests.push_back({.name = measured.name,
                           .protocol = protocol_path(path_or_name(path, measured.protocol)),
                           .settings = file.assignments(measured),
                           .pressure = measured.pressure.value_or(0),
                           .targets = measured.targets,
                           .curves = std::move(curves),
                           .predict = measured.predict,
                           .by_features = file.compares_features(measured) && !measured.curve.empty(),
                           .feature_names = measured.features,
                           .repetitions = {}});
  }
  expect_own_keys(setup, path);
  if (std::all_of(setup.tests.begin(), setup.tests.end(), [](const ComparedTest& test) { return test.predict; }))
    throw InputError("--predict names every test of " + path + "; allowed: all but one; leave one to fit");
}

/// The file of several tests that `what` names, by its path or, installed, by its name; "" if it is a protocol's.
std::string soil_file_of(const std::string& what) {
  const std::string path = is_path(what) ? what : installed_in("fits", what);
  return !path.empty() && fit::is_soil_file(keys::parse_toml_file(path)) ? path : "";
}

}  // namespace

FitSetup setup_of(FitArguments& arguments) {
  FitSetup setup;
  setup.settings = arguments.settings;
  if (const std::string file = soil_file_of(arguments.what); !file.empty()) {
    add_tests_of_file(setup, arguments, file);
  } else {
    if (!arguments.predict.empty())
      throw InputError("--predict is given with a protocol; allowed: with a file of several tests; leave it out");
    for (const std::string& text : arguments.vary) setup.parameters.push_back(fit::parsed_parameter(text));
    add_tests_of_protocol(setup, arguments);
    if (!setup.has_targets() && arguments.same_specimens)
      throw InputError("--same-specimens is given without a target; allowed: with --target or --curve; leave it out");
  }
  expect_parameters(setup);
  read_specimens(setup, arguments);
  expect_runnable(setup);
  take_features(setup);
  assume_errors(setup);
  return setup;
}

}  // namespace rvelab::cli
