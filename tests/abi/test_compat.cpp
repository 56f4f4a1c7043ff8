// Pool files of earlier versions, as tests/data/compat/make_pool.py wrote them and printed what follows from them.
#include "tests/abi/host.hpp"
#include "tests/folder.hpp"

using namespace rvelab;
using namespace rvelab::test;

TEST_CASE("a pool file of every version is read with its ids and tokens, and its steps go on") {
  for (const std::string version : {"1_8"}) {
    CAPTURE(version);
    const Folder folder;
    const std::string file = kept_file(folder, std::string(RVELAB_TEST_DATA) + "/compat/pool_" + version + ".h5");
    Host host;
    REQUIRE_OK(rvelab_pool_read(host.pool, file.c_str()));
    std::vector<std::int64_t> ids(3);
    std::int64_t n = 0;
    REQUIRE_OK(rvelab_ids(host.pool, 3, ids.data(), &n));
    CHECK(n == 3);
    CHECK(ids == std::vector<std::int64_t>{8796160131073, 8796160131075, 8796160131076});
    Nine stress{};
    CHECK_STATUS(rvelab_apply(host.pool, 8796093022210, stress.data(), 0, stress.data()), RVELAB_E_ID);  // released
    for (const std::int64_t id : ids) CHECK(host.info(id).token == 2);
    Trials next(ids);
    next.tokens.assign(3, 3);  // of two trials from that state the first, which is made again
    next.batch.tokens_in = next.tokens.data();
    const auto step = [](std::size_t k, double one) {
      return Nine{k == 1 ? one : 0, one, 0, 0, k == 2 ? -one : 0, 0, 0, 0, 0};
    };
    std::vector<Specimen> states;
    for (std::size_t k = 0; k < 3; ++k) {
      next.dH[k] = step(k, 4e-5);
      states.push_back(host.state(ids[k]));
    }
    REQUIRE_OK(rvelab_trial(host.pool, &next.batch));
    // Printed by 1.8: with as many sub-steps the stresses are the same, only their number differs.
    const double expected[3][3] = {{-196542.71420004684, 2573.8855068332105, -196603.83781557955},
                                   {-193737.04221840424, 2674.2476048991944, -196595.9682130681},
                                   {-196564.61259327747, 2663.4511209151906, -199423.50653096524}};
    const long substeps[3][2] = {{8, 12}, {12, 22}, {12, 22}};
    for (std::size_t k = 0; k < 3; ++k) {
      CAPTURE(k);
      Matrix3 stress[2];
      for (const std::size_t round : {0, 1}) {  // the trial of token 3, and the one after it
        states[k].solver.fixed_substeps = substeps[k][round];
        Rve rve(states[k]);
        stress[round] = rve.apply(matrix_of(step(k, round == 0 ? 2e-5 : 4e-5)), 0).stress;
        states[k] = rve.specimen();
      }
      CHECK(stress[1](0, 0) == Approx(expected[k][0]).epsilon(1e-12));
      CHECK(stress[1](0, 1) == Approx(expected[k][1]).epsilon(1e-12));
      CHECK(stress[1](1, 1) == Approx(expected[k][2]).epsilon(1e-12));
      const double allowed = 1e-2 * (stress[1] - stress[0]).norm() - 0.5e-4 * stress[1].trace();
      CHECK((matrix_of(next.sigma[k]) - stress[1]).norm() <= allowed);
    }
  }
}
