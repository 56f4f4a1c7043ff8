// A team of threads that share out numbered pieces of work. What is computed must not depend on who does which piece.
//
// Where other processes want the cores, a thread may be off its core for milliseconds, and a meeting of threads then
// costs more than the work that it shares out. So nobody waits for a thread that has not come: a thread that comes late
// finds less to do. And the team keeps an account of what it gains: where that is a loss, the caller goes on alone, and
// tries again when the loss is small beside the time since.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "rvelab/error.hpp"

namespace rvelab {

/// Which pieces of work come before others: k after each of before[first[k]] .. before[first[k + 1] - 1], all less than
/// k.
struct WorkOrder {
  std::vector<std::size_t> first{0}, before;
  std::size_t pieces() const { return first.size() - 1; }

  struct Pair {
    std::size_t before, after;
  };
  WorkOrder() = default;
  WorkOrder(std::size_t pieces, const std::vector<Pair>& pairs);
};

/// The system gives fewer threads than were asked for.
struct NotStarted : Error {
  using Error::Error;
};

class Workers {
 public:
  /// Whether the threads share a loop: as the time says, always, or never. Results do not depend on it.
  enum class Sharing { measured, always, never };

  /// `threads` in all, the caller's included; 0 counts as 1. NotStarted if the system gives fewer.
  explicit Workers(unsigned threads);
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;
  ~Workers();

  unsigned count() const { return unsigned(threads_.size()) + 1; }
  Sharing sharing = Sharing::measured;

  /// work(k) for k in 0 .. pieces - 1, each once; returns when all are done. An exception of a piece does not stop the
  /// others, and that of the lowest piece is thrown at the end. A thread begins with a part of its own, the same in
  /// every call: points stay in the cache of its core. Then it helps those that are far behind.
  void for_each(std::size_t pieces, const std::function<void(std::size_t)>& work) {
    share(pieces, parts_.size(), nullptr, work);
  }
  /// The same, begun in the order of their numbers: for pieces of unlike length, the longest first.
  void for_each_in_turn(std::size_t pieces, const std::function<void(std::size_t)>& work) {
    share(pieces, 1, nullptr, work);
  }
  /// The same, and a piece begins when those before it are done; after a failure those of higher numbers are left out.
  void for_each_after(const WorkOrder& order, const std::function<void(std::size_t)>& work) {
    share(order.pieces(), 1, &order, work);
  }

 private:
  /// The pieces of one thread that are left, and what it did in this call. On cache lines of its own.
  struct alignas(128) Part {
    std::atomic<std::size_t> next{0};
    std::size_t end = 0;
    std::size_t made = 0;
    double worked = 0, waited = 0;  ///< s
  };
  /// What sharing gained of late.
  struct Account {
    double balance = 0;      ///< s
    double alone_until = 0;  ///< s, of wall_seconds()
  };
  void share(std::size_t pieces, std::size_t parts, const WorkOrder* order,
             const std::function<void(std::size_t)>& work);
  void together(std::size_t pieces, std::size_t parts);
  void meet(std::size_t first, std::size_t pieces, std::size_t parts);
  void book(Account& account, double begin) const;
  void leave();
  void serve(std::size_t thread);
  bool enter(std::uint64_t& seen);
  void take(std::size_t thread);
  bool others_finish(std::size_t thread, Part& own);
  void take_from(Part& from, Part& own);
  void make(std::size_t piece);
  void await_before(std::size_t piece, Part& own);
  template <class Condition>
  void await(double spinning, const Condition& condition);
  void tell();
  std::vector<std::thread> threads_;
  std::vector<Part> parts_;
  bool own_parts_ = false;  ///< of this call: each thread has one
  const std::function<void(std::size_t)>* work_ = nullptr;
  const WorkOrder* order_ = nullptr;
  std::vector<unsigned char> done_;  ///< by piece, where there is an order
  /// Calls so far, whether this one is open, threads inside (bits: see workers.cpp). Threads read the fields above only
  /// while they are inside, and the caller writes them only while none is.
  std::atomic<std::uint64_t> gate_{0};
  std::atomic<int> sleeping_{0}, waiting_{0};  ///< for a call; for an end
  std::atomic<bool> stop_{false};
  std::atomic<std::size_t> failed_piece_;  ///< the lowest of this call
  std::exception_ptr failure_;             ///< its exception
  std::mutex mutex_;
  std::condition_variable begin_, end_;
  Account brief_, long_;
};

}  // namespace rvelab
