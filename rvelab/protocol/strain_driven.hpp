// What compression and simple shear share: a strain that goes straight to its end or to and fro, one increment for each
// record. Internal to the room.
#pragma once

#include <string>

#include "rvelab/protocol/drive.hpp"
#include "rvelab/protocol/stage_kind.hpp"

namespace rvelab::protocol {

/// to_strain; 0 is a mistake.
double strain_of(StageSource& source);

/// cycles and reverse_at_Pa.
Cycles read_cycles(keys::TableReader& reader, double to_strain, double record_every);

/// A mistake at `key` if its axes ("xz") leave the plane of test.dimension = 2.
void expect_in_plane(keys::TableReader& reader, const std::string& key, const std::string& axes,
                     const Protocol& protocol);

/// What is wrong if they leave the plane of a specimen; "" if nothing is.
std::string out_of_plane(const std::string& key, const std::string& axes, int dimension);

/// Records on the way to one amplitude.
long steps_to(double to_strain, double spacing);

/// Records of a whole stage; where a stress turns it, those that it makes if none does.
std::size_t strain_records(double to_strain, double spacing, const Cycles& cycles);

inline int axis_index(char axis) { return axis - 'x'; }

/// "-sigma_xx": what messages call a normal stress, compression positive.
inline std::string normal_stress(int k) { return std::string("-sigma_") + "xyz"[k] + "xyz"[k]; }

/// Goes through the stage: `increment_to(strain)` applies the increment to a record, `driving_stress(stress)` grows
/// with the driving strain.
template <class Settings, class Increment, class DrivingStress>
void drive_strain(RunningTest& test, const Settings& stage, Increment increment_to, DrivingStress driving_stress) {
  if (stage.cycles.count == 0)
    return test.go_through(record_strains(stage.to_strain, stage.record_every), increment_to);
  test.go_to_and_fro(stage.to_strain, steps_to(stage.to_strain, stage.record_every), stage.cycles, increment_to,
                     driving_stress);
}

}  // namespace rvelab::protocol
