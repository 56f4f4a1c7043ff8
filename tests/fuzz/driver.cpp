#include "tests/fuzz/driver.hpp"

#include <signal.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <new>
#include <stdexcept>
#include <thread>

#include "tests/fuzz/mutate.hpp"

namespace rvelab::fuzz {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::uint64_t batch = 500;      // inputs of one child
constexpr double patience = 20;           // s for one input
constexpr rlim_t most_memory = 2u << 30;  // bytes of a child, beyond what it starts with

double seconds_since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

/// What a child says while it works, in memory that both see.
struct Shared {
  std::atomic<std::uint64_t> at{0};  ///< number of the input under way
  std::atomic<std::uint64_t> taken{0}, refused{0};
  char said[512] = {};
};

constexpr int finding_code = 42;

// A sanitizer's runtime takes terabytes of addresses.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool limited = false;
#else
constexpr bool limited = true;
#endif

void limit_memory() {
  if (!limited) return;
  unsigned long long pages = 0;
  if (std::FILE* file = std::fopen("/proc/self/statm", "r")) {
    if (std::fscanf(file, "%llu", &pages) != 1) pages = 0;
    std::fclose(file);
  }
  const rlim_t bytes = pages * static_cast<rlim_t>(::sysconf(_SC_PAGESIZE)) + most_memory;
  const struct rlimit limit { bytes, bytes };
  ::setrlimit(RLIMIT_AS, &limit);
}

[[noreturn]] void work(const Format& format, const std::vector<Bytes>& seeds, std::uint64_t end, Shared& shared) {
  limit_memory();
  for (const int fault : {SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL})
    ::signal(fault, SIG_DFL);  // not the parent's report
  for (; shared.at < end; ++shared.at) {
    try {
      const Answer answer = format.check(input_of(format, seeds, shared.at));
      ++(answer == Answer::taken ? shared.taken : shared.refused);
    } catch (const std::exception& error) {
      std::snprintf(shared.said, sizeof shared.said, "%s", error.what());
      ::_exit(finding_code);
    } catch (...) {
      std::snprintf(shared.said, sizeof shared.said, "something that is no exception of the standard library");
      ::_exit(finding_code);
    }
  }
  ::_exit(0);
}

/// Waits for the child; -1: one input took longer than the patience, and it was ended.
int wait_for(pid_t child, const Shared& shared) {
  std::uint64_t at = shared.at;
  auto since = Clock::now();
  while (true) {
    int status = 0;
    if (::waitpid(child, &status, WNOHANG) == child) return status;
    if (shared.at != at) {
      at = shared.at;
      since = Clock::now();
    }
    if (seconds_since(since) > patience) {
      ::kill(child, SIGKILL);
      ::waitpid(child, &status, 0);
      return -1;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
}

std::string in_words(int status, const Shared& shared) {
  if (status == -1) return "no end within " + std::to_string(static_cast<int>(patience)) + " s";
  if (WIFSIGNALED(status)) return "ended by signal " + std::to_string(WTERMSIG(status));
  if (WEXITSTATUS(status) == finding_code) return shared.said;
  return "ended with the exit code " + std::to_string(WEXITSTATUS(status));
}

}  // namespace

Bytes input_of(const Format& format, const std::vector<Bytes>& seeds, std::uint64_t number) {
  if (number < seeds.size()) return seeds[number];
  std::mt19937_64 random(number);
  return mutated(seeds, format.is_text, random);
}

Tally run(const Format& format, std::uint64_t mutations, double seconds, const std::string& folder) {
  const auto begin = Clock::now();
  const std::vector<Bytes> seeds = format.seeds();
  void* const memory = ::mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) throw std::runtime_error("no memory to share with a child process");
  Shared& shared = *new (memory) Shared;
  const std::uint64_t all = seconds > 0 ? ~std::uint64_t{0} : seeds.size() + mutations;
  Tally tally;
  std::uint64_t next = 0;
  while (next < all && (seconds <= 0 || seconds_since(begin) < seconds) && tally.findings.size() < 20) {
    const std::uint64_t end = std::min(all, next + batch);
    shared.at = next;
    const pid_t child = ::fork();
    if (child < 0) throw std::runtime_error("no child process could be started");
    if (child == 0) work(format, seeds, end, shared);
    const int status = wait_for(child, shared);
    next = shared.at;
    if (status == 0) continue;
    const std::string file = folder + "/" + format.name + "_" + std::to_string(next);
    const Bytes input = input_of(format, seeds, next);
    std::ofstream(file, std::ios::binary)
        .write(reinterpret_cast<const char*>(input.data()), static_cast<std::streamsize>(input.size()));
    tally.findings.push_back({in_words(status, shared), file});
    ++next;
  }
  tally.executions = next;
  tally.taken = shared.taken;
  tally.refused = shared.refused;
  tally.seconds = seconds_since(begin);
  ::munmap(memory, sizeof(Shared));
  return tally;
}

}  // namespace rvelab::fuzz
