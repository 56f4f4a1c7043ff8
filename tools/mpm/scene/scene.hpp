// A scene as its TOML file says it, with every default. Lengths of vectors are the dimension.
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "tools/mpm/bodies/shapes.hpp"
#include "tools/mpm/keys/keys.hpp"
#include "tools/mpm/materials/continuum.hpp"
#include "tools/mpm/scene/rocks.hpp"
#include "tools/mpm/step/loads.hpp"
#include "tools/mpm/step/options.hpp"
#include "tools/mpm/water/options.hpp"

namespace mpm {

struct GrainsOfScene {
  std::vector<std::string> specimens;
  double density = 0;  ///< kg/m^3, of the grains themselves
  bool at_rate = false;
  double tolerance_rel = 0, tolerance_abs = 0, gather = 0;
};

struct MaterialOfScene {
  std::string name;
  std::optional<GrainsOfScene> grains;  ///< else:
  Continuum continuum;
  double density = 0;  ///< kg/m^3, of the continuum
};

struct RegionOfScene {
  std::string material;
  std::vector<double> lower, upper, velocity;
  long points_per_cell = 4;
  bool ellipsoid = false;  ///< that which the box holds, instead of the box
  /// Of a table: x, y(, z), radius (m) of a grain for each point, which has the grain's solids and is its ball to
  /// rocks.
  std::vector<std::vector<double>> grains;
  bool saturated = false;
  double conductivity = 0, porosity = 0;  ///< m/s, 1; of a continuum (that of grains is their own)

  /// m^3 (m^2 in the plane), of the soil of a grain: its solids and their pores.
  double volume_of(const std::vector<double>& grain) const;
  double largest_side() const;  ///< m, of the domains of the grains
};

/// Water that saturated soil begins with. table: m, height at which it has no pressure; NaN: it has none anywhere.
struct WaterOfScene {
  FluidOptions options;
  double conductivity = 0, porosity = 0, table = NAN;
};

struct PlaneOfScene {
  std::string name;
  int axis = 0;
  double at = 0;
  bool soil_above = true, fixed = false;
  double removed_at = 0;
  std::vector<std::vector<double>> motion;
  double to = NAN;       ///< m, the plane that a periodic one is one with
  double impedance = 0;  ///< kg/(m^2 s), of an absorbing one
  WaterBoundary water;
};

/// A body under pressure. mass: kg, area: m^2; 0: to be found.
struct PlateOfScene {
  TimeHistory pressure;
  double until = 1e300, mass = 0, area = 0;
};

struct BodyOfScene {
  std::string name;
  std::variant<BodyShape<2>, BodyShape<3>> shape;
  std::vector<double> centre;
  double friction = 0;
  bool at_surface = false;
  bool rough = true;
  std::vector<std::vector<double>> motion;
  std::optional<PlateOfScene> plate;
};

/// Stages of a test, as text of TOML, that the RVEs of a material go through at a moment.
struct ChangeOfScene {
  std::string name, material, stages;
  double at = 0;                     ///< s
  std::vector<double> lower, upper;  ///< m: of points that lie in this box then; empty: of all
};

struct Scene {
  enum class Stress { zero, isotropic, geostatic };
  std::string name;
  int dimension = 2;
  double thickness = 1;
  std::vector<double> cell;
  Shape shape = Shape::bspline;
  std::string follows;
  double duration = 0, pic_fraction = 0.1, cfl = 0.4;
  Scheme scheme = Scheme::usf;
  bool affine = true;
  std::vector<double> gravity;
  double surface_pressure = 0;
  Stress stress = Stress::zero;
  double pressure = 0, surface = 0, earth_pressure_ratio = 1;
  Loads loads;
  std::optional<WaterOfScene> water;  ///< none: dry soil
  std::vector<MaterialOfScene> materials;
  std::vector<ChangeOfScene> changes;  ///< in the order of their times
  std::vector<RegionOfScene> regions;
  std::vector<PlaneOfScene> planes;
  std::vector<BodyOfScene> bodies;
  double rock_steps = 50;             ///< sub-steps of the shortest collision of rocks
  std::optional<RocksOfScene> rocks;  ///< none: no rocks
  double frame_every = 0, history_every = 0, checkpoint_every = 0;
  std::vector<std::vector<double>> watched;
  bool networks = false;  ///< with each frame, those of the watched points
};

/// Cases override the scene in their order, then the assignments. `resolved` becomes the table without its cases, as
/// the run keeps it.
Scene read_scene(const std::string& path, const std::vector<std::string>& cases,
                 const std::vector<std::string>& assignments, toml::table* resolved = nullptr);

/// Names of the cases of a file, in alphabetical order.
std::vector<std::string> cases_of(const std::string& path);

}  // namespace mpm
