// One contact of a specimen that is not opened as an Rve, computed by its law: for reading and writing files.
#pragma once

#include "rvelab/specimen/specimen.hpp"

namespace rvelab {

/// x_j + L image - x_i, m, cell frame.
Vector3 branch_of(const Specimen& specimen, const Contact& contact);
/// Cell frame, from i to j; along the branch where the grains are round.
Vector3 normal_of(const Specimen& specimen, const Contact& contact);
double overlap_of(const Specimen& specimen, const Contact& contact);  ///< m
PairParameters parameters_of(const Specimen& specimen, const Contact& contact);
/// Elastic, N, repulsion positive; 0 without overlap.
double normal_force_of(const Specimen& specimen, const Contact& contact);

/// Sets Contact::last_root_overlap of all: the root of laws that store it (hertz_mindlin), else zero.
void set_root_overlaps(Specimen& specimen);

}  // namespace rvelab
