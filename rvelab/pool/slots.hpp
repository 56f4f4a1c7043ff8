// Where the RVEs of a pool live, under which ids, who is at work on each, and which of them rest.
//
// Ids: pool tag (10 bits), generation (17), slot (26): 53 bits, exact in a double. A slot that is released gets the
// next generation, so that the old id is seen to be stale; when its generations are used up it is retired. Tag and
// first generation are drawn at random for each pool, so that an id of another pool or process is seen to be foreign.
// Single precision keeps 24 bits: with a tag above zero it changes the lowest 20 bits of the slot to zeros. Slots whose
// lowest 20 bits are zero are never used, so that a rounded id is seen to be one.
#pragma once

#include <atomic>
#include <deque>
#include <memory>

#include "rvelab/pool/rve_state.hpp"
#include "rvelab/solver/rve.hpp"

namespace rvelab::pool {

constexpr int slot_bits = 26, generation_bits = 17, tag_bits = 10;
constexpr std::uint32_t slot_limit = 1u << slot_bits;              ///< slots are below
constexpr std::uint32_t generation_limit = 1u << generation_bits;  ///< generations are below, and above 0
constexpr std::uint32_t tag_limit = 1u << tag_bits;                ///< tags are below, and above 0
constexpr std::uint32_t first_limit = 1u << 16;  ///< first generations are below, and above 0: half are left for reuse

/// From 1 to below `limit`, at most 2^52; no other pool or process can know it. No result of a calculation depends on
/// it.
std::int64_t drawn_below(std::int64_t limit);

struct Id {
  std::uint32_t tag = 0, generation = 0, slot = 0;

  static constexpr Id of(std::int64_t value) {
    return {std::uint32_t(value >> (slot_bits + generation_bits)),
            std::uint32_t(value >> slot_bits) & (generation_limit - 1), std::uint32_t(value) & (slot_limit - 1)};
  }
  constexpr std::int64_t value() const {
    return std::int64_t(tag) << (slot_bits + generation_bits) | std::int64_t(generation) << slot_bits | slot;
  }
};

/// Whether a slot may be in use; others hold nothing.
constexpr bool is_usable(std::uint32_t slot) { return (slot & ((1u << 20) - 1)) != 0; }

/// Which ids of a pool are in use. Changed only by calls that are alone in the pool; read by any.
class IdTable {
 public:
  /// `drawn` false: the lowest tag that is free, and generations from 1.
  explicit IdTable(bool drawn = true)
      : drawn_(drawn), first_generation_(drawn ? std::uint32_t(drawn_below(first_limit)) : 1) {}
  ~IdTable();
  IdTable(const IdTable&) = delete;
  IdTable& operator=(const IdTable&) = delete;

  /// The slot of an id in use. Throws Refused (bad_id) if it is null, stale, foreign, rounded, or none.
  std::uint32_t slot_of(std::int64_t id) const;
  std::vector<std::int64_t> all() const;  ///< in use, in ascending order of their slots
  std::int64_t id_of(std::size_t slot) const { return Id{tag_, generations_[slot], std::uint32_t(slot)}.value(); }
  std::size_t size() const { return generations_.size(); }  ///< slots, from 0; those that are free too
  std::size_t population() const { return population_; }
  std::uint32_t tag() const { return tag_; }  ///< 0: none yet
  void take_tag();                            ///< one that no pool of this process has, if there is none yet
  Id first() const { return {tag_, first_generation_, 0}; }
  void go_on_as(const Id& first);  ///< `first` of another table; before any id was given out
  const std::vector<std::uint32_t>& generations() const { return generations_; }

  /// Makes room for n more. All or nothing is taken by `take`, which then cannot fail. Refused (no_slot): all are used.
  void make_room(std::size_t n);
  /// An id that is free; room must have been made.
  std::int64_t take() noexcept;
  /// The id is stale from now on.
  void give_back(std::int64_t id) noexcept;

