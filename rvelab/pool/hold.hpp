// Who is at work in a pool: calls on RVEs beside each other, each holding its RVEs, or one call alone.
#pragma once

#include <utility>

#include "rvelab/pool/threaded_pool.hpp"

namespace rvelab::pool {

/// An RVE that a call is at work on; let go of at the end.
class Hold {
 public:
  Hold() = default;
  explicit Hold(Slot& slot) : slot_(&slot) {}
  Hold(Hold&& other) noexcept : slot_(std::exchange(other.slot_, nullptr)) {}
  Hold& operator=(Hold&& other) noexcept {
    let_go();
    slot_ = std::exchange(other.slot_, nullptr);
    return *this;
  }
  ~Hold() { let_go(); }
  bool empty() const { return slot_ == nullptr; }
  Slot& slot() const { return *slot_; }
  Resident& resident() const { return *slot_->resident; }

 private:
  void let_go() noexcept {
    if (slot_ != nullptr) slot_->owner.store(0, std::memory_order_release);
  }
  Slot* slot_ = nullptr;
};

/// A call that works on RVEs.
class ThreadedPool::AtWork {
 public:
  explicit AtWork(ThreadedPool& pool) : pool_(pool) {
    pool.expect_this_process();
    int calls = pool.calls_.load(std::memory_order_relaxed);
    do {
      if (calls < 0) throw Refused(Status::busy, "pool: a call for population or files is under way; call again after");
    } while (!pool.calls_.compare_exchange_weak(calls, calls + 1, std::memory_order_acquire));
  }
  ~AtWork() { pool_.calls_.fetch_sub(1, std::memory_order_release); }
  AtWork(const AtWork&) = delete;
  AtWork& operator=(const AtWork&) = delete;

 private:
  ThreadedPool& pool_;
};

/// A call that no other may run beside.
class ThreadedPool::Alone {
 public:
  explicit Alone(ThreadedPool& pool) : pool_(pool) {
    pool.expect_this_process();
    int none = 0;
    if (!pool.calls_.compare_exchange_strong(none, -1, std::memory_order_acquire))
      throw Refused(Status::busy, "pool: another call is under way; population and files are for one call alone");
  }
  ~Alone() { pool_.calls_.store(0, std::memory_order_release); }
  Alone(const Alone&) = delete;
  Alone& operator=(const Alone&) = delete;

 private:
  ThreadedPool& pool_;
};

/// The committed state in the place of a pending trial, for as long as it is looked at.
class Committed {
 public:
  explicit Committed(Rve& rve) : rve_(rve) { rve.exchange(); }
  ~Committed() { rve_.exchange(); }
  Committed(const Committed&) = delete;
  Committed& operator=(const Committed&) = delete;

 private:
  Rve& rve_;
};

}  // namespace rvelab::pool
