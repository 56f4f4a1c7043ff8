// Stopped and gone on with: a test that was left at any moment ends with every bit of the undisturbed one.
#include <atomic>
#include <chrono>
#include <ctime>
#include <thread>

#include "rvelab/error.hpp"
#include "rvelab/protocol/run.hpp"
#include "tests/catch.hpp"
#include "tests/io/random_specimen.hpp"
#include "tests/reference_specimen.hpp"

using namespace rvelab;

namespace {

/// Every kind of stage, with records where they are optional.
const char* const all_stages =
    "[test]\nname = \"all stages\"\n[output]\nsnapshots_every = 4\n"
    "[[stage]]\nname = \"small\"\nkind = \"probe\"\nno_slip = true\n"
    "[[stage]]\nkind = \"isotropic\"\npressure_Pa = 26e3\nrecord = true\n"
    "[[stage]]\nkind = \"probe\"\nmethod = \"linear\"\n"
    "[[stage]]\nkind = \"compression\"\nto_strain = 0.003\nlateral_pressure_Pa = 26e3\n"
    "[[stage]]\nkind = \"relax\"\nrecord = true\n"
    "[[stage]]\nkind = \"simple_shear\"\nto_strain = 0.003\n";

/// Those whose place is more than a number of records: events that lead back, cycles, rows, copies.
const char* const wandering_stages =
    "[test]\nname = \"wandering\"\npressure_Pa = 20e3\n[output]\nquantities = [\"fabric\", \"void_ratio\"]\n"
    "[[stage]]\nname = \"forth\"\nkind = \"simple_shear\"\nto_strain = 0.01\nrecord_every = 2e-4\n"
    "  [[stage.until]]\n  quantity = \"visits\"\n  above = 1\n  then = \"cycles\"\n"
    "  [[stage.until]]\n  quantity = \"q_Pa\"\n  falls_by = 0.5\n  then = \"end\"\n"
    "  [[stage.until]]\n  quantity = \"stress_xy_Pa\"\n  above = 2e3\n"
    "[[stage]]\nname = \"back\"\nkind = \"flow\"\ngradient = {xy = -1}\nto_strain = 2e-4\nrecord_every = 1e-4\n"
    "then = \"forth\"\n"
    "[[stage]]\nname = \"cycles\"\nkind = \"compression\"\nlateral = \"constant_volume\"\nto_strain = 0.01\n"
    "record_every = 2e-4\ncycles = 1\nreverse_at_Pa = 2e3\n"
    "[[stage]]\nkind = \"envelope\"\ndirections = 2\nsize = 1e-5\n"
    "[[stage]]\nkind = \"path\"\nrecords_per_point = 3\ncycles = 2\n"
    "  [[stage.row]]\n  name = \"volume\"\n  strain = {xx = 1, yy = 1}\n"
    "  [[stage.row]]\n  name = \"q\"\n  stress = {xx = 1, yy = -1}\n  to_Pa = [3e3, 0.0]\n";

protocol::Protocol protocol_of(const std::string& text) { return protocol::parse_protocol(text, "test.toml"); }

void expect_same(const protocol::TestRun& a, const protocol::TestRun& b) {
  CHECK(a.complete);
  CHECK(b.complete);
  records::TestResult first = a.result, second = b.result;
  CHECK(first.records.size() == second.records.size());
  CHECK(first.probes.size() == second.probes.size());
  first.wall_seconds = second.wall_seconds = 0;
  CHECK(test::differences(first, second) == 0);
  CHECK(test::differences(a.end_state, b.end_state) == 0);
}

struct Stop {
  records::Checkpoint checkpoint;
  records::TestResult result;
};

/// Runs a test and keeps every moment of it.
protocol::TestRun run_keeping(const protocol::Protocol& protocol, const Specimen& specimen, std::vector<Stop>& stops) {
  protocol::Watch watch;
  watch.on_path_point = [&](const protocol::PathPoint& reached) {
    stops.push_back({reached.checkpoint(), reached.result});
  };
  return protocol::run_protocol(protocol, specimen, watch);
}

}  // namespace

