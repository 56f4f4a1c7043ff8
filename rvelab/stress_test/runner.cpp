#include "rvelab/stress_test/runner.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <fstream>
#include <optional>
#include <thread>

#include "rvelab/error.hpp"
#include "rvelab/stress_test/run_case.hpp"

// Sanitizers reserve terabytes of addresses: there the resident memory alone is watched.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define RVELAB_LIMITS_ADDRESSES 0
#else
#define RVELAB_LIMITS_ADDRESSES 1
#endif

namespace rvelab::stress_test {

namespace {

using Clock = std::chrono::steady_clock;

constexpr auto look_every = std::chrono::milliseconds(5);

/// A child that waits uses no processor time; it may last so many times its limit by the clock.
constexpr double clock_over_limit = 4;

/// In the child between fork and exec: system calls only.
void limit(int resource, rlim_t soft, rlim_t hard) {
  const rlimit wanted{soft, hard};
  setrlimit(resource, &wanted);
}

class Child {
 public:
  Child(const Case& one, const std::vector<std::string>& command) : case_(&one), start_(Clock::now()) {
    std::vector<std::string> words = command;
    words.push_back(one.name);
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) throw Error("no pipe to a child process could be made; close other programs");
    process_ = fork();
    if (process_ < 0) throw Error("no child process could be started; close other programs or lower --jobs");
    if (process_ == 0) become(arguments.data(), ends[1]);
    setpgid(process_, process_);  // here too, so that kill() never comes too early
    close(ends[1]);
    answer_ = ends[0];
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  ~Child() {
    if (process_ > 0) {
      ::kill(-process_, SIGKILL);
      waitpid(process_, nullptr, 0);
    }
    close(answer_);
  }

  /// The result once the child has ended; it is ended here if it exceeds its limits.
  std::optional<Result> look() {
    int status = 0;
    rusage used{};
    if (wait4(process_, &status, WNOHANG, &used) != process_) {
      enforce_limits();
      return std::nullopt;
    }
    ::kill(-process_, SIGKILL);  // whatever it has started itself
    process_ = -1;
    const auto seconds = [](const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); };
    return Result{case_, answer_of(status), seconds(used.ru_utime) + seconds(used.ru_stime)};
  }

 private:
  [[noreturn]] void become(char** arguments, int answer) const {
    setpgid(0, 0);                     // so that its own children can be ended with it
    prctl(PR_SET_PDEATHSIG, SIGKILL);  // it never outlives the program
    for (const int number : {SIGINT, SIGTERM}) signal(number, SIG_DFL);
    dup2(answer, STDOUT_FILENO);
    const auto whole_seconds = rlim_t(std::ceil(case_->seconds));
    limit(RLIMIT_CPU, whole_seconds, whole_seconds + 1);
    limit(RLIMIT_CORE, 0, 0);
    const auto bytes = rlim_t(case_->memory_MiB * 1024 * 1024);
    if (RVELAB_LIMITS_ADDRESSES) limit(RLIMIT_AS, bytes, bytes);
    execv("/proc/self/exe", arguments);
    _exit(127);
  }

  void enforce_limits() {
    const double waited = std::chrono::duration<double>(Clock::now() - start_).count();
    if (waited > clock_over_limit * case_->seconds) end("time limit");
    if (!RVELAB_LIMITS_ADDRESSES && resident_MiB() > case_->memory_MiB) end("memory limit");
  }

  void end(const char* reason) {
    if (!ended_.empty()) return;
    ended_ = reason;
    ::kill(-process_, SIGKILL);
  }

  double resident_MiB() const {
    std::ifstream statm("/proc/" + std::to_string(process_) + "/statm");
    double all = 0, resident = 0;
    statm >> all >> resident;
    return resident * double(sysconf(_SC_PAGESIZE)) / (1024 * 1024);
  }

  Answer answer_of(int status) const {
    Answer failed;
    if (!ended_.empty()) {
      failed.status = ended_;
    } else if (WIFSIGNALED(status)) {
      const int number = WTERMSIG(status);
      failed.status = number == SIGXCPU ? "time limit" : "signal " + std::to_string(number);
    } else if (WEXITSTATUS(status) != 0) {
      failed.status = "exit code " + std::to_string(WEXITSTATUS(status));
    } else {
      std::string text;
      char buffer[4096];
      for (ssize_t count = 0; (count = read(answer_, buffer, sizeof buffer)) > 0;) text.append(buffer, size_t(count));
      return read_answer(text);
    }
    return failed;
  }

  const Case* case_;
  Clock::time_point start_;
  pid_t process_ = -1;
  int answer_ = -1;
  std::string ended_;
};

}  // namespace

std::vector<Result> run(const std::vector<Case>& cases, const Running& running) {
  struct Slot {
    std::unique_ptr<Child> child;
    std::size_t index = 0;
  };
  std::vector<Slot> slots(std::max(1u, running.jobs));
  std::vector<std::optional<Result>> found(cases.size());
  std::size_t started = 0, told = 0;
  while (told < cases.size()) {
    if (running.stop != nullptr && running.stop->load()) throw Interrupted();  // children end with their slots
    for (Slot& slot : slots) {
      if (slot.child == nullptr && started < cases.size()) {
        slot.index = started;
        slot.child = std::make_unique<Child>(cases[started++], running.command);
      }
      if (slot.child == nullptr) continue;
      if (auto result = slot.child->look()) {
        found[slot.index] = std::move(result);
        slot.child.reset();
      }
    }
    for (; told < cases.size() && found[told]; ++told)
      if (running.on_result) running.on_result(*found[told]);
    if (told < cases.size()) std::this_thread::sleep_for(look_every);
  }
  std::vector<Result> results;
  for (auto& result : found) results.push_back(std::move(*result));
  return results;
}

}  // namespace rvelab::stress_test
