#include "rvelab/fit/soil_file.hpp"

#include <algorithm>
#include <set>

#include "rvelab/ensemble/features.hpp"
#include "rvelab/error.hpp"
#include "rvelab/keys/table_reader.hpp"

namespace rvelab::fit {
namespace {

using keys::TableReader;

/// Reads what `parsed` takes of each text of a list; its InputError is a mistake at the key.
template <class Parsed>
auto parsed_texts(TableReader& reader, const char* name, const char* meaning, Parsed parsed) {
  std::vector<decltype(parsed(std::string()))> found;
  for (const std::string& text : reader.texts(name, meaning)) {
    try {
      found.push_back(parsed(text));
    } catch (const InputError& error) {
      reader.mistake(name, std::string("is wrong: ") + error.what());
    }
  }
  return found;
}

void read_fit(TableReader& reader, SoilFile& file) {
  file.recipe = reader.required_text("recipe", "recipe of the specimens: a path, or the name of an installed one");
  reader.whole_number("count", file.count, {1, 1e6}, "specimens of each test, one a seed");
  file.tests =
      reader.optional_whole_number("tests", {8, 100'000}, "sets of parameters to try",
                                   "24 and 16 for each parameter, 8 where only features are fitted", "8 to 100000");
  file.settings = reader.texts("settings", "KEY=value of every test and of the recipe");
  file.parameters = parsed_texts(reader, "vary", "KEY=low:high, with :log behind it for even steps in the logarithm",
                                 [](const std::string& text) { return parsed_parameter(text); });
  reader.choice(
      "compare", file.compare, {"curves", "features"},
      "what of a measured curve is fitted: curves: its points; features: what the soil is (q at small strains, "
      "E50, largest q ...), by the scatter of laboratories");
  const keys::Range void_ratios{{0, 10, true, false}};
  const auto e_min =
      reader.optional_number("e_min", "1", void_ratios,
                             "densest void ratio of the sand itself; with e_max: void_ratio of a "
                             "[[measured]] is that of the sand, and the specimen gets its relative density");
  const auto e_max = reader.optional_number("e_max", "1", void_ratios, "loosest void ratio of the sand itself");
  if (e_min && e_max && *e_min < *e_max) file.sand = {*e_min, *e_max};
  if (e_min.has_value() != e_max.has_value() || (e_min && !file.sand))
    reader.mistake(e_min ? "e_min" : "e_max", "needs e_min below e_max; allowed: both, or none; give both");
  for (const Parameter& parameter : file.parameters)
    if (parameter.grid != 0)
      reader.mistake("vary", "asks for a sweep of " + parameter.key + "; allowed: KEY=low:high; leave the number out");
}

MeasuredTest read_measured(TableReader& reader) {
  MeasuredTest test;
  test.name = reader.required_text("name", "of the test, for results");
  reader.text("repeats", test.repeats,
              "name of the test above that this one repeats in the laboratory: its features count with those of that "
              "one, and give the scatter",
              "none");
  reader.text("protocol", test.protocol, "test to make: a path, or the name of an installed one", "required");
  reader.text("curve", test.curve, "measured curve, CSV; relative to the folder of the file", "none");
  test.selection.columns = reader.texts("columns",
                                        "columns of it to read, the abscissa first: \"deviator_kPa\", or "
                                        "\"deviator_kPa=q\" for a column that is called q; else all");
  test.selection.from = reader.optional_number("from", "", keys::every, "first abscissa, in the unit of its column");
  test.selection.to = reader.optional_number("to", "", keys::every, "last abscissa, in the unit of its column");
  test.targets = parsed_texts(reader, "targets", "MEASURE=value+-error", [](const std::string& text) {
    const ScalarTarget target = parsed_target(text);
    if (target.pressure > 0)
      throw InputError(text + " has a pressure; allowed: MEASURE=value+-error; write it as pressure_Pa of the test");
    return target;
  });
  test.pressure = reader.optional_number("pressure_Pa", "Pa", keys::pressures,
                                         "of the specimen and of the test (target.pressure_Pa, test.pressure_Pa)",
                                         "those of recipe and protocol");
  test.relative_density =
      reader.optional_number("relative_density", "1", {-1, 2}, "of the specimen (target.relative_density)");
  test.void_ratio =
      reader.optional_number("void_ratio", "1", {0, 10, true, false}, "of the specimen (target.void_ratio)");
  if (test.relative_density && test.void_ratio)
    reader.mistake("void_ratio", "contradicts relative_density; allowed: one of the two; remove one");
  test.settings = reader.texts("settings", "KEY=value of this test alone");
  reader.boolean("predict", test.predict, "leave it out of the fit, and compare it with what the fit predicts");
  test.features =
      reader.texts("features",
                   "features to compare of the curve, instead of the usual ones of the kind of test; names: "
                   "the page Fitting of the manual");
  test.compare = reader.choice("compare", "", {"curves", "features"}, "of this test alone, as fit.compare",
                               "fit.compare; features where some are named");
  if (test.compare == "curves" && !test.features.empty())
    reader.mistake("features", "is given with compare = \"curves\"; allowed: one of the two; remove one");
  for (const std::string& name : test.features)
    if (!ensemble::feature_of(name))
      reader.mistake("features", "names " + name + ", which is no feature" +
                                     keys::nearest_in_words(name, ensemble::feature_names()) + "; allowed: " +
                                     keys::listed(ensemble::feature_names()) + ", X a number; correct it");
  if (!test.repeats.empty()) {
    for (const char* name : {"protocol", "targets", "pressure_Pa", "relative_density", "void_ratio", "settings",
                             "predict", "features", "compare"})
      reader.refuse(name, "is that of the test that is repeated; remove it");
    if (test.curve.empty()) reader.mistake("curve", "is missing; allowed: the curve of a repeated test; give it");
    return test;
  }
  if (test.protocol.empty())
    reader.mistake("protocol", "is missing; allowed: a path, or the name of an installed test; give it");
  if (test.curve.empty() && test.targets.empty())
    reader.mistake("has neither curve nor targets; allowed: a measured curve (CSV), or measures; give one");
  if (test.curve.empty())
    for (const char* name : {"columns", "from", "to", "features", "compare"})
      reader.refuse(name, "is given without a curve; remove it");
  return test;
}

std::vector<MeasuredTest> read_list(const toml::table& file, std::vector<keys::KeyError>& errors) {
  std::vector<MeasuredTest> tests;
  const toml::node* node = file.get("measured");
  if (node == nullptr || !node->is_array_of_tables()) {
    errors.push_back(keys::key_error(node == nullptr ? file.source() : node->source(),
                                     "measured is no list of tables; allowed: [[measured]] for each test"));
    return tests;
  }
  std::set<std::string> names;
  for (const toml::node& item : *node->as_array()) {
    const toml::table& table = *item.as_table();
    const std::string name = table["name"].value_or(std::to_string(tests.size() + 1));
    TableReader reader(table, "measured", "measured." + name, keys::line_of(table), errors);
    tests.push_back(read_measured(reader));
    if (!names.insert(tests.back().name).second)
      reader.mistake("name", "stands twice; allowed: a name of its own for each test; rename one");
    reader.finish();
  }
  return tests;
}

/// A repetition stands behind a test whose features are compared.
void expect_repeated(TableReader& reader, const SoilFile& file) {
  for (auto test = file.measured.begin(); test != file.measured.end(); ++test) {
    if (test->repeats.empty()) continue;
    const auto original = std::find_if(file.measured.begin(), test, [&](const MeasuredTest& other) {
      return other.name == test->repeats && other.repeats.empty() && !other.curve.empty();
    });
    if (original == test)
      reader.mistake("measured." + test->name + ".repeats = " + test->repeats +
                     " names no test with a curve above it; allowed: the name of one; correct it");
    else if (!file.compares_features(*original))
      reader.mistake("measured." + test->name + ".repeats: the points of " + original->name +
                     " are fitted; allowed: with features, which give a scatter; set fit.compare = \"features\"");
  }
}

}  // namespace

std::vector<std::string> SoilFile::assignments(const MeasuredTest& test) const {
  std::vector<std::string> all;
  std::optional<double> relative_density = test.relative_density, void_ratio = test.void_ratio;
  if (sand && void_ratio) {
    relative_density = (sand->e_max - *void_ratio) / (sand->e_max - sand->e_min);
    void_ratio.reset();
  }
  const auto add = [&](const char* key, const std::optional<double>& value) {
    if (value) all.push_back(std::string(key) + "=" + keys::as_toml(*value));
  };
  add("target.pressure_Pa", test.pressure);
  add("test.pressure_Pa", test.pressure);
  add("target.relative_density", relative_density);
  add("target.void_ratio", void_ratio);
  all.insert(all.end(), test.settings.begin(), test.settings.end());
  return all;
}

bool is_soil_file(const toml::table& file) { return file.contains("fit"); }

SoilFile read_soil_file(const toml::table& file, const std::string& path) {
  std::vector<keys::KeyError> errors;
  keys::expect_top_tables(file, errors, {"fit", "measured"});
  const toml::table& table = keys::table_of(file, "fit", errors);
  TableReader reader(table, "fit", "fit", keys::line_of(table), errors);
  SoilFile found;
  read_fit(reader, found);
  reader.finish();
  found.measured = read_list(file, errors);
  expect_repeated(reader, found);
  if (errors.empty() && std::all_of(found.measured.begin(), found.measured.end(),
                                    [](const MeasuredTest& test) { return test.predict || !test.repeats.empty(); }))
    reader.mistake("has only tests to predict; allowed: at least one to fit; leave predict out of one");
  keys::raise(path, errors);
  return found;
}

}  // namespace rvelab::fit
