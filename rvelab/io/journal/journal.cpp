#include "rvelab/io/journal/journal.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstring>

#include "rvelab/error.hpp"
#include "rvelab/io/crc32c.hpp"

namespace rvelab::io {
namespace {

static_assert(std::endian::native == std::endian::little, "the journal is little-endian; swap bytes here");

constexpr char journal_magic[8] = {'r', 'v', 'e', 'j', 'r', 'n', 'l', '\n'};

template <class Value>
void put(std::byte* at, Value value) {
  std::memcpy(at, &value, sizeof value);
}

template <class Value>
Value get(const std::byte* at) {
  Value value;
  std::memcpy(&value, at, sizeof value);
  return value;
}

/// Type and length, then the checksum over them and the payload.
void put_header(std::byte* at, std::uint32_t type, std::span<const std::byte> payload) {
  put(at, type);
  put(at + 4, std::uint64_t(payload.size()));
  put(at + 12, crc32c(payload, crc32c({at, 12})));
}

[[noreturn]] void refuse_opening(const std::string& path, int reason) {
  throw InputError(path + ": cannot be opened (" + std::strerror(reason) + "); check the permissions");
}

/// Header of the file: whole and known (true), or torn (false). InputError if it is something else.
bool check_header(const std::string& path, int file) {
  std::byte header[journal_header_bytes];
  const auto found = read_at(file, 0, header);
  if (std::memcmp(header, journal_magic, std::min(found, sizeof journal_magic)) != 0) {
    throw InputError(path +
                     ": is not a journal of rvelab, or damaged at its start; remove it or start again with "
                     "--force");
  }
  if (found < sizeof header) return false;
  if (get<std::uint32_t>(header + 12) != crc32c({header, 12})) {
    throw InputError(path + ": is damaged at its start; remove it or start again with --force");
  }
  const auto version = get<std::uint32_t>(header + 8);
  if (version > journal_version) {
    throw InputError(path + ": has the format version " + std::to_string(version) + "; allowed: up to " +
                     std::to_string(journal_version) + "; open it with a newer rvelab");
  }
  return true;
}

}  // namespace

JournalExtent read_journal(const std::string& path, const std::function<void(const Frame&)>& visit) {
  JournalExtent extent;
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (!file.open() && errno == ENOENT) return extent;
  struct stat status;
  if (!file.open() || ::fstat(file.number(), &status) != 0) refuse_opening(path, errno);
  extent.exists = true;
  extent.file_bytes = std::uint64_t(status.st_size);
  extent.begun = check_header(path, file.number());
  extent.valid_bytes = extent.begun ? journal_header_bytes : 0;
  std::vector<std::byte> payload;
  while (extent.begun && extent.file_bytes - extent.valid_bytes >= frame_header_bytes) {
    std::byte header[frame_header_bytes];
    if (read_at(file.number(), extent.valid_bytes, header) < sizeof header) break;
    const auto length = get<std::uint64_t>(header + 4);
    const std::uint64_t begin = extent.valid_bytes + frame_header_bytes;
    if (length > extent.file_bytes - begin) break;
    payload.resize(length);
    if (read_at(file.number(), begin, payload) < length) break;
    if (get<std::uint32_t>(header + 12) != crc32c(payload, crc32c({header, 12}))) break;
    visit({get<std::uint32_t>(header), payload, begin});
    extent.valid_bytes = begin + length;
  }
  extent.torn = extent.valid_bytes < extent.file_bytes;
  return extent;
}

std::vector<std::byte> read_payload(const std::string& path, std::uint64_t payload_at, std::uint64_t length) {
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (!file.open()) refuse_opening(path, errno);
  std::vector<std::byte> payload(length);
  if (read_at(file.number(), payload_at, payload) < length) {
    throw Error(path + ": ends before a frame that was in it; another program has changed it");
  }
  return payload;
}

Journal::Journal(const std::string& path) : path_(path) {
  while (true) {
    file_ = Descriptor(::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666));
    if (!file_.open()) {
      throw InputError(path + ": cannot be written (" + std::strerror(errno) +
                       "); give a path in an existing folder that you may write to");
    }
    if (::flock(file_.number(), LOCK_EX | LOCK_NB) != 0) {
      if (errno == EINTR) continue;
      if (errno == EWOULDBLOCK) {
        throw Busy(path + ": another rvelab is writing it; wait for it, stop it, or give another name with -o");
      }
      throw InputError(path + ": cannot be locked (" + std::strerror(errno) +
                       "); give a path on a file system with locks, and copy the file later");
    }
    // The writer before may have removed the file between our open and our lock: then another one has its name.
    struct stat mine, named;
    if (::fstat(file_.number(), &mine) != 0) refuse_opening(path, errno);
    if (::stat(path.c_str(), &named) == 0 && mine.st_ino == named.st_ino && mine.st_dev == named.st_dev) {
      size_ = std::uint64_t(mine.st_size);
      return;
    }
  }
}

