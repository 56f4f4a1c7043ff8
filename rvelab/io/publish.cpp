// Writing a whole file so that a reader, or a kill at any moment, finds the old one or the new one.
#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "rvelab/error.hpp"
#include "rvelab/io/hdf5_file.hpp"

namespace rvelab {
namespace {

/// A file descriptor that closes itself.
struct Descriptor {
  int number;
  explicit Descriptor(int opened) : number(opened) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (number >= 0) ::close(number);
  }
};

bool write_all(int descriptor, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const auto written = ::write(descriptor, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  return true;
}

[[noreturn]] void fail(const std::string& path, const std::string& temporary, int reason) {
  ::unlink(temporary.c_str());
  throw Error(path + ": could not be written (" + std::strerror(reason) +
              "); free space or choose another place with -o; what was there before is untouched");
}

}  // namespace

void publish(const std::string& path, const std::function<void(Hdf5File&)>& fill) {
  auto file = Hdf5File::in_memory(path);
  fill(file);
  const auto bytes = file.image();

  const std::string temporary = path + ".tmp";
  {
    const Descriptor output(::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666));
    if (output.number < 0) {
      throw InputError(path + ": cannot be written (" + std::strerror(errno) +
                       "); give a path in an existing folder that you may write to");
    }
    if (!write_all(output.number, bytes) || ::fsync(output.number) != 0) fail(path, temporary, errno);
  }
  if (::rename(temporary.c_str(), path.c_str()) != 0) fail(path, temporary, errno);

  const auto folder = std::filesystem::path(path).parent_path();
  const Descriptor directory(::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (directory.number >= 0) ::fsync(directory.number);  // the new name; not every file system offers it
}

}  // namespace rvelab
