#include "tools/mpm/scene/water.hpp"

#include <algorithm>
#include <cmath>

#include "tools/mpm/scene/checks.hpp"

namespace mpm {
namespace {

constexpr const char* dry_scene = "is of saturated soil, and the scene has no [fluid]; add it, or remove the key";

}  // namespace

TimeHistory read_time_history(Keys& keys, const std::string& name, const std::string& unit) {
  TimeHistory history;
  for (const auto& row : keys.rows(name, 2, {"_s", unit})) {
    if (!history.times.empty() && row[0] <= history.times.back()) {
      keys.wrong(name, "must go forward in time, and goes from " + in_words(history.times.back()) + " to " +
                           in_words(row[0]) + " s; sort its rows, and leave out what is there twice");
    }
    history.times.push_back(row[0]);
    history.values.push_back(row[1]);
  }
  return history;
}

namespace {

Shaking read_shaking(Keys keys, int dimension) {
  Shaking shaking;
  std::vector<std::string> axes(axis_names, axis_names + dimension);
  const auto axis = keys.choice("axis", axes);
  shaking.axis = int(std::find(axes.begin(), axes.end(), axis) - axes.begin());
  shaking.record = read_time_history(keys, "record", "_m_s2");
  if (keys.has("record_csv")) keys.text("record_csv");  // a text would have become rows
  if (shaking.record.times.empty()) {
    shaking.velocity = keys.number("velocity_m_s");
    shaking.frequency = keys.positive("frequency_Hz");
  } else {
    for (const char* name : {"velocity_m_s", "frequency_Hz"}) {
      if (keys.has(name)) keys.wrong(name, "is of harmonic shaking, and there is a record; remove one of them");
    }
  }
  keys.finish();
  return shaking;
}

Strip read_strip(Keys& keys) {
  Strip strip;
  strip.lower = keys.number("lower_m");
  strip.upper = keys.number("upper_m");
  strip.history = read_time_history(keys, "history", "_Pa");
  strip.peak = keys.number("half_sine_Pa", 0);
  if (strip.peak != 0) strip.duration = keys.positive("half_sine_s");
  keys.finish();
  if (!(strip.lower < strip.upper)) keys.wrong("upper_m", "must be above lower_m");
  if (strip.history.times.empty() && strip.peak == 0) {
    keys.wrong("history", "is missing, and so is half_sine_Pa; give rows [s, Pa], or a pulse");
  }
  return strip;
}

}  // namespace

std::optional<WaterOfScene> read_water(Keys& file, const Scene& scene) {
  if (!file.has("fluid")) return {};
  WaterOfScene water;
  auto keys = file.table("fluid");
  auto& options = water.options;
  options.density = keys.number("density_kg_m3", 1000, 1);
  water.conductivity = keys.positive("conductivity_m_s");
  options.follows_void_ratio = keys.boolean("follows_void_ratio", true);
  if (keys.has("bulk_modulus_Pa")) options.bulk_modulus = keys.positive("bulk_modulus_Pa");
  options.drained_surface = keys.choice("free_surface", {"drained", "membrane"}) == "drained";
  options.thickness = scene.thickness;
  water.porosity = keys.number("porosity", 0, 0.01, 0.99);  // 0: not told
  if (keys.has("water_table_m")) {
    water.table = keys.number("water_table_m");
  } else if (scene.stress == Scene::Stress::geostatic) {
    water.table = scene.surface;
  }
  keys.finish();
  const auto d = std::size_t(scene.dimension);
  if (keys.has("water_table_m") && !(scene.gravity[d - 1] < 0)) {
    keys.wrong("water_table_m", "needs gravity down the last axis; set loads.gravity_m_s2, or remove the key");
  }
  if (scene.scheme == Scheme::musl) {
    keys.wrong("conductivity_m_s", "is of saturated soil, which is stepped by USF; set time.scheme = \"usf\"");
  }
  return water;
}

WaterBoundary read_water_boundary(Keys& keys, bool with_water) {
  WaterBoundary boundary;
  std::string given;
  const auto give = [&](const char* name, WaterBoundary::Kind kind, double value) {
    if (!with_water) keys.wrong(name, dry_scene);
    if (!given.empty()) keys.wrong(name, "and " + given + " say the same thing twice; remove one of them");
    given = name;
    boundary = {kind, value};
  };
  const bool drained = keys.boolean("drained", false);
  if (keys.has("drained") && !with_water) keys.wrong("drained", dry_scene);
  if (drained) give("drained", WaterBoundary::Kind::pressure, 0);
  const double pressure = keys.number("pressure_Pa", 0), head = keys.number("head_m", 0);
  if (keys.has("pressure_Pa")) give("pressure_Pa", WaterBoundary::Kind::pressure, pressure);
  if (keys.has("head_m")) give("head_m", WaterBoundary::Kind::head, head);
  return boundary;
}

void read_region_water(Keys& keys, const std::optional<WaterOfScene>& water, RegionOfScene& region, bool grains) {
  region.saturated = keys.boolean("saturated", water.has_value());
  region.conductivity =
      keys.number("conductivity_m_s", water ? water->conductivity : 0, range_of("conductivity_m_s").least);
  for (const char* name : {"saturated", "conductivity_m_s"}) {
    if (keys.has(name) && !water) keys.wrong(name, dry_scene);
  }
  if (grains) {
    keys.positive("porosity");
  } else if (keys.has("porosity") && !water) {
    keys.wrong("porosity",
               "is of a table of grains or of saturated soil; give table, or the scene a [fluid], or remove the key");
  }
  region.porosity = keys.number("porosity", water ? water->porosity : 0, 0.01, 0.99);
}

Loads read_loads(Keys& keys, const Scene& scene) {
  Loads loads;
  if (keys.has("shaking")) loads.shaking = read_shaking(keys.table("shaking"), scene.dimension);
  keys.known("shaking");
  for (auto& each : keys.tables("strip")) loads.strips.push_back(read_strip(each));
  return loads;
}

void check_water(const Scene& scene, const std::string& path) {
  if (!scene.water) return;
  const auto& water = *scene.water;
  bool any = false;
  for (const auto& region : scene.regions) {
    if (!region.saturated) continue;
    any = true;
    const auto name = path + ": " + region_name(scene, region);
    const auto material = std::find_if(scene.materials.begin(), scene.materials.end(),
                                       [&](const auto& each) { return each.name == region.material; });
    const bool grains = material != scene.materials.end() && material->grains;
    if (!grains && !(region.porosity > 0)) {
      throw InputError(name +
                       ": the porosity of a saturated continuum is not told; set fluid.porosity or its porosity");
    }
    const long least = scene.dimension == 2 ? 4 : 8;
    if (region.points_per_cell < least) {
      throw InputError(name + ": points_per_cell is " + std::to_string(region.points_per_cell) +
                       ", and water seeps in and out of "
                       "cells with fewer than " +
                       std::to_string(least) + " saturated points for ever; set it to that at least");
    }
    if (region.upper.back() > water.table + 1e-6 * scene.cell.back()) {
      throw InputError(name + ": reaches " + in_words(region.upper.back()) +
                       " m, above fluid.water_table_m = " + in_words(water.table) +
                       ", and would start under suction; end it there, and set saturated = false above");
    }
  }
  if (!any) throw InputError(path + ": [fluid] is there, and no region is saturated; set saturated = true in one");
  if (!std::isnan(water.table) && scene.stress == Scene::Stress::geostatic &&
      water.table > scene.surface + 1e-6 * scene.cell.back()) {
    throw InputError(path + ": fluid.water_table_m = " + in_words(water.table) + " lies above initial.surface_m = " +
                     in_words(scene.surface) + ": free water is no part of the method; set it to the surface at most");
  }
}

}  // namespace mpm
