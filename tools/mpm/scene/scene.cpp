#include "tools/mpm/scene/scene.hpp"

#include <algorithm>
#include <filesystem>

#include "tools/mpm/keys/included.hpp"
#include "tools/mpm/scene/checks.hpp"
#include "tools/mpm/scene/plates.hpp"
#include "tools/mpm/scene/regions.hpp"
#include "tools/mpm/scene/water.hpp"

namespace mpm {
namespace {

GrainsOfScene read_grains(Keys& keys) {
  GrainsOfScene grains;
  grains.specimens = keys.texts("specimens");
  grains.density = keys.number("grain_density_kg_m3", 2650, 1e-3);
  grains.at_rate = keys.choice("loading", {"quasi_static", "at_rate"}) == "at_rate";
  grains.tolerance_rel = keys.number("tolerance_rel", 0, 0, 1);
  grains.tolerance_abs = keys.number("tolerance_abs", 0, 0, 1);
  grains.gather = keys.number("gather", 0, 0, 1e-3);
  if (grains.gather > 0 && grains.at_rate) keys.wrong("gather", "is for quasi_static loading; remove it");
  return grains;
}

MaterialOfScene read_material(Keys& keys) {
  MaterialOfScene material;
  material.name = keys.name();
  std::vector<std::string> kinds{"grains"};
  for (const auto& each : continuum_kinds) kinds.emplace_back(each.name);
  const auto kind = keys.choice("kind", kinds, true);
  if (kind == "grains") {
    material.grains = read_grains(keys);
  } else {
    material.density = keys.number("density_kg_m3", 2000, 1e-3);
    const auto found = std::find_if(continuum_kinds.begin(), continuum_kinds.end(),
                                    [&](const auto& each) { return each.name == kind; });
    material.continuum = found->read(keys);
  }
  keys.finish();
  return material;
}

ChangeOfScene read_change(Keys& keys, std::size_t d) {
  ChangeOfScene change;
  change.name = keys.name();
  change.material = keys.text("material");
  change.at = keys.number("at_s", 0, 0);
  change.stages = keys.text("stages");
  if (keys.has("lower_m") || keys.has("upper_m")) {
    change.lower = keys.vector("lower_m", d, {});
    change.upper = keys.vector("upper_m", d, {});
  }
  keys.finish();
  for (std::size_t i = 0; i < change.lower.size(); ++i)
    if (!(change.lower[i] < change.upper[i])) keys.wrong("upper_m", "is not above lower_m; give the corners of a box");
  return change;
}

std::vector<std::vector<double>> read_motion(Keys& keys, std::size_t d) {
  auto rows = keys.rows("motion", d + 1, {"_s", "_m_s"});
  for (std::size_t k = 0; k < rows.size(); ++k) {
    if (k == 0 ? rows[k][0] != 0 : rows[k][0] <= rows[k - 1][0]) {
      keys.wrong("motion", "must begin at time 0 and go forward in time: rows of s and m/s");
    }
  }
  return rows;
}

int axis_of(const std::string& name) { return name == "x" ? 0 : name == "y" ? 1 : 2; }

PlaneOfScene read_plane(Keys& keys, std::size_t d, const std::string& followed, bool with_water) {
  PlaneOfScene plane;
  plane.name = keys.name();
  const auto kind = keys.choice("kind", {"roller", "fixed", "absorbing", "periodic"}, true);
  plane.fixed = kind == "fixed";
  plane.axis = axis_of(
      keys.choice("axis", d == 2 ? std::vector<std::string>{"x", "y"} : std::vector<std::string>{"x", "y", "z"}, true));
  plane.at = keys.number("at_m");
  if (kind == "periodic") {
    plane.to = keys.number("to_m");
    if (keys.has("to_m") && !(plane.to > plane.at))
      keys.wrong("to_m", "is the upper of two planes that are one; give more than at_m");
  } else {
    plane.soil_above = keys.choice("soil", {"above", "below"}) == "above";
    plane.motion = read_motion(keys, d);
  }
  if (kind == "absorbing") plane.impedance = keys.positive("density_kg_m3") * keys.positive("shear_wave_m_s");
  plane.removed_at = keys.number("removed_at_s", 1e300, 0);
  plane.water = read_water_boundary(keys, with_water);
  keys.finish();
  for (const auto& row : plane.motion) {
    for (int i = 0; i < int(d); ++i) {
      if (row[std::size_t(i) + 1] == 0) continue;
      if (i == plane.axis && kind == "absorbing")
        keys.wrong("motion", "is the shear wave that comes up: along the plane");
      if (i == plane.axis && plane.name != followed) {
        keys.wrong("motion", "moves the plane off its nodes, which stay; set grid.follows = \"" + plane.name +
                                 "\", or take a [[body]] in its place");
      }
      if (i != plane.axis && !plane.fixed && kind != "absorbing") {
        keys.wrong("motion", "is along a smooth plane, which takes no soil along; set kind = \"fixed\", or make it 0");
      }
    }
  }
  return plane;
}

template <int D>
BodyOfScene read_body(Keys& keys) {
  BodyOfScene body;
  BodyShape<D> shape;
  body.name = keys.name();
  const auto kind = keys.choice("kind", kinds_of(shape), true);
  body.centre = keys.vector("centre_m", D, {});
  read_shape(shape, kind, keys);
  body.rough = keys.boolean("rough", std::visit([](const auto& any) { return any.rough_by_default; }, shape));
  body.friction = keys.number("friction", 0, 0, 100);
  if (body.rough && keys.has("friction")) {
    keys.wrong("friction", "is of a body that is not rough, and a " + kind + " is unless told; set rough = false");
  }
  body.at_surface = keys.choice("contact", {"surface", "nodes"}) == "surface";
  body.motion = read_motion(keys, D);
  body.plate = read_plate(keys);
  keys.finish();
  std::visit([&](auto& any) { any.settle(keys); }, shape);
  body.shape = shape;
  return body;
}

void read_rest(Keys& file, Scene& scene) {
  const auto d = std::size_t(scene.dimension);
  auto grid = file.table("grid");
  scene.cell = grid.vector("cell_m", d, {}, true);
  const auto shape = grid.choice("shape", {"bspline", "gimp", "linear"});
  scene.shape = shape == "bspline" ? Shape::bspline : shape == "gimp" ? Shape::gimp : Shape::linear;
  scene.follows = grid.text("follows", "");
  grid.finish();
  for (const double side : scene.cell) {
    if (grid.has("cell_m")) grid.expect_positive("cell_m", side);
  }
  auto time = file.table("time");
  scene.duration = time.positive("duration_s");
  scene.scheme = time.choice("scheme", {"usf", "musl"}) == "usf" ? Scheme::usf : Scheme::musl;
  scene.pic_fraction = time.number("pic_fraction", 0.1, 0, 1);
  scene.affine = time.boolean("affine", true);
  scene.cfl = time.number("cfl", 0.4, 1e-4, 1);
  scene.rock_steps = time.number("rock_steps_per_collision", 50, 10, 1e5);
  time.finish();
  auto loads = file.table("loads");
  scene.gravity = loads.vector("gravity_m_s2", d, std::vector<double>(d, 0));
  scene.surface_pressure = loads.number("surface_pressure_Pa", 0);
  scene.loads = read_loads(loads, scene);
  loads.finish();
  auto initial = file.table("initial");
  const auto stress = initial.choice("stress", {"zero", "isotropic", "geostatic"});
  if (stress == "isotropic") {
    scene.stress = Scene::Stress::isotropic;
    scene.pressure = initial.number("pressure_Pa");
  } else if (stress == "geostatic") {
    scene.stress = Scene::Stress::geostatic;
    scene.surface = initial.number("surface_m");
    scene.earth_pressure_ratio = initial.number("earth_pressure_ratio", 1, 0, 10);
  }
  initial.finish();
  if (scene.stress == Scene::Stress::geostatic) {
    for (std::size_t i = 0; i < d; ++i) {
      if (i + 1 < d ? scene.gravity[i] == 0 : scene.gravity[i] < 0) continue;
      initial.wrong("stress", std::string("is geostatic, which needs gravity down the last axis alone; set "
                                          "loads.gravity_m_s2 = ") +
                                  (d == 2 ? "[0, -9.81]" : "[0, 0, -9.81]") + ", or another initial.stress");
    }
  }
  scene.water = read_water(file, scene);
  auto output = file.table("output");
  // Outputs come once a step at most; intervals far below any step would be counted through one by one.
  const double least = 1e-6 * scene.duration;
  scene.frame_every = output.number("frame_every_s", scene.duration / 20, least);
  scene.history_every = output.number("history_every_s", scene.duration / 500, least);
  scene.checkpoint_every = output.number("checkpoint_every_s", scene.duration / 10, least);
  scene.watched = output.rows("watched_points_m", d);
  scene.networks = output.boolean("networks", false);
  if (scene.networks && scene.watched.empty()) {
    output.wrong("networks", "is for chosen points; name them in watched_points_m, or set it to false");
  }
  output.finish();
}

toml::table parse_scene(const std::string& path) {
  const std::filesystem::path file(path);
  if (std::error_code none; std::filesystem::exists(file, none)) return rvelab::keys::parse_toml_file(path);
  throw InputError(path + ": there is no such file; a scene goes by its path, such as protocols/mpm/" +
                   (file.extension().empty() && !file.stem().empty() ? file.stem().string() : "column_soil") + ".toml");
}

/// Tables key by key, arrays of tables element by element, everything else as a whole.
void override_table(toml::table& base, const toml::table& over) {
  for (const auto& [key, node] : over) {
    auto* mine = base.get(key.str());
    if (mine != nullptr && mine->is_table() && node.is_table()) {
      override_table(*mine->as_table(), *node.as_table());
    } else if (mine != nullptr && mine->is_array_of_tables() && node.is_array_of_tables()) {
      auto& list = *mine->as_array();
      const auto& other = *node.as_array();
      for (std::size_t k = 0; k < other.size(); ++k) {
        if (k >= list.size()) list.push_back(toml::table());
        override_table(*list[k].as_table(), *other[k].as_table());
      }
    } else {
      base.insert_or_assign(key.str(), node);
    }
  }
}

}  // namespace

std::vector<std::string> cases_of(const std::string& path) {
  std::vector<std::string> names;
  const auto file = parse_scene(path);
  if (const auto* cases = file["case"].as_table()) {
    for (const auto& [key, node] : *cases) names.emplace_back(key.str());
  }
  return names;
}

Scene read_scene(const std::string& path, const std::vector<std::string>& cases,
                 const std::vector<std::string>& assignments, toml::table* resolved) {
  toml::table file = parse_scene(path);
  for (const auto& name : cases) {
    const auto* over = file["case"][name].as_table();
    if (over == nullptr) throw InputError(path + ": there is no case " + name + one_of(cases_of(path), name));
    const toml::table copy = *over;
    override_table(file, copy);
  }
  std::vector<rvelab::keys::KeyError> errors;
  rvelab::keys::assign_all(file, assignments, errors, 1);
  rvelab::keys::raise(path, errors);
  include_rows(file, "loads.shaking", "record_csv", "record", path);
  include_rows(file, "region", "table", "rows_m", path);
  include_rocks(file, path);
  include_terrain(file, path);
  Keys keys(file, path, "");
  // A misspelt table is reported before a key that is missing because of it.
  for (const char* name : {"scene", "grid", "time", "loads", "initial", "fluid", "output", "material", "region",
                           "change", "boundary", "body", "rock_material", "rock", "rocks", "rock_soil", "case"}) {
    keys.known(name);
  }
  keys.finish();
  Scene scene;
  auto head = keys.table("scene");
  scene.name = head.text("name");
  scene.dimension = int(head.whole_number("dimension", 2, 2, 3));
  scene.thickness = scene.dimension == 2 ? head.number("thickness_m", 1, 1e-9) : 1;
  head.finish();
  read_rest(keys, scene);
  const auto d = std::size_t(scene.dimension);
  for (auto& each : keys.tables("material")) scene.materials.push_back(read_material(each));
  for (auto& each : keys.tables("change")) scene.changes.push_back(read_change(each, d));
  std::stable_sort(scene.changes.begin(), scene.changes.end(),
                   [](const auto& a, const auto& b) { return a.at < b.at; });
  for (auto& each : keys.tables("region")) scene.regions.push_back(read_region(each, d, scene.water));
  for (auto& each : keys.tables("boundary")) {
    scene.planes.push_back(read_plane(each, d, scene.follows, scene.water.has_value()));
  }
  for (auto& each : keys.tables("body")) scene.bodies.push_back(d == 2 ? read_body<2>(each) : read_body<3>(each));
  read_rocks(keys, scene);
  check_scene(scene, path);
  if (resolved != nullptr) {
    file.erase("case");
    *resolved = file;
  }
  return scene;
}

}  // namespace mpm
