// Where the RVEs of a pool live, who is at work on each, and which of them rest.
#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <memory>
#include <vector>

#include "rvelab/pool/id_table.hpp"
#include "rvelab/pool/tokens.hpp"
#include "rvelab/solver/rve.hpp"

namespace rvelab::pool {

/// One RVE of the pool.
struct Resident {
  Rve rve;
  Tokens tokens;
  double initial_void_ratio = 0;
  double inertial_number = 0;        ///< of the last committed step
  double trial_inertial_number = 0;  ///< of the pending trial
  bool pending = false;              ///< the last trial of `tokens` is; its state may have been let go of
};

struct Slot {
  std::unique_ptr<Resident> resident;         ///< null: the slot is free
  std::atomic<std::uint64_t> owner{0};        ///< serial number of the call that is at work on it; 0: none
  std::atomic<std::uint64_t> last_call{0};    ///< by the pool's count of calls on RVEs
  std::atomic<std::uint64_t> grain_steps{0};  ///< made in this pool, trials included
  std::atomic<bool> allocated{false};
  std::uint64_t last_grain_steps = 0;  ///< of the last call: what the next will cost
};

/// Changed only by calls that are alone in the pool: `add`, `remove` and what they say; the rest by calls at work.
class Slots {
 public:
  /// The slot of an id. Throws Refused (bad_id) if it is null, stale, foreign, rounded, or none.
  Slot& at(std::int64_t id) { return slots_[ids_.slot_of(id)]; }
  /// Makes room for n more. All or nothing is taken by `add`, which then cannot fail. Refused (no_slot): all are used.
  void make_room(std::size_t n);
  /// Puts an RVE into a free slot; its id. Room must have been made.
  std::int64_t add(std::unique_ptr<Resident> resident) noexcept;
  void remove(std::int64_t id) noexcept;

  std::size_t size() const { return slots_.size(); }  ///< slots, from 0; those that hold nothing too
  Slot& operator[](std::size_t slot) { return slots_[slot]; }
  const IdTable& ids() const { return ids_; }
  void take_tag() { ids_.take_tag(); }

  using Residents = std::vector<std::unique_ptr<Resident>>;
  /// As a file has them: a generation for each slot, and the RVEs of the ids. The table must be without RVEs.
  void restore(std::uint32_t tag, const std::vector<std::uint32_t>& generations, std::span<const std::int64_t> ids,
               Residents residents);
  /// RVEs under ids that another table gave out, all or none; and away again.
  void claim(std::span<const std::int64_t> ids, Residents residents);
  void give_up(std::int64_t id) noexcept;

 private:
  void settle(std::size_t slot, std::unique_ptr<Resident> resident) noexcept;

  IdTable ids_;
  std::deque<Slot> slots_;  ///< as many as ids_ has, or fewer after memory ran out
};

}  // namespace rvelab::pool
