// Bad input: each a status and a text, and the state is as it was.
#include <cmath>
#include <limits>

#include "rvelab/pool/slots.hpp"
#include "tests/abi/host.hpp"

using namespace rvelab;
using namespace rvelab::test;
using Catch::Matchers::Contains;

namespace {

const double not_a_number = std::numeric_limits<double>::quiet_NaN(),
             infinity = std::numeric_limits<double>::infinity();

/// The status is the expected one, the text says `words`.
#define CHECK_REFUSED(call, expected, words)          \
  do {                                                \
    CHECK((call) == (expected));                      \
    CHECK_THAT(rvelab_last_error(), Contains(words)); \
    CHECK(std::strlen(rvelab_last_error()) > 20);     \
  } while (false)

}  // namespace

TEST_CASE("Increments that are none are refused, one by one and in a batch") {
  Host host;
  const auto ids = host.spawn(packed(Shape::disc, 6), 3);
  const auto before = host.snapshot(ids[1]);
  const Nine good = Increments(1).next(1e-5);
  struct Bad {
    Nine dH;
    std::int32_t status;
    const char* words;
  };
  std::vector<Bad> all;
  for (std::size_t k = 0; k < 9; ++k)
    for (const double value : {not_a_number, infinity, -infinity}) {
      Bad bad{good, RVELAB_E_INPUT, "finite"};
      bad.dH[k] = value;
      all.push_back(bad);
    }
  all.push_back({Nine{-1, 0, 0, 0, 0, 0, 0, 0, 0}, RVELAB_E_INPUT, "det"});
  all.push_back({Nine{-3, 0, 0, 0, 1, 0, 0, 0, 0}, RVELAB_E_INPUT, "det"});
  all.push_back({Nine{0, 0, 0, 0, 0, 0, 0, 0, 1e-3}, RVELAB_E_INPUT, ""});  // out of the plane
  const Nine untouched{1, 2, 3, 4, 5, 6, 7, 8, 9};
  for (const Bad& bad : all) {
    Nine sigma = untouched;
    CHECK_REFUSED(rvelab_apply(host.pool, ids[1], bad.dH.data(), 0, sigma.data()), bad.status, bad.words);
    CHECK(same(sigma, untouched));
    CHECK(host.snapshot(ids[1]) == before);
    Trials trials(ids);
    trials.ask_for_all();
    trials.dH = {good, bad.dH, good};
    trials.sigma[1] = untouched;
    trials.error_estimate[1] = trials.tangent[36] = 77;
    trials.tokens[1] = 55;
    CHECK_REFUSED(rvelab_trial(host.pool, &trials.batch), bad.status, "entry 1 (id " + std::to_string(ids[1]) + ")");
    CHECK((trials.status[0] >= 0 && trials.status[2] >= 0));
    CHECK(trials.status[1] == bad.status);
    CHECK((trials.dt_scale[0] == 1 && trials.dt_scale[1] == 0));
    CHECK(same(trials.sigma[1], untouched));
    CHECK((trials.error_estimate[1] == 77 && trials.tangent[36] == 77 && trials.tokens[1] == 55));
    CHECK(!same(trials.sigma[0], Nine{}));
    CHECK_REFUSED(rvelab_commit(host.pool, 3, ids.data()), RVELAB_E_NO_TRIAL, "entry 1");  // all or none
    REQUIRE_OK(rvelab_revert(host.pool, 3, ids.data()));
    CHECK(host.snapshot(ids[1]) == before);
  }
  Nine sigma = untouched;
  for (const double dt : {not_a_number, infinity, -1e-9})
    CHECK_REFUSED(rvelab_apply(host.pool, ids[0], good.data(), dt, sigma.data()), RVELAB_E_INPUT, "dt");
  CHECK(same(sigma, untouched));
}

