// The fields of records and of progress, described once for all their files: the datasets of R.h5 and the frames of its
// journal. Each description is a template over the archive that writes or reads (rvelab/io/hdf5/archive.hpp).
#pragma once

#include "rvelab/records/progress.hpp"
#include "rvelab/records/record.hpp"
#include "rvelab/specimen/described.hpp"

namespace rvelab::records {

/// A member of a part of the record as one of the record.
template <class Part, class Member>
constexpr Member Record::*in_record(Member Part::*member) {
  return member;
}

/// Every column of a record. Value: std::vector<Record>, const or not. Of the quantities (quantities.hpp) a file holds
/// the requested columns; a frame of the journal has all, and the bits of the valid ones.
template <class Archive, class Value>
void describe_records(Archive& archive, Value& records) {
  const auto column = [](const char* name, auto member, const char* unit) {
    return fields::Field{name, in_record(member), unit};
  };
  archive.table("records", records,                                                      //
                column("stage", &Record::stage, "1"),                                    //
                column("strain", &Record::strain, "1"),                                  //
                column("deformation_gradient", &Record::deformation_gradient, "1"),      //
                column("stress_Pa", &Record::stress, "Pa"),                              //
                column("unbalanced_force_ratio", &Record::unbalanced_force_ratio, "1"),  //
                column("inertial_number", &Record::inertial_number, "1"),                //
                column("substeps", &Record::substeps, "1"),                              //
                column("held_error", &Record::held_error, "1"),                          //
                column("target_held", &Record::target_held, "1"),                        //
                column("quasi_static", &Record::quasi_static, "1"),                      //
                column("cell_thin", &Record::cell_thin, "1"),                            //
                column("error_estimate", &Record::error_estimate, "1"));
  archive.choice("records", records, column("quantities", &Record::quantities, "1"));
  Quantities::for_each([&]<class Quantity>(std::type_identity<Quantity>, std::uint64_t bit) {
    archive.chosen("records", records, column(Quantity::text.name, Quantity::member, Quantity::text.unit),
                   in_record(&Record::quantities), bit);
  });
}

/// Every field of the progress of a running test; by a structured binding, so that a new field does not compile until
/// it is added here. The caller stores the wall time under /provenance.
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
  archive.field("checkpoint/strain_sum", strain_sum, "1");
  archive.field("checkpoint/first_stress_Pa", first_stress, "Pa");
  archive.field("checkpoint/turns", turns, "1");
  archive.field("checkpoint/place", place, "1");
  archive.field("checkpoint/visits", visits, "1");
  archive.field("checkpoint/largest", largest, "1");
  archive.field("checkpoint/axis", axis, "-");
  archive.field("checkpoint/pressure_Pa", pressure, "Pa");
  archive.field("checkpoint/first_grain_steps", first_grain_steps, "1");
}

}  // namespace rvelab::records
