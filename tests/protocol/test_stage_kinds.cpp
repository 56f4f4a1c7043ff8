// The table of the kinds of stages: each stands in it once, with its own keys.
#include <algorithm>
#include <set>
#include <stdexcept>
#include <string>
#include <typeinfo>

#include "rvelab/protocol/stage_kinds.hpp"
#include "tests/catch.hpp"

using namespace rvelab;
using Catch::Matchers::Contains;

TEST_CASE("each kind of stage stands in the table once, with keys of its own") {
  std::set<std::string> names;
  for (protocol::MakeStage* const make : protocol::stage_kinds) {
    const auto kind = make();
    const std::string name = kind->name(), table = "stage." + name;
    CAPTURE(name);
    CHECK(names.insert(name).second);
    CHECK(typeid(*protocol::stage_of_kind(name)) == typeid(*kind));
    const auto all = protocol::protocol_keys();
    CHECK(std::any_of(all.begin(), all.end(), [&](const keys::Key& key) { return key.table == table; }));
  }
  CHECK_THROWS_AS(protocol::stage_of_kind("compresion"), std::logic_error);
}

TEST_CASE("a stage says what calibration may read from its records") {
  const auto role = [](const std::string& stage) {
    const protocol::Protocol protocol =
        protocol::parse_protocol("[test]\nname = \"t\"\npressure_Pa = 1e4\n[[stage]]\n" + stage, "t.toml");
    return protocol::role_of(protocol.stages.front());
  };
  using Gives = protocol::StageRole::Gives;
  CHECK(role("kind = \"compression\"\nto_strain = 0.1\n").gives == Gives::strength);
  CHECK(role("kind = \"compression\"\nto_strain = -0.1\n").gives == Gives::nothing);
  CHECK(role("kind = \"compression\"\nto_strain = 0.1\nlateral = \"constant_volume\"\n").gives == Gives::nothing);
  const protocol::StageRole oedometer =
      role("kind = \"compression\"\nto_strain = 0.1\nlateral = \"zero_strain\"\naxis = \"x\"\n");
  CHECK(oedometer.gives == Gives::oedometric_stiffness);
  CHECK(oedometer.axis == "x");
  CHECK(role("kind = \"relax\"\n").gives == Gives::nothing);
  CHECK_THAT(protocol::strength_stages(), Contains("kind = \"compression\" with lateral = \"constant_stress\""));
}
