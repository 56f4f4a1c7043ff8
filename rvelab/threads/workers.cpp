#include "rvelab/threads/workers.hpp"

#include <algorithm>
#include <chrono>
#include <limits>
#include <string>
#include <system_error>
#include <utility>

#include "rvelab/threads/classic_locale.hpp"

namespace rvelab {
namespace {

constexpr std::size_t no_piece = std::numeric_limits<std::size_t>::max();

/// s, from an arbitrary origin.
double wall_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// The gate: threads inside, one bit whether more may enter, number of the call.
constexpr std::uint64_t inside = 0xffff, open = 0x10000, next_call = 0x20000;

// s. A step has some twenty calls, many of them shorter than the time to wake a thread. A late thread may run on the
// core of the caller, so it spins only briefly.
constexpr double until_sleep = 150e-6, until_sleep_late = 20e-6, until_help = 20e-6;
// s. A loss of `loss` ends the sharing for `patience` times as long. Gains up to `most` are stored, so that a single
// delay does not end it. Loops longer than `brief` have a separate account.
constexpr double loss = 5e-3, most = 20e-3, patience = 20, brief = 2e-3;

void rest() {
#if defined(__x86_64__)
  __builtin_ia32_pause();
#elif defined(__aarch64__)
  asm volatile("yield");
#endif
}

/// Whether the condition becomes true within so many seconds. It spins without yielding: on a busy machine a yield
/// costs a time slice of other processes, thousands of times this wait.
template <class Condition>
bool soon(double seconds, const Condition& condition) {
  if (condition()) return true;
  const double until = wall_seconds() + seconds;
  do {
    for (int k = 0; k < 16; ++k) {
      rest();
      if (condition()) return true;
    }
  } while (wall_seconds() < until);
  return false;
}

}  // namespace

WorkOrder::WorkOrder(std::size_t pieces, const std::vector<Pair>& pairs) : first(pieces + 1, 0), before(pairs.size()) {
  for (const auto& pair : pairs) ++first[pair.after + 1];
  for (std::size_t k = 1; k < first.size(); ++k) first[k] += first[k - 1];
  auto next = first;
  for (const auto& pair : pairs) before[next[pair.after]++] = pair.before;
}

Workers::Workers(unsigned threads) : parts_(std::max(1u, threads)), failed_piece_(no_piece) {
  try {
    for (std::size_t k = 1; k < threads; ++k) threads_.emplace_back([this, k] { serve(k); });
  } catch (const std::system_error&) {
    const unsigned started = count();
    leave();
    throw NotStarted(std::to_string(threads) + " threads: the system starts no more than " + std::to_string(started) +
                     " here; lower --threads, or raise the limits (ulimit -u, ulimit -v)");
  } catch (...) {  // out of memory: destroying running threads would end the program
    leave();
    throw;
  }
}

Workers::~Workers() { leave(); }

void Workers::leave() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  begin_.notify_all();
  for (auto& thread : threads_) thread.join();
}

void Workers::share(std::size_t pieces, std::size_t parts, const WorkOrder* order,
                    const std::function<void(std::size_t)>& work) {
  work_ = &work;
  order_ = order;
  if (threads_.empty() || pieces <= 1 || sharing == Sharing::never)
    for (std::size_t k = 0; k < pieces; ++k) make(k);
  else
    together(pieces, parts);
  work_ = nullptr;
  if (failed_piece_ == no_piece) return;
  failed_piece_ = no_piece;
  std::rethrow_exception(std::exchange(failure_, nullptr));
}

/// Shares the loop unless the account forbids it. A long loop that the caller has begun alone is then shared.
void Workers::together(std::size_t pieces, std::size_t parts) {
  const double begin = wall_seconds();
  double now = begin;
  std::size_t first = 0;
  Account* account = &brief_;
  if (sharing == Sharing::measured && now < brief_.alone_until) {
    account = &long_;
    while (first < pieces && (now < begin + brief || now < long_.alone_until || first == pieces - 1)) {
      make(first++);
      now = wall_seconds();
    }
    if (first == pieces) return;
  }
  meet(first, pieces, parts);
  book(*account, now);
}

/// One block. In an ordered loop blocks above a failed one are skipped.
void Workers::make(std::size_t piece) {
  if (order_ != nullptr && piece > failed_piece_) return;
  try {
    (*work_)(piece);
  } catch (...) {
    const std::lock_guard lock(mutex_);
    if (piece > failed_piece_) return;
    failed_piece_ = piece;
    failure_ = std::current_exception();
  }
}