TEST_CASE("a test gone on with from any of its moments ends with every bit of the undisturbed one") {
  const Specimen specimen = reference_specimen("dense_p20");
  const protocol::Protocol protocol = protocol_of(all_stages);
  const protocol::TestRun undisturbed = protocol::run_protocol(protocol, specimen);
  std::vector<Stop> stops;
  expect_same(undisturbed, run_keeping(protocol, specimen, stops));  // taking checkpoints disturbs nothing
  REQUIRE(stops.size() > 18);
  CHECK(undisturbed.result.probes.size() == 2);
  CHECK(undisturbed.result.records.size() == 2 + 7 + 2 + 4);
  std::int32_t stages_seen = 0;
  for (std::size_t k = 0; k < stops.size(); k += k + 6 < stops.size() ? 2 : 1) {
    const records::Progress& progress = stops[k].checkpoint.progress;
    CAPTURE(k, progress.stage, progress.phase, progress.step);
    stages_seen |= 1 << progress.stage;
    expect_same(undisturbed, protocol::resume_protocol(protocol, stops[k].checkpoint, stops[k].result));
  }
  CHECK((stages_seen >> 6 & 1) == 1);  // the moment after the last stage among them
}

TEST_CASE("a test whose stages lead back, turn or copy is gone on with from any of its moments") {
  const Specimen specimen = reference_specimen("dense_p20");
  const protocol::Protocol protocol = protocol_of(wandering_stages);
  const protocol::TestRun undisturbed = protocol::run_protocol(protocol, specimen);
  std::vector<Stop> stops;
  expect_same(undisturbed, run_keeping(protocol, specimen, stops));
  REQUIRE(stops.size() > 30);
  std::int32_t stages_seen = 0;
  for (std::size_t k = 0; k < stops.size(); ++k) {
    const records::Progress& progress = stops[k].checkpoint.progress;
    CAPTURE(k, progress.stage, progress.phase, progress.step, progress.turns);
    stages_seen |= 1 << progress.stage;
    expect_same(undisturbed, protocol::resume_protocol(protocol, stops[k].checkpoint, stops[k].result));
  }
  CHECK(stages_seen == 63);
}

TEST_CASE("a test stopped at any time, within an increment too, ends as the undisturbed one when it is gone on with") {
  const Specimen specimen = reference_specimen("dense_p20");
  const protocol::Protocol protocol = protocol_of(all_stages);
  // Moments are shares of the processor time that the undisturbed run takes: other work on the machine is not in it.
  const std::clock_t begin = std::clock();
  const protocol::TestRun undisturbed = protocol::run_protocol(protocol, specimen);
  const std::clock_t whole = std::clock() - begin;
  int stopped = 0;
  for (int k = 0; k < 8; ++k) {
    std::atomic<bool> stop{false};
    protocol::Watch watch;
    watch.stop = &stop;
    std::atomic<bool> ended{false};
    const std::clock_t moment = std::clock() + whole * (2 * k + 1) / 17;
    std::thread timer([&] {
      while (!ended && std::clock() < moment) std::this_thread::sleep_for(std::chrono::milliseconds(1));
      stop = true;
    });
    protocol::TestRun run = protocol::run_protocol(protocol, specimen, watch);
    ended = true;
    timer.join();
    if (run.complete) continue;
    ++stopped;
    // Bit for bit a moment that the undisturbed run passes, or one within a round of an isotropic stage.
    expect_same(undisturbed, protocol::resume_protocol(protocol, {run.progress, run.end_state}, run.result));
  }
  CHECK(stopped >= 4);
}

