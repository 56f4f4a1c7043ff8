// The check of a specimen from any source: a file, a record, a pool, a snapshot, an importer, a host. The ranges of its
// fields are in their declarations (specimen_fields.hpp); this file has the conditions between fields.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "rvelab/specimen/specimen.hpp"

namespace rvelab {

/// Largest tilt of a lattice vector over the vector along which it tilts. Beyond it images are so far away that double
/// precision does not resolve positions in them. The tilt of reduced cells is a half, that of an unreduced cell its
/// shear strain times its slenderness.
inline constexpr double largest_tilt = 1000;

/// Throws InputError with the name of the field in a file, the index as HDF5 counts it, the value and the allowed
/// range. `where`: text before that name, such as a path. O(n); every specimen is checked as it is read and opened.
void check_specimen(const Specimen& specimen, const std::string& where = "specimen: ");

/// Whether each of 0 .. grains - 1 occurs once.
bool is_permutation(const std::vector<std::int32_t>& order, std::size_t grains);

/// Removes from a specimen what depends on its former parameters: tangential forces of contacts that have lost their
/// tangential stiffness, and scaled masses if the stiffness of contacts has changed (with the masses of softer contacts
/// a quasi-static sub-step is unstable). `contact`, `materials`: the former ones.
void fit_state_to_parameters(Specimen& specimen, const ContactModel& contact, const std::vector<Material>& materials);

}  // namespace rvelab
