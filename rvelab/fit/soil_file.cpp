#include "rvelab/fit/soil_file.hpp"

#include <algorithm>
#include <set>

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
  file.tests = reader.optional_whole_number("tests", {8, 100'000}, "sets of parameters to try",
                                            "24 and 16 for each parameter", "8 to 100000");
  file.settings = reader.texts("settings", "KEY=value of every test and of the recipe");
  file.parameters = parsed_texts(reader, "vary", "KEY=low:high, with :log behind it for even steps in the logarithm",
                                 [](const std::string& text) { return parsed_parameter(text); });
  for (const Parameter& parameter : file.parameters)
    if (parameter.grid != 0)
      reader.mistake("vary", "asks for a sweep of " + parameter.key + "; allowed: KEY=low:high; leave the number out");
}

MeasuredTest read_measured(TableReader& reader) {
  MeasuredTest test;
  test.name = reader.required_text("name", "of the test, for results");
  test.protocol = reader.required_text("protocol", "test to make: a path, or the name of an installed one");
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
  if (test.curve.empty() && test.targets.empty())
    reader.mistake("has neither curve nor targets; allowed: a measured curve (CSV), or measures; give one");
  if (test.curve.empty())
    for (const char* name : {"columns", "from", "to"}) reader.refuse(name, "is given without a curve; remove it");
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

}  // namespace

std::vector<std::string> MeasuredTest::assignments() const {
  std::vector<std::string> all;
  const auto add = [&](const char* key, const std::optional<double>& value) {
    if (value) all.push_back(std::string(key) + "=" + keys::as_toml(*value));
  };
  add("target.pressure_Pa", pressure);
  add("test.pressure_Pa", pressure);
  add("target.relative_density", relative_density);
  add("target.void_ratio", void_ratio);
  all.insert(all.end(), settings.begin(), settings.end());
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
  if (errors.empty() &&
      std::all_of(found.measured.begin(), found.measured.end(), [](const MeasuredTest& test) { return test.predict; }))
    reader.mistake("has only tests to predict; allowed: at least one to fit; leave predict out of one");
  keys::raise(path, errors);
  return found;
}

}  // namespace rvelab::fit
