// Record files: the records bitwise, the end state as a specimen, and a layout that is the documented one.
#include "rvelab/io/journal/recorded_test.hpp"

#include <algorithm>
#include <map>
#include <sstream>

#include "random_specimen.hpp"
#include "rvelab/io/hdf5/file.hpp"
#include "rvelab/io/hdf5/specimen_file.hpp"
#include "rvelab/io/journal/record_journal.hpp"
#include "rvelab/io/journal/recorded_test.hpp"
#include "rvelab/io/version.hpp"
#include "tests/catch.hpp"
#include "tests/io/record_files.hpp"

using namespace rvelab;
using namespace rvelab::test;
using Catch::Matchers::Contains;

TEST_CASE("records and end state come back from their file bit for bit") {
  const Folder folder;
  const std::string protocol = "[test]\nname = \"biaxial\"\n";
  for (unsigned seed = 1; seed <= 4; ++seed) {
    const records::TestResult written = random_result(seed);
    const Specimen end = random_specimen(seed);
    test::write_records(written, end, protocol, folder / "r.h5");
    const records::TestResult read = test::read_records(folder / "r.h5");
    CHECK(read.records.size() == 23);
    CHECK(differences(written, read) == 0);
    CHECK(differences(end, io::read_specimen(folder / "r.h5")) == 0);
    CHECK(test::read_protocol_text(folder / "r.h5") == protocol);
  }
  CHECK(io::file_kind(folder / "r.h5") == io::FileKind::records);
  CHECK(differences(random_result(1), random_result(2)) > 200);
}

TEST_CASE("a test without records is a file all the same") {
  const Folder folder;
  test::write_records(random_result(5, 0), random_specimen(5), "", folder / "r.h5");
  CHECK(test::read_records(folder / "r.h5").records.empty());
}

TEST_CASE("a specimen file has no records, and says so") {
  const Folder folder;
  io::write_specimen(random_specimen(6), folder / "s.h5");
  CHECK(io::file_kind(folder / "s.h5") == io::FileKind::specimen);
  CHECK_THAT(input_error([&] { test::read_records(folder / "s.h5"); }), Contains("s.h5"));
}

TEST_CASE("provenance names the version and the compiler, and neither a date nor a host") {
  const Folder folder;
  records::TestResult result = random_result(7);
  test::write_records(result, random_specimen(7), "", folder / "a.h5");
  test::write_records(result, random_specimen(7), "", folder / "b.h5");
  CHECK(bytes_of(folder / "a.h5") == bytes_of(folder / "b.h5"));
  const auto file = io::Hdf5File::open(folder / "a.h5");
  CHECK(file.read_text("/provenance/version") == std::vector<std::string>{io::version});
  CHECK(file.read_text("/provenance/compiler") == std::vector<std::string>{io::compiler()});
  char host[256] = {};
  REQUIRE(gethostname(host, sizeof host - 1) == 0);
  if (std::strlen(host) > 5) CHECK(bytes_of(folder / "a.h5").find(host) == std::string::npos);
}

namespace {

/// Rows of the manual's tables that begin with a name like `wanted`: cells by name.
std::map<std::string, std::vector<std::string>> documented(const std::string& readme, const std::string& first) {
  std::map<std::string, std::vector<std::string>> rows;
  std::istringstream text(readme);
  for (std::string line; std::getline(text, line);) {
    if (!line.starts_with("| " + first)) continue;
    std::vector<std::string> cells;
    std::istringstream row(line.substr(1));
    for (std::string cell; std::getline(row, cell, '|');) {
      const auto begin = cell.find_first_not_of(' '), end = cell.find_last_not_of(' ');
      cells.push_back(begin == std::string::npos ? "" : cell.substr(begin, end - begin + 1));
    }
    rows[cells[0]] = cells;
  }
  return rows;
}

/// Extents as the manual writes them: numbers, and a letter for each that varies. The letters stand for different
/// numbers here, so that one for the other is noticed.
std::string in_readme(const io::Shape64& shape) {
  const std::map<std::uint64_t, std::string> letters{{17, "n"}, {31, "c"}, {23, "r"}, {2, "s"},
                                                     {5, "p"},  {6, "k"},  {7, "v"},  {9, "g"}};
  std::string text;
  for (const auto extent : shape) {
    const auto letter = letters.find(extent);
    text += (text.empty() ? "" : ", ") + (letter == letters.end() ? std::to_string(extent) : letter->second);
  }
  return text;
}

}  // namespace

