// Threads that share out numbered pieces of work. What is computed must not depend on who does which piece.
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

namespace mpm {

/// Which pieces of work come before others: k after each of before[first[k]] .. before[first[k + 1] - 1], all less than
/// k.
struct WorkOrder {
  std::vector<std::int64_t> first{0}, before;
  std::int64_t pieces() const { return std::int64_t(first.size()) - 1; }

  struct Pair {
    std::int64_t before, after;
  };
  WorkOrder() = default;
  WorkOrder(std::int64_t pieces, const std::vector<Pair>& pairs);
};

class Workers {
 public:
  /// Whether the threads share a loop: as the time says, always, or never. Results do not depend on it.
  enum class Sharing { measured, always, never };

  /// `count` threads, the caller's included; 0: as many as the processor runs at once. InputError if the system gives
  /// fewer.
  explicit Workers(int count);
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;
  ~Workers();

  int count() const { return int(threads_.size()) + 1; }
  Sharing sharing = Sharing::measured;

  /// work(k) for k in 0 .. pieces - 1, each once; returns when all are done. The first exception is thrown again. A
  /// thread begins with a part of its own, the same in every call: points stay in the cache of its core. Then it helps
  /// those that are far behind.
  void for_each(std::int64_t pieces, const std::function<void(std::int64_t)>& work) {
    share(pieces, std::int64_t(parts_.size()), nullptr, work);
  }
  /// The same, begun in the order of their numbers: for pieces of unlike length, the longest first.
  void for_each_in_turn(std::int64_t pieces, const std::function<void(std::int64_t)>& work) {
    share(pieces, 1, nullptr, work);
  }
  /// The same, and a piece begins when those before it are done.
  void for_each_after(const WorkOrder& order, const std::function<void(std::int64_t)>& work) {
    share(order.pieces(), 1, &order, work);
  }

 private:
  /// The pieces of one thread that are left, and what it did in this call. On cache lines of its own.
  struct alignas(128) Part {
    std::atomic<std::int64_t> next{0};
    std::int64_t end = 0;
    std::int64_t made = 0;
    double worked = 0, waited = 0;  ///< s
  };
  /// What sharing gained of late.
  struct Account {
    double balance = 0;      ///< s
    double alone_until = 0;  ///< s, of wall_seconds()
  };
  void share(std::int64_t pieces, std::int64_t parts, const WorkOrder* order,
             const std::function<void(std::int64_t)>& work);
  void meet(std::int64_t first, std::int64_t pieces, std::int64_t parts);
  void book(Account& account, double begin) const;
  void end();
  void serve(int thread);
  bool enter(std::uint64_t& seen);
  void take(int thread);
  bool others_finish(int thread, Part& own);
  void make(Part& from, Part& own);
  void await_before(std::int64_t piece, Part& own);
  template <class Condition>
  void await(double spinning, const Condition& condition);
  void tell();
  void fail();
  std::vector<std::thread> threads_;
  std::vector<Part> parts_;
  bool own_parts_ = false;  ///< of this call: each thread has one
  const std::function<void(std::int64_t)>* work_ = nullptr;
  const WorkOrder* order_ = nullptr;
  std::vector<unsigned char> done_;  ///< by piece, where there is an order
  /// Calls so far, whether this one is open, threads inside (bits: see workers.cpp). Threads read the fields above only
  /// while they are inside, and the caller writes them only while none is.
  std::atomic<std::uint64_t> gate_{0};
  std::atomic<int> sleeping_{0}, waiting_{0};  ///< for a call; for an end
  std::atomic<bool> stop_{false}, failed_{false};
  std::exception_ptr failure_;
  std::mutex mutex_;
  std::condition_variable begin_, end_;
  Account brief_, long_;
};

}  // namespace mpm
