// Specimens out of nothing: grains on a jittered grid, compressed isotropically until the stress is there.
//
// This room knows how to make specimens; it uses Rve as any client does and knows nothing of files.
#pragma once

#include <cstdint>

#include "rvelab/solver/specimen.hpp"

namespace rvelab {

/// A recipe. Radii are uniform between the limits; the preparation friction sets how dense the packing becomes.
struct PackingRecipe {
  Shape shape = Shape::disc;
  std::size_t grains = 400;
  double smallest_radius = 3e-3, largest_radius = 7e-3;  ///< m
  double thickness = 0.1;                                ///< m, 2D
  double pressure = 1e5;                                 ///< Pa
  double preparation_friction = 0.02;
  Material material;
  ContactModel contact;
  std::uint64_t seed = 1;
};

/// Packs by the recipe: every normal stress within 1 % of -pressure, shear strain zero, final friction set afterwards.
/// The same recipe gives the same bits. Throws InputError (bad recipe) or IncrementFailed.
Specimen random_packing(const PackingRecipe& recipe);

/// A periodic specimen repeated along its cell vectors, contacts with their history copied.
Specimen repeated(const Specimen& specimen, const Image& times);

}  // namespace rvelab
