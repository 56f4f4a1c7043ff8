#include "rvelab/protocol/protocol_keys.hpp"

#include <algorithm>

#include "rvelab/keys/key_builders.hpp"
#include "rvelab/keys/material_toml.hpp"
#include "rvelab/protocol/path_keys.hpp"
#include "rvelab/protocol/protocol.hpp"

namespace rvelab {
namespace protocol {
namespace {

using namespace keys;

std::vector<TableKey> test() {
  const char* t = "test";
  return {
      required(text(t, "name", "", "what the records are called")),
      with_range({{t, "dimension", "1", "whole number", "(that of the specimen)", "", "dimension of the specimen"},
                  KeyKind::whole_number,
                  {2, 3},
                  {},
                  {}},
                 "2, 3"),
      number(t, "pressure_Pa", "Pa", "", positive,
             "pressure, compression positive, of every stage that gives none of its own; `rvelab calibrate` sets it"),
  };
}

std::vector<TableKey> loading() {
  const char* t = "loading";
  const Loading initial;
  return {
      word(t, "mode", {"quasi_static", "physical"},
           "how compression, simple shear, flow and deformation pass through time; physical: real masses at the given "
           "rate"),
      number(t, "rate_1_s", "1/s", "", positive, "mode = physical: true rate of the driving strain"),
      number(t, "inertial_number", "1", "", positive,
             "mode = physical, in place of rate_1_s: I = rate d sqrt(rho/p) with p at the start of the stage"),
      number(t, "held_tolerance", "1", initial.held_tolerance, ratio,
             "a held stress may miss its target by this times the larger of the target's size and 1 % of the stage's "
             "first p; mode = physical: its mean over an increment may, 0.05 unless given"),
      whole_number(
          t, "held_wait", initial.held_wait, {0, 1e9},
          "mode = quasi_static: sub-steps that a record waits for the held stress; a quarter of its increment's where "
          "that is more"),
  };
}

TableKey quantities() {
  TableKey key = listed("output", "quantities", "-", "list of words", "", KeyKind::words,
                        "what is measured at each record beside strain and stress; the rest is not computed");
  for (const QuantityName& each : quantity_names) {
    key.words.emplace_back(each.name);
    key.key.range += (key.key.range.empty() ? "" : ", ") + key.words.back();
    if ((usual_quantities & each.quantity) == 0) continue;
    key.key.initial += (key.key.initial.empty() ? "[\"" : ", \"") + key.words.back() + "\"";
  }
  key.key.initial += "]";
  return key;
}

std::vector<TableKey> output_specimen_and_calibrate() {
  return {
      whole_number("output", "snapshots_every", Protocol{}.snapshots_every, {0, 1e9},
                   "grains and contacts are kept at every so many records, from the first; 0: never"),
      quantities(),
      required(text("specimen", "file", "",
                    "specimen file that the test runs on, relative to the protocol; --specimen goes before it")),
      {{"calibrate", "pressures_Pa", "Pa", "list of numbers", "", "each " + positive.in_words(),
        "pressures of `rvelab calibrate`; --pressures goes before them"},
       KeyKind::numbers,
       positive,
       {},
       {}},
  };
}

std::vector<TableKey> stage() {
  return {
      required(word("stage", "kind",
                    {"isotropic", "compression", "simple_shear", "pressure_path", "deviatoric", "path", "flow",
                     "deformation", "envelope", "relax", "probe"},
                    "what the stage does; its other keys are those of [[stage]] with this kind", "")),
      text("stage", "name", "(its kind)", "name of its own, for --set stage.NAME.key=value and in the records"),
      text("stage", "then", "(the next)", "name of the stage that follows, \"end\" for none"),
      listed("stage", "until", "-", "list of tables", "[[stage.until]], any number", KeyKind::tables,
             "events, each of which ends the stage; not with isotropic, relax, probe, envelope"),
  };
}

std::vector<TableKey> isotropic() {
  const char* t = "stage.isotropic";
  const IsotropicStage initial;
  return {
      number(t, "pressure_Pa", "Pa", "(test.pressure_Pa)", positive, "all normal stresses are brought to minus this"),
      word(t, "shear", {"zero_strain", "zero_stress"},
           "zero_strain: the cell keeps its angles; zero_stress: shear stresses are driven to zero"),
      number(t, "stress_tolerance", "1", initial.stress_tolerance, ratio, "of the pressure; the stage ends within it"),
      number(t, "unbalanced", "1", initial.unbalanced, ratio, "unbalanced force ratio below which the stage ends"),
      number(t, "largest_change", "1", initial.largest_change, {0, 1, true, false},
             "largest change of stress in one increment, over the pressure"),
      whole_number(t, "max_rounds", initial.max_rounds, steps, "rounds of relaxing and correcting before it fails"),
      whole_number(t, "max_steps", initial.max_steps, steps, "sub-steps of one relaxation before it fails"),
      truth(t, "record", initial.record, "records the state at the start and at the end"),
  };
}

std::vector<TableKey> compression() {
  const char* t = "stage.compression";
  return {
      word(t, "axis", {"x", "y", "z"}, "laboratory axis that is shortened", "(y in 2D, z in 3D)"),
      required(with_range(number(t, "to_strain", "1", "", {-infinity, 1, true, true},
                                 "strain 1 - F_aa at which the stage ends, compression positive"),
                          "below 1, not 0")),
      number(t, "record_every", "1", CompressionStage{}.record_every, positive,
             "strain between records; at most 1e6 records"),
      word(t, "lateral", {"constant_stress", "constant_volume", "zero_strain"},
           "constant_stress: each lateral normal stress is held (drained); constant_volume: det F = 1 (undrained); "
           "zero_strain: oedometer"),
      number(t, "lateral_pressure_Pa", "Pa", "(test.pressure_Pa)", positive,
             "lateral = constant_stress: lateral normal stresses are held at minus this, which they start from"),
      whole_number(t, "cycles", CompressionStage{}.cycles.count, {0, 1e6},
                   "0: straight to to_strain; else so many cycles between +-to_strain"),
      number(t, "reverse_at_Pa", "Pa", "", positive,
             "cycles > 0: the strain turns where the axial less the mean lateral stress has this size"),
  };
}

std::vector<TableKey> simple_shear() {
  const char* t = "stage.simple_shear";
  return {
      word(t, "plane", {"xy", "xz", "yz", "yx", "zx", "zy"}, "ab: shear dv_a/dx_b", "(xy in 2D, xz in 3D)"),
      required(with_range(number(t, "to_strain", "1", "", {-infinity, infinity, true, true},
                                 "gamma = F_ab at which the stage ends, either sign"),
                          "any finite number but 0")),
      number(t, "record_every", "1", SimpleShearStage{}.record_every, positive,
             "gamma between records; at most 1e6 records"),
      word(t, "normal", {"constant_volume", "constant_stress"},
           "constant_volume: only the shear moves (undrained); constant_stress: sigma_bb is held (drained)"),
      number(t, "normal_pressure_Pa", "Pa", "(test.pressure_Pa)", positive,
             "normal = constant_stress: sigma_bb is held at minus this, which it starts from"),
      whole_number(t, "cycles", SimpleShearStage{}.cycles.count, {0, 1e6},
                   "0: straight to to_strain; else so many cycles between +-to_strain"),
      number(t, "reverse_at_Pa", "Pa", "", positive, "cycles > 0: gamma turns where sigma_ab has this size"),
  };
}

std::vector<TableKey> relax_and_probe() {
  const char *r = "stage.relax", *p = "stage.probe";
  const RelaxStage relax;
  const ProbeStage probe;
  return {
      number(r, "unbalanced", "1", relax.unbalanced, ratio, "unbalanced force ratio below which the stage ends"),
      whole_number(r, "max_steps", relax.max_steps, steps, "sub-steps before it fails"),
      truth(r, "record", relax.record, "records the state at the end"),
      word(p, "method", {"dynamic", "linear"},
           "dynamic: increments of +-size, relaxed; linear: the contact network solved, every contact stuck"),
      number(p, "size", "1", probe.size, {0, 0.01, true, false}, "method = dynamic: strain of each increment"),
      {{p, "no_slip", "-", "truth", "(true with method = linear, else false)", "true, false",
        "no contact slips or rolls over in the probed copy (friction 1e6)"},
       KeyKind::truth,
       any,
       {},
       {}},
  };
}

}  // namespace

const std::vector<TableKey>& protocol_keys() {
  static const std::vector<TableKey> all = [] {
    std::vector<TableKey> entries;
    for (const auto& list : {test(), loading(), output_specimen_and_calibrate(), stage(), isotropic(), compression(),
                             simple_shear(), path_keys(), relax_and_probe()}) {
      entries.insert(entries.end(), list.begin(), list.end());
    }
    return entries;
  }();
  return all;
}

const std::vector<std::string>& top_tables() {
  static const std::vector<std::string> tables = [] {
    std::vector<std::string> list;
    const auto add = [&](const Key& key) {
      const std::string top = key.table.substr(0, key.table.find('.'));
      if (std::find(list.begin(), list.end(), top) == list.end()) list.push_back(top);
    };
    for (const auto& entry : protocol_keys()) add(entry.key);
    for (const Key& key : known_keys()) add(key);
    return list;
  }();
  return tables;
}

}  // namespace protocol

const std::vector<Key>& all_keys() {
  static const std::vector<Key> keys = [] {
    std::vector<Key> list;
    for (const auto& entry : protocol::protocol_keys()) list.push_back(entry.key);
    for (const auto& entry : protocol::recipe_keys()) list.push_back(entry.key);
    list.insert(list.end(), known_keys().begin(), known_keys().end());
    return list;
  }();
  return keys;
}

}  // namespace rvelab
