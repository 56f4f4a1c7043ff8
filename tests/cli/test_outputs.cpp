// Where results go: nothing is written over that was not meant to be, and what could not be written is said.
#include <sys/stat.h>
#include <sys/sysmacros.h>

#include <set>

#include "rvelab/io/hdf5/specimen_file.hpp"
#include "tests/child.hpp"
#include "tests/program.hpp"

using namespace rvelab::test;
using Catch::Matchers::Contains;

namespace {

const std::string yade = std::string(RVELAB_TEST_DATA) + "/yade/dense_p20";

/// Commands that write a file, with OUT in the place of its name, and one that succeeds in a minute's hundredth.
struct Writer {
  std::string command;
  std::vector<std::string> inputs;
};

const std::vector<Writer> writers{
    {"import p.csv c.csv m.json -o OUT", {"p.csv", "c.csv", "m.json"}},
    {"pack tiny.toml -o OUT", {"tiny.toml"}},
    {"export S.h5 --format lammps -o OUT", {"S.h5"}},
    {"export S.h5 --format lammps-data -o OUT", {"S.h5"}},
    {"export S.h5 --format xdmf -o OUT", {"S.h5"}},
    {"run test.toml --specimen S.h5 -o OUT", {"S.h5", "test.toml"}},
    {"seal S.h5 -o OUT", {"S.h5"}},
};

std::string with(std::string command, const std::string& output) {
  return command.replace(command.find("OUT"), 3, output);
}

/// A folder with an input of each kind.
struct Desk : Workplace {
  Desk() {
    import_packing("dense_p20");
    std::filesystem::copy_file(yade + ".particles.csv", *this / "p.csv");
    std::filesystem::copy_file(yade + ".contacts.csv", *this / "c.csv");
    std::filesystem::copy_file(yade + ".json", *this / "m.json");
    std::ofstream(*this / "test.toml") << "[test]\nname = \"t\"\n[[stage]]\nkind = \"simple_shear\"\nto_strain = 1e-5\n"
                                          "record_every = 1e-5\n";
    std::ofstream(*this / "tiny.toml") << "[pack]\nname = \"tiny\"\nshape = \"disc\"\nnumber = 40\nthickness_m = 0.1\n"
                                          "[grains]\ngrading = \"uniform\"\nsmallest_radius_m = 3e-3\n"
                                          "largest_radius_m = 7e-3\n[target]\npressure_Pa = 100e3\n[contact]\n"
                                          "law = \"linear\"\n[[material]]\nname = \"sand\"\ndensity_kg_m3 = 2650\n"
                                          "young_modulus_Pa = 80e6\nstiffness_ratio = 0.5\nfriction = 0.4\n";
  }
};

}  // namespace

TEST_CASE("what is there is replaced with --force only, and then whole") {
  const Desk here;
  for (const auto& writer : writers) {
    CAPTURE(writer.command);
    std::ofstream(here / "foreign") << "years of work";
    here.refuses(with(writer.command, "foreign"), "foreign: is there already; allowed: a new name");
    CHECK(bytes_of(here / "foreign") == "years of work");
    here.succeeds(with(writer.command, "foreign --force"));
    CHECK(bytes_of(here / "foreign") != "years of work");
    CHECK(!std::filesystem::exists(here / "foreign.tmp"));
    std::filesystem::remove(here / "foreign");
    std::filesystem::remove(here / "foreign.h5");
    here.succeeds(with(writer.command, "foreign"));
    std::filesystem::remove(here / "foreign");
    std::filesystem::remove(here / "foreign.h5");
  }
  // Every file of an export counts, and every specimen of a family.
  std::ofstream(here / "out.json") << "mine";
  here.refuses("export S.h5 --format csv -o out", "out.json: is there already");
  std::ofstream(here / "out.xdmf.h5") << "mine";
  here.refuses("export S.h5 --format xdmf -o out.xdmf", "out.xdmf.h5: is there already");
  std::ofstream(here / "n_2.h5") << "mine";
  here.refuses("pack tiny.toml --count 3 -o n.h5", "n_2.h5: is there already");
  CHECK(!std::filesystem::exists(here / "n_1.h5"));
  for (const char* file : {"out.json", "out.xdmf.h5", "n_2.h5"}) CHECK(bytes_of(here / file) == "mine");
}

