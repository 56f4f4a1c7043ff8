// What a specimen is to be: grains, stress, void ratio, and how it is prepared.
//
// This module knows how to make specimens; it uses Rve as any client does and knows no file. Pressures and void ratios
// are those of the finished specimen, with the friction of its materials.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "rvelab/grains/clump.hpp"
#include "rvelab/grains/grading.hpp"
#include "rvelab/specimen/specimen.hpp"

namespace rvelab::pack {

/// How sizes are drawn from a grading.
enum class Sampling {
  random,     ///< one from each of N equal parts of the number, at random within it
  stratified  ///< d10, d50 and d90 by mass are those of the grading (sampling.hpp), the same sizes for every seed
};

/// A part of the grains with a material and a grading of its own.
struct GrainFraction {
  std::string name = "grains";
  double share = 1;          ///< of all grains, by number or by mass (Recipe::share_by_mass); all shares add up to 1
  std::size_t material = 0;  ///< row of Recipe::materials
  Grading grading;
  Sampling sampling = Sampling::random;
  std::optional<Clump> clump = {};  ///< where the recipe is of clumps: the shape of this fraction
  /// Superellipsoids: half axes along x, y, z of the shape, of which the ratios count, and exponents e (of x and y) and
  /// n (of both and z). bedding_spread is then the largest angle of the z of the shapes from the vertical, directions
  /// within equally frequent; 90: every orientation equally likely.
  Vector3 half_axes = Vector3::Ones();
  double exponent_xy = 2, exponent_z = 2;
  // Not round:
  double smallest_aspect_ratio = 1, largest_aspect_ratio = 1;  ///< b/a, every value between equally frequent
  double bedding_angle = 0,
         bedding_spread = 90;  ///< degrees: from x to the long axes on average; to either side, every
                               ///< angle equally frequent. As they are laid, before they are pressed

  /// Its table, as messages name it: "grains", "grains.fine".
  std::string table() const { return name == GrainFraction{}.name ? name : "grains." + name; }
};

/// How a specimen is brought from scattered grains to contact.
struct Preparation {
  enum class Method {
    compression,  ///< scattered without contact, then the cell shrinks
    growth,       ///< scattered small in a cell of the end's size, then the radii grow (Li et al. 2023)
    regular       ///< laid in rows (regular.hpp)
  };
  Method method = Method::compression;
  std::optional<double> friction;  ///< of all contacts while it is prepared; none: that of the materials, or searched
  double rolling_friction = 0;     ///< eta while it is prepared, where the contact model rolls
  double lowest_friction = 0, highest_friction = 1e6;  ///< of a search for the void ratio
  long max_draws = 100;                                ///< of that search
  double first_size = 0.2;                             ///< growth: radii at the start over those at the end
  std::optional<double> growth_void_ratio;             ///< growth: of the cell when the grains have grown; none: below
  // Agitation (agitation.hpp) between the preparation friction and that of the materials:
  std::optional<double> expansion;          ///< strain along each axis; none: searched for a coordination number, or no
                                            ///< agitation
  std::optional<double> least_expansion;    ///< to which it is reduced for a void ratio out of reach; 0: at last no
                                            ///< agitation; none: it is not reduced
  std::optional<double> strain_difference;  ///< of the compression after it; none: searched for a fabric, or 0
};

/// How agitated grains are compressed.
struct Agitation {
  double expansion = 8e-3;  ///< strain of the cell along each axis, by which the grains come apart
  /// Of the compressive strains along ContactTarget::axis and across it, over the larger of them. 0: isotropic, 1:
  /// along alone, -1: across alone, up to 1.5: the cell widens across while it shortens.
  double strain_difference = 0;
};
inline constexpr double smallest_expansion = 1e-4;  ///< of a search
inline constexpr double largest_expansion = 0.1, largest_strain_difference = 1.5;

/// Number and directions of the contacts of the finished specimen; none: what the preparation gives.
struct ContactTarget {
  std::optional<double> coordination_number;  ///< Z_mech: of the grains that bear
  double coordination_tolerance = 0.05;
  /// Along the axis, positive where more contacts lie along it than across: 2D 4 (phi - 1/2), 3D 45/4 (phi - 1/3), phi
  /// the mean square of the normals' component. Of a fabric with this axis fabric_anisotropy() and its sign.
  std::optional<double> fabric_anisotropy;
  double fabric_tolerance = 0.05;
  std::optional<int> axis;  ///< 0, 1, 2; none: the last
};

/// A recipe. The same recipe gives the same bits on any number of threads.
struct Recipe {
  Shape shape = round_shape(2);
  bool clumps = false;       ///< each grain is a body whose members are of that shape
  std::size_t number = 400;  ///< grains in all
  std::uint64_t seed = 1;
  double thickness = 0.1;  ///< m, of the slab, 2D
  bool oriented = false;   ///< lattice of Kraynik and Reinelt (2D) or of the cubic field (3D); else square or cubic
  bool share_by_mass = false;
  std::vector<GrainFraction> fractions{GrainFraction{}};
  std::vector<Material> materials{Material{}};
  ContactModel contact;
  Damping damping;
  SolverOptions solver;

  std::optional<Matrix3> stress;     ///< Pa, laboratory frame, tension positive, symmetric; none: void_ratio alone
  std::optional<double> void_ratio;  ///< none: what the preparation gives
  double void_ratio_tolerance = 1e-3;
  ContactTarget contacts;
  double stress_tolerance = 5e-4;  ///< of the mean pressure, for each component
  double unbalanced = 1e-5;
  Preparation preparation;
};

/// All stress components of an isotropic pressure (Pa, compression positive).
Matrix3 isotropic_stress(double pressure, Shape shape);

/// Materials while a specimen is prepared with the given friction.
std::vector<Material> preparing(const Recipe& recipe, double friction);

/// Void ratio of the cell in which grains grow: as given; without a stress the target's; else 0.1 above the target's,
/// and without that 0.3 in 2D, 0.9 in 3D.
double growth_void_ratio(const Recipe& recipe);

/// Whether the grains are agitated before they are compressed with their own friction.
bool is_agitated(const Recipe& recipe);
/// Number (0, 1, 2) of the axis of the fabric.
int fabric_axis(const Recipe& recipe);
/// The anisotropy along an axis (ContactTarget) of a fabric tensor in the laboratory frame.
double anisotropy_along(const Matrix3& fabric, int dimension, int axis);

/// Throws InputError for what no specimen can be made of.
void check_recipe(const Recipe& recipe);

/// How a specimen came about, beside itself.
struct Packing {
  Specimen specimen;
  long draw = 1;  ///< the one that was accepted, from 1
  double preparation_friction = 0;
  double void_ratio = 0;
  std::optional<Agitation> agitation = {};
};

}  // namespace rvelab::pack