TEST_CASE("a relaxation of several slices is gone on with in its middle") {
  // Four packings side by side, far from rest: slices, shorter the more grains there are, end before it does.
  Specimen specimen = reference_specimen("dense_p20");
  const Specimen one = specimen;
  for (int copy = 1; copy < 4; ++copy) {
    const Vector3 shift = one.cell.lattice * Vector3(copy % 2, copy / 2, 0);
    for (std::size_t g = 0; g < one.grains.size(); ++g) {
      specimen.grains.id.push_back(one.grains.id[g] + copy * (one.grains.id.back() + 1));
      specimen.grains.position.push_back(one.grains.position[g] + shift);
      specimen.grains.radius.push_back(one.grains.radius[g]);
      specimen.grains.material.push_back(one.grains.material[g]);
      specimen.grains.velocity.push_back(one.grains.velocity[g]);
      specimen.grains.spin.push_back(one.grains.spin[g]);
    }
  }
  specimen.cell.lattice.leftCols(2) *= 2;
  specimen.contacts.clear();
  specimen.cell.lattice *= 0.995;
  for (auto& position : specimen.grains.position) position *= 0.995;
  const protocol::Protocol protocol = protocol_of(
      "[test]\nname = \"relax\"\n[[stage]]\nkind = \"relax\"\nunbalanced = 1e-8\nmax_steps = 200000\nrecord = "
      "true\n");
  std::vector<Stop> stops;
  protocol::TestRun undisturbed;
  try {
    undisturbed = run_keeping(protocol, specimen, stops);
  } catch (const Error& error) {
    FAIL(error.what());
  }
  REQUIRE(stops.size() >= 2);
  CHECK(stops[0].checkpoint.progress.relaxation_steps > 0);
  CHECK(stops[0].checkpoint.progress.stage == 0);
  for (const Stop& stop : stops)
    expect_same(undisturbed, protocol::resume_protocol(protocol, stop.checkpoint, stop.result));
}

TEST_CASE("physical loading goes on with its rate and its velocities") {
  const Specimen specimen = reference_specimen("dense_p20");
  const protocol::Protocol protocol = protocol_of(
      "[test]\nname = \"fast\"\n[loading]\nmode = \"at_rate\"\ninertial_number = 2e-3\n"
      "[[stage]]\nkind = \"simple_shear\"\nto_strain = 0.004\n"
      "[[stage]]\nkind = \"compression\"\nto_strain = 0.001\nlateral = \"constant_volume\"\n");
  std::vector<Stop> stops;
  const protocol::TestRun undisturbed = run_keeping(protocol, specimen, stops);
  for (const Stop& stop : stops)
    expect_same(undisturbed, protocol::resume_protocol(protocol, stop.checkpoint, stop.result));
}

TEST_CASE("snapshots are the states of every n-th record, and of no other") {
  const Specimen specimen = reference_specimen("dense_p20");
  std::vector<std::pair<std::size_t, Specimen>> snapshots;
  std::vector<Matrix3> stresses;
  protocol::Watch watch;
  watch.on_record = [&](const records::Record& record) { stresses.push_back(record.stress); };
  watch.on_snapshot = [&](std::size_t record, const Specimen& state) { snapshots.emplace_back(record, state); };
  protocol::run_protocol(protocol_of(all_stages), specimen, watch);
  REQUIRE(snapshots.size() == 4);
  for (std::size_t k = 0; k < snapshots.size(); ++k) {
    CHECK(snapshots[k].first == 4 * k);
    const Matrix3 difference = Rve(snapshots[k].second).stress() - stresses[4 * k];
    CHECK(difference.norm() <= 1e-9 * stresses[4 * k].norm());
  }
}

TEST_CASE("a checkpoint that does not fit its protocol is refused") {
  const Specimen specimen = reference_specimen("dense_p20");
  const protocol::Protocol protocol = protocol_of("[test]\nname = \"short\"\n[[stage]]\nkind = \"relax\"\n");
  records::Checkpoint checkpoint{{}, specimen};
  checkpoint.progress.stage = 2;
  CHECK_THROWS_AS(protocol::resume_protocol(protocol, checkpoint, {}), InputError);
  checkpoint.progress.stage = 0;
  checkpoint.progress.records = 1;
  CHECK_THROWS_AS(protocol::resume_protocol(protocol, checkpoint, {}), InputError);
}
