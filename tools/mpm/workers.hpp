// Threads that share out numbered pieces of work. What is computed must not depend on who does which piece.
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

class Workers {
 public:
  /// `count` threads, the caller's included; 0: as many as the processor runs at once. InputError if the system gives
  /// fewer.
  explicit Workers(int count);
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;
  ~Workers();

  int count() const { return int(threads_.size()) + 1; }

  /// work(k) for k in 0 .. pieces - 1, each once; returns when all are done. The first exception is thrown again. A
  /// thread begins with a part of its own, the same in every call: points stay in the cache of its core. Then it helps
  /// those that are far behind.
  void for_each(std::int64_t pieces, const std::function<void(std::int64_t)>& work) {
    share(pieces, std::int64_t(parts_.size()), work);
  }
  /// The same, begun in the order of their numbers: for pieces of unlike length, the longest first.
  void for_each_in_turn(std::int64_t pieces, const std::function<void(std::int64_t)>& work) { share(pieces, 1, work); }

 private:
  /// The pieces of one thread that are left. On cache lines of its own.
  struct alignas(128) Part {
    std::atomic<std::int64_t> next{0};
    std::int64_t end = 0;
  };
  void share(std::int64_t pieces, std::int64_t parts, const std::function<void(std::int64_t)>& work);
  void end();
  void serve(int thread);
  void take(int thread);
  std::vector<std::thread> threads_;
  std::vector<Part> parts_;
  bool own_parts_ = false;  ///< of this call: each thread has one
  std::mutex mutex_;
  std::condition_variable begin_, end_;
  const std::function<void(std::int64_t)>* work_ = nullptr;
  std::atomic<std::uint64_t> round_{0};
  std::atomic<int> busy_{0};
  std::atomic<bool> stop_{false};
  std::exception_ptr failure_;
};

}  // namespace mpm
