// The pool: any number of workers gives the same bits, RVEs rest when they are forgotten, costs are counted.
#include <algorithm>
#include <cmath>

#include "rvelab/pool/slots.hpp"
#include "rvelab/pool/status.hpp"
#include "rvelab/solver/quasi_static/constants.hpp"
#include "tests/abi/host.hpp"

using namespace rvelab;
using namespace rvelab::test;

TEST_CASE("A batch gives the same bits on 1, 2, 3, 5 and 8 workers") {
  constexpr std::size_t discs = 20, spheres = 6;
  std::vector<std::vector<Nine>> expected;
  std::vector<std::vector<std::byte>> states;
  for (const int workers : {1, 2, 3, 5, 8}) {
    rvelab_pool_def def = default_def(workers);
    def.flags = RVELAB_POOL_COUNTED_IDS;  // snapshots hold tokens
    Host host(def);
    auto ids = host.spawn(packed(Shape::disc, 6), discs);
    const auto more = host.spawn(packed(Shape::sphere, 4), spheres);
    ids.insert(ids.end(), more.begin(), more.end());
    Trials trials(ids);
    trials.ask_for_all();
    Increments plane(1), space(2, 3);
    for (std::size_t round = 0; round < 6; ++round) {
      for (std::size_t k = 0; k < ids.size(); ++k)
        trials.dH[k] = (k < discs ? plane : space).next(k % 7 == 0 ? 1e-3 : 1e-5);
      if (round == 1) trials.batch.tangent = nullptr;
      trials.batch.dt = round < 4 ? 0 : 1e-4;
      REQUIRE_OK(rvelab_trial(host.pool, &trials.batch));
      if (round % 2 == 0) REQUIRE_OK(rvelab_commit(host.pool, 0, nullptr));
      if (workers == 1)
        expected.push_back(trials.sigma);
      else
        CHECK(trials.sigma == expected[round]);
    }
    for (std::size_t k = 0; k < ids.size(); k += 5) {
      const auto state = host.snapshot(ids[k]);
      if (workers == 1)
        states.push_back(state);
      else
        CHECK(state == states[k / 5]);
    }
  }
}

TEST_CASE("An RVE called again at once stays awake; one that is forgotten, or was at work for long, rests") {
  Host host;
  const auto ids = host.spawn(packed(Shape::disc, 6), 5);
  const Nine small{1e-7}, large{-3e-2};
  for (const std::int64_t id : ids) CHECK(host.info(id).bytes_working == 0);
  for (int round = 0; round < 4; ++round)
    for (const std::int64_t id : ids) {
      host.apply(id, small);
      CHECK(host.info(id).bytes_working > 0);
    }
  for (const std::int64_t id : ids) CHECK(host.info(id).bytes_working > 0);
  for (int k = 0; k < 20; ++k) host.apply(ids[0], small);
  CHECK(host.info(ids[0]).bytes_working > 0);
  for (std::size_t k = 1; k < ids.size(); ++k) CHECK(host.info(ids[k]).bytes_working == 0);
  host.apply(ids[0], large);
  CHECK(host.info(ids[0]).bytes_working == 0);

  // With a trial pending an RVE at rest holds two states at most.
  Trials trials({ids[0]});
  trials.dH[0] = Nine{3e-2};  // back, which takes more sub-steps than going on
  REQUIRE_OK(rvelab_trial(host.pool, &trials.batch));
  const rvelab_info info = host.info(ids[0]);
  CHECK(info.bytes_working == 0);
  CHECK(info.bytes_trial > 0);
  CHECK(info.bytes_trial <= info.bytes_resting);
  REQUIRE_OK(rvelab_revert(host.pool, 1, &ids[0]));
  CHECK(host.info(ids[0]).bytes_trial == 0);
}

