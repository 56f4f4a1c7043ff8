// Large assemblies keep their grains in an order of their own: outside it must not show, and a restart must keep it.
#include <numeric>
#include <random>

#include "rvelab/error.hpp"
#include "rvelab/solver/assembly/memory_order.hpp"
#include "rvelab/specimen/specimen_check.hpp"
#include "tests/specimens.hpp"

using namespace rvelab;
using namespace rvelab::test;

namespace {

/// Some 2100 grains, numbered at random, with rolling and friction; sides exchanged on renumbering show.
Specimen large(Shape shape) {
  Material material = linear_material(2e6, 1e6, 0.4);
  material.rolling_stiffness = 1;
  material.rolling_friction = 0.2;
  Specimen s = disordered(shape, dimension_of(shape) == 2 ? 46 : 13, material, Law::linear_stiffness, 0.52, 3);
  s.contact.rolling = true;
  std::vector<std::size_t> from(s.grains.size());
  std::iota(from.begin(), from.end(), std::size_t(0));
  std::shuffle(from.begin(), from.end(), std::mt19937_64(7));
  const Grains plain = s.grains;
  for (std::size_t k = 0; k < from.size(); ++k) {
    s.grains.position[k] = plain.position[from[k]];
    s.grains.radius[k] = plain.radius[from[k]];
    if (shape != Shape::ellipse) continue;
    s.grains.semi_major[k] = plain.semi_major[from[k]];
    s.grains.semi_minor[k] = plain.semi_minor[from[k]];
    s.grains.orientation[k] = plain.orientation[from[k]];
  }
  return s;
}

/// The same, with its grains left as they stand.
Specimen unordered(Specimen s) {
  s.state.memory_order.resize(s.grains.size());
  std::iota(s.state.memory_order.begin(), s.state.memory_order.end(), 0);
  return s;
}

Matrix3 small_shear(int dimension) {
  Matrix3 g = gradient(-1e-5, 2e-5, 0, -1e-5);
  if (dimension == 3) g(1, 2) = 1e-5;
  return g;
}

}  // namespace

TEST_CASE("The order of grains in memory does not show in specimen, network or stress", "[solver]") {
  for (const Shape shape : {Shape::disc, Shape::sphere, Shape::ellipse}) {
    const Specimen start = large(shape);
    REQUIRE(start.grains.size() >= least_ordered_grains);
    Rve ordered(start), plain(unordered(start));
    CHECK(ordered.specimen().state.memory_order != plain.specimen().state.memory_order);
    const int d = dimension_of(shape);
    for (int step = 0; step < 3; ++step) {
      const Matrix3 a = ordered.apply(small_shear(d), 0).stress, b = plain.apply(small_shear(d), 0).stress;
      CHECK(largest(a - b) <= 1e-10 * pressure(b, d));
    }
    const Specimen after = ordered.specimen();
    const Network one = ordered.network(), other = plain.network();
    CHECK(after.grains.id == start.grains.id);
    CHECK(after.grains.radius == start.grains.radius);
    REQUIRE(one.contacts.size() == other.contacts.size());
    REQUIRE(after.contacts.size() == one.contacts.size());
    for (std::size_t g = 0; g < one.grains.size(); ++g) {
      REQUIRE(one.grains[g].radius == start.grains.radius[g]);
      REQUIRE((one.grains[g].position - other.grains[g].position).norm() <= 1e-11 * start.cell.lattice(0, 0));
    }
    double force = 0, moment = 0;
    for (const ContactState& c : other.contacts) {
      force = std::max(force, c.force().norm());
      moment = std::max(moment, c.rolling_moment.norm());
    }
    REQUIRE(moment > 0);
    for (std::size_t k = 0; k < one.contacts.size(); ++k) {
      const ContactState &x = one.contacts[k], &y = other.contacts[k];
      REQUIRE((x.i == y.i && x.j == y.j && x.image == y.image));
      REQUIRE((x.branch - y.branch).norm() <= 1e-9 * x.length);
      REQUIRE((x.force() - y.force()).norm() <= 1e-7 * force);
      REQUIRE((x.rolling_moment - y.rolling_moment).norm() <= 1e-7 * moment);
      REQUIRE(after.contacts[k].i == x.i);
      REQUIRE((after.contacts[k].rolling_moment - x.rolling_moment).norm() <= 1e-12 * moment);
    }
  }
}

TEST_CASE("A large assembly goes on bit for bit after a restart from its specimen", "[solver]") {
  for (const Shape shape : {Shape::disc, Shape::sphere, Shape::ellipse}) {
    Rve first(large(shape));
    const int d = dimension_of(shape);
    first.apply(50 * small_shear(d), 0);
    Rve second(first.specimen());
    CHECK(second.save() == first.save());
    for (int step = 0; step < 3; ++step) {
      first.apply(200 * small_shear(d), 1e-3);
      second.apply(200 * small_shear(d), 1e-3);
    }
    CHECK(second.save() == first.save());
  }
}

TEST_CASE("Velocities given to a large assembly go to the grains that they are given for", "[solver]") {
  const Specimen start = large(Shape::sphere);
  Rve rve(start);
  std::vector<Vector3> velocity, spin;
  for (std::size_t g = 0; g < rve.size(); ++g) {
    velocity.emplace_back(1e-6 * double(g), 0, -1e-7 * double(g));
    spin.emplace_back(0, 1e-3 * double(g), 0);
  }
  rve.set_velocities(velocity, spin);
  const Network net = rve.network();
  for (std::size_t g = 0; g < rve.size(); ++g) {
    REQUIRE((net.grains[g].velocity - velocity[g]).norm() == 0);
    REQUIRE((net.grains[g].spin - spin[g]).norm() == 0);
  }
  velocity[100][0] = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_WITH(rve.set_velocities(velocity, spin),
                    Catch::Contains("grain " + std::to_string(start.grains.id[100]) + " "));
}

TEST_CASE("Neighbours in space are near in memory", "[solver]") {
  for (const Shape shape : {Shape::disc, Shape::sphere, Shape::ellipse}) {
    const Rve rve(large(shape));
    const Network net = rve.network();
    const auto order = rve.specimen().state.memory_order;
    REQUIRE(is_permutation(order, net.grains.size()));
    std::vector<long> place(order.size());
    for (std::size_t k = 0; k < order.size(); ++k) place[std::size_t(order[k])] = long(k);
    std::size_t near = 0;
    for (const ContactState& c : net.contacts)
      near += std::size_t(std::abs(place[std::size_t(c.i)] - place[std::size_t(c.j)]) < 64);
    // At random about 6 % would be.
    CHECK(double(near) > 0.5 * double(net.contacts.size()));
  }
}

TEST_CASE("A memory order that is no permutation is refused", "[solver]") {
  Specimen s = disordered(Shape::disc, 6, linear_material(2e6, 1e6, 0.4), Law::linear_stiffness, 0.52, 3);
  s.state.memory_order = {0, 1, 2};
  CHECK_THROWS_WITH(Rve(s), Catch::Contains("state/memory_order has 3 rows; allowed: 36, one for each grain, or none"));
  s.state.memory_order.assign(36, 0);
  CHECK_THROWS_WITH(Rve(s), Catch::Contains("no permutation of the 36 grains; leave it empty"));
}
