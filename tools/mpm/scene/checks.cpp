#include "tools/mpm/scene/checks.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "tools/mpm/grid/point.hpp"
#include "tools/mpm/scene/plates.hpp"
#include "tools/mpm/scene/water.hpp"

namespace mpm {

namespace {

constexpr double most_points = 5e7;
constexpr double farthest_cell = 1e9;  // numbers of nodes are int

/// Points along one axis of a region, before it is known that they can be counted.
double points_along(const Scene& scene, const RegionOfScene& region, std::size_t axis) {
  const double along = std::round(std::pow(double(region.points_per_cell), 1.0 / double(scene.dimension)));
  return std::max(1.0, std::round((region.upper[axis] - region.lower[axis]) / scene.cell[axis] * along));
}

void check_materials(const Scene& scene, const std::string& path) {
  std::set<std::string> materials;
  for (const auto& material : scene.materials) {
    if (!materials.insert(material.name).second) throw InputError(path + ": two materials are called " + material.name);
    if (material.grains && scene.stress == Scene::Stress::zero) {
      throw InputError(path + ": grains carry a pressure from the start; set initial.stress to isotropic or geostatic");
    }
    if (material.grains && scene.earth_pressure_ratio != 1) {
      throw InputError(path + ": grains are consolidated isotropically; set initial.earth_pressure_ratio to 1");
    }
  }
  for (const auto& region : scene.regions) {
    if (materials.contains(region.material)) continue;
    throw InputError(path + ": region.material is \"" + region.material + "\"" + one_of(materials, region.material));
  }
}

void check_changes(const Scene& scene, const std::string& path) {
  std::set<std::string> grains, names;
  for (const auto& material : scene.materials)
    if (material.grains) grains.insert(material.name);
  for (const auto& change : scene.changes) {
    if (!names.insert(change.name).second)
      throw InputError(path + ": two changes are called " + change.name + "; rename one");
    if (grains.contains(change.material)) continue;
    throw InputError(path + ": change." + change.name + ".material is \"" + change.material +
                     "\", and no material of kind = \"grains\"" + one_of(grains, change.material));
  }
}

void check_boundaries(const Scene& scene, const std::string& path) {
  std::set<std::string> planes, all;
  const auto expect_new = [&](const std::string& name) {
    if (all.insert(name).second) return;
    throw InputError(path + ": two boundaries, bodies or rocks are called " + name + "; columns go by it: rename one");
  };
  for (const auto& plane : scene.planes) {
    expect_new(plane.name);
    planes.insert(plane.name);
    if (std::abs(plane.at / scene.cell[std::size_t(plane.axis)]) < farthest_cell) continue;
    throw InputError(path + ": boundary." + plane.name + ".at_m is " + in_words(plane.at) +
                     ", too many cells from 0; move it nearer, or make grid.cell_m larger");
  }
  for (const auto& body : scene.bodies) expect_new(body.name);
  for (std::size_t k = 0; scene.rocks && k < scene.rocks->all.size(); ++k) {
    if (scene.rocks->all[k].single) expect_new(scene.rocks->all[k].name);
  }
  if (scene.follows.empty()) return;
  if (!planes.contains(scene.follows)) {
    throw InputError(path + ": grid.follows is \"" + scene.follows + "\"" + one_of(planes, scene.follows));
  }
  const auto& followed = *std::find_if(scene.planes.begin(), scene.planes.end(),
                                       [&](const auto& plane) { return plane.name == scene.follows; });
  for (const auto& plane : scene.planes) {
    if (plane.axis != followed.axis || plane.name == followed.name || plane.at == 0) continue;
    throw InputError(path + ": boundary." + plane.name + ".at_m is " + in_words(plane.at) +
                     ", and would move along with grid.follows, which shortens all cells across " +
                     axis_names[plane.axis] + "; put it at 0, or take a [[body]] in its place");
  }
}

/// GB, of points with their supports and of the nodes of the background grid.
double memory_of(const Scene& scene, double points, double nodes) {
  const bool plane = scene.dimension == 2;
  const double point = plane ? sizeof(Point<2>) + sizeof(Support<2>) : sizeof(Point<3>) + sizeof(Support<3>);
  return 1e-9 * (points * (point + 2 * sizeof(long)) + nodes * (plane ? sizeof(Node<2>) : sizeof(Node<3>)));
}

/// m, along an axis, of the box that holds all regions.
double extent(const Scene& scene, std::size_t axis) {
  double lowest = 1e300, highest = -1e300;
  for (const auto& region : scene.regions) {
    lowest = std::min(lowest, region.lower[axis]);
    highest = std::max(highest, region.upper[axis]);
  }
  return highest - lowest;
}

/// Of the box that holds all regions, with four to each side.
double nodes_of(const Scene& scene) {
  double nodes = scene.regions.empty() ? 0 : 1;
  for (std::size_t i = 0; i < scene.cell.size() && nodes > 0; ++i)
    nodes *= std::ceil(extent(scene, i) / scene.cell[i]) + 9;
  return nodes;
}

void check_grid(const Scene& scene, const std::string& path) {
  const double nodes = nodes_of(scene), most = double(Grid<3>::most);
  if (nodes <= most) return;
  throw InputError(path + ": grid.cell_m is " + in_words(scene.cell) + ": the box around all regions would have " +
                   in_words(nodes) + " nodes (" + in_words(memory_of(scene, 0, nodes)) +
                   " GB), and a scene has at most " + in_words(most) +
                   "; make grid.cell_m larger, or put the regions nearer to each other");
}

/// The step follows from the fastest wave, before any point is there.
void check_steps(const Scene& scene, const std::string& path) {
  const double cell = *std::min_element(scene.cell.begin(), scene.cell.end());
  for (const auto& material : scene.materials) {
    if (material.grains) continue;
    const double speed = std::sqrt(material.continuum.wave_modulus / material.density);
    const double steps = scene.duration * speed / (scene.cfl * cell);
    if (steps <= most_steps) continue;
    throw InputError(path + ": time.duration_s = " + in_words(scene.duration) + " would need " + in_words(steps) +
                     " steps of " + in_words(scene.cfl * cell / speed) + " s, in which the wave of material " +
                     material.name + " (" + in_words(speed) + " m/s: modulus " +
                     in_words(material.continuum.wave_modulus) + " Pa, density " + in_words(material.density) +
                     " kg/m^3) crosses a part of a cell of " + in_words(cell) +
                     " m (grid.cell_m, time.cfl); allowed: up to " + in_words(most_steps) +
                     "; make young_modulus_Pa smaller, density_kg_m3 or grid.cell_m larger, or "
                     "time.duration_s shorter");
  }
}

void check_sizes(const Scene& scene, const std::string& path) {
  double total = 0;
  for (const auto& region : scene.regions) {
    double points = region.grains.empty() ? 1 : double(region.grains.size());
    for (std::size_t i = 0; i < scene.cell.size(); ++i) {
      if (region.grains.empty()) points *= points_along(scene, region, i);
      if (std::max(std::abs(region.lower[i]), std::abs(region.upper[i])) < farthest_cell * scene.cell[i]) continue;
      throw InputError(path + ": " + region_name(scene, region) + " from " + in_words(region.lower) + " to " +
                       in_words(region.upper) +
                       " m lies too many cells from 0; move it nearer, or make grid.cell_m larger");
    }
    total += points;
    if (total <= most_points) continue;
    throw InputError(path + ": " + region_name(scene, region) + " would have " + in_words(points) +
                     " material points (" + in_words(memory_of(scene, points, 0)) + " GB), and a scene has at most " +
                     in_words(most_points) + "; make grid.cell_m larger, or the region or points_per_cell smaller");
  }
}

/// Of a box and a table, either way round.
bool no_grain_inside(const RegionOfScene& a, const RegionOfScene& b) {
  const auto& box = a.grains.empty() ? a : b;
  const auto& table = a.grains.empty() ? b : a;
  return std::none_of(table.grains.begin(), table.grains.end(), [&](const auto& grain) {
    bool inside = true;
    for (std::size_t i = 0; i < box.lower.size(); ++i) {
      inside = inside && grain[i] > box.lower[i] && grain[i] < box.upper[i];
    }
    return inside;
  });
}

/// Two tables may share a place, but not under a geostatic stress, of which each region is a layer.
void check_overlaps(const Scene& scene, const std::string& path) {
  for (auto a = scene.regions.begin(); a != scene.regions.end(); ++a) {
    for (auto b = scene.regions.begin(); b != a; ++b) {
      bool apart = !a->grains.empty() && !b->grains.empty() && scene.stress != Scene::Stress::geostatic;
      if (a->grains.empty() != b->grains.empty()) apart = no_grain_inside(*a, *b);
      for (std::size_t i = 0; i < scene.cell.size(); ++i) {
        const double shared = std::min(a->upper[i], b->upper[i]) - std::max(a->lower[i], b->lower[i]);
        apart = apart || shared < 1e-6 * scene.cell[i];
      }
      if (apart) continue;
      throw InputError(path + ": " + region_name(scene, *b) + " and " + region_name(scene, *a) +
                       " overlap, and would fill that place twice; change lower_m or upper_m of one");
    }
  }
}

void check_sides(const Scene& scene, const std::string& path) {
  for (const auto& region : scene.regions) {
    const auto filling = filling_of(scene, region);
    for (const auto& plane : scene.planes) {
      if (!(plane.removed_at > 0)) continue;
      const auto i = std::size_t(plane.axis);
      const double first = region.lower[i] + 0.5 * filling.side[i], last = region.upper[i] - 0.5 * filling.side[i];
      const double slack = 1e-6 * scene.cell[i];
      if (!std::isnan(plane.to) && last > plane.to + slack) {
        throw InputError(path + ": points of " + region_name(scene, region) + " lie beyond boundary." + plane.name +
                         ".to_m = " + in_words(plane.to) + "; end the region there, or set to_m to its end");
      }
      if (plane.soil_above ? first > plane.at - slack : last < plane.at + slack) continue;
      throw InputError(path + ": points of " + region_name(scene, region) + " lie behind boundary." + plane.name +
                       " (soil " + (plane.soil_above ? "above " : "below ") + axis_names[i] + " = " +
                       in_words(plane.at) + " m); set soil = \"" + (plane.soil_above ? "below" : "above") +
                       "\" there, or move the region");
    }
    const double top = region.upper.back() - 0.5 * filling.side.back();
    if (scene.stress == Scene::Stress::geostatic && top > scene.surface + 1e-6 * scene.cell.back()) {
      throw InputError(path + ": points of " + region_name(scene, region) +
                       " lie above initial.surface_m = " + in_words(scene.surface) +
                       ", and would start under tension; set it to the height of the free surface");
    }
  }
}

void check_watched(const Scene& scene, const std::string& path) {
  for (std::size_t k = 0; k < scene.watched.size(); ++k) {
    const bool near = std::any_of(scene.regions.begin(), scene.regions.end(), [&](const auto& region) {
      const auto side = filling_of(scene, region).side;
      bool within = true;
      for (std::size_t i = 0; i < side.size(); ++i) {
        const double x = scene.watched[k][i], reach = scene.cell[i] - 0.5 * side[i];
        within = within && x > region.lower[i] - reach && x < region.upper[i] + reach;
      }
      return within;
    });
    if (near) continue;
    throw InputError(path + ": output.watched_points_m[" + std::to_string(k) + "] is " + in_words(scene.watched[k]) +
                     ", more than a cell from any material point; move it into a region, or take it away");
  }
}

}  // namespace

Filling filling_of(const Scene& scene, const RegionOfScene& region) {
  Filling filling;
  if (!region.grains.empty()) {
    filling.total = long(region.grains.size());
    filling.side.assign(scene.cell.size(), region.largest_side());
    return filling;
  }
  for (std::size_t i = 0; i < scene.cell.size(); ++i) {
    filling.count.push_back(long(points_along(scene, region, i)));
    filling.side.push_back((region.upper[i] - region.lower[i]) / double(filling.count[i]));
    filling.total *= filling.count[i];
  }
  return filling;
}

std::string region_name(const Scene& scene, const RegionOfScene& region) {
  return "region." + std::to_string(&region - scene.regions.data()) + " (of " + region.material + ")";
}

void expect_memory(const Scene& scene) {
  double points = 0;
  for (const auto& region : scene.regions) points += double(filling_of(scene, region).total);
  const double needed = memory_of(scene, points, nodes_of(scene));
  const double there = 1e-9 * double(sysconf(_SC_PHYS_PAGES)) * double(sysconf(_SC_PAGESIZE));
  if (needed <= there) return;
  throw InputError(in_words(points) + " material points and the nodes around them need " + in_words(needed) +
                   " GB, and this machine has " + in_words(there) +
                   " GB; make grid.cell_m larger, or a [[region]] or its points_per_cell smaller");
}

void check_scene(const Scene& scene, const std::string& path) {
  check_materials(scene, path);
  check_changes(scene, path);
  check_boundaries(scene, path);
  if (scene.regions.empty() && !scene.rocks) {
    throw InputError(path + ": there is no [[region]]; the scene has no material points");
  }
  check_sizes(scene, path);
  check_grid(scene, path);
  check_steps(scene, path);
  check_overlaps(scene, path);
  check_sides(scene, path);
  check_watched(scene, path);
  check_water(scene, path);
  check_plates(scene, path);
  check_rocks(scene, path);
}

namespace {

constexpr double largest_strain = 0.5;  // by a load at once

/// Something that moves: its name as a key, and its velocities (m/s).
struct Moving {
  std::string key;
  std::vector<std::vector<double>> velocities;
  bool soil;
};

std::vector<Moving> all_moving(const Scene& scene) {
  std::vector<Moving> all;
  for (const auto& region : scene.regions) {
    all.push_back({region_name(scene, region) + ".velocity_m_s", {region.velocity}, true});
  }
  const auto driven = [&](const std::string& key, const std::vector<std::vector<double>>& motion) {
    Moving moving{key + ".motion", {}, false};
    for (const auto& row : motion) moving.velocities.emplace_back(row.begin() + 1, row.end());
    if (motion.empty()) moving.velocities.emplace_back(scene.cell.size(), 0.0);
    all.push_back(moving);
  };
  for (const auto& plane : scene.planes) driven("boundary." + plane.name, plane.motion);
  for (const auto& body : scene.bodies) driven("body." + body.name, body.motion);
  return all;
}

/// m/s, the largest difference of their velocities.
double relative_speed(const Moving& a, const Moving& b) {
  double largest = 0;
  for (const auto& v : a.velocities) {
    for (const auto& w : b.velocities) {
      double square = 0;
      for (std::size_t i = 0; i < v.size(); ++i) square += (v[i] - w[i]) * (v[i] - w[i]);
      largest = std::max(largest, std::sqrt(square));
    }
  }
  return largest;
}

/// The box presses its soil by what it accelerates over the length of the soil, or by its speed, whichever is less.
void check_shaking(const Scene& scene, const std::string& material, double modulus, double density, double fastest) {
  const auto& shaking = scene.loads.shaking;
  if (!shaking.any() || (scene.planes.empty() && scene.bodies.empty())) return;
  double speed = std::abs(shaking.velocity), largest = shaking.velocity == 0 ? 0 : 1e300, now = 0;
  const auto& record = shaking.record;
  for (std::size_t k = 0; k < record.times.size(); ++k) {
    largest = std::max(largest, std::abs(record.values[k]));
    if (k == 0) continue;
    now += 0.5 * (record.values[k] + record.values[k - 1]) * (record.times[k] - record.times[k - 1]);
    speed = std::max(speed, std::abs(now));
  }
  const double pressure = density * largest * extent(scene, std::size_t(shaking.axis));
  if (!(speed > fastest && pressure > largest_strain * modulus)) return;
  throw InputError(std::string("loads.shaking.") + (record.times.empty() ? "velocity_m_s" : "record") +
                   ": it moves the box at up to " + in_words(speed) + " m/s, and waves in material " + material +
                   " at " + in_words(fastest / largest_strain) +
                   " m/s: soil would be compressed by half or more at once; allowed: up to " + in_words(fastest) +
                   " m/s; make it slower, or the material stiffer");
}

}  // namespace

void check_loads(const Scene& scene, const std::string& material, double modulus, double density) {
  const auto refuse_pressure = [&](const std::string& key, const std::string& value, double pressure) {
    if (!(std::abs(pressure) > largest_strain * modulus)) return;
    throw InputError(key + " = " + value + ": a pressure of " + in_words(std::abs(pressure)) +
                     " Pa would compress material " + material + ", of the modulus " + in_words(modulus) +
                     " Pa, by half of its height or more; allowed: up to " + in_words(largest_strain * modulus) +
                     " Pa; make the load smaller, or the material stiffer");
  };
  refuse_pressure("loads.surface_pressure_Pa", in_words(scene.surface_pressure), scene.surface_pressure);
  refuse_pressure("initial.pressure_Pa", in_words(scene.pressure), scene.pressure);
  for (const auto& body : scene.bodies) {
    if (!body.plate) continue;
    const auto& values = body.plate->pressure.values;
    const double most = *std::max_element(values.begin(), values.end());
    refuse_pressure("body." + body.name + ".pressure_Pa", in_words(most), most);
  }
  const auto moving = all_moving(scene);
  // Soil that nothing holds falls without being pressed.
  for (std::size_t i = 0; i < scene.cell.size() && !(scene.planes.empty() && scene.bodies.empty()); ++i)
    refuse_pressure("loads.gravity_m_s2", in_words(scene.gravity), density * scene.gravity[i] * extent(scene, i));
  for (const auto& strip : scene.loads.strips) {
    refuse_pressure("loads.strip.half_sine_Pa", in_words(strip.peak), strip.peak);
    for (const double each : strip.history.values) refuse_pressure("loads.strip.history", in_words(each), each);
  }
  const double fastest = largest_strain * std::sqrt(modulus / density);
  check_shaking(scene, material, modulus, density, fastest);
  for (std::size_t a = 0; a < moving.size(); ++a) {
    for (std::size_t b = a + 1; b < moving.size(); ++b) {
      // Two bodies press what is between them from both sides.
      const double speed = relative_speed(moving[a], moving[b]) / (moving[a].soil || moving[b].soil ? 1 : 2);
      if (!(speed > fastest)) continue;
      throw InputError(moving[b].key + ": against " + moving[a].key + " it moves at up to " + in_words(speed) +
                       " m/s, and waves in material " + material + " at " + in_words(2 * fastest) +
                       " m/s: what they meet would be compressed by half or more at once; allowed: up to " +
                       in_words(fastest) + " m/s; make it slower, or the material stiffer");
    }
  }
}

}  // namespace mpm
