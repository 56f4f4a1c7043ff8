#include "tools/mpm/scene/rocks.hpp"

#include <algorithm>
#include <numbers>

#include "rvelab/grains/mesh.hpp"
#include "rvelab/keys/regular_file.hpp"
#include "tools/mpm/keys/included.hpp"
#include "tools/mpm/scene/scene.hpp"

namespace mpm {
namespace {

constexpr double degree = std::numbers::pi / 180;

std::size_t number_of(Keys& keys, const RocksOfScene& rocks) {
  const auto name = keys.text("material");
  std::set<std::string> known;
  for (std::size_t k = 0; k < rocks.materials.size(); ++k) {
    if (rocks.materials[k].name == name) return k;
    known.insert(rocks.materials[k].name);
  }
  if (keys.has("material")) {
    keys.wrong("material", "is \"" + name + "\"" +
                               (known.empty() ? ", and there is no [[rock_material]]; add it" : one_of(known, name)));
  }
  return 0;
}

RockMaterialOfScene read_rock_material(Keys& keys) {
  RockMaterialOfScene material;
  material.name = keys.name();
  material.density = keys.positive("density_kg_m3");
  material.constants.young_modulus = keys.positive("young_modulus_Pa");
  material.constants.poisson_ratio = keys.number("poisson_ratio", 0.25, -0.99, 0.5);
  material.constants.friction = keys.number("friction", 0.5, 0, 100);
  material.constants.restitution = keys.number("restitution", 0.5, 0, 1);
  keys.finish();
  return material;
}

std::vector<double> blockiness_of(Keys& keys, int d) {
  if (!keys.has("blockiness")) return {2, 2};
  auto values = keys.numbers("blockiness", d == 2 ? 1 : 2);
  for (const double each : values) {
    if (each < 2 || each > 50)
      keys.wrong("blockiness", "holds " + in_words(each) + "; allowed: 2 (round) to 50 (a box)");
  }
  values.resize(2, values[0]);
  return values;
}

/// In the plane an angle (degrees); in space an axis and an angle.
std::vector<double> rotation_of(Keys& keys, int d) {
  if (!keys.has("rotation_deg")) return d == 2 ? std::vector<double>{0} : std::vector<double>{1, 0, 0, 0};
  if (d == 2) return {keys.number("rotation_deg") * degree};
  const auto values = keys.numbers("rotation_deg", 4);
  const Vec<3> axis(values[0], values[1], values[2]);
  if (!(axis.norm() > 1e-9)) keys.wrong("rotation_deg", "has no axis; give [x, y, z, angle]");
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(values[3] * degree, axis.normalized()));
  return {turn.w(), turn.x(), turn.y(), turn.z()};
}

void read_form(Keys& keys, int d, RockOfScene& rock) {
  const auto form = keys.choice("shape", d == 2 ? std::vector<std::string>{"sphere", "superquadric"}
                                                : std::vector<std::string>{"sphere", "superquadric", "polyhedron"});
  if (form == "sphere") {
    rock.radius = keys.positive("radius_m");
  } else if (form == "superquadric") {
    rock.form = RockOfScene::Form::superquadric;
    rock.half_axes = keys.vector("half_axes_m", std::size_t(d), {});
    rock.blockiness = blockiness_of(keys, d);
    for (const double axis : rock.half_axes) {
      if (keys.has("half_axes_m")) keys.expect_positive("half_axes_m", axis);
    }
  } else {
    rock.form = RockOfScene::Form::polyhedron;
    if (keys.has("triangles_m")) {
      keys.known("file_stl");
    } else {
      keys.text("file_stl");
    }
    rock.triangles = keys.rows("triangles_m", 9);
  }
}

RockOfScene read_rock(Keys& keys, const RocksOfScene& rocks, int d) {
  const auto axes = std::size_t(d);
  RockOfScene rock;
  rock.name = keys.name();
  rock.material = number_of(keys, rocks);
  read_form(keys, d, rock);
  rock.centre = keys.vector("centre_m", axes, {});
  rock.rotation = rotation_of(keys, d);
  rock.velocity = keys.vector("velocity_m_s", axes, std::vector<double>(axes, 0));
  rock.spin = d == 2 ? std::vector<double>{keys.number("spin_rad_s", 0)} : keys.vector("spin_rad_s", 3, {0, 0, 0});
  if (keys.has("held")) {
    rock.held = keys.texts("held");
    for (const auto& each : rock.held) {
      const bool axis = std::any_of(axis_names, axis_names + d, [&](const char* name) { return each == name; });
      if (!axis && each != "rotation") {
        keys.wrong("held", "names \"" + each + "\"; allowed: x, y" + (d == 3 ? ", z" : "") + ", rotation");
      }
    }
  }
  keys.finish();
  return rock;
}

/// One rock for each row: place and radius, or place, half axes and orientation.
void read_rows(Keys& keys, int d, const RockOfScene& like, std::vector<RockOfScene>& all) {
  const std::size_t balls = d == 2 ? 3 : 4, turned = d == 2 ? 5 : 10;
  const bool round = keys.row_length("rows_m") == balls;
  if (!round && keys.row_length("rows_m") != turned) {
    keys.wrong("rows_m", "has rows of " + std::to_string(keys.row_length("rows_m")) + " numbers; give " +
                             (d == 2 ? "x, y, radius, or x, y, half axes a, b, angle in degrees"
                                     : "x, y, z, radius, or x, y, z, half axes a, b, c, quaternion w, x, y, z"));
  }
  if (round && keys.has("blockiness"))
    keys.wrong("blockiness", "is of rows with half axes; these are spheres: remove it");
  for (const auto& row : keys.rows("rows_m", round ? balls : turned)) {
    RockOfScene rock = like;
    rock.centre.assign(row.begin(), row.begin() + d);
    rock.rotation = d == 2 ? std::vector<double>{0} : std::vector<double>{1, 0, 0, 0};
    if (round) {
      rock.radius = row.back();
    } else {
      rock.form = RockOfScene::Form::superquadric;
      rock.half_axes.assign(row.begin() + d, row.begin() + 2 * d);
      rock.rotation.assign(row.begin() + 2 * d, row.end());
      if (d == 2) rock.rotation[0] *= degree;
    }
    const double least = round ? rock.radius : *std::min_element(rock.half_axes.begin(), rock.half_axes.end());
    if (!(least >= range_of("radius_m").least))
      keys.wrong("rows_m", "has a rock of size " + in_words(least) + "; sizes must be positive, " +
                               in_words(range_of("radius_m").least) + " m or more");
    if (d == 3 && !(Eigen::Map<const Vec<4>>(rock.rotation.data()).norm() > 0)) {
      keys.wrong("rows_m", "has a quaternion of length 0; give [1, 0, 0, 0] for a rock that is not turned");
    }
    all.push_back(rock);
  }
}

void read_group(Keys& keys, RocksOfScene& rocks, int d) {
  const auto axes = std::size_t(d);
  RockOfScene like;
  like.single = false;
  like.name = keys.name();
  like.material = number_of(keys, rocks);
  like.velocity.assign(axes, 0);
  like.spin.assign(d == 2 ? 1 : 3, 0);
  RockField field;
  field.name = like.name;
  field.material = like.material;
  field.blockiness = like.blockiness = blockiness_of(keys, d);
  keys.known("table");
  if (keys.has("table")) keys.text("table");
  if (keys.has("rows_m")) {
    read_rows(keys, d, like, rocks.all);
    keys.finish();
    return;
  }
  field.lower = keys.vector("lower_m", axes, {});
  field.upper = keys.vector("upper_m", axes, {});
  field.share = keys.positive("volume_share");
  field.diameters = keys.rows("diameters_m", 2, {"_m", ""});
  field.spread = keys.number("spread", 0, 0, 0.9);
  field.aspect = keys.vector("aspect", axes, std::vector<double>(axes, 1));
  field.aligned = keys.choice("orientation", {"random", "aligned"}) == "aligned";
  if (keys.has("rotation_deg") && !field.aligned) {
    keys.wrong("rotation_deg", "is of orientation = \"aligned\"; set that, or remove it");
  }
  field.rotation = rotation_of(keys, d);
  field.gap = keys.number("gap_m", 0, 0);
  field.seed = keys.whole_number("seed", 1, 0, 1'000'000'000);
  keys.finish();
  if (field.diameters.empty()) keys.wrong("diameters_m", "is missing; give rows [diameter in m, part by volume]");
  for (const auto& row : field.diameters) {
    if (!(row[0] >= range_of("_m").least && row[1] >= range_of("").least))
      keys.wrong("diameters_m", "has the row " + in_words(row) + ", which is not positive; give [diameter, part], " +
                                    in_words(range_of("_m").least) + " m or more");
  }
  if (field.share > 0.6) keys.wrong("volume_share", "is " + in_words(field.share) + "; allowed: up to 0.6");
  for (std::size_t i = 0; i < axes; ++i) {
    if (!(field.lower[i] < field.upper[i])) keys.wrong("upper_m", "must be above lower_m along every axis");
    if (!(field.aspect[i] >= 1e-3 && field.aspect[i] <= 1e3))
      keys.wrong("aspect", "holds " + in_words(field.aspect[i]) + "; allowed: 0.001 to 1000 along every axis");
  }
  draw_rocks(field, rocks.all);
}

RockSoil read_rock_soil(Keys keys) {
  RockSoil soil;
  soil.ghosts = keys.choice("contact", {"surface", "ghost"}) == "ghost";
  soil.rough = keys.boolean("rough", false);
  soil.friction = keys.number("friction", 0.3, 0, 100);
  if (soil.rough && keys.has("friction")) keys.wrong("friction", "and rough = true exclude each other; remove one");
  for (const char* name : {"porosity", "young_modulus_Pa", "poisson_ratio", "moment"}) {
    if (keys.has(name) && !soil.ghosts)
      keys.wrong(name, "is of contact = \"ghost\"; remove it, or set contact to that");
  }
  soil.porosity = keys.number("porosity", 0, 0, 0.9);
  if (keys.has("young_modulus_Pa")) {
    soil.ball.young_modulus = keys.positive("young_modulus_Pa");
    soil.ball.poisson_ratio = keys.number("poisson_ratio", 0.25, -0.99, 0.5);
  } else if (keys.has("poisson_ratio")) {
    keys.wrong("poisson_ratio", "goes with young_modulus_Pa; give both, or none for the rock's own");
  }
  soil.moment = keys.boolean("moment", true);
  keys.finish();
  return soil;
}

}  // namespace

void include_rocks(toml::table& file, const std::string& scene_path) {
  include_rows(file, "rocks", "table", "rows_m", scene_path);
  include_files(file, "rock", "file_stl", scene_path, [](toml::table& table, const std::string& path) {
    const auto mesh = rvelab::read_stl(rvelab::keys::whole_file<std::string>(path, "an STL file"), path);
    toml::array rows;
    for (const auto& triangle : mesh.triangles) {
      toml::array row;
      for (const int corner : triangle) {
        for (const double x : mesh.corners[std::size_t(corner)]) row.push_back(x);
      }
      rows.push_back(std::move(row));
    }
    table.insert_or_assign("triangles_m", std::move(rows));
  });
}

void read_rocks(Keys& file, Scene& scene) {
  RocksOfScene rocks;
  std::set<std::string> materials, groups;
  for (auto& each : file.tables("rock_material")) {
    rocks.materials.push_back(read_rock_material(each));
    if (!materials.insert(rocks.materials.back().name).second) {
      each.wrong("name", "is \"" + rocks.materials.back().name + "\", as that of another rock_material; rename one");
    }
  }
  for (auto& each : file.tables("rock")) rocks.all.push_back(read_rock(each, rocks, scene.dimension));
  for (auto& each : file.tables("rocks")) {
    if (!groups.insert(each.text("name", "")).second && each.has("name")) {
      each.wrong("name", "is \"" + each.text("name", "") + "\", as that of other [[rocks]]; rename one");
    }
    read_group(each, rocks, scene.dimension);
  }
  if (file.has("rock_soil")) rocks.soil = read_rock_soil(file.table("rock_soil"));
  file.known("rock_soil");
  rocks.steps_per_collision = scene.rock_steps;
  if (rocks.all.empty()) {
    // rocks = [] or rock = [], as a case has it, takes them away from a scene.
    if (!file.has("rocks") && !file.has("rock") && (!rocks.materials.empty() || file.has("rock_soil"))) {
      throw InputError(
          "the scene has [[rock_material]] or [rock_soil], and no rock; add [[rock]] or [[rocks]], or "
          "remove them");
    }
    return;
  }
  scene.rocks = std::move(rocks);
}

template <int D>
RockShape<D> shape_of(const RockOfScene& rock, Vec<3>* centre, Eigen::Quaterniond* axes) {
  if (rock.form == RockOfScene::Form::sphere) return RockShape<D>::sphere(rock.radius);
  if (rock.form == RockOfScene::Form::superquadric) {
    const bool even = std::all_of(rock.half_axes.begin(), rock.half_axes.end(),
                                  [&](double axis) { return axis == rock.half_axes[0]; });
    if (even && rock.blockiness == std::vector<double>{2, 2}) return RockShape<D>::sphere(rock.half_axes[0]);
    return RockShape<D>::superquadric(vector_of<D>(rock.half_axes), rock.blockiness[0], rock.blockiness[1]);
  }
  if constexpr (D == 3) {
    std::vector<Triangle> triangles;
    for (const auto& row : rock.triangles) {
      triangles.push_back(
          {Vec<3>(row[0], row[1], row[2]), Vec<3>(row[3], row[4], row[5]), Vec<3>(row[6], row[7], row[8])});
    }
    Vec<3> middle;
    Eigen::Quaterniond principal;
    try {
      auto shape = RockShape<3>::polyhedron(triangles, &middle, &principal);
      if (centre != nullptr) *centre = middle;
      if (axes != nullptr) *axes = principal;
      return shape;
    } catch (const InputError& mistake) {
      throw InputError("rock." + rock.name + ".file_stl: " + mistake.what());
    }
  }
  throw InputError("rock." + rock.name + ".shape: a polyhedron is of space; set scene.dimension = 3");
}

template <int D>
Rot<D> orientation_of(const RockOfScene& rock) {
  if constexpr (D == 2) {
    return rock.rotation[0];
  } else {
    const auto& q = rock.rotation;
    return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized();
  }
}

template RockShape<2> shape_of<2>(const RockOfScene&, Vec<3>*, Eigen::Quaterniond*);
template RockShape<3> shape_of<3>(const RockOfScene&, Vec<3>*, Eigen::Quaterniond*);
template Rot<2> orientation_of<2>(const RockOfScene&);
template Rot<3> orientation_of<3>(const RockOfScene&);

}  // namespace mpm
