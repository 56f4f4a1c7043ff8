// A test as data: stages of loading, read from a TOML file and checked whole before anything runs.
//
// This module knows what a laboratory test is (stages, targets, what is recorded); it reaches grains only through
// Rve::apply and Rve::relax and knows no file but the protocol. Pressures are compression positive; strains are
// dimensionless and count from the start of their stage.
#pragma once

#include <toml++/toml.h>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "rvelab/keys/key.hpp"
#include "rvelab/protocol/stages.hpp"
#include "rvelab/records/record.hpp"
#include "rvelab/specimen/specimen.hpp"

namespace rvelab::protocol {

/// Time in driven stages (compression, simple shear, flow, deformation). All other stages are quasi-static.
struct LoadingSettings {
  bool at_rate = false;           ///< false: quasi-static; true: physical masses at the rate below
  double rate = 0;                ///< 1/s, true rate of the driving strain; 0: from the inertial number
  double inertial_number = 0;     ///< I = rate d sqrt(rho/p), p at the start of the stage; 0: from the rate
  double held_tolerance = 0.005;  ///< a held stress may miss by this times max(|target|, 1 % of the stage's first p);
                                  ///< at a rate: its mean over an increment may
  static constexpr double held_tolerance_at_rate =
      0.05;  ///< default at a given rate, where collisions make it fluctuate
};

/// A condition that ends a stage, checked at each of its records after the first.
struct Event {
  enum class When { above, below, falls_by };
  std::string quantity;  ///< see event_quantities()
  When when = When::above;
  double value = 0;  ///< of the quantity; falls_by: fraction that it has lost of the largest it had in this stage
  std::string then;  ///< name of the stage to go on with; empty: the next; "end": none
};

/// "p_over_first below 0.001".
std::string event_in_words(const Event& event);

class StageKind;

struct Stage {
  std::string name;                       ///< the kind, unless the file names it
  std::string kind;                       ///< as stage_kinds.hpp calls it
  std::shared_ptr<const StageKind> what;  ///< the kind with its settings
  std::vector<Event> until;
  std::string then;  ///< after its own end; empty: the next; "end": none
};

/// A checked protocol.
struct Protocol {
  std::string path;  ///< of its file; relative names in it count from there
  std::string name;
  int dimension = 0;                                           ///< 2 or 3; 0: any
  double pressure = std::numeric_limits<double>::quiet_NaN();  ///< Pa, [test] pressure_Pa
  bool uses_pressure = false;                                  ///< a stage takes its pressure from there
  std::string specimen_file;                                   ///< empty: given on the command line
  std::vector<double> calibration_pressures;                   ///< Pa, [calibrate] pressures_Pa
  toml::table overrides;                                       ///< [contact], [damping], [solver], [material]
  LoadingSettings loading;
  long snapshots_every = 0;  ///< [output]: grains and contacts are kept at every so many records; 0: never
  std::uint64_t quantities = records::usual_quantities;  ///< [output]: what is measured at each record
  std::vector<Stage> stages;
  double largest_pressure = 0;      ///< Pa, that a stage brings the grains to
  std::vector<std::string> doubts;  ///< values that are likely in another unit, one line each
  std::string resolved;             ///< the protocol with every default and assignment in it, TOML
};

/// Reads a protocol file after the assignments "key=value" have been applied to it ("test.pressure_Pa=2e4",
/// "contact.slip=full_radius", "stage.compression.to_strain=0.05"; stages by name or by number from 0). A value is
/// TOML; what is not is taken as text. Throws InputError with every mistake of the file: unknown keys (with the
/// nearest known one), missing ones, wrong types, values out of range, keys that contradict each other, each with its
/// line.
Protocol read_protocol(const std::string& path, const std::vector<std::string>& assignments = {});

/// The same from a text; `path` serves messages and relative names only.
Protocol parse_protocol(const std::string& text, const std::string& path,
                        const std::vector<std::string>& assignments = {});

/// The same of a test that has run: it may have keys of materials that its contact law does not read, if --set gave the
/// law or an earlier version ran it.
Protocol parse_recorded_protocol(const std::string& text, const std::string& path);

/// What calibration may read from the records of a stage.
StageRole role_of(const Stage& stage);

/// Settings of a stage with which it gives a friction angle, in words, for each kind that has such.
std::string strength_stages();

/// The specimen with the protocol's overrides. InputError if one does not fit the specimen (a material that it has
/// not, a stiffness key that its law does not take), or if its dimension is not the protocol's.
Specimen with_overrides(const Protocol& protocol, Specimen specimen);

/// What is likely in another unit: in the protocol, in the specimen with its overrides, and in both together (overlaps
/// that follow from the pressures); and what lies outside the tables and formulas of its stages. One line each.
/// InputError as with_overrides.
std::vector<std::string> unusual_in(const Protocol& protocol, const Specimen& specimen);

/// Every key that a protocol or a recipe may have, in the order of its tables: those of the protocol itself ("test",
/// "loading", "stage", "stage.compression", ...), those of a recipe ("pack", "grains", "target", "preparation"), then
/// those of a material file (contact, damping, solver, material).
std::vector<keys::Key> all_keys();

/// Those of the protocol itself.
std::vector<keys::Key> protocol_keys();

}  // namespace rvelab::protocol
