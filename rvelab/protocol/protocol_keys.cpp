#include "rvelab/protocol/protocol_keys.hpp"

#include <algorithm>

#include "rvelab/keys/key_builders.hpp"
#include "rvelab/keys/material_toml.hpp"
#include "rvelab/pack/read_recipe.hpp"
#include "rvelab/protocol/events.hpp"
#include "rvelab/protocol/protocol.hpp"
#include "rvelab/protocol/stage_kinds.hpp"
#include "rvelab/protocol/stage_readers.hpp"

namespace rvelab::protocol {
namespace {

using namespace keys;

std::vector<TableKey> test() {
  const char* t = "test";
  return {
      required(text(t, "name", "", "name of the test, kept in the record file")),
      with_range({{t, "dimension", "1", "whole number", "(that of the specimen)", "", "dimension of the specimen"},
                  KeyKind::whole_number,
                  {2, 3},
                  {},
                  {}},
                 "2, 3"),
      number(t, "pressure_Pa", "Pa", "", pressures,
             "pressure, compression positive, of every stage without one of its own; `rvelab calibrate` sets it"),
  };
}

std::vector<TableKey> loading() {
  const char* t = "loading";
  const LoadingSettings initial;
  return {
      choice(t, "mode", {"quasi_static", "physical"},
             "time in compression, simple shear, flow and deformation: quasi_static, or physical with true masses at "
             "the given rate"),
      number(t, "rate_1_s", "1/s", "", positive, "mode = physical: true rate of the driving strain"),
      number(t, "inertial_number", "1", "", positive,
             "mode = physical, in place of rate_1_s: I = rate d sqrt(rho/p) with p at the start of the stage"),
      number(t, "held_tolerance", "1", initial.held_tolerance, ratio,
             "allowed error of a held stress, over the larger of its target and 1 % of p at the start of the stage; "
             "mode = physical: of its mean over an increment, by default 0.05"),
  };
}

TableKey quantities() {
  TableKey key = listed("output", "quantities", "-", "list of choices", "", KeyKind::choices,
                        "quantities measured at each record beside strain and stress; others are not computed");
  for (const records::QuantityRow& row : records::quantity_rows) {
    key.choices.emplace_back(row.text.name);
    key.key.range += (key.key.range.empty() ? "" : ", ") + key.choices.back();
    if (!row.text.usual) continue;
    key.key.initial += (key.key.initial.empty() ? "[\"" : ", \"") + key.choices.back() + "\"";
  }
  key.key.initial += "]";
  return key;
}

std::vector<TableKey> output_specimen_and_calibrate() {
  return {
      whole_number("output", "snapshots_every", Protocol{}.snapshots_every, {0, 1e9},
                   "n: the file keeps grains and contacts of every n-th record, from the first; 0: of none"),
      quantities(),
      required(text("specimen", "file", "",
                    "specimen file of the test, relative to the protocol's folder; --specimen overrides it")),
      {{"calibrate", "pressures_Pa", "Pa", "list of numbers", "", "each " + in_words(positive),
        "pressures of `rvelab calibrate`; --pressures overrides them"},
       KeyKind::numbers,
       positive,
       {},
       {}},
  };
}

std::vector<TableKey> stage() {
  Choices kinds;
  for (MakeStage* const make : stage_kinds) kinds.emplace_back(make()->name());
  const std::string events = "events, each of which ends the stage; not with " + kinds_with_events(false);
  return {
      required(choice("stage", "kind", kinds,
                      "kind of loading; the other keys of the stage are those listed under its kind", "")),
      text("stage", "name", "(its kind)", "name of the stage, in records and in --set stage.NAME.key=value"),
      text("stage", "then", "(the next)", "name of the stage that follows, \"end\" for none"),
      listed("stage", "until", "-", "list of tables", "[[stage.until]], any number", KeyKind::tables, events.c_str()),
  };
}

}  // namespace

const std::vector<TableKey>& protocol_keys() {
  static const std::vector<TableKey> all = [] {
    std::vector<TableKey> entries;
    const auto add = [&](const std::vector<TableKey>& list) {
      entries.insert(entries.end(), list.begin(), list.end());
    };
    for (const auto& list : {test(), loading(), output_specimen_and_calibrate(), stage(), event_keys()}) add(list);
    for (MakeStage* const make : stage_kinds) add(make()->keys());
    return entries;
  }();
  return all;
}

const std::vector<std::string>& top_tables() {
  static const std::vector<std::string> tables = [] {
    std::vector<std::string> list;
    const auto add = [&](const keys::Key& key) {
      const std::string top = key.table.substr(0, key.table.find('.'));
      if (std::find(list.begin(), list.end(), top) == list.end()) list.push_back(top);
    };
    for (const auto& entry : protocol_keys()) add(entry.key);
    for (const keys::Key& key : keys::known_keys()) add(key);
    return list;
  }();
  return tables;
}

const std::vector<keys::Key>& all_keys() {
  static const std::vector<keys::Key> keys = [] {
    std::vector<keys::Key> list;
    for (const auto& entry : protocol_keys()) list.push_back(entry.key);
    for (const auto& entry : pack::recipe_keys()) list.push_back(entry.key);
    list.insert(list.end(), keys::known_keys().begin(), keys::known_keys().end());
    return list;
  }();
  return keys;
}

}  // namespace rvelab::protocol
