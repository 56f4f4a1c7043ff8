#include "rvelab/io/journal/recorded_test.hpp"

#include <toml++/toml.h>
#include <Eigen/Core>
#include <algorithm>
#include <charconv>
#include <cstdio>
#include <filesystem>

#include "rvelab/error.hpp"
#include "rvelab/io/hdf5/archive.hpp"
#include "rvelab/io/hdf5/schema.hpp"
#include "rvelab/io/hdf5/specimen_file.hpp"
#include "rvelab/io/journal/journal.hpp"
#include "rvelab/io/journal/record_journal.hpp"
#include "rvelab/io/version.hpp"
#include "rvelab/records/record_fields.hpp"
#include "rvelab/solver/rve.hpp"

namespace rvelab::io {

namespace {

/// Every field of a test but records and probes, once for both directions.
template <class Archive, class Value>
void describe_test(Archive& archive, Value& test) {
  archive.field("test/protocol", test.result.protocol, "-");
  archive.field("test/axis", test.result.axis, "-");
  archive.field("test/pressure_Pa", test.result.pressure, "Pa");
  archive.field("test/stages", test.result.stages, "-");
  archive.field("test/grain_steps", test.result.grain_steps, "1");
  archive.field("provenance/wall_seconds", test.result.wall_seconds, "s");
  archive.field("provenance/protocol", test.provenance.protocol, "-");
  archive.field("provenance/version", test.provenance.version, "-");
  archive.field("provenance/compiler", test.provenance.compiler, "-");
  archive.field("provenance/packages", test.provenance.packages, "-");
  archive.field("provenance/specimen_crc32c", test.provenance.specimen_crc32c, "1");
  archive.field("complete", test.complete, "1");
}

std::string snapshot_group(std::size_t record) {
  char name[32];
  std::snprintf(name, sizeof name, "/snapshots/%06zu", record);
  return name;
}

std::shared_ptr<const Hdf5File> open_records(const std::string& path) {
  auto file = std::make_shared<const Hdf5File>(Hdf5File::open(path));
  if (checked_kind(*file) != FileKind::records) {
    throw InputError(path + ": holds a specimen and no records; give a file that `rvelab run` wrote");
  }
  return file;
}

/// Names of the quantities that the records have, as the protocol chose them.
std::vector<std::string> quantities_in(const std::vector<records::Record>& records) {
  const std::uint64_t chosen = (records.empty() ? records::Record{} : records.front()).quantities;
  std::vector<std::string> names;
  records::Quantities::for_each([&]<class Quantity>(std::type_identity<Quantity>, std::uint64_t bit) {
    if ((chosen & bit) != 0) names.emplace_back(Quantity::text.name);
  });
  return names;
}

/// The file alone, without its journal.
RecordedTest test_in(const std::shared_ptr<const Hdf5File>& opened) {
  const Hdf5File& file = *opened;
  const std::string& path = file.path();
  RecordedTest test;
  Reader reader(file, "");
  describe_test(reader, test);
  records::describe_records(reader, test.result.records);
  std::vector<std::string> quantities;
  reader.field("test/quantities", quantities, "-");
  for (const std::string& name : quantities) file.shape("/records/" + name);  // says so if one is missing
  test.result.probes = get_probes(file);
  if (!test.complete) {
    records::describe_progress(reader, test.checkpoint.progress);
    test.checkpoint.progress.wall_seconds = test.result.wall_seconds;
  }
  test.checkpoint.specimen = get_specimen(file, "/specimen");
  for (const std::string& name : file.groups("/snapshots")) {
    std::size_t number = 0;
    const char* const end = name.data() + name.size();
    const auto [stop, error] = std::from_chars(name.data(), end, number);
    if (error != std::errc() || stop != end) {
      throw InputError(path + ": the group /snapshots/" + name +
                       " is not named by the number of a record; the file is damaged: write it again");
    }
    test.snapshots.push_back({number, "", 0, 0, opened});
  }
  std::sort(test.snapshots.begin(), test.snapshots.end(),
            [](const Snapshot& a, const Snapshot& b) { return a.record < b.record; });
  return test;
}

/// InputError where no RVE can be made of the specimen: grains at one place, an overlap beyond its limit.
void expect_opens(const Specimen& specimen, const std::string& where) {
  try {
    const Rve rve(specimen);
  } catch (const Error& error) {
    throw InputError(where + ": " + error.what());
  }
}

/// InputError where something in the file would be refused when it is read.
void expect_readable(const std::shared_ptr<const Hdf5File>& opened, FileKind kind) {
  const Hdf5File& file = *opened;
  if (kind == FileKind::specimen) {
    get_origin(file);
    return expect_opens(get_specimen(file, specimen_group(file)), file.path());
  }
  const RecordedTest test = test_in(opened);
  expect_opens(test.checkpoint.specimen, file.path());
  for (const Snapshot& snapshot : test.snapshots) {
    const std::string group = snapshot_group(snapshot.record);
    expect_opens(get_specimen(file, group), file.path() + ", " + group);
  }
}

}  // namespace

void put_probes(Hdf5File& file, const std::vector<records::ProbeResult>& probes) {
  const auto size = probes.empty() ? 0 : std::size_t(probes.front().stiffness.rows());
  std::vector<std::string> stages;
  std::vector<double> rows;
  for (const records::ProbeResult& probe : probes) {
    stages.push_back(probe.stage);
    const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> matrix = probe.stiffness;
    rows.insert(rows.end(), matrix.data(), matrix.data() + matrix.size());
  }
  file.write_text("/probes/stage", stages, {probes.size()});
  file.write<double>("/probes/stiffness_Pa", rows, {probes.size(), size, size}, "Pa");
}

std::vector<records::ProbeResult> get_probes(const Hdf5File& file) {
  const auto stages = file.read_text("/probes/stage");
  const auto rows = file.read<double>("/probes/stiffness_Pa");
  const Shape64 shape = file.shape("/probes/stiffness_Pa");
  if (shape.size() != 3 || shape[0] != stages.size() || shape[1] != shape[2]) {
    throw InputError(file.path() +
                     ": /probes/stiffness_Pa is not one square matrix for each of /probes/stage; the file "
                     "is damaged: write it again");
  }
  const auto size = Eigen::Index(shape[1]);
  std::vector<records::ProbeResult> probes;
  for (std::size_t k = 0; k < stages.size(); ++k) {
    using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    probes.push_back({stages[k], Eigen::Map<const RowMajor>(rows.data() + k * shape[1] * shape[2], size, size)});
  }
  return probes;
}

Provenance provenance_of(const std::string& protocol_text, const Specimen& start) {
  const auto dotted = [](int major, int minor, int patch) {
    return std::to_string(major) + "." + std::to_string(minor) + "." + std::to_string(patch);
  };
  return {protocol_text,
          version,
          compiler(),
          {"eigen " + dotted(EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION),
           "toml++ " + dotted(TOML_LIB_MAJOR, TOML_LIB_MINOR, TOML_LIB_PATCH)},
          digest(start)};
}

void RecordedTest::take(const records::Checkpoint& reached) {
  checkpoint = reached;
  result.axis = reached.progress.axis;
  result.pressure = reached.progress.pressure;
  result.wall_seconds = reached.progress.wall_seconds;
  result.grain_steps = reached.specimen.state.grain_steps - reached.progress.first_grain_steps;
}

void write_recorded_test(const RecordedTest& test, const std::string& path) {
  publish(path, [&](Hdf5File& file) {
    stamp(file, FileKind::records);
    Writer writer(file, "");
    describe_test(writer, test);
    records::describe_records(writer, test.result.records);
    writer.field("test/quantities", quantities_in(test.result.records), "-");
    put_probes(file, test.result.probes);
    if (!test.complete) records::describe_progress(writer, test.checkpoint.progress);
    put_specimen(file, "/specimen", test.checkpoint.specimen);
    for (const Snapshot& snapshot : test.snapshots) {
      put_specimen(file, snapshot_group(snapshot.record), read_snapshot(snapshot));
    }
  });
}

SealedFile seal_file(const std::string& path, const std::string& output) {
  const auto opened = std::make_shared<const Hdf5File>(Hdf5File::open(path, Seal::if_any));
  const Hdf5File& file = *opened;
  const SealedFile found{checked_kind(file), file.sealed(), file.entries().size()};
  try {
    expect_readable(opened, found.kind);
  } catch (const InputError& error) {
    throw InputError(error.what() + std::string("; nothing was written"));
  }
  publish(output, file);
  return found;
}

Specimen read_snapshot(const Snapshot& snapshot) {
  if (snapshot.within) return get_specimen(*snapshot.within, snapshot_group(snapshot.record));
  return decode_snapshot(snapshot.journal, read_payload(snapshot.journal, snapshot.payload_at, snapshot.length));
}

RecordedTest read_recorded_test(const std::string& path) {
  // The journal first: if its writer ends meanwhile, the file found afterwards holds at least as much.
  const std::string journal_path = journal_of(path);
  const RecordJournal journal = read_record_journal(journal_path);
  const bool has_file = std::filesystem::exists(path);
  if (!has_file && journal.test) return *journal.test;
  RecordedTest file = test_in(open_records(path));  // says so if neither is there
  if (file.complete || !journal.test) return file;
  RecordedTest merged = *journal.test;
  if (merged.provenance.protocol != file.provenance.protocol ||
      merged.provenance.specimen_crc32c != file.provenance.specimen_crc32c) {
    throw InputError(path + ": is of another test than " + journal_path +
                     "; allowed: a record file with its own journal; move one of the two away");
  }
  const auto steps = [](const RecordedTest& test) { return test.checkpoint.specimen.state.grain_steps; };
  if (steps(file) > steps(merged)) merged.take(file.checkpoint);
  if (file.result.records.size() > merged.result.records.size()) merged.result.records = file.result.records;
  if (file.result.probes.size() > merged.result.probes.size()) merged.result.probes = file.result.probes;
  for (const Snapshot& snapshot : file.snapshots) {
    const auto same = [&](const Snapshot& other) { return other.record == snapshot.record; };
    if (std::none_of(merged.snapshots.begin(), merged.snapshots.end(), same)) merged.snapshots.push_back(snapshot);
  }
  std::sort(merged.snapshots.begin(), merged.snapshots.end(),
            [](const Snapshot& a, const Snapshot& b) { return a.record < b.record; });
  return merged;
}

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