TEST_CASE("Half a unit of strain in one call is made in parts or discarded, never garbage") {
  for (const Shape shape : {Shape::disc, Shape::sphere}) {
    Host host;
    const Specimen& start = packed(shape, shape == Shape::disc ? 6 : 4);
    const auto ids = host.spawn(start);
    const auto before = host.snapshot(ids[0]);
    for (const Nine& dH : {Nine{0.5}, Nine{-0.5}, Nine{0, 0.5}, Nine{-0.5, 0, 0, 0, -0.5}, Nine{0, -0.5, 0, 0.5}}) {
      for (const double dt : {0.0, 1e-3}) {
        Trials trials(ids);
        trials.dH[0] = dH;
        trials.batch.dt = dt;
        const std::int32_t status = rvelab_trial(host.pool, &trials.batch);
        INFO(rvelab_status_name(status) << " " << rvelab_last_error());
        if (status == RVELAB_DISCARD) {
          CHECK(trials.dt_scale[0] == 0.5);
          CHECK(same(trials.sigma[0], Nine{}));
          CHECK(rvelab_commit(host.pool, 1, ids.data()) == RVELAB_E_NO_TRIAL);
        } else {
          CHECK(status >= RVELAB_OK);
          CHECK(matrix_of(trials.sigma[0]).allFinite());
        }
        REQUIRE_OK(rvelab_revert(host.pool, 0, nullptr));
        CHECK(Rve(host.state(ids[0])).save() == Rve(pool::rve_state_of(before).specimen).save());
      }
    }
  }
}

TEST_CASE("Ids that are null, stale, foreign, rounded or of nothing are told apart") {
  Host host, other;
  auto ids = host.spawn(packed(Shape::disc, 6), 3);
  const auto foreign = other.spawn(packed(Shape::disc, 6));
  Nine dH{}, sigma{};
  const auto refused = [&](std::int64_t id, const char* words) {
    CHECK_REFUSED(rvelab_apply(host.pool, id, dH.data(), 0, sigma.data()), RVELAB_E_ID, words);
    std::int64_t clone = 5, cost = 5;
    std::size_t need = 5;
    rvelab_info info;
    rvelab_info_init(&info, sizeof info);
    char byte = 0;
    CHECK_REFUSED(rvelab_clone(host.pool, id, &clone), RVELAB_E_ID, words);
    CHECK_REFUSED(rvelab_release(host.pool, 1, &id), RVELAB_E_ID, words);
    CHECK_REFUSED(rvelab_cost(host.pool, 1, &id, &cost), RVELAB_E_ID, words);
    CHECK_REFUSED(rvelab_commit(host.pool, 1, &id), RVELAB_E_ID, words);
    CHECK_REFUSED(rvelab_revert(host.pool, 1, &id), RVELAB_E_ID, words);
    CHECK_REFUSED(rvelab_get_info(host.pool, id, &info), RVELAB_E_ID, words);
    CHECK_REFUSED(rvelab_snapshot_save(host.pool, id, nullptr, 0, &need), RVELAB_E_ID, words);
    CHECK_REFUSED(rvelab_snapshot_load(host.pool, id, &byte, 1), RVELAB_E_ID, words);
    CHECK((clone == 5 && cost == 5 && need == 5));
  };
  refused(0, "null");
  refused(-7, "no id");
  refused(std::int64_t(1) << 53, "no id");
  refused(foreign[0], "another pool or process made it (of tag ");
  refused(ids[2] + 1, "another pool or process made it (no RVE of this pool ever had it)");
  for (const std::int64_t id : ids) {
    CHECK(std::int64_t(double(id)) == id);
    CHECK(std::int64_t(float(id)) != id);
    refused(std::int64_t(float(id)), "rounded");
  }
  const std::int64_t released = ids[1];
  REQUIRE_OK(rvelab_release(host.pool, 1, &released));
  refused(released, "stale");
  const auto again = host.spawn(packed(Shape::disc, 6));  // the slot has a new generation
  CHECK(again[0] != released);
  refused(released, "stale");
  const std::int64_t twice[] = {ids[0], ids[0]};
  CHECK_REFUSED(rvelab_release(host.pool, 2, twice), RVELAB_E_DUPLICATE, "twice");
  const std::int64_t partly[] = {ids[0], released};
  CHECK_REFUSED(rvelab_release(host.pool, 2, partly), RVELAB_E_ID, "stale");
  host.apply(ids[0], dH);  // is there still
}

