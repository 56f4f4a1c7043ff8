// Rocks of scenes: drawn at random in a box, and from tables.
#include "tests/mpm/rocks.hpp"
#include "tests/mpm/scenes.hpp"

using namespace mpm;
using namespace mpm::test;

namespace {

const std::string drawn = rocks(
    "mix",
    "lower_m = [1, 2, 3]\nupper_m = [2, 3.5, 4]\nvolume_share = 0.4\ndiameters_m = [[0.3, 0.5], [0.2, 0.3], [0.12, "
    "0.2]]\n");

Change with_rows(const std::string& rows, const std::vector<std::string>& assignments = {}) {
  return {assignments, "", "", {{"rocks.csv", rows}}};
}

/// Nothing overlaps, and all is inside the box of `drawn`.
void expect_apart(const Rocks<3>& rocks, double gap) {
  const double lower[] = {1, 2, 3}, upper[] = {2, 3.5, 4};
  double least = 1e300, out = 0;
  for (std::size_t i = 0; i < rocks.all.size(); ++i) {
    const auto& rock = rocks.all[i];
    for (int axis = 0; axis < 3; ++axis) {
      const Vec<3> along = to_body<3>(rock.body.orientation, Vec<3>::Unit(axis));
      const auto& shape = rocks.shapes[std::size_t(rock.shape)];
      out = std::max({out, lower[axis] - rock.body.centre[axis] + shape.height(-along),
                      rock.body.centre[axis] + shape.height(along) - upper[axis]});
    }
    for (std::size_t j = 0; j < i; ++j) {
      least = std::min(least, gap_between<3>(rock.placed(rocks.shapes), rocks.all[j].placed(rocks.shapes)).gap);
    }
  }
  CHECK(least >= gap);
  CHECK(out < 1e-12);
}

}  // namespace

TEST_CASE("rocks are drawn to their share of the volume and their grading, inside the box and apart") {
  const auto model = model_of<3>(rocks_alone(3, drawn), set({"rocks.mix.seed=5", "rocks.mix.gap_m=0.002"}));
  const auto& rocks = *model->solver.rocks;
  expect_apart(rocks, 0.002);
  const double box = 1.5, parts[] = {0.5, 0.3, 0.2}, diameters[] = {0.3, 0.2, 0.12};
  double total = 0;
  for (int k = 0; k < 3; ++k) {
    const double one = pi / 6 * std::pow(diameters[k], 3);
    double volume = 0;
    for (const auto& shape : rocks.shapes) volume += std::abs(shape.volume() / one - 1) < 1e-9 ? shape.volume() : 0;
    CHECK(std::abs(volume - 0.4 * parts[k] * box) <= 0.5 * one * (1 + 1e-9));
    total += volume;
  }
  CHECK(std::abs(total - 0.4 * box) < pi / 6 * std::pow(0.3, 3));
  double mass = 0;
  for (const auto& rock : rocks.all) mass += rock.body.mass;
  CHECK(mass == Approx(2700 * total));  // no others
}

TEST_CASE("spheres that fill half of a box are apart, whatever the seed") {
  for (const char* seed : {"1", "2", "3", "4", "5", "6"}) {
    CAPTURE(seed);
    const auto model =
        model_of<3>(rocks_alone(3, drawn), set({"rocks.mix.volume_share=0.5", "rocks.mix.diameters_m=[[0.15, 1]]",
                                                "rocks.mix.seed=" + std::string(seed)}));
    expect_apart(*model->solver.rocks, 0);
  }
}

TEST_CASE("one seed draws one and the same rocks, another others") {
  const auto first = model_of<3>(rocks_alone(3, drawn)),
             again = model_of<3>(rocks_alone(3, drawn), set({"rocks.mix.seed=1"}));
  const auto other = model_of<3>(rocks_alone(3, drawn), set({"rocks.mix.seed=2"}));
  const auto &a = *first->solver.rocks, &b = *again->solver.rocks, &c = *other->solver.rocks;
  REQUIRE(a.all.size() == b.all.size());
  REQUIRE(a.all.size() == c.all.size());
  double nearest = 1e300;
  for (std::size_t k = 0; k < a.all.size(); ++k) {
    CHECK(a.all[k].body.centre == b.all[k].body.centre);
    CHECK(a.all[k].body.orientation.coeffs() == b.all[k].body.orientation.coeffs());
    nearest = std::min(nearest, (a.all[k].body.centre - c.all[k].body.centre).norm());
  }
  CHECK(nearest > 1e-6);
}

