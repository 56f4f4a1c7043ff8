#include "rvelab/protocol/read_stage.hpp"

#include "rvelab/keys/table_reader.hpp"
#include "rvelab/protocol/events.hpp"
#include "rvelab/protocol/protocol_keys.hpp"
#include "rvelab/protocol/stage_kinds.hpp"

namespace rvelab::protocol {

using keys::TableReader;

void read_stage(const toml::table& table, long number, Protocol& protocol, toml::array& resolved,
                std::vector<keys::KeyError>& errors) {
  const std::string kind_given = table["kind"].value_or(std::string());
  const std::string name = table["name"].value_or(kind_given.empty() ? std::to_string(number) : kind_given);
  TableReader reader(table, protocol_keys(), "stage", "stage." + name, keys::line_of(table), errors);
  const auto kind = reader.choice("kind");
  if (kind.empty()) return;  // without its kind no other key can be judged
  reader.also("stage." + kind);
  Stage stage{reader.text("name", kind), kind, {}, {}, ""};
  StageSource source{table, reader, stage.name, protocol, errors};
  auto what = stage_of_kind(kind);
  what->read(source);
  stage.what = std::move(what);
  stage.until = read_events(reader, stage, errors);
  stage.then = reader.text("then", "");
  reader.finish();
  for (const auto& other : protocol.stages) {
    if (other.name != stage.name) continue;
    errors.push_back(
        {keys::line_of(table), "stage.name = \"" + stage.name +
                                   "\" is there twice; allowed: a name of its own for each (without one its "
                                   "kind is its name); give this stage another name"});
  }
  protocol.stages.push_back(std::move(stage));
  resolved.push_back(reader.resolved());
}

}  // namespace rvelab::protocol
