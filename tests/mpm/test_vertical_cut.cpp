// A vertical cut in grains: it stands by cement or suction and fails when that is gone; changes of a scene at their
// times.
#include <sstream>

#include "tests/mpm/scene_runs.hpp"

using Catch::Matchers::Contains;
using rvelab::test::bytes_of;
using rvelab::test::Child;

namespace {

/// The shipped scene, coarse, with specimens of few grains.
struct CutRuns : mpm::test::SceneRuns {
  CutRuns() : SceneRuns(bytes_of(RVELAB_SOURCE_DIR "/protocols/mpm/vertical_cut.toml"), "cut.toml") {
    Child pack({RVELAB_PROGRAM, "pack", RVELAB_SOURCE_DIR "/protocols/pack_cut.toml", "-o", folder / "cut.h5", "--set",
                "pack.number=36"},
               folder / "out", folder / "err");
    REQUIRE(pack.wait() == 0);
  }
  int start(const std::string& name, std::vector<std::string> more = {}) const {
    more.insert(more.begin(), {"-j", "1", "--case", "coarse", "--specimens", folder / "."});
    return SceneRuns::start(name, more);
  }
  /// Height over that of the start, m, of the point at the top of the face at a time (its row of watched.csv).
  double sinking(const std::string& name, double at) const {
    std::istringstream rows(bytes_of(folder / (name + "/watched.csv")));
    double first = 0, last = 0;
    std::string row;
    std::getline(rows, row);
    for (bool begun = false; std::getline(rows, row); begun = true) {
      double time = 0, x = 0, y = 0;
      REQUIRE(std::sscanf(row.c_str(), "%lf,%lf,%lf", &time, &x, &y) == 3);
      if (time > at + 1e-9) break;
      last = y;
      if (!begun) first = y;
    }
    return first - last;
  }
};

}  // namespace

TEST_CASE("a vertical cut stands by its cement and fails when it dissolves", "[mpm]") {
  const CutRuns runs;
  REQUIRE(runs.start("cut") == 0);
  CHECK_THAT(runs.output(), Contains("change cementing at 0 s: 20 RVEs") && Contains("change end at 0.3"));
  CHECK(runs.sinking("cut", 0.3) < 0.01);
  CHECK(runs.sinking("cut", 0.8) > 0.15);
  // Without its first change it falls from the start: it is the cement that held it.
  REQUIRE(runs.start("bare", {"--set", "change.cementing.at_s=9", "--set", "change.end.at_s=10", "--set",
                              "time.duration_s=0.3"}) == 0);
  CHECK(runs.sinking("bare", 0.3) > 0.05);
}

TEST_CASE("a run with changes that is stopped goes on with the same bits", "[mpm]") {
  const CutRuns runs;
  const std::vector<std::string> brief{"--set", "time.duration_s=0.06",          "--set", "change.end.at_s=0.03",
                                       "--set", "output.checkpoint_every_s=0.02"};
  REQUIRE(runs.start("whole", brief) == 0);
  for (const char* at : {"0.01", "0.045"}) {
    CAPTURE(at);
    const std::string name = std::string("parts") + at;
    auto stopped = brief;
    stopped.insert(stopped.end(), {"--stop-at", at});
    REQUIRE(runs.start(name, stopped) == 0);
    REQUIRE(runs.run({"--resume", runs.folder / name, "-j", "1"}) == 0);
    for (const char* file : {"/history.csv", "/watched.csv"})
      CHECK(bytes_of(runs.folder / (name + file)) == bytes_of(runs.folder / (std::string("whole") + file)));
  }
}

TEST_CASE("changes that cannot be are refused before a step is made", "[mpm]") {
  const CutRuns runs;
  const auto refused = [&](const std::string& assignment, const std::string& words) {
    CAPTURE(assignment);
    CHECK(runs.start("refused", {"--set", assignment}) == 2);
    CHECK_THAT(runs.errors(), Contains(words));
  };
  refused("change.end.material=sand", "allowed: soil");
  refused("change.end.stages='''[[stage]]\nkind = \"dissolve\"\n'''", "radius_left");
  refused("change.end.at_s=-1", "at_s");
  refused("change.end.lower_m=[0, 2]", "upper_m");
}
