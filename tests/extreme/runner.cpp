#include "tests/extreme/runner.hpp"

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

class Child {
 public:
  explicit Child(const Case& one) : case_(&one) {
    void* shared = mmap(nullptr, sizeof(Left), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (shared == MAP_FAILED) throw Error("no memory is left for a case");
    left_ = new (shared) Left;
    process_ = fork();
    if (process_ < 0) throw Error("no process could be started for a case");
    if (process_ == 0) answer();
    setpgid(process_, process_);  // in both, so that neither has to wait for the other
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  ~Child() { munmap(left_, sizeof(Left)); }

  pid_t process() const { return process_; }

  /// Of a process that has ended.
  Result result(int status, const rusage& used) const {
    ::kill(-process_, SIGKILL);  // whatever it has started itself
    const auto seconds = [](const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); };
    Result found{case_, {}, seconds(used.ru_utime) + seconds(used.ru_stime)};
    std::string& text = found.answer.status;
    if (WIFSIGNALED(status)) {
      const int number = WTERMSIG(status);
      text = number == SIGXCPU || number == SIGALRM ? "time limit" : "signal " + std::to_string(number);
    } else if (WEXITSTATUS(status) != 0) {
      text = "exit code " + std::to_string(WEXITSTATUS(status));
    } else if (RVELAB_SANITIZED && double(used.ru_maxrss) > 1024 * case_->memory_MiB) {
      text = "memory limit";
    } else if (!left_->answered) {
      text = "no answer";
    } else {
      found.answer = {left_->outcome, left_->status, left_->error, left_->hash};
    }
    return found;
  }

 private:
  [[noreturn]] void answer() const {
    setpgid(0, 0);                     // so that its own children can be ended with it
    prctl(PR_SET_PDEATHSIG, SIGKILL);  // it never outlives the test
    for (int number = 1; number < NSIG; ++number) signal(number, SIG_DFL);
    const double seconds = std::ceil(case_->seconds * slower_when_sanitized);
    limit(RLIMIT_CPU, seconds, seconds + 1);
    limit(RLIMIT_CORE, 0, 0);
    const double bytes = case_->memory_MiB * 1024 * 1024;
    if (!RVELAB_SANITIZED) limit(RLIMIT_AS, bytes, bytes);
    const double longest = clock_over_limit * case_->seconds * slower_when_sanitized;
    const itimerval by_the_clock{{}, {time_t(longest), suseconds_t(1e6 * (longest - std::floor(longest)))}};
    setitimer(ITIMER_REAL, &by_the_clock, nullptr);
    const Answer found = answer_to(*case_);
#if defined(__SANITIZE_ADDRESS__)
    if (__lsan_do_recoverable_leak_check() != 0) _exit(1);
#endif
    left_->outcome = found.outcome;
    left_->error = found.error;
    left_->hash = found.hash;
    std::strncpy(left_->status, found.status.c_str(), sizeof left_->status - 1);
    left_->answered = true;
    _exit(0);
  }

  const Case* case_;
  Left* left_ = nullptr;
  pid_t process_ = -1;
};

}  // namespace

std::vector<Result> run(const std::vector<Case>& cases, unsigned at_a_time) {
  std::vector<Result> results(cases.size());
  std::map<pid_t, std::pair<std::unique_ptr<Child>, std::size_t>> running;
  std::fflush(nullptr);
  for (std::size_t started = 0; started < cases.size() || !running.empty();) {
    if (started < cases.size() && running.size() < at_a_time) {
      auto child = std::make_unique<Child>(cases[started]);
      const pid_t process = child->process();
      running[process] = {std::move(child), started++};
      continue;
    }
    int status = 0;
    rusage used{};
    const auto ended = running.find(wait4(-1, &status, 0, &used));
    if (ended == running.end()) continue;
    results[ended->second.second] = ended->second.first->result(status, used);
    running.erase(ended);
  }
  return results;
}

}  // namespace rvelab::test