/// Blocks from `first` on, shared with the threads that enter.
void Workers::meet(std::size_t first, std::size_t pieces, std::size_t parts) {
  own_parts_ = parts > 1;
  for (std::size_t k = 0; k < parts_.size(); ++k) {
    Part& part = parts_[k];
    part.next = k < parts ? first + (pieces - first) * k / parts : 0;
    part.end = k < parts ? first + (pieces - first) * (k + 1) / parts : 0;
    part.made = 0;
    part.worked = part.waited = 0;
  }
  if (order_ != nullptr) {
    done_.assign(pieces, 0);
    std::fill_n(done_.begin(), first, 1);
  }
  gate_ += next_call + open;
  if (sleeping_ > 0) {
    // A thread that is going to sleep holds the mutex until it can be woken.
    { const std::lock_guard lock(mutex_); }
    begin_.notify_all();
  }
  take(0);
  gate_ -= open;
  await(until_sleep, [this] { return (gate_ & inside) == 0; });
}

/// The estimated time without sharing is the working time of the caller and the others. That of the others is limited
/// by the caller's time for as many blocks, since they may have been suspended meanwhile.
void Workers::book(Account& account, double begin) const {
  const double end = wall_seconds();
  const Part& caller = parts_[0];
  double alone = caller.worked;
  for (std::size_t k = 1; k < parts_.size(); ++k) {
    const Part& part = parts_[k];
    const double by_pieces = caller.made > 0 ? caller.worked / double(caller.made) * double(part.made) : part.worked;
    alone += std::min(part.worked, by_pieces);
  }
  account.balance = std::min(most, account.balance + alone - (end - begin));
  if (account.balance > -loss) return;
  account.alone_until = end - patience * account.balance;
  account.balance = 0;
}

void Workers::take(std::size_t thread) {
  Part& own = parts_[thread];
  const double begin = wall_seconds();
  take_from(own, own);
  if (!own_parts_ || !others_finish(thread, own)) {
    for (std::size_t k = 1; k < parts_.size(); ++k) take_from(parts_[(thread + k) % parts_.size()], own);
  }
  own.worked = wall_seconds() - begin - own.waited;
}

/// Whether the others begin all blocks of their parts. Taking over a block moves its points to this core's cache, and
/// the next loop moves them back. So this thread waits for an active one that is behind by less than a wake-up.
bool Workers::others_finish(std::size_t thread, Part& own) {
  const auto all_begun = [this] {
    return std::all_of(parts_.begin(), parts_.end(), [](const Part& part) { return part.next >= part.end; });
  };
  const auto nobody_came = [&] { return thread == 0 && (gate_ & inside) == 0; };
  const double begin = wall_seconds();
  soon(until_help, [&] { return all_begun() || nobody_came(); });
  own.waited += wall_seconds() - begin;
  return all_begun();
}

/// Makes the remaining blocks of a part.
void Workers::take_from(Part& from, Part& own) {
  for (std::size_t piece; (piece = from.next.fetch_add(1)) < from.end;) {
    if (order_ != nullptr) await_before(piece, own);
    make(piece);
    ++own.made;
    if (order_ == nullptr) continue;
    std::atomic_ref(done_[piece]).store(1);
    notify_waiting();
  }
}

void Workers::await_before(std::size_t piece, Part& own) {
  for (auto k = order_->first[piece]; k < order_->first[piece + 1]; ++k) {
    unsigned char& before = done_[order_->before[k]];
    const auto is_done = [&] { return std::atomic_ref(before).load() != 0; };
    if (is_done()) continue;
    const double begin = wall_seconds();
    await(until_sleep, is_done);
    own.waited += wall_seconds() - begin;
  }
}

/// Spins, then sleeps until notify_waiting(): sleeping leaves the core to the threads that it waits for.
template <class Condition>
void Workers::await(double spinning, const Condition& condition) {
  if (soon(spinning, condition)) return;
  std::unique_lock lock(mutex_);
  ++waiting_;
  end_.wait(lock, condition);
  --waiting_;
}

void Workers::notify_waiting() {
  if (waiting_ == 0) return;
  { const std::lock_guard lock(mutex_); }
  end_.notify_all();
}

/// Enters an open call in which this thread has not taken part.
bool Workers::enter(std::uint64_t& seen) {
  std::uint64_t gate = gate_;
  while ((gate & open) != 0 && gate / next_call != seen) {
    if (!gate_.compare_exchange_weak(gate, gate + 1)) continue;
    seen = gate / next_call;
    return true;
  }
  return false;
}

void Workers::serve(std::size_t thread) {
  const ClassicLocale locale;
  std::uint64_t seen = 0;
  double patient = until_sleep;
  while (!stop_) {
    bool entered = false;
    const auto called = [&] { return stop_ || (entered = enter(seen)); };
    if (!soon(patient, called)) {
      const auto is_open = [&] {
        const std::uint64_t gate = gate_;
        return stop_ || ((gate & open) != 0 && gate / next_call != seen);
      };
      std::unique_lock lock(mutex_);
      ++sleeping_;
      begin_.wait(lock, is_open);
      --sleeping_;
      patient = until_sleep_late;
      continue;
    }
    if (!entered) return;
    take(thread);
    --gate_;
    notify_waiting();
    patient = until_sleep;
  }
}

}  // namespace rvelab
