#include "rvelab/pack/regular.hpp"

#include <algorithm>
#include <cmath>

#include "rvelab/error.hpp"
#include "rvelab/grains/direction.hpp"

namespace rvelab::pack {

namespace {

const double root_of_three = std::sqrt(3.0);

/// Of the touching lattice: contacts are found where grains overlap.
constexpr double closeness = 1 - 1e-6;

[[noreturn]] void refuse(const std::string& text) { throw InputError(text); }

}  // namespace

RowCounts row_counts(std::size_t number, double aspect_ratio) {
  RowCounts best;
  double least = 0;
  for (std::size_t rows = 2; 2 * rows <= number; rows += 2) {
    if (number % rows != 0) continue;
    const double wide = 2 * double(number / rows), high = root_of_three * aspect_ratio * double(rows);
    const double slender = std::max(wide / high, high / wide);
    if (best.rows == 0 || slender < least) {
      best = {number / rows, rows};
      least = slender;
    }
  }
  return best;
}

void check_regular(const Recipe& recipe) {
  const std::string method = "preparation.method = \"regular\"";
  if (!fills_rows(recipe.shape))
    refuse("pack.shape = \"" + std::string(name(recipe.shape)) + "\" contradicts " + method +
           "; allowed: " + names_of_shapes(fills_rows) + "; choose one of these");
  if (!recipe.stress)
    refuse("target.pressure_Pa is missing, which " + method + " presses its rows to; allowed: a stress; add it");
  if (recipe.void_ratio)
    refuse("target.void_ratio contradicts " + method + ", whose void ratio follows from its rows; remove one");
  if (recipe.oriented)
    refuse("pack.cell = \"oriented\" contradicts " + method + ", whose cell lies along its rows; allowed: upright");
  const GrainFraction& fraction = recipe.fractions.front();
  const Grading& grading = fraction.grading;
  const bool alike = recipe.fractions.size() == 1 && grading.curve != GradingCurve::tabulated &&
                     grading.smallest_radius == grading.largest_radius &&
                     fraction.smallest_aspect_ratio == fraction.largest_aspect_ratio;
  if (!alike)
    refuse(fraction.table() + ": " + method +
           " takes grains of one size and form; allowed: one [grains], smallest_radius_m = largest_radius_m and "
           "smallest_aspect_ratio = largest_aspect_ratio; make them equal");
  if (keeps_axis(recipe.shape) && fraction.bedding_spread != 0)
    refuse(fraction.table() + ".bedding_spread_deg = " + in_words(fraction.bedding_spread) + " contradicts " + method +
           ", whose grains lie alike; allowed: 0; set it");
  if (row_counts(recipe.number, fraction.smallest_aspect_ratio).rows == 0) {
    const std::size_t nearest = std::max<std::size_t>(4, (recipe.number + 2) / 4 * 4);
    refuse("pack.number = " + std::to_string(recipe.number) + " makes no rows; allowed with " + method +
           ": two or more grains in each of an even number of rows; take " + std::to_string(nearest));
  }
}

Cell lay_rows(const Recipe& recipe, Grains& grains) {
  const GrainFraction& fraction = recipe.fractions.front();
  const RowCounts counts = row_counts(grains.size(), fraction.smallest_aspect_ratio);
  const Extent extent = extent_of(recipe.shape, grains.radius[0], grains, 0);
  const double apart = closeness * 2 * extent.outer, height = closeness * root_of_three * extent.inner;
  Cell cell;
  cell.dimension = 2;
  cell.lattice = Vector3(double(counts.in_row) * apart, double(counts.rows) * height, recipe.thickness).asDiagonal();
  if (keeps_axis(recipe.shape)) {
    const auto [c, s] = direction_of(fraction.bedding_angle);
    cell.rotation << c, -s, 0, s, c, 0, 0, 0, 1;
    grains.orientation.assign(grains.size(), Vector3::UnitX());
  }
  for (std::size_t g = 0; g < grains.size(); ++g) {
    const std::size_t row = g / counts.in_row, place = g % counts.in_row;
    grains.position[g] = Vector3((double(place) + 0.5 * double(row % 2)) * apart, double(row) * height, 0);
    wrap(cell, grains.position[g]);
  }
  return cell;
}

}  // namespace rvelab::pack
