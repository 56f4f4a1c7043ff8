// Whose an id, a token or a template is: those of another pool, of one that is gone or of another process name nothing.
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <functional>
#include <set>

#include "rvelab/pool/threaded_pool.hpp"
#include "tests/abi/host.hpp"
#include "tests/folder.hpp"

using namespace rvelab;
using namespace rvelab::test;
using Catch::Matchers::Contains;

namespace {

/// What a host keeps of three points after a trial.
struct Kept {
  std::int64_t ids[3], tokens[3], made;
};

Kept kept_of(Host& host) {
  Kept kept;
  kept.made = host.template_of(packed(Shape::disc, 4));
  REQUIRE_OK(rvelab_spawn(host.pool, kept.made, 3, kept.ids));
  Trials trials({kept.ids[0], kept.ids[1], kept.ids[2]});
  for (Nine& dH : trials.dH) dH = Nine{1e-5};
  REQUIRE_OK(rvelab_trial(host.pool, &trials.batch));
  std::copy_n(trials.tokens.data(), 3, kept.tokens);
  return kept;
}

Kept kept_of_destroyed() {
  Host gone;
  return kept_of(gone);
}

/// Of another process, which makes the same calls as this one.
Kept kept_of_process() {
  int ends[2];
  REQUIRE(pipe(ends) == 0);
  const pid_t child = fork();
  REQUIRE(child >= 0);
  if (child == 0) try {
      const Kept kept = kept_of_destroyed();
      _exit(::write(ends[1], &kept, sizeof kept) == sizeof kept ? 0 : 1);
    } catch (...) {
      _exit(1);
    }
  close(ends[1]);
  Kept kept;
  const bool read_all = ::read(ends[0], &kept, sizeof kept) == sizeof kept;
  close(ends[0]);
  int status = -1;
  REQUIRE((waitpid(child, &status, 0) == child && status == 0 && read_all));
  return kept;
}

using Call = std::function<std::int32_t(std::int64_t id)>;

/// Every call that takes an id.
std::vector<std::pair<const char*, Call>> calls_by_id(rvelab_pool* pool) {
  static const Nine dH{1e-5};
  static double sigma[9];
  static std::int64_t number;
  static std::size_t need;
  const auto snapshot = snapshot_of(packed(Shape::disc, 4));
  return {
      {"apply", [=](std::int64_t id) { return rvelab_apply(pool, id, dH.data(), 0, sigma); }},
      {"trial",
       [=](std::int64_t id) {
         Trials trials({id});
         return rvelab_trial(pool, &trials.batch);
       }},
      {"apply_mixed",
       [=](std::int64_t id) {
         const std::vector<double> rows(27, 1.0);
         rvelab_mixed mixed;
         rvelab_mixed_init(&mixed, sizeof mixed);
         mixed.n = 1;
         mixed.rows = 3;
         mixed.ids = &id;
         mixed.strain = mixed.stress = mixed.value = mixed.scale = rows.data();
         mixed.sigma = sigma;
         return rvelab_apply_mixed(pool, &mixed);
       }},
      {"relax", [=](std::int64_t id) { return rvelab_relax(pool, id, 1e-3, 10, sigma); }},
      {"commit", [=](std::int64_t id) { return rvelab_commit(pool, 1, &id); }},
      {"revert", [=](std::int64_t id) { return rvelab_revert(pool, 1, &id); }},
      {"release", [=](std::int64_t id) { return rvelab_release(pool, 1, &id); }},
      {"clone", [=](std::int64_t id) { return rvelab_clone(pool, id, &number); }},
      {"get_info",
       [=](std::int64_t id) {
         rvelab_info info;
         rvelab_info_init(&info, sizeof info);
         return rvelab_get_info(pool, id, &info);
       }},
      {"list_arrays", [=](std::int64_t id) { return rvelab_list_arrays(pool, id, 0, nullptr, &number); }},
      {"get_array", [=](std::int64_t id) { return rvelab_get_array(pool, id, "void_ratio", nullptr, 0, &need); }},
      {"get_parameters", [=](std::int64_t id) { return rvelab_get_parameters(pool, id, nullptr, 0, &need); }},
      {"set_parameters", [=](std::int64_t id) { return rvelab_set_parameters(pool, id, "material.friction = 0.2"); }},
      {"run_stages",
       [=](std::int64_t id) {
         return rvelab_run_stages(pool, 1, &id, "[[stage]]\nkind = \"water\"\nsuction_Pa = 100\n", sigma, nullptr);
       }},
      {"cost", [=](std::int64_t id) { return rvelab_cost(pool, 1, &id, &number); }},
      {"snapshot_save", [=](std::int64_t id) { return rvelab_snapshot_save(pool, id, nullptr, 0, &need); }},
      {"snapshot_load",
       [=](std::int64_t id) { return rvelab_snapshot_load(pool, id, snapshot.data(), snapshot.size()); }},
  };
}

}  // namespace

