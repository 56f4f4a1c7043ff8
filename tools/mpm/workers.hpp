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

  /// work(k) for k in 0 .. pieces - 1, each once; returns when all are done. The first exception is thrown again.
  void for_each(std::int64_t pieces, const std::function<void(std::int64_t)>& work);

 private:
  void end();
  void serve();
  void take();
  std::vector<std::thread> threads_;
  std::mutex mutex_;
  std::condition_variable begin_, end_;
  const std::function<void(std::int64_t)>* work_ = nullptr;
  std::int64_t pieces_ = 0;
  std::atomic<std::int64_t> next_{0};
  std::atomic<std::uint64_t> round_{0};
  std::atomic<int> busy_{0};
  std::atomic<bool> stop_{false};
  std::exception_ptr failure_;
};

}  // namespace mpm
