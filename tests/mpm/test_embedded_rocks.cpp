// Rocks that stand in the soil at the start: what is cut out of it, and soil under pressure that stays around them.
#include "tests/mpm/rocks.hpp"
#include "tests/mpm/scenes.hpp"
#include "tools/mpm/step/energy.hpp"

using namespace mpm;
using namespace mpm::test;

namespace {

/// A block of elastic soil of side 1 with a rock in it, its middle at (0.47, 0.52, 0.55) or (0.47, 0.52).
template <int D>
std::string block_with(const std::string& form, const std::string& contact, const std::string& more = "") {
  const bool plane = D == 2;
  return head("block", "0.125", "1\ncfl = 0.3", D) + "[initial]\nstress = \"isotropic\"\npressure_Pa = 5e4\n" +
         soil_of("soil", "elastic", "1600", "4.6e6", "poisson_ratio = 0.12\n") +
         region("soil", plane ? "[0, 0]" : "[0, 0, 0]", plane ? "[1, 1]" : "[1, 1, 1]") + basalt("1e9") +
         rock("rock", plane ? "[0.47, 0.52]" : "[0.47, 0.52, 0.55]", form) + "\n[rock_soil]\n" + contact + "\n" + more;
}

/// Volume and centre of mass of the soil are those of the block without the rock.
template <int D>
void expect_cut(const std::string& rock, double tolerance, double off = 0.05) {
  const auto model = model_of<D>(block_with<D>(rock, "friction = 0.3"));
  const double stone = model->solver.rocks->shapes[0].volume();
  const Vec<D> at = model->solver.rocks->all[0].body.centre;
  double volume = 0, least = 1e300;
  Vec<D> first = Vec<D>::Zero();
  for (const auto& point : model->solver.points) {
    volume += point.volume;
    first += point.volume * point.position;
    least = std::min(least, model->solver.rocks->distance(model->solver.rocks->all[0], point.position, 1));
    CHECK(point.volume == Approx(std::pow(2.0, D) * point.half.prod()));
    CHECK(point.volume >= 0.25 * std::pow(0.0625, D));
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
      return text + "]";
    };
    walls += boundary(std::string("low") + axis_names[axis], "roller", axis_names[axis], "0") +
             half_space(names[axis], along("1"), along("-1"), "pressure_Pa = 5e4\n");
  }
  const auto model = model_of<3>(block_with<3>("radius_m = 0.32", contact, walls));
  auto& solver = model->solver;
  for (int step = 0; step < 300; ++step) solver.step(solver.stable_step());
  double way = 0;
  for (const auto& body : solver.bodies.all) way = std::max(way, std::abs(body.plate->displacement));
  return way;
}

std::unique_ptr<Model<3>> shipped(const char* name, const std::vector<std::string>& cases,
                                  const std::vector<std::string>& sets) {
  const rvelab::test::Folder folder;
  const std::string path = std::string(RVELAB_SOURCE_DIR) + "/protocols/mpm/" + name + ".toml";
  return set_up<3>(read_scene(path, cases, sets), 1, folder.path());
}

