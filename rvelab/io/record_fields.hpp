// The fields of records, probes and progress, once for every way in which they are kept: the datasets of R.h5 and the
// frames of its journal.
#pragma once

#include "rvelab/io/archive.hpp"
#include "rvelab/protocol/progress.hpp"
#include "rvelab/protocol/record.hpp"

namespace rvelab::io {

/// Every column of a record. Value: std::vector<Record>, const or not. Of what [output] quantities chooses, a file
/// holds the columns that were asked for; a frame of the journal holds all, and which of them count.
template <class Archive, class Value>
void describe_records(Archive& archive, Value& records) {
  archive.table("records", records,                                                     //
                Field{"stage", &Record::stage, "1"},                                    //
                Field{"strain", &Record::strain, "1"},                                  //
                Field{"deformation_gradient", &Record::deformation_gradient, "1"},      //
                Field{"stress_Pa", &Record::stress, "Pa"},                              //
                Field{"unbalanced_force_ratio", &Record::unbalanced_force_ratio, "1"},  //
                Field{"inertial_number", &Record::inertial_number, "1"},                //
                Field{"substeps", &Record::substeps, "1"},                              //
                Field{"held_error", &Record::held_error, "1"},                          //
                Field{"target_held", &Record::target_held, "1"},                        //
                Field{"quasi_static", &Record::quasi_static, "1", fields::Rows::one, InFiles::added_later});
  const auto chosen = [&](Quantity quantity, const auto& column) {
    archive.chosen("records", records, column, &Record::quantities, static_cast<std::uint64_t>(quantity));
  };
  archive.choice("records", records, Field{"quantities", &Record::quantities, "1"});
  chosen(void_ratio_asked, Field{"void_ratio", &Record::void_ratio, "1"});
  chosen(coordination_number_asked, Field{"coordination_number", &Record::coordination_number, "1"});
  chosen(fabric_anisotropy_asked, Field{"fabric_anisotropy", &Record::fabric_anisotropy, "1"});
  chosen(sliding_fraction_asked, Field{"sliding_fraction", &Record::sliding_fraction, "1"});
  chosen(mechanical_void_ratio_asked, Field{"mechanical_void_ratio", &Record::mechanical_void_ratio, "1"});
  chosen(mechanical_coordination_number_asked,
         Field{"mechanical_coordination_number", &Record::mechanical_coordination_number, "1"});
  chosen(fabric_asked, Field{"fabric", &Record::fabric, "1"});
  chosen(branch_fabric_asked, Field{"branch_fabric", &Record::branch_fabric, "1"});
  chosen(contact_stress_asked, Field{"contact_stress_Pa", &Record::contact_stress, "Pa"});
  chosen(reynolds_stress_asked, Field{"reynolds_stress_Pa", &Record::reynolds_stress, "Pa"});
  chosen(elastic_energy_asked, Field{"elastic_energy_J", &Record::elastic_energy, "J"});
  chosen(kinetic_energy_asked, Field{"kinetic_energy_J", &Record::kinetic_energy, "J"});
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

/// Probe results: the names of their stages, and one square matrix each (all of one size).
void put_probes(Hdf5File& file, const std::vector<ProbeResult>& probes);
std::vector<ProbeResult> get_probes(const Hdf5File& file);

}  // namespace rvelab::io
