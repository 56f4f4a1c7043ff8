// The store of a running test: what it refuses, what it keeps, what it publishes and when.
#include "rvelab/io/journal/record_store.hpp"

#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include <filesystem>

#include "random_specimen.hpp"
#include "rvelab/io/hdf5/file.hpp"
#include "rvelab/io/journal/recorded_test.hpp"
#include "same_contents.hpp"
#include "tests/catch.hpp"
#include "tests/io/record_files.hpp"

using namespace rvelab;
using namespace rvelab::test;
using Catch::Matchers::Contains;

namespace {

const io::RunStart start{"biaxial", "[test]\nname = \"biaxial\"\n", {"isotropic", "shear"}, random_specimen(1)};

records::Checkpoint checkpoint_after(std::size_t records) {
  records::Checkpoint checkpoint = random_checkpoint(static_cast<unsigned>(records));
  checkpoint.progress.stage = 1;
  checkpoint.progress.phase = 1;
  checkpoint.progress.records = static_cast<std::int64_t>(records);
  checkpoint.progress.probes = 0;
  checkpoint.progress.first_grain_steps = 0;
  checkpoint.specimen.state.grain_steps = 1000 * records;
  return checkpoint;
}

/// Twelve records with a checkpoint, and perhaps publishing, after each fourth; then it ends as a killed run does.
void record_some(const std::string& path, double checkpoint_every) {
  const pid_t child = fork();
  if (child == 0) {
    const records::TestResult result = random_result(3, 12);
    auto* store = new io::RecordStore(path, start, io::IfExists::refuse, checkpoint_every);
    for (std::size_t k = 0; k < 12; ++k) {
      store->put(result.records[k]);
      if (k % 4 == 3) store->offer([&] { return checkpoint_after(k + 1); });
    }
    store->put_snapshot(8, random_specimen(8));
    _exit(0);
  }
  int status = -1;
  waitpid(child, &status, 0);
  REQUIRE(status == 0);
}

constexpr double at_once = 1e-9, never = 1e9;

}  // namespace

TEST_CASE("before the first record there is no file, and a run that kept nothing leaves none") {
  const Folder folder;
  {
    io::RecordStore store(folder / "r.h5", start, io::IfExists::refuse, at_once);
    store.offer([] { return checkpoint_after(0); });
    CHECK(!std::filesystem::exists(folder / "r.h5"));
    CHECK(std::filesystem::exists(folder / "r.h5.journal"));
    store.put(random_result(2).records[0]);
    store.offer([] { return checkpoint_after(1); });
    CHECK(std::filesystem::exists(folder / "r.h5"));
  }
  { io::RecordStore store(folder / "q.h5", start, io::IfExists::refuse); }
  CHECK(!std::filesystem::exists(folder / "q.h5.journal"));
}

TEST_CASE("a finished test is one complete file and nothing beside it") {
  const Folder folder;
  records::TestResult result = random_result(4);
  result.stages = start.stages;
  {
    io::RecordStore store(folder / "r.h5", start, io::IfExists::refuse, at_once);
    for (const records::Record& record : result.records) store.put(record);
    for (const records::ProbeResult& probe : result.probes) store.put(probe);
    store.finish(result, random_specimen(5));
  }
  CHECK(std::distance(std::filesystem::directory_iterator(folder / ""), {}) == 1);
  const io::RecordedTest read = io::read_recorded_test(folder / "r.h5");
  CHECK(read.complete);
  CHECK(differences(read.result, result) == 0);
  CHECK(differences(read.checkpoint.specimen, random_specimen(5)) == 0);
  CHECK(io::Hdf5File::open(folder / "r.h5").read<std::uint8_t>("/complete")[0] == 1);
  // Gone on with, there is nothing to do; of another protocol or specimen, it is refused.
  CHECK(io::RecordStore(folder / "r.h5", start, io::IfExists::resume).complete());
  CHECK(std::distance(std::filesystem::directory_iterator(folder / ""), {}) == 1);
  io::RunStart other = start;
  other.protocol_text = "[test]\nname = \"triaxial\"\n";
  CHECK_THAT(input_error([&] { io::RecordStore(folder / "r.h5", other, io::IfExists::resume); }),
             Contains("another protocol") && Contains("biaxial") && Contains("triaxial") && Contains("--force"));
  other = start;
  other.specimen.grains.radius[3] = -other.specimen.grains.radius[3];
  CHECK_THAT(input_error([&] { io::RecordStore(folder / "r.h5", other, io::IfExists::resume); }),
             Contains("another specimen"));
  CHECK(differences(test::read_records(folder / "r.h5"), result) == 0);
}

