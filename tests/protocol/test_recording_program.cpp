// `rvelab run` and its files: signals, full discs, places that are taken or cannot be written to, vanished input, what
// a terminal is shown. Every failure is one line, and what was recorded before stays.
#include <pty.h>
#include <sys/resource.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

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
using Catch::Matchers::Contains;

namespace {

/// A folder with a specimen, a protocol that runs for seconds, and one that is done at once.
class Bench {
 public:
  Bench() {
    io::write_specimen(reference_specimen("dense_p20"), folder / "s.h5");
    const std::string begin = "[test]\nname = \"test\"\npressure_Pa = 20e3\n[[stage]]\nkind = \"compression\"\n";
    write_bytes(folder / "long.toml", begin + "to_strain = 0.9\nlateral = \"constant_volume\"\nrecord_every = 1e-4\n");
    write_bytes(folder / "short.toml", begin + "to_strain = 0.004\n");
  }
  std::vector<std::string> command(const std::string& protocol, const std::vector<std::string>& more) const {
    std::vector<std::string> all{RVELAB_PROGRAM, "run", folder / protocol, "--specimen", folder / "s.h5"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  std::unique_ptr<Child> start(const std::vector<std::string>& command, const std::string& fault = "") const {
    return std::make_unique<Child>(command, folder / "out", folder / "err", fault);
  }
  int run(const std::vector<std::string>& command, const std::string& fault = "") const {
    return start(command, fault)->wait();
  }
  std::string errors() const { return bytes_of(folder / "err"); }
  void expect_one_line(const std::string& word) const {
    CHECK_THAT(errors(), Contains("rvelab: ") && Contains(word));
    const std::string text = errors();
    CHECK(std::count(text.begin(), text.end(), '\n') == 1);
  }
  void ends(const std::vector<std::string>& command, int code, const std::string& word) const {
    CHECK(run(command) == code);
    expect_one_line(word);
  }
  /// Waits until a file is there, two minutes at most.
  bool appears(const std::string& path) const {
    for (int k = 0; k < 120'000 && !std::filesystem::exists(path); ++k) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return std::filesystem::exists(path);
  }
  Folder folder;
};

/// Signals a run that has worked for a while; its exit code. It may work for `seconds` more, of processor time: other
/// work on the machine does not count, and the minutes that it may take are there to end the test.
int stopped(Child& run, int number, double seconds = 1) {
  CHECK(run.works_for(0.3));
  const double before = run.processor_seconds();
  run.signal(number);
  const int code = run.wait_for(120);
  CHECK(run.processor_seconds() - before < seconds);
  return code;
}

/// The output of a command on a terminal of its own.
std::string on_a_terminal(std::vector<std::string> command) {
  int terminal = -1;
  const pid_t process = forkpty(&terminal, nullptr, nullptr, nullptr);
  if (process == 0) {
    std::vector<char*> list;
    for (auto& word : command) list.push_back(word.data());
    list.push_back(nullptr);
    execv(list[0], list.data());
    _exit(99);
  }
  std::string text;
  char part[4096];
  for (ssize_t count = 0; (count = read(terminal, part, sizeof part)) > 0;)
    text.append(part, static_cast<size_t>(count));
  close(terminal);
  int status = 0;
  waitpid(process, &status, 0);
  return text;
}

}  // namespace

TEST_CASE("Ctrl-C and SIGTERM end a run within a second of its work, with their codes, and its records are kept") {
  const Bench bench;
  const std::string path = bench.folder / "r.h5";
  std::size_t records = 0;
  for (const int number : {SIGINT, SIGTERM}) {
    const auto run = bench.start(bench.command("long.toml", {"-o", path, "--resume", "--checkpoint-every", "0.2"}));
    REQUIRE(bench.appears(path));
    CHECK(stopped(*run, number) == 128 + number);
    bench.expect_one_line(number == SIGINT ? "stopped by Ctrl-C" : "stopped by SIGTERM");
    CHECK_THAT(bench.errors(), Contains("--resume"));
    const io::RecordedTest left = io::read_recorded_test(path);
    CHECK(!left.complete);
    CHECK(left.result.records.size() > records);
    CHECK(static_cast<std::size_t>(left.checkpoint.progress.records) == left.result.records.size());
    records = left.result.records.size();
  }
  // Without -o nothing is kept, and that is said.
  const auto run = bench.start(bench.command("long.toml", {}));
  CHECK(stopped(*run, SIGINT) == 130);
  bench.expect_one_line("not kept without -o");
}

TEST_CASE("a run that fails leaves the records before the failure, published") {
  const Bench bench;
  const std::string path = bench.folder / "r.h5";
  bench.ends(bench.command("long.toml", {"-o", path, "--set", "solver.max_substeps=60", "--set",
                                         "stage.compression.record_every=0.0003"}),
             1, "max_substeps");
  const io::RecordedTest left = io::read_recorded_test(path);
  CHECK(!left.complete);
  CHECK(left.result.records.size() > 0);
}

TEST_CASE("a full disc, a file too large and a disc that fails end a run with one line, and its last file stays") {
  const Bench bench;
  for (const std::string fault : {"write 40 enospc", "write 41 eio", "fsync 9 eio", "rename 3 enospc"}) {
    CAPTURE(fault);
    const std::string path = bench.folder / "r.h5";
    CHECK(bench.run(bench.command("long.toml", {"-o", path, "--force", "--checkpoint-every", "0.1"}), fault) == 1);
    bench.expect_one_line("could not be written");
    CHECK_THAT(bench.errors(), Contains(fault.ends_with("eio") ? "Input/output error" : "No space left"));
    const io::RecordedTest left = io::read_recorded_test(path);
    CHECK(left.result.records.size() >= 3);
    CHECK(!io::read_journal(io::journal_of(path), [](const io::Frame&) {}).torn);
    CHECK(!std::filesystem::exists(path + ".tmp"));
  }
  // The shell's limit, in a child of its own.
  const std::string path = bench.folder / "limited.h5";
  const std::string line = "ulimit -f 400; exec \"$0\" \"$@\"";
  std::vector<std::string> command{"/bin/bash", "-c", line};
  for (const auto& word : bench.command("long.toml", {"-o", path, "--checkpoint-every", "0.1"}))
    command.push_back(word);
  CHECK(bench.run(command) == 1);
  bench.expect_one_line("File too large");
  CHECK(io::Hdf5File::open(path).has("/records/strain"));
  CHECK(io::read_recorded_test(path).result.records.size() > 1);
}

TEST_CASE("what cannot be used is one line and exit code 2, before anything is made or lost") {
  const Bench bench;
  const std::string path = bench.folder / "r.h5";
  // A folder that nobody may write to, not even root.
  bench.ends(bench.command("short.toml", {"-o", "/proc/r.h5"}), 2, "/proc/r.h5");
  bench.ends(bench.command("short.toml", {"-o", bench.folder / "s.h5/r.h5"}), 2, "does not exist");
  for (const std::string option : {"--force", "--resume"}) {
    bench.ends(bench.command("short.toml", {option}), 2, option + " is given without -o");
  }
  CHECK(bench.run(bench.command("short.toml", {"-o", path, "--force", "--resume"})) == 2);
  CHECK(!std::filesystem::exists(path));

  REQUIRE(bench.run(bench.command("short.toml", {"-o", path})) == 0);
  CHECK(!std::filesystem::exists(path + ".journal"));
  const std::string before = bytes_of(path);
  bench.ends(bench.command("short.toml", {"-o", path}), 2, "--force");
  bench.ends(bench.command("long.toml", {"-o", path, "--resume"}), 2, "another protocol");
  // A mistake in the protocol's overrides is found before --force removes anything.
  CHECK(bench.run(bench.command("short.toml", {"-o", path, "--force", "--set", "material.mud.friction=1"})) == 2);
  bench.ends(bench.command("short.toml", {"-o", path, "--resume"}), 0, "is complete; nothing was run");
  CHECK(bytes_of(path) == before);
  std::filesystem::copy_file(path, bench.folder / "before.h5");
  CHECK(bench.run(bench.command("short.toml", {"-o", path, "--force"})) == 0);
  CHECK(first_different_dataset(bench.folder / "before.h5", path).empty());

  // Vanished input.
  std::filesystem::remove(bench.folder / "s.h5");
  bench.ends(bench.command("short.toml", {"-o", path, "--force"}), 2, "s.h5: no such file");
  CHECK(std::filesystem::exists(path));
}

TEST_CASE("a second run into the same file is refused while the first goes on") {
  const Bench bench;
  const std::string path = bench.folder / "r.h5";
  const auto first = bench.start(bench.command("long.toml", {"-o", path}));
  REQUIRE(bench.appears(path + ".journal"));
  for (const std::string option : {"--force", "--resume"}) {
    Child second(bench.command("long.toml", {"-o", path, option}), bench.folder / "out2", bench.folder / "err2");
    CHECK(second.wait() == 2);
    CHECK_THAT(bytes_of(bench.folder / "err2"), Contains("another rvelab is writing it"));
  }
  Child third({RVELAB_PROGRAM, "recover", path}, bench.folder / "out2", bench.folder / "err2");
  CHECK(third.wait() == 2);
  CHECK(stopped(*first, SIGTERM) == 143);
}

TEST_CASE("the folder of a running test vanishes: one line, exit code 1") {
  const Bench bench;
  std::filesystem::create_directory(bench.folder / "sub");
  const std::string path = bench.folder / "sub/r.h5";
  const auto run = bench.start(bench.command("long.toml", {"-o", path, "--checkpoint-every", "0.1"}));
  REQUIRE(bench.appears(path));
  std::filesystem::remove_all(bench.folder / "sub");
  CHECK(run->wait_for(120) == 1);
  bench.expect_one_line("r.h5: cannot be written (No such file or directory)");
}

TEST_CASE("recover makes a file of what a killed run left; inspect and resume need none") {
  const Bench bench;
  const std::string path = bench.folder / "r.h5", undisturbed = bench.folder / "u.h5";
  REQUIRE(bench.run(bench.command("short.toml", {"-o", undisturbed})) == 0);
  // Killed in the middle of its seventh write: header, begin, then records.
  CHECK(bench.run(bench.command("short.toml", {"-o", path}), "write 7 kill 0.5") == 137);
  CHECK(!std::filesystem::exists(path));
  const auto ask = [&](std::vector<std::string> words) {
    words.insert(words.begin(), RVELAB_PROGRAM);
    words.push_back("--json");
    REQUIRE(bench.run(words) == 0);
    return nlohmann::json::parse(bytes_of(bench.folder / "out"));
  };
  CHECK(ask({"inspect", path})["records"] == 4);
  CHECK(ask({"inspect", path})["complete"] == 0);
  CHECK(ask({"recover", path, "-o", bench.folder / "copy.h5"})["records"] == 4);
  CHECK(!std::filesystem::exists(path));
  CHECK(bench.run({RVELAB_PROGRAM, "recover", path, "-o", bench.folder / "copy.h5"}) == 2);
  const auto recovered = ask({"recover", path});
  CHECK(recovered["complete"] == 0);
  CHECK(recovered["records_in_journal"] == 4);
  CHECK(recovered["journal_bytes_cut_off"] > 0);
  CHECK(io::Hdf5File::open(path).shape("/records/strain") == io::Shape64{4});
  CHECK(bench.run(bench.command("short.toml", {"-o", path, "--resume"})) == 0);
  CHECK(first_different_dataset(undisturbed, path).empty());
  CHECK(ask({"recover", path})["complete"] == 1);
  CHECK(bench.run({RVELAB_PROGRAM, "recover", bench.folder / "none.h5"}) == 2);
  bench.expect_one_line("none.h5");
}

TEST_CASE("a terminal is shown strain, stress ratio, speed and time left; a pipe is not") {
  const Bench bench;
  // Some seconds of work: the line appears after a fifth of one.
  const auto command = bench.command(
      "short.toml", {"--set", "stage.compression.record_every=1e-5", "--set", "stage.compression.to_strain=0.03"});
  const std::string shown = on_a_terminal(command);
  CHECK_THAT(shown, Contains("compression  strain ") && Contains("q/p ") && Contains("M grain-steps/s") &&
                        Contains(" left") && Contains("\r\x1b[K"));
  CHECK_THAT(shown, Contains("peak_strain"));
  CHECK(bench.run(command) == 0);
  CHECK(bench.errors().empty());
}

TEST_CASE(
    "a terminal is shown how the tests of a calibration get on, and that records will not be kept; a pipe is not") {
  const Bench bench;
  const std::vector<std::string> command{RVELAB_PROGRAM,
                                         "calibrate",
                                         bench.folder / "short.toml",
                                         "--specimen",
                                         bench.folder / "s.h5",
                                         "--pressures",
                                         "20e3,20.1e3",
                                         "--set",
                                         "stage.compression.record_every=1e-5",
                                         "--set",
                                         "stage.compression.to_strain=0.03"};
  const std::string shown = on_a_terminal(command);
  CHECK_THAT(shown, Contains(" of 2 tests done") && Contains("p = 20") && Contains("strain ") &&
                        Contains("M grain-steps/s") && Contains(" left") && Contains("\r\x1b[K"));
  CHECK_THAT(shown, Contains("friction_angle_deg"));
  CHECK(bench.run(command) == 0);
  CHECK(bench.errors().empty());
  CHECK_THAT(on_a_terminal(bench.command("short.toml", {})), Contains("the records will not be kept: no -o R.h5"));
}

TEST_CASE("snapshots stand in the file as specimens that can be opened") {
  const Bench bench;
  const std::string path = bench.folder / "r.h5";
  REQUIRE(bench.run(bench.command("short.toml", {"-o", path, "--set", "output.snapshots_every=3"})) == 0);
  const io::RecordedTest test = io::read_recorded_test(path);
  REQUIRE(test.snapshots.size() == 3);
  CHECK(test.snapshots[1].record == 3);
  CHECK(io::read_snapshot(test.snapshots[1]).grains.size() == 400);
  CHECK(io::Hdf5File::open(path).has("/snapshots/000006/contacts/tangential_force_N"));
}

TEST_CASE("calibrate keeps its records in the same way: refused, stopped, gone on with") {
  const Bench bench;
  const auto calibrate = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words{RVELAB_PROGRAM,
                                   "calibrate",
                                   bench.folder / "short.toml",
                                   "--specimen",
                                   bench.folder / "s.h5",
                                   "-o",
                                   bench.folder / "",
                                   "--pressures",
                                   "20e3,21e3",
                                   "--threads",
                                   "2"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  };
  const std::vector<std::string> slow{"--set", "stage.compression.to_strain=0.2"};
  const auto run = bench.start(calibrate(slow));
  REQUIRE(bench.appears(bench.folder / "R_21000.h5.journal"));
  CHECK(stopped(*run, SIGINT, 2) == 130);  // two tests at once
  bench.expect_one_line("0 of 2 tests complete");
  bench.ends(calibrate(slow), 2, "R_20000.h5");
  bench.ends(calibrate({"--resume"}), 2, "another protocol");  // another strain: another protocol
  REQUIRE(bench.run(calibrate({"--force"})) == 0);
  const std::string first = bytes_of(bench.folder / "R_20000.h5"), printed = bytes_of(bench.folder / "out");
  CHECK(!std::filesystem::exists(bench.folder / "R_20000.h5.journal"));
  std::filesystem::remove(bench.folder / "R_21000.h5");
  REQUIRE(bench.run(calibrate({"--resume"})) == 0);
  CHECK(bytes_of(bench.folder / "R_20000.h5") == first);
  CHECK(printed.substr(0, printed.find("wall_s")) ==
        bytes_of(bench.folder / "out").substr(0, bytes_of(bench.folder / "out").find("wall_s")));
}

TEST_CASE("the plots name `rvelab recover` where there is a journal only") {
  const Bench bench;
  const std::string path = bench.folder / "r.h5";
  CHECK(bench.run(bench.command("short.toml", {"-o", path}), "write 7 after") == 137);
  REQUIRE(std::filesystem::exists(path + ".journal"));
  const std::string plot = RVELAB_SOURCE_DIR "/tools/plot/stress_strain.py";
  CHECK(bench.run({"/usr/bin/python3", "-B", plot, path, "-o", bench.folder / "r.png"}) == 2);
  CHECK_THAT(bench.errors(), Contains("rvelab recover " + path));
}
