#include "tools/mpm/setup/setup.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "tools/mpm/scene/checks.hpp"
#include "tools/mpm/setup/plates.hpp"
#include "tools/mpm/setup/points.hpp"
#include "tools/mpm/setup/rocks.hpp"

namespace mpm {
namespace {

template <int D>
VelocityHistory<D> history(const std::vector<std::vector<double>>& rows) {
  VelocityHistory<D> history;
  for (const auto& row : rows) {
    history.times.push_back(row[0]);
    history.velocities.push_back(Eigen::Map<const Vec<D>>(row.data() + 1));
  }
  return history;
}

template <int D>
void place_planes(const Scene& scene, Solver<D>& solver) {
  for (const auto& each : scene.planes) {
    Plane<D> plane;
    plane.name = each.name;
    plane.axis = each.axis;
    const double node = (each.at - solver.grid.anchor[each.axis]) / solver.grid.cell[each.axis];
    plane.node = int(std::lround(node));
    if (std::abs(node - plane.node) > 1e-6) {
      throw InputError("boundary " + each.name + ": at_m must be a whole number of cells (grid.cell_m)");
    }
    plane.inside = each.soil_above ? 1 : -1;
    plane.fixed = each.fixed;
    plane.removed_at = each.removed_at;
    plane.impedance = each.impedance;
    (each.impedance > 0 ? plane.incoming : plane.velocity) = history<D>(each.motion);
    if (!std::isnan(each.to)) {
      const double cells = (each.to - each.at) / solver.grid.cell[each.axis];
      plane.period = int(std::lround(cells));
      if (std::abs(cells - plane.period) > 1e-6) {
        throw InputError("boundary " + each.name + ": to_m must be a whole number of cells (grid.cell_m) above at_m");
      }
    }
    if (each.name == scene.follows) {
      solver.follow_axis = each.axis;
      solver.followed = int(solver.planes.all.size());
      if (plane.node <= 0)
        throw InputError("boundary " + each.name + ": grid.follows needs it at a positive coordinate");
      // The step shrinks with the cells.
      if (each.at + plane.velocity.least_displacement(each.axis, scene.duration) < 0.01 * each.at) {
        throw InputError(
            "boundary " + each.name +
            ": its motion takes it to less than a hundredth of at_m within time.duration_s, and cells of no "
            "height have no time step; shorten motion or time.duration_s");
      }
    }
    solver.planes.all.push_back(plane);
  }
}

/// Contact is at points of the surface, a cell apart, which are visited each step.
template <int D>
void expect_countable_surface(const std::string& name, const BodyShape<D>& shape, const Vec<D>& cell) {
  constexpr double most = 1e7;
  double points = 0;
  std::string key = "size_m";
  if (const auto* box = std::get_if<Box<D>>(&shape)) {
    for (int i = 0; i < D; ++i) {
      double face = 2;
      for (int j = 0; j < D; ++j) face *= j == i ? 1 : 2 * box->half[j] / cell[j];
      points += face;
    }
  } else if (const auto* disc = std::get_if<Disc<D>>(&shape)) {
    key = "radius_m";
    points = 6.3 * disc->radius / cell.minCoeff();
  }
  if (points <= most) return;
  throw InputError("body." + name + "." + key + ": the surface would have " + in_words(points) +
                   " points of contact, a cell apart; allowed: up to " + in_words(most) +
                   "; make the body smaller or grid.cell_m larger, or take a half_space");
}

template <int D>
void place_bodies(const Scene& scene, Solver<D>& solver) {
  for (const auto& each : scene.bodies) {
    Body<D> body;
    body.name = each.name;
    body.shape = std::get<BodyShape<D>>(each.shape);
    expect_countable_surface<D>(each.name, body.shape, solver.grid.cell);
    body.centre = vector_of<D>(each.centre);
    body.rough = each.rough;
    body.friction = each.friction;
    body.at_surface = each.at_surface;
    body.velocity = history<D>(each.motion);
    solver.bodies.all.push_back(body);
    solver.bodies.shape = scene.shape;
  }
}

/// kg/m^3 of the soil itself without its water, by the name of the material.
using Densities = std::map<std::string, double>;

/// Of the soil of a region: with grains that of their first specimen.
double porosity_of(const Scene& scene, const RegionOfScene& region, const Densities& soils) {
  const auto& material = *std::find_if(scene.materials.begin(), scene.materials.end(),
                                       [&](const auto& each) { return each.name == region.material; });
  return material.grains ? 1 - soils.at(region.material) / material.grains->density : region.porosity;
}

/// kg/m^3, with the water of a saturated region.
double density_of(const Scene& scene, const RegionOfScene& region, const Densities& soils) {
  const double dry = soils.at(region.material);
  return region.saturated ? dry + porosity_of(scene, region, soils) * scene.water->options.density : dry;
}

/// The region that a point of this material was filled from.
template <int D>
const RegionOfScene& region_of(const Scene& scene, const Vec<D>& position, const std::string& material) {
  return *std::find_if(scene.regions.begin(), scene.regions.end(), [&](const auto& region) {
    bool inside = region.material == material;
    for (int i = 0; i < D; ++i) inside = inside && position[i] > region.lower[i] && position[i] < region.upper[i];
    return inside;
  });
}

/// Pa, of the pore water at a height.
template <int D>
double water_pressure_at(const Scene& scene, const RegionOfScene& region, double height) {
  if (!region.saturated || std::isnan(scene.water->table)) return 0;
  return scene.water->options.density * -scene.gravity[D - 1] * (scene.water->table - height);
}

/// Pa, compression positive, without the pore pressure: what a point of this material and height carries at the start.
/// Geostatic: of its own soil up to the surface, and by how much the layers of other soils above it are heavier.
template <int D>
double pressure_at(const Scene& scene, const Vec<D>& position, const std::string& material, const Densities& soils) {
  if (scene.stress == Scene::Stress::isotropic) return scene.pressure;
  if (scene.stress == Scene::Stress::zero) return 0;
  const auto& own = region_of<D>(scene, position, material);
  const double depth = scene.surface - position[D - 1], density = density_of(scene, own, soils);
  double pressure = scene.surface_pressure + density * -scene.gravity[D - 1] * depth;
  pressure -= water_pressure_at<D>(scene, own, position[D - 1]);
  for (const auto& region : scene.regions) {
    const double excess = density_of(scene, region, soils) - density;
    const double layer = region.upper[D - 1] - std::max(region.lower[D - 1], position[D - 1]);
    bool above = excess != 0 && layer > 0;
    for (int i = 0; i + 1 < D; ++i) above = above && position[i] > region.lower[i] && position[i] < region.upper[i];
    if (above) pressure += excess * -scene.gravity[D - 1] * layer;
  }
  return pressure;
}

template <int D>
void load_continuum(const Scene& scene, const MaterialOfScene& material, const Densities& soils, Point<D>* points,
                    long count) {
  for (long k = 0; k < count; ++k) {
    auto& point = points[k];
    point.mass = material.density * point.volume;
    const double vertical = pressure_at<D>(scene, point.position, material.name, soils);
    const double side = scene.stress == Scene::Stress::geostatic ? scene.earth_pressure_ratio * vertical : vertical;
    point.stress = -side * Mat<D>::Identity();
    point.stress(D - 1, D - 1) = -vertical;
    point.stress_zz = D == 2 ? -side : 0;
  }
}

/// Specimens of each material of grains.
using Families = std::map<std::string, std::unique_ptr<SpecimenFamily>>;

template <int D>
void open_specimens(const Scene& scene, const MaterialOfScene& material, const std::shared_ptr<GrainPool>& pool,
                    const std::string& folder, Families& families, Densities& soils) {
  std::vector<std::string> paths;
  for (const auto& name : material.grains->specimens) paths.push_back((std::filesystem::path(folder) / name).string());
  auto& family = families[material.name] = std::make_unique<SpecimenFamily>(pool, paths);
  const auto first = family->prepared(0);
  if (first.dimension != D) {
    throw InputError("material " + material.name + ": its specimen is of dimension " + std::to_string(first.dimension) +
                     ", the scene of " + std::to_string(D) + "; name another in specimens, or set scene.dimension");
  }
  soils[material.name] = material.grains->density / (1 + first.void_ratio);
  check_loads(scene, material.name, family->wave_modulus(), soils[material.name]);
}

template <int D>
std::shared_ptr<Grains<D>> load_grains(const Scene& scene, const MaterialOfScene& material, Model<D>& model,
                                       const std::shared_ptr<GrainPool>& pool, SpecimenFamily& family,
                                       const Densities& soils, Point<D>* points, long count) {
  std::vector<std::int64_t> ids;
  for (long k = 0; k < count; ++k) {
    // Points of one depth share one prepared state; round-off in their heights must not part them.
    const double exact = pressure_at<D>(scene, points[k].position, material.name, soils);
    const double pressure = std::stod(std::to_string(exact));
    if (!(pressure > 0)) {
      throw InputError("material " + material.name +
                       ": a point would carry no pressure; set initial.pressure_Pa, or "
                       "initial.surface_m to the height of the free surface");
    }
    ids.push_back(family.spawn(pressure));
    points[k].mass = material.grains->density / (1 + family.prepared(pressure).void_ratio) * points[k].volume;
  }
  model.pressure_classes += long(family.classes()) - 1;
  family.release();
  auto grains = std::make_shared<Grains<D>>(pool, std::move(ids), material.grains->at_rate, material.grains->gather);
  grains->read_stress(points);
  return grains;
}

/// Every watched point must have a network to write.
template <int D>
void expect_grains(const Model<D>& model) {
  for (std::size_t k = 0; k < model.watched.size(); ++k) {
    const auto& group = model.solver.group_of(model.watched[k]);
    if (model.grains.contains(group.name)) continue;
    throw InputError("output.networks is true, but the material " + group.name + " at output.watched_points_m[" +
                     std::to_string(k) + "] has no grains; take that point away, or set output.networks = false");
  }
}

/// Water in the points of saturated regions.
template <int D>
void fill_with_water(const Scene& scene, bool populate, Solver<D>& solver) {
  auto water = std::make_unique<Fluid<D>>();
  water->options = scene.water->options;
  for (const auto& plane : scene.planes) water->options.boundaries.push_back(plane.water);
  make_water_boundaries<D>(solver.planes, solver.bodies, *water);
  water->points.resize(solver.points.size());
  const auto& of = *scene.water;
  water->first_pressure = [table = of.table, weight = of.options.density * -vector_of<D>(scene.gravity)[D - 1]](
                              double y) { return std::isnan(table) ? 0 : weight * std::max(0.0, table - y); };
  for (const auto& group : solver.groups) {
    for (long k = group.first; populate && k < group.first + group.count; ++k) {
      const auto& point = solver.points[k];
      const auto& region = region_of<D>(scene, point.position, group.name);
      if (!region.saturated) continue;
      const auto& material = *std::find_if(scene.materials.begin(), scene.materials.end(),
                                           [&](const auto& each) { return each.name == group.name; });
      auto& here = water->points[k];
      here.solids = material.grains ? point.mass / material.grains->density : (1 - region.porosity) * point.volume;
      here.first_void_ratio = here.void_ratio(point.volume);
      here.conductivity = region.conductivity;
      here.pressure = here.first_pressure = water_pressure_at<D>(scene, region, point.position[D - 1]);
      here.first_vertical = -point.stress(D - 1, D - 1);
      here.velocity = point.velocity;
    }
  }
  solver.fluid = std::move(water);
}

template <int D>
void set_options(const Scene& scene, Solver<D>& solver) {
  solver.grid.cell = solver.first_cell = vector_of<D>(scene.cell);
  solver.options.shape = scene.shape;
  solver.options.scheme = scene.scheme;
  solver.options.pic_fraction = scene.pic_fraction;
  solver.options.affine = scene.affine;
  solver.options.cfl = scene.cfl;
  solver.options.gravity = vector_of<D>(scene.gravity);
  solver.options.surface_pressure = scene.surface_pressure;
  solver.loads = scene.loads;
}

/// What materials need before their points are there: pools of RVEs, specimens, densities.
template <int D>
struct Stock {
  const std::string& folder;
  bool populate;
  Families families;
  Densities soils;