  /// As a file or another process has them. The table must be without ids in use.
  void restore(std::uint32_t tag, std::vector<std::uint32_t> generations, std::span<const std::int64_t> ids);
  /// Takes ids that another table gave out, whose tag becomes that of this one; all or none.
  void claim(std::span<const std::int64_t> ids);
  /// The id is for the other table to give out again.
  void give_up(std::int64_t id) noexcept;

 private:
  void grow(std::size_t slots);

  std::vector<std::uint32_t> generations_;
  std::vector<bool> used_;
  std::vector<std::uint32_t> free_;
  std::size_t population_ = 0;
  std::uint32_t tag_ = 0;
  bool drawn_;
  std::uint32_t first_generation_;  ///< of the slots that it gives out
};

/// One RVE of the pool.
struct Resident {
  Rve rve;
  Tokens tokens;
  double initial_void_ratio = 0;
  StepFigures last{};        ///< committed
  StepFigures trial{};       ///< pending
  bool pending = false;      ///< the last trial of `tokens` is; its state may have been let go of
  bool called_long = false;  ///< by many sub-steps: it rests once nothing that it keeps serves another trial
};

struct Slot {
  std::unique_ptr<Resident> resident;         ///< null: the slot is free
  std::atomic<std::uint64_t> owner{0};        ///< serial number of the call that is at work on it; 0: none
  std::atomic<std::uint64_t> last_call{0};    ///< by the pool's count of calls on RVEs
  std::atomic<std::uint64_t> grain_steps{0};  ///< made in this pool, trials included
  std::atomic<bool> allocated{false};
  std::uint64_t last_grain_steps = 0;  ///< of the last call: what the next will cost
};

/// Books what is made for an RVE from now on, failed trials too.
class Cost {
 public:
  explicit Cost(Slot& slot)
      : slot_(slot), before_(rve().grain_steps_made()), shared_before_(rve().grain_steps_shared()) {}
  ~Cost() {
    slot_.last_grain_steps = rve().grain_steps_made() - before_;
    slot_.grain_steps.fetch_add(slot_.last_grain_steps + rve().grain_steps_shared() - shared_before_,
                                std::memory_order_relaxed);
  }
  Cost(const Cost&) = delete;
  Cost& operator=(const Cost&) = delete;

 private:
  const Rve& rve() const { return slot_.resident->rve; }

  Slot& slot_;
  std::uint64_t before_, shared_before_;
};

/// What the ids of one process stand for. Changed only by calls that are alone in the pool: `add`, `remove` and what
/// they say; the rest by calls at work.
class Slots : public IdTable {
 public:
  using IdTable::IdTable;
  /// The slot of an id. Throws Refused (bad_id) if it is null, stale, foreign, rounded, or none.
  Slot& at(std::int64_t id) { return slots_[slot_of(id)]; }
  Slot& operator[](std::size_t slot) { return slots_[slot]; }
  std::size_t size() const { return slots_.size(); }  ///< those that hold nothing too
  /// Makes room for n more. All or nothing is taken by `add`, which then cannot fail. Refused (no_slot): all are used.
  void make_room(std::size_t n);
  /// Puts an RVE into a free slot; its id. Room must have been made.
  std::int64_t add(std::unique_ptr<Resident> resident) noexcept;
  void remove(std::int64_t id) noexcept;

  using Residents = std::vector<std::unique_ptr<Resident>>;
  /// As a file has them: a generation for each slot, and the RVEs of the ids. The table must be without RVEs.
  void restore(std::uint32_t tag, const std::vector<std::uint32_t>& generations, std::span<const std::int64_t> ids,
               Residents residents);
  /// RVEs under ids that another table gave out, all or none; and away again.
  void claim(std::span<const std::int64_t> ids, Residents residents);
  void give_up(std::int64_t id) noexcept;

 private:
  void settle(std::size_t slot, std::unique_ptr<Resident> resident) noexcept;
  void settle(std::span<const std::int64_t> ids, Residents& residents) noexcept;
  void clear(std::int64_t id) noexcept;

  std::deque<Slot> slots_;  ///< for each slot of the ids; fewer or more after memory ran out
};

}  // namespace rvelab::pool
