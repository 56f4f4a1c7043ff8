// How long a list may become is known before it is made, and what is too long is refused.
#include "rvelab/error.hpp"
#include "rvelab/solver/assembly/list_size.hpp"
#include "rvelab/solver/assembly/neighbour_list.hpp"
#include "tests/refusal.hpp"
#include "tests/solver/generator.hpp"
#include "tests/specimens.hpp"

using namespace rvelab;
using namespace rvelab::test;
using Catch::Matchers::Contains;

namespace {

/// Evenly spread over decades.
double over_decades(Generator& generator, double low, double high) {
  return low * std::pow(high / low, uniform(generator, 0, 1));
}

struct SizedCloud {
  Cell cell;
  std::vector<double> positions, radii;
  double skin = 0;
};

/// Grains anywhere, or all in one corner, in a cell that may be long, flat and skew.
SizedCloud random_cloud(Generator& generator, int dimension, int grains, double mean_radius, double slenderness) {
  SizedCloud c;
  c.cell.dimension = dimension;
  for (int k = 0; k < dimension; ++k) c.cell.lattice(k, k) = over_decades(generator, 1 / slenderness, slenderness);
  for (int r = 0; r < dimension; ++r)
    for (int k = r + 1; k < dimension; ++k) c.cell.lattice(r, k) = uniform(generator, -1, 1) * c.cell.lattice(r, r);
  const double corner = generator() % 4 == 0 ? 0.2 : 1, spread = generator() % 2 == 0 ? 1.2 : 20;
  for (int g = 0; g < grains; ++g) {
    Vector3 s = Vector3::Zero();
    for (int k = 0; k < dimension; ++k) s[k] = uniform(generator, 0, corner);
    const Vector3 x = c.cell.lattice * s;
    c.positions.insert(c.positions.end(), {x[0], x[1], x[2]});
    c.radii.push_back(mean_radius * over_decades(generator, 1 / spread, spread));
  }
  c.skin = mean_radius * over_decades(generator, 0.01, 2);
  return c;
}

std::string refusal(const SizedCloud& c) {
  try {
    list_pairs(c.cell, c.positions.data(), 3, c.radii, c.skin);
  } catch (const IncrementFailed& error) {
    return error.what();
  }
  return "";
}

SizedCloud two_grains(int dimension, double edge, double radius, double skin) {
  SizedCloud c;
  c.cell.dimension = dimension;
  c.cell.lattice = Vector3(edge, edge, edge).asDiagonal();
  c.positions = {0, 0, 0, 0.4 * edge, 0.4 * edge, dimension == 2 ? 0 : 0.3 * edge};
  c.radii = {radius, 0.9 * radius};
  c.skin = skin;
  return c;
}

}  // namespace

TEST_CASE("no list is longer than was said before it was made, in any cell, for any radii") {
  Generator generator(7);
  for (const int dimension : {2, 3})
    for (int trial = 0; trial < 400; ++trial) {
      const int grains = int(over_decades(generator, 1, 300));
      const double reach = over_decades(generator, 0.02, dimension == 2 ? 3 : 1);
      const SizedCloud c = random_cloud(generator, dimension, grains, reach, trial % 2 == 0 ? 1.3 : 4);
      const double most = pairs_at_most(c.cell, c.positions.data(), 3, c.radii, c.skin);
      if (!(most <= allowed_pairs(c.radii.size()))) continue;
      CAPTURE(dimension, trial, grains);
      CHECK(double(list_pairs(c.cell, c.positions.data(), 3, c.radii, c.skin).size()) <= most);
      CHECK(double(list_pairs(c.cell, c.positions.data(), 3, c.radii, c.skin).size()) <=
            pairs_by_volume(c.cell, c.radii, c.skin));
    }
}

TEST_CASE("what is said of a list is near its length where grains fill their cell") {
  Generator generator(8);
  for (const int dimension : {2, 3})
    for (int trial = 0; trial < 60; ++trial) {
      // From grains as wide as the cell to thousands in it; in a cell as a run has it.
      const int grains = int(over_decades(generator, 1, 3000));
      const double radius = over_decades(generator, 0.3, 0.8) / std::pow(grains, 1.0 / dimension);
      SizedCloud c = random_cloud(generator, dimension, 0, radius, 1.3);
      apply_reduction(c.cell, reduced(c.cell));
      for (int g = 0; g < grains; ++g) {
        for (int k = 0; k < 3; ++k) c.positions.push_back(k < dimension ? uniform(generator, -0.5, 0.5) : 0);
        c.radii.push_back(radius * uniform(generator, 0.7, 1.3));
      }
      c.skin = 0.15 * radius;
      const double listed = double(list_pairs(c.cell, c.positions.data(), 3, c.radii, c.skin).size());
      CAPTURE(dimension, trial, grains, radius, listed);
      CHECK(pairs_at_most(c.cell, c.positions.data(), 3, c.radii, c.skin) <=
            (dimension == 2 ? 12 : 45) * (listed + double(grains)));
    }
}