TEST_CASE("an input is never replaced, under whatever name, with --force or without") {
  const Desk here;
  std::filesystem::create_directory(here / "sub");
  for (const auto& writer : writers) {
    for (const std::string& input : writer.inputs) {
      const std::string before = bytes_of(here / input);
      std::filesystem::create_symlink("../" + input, here / "sub/link");
      std::filesystem::create_hard_link(here / input, here / "sub/other");
      for (const std::string& name : std::vector<std::string>{input, "./" + input, "sub/link", "sub/other"}) {
        for (const char* force : {"", " --force"}) {
          CAPTURE(writer.command, name, force);
          here.refuses(with(writer.command, name) + force, "would replace " + input);
          CHECK(bytes_of(here / input) == before);
          CHECK(!std::filesystem::exists(here / (input + ".journal")));
        }
      }
      std::filesystem::remove(here / "sub/link");
      std::filesystem::remove(here / "sub/other");
    }
  }
  // Neither is one that has the name which is written to meanwhile.
  std::filesystem::rename(here / "S.h5", here / "R.h5.tmp");
  const std::string before = bytes_of(here / "R.h5.tmp");
  here.refuses("run test.toml --specimen R.h5.tmp -o R.h5", "would replace R.h5.tmp");
  here.refuses("export R.h5.tmp --format lammps -o R.h5", "would replace R.h5.tmp");
  CHECK(bytes_of(here / "R.h5.tmp") == before);
}

TEST_CASE("links are followed, and folders, pipes and devices never replaced") {
  const Desk here;
  std::filesystem::create_directory(here / "store");
  REQUIRE(mkfifo((here / "pipe").c_str(), 0600) == 0);
  const bool device = mknod((here / "device").c_str(), S_IFCHR | 0600, makedev(1, 3)) == 0;  // as root only
  for (const auto& writer : writers) {
    CAPTURE(writer.command);
    std::filesystem::create_symlink("store/real", here / "link");  // to nothing yet
    here.succeeds(with(writer.command, "link"));
    CHECK(std::filesystem::is_symlink(here / "link"));
    CHECK(std::filesystem::is_regular_file(here / "store/real"));
    here.refuses(with(writer.command, "link"), "link: is there already");
    CHECK(here.run(with(writer.command, "link --force")).code == 0);
    CHECK(std::filesystem::is_symlink(here / "link"));
    std::filesystem::remove(here / "link");
    std::filesystem::remove(here / "link.h5");
    std::filesystem::remove(here / "store/real");
    for (const char* force : {"", " --force"}) {
      here.refuses(with(writer.command, "store") + force, "store: is a folder; allowed: a file");
      here.refuses(with(writer.command, "pipe") + force, "pipe: is a pipe; allowed: a file");
      if (device) here.refuses(with(writer.command, "device") + force, "device: is a device");
    }
    CHECK(std::filesystem::is_fifo(here / "pipe"));
    CHECK(std::filesystem::is_directory(here / "store"));
    if (device) CHECK(std::filesystem::is_character_file(here / "device"));
  }
}

TEST_CASE("programs that write one name at the same time each write it whole, or are told") {
  const Desk here;
  for (int round = 0; round < 5; ++round) {
    std::vector<std::unique_ptr<Child>> children;
    for (int k = 0; k < 4; ++k) {
      const std::string end = std::to_string(k);
      children.push_back(std::make_unique<Child>(
          std::vector<std::string>{RVELAB_PROGRAM, "import", yade + ".particles.csv", yade + ".contacts.csv",
                                   yade + ".json", "-o", here / "one.h5", "--force"},
          here / ("out" + end), here / ("err" + end)));
    }
    for (auto& child : children) CHECK(child->wait() == 0);
    CHECK(rvelab::io::read_specimen(here / "one.h5").grains.size() == 400);
    CHECK(!std::filesystem::exists(here / "one.h5.tmp"));
  }
}

