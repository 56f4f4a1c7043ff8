#include "rvelab/io/journal/record_journal.hpp"

#include <algorithm>
#include <cstring>

#include "rvelab/error.hpp"
#include "rvelab/io/hdf5/archive.hpp"
#include "rvelab/io/hdf5/schema.hpp"
#include "rvelab/io/journal/recorded_test.hpp"
#include "rvelab/records/record_fields.hpp"

namespace rvelab::io {
namespace {

using records::describe_progress;
using records::describe_records;
using Bytes = std::vector<std::byte>;

/// Shows Self every column of a record, chosen or not, as column(items, field).
template <class Self>
struct EveryColumn {
  template <class Items, class... Columns>
  void table(const std::string&, Items& items, const Columns&... columns) {
    (static_cast<Self*>(this)->column(items, columns), ...);
  }
  template <class Items, class Column>
  void choice(const std::string&, Items& items, const Column& column) {
    static_cast<Self*>(this)->column(items, column);
  }
  template <class Items, class Column, class Mask, class Bit>
  void chosen(const std::string&, Items& items, const Column& column, Mask, Bit) {
    static_cast<Self*>(this)->column(items, column);
  }
};

/// Columns of a packed record, in their order. The begin frame holds it, so that a reader of another version finds each
/// column by its name.
struct RowLayout : EveryColumn<RowLayout> {
  std::vector<std::string> names;
  std::vector<std::int64_t> bytes;

  template <class Items, class Item, class Member>
  void column(Items&, const Field<Item, Member>& column) {
    names.emplace_back(column.name);
    bytes.push_back(sizeof(typename Layout<Member>::Scalar) * Layout<Member>::size);
  }
};

/// Packs one record.
struct RowWriter : EveryColumn<RowWriter> {
  Bytes& bytes;
  explicit RowWriter(Bytes& to) : bytes(to) {}

  template <class Items, class Item, class Member>
  void column(const Items& row, const Field<Item, Member>& column) {
    typename Layout<Member>::Scalar scalars[Layout<Member>::size];
    Layout<Member>::put(row.front().*column.member, scalars);
    const auto raw = std::as_bytes(std::span(scalars));
    bytes.insert(bytes.end(), raw.begin(), raw.end());
  }
};

/// Unpacks one record. Columns that the row does not have stay as they are.
struct RowReader : EveryColumn<RowReader> {
  const RowLayout& layout;
  std::span<const std::byte> row;
  RowReader(const RowLayout& of, std::span<const std::byte> from) : layout(of), row(from) {}

  template <class Items, class Item, class Member>
  void column(Items& items, const Field<Item, Member>& column) const {
    typename Layout<Member>::Scalar scalars[Layout<Member>::size];
    std::size_t at = 0;
    for (std::size_t k = 0; k < layout.names.size(); ++k) {
      const auto size = std::size_t(layout.bytes[k]);
      if (layout.names[k] == column.name && size == sizeof scalars && at + size <= row.size()) {
        std::memcpy(scalars, row.data() + at, size);
        Layout<Member>::get(scalars, items.front().*column.member);
      }
      at += size;
    }
  }
};

RowLayout row_layout() {
  RowLayout layout;
  const std::vector<records::Record> none;
  describe_records(layout, none);
  return layout;
}

/// A number in front of what it numbers.
Bytes numbered(std::size_t number, const Bytes& rest = {}) {
  const auto stored = std::uint64_t(number);
  Bytes bytes(sizeof stored + rest.size());
  std::memcpy(bytes.data(), &stored, sizeof stored);
  std::copy(rest.begin(), rest.end(), bytes.begin() + sizeof stored);
  return bytes;
}

std::size_t take_number(const std::string& path, std::span<const std::byte>& payload) {
  std::uint64_t number = 0;
  if (payload.size() < sizeof number) throw InputError(path + ": holds a frame without its number; it is damaged");
  std::memcpy(&number, payload.data(), sizeof number);
  payload = payload.subspan(sizeof number);
  return number;
}

template <class Fill>
Bytes image_of(Fill fill) {
  auto file = Hdf5File::in_memory("frame");
  stamp(file, "rvelab journal");
  fill(file);
  return file.image();
}

template <class Archive, class Value>
void describe_begin(Archive& archive, Value& test, RowLayout& layout) {
  archive.field("test/protocol", test.result.protocol, "-");
  archive.field("test/stages", test.result.stages, "-");
  archive.field("provenance/protocol", test.provenance.protocol, "-");
  archive.field("provenance/version", test.provenance.version, "-");
  archive.field("provenance/compiler", test.provenance.compiler, "-");
  archive.field("provenance/packages", test.provenance.packages, "-");
  archive.field("provenance/specimen_crc32c", test.provenance.specimen_crc32c, "1");
  archive.field("journal/columns", layout.names, "-");
  archive.field("journal/column_bytes", layout.bytes, "1");
}

/// Puts frames together, one after the other.
struct Assembler {
  const std::string& path;
  RecordJournal& journal;
  RowLayout layout;