TEST_CASE("grains that reach over thousands of cells are refused before anything is listed") {
  for (const int dimension : {2, 3}) {
    for (const double radius : {20.0, 1e3, 1e8, 1e9, 1e100, 1e300}) {
      CAPTURE(dimension, radius);
      CHECK_THAT(refusal(two_grains(dimension, 0.02, radius, 0.15 * radius)),
                 Contains("of 2 grains may need") && Contains("allowed: 100000") && Contains("in mm?"));
    }
    for (const double skin : {1e3, 1e10, 1e200})
      CHECK_THAT(refusal(two_grains(dimension, 1, 0.2, skin)), Contains("lower solver.skin"));
    // The smallest numbers there are, and nothing to refuse.
    CHECK(refusal(two_grains(dimension, 1, 5e-324, 5e-324)) == "");
    CHECK(refusal(two_grains(dimension, 1, 1e-200, 1e-200)) == "");
    CHECK(refusal(two_grains(dimension, 1e60, 1e58, 1e57)) == "");
  }
}

TEST_CASE("cells that are flat, skew or no longer numbers are refused") {
  for (const int dimension : {2, 3}) {
    SizedCloud flat = two_grains(dimension, 1, 0.2, 0.03);
    flat.cell.lattice(1, 1) = 1e-7;
    CHECK_THAT(refusal(flat), Contains("of 2 grains may need"));
    SizedCloud skew = two_grains(dimension, 1, 0.2, 0.03);
    skew.cell.lattice(0, 1) = 1e9;
    CHECK_THAT(refusal(skew), Contains("skew"));
    for (const double edge : {1e-200, 1e200}) {
      const SizedCloud beyond = two_grains(dimension, edge, 0.2 * edge, 0.03 * edge);
      CHECK_THAT(refusal(beyond), Contains("above 0 and finite"));
    }
  }
}

TEST_CASE("a specimen in two units, or far from its cell, is refused when it is opened") {
  for (const Shape shape : {Shape::disc, Shape::sphere}) {
    Specimen s = disordered(shape, 6, linear_material(1e6, 5e5, 0.3), Law::linear_stiffness, 0.5, 3);
    REQUIRE_NOTHROW(Rve(s));
    Specimen millimetres = s;
    for (double& radius : millimetres.grains.radius) radius *= 1000;
    CHECK_THROWS_AS(Rve(millimetres), InputError);
    CHECK_THROWS_WITH(Rve(millimetres), Contains("in mm?"));
    Specimen wide = s;
    wide.solver.skin = 1000;
    CHECK_THROWS_WITH(Rve(wide), Contains("solver/skin = 1000 is out of range"));
    Specimen far = s;
    far.grains.position[7][0] = 1e12;
    CHECK_THROWS_AS(Rve(far), InputError);
    CHECK_THROWS_WITH(Rve(far), Contains("grains/position_m[7] of grain 8 is 1e+12 m"));
  }
}

TEST_CASE("an expansion by tens of decades ends well or is refused, and changes nothing then") {
  for (const Shape shape : {Shape::disc, Shape::sphere})
    for (const double factor : {1e10, 1e80, 1e100, 1e150}) {
      const int d = dimension_of(shape);
      Rve rve(disordered(shape, 4, linear_material(1e6, 5e5, 0.3), Law::linear_stiffness, 0.5, 3));
      rve.relax(1e-4, 10'000);
      const auto before = rve.save();
      Matrix3 expansion = Matrix3::Zero();
      for (int k = 0; k < d; ++k) expansion(k, k) = factor;
      CAPTURE(d, factor);
      for (const double dt : {0.0, 1e-3}) {
        Rve expanded = rve;
        try {
          const bool finite = expanded.apply(expansion, dt).stress.allFinite();
          CHECK(finite);
        } catch (const Error&) {
          CHECK(bool(expanded.save() == before));
        }
      }
    }
}

TEST_CASE("overlaps beyond the limit are refused when a specimen is opened, those within it are not") {
  for (const Shape shape : {Shape::disc, Shape::sphere}) {
    // A grain that touches its own images, since nothing can push it away.
    Specimen s = empty_specimen(shape, 0.14, linear_material(1e6, 5e5, 0.3));
    s.solver.min_height = 0.1;
    add_grain(s, {0, 0, 0}, 0.1);  // overlap 0.06: six tenths of the radius
    const std::string text = input_error([&] { Rve{s}; });
    CHECK_THAT(text, Contains("overlap by 0.6 of the smaller radius; solver.max_overlap_ratio allows 0.25"));
    for (const char* cause : {"stiffness", "pressure", "slab", "units"}) CHECK_THAT(text, Contains(cause));
    s.solver.max_overlap_ratio = 0.61;
    Rve rve(s);
    CHECK(rve.network().contacts.size() >= 2);
    // And the limit is that of the file, not what the overlap happens to be.
    Matrix3 compression = Matrix3::Zero();
    compression(0, 0) = -0.02;
    CHECK_THROWS_AS(rve.apply(compression, 0), IncrementFailed);
  }
}
