// Trials, tokens and commits: whatever a host tries on the way, the state is that of the committed path, bit for bit.
#include "tests/abi/host.hpp"

using namespace rvelab;
using namespace rvelab::test;

TEST_CASE("rvelab_apply gives the bits of Rve::apply") {
  for (const Shape shape : {Shape::disc, Shape::sphere})
    for (const double dt : {0.0, 1e-4}) {
      const Specimen& start = packed(shape, shape == Shape::disc ? 6 : 4);
      Rve rve(start);
      Host host;
      const auto ids = host.spawn(start);
      Increments draw(3, start.cell.dimension);
      for (int k = 0; k < 30; ++k) {
        const Nine dH = draw.next(k % 10 == 9 ? 2e-3 : 1e-5);
        const Nine expected = nine_of(rve.apply(matrix_of(dH), dt).stress);
        CHECK(same(host.apply(ids[0], dH, dt), expected));
      }
      CHECK(Rve(host.state(ids[0])).save() == rve.save());
    }
}

TEST_CASE("A trial made again gives the same bits, and what is asked for changes none of them") {
  for (const Shape shape : {Shape::disc, Shape::sphere})
    for (const int memory : {RVELAB_TRIAL_KEEP, RVELAB_TRIAL_RECOMPUTE})
      for (const double size : {1e-6, 1e-3}) {  // beyond 100 sub-steps the RVE rests with its trial pending
        rvelab_pool_def def = default_def();
        def.trial_memory = memory;
        Host host(def);
        const Specimen& start = packed(shape, shape == Shape::disc ? 6 : 4);
        Trials trials(host.spawn(start));
        const auto before = host.snapshot(trials.ids[0]);
        trials.dH[0] = Increments(5, start.cell.dimension).next(size);
        REQUIRE_OK(rvelab_trial(host.pool, &trials.batch));
        const Nine first = trials.sigma[0];
        CHECK(Rve(host.state(trials.ids[0])).save() == Rve(start).save());
        trials.ask_for_all();
        for (int k = 0; k < 3; ++k) {
          if (k == 1) REQUIRE_OK(rvelab_revert(host.pool, 1, trials.ids.data()));
          if (k == 2) host.info(trials.ids[0]);
          REQUIRE_OK(rvelab_trial(host.pool, &trials.batch));
          CHECK(same(trials.sigma[0], first));
          CHECK(matrix_of(trials.contact[0]) == matrix_of(first));  // -0 is 0
          CHECK(same(trials.reynolds[0], Nine{}));
        }
        REQUIRE_OK(rvelab_commit(host.pool, 0, nullptr));
        Rve rve(start);
        rve.apply(matrix_of(trials.dH[0]), 0);
        CHECK(Rve(host.state(trials.ids[0])).save() == rve.save());
        CHECK(before != host.snapshot(trials.ids[0]));
        CHECK_STATUS(rvelab_commit(host.pool, 1, trials.ids.data()), RVELAB_E_NO_TRIAL);
      }
}

TEST_CASE("100,000 calls with detours: trials reverted, repeated, older tokens accepted at random") {
  const Specimen& start = packed(Shape::disc, 4);
  for (const int memory : {RVELAB_TRIAL_KEEP, RVELAB_TRIAL_RECOMPUTE}) {
    rvelab_pool_def def = default_def();
    def.trial_memory = memory;
    Host host(def);
    const auto ids = host.spawn(start, 2);
    const std::int64_t winding = ids[0], straight = ids[1];
    Increments draw(11);
    Trials trials({winding});
    trials.batch.tokens_in = trials.tokens.data();
    struct Made {
      std::int64_t token;
      Nine dH, sigma;
      double dt;
    };
    std::vector<Made> made;  // since the last commit
    std::int64_t committed = host.info(winding).token;
    int calls = 0, replayed = 0;
    bool equal = true;
    const auto follow = [&](const Made& accepted) {
      equal = equal && same(host.apply(straight, accepted.dH, accepted.dt), accepted.sigma);
      committed = accepted.token;
      made.clear();
    };
    const int wanted = memory == RVELAB_TRIAL_KEEP ? 100'000 : 20'000;
    while (calls < wanted) {
      const auto choice = draw.below(8);
      if (choice == 0 && !made.empty()) {
        REQUIRE_OK(rvelab_revert(host.pool, 1, &winding));
        continue;
      }
      if (choice == 1 && !made.empty()) {  // a commit hook, after which the last trial is the state
        const std::int32_t status = rvelab_commit(host.pool, 1, &winding);
        if (status == RVELAB_E_NO_TRIAL) continue;
        REQUIRE(status == RVELAB_OK);
        follow(made.back());
        continue;
      }
      if (choice == 2) host.info(winding);
      trials.tokens[0] = committed;
      if (choice >= 5 && !made.empty()) {  // an older trial, or the last, is accepted
        const std::size_t kept = std::min<std::size_t>(made.size(), 16);
        const Made accepted = made[made.size() - 1 - draw.below(kept)];
        replayed += accepted.token != made.back().token;
        trials.tokens[0] = accepted.token;
        follow(accepted);
      }
      const bool again = choice == 3 && !made.empty();
      trials.dH[0] = again ? made[0].dH : draw.next(calls % 150 == 0 ? 2e-3 : 1e-6);
      trials.batch.dt = again ? made[0].dt : draw.below(20) == 0 ? 1e-5 : 0;
      REQUIRE_OK(rvelab_trial(host.pool, &trials.batch));
      ++calls;
      if (again) equal = equal && same(trials.sigma[0], made[0].sigma);
      made.push_back({trials.tokens[0], trials.dH[0], trials.sigma[0], trials.batch.dt});
    }
    CHECK(equal);
    CHECK(replayed > wanted / 20);
    const auto lists = host.state(straight).state.list.builds;
    CHECK(lists > std::uint64_t(wanted) / 5000);
    CHECK(Rve(host.state(winding)).save() == Rve(host.state(straight)).save());
  }
}
