// The journal: what was written is read, and of what was cut or changed the longest valid prefix.
#include "rvelab/io/journal/journal.hpp"

#include <sys/resource.h>
#include <sys/wait.h>

#include <algorithm>
#include <filesystem>
#include <regex>

#include "random_specimen.hpp"
#include "rvelab/io/crc32c.hpp"
#include "rvelab/io/hdf5/file.hpp"
#include "rvelab/io/journal/record_journal.hpp"
#include "tests/catch.hpp"

using namespace rvelab;
using namespace rvelab::test;
using Catch::Matchers::Contains;

namespace {

std::span<const std::byte> bytes_in(const std::string& text) { return std::as_bytes(std::span(text)); }

/// A journal of a begun test with `records` records, a checkpoint after the fifth and a probe after the seventh.
std::string journal_of_a_test(const std::string& path, std::size_t records,
                              std::vector<std::uint64_t>* ends = nullptr) {
  const records::TestResult result = random_result(1, records);
  {
    io::Journal journal(path);
    journal.begin();
    journal.append(io::begin_frame, io::encode_begin({"biaxial", "[test]\n", {"shear"}, random_specimen(2)}));
    for (std::size_t k = 0; k < records; ++k) {
      journal.append(io::record_frame, io::encode_record(k, result.records[k]));
      if (k == 4) journal.append(io::checkpoint_frame, io::encode_checkpoint(random_checkpoint(3)));
      if (k == 6) journal.append(io::probe_frame, io::encode_probe(0, result.probes[0]));
      if (ends != nullptr) ends->push_back(journal.size());
    }
  }
  return bytes_of(path);
}

struct Frames {
  std::vector<std::string> payloads;
  io::JournalExtent extent;
};

Frames frames_of(const std::string& path) {
  Frames frames;
  frames.extent = io::read_journal(path, [&](const io::Frame& frame) {
    frames.payloads.emplace_back(reinterpret_cast<const char*>(frame.payload.data()), frame.payload.size());
  });
  return frames;
}

bool is_prefix(const std::vector<std::string>& part, const std::vector<std::string>& whole) {
  return part.size() < whole.size() && std::equal(part.begin(), part.end(), whole.begin());
}

int records_that_differ(const records::TestResult& a, const records::TestResult& b, std::size_t count) {
  records::TestResult first, second;
  first.records.assign(a.records.begin(), a.records.begin() + static_cast<std::ptrdiff_t>(count));
  second.records.assign(b.records.begin(), b.records.begin() + static_cast<std::ptrdiff_t>(count));
  return differences(first, second);
}

}  // namespace

TEST_CASE("CRC-32C has its check value, in one part or in many") {
  const std::string digits = "123456789";
  CHECK(io::crc32c(bytes_in(digits)) == 0xE3069283);
  CHECK(io::crc32c({}) == 0);
  CHECK(io::crc32c(bytes_in(std::string(32, '\0'))) == 0x8A9136AA);  // RFC 3720, B.4
  CHECK(io::crc32c(bytes_in(std::string(32, '\xFF'))) == 0x62A8AB43);
  std::string text;
  for (int k = 0; k < 100; ++k) text += static_cast<char>(37 * k);
  for (std::size_t cut = 0; cut <= text.size(); ++cut) {
    const auto whole = bytes_in(text);
    CHECK(io::crc32c(whole.subspan(cut), io::crc32c(whole.first(cut))) == io::crc32c(whole));
  }
}

TEST_CASE("a test comes back from its journal bit for bit") {
  const Folder folder;
  journal_of_a_test(folder / "j", 12);
  const io::RecordJournal read = io::read_record_journal(folder / "j");
  REQUIRE(read.test);
  CHECK(!read.extent.torn);
  CHECK(read.has_checkpoint);
  CHECK(read.test->result.records.size() == 12);
  CHECK(records_that_differ(read.test->result, random_result(1, 12), 12) == 0);
  CHECK(differences(read.test->checkpoint, random_checkpoint(3)) == 0);
  CHECK(read.test->result.probes.size() == 1);
  CHECK(read.test->result.stages == std::vector<std::string>{"shear"});
  CHECK(read.test->provenance.protocol == "[test]\n");
  CHECK(!io::read_record_journal(folder / "none").extent.exists);
}

