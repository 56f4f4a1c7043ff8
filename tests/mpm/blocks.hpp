// Blocks of material points as tests set them up: no scene, the solver alone.
#pragma once

#include <cmath>
#include <functional>
#include <memory>

#include "tools/mpm/materials/elastic.hpp"
#include "tools/mpm/step/energy.hpp"
#include "tools/mpm/step/solver.hpp"

namespace mpm::test {

constexpr double pi = 3.14159265358979323846;
inline const ElasticModuli soil{1e7, 0.25};

/// An elastic box from the origin on, with a number of cells along each side and 2^D points in each.
template <int D>
std::unique_ptr<Solver<D>> block(const std::array<int, D>& cells, double cell, const ElasticModuli& moduli,
                                 double density, int threads = 1) {
  auto solver = std::make_unique<Solver<D>>(threads);
  solver->grid.cell.setConstant(cell);
  solver->first_cell = solver->grid.cell;
  long total = 1;
  for (const int n : cells) total *= 2 * n;
  for (long k = 0; k < total; ++k) {
    Point<D> point;
    long rest = k;
    for (int i = 0; i < D; ++i) {
      point.position[i] = (double(rest % (2 * cells[i])) + 0.5) * cell / 2;
      rest /= 2 * cells[i];
    }
    point.first = point.position;
    point.half.setConstant(cell / 4);
    point.volume = std::pow(cell / 2, D);
    point.mass = density * point.volume;
    solver->points.push_back(point);
  }
  solver->groups.push_back({0, total, "elastic", std::make_shared<Elastic<D>>(moduli)});
  return solver;
}

template <int D>
void set_velocity(Solver<D>& solver, const std::function<Vec<D>(const Vec<D>&)>& field) {
  constexpr double step = 1e-6;
  for (auto& point : solver.points) {
    point.velocity = field(point.position);
    for (int j = 0; j < D; ++j) {
      Vec<D> there = point.position, here = point.position;
      there[j] += step;
      here[j] -= step;
      point.affine.col(j) = (field(there) - field(here)) / (2 * step);
    }
  }
}

template <int D>
Plane<D> roller(int axis, int node, bool soil_above) {
  Plane<D> plane;
  plane.name = "roller";
  plane.axis = axis;
  plane.node = node;
  plane.inside = soil_above ? 1 : -1;
  return plane;
}

/// Smooth, unless told.
inline Body<2> half_space(const Vec<2>& centre, const Vec<2>& normal) {
  Body<2> body;
  body.shape = HalfSpace<2>{normal};
  body.centre = centre;
  body.rough = false;
  return body;
}

/// Rollers on all sides of a box.
template <int D>
void enclose(Solver<D>& solver, const std::array<int, D>& cells) {
  for (int i = 0; i < D; ++i) {
    solver.planes.all.push_back(roller<D>(i, 0, true));
    solver.planes.all.push_back(roller<D>(i, cells[i], false));
  }
}

template <int D>
Vec<D> momentum_of(const Solver<D>& solver) {
  Vec<D> sum = Vec<D>::Zero();
  for (const auto& point : solver.points) sum += point.mass * point.velocity;
  return sum;
}

}  // namespace mpm::test
