#include "rvelab/sheet/plan.hpp"

#include <algorithm>
#include <set>

#include "rvelab/error.hpp"
#include "rvelab/keys/table_reader.hpp"

namespace rvelab::sheet {
namespace {

using keys::TableReader;

bool is_cyclic(Purpose purpose) { return purpose == Purpose::cyclic_strain || purpose == Purpose::cyclic_stress; }

/// A mistake unless the name can stand in the name of a file.
void expect_name(TableReader& reader, const std::string& name, std::set<std::string>& names) {
  const bool plain = std::all_of(name.begin(), name.end(), [](unsigned char letter) {
    return std::isalnum(letter) != 0 || letter == '_' || letter == '-';
  });
  if (!plain) reader.mistake("name", "is no name of a file; allowed: letters, digits, - and _; rename it");
  if (!name.empty() && !names.insert(name).second)
    reader.mistake("name", "stands twice; allowed: a name of its own for each; rename one");
}

void read_sheet(TableReader& reader, Plan& plan) {
  reader.whole_number("seeds", plan.seeds, {1, 1000}, "specimens of each density, of consecutive seeds of the recipe");
  plan.pressure = reader.optional_number("pressure_Pa", "Pa", keys::pressures,
                                         "at which specimens are packed; tests bring them from there to their own",
                                         "that of the recipe");
  plan.settings = reader.texts("settings", "KEY=value of the recipe");
}

PlanDensity read_density(TableReader& reader, std::set<std::string>& names) {
  PlanDensity density;
  density.name = reader.required_text("name", "of the density, in names of tests and on the sheet");
  expect_name(reader, density.name, names);
  density.relative_density = reader.optional_number(
      "relative_density", "1", {-1, 2}, "of specimens, between target.e_min and target.e_max of the recipe");
  density.void_ratio = reader.optional_number("void_ratio", "1", {0, 10, true, false},
                                              "of specimens, where the recipe has no such limits");
  density.settings = reader.texts("settings", "KEY=value of the recipe for this density alone");
  if (density.relative_density && density.void_ratio)
    reader.mistake("void_ratio", "contradicts relative_density; allowed: one of the two; remove one");
  if (!density.relative_density && !density.void_ratio && density.settings.empty())
    reader.mistake("density." + density.name +
                   " says nothing of its specimens; allowed: relative_density, void_ratio, or settings of the recipe; "
                   "give one");
  return density;
}

PlanTest read_test(TableReader& reader, std::set<std::string>& names) {
  PlanTest test;
  test.name = reader.required_text("name", "of the test, in names of record files");
  expect_name(reader, test.name, names);
  const std::string purpose = reader.required_choice("purpose", purpose_names(), "numbers of the sheet that it gives");
  const auto& all = purpose_names();
  test.purpose = Purpose(std::find(all.begin(), all.end(), purpose) - all.begin());
  test.protocol = reader.required_text("protocol", "test to make: a path, or the name of an installed one");
  reader.text("protocol_2D", test.protocol_2D, "in its place where the grains are in the plane", "the same");
  test.densities = reader.texts("densities", "names of densities whose specimens go through it; else all");
  test.pressures = reader.numbers("pressures_Pa", "Pa", keys::pressures,
                                  "pressures to which specimens are brought, a test at each (test.pressure_Pa); else "
                                  "that of the protocol");
  test.amplitudes = reader.numbers("amplitudes", "1", keys::positive,
                                   "of cycles, a test with each: cyclic_strain: strain; cyclic_stress: stress over the "
                                   "pressure, q/(2 p) of a triaxial test, tau/p of simple shear");
  reader.whole_number("records_per_amplitude", test.records_per_amplitude, {2, 10'000},
                      "cyclic_strain: records on the way to the amplitude");
  test.seeds =
      reader.optional_whole_number("seeds", {1, 1000}, "on so many specimens of each density only", "all", "1 to 1000");
  test.settings = reader.texts("settings", "KEY=value of the protocol");
  if (purpose.empty()) return test;
  if (is_cyclic(test.purpose) && test.amplitudes.empty())
    reader.mistake("amplitudes", "is missing; allowed: with purpose = " + keys::as_toml(purpose) +
                                     " one amplitude or more; give them");
  if (!is_cyclic(test.purpose))
    for (const char* name : {"amplitudes", "records_per_amplitude"})
      reader.refuse(name, "contradicts purpose = " + keys::as_toml(purpose) + "; allowed: with cycles; remove it");
  return test;
}

/// The tables [[name]], each by read(reader, names of those before).
template <class Read>
auto read_list(const toml::table& file, const std::string& list, std::vector<keys::KeyError>& errors, Read read) {
  std::set<std::string> names;
  TableReader* none = nullptr;
  std::vector<decltype(read(*none, names))> found;
  const toml::node* node = file.get(list);
  if (node == nullptr || !node->is_array_of_tables()) {
    errors.push_back(
        keys::key_error(node == nullptr ? file.source() : node->source(),
                        list + " is no list of tables; allowed: [[" + list + "]] for each " + list + "; give one"));
    return found;
  }
  for (const toml::node& item : *node->as_array()) {
    const toml::table& table = *item.as_table();
    const std::string name = table["name"].value_or(std::to_string(found.size()));
    TableReader reader(table, list, list + "." + name, keys::line_of(table), errors);
    found.push_back(read(reader, names));
    reader.finish();
  }
  return found;
}

/// Names of densities in tests.
void expect_densities(const Plan& plan, const toml::table& file, std::vector<keys::KeyError>& errors) {
  std::vector<std::string> names;
  for (const PlanDensity& density : plan.densities) names.push_back(density.name);
  for (std::size_t k = 0; k < plan.tests.size(); ++k)
    for (const std::string& name : plan.tests[k].densities)
      if (std::find(names.begin(), names.end(), name) == names.end())
        errors.push_back(keys::key_error((*file["test"].as_array())[k].source(),
                                         "test." + plan.tests[k].name + ".densities names " + name +
                                             ", which is no density of the plan" + keys::nearest_in_words(name, names) +
                                             "; allowed: " + keys::listed(names) + "; correct it"));
}

}  // namespace

const std::vector<std::string>& purpose_names() {
  static const std::vector<std::string> names{"isotropic",       "oedometer",     "drained",      "undrained",
                                              "undrained_shear", "cyclic_strain", "cyclic_stress"};
  return names;
}

std::vector<std::string> Plan::recipe_settings(const PlanDensity& density) const {
  std::vector<std::string> all = settings;
  const auto add = [&](const char* key, const std::optional<double>& value) {
    if (value) all.push_back(std::string(key) + "=" + keys::as_toml(*value));
  };
  add("target.pressure_Pa", pressure);
  add("target.relative_density", density.relative_density);
  add("target.void_ratio", density.void_ratio);
  all.insert(all.end(), density.settings.begin(), density.settings.end());
  return all;
}

bool is_of_plan(const std::string& assignment) {
  return assignment.starts_with("sheet.") || assignment.starts_with("density.") || assignment.starts_with("test.");
}

Plan read_plan(toml::table file, const std::string& path, const std::vector<std::string>& assignments) {
  std::vector<keys::KeyError> errors;
  keys::expect_top_tables(file, errors, {"sheet", "density", "test"});
  keys::assign_all(file, assignments, errors);
  const toml::table& table = keys::table_of(file, "sheet", errors);
  TableReader reader(table, "sheet", "sheet", keys::line_of(table), errors);
  Plan plan;
  plan.path = path;
  read_sheet(reader, plan);
  reader.finish();
  plan.densities = read_list(file, "density", errors, read_density);
  plan.tests = read_list(file, "test", errors, read_test);
  if (errors.empty()) expect_densities(plan, file, errors);
  keys::raise(path, errors);
  plan.resolved = keys::written_file(file);
  return plan;
}

}  // namespace rvelab::sheet
