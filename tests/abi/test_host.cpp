// Hosts as they are: other floating-point environments, forks, threads, task systems, no memory.
#include <sys/wait.h>
#include <unistd.h>
#if defined(__x86_64__)
#include <xmmintrin.h>
#endif

#include <atomic>
#include <cfenv>
#include <functional>
#include <thread>

#include "tests/abi/host.hpp"
#include "tests/abi/no_memory.hpp"

using namespace rvelab;
using namespace rvelab::test;
using Catch::Matchers::Contains;

TEST_CASE("A call that finds no memory, whichever request fails, says so and changes nothing") {
  Host host;
  Specimen loose = disordered(Shape::disc, 4, linear_material(2e6, 1e6, 0.4), Law::linear_stiffness, 0.515, 1);
  for (int k = 16; k-- > 0;) loose.state.memory_order.push_back(k);  // kept in an order, as large ones are
  Rve relaxed(loose);
  relaxed.relax(1e-5, 100'000);
  relaxed.take_as_reference();
  const Specimen start = relaxed.specimen();
  const auto template_bytes = snapshot_of(start);
  const std::int64_t made = host.template_of(start);
  auto ids = host.spawn(start, 2);
  const Nine dH = Increments(1).next(1e-3);  // a new list is made on the way
  const auto before = host.snapshot(ids[0]);
  Trials trials(ids);
  trials.dH = {dH, dH};
  trials.ask_for_all();
  Nine sigma{};
  std::int64_t out = 0;
  std::size_t need = 0;
  rvelab_pool* pool = nullptr;
  std::vector<std::byte> room(before.size() + 100'000);
  rvelab_info info;
  rvelab_info_init(&info, sizeof info);
  struct Call {
    const char* name;
    std::function<std::int32_t()> call, undo;
  };
  const auto revert = [&] { return rvelab_revert(host.pool, 2, ids.data()); };
  const std::vector<Call> calls = {
      {"create", [&] { return rvelab_pool_create(nullptr, &pool); }, [&] { return rvelab_pool_destroy(pool); }},
      {"template",
       [&] { return rvelab_template_from_snapshot(host.pool, template_bytes.data(), template_bytes.size(), &out); },
       [] { return 0; }},
      {"spawn", [&] { return rvelab_spawn(host.pool, made, 1, &out); },
       [&] { return rvelab_release(host.pool, 1, &out); }},
      {"clone", [&] { return rvelab_clone(host.pool, ids[0], &out); },
       [&] { return rvelab_release(host.pool, 1, &out); }},
      {"trial", [&] { return rvelab_trial(host.pool, &trials.batch); }, revert},
      {"info", [&] { return rvelab_get_info(host.pool, ids[0], &info); }, [] { return 0; }},
      {"save", [&] { return rvelab_snapshot_save(host.pool, ids[0], room.data(), room.size(), &need); },
       [] { return 0; }},
      {"ids", [&] { return rvelab_ids(host.pool, 0, nullptr, &out); }, [] { return 0; }},
      {"apply", [&] { return rvelab_apply(host.pool, ids[0], dH.data(), 0, sigma.data()); },
       [&] { return rvelab_snapshot_load(host.pool, ids[0], before.data(), before.size()); }},
  };
  for (const Call& call : calls) {
    long failed = 0;
    for (long n = 1;; ++n) {
      const auto state = std::string(call.name) == "apply" ? host.snapshot(ids[0]) : std::vector<std::byte>();
      allocations_left = n;
      const std::int32_t status = call.call();
      const bool ran_out = allocations_left == 0;
      allocations_left = 0;
      if (!ran_out) {  // it needs fewer
        INFO(call.name << ": " << rvelab_last_error());
        REQUIRE(status >= RVELAB_OK);
        REQUIRE_OK(call.undo());
        break;
      }
      if (status >= RVELAB_OK) {  // what was refused could be done without
        REQUIRE_OK(call.undo());
        continue;
      }
      ++failed;
      INFO(call.name << ", request " << n << ": " << rvelab_last_error());
      CHECK(status == RVELAB_E_MEMORY);
      if (std::string(call.name) == "apply") CHECK(host.snapshot(ids[0]) == state);
      if (std::string(call.name) == "trial") REQUIRE_OK(revert());
    }
    INFO(call.name);
    CHECK(failed > 0);
  }
  CHECK(Rve(host.state(ids[0])).save() == Rve(pool::rve_state_of(before).specimen).save());
}

#if defined(__x86_64__)
TEST_CASE("Rounding, flushing to zero and traps of a host change no bit, raise no signal and are put back") {
  const Specimen& start = packed(Shape::sphere, 3);
  Host host(2);
  const auto ids = host.spawn(start, 5);
  const Nine dH = Increments(9, 3).next(1e-4);
  const Nine expected = host.apply(ids[0], dH);
  feclearexcept(FE_ALL_EXCEPT);
  fenv_t as_found;
  fegetenv(&as_found);
  Trials trials({ids[1], ids[2], ids[3]});
  for (Nine& each : trials.dH) each = dH;
  const auto work = [&](int raised = 0) {
    feclearexcept(raised ^ FE_ALL_EXCEPT);
    Nine sigma{};
    const std::int32_t one = rvelab_apply(host.pool, ids[4], dH.data(), 0, sigma.data());
    const std::int32_t many = rvelab_trial(host.pool, &trials.batch);
    const unsigned vectors = _mm_getcsr();
    const int rounding = fegetround(), traps = fegetexcept(), flags = fetestexcept(FE_ALL_EXCEPT);
    fesetenv(&as_found);
    CHECK((one >= 0 && many >= 0));
    CHECK(same(sigma, expected));
    for (const Nine& each : trials.sigma) CHECK(same(each, expected));
    rvelab_revert(host.pool, 0, nullptr);
    const auto again = snapshot_of(start);
    REQUIRE_OK(rvelab_snapshot_load(host.pool, ids[4], again.data(), again.size()));
    return std::array<int, 4>{int(vectors), rounding, traps, flags};
  };
  _mm_setcsr(_mm_getcsr() | 0x8040);  // FTZ and DAZ
  CHECK((work()[0] & 0x8040) == 0x8040);
  // The same of the vector unit alone, which the calls of fenv.h do not see.
  _mm_setcsr(_mm_getcsr() | 0x4000);
  CHECK((work()[0] & 0x6000) == 0x4000);
  _mm_setcsr(_mm_getcsr() & ~0x1F80U);
  CHECK((work()[0] & 0x1F80) == 0);
  fesetround(FE_UPWARD);
  CHECK(work()[1] == FE_UPWARD);
  feenableexcept(FE_DIVBYZERO | FE_INVALID | FE_OVERFLOW | FE_UNDERFLOW | FE_INEXACT);
  CHECK(work()[2] == (FE_DIVBYZERO | FE_INVALID | FE_OVERFLOW | FE_UNDERFLOW | FE_INEXACT));
  CHECK(work()[3] == 0);  // what is computed inside leaves no flag
  feraiseexcept(FE_DIVBYZERO);
  CHECK(work(FE_DIVBYZERO)[3] == FE_DIVBYZERO);
}
#endif

TEST_CASE("A child process may not use the pool of its parent, and the parent's goes on") {
  Host host(3);
  const auto ids = host.spawn(packed(Shape::disc, 6), 4);
  Trials trials(ids);
  REQUIRE_OK(rvelab_trial(host.pool, &trials.batch));  // the workers are there
  const pid_t child = fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    Nine nine{};
    std::int64_t out = 0;
    const bool told = rvelab_apply(host.pool, ids[0], nine.data(), 0, nine.data()) == RVELAB_E_FORKED &&
                      rvelab_trial(host.pool, &trials.batch) == RVELAB_E_FORKED &&
                      rvelab_commit(host.pool, 0, nullptr) == RVELAB_E_FORKED &&
                      rvelab_ids(host.pool, 0, nullptr, &out) == RVELAB_E_FORKED &&
                      rvelab_clone(host.pool, ids[0], &out) == RVELAB_E_FORKED &&
                      rvelab_pool_write(host.pool, "/dev/null") == RVELAB_E_FORKED &&
                      rvelab_pool_destroy(host.pool) == RVELAB_E_FORKED &&
                      std::strstr(rvelab_last_error(), "parent") != nullptr;
    rvelab_pool* own = nullptr;
    const bool made = rvelab_pool_create(nullptr, &own) == RVELAB_OK && rvelab_pool_destroy(own) == RVELAB_OK;
    _exit(told && made ? 0 : 1);
  }
  int status = -1;
  REQUIRE(waitpid(child, &status, 0) == child);
  CHECK(status == 0);
  REQUIRE_OK(rvelab_trial(host.pool, &trials.batch));
}

namespace {

/// A host's task system that does something of its own while a batch is under way, and runs tasks backwards.
struct Tasks {
  std::function<void()> meanwhile;
  int leave_out = 0, rounds = 0;
  static void run(void* host, rvelab_task task, void* work, std::int64_t count) {
    Tasks& self = *static_cast<Tasks*>(host);
    ++self.rounds;
    if (self.meanwhile) self.meanwhile();
    for (std::int64_t k = count; k-- > self.leave_out;) std::thread([&] { task(work, k); }).join();
  }
};

}  // namespace

TEST_CASE("While a call is at work, its RVEs are busy, others are not, and the population stays as it is") {
  Tasks tasks;
  rvelab_pool_def def = default_def();
  def.run_tasks = Tasks::run;
  def.host = &tasks;
  Host host(def);
  const auto ids = host.spawn(packed(Shape::disc, 6), 4);
  Trials trials({ids[0], ids[1]});
  for (Nine& dH : trials.dH) dH = Increments(1).next(1e-5);
  bool asked = false;
  tasks.meanwhile = [&] {
    if (std::exchange(asked, true)) return;
    Nine zero{}, sigma{};
    std::int64_t out = 0, made = 0;
    std::size_t need = 0;
    rvelab_info info;
    rvelab_info_init(&info, sizeof info);
    CHECK(rvelab_apply(host.pool, ids[0], zero.data(), 0, sigma.data()) == RVELAB_E_BUSY);
    CHECK_THAT(rvelab_last_error(), Contains(std::to_string(ids[0])));
    CHECK(rvelab_get_info(host.pool, ids[1], &info) == RVELAB_E_BUSY);
    CHECK(rvelab_snapshot_save(host.pool, ids[1], nullptr, 0, &need) == RVELAB_E_BUSY);
    CHECK(rvelab_commit(host.pool, 1, &ids[1]) == RVELAB_E_BUSY);
    CHECK(rvelab_commit(host.pool, 0, nullptr) == RVELAB_E_BUSY);
    CHECK(rvelab_spawn(host.pool, made, 1, &out) == RVELAB_E_BUSY);
    CHECK(rvelab_clone(host.pool, ids[2], &out) == RVELAB_E_BUSY);
    CHECK(rvelab_release(host.pool, 1, &ids[2]) == RVELAB_E_BUSY);
    CHECK(rvelab_pool_write(host.pool, "nowhere/at/all.h5") == RVELAB_E_BUSY);
    CHECK(rvelab_pool_read(host.pool, "nowhere/at/all.h5") == RVELAB_E_BUSY);
    CHECK(rvelab_pool_destroy(host.pool) == RVELAB_E_BUSY);
    CHECK_STATUS(rvelab_apply(host.pool, ids[2], trials.dH[0].data(), 0, sigma.data()), RVELAB_OK);
    Trials mixed({ids[3], ids[1]});
    mixed.dH = trials.dH;
    CHECK(rvelab_trial(host.pool, &mixed.batch) == RVELAB_E_BUSY);
    CHECK(mixed.status == std::vector<std::int32_t>{RVELAB_OK, RVELAB_E_BUSY});
    CHECK(same(mixed.sigma[0], sigma));
  };
  REQUIRE_OK(rvelab_trial(host.pool, &trials.batch));
  CHECK(tasks.rounds == 2);
  Nine sigma{};
  CHECK_STATUS(rvelab_apply(host.pool, ids[0], trials.dH[0].data(), 0, sigma.data()), RVELAB_OK);  // no longer
  CHECK(same(sigma, trials.sigma[0]));
}

TEST_CASE("While a call for population is under way, all others are busy") {
  static Host* host = nullptr;
  static std::int64_t id = 0;
  static std::int32_t found[4];
  Host at_hand;
  host = &at_hand;
  id = host->spawn(packed(Shape::disc, 6))[0];
  meanwhile = [] {
    double nine[9] = {}, sigma[9];
    std::int64_t out = 0;
    found[0] = rvelab_apply(host->pool, id, nine, 0, sigma);
    found[1] = rvelab_commit(host->pool, 0, nullptr);
    found[2] = rvelab_ids(host->pool, 0, nullptr, &out);
    found[3] = rvelab_pool_destroy(host->pool);
  };
  std::int64_t twin = 0;
  CHECK(rvelab_clone(host->pool, id, &twin) == RVELAB_OK);
  for (const std::int32_t status : found) CHECK(status == RVELAB_E_BUSY);
}

TEST_CASE("A host that leaves tasks out is told; every entry has its answer all the same") {
  Tasks tasks;
  tasks.leave_out = 2;
  rvelab_pool_def def = default_def();
  def.run_tasks = Tasks::run;
  def.host = &tasks;
  Host host(def);
  Trials trials(host.spawn(packed(Shape::disc, 6), 3));
  for (Nine& dH : trials.dH) dH = Increments(1).next(1e-5);
  CHECK(rvelab_trial(host.pool, &trials.batch) == RVELAB_E_INPUT);
  CHECK_THAT(rvelab_last_error(), Contains("1 of 3"));
  CHECK((same(trials.sigma[0], trials.sigma[2]) && same(trials.sigma[1], trials.sigma[2])));
}

TEST_CASE("Calls on different ids run at once, and each does what it does alone") {
  constexpr std::size_t threads = 4;
  const Specimen& start = packed(Shape::disc, 6);
  Host host(2), alone;
  const auto ids = host.spawn(start, threads), one = alone.spawn(start, threads);
  std::vector<std::vector<Nine>> found(threads);
  std::atomic<int> failed{0};
  const auto work = [&](rvelab_pool* pool, std::int64_t id, std::size_t k, std::vector<Nine>& row) {
    Increments draw(k + 1);
    for (int step = 0; step < 200; ++step) {
      Nine sigma{};
      const Nine dH = draw.next(1e-5);
      if (step % 3 == 0) {
        failed += rvelab_apply(pool, id, dH.data(), 0, sigma.data()) < 0;
      } else {
        rvelab_batch batch;
        rvelab_batch_init(&batch, sizeof batch);
        batch.n = 1;
        batch.ids = &id;
        batch.dH = dH.data();
        batch.sigma = sigma.data();
        failed += rvelab_trial(pool, &batch) < 0 || rvelab_commit(pool, 1, &id) < 0;
      }
      row.push_back(sigma);
    }
  };
  std::vector<std::thread> running;
  for (std::size_t k = 0; k < threads; ++k) running.emplace_back([&, k] { work(host.pool, ids[k], k, found[k]); });
  for (std::thread& thread : running) thread.join();
  CHECK(failed == 0);
  for (std::size_t k = 0; k < threads; ++k) {
    std::vector<Nine> expected;
    work(alone.pool, one[k], k, expected);
    CHECK(expected == found[k]);
  }
}
