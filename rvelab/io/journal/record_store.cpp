#include "rvelab/io/journal/record_store.hpp"

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "rvelab/error.hpp"
#include "rvelab/io/hdf5/schema.hpp"

namespace rvelab::io {
namespace {

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// The first line in which two texts differ, both versions.
std::string first_differing_lines(const std::string& a, const std::string& b) {
  std::istringstream lines_a(a), lines_b(b);
  std::string line_a, line_b;
  while (true) {
    const bool more_a = static_cast<bool>(std::getline(lines_a, line_a));
    const bool more_b = static_cast<bool>(std::getline(lines_b, line_b));
    if (!more_a) line_a = "nothing";
    if (!more_b) line_b = "nothing";
    if (line_a != line_b || (!more_a && !more_b)) return "\"" + line_a + "\" there, \"" + line_b + "\" here";
  }
}

void expect_same_run(const std::string& path, const RecordedTest& there, const RunStart& here) {
  if (there.provenance.protocol != here.protocol_text) {
    throw InputError(path + ": was begun with another protocol (" +
                     first_differing_lines(there.provenance.protocol, here.protocol_text) + "), by rvelab " +
                     there.provenance.version +
                     "; allowed with --resume: the same protocol and settings; give them, or "
                     "start again with --force");
  }
  const auto known = there.provenance.specimen_crc32c;
  if (known != 0 && known != digest(here.specimen)) {
    throw InputError(path +
                     ": was begun with another specimen; allowed with --resume: the same one; give it, or start "
                     "again with --force");
  }
}

/// Places taken without --force or --resume are refused before anything is made there.
void expect_free(const std::string& path) {
  const std::string journal = journal_of(path);
  std::error_code ignored;
  const bool has_journal = std::filesystem::file_size(journal, ignored) > 0 && !ignored;
  if (!has_journal && !std::filesystem::exists(path)) return;
  expect_output(std::filesystem::exists(path) ? path : journal, false, {}, ", or --resume to go on with it");
}

/// The journal's name, if it may be taken.
std::string place_for(const std::string& path, IfExists existing) {
  expect_place(path);
  if (existing == IfExists::refuse) expect_free(path);
  return journal_of(path);
}

/// Records and probes from the given ones on.
void append_rows(Journal& journal, const records::TestResult& result, std::size_t records, std::size_t probes) {
  for (std::size_t k = records; k < result.records.size(); ++k)
    journal.append(record_frame, encode_record(k, result.records[k]));
  for (std::size_t k = probes; k < result.probes.size(); ++k)
    journal.append(probe_frame, encode_probe(k, result.probes[k]));
}

bool same_bits(const records::Record& a, const records::Record& b) {
  return encode_record(0, a) == encode_record(0, b);
}

bool same_bits(const records::ProbeResult& a, const records::ProbeResult& b) {
  return a.stage == b.stage && a.stiffness.size() == b.stiffness.size() && a.stiffness == b.stiffness;
}

}  // namespace

RecordStore::RecordStore(const std::string& path, const RunStart& start, IfExists existing, double checkpoint_every)
    : path_(followed(path)), journal_(place_for(path, existing)), checkpoint_every_(checkpoint_every) {
  if (existing == IfExists::refuse) expect_free(path);  // once more, under the lock
  const auto begin_time = Clock::now();
  // Left by a run that was killed while it wrote them.
  for (const std::string& whole : {path_, journal_.path()}) ::unlink((whole + ".tmp").c_str());
  kept_ = published_ = {begin_time, 0};
  if (existing == IfExists::resume) resume(start);
  if (existing == IfExists::resume && (test_.complete || journal_.size() > 0)) return;
  try {
    ::unlink(path_.c_str());
    const auto begin = encode_begin(start);
    journal_.begin();
    journal_.append(begin_frame, begin);
    journal_.sync();
    test_ = begun_test(start);
    // What a checkpoint will cost is not known yet: about as much as this.
    kept_ = published_ = {Clock::now(), seconds_since(begin_time)};
  } catch (...) {
    journal_.remove();
    throw;
  }
}

RecordStore::~RecordStore() {
  // Nothing to go on from: no file is left behind.
  if (!test_.complete && !keeps_something_) journal_.remove();
}

void RecordStore::resume(const RunStart& start) {
  const RecordJournal there = read_record_journal(journal_.path());
  const bool has_file = std::filesystem::exists(path_);
  if (there.extent.torn && !there.test && !has_file && there.extent.file_bytes > journal_header_bytes) {
    // A run killed while it wrote its first frame has lost nothing; a damaged journal may have held a test.
    const auto first = encode_begin(start).size() + journal_header_bytes + frame_header_bytes;
    if (there.extent.file_bytes >= first) {
      throw InputError(journal_.path() +
                       ": is damaged at its start, and nothing after that can be read; start again "
                       "with --force");
    }
  }
  test_.complete = false;
  if (!has_file && !there.test) {
    journal_.go_on(0);
    return;
  }
  keeps_something_ = true;
  test_ = read_recorded_test(path_);
  expect_same_run(path_, test_, start);
  if (test_.complete) {
    journal_.remove();
    return;
  }
  // What the journal does not hold, because it is gone or was damaged, goes back into it from R.h5.
  std::size_t records = 0, probes = 0;
  std::uint64_t steps = 0;
  std::vector<std::size_t> snapshots;
  if (there.test) {
    journal_.go_on(there.extent.valid_bytes);
    records = there.test->result.records.size();
    probes = there.test->result.probes.size();
    steps = there.test->checkpoint.specimen.state.grain_steps;
  } else {
    journal_.begin();
    journal_.append(begin_frame, encode_begin(start));
  }
  append_rows(journal_, test_.result, records, probes);
  for (Snapshot& snapshot : test_.snapshots) {
    if (!snapshot.within) continue;
    const auto payload = encode_snapshot(snapshot.record, read_snapshot(snapshot));
    snapshot = {snapshot.record, journal_.path(), journal_.append(snapshot_frame, payload), payload.size()};
  }
  const bool at_start = test_.checkpoint.progress.stage == 0 && test_.checkpoint.progress.phase == 0;
  if (!at_start && (!there.has_checkpoint || test_.checkpoint.specimen.state.grain_steps > steps)) {
    journal_.append(checkpoint_frame, encode_checkpoint(test_.checkpoint));
  }
  journal_.sync();
  if (at_start) return;
  from_ = test_.checkpoint;
  made_records_ = std::size_t(from_->progress.records);
  made_probes_ = std::size_t(from_->progress.probes);
}

void RecordStore::put(const records::Record& record) {
  auto& records = test_.result.records;
  const std::size_t number = made_records_++;
  if (number < records.size() && same_bits(records[number], record)) return;
  // A build that computes other bits than the one before: what that one made from here on is not this run's.
  records.resize(number);
  std::erase_if(test_.snapshots, [&](const Snapshot& snapshot) { return snapshot.record >= number; });
  journal_.append(record_frame, encode_record(number, record));
  records.push_back(record);
  keeps_something_ = true;
}

void RecordStore::put(const records::ProbeResult& probe) {
  auto& probes = test_.result.probes;
  const std::size_t number = made_probes_++;
  if (number < probes.size() && same_bits(probes[number], probe)) return;
  probes.resize(number);
  journal_.append(probe_frame, encode_probe(number, probe));
  probes.push_back(probe);
}

void RecordStore::put_snapshot(std::size_t record, const Specimen& state) {
  for (const Snapshot& there : test_.snapshots) {
    if (there.record == record) return;
  }
  const auto payload = encode_snapshot(record, state);
  const auto payload_at = journal_.append(snapshot_frame, payload);
  test_.snapshots.push_back({record, journal_.path(), payload_at, payload.size()});
}

bool RecordStore::ready(const Last& last, double shortest) const {
  // Each takes at most a 400th of the time, so that records, checkpoints and files together stay below a hundredth.
  constexpr double cost_multiple = 400;
  const double wait = checkpoint_every_ > 0 ? checkpoint_every_ : std::max(shortest, cost_multiple * last.cost);
  return seconds_since(last.when) >= wait;
}

void RecordStore::offer(const std::function<records::Checkpoint()>& take) {
  constexpr double shortest_checkpoint = 1, shortest_publish = 5;  // s
  const bool to_publish = ready(published_, shortest_publish) && made_records_ > 0;
  if (!to_publish && !ready(kept_, shortest_checkpoint)) return;
  keep(take());
  if (to_publish) publish_now();
}

void RecordStore::keep(const records::Checkpoint& checkpoint) {
  const auto begin = Clock::now();
  test_.take(checkpoint);
  journal_.append(checkpoint_frame, encode_checkpoint(checkpoint));
  keeps_something_ = true;
  journal_.sync();
  drop_old_checkpoints();
  kept_ = {Clock::now(), seconds_since(begin)};
}

void RecordStore::drop_old_checkpoints() {
  // The journal is rewritten with its last checkpoint only when the others are most of it: the cost is then a fraction
  // of theirs.
  constexpr std::uint64_t small = 16 << 20;
  if (journal_.size() < std::max(small, 4 * size_without_)) return;
  auto snapshots = test_.snapshots;
  journal_.replace([&](Journal& next) {
    read_journal(journal_.path(), [&](const Frame& frame) {
      if (frame.type == begin_frame) next.append(frame.type, frame.payload);
    });
    append_rows(next, test_.result, 0, 0);
    for (Snapshot& snapshot : snapshots) {
      const auto payload = read_payload(journal_.path(), snapshot.payload_at, snapshot.length);
      snapshot.payload_at = next.append(snapshot_frame, payload);
    }
    next.append(checkpoint_frame, encode_checkpoint(test_.checkpoint));
  });
  test_.snapshots = snapshots;
  size_without_ = journal_.size();
}

void RecordStore::publish_now() {
  const auto begin = Clock::now();
  try {
    write_recorded_test(test_, path_);
  } catch (const InputError& error) {
    // The place was good when the run began: that it is no longer is a failure and no mistake of the user.
    throw Error(error.what());
  }
  published_ = {Clock::now(), seconds_since(begin)};
}

void RecordStore::stop(const records::Checkpoint& checkpoint) {
  keep(checkpoint);
  publish_what_is_there();
}

void RecordStore::publish_what_is_there() {
  if (!journal_.failed() && made_records_ > 0) publish_now();
}

void RecordStore::finish(const records::TestResult& result, const Specimen& end_state) {
  test_.result = result;
  test_.checkpoint.specimen = end_state;
  test_.complete = true;
  publish_now();
  journal_.remove();
}

}  // namespace rvelab::io