TEST_CASE("Costs count grains times sub-steps, of the copy that rests to show the error and of reverted trials too") {
  Host host;
  const auto ids = host.spawn(packed(Shape::disc, 6), 2);
  std::int64_t cost[2] = {-1, -1};
  REQUIRE_OK(rvelab_cost(host.pool, 2, ids.data(), cost));
  CHECK((cost[0] == 0 && cost[1] == 0));
  const std::int64_t before = host.info(ids[0]).grain_steps;
  const Nine dH{3e-3};  // a start from rest of so many sub-steps that a copy rests once (error_model.hpp)
  host.apply(ids[0], dH);
  const std::int64_t made = host.info(ids[0]).grain_steps - before;
  Trials trials({ids[1]});
  trials.dH[0] = dH;
  for (int k = 0; k < 3; ++k) REQUIRE_OK(rvelab_trial(host.pool, &trials.batch));
  CHECK(host.info(ids[1]).grain_steps == before);
  REQUIRE_OK(rvelab_cost(host.pool, 2, ids.data(), cost));
  CHECK(made % 36 == 0);
  REQUIRE(made >= 36 * constants::check_interval / 2);  // long enough to be measured
  CHECK(cost[0] == made + 36 * constants::check_interval);
  CHECK(cost[1] == 3 * cost[0]);
}

TEST_CASE("Costs count what was discarded, and trials that a commit makes again") {
  rvelab_pool_def def = default_def();
  def.trial_memory = RVELAB_TRIAL_RECOMPUTE;
  Host host(def);
  Trials trials(host.spawn(packed(Shape::disc, 6)));
  std::int64_t once = 0, cost = 0;
  trials.dH[0] = Nine{1e-4};
  REQUIRE_OK(rvelab_trial(host.pool, &trials.batch));
  REQUIRE_OK(rvelab_cost(host.pool, 1, trials.ids.data(), &once));
  CHECK(once > 0);
  REQUIRE_OK(rvelab_commit(host.pool, 1, trials.ids.data()));
  REQUIRE_OK(rvelab_cost(host.pool, 1, trials.ids.data(), &cost));
  CHECK(cost == 2 * once);

  const std::int64_t made = host.info(trials.ids[0]).grain_steps;
  trials.dH[0] = Nine{-0.3, 0, 0, 0, -0.3};  // grains come to overlap by more than is allowed
  CHECK_STATUS(rvelab_trial(host.pool, &trials.batch), RVELAB_DISCARD);
  REQUIRE_OK(rvelab_cost(host.pool, 1, trials.ids.data(), &once));
  CHECK(once > cost);
  CHECK(host.info(trials.ids[0]).grain_steps == made);
}

TEST_CASE("No increment at all, and a rotation, are judged as the path that led to them") {
  for (const double piece : {1e-5, 1e-7}) {  // of 1e-7 some are left to the next sub-step
    Host host;
    Trials trials(host.spawn(packed(Shape::disc, 6)));
    trials.ask_for_all();
    for (int k = 0; k < 40; ++k) {
      trials.dH[0] = Nine{0.3 * piece, 0, 0, 0, -piece};
      const std::int32_t verdict = rvelab_trial(host.pool, &trials.batch);
      REQUIRE_OK(verdict);
      REQUIRE_OK(rvelab_commit(host.pool, 1, trials.ids.data()));
      const double estimate = trials.error_estimate[0];
      const Nine sigma = trials.sigma[0];
      for (const Nine& still : {Nine{}, Nine{-2, 0, 0, 0, -2}}) {  // half a turn
        trials.dH[0] = still;
        CHECK_STATUS(rvelab_trial(host.pool, &trials.batch), verdict);
        CHECK((matrix_of(trials.sigma[0]) - matrix_of(sigma)).norm() <= 1e-12 * matrix_of(sigma).norm());
        CHECK(trials.error_estimate[0] == Approx(estimate));
      }
    }
  }
}

