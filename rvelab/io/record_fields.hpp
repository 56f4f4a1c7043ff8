// The fields of records, probes and progress, once for every way in which they are kept: the datasets of R.h5 and the
// frames of its journal.
#pragma once

#include "rvelab/io/archive.hpp"
#include "rvelab/protocol/progress.hpp"
#include "rvelab/protocol/record.hpp"

namespace rvelab::io {

/// Every column of a record. Value: std::vector<Record>, const or not.
template <class Archive, class Value>
void describe_records(Archive& archive, Value& records) {
  archive.table("records", records,                                                      //
                Column{"stage", &Record::stage, "1"},                                    //
                Column{"strain", &Record::strain, "1"},                                  //
                Column{"deformation_gradient", &Record::deformation_gradient, "1"},      //
                Column{"stress_Pa", &Record::stress, "Pa"},                              //
                Column{"void_ratio", &Record::void_ratio, "1"},                          //
                Column{"coordination_number", &Record::coordination_number, "1"},        //
                Column{"fabric_anisotropy", &Record::fabric_anisotropy, "1"},            //
                Column{"sliding_fraction", &Record::sliding_fraction, "1"},              //
                Column{"unbalanced_force_ratio", &Record::unbalanced_force_ratio, "1"},  //
                Column{"inertial_number", &Record::inertial_number, "1"},                //
                Column{"substeps", &Record::substeps, "1"},                              //
                Column{"held_error", &Record::held_error, "1"},                          //
                Column{"target_held", &Record::target_held, "1"});
}

/// Every field of a running test's progress; a structured binding, so that a new one does not compile until it is here.
/// The wall time stands under /provenance, and is the caller's.
template <class Archive, class Value>
void describe_progress(Archive& archive, Value& progress) {
  auto& [stage, phase, step, relaxation_steps, substeps, records, probes, unbalanced_ratio, first_pressure, rate,
         deformation, stress, axis, pressure, first_grain_steps, wall_seconds] = progress;
  static_cast<void>(wall_seconds);
  archive.field("checkpoint/stage", stage, "1");
  archive.field("checkpoint/phase", phase, "1");
  archive.field("checkpoint/step", step, "1");
  archive.field("checkpoint/relaxation_steps", relaxation_steps, "1");
  archive.field("checkpoint/substeps", substeps, "1");
  archive.field("checkpoint/records", records, "1");
  archive.field("checkpoint/probes", probes, "1");
  archive.field("checkpoint/unbalanced_force_ratio", unbalanced_ratio, "1");
  archive.field("checkpoint/first_pressure_Pa", first_pressure, "Pa");
  archive.field("checkpoint/rate_1_s", rate, "1/s");
  archive.field("checkpoint/deformation_gradient", deformation, "1");
  archive.field("checkpoint/stress_Pa", stress, "Pa");
  archive.field("checkpoint/axis", axis, "-");
  archive.field("checkpoint/pressure_Pa", pressure, "Pa");
  archive.field("checkpoint/first_grain_steps", first_grain_steps, "1");
}

/// Probe results: the names of their stages, and one square matrix each (all of one size).
void put_probes(Hdf5File& file, const std::vector<ProbeResult>& probes);
std::vector<ProbeResult> get_probes(const Hdf5File& file);

}  // namespace rvelab::io
