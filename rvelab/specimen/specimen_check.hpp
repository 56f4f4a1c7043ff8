// What a specimen must be, wherever it comes from: a file, a record, a pool, a snapshot, an importer, a host. The
// ranges of its fields stand where they are declared (specimen_fields.hpp); here is what they must be beside one
// another.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "rvelab/specimen/specimen.hpp"

namespace rvelab {

/// A lattice vector may lean by so many times the vector that it leans along. Beyond, images are so far away that
/// double precision places no grain in them; reduced cells lean by a half, and a cell that is not yet reduced by its
/// shear strain times its slenderness.
inline constexpr double largest_tilt = 1000;

/// Throws InputError: the field under its name in a file, the index as HDF5 counts it, the value and what is allowed.
/// `where`: what stands before that name, such as a path. O(n); every specimen is checked as it is read and opened.
void check_specimen(const Specimen& specimen, const std::string& where = "specimen: ");

/// Whether each of 0 .. grains - 1 comes once.
bool is_permutation(const std::vector<std::int32_t>& order, std::size_t grains);

/// Takes from a specimen what it keeps of other parameters than its present ones: tangential forces of contacts that
/// have no tangential stiffness any more, and scaled masses where the stiffness of contacts has changed (with those of
/// softer contacts a sub-step in quasi-static loading is unstable). `contact`, `materials`: those that it had.
void fit_state_to_parameters(Specimen& specimen, const ContactModel& contact, const std::vector<Material>& materials);

}  // namespace rvelab