Journal::~Journal() {
  // A journal that never began is no more than a name.
  if (file_.open() && size_ == 0) ::unlink(path_.c_str());
}

void Journal::begin() {
  if (::ftruncate(file_.number(), 0) != 0 || ::lseek(file_.number(), 0, SEEK_SET) != 0) fail(errno);
  size_ = 0;
  std::byte header[journal_header_bytes];
  std::memcpy(header, journal_magic, sizeof journal_magic);
  put(header + 8, journal_version);
  put(header + 12, crc32c({header, 12}));
  if (!write_all(file_.number(), header)) fail(errno);
  size_ = sizeof header;
}

void Journal::go_on(std::uint64_t valid_bytes) {
  if (::ftruncate(file_.number(), off_t(valid_bytes)) != 0 ||
      ::lseek(file_.number(), off_t(valid_bytes), SEEK_SET) < 0) {
    fail(errno);
  }
  size_ = valid_bytes;
}

std::uint64_t Journal::append(std::uint32_t type, std::span<const std::byte> payload) {
  if (failed_) throw Error(path_ + ": could not be written before; nothing more is");
  std::vector<std::byte> frame(frame_header_bytes + payload.size());
  put_header(frame.data(), type, payload);
  std::copy(payload.begin(), payload.end(), frame.begin() + frame_header_bytes);
  if (!write_all(file_.number(), frame)) fail(errno);
  const std::uint64_t payload_at = size_ + frame_header_bytes;
  size_ += frame.size();
  return payload_at;
}

void Journal::sync() {
  if (::fsync(file_.number()) != 0) fail(errno);
}

void Journal::replace(const std::function<void(Journal&)>& fill) {
  Journal next;
  next.path_ = path_ + ".tmp";
  next.file_ = Descriptor(::open(next.path_.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0666));
  try {
    // Nobody else opens a file of this name while the journal of the old one is locked.
    if (!next.file_.open() || ::flock(next.file_.number(), LOCK_EX | LOCK_NB) != 0) next.fail(errno);
    next.begin();
    fill(next);
    next.sync();
    if (::rename(next.path_.c_str(), path_.c_str()) != 0) next.fail(errno);
  } catch (...) {
    next.remove();
    throw;
  }
  sync_folder_of(path_);
  std::swap(file_, next.file_);
  std::swap(size_, next.size_);
  next.file_ = Descriptor();
}

void Journal::remove() {
  ::unlink(path_.c_str());
  file_ = Descriptor();
}

void Journal::fail(int reason) {
  failed_ = true;
  // Best effort: a frame cut in two is cut off by the next reader all the same.
  [[maybe_unused]] const int cut = ::ftruncate(file_.number(), off_t(size_));
  throw Error(path_ + ": could not be written (" + std::strerror(reason) +
              "); free space, then go on with --resume; what was recorded before is kept");
}

}  // namespace rvelab::io