TEST_CASE("drawn superquadrics have the aspect, the volume and the turns that were asked for, close together too") {
  const std::vector<std::string> shape{"rocks.mix.aspect=[3, 2, 1.5]", "rocks.mix.blockiness=[4, 3]",
                                       "rocks.mix.diameters_m=[[0.25, 1]]", "rocks.mix.volume_share=0.3"};
  const auto check = [&](std::vector<std::string> more, bool aligned) {
    more.insert(more.end(), shape.begin(), shape.end());
    const auto model = model_of<3>(rocks_alone(3, drawn), {more});
    const auto& rocks = *model->solver.rocks;
    expect_apart(rocks, 0);
    CHECK(rocks.all.size() == std::size_t(std::round(0.3 * 1.5 / (pi / 6 * std::pow(0.25, 3)))));
    Vec<3> mean = Vec<3>::Zero();
    for (const auto& rock : rocks.all) {
      const auto& outline = rocks.shapes[std::size_t(rock.shape)];
      CHECK(outline.volume() == Approx(pi / 6 * std::pow(0.25, 3)).epsilon(1e-9));
      const double a = outline.height(Vec<3>::UnitX());
      CHECK(outline.height(Vec<3>::UnitY()) == Approx(a * 2 / 3).epsilon(1e-9));
      CHECK(outline.height(Vec<3>::UnitZ()) == Approx(a / 2).epsilon(1e-9));
      mean += (rock.body.orientation * Vec<3>::UnitX()).cwiseAbs2();
    }
    mean /= double(rocks.all.size());
    // cos^2 of isotropic directions: 1/3, variance 4/45.
    if (!aligned)
      CHECK((mean - Vec<3>::Constant(1.0 / 3)).cwiseAbs().maxCoeff() <
            4 * std::sqrt(4.0 / 45 / double(rocks.all.size())));
    if (aligned) CHECK((mean - Vec<3>(0.75, 0.25, 0)).norm() < 1e-12);
  };
  check({}, false);
  check({"rocks.mix.orientation=aligned", "rocks.mix.rotation_deg=[0, 0, 1, 30]"}, true);
}

TEST_CASE("diameters that vary within a grading keep to it, and the volume to its share") {
  const auto model =
      model_of<3>(rocks_alone(3, drawn), set({"rocks.mix.diameters_m=[[0.15, 1]]", "rocks.mix.spread=0.5"}));
  const auto& rocks = *model->solver.rocks;
  expect_apart(rocks, 0);
  double volume = 0, least = 1, most = 0;
  for (const auto& shape : rocks.shapes) {
    volume += shape.volume();
    least = std::min(least, 2 * shape.equivalent_radius());
    most = std::max(most, 2 * shape.equivalent_radius());
  }
  CHECK(std::abs(volume - 0.4 * 1.5) < pi / 6 * std::pow(0.225, 3));
  CHECK(least >= 0.075);
  CHECK(least < 0.09);
  CHECK(most <= 0.225);
  CHECK(most > 0.21);
}

TEST_CASE("a superquadric of equal half axes and exponents of 2 is a sphere to the bit") {
  const auto model =
      model_of<3>(rocks_alone(3, rock("a", "[0, 0, 0]", "shape = \"superquadric\"\nhalf_axes_m = [0.3, 0.3, 0.3]\n")));
  const auto& shape = model->solver.rocks->shapes[0];
  CHECK(shape.is_sphere());
  CHECK(shape.volume() == RockShape<3>::sphere(0.3).volume());
}

TEST_CASE("tables of rocks: place and radius, or place, half axes and turn, in the plane and in space") {
  const auto table = rocks("t", "table = \"rocks.csv\"\n");
  const auto discs = model_of<2>(rocks_alone(2, table), with_rows("x, y, radius\n1, 2, 0.5\n\n 3 4 0.25\r\n"));
  REQUIRE(discs->solver.rocks->all.size() == 2);
  CHECK(discs->solver.rocks->all[1].body.centre == Vec<2>(3, 4));
  CHECK(discs->solver.rocks->all[0].body.mass == Approx(2700 * pi * 0.25));
  const auto slabs = model_of<2>(rocks_alone(2, table), with_rows("1,2,0.5,0.2,90\n", {"rocks.t.blockiness=[2]"}));
  CHECK(slabs->solver.rocks->all[0].body.orientation == Approx(pi / 2));
  CHECK(slabs->solver.rocks->all[0].body.mass == Approx(2700 * pi * 0.1));
  const auto balls = model_of<3>(rocks_alone(3, table), with_rows("1,2,3,0.5\n3,4,5,0.25\n"));
  CHECK(balls->solver.rocks->all[1].body.centre == Vec<3>(3, 4, 5));
  CHECK(balls->solver.rocks->all[1].body.mass == Approx(2700 * 4.0 / 3 * pi / 64));
  // A quaternion w, x, y, z of any length: a quarter about z.
  const auto blocks =
      model_of<3>(rocks_alone(3, table), with_rows("1,2,3,0.3,0.2,0.1,2,0,0,2\n", {"rocks.t.blockiness=[20, 20]"}));
  const auto& block = blocks->solver.rocks->all[0].body;
  CHECK((block.orientation * Vec<3>::UnitX() - Vec<3>::UnitY()).norm() < 1e-12);
  CHECK(block.mass == Approx(2700 * 7.910481 * 0.006).epsilon(1e-6));
  // A box of these half axes has I_zz = m (a^2 + b^2)/3; the rounded one less, by the published 0.657735/(2/3).
  CHECK(block.inertia[2] < block.mass * 0.13 / 3);
  CHECK(block.inertia[2] == Approx(block.mass * 0.13 * 0.657735 / 2).epsilon(1e-6));
}
