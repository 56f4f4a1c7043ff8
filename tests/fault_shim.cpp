// Preloaded (LD_PRELOAD) into the program under test: ends it, or fails a call, in the middle of writing a file. The
// program itself knows nothing of it. RVELAB_FAULT = "CALL NUMBER ACTION": the NUMBER-th CALL (write, fsync, rename,
// unlink; from 1) on a file that ends in .journal or .tmp meets with ACTION:
//   kill F      write: only the fraction F of the bytes is written, then SIGKILL
//   before      SIGKILL instead of the call
//   after       SIGKILL after the call
//   enospc, eio the call fails with that error, and so does every later one of its kind
// RVELAB_FAULT = "proc 1 unmounted": /proc/self/exe is not there, as where /proc is not mounted.
#include <dlfcn.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace {

struct Fault {
  char call[16] = "", action[16] = "";
  long number = 0;
  double fraction = 0;
};

const Fault& fault() {
  static const Fault wanted = [] {
    Fault read;
    if (const char* text = std::getenv("RVELAB_FAULT")) {
      std::sscanf(text, "%15s %ld %15s %lf", read.call, &read.number, read.action, &read.fraction);
    }
    return read;
  }();
  return wanted;
}

bool ends_in(const char* path, const char* end) {
  const std::size_t length = std::strlen(path), tail = std::strlen(end);
  return length >= tail && std::strcmp(path + length - tail, end) == 0;
}

bool watched(const char* path) { return ends_in(path, ".journal") || ends_in(path, ".tmp"); }

bool watched(int descriptor) {
  char link[64], path[4096];
  std::snprintf(link, sizeof link, "/proc/self/fd/%d", descriptor);
  const auto length = ::readlink(link, path, sizeof path - 1);
  if (length <= 0) return false;
  path[length] = '\0';
  return watched(path);
}

[[noreturn]] void die() {
  ::kill(::getpid(), SIGKILL);
  while (true) ::pause();
}

bool is(const char* action) { return std::strcmp(fault().action, action) == 0; }

/// Whether this call is the one; counts the calls of its kind on watched files.
template <class File>
bool hit(const char* call, File file) {
  static std::atomic<long> calls{0};
  if (std::strcmp(fault().call, call) != 0 || !watched(file)) return false;
  const long number = ++calls;
  return number == fault().number || (number > fault().number && (is("enospc") || is("eio")));
}

template <class Function>
Function* next(const char* name) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

/// A call that is done whole or not at all.
template <class Call>
int meet(Call call) {
  if (is("before")) die();
  if (is("enospc") || is("eio")) {
    errno = is("eio") ? EIO : ENOSPC;
    return -1;
  }
  const int result = call();
  if (is("after")) die();
  return result;
}

}  // namespace

extern "C" ssize_t write(int descriptor, const void* bytes, size_t count) {
  static auto* const real = next<ssize_t(int, const void*, size_t)>("write");
  if (!hit("write", descriptor)) return real(descriptor, bytes, count);
  if (is("kill")) {
    const auto part = static_cast<size_t>(fault().fraction * static_cast<double>(count));
    [[maybe_unused]] const auto written = real(descriptor, bytes, std::min(part, count));
    die();
  }
  if (is("before")) die();
  if (is("after")) {
    [[maybe_unused]] const auto written = real(descriptor, bytes, count);
    die();
  }
  // A disc that fills up takes a part first, and says so at the next call.
  static std::atomic<bool> full{false};
  if (is("enospc") && !full.exchange(true) && count > 1) return real(descriptor, bytes, count / 2);
  errno = is("eio") ? EIO : ENOSPC;
  return -1;
}

extern "C" int fsync(int descriptor) {
  static auto* const real = next<int(int)>("fsync");
  return hit("fsync", descriptor) ? meet([&] { return real(descriptor); }) : real(descriptor);
}

extern "C" int rename(const char* from, const char* to) noexcept {
  static auto* const real = next<int(const char*, const char*)>("rename");
  return hit("rename", from) ? meet([&] { return real(from, to); }) : real(from, to);
}

extern "C" int unlink(const char* path) noexcept {
  static auto* const real = next<int(const char*)>("unlink");
  return hit("unlink", path) ? meet([&] { return real(path); }) : real(path);
}

extern "C" ssize_t readlink(const char* path, char* to, size_t size) noexcept {
  static auto* const real = next<ssize_t(const char*, char*, size_t)>("readlink");
  if (std::strcmp(fault().call, "proc") != 0 || std::strcmp(path, "/proc/self/exe") != 0) return real(path, to, size);
  errno = ENOENT;
  return -1;
}
