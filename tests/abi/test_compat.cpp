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
    const double one = 4e-5;
    next.dH[0] = {0, one, 0, 0, 0, 0, 0, 0, 0};
    next.dH[1] = {one, one, 0, 0, 0, 0, 0, 0, 0};
    next.dH[2] = {0, one, 0, 0, -one, 0, 0, 0, 0};
    REQUIRE_OK(rvelab_trial(host.pool, &next.batch));
    // Since 1.10 the sub-steps follow the true count of constraints, which files of 1.8 do not know: 1.5e-5 of the
    // stress.
    const double expected[3][3] = {{-196542.71420004684, 2573.8855068332105, -196603.83781557955},
                                   {-193739.9542701108, 2659.6470436558, -196599.0131113649},
                                   {-196567.4158855256, 2656.4913209554, -199426.3986139367}};
    for (std::size_t k = 0; k < 3; ++k) {
      CHECK(next.sigma[k][0] == Approx(expected[k][0]).epsilon(1e-8));
      CHECK(next.sigma[k][1] == Approx(expected[k][1]).epsilon(1e-6));
      CHECK(next.sigma[k][4] == Approx(expected[k][2]).epsilon(1e-8));
    }
  }
}
