// A test, complete or as far as it got, as a record file R.h5 and its journal hold it together: one dataset a column
// under /records, the test under /test, its origin under /provenance, the end state under /specimen
// (rvelab/io/README.md). A running test writes through RecordStore.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "rvelab/io/hdf5/file.hpp"
#include "rvelab/io/hdf5/specimen_file.hpp"
#include "rvelab/records/progress.hpp"
#include "rvelab/records/record.hpp"
#include "rvelab/specimen/specimen.hpp"

namespace rvelab::io {

/// Origin of a file. No host names, no dates. A run draws no random numbers, so there is no seed.
struct Provenance {
  std::string protocol;  ///< with every default and setting in it, TOML
  std::string version, compiler;
  std::vector<std::string> packages;  ///< libraries that numbers or files pass through, "name version"
  std::uint64_t specimen_crc32c = 0;  ///< of the specimen that the test began with; 0: not known
};

/// The provenance of what this program writes.
Provenance provenance_of(const std::string& protocol_text, const Specimen& start);

/// Place of the state of one record: a frame of a journal, or a record file that was read.
struct Snapshot {
  std::size_t record = 0;  ///< row of /records
  std::string journal;
  std::uint64_t payload_at = 0, length = 0;
  std::shared_ptr<const Hdf5File> within = nullptr;
};

struct RecordedTest {
  Provenance provenance;
  records::TestResult
      result;  ///< incomplete: with all stages of the protocol, and grain_steps and wall time of the checkpoint
  records::Checkpoint
      checkpoint;  ///< complete: the end state; else where the test goes on (perhaps before the last record)
  bool complete = true;
  std::vector<Snapshot> snapshots;  ///< in the order of their records
  /// A checkpoint that an incomplete test has reached, and what it says of the result.
  void take(const records::Checkpoint& reached);
};

/// Reads R.h5 and, if it is not complete, what its journal has beyond it: the records of the one that has more, the
/// checkpoint of the one that went further. InputError if there is neither file, or one of them is not rvelab's.
RecordedTest read_recorded_test(const std::string& path);

/// Writes (publish()) a whole record file.
void write_recorded_test(const RecordedTest& test, const std::string& path);

/// The state at a snapshot.
Specimen read_snapshot(const Snapshot& snapshot);

struct SealedFile {
  FileKind kind = FileKind::specimen;
  bool had_seal = false;
  std::size_t datasets = 0;
};

/// Reads a specimen or record file that lacks its seal, because another program has made or changed it or because it is
/// of a version before 1.4, and writes everything that it holds to `output` (publish()), sealed and of its own version.
/// InputError: damaged, not rvelab's, datasets are missing or contradict each other, or a specimen in it makes no RVE.
SealedFile seal_file(const std::string& path, const std::string& output);

/// Probe results: the names of their stages, and one square matrix each (all of one size).
void put_probes(Hdf5File& file, const std::vector<records::ProbeResult>& probes);
/// InputError if names and matrices do not fit each other; none in files of version 1.0.
std::vector<records::ProbeResult> get_probes(const Hdf5File& file);

struct StoredState {
  long record = 0;    ///< number of the record; an end state comes after all of them
  double strain = 0;  ///< driving strain there; that of the last record for an end state; 0 without records
  Specimen specimen;
};

/// The specimen of a specimen file; of a record file, with its journal, each snapshot in the order of the records, and
/// the end state, or the last checkpoint of a test that has not ended. Never empty. InputError as read_specimen.
std::vector<StoredState> read_states(const std::string& path);

}  // namespace rvelab::io