TEST_CASE("a journal cut at any byte of its last three records has all records before the cut") {
  const Folder folder;
  std::vector<std::uint64_t> ends;
  const std::string whole = journal_of_a_test(folder / "j", 12, &ends);
  REQUIRE(ends.back() == whole.size());
  const auto frames = frames_of(folder / "j").payloads;
  const records::TestResult written = random_result(1, 12);
  for (std::uint64_t cut = ends[8]; cut < whole.size(); ++cut) {
    write_bytes(folder / "cut", whole.substr(0, cut));
    const std::size_t expected = cut < ends[9] ? 9 : cut < ends[10] ? 10 : 11;
    const Frames read = frames_of(folder / "cut");
    REQUIRE(read.extent.valid_bytes == ends[expected - 1]);
    REQUIRE(read.extent.torn == (cut != ends[expected - 1]));
    REQUIRE(is_prefix(read.payloads, frames));
    if (cut % 16 > 0 && cut != ends[expected - 1]) continue;  // a whole test takes longer to read
    const io::RecordJournal test = io::read_record_journal(folder / "cut");
    REQUIRE(test.test->result.records.size() == expected);
    REQUIRE(records_that_differ(test.test->result, written, expected) == 0);
  }
}

TEST_CASE("a journal with any bit of a record flipped has all records before it, and none that is wrong") {
  const Folder folder;
  std::vector<std::uint64_t> ends;
  const std::string whole = journal_of_a_test(folder / "j", 12, &ends);
  const auto frames = frames_of(folder / "j").payloads;
  const records::TestResult written = random_result(1, 12);
  for (std::uint64_t bit = 8 * ends[9]; bit < 8 * ends[10]; ++bit) {
    std::string flipped = whole;
    flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ (1 << bit % 8));
    write_bytes(folder / "flipped", flipped);
    const Frames read = frames_of(folder / "flipped");
    REQUIRE(read.extent.valid_bytes == ends[9]);
    REQUIRE(read.extent.torn);
    REQUIRE(is_prefix(read.payloads, frames));
    if (bit % 61 > 0) continue;
    const io::RecordJournal test = io::read_record_journal(folder / "flipped");
    REQUIRE(test.test->result.records.size() == 10);
    REQUIRE(records_that_differ(test.test->result, written, 10) == 0);
  }
}

TEST_CASE("a journal cut or changed at its start is empty, or refused with a clear word") {
  const Folder folder;
  const std::string whole = journal_of_a_test(folder / "j", 1);
  for (std::size_t cut = 0; cut < 200; ++cut) {
    write_bytes(folder / "cut", whole.substr(0, cut));
    REQUIRE(!io::read_record_journal(folder / "cut").test);
  }
  for (std::size_t bit = 0; bit < 8 * 40; ++bit) {
    std::string flipped = whole;
    flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ (1 << bit % 8));
    write_bytes(folder / "flipped", flipped);
    bool any = false;
    const std::string message =
        input_error([&] { any = io::read_record_journal(folder / "flipped").test.has_value(); });
    REQUIRE(!any);
    REQUIRE(message.empty() == (bit >= 8 * io::journal_header_bytes));
    if (!message.empty()) CHECK_THAT(message, Contains("flipped") && Contains("damaged"));
  }
  // A whole header of a later version, which this one cannot know.
  std::string later = whole.substr(0, 12);
  later[8] = 2;
  const auto sum = io::crc32c(bytes_in(later));
  later.append(reinterpret_cast<const char*>(&sum), sizeof sum);
  write_bytes(folder / "later", later);
  CHECK_THAT(input_error([&] { io::read_record_journal(folder / "later"); }), Contains("newer rvelab"));
}

TEST_CASE("a writer that takes a journal over cuts off its torn end") {
  const Folder folder;
  const std::string whole = journal_of_a_test(folder / "j", 12);
  write_bytes(folder / "j", whole.substr(0, whole.size() - 1));
  {
    const auto extent = io::read_record_journal(folder / "j").extent;
    io::Journal journal(folder / "j");
    journal.go_on(extent.valid_bytes);
    journal.append(io::record_frame, io::encode_record(11, random_result(1, 12).records[11]));
  }
  CHECK(bytes_of(folder / "j") == whole);
}

TEST_CASE("a record with a number that is there replaces it and those after it; unknown frames are passed over") {
  const Folder folder;
  journal_of_a_test(folder / "j", 12);
  const records::Record other = random_result(5, 1).records[0];
  {
    const auto extent = io::read_record_journal(folder / "j").extent;
    io::Journal journal(folder / "j");
    journal.go_on(extent.valid_bytes);
    journal.append(99, bytes_in("of a later version"));
    journal.append(io::record_frame, io::encode_record(3, other));
  }
  const auto records = io::read_record_journal(folder / "j").test->result.records;
  CHECK(records.size() == 4);
  CHECK(io::encode_record(0, records[3]) == io::encode_record(0, other));
}

