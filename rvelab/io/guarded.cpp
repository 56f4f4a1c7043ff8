#include "rvelab/io/guarded.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <span>

#include "rvelab/error.hpp"

namespace rvelab::io {
namespace {

// How the child ends; anything else is the damage's doing.
constexpr int made = 0, told = 10, no_memory = 11;

using Resource = __rlimit_resource_t;

/// Lowers a limit. False: it was as low before.
bool lower(Resource resource, std::uint64_t value) {
  struct rlimit before;
  if (::getrlimit(resource, &before) != 0) return false;
  if (before.rlim_cur != RLIM_INFINITY && before.rlim_cur <= value) return false;
  const struct rlimit now {
    value, before.rlim_max
  };  // beyond the hard limit on time SIGKILL would come, which says less
  return ::setrlimit(resource, &now) == 0;
}

std::uint64_t own_memory() {
  unsigned long long pages = 0;
  if (std::FILE* file = std::fopen("/proc/self/statm", "r")) {
    if (std::fscanf(file, "%llu", &pages) != 1) pages = 0;
    std::fclose(file);
  }
  return pages * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

std::uint64_t seconds_for(std::uint64_t size) { return 3 + size / 10'000'000; }

[[noreturn]] void live_as_child(const Descriptor& target, std::uint64_t size,
                                const std::function<std::vector<std::byte>()>& make) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  for (const int stop : {SIGINT, SIGTERM, SIGHUP, SIGQUIT}) std::signal(stop, SIG_IGN);  // the parent answers those
  for (const int fault : {SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL, SIGXCPU, SIGALRM}) std::signal(fault, SIG_DFL);
  // What a library says while it dies is not for the user.
  const int nowhere = ::open("/dev/null", O_RDWR);
  for (const int standard : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) ::dup2(nowhere, standard);
  lower(RLIMIT_CORE, 0);
  lower(RLIMIT_CPU, seconds_for(size));
  ::alarm(static_cast<unsigned>(60 + 20 * seconds_for(size)));  // a child that waits for ever uses no time
  constexpr std::uint64_t libraries = 256 << 20;
  const bool own_limit = lower(RLIMIT_AS, own_memory() + libraries + 8 * size);
  try {
    ::_exit(write_all(target.number(), make()) ? made : no_memory);
  } catch (const InputError& error) {
    const std::string text = error.what();
    ::_exit(write_all(target.number(), std::as_bytes(std::span(text))) ? told : no_memory);
  } catch (...) {
    ::_exit(own_limit ? -1 : no_memory);
  }
}

std::string text_in(const Descriptor& file) {
  std::string text(1 << 16, '\0');
  text.resize(read_at(file.number(), 0, std::as_writable_bytes(std::span(text))));
  return text;
}

}  // namespace

Descriptor made_in_child(const std::string& path, std::uint64_t size,
                         const std::function<std::vector<std::byte>()>& make) {
  const auto fail = [&](const std::string& why) {
    throw Error(path + ": has no checksum and is read by a process of its own, which could not be had (" + why +
                "); free memory or processes");
  };
  Descriptor target(::memfd_create("rvelab", MFD_CLOEXEC));
  if (!target.open()) fail(std::strerror(errno));
  const pid_t child = ::fork();
  if (child < 0) fail(std::strerror(errno));
  if (child == 0) live_as_child(target, size, make);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) fail(std::strerror(errno));
  }
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  if (code == made) return target;
  if (code == told) throw InputError(text_in(target));
  if (code == no_memory) fail("no memory");
  const int signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  const std::string what = signal == SIGXCPU || signal == SIGALRM
                               ? "reading it came to no end within " + std::to_string(seconds_for(size)) + " s"
                               : "HDF5 fails while it reads it";
  throw InputError(path + ": is damaged (" + what +
                   "); copy it again from where it was made, or write it again; nothing of it was read");
}

}  // namespace rvelab::io
