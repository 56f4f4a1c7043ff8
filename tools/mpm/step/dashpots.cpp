// Absorbing planes (Lysmer and Kuhlemeyer 1969; with an incoming wave, Joyner and Chen 1975): behind a roller lies a
// half-space of impedance rho c_s. Shear waves go into it, and come up through it,
//
//   tau = rho c_s (2 v_in - v)        along the plane, v: velocity of the soil there,
//
// given to the nodes as N_I A tau, so that a uniform shear stress is in balance at each of them. Across, the plane
// stays. Declared in solver.hpp.
#include "tools/mpm/step/solver.hpp"

namespace mpm {
namespace {

/// Weights of the place of a plane at its own nodes and at the next row inside; what is mirrored is added. GIMP: as
/// linear, which neglects the width of a point's domain.
struct RowWeights {
  double on, inside;
};
RowWeights weights_of(Shape shape) { return shape == Shape::bspline ? RowWeights{0.75, 0.25} : RowWeights{1, 0}; }

}  // namespace

/// m^2 of the plane that each of its nodes stands for: points of the first row of cells, by their weights along it.
template <int D>
std::vector<double> Solver<D>::areas_on(const Plane<D>& plane) const {
  std::vector<double> areas(grid.nodes.size(), 0.0);
  const double h = grid.cell[plane.axis];
  for (std::size_t k = 0; k < points.size(); ++k) {
    const auto& support = supports_[k];
    const double away = (points[k].position[plane.axis] - grid.anchor[plane.axis] - plane.node * h) * plane.inside;
    if (away > h) continue;
    const int layers = D == 3 ? 3 : 1;
    for (int b = 0; b < layers; ++b) {
      for (int a = 0; a < 3; ++a) {
        typename Grid<D>::Index node;
        double area = points[k].volume / h;
        int along = 0;
        for (int i = 0; i < D; ++i) {
          const int r = along == 0 ? a : b;
          node[i] = i == plane.axis ? plane.node : support.node[i] + r;
          if (i == plane.axis) continue;
          area *= support.weight[i][r];
          ++along;
        }
        if (grid.contains(node)) areas[grid.flat(node)] += area;
      }
    }
  }
  for (const auto& mirror : planes.mirror_nodes()) {
    if (grid.index(mirror.node)[plane.axis] == plane.node) areas[mirror.image] += areas[mirror.node];
  }
  return areas;
}

/// Changes the velocities w at the end of the step, which nothing but bodies and planes hold any more.
template <int D>
void Solver<D>::add_dashpots(double dt) {
  dashpots_.clear();
  const auto weight = weights_of(options.shape);
  // m/s of the solid, and of the water that it drags along, for an impulse of 1 N s at a node.
  const auto mobility = [&](long node, int i) {
    return fluid ? fluid->mobility[node * D + i] : Mobility{1 / grid.nodes[node].mass, 0, 0};
  };
  const auto push = [&](long node, int i, double impulse) {
    grid.nodes[node].w[i] += mobility(node, i).solid * impulse;
    if (fluid) fluid->grid.nodes[node].w[i] += mobility(node, i).both * impulse;
  };
  for (int k = 0; k < int(planes.all.size()); ++k) {
    const auto& plane = planes.all[k];
    if (!(plane.impedance > 0) || !planes.active(k, time)) continue;
    const auto areas = areas_on(plane);
    const Vec<D> incoming = plane.incoming.at(time + dt);
    for (long node = 0; node < long(areas.size()); ++node) {
      auto next = grid.index(node);
      if (!(areas[node] > 0) || next[plane.axis] != plane.node || planes.is_mirror(node)) continue;
      next[plane.axis] += plane.inside;
      Dashpot dashpot{k, node, grid.flat(next), Vec<D>::Zero()};
      if (!(grid.nodes[node].mass > 0) || !(grid.nodes[dashpot.inside].mass > 0)) continue;
      const double impedance = plane.impedance * areas[node];
      for (int i = 0; i < D; ++i) {
        if (i == plane.axis || planes.holds(node, i)) continue;
        // Implicit: with the velocity at the plane that its own impulse leaves.
        const double soil = weight.on * grid.nodes[node].w[i] + weight.inside * grid.nodes[dashpot.inside].w[i];
        const double yields = weight.on * weight.on * mobility(node, i).solid +
                              weight.inside * weight.inside * mobility(dashpot.inside, i).solid;
        dashpot.force[i] = impedance * (2 * incoming[i] - soil) / (1 + dt * impedance * yields);
        push(node, i, dt * weight.on * dashpot.force[i]);
        push(dashpot.inside, i, dt * weight.inside * dashpot.force[i]);
      }
      dashpots_.push_back(dashpot);
    }
  }
}

/// Impulse and work, once w is the velocity at the end and a still the mapped one.
template <int D>
void Solver<D>::book_dashpots(double dt) {
  const auto weight = weights_of(options.shape);
  for (const auto& dashpot : dashpots_) {
    auto& reaction = planes.all[dashpot.plane].reaction;
    const auto& on = grid.nodes[dashpot.node];
    const auto& inside = grid.nodes[dashpot.inside];
    for (int i = 0; i < D; ++i) {
      const double mean = 0.5 * (weight.on * (on.w[i] + on.a[i]) + weight.inside * (inside.w[i] + inside.a[i]));
      reaction.impulse[i] += dt * dashpot.force[i];
      reaction.work += dt * dashpot.force[i] * mean;
    }
  }
}

template void Solver<2>::add_dashpots(double);
template void Solver<3>::add_dashpots(double);
template void Solver<2>::book_dashpots(double);
template void Solver<3>::book_dashpots(double);

}  // namespace mpm
