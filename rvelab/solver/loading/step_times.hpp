// Where the time of an RVE goes (Rve::measure_time): grains, pairs, neighbour list, and the calls as
// wholes.
#pragma once

#include <atomic>
#include <chrono>

namespace rvelab {

/// Seconds; every thread at work adds its own. What calls take beyond the other three is control: balance, tolerance,
/// the stress servo, trials.
struct StepTimes {
  std::atomic<double> grains = 0;  ///< motion, with the gather of the forces
  std::atomic<double> pairs = 0;   ///< contacts
  std::atomic<double> list = 0;    ///< neighbour list
  std::atomic<double> calls = 0;   ///< apply, attempt and relax from their begin to their end
};

/// Adds to a sum of several threads; an addition of its own, since not every library has that of double.
inline void add_to(std::atomic<double>& sum, double more) {
  double before = sum.load();
  while (!sum.compare_exchange_weak(before, before + more)) {
  }
}

/// The clock of a row of sub-steps. Every sixteenth is measured and stands for the others, so that a sub-step of a
/// small RVE, of some microseconds, is not made slower by the clock; lists are measured each.
class StepClock {
 public:
  explicit StepClock(StepTimes* times) : times_(times) {
    if (times_ != nullptr) begin_ = Clock::now();
  }
  StepClock(const StepClock&) = delete;
  StepClock& operator=(const StepClock&) = delete;
  ~StepClock() {
    if (times_ == nullptr) return;
    const double sampled = grains_ + pairs_ + rest_;
    const double each = sampled > 0 ? (since(begin_) - list_) / sampled : 0;
    add_to(times_->grains, grains_ * each);
    add_to(times_->pairs, pairs_ * each);
    add_to(times_->list, list_);
  }

  bool samples(long number) const { return times_ != nullptr && number % 16 == 0; }
  void begin_step(long number) {
    sampled_ = samples(number);
    if (sampled_) last_ = Clock::now();
  }
  void begin_grains() { lap(rest_); }
  void end_grains() { lap(grains_); }
  void begin_list() {
    lap(rest_);
    if (times_ != nullptr) last_ = Clock::now();
  }
  void end_list() {
    if (times_ == nullptr) return;
    list_ += since(last_);
    last_ = Clock::now();
  }
  void begin_pairs() { lap(rest_); }
  void end_pairs() { lap(pairs_); }

 private:
  using Clock = std::chrono::steady_clock;
  static double since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }
  void lap(double& part) {
    if (!sampled_) return;
    const Clock::time_point now = Clock::now();
    part += std::chrono::duration<double>(now - last_).count();
    last_ = now;
  }

  StepTimes* times_;
  bool sampled_ = false;
  Clock::time_point begin_, last_;
  double grains_ = 0, pairs_ = 0, rest_ = 0, list_ = 0;
};

/// The clock of a call.
class CallClock {
 public:
  explicit CallClock(StepTimes* times) : times_(times) {
    if (times_ != nullptr) begin_ = std::chrono::steady_clock::now();
  }
  CallClock(const CallClock&) = delete;
  CallClock& operator=(const CallClock&) = delete;
  ~CallClock() {
    if (times_ != nullptr)
      add_to(times_->calls, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count());
  }

 private:
  StepTimes* times_;
  std::chrono::steady_clock::time_point begin_;
};

}  // namespace rvelab
