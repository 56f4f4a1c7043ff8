#include "rvelab/cli/interrupt.hpp"

#include <unistd.h>

#include <chrono>
#include <csignal>
#include <system_error>
#include <utility>

#include "rvelab/cli/command.hpp"
#include "rvelab/cli/report.hpp"

namespace rvelab::cli {
namespace {

// What a signal handler may touch: lock-free atomics.
std::atomic<bool> stop{false};
std::atomic<int> received{0};
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free);

extern "C" void ask_to_stop(int number) {
  received = number;
  stop = true;
  for (const int next : {SIGINT, SIGTERM}) std::signal(next, SIG_DFL);
}

}  // namespace

const std::atomic<bool>& stop_on_signals() {
  struct sigaction action {};
  action.sa_handler = ask_to_stop;
  action.sa_flags = SA_RESTART;
  for (const int number : {SIGINT, SIGTERM}) {
    // A shell starts background jobs with Ctrl-C ignored; that stays so.
    struct sigaction before {};
    if (sigaction(number, nullptr, &before) == 0 && before.sa_handler != SIG_IGN) sigaction(number, &action, nullptr);
  }
  return stop;
}

namespace {

void tell_stopped(const std::string& done) {
  tell(std::string("stopped by ") + (received == SIGINT ? "Ctrl-C" : "SIGTERM") + done);
}

}  // namespace

EndInASecond::EndInASecond(std::function<std::string()> done) {
  const auto watch = [this, done = std::move(done)] {
    using namespace std::chrono_literals;
    constexpr auto pause = 50ms, patience = 1000ms;
    {
      std::unique_lock lock(mutex_);
      for (auto waited = 0ms; waited < patience; waited += stop ? pause : 0ms)
        if (ended_.wait_for(lock, pause, [&] { return over_; })) return;
    }
    tell_stopped(done());
    ::_exit(128 + received);
  };
  try {
    thread_ = std::thread(watch);
  } catch (const std::system_error&) {  // no thread available: only phases that check for the signal end by it
  }
}

EndInASecond::~EndInASecond() {
  {
    const std::lock_guard lock(mutex_);
    over_ = true;
  }
  ended_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void end_stopped(const std::string& done) {
  tell_stopped(done);
  throw Exit(128 + received);
}

}  // namespace rvelab::cli
