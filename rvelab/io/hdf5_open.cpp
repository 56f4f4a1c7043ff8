// Opening a file. HDF5's library trusts the bytes of a file: of damaged ones that it was given, one in forty crashed it
// or kept it busy for ever. So it is shown a sealed file only after its checksum was found to fit. A file without a
// seal (of a version before 1.4, or changed by another program) is read by a child process with limits on time and
// memory, which copies what it finds; if the child fails, the file is refused, and nothing happened to this process.
// Declared in hdf5_file.hpp.
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <memory>
#include <mutex>
#include <new>
#include <span>

#include "rvelab/error.hpp"
#include "rvelab/io/descriptor.hpp"
#include "rvelab/io/guarded.hpp"
#include "rvelab/io/hdf5_file.hpp"
#include "rvelab/io/hdf5_raw.hpp"
#include "rvelab/io/journal.hpp"
#include "rvelab/io/seal.hpp"

namespace rvelab::io {
namespace {

using raw::Handle;

Descriptor opened(const std::string& path) {
  struct stat status;
  if (::stat(path.c_str(), &status) != 0) {
    const int reason = errno;
    if (reason == ENOENT && ::access(journal_of(path).c_str(), F_OK) == 0) {
      throw InputError(path +
                       ": there is only the journal of a run that was killed or goes on; make the file with `rvelab "
                       "recover " +
                       path + "`");
    }
    errno = reason;
    throw InputError(path + (errno == ENOENT || errno == ENOTDIR
                                 ? ": no such file; give the path of an HDF5 file that rvelab wrote"
                                 : ": cannot be opened (" + std::string(std::strerror(errno)) +
                                       "); give the path of an HDF5 file that rvelab wrote"));
  }
  if (!S_ISREG(status.st_mode)) {
    throw InputError(path + ": is not a regular file; give the path of an HDF5 file that rvelab wrote");
  }
  Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (!file.open()) {
    throw InputError(path + ": cannot be opened (" + std::strerror(errno) + "); check the permissions");
  }
  return file;
}

/// Which bytes a file held when it was looked at.
struct Identity {
  std::uint64_t device = 0, inode = 0, size = 0;
  std::int64_t changed_s = 0, changed_ns = 0;
  bool operator==(const Identity&) const = default;
};

Identity identity_in(const struct stat& status) {
  return {status.st_dev, status.st_ino, static_cast<std::uint64_t>(status.st_size), status.st_ctim.tv_sec,
          status.st_ctim.tv_nsec};
}

Identity identity_of(const Descriptor& file) {
  struct stat status;
  return ::fstat(file.number(), &status) == 0 ? identity_in(status) : Identity{};
}

/// Files that were checked before: a record file is opened once for each of its snapshots. A file that was changed
/// within the last seconds may change again without a new time, and is not remembered.
class Checked {
 public:
  bool sealed(const Identity& file) const { return std::find(sealed_.begin(), sealed_.end(), file) != sealed_.end(); }
  void remember_sealed(const Identity& file) {
    if (lasts(file)) sealed_[next_++ % sealed_.size()] = file;
  }
  /// The copy that was made of a file without a seal; none: no such file.
  std::shared_ptr<Descriptor> copy(const Identity& file) const { return file == copied_ ? copy_ : nullptr; }
  void remember_copy(const Identity& file, std::shared_ptr<Descriptor> copy) {
    if (!lasts(file)) return;
    copied_ = file;
    copy_ = std::move(copy);
  }

 private:
  static bool lasts(const Identity& file) {
    constexpr std::int64_t coarsest_clock = 2;  // s
    return file.changed_s != 0 && std::time(nullptr) - file.changed_s > coarsest_clock;
  }

  std::array<Identity, 8> sealed_{};
  std::size_t next_ = 0;
  Identity copied_;
  std::shared_ptr<Descriptor> copy_;
};

std::mutex checked_mutex;

Checked& checked() {
  static Checked files;
  return files;
}

bool begins_as_hdf5(const Descriptor& file) {
  constexpr unsigned char signature[8] = {0x89, 'H', 'D', 'F', '\r', '\n', 0x1a, '\n'};
  std::array<std::byte, sizeof signature> found;
  return read_at(file.number(), 0, found) == found.size() &&
         std::memcmp(found.data(), signature, sizeof signature) == 0;
}

/// The bytes of a file in memory, as long as this lives.
class Mapped {
 public:
  explicit Mapped(const Descriptor& file)
      : size_(identity_of(file).size), at_(::mmap(nullptr, size_, PROT_READ, MAP_PRIVATE, file.number(), 0)) {
    if (at_ == MAP_FAILED) throw std::bad_alloc();
  }
  Mapped(const Mapped&) = delete;
  Mapped& operator=(const Mapped&) = delete;
  ~Mapped() { ::munmap(at_, size_); }
  std::span<const std::byte> bytes() const { return {static_cast<const std::byte*>(at_), size_}; }

 private:
  std::size_t size_;
  void* at_;
};

[[noreturn]] void fail_opening(const std::string& path) {
  throw InputError(path + ": cannot be opened as HDF5 (" + raw::reason() +
                   "); the file is truncated or damaged: write or copy it again");
}

/// HDF5 opens by name. Whether what it opened is the file that was checked.
bool is_open(hid_t id, const Identity& wanted) {
  void* handle = nullptr;
  struct stat status;
  return H5Fget_vfd_handle(id, H5P_DEFAULT, &handle) >= 0 && ::fstat(*static_cast<int*>(handle), &status) == 0 &&
         identity_in(status) == wanted;
}

}  // namespace

Hdf5File Hdf5File::open(const std::string& path) {
  raw::silence();
  const std::lock_guard lock(checked_mutex);
  while (true) {
    const Descriptor file = opened(path);
    const Identity identity = identity_of(file);
    const bool sealed = checked().sealed(identity) || check_seal(file.number(), path);
    if (!begins_as_hdf5(file)) {
      throw InputError(path +
                       ": is not an HDF5 file; give a file that rvelab wrote (make one with `rvelab import` or "
                       "`rvelab run`)");
    }
    if (!sealed) {
      auto copy = checked().copy(identity);
      if (!copy) {
        copy = std::make_shared<Descriptor>(made_in_child(path, identity.size, [&] {
          const hid_t from = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
          if (from < 0) fail_opening(path);
          const auto to = in_memory(path);
          raw::copy_contents(from, to.id_, path, 8 * identity.size + (1 << 20));
          return to.image();
        }));
      }
      checked().remember_copy(identity, copy);
      Hdf5File in_memory = from_image(path, Mapped(*copy).bytes());
      in_memory.sealed_ = false;
      return in_memory;
    }
    checked().remember_sealed(identity);
    raw::expect_memory(0);
    const hid_t id = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    if (id >= 0 && is_open(id, identity)) return {path, id, true};
    if (id >= 0) {
      H5Fclose(id);
      continue;  // replaced by its writer since it was checked
    }
    fail_opening(path);
  }
}

}  // namespace rvelab::io
