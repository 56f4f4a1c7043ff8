// Ranks whose memory runs out, the first one and the others alike: those of this process work on one thread.
#include <algorithm>
#include <functional>

#include "rvelab/pool/rve_state.hpp"
#include "tests/abi/no_memory.hpp"
#include "tests/ranks/local_ranks.hpp"

using namespace rvelab;
using namespace rvelab::test;

namespace {

struct Step {
  const char* name;
  std::function<void()> prepare, call, undo;
};

}  // namespace

TEST_CASE("Without memory at any request of any rank a call is refused and leaves RVEs and ids as they were") {
  const auto ranks = GENERATE(1, 3);
  const auto pool = over(ranks, one_thread());
  const Specimen& start = packed(3);
  const std::int64_t made = pool->add_template(start);
  std::vector<std::int64_t> ids(4), more(4);
  pool->spawn(made, 4, ids.data());
  const std::vector<double> gradients = Draw(3).gradients(4, 1e-4);
  Matrix3 gradient = Matrix3::Zero();
  gradient(0, 1) = 1e-4;
  double stress[9];
  pool->apply(ids[1], gradient, 0, stress);
  const auto seen = [&] {
    std::vector<std::vector<std::byte>> states;
    for (const std::int64_t id : ids) states.push_back(pool->at<&pool::Share::save>(id));
    return states;
  };
  const auto states = seen();
  const auto put_back = [&] {
    for (std::size_t k = 0; k < ids.size(); ++k) pool->at<&pool::Share::load>(ids[k], states[k]);
  };
  std::int64_t other = 0;
  std::vector<std::int64_t> costs(4);
  const auto nothing = [] {};
  const std::vector<Step> calls = {
      {"add_template", nothing, [&] { other = pool->add_template(start); },
       [&] { pool->everywhere<&pool::Share::release_template>(other); }},
      {"release_template", [&] { other = pool->add_template(start); },
       [&] { pool->everywhere<&pool::Share::release_template>(other); }, nothing},
      {"spawn", nothing, [&] { pool->spawn(made, 4, more.data()); }, [&] { pool->release(more); }},
      {"clone", nothing, [&] { other = pool->clone(ids[1]); },
       [&] {
         pool->release({&other, 1});
       }},
      {"ids", nothing, [&] { pool->ids(); }, nothing},
      {"info", nothing, [&] { pool->at<&pool::Share::info>(ids[1]); }, nothing},
      {"cost", nothing, [&] { pool->cost(ids, costs.data()); }, nothing},
      {"save", nothing, [&] { pool->at<&pool::Share::save>(ids[2]); }, nothing},
      {"load", nothing, [&] { pool->at<&pool::Share::load>(ids[2], states[2]); }, nothing},
      {"apply", nothing, [&] { pool->apply(ids[1], gradient, 0, stress); }, put_back},
      {"revert", [&] { trial(*pool, ids, gradients); }, [&] { pool->revert(ids); }, nothing},
  };
  for (const Step& call : calls) {
    long refused = 0;
    for (long n = 1;; ++n) {
      CAPTURE(ranks, call.name, n);
      call.prepare();
      const auto before = seen();
      pool::Status status = pool::Status::ok;
      allocations_left = n;
      try {
        call.call();
      } catch (...) {
        allocations_left = 0;
        char text[1024];
        status = pool::status_of_exception(text, sizeof text);
        CAPTURE(text);
        CHECK(status == pool::Status::no_memory);
      }
      const bool enough = allocations_left > 0;
      allocations_left = 0;
      if (status != pool::Status::ok) {
        ++refused;
        REQUIRE(pool->ids() == ids);
        REQUIRE((seen() == before));
        call.call();  // with memory
      }
      call.undo();
      REQUIRE((seen() == before));
      put_back();
      if (enough) break;
    }
    INFO(call.name);
    CHECK(refused > 0);
  }
}