TEST_CASE("A duplicate in a batch is an error before any work") {
  Host host(3);
  const auto ids = host.spawn(packed(Shape::disc, 6), 2);
  Trials trials({ids[0], ids[1], ids[0]});
  for (Nine& dH : trials.dH) dH = Increments(2).next(1e-5);
  CHECK_REFUSED(rvelab_trial(host.pool, &trials.batch), RVELAB_E_DUPLICATE, "twice");
  CHECK(trials.status == std::vector<std::int32_t>{99, 99, 99});
  CHECK(same(trials.sigma[1], Nine{}));
  CHECK(rvelab_commit(host.pool, 1, &ids[1]) == RVELAB_E_NO_TRIAL);
  CHECK_REFUSED(rvelab_commit(host.pool, 3, trials.ids.data()), RVELAB_E_DUPLICATE, "twice");
  Trials none(std::vector<std::int64_t>{});
  CHECK(rvelab_trial(host.pool, &none.batch) == RVELAB_OK);
  none.batch.n = -1;
  CHECK_REFUSED(rvelab_trial(host.pool, &none.batch), RVELAB_E_INPUT, "n is -1");
}

TEST_CASE("Of many RVEs the same ones are refused on any number of workers, and named in the same words") {
  constexpr std::size_t many = 300;  // from 256 on ids are held by the workers
  std::vector<std::string> texts;
  for (const int workers : {1, 3}) {
    CAPTURE(workers);
    Host host(workers);
    const auto ids = host.spawn(packed(Shape::disc, 6), many);
    Trials trials(ids);
    for (Nine& dH : trials.dH) dH = Increments(2).next(1e-6);
    REQUIRE_OK(rvelab_trial(host.pool, &trials.batch));  // the workers are there
    REQUIRE_OK(rvelab_commit(host.pool, 0, nullptr));
    const std::vector<std::int64_t> tokens = trials.tokens;

    Trials partly(ids);
    partly.dH = trials.dH;
    partly.ids[17] = partly.ids[250] = ids[5] + 1'000'000;
    CHECK(rvelab_trial(host.pool, &partly.batch) == RVELAB_E_ID);
    std::vector<std::string> here{rvelab_last_error()};
    CHECK_THAT(here[0], Contains("entry 17"));
    for (std::size_t k = 0; k < many; ++k) CHECK(partly.status[k] == (k == 17 || k == 250 ? RVELAB_E_ID : RVELAB_OK));
    CHECK(rvelab_commit(host.pool, std::int64_t(many), partly.ids.data()) == RVELAB_E_ID);
    here.emplace_back(rvelab_last_error());
    CHECK(host.info(ids[0]).token == tokens[0]);  // nothing was committed
    REQUIRE_OK(rvelab_revert(host.pool, 0, nullptr));

    Trials twice(ids);
    twice.dH = trials.dH;
    twice.ids[290] = ids[3];
    twice.ids[41] = ids[40];
    CHECK(rvelab_trial(host.pool, &twice.batch) == RVELAB_E_DUPLICATE);
    here.emplace_back(rvelab_last_error());
    CHECK(rvelab_commit(host.pool, 0, nullptr) == RVELAB_OK);
    CHECK(host.info(ids[0]).token == tokens[0]);  // there was none pending
    // All were let go of: the next call has them.
    REQUIRE_OK(rvelab_trial(host.pool, &trials.batch));
    CHECK(rvelab_commit(host.pool, std::int64_t(many), twice.ids.data()) == RVELAB_E_DUPLICATE);
    here.emplace_back(rvelab_last_error());
    REQUIRE_OK(rvelab_commit(host.pool, 0, nullptr));
    for (std::string& text : here)  // each pool has its own ids
      for (std::int64_t id : {partly.ids[17], ids[3], ids[40]})
        for (auto at = text.find(std::to_string(id)); at != std::string::npos; at = text.find(std::to_string(id)))
          text.replace(at, std::to_string(id).size(), "of slot " + std::to_string(pool::Id::of(id).slot));
    if (texts.empty())
      texts = here;
    else
      CHECK(texts == here);
  }
}