TEST_CASE("A cell that an increment skews beyond double precision is discarded, at rest and at rate") {
  for (const double dt : {0.0, 1e-12})
    for (const double shear : {1e8, 1e10}) {
      Host host;
      Trials trials(host.spawn(packed(Shape::disc, 4)));
      const auto before = host.snapshot(trials.ids[0]);
      trials.batch.dt = dt;
      trials.dH[0][3] = shear;
      CHECK_STATUS(rvelab_trial(host.pool, &trials.batch), RVELAB_DISCARD);
      CHECK(trials.dt_scale[0] == 0.5);
      CHECK(host.snapshot(trials.ids[0]) == before);
    }
}

TEST_CASE("An id that stands twice is a duplicate, whichever token is stale") {
  Host host;
  const std::int64_t id = host.spawn(packed(Shape::disc, 4))[0];
  const std::int64_t committed = host.info(id).token;
  Trials trials({id, id});
  trials.batch.tokens_in = trials.tokens.data();
  for (const auto& tokens : {std::vector<std::int64_t>{77, committed}, {committed, 77}, {77, 77}}) {
    trials.tokens = tokens;
    trials.batch.tokens_in = trials.tokens.data();
    trials.batch.tokens_out = nullptr;
    CHECK_STATUS(rvelab_trial(host.pool, &trials.batch), RVELAB_E_DUPLICATE);
    CHECK_STATUS(rvelab_commit(host.pool, 1, &id), RVELAB_E_NO_TRIAL);
  }
}

TEST_CASE("A tolerance of the pool above one is refused where the pool is made") {
  rvelab_pool_def def = default_def();
  rvelab_pool* pool = nullptr;
  def.tolerance_rel = 2;
  CHECK_STATUS(rvelab_pool_create(&def, &pool), RVELAB_E_INPUT);
  CHECK(std::strstr(rvelab_last_error(), "tolerance_rel is 2") != nullptr);
}

TEST_CASE("info tells of the committed state while a trial is pending") {
  for (const Shape shape : {Shape::disc, Shape::sphere}) {
    const Specimen& start = packed(shape, shape == Shape::disc ? 6 : 4);
    const int d = start.cell.dimension;
    Host host;
    const auto ids = host.spawn(start);
    const rvelab_info before = host.info(ids[0]);
    CHECK((before.dimension == d && before.grains == std::int64_t(start.grains.size()) && before.contacts > 0));
    CHECK(before.volume == Approx(start.cell.volume()));
    CHECK(before.fabric[0] + before.fabric[4] + before.fabric[8] == Approx(1));
    CHECK((before.p > 0 && before.token > 0 && before.inertial_number == 0));
    Trials trials(ids);
    trials.dH[0] = Nine{-1e-3};
    trials.batch.dt = 1e-3;
    REQUIRE_OK(rvelab_trial(host.pool, &trials.batch));
    rvelab_info pending = host.info(ids[0]);
    CHECK(pending.bytes_trial > 0);
    pending.bytes_trial = before.bytes_trial;
    pending.bytes_working = before.bytes_working;
    CHECK(std::memcmp(&pending, &before, sizeof before) == 0);
    REQUIRE_OK(rvelab_commit(host.pool, 1, ids.data()));
    const rvelab_info after = host.info(ids[0]);
    CHECK(after.volume == Approx(before.volume * 0.999));
    CHECK((after.token == trials.tokens[0] && after.inertial_number > 0));
    const Matrix3 sigma = matrix_of(trials.sigma[0]);
    CHECK(after.p == Approx(d == 2 ? -(sigma(0, 0) + sigma(1, 1)) / 2 : -sigma.trace() / 3));
    const auto kozeny = [](double e) { return e * e * e / (1 + e); };
    CHECK(after.permeability_ratio / before.permeability_ratio ==
          Approx(kozeny(after.void_ratio) / kozeny(before.void_ratio)));
  }
}

