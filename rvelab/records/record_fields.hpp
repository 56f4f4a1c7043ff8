// The fields of records and of progress, once for every way in which they are kept: the datasets of R.h5 and the frames
// of its journal. Each description is a template over the archive that writes or reads (rvelab/io/archive.hpp).
#pragma once

#include "rvelab/records/column.hpp"
#include "rvelab/records/progress.hpp"
#include "rvelab/records/record.hpp"

namespace rvelab::records {

/// Every column of a record. Value: std::vector<Record>, const or not. Of what [output] quantities chooses, a file
/// holds the columns that were asked for; a frame of the journal holds all, and which of them count.
template <class Archive, class Value>
void describe_records(Archive& archive, Value& records) {
  archive.table("records", records,                                                      //
                Column{"stage", &Record::stage, "1"},                                    //
                Column{"strain", &Record::strain, "1"},                                  //
                Column{"deformation_gradient", &Record::deformation_gradient, "1"},      //
                Column{"stress_Pa", &Record::stress, "Pa"},                              //
                Column{"unbalanced_force_ratio", &Record::unbalanced_force_ratio, "1"},  //
                Column{"inertial_number", &Record::inertial_number, "1"},                //
                Column{"substeps", &Record::substeps, "1"},                              //
                Column{"held_error", &Record::held_error, "1"},                          //
                Column{"target_held", &Record::target_held, "1"});
  archive.later_column("records", records, Column{"quasi_static", &Record::quasi_static, "1"});
  const auto chosen = [&](Quantity quantity, const auto& column) {
    archive.chosen("records", records, column, &Record::quantities, static_cast<std::uint64_t>(quantity));
  };
  archive.choice("records", records, Column{"quantities", &Record::quantities, "1"});
  chosen(void_ratio_asked, Column{"void_ratio", &Record::void_ratio, "1"});
  chosen(coordination_number_asked, Column{"coordination_number", &Record::coordination_number, "1"});
  chosen(fabric_anisotropy_asked, Column{"fabric_anisotropy", &Record::fabric_anisotropy, "1"});
  chosen(sliding_fraction_asked, Column{"sliding_fraction", &Record::sliding_fraction, "1"});
  chosen(mechanical_void_ratio_asked, Column{"mechanical_void_ratio", &Record::mechanical_void_ratio, "1"});
  chosen(mechanical_coordination_number_asked,
         Column{"mechanical_coordination_number", &Record::mechanical_coordination_number, "1"});
  chosen(fabric_asked, Column{"fabric", &Record::fabric, "1"});
  chosen(branch_fabric_asked, Column{"branch_fabric", &Record::branch_fabric, "1"});
  chosen(contact_stress_asked, Column{"contact_stress_Pa", &Record::contact_stress, "Pa"});
  chosen(reynolds_stress_asked, Column{"reynolds_stress_Pa", &Record::reynolds_stress, "Pa"});
  chosen(elastic_energy_asked, Column{"elastic_energy_J", &Record::elastic_energy, "J"});
  chosen(kinetic_energy_asked, Column{"kinetic_energy_J", &Record::kinetic_energy, "J"});
}

/// Every field of a running test's progress; a structured binding, so that a new one does not compile until it is here.
/// The wall time stands under /provenance, and is the caller's.
template <class Archive, class Value>
void describe_progress(Archive& archive, Value& progress) {
  auto& [stage, phase, step, relaxation_steps, substeps, records, probes, unbalanced_ratio, first_pressure, rate,
         deformation, stress, strain_sum, first_stress, turns, place, visits, largest, axis, pressure,
         first_grain_steps, wall_seconds] = progress;
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
  archive.later_field("checkpoint/strain_sum", strain_sum, "1");
  archive.later_field("checkpoint/first_stress_Pa", first_stress, "Pa");
  archive.later_field("checkpoint/turns", turns, "1");
  archive.later_field("checkpoint/place", place, "1");
  archive.later_field("checkpoint/visits", visits, "1");
  archive.later_field("checkpoint/largest", largest, "1");
  archive.field("checkpoint/axis", axis, "-");
  archive.field("checkpoint/pressure_Pa", pressure, "Pa");
  archive.field("checkpoint/first_grain_steps", first_grain_steps, "1");
}

}  // namespace rvelab::records
