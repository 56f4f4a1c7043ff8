#include "rvelab/pack/read_recipe.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "rvelab/error.hpp"
#include "rvelab/grains/sieve_grading.hpp"
#include "rvelab/keys/assign.hpp"
#include "rvelab/keys/material_toml.hpp"
#include "rvelab/keys/table_reader.hpp"
#include "rvelab/keys/toml_source.hpp"
#include "rvelab/measure/measures.hpp"
#include "rvelab/specimen/field_layout.hpp"

namespace rvelab::pack {
namespace {

using keys::line_of;
using keys::table_of;
using keys::TableReader;

const std::vector<std::string> tables{"pack",    "grains",  "target", "preparation",
                                      "contact", "damping", "solver", "material"};

std::string text_of(const toml::table& table) {
  std::ostringstream text;
  text << toml::toml_formatter{table} << "\n";
  return text.str();
}

void read_pack(const toml::table& table, RecipeFile& file, toml::table& resolved, std::vector<keys::KeyError>& errors) {
  TableReader reader(table, recipe_keys(), "pack", "pack", line_of(table), errors);
  Recipe& recipe = file.recipe;
  file.name = reader.text("name");
  fields::from_text(reader.choice("shape"), recipe.shape);
  recipe.number = std::size_t(reader.whole_number("number"));
  recipe.seed = std::uint64_t(reader.whole_number("seed"));
  if (dimension_of(recipe.shape) == 2) {
    recipe.thickness = reader.number("thickness_m");
  } else {
    reader.leave("thickness_m");
    if (reader.has("thickness_m"))
      reader.mistake("thickness_m", "contradicts pack.shape = \"sphere\"; allowed: in 2D only; remove one");
  }
  recipe.oriented = reader.choice("cell") == "oriented";
  recipe.share_by_mass = reader.choice("share_by") == "mass";
  reader.finish();
  resolved.insert("pack", reader.resolved());
}

/// A key that another kind of grading has.
void refuse(TableReader& reader, const std::string& name, const std::string& grading) {
  reader.leave(name);
  if (reader.has(name))
    reader.mistake(name, "contradicts grading = \"" + grading + "\"; allowed: one of the two; remove one");
}

/// The curve through d10, d50 and d60, which are in mm.
Grading read_sieves(TableReader& reader, const std::string& curve) {
  for (const char* name : {"radii_m", "passing", "smallest_radius_m", "largest_radius_m"}) refuse(reader, name, curve);
  if (reader.has("passing_by") && reader.choice("passing_by") != "mass")
    reader.mistake("passing_by", "contradicts grading = \"d10_d60\"; allowed: mass; remove it");
  reader.leave("passing_by");
  const double d10 = 1e-3 * reader.number("d10_mm"), d50 = 1e-3 * reader.number("d50_mm"),
               d60 = 1e-3 * reader.number("d60_mm");
  if (!(d10 > 0 && d50 > 0 && d60 > 0)) return {};  // a mistake that is told already
  const std::string wrong = wrong_with_sieves(d10, d50, d60);
  if (!wrong.empty()) reader.mistake("d50_mm", wrong);
  return wrong.empty() ? sieve_grading(d10, d50, d60) : Grading{};
}

Grading read_grading(TableReader& reader) {
  Grading grading;
  const std::string curve = reader.choice("grading");
  if (curve == "d10_d60") return read_sieves(reader, curve);
  for (const char* name : {"d10_mm", "d50_mm", "d60_mm"}) refuse(reader, name, curve);
  grading.by_mass = reader.choice("passing_by") == "mass";
  if (curve == "tabulated") {
    grading.curve = GradingCurve::tabulated;
    grading.radii = reader.numbers("radii_m");
    grading.passing = reader.numbers("passing");
    for (const char* name : {"smallest_radius_m", "largest_radius_m"}) refuse(reader, name, curve);
    return grading;
  }
  grading.curve = curve == "linear" ? GradingCurve::linear : GradingCurve::uniform;
  grading.smallest_radius = reader.number("smallest_radius_m");
  grading.largest_radius = reader.number("largest_radius_m");
  for (const char* name : {"radii_m", "passing"}) refuse(reader, name, curve);
  return grading;
}

/// Aspect ratios and bedding of grains that are not round; of others none may be given.
void read_outlines(TableReader& reader, GrainFraction& fraction, Shape shape) {
  struct Key {
    const char* name;
    double* value;
  };
  const Key keys[] = {{"smallest_aspect_ratio", &fraction.smallest_aspect_ratio},
                      {"largest_aspect_ratio", &fraction.largest_aspect_ratio},
                      {"bedding_angle_deg", &fraction.bedding_angle},
                      {"bedding_spread_deg", &fraction.bedding_spread}};
  for (const Key& key : keys) {
    if (!is_round(shape)) {
      *key.value = reader.number(key.name);
      continue;
    }
    reader.leave(key.name);
    if (reader.has(key.name))
      reader.mistake(key.name, "contradicts pack.shape = \"" + fields::text_of(shape) + "\"; allowed: with " +
                                   names_of_shapes([](Shape each) { return !is_round(each); }, true) +
                                   " only; remove one");
  }
  if (fraction.smallest_aspect_ratio > fraction.largest_aspect_ratio)
    reader.mistake("smallest_aspect_ratio", "is above grains.largest_aspect_ratio; allowed: up to it; correct them");
}

void read_fraction(const toml::table& table, Recipe& recipe, toml::array& resolved,
                   std::vector<keys::KeyError>& errors) {
  GrainFraction fraction;
  const std::string where = "grains." + table["name"].value_or(fraction.name);
  TableReader reader(table, recipe_keys(), "grains", table.contains("name") ? where : "grains", line_of(table), errors);
  fraction.name = reader.text("name", fraction.name);
  fraction.share = reader.number("share");
  const std::size_t mistakes = errors.size();
  fraction.grading = read_grading(reader);
  const bool grading_read = errors.size() == mistakes;
  read_outlines(reader, fraction, recipe.shape);
  const std::string material = reader.text("material", recipe.materials.front().name);
  std::string known;
  bool found = false;
  for (std::size_t k = 0; k < recipe.materials.size(); ++k) {
    known += (k == 0 ? "" : ", ") + recipe.materials[k].name;
    if (recipe.materials[k].name != material) continue;
    fraction.material = k;
    found = true;
  }
  if (!found) reader.mistake("material", "is no material of the recipe; allowed: " + known + "; name one of these");
  reader.finish();
  if (grading_read) {
    try {
      check_grading(fraction.grading, where.c_str());
    } catch (const InputError& error) {
      errors.push_back({line_of(table), error.what()});
    }
  }
  recipe.fractions.push_back(fraction);
  resolved.push_back(reader.resolved());
}

void read_grains(const toml::table& file, Recipe& recipe, toml::table& resolved, std::vector<keys::KeyError>& errors) {
  const toml::node* node = file.get("grains");
  toml::array list;
  recipe.fractions.clear();
  if (node != nullptr && node->is_table()) {
    read_fraction(*node->as_table(), recipe, list, errors);
  } else if (node != nullptr && node->is_array_of_tables()) {
    for (const auto& item : *node->as_array()) read_fraction(*item.as_table(), recipe, list, errors);
  } else {
    const std::string text = "the recipe has no grains; allowed: [grains], or [[grains]] for each fraction; add it";
    errors.push_back(node == nullptr ? keys::KeyError{0, text} : keys::key_error(node->source(), text));
  }
  double shares = 0;
  for (std::size_t k = 0; k < recipe.fractions.size(); ++k) {
    shares += recipe.fractions[k].share;
    for (std::size_t other = 0; other < k; ++other) {
      if (recipe.fractions[k].name == recipe.fractions[other].name)
        errors.push_back({line_of(*node), "grains.name = \"" + recipe.fractions[k].name +
                                              "\" is there twice; allowed: a name of its own for each; rename one"});
    }
  }
  if (!recipe.fractions.empty() && !(std::abs(shares - 1) <= 1e-6)) {
    std::ostringstream text;
    text << "the values of grains.share add up to " << shares << "; allowed: 1; correct them";
    errors.push_back({line_of(*node), text.str()});
  }
  resolved.insert("grains", list);
}

/// xx yy xy, or xx yy zz yz xz xy.
std::optional<Matrix3> stress_of(const std::vector<double>& list, Shape shape) {
  Matrix3 stress = Matrix3::Zero();
  const int d = dimension_of(shape);
  if (list.size() != (d == 2 ? 3u : 6u)) return std::nullopt;
  for (int k = 0; k < d; ++k) stress(k, k) = list[std::size_t(k)];
  if (d == 2) {
    stress(0, 1) = stress(1, 0) = list[2];
  } else {
    stress(1, 2) = stress(2, 1) = list[3];
    stress(0, 2) = stress(2, 0) = list[4];
    stress(0, 1) = stress(1, 0) = list[5];
  }
  return stress;
}

void read_stress(TableReader& reader, RecipeFile& file) {
  Recipe& recipe = file.recipe;
  const auto pressure = reader.optional_number("pressure_Pa");
  file.pressures = reader.numbers("pressures_Pa");
  const auto components = reader.numbers("stress_Pa");
  if (pressure && reader.has("pressures_Pa"))
    reader.mistake("pressures_Pa", "contradicts target.pressure_Pa; allowed: one of the two; remove one");
  if (pressure && reader.has("stress_Pa"))
    reader.mistake("stress_Pa", "contradicts target.pressure_Pa; allowed: one of the two; remove one");
  if (pressure) recipe.stress = isotropic_stress(*pressure, recipe.shape);
  if (!components.empty()) {
    recipe.stress = stress_of(components, recipe.shape);
    if (!recipe.stress) {
      reader.mistake("stress_Pa", dimension_of(recipe.shape) == 2
                                      ? "is not a stress in 2D; allowed: [xx, yy, xy]; give three numbers"
                                      : "is not a stress in 3D; allowed: [xx, yy, zz, yz, xz, xy]; give six numbers");
    } else if (!(mean_pressure(*recipe.stress, dimension_of(recipe.shape)) > 0)) {
      reader.mistake("stress_Pa",
                     "has no mean pressure; allowed: tension positive with -(xx + yy [+ zz]) > 0; give "
                     "compressive normal stresses as negative numbers");
    }
  }
  if (!file.pressures.empty() && file.pressures.front() > 0) {
    if (!recipe.stress) recipe.stress = isotropic_stress(1, recipe.shape);
    *recipe.stress *= file.pressures.front() / mean_pressure(*recipe.stress, dimension_of(recipe.shape));
  }
}

/// The void ratio of a relative density between the limits of the recipe.
void read_relative_density(TableReader& reader, Recipe& recipe) {
  const auto density = reader.optional_number("relative_density");
  const auto e_min = reader.optional_number("e_min"), e_max = reader.optional_number("e_max");
  if (!density) return;
  if (recipe.void_ratio)
    reader.mistake("relative_density", "contradicts target.void_ratio or porosity; allowed: one of them; remove one");
  if (!e_min || !e_max || !(*e_min < *e_max)) {
    reader.mistake("relative_density",
                   "needs target.e_min below target.e_max, the void ratios that the recipe reaches with "
                   "preparation.friction = 0 and 1e6; allowed: both; pack the two and give them");
    return;
  }
  recipe.void_ratio = *e_max - *density * (*e_max - *e_min);
}

void read_target(const toml::table& table, RecipeFile& file, toml::table& resolved,
                 std::vector<keys::KeyError>& errors) {
  TableReader reader(table, recipe_keys(), "target", "target", line_of(table), errors);
  Recipe& recipe = file.recipe;
  read_stress(reader, file);
  recipe.void_ratio = reader.optional_number("void_ratio");
  if (const auto porosity = reader.optional_number("porosity")) {
    if (recipe.void_ratio)
      reader.mistake("porosity", "contradicts target.void_ratio; allowed: one of the two; remove one");
    recipe.void_ratio = *porosity / (1 - *porosity);
  }
  read_relative_density(reader, recipe);
  const bool stress_named = reader.has("pressure_Pa") || reader.has("pressures_Pa") || reader.has("stress_Pa") ||
                            reader.has_in_another_unit("pressure_Pa") || reader.has_in_another_unit("pressures_Pa") ||
                            reader.has_in_another_unit("stress_Pa");
  if (!stress_named && !recipe.void_ratio && !table.contains("void_ratio") && !table.contains("relative_density"))
    reader.mistake("pressure_Pa", "is missing, and so is target.void_ratio; allowed: one of them or both; add one");
  recipe.void_ratio_tolerance = reader.number("void_ratio_tolerance");
  recipe.stress_tolerance = reader.number("stress_tolerance");
  recipe.unbalanced = reader.number("unbalanced");
  reader.finish();
  resolved.insert("target", reader.resolved());
}

void read_preparation(const toml::table& table, Recipe& recipe, toml::table& resolved,
                      std::vector<keys::KeyError>& errors) {
  TableReader reader(table, recipe_keys(), "preparation", "preparation", line_of(table), errors);
  Preparation& preparation = recipe.preparation;
  using Method = Preparation::Method;
  const std::string method = reader.choice("method");
  preparation.method = method == "growth"    ? Method::growth
                       : method == "regular" ? Method::regular
                                             : Method::compression;
  preparation.friction = reader.optional_number("friction");
  preparation.rolling_friction = reader.number("rolling_friction");
  preparation.lowest_friction = reader.number("lowest_friction");
  preparation.highest_friction = reader.number("highest_friction");
  preparation.max_draws = reader.whole_number("max_draws");
  if (method == "growth" || !recipe.stress) {
    preparation.first_size = reader.number("first_size");
    preparation.growth_void_ratio = reader.optional_number("growth_void_ratio");
  } else {
    for (const char* name : {"first_size", "growth_void_ratio"}) {
      reader.leave(name);
      if (reader.has(name))
        reader.mistake(name, "contradicts method = \"" + method + "\"; allowed: with method = \"growth\"; remove one");
    }
  }
  if (preparation.friction && recipe.stress && recipe.void_ratio)
    reader.mistake("friction",
                   "contradicts target.void_ratio, for which the friction is searched; allowed: one of the "
                   "two; remove one");
  if (!(preparation.lowest_friction < preparation.highest_friction))
    reader.mistake("highest_friction", "is not above preparation.lowest_friction; allowed: above it; correct one");
  reader.finish();
  resolved.insert("preparation", reader.resolved());
}

/// Materials, contact model, damping and solver.
void read_parameters(const toml::table& file, Recipe& recipe, toml::table& resolved,
                     std::vector<keys::KeyError>& errors) {
  Specimen specimen;
  specimen.shape = recipe.shape;
  specimen.materials = {Material{}};
  if (!file.contains("material"))
    errors.push_back({0, "the recipe has no material; allowed: [[material]] with its keys below; add it"});
  const std::size_t mistakes = errors.size();
  keys::read_material_tables(file, specimen, errors);
  if (specimen.materials.empty()) specimen.materials = {Material{}};
  recipe.materials = specimen.materials;
  recipe.contact = specimen.contact;
  recipe.damping = specimen.damping;
  recipe.solver = specimen.solver;
  if (errors.size() == mistakes && file.contains("material")) {
    try {
      check_parameters(recipe.contact, recipe.damping, recipe.materials);
    } catch (const InputError& error) {
      errors.push_back({0, error.what()});
    }
  }
  for (const char* name : {"contact", "damping", "solver", "material"}) {
    if (const toml::node* node = file.get(name)) resolved.insert(name, *node);
  }
}

RecipeFile read_file(toml::table file, const std::string& path, const std::vector<std::string>& assignments) {
  std::vector<keys::KeyError> errors;
  keys::assign_all(file, assignments, errors);
  RecipeFile read;
  toml::table resolved;
  keys::expect_top_tables(file, errors, tables);
  read_pack(table_of(file, "pack", errors), read, resolved, errors);
  read_parameters(file, read.recipe, resolved, errors);
  read_grains(file, read.recipe, resolved, errors);
  read_target(table_of(file, "target", errors), read, resolved, errors);
  read_preparation(table_of(file, "preparation", errors), read.recipe, resolved, errors);
  keys::raise(path, errors);
  try {
    check_recipe(read.recipe);
  } catch (const InputError& error) {
    throw InputError(path + ": " + error.what());
  }
  read.resolved = text_of(resolved);
  return read;
}

}  // namespace

RecipeFile RecipeFile::member(std::uint64_t seed, std::optional<double> pressure) const {
  RecipeFile one = *this;
  toml::table table = toml::parse(resolved);
  one.recipe.seed = seed;
  table["pack"].as_table()->insert_or_assign("seed", std::int64_t(seed));
  if (pressure) {
    one.recipe.stress = *recipe.stress * (*pressure / mean_pressure(*recipe.stress, dimension_of(recipe.shape)));
    one.pressures = {*pressure};
    table["target"].as_table()->insert_or_assign("pressures_Pa", toml::array{*pressure});
  }
  one.resolved = text_of(table);
  return one;
}

RecipeFile read_recipe(const std::string& path, const std::vector<std::string>& assignments) {
  return read_file(keys::parse_toml_file(path), path, assignments);
}

RecipeFile parse_recipe(const std::string& text, const std::string& path, const std::vector<std::string>& assignments) {
  return read_file(keys::parse_toml_text(text, path), path, assignments);
}

bool is_recipe(const std::string& path) { return keys::parse_toml_file(path).contains("pack"); }

}  // namespace rvelab::pack