TEST_CASE("a second writer is refused, in this process and in another") {
  const Folder folder;
  auto first = std::make_unique<io::Journal>(folder / "j");
  first->begin();
  CHECK_THAT(input_error([&] { io::Journal(folder / "j"); }), Contains("j: another rvelab is writing it"));
  const pid_t child = fork();
  if (child == 0) {
    const bool refused = !input_error([&] { io::Journal(folder / "j"); }).empty();
    _exit(refused ? 0 : 1);
  }
  int status = -1;
  waitpid(child, &status, 0);
  CHECK(status == 0);
  first.reset();
  io::Journal(folder / "j").begin();
  // A writer that removes its journal takes the lock with it; the next one makes a file of its own.
  auto removed = std::make_unique<io::Journal>(folder / "j");
  removed->remove();
  io::Journal next(folder / "j");
  next.begin();
  CHECK(std::filesystem::exists(folder / "j"));
}

TEST_CASE("replacing a journal keeps its lock and shows the old frames or the new") {
  const Folder folder;
  io::Journal journal(folder / "j");
  journal.begin();
  for (int k = 0; k < 10; ++k) journal.append(7, bytes_in("old"));
  journal.replace([&](io::Journal& next) { next.append(8, bytes_in("new")); });
  CHECK_THAT(input_error([&] { io::Journal(folder / "j"); }), Contains("another rvelab"));
  journal.append(9, bytes_in("newer"));
  std::vector<std::uint32_t> types;
  const auto extent = io::read_journal(folder / "j", [&](const io::Frame& frame) { types.push_back(frame.type); });
  CHECK(types == std::vector<std::uint32_t>{8, 9});
  CHECK(!extent.torn);
  CHECK(!std::filesystem::exists(folder / "j.tmp"));
  CHECK_THROWS_AS(journal.replace([](io::Journal&) { throw Error("no"); }), Error);
  journal.append(10, {});
  CHECK(!std::filesystem::exists(folder / "j.tmp"));
  CHECK(io::read_journal(folder / "j", [](const io::Frame&) {}).file_bytes == journal.size());
}

TEST_CASE("beyond the limit of a file's size a journal says so, and keeps what it had") {
  const Folder folder;
  const pid_t child = fork();
  if (child == 0) {
    const rlimit limit{4096, 4096};
    setrlimit(RLIMIT_FSIZE, &limit);
    std::string message;
    try {
      io::Journal journal(folder / "j");
      journal.begin();
      for (int k = 0; k < 100; ++k) journal.append(7, bytes_in(std::string(100, 'x')));
    } catch (const Error& error) {
      message = error.what();
    }
    _exit(message.find("could not be written (File too large)") != std::string::npos ? 0 : 1);
  }
  int status = -1;
  waitpid(child, &status, 0);
  CHECK(status == 0);
  int frames = 0;
  const auto extent = io::read_journal(folder / "j", [&](const io::Frame&) { ++frames; });
  CHECK(frames == (4096 - 16) / 116);
  CHECK(!extent.torn);  // the part of a frame that went in was cut off again
}

TEST_CASE("a place that cannot be written to is refused with its name") {
  const Folder folder;
  write_bytes(folder / "file", "");
  CHECK_THAT(input_error([&] { io::Journal(folder / "file/j"); }), Contains("file/j"));
  CHECK_THAT(input_error([&] { io::Journal(folder / "missing/j"); }), Contains("No such file"));
}

TEST_CASE("the manual lists the types of frames and the columns of a record") {
  std::string page = bytes_of(std::string(RVELAB_SOURCE_DIR) + "/tools/manual/pages/file_format.md");
  std::replace(page.begin(), page.end(), '\n', ' ');
  const auto documented = [&](const std::string& pattern) {
    CAPTURE(pattern);
    CHECK(std::regex_search(page, std::regex(pattern)));
  };
  for (const auto& [name, type] :
       {std::pair{"begin_frame", io::begin_frame}, std::pair{"record_frame", io::record_frame},
        std::pair{"probe_frame", io::probe_frame}, std::pair{"checkpoint_frame", io::checkpoint_frame},
        std::pair{"snapshot_frame", io::snapshot_frame}})
    documented("\\| *" + std::string(name) + " *\\| *" + std::to_string(type) + " *\\|");
  documented("rvejrnl[^.]*format version *\\(" + std::to_string(io::journal_version) + "\\)");
  const Folder folder;
  journal_of_a_test(folder / "j", 1);
  std::string columns;
  std::size_t bytes = 0, payload = 0;
  io::read_journal(folder / "j", [&](const io::Frame& frame) {
    if (frame.type == io::record_frame) payload = frame.payload.size();
    if (frame.type != io::begin_frame) return;
    const auto begin = io::Hdf5File::from_image("begin", frame.payload);
    for (const auto& name : begin.read_text("/journal/columns")) columns += (columns.empty() ? "" : ", *") + name;
    for (const auto size : begin.read<std::int64_t>("/journal/column_bytes")) bytes += static_cast<std::size_t>(size);
  });
  CHECK(payload == 8 + bytes);
  documented("[ ,]" + columns + "\\.");
}