/// m, largest distance of a ball to the rock less its radius, of balls about as near as a point is large, and the range
/// of their radii.
struct Balls {
  double farthest = 0, least = 1e300, most = 0;
};
Balls balls_beside(const Model<3>& model) {
  const auto& rocks = *model.solver.rocks;
  Balls found;
  for (std::size_t k = 0; k < rocks.balls.size(); ++k) {
    const double to_rock = rocks.distance(rocks.all[0], model.solver.points[k].position, 1);
    found.least = std::min(found.least, rocks.balls[k]);
    found.most = std::max(found.most, rocks.balls[k]);
    CHECK(rocks.balls[k] <= to_rock * (1 + 1e-12));
    if (to_rock < model.solver.points[k].half.maxCoeff())
      found.farthest = std::max(found.farthest, to_rock - rocks.balls[k]);
  }
  return found;
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

TEST_CASE("soil pressed between plates and rocks closes its energy: contact takes some, mapping makes none") {
  std::vector<std::string> sets = {"region.0.upper_m=[0.04,0.04,0.04]", "rocks.coarse.upper_m=[0.04,0.04,0.04]",
                                   "rocks.coarse.volume_share=0.33", "rocks.coarse.seed=1"};
  const char* plates[] = {"right", "back", "top"};
  const char* centres[] = {"[0.04,0,0]", "[0,0.04,0]", "[0,0,0.04]"};
  for (int i = 0; i < 3; ++i) sets.push_back(std::string("body.") + plates[i] + ".centre_m=" + centres[i]);
  const auto model = shipped("soil_rock_triaxial", {"mm_20"}, sets);
  auto& solver = model->solver;
  const EnergyStart start = energy_start<3>(solver);
  double least = 0, largest = 0;
  while (solver.time < 0.012) {
    solver.step(solver.stable_step());
    const auto now = energy_balance<3>(solver, start);
    least = std::min(least, now.mapping_loss);
    largest = std::max(largest, std::abs(now.residual));
  }
  const auto balance = energy_balance<3>(solver, start);
  const auto rocks = solver.rocks->energy(solver.options.gravity);
  double plate_work = rocks.wall_work;
  solver.each_driven([&](const auto& each) { plate_work += each.reaction.work; });
  CAPTURE(balance.stress_work, balance.mapping_loss, solver.rocks->surface_loss, plate_work);
  REQUIRE(solver.rocks->all.size() == 5);
  REQUIRE(balance.stress_work > 0.05);
  CHECK(-least < 0.02 * plate_work);
  CHECK(balance.mapping_loss < 0.05 * plate_work);
  CHECK(largest < 1e-3 * plate_work);
  CHECK(std::abs(rocks.residual) < 1e-3 * plate_work);
  // What the soil gets, the rocks give but for the loss of their contact; half a percent is between the velocities that
  // the step is told of rocks and those that they have as they meet each other.
  CHECK(solver.rocks->work_on_soil + rocks.soil_work + solver.rocks->surface_loss ==
        Approx(0).margin(5e-3 * plate_work));
  CHECK(solver.rocks->surface_loss > 0);
}

TEST_CASE(
    "balls against rocks that shake between plates close their energy: friction, springs and what mapping takes") {
  std::vector<std::string> sets = {"region.0.upper_m=[0.04,0.04,0.04]",
                                   "rocks.coarse.upper_m=[0.04,0.04,0.04]",
                                   "rocks.coarse.volume_share=0.33",
                                   "rocks.coarse.seed=1",
                                   "rock_soil={contact=\"ghost\", friction=0.3, porosity=0.35, young_modulus_Pa=1e8}",
                                   "body.top.motion=[[0,0,0,0],[0.012,0,0,0],[0.013,0,0,-0.4]]",
                                   "body.top.pressure_until_s=0.012"};
  const char* plates[] = {"right", "back", "top"};
  const char* centres[] = {"[0.04,0,0]", "[0,0.04,0]", "[0,0,0.04]"};
  for (int i = 0; i < 3; ++i) sets.push_back(std::string("body.") + plates[i] + ".centre_m=" + centres[i]);
  const auto model = shipped("soil_rock_triaxial", {"mm_20"}, sets);
  auto& solver = model->solver;
  auto& rocks = *solver.rocks;
  const auto lost = [&] { return rocks.ghost_loss + rocks.ghost_mapping + rocks.ghost_springs(); };
  const auto open = [&] { return rocks.work_on_soil + rocks.energy(solver.options.gravity).soil_work + lost(); };
  while (solver.time < 0.012) solver.step(solver.stable_step());
  const double before = open(), lost_before = lost();
  while (solver.time < 0.022) solver.step(solver.stable_step());  // to a strain of 9 %
  CAPTURE(rocks.work_on_soil, rocks.ghost_loss, rocks.ghost_mapping, rocks.ghost_springs(), before);
  REQUIRE(rocks.all.size() == 5);
  REQUIRE(lost() - lost_before > 0.01);
  CHECK(open() - before == Approx(0).margin(0.01 * (lost() - lost_before)));
}

TEST_CASE("balls beside a rock in the soil reach it, and those under a rock that lies on the soil stay alike") {
  const auto inside = model_of<3>(block_with<3>("radius_m = 0.3", "contact = \"ghost\""));
  const Balls beside = balls_beside(*inside);
  CHECK(beside.farthest < 1e-12);
  CHECK(beside.most > 1.2 * beside.least);
  const auto on = shipped("block_slide", {}, {"rock_soil.contact=\"ghost\""});
  const Balls under = balls_beside(*on);
  CHECK(under.most == Approx(0.0125));
  CHECK(under.least == Approx(0.0125).epsilon(1e-6));
}
