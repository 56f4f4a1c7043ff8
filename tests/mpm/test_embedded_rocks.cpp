// Rocks that stand in the soil at the start: what is cut out of it, and soil under pressure that stays around them.
#include <fstream>

#include "tests/catch.hpp"
#include "tests/folder.hpp"
#include "tests/mpm/rocks.hpp"
#include "tools/mpm/setup.hpp"

using namespace mpm;
using namespace mpm::test;

namespace {

/// A block of elastic soil of side 1 with a rock in it, its middle at (0.47, 0.52, 0.55) or (0.47, 0.52).
template <int D>
std::string block(const std::string& rock, const std::string& contact, const std::string& more = "") {
  const auto vector = [](const std::string& x, const std::string& y, const std::string& z) {
    return "[" + x + ", " + y + (D == 3 ? ", " + z : "") + "]\n";
  };
  return "[scene]\nname = \"block\"\ndimension = " + std::to_string(D) +
         "\n[grid]\ncell_m = 0.125\n[time]\nduration_s = 1\ncfl = 0.3\n[initial]\nstress = \"isotropic\"\npressure_Pa "
         "= "
         "5e4\n[[material]]\nname = \"soil\"\nkind = \"elastic\"\ndensity_kg_m3 = 1600\nyoung_modulus_Pa = 4.6e6\n"
         "poisson_ratio = 0.12\n[[region]]\nmaterial = \"soil\"\nlower_m = " +
         vector("0", "0", "0") + "upper_m = " + vector("1", "1", "1") +
         "[[rock_material]]\nname = \"basalt\"\ndensity_kg_m3 = 2600\nyoung_modulus_Pa = 1e9\n[[rock]]\nname = "
         "\"rock\"\nmaterial = \"basalt\"\ncentre_m = " +
         vector("0.47", "0.52", "0.55") + rock + "\n[rock_soil]\n" + contact + "\n" + more;
}

template <int D>
std::unique_ptr<Model<D>> model_of(const std::string& scene) {
  const rvelab::test::Folder folder;
  std::ofstream(folder / "scene.toml") << scene;
  return set_up<D>(read_scene(folder / "scene.toml", {}, {}), 1, folder.path());
}

/// Volume and centre of mass of the soil are those of the block without the rock.
template <int D>
void expect_cut(const std::string& rock, double tolerance, double off = 0.05) {
  const auto model = model_of<D>(block<D>(rock, "friction = 0.3"));
  const double stone = model->solver.rocks->shapes[0].volume();
  const Vec<D> at = model->solver.rocks->all[0].body.centre;
  double volume = 0, least = 1e300;
  Vec<D> first = Vec<D>::Zero();
  for (const auto& point : model->solver.points) {
    volume += point.volume;
    first += point.volume * point.position;
    least = std::min(least, model->solver.rocks->distance(model->solver.rocks->all[0], point.position, 1));
    CHECK(point.volume == Approx(std::pow(2.0, D) * point.half.prod()));
    CHECK(point.mass == Approx(1600 * point.volume));
  }
  CAPTURE(D, rock, stone);
  CHECK(volume == Approx(1 - stone).margin(tolerance * stone));
  // The middle of what is cut out, within a part of a point.
  CHECK((first - (0.5 * Vec<D>::Ones() - stone * at)).norm() < off * 0.0625 * stone);
  CHECK(least > 0);
  CHECK(model->solver.rocks->left_out_volume == Approx(1 - volume));
}

/// Largest way (m) of the walls of a block of soil with a rock under 50 kPa, over 300 steps.
double way_at_rest(const std::string& contact) {
  const char* names[] = {"right", "back", "top"};
  std::string walls;
  for (int axis = 0; axis < 3; ++axis) {
    const auto along = [&](const char* value) {
      std::string text = "[";
      for (int i = 0; i < 3; ++i) text += std::string(i == 0 ? "" : ", ") + (i == axis ? value : "0");
      return text + "]\n";
    };
    walls += std::string("[[boundary]]\nname = \"low") + axis_names[axis] + "\"\nkind = \"roller\"\naxis = \"" +
             axis_names[axis] + "\"\nat_m = 0\n[[body]]\nname = \"" + names[axis] +
             "\"\nkind = \"half_space\"\ncentre_m = " + along("1") + "normal = " + along("-1") + "pressure_Pa = 5e4\n";
  }
  const auto model = model_of<3>(block<3>("radius_m = 0.32", contact, walls));
  auto& solver = model->solver;
  for (int step = 0; step < 300; ++step) solver.step(solver.stable_step());
  double way = 0;
  for (const auto& body : solver.bodies.all) way = std::max(way, std::abs(body.plate->displacement));
  return way;
}

}  // namespace

TEST_CASE("soil is cut at the surface of the rocks that stand in it: volume and centre of mass") {
  expect_cut<2>("radius_m = 0.3", 3e-3);
  expect_cut<2>("shape = \"superquadric\"\nhalf_axes_m = [0.35, 0.2]\nblockiness = [6]\nrotation_deg = 25", 5e-3);
  expect_cut<3>("radius_m = 0.3", 3e-3);
  // The smallest that there may be: two and a half points across.
  expect_cut<2>("radius_m = 0.0785", 0.1, 0.25);
  expect_cut<3>("radius_m = 0.0785", 0.1, 0.25);
  expect_cut<3>(
      "shape = \"superquadric\"\nhalf_axes_m = [0.35, 0.2, 0.25]\nblockiness = [4, 4]\nrotation_deg = [1, 1, 0, 25]",
      5e-3);
}

TEST_CASE("soil at rest around a rock keeps its volume, with friction and without slip") {
  // 50 kPa strain the soil by 0.8 %; of that, walls may move a twentieth.
  CHECK(way_at_rest("friction = 0.3") < 4e-4);
  CHECK(way_at_rest("rough = true") < 4e-4);
}
