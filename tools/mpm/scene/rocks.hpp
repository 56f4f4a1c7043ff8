// Rocks of a scene: [[rock_material]], [[rock]], [[rocks]], [rock_soil].
#pragma once

#include <string>
#include <vector>

#include "tools/mpm/keys/keys.hpp"
#include "tools/mpm/rocks/contact.hpp"
#include "tools/mpm/shapes/shape.hpp"

namespace mpm {

struct Scene;

struct RockMaterialOfScene {
  std::string name;
  double density = 0;  ///< kg/m^3
  RockMaterial constants;
};

/// One rock; lengths of vectors are the dimension.
struct RockOfScene {
  std::string name;
  bool single = true;  ///< of [[rock]]: its path is kept in history.csv
  std::size_t material = 0;
  enum class Form { sphere, superquadric, polyhedron } form = Form::sphere;
  double radius = 0;
  std::vector<double> half_axes;
  std::vector<double> blockiness{2, 2};
  std::vector<std::vector<double>> triangles;  ///< nine numbers each, m
  std::vector<double> centre, velocity;
  std::vector<double> spin;      ///< rad/s: one number in the plane
  std::vector<double> rotation;  ///< rad in the plane; a quaternion w, x, y, z in space
  std::vector<std::string> held;
};

/// Rocks drawn at random in a box.
struct RockField {
  std::string name;
  std::size_t material = 0;
  std::vector<double> lower, upper;              ///< m
  double share = 0;                              ///< of the volume of the box
  std::vector<std::vector<double>> diameters;    ///< m of the sphere of equal volume, and parts by volume
  double spread = 0;                             ///< diameters vary by this part, to both sides
  std::vector<double> aspect, blockiness{2, 2};  ///< lengths of the axes, in proportion
  bool aligned = false;                          ///< else turned at random
  std::vector<double> rotation;                  ///< of those that are aligned
  double gap = 0;                                ///< m, left between them at least
  long seed = 1;
};

struct RocksOfScene {
  std::vector<RockMaterialOfScene> materials;
  std::vector<RockOfScene> all;  ///< those of [[rocks]] too
  RockSoil soil;
  double steps_per_collision = 50;
};

/// Rows of the tables and STL files that rocks name become a part of the scene, so that a run's folder is whole.
void include_rocks(toml::table& file, const std::string& scene_path);
/// Nothing where the scene has no rocks.
void read_rocks(Keys& file, Scene& scene);
/// InputError: rocks where the method has no answer for them.
void check_rocks(const Scene& scene, const std::string& path);
/// Draws sizes and places, and pushes them apart until none overlaps another or `others`. InputError where they do not
/// fit.
void draw_rocks(const RockField& field, std::vector<RockOfScene>& all);

template <int D>
RockShape<D> shape_of(const RockOfScene& rock, Vec<3>* centre = nullptr, Eigen::Quaterniond* axes = nullptr);
template <int D>
Rot<D> orientation_of(const RockOfScene& rock);

}  // namespace mpm
