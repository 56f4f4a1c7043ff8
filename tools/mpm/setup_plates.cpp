#include "tools/mpm/setup_plates.hpp"

#include "tools/mpm/rocks.hpp"
#include "tools/mpm/scene_water.hpp"

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

std::optional<PlateOfScene> read_plate(Keys& keys) {
  PlateOfScene plate;
  const double pressure = keys.number("pressure_Pa", 0);
  plate.pressure = read_time_history(keys, "pressure_history", "_Pa");
  if (keys.has("pressure_Pa")) {
    if (!plate.pressure.times.empty())
      keys.wrong("pressure_history", "and pressure_Pa say the same thing twice; remove one of them");
    plate.pressure = {{0}, {pressure}};
  }
  plate.until = keys.number("pressure_until_s", 1e300, 0);
  if (keys.has("plate_mass_kg")) plate.mass = keys.positive("plate_mass_kg");
  if (keys.has("area_m2")) plate.area = keys.positive("area_m2");
  keys.known("plate_mass_kg");
  keys.known("area_m2");
  for (const double value : plate.pressure.values) {
    if (value < 0)
      keys.wrong(keys.has("pressure_Pa") ? "pressure_Pa" : "pressure_history",
                 "is negative, and a plate only pushes; give pressures of 0 and more");
  }
  if (!plate.pressure.times.empty()) return plate;
  for (const char* name : {"pressure_until_s", "plate_mass_kg", "area_m2"}) {
    if (keys.has(name)) keys.wrong(name, "is of a plate under pressure; give pressure_Pa, or remove the key");
  }
  return {};
}

void check_plates(const Scene& scene, const std::string& path) {
  for (const auto& body : scene.bodies) {
    if (!body.plate) continue;
    const auto refuse = [&](const std::string& why) { throw InputError(path + ": body." + body.name + why); };
    const bool along_axis = std::visit(
        [](const auto& of_dimension) {
          return std::visit(
              [](const auto& shape) {
                if constexpr (requires { shape.normal; }) {
                  return shape.normal.cwiseAbs().maxCoeff() == 1;
                } else {
                  return false;
                }
              },
              of_dimension);
        },
        body.shape);
    if (!along_axis) {
      refuse(
          ".pressure_Pa: is of a plate, which moves along its normal; set kind = \"half_space\" and a normal along "
          "an axis");
    }
    if (!body.at_surface) refuse(".contact: of a plate under pressure is \"surface\"; remove the key");
    if (scene.water) refuse(".pressure_Pa: is for dry scenes, and this one has [fluid]; set motion instead");
    if (!body.motion.empty() && body.plate->until == 1e300) {
      refuse(
          ".motion: and pressure_Pa both move the plate; remove one of them, or set pressure_until_s, from which "
          "time on it has its motion");
    }
  }
}

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