TEST_CASE("Ids, tokens and templates of another pool, of one that is gone or of another process are refused by all") {
  const Kept of_process = kept_of_process(), of_destroyed = kept_of_destroyed();
  Host other, host;
  const Kept of_other = kept_of(other), own = kept_of(host);
  const auto states = [&] {
    std::vector<std::vector<std::byte>> all;
    for (const std::int64_t id : own.ids) all.push_back(host.snapshot(id));
    return all;
  };
  const auto before = states();
  for (const auto& [whose, foreign] : {std::pair("another pool", of_other), std::pair("one that is gone", of_destroyed),
                                       std::pair("another process", of_process)}) {
    CAPTURE(whose);
    for (std::size_t k = 0; k < 3; ++k) {
      CHECK(pool::Id::of(foreign.ids[k]).slot == pool::Id::of(own.ids[k]).slot);  // but for the tag it is one of these
      for (const auto& [name, call] : calls_by_id(host.pool)) {
        CAPTURE(name);
        CHECK_STATUS(call(foreign.ids[k]), RVELAB_E_ID);
        CHECK_THAT(rvelab_last_error(), Contains("another pool or process made it"));
      }
      Trials trials({own.ids[k]});
      trials.tokens[0] = foreign.tokens[k];
      trials.batch.tokens_in = trials.tokens.data();
      CHECK_STATUS(rvelab_trial(host.pool, &trials.batch), RVELAB_E_STALE);
      CHECK_THAT(rvelab_last_error(), Contains("made by another pool or process"));
    }
    std::int64_t id = 0;
    CHECK_STATUS(rvelab_spawn(host.pool, foreign.made, 1, &id), RVELAB_E_ID);
    CHECK_THAT(rvelab_last_error(), Contains("another pool or process"));
    CHECK_STATUS(rvelab_template_release(host.pool, foreign.made), RVELAB_E_ID);
  }
  // Of a batch the foreign one alone fails; what takes all or none takes none.
  Trials mixed({own.ids[0], of_process.ids[1], own.ids[2]});
  CHECK_STATUS(rvelab_trial(host.pool, &mixed.batch), RVELAB_E_ID);
  CHECK((mixed.status[0] >= RVELAB_OK && mixed.status[1] == RVELAB_E_ID && mixed.status[2] >= RVELAB_OK));
  CHECK_STATUS(rvelab_commit(host.pool, 3, mixed.ids.data()), RVELAB_E_ID);
  CHECK_STATUS(rvelab_release(host.pool, 3, mixed.ids.data()), RVELAB_E_ID);
  for (std::size_t k = 0; k < 3; ++k)
    CHECK(Rve(pool::rve_state_of(before[k]).specimen).save() == Rve(host.state(own.ids[k])).save());
  Host empty;
  CHECK_STATUS(rvelab_revert(empty.pool, 1, own.ids), RVELAB_E_ID);
  CHECK_THAT(rvelab_last_error(), Contains("another pool or process made it") && Contains("no RVEs yet"));
}

TEST_CASE("What pools give out differs from pool to pool, and is exact in a double") {
  std::set<std::int64_t> ids, tokens, templates;
  std::set<std::uint32_t> tags, generations;
  for (int k = 0; k < 100; ++k) {  // one after the other: a tag that is free again is not the next
    const Kept kept = kept_of_destroyed();
    for (const std::int64_t number : {kept.ids[0], kept.ids[2], kept.tokens[0], kept.made}) {
      CHECK((number > 0 && number < std::int64_t(1) << 53));
      CHECK(std::int64_t(double(number)) == number);
    }
    CHECK(kept.ids[1] == kept.ids[0] + 1);
    ids.insert(kept.ids[0]);
    tokens.insert(kept.tokens[0]);
    templates.insert(kept.made);
    tags.insert(pool::Id::of(kept.ids[0]).tag);
    generations.insert(pool::Id::of(kept.ids[0]).generation);
  }
  CHECK((ids.size() == 100 && tokens.size() == 100 && templates.size() >= 99));
  CHECK((tags.size() > 80 && generations.size() > 95));
}

TEST_CASE("Ids that count give pool files of the same bytes; those that are drawn differ in them alone") {
  const Folder folder;
  const auto written = [&](std::uint32_t flags) {
    rvelab_pool_def def = default_def();
    def.flags = flags;
    Host host(def);
    const Kept kept = kept_of(host);
    CHECK((kept.tokens[0] == 2) == (flags != 0));
    REQUIRE_OK(rvelab_commit(host.pool, 0, nullptr));
    REQUIRE_OK(rvelab_pool_write(host.pool, (folder / "pool.h5").c_str()));
    std::ifstream file(folder / "pool.h5", std::ios::binary);
    return std::pair(std::string(std::istreambuf_iterator<char>(file), {}), host.state(kept.ids[0]));
  };
  const auto counted = written(RVELAB_POOL_COUNTED_IDS), drawn = written(0);
  CHECK(counted.first == written(RVELAB_POOL_COUNTED_IDS).first);
  CHECK(drawn.first != written(0).first);
  CHECK(Rve(drawn.second).save() == Rve(counted.second).save());
}

TEST_CASE("Ids and tokens of a pool file from before they were drawn stay valid, and new ones are drawn") {
  pool::ThreadedPool pool{pool::Options()};
  const std::int64_t ids[] = {pool::Id{1, 1, 1}.value(), pool::Id{1, 3, 2}.value()};
  const auto bytes = snapshot_of(packed(Shape::disc, 4));
  pool.read([&](const auto& take) {
    for (int k = 0; k < 2; ++k) take(bytes);
    return pool::Population{1, {1, 1, 3}, {ids[0], ids[1]}};
  });
  CHECK((pool.info(ids[0]).token == 1 && pool.info(ids[1]).token == 1));
  CHECK_THROWS_WITH(pool.info(pool::Id({1, 2, 2}).value()), Contains("stale"));
  std::set<std::uint32_t> generations;
  for (std::int64_t k = 0; k < 3; ++k) {
    std::int64_t id = 0;
    const std::int64_t made = pool.add_template(packed(Shape::disc, 4));
    pool.spawn(made, 1, &id);
    CHECK((pool::Id::of(id).tag == 1 && pool::Id::of(id).slot == 3 + k));
    generations.insert(pool::Id::of(id).generation);
  }
  CHECK((generations.size() == 1 && *generations.begin() > 3));
}
