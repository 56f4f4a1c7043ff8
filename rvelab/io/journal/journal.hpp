// The journal of a run, R.h5.journal: an append-only file of frames, each with its length and checksum. If a run is
// killed, all frames before the last one are whole; the longest prefix of valid frames counts.
//
// Layout, little-endian (rvelab/io/README.md has the meaning of the frames):
//   header  8 bytes "rvejrnl\n", uint32 format version, uint32 CRC-32C of the twelve bytes before it
//   frame   uint32 type, uint64 length of the payload, uint32 CRC-32C over type, length and payload, payload
// This file knows frames, not their contents.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "rvelab/error.hpp"
#include "rvelab/io/descriptor.hpp"
#include "rvelab/io/publish.hpp"

namespace rvelab::io {

inline constexpr std::uint32_t journal_version = 1;
inline constexpr std::size_t journal_header_bytes = 16, frame_header_bytes = 16;

struct Frame {
  std::uint32_t type;
  std::span<const std::byte> payload;  ///< valid during the visit only
  std::uint64_t payload_at;            ///< its offset in the file
};

/// How much of a journal is valid.
struct JournalExtent {
  bool exists = false;
  bool begun = false;             ///< its header is whole
  bool torn = false;              ///< it ends in part of a header or frame, or in a frame whose checksum is wrong
  std::uint64_t valid_bytes = 0;  ///< header and whole frames
  std::uint64_t file_bytes = 0;
};

/// Shows every valid frame in order. A journal that is missing, cut or damaged has fewer of them. InputError: the file
/// cannot be opened, is no journal, or of a newer format.
JournalExtent read_journal(const std::string& path, const std::function<void(const Frame&)>& visit);

/// The payload of one frame that read_journal or append placed at `payload_at`.
std::vector<std::byte> read_payload(const std::string& path, std::uint64_t payload_at, std::uint64_t length);

/// Another process, or another part of this one, writes to that place.
struct Busy : InputError {
  using InputError::InputError;
};

/// The one writer of a journal: holds its lock as long as it lives.
class Journal {
 public:
  /// Opens the journal, or makes an empty file of its name, and takes its lock. Busy: another process holds it;
  /// InputError: the place cannot be written to; its file system has no locks.
  explicit Journal(const std::string& path);
  Journal(Journal&&) = default;
  Journal& operator=(Journal&&) = default;
  ~Journal();

  /// Throws everything away and writes the header.
  void begin();
  /// Keeps the first bytes (JournalExtent::valid_bytes) and appends after them.
  void go_on(std::uint64_t valid_bytes);
  /// Appends a frame by one write; returns where its payload begins. If that fails, what was written of it is cut off
  /// again, and Error names file and reason; later calls fail at once.
  std::uint64_t append(std::uint32_t type, std::span<const std::byte> payload);
  /// To the disc itself. Without it a frame survives the end of the process but perhaps not a power loss.
  void sync();
  /// Puts another journal in the place of this one at once (rename), with the frames that `fill` appends to it: a
  /// reader finds the old frames or the new ones. The lock goes over to it. Error as append; the old journal then
  /// stays.
  void replace(const std::function<void(Journal&)>& fill);
  /// Removes the file. The lock goes with it.
  void remove();

  bool failed() const { return failed_; }
  const std::string& path() const { return path_; }
  std::uint64_t size() const { return size_; }

 private:
  Journal() = default;
  [[noreturn]] void fail(int reason);

  std::string path_;
  Descriptor file_;
  std::uint64_t size_ = 0;
  bool failed_ = false;
};

}  // namespace rvelab::io
