// The frames of a record file's journal: what each type holds, and how a journal becomes a test again.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "rvelab/io/journal/journal.hpp"
#include "rvelab/io/journal/recorded_test.hpp"

namespace rvelab::io {

/// Types of frames. Those that hold HDF5 begin as an HDF5 file does and can be cut out and opened as one; rows are
/// packed, since there are many. A reader passes over types that it does not know.
enum FrameType : std::uint32_t {
  begin_frame = 1,       ///< HDF5: /provenance, /test/protocol, /test/stages, /journal, the specimen at the start
  record_frame = 2,      ///< uint64 number from 0, then the columns of /journal/columns, packed
  probe_frame = 3,       ///< uint64 number from 0, then HDF5: /probes with one row
  checkpoint_frame = 4,  ///< HDF5: /checkpoint, /specimen, /provenance/wall_seconds
  snapshot_frame = 5     ///< uint64 number of its record, then HDF5: /specimen
};

/// What a run is at its start.
struct RunStart {
  std::string protocol_name;
  std::string protocol_text;  ///< resolved
  std::vector<std::string> stages;
  Specimen specimen;  ///< as it was given
};

/// A test of which nothing has been run.
RecordedTest begun_test(const RunStart& start);

std::vector<std::byte> encode_begin(const RunStart& start);
std::vector<std::byte> encode_record(std::size_t number, const records::Record& record);
std::vector<std::byte> encode_probe(std::size_t number, const records::ProbeResult& probe);
std::vector<std::byte> encode_checkpoint(const records::Checkpoint& checkpoint);
std::vector<std::byte> encode_snapshot(std::size_t record, const Specimen& specimen);
Specimen decode_snapshot(const std::string& path, std::span<const std::byte> payload);

struct RecordJournal {
  std::optional<RecordedTest> test;  ///< none without a whole begin frame
  bool has_checkpoint = false;       ///< else the test's checkpoint is its start
  JournalExtent extent;
};

/// Reads the valid prefix of a journal. A record numbered k replaces all from k on. InputError: no journal, of a newer
/// format, or frames that are whole and make no sense.
RecordJournal read_record_journal(const std::string& path);

}  // namespace rvelab::io