TEST_CASE("the manual lists exactly the datasets of a file, with their types, shapes and units") {
  const Folder folder;
  io::write_specimen(random_bits(8), folder / "s.h5");
  // The end state of another file stands for a snapshot.
  test::write_records(random_result(8), with_every_interaction(8), "", folder / "whole.h5");
  io::RecordedTest test = io::read_recorded_test(folder / "whole.h5");
  test.complete = false;
  test.checkpoint = random_checkpoint(8);
  test.checkpoint.specimen = with_every_interaction(8);
  const auto snapshot = io::encode_snapshot(12, with_every_interaction(8));
  io::Journal journal(folder / "snapshots");
  journal.begin();
  test.snapshots = {{12, folder / "snapshots", journal.append(io::snapshot_frame, snapshot), snapshot.size()}};
  io::write_recorded_test(test, folder / "r.h5");
  const std::string readme = bytes_of(std::string(RVELAB_SOURCE_DIR) + "/tools/manual/pages/file_format.md");
  auto rows = documented(readme, "/");
  REQUIRE(rows.size() > 60);

  std::map<std::string, io::Hdf5Entry> found;
  for (const auto& entry : io::Hdf5File::open(folder / "s.h5").entries()) found[entry.name] = entry;
  const std::size_t of_a_specimen = found.size();
  // The states of r.h5 have interactions, and bodies know none.
  const auto of_bodies = std::count_if(found.begin(), found.end(), [](const auto& entry) {
    const std::string& name = entry.first;
    return name.starts_with("/bodies/") || name.starts_with("/members/") || name.starts_with("/grains/half_") ||
           name.starts_with("/grains/exponent_") || name == "/state/list/orientations";
  });
  REQUIRE(of_bodies == 15);
  const io::SpecimenOrigin origin{"recipe", 1, 2, 0.5, 0.01, 0.0};
  io::write_specimen(random_bits(8), folder / "packed.h5", &origin);
  for (const auto& entry : io::Hdf5File::open(folder / "packed.h5").entries()) found[entry.name] = entry;
  CHECK(found.size() == of_a_specimen + 8);
  std::size_t states = 0;
  for (const auto& entry : io::Hdf5File::open(folder / "r.h5").entries()) {
    const std::string snapshot_group = "/snapshots/000012";
    const bool is_end = entry.name.starts_with("/specimen/"), is_snapshot = entry.name.starts_with(snapshot_group);
    if (is_end || is_snapshot) {
      // the same layout in either group
      CHECK(found.contains(entry.name.substr(is_end ? std::strlen("/specimen") : snapshot_group.size())));
      ++states;
    } else {
      found[entry.name] = entry;
    }
  }
  // The states have materials of one law: what is left out at zero is left out there.
  constexpr std::size_t of_other_laws = 2;
  CHECK(states == 2 * (of_a_specimen - std::size_t(of_bodies) - of_other_laws));
  for (const auto& [name, entry] : found) {
    CAPTURE(name);
    REQUIRE(rows.contains(name));
    const auto& row = rows[name];
    REQUIRE(row.size() == 5);
    CHECK(row[1] == entry.type);
    // m, the number of materials, is 3 as a vector's extent is; k, the components of a 3D stiffness, are 6.
    const std::string shape = name.starts_with("/materials/")  ? "m"
                              : name == "/provenance/packages" ? "2"
                              : name == "/test/quantities"     ? "q"
                                                               : in_readme(entry.shape);
    // Interactions of each law are as many as contacts here.
    const bool adhesive = name.starts_with("/jkr_") || name.starts_with("/dmt_");
    const std::string count = name.find("bonds/") != std::string::npos ? "b"
                              : name.starts_with("/bridges/")          ? "w"
                              : adhesive                               ? "a"
                                                                       : "c";
    CHECK(row[2] == (shape.starts_with("c") ? count + shape.substr(1) : shape));
    CHECK(row[3] == entry.units);
    CHECK(!row[4].empty());
  }
  for (const auto& [name, row] : rows) {
    CAPTURE(name);
    CHECK(found.contains(name));
  }
  std::vector<std::string> attributes;
  for (const auto& [name, row] : documented(readme, "format")) attributes.push_back(name);
  CHECK(io::Hdf5File::open(folder / "s.h5").attributes() == attributes);
  CHECK(io::Hdf5File::open(folder / "r.h5").attributes() == attributes);

  test::write_records(random_result(8), random_specimen(8), "", folder / "c.h5");
  for (const auto& entry : io::Hdf5File::open(folder / "c.h5").entries())
    CHECK(!entry.name.starts_with("/checkpoint/"));
}

TEST_CASE("an incomplete test comes back with its checkpoint and its snapshots bit for bit") {
  const Folder folder;
  test::write_records(random_result(9), random_specimen(9), "[test]", folder / "whole.h5");
  CHECK(io::read_recorded_test(folder / "whole.h5").complete);
  io::RecordedTest test = io::read_recorded_test(folder / "whole.h5");
  test.complete = false;
  test.checkpoint = random_checkpoint(10);
  test.result.wall_seconds = test.checkpoint.progress.wall_seconds;
  test.provenance.packages = {"a 1", "b 2"};
  test.provenance.specimen_crc32c = 77;
  const auto snapshot = io::encode_snapshot(4, random_specimen(11));
  {
    io::Journal journal(folder / "snapshots");
    journal.begin();
    test.snapshots = {{4, folder / "snapshots", journal.append(io::snapshot_frame, snapshot), snapshot.size()}};
  }
  io::write_recorded_test(test, folder / "r.h5");
  const io::RecordedTest read = io::read_recorded_test(folder / "r.h5");
  CHECK(!read.complete);
  CHECK(differences(test.result, read.result) == 0);
  CHECK(differences(test.checkpoint, read.checkpoint) == 0);
  CHECK(read.provenance.packages == test.provenance.packages);
  CHECK(read.provenance.specimen_crc32c == 77);
  REQUIRE(read.snapshots.size() == 1);
  CHECK(read.snapshots[0].record == 4);
  CHECK(differences(random_specimen(11), io::read_snapshot(read.snapshots[0])) == 0);
  CHECK(test::read_records(folder / "whole.h5").probes.size() == 5);
}
