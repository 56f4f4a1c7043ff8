#include "tools/mpm/water/fluid.hpp"

#include <sstream>

namespace mpm {
namespace {

constexpr double least_porosity = 1e-3;

}  // namespace

template <int D>
void make_water_boundaries(const Planes<D>& planes, const Bodies<D>& bodies, Fluid<D>& fluid) {
  fluid.planes.all = planes.all;
  for (std::size_t k = 0; k < planes.all.size(); ++k) {
    auto& plane = fluid.planes.all[k];
    plane.fixed = false;
    plane.open = fluid.options.boundaries[k].open();
    if (plane.period > 0) fluid.pressure.repeat(plane.axis, plane.node, plane.period);
  }
  fluid.bodies.all = bodies.all;
  fluid.bodies.shape = bodies.shape;
  for (auto& body : fluid.bodies.all) {
    body.rough = false;
    body.friction = 0;
  }
  fluid.outflow.assign(planes.all.size() + 1, 0);
}

template <int D>
void Fluid<D>::begin_step(const Grid<D>& solid, const std::vector<Point<D>>& soil, double time, bool first) {
  const bool grown = grid.nodes.size() != solid.nodes.size() || grid.low != solid.low;
  grid.low = solid.low;
  grid.count = solid.count;
  grid.cell = solid.cell;
  grid.anchor = solid.anchor;
  grid.nodes.resize(solid.nodes.size());
  if (grown || planes.changed(time)) planes.rebuild(grid, time);
  pressure.follow(grid);
  for (long node = 0; first && first_pressure && node < long(grid.nodes.size()); ++node) {
    pressure.values[node] = first_pressure(grid.position(grid.index(node))[D - 1]);
  }
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (!(points[k].solids > 0)) continue;
    const double volume = soil[k].volume, porosity = points[k].porosity(volume);
    if (!(porosity > least_porosity)) {
      std::ostringstream words;
      words << "at " << time << " s the saturated point at " << soil[k].position.transpose() << " m has a porosity of "
            << porosity << ", and no room for water; take a smaller time.cfl, or a load that "
            << "the soil can carry";
      throw std::runtime_error(words.str());
    }
    points[k].mass = options.density * porosity * volume;
  }
}

/// An open plane that the node lies on; -1: none.
template <int D>
int Fluid<D>::open_plane_at(const typename Grid<D>::Index& node, double time) const {
  for (int k = 0; k < int(planes.all.size()); ++k) {
    const auto& plane = planes.all[k];
    if (plane.open && planes.active(k, time) && node[plane.axis] == plane.node) return k;
  }
  return -1;
}

/// m^3 of a hat that soil may fill: on the soil's side of the planes, outside of bodies.
template <int D>
double Fluid<D>::whole_hat(const Bodies<D>& solid, double time, long node) const {
  double volume = grid.cell.prod() * options.thickness;
  const auto index = grid.index(node);
  for (int k = 0; k < int(planes.all.size()); ++k) {
    const auto& plane = planes.all[k];
    if (plane.period == 0 && planes.active(k, time) && index[plane.axis] == plane.node) volume *= 0.5;
  }
  if (solid.all.empty()) return volume;
  constexpr int samples = 8;  // along each axis, of the two cells of a hat
  double outside = 0, whole = 0;
  const Vec<D> x = grid.position(index);
  for (long k = 0; k < std::lround(std::pow(samples, D)); ++k) {
    Vec<D> away, outward;
    double value = 1;
    long rest = k;
    for (int i = 0; i < D; ++i) {
      const double part = (double(rest % samples) + 0.5) / samples * 2 - 1;
      rest /= samples;
      away[i] = part * grid.cell[i];
      value *= 1 - std::abs(part);
    }
    whole += value;
    bool free = true;
    for (const auto& body : solid.all) {
      free = free && body.distance(x + away - body.centre_at(time), outward) > 0;
    }
    if (free) outside += value;
  }
  return volume * outside / whole;
}

template <int D>
void Fluid<D>::set_roles(const Bodies<D>& solid, double time) {
  constexpr double surface = 0.75;  // of a hat: the soil ends less than 0.7 of a cell above a node that is filled less
  using Role = typename PorePressure<D>::Role;
  for (long node = 0; node < long(grid.nodes.size()); ++node) {
    if (!(pressure.filled[node] > 0)) continue;
    const auto index = grid.index(node);
    auto& role = pressure.roles[node];
    if (const int k = open_plane_at(index, time); k >= 0) {
      const auto& boundary = options.boundaries[k];
      role = Role::given;
      const double depth = boundary.value - grid.position(index)[D - 1];
      pressure.targets[node] = boundary.kind == WaterBoundary::Kind::pressure
                                   ? boundary.value
                                   : options.density * FluidOptions::standard_gravity * std::max(0.0, depth);
      continue;
    }
    const double most = surface * grid.cell.prod() * options.thickness;
    const bool at_surface = options.drained_surface && pressure.filled[node] < most &&
                            pressure.filled[node] < surface * whole_hat(solid, time, node);
    role = at_surface ? Role::given : Role::unknown;
    pressure.targets[node] = 0;
  }
  pressure.tie(grid);
}

template <int D>
double Fluid<D>::force_on(const Planes<D>& all, int plane) const {
  const auto& of = all.all[plane];
  double force = 0;
  if (of.period > 0) return force;  // the water goes on behind it
  for (long node = 0; node < long(pressure.filled.size()); ++node) {
    const auto index = grid.index(node);
    if (!(pressure.filled[node] > 0) || index[of.axis] != of.node) continue;
    force += pressure.values[node] * pressure.filled[node] / (0.5 * grid.cell[of.axis]);
  }
  return -of.inside * force;
}

template struct Fluid<2>;
template struct Fluid<3>;
template void make_water_boundaries<2>(const Planes<2>&, const Bodies<2>&, Fluid<2>&);
template void make_water_boundaries<3>(const Planes<3>&, const Bodies<3>&, Fluid<3>&);

}  // namespace mpm
