// Runs as a user starts, stops and resumes them: folders, signals, threads.
#include <sys/stat.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "rvelab/io/hdf5/seal.hpp"
#include "rvelab/io/hdf5/tree.hpp"
#include "tests/mpm/scene_runs.hpp"
#include "tests/mpm/scenes.hpp"

using namespace mpm::test;
using Catch::Matchers::Contains;
using rvelab::test::bytes_of;
using rvelab::test::Child;
using rvelab::test::Folder;

namespace {

/// A small block that falls on a base.
const std::string block_scene = head("block", "0.25", "0.1") + "[loads]\ngravity_m_s2 = [0, -10]\n" +
                                soil_of("soil", "mohr_coulomb", "2000", "1e6") + region("soil", "[0, 0]", "[1, 1]") +
                                half_space("base", "[0, 0]", "[0, 1]") + "[output]\nwatched_points_m = [[0.5, 0.5]]\n";

struct BlockRuns : SceneRuns {
  BlockRuns() : SceneRuns(block_scene, "block.toml") {}
  int start(const std::string& name, std::vector<std::string> more = {}) const {
    more.insert(more.begin(), {"-j", "1"});
    return SceneRuns::start(name, more);
  }
  double last_time(const std::string& name) const { return history(name).last("time_s"); }
};

}  // namespace

TEST_CASE("runs that are the same have the same bytes in every file") {
  const BlockRuns bench;
  REQUIRE(bench.start("a") == 0);
  std::this_thread::sleep_for(std::chrono::milliseconds(1100));  // stamps count seconds
  REQUIRE(bench.start("b") == 0);
  bench.expect_same("a", "b", 24);
}

TEST_CASE("a run stops where it was asked to as one that succeeded, and says what it took") {
  const BlockRuns bench;
  REQUIRE(bench.start("a", {"--stop-at", "0.05"}) == 0);
  CHECK_THAT(bench.output(), Contains("go on with: rvelab-mpm --resume") && Contains(" s, processor "));
  CHECK(bench.start("b", {"--stop-at", "nan"}) == 2);
  CHECK_THAT(bench.errors(), Contains("--stop-at nan: give a time in s"));
  CHECK(bench.start("b", {"--stop-at", "-1"}) == 2);
  CHECK(bench.run({bench.folder / "block.toml", "-o", bench.folder / "b", "-j", "-2"}) == 2);
  CHECK_THAT(bench.errors(), Contains("-j -2: give a number of threads"));
  CHECK(bench.run({"column_soil", "-o", bench.folder / "c"}) == 2);
  CHECK_THAT(bench.errors(), Contains("column_soil: there is no such file; a scene goes by its path, such as "
                                      "protocols/mpm/column_soil.toml"));
}

TEST_CASE("what a resumed run is told stays told: the scene in its folder is the one that it goes on with") {
  const BlockRuns bench;
  REQUIRE(bench.start("a") == 0);
  REQUIRE(bench.resume("a") == 0);
  CHECK_THAT(bench.output(), Contains("the run is at 0.1 s, and ends at time.duration_s = 0.1"));
  REQUIRE(bench.resume("a", {"--set", "time.duration_s=0.2", "--stop-at", "0.15"}) == 0);
  CHECK(bench.last_time("a") < 0.2);
  REQUIRE(bench.resume("a") == 0);
  CHECK(bench.last_time("a") == 0.2);
  // A scene that the checkpoint is not of is refused, and not kept.
  const auto kept = bytes_of(bench.folder / "a/scene.toml");
  const std::string plane = "boundary=[{name=\"left\", kind=\"roller\", axis=\"x\", at_m=0}]";
  CHECK(bench.resume("a", {"--set", plane}) == 2);
  CHECK_THAT(bench.errors(), Contains("holds 3 reactions, this scene needs 6"));
  CHECK(bench.resume("a", {"--set", "body.base.contact=nodes"}) == 2);
  CHECK_THAT(bench.errors(), Contains("its bodies were met by another contact than in this scene"));
  CHECK(bench.resume("a", {"--set", "grid.cell_m=0.5"}) == 2);
  CHECK_THAT(bench.errors(), Contains("holds 64 points, this scene needs 16"));
  CHECK(bytes_of(bench.folder / "a/scene.toml") == kept);
}