TEST_CASE("A stale token names the valid ones; a failed step leaves the accepted state") {
  Host host;
  const auto ids = host.spawn(packed(Shape::disc, 6));
  Trials trials(ids);
  const std::int64_t committed = host.info(ids[0]).token;
  Increments draw(4);
  std::vector<std::int64_t> tokens;
  for (int k = 0; k < 18; ++k) {
    trials.dH[0] = draw.next(1e-6);
    REQUIRE_OK(rvelab_trial(host.pool, &trials.batch));
    tokens.push_back(trials.tokens[0]);
  }
  trials.batch.tokens_in = trials.tokens.data();
  for (const std::int64_t stale : {tokens[0], tokens[1], std::int64_t(0), std::int64_t(-3), tokens[17] + 1}) {
    trials.tokens[0] = stale;
    CHECK_REFUSED(rvelab_trial(host.pool, &trials.batch), RVELAB_E_STALE, std::to_string(committed) + " (committed)");
    CHECK_THAT(rvelab_last_error(), Contains(" " + std::to_string(tokens[2]) + ", "));
    CHECK(trials.tokens[0] == stale);
  }
  trials.tokens[0] = tokens[5];
  trials.dH[0] = Nine{-1};  // refused before anything is committed
  CHECK_REFUSED(rvelab_trial(host.pool, &trials.batch), RVELAB_E_INPUT, "det");
  CHECK(host.info(ids[0]).token == committed);
  trials.dH[0] = Nine{};
  REQUIRE_OK(rvelab_trial(host.pool, &trials.batch));
  CHECK(host.info(ids[0]).token == tokens[5]);
  trials.tokens[0] = tokens[17];  // the trials from the old state are over
  CHECK_REFUSED(rvelab_trial(host.pool, &trials.batch), RVELAB_E_STALE, std::to_string(tokens[5]) + " (committed)");
}

TEST_CASE("Null pointers, bad options and templates of another pool are refused") {
  Host host, other;
  const std::int64_t made = other.template_of(packed(Shape::disc, 6));
  std::int64_t id = 1, out = 5;
  double nine[9] = {};
  const std::vector<std::byte> bytes = snapshot_of(packed(Shape::disc, 6));
  rvelab_pool* pool = nullptr;
  CHECK_REFUSED(rvelab_pool_create(nullptr, nullptr), RVELAB_E_NULL, "pool");
  CHECK_REFUSED(rvelab_pool_def_init(nullptr, 8), RVELAB_E_NULL, "def");
  CHECK_REFUSED(rvelab_batch_init(nullptr, 8), RVELAB_E_NULL, "batch");
  CHECK_REFUSED(rvelab_info_init(nullptr, 8), RVELAB_E_NULL, "info");
  CHECK_REFUSED(rvelab_template_load(host.pool, nullptr, &out), RVELAB_E_NULL, "path");
  CHECK_REFUSED(rvelab_template_load(host.pool, "x", nullptr), RVELAB_E_NULL, "tmpl");
  CHECK_REFUSED(rvelab_template_from_snapshot(host.pool, nullptr, 5, &out), RVELAB_E_NULL, "buf");
  CHECK_REFUSED(rvelab_template_from_snapshot(host.pool, bytes.data(), bytes.size(), nullptr), RVELAB_E_NULL, "tmpl");
  CHECK_REFUSED(rvelab_spawn(host.pool, made, 1, nullptr), RVELAB_E_NULL, "ids");
  CHECK_REFUSED(rvelab_spawn(host.pool, made, 1, &out), RVELAB_E_ID, "template");
  CHECK_REFUSED(rvelab_spawn(other.pool, made, -1, &out), RVELAB_E_INPUT, "n is -1");
  CHECK_REFUSED(rvelab_clone(host.pool, id, nullptr), RVELAB_E_NULL, "dst");
  CHECK_REFUSED(rvelab_release(host.pool, 1, nullptr), RVELAB_E_NULL, "ids");
  CHECK_REFUSED(rvelab_apply(host.pool, id, nullptr, 0, nine), RVELAB_E_NULL, "dH");
  CHECK_REFUSED(rvelab_apply(host.pool, id, nine, 0, nullptr), RVELAB_E_NULL, "sigma");
  CHECK_REFUSED(rvelab_trial(host.pool, nullptr), RVELAB_E_NULL, "batch");
  CHECK_REFUSED(rvelab_get_info(host.pool, id, nullptr), RVELAB_E_NULL, "info");
  CHECK_REFUSED(rvelab_cost(host.pool, 1, &id, nullptr), RVELAB_E_NULL, "grain_steps");
  CHECK_REFUSED(rvelab_cost(host.pool, 1, nullptr, &out), RVELAB_E_NULL, "ids");
  CHECK_REFUSED(rvelab_snapshot_save(host.pool, id, nullptr, 0, nullptr), RVELAB_E_NULL, "need");
  CHECK_REFUSED(rvelab_snapshot_load(host.pool, id, nullptr, 5), RVELAB_E_NULL, "buf");
  CHECK_REFUSED(rvelab_ids(host.pool, 0, nullptr, nullptr), RVELAB_E_NULL, "n is null");
  CHECK_REFUSED(rvelab_pool_write(host.pool, nullptr), RVELAB_E_NULL, "path");
  CHECK_REFUSED(rvelab_pool_read(host.pool, nullptr), RVELAB_E_NULL, "path");
  CHECK_REFUSED(rvelab_apply(nullptr, id, nine, 0, nine), RVELAB_E_NULL, "pool");
  CHECK_REFUSED(rvelab_ids(nullptr, 0, nullptr, &out), RVELAB_E_NULL, "pool");
  CHECK(rvelab_pool_destroy(nullptr) == RVELAB_OK);
  CHECK(out == 5);
  Trials trials(host.spawn(packed(Shape::disc, 6)));
  for (const double* rvelab_batch::*input : {&rvelab_batch::dH}) {
    rvelab_batch batch = trials.batch;
    batch.*input = nullptr;
    CHECK_REFUSED(rvelab_trial(host.pool, &batch), RVELAB_E_NULL, "dH");
  }
  const auto refused_def = [&](auto change, std::int32_t status, const char* words) {
    rvelab_pool_def def = default_def();
    change(def);
    CHECK_REFUSED(rvelab_pool_create(&def, &pool), status, words);
    CHECK(pool == nullptr);
  };
  refused_def([](auto& def) { def.workers = -1; }, RVELAB_E_INPUT, "workers");
  refused_def([](auto& def) { def.trial_memory = 2; }, RVELAB_E_UNSUPPORTED, "trial_memory");
  refused_def([](auto& def) { def.flags = 1; }, RVELAB_E_UNSUPPORTED, "flags");
  refused_def([](auto& def) { def.flags = RVELAB_POOL_COUNTED_IDS + 4; }, RVELAB_E_UNSUPPORTED, "knows 2 alone");
  refused_def([](auto& def) { def.tolerance_rel = not_a_number; }, RVELAB_E_INPUT, "tolerance_rel");
  refused_def([](auto& def) { def.tolerance_abs = -1; }, RVELAB_E_INPUT, "tolerance_abs");
  refused_def([](auto& def) { def.max_substeps = -1; }, RVELAB_E_INPUT, "max_substeps");
  refused_def([](auto& def) { def.damping = 1; }, RVELAB_E_INPUT, "damping");
  refused_def([](auto& def) { def.min_height = infinity; }, RVELAB_E_INPUT, "min_height");
}

