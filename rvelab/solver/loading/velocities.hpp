// Velocities and masses of the two kinds of loading, and the energy of the fluctuations.
#pragma once

#include "rvelab/solver/assembly/assembly.hpp"

namespace rvelab {

struct RowSums;

/// Sets the units of the stored velocities for a kind of loading, and the physical masses; those of quasi-static
/// loading are the caller's to scale. Velocities end where the kind of loading changes.
void set_loading(const Model& model, Assembly& assembly, Loading loading);

/// scale_inertia with the change of kinetic energy booked.
void rescale_inertia(const Model& model, const RowSums& sums, Assembly& assembly);

/// Of the fluctuations with the masses in use, in units of the force law's energy (J, also in quasi-static loading).
double kinetic_energy(const Model& model, const Assembly& assembly);

/// Sets all velocities to zero; books their energy where the energy balance is kept.
void stop_grains(const Model& model, Assembly& assembly);

/// Reynolds stress times volume, -sum m v' v', cell frame, with the masses in use.
Matrix3 reynolds_stress_times_volume(const Model& model, const Assembly& assembly);

}  // namespace rvelab
