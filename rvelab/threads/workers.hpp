// A team of threads that share numbered blocks of work. The result must not depend on which thread makes which block.
//
// If other processes use the cores, a thread may be suspended for milliseconds, and synchronising threads then costs
// more than the shared work. So no thread waits for one that has not started: a late thread finds less work. The team
// also measures the time that sharing gains. After a loss the caller works alone, and tries again when the loss is
// small compared with the time since.
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

/// Dependencies of blocks: k comes after each of before[first[k]] .. before[first[k + 1] - 1], all less than k.
struct WorkOrder {
  std::vector<std::size_t> first{0}, before;
  std::size_t pieces() const { return first.size() - 1; }

  struct Pair {
    std::size_t before, after;
  };
  WorkOrder() = default;
  WorkOrder(std::size_t pieces, const std::vector<Pair>& pairs);
};

/// The system starts fewer threads than requested.
struct NotStarted : Error {
  using Error::Error;
};

class Workers {
 public:
  /// Whether the threads share a loop: by the measured gain, always, or never. Results do not depend on it.
  enum class Sharing { measured, always, never };

  /// `threads` in total, including the caller; 0 counts as 1. NotStarted if the system starts fewer.
  explicit Workers(unsigned threads);
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;
  ~Workers();

  unsigned count() const { return unsigned(threads_.size()) + 1; }
  Sharing sharing = Sharing::measured;

  /// work(k) for k in 0 .. pieces - 1, each once; returns when all have ended. An exception of a block does not stop
  /// the others; that of the lowest block is thrown at the end. A thread begins with its own part, the same in every
  /// call, so that points stay in the cache of its core. Then it takes over blocks of threads that are far behind.
  void for_each(std::size_t pieces, const std::function<void(std::size_t)>& work) {
    share(pieces, parts_.size(), nullptr, work);
  }
  /// The same, begun in the order of their numbers: for blocks of unequal length, the longest first.
  void for_each_in_turn(std::size_t pieces, const std::function<void(std::size_t)>& work) {
    share(pieces, 1, nullptr, work);
  }
  /// The same; a block begins when those before it have ended; after a failure blocks of higher numbers are skipped.
  void for_each_after(const WorkOrder& order, const std::function<void(std::size_t)>& work) {
    share(order.pieces(), 1, &order, work);
  }

 private:
  /// The remaining blocks of one thread, and its work in this call. On separate cache lines.
  struct alignas(128) Part {
    std::atomic<std::size_t> next{0};
    std::size_t end = 0;
    std::size_t made = 0;
    double worked = 0, waited = 0;  ///< s
  };
  /// Recent gain by sharing.
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
  void notify_waiting();
  std::vector<std::thread> threads_;
  std::vector<Part> parts_;
  bool own_parts_ = false;  ///< each thread has a part of its own in this call
  const std::function<void(std::size_t)>* work_ = nullptr;
  const WorkOrder* order_ = nullptr;
  std::vector<unsigned char> done_;  ///< of each block, if there is an order
  /// Calls so far, whether this one is open, threads inside (bits: see workers.cpp). Threads read the fields above only
  /// while they are inside, and the caller writes them only while no thread is inside.
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
