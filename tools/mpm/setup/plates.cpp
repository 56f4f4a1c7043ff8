#include "tools/mpm/setup/plates.hpp"

namespace mpm {
namespace {

/// Of a normal along that axis; 0: it is along another, or along none.
template <int D>
int sign_along(const Vec<D>& normal, int axis) {
  for (int i = 0; i < D; ++i) {
    if (i != axis && normal[i] != 0) return 0;
  }
  return normal[axis] > 0 ? 1 : normal[axis] < 0 ? -1 : 0;
}

/// What bounds the soil from below (or above) along an axis.
template <int D>
std::vector<PlateSide> sides_along(const Solver<D>& solver, int axis, bool above) {
  std::vector<PlateSide> sides;
  for (int k = 0; k < int(solver.planes.all.size()); ++k) {
    const auto& plane = solver.planes.all[std::size_t(k)];
    if (plane.axis == axis && (plane.period > 0 || (plane.inside > 0) != above)) sides.push_back({false, k});
  }
  for (int k = 0; k < int(solver.bodies.all.size()); ++k) {
    const auto* half = std::get_if<HalfSpace<D>>(&solver.bodies.all[std::size_t(k)].shape);
    if (half != nullptr && sign_along<D>(half->normal, axis) == (above ? -1 : 1)) sides.push_back({true, k});
  }
  return sides;
}

template <int D>
std::vector<PlateSide> sides_of(const Solver<D>& solver, const Body<D>& body) {
  std::vector<PlateSide> sides;
  for (int axis = 0; axis < D; ++axis) {
    if (axis == body.plate_axis()) continue;
    for (const bool above : {false, true}) {
      const auto found = sides_along<D>(solver, axis, above);
      if (found.size() != 1) {
        throw InputError("body." + body.name + ".pressure_Pa: acts on the area between the boundaries beside it, and " +
                         std::to_string(found.size()) + " bound the specimen along " + axis_names[axis] +
                         (above ? " from above" : " from below") + "; give body." + body.name +
                         ".area_m2, or one [[boundary]] or half-space on each side");
      }
      sides.push_back(found[0]);
    }
  }
  return sides;
}

}  // namespace

template <int D>
void place_plates(const Scene& scene, Solver<D>& solver) {
  for (std::size_t k = 0; k < scene.bodies.size(); ++k) {
    if (!scene.bodies[k].plate) continue;
    const auto& of = *scene.bodies[k].plate;
    auto& body = solver.bodies.all[k];
    Plate plate;
    plate.mass = of.mass;
    plate.pressure = of.pressure;
    plate.until = of.until;
    plate.area = of.area;
    plate.thickness = D == 2 ? scene.thickness : 1;
    if (of.area == 0) plate.sides = sides_of<D>(solver, body);
    body.plate = plate;
  }
  solver.bodies.place_plates(solver.grid, solver.planes, 0);
}

template <int D>
void weigh_plates(Solver<D>& solver) {
  double mass = 0, volume = 0;
  for (const auto& point : solver.points) mass += point.mass, volume += point.volume;
  if (solver.rocks) {
    for (const auto& rock : solver.rocks->all) {
      mass += rock.body.mass;
      volume += solver.rocks->shapes[std::size_t(rock.shape)].volume() * solver.rocks->thickness;
    }
  }
  for (auto& body : solver.bodies.all) {
    if (!body.plate || body.plate->mass > 0) continue;
    body.plate->mass = mass / volume * body.plate->area * solver.grid.cell[body.plate_axis()];
  }
}

#define MPM_INSTANTIATE(D)                                 \
  template void place_plates<D>(const Scene&, Solver<D>&); \
  template void weigh_plates<D>(Solver<D>&);
MPM_INSTANTIATE(2)
MPM_INSTANTIATE(3)
#undef MPM_INSTANTIATE

}  // namespace mpm
