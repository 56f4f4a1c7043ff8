// Material points exactly on nodes, edges and faces of the grid, with every shape function: nothing there is special.
#include <sstream>

#include "tests/catch.hpp"
#include "tests/mpm/blocks.hpp"
#include "tools/mpm/step/watch.hpp"

using namespace mpm;
using namespace mpm::test;

namespace {

constexpr double node_distance = 0.25, block_density = 2000;
const ElasticModuli soft_block{1e6, 0.3};

/// Points a cell apart; along each axis they stand on nodes or, where `between` has that bit, in the middle of
/// cells.
template <int D>
std::unique_ptr<Solver<D>> block_on_nodes(Shape shape, Scheme scheme, int along, int between) {
  auto solver = std::make_unique<Solver<D>>(1);
  solver->grid.cell.setConstant(node_distance);
  solver->first_cell = solver->grid.cell;
  solver->options.shape = shape;
  solver->options.scheme = scheme;
  solver->options.gravity = -9.81 * Vec<D>::Unit(D - 1);
  const long total = std::lround(std::pow(along, D));
  for (long k = 0; k < total; ++k) {
    Point<D> point;
    long rest = k;
    for (int i = 0; i < D; ++i) {
      point.position[i] = (double(rest % along) + ((between >> i) % 2 != 0 ? 0.5 : 0)) * node_distance;
      rest /= along;
    }
    point.first = point.position;
    point.half.setConstant(node_distance / 2);
    point.volume = std::pow(node_distance, D);
    point.mass = block_density * point.volume;
    solver->points.push_back(point);
  }
  solver->groups.push_back({0, total, "elastic", std::make_shared<Elastic<D>>(soft_block)});
  return solver;
}

template <class Visit>
void each_shape_and_scheme(const Visit& visit) {
  for (const Shape shape : {Shape::bspline, Shape::gimp, Shape::linear}) {
    for (const Scheme scheme : {Scheme::usf, Scheme::musl}) visit(shape, scheme);
  }
}

template <int D>
void expect_free_fall() {
  each_shape_and_scheme([](Shape shape, Scheme scheme) {
    for (int between = 0; between < 1 << D; ++between) {
      CAPTURE(D, int(shape), int(scheme), between);
      const auto solver = block_on_nodes<D>(shape, scheme, 2, between);
      for (int k = 0; k < 100; ++k) solver->step(0.4 * solver->stable_step());
      const double speed = -9.81 * solver->time;
      REQUIRE(0.5 * speed * solver->time < -0.2 * node_distance);
      for (const auto& point : solver->points) {
        CHECK((point.velocity - speed * Vec<D>::Unit(D - 1)).norm() < 1e-10);
        CHECK(point.stress.norm() < 1e-9 * soft_block.young);
      }
    }
  });
}

/// A block that is let go onto a smooth plane; twice its settlement under its weight is as far as it goes.
template <int D>
void expect_settling() {
  each_shape_and_scheme([](Shape shape, Scheme scheme) {
    for (int between = 0; between < 1 << D; ++between) {
      CAPTURE(D, int(shape), int(scheme), between);
      constexpr int along = 3;
      const auto solver = block_on_nodes<D>(shape, scheme, along, between);
      if (between >> (D - 1) == 0) {
        for (auto& point : solver->points) {
          if (point.position[D - 1] == 0) point.mass /= 2, point.volume /= 2;  // half of it would lie below
        }
      }
      solver->planes.all.push_back(roller<D>(D - 1, 0, true));
      const auto start = energy_start<D>(*solver);
      Watched seen;
      std::ostringstream warnings;
      double largest = 0, residual = 0, moved = 0, pressed = 0;
      while (solver->time < 0.25) {
        solver->step(solver->stable_step());
        watch_energy<D>(*solver, start, seen, warnings);
        const auto b = energy_balance<D>(*solver, start);
        for (const double each : {b.kinetic, b.potential, b.stress_work}) largest = std::max(largest, std::abs(each));
        residual = std::max(residual, std::abs(b.residual));
        for (const auto& point : solver->points) {
          moved = std::max(moved, (point.position - point.first).norm());
          pressed = std::max(pressed, -point.stress(D - 1, D - 1));
        }
      }
      const double weight = block_density * 9.81 * along * node_distance;
      // MUSL has stress and heights half a step late.
      CHECK(residual < (scheme == Scheme::usf ? 0.02 : 0.08) * largest);
      CHECK(warnings.str().empty());
      CHECK(moved < 2.5 * weight * along * node_distance / soft_block.young);
      CHECK(moved > 0.3 * weight * along * node_distance / soft_block.young);
      CHECK(pressed < 2.5 * weight);
      CHECK(pressed > 0.8 * weight);
    }
  });
}

/// Sums over nodes at a place: weights, slopes, and a linear field with its gradient.
void expect_consistent(Shape shape, double xi, double half) {
  CAPTURE(int(shape), xi, half);
  double weight[3], slope[3], sum = 0, slopes = 0, value = 0, gradient = 0;
  const int first = shape_along_axis(shape, xi, 1 / node_distance, half, weight, slope);
  for (int k = 0; k < 3; ++k) {
    CHECK(weight[k] >= 0);
    CHECK((weight[k] > 0 || slope[k] == 0));  // no stress to a node without mass
    // Square of the frequency that a point gives to a node over that of a whole cell.
    if (weight[k] > 0) CHECK(slope[k] * slope[k] * node_distance * node_distance / weight[k] <= 8.0001);
    sum += weight[k];
    slopes += slope[k];
    value += weight[k] * (3 - 2 * (first + k) * node_distance);
    gradient += slope[k] * (3 - 2 * (first + k) * node_distance);
  }
  CHECK(sum == Approx(1).epsilon(1e-14));
  CHECK(slopes == Approx(0).margin(1e-12));
  CHECK(value == Approx(3 - 2 * xi * node_distance).epsilon(1e-12).margin(1e-13));
  CHECK(gradient == Approx(-2).epsilon(1e-12));
}

}  // namespace

TEST_CASE("at nodes, beside them and between them weights sum to one and slopes to zero, and no light node is stiff") {
  for (const Shape shape : {Shape::bspline, Shape::gimp, Shape::linear}) {
    for (const double half : {0.5, 0.25, 0.125, 0.01, 1e-6}) {
      for (const int node : {-3, 0, 7}) {
        for (const double beside : {0.0, 1e-300, 1e-16, 1e-9, 1e-3, 0.125, 0.2, 0.5, 0.999999}) {
          expect_consistent(shape, node + beside, half);
          expect_consistent(shape, node - beside, half);
        }
      }
    }
  }
}

TEST_CASE("a block in free fall has no stress, wherever its points stand in the cells") {
  expect_free_fall<2>();
  expect_free_fall<3>();
}

TEST_CASE("a block that is let go onto a plane settles and keeps its energy, wherever its points stand in the cells") {
  expect_settling<2>();
  expect_settling<3>();
}
