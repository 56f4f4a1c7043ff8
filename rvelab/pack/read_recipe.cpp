#include "rvelab/pack/read_recipe.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>

#include "rvelab/error.hpp"
#include "rvelab/keys/material_toml.hpp"
#include "rvelab/keys/table_reader.hpp"
#include "rvelab/measure/measures.hpp"
#include "rvelab/pack/plausible.hpp"
#include "rvelab/pack/read_grading.hpp"
#include "rvelab/pack/read_target.hpp"
#include "rvelab/pack/recipe_grading.hpp"

namespace rvelab::pack {
namespace {

using namespace keys;

constexpr Interval aspect_ratio{least_aspect_ratio, 1};

/// Words of pack.shape: those of Shape, and clump and ellipsoid behind them.
enum class ShapeName {};
enum class MemberName { disc, sphere };

void read_pack(TableReader& reader, RecipeFile& file) {
  Recipe& recipe = file.recipe;
  file.name = reader.required_text("name", "name of the recipe");
  const auto of_dimension = [](int d) {
    return names_of_shapes([d](Shape shape) { return dimension_of(shape) == d; });
  };
  Choices shapes;
  for (int number = 0; number < shape_count; ++number) shapes.emplace_back(name(Shape(number)));
  shapes.emplace_back("clump");
  shapes.emplace_back("ellipsoid");
  auto shape = ShapeName(recipe.shape);
  auto members = MemberName::sphere;
  reader.choice("shape", shape, shapes,
                of_dimension(2) + ": 2D; " + of_dimension(3) +
                    ": 3D; clump: bodies of discs or spheres, pack.members; "
                    "ellipsoid: superellipsoid with exponents of 2, 3D");
  reader.choice("members", members, {"disc", "sphere"}, "shape = clump: what bodies are made of, 2D or 3D");
  recipe.clumps = int(shape) == shape_count;
  file.ellipsoids = int(shape) == shape_count + 1;
  recipe.shape = recipe.clumps     ? round_shape(members == MemberName::disc ? 2 : 3)
                 : file.ellipsoids ? Shape::superellipsoid
                                   : Shape(shape);
  if (!recipe.clumps)
    reader.refuse("members", "contradicts pack.shape = " + as_toml(shapes[std::size_t(shape)]) +
                                 "; allowed: with shape = \"clump\"; remove one");
  reader.whole_number("number", recipe.number, {1, 1e8}, "grains in all");
  reader.whole_number("seed", recipe.seed, {0, 9e15},
                      "seed of all random numbers; further specimens of --count take the next seeds");
  reader.number("thickness_m", recipe.thickness, "m", {positive, {{1e-7, 10}}}, "2D: thickness of the slab");
  if (dimension_of(recipe.shape) == 3)
    reader.refuse("thickness_m", std::string("contradicts pack.") + (recipe.clumps ? "members" : "shape") + " = " +
                                     as_toml(recipe.clumps ? "sphere" : shapes[std::size_t(shape)]) +
                                     "; allowed: in 2D only; remove one");
  reader.choice("cell", recipe.oriented, {"upright", "oriented"},
                "upright: square or cube; oriented: a lattice that compression along the axes never makes slender "
                "(Kraynik and Reinelt in 2D, a cubic field in 3D)");
  reader.choice("share_by", recipe.share_by_mass, {"number", "mass"}, "measure of grains.share");
}

/// Aspect ratios and bedding of grains that are not round; of others none may be given.
void read_outlines(TableReader& reader, GrainFraction& fraction, Shape shape) {
  reader.number("smallest_aspect_ratio", fraction.smallest_aspect_ratio, "1", aspect_ratio,
                "not round: smallest b/a; values up to the largest are equally frequent");
  reader.number("largest_aspect_ratio", fraction.largest_aspect_ratio, "1", aspect_ratio, "not round: largest b/a");
  reader.number("bedding_angle_deg", fraction.bedding_angle, "degrees", {-180, 180},
                "not round: mean angle from x to the long axes when the grains are placed");
  reader.number("bedding_spread_deg", fraction.bedding_spread, "degrees", {0, 90},
                "not round: largest deviation from it, all angles equally frequent; 90: no bedding. Of superellipsoids "
                "from the vertical to z of their shape, directions equally frequent; 90: every orientation");
  std::vector<const char*> others;
  if (!keeps_axis(shape)) others = {"smallest_aspect_ratio", "largest_aspect_ratio", "bedding_angle_deg"};
  if (is_round(shape)) others.push_back("bedding_spread_deg");
  for (const char* name : others)
    reader.refuse(name, "contradicts pack.shape = " + as_toml(std::string(rvelab::name(shape))) + "; allowed: with " +
                            (std::string(name) == "bedding_spread_deg"
                                 ? names_of_shapes([](Shape each) { return !is_round(each); }, true)
                                 : names_of_shapes(keeps_axis, true)) +
                            " only; remove one");
  if (!others.empty()) return;
  if (fraction.smallest_aspect_ratio > fraction.largest_aspect_ratio) {
    reader.mistake("smallest_aspect_ratio", "is above grains.largest_aspect_ratio; allowed: up to it; correct them");
  }
}

/// Half axes and exponents of superellipsoids; of others none may be given.
void read_solid(TableReader& reader, GrainFraction& fraction, Shape shape, bool ellipsoids) {
  const std::size_t mistakes = reader.mistakes();
  const std::vector<double> half = reader.numbers("half_axes", "1", {0, 1e6, true, false},
                                                  "superellipsoids: half axes along x, y, z of the shape, of which the "
                                                  "ratios count; radii of the grading are those of the sphere of the "
                                                  "same volume");
  const std::vector<double> exponents = reader.numbers(
      "exponents", "1", {2, largest_exponent},
      "shape = superellipsoid: e and n of (|x/a|^e + |y/b|^e)^(n/e) + |z/c|^n <= 1; 2 and 2: an ellipsoid");
  if (!moves_as_body(shape)) {
    for (const char* name : {"half_axes", "exponents"})
      reader.refuse(name, "contradicts pack.shape = " + as_toml(std::string(rvelab::name(shape))) +
                              "; allowed: with shape = \"ellipsoid\" or \"superellipsoid\"; remove one");
    return;
  }
  if (ellipsoids)
    reader.refuse("exponents", "contradicts pack.shape = \"ellipsoid\"; allowed: with \"superellipsoid\"; remove one");
  if (half.size() != 3)
    reader.mistake("half_axes", half.empty() ? "is missing; allowed: three numbers, as [1.25, 1, 0.8]; add it"
                                             : "is not three numbers; allowed: as [1.25, 1, 0.8]; correct it");
  if (!ellipsoids && exponents.size() != 2)
    reader.mistake("exponents", exponents.empty() ? "is missing; allowed: two numbers, as [4, 4]; add it"
                                                  : "is not two numbers; allowed: as [4, 4]; correct it");
  if (reader.mistakes() > mistakes) return;
  fraction.half_axes = {half[0], half[1], half[2]};
  if (!ellipsoids) {
    fraction.exponent_xy = exponents[0];
    fraction.exponent_z = exponents[1];
  }
  if (fraction.half_axes.minCoeff() < least_aspect_ratio * fraction.half_axes.maxCoeff())
    reader.mistake("half_axes", "has a longest more than 10 times the shortest; allowed: up to 10; correct it");
}

/// Of recipes of clumps: the shape, by name or from a file of members.
void read_clump(TableReader& reader, GrainFraction& fraction, const Recipe& recipe) {
  const int d = dimension_of(recipe.shape);
  std::string clump = "pair";
  static const std::string meaning =
      "shape = clump: " + names_of_clumps(3) + " (in 2D " + names_of_clumps(2) +
      "), or a file NAME.csv with columns x, y, z, r of its members in any unit; radii of the grading are those of the "
      "disc or sphere of the same area or volume";
  reader.text("clump", clump, meaning.c_str());
  if (!recipe.clumps) {
    reader.refuse("clump", "contradicts pack.shape = " + as_toml(std::string(rvelab::name(recipe.shape))) +
                               "; allowed: with shape = \"clump\"; remove one");
    return;
  }
  try {
    if (clump.size() > 4 && clump.ends_with(".csv")) {
      std::ifstream file(clump);
      if (!file) throw InputError("clump = " + as_toml(clump) + ": the file cannot be read; give its path");
      TextStream text;
      text << file.rdbuf();
      fraction.clump = clump_of(clump, read_members(text.str(), clump), d);
    } else {
      fraction.clump = published_clump(clump, d);
    }
  } catch (const InputError& error) {
    reader.mistake(error.what());
  }
}

void read_fraction(TableReader& reader, Recipe& recipe, bool ellipsoids) {
  GrainFraction fraction;
  reader.text("name", fraction.name, "name of a fraction, for --set grains.NAME.key=value");
  std::string material = recipe.materials.front().name;
  reader.text("material", material, "name of the material", "(the first)");
  reader.number("share", fraction.share, "1", {0, 1, true, false},
                "fraction of all grains, by pack.share_by; the shares of all [[grains]] add up to 1");
  const std::size_t mistakes = reader.mistakes();
  read_grading(reader, fraction.grading);
  reader.choice("sampling", fraction.sampling, {"random", "stratified"},
                "random: a grain from each of N equal parts of the number, at random within it; stratified: sizes, the "
                "same for every seed, whose d10, d50 and d90 by mass are within 3 % of those of the grading");
  if (reader.mistakes() == mistakes) {
    try {
      check_grading(fraction.grading, fraction.table().c_str());
    } catch (const InputError& error) {
      reader.mistake(error.what());
    }
  }
  read_outlines(reader, fraction, recipe.shape);
  read_solid(reader, fraction, recipe.shape, ellipsoids);
  read_clump(reader, fraction, recipe);
  Choices known;
  for (const Material& each : recipe.materials) known.push_back(each.name);
  const auto found = std::find(known.begin(), known.end(), material);
  fraction.material = std::size_t(found - known.begin());
  if (found == known.end())
    reader.mistake("material", "is no material of the recipe; allowed: " + listed(known) + "; name one of these");
  recipe.fractions.push_back(fraction);
}

void read_grains(const toml::table& file, Recipe& recipe, bool ellipsoids, toml::table& resolved,
                 std::vector<KeyError>& errors) {
  const toml::node* node = file.get("grains");
  toml::array list;
  recipe.fractions.clear();
  const auto read = [&](const toml::table& table) {
    GrainFraction named;
    named.name = table["name"].value_or(named.name);
    TableReader reader(table, "grains", named.table(), line_of(table), errors);
    read_fraction(reader, recipe, ellipsoids);
    reader.finish();
    list.push_back(reader.resolved());
  };
  if (node != nullptr && node->is_table()) {
    read(*node->as_table());
  } else if (node != nullptr && node->is_array_of_tables()) {
    for (const auto& item : *node->as_array()) read(*item.as_table());
  } else {
    const std::string text = "the recipe has no grains; allowed: [grains], or [[grains]] for each fraction; add it";
    errors.push_back(node == nullptr ? KeyError{0, text} : key_error(node->source(), text));
  }
  double shares = 0;
  for (std::size_t k = 0; k < recipe.fractions.size(); ++k) {
    shares += recipe.fractions[k].share;
    for (std::size_t other = 0; other < k; ++other) {
      if (recipe.fractions[k].name == recipe.fractions[other].name)
        errors.push_back({line_of(*node), "grains.name = " + as_toml(recipe.fractions[k].name) +
                                              " is there twice; allowed: a name of its own for each; rename one"});
    }
  }
  if (!recipe.fractions.empty() && !(std::abs(shares - 1) <= 1e-6)) {
    TextStream text;
    text << "the values of grains.share add up to " << shares << "; allowed: 1; correct them";
    errors.push_back({line_of(*node), text.str()});
  }
  resolved.insert("grains", list);
}

/// A law of --set leaves the keys of the file's law in a material: the recipe that makes the specimen again, and the
/// specimen, have none of them.
void leave_out_unread(toml::node& materials, const Specimen& specimen) {
  if (toml::array* list = materials.as_array())
    for (toml::node& each : *list) leave_out_unread(each, specimen);
  toml::table* table = materials.as_table();
  if (table == nullptr) return;
  std::vector<std::string> unread;
  for (const auto& [key, value] : *table) {
    const std::string name(key.str());
    if (!keys::laws_that_read(name).empty() && keys::key_in_use(specimen, name).empty()) unread.push_back(name);
  }
  for (const std::string& name : unread) table->erase(name);
}

/// Materials, contact model, damping and solver.
void read_parameters(const toml::table& file, Recipe& recipe, toml::table& resolved, std::vector<KeyError>& errors) {
  Specimen specimen;
  specimen.shape = recipe.shape;
  specimen.materials = {Material{}};
  const std::size_t mistakes = mistakes_in(errors);
  if (!file.contains("material"))
    errors.push_back({0, "the recipe has no material; allowed: [[material]] with its keys below; add it"});
  read_material_tables(file, specimen, errors);
  for (const LawParameter& each : law_parameters())
    if (keys::key_in_use(specimen, each.parameter.key).empty())
      for (Material& material : specimen.materials) material.*each.value = 0;
  if (specimen.materials.empty()) specimen.materials = {Material{}};
  recipe.materials = specimen.materials;
  recipe.contact = specimen.contact;
  recipe.damping = specimen.damping;
  recipe.solver = specimen.solver;
  if (mistakes_in(errors) == mistakes) {
    try {
      check_parameters(recipe.contact, recipe.damping, recipe.materials);
    } catch (const InputError& error) {
      errors.push_back({0, error.what()});
    }
  }
  for (const char* name : {"contact", "damping", "solver", "material"}) {
    if (const toml::node* node = file.get(name)) resolved.insert(name, *node);
  }
  if (toml::node* node = resolved.get("material")) leave_out_unread(*node, specimen);
}

/// Whether its grains are many enough, can carry its largest pressure, and are likely to be meant for it.
void read_together(const RecipeFile& file, std::vector<KeyError>& errors) {
  const Recipe& recipe = file.recipe;
  for (const std::string& line : too_few_grains(recipe)) errors.push_back({0, line, false, true});
  if (!recipe.stress) return;
  const int d = dimension_of(recipe.shape);
  double pressure = mean_pressure(*recipe.stress, d);
  for (const double each : file.pressures) pressure = std::max(pressure, each);
  for (const GrainFraction& fraction : recipe.fractions) {
    const double radius = number_curve(fraction.grading, d).radius_at(0.5);
    const Pressed pressed{file.pressures.empty() ? "target.pressure_Pa" : "target.pressures_Pa", pressure, recipe.shape,
                          radius, recipe.thickness};
    const std::vector<Material> own{recipe.materials.at(fraction.material)};
    expect_possible(pressed, recipe.contact, own);
    for (const std::string& line : unusual_overlaps(pressed, recipe.contact, own))
      errors.push_back({0, line, false, true});
  }
}

RecipeFile read_file(toml::table file, const std::string& path, const std::vector<std::string>& assignments) {
  std::vector<KeyError> errors;
  assign_all(file, assignments, errors);
  RecipeFile recipe;
  toml::table resolved;
  expect_top_tables(file, errors,
                    {"pack", "grains", "target", "preparation", "contact", "damping", "solver", "material"});
  const auto read = [&](const char* name, void (*by)(TableReader&, RecipeFile&)) {
    const toml::table& table = table_of(file, name, errors);
    TableReader reader(table, name, name, line_of(table), errors);
    by(reader, recipe);
    reader.finish();
    resolved.insert(name, reader.resolved());
  };
  read("pack", read_pack);
  read_parameters(file, recipe.recipe, resolved, errors);
  read_grains(file, recipe.recipe, recipe.ellipsoids, resolved, errors);
  read("target", read_target);
  read("preparation", read_preparation);
  raise(path, errors);
  try {
    check_recipe(recipe.recipe);
    read_together(recipe, errors);
  } catch (const InputError& error) {
    throw InputError(path + ": " + error.what());
  }
  recipe.doubts = doubts_in(errors);
  recipe.resolved = with_doubts(recipe.doubts, written_file(resolved));
  return recipe;
}

}  // namespace

std::vector<Key> recipe_keys() {
  const toml::table nothing;
  std::vector<KeyError> ignored;
  std::vector<Key> all;
  RecipeFile recipe;
  const auto document = [&](const char* table, void (*read)(TableReader&, RecipeFile&)) {
    TableReader reader(nothing, table, table, 0, ignored);
    read(reader, recipe);
    const std::vector<Key> keys = reader.keys();
    all.insert(all.end(), keys.begin(), keys.end());
  };
  document("pack", read_pack);
  document("grains",
           [](TableReader& reader, RecipeFile& file) { read_fraction(reader, file.recipe, file.ellipsoids); });
  document("target", read_target);
  document("preparation", read_preparation);
  return all;
}

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
  one.resolved = with_doubts(doubts, written_file(table));
  return one;
}

RecipeFile read_recipe(const std::string& path, const std::vector<std::string>& assignments) {
  return read_file(parse_toml_file(path), path, assignments);
}

RecipeFile parse_recipe(const std::string& text, const std::string& path, const std::vector<std::string>& assignments) {
  return read_file(parse_toml_text(text, path), path, assignments);
}

bool is_recipe(const std::string& path) { return parse_toml_file(path).contains("pack"); }

}  // namespace rvelab::pack
