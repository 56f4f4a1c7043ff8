#include "tools/mpm/workers.hpp"

#include <algorithm>
#include <utility>

#include "tools/mpm/tensors.hpp"

namespace mpm {
namespace {

/// Whether it comes true within so many times that a thread gives way, a third of a microsecond each. A step has a
/// score of calls, many of which are shorter than it takes to wake a thread.
template <class Condition>
bool soon(int times, const Condition& condition) {
  for (int k = 0; k < times; ++k) {
    if (condition()) return true;
    std::this_thread::yield();
  }
  return false;
}

constexpr int until_sleep = 512, until_help = 64;

}  // namespace

Workers::Workers(int count) {
  if (count <= 0) count = int(std::max(1u, std::thread::hardware_concurrency()));
  try {
    for (int k = 1; k < count; ++k) threads_.emplace_back([this, k] { serve(k); });
  } catch (const std::exception&) {
    const int started = this->count();
    end();
    throw InputError("-j " + std::to_string(count) + ": the system starts no more than " + std::to_string(started) +
                     " threads here; give fewer");
  }
  parts_ = std::vector<Part>(count);
}

Workers::~Workers() { end(); }

void Workers::end() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  begin_.notify_all();
  for (auto& thread : threads_) thread.join();
}

void Workers::share(std::int64_t pieces, std::int64_t parts, const std::function<void(std::int64_t)>& work) {
  if (threads_.empty() || pieces <= 1) {
    for (std::int64_t k = 0; k < pieces; ++k) work(k);
    return;
  }
  {
    const std::lock_guard lock(mutex_);
    work_ = &work;
    own_parts_ = parts > 1;
    for (std::int64_t k = 0; k < std::int64_t(parts_.size()); ++k) {
      parts_[k].next = k < parts ? pieces * k / parts : 0;
      parts_[k].end = k < parts ? pieces * (k + 1) / parts : 0;
    }
    busy_ = int(threads_.size());
    ++round_;
  }
  begin_.notify_all();
  take(0);
  if (!soon(until_sleep, [this] { return busy_ == 0; })) {
    std::unique_lock lock(mutex_);
    end_.wait(lock, [this] { return busy_ == 0; });
  }
  work_ = nullptr;
  if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
}

void Workers::take(int thread) {
  try {
    const auto make = [this](Part& part) {
      for (std::int64_t piece; (piece = part.next.fetch_add(1)) < part.end;) (*work_)(piece);
    };
    make(parts_[thread]);
    // A piece that is taken over moves its points to this core's cache, and the next loop moves them back: a thread
    // that is behind by less than a wake-up is waited for.
    const auto all_begun = [this] {
      return std::all_of(parts_.begin(), parts_.end(), [](const Part& part) { return part.next >= part.end; });
    };
    if (own_parts_ && soon(until_help, all_begun)) return;
    for (std::size_t k = 1; k < parts_.size(); ++k) make(parts_[(thread + k) % parts_.size()]);
  } catch (...) {
    for (Part& part : parts_) part.next = part.end;
    const std::lock_guard lock(mutex_);
    if (!failure_) failure_ = std::current_exception();
  }
}

void Workers::serve(int thread) {
  std::uint64_t seen = 0;
  for (;;) {
    const auto called = [&] { return stop_ || round_ != seen; };
    if (!soon(until_sleep, called)) {
      std::unique_lock lock(mutex_);
      begin_.wait(lock, called);
    }
    if (stop_) return;
    seen = round_;
    take(thread);
    if (busy_.fetch_sub(1) == 1) {
      const std::lock_guard lock(mutex_);
      end_.notify_one();
    }
  }
}

}  // namespace mpm
