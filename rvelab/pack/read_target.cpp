#include "rvelab/pack/read_target.hpp"

#include <algorithm>

#include "rvelab/error.hpp"
#include "rvelab/measure/measures.hpp"

namespace rvelab::pack {
namespace {

using namespace keys;

constexpr Interval below_one{0, 1, true, true};
constexpr Range friction{{0, 1e6}, friction_values};
constexpr Interval stresses{-pressures.high, pressures.high};

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

/// What the mean pressure of a stress is looked at by.
Key stress_as_key() {
  Key key;
  key.unit = "Pa";
  key.usual = pressures.usual;
  return key;
}

void read_stress(TableReader& reader, RecipeFile& file) {
  Recipe& recipe = file.recipe;
  const int d = dimension_of(recipe.shape);
  const auto pressure = reader.optional_number("pressure_Pa", "Pa", pressures,
                                               "isotropic stress, compression positive; shear stresses are zero");
  file.pressures =
      reader.numbers("pressures_Pa", "Pa", pressures, "a family: the same grains at each of these pressures");
  const auto components = reader.numbers(
      "stress_Pa", "Pa", stresses,
      "full stress, tension positive: xx, yy, xy in 2D, xx, yy, zz, yz, xz, xy in 3D; with pressures_Pa it is scaled "
      "to each mean pressure");
  for (const char* other : {"pressures_Pa", "stress_Pa"})
    if (pressure) reader.refuse(other, "contradicts target.pressure_Pa; allowed: one of the two; remove one");
  if (pressure) recipe.stress = isotropic_stress(*pressure, recipe.shape);
  if (!components.empty()) {
    recipe.stress = stress_of(components, recipe.shape);
    if (!recipe.stress)
      reader.mistake("stress_Pa", d == 2
                                      ? "is not a stress in 2D; allowed: [xx, yy, xy]; give three numbers"
                                      : "is not a stress in 3D; allowed: [xx, yy, zz, yz, xz, xy]; give six numbers");
    else if (!(mean_pressure(*recipe.stress, d) > 0))
      reader.mistake("stress_Pa",
                     "has no mean pressure; allowed: tension positive with -(xx + yy [+ zz]) > 0; give "
                     "compressive normal stresses as negative numbers");
    else if (file.pressures.empty())
      reader.doubt("stress_Pa", keys::unusual_in(stress_as_key(), mean_pressure(*recipe.stress, d)));
  }
  if (!file.pressures.empty() && file.pressures.front() > 0) {
    if (!recipe.stress) recipe.stress = isotropic_stress(1, recipe.shape);
    *recipe.stress *= file.pressures.front() / mean_pressure(*recipe.stress, d);
  }
}

/// The void ratio of a relative density between the limits of the recipe.
void read_relative_density(TableReader& reader, Recipe& recipe) {
  const auto density =
      reader.optional_number("relative_density", "1", {-1, 2},
                             "D = (e_max - e)/(e_max - e_min) of the finished specimen, in place of void_ratio");
  const auto e_min = reader.optional_number(
      "e_min", "1", {-1, infinity, true, true},
      "relative_density: void ratio that the recipe reaches with preparation.friction = 0, without a target");
  const auto e_max =
      reader.optional_number("e_max", "1", {-1, infinity, true, true},
                             "relative_density: void ratio that it reaches with preparation.friction = 1e6");
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

/// The expansion of agitated grains, and how far it may be reduced.
void read_expansion(TableReader& reader, Preparation& p) {
  p.expansion = reader.optional_number(
      "expansion", "1", {0, largest_expansion, true},
      "strain of the cell along each axis, after which the grains collide without friction and are compressed with "
      "their own, as in a shaken sand; the larger, the fewer contacts",
      "(searched for target.coordination_number; else the grains are not agitated)");
  p.least_expansion = reader.optional_number(
      "least_expansion", "1", {0, largest_expansion},
      "where agitated grains are denser than the target at any preparation friction, rvelab takes a third of "
      "preparation.expansion, again and again, down to this; 0: in the end the grains are not agitated",
      "(the expansion is not reduced)");
}

/// Number of contacts and fabric.
void read_contact_target(TableReader& reader, ContactTarget& contacts) {
  contacts.coordination_number = reader.optional_number(
      "coordination_number", "1", {2, 20},
      "contacts a grain of the finished specimen, 2 Nc/N without grains that bear nothing, for which rvelab finds "
      "preparation.expansion",
      "(what the preparation gives)");
  reader.number("coordination_number_tolerance", contacts.coordination_tolerance, "1", below_one,
                "allowed error of the coordination number");
  contacts.fabric_anisotropy = reader.optional_number(
      "fabric_anisotropy", "1", {-2, 2},
      "anisotropy of the contacts along target.fabric_direction, negative where more lie across it, for which rvelab "
      "finds preparation.strain_difference",
      "(what the preparation gives)");
  reader.number("fabric_anisotropy_tolerance", contacts.fabric_tolerance, "1", below_one,
                "allowed error of the fabric anisotropy");
  const Choices axes{"x", "y", "z"};
  if (const std::string name =
          reader.choice("fabric_direction", std::string(), axes,
                        "axis of the fabric and of the compression of agitated grains", "(z, in 2D y)");
      !name.empty())
    contacts.axis = int(std::find(axes.begin(), axes.end(), name) - axes.begin());
}

}  // namespace

void read_target(keys::TableReader& reader, RecipeFile& file) {
  Recipe& recipe = file.recipe;
  read_stress(reader, file);
  recipe.void_ratio = reader.optional_number(
      "void_ratio", "1", {{-1, infinity, true, true}, {{-1, 10}}},
      "void ratio of the finished specimen, for which rvelab finds the preparation friction; without a stress: of the "
      "cell");
  const auto porosity =
      reader.optional_number("porosity", "1", {-10, 1, true, true}, "porosity n = e/(1 + e), in place of void_ratio");
  if (porosity && recipe.void_ratio)
    reader.mistake("porosity", "contradicts target.void_ratio; allowed: one of the two; remove one");
  if (porosity) recipe.void_ratio = *porosity / (1 - *porosity);
  read_relative_density(reader, recipe);
  bool stress_named = false;
  for (const char* name : {"pressure_Pa", "pressures_Pa", "stress_Pa"})
    stress_named = stress_named || reader.has(name) || reader.has_in_another_unit(name);
  if (!stress_named && !recipe.void_ratio && !reader.has("void_ratio") && !reader.has("relative_density"))
    reader.mistake("pressure_Pa", "is missing, and so is target.void_ratio; allowed: one of them or both; add one");
  read_contact_target(reader, recipe.contacts);
  reader.number("void_ratio_tolerance", recipe.void_ratio_tolerance, "1", below_one, "allowed error of the void ratio");
  reader.number("stress_tolerance", recipe.stress_tolerance, "1", below_one,
                "allowed error of each stress component, over the mean pressure");
  reader.number("unbalanced", recipe.unbalanced, "1", below_one, "unbalanced force ratio of the finished specimen");
}

void read_preparation(keys::TableReader& reader, RecipeFile& file) {
  Recipe& recipe = file.recipe;
  Preparation& p = recipe.preparation;
  const Choices methods{"compression", "growth", "regular"};
  reader.choice("method", p.method, methods,
                "compression: the cell shrinks around scattered grains; growth: the radii grow in a cell that stands "
                "still; regular: 2D, equal grains in rows that lie, with the cell, at the bedding angle");
  p.friction = reader.optional_number(
      "friction", "1", friction, "friction of all contacts during preparation: low for dense, high for loose specimens",
      "(searched, or that of the materials; 0 without a stress)");
  reader.number("rolling_friction", p.rolling_friction, "1", not_negative,
                "largest eta of all materials during preparation");
  reader.number("lowest_friction", p.lowest_friction, "1", friction, "lower limit of the search for target.void_ratio");
  reader.number("highest_friction", p.highest_friction, "1", friction,
                "upper limit of the search for target.void_ratio");
  reader.whole_number("max_draws", p.max_draws, {1, 1e6}, "most trial packings of that search; then it fails");
  reader.number("first_size", p.first_size, "1", below_one, "method = growth: initial radii over the final ones");
  p.growth_void_ratio = reader.optional_number("growth_void_ratio", "1", positive,
                                               "method = growth: void ratio of the cell once the grains have grown",
                                               "(target.void_ratio + 0.1; without one 0.3 in 2D, 0.9 in 3D)");
  read_expansion(reader, p);
  p.strain_difference = reader.optional_number(
      "strain_difference", "1", {-largest_strain_difference, largest_strain_difference},
      "of that compression: strain along target.fabric_direction less that across it, over the larger; positive makes "
      "more contacts along it",
      "(searched for target.fabric_anisotropy; else 0)");
  if (p.method != Preparation::Method::growth && recipe.stress)
    for (const char* name : {"first_size", "growth_void_ratio"})
      reader.refuse(name, "contradicts method = " + as_toml(methods[std::size_t(p.method)]) +
                              "; allowed: with method = \"growth\"; remove one");
  if (p.friction && recipe.stress && recipe.void_ratio)
    reader.mistake("friction",
                   "contradicts target.void_ratio, for which the friction is searched; allowed: one of the "
                   "two; remove one");
  if (!(p.lowest_friction < p.highest_friction))
    reader.mistake("highest_friction", "is not above preparation.lowest_friction; allowed: above it; correct one");
}

}  // namespace rvelab::pack