TEST_CASE("what is there is refused without --force or --resume, and by a name for both") {
  const Folder folder;
  record_some(folder / "a.h5", at_once);
  record_some(folder / "b.h5", never);
  REQUIRE(std::filesystem::exists(folder / "a.h5"));
  REQUIRE(!std::filesystem::exists(folder / "b.h5"));
  for (const std::string name : {"a.h5", "b.h5"}) {
    const std::string before = bytes_of(folder / (name + ".journal"));
    CHECK_THAT(input_error([&] { io::RecordStore(folder / name, start, io::IfExists::refuse); }),
               Contains(name) && Contains("--resume") && Contains("--force"));
    CHECK(bytes_of(folder / (name + ".journal")) == before);
    io::RecordStore overwritten(folder / name, start, io::IfExists::overwrite);
    CHECK(!std::filesystem::exists(folder / name));
    CHECK(overwritten.test().result.records.empty());
    CHECK(!overwritten.checkpoint());
  }
}

TEST_CASE("two writers: the second is refused at once, and the first goes on") {
  const Folder folder;
  io::RecordStore first(folder / "r.h5", start, io::IfExists::refuse);
  first.put(random_result(2).records[0]);
  for (const auto existing : {io::IfExists::overwrite, io::IfExists::resume}) {
    CHECK_THAT(input_error([&] { io::RecordStore(folder / "r.h5", start, existing); }), Contains("another rvelab"));
  }
  first.put(random_result(2).records[1]);
  CHECK(test::read_records(folder / "r.h5").records.size() == 2);
}

TEST_CASE("a killed test is gone on with from its last checkpoint, with all its records kept") {
  const Folder folder;
  for (const double every : {at_once, never}) {
    CAPTURE(every);
    const std::string path = folder / (every == at_once ? "a.h5" : "b.h5");
    record_some(path, every);
    const records::TestResult written = random_result(3, 12);
    CHECK(test::read_records(path).records.size() == 12);
    if (every == at_once) CHECK(!io::read_recorded_test(path).complete);
    io::RecordStore store(path, start, io::IfExists::resume, never);
    CHECK(store.test().result.records.size() == 12);
    CHECK(store.test().snapshots.size() == 1);
    REQUIRE(store.checkpoint().has_value() == (every == at_once));
    const std::size_t from = store.checkpoint() ? 12 : 0;
    if (store.checkpoint()) CHECK(differences(*store.checkpoint(), checkpoint_after(12)) == 0);
    // Records that are made again are not written again.
    const auto size = std::filesystem::file_size(path + ".journal");
    for (std::size_t k = from; k < 12; ++k) store.put(written.records[k]);
    CHECK(std::filesystem::file_size(path + ".journal") == size);
    store.put(random_result(9).records[0]);
    CHECK(test::read_records(path).records.size() == 13);
  }
}

TEST_CASE("if other bits are computed than before, what was made from there on is no longer the test's") {
  const Folder folder;
  record_some(folder / "r.h5", never);
  const records::TestResult written = random_result(3, 12);
  io::RecordStore store(folder / "r.h5", start, io::IfExists::resume, never);
  store.put(written.records[0]);
  store.put(random_result(9).records[0]);
  CHECK(store.test().snapshots.empty());
  CHECK(test::read_records(folder / "r.h5").records.size() == 2);
}

