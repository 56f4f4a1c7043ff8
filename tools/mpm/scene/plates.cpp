#include "tools/mpm/scene/plates.hpp"

#include "tools/mpm/scene/water.hpp"

namespace mpm {

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

}  // namespace mpm
