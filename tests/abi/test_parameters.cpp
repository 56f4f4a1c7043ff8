// Parameters of an RVE through the C interface, by the keys of material files.
#include <cmath>

#include "rvelab/keys/parameters.hpp"
#include "tests/abi/host.hpp"

using namespace rvelab;
using namespace rvelab::test;
using Catch::Matchers::Contains;

namespace {

std::string parameters_of(Host& host, std::int64_t id) {
  std::size_t need = 0;
  REQUIRE_OK(rvelab_get_parameters(host.pool, id, nullptr, 0, &need));
  std::string text(need, '?');
  REQUIRE_OK(rvelab_get_parameters(host.pool, id, text.data(), text.size(), &need));
  REQUIRE(text.back() == '\0');
  text.pop_back();
  return text;
}

Matrix3 sheared(double by) {
  Matrix3 gradient = Matrix3::Zero();
  gradient(0, 1) = by;
  return gradient;
}

}  // namespace

TEST_CASE("parameters by their keys: what is set is read, the rest stays, and the RVE goes on as a specimen of these") {
  const Specimen& start = packed(Shape::disc, 6);
  Host host;
  const auto ids = host.spawn(start, 2);
  const std::string before = parameters_of(host, ids[0]);
  CHECK(before == keys::parameters_text(start));
  REQUIRE_OK(rvelab_set_parameters(
      host.pool, ids[0], "material.friction = 0.2\n[solver]\nrelative_tolerance = 1e-3\n[damping]\nlocal = 0.2"));
  Specimen changed = start;
  for (Material& each : changed.materials) each.friction = 0.2;
  changed.solver.relative_tolerance = 1e-3;
  changed.damping.local = 0.2;
  CHECK(parameters_of(host, ids[0]) == keys::parameters_text(changed));
  CHECK(parameters_of(host, ids[1]) == before);
  CHECK(host.info(ids[0]).token == host.info(ids[1]).token + 1);
  Rve rve(changed);
  for (const double by : {1e-4, -3e-4}) {
    const Nine stress = host.apply(ids[0], nine_of(sheared(by)));
    CHECK(same(stress, nine_of(rve.apply(sheared(by), 0).stress)));
  }
  // What is read may be set.
  REQUIRE_OK(rvelab_set_parameters(host.pool, ids[1], before.c_str()));
  CHECK(parameters_of(host, ids[1]) == before);
}

TEST_CASE("one material of several is set by its name, in a table, a list or with dots") {
  Specimen start = packed(Shape::disc, 6);
  start.materials.push_back(start.materials[0]);
  start.materials[0].name = "sand";
  start.materials[1].name = "coarse sand";
  for (std::size_t g = 0; g < start.grains.size(); g += 2) start.grains.material[g] = 1;
  Host host;
  const std::int64_t id = host.spawn(start)[0];
  const auto friction = [&] {
    const Specimen state = host.state(id);
    return std::pair(state.materials[0].friction, state.materials[1].friction);
  };
  REQUIRE_OK(rvelab_set_parameters(host.pool, id, "material.sand.friction = 0.1"));
  CHECK(friction() == std::pair(0.1, 0.4));
  REQUIRE_OK(rvelab_set_parameters(host.pool, id, "[[material]]\nname = \"coarse sand\"\nfriction_angle_deg = 45"));
  CHECK(friction().first == 0.1);
  CHECK(std::abs(friction().second - 1) < 1e-15);
  REQUIRE_OK(rvelab_set_parameters(host.pool, id, "[material.\"coarse sand\"]\nfriction = 0.3"));
  CHECK(friction() == std::pair(0.1, 0.3));
  REQUIRE_OK(rvelab_set_parameters(host.pool, id, "[material]\nfriction = 0.5"));
  CHECK(friction() == std::pair(0.5, 0.5));
}

TEST_CASE("parameters that cannot be are refused by key, value and line; state, token and pending trial stay") {
  Host host;
  const auto ids = host.spawn(packed(Shape::disc, 6));
  Trials trials(ids);
  trials.dH[0] = Nine{1e-4};
  REQUIRE_OK(rvelab_trial(host.pool, &trials.batch));
  const auto before = host.snapshot(ids[0]);
  const struct {
    const char *text, *named;
  } wrong[] = {{"material.frictoin = 0.5", "material.friction"},
               {"solver.skin = 0.1\nmaterial.friction = -1", "parameters:2: material.friction = -1"},
               {"[solver]\nrelative_tolerance = \"small\"", "parameters:2: solver.relative_tolerance"},
               {"material.clay.friction = 0.5", "\"clay\""},
               {"[[material]]\nfriction = 0.5", "name"},
               {"[stage]\nkind = \"relax\"", "[stage]"},
               {"material.friction 0.5", "parameters:1"},
               {"material.roughness_m = 1e-7", "roughness_m does not go with contact.law = linear"},
               {"contact.law = \"hertz_mindlin\"", "young_modulus"}};  // a law without its modulus
  for (const auto& each : wrong) {
    INFO(each.text);
    CHECK_STATUS(rvelab_set_parameters(host.pool, ids[0], each.text), RVELAB_E_INPUT);
    CHECK_THAT(rvelab_last_error(), Contains(each.named));
    CHECK(host.snapshot(ids[0]) == before);
  }
  std::size_t need = 0;
  char small[8];
  CHECK_STATUS(rvelab_get_parameters(host.pool, ids[0], small, sizeof small, &need), RVELAB_E_BUFFER);
  CHECK_STATUS(rvelab_set_parameters(host.pool, ids[0], nullptr), RVELAB_E_NULL);
  CHECK_STATUS(rvelab_set_parameters(host.pool, 0, "solver.skin = 0.1"), RVELAB_E_ID);
  REQUIRE_OK(rvelab_commit(host.pool, 1, ids.data()));
}

TEST_CASE("stiffer contacts in a state at rest: masses follow, sub-steps stay stable") {
  Specimen start;
  {
    Rve rve(packed(Shape::disc, 8));
    rve.apply(sheared(1e-3), 0);
    start = rve.specimen();
  }
  REQUIRE(start.state.masses.in_use);  // scaled masses are kept
  Host host;
  const std::int64_t id = host.spawn(start)[0];
  REQUIRE_OK(rvelab_set_parameters(host.pool, id, "material.normal_stiffness_N_m = 2e8"));
  const double p = host.info(id).p;
  CHECK(p > 50 * -Rve(start).stress().trace() / 2);  // the same overlaps, a hundred times as stiff
  // Springs along the contacts keep their forces: these are out of balance now.
  REQUIRE_OK(rvelab_relax(host.pool, id, 1e-4, 100'000, nullptr));
  CHECK(host.info(id).unbalanced_force_ratio <= 1e-4);
  host.apply(id, nine_of(sheared(1e-5)));
  CHECK(host.info(id).unbalanced_force_ratio < 1e-2);
}
