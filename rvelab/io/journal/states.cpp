#include "rvelab/io/journal/states.hpp"

#include <algorithm>
#include <filesystem>

#include "rvelab/io/hdf5/specimen_file.hpp"
#include "rvelab/io/journal/recorded_test.hpp"

namespace rvelab::io {

std::vector<StoredState> read_states(const std::string& path) {
  if (std::filesystem::exists(path) && file_kind(path) == FileKind::specimen) return {{0, 0, read_specimen(path)}};
  const RecordedTest test = read_recorded_test(path);
  const auto& records = test.result.records;
  const auto strain_of = [&](std::size_t record) {
    return records.empty() ? 0.0 : records[std::min(record, records.size() - 1)].strain;
  };
  std::vector<StoredState> states;
  for (const Snapshot& snapshot : test.snapshots)
    states.push_back({long(snapshot.record), strain_of(snapshot.record), read_snapshot(snapshot)});
  states.push_back({long(records.size()), strain_of(records.size()), test.checkpoint.specimen});
  return states;
}

}  // namespace rvelab::io
