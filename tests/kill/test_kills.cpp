// Killed runs (kill -9), half of them inside a write to the journal or a publish: every file opens, nothing that was
// recorded is lost, and the run, gone on with, ends equal to the undisturbed one.
//
// RVELAB_KILLS=1000 build/release/bin/test_kill makes a thousand of them; without it there are 50.
#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <mutex>
#include <optional>
#include <random>
#include <thread>

#include "rvelab/io/hdf5/specimen_file.hpp"
#include "rvelab/io/journal/journal.hpp"
#include "rvelab/io/journal/recorded_test.hpp"
#include "tests/catch.hpp"
#include "tests/child.hpp"
#include "tests/io/random_specimen.hpp"
#include "tests/io/same_contents.hpp"
#include "tests/reference_specimen.hpp"

using namespace rvelab;
using namespace rvelab::test;

namespace {

/// Stages that give every pair cement and water.
const std::string cement_and_water =
    "[[stage]]\nkind = \"cement\"\nyoung_modulus_Pa = 50e6\ntensile_strength_Pa = 100e3\ncohesion_Pa = 100e3\n"
    "strength_scatter = 0.2\n[[stage]]\nkind = \"water\"\nsuction_Pa = 100\n"
    "[[stage]]\nname = \"again\"\nkind = \"isotropic\"\npressure_Pa = 22e3\n";

/// The run that is killed: stages, increments, snapshots, and checkpoints ten times a second. `more`: stages after the
/// first.
class Victim {
 public:
  Victim(const Folder& folder, const std::string& more, const std::string& to_strain)
      : specimen_(folder / "s.h5"), protocol_(folder / "p.toml") {
    io::write_specimen(reference_specimen("dense_p20"), specimen_);
    write_bytes(protocol_,
                "[test]\nname = \"victim\"\n[output]\nsnapshots_every = 25\n"
                "[[stage]]\nkind = \"isotropic\"\npressure_Pa = 22e3\nrecord = true\n" +
                    more +
                    "[[stage]]\nkind = \"probe\"\nmethod = \"linear\"\n"
                    "[[stage]]\nname = \"shear\"\nkind = \"compression\"\nlateral_pressure_Pa = 22e3\nto_strain = " +
                    to_strain + "\n");
  }

  std::vector<std::string> command(const std::string& output) const {
    return {RVELAB_PROGRAM, "run",      protocol_,
            "--specimen",   specimen_,  "-o",
            output,         "--resume", "--checkpoint-every",
            "0.1",          "--set",    "stage.shear.record_every=" + std::to_string(spacing_)};
  }

  /// More records until an undisturbed run takes a second; it is left at `output`. Returns its time, s.
  double run_undisturbed(const Folder& folder, const std::string& output) {
    while (true) {
      const auto begin = std::chrono::steady_clock::now();
      Child child(command(output), folder / "out", folder / "err");
      const int code = child.wait();
      const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
      CAPTURE(bytes_of(folder / "err"));
      REQUIRE(code == 0);
      if (seconds >= 1) return seconds;
      std::filesystem::remove(output);
      spacing_ /= 1.25;
    }
  }