TEST_CASE("A clone goes on as its source, tokens included") {
  Host host;
  const auto ids = host.spawn(packed(Shape::disc, 6));
  Increments draw(3);
  host.apply(ids[0], draw.next(1e-4));
  Trials trials(ids);
  trials.dH[0] = draw.next(1e-4);
  REQUIRE_OK(rvelab_trial(host.pool, &trials.batch));
  std::int64_t twin = 0;
  REQUIRE_OK(rvelab_clone(host.pool, ids[0], &twin));
  CHECK(host.snapshot(twin) == host.snapshot(ids[0]));
  CHECK(rvelab_commit(host.pool, 1, &twin) == RVELAB_E_NO_TRIAL);  // what is pending is not cloned,
  Trials both({ids[0], twin});
  both.batch.tokens_in = both.tokens.data();
  both.tokens = {trials.tokens[0], trials.tokens[0]};  // but can be accepted
  both.dH[0] = both.dH[1] = draw.next(1e-4);
  REQUIRE_OK(rvelab_trial(host.pool, &both.batch));
  CHECK(same(both.sigma[0], both.sigma[1]));
  CHECK(host.snapshot(twin) == host.snapshot(ids[0]));
}

TEST_CASE("Options of the pool are laid over those of the specimen") {
  rvelab_pool_def def = default_def();
  def.tolerance_rel = 0.03;
  def.tolerance_abs = 2e-4;
  def.max_substeps = 5;
  def.damping = 0.35;
  def.min_height = 0.001;
  Host host(def);
  const auto ids = host.spawn(packed(Shape::disc, 6));
  const Specimen state = host.state(ids[0]);
  CHECK((state.solver.relative_tolerance == 0.03 && state.solver.absolute_tolerance == 2e-4));
  CHECK((state.solver.max_substeps == 5 && state.damping.local == 0.35 && state.solver.min_height == 0.001));
  CHECK(state.damping.local_quasi_static == 0.35);
  Trials trials(ids);
  trials.dH[0] = Nine{5e-3};
  CHECK(rvelab_trial(host.pool, &trials.batch) == RVELAB_DISCARD);
  CHECK((trials.status[0] == RVELAB_DISCARD && trials.dt_scale[0] == 0.5));
  CHECK(std::strstr(rvelab_last_error(), "max_substeps") != nullptr);
  CHECK(Rve(host.state(ids[0])).save() == Rve(state).save());
}

TEST_CASE("A template that is released is stale, its RVEs go on, and no later one has its number") {
  Host host, other;
  const Specimen& start = packed(Shape::disc, 3);
  const std::int64_t first = host.template_of(start), kept = host.template_of(packed(Shape::disc, 4));
  const std::int64_t foreign = other.template_of(start);
  std::int64_t ids[2] = {};
  REQUIRE_OK(rvelab_spawn(host.pool, first, 2, ids));
  const Nine dH = Increments(4).next(1e-4);
  const Nine before = host.apply(ids[0], dH);
  REQUIRE(rvelab_template_release(host.pool, first) == RVELAB_OK);
  CHECK(same(host.apply(ids[1], dH), before));
  const auto refused = [&](std::int32_t status, const char* text) {
    return status == RVELAB_E_ID && std::string(rvelab_last_error()).find(text) != std::string::npos;
  };
  std::int64_t id = 7;
  CHECK(refused(rvelab_spawn(host.pool, first, 1, &id), "it was released"));
  CHECK(refused(rvelab_template_release(host.pool, first), "it was released"));
  for (const std::int64_t none : {std::int64_t(0), std::int64_t(-1), foreign, kept + 1, ids[0]})
    CHECK(refused(rvelab_template_release(host.pool, none), "none of that number"));
  CHECK(id == 7);
  CHECK(rvelab_template_release(nullptr, first) == RVELAB_E_NULL);
  const std::int64_t next = host.template_of(start);
  CHECK((next != first && next != kept));
  REQUIRE_OK(rvelab_spawn(host.pool, kept, 1, &id));
  REQUIRE_OK(rvelab_spawn(host.pool, next, 1, &id));
  CHECK(same(host.apply(id, dH), before));
}

