// The program under test as a child process: started, signalled, waited for.
#pragma once

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
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
    while (waitpid(process_, &status, 0) < 0) continue;
    process_ = -1;
    return code_of(status);
  }

  /// The same within a time; -1: it goes on.
  int wait_for(double seconds) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    do {
      int status = 0;
      if (waitpid(process_, &status, WNOHANG) > 0) {
        process_ = -1;
        return code_of(status);
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    } while (std::chrono::steady_clock::now() < end);
    return -1;
  }

 private:
  static int code_of(int status) { return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status); }
  static std::vector<char*> pointers(std::vector<std::string>& texts) {
    std::vector<char*> list;
    for (auto& text : texts) list.push_back(text.data());
    list.push_back(nullptr);
    return list;
  }
  pid_t process_ = -1;
};

}  // namespace rvelab::test