 private:
  std::string specimen_, protocol_;
  double spacing_ = 5e-4;
};

/// Somewhere inside the writing: any byte of a frame or of R.h5.tmp, and either side of fsync, rename and unlink.
std::string random_fault(std::mt19937& random) {
  const auto below = [&](int limit) { return std::uniform_int_distribution<int>(0, limit - 1)(random); };
  const std::string side = below(2) == 0 ? " before" : " after";
  switch (below(6)) {
    case 0:
      return "fsync " + std::to_string(1 + below(8)) + side;
    case 1:
      return "rename " + std::to_string(1 + below(3)) + side;
    case 2:
      return "unlink " + std::to_string(1 + below(4)) + side;
    default:
      return "write " + std::to_string(1 + below(60)) + " kill " +
             std::to_string(std::uniform_real_distribution<double>(0, 1)(random));
  }
}

/// What the files of a killed run hold; none if there is nothing yet. Throws if one of them does not open.
std::optional<io::RecordedTest> left_by(const std::string& path) {
  if (std::filesystem::exists(path)) {
    const auto file = io::Hdf5File::open(path);  // once: a file of many snapshots has thousands of entries
    for (const auto& entry : file.entries())
      if (entry.type == "float64") file.read<double>(entry.name);
    return io::read_recorded_test(path);
  }
  bool begun = false;
  io::read_journal(io::journal_of(path), [&](const io::Frame&) { begun = true; });
  return begun ? std::optional(io::read_recorded_test(path)) : std::nullopt;
}

struct Tally {
  std::atomic<int> kills{0}, aimed{0}, runs{0};
  std::mutex mutex;
  std::vector<std::string> failures;
  void fail(const std::string& text) {
    const std::lock_guard lock(mutex);
    failures.push_back(text);
  }
};

/// One run that is killed up to six times and then ends. "" or what went wrong.
std::string kill_and_resume(const Victim& victim, const Folder& folder, const std::string& reference, double seconds,
                            unsigned seed, int most_kills, Tally& tally) {
  const std::string output = folder / "r.h5", errors = folder / "err";
  std::mt19937 random(seed);
  std::size_t records = 0;
  for (int kills = 0; kills < most_kills;) {
    const bool aimed = kills % 2 == 0;
    const std::string fault = aimed ? random_fault(random) : "";
    Child child(victim.command(output), folder / "out", errors, fault);
    const double when = std::uniform_real_distribution<double>(0, 0.3 * seconds)(random);
    int code = aimed ? child.wait() : child.wait_for(when);
    if (code == -1) {
      child.signal(SIGKILL);
      code = child.wait();
    }
    if (code == 0) break;  // it ended before its time had come
    if (code != 128 + SIGKILL) return "exit code " + std::to_string(code) + " " + fault + ": " + bytes_of(errors);
    ++kills;
    ++tally.kills;
    tally.aimed += aimed ? 1 : 0;
    const auto left = left_by(output);
    const std::size_t now = left ? left->result.records.size() : 0;
    if (now < records) {
      return std::to_string(records) + " records became " + std::to_string(now) + " by " + (aimed ? fault : "a kill");
    }
    records = now;
  }
  Child last(victim.command(output), folder / "out", errors);
  if (const int code = last.wait(); code != 0) return "exit code " + std::to_string(code) + ": " + bytes_of(errors);
  ++tally.runs;
  if (std::filesystem::exists(io::journal_of(output))) return "the journal is left";
  const std::string different = first_different_dataset(reference, output);
  return different.empty() ? "" : different + " differs from the undisturbed run";
}

/// RVELAB_KILLS, or `kills` of them, in many runs of a victim.
void kill_often(const std::string& stages, const std::string& to_strain, int kills) {
  if (const char* const wanted = std::getenv("RVELAB_KILLS")) kills = std::atoi(wanted);
  REQUIRE(kills > 0);
  const Folder folder;
  Victim victim(folder, stages, to_strain);
  const std::string reference = folder / "reference.h5";
  const double seconds = victim.run_undisturbed(folder, reference);
  {
    // Undisturbed means without resuming and checkpoints, too.
    auto plain = victim.command(folder / "plain.h5");
    plain.erase(plain.begin() + 7, plain.begin() + 10);
    REQUIRE(plain[6] == folder / "plain.h5");
    REQUIRE(Child(plain, folder / "out", folder / "err").wait() == 0);
    REQUIRE(first_different_dataset(reference, folder / "plain.h5").empty());
  }

  Tally tally;
  std::atomic<unsigned> next_seed{1};
  const auto work = [&] {
    while (tally.kills < kills) {
      const unsigned seed = next_seed++;
      const Folder own;
      std::string wrong;
      try {
        wrong = kill_and_resume(victim, own, reference, seconds, seed, std::min(6, kills - tally.kills), tally);
      } catch (const std::exception& error) {
        wrong = error.what();
      }
      if (!wrong.empty()) tally.fail("run " + std::to_string(seed) + ": " + wrong);
    }
  };
  std::vector<std::thread> workers;
  const unsigned cores = std::max(1u, std::thread::hardware_concurrency());
  for (unsigned k = 0; k < std::max(2u, std::min(cores, 8u)); ++k) workers.emplace_back(work);
  for (auto& worker : workers) worker.join();
  std::cout << tally.kills << " kills, " << tally.aimed << " of them inside a write or publish, of " << tally.runs
            << " runs of " << seconds << " s: " << tally.failures.size() << " failures" << std::endl;
  for (const std::string& failure : tally.failures) FAIL_CHECK(failure);
  CHECK(tally.kills >= kills);
  CHECK(tally.aimed * 2 >= kills);
}

}  // namespace

TEST_CASE("killed at any moment, a run loses nothing that was recorded and ends as the undisturbed one", "[slow]") {
  kill_often("", "0.08", 50);
}

TEST_CASE("so does a run whose grains have bonds, which break, and bridges of water", "[slow]") {
  kill_often(cement_and_water, "0.006", 12);
}
