// Stages of a test on RVEs of a host: bonds and water made, cement dissolved, by the keys of protocols.
#include "rvelab/protocol/run.hpp"
#include "tests/abi/host.hpp"

using namespace rvelab;
using namespace rvelab::test;
using Catch::Matchers::Contains;

namespace {

const char* const cement_stage =
    "[[stage]]\nkind = \"cement\"\nyoung_modulus_Pa = 5e6\ntensile_strength_Pa = 1e5\ncohesion_Pa = 1e5\ngap = 0.05\n";
const char* const dissolve_stage =
    "[[stage]]\nkind = \"dissolve\"\nradius_left = 0.5\nstrength_left = 0.2\nstep_count = 2\n";
const char* const water_stage = "[[stage]]\nkind = \"water\"\nsuction_Pa = 100\n";

std::int64_t rows_of_array(Host& host, std::int64_t id, const char* name) {
  std::size_t need = 0;
  REQUIRE_OK(rvelab_get_array(host.pool, id, name, nullptr, 0, &need));
  return std::int64_t(need / 8);
}

/// As the program runs them.
Specimen end_of_stages(const Specimen& start, const std::string& stages) {
  return protocol::run_protocol(protocol::parse_protocol("[test]\nname = \"t\"\n" + stages, "t.toml"), start).end_state;
}

}  // namespace

TEST_CASE("stages of a host give the bits of the same stages of a test") {
  for (const Shape shape : {Shape::disc, Shape::sphere}) {
    const Specimen& start = packed(shape, shape == Shape::sphere ? 4 : 6);
    Host host(2);
    const auto ids = host.spawn(start, 3);
    const std::int64_t first = host.info(ids[0]).token;
    host.apply(ids[1], Nine{0, 1e-3, 0, -1e-3});
    const Specimen sheared = host.state(ids[1]);
    std::vector<double> sigma(27, -1);
    std::vector<std::int32_t> status(3, -99);
    const std::string stages = std::string(cement_stage) + dissolve_stage + water_stage;
    REQUIRE_OK(rvelab_run_stages(host.pool, 3, ids.data(), stages.c_str(), sigma.data(), status.data()));
    CHECK(status == std::vector<std::int32_t>(3, 0));
    for (std::size_t k = 0; k < 3; ++k) {
      const Specimen wanted = end_of_stages(k == 1 ? sheared : start, stages);
      CHECK(Rve(host.state(ids[k])).save() == Rve(wanted).save());
      CHECK(std::memcmp(sigma.data() + 9 * k, nine_of(Rve(wanted).stress()).data(), 72) == 0);
      CHECK(rows_of_array(host, ids[k], "bonds/radius_m") > 0);
      CHECK(rows_of_array(host, ids[k], "bridges/i") > 0);
      CHECK(host.info(ids[k]).token == first + (k == 1 ? 2 : 1));
      // It goes on as that specimen does.
      Rve rve(wanted);
      const Nine more{1e-4, 0, 0, -1e-4};
      CHECK(same(host.apply(ids[k], more), nine_of(rve.apply(matrix_of(more), 0).stress)));
    }
    // What the stages cost is booked: the relaxations of a dissolution.
    std::int64_t steps[3];
    REQUIRE_OK(rvelab_cost(host.pool, 3, ids.data(), steps));
    CHECK(steps[0] >= host.info(ids[0]).grain_steps - std::int64_t(start.state.grain_steps));
  }
}

TEST_CASE("a stage ends trials: tokens before it are stale, a pending one is reverted") {
  Host host;
  const auto ids = host.spawn(packed(Shape::disc, 6));
  const Specimen before = host.state(ids[0]);
  Trials trials(ids);
  trials.dH[0] = Nine{-1e-3, 2e-4};
  REQUIRE_OK(rvelab_trial(host.pool, &trials.batch));
  REQUIRE_OK(rvelab_run_stages(host.pool, 1, ids.data(), cement_stage, nullptr, nullptr));
  CHECK(Rve(host.state(ids[0])).save() == Rve(end_of_stages(before, cement_stage)).save());
  CHECK_STATUS(rvelab_commit(host.pool, 1, ids.data()), RVELAB_E_NO_TRIAL);
}

TEST_CASE("stages that cannot be are refused by line, key and value, and what failed is as it was") {
  Host host;
  const auto ids = host.spawn(packed(Shape::disc, 6), 2);
  const auto before = host.snapshot(ids[0]);
  const struct {
    const char* text;
    int32_t status;
    const char* says;
  } cases[] = {
      {"[[stage]]\nkind = \"cement\"\nyoung_modulus_Pa = -5\n", RVELAB_E_INPUT, "young_modulus_Pa = -5"},
      {"[[stage]]\nkind = \"cememt\"\n", RVELAB_E_INPUT, "cememt"},
      {"", RVELAB_E_INPUT, "stage"},
      {"[[stage]\n", RVELAB_E_INPUT, "1"},
      {"[specimen]\nfile = \"S.h5\"\n[[stage]]\nkind = \"relax\"\n", RVELAB_E_INPUT, "specimen.file"},
      {dissolve_stage, RVELAB_E_INPUT, "bond"},  // there is none
      {"[[stage]]\nkind = \"relax\"\nunbalanced = 1e-14\nmax_steps = 1\n", RVELAB_DISCARD, "unbalanced"},
      {"[test]\nname = \"t\"\ndimension = 3\n[[stage]]\nkind = \"relax\"\n", RVELAB_E_INPUT, "dimension"},
  };
  for (const auto& each : cases) {
    CAPTURE(each.text);
    std::vector<double> sigma(18, -1);
    CHECK_STATUS(rvelab_run_stages(host.pool, 2, ids.data(), each.text, sigma.data(), nullptr), each.status);
    CHECK_THAT(rvelab_last_error(), Contains(each.says));
    CHECK(host.snapshot(ids[0]) == before);
    CHECK(sigma == std::vector<double>(18, -1));
  }
  CHECK_STATUS(rvelab_run_stages(host.pool, 2, ids.data(), nullptr, nullptr, nullptr), RVELAB_E_NULL);
  CHECK_STATUS(rvelab_run_stages(host.pool, 2, nullptr, cement_stage, nullptr, nullptr), RVELAB_E_NULL);
  const std::int64_t twice[] = {ids[0], ids[0]}, wrong[] = {ids[0], 12345};
  CHECK_STATUS(rvelab_run_stages(host.pool, 2, twice, cement_stage, nullptr, nullptr), RVELAB_E_DUPLICATE);
  CHECK(host.snapshot(ids[0]) == before);
  std::int32_t status[2];
  CHECK_STATUS(rvelab_run_stages(host.pool, 2, wrong, cement_stage, nullptr, status), RVELAB_E_ID);
  CHECK((status[0] == RVELAB_OK && status[1] == RVELAB_E_ID));  // the others went on
  // Without RVEs a text is checked alone.
  CHECK_STATUS(rvelab_run_stages(host.pool, 0, nullptr, cement_stage, nullptr, nullptr), RVELAB_OK);
  CHECK_STATUS(rvelab_run_stages(host.pool, 0, nullptr, "[[stage]]\nkind = \"cement\"\n", nullptr, nullptr),
               RVELAB_E_INPUT);
}