TEST_CASE("what rvelab-mpm echoes of its command line is printable and short") {
  const BlockRuns bench;
  const std::string odd = "a\x1b[31mb\xff", word(9000, 'x');
  std::string words = "x=";
  while (words.size() < 9000) words += "a b ";
  const std::vector<std::vector<std::string>> all{{odd, "-o", bench.folder / "c"},
                                                  {word, "-o", bench.folder / "c"},
                                                  {bench.scene, "-o", bench.folder / "c", "--set", odd + word + "=1"},
                                                  {bench.scene, "-o", bench.folder / "c", "--set", words},
                                                  {bench.scene, "-o", bench.folder / "c", "--case", odd + word},
                                                  {bench.scene, "-o", bench.folder / "c", "--no" + odd + word},
                                                  {bench.scene, "-o", bench.folder / "c", "-j", odd + words},
                                                  {"--resume", odd + word}};
  for (const auto& arguments : all) {
    CHECK(bench.run(arguments) == 2);
    const std::string said = bench.errors();
    CAPTURE(said);
    CHECK(said.starts_with("rvelab-mpm: "));
    CHECK(said.size() < 500);
    CHECK(std::count_if(said.begin(), said.end(), [](char c) { return c < ' ' || c > '~'; }) == 1);
  }
}

TEST_CASE("a checkpoint that was edited and sealed again is refused by what is no state") {
  const BlockRuns bench;
  REQUIRE(bench.start("a", {"--stop-at", "0.05"}) == 0);
  const auto path = bench.folder / "a/checkpoint.h5";
  const auto whole = bytes_of(path);
  const auto refusal = [&](std::size_t column, double value) {
    std::string bytes = whole.substr(0, whole.size() - rvelab::io::seal_bytes);
    std::vector<std::byte> image(bytes.size());
    std::memcpy(image.data(), bytes.data(), bytes.size());
    const auto tree = rvelab::io::hdf5::read(path, image);  // holds the bytes of its datasets
    const auto rows = tree.objects.at("/points").dataset->bytes;
    const std::size_t at = bytes.find(std::string(reinterpret_cast<const char*>(rows.data()), 11 * sizeof value));
    REQUIRE(at != std::string::npos);
    std::memcpy(bytes.data() + at + column * sizeof value, &value, sizeof value);
    std::memcpy(image.data(), bytes.data(), bytes.size());
    const auto seal = rvelab::io::seal_of(image);
    bytes.append(reinterpret_cast<const char*>(seal.data()), seal.size());
    std::ofstream(path, std::ios::binary) << bytes;
    CHECK(bench.resume("a", {"-j", "1"}) == 2);
    return bench.errors();
  };
  CHECK_THAT(refusal(1, std::nan("")), Contains("checkpoint.h5: points[0, 1] = nan; allowed: a finite number"));
  CHECK_THAT(refusal(9, -1), Contains("checkpoint.h5: mass of points[0] = -1; allowed: > 0 kg"));
  CHECK_THAT(refusal(10, 0), Contains("checkpoint.h5: volume of points[0] = 0; allowed: > 0 m^3"));
}

TEST_CASE("a folder that lost something is refused with the remedy") {
  const BlockRuns bench;
  REQUIRE(bench.start("a", {"--stop-at", "0.05"}) == 0);
  const auto history = bench.folder / "a/history.csv", checkpoint = bench.folder / "a/checkpoint.h5";
  const auto rows = bytes_of(history), state = bytes_of(checkpoint);
  std::ofstream(history) << rows.substr(0, rows.size() / 2);
  CHECK(bench.resume("a") == 2);
  CHECK_THAT(bench.errors(), Contains("history.csv: has " + std::to_string(rows.size() / 2) + " bytes") &&
                                 Contains("put the whole file back"));
  CHECK(bytes_of(history).size() == rows.size() / 2);
  std::ofstream(history) << rows;
  std::ofstream(checkpoint, std::ios::binary) << state.substr(0, state.size() / 2);
  CHECK(bench.resume("a") == 2);
  CHECK_THAT(bench.errors(), Contains("checkpoint.h5: ") && Contains("copy it again"));
  std::filesystem::remove(checkpoint);
  CHECK(bench.resume("a") == 2);
  CHECK_THAT(bench.errors(), Contains("holds no checkpoint.h5") && Contains("give the folder of a run"));
}

