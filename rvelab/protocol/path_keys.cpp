#include "rvelab/protocol/events.hpp"
#include "rvelab/protocol/key_builders.hpp"

namespace rvelab::protocol {
namespace {

std::vector<ProtocolKey> until() {
  const char* t = "stage.until";
  Words names;
  for (const EventQuantity& each : event_quantities()) names.emplace_back(each.name);
  return {
      required(word(t, "quantity", names,
                    "what is looked at with each record but the first; strain is that of the record; eps_v is "
                    "compression positive, stresses tension positive; p_over_first: over p at the start of the stage",
                    "")),
      with_range(number(t, "above", "1", "", every, "the event: the quantity is above this, in its unit"),
                 "any finite number"),
      with_range(number(t, "below", "1", "", every, "the event: the quantity is below this, in its unit"),
                 "any finite number"),
      number(t, "falls_by", "1", "", ratio,
             "the event: the quantity has lost this fraction of its largest value in the stage (a peak is passed)"),
      text(t, "then", "(the next)", "name of the stage that follows, \"end\" for none"),
  };
}

std::vector<ProtocolKey> path() {
  const char *t = "stage.path", *r = "stage.path.row";
  const PathStage initial;
  return {
      required(listed(t, "row", "-", "list of tables", "[[stage.row]], at most 6", KeyKind::tables,
                      "constraints A : d eps + B : d sigma = c; a strain component that no row names stays zero")),
      whole_number(t, "records_per_point", initial.records_per_point, {1, 1e6},
                   "records, and increments, on the way to each point"),
      whole_number(t, "cycles", initial.cycles, {1, 1e6}, "times that the points are gone through"),
      word(t, "axis", {"x", "y", "z"}, "loading axis that is noted in the records", "(none)"),
      required(text(r, "name", "", "name of the row, for messages and --set stage.NAME.row.ROW.key=value")),
      listed(r, "strain", "1", "components", symmetric_components, KeyKind::components,
             "A of a row without stress, tension positive; yz, xz, xy: of the engineering shear strain"),
      listed(r, "stress", "1", "components", symmetric_components, KeyKind::components, "B, tension positive"),
      listed(r, "strain_Pa", "Pa", "components", symmetric_components, KeyKind::components,
             "A of a row with stress: a stiffness"),
      {{r, "to", "1", "list of numbers", "", "one number a point",
        "values of a row of strain, from 0 at the start of the stage; none: it stays 0"},
       KeyKind::numbers,
       every,
       {},
       {}},
      {{r, "to_Pa", "Pa", "list of numbers", "", "one number a point",
        "values of a row with stress; none: it keeps the value of the start of the stage"},
       KeyKind::numbers,
       every,
       {},
       {}},
  };
}

std::vector<ProtocolKey> deviatoric() {
  const char* t = "stage.deviatoric";
  const DeviatoricStage initial;
  return {
      required(number(t, "to_strain", "1", "", positive, "eps_q at which the stage ends")),
      number(t, "record_every", "1", initial.record_every, positive, "eps_q between records; at most 1e6 records"),
      number(t, "lode_angle_deg", "degree", initial.lode_angle_deg, {-180, 180},
             "3D: direction in the deviatoric plane; 0 compression along z, 60 extension along y"),
      number(t, "pressure_Pa", "Pa", "(test.pressure_Pa)", positive,
             "p, which is held and which the stage starts from"),
  };
}

std::vector<ProtocolKey> pressure_path() {
  const char* t = "stage.pressure_path";
  ProtocolKey pressures =
      listed(t, "to_Pa", "Pa", "list of numbers", "", KeyKind::numbers,
             "pressures that all normal stresses go to one after the other; shear strains are zero");
  pressures.range = positive;
  pressures.key.range = "each " + in_words(positive);
  return {required(pressures), whole_number(t, "records_per_point", PressurePathStage{}.records_per_point, {1, 1e6},
                                            "records, and increments, on the way to each pressure")};
}

std::vector<ProtocolKey> flow_and_deformation() {
  const char *f = "stage.flow", *d = "stage.deformation";
  return {
      required(listed(f, "gradient", "1", "components", "xx, xy, xz, yx, yy, yz, zx, zy, zz = numbers",
                      KeyKind::components,
                      "G of F = exp(s G), s the driving strain; physical loading: velocity gradient = rate G")),
      required(number(f, "to_strain", "1", "", positive, "s at which the stage ends")),
      number(f, "record_every", "1", FlowStage{}.record_every, positive, "s between records; at most 1e6 records"),
      required(listed(d, "gradients", "1", "list of lists of numbers", "4 (2D) or 9 numbers each, row by row",
                      KeyKind::matrices, "deformation gradients F since the start of the stage, a record at each")),
  };
}

std::vector<ProtocolKey> envelope() {
  const char* t = "stage.envelope";
  const EnvelopeStage initial;
  return {
      word(t, "probes", {"strain", "stress"}, "what is the same in every direction"),
      number(t, "size", "1", initial.size, {0, 0.1, true, false}, "probes = strain: norm of the strain"),
      number(t, "size_Pa", "Pa", "", positive, "probes = stress: norm of the change of stress"),
      whole_number(t, "directions", initial.directions, {1, 1e4},
                   "of the plane y, x in 2D, z and the two others together in 3D, from compression along the axis"),
      whole_number(t, "increments", initial.increments, {1, 1e6}, "of each probe"),
      number(t, "unbalanced", "1", initial.unbalanced, ratio, "unbalanced force ratio to which each probe is relaxed"),
      whole_number(t, "max_steps", initial.max_steps, steps, "sub-steps of that before it fails"),
  };
}

}  // namespace

std::vector<ProtocolKey> path_keys() {
  std::vector<ProtocolKey> keys;
  for (const auto& list : {until(), pressure_path(), deviatoric(), path(), flow_and_deformation(), envelope()}) {
    keys.insert(keys.end(), list.begin(), list.end());
  }
  return keys;
}

}  // namespace rvelab::protocol