TEST_CASE("10,000 snapshots, truncated or with a bit flipped, are refused, and the state stays") {
  Host host;
  const auto ids = host.spawn(packed(Shape::disc, 3));
  Trials trials(ids);
  trials.dH[0] = Increments(1).next(1e-6);
  REQUIRE_OK(rvelab_trial(host.pool, &trials.batch));  // so that there is a token to damage
  const auto whole = host.snapshot(ids[0]);
  const auto refused = [&](const std::vector<std::byte>& bytes) {
    std::int64_t made = 5;
    return rvelab_snapshot_load(host.pool, ids[0], bytes.data(), bytes.size()) == RVELAB_E_SNAPSHOT &&
           rvelab_template_from_snapshot(host.pool, bytes.data(), bytes.size(), &made) == RVELAB_E_SNAPSHOT &&
           made == 5 && std::strstr(rvelab_last_error(), "rvelab_pool_write") != nullptr;
  };
  Increments draw(7);
  int taken = 0;
  for (int k = 0; k < 5000; ++k) {
    auto cut = whole;
    cut.resize(k < 400 ? std::size_t(k) : draw.below(whole.size()));
    taken += !refused(cut);
    auto flipped = whole;
    const std::size_t bit = k < 2000 ? std::size_t(k) : draw.below(8 * whole.size());
    flipped[bit / 8] ^= std::byte(1 << bit % 8);
    taken += !refused(flipped);
  }
  CHECK(taken == 0);
  auto longer = whole;
  longer.push_back({});
  CHECK(refused(longer));
  CHECK(host.snapshot(ids[0]) == whole);
  CHECK_STATUS(rvelab_snapshot_load(host.pool, ids[0], whole.data(), whole.size()), RVELAB_OK);
  std::size_t need = 0;
  auto small = whole;
  CHECK_STATUS(rvelab_snapshot_save(host.pool, ids[0], small.data(), 10, &need), RVELAB_E_BUFFER);
  CHECK((need == whole.size() && small == whole));
}
