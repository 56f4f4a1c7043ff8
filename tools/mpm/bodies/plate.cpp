#include "tools/mpm/bodies/plate.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "tools/mpm/bodies/bodies.hpp"

namespace mpm {

double plate_velocity(double mass, double free_velocity, const std::vector<SurfaceMobility>& soil) {
  double velocity = free_velocity;
  // Each step leaves points behind that the plate does not reach; there are no more steps than points.
  for (std::size_t step = 0; step <= soil.size(); ++step) {
    double slope = mass, sum = mass * free_velocity;
    for (const auto& point : soil) {
      if (!(velocity > point.speed)) continue;
      slope += 1 / point.mobility;
      sum += point.speed / point.mobility;
    }
    const double next = sum / slope;
    if (!(next < velocity)) break;
    velocity = next;
  }
  return velocity;
}

double Plate::acceleration() const {
  double largest = 0;
  for (const double each : pressure.values) largest = std::max(largest, std::abs(each));
  return mass > 0 ? largest * area / mass : 0;  // no mass yet: of a scene that is being set up
}

template <int D>
void Bodies<D>::place_plates(const Grid<D>& grid, const Planes<D>& planes, double time) {
  for (auto& body : all) {
    if (!body.plate) continue;
    auto& plate = *body.plate;
    if (plate.free() && time >= plate.until) plate.held_from = time;
    if (plate.sides.empty()) continue;
    plate.area = plate.thickness;
    for (int axis = 0, k = 0; axis < D; ++axis) {
      if (axis == body.plate_axis()) continue;
      double at[2];
      for (int above = 0; above < 2; ++above, ++k) {
        const auto& side = plate.sides[std::size_t(k)];
        if (side.body) {
          at[above] = all[std::size_t(side.number)].centre_at(time)[axis];
        } else {
          const auto& plane = planes.all[std::size_t(side.number)];
          at[above] = grid.anchor[axis] + (plane.node + above * plane.period) * grid.cell[axis];
        }
      }
      if (!(at[1] > at[0])) {
        throw std::runtime_error("body." + body.name + ": the sides of the specimen beside this plate have met along " +
                                 axis_names[axis] + "; make the pressures or the loading smaller");
      }
      plate.area *= at[1] - at[0];
    }
  }
}

template <int D>
void Bodies<D>::start_plates() {
  for (auto& body : all) {
    if (body.pressed()) body.plate->free_velocity = body.plate->met_velocity = body.plate->velocity;
  }
}

template <int D>
void Bodies<D>::predict_plates(double time, double dt) {
  for (auto& body : all) {
    if (!body.pressed()) continue;
    auto& plate = *body.plate;
    const double force = plate.pressure.at(time + 0.5 * dt) * plate.area + plate.rock_force;
    plate.free_velocity = plate.met_velocity = plate.met_velocity + dt / plate.mass * force;
  }
}

/// Along the plate, soil sticks or slips as on any body.
template <int D>
void Bodies<D>::hold_plate(Body<D>& body, Grid<D>& grid, bool end) {
  auto& plate = *body.plate;
  const Vec<D>& normal = body.plate_normal();
  met_.clear();
  for (std::size_t k = plate.first; k < plate.last; ++k) {
    const auto& point = surface[k];
    const Vec<D> alone = point.velocity(grid, end) - point.mobility * point.now;
    met_.push_back({alone.dot(normal), point.mobility});
  }
  plate.met_velocity = plate_velocity(plate.mass, plate.free_velocity, met_);
  for (std::size_t k = plate.first; k < plate.last; ++k) {
    auto& point = surface[k];
    const auto& soil = met_[k - plate.first];
    const double across = std::max(0.0, plate.met_velocity - soil.speed) / soil.mobility;
    const Vec<D> wanted = point.now - point.velocity(grid, end) / point.mobility;
    const Vec<D> more = across * normal + along_surface(body, point, wanted, across) - point.now;
    if (more.isZero(0)) continue;
    point.now += more;
    point.push(grid, more, end);
  }
}

template <int D>
void Bodies<D>::hold_plates(Grid<D>& grid, bool end) {
  for (auto& body : all) {
    if (body.pressed()) hold_plate(body, grid, end);
  }
}

template <int D>
void Bodies<D>::sum_plate_forces(const Grid<D>& grid, double time, double dt) {
  for (auto& body : all) {
    if (!body.pressed()) continue;
    auto& plate = *body.plate;
    double soil = 0;
    for (std::size_t k = plate.first; k < plate.last; ++k)
      soil -= (surface[k].at_start + surface[k].at_end).dot(body.plate_normal());
    for (const auto& contact : contacts_) {
      if (&body == all.data() + contact.body)
        soil -= grid.nodes[contact.node].mass * (contact.at_start + contact.at_end).dot(body.plate_normal());
    }
    plate.force = plate.pressure.at(time + 0.5 * dt) * plate.area + soil / dt;
    plate.rock_impulse = 0;
  }
}

template <int D>
void Bodies<D>::kick_plates(const std::vector<Vec<D>>& rock_forces, std::size_t first, double dt) {
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (!all[k].pressed()) continue;
    auto& plate = *all[k].plate;
    const double of_rocks = rock_forces.empty() ? 0 : rock_forces[first + k].dot(all[k].plate_normal());
    plate.rock_impulse += dt * of_rocks;
    plate.velocity += dt / plate.mass * (plate.force + of_rocks);
  }
}

template <int D>
void Bodies<D>::drift_plates(double dt) {
  for (auto& body : all) {
    if (body.pressed()) body.plate->displacement += dt * body.plate->velocity;
  }
}

template <int D>
void Bodies<D>::end_plates(double dt) {
  for (auto& body : all) {
    if (body.pressed()) body.plate->rock_force = body.plate->rock_impulse / dt;
  }
}

#define MPM_INSTANTIATE(D)                                                               \
  template void Bodies<D>::place_plates(const Grid<D>&, const Planes<D>&, double);       \
  template void Bodies<D>::start_plates();                                               \
  template void Bodies<D>::predict_plates(double, double);                               \
  template void Bodies<D>::hold_plates(Grid<D>&, bool);                                  \
  template void Bodies<D>::sum_plate_forces(const Grid<D>&, double, double);             \
  template void Bodies<D>::kick_plates(const std::vector<Vec<D>>&, std::size_t, double); \
  template void Bodies<D>::drift_plates(double);                                         \
  template void Bodies<D>::end_plates(double);
MPM_INSTANTIATE(2)
MPM_INSTANTIATE(3)
#undef MPM_INSTANTIATE

}  // namespace mpm
