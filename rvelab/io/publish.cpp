#include "rvelab/io/publish.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <iterator>
#include <thread>

#include "rvelab/error.hpp"
#include "rvelab/io/descriptor.hpp"

namespace rvelab::io {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void fail(const std::string& path, const std::string& temporary, int reason) {
  ::unlink(temporary.c_str());
  throw Error(path + ": could not be written (" + std::strerror(reason) +
              "); free space or choose another place with -o; what was there before is untouched");
}

[[noreturn]] void refuse_place(const std::string& path, int reason) {
  throw InputError(path + ": cannot be written (" + std::strerror(reason) +
                   "); give a path in an existing folder that you may write to");
}

void expect_regular(const std::string& path) {
  struct stat status;
  if (::stat(path.c_str(), &status) != 0 || S_ISREG(status.st_mode)) return;
  const char* const kind = S_ISDIR(status.st_mode)    ? "a folder"
                           : S_ISFIFO(status.st_mode) ? "a pipe"
                           : S_ISSOCK(status.st_mode) ? "a socket"
                                                      : "a device";
  throw InputError(path + ": is " + kind +
                   "; allowed: a file, which is replaced as a whole; give another name with -o");
}

/// Opens the file that is written, empty, and keeps other programs from it.
Descriptor taken(const std::string& path, const std::string& temporary) {
  constexpr std::chrono::seconds patience(30);
  const auto begin = std::chrono::steady_clock::now();
  while (true) {
    Descriptor output(::open(temporary.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666));
    if (!output.open()) refuse_place(path, errno);
    if (::flock(output.number(), LOCK_EX | LOCK_NB) == 0) {
      // The writer before may have renamed the file between our open and our lock: then it is another's result.
      struct stat mine, named;
      const bool same = ::fstat(output.number(), &mine) == 0 && ::stat(temporary.c_str(), &named) == 0 &&
                        mine.st_ino == named.st_ino && mine.st_dev == named.st_dev;
      if (!same) continue;
    } else if (errno == EWOULDBLOCK || errno == EINTR) {
      if (std::chrono::steady_clock::now() - begin > patience) {
        throw Error(path + ": another program is writing it and does not end; stop it, or give another name with -o");
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
      continue;
    }  // else a file system without locks: the last writer wins
    if (::ftruncate(output.number(), 0) != 0 && errno != EINVAL) fail(path, temporary, errno);  // EINVAL: no file
    return output;
  }
}

}  // namespace

std::string followed(const std::string& path) {
  fs::path at = path;
  std::error_code error;
  constexpr int most_links = 40;  // as the kernel
  for (int links = 0; links < most_links && fs::is_symlink(at, error); ++links) {
    const fs::path target = fs::read_symlink(at, error);
    if (error) break;
    at = target.is_absolute() ? target : at.parent_path() / target;
  }
  return at.string();
}

void expect_place(const std::string& path, const std::vector<std::string>& inputs) {
  const std::string place = followed(path);
  for (const std::string& input : inputs) {
    std::error_code ignored;
    for (const char* ending : {"", ".tmp", ".journal"}) {
      if (!fs::equivalent(input, place + ending, ignored)) continue;
      throw InputError("-o " + path + " would replace " + input +
                       ", which it is made from; allowed: another name; choose one");
    }
  }
  expect_regular(place);
}

void expect_output(const std::string& path, bool force, const std::vector<std::string>& inputs,
                   const std::string& otherwise) {
  expect_place(path, inputs);
  std::error_code ignored;
  if (force || !fs::exists(path, ignored)) return;
  throw InputError(path + ": is there already; allowed: a new name" + otherwise + ", or --force to overwrite it");
}

void publish_bytes(const std::string& path, std::initializer_list<std::span<const std::byte>> parts, Sync sync) {
  const std::string place = followed(path), temporary = place + ".tmp";
  expect_regular(place);
  {
    const Descriptor output = taken(path, temporary);
    for (const auto bytes : parts) {
      if (!write_all(output.number(), bytes)) fail(path, temporary, errno);
    }
    if (sync == Sync::now && ::fsync(output.number()) != 0) fail(path, temporary, errno);
    // Under the lock: a second writer finds its file gone, and makes another.
    if (::rename(temporary.c_str(), place.c_str()) != 0) fail(path, temporary, errno);
  }
  if (sync == Sync::now) sync_folder_of(place);
}

std::string exact(double value) {
  char text[32];
  return {text, std::to_chars(std::begin(text), std::end(text), value).ptr};
}

void publish_text(const std::string& path, const std::string& text, Sync sync) {
  publish_bytes(path, {std::as_bytes(std::span(text))}, sync);
}

}  // namespace rvelab::io