  void take(const Frame& frame) {
    if (frame.type == begin_frame) return begin(frame);
    if (!journal.test) throw InputError(path + ": does not start with its begin frame; start again with --force");
    auto rest = frame.payload;
    if (frame.type == checkpoint_frame) return checkpoint(rest);
    if (frame.type < begin_frame || frame.type > snapshot_frame) return;
    const std::size_t number = take_number(path, rest);
    records::TestResult& result = journal.test->result;
    if (frame.type == record_frame) {
      truncate(result.records, number);
      std::vector<records::Record> row(1);
      RowReader reader(layout, rest);
      describe_records(reader, row);
      result.records.push_back(row.front());
      std::erase_if(journal.test->snapshots, [&](const Snapshot& snapshot) { return snapshot.record >= number; });
    } else if (frame.type == probe_frame) {
      truncate(result.probes, number);
      for (records::ProbeResult& probe : get_probes(Hdf5File::from_image(path, rest)))
        result.probes.push_back(std::move(probe));
    } else {
      std::erase_if(journal.test->snapshots, [&](const Snapshot& snapshot) { return snapshot.record == number; });
      journal.test->snapshots.push_back({number, path, frame.payload_at, frame.payload.size()});
    }
  }

  template <class Row>
  void truncate(std::vector<Row>& rows, std::size_t number) const {
    if (number > rows.size()) {
      throw InputError(path + ": holds row " + std::to_string(number) + " after " + std::to_string(rows.size()) +
                       " rows; it is damaged");
    }
    rows.resize(number);
  }

  void begin(const Frame& frame) {
    const auto file = Hdf5File::from_image(path, frame.payload);
    expect_version(file);
    journal.test.emplace();
    journal.test->complete = false;
    Reader reader(file, "");
    layout = {};
    describe_begin(reader, *journal.test, layout);
    constexpr std::int64_t widest = 1 << 16;
    const auto has_width = [](std::int64_t bytes) { return bytes > 0 && bytes <= widest; };
    if (layout.names.size() != layout.bytes.size() ||
        !std::all_of(layout.bytes.begin(), layout.bytes.end(), has_width)) {
      throw InputError(path + ": its list of columns is damaged; start again with --force");
    }
    journal.test->checkpoint.specimen = get_specimen(file, "/specimen");
    journal.test->checkpoint.progress.first_grain_steps = journal.test->checkpoint.specimen.state.grain_steps;
  }

  void checkpoint(std::span<const std::byte> payload) {
    const auto file = Hdf5File::from_image(path, payload);
    records::Checkpoint checkpoint = journal.test->checkpoint;
    Reader reader(file, "");
    describe_progress(reader, checkpoint.progress);
    reader.field("provenance/wall_seconds", checkpoint.progress.wall_seconds, "s");
    checkpoint.specimen = get_specimen(file, "/specimen");
    journal.test->take(checkpoint);
    journal.has_checkpoint = true;
  }
};

}  // namespace

RecordedTest begun_test(const RunStart& start) {
  RecordedTest test;
  test.complete = false;
  test.provenance = provenance_of(start.protocol_text, start.specimen);
  test.result.protocol = start.protocol_name;
  test.result.stages = start.stages;
  test.checkpoint.specimen = start.specimen;
  test.checkpoint.progress.first_grain_steps = start.specimen.state.grain_steps;
  return test;
}

Bytes encode_begin(const RunStart& start) {
  const RecordedTest test = begun_test(start);
  return image_of([&](Hdf5File& file) {
    RowLayout layout = row_layout();
    Writer writer(file, "");
    describe_begin(writer, test, layout);
    put_specimen(file, "/specimen", start.specimen);
  });
}

Bytes encode_record(std::size_t number, const records::Record& record) {
  Bytes bytes = numbered(number);
  const std::vector<records::Record> row{record};
  RowWriter writer(bytes);
  describe_records(writer, row);
  return bytes;
}

Bytes encode_probe(std::size_t number, const records::ProbeResult& probe) {
  return numbered(number, image_of([&](Hdf5File& file) { put_probes(file, {probe}); }));
}

Bytes encode_checkpoint(const records::Checkpoint& checkpoint) {
  return image_of([&](Hdf5File& file) {
    Writer writer(file, "");
    describe_progress(writer, checkpoint.progress);
    writer.field("provenance/wall_seconds", checkpoint.progress.wall_seconds, "s");
    put_specimen(file, "/specimen", checkpoint.specimen);
  });
}

Bytes encode_snapshot(std::size_t record, const Specimen& specimen) {
  return numbered(record, image_of([&](Hdf5File& file) { put_specimen(file, "/specimen", specimen); }));
}

Specimen decode_snapshot(const std::string& path, std::span<const std::byte> payload) {
  take_number(path, payload);
  return get_specimen(Hdf5File::from_image(path, payload), "/specimen");
}

RecordJournal read_record_journal(const std::string& path) {
  RecordJournal journal;
  Assembler assembler{path, journal, {}};
  journal.extent = read_journal(path, [&](const Frame& frame) { assembler.take(frame); });
  return journal;
}

}  // namespace rvelab::io
