// The key table of recipes: what `rvelab pack` reads. Declared in read_recipe.hpp.
#include "rvelab/keys/key_builders.hpp"
#include "rvelab/pack/read_recipe.hpp"

namespace rvelab::pack {
namespace {

using namespace keys;

constexpr Interval below_one{0, 1, true, true};
constexpr Interval friction{0, 1e6};
constexpr Interval stresses{-pressures.high, pressures.high};
constexpr Interval aspect_ratio{least_aspect_ratio, 1};

std::vector<TableKey> pack() {
  const char* t = "pack";
  const Recipe initial;
  const auto of_dimension = [](int d) {
    return names_of_shapes([d](Shape shape) { return dimension_of(shape) == d; });
  };
  Choices shapes;
  for (int number = 0; number < shape_count; ++number) shapes.emplace_back(name(Shape(number)));
  const std::string dimensions = of_dimension(2) + ": 2D; " + of_dimension(3) + ": 3D";
  return {
      required(text(t, "name", "", "name of the recipe")),
      choice(t, "shape", shapes, dimensions.c_str()),
      whole_number(t, "number", long(initial.number), {1, 1e8}, "grains in all"),
      whole_number(t, "seed", long(initial.seed), {0, 9e15},
                   "seed of all random numbers; further specimens of --count take the next seeds"),
      number(t, "thickness_m", "m", initial.thickness, positive, "2D: thickness of the slab"),
      choice(t, "cell", {"upright", "oriented"},
             "upright: square or cube; oriented: a lattice that compression along the axes never makes slender "
             "(Kraynik and Reinelt in 2D, a cubic field in 3D)"),
      choice(t, "share_by", {"number", "mass"}, "measure of grains.share"),
  };
}

std::vector<TableKey> grains() {
  const char* t = "grains";
  const GrainFraction initial_fraction;
  return {
      text(t, "name", "\"grains\"", "name of a fraction, for --set grains.NAME.key=value"),
      text(t, "material", "(the first)", "name of the material"),
      number(t, "share", "1", GrainFraction{}.share, {0, 1, true, false},
             "fraction of all grains, by pack.share_by; the shares of all [[grains]] add up to 1"),
      choice(t, "grading", {"uniform", "linear", "tabulated", "d10_d60"},
             "uniform: passing is linear in the radius; linear: linear in its logarithm; tabulated: given points, "
             "linear in the radius between them; d10_d60: by mass through d10, d50 and d60, linear in the logarithm"),
      number(t, "d10_mm", "mm", "", positive, "grading = d10_d60: diameter that 10 % of the mass pass"),
      number(t, "d50_mm", "mm", "", positive, "grading = d10_d60: mean diameter, that 50 % pass"),
      number(t, "d60_mm", "mm", "", positive, "grading = d10_d60: diameter that 60 % pass; d60/d10 is the uniformity"),
      choice(t, "passing_by", {"number", "mass"}, "measure of the passing fraction"),
      number(t, "smallest_radius_m", "m", "", positive,
             "grading = uniform, linear: radius at passing 0; of grains that are not round that of the disc of their "
             "area"),
      number(t, "largest_radius_m", "m", "", positive, "grading = uniform, linear: radius at passing 1"),
      number(t, "smallest_aspect_ratio", "1", initial_fraction.smallest_aspect_ratio, aspect_ratio,
             "not round: smallest b/a; values up to the largest are equally frequent"),
      number(t, "largest_aspect_ratio", "1", initial_fraction.largest_aspect_ratio, aspect_ratio,
             "not round: largest b/a"),
      number(t, "bedding_angle_deg", "degrees", initial_fraction.bedding_angle, {-180, 180},
             "not round: mean angle from x to the long axes when the grains are placed"),
      number(t, "bedding_spread_deg", "degrees", initial_fraction.bedding_spread, {0, 90},
             "not round: largest deviation from it, all angles equally frequent; 90: no bedding"),
      {{t, "radii_m", "m", "list of numbers", "", "each " + in_words(positive), "grading = tabulated: ascending radii"},
       KeyKind::numbers,
       positive,
       {},
       {}},
      {{t, "passing", "1", "list of numbers", "", "each 0 to 1",
        "grading = tabulated: fraction not larger than each radius, 0 first, 1 last"},
       KeyKind::numbers,
       {0, 1},
       {},
       {}},
  };
}

std::vector<TableKey> target() {
  const char* t = "target";
  const Recipe initial;
  return {
      number(t, "pressure_Pa", "Pa", "", pressures, "isotropic stress, compression positive; shear stresses are zero"),
      {{t, "pressures_Pa", "Pa", "list of numbers", "", "each " + in_words(pressures),
        "a family: the same grains at each of these pressures"},
       KeyKind::numbers,
       pressures,
       {},
       {}},
      {{t, "stress_Pa", "Pa", "list of numbers", "", "each " + in_words(stresses),
        "full stress, tension positive: xx, yy, xy in 2D, xx, yy, zz, yz, xz, xy in 3D; with pressures_Pa it is scaled "
        "to each mean pressure"},
       KeyKind::numbers,
       stresses,
       {},
       {}},
      number(t, "void_ratio", "1", "", {-1, infinity, true, true},
             "void ratio of the finished specimen, for which rvelab finds the preparation friction; without a stress: "
             "of the cell"),
      number(t, "porosity", "1", "", {-10, 1, true, true}, "porosity n = e/(1 + e), in place of void_ratio"),
      number(t, "relative_density", "1", "", {-1, 2},
             "D = (e_max - e)/(e_max - e_min) of the finished specimen, in place of void_ratio"),
      number(t, "e_min", "1", "", {-1, infinity, true, true},
             "relative_density: void ratio that the recipe reaches with preparation.friction = 0, without a target"),
      number(t, "e_max", "1", "", {-1, infinity, true, true},
             "relative_density: void ratio that it reaches with preparation.friction = 1e6"),
      number(t, "void_ratio_tolerance", "1", initial.void_ratio_tolerance, below_one,
             "allowed error of the void ratio"),
      number(t, "stress_tolerance", "1", initial.stress_tolerance, below_one,
             "allowed error of each stress component, over the mean pressure"),
      number(t, "unbalanced", "1", initial.unbalanced, below_one, "unbalanced force ratio of the finished specimen"),
  };
}

std::vector<TableKey> preparation() {
  const char* t = "preparation";
  const Preparation initial;
  return {
      choice(t, "method", {"compression", "growth", "regular"},
             "compression: the cell shrinks around scattered grains; growth: the radii grow in a cell that stands "
             "still; regular: 2D, equal grains in rows that lie, with the cell, at the bedding angle"),
      number(t, "friction", "1", "(searched, or that of the materials; 0 without a stress)", friction,
             "friction of all contacts during preparation: low for dense, high for loose specimens"),
      number(t, "rolling_friction", "1", initial.rolling_friction, {0, infinity, false, true},
             "largest eta of all materials during preparation"),
      number(t, "lowest_friction", "1", initial.lowest_friction, friction,
             "lower limit of the search for target.void_ratio"),
      number(t, "highest_friction", "1", initial.highest_friction, friction,
             "upper limit of the search for target.void_ratio"),
      whole_number(t, "max_draws", initial.max_draws, {1, 1e6}, "most draws of that search; then it fails"),
      number(t, "first_size", "1", initial.first_size, below_one, "method = growth: initial radii over the final ones"),
      number(t, "growth_void_ratio", "1", "(target.void_ratio + 0.1; without one 0.3 in 2D, 0.9 in 3D)",
             {0, infinity, true, true}, "method = growth: void ratio of the cell once the grains have grown"),
  };
}

}  // namespace

const std::vector<TableKey>& recipe_keys() {
  static const std::vector<TableKey> all = [] {
    std::vector<TableKey> keys;
    for (const auto& list : {pack(), grains(), target(), preparation()}) {
      keys.insert(keys.end(), list.begin(), list.end());
    }
    return keys;
  }();
  return all;
}

}  // namespace rvelab::pack
