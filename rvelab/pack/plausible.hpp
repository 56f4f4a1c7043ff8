// Whether a specimen can exist: the overlap that pressure, stiffness and size of the grains lead to, before any is
// made.
#pragma once

#include <string>
#include <vector>

#include "rvelab/pack/recipe.hpp"

namespace rvelab::pack {

/// A pressure on grains of one size, in a cell that is neither dense nor loose.
struct Pressed {
  std::string by;       ///< where the pressure stands: "target.pressure_Pa"
  double pressure = 0;  ///< Pa, compression positive
  Shape shape = round_shape(2);
  double radius = 0;     ///< m
  double thickness = 0;  ///< m, 2D
};

/// Overlap over the radius of contacts that carry the mean force of that pressure,
///   2D  p t pi r (1 + e) 2/z,  e = 0.2, z = 4;   3D  p pi r^2 (1 + e) 4/z,  e = 0.65, z = 5.5
/// (d p V = sum of f l over the contacts, z/2 a grain; both within a factor of 2 of packings), and of their adhesion.
double expected_overlap(const Pressed& pressed, const ContactModel& model, const Material& material);

/// InputError naming the stiffness of a material with which the grains would overlap by more than a radius.
void expect_possible(const Pressed& pressed, const ContactModel& model, const std::vector<Material>& materials);

/// The materials with which the overlap is unlikely to be meant (above a tenth of the radius, below 1e-9 of it), each
/// as one line; empty if there is none.
std::vector<std::string> unusual_overlaps(const Pressed& pressed, const ContactModel& model,
                                          const std::vector<Material>& materials);

/// Time that one draw of a recipe takes on one core, s, within a factor of some 3: from packings that were measured.
double expected_seconds(const Recipe& recipe);

/// The same of a specimen under a pressure, by its mean radius; none: nothing is said.
Pressed pressed(const Specimen& specimen, const std::string& by, double pressure);

/// What is unusual in a specimen: its radii, and what the contact law reads of its materials.
std::vector<std::string> unusual_in(const Specimen& specimen);

}  // namespace rvelab::pack
