#include "tests/fuzz/journals.hpp"

#include <algorithm>
#include <cstring>

#include "rvelab/io/crc32c.hpp"
#include "rvelab/io/hdf5/specimen_file.hpp"
#include "rvelab/io/journal/record_journal.hpp"
#include "tests/fuzz/hdf5_edits.hpp"
#include "tests/fuzz/seeds.hpp"

namespace rvelab::fuzz {
namespace {

struct Part {
  std::uint32_t type;
  std::size_t number_bytes;  ///< in front of the HDF5
  Bytes payload;
};

const std::vector<Part>& parts() {
  static const std::vector<Part> all = [] {
    constexpr std::size_t number = 8;
    const io::RecordedTest test = seed_records();
    const Specimen& specimen = test.checkpoint.specimen;
    const auto& result = test.result;
    std::vector<Part> made{
        {io::begin_frame, 0, io::encode_begin({result.protocol, test.provenance.protocol, result.stages, specimen})}};
    for (std::size_t k = 0; k < std::min<std::size_t>(result.records.size(), 3); ++k) {
      made.push_back({io::record_frame, 0, io::encode_record(k, result.records[k])});
    }
    made.push_back({io::probe_frame, number, io::encode_probe(0, result.probes.at(0))});
    made.push_back({io::snapshot_frame, number, io::encode_snapshot(1, specimen)});
    records::Checkpoint checkpoint{{}, specimen};
    checkpoint.progress.records = 3;
    checkpoint.progress.stage = 2;
    made.push_back({io::checkpoint_frame, 0, io::encode_checkpoint(checkpoint)});
    return made;
  }();
  return all;
}

void put(Bytes& bytes, const void* from, std::size_t count) {
  const std::size_t before = bytes.size();
  bytes.resize(before + count);
  if (count > 0) std::memcpy(bytes.data() + before, from, count);
}

Bytes journal_of(const std::vector<Part>& frames) {
  Bytes bytes;
  put(bytes, "rvejrnl\n", 8);
  put(bytes, &io::journal_version, 4);
  const std::uint32_t head = io::crc32c(bytes);
  put(bytes, &head, 4);
  for (const Part& frame : frames) {
    Bytes whole;
    const std::uint64_t length = frame.payload.size();
    put(whole, &frame.type, 4);
    put(whole, &length, 8);
    const std::uint32_t sum = io::crc32c(frame.payload, io::crc32c(whole));
    put(whole, &sum, 4);
    put(whole, frame.payload.data(), frame.payload.size());
    put(bytes, whole.data(), whole.size());
  }
  return bytes;
}

/// Whether HDF5 may be shown what this frame holds.
bool harmless(std::uint32_t type, View payload) {
  if (type == io::record_frame || type < io::begin_frame || type > io::snapshot_frame) return true;
  return std::any_of(parts().begin(), parts().end(), [&](const Part& part) {
    const View hdf5 = View(part.payload).subspan(part.number_bytes);
    return part.type == type && payload.size() == part.payload.size() &&
           std::equal(hdf5.begin(), hdf5.end(), payload.begin() + static_cast<std::ptrdiff_t>(part.number_bytes));
  });
}

}  // namespace

Bytes whole_journal() { return journal_of(parts()); }

Bytes edited_journal(Choices& choices) {
  std::vector<Part> frames = parts();
  std::vector<Part*> with_hdf5;
  for (Part& part : frames) {
    if (part.type != io::record_frame) with_hdf5.push_back(&part);
  }
  Part& part = *choices.among(with_hdf5);
  const Bytes changed = edited(View(part.payload).subspan(part.number_bytes), choices);
  part.payload.resize(part.number_bytes);
  put(part.payload, changed.data(), changed.size());
  return journal_of(frames);
}

Bytes with_checksums(View journal) {
  Bytes bytes(journal.begin(), journal.end());
  if (bytes.size() < io::journal_header_bytes) return bytes;
  const std::uint32_t head = io::crc32c(View(bytes).first(12));
  std::memcpy(bytes.data() + 12, &head, sizeof head);
  std::size_t at = io::journal_header_bytes;
  while (bytes.size() - at >= io::frame_header_bytes) {
    std::uint32_t type;
    std::uint64_t length;
    std::memcpy(&type, bytes.data() + at, sizeof type);
    std::memcpy(&length, bytes.data() + at + 4, sizeof length);
    const std::size_t begin = at + io::frame_header_bytes;
    if (length > bytes.size() - begin) break;
    const View payload = View(bytes).subspan(begin, length);
    const std::uint32_t sum = io::crc32c(payload, io::crc32c(View(bytes).subspan(at, 12)));
    if (harmless(type, payload)) std::memcpy(bytes.data() + at + 12, &sum, sizeof sum);
    at = begin + length;
  }
  return bytes;
}

}  // namespace rvelab::fuzz
