// Writing a whole file so that a reader, or a kill at any moment, finds the old one or the new one.
#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "rvelab/error.hpp"
#include "rvelab/io/descriptor.hpp"
#include "rvelab/io/hdf5_file.hpp"

namespace rvelab {
namespace {

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
    const io::Descriptor output(::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666));
    if (!output.open()) {
      throw InputError(path + ": cannot be written (" + std::strerror(errno) +
                       "); give a path in an existing folder that you may write to");
    }
    if (!io::write_all(output.number(), bytes) || ::fsync(output.number()) != 0) fail(path, temporary, errno);
  }
  if (::rename(temporary.c_str(), path.c_str()) != 0) fail(path, temporary, errno);
  io::sync_folder_of(path);
}

}  // namespace rvelab
