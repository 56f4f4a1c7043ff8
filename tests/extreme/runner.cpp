// Runs cases, each in a process of its own with limits on processor time and memory, several at a time.

#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstring>
#include <exception>
#include <new>

#include "rvelab/error.hpp"
#include "tests/extreme/matrix.hpp"

// Sanitizers reserve terabytes of addresses: there the resident memory is looked at once a case has ended. They are
// slow.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define RVELAB_SANITIZED 1
#else
#define RVELAB_SANITIZED 0
#endif
#if defined(__SANITIZE_ADDRESS__)
#include <sanitizer/lsan_interface.h>
#endif

namespace rvelab::test {

namespace {

/// A process that waits uses no processor time; it may last so many times its limit by the clock.
constexpr double clock_over_limit = 4;
constexpr double slower_when_sanitized = RVELAB_SANITIZED ? 60 : 1;

/// What a child leaves, in memory that both share.
struct Left {
  bool answered = false;
  Outcome outcome = Outcome::wrong;
  std::optional<double> error;
  std::optional<std::uint64_t> hash;
  char status[601] = "";
};

Answer answer_to(const Case& one) {
  Verdict verdict;
  Answer failed;
  try {
    one.experiment->run(one, verdict);
    return verdict.answer(one.may_flag);
  } catch (const Refused& refusal) {
    return verdict.answer(refusal, one.may_refuse);
  } catch (const std::bad_alloc&) {
    failed.status = "memory limit";
  } catch (const std::exception& error) {
    failed.status = std::string("the experiment could not be made: ") + error.what();
  }
  return failed;
}

void limit(int resource, double soft, double hard) {
  const rlimit wanted{rlim_t(soft), rlim_t(hard)};
  setrlimit(resource, &wanted);
}

/// In the process of the case, which ends with it.
[[noreturn]] void answer(const Case& one, Left& left) {
  setpgid(0, 0);                     // so that its own children can be ended with it
  prctl(PR_SET_PDEATHSIG, SIGKILL);  // it never outlives the test
  for (int number = 1; number < NSIG; ++number) signal(number, SIG_DFL);
  const double seconds = std::ceil(one.seconds * slower_when_sanitized);
  limit(RLIMIT_CPU, seconds, seconds + 1);
  limit(RLIMIT_CORE, 0, 0);
  const double bytes = one.memory_MiB * 1024 * 1024;
  if (!RVELAB_SANITIZED) limit(RLIMIT_AS, bytes, bytes);
  const double longest = clock_over_limit * one.seconds * slower_when_sanitized;
  const itimerval by_the_clock{{}, {time_t(longest), suseconds_t(1e6 * (longest - std::floor(longest)))}};
  setitimer(ITIMER_REAL, &by_the_clock, nullptr);
  const Answer found = answer_to(one);
#if defined(__SANITIZE_ADDRESS__)
  if (__lsan_do_recoverable_leak_check() != 0) _exit(1);
#endif
  left.outcome = found.outcome;
  left.error = found.error;
  left.hash = found.hash;
  std::strncpy(left.status, found.status.c_str(), sizeof left.status - 1);
  left.answered = true;
  _exit(0);
}

/// What became of a process that has ended.
Answer answer_of(const Case& one, const Left& left, int status, const rusage& used) {
  Answer found;
  if (WIFSIGNALED(status)) {
    const int number = WTERMSIG(status);
    found.status = number == SIGXCPU || number == SIGALRM ? "time limit" : "signal " + std::to_string(number);
  } else if (WEXITSTATUS(status) != 0) {
    found.status = "exit code " + std::to_string(WEXITSTATUS(status));
  } else if (RVELAB_SANITIZED && double(used.ru_maxrss) > 1024 * one.memory_MiB) {
    found.status = "memory limit";
  } else if (!left.answered) {
    found.status = "no answer";
  } else {
    found = {left.outcome, left.status, left.error, left.hash};
  }
  return found;
}

}  // namespace

std::vector<Result> run(const std::vector<Case>& cases, unsigned at_a_time) {
  const std::size_t bytes = cases.size() * sizeof(Left);
  void* shared = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (shared == MAP_FAILED) throw Error("no memory is left for the answers");
  Left* left = new (shared) Left[cases.size()];
  std::vector<Result> results(cases.size());
  std::map<pid_t, std::size_t> running;
  std::fflush(nullptr);
  for (std::size_t started = 0; started < cases.size() || !running.empty();) {
    if (started < cases.size() && running.size() < at_a_time) {
      const pid_t process = fork();
      if (process < 0) throw Error("no process could be started for a case");
      if (process == 0) answer(cases[started], left[started]);
      setpgid(process, process);  // in both, so that neither has to wait for the other
      running[process] = started++;
      continue;
    }
    int status = 0;
    rusage used{};
    const auto ended = running.find(wait4(-1, &status, 0, &used));
    if (ended == running.end()) continue;
    const auto [process, k] = *ended;
    ::kill(-process, SIGKILL);  // whatever it has started itself
    const auto seconds = [](const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); };
    results[k] = {&cases[k], answer_of(cases[k], left[k], status, used),
                  seconds(used.ru_utime) + seconds(used.ru_stime)};
    running.erase(ended);
  }
  munmap(shared, bytes);
  return results;
}

}  // namespace rvelab::test
