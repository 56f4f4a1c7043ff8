// The program under test as a child process: started, signalled, waited for.
#pragma once

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <chrono>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

extern char** environ;

namespace rvelab::test {

/// A child with its output and errors in files.
class Child {
 public:
  /// `fault`: what tests/fault_shim.cpp is to do; "": nothing, and it is not loaded.
  Child(std::vector<std::string> arguments, const std::string& output, const std::string& errors,
        const std::string& fault = "") {
    std::vector<std::string> environment;
    for (char** entry = environ; *entry != nullptr; ++entry) environment.emplace_back(*entry);
    if (!fault.empty()) {
      environment.push_back("LD_PRELOAD=" RVELAB_FAULT_SHIM);
      environment.push_back("RVELAB_FAULT=" + fault);
      environment.push_back("ASAN_OPTIONS=verify_asan_link_order=0");  // the shim stands before its runtime
    }
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions, 1, output.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
    posix_spawn_file_actions_addopen(&actions, 2, errors.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
    // Test runners may start with Ctrl-C ignored, which children inherit.
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    sigset_t defaults;
    sigemptyset(&defaults);
    sigaddset(&defaults, SIGINT);
    sigaddset(&defaults, SIGTERM);
    posix_spawnattr_setsigdefault(&attributes, &defaults);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF);
    const int failed = posix_spawn(&process_, arguments.front().c_str(), &actions, &attributes,
                                   pointers(arguments).data(), pointers(environment).data());
    posix_spawn_file_actions_destroy(&actions);
    posix_spawnattr_destroy(&attributes);
    if (failed != 0) throw std::runtime_error("no child process could be started");
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  ~Child() {
    if (process_ > 0) {
      signal(SIGKILL);
      wait();
    }
  }

  void signal(int number) const { ::kill(process_, number); }

  /// Exit code, or 128 plus the number of the signal that ended it.
  int wait() {
    int status = 0;
    while (wait4(process_, &status, 0, &used_) < 0) continue;
    process_ = -1;
    return code_of(status);
  }

  /// The same within a time; -1: it goes on.
  int wait_for(double seconds) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    do {
      int status = 0;
      if (wait4(process_, &status, WNOHANG, &used_) > 0) {
        process_ = -1;
        return code_of(status);
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    } while (std::chrono::steady_clock::now() < end);
    return -1;
  }

  /// Processor time of all its threads, s; of one that was waited for, in all. Other work on the machine is not in it.
  double processor_seconds() const {
    if (process_ < 0) return seconds_of(used_.ru_utime) + seconds_of(used_.ru_stime);
    clockid_t clock;
    timespec now{};
    if (clock_getcpuclockid(process_, &clock) != 0 || clock_gettime(clock, &now) != 0) return 0;
    return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
  }

  /// Waits until it has worked for so much longer (s of processor time), two minutes at most; false: it had ended.
  bool works_for(double seconds) const {
    const double until = processor_seconds() + seconds;
    for (int k = 0; k < 60'000; ++k) {
      if (processor_seconds() >= until) return true;
      siginfo_t ended{};
      if (waitid(P_PID, id_t(process_), &ended, WEXITED | WNOHANG | WNOWAIT) == 0 && ended.si_pid != 0) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return false;
  }

 private:
  static double seconds_of(const timeval& time) { return double(time.tv_sec) + 1e-6 * double(time.tv_usec); }
  static int code_of(int status) { return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status); }
  static std::vector<char*> pointers(std::vector<std::string>& texts) {
    std::vector<char*> list;
    for (auto& text : texts) list.push_back(text.data());
    list.push_back(nullptr);
    return list;
  }
  pid_t process_ = -1;
  rusage used_{};  // once it was waited for
};

}  // namespace rvelab::test
