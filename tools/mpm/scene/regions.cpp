#include "tools/mpm/scene/regions.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/mpm/scene/water.hpp"

namespace mpm {
namespace {

void read_box(Keys& keys, std::size_t d, RegionOfScene& region) {
  region.lower = keys.vector("lower_m", d, {});
  region.upper = keys.vector("upper_m", d, {});
  region.points_per_cell = keys.whole_number("points_per_cell", d == 2 ? 4 : 8, 1, 1000);
  const long along = std::lround(std::pow(double(region.points_per_cell), 1.0 / double(d)));
  if (std::lround(std::pow(double(along), double(d))) != region.points_per_cell) {
    keys.wrong("points_per_cell", d == 2 ? "must be a square: 1, 4, 9, 16" : "must be a cube: 1, 8, 27");
  }
  region.ellipsoid = keys.choice("shape", {"box", "ellipsoid"}) == "ellipsoid";
}

/// lower and upper: half of the largest domain beyond the outermost points.
void read_grains(Keys& keys, std::size_t d, RegionOfScene& region) {
  for (const char* name : {"lower_m", "upper_m", "points_per_cell", "shape"}) {
    if (keys.has(name))
      keys.wrong(name, "is of a region that is filled, and this one has a table of grains; remove it");
  }
  if (keys.row_length("rows_m") != d + 1) {
    keys.wrong("rows_m", "has rows of " + std::to_string(keys.row_length("rows_m")) + " numbers; give " +
                             (d == 2 ? "x, y, radius" : "x, y, z, radius") + " of each grain");
  }
  region.grains = keys.rows("rows_m", d + 1);
  region.lower.assign(d, 1e300);
  region.upper.assign(d, -1e300);
  const double half = 0.5 * region.largest_side();
  for (const auto& grain : region.grains) {
    if (!(grain[d] >= range_of("radius_m").least))
      keys.wrong("rows_m", "has a grain of radius " + in_words(grain[d]) + "; radii must be positive, " +
                               in_words(range_of("radius_m").least) + " m or more");
    for (std::size_t i = 0; i < d; ++i) {
      region.lower[i] = std::min(region.lower[i], grain[i] - half);
      region.upper[i] = std::max(region.upper[i], grain[i] + half);
    }
  }
}

}  // namespace

double RegionOfScene::volume_of(const std::vector<double>& grain) const {
  const double r = grain.back();
  const double solids = grain.size() == 3 ? std::numbers::pi * r * r : 4 * std::numbers::pi / 3 * r * r * r;
  return solids / (1 - porosity);
}

double RegionOfScene::largest_side() const {
  double largest = 0;
  for (const auto& grain : grains) largest = std::max(largest, volume_of(grain));
  return std::pow(largest, 1.0 / double(lower.size()));
}

RegionOfScene read_region(Keys& keys, std::size_t d, const std::optional<WaterOfScene>& water) {
  RegionOfScene region;
  const bool table = keys.has("rows_m");
  region.material = keys.text("material");
  region.velocity = keys.vector("velocity_m_s", d, std::vector<double>(d, 0));
  keys.known("rows_m");
  if (keys.has("table")) keys.text("table");  // a text would have become rows
  if (table && water) keys.wrong("rows_m", "(table) is of dry soil, and the scene has [fluid]; fill a box instead");
  if (!table) {
    keys.known("table");
    read_box(keys, d, region);
  }
  read_region_water(keys, water, region, table);
  if (table) read_grains(keys, d, region);
  keys.finish();
  for (std::size_t i = 0; i < d; ++i) {
    if (!(region.lower[i] < region.upper[i])) keys.wrong("upper_m", "must be above lower_m along every axis");
  }
  return region;
}

}  // namespace mpm
