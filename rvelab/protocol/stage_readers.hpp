// What readers of several kinds of stages share. Internal to the module.
#pragma once

#include <string>

#include "rvelab/keys/table_reader.hpp"
#include "rvelab/protocol/drive.hpp"
#include "rvelab/protocol/protocol.hpp"
#include "rvelab/protocol/stage_kinds.hpp"

namespace rvelab::protocol {

inline constexpr double most_records = 1e6;

/// A stage's own pressure, Pa, or the test's. `unless`: what it contradicts, since the stage then holds nothing at it;
/// "": it does.
double pressure_of(keys::TableReader& reader, const char* name, const keys::Range& range, const char* meaning,
                   Protocol& protocol, const std::string& unless = "");

/// record_every, for a stage that goes to `to_strain`.
void read_spacing(keys::TableReader& reader, double& record_every, double to_strain, const char* meaning);

/// to_strain; 0 is a mistake.
void read_strain(keys::TableReader& reader, double& to_strain, const Interval& range, const char* meaning,
                 const char* allowed);

/// cycles and reverse_at_Pa.
void read_cycles(keys::TableReader& reader, Cycles& cycles, double to_strain, double record_every,
                 const char* reverse_meaning);

/// A choice of axes ("xz"), of those in the plane if test.dimension = 2.
std::string read_axes(keys::TableReader& reader, const char* name, const keys::Choices& axes, const char* meaning,
                      const char* usual_2d, const char* usual_3d, const Protocol& protocol);

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