TEST_CASE(
    "a flipped bit in what a run is resumed from is refused, and what a kill left behind a checkpoint is cut off") {
  const BlockRuns bench;
  REQUIRE(bench.start("a", {"--stop-at", "0.05"}) == 0);
  const auto resume = [&] { return bench.resume("a", {"-j", "1"}); };
  for (const char* name : {"checkpoint.h5", "history.csv", "watched.csv", "scene.toml"}) {
    const auto path = bench.folder / ("a/" + std::string(name));
    const auto whole = bytes_of(path);
    for (std::size_t k = 0; k < 12; ++k) {
      auto damaged = whole;
      damaged[(2 * k + 1) * whole.size() / 24] ^= char(1 << k % 8);
      std::ofstream(path, std::ios::binary) << damaged;
      CAPTURE(name, k);
      CHECK(resume() == 2);
      CHECK_THAT(bench.errors(),
                 Contains(std::string(name) + ": ") &&
                     Contains(name == std::string("checkpoint.h5") ? "copy it again" : "start the run again"));
    }
    std::ofstream(path, std::ios::binary) << whole;
  }
  // A scene that was changed by hand is no longer the one of the run.
  const auto scene = bench.folder / "a/scene.toml";
  const auto text = bytes_of(scene);
  std::ofstream(scene) << text << "\n";
  CHECK(resume() == 2);
  CHECK_THAT(bench.errors(), Contains("change a scene by --resume with --set"));
  std::ofstream(scene) << text;
  std::ofstream(bench.folder / "a/history.csv", std::ios::app) << "0.05,12,nan,";
  REQUIRE(resume() == 0);
  REQUIRE(bench.start("b") == 0);
  for (const char* name : {"history.csv", "watched.csv", "checkpoint.h5"}) {
    CHECK(bytes_of(bench.folder / ("a/" + std::string(name))) == bytes_of(bench.folder / ("b/" + std::string(name))));
  }
}

TEST_CASE("a scene or a checkpoint that is no regular file is refused at once") {
  const BlockRuns bench;
  const auto pipe = bench.folder / "pipe";
  REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  Child child({RVELAB_MPM_PROGRAM, pipe, "-o", bench.folder / "a"}, bench.folder / "out", bench.folder / "err");
  CHECK(child.wait_for(20) == 2);
  CHECK_THAT(bench.errors(), Contains("pipe: is not a regular file"));
  REQUIRE(bench.start("b", {"--stop-at", "0.05"}) == 0);
  std::filesystem::remove(bench.folder / "b/checkpoint.h5");
  REQUIRE(mkfifo((bench.folder / "b/checkpoint.h5").c_str(), 0600) == 0);
  Child resumed({RVELAB_MPM_PROGRAM, "--resume", bench.folder / "b"}, bench.folder / "out", bench.folder / "err");
  CHECK(resumed.wait_for(20) == 2);
  CHECK_THAT(bench.errors(), Contains("checkpoint.h5: is not a regular file"));
}

TEST_CASE("a full disc fails the run by name, and what was whole stays whole") {
  const BlockRuns bench;
  const auto run_with = [&](const std::string& blocks, const std::string& name) {  // of 512 bytes, for each file
    Child child({"/bin/sh", "-c", "trap '' XFSZ; ulimit -f " + blocks + "; exec \"$0\" \"$@\"", RVELAB_MPM_PROGRAM,
                 bench.folder / "block.toml", "-j", "1", "-o", bench.folder / name},
                bench.folder / "out", bench.folder / "err");
    return child.wait();
  };
  CHECK(run_with("20", "a") == 1);
  CHECK_THAT(bench.errors(), Contains("a/points_0000.h5: could not be written") && Contains("free space"));
  CHECK_FALSE(std::filesystem::exists(bench.folder / "a/points_0000.h5.tmp"));
  // Only the list of frames outgrows this; frames and checkpoint go on where there is room again.
  CHECK(run_with("80", "c") == 1);
  CHECK_THAT(bench.errors(), Contains("c/points.xdmf: could not be written"));
  REQUIRE(bench.resume("c") == 0);
  REQUIRE(bench.start("whole") == 0);
  for (const auto* name : {"points_0020.h5", "points.xdmf", "history.csv"}) {
    CHECK(bytes_of(bench.folder / ("c/" + std::string(name))) ==
          bytes_of(bench.folder / ("whole/" + std::string(name))));
  }
}

TEST_CASE("a first signal stops a run with a checkpoint, and threads that the system refuses are told") {
  const BlockRuns bench;
  {
    Child child({RVELAB_MPM_PROGRAM, bench.folder / "block.toml", "-o", bench.folder / "a", "-j", "1", "--set",
                 "time.duration_s=1e4"},
                bench.folder / "out", bench.folder / "err");
    for (int k = 0; k < 6000 && !std::filesystem::exists(bench.folder / "a/points_0000.h5"); ++k) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    child.signal(SIGTERM);
    CHECK(child.wait() == 130);
    CHECK(std::filesystem::exists(bench.folder / "a/checkpoint.h5"));
  }
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // their runtimes need more than any limit
  Child child({"/bin/sh", "-c", "ulimit -v 1000000; exec \"$0\" \"$@\"", RVELAB_MPM_PROGRAM,
               bench.folder / "block.toml", "-o", bench.folder / "b", "-j", "500"},
              bench.folder / "out", bench.folder / "err");
  CHECK(child.wait_for(60) == 2);
  CHECK_THAT(bench.errors(), Contains("500 threads: the system starts no more than ") && Contains("lower --threads"));
#endif
}