TEST_CASE("output that cannot be written is one line and exit code 1, for every subcommand") {
  if (!std::filesystem::exists("/dev/full")) return;
  const Desk here;
  here.succeeds("run test.toml --specimen S.h5 -o R.h5");
  here.succeeds("import p.csv c.csv m.json -o T.h5");
  for (const std::string command :
       {"--help", "--version", "run --help", "pack tiny.toml -o a.h5", "import p.csv c.csv m.json -o b.h5",
        "inspect S.h5", "inspect S.h5 --json", "probe S.h5 --method linear", "run test.toml --specimen S.h5 -o c.h5",
        "recover R.h5 -o d.h5", "seal S.h5 -o e.h5", "compare S.h5 T.h5", "compare S.h5 a.h5",
        "export S.h5 --format csv -o f", "protocols", "protocols biaxial", "keys", "keys --json"}) {
    CAPTURE(command);
    expect_one_line(here.run(command + " >/dev/full"), 1, "standard output could not be written");
  }
}

TEST_CASE("beyond the limit of a file's size every writer says so in one line and leaves nothing") {
  const Desk here;
  for (const auto& writer : writers) {
    CAPTURE(writer.command);
    expect_one_line(here.shell("ulimit -f 8; '" RVELAB_PROGRAM "' " + with(writer.command, "big")), 1,
                    "could not be written", "File too large");
    CHECK(!std::filesystem::exists(here / "big"));
    CHECK(!std::filesystem::exists(here / "big.tmp"));
  }
}

TEST_CASE("without memory every subcommand says so in one line with exit code 1, wherever it ran out") {
  const Desk here;
  here.succeeds("pack tiny.toml -o t.h5");
  const auto outcome_at = [&](const std::string& command, long number) {
    for (const char* made : {"o", "o.h5", "o.journal", "o_1", "o_2"}) std::filesystem::remove(here / made);
    return here.shell("RVELAB_NO_MEMORY_FROM=" + std::to_string(number) +
                      " LD_PRELOAD=" RVELAB_MEMORY_SHIM " ASAN_OPTIONS=verify_asan_link_order=0 '" RVELAB_PROGRAM "' " +
                      command);
  };
  for (const std::string command : {"inspect t.h5", "export t.h5 --format xdmf -o o", "import p.csv c.csv m.json -o o",
                                    "run test.toml --specimen t.h5 -o o", "compare t.h5 S.h5",
                                    "pack tiny.toml -o o --threads 2", "pack tiny.toml -o o --count 2 --threads 2"}) {
    long number = 1;
    for (int done = 0; done < 2 && number < 100'000; number += 1 + number / 12) {
      const Outcome outcome = outcome_at(command, number);
      CAPTURE(command, number, outcome.errors);
      if (outcome.code == 0 || (command.starts_with("compare") && outcome.code == 1 && outcome.errors.empty())) {
        ++done;  // it needs no more than this
        continue;
      }
      expect_one_line(outcome, 1);
      CHECK_THAT(outcome.errors, Contains("memory") || Contains("bad_alloc"));
      for (const char* half : {"o.tmp", "o_1.tmp", "o_2.tmp"}) CHECK(!std::filesystem::exists(here / half));
      // What a family has made before is kept, in whole.
      for (const char* made : {"o_1", "o_2"}) {
        if (std::filesystem::exists(here / made)) CHECK(here.run("inspect " + std::string(made)).code == 0);
      }
      // What a run has recorded before is kept, in whole.
      if (std::filesystem::exists(here / "o.journal")) CHECK(here.run("recover o -o kept --force").code == 0);
    }
    CHECK(number > 100);
  }
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // their runtimes need more than any limit
TEST_CASE("threads that are not to be had are said in one line with exit code 1") {
  const Desk here;
  for (const std::string command :
       {"pack tiny.toml -o o --threads 64", "pack tiny.toml -o o --count 40 --threads 40"}) {
    CAPTURE(command);
    expect_one_line(here.shell("ulimit -v 150000; '" RVELAB_PROGRAM "' " + command), 1, "lower --threads");
  }
}
#endif