TEST_CASE("A template is not released while another call is at work in the pool") {
  rvelab_pool_def def = default_def();
  struct Task {
    rvelab_pool* pool = nullptr;
    std::int64_t made = 0;
    std::int32_t status = 0;
  } task;
  def.host = &task;
  def.run_tasks = [](void* host, rvelab_task work, void* of, std::int64_t count) {
    Task& asked = *static_cast<Task*>(host);
    asked.status = rvelab_template_release(asked.pool, asked.made);
    for (std::int64_t k = 0; k < count; ++k) work(of, k);
  };
  Host host(def);
  task.pool = host.pool;
  task.made = host.template_of(packed(Shape::disc, 3));
  std::vector<std::int64_t> ids(2);
  REQUIRE_OK(rvelab_spawn(host.pool, task.made, 2, ids.data()));
  Trials trials(ids);
  REQUIRE_OK(rvelab_trial(host.pool, &trials.batch));
  CHECK(task.status == RVELAB_E_BUSY);
  CHECK(rvelab_template_release(host.pool, task.made) == RVELAB_OK);
}

TEST_CASE("A slot whose generations are used up is retired") {
  using namespace rvelab::pool;
  Slots slots;
  const Rve rve(packed(Shape::disc, 3));
  const auto resident = [&] { return std::make_unique<Resident>(Resident{rve, {}}); };
  slots.make_room(1);
  std::vector<std::uint32_t> generations(2, generation_limit - 1);
  Slots worn;
  worn.restore(7, generations, {}, {});
  worn.make_room(1);
  const Id last = Id::of(worn.add(resident()));
  CHECK((last.slot == 1 && last.generation == generation_limit - 1 && last.tag == 7));
  CHECK(last.value() < std::int64_t(1) << 53);
  worn.remove(last.value());
  worn.make_room(1);
  const Id next = Id::of(worn.add(resident()));
  CHECK((next.slot == 2 && next.generation > 0 && next.generation < first_limit));
  CHECK(!is_usable(0));
  CHECK(!is_usable(3u << 20));
}

TEST_CASE("The tangent is the stress that small strains lead to, per strain, and asks for no spin") {
  for (const Shape shape : {Shape::disc, Shape::sphere}) {
    Specimen start = packed(shape, shape == Shape::disc ? 5 : 3);  // even rings counter-rotate without stiffness
    const int d = start.cell.dimension;
    for (Material& material : start.materials) material.friction = 1e6;  // no slip: elastic
    Rve resolved(start);
    resolved.relax(1e-10, 1'000'000);
    Host host;
    const auto ids = host.spawn(resolved.specimen());
    Trials trials(ids);
    trials.ask_for_all();
    REQUIRE_OK(rvelab_trial(host.pool, &trials.batch));  // dH = 0: the tangent of the state
    const std::vector<double> tangent = trials.tangent;
    const int row_of[6] = {0, 1, 2, 1, 0, 0}, column_of[6] = {0, 1, 2, 2, 2, 1};
    double largest = 0;
    for (const double entry : tangent) largest = std::max(largest, std::abs(entry));
    for (int k = 0; k < 6; ++k) {
      const bool out_of_plane = d == 2 && (k == 2 || k == 3 || k == 4);
      Matrix3 strain = Matrix3::Zero();
      strain(row_of[k], column_of[k]) += 0.5;
      strain(column_of[k], row_of[k]) += 0.5;
      Matrix3 ends[2];
      if (!out_of_plane)
        for (const int sign : {-1, 1}) {
          Rve rve = resolved;
          rve.apply(1e-6 * sign * strain, 0);
          rve.relax(1e-10, 1'000'000);
          ends[sign > 0] = rve.stress();
        }
      for (int j = 0; j < 6; ++j) {
        const double found = tangent[std::size_t(6 * j + k)];
        if (out_of_plane || (d == 2 && (j == 2 || j == 3 || j == 4))) {
          CHECK(found == 0);
          continue;
        }
        const Matrix3 change = (ends[1] - ends[0]) / 2e-6;
        const double expected = 0.5 * (change(row_of[j], column_of[j]) + change(column_of[j], row_of[j]));
        CAPTURE(d, j, k);
        CHECK(std::abs(found - expected) < 1e-5 * largest);
      }
    }
  }
}