  void open(const Scene& scene, Model<D>& model, const PoolSource& source) {
    for (const auto& material : scene.materials) {
      const auto& grains = material.grains;
      soils[material.name] = grains ? grains->density : material.density;
      if (!grains) continue;
      if (!model.pools.empty() && source.over_ranks) {
        throw InputError("material." + material.name +
                         ": a second material of grains, and ranks serve one pool; run this "
                         "scene by rvelab-mpm, on threads");
      }
      const GrainOptions options{grains->tolerance_rel, grains->tolerance_abs, source};
      const auto pool = std::make_shared<GrainPool>(model.solver.workers, options);
      model.pools[material.name] = pool;
      if (populate) open_specimens<D>(scene, material, pool, folder, families, soils);
    }
  }
};

/// Says how much of a region that was filled last lies above terrain.
template <int D>
void tell_of_ground(const Scene& scene, const RegionOfScene& region, std::size_t first, Model<D>& model) {
  const auto& solver = model.solver;
  const auto& bodies = solver.bodies.all;
  const bool ground = std::any_of(bodies.begin(), bodies.end(),
                                  [](const auto& body) { return std::holds_alternative<Terrain<D>>(body.shape); });
  if (!ground || region.ellipsoid || !region.grains.empty()) return;
  const auto filling = filling_of(scene, region);
  const double whole = double(filling.total) * vector_of<D>(filling.side).prod() * (D == 2 ? scene.thickness : 1);
  double volume = 0;
  for (std::size_t k = first; k < solver.points.size(); ++k) volume += solver.points[k].volume;
  model.told.push_back(region_name(scene, region) + ": " + in_words(volume) + " of its " + in_words(whole) +
                       " m3 are soil; the others lie in terrain or rocks");
}

/// The points of one material, and the law or the RVEs that they obey.
template <int D>
void add_group(const Scene& scene, const MaterialOfScene& material, Model<D>& model, Stock<D>& stock) {
  auto& solver = model.solver;
  MaterialGroup<D> group;
  group.first = long(solver.points.size());
  group.name = material.name;
  for (const auto& region : scene.regions) {
    if (region.material != material.name) continue;
    const std::size_t first = solver.points.size();
    fill<D>(scene, region, solver);
    tell_of_ground<D>(scene, region, first, model);
  }
  group.count = long(solver.points.size()) - group.first;
  Point<D>* points = solver.points.data() + group.first;
  if (!material.grains) {
    if (group.count > 0) check_loads(scene, material.name, material.continuum.wave_modulus, material.density);
    load_continuum<D>(scene, material, stock.soils, points, group.count);
    group.material = material.continuum.make<D>();
  } else {
    const auto& pool = model.pools.at(material.name);
    auto grains = stock.populate ? load_grains<D>(scene, material, model, pool, *stock.families.at(material.name),
                                                  stock.soils, points, group.count)
                                 : std::make_shared<Grains<D>>(pool, std::vector<std::int64_t>{},
                                                               material.grains->at_rate, material.grains->gather);
    model.grains[material.name] = grains;
    group.material = grains;
  }
  solver.groups.push_back(group);
}

template <int D>
void watch_points(const Scene& scene, Model<D>& model) {
  const auto& points = model.solver.points;
  if (points.empty() && !scene.watched.empty()) {
    throw InputError("output.watched_points_m: the scene has no material points; remove the key");
  }
  for (const auto& position : scene.watched) {
    const Vec<D> x = vector_of<D>(position);
    const auto nearer = [&](const auto& a, const auto& b) {
      return (a.position - x).squaredNorm() < (b.position - x).squaredNorm();
    };
    model.watched.push_back(std::min_element(points.begin(), points.end(), nearer) - points.begin());
  }
  if (scene.networks) expect_grains<D>(model);
}

}  // namespace

template <int D>
std::unique_ptr<Model<D>> set_up(const Scene& scene, int threads, const std::string& specimens, bool populate,
                                 const PoolSource& source) {
  auto model = std::make_unique<Model<D>>(threads);
  set_options(scene, model->solver);
  place_planes(scene, model->solver);
  place_bodies(scene, model->solver);
  place_plates<D>(scene, model->solver);
  place_rocks<D>(scene, model->solver);
  Stock<D> stock{specimens, populate, {}, {}};
  stock.open(scene, *model, source);
  for (const auto& material : scene.materials) add_group(scene, material, *model, stock);
  finish_rocks<D>(scene, model->solver, model->told);
  weigh_plates<D>(model->solver);
  if (scene.water) fill_with_water<D>(scene, populate, model->solver);
  watch_points(scene, *model);
  return model;
}

template std::unique_ptr<Model<2>> set_up<2>(const Scene&, int, const std::string&, bool, const PoolSource&);
template std::unique_ptr<Model<3>> set_up<3>(const Scene&, int, const std::string&, bool, const PoolSource&);

}  // namespace mpm