TEST_CASE("Without memory at any request of any rank a commit, revert or release is made by all ranks or by none") {
  const auto ranks = GENERATE(1, 3);
  const auto memory = GENERATE(RVELAB_TRIAL_KEEP, RVELAB_TRIAL_RECOMPUTE);
  const auto everything = GENERATE(false, true);  // all that are pending, or those named
  pool::Options options = one_thread();
  options.trial_memory = memory;
  const auto pool = over(ranks, options);
  const std::int64_t made = pool->add_template(packed(3));
  const std::vector<double> gradients = Draw(3).gradients(5, 1e-4);
  std::vector<std::int64_t> ids(5);
  const auto seen = [&] {
    std::vector<std::vector<std::byte>> states;
    for (const std::int64_t id : ids) states.push_back(pool->at<&pool::Share::save>(id));
    return states;
  };
  const auto spawn = [&] {
    pool->spawn(made, 5, ids.data());
    std::sort(ids.begin(), ids.end());
  };
  spawn();
  trial(*pool, ids, gradients);
  pool->commit(ids);
  const auto committed = seen();
  const std::span<const std::int64_t> named = everything ? std::span<const std::int64_t>() : std::span(ids);
  enum What { commit, revert, release };
  for (const What what : {commit, revert, release}) {
    long refused = 0;
    bool enough = false;
    for (long n = 1; !enough; ++n) {
      CAPTURE(ranks, memory, int(what), n);
      pool->release(ids);
      spawn();
      trial(*pool, ids, gradients);
      const auto before = seen();
      const auto call = [&] {
        if (what == release) return pool->release(ids);
        what == commit ? pool->commit(named) : pool->revert(named);
      };
      bool done = true;
      allocations_left = n;
      try {
        call();
      } catch (const std::bad_alloc&) {
        done = false;
      } catch (const pool::Refused& reason) {
        done = reason.status != pool::Status::no_memory;
      }
      enough = allocations_left > 0;
      allocations_left = 0;
      if (!done) {
        ++refused;
        REQUIRE(pool->ids() == ids);
        REQUIRE((seen() == before));
        if (what == revert) pool->commit(ids);  // each trial is pending still
        if (what == revert) REQUIRE((seen() == committed));
        if (what != revert) call();
      }
      if (what == commit) REQUIRE((seen() == committed));
      if (what == revert && done) {
        REQUIRE((seen() == before));
        CHECK_THROWS_AS(pool->commit(std::span(ids).first(1)), pool::Refused);
      }
      if (what == release) {
        REQUIRE(pool->ids().empty());
        spawn();
      }
    }
    CHECK(refused > 0);
  }
}

TEST_CASE("A batch over ranks without memory tells of each RVE what became of it") {
  const auto pool = over(3, one_thread());
  const std::int64_t made = pool->add_template(packed(3));
  std::vector<std::int64_t> ids(6);
  pool->spawn(made, 6, ids.data());
  std::vector<std::vector<std::byte>> states;
  for (const std::int64_t id : ids) states.push_back(pool->at<&pool::Share::save>(id));
  const std::vector<double> gradients = Draw(3).gradients(6, 1e-4);
  const Found expected = trial(*pool, ids, gradients, nullptr, 0, true);
  pool->revert(ids);
  std::vector<double> stress(54), tangent(216);
  std::vector<std::int32_t> status(6);
  pool::Batch batch;
  batch.n = 6;
  batch.ids = ids.data();
  batch.dH = gradients.data();
  batch.sigma = stress.data();
  batch.tangent = tangent.data();
  batch.status = status.data();
  /// Whether n requests were enough.
  const auto tried = [&](long n) {
    CAPTURE(n);
    for (std::size_t k = 0; k < ids.size(); ++k) pool->at<&pool::Share::load>(ids[k], states[k]);
    std::fill(stress.begin(), stress.end(), 7);
    std::fill(status.begin(), status.end(), std::int32_t(pool::Status::no_memory));
    allocations_left = n;
    pool::Status found = pool::Status::no_memory;
    try {
      found = pool->trial(batch).status;
    } catch (const std::bad_alloc&) {
    }
    const bool enough = allocations_left > 0;
    allocations_left = 0;
    if (enough) return true;
    for (std::size_t k = 0; k < ids.size(); ++k) {
      CAPTURE(k);
      if (pool::Status(status[k]) >= pool::Status::ok) {
        CHECK(std::equal(&stress[9 * k], &stress[9 * k] + 9, &expected.stress[9 * k]));
        continue;
      }
      CHECK(pool::Status(status[k]) == pool::Status::no_memory);
      CHECK(found == pool::Status::no_memory);
      CHECK(stress[9 * k] == 7);
      CHECK((pool->at<&pool::Share::save>(ids[k]) == states[k]));
    }
    CHECK(trial(*pool, ids, gradients, nullptr, 0, true).bits() == expected.bits());
    return false;
  };
  long n = 1;
  while (!tried(n)) n += n < 200 ? 1 : 7;
  for (long last = n - 40; last < n; ++last) tried(last);  // those after the trials, each of them
}