TEST_CASE("without its journal, or with a damaged one, a test goes on from its published file") {
  const Folder folder;
  for (const std::string damage : {"gone", "cut", "only its header"}) {
    CAPTURE(damage);
    const std::string path = folder / (damage + ".h5");
    record_some(path, at_once);
    const std::string journal = bytes_of(path + ".journal");
    // Two more records after the last checkpoint were in the journal alone.
    if (damage == "gone") std::filesystem::remove(path + ".journal");
    if (damage == "cut") write_bytes(path + ".journal", journal.substr(0, journal.size() * 2 / 3));
    if (damage == "only its header") write_bytes(path + ".journal", journal.substr(0, 16));
    CHECK(test::read_records(path).records.size() == 12);
    {
      io::RecordStore store(path, start, io::IfExists::resume, never);
      REQUIRE(store.checkpoint());
      CHECK(differences(*store.checkpoint(), checkpoint_after(12)) == 0);
      CHECK(store.test().result.records.size() == 12);
    }
    // Now the journal holds everything again.
    std::filesystem::remove(path);
    CHECK(test::read_records(path).records.size() == 12);
    CHECK(differences(io::read_recorded_test(path).checkpoint, checkpoint_after(12)) == 0);
  }
  // Damaged at its start, with nothing published: said, and not thrown away.
  record_some(folder / "d.h5", never);
  std::string journal = bytes_of(folder / "d.h5.journal");
  journal[200] = static_cast<char>(journal[200] ^ 1);
  write_bytes(folder / "d.h5.journal", journal);
  CHECK_THAT(input_error([&] { io::RecordStore(folder / "d.h5", start, io::IfExists::resume); }),
             Contains("d.h5.journal"));
  CHECK(bytes_of(folder / "d.h5.journal") == journal);
}

TEST_CASE("a complete file with a journal left beside it is complete") {
  const Folder folder;
  record_some(folder / "r.h5", never);
  std::filesystem::copy_file(folder / "r.h5.journal", folder / "left");
  {
    io::RecordStore store(folder / "r.h5", start, io::IfExists::resume, never);
    store.finish(random_result(3, 12), random_specimen(5));
  }
  std::filesystem::copy_file(folder / "left", folder / "r.h5.journal");
  CHECK(io::read_recorded_test(folder / "r.h5").complete);
  CHECK(io::RecordStore(folder / "r.h5", start, io::IfExists::resume).complete());
  CHECK(!std::filesystem::exists(folder / "r.h5.journal"));
}

TEST_CASE("old checkpoints do not fill the disc") {
  const Folder folder;
  const records::TestResult result = random_result(6, 3);
  records::Checkpoint checkpoint{{}, random_specimen(7, 3000, 6000)};
  static_cast<Interactions&>(checkpoint.specimen) = {};
  checkpoint.progress.stage = 1;
  checkpoint.progress.phase = 1;
  {
    io::RecordStore store(folder / "r.h5", start, io::IfExists::refuse, at_once);
    for (const records::Record& record : result.records) store.put(record);
    store.put_snapshot(2, random_specimen(8));
    std::uintmax_t largest = 0, one = 0;
    for (int k = 0; k < 30; ++k) {
      checkpoint.progress.step = k;
      store.offer([&] { return checkpoint; });
      const auto size = std::filesystem::file_size(folder / "r.h5.journal");
      largest = std::max(largest, size);
      if (k == 0) one = size;
    }
    CHECK(one * 30 > (24 << 20));
    CHECK(largest < (18 << 20));
    CHECK(store.test().snapshots.size() == 1);
    CHECK(differences(io::read_snapshot(store.test().snapshots[0]), random_specimen(8)) == 0);
  }
  std::filesystem::remove(folder / "r.h5");
  const io::RecordedTest read = io::read_recorded_test(folder / "r.h5");
  CHECK(read.result.records.size() == 3);
  CHECK(read.checkpoint.progress.step == 29);
  CHECK(differences(read.checkpoint, checkpoint) == 0);
}
