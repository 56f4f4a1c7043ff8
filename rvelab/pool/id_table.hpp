// Which ids of a pool are in use. What they stand for is kept beside it, by slot.
#pragma once

#include <span>
#include <vector>

#include "rvelab/pool/id.hpp"

namespace rvelab::pool {

/// Changed only by calls that are alone in the pool; read by any.
class IdTable {
 public:
  IdTable() = default;
  ~IdTable();
  IdTable(const IdTable&) = delete;
  IdTable& operator=(const IdTable&) = delete;

  /// The slot of an id in use. Throws Refused (bad_id) if it is null, stale, foreign, rounded, or none.
  std::uint32_t slot_of(std::int64_t id) const;
  bool in_use(std::size_t slot) const { return used_[slot]; }
  std::int64_t id_of(std::size_t slot) const { return Id{tag_, generations_[slot], std::uint32_t(slot)}.value(); }
  std::size_t size() const { return generations_.size(); }  ///< slots, from 0; those that are free too
  std::size_t population() const { return population_; }
  std::uint32_t tag() const { return tag_; }  ///< 0: none yet
  void take_tag();                            ///< one that no pool of this process has, if there is none yet
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
};

}  // namespace rvelab::pool
