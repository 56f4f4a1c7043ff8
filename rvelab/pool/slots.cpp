#include "rvelab/pool/slots.hpp"

#include <algorithm>
#include <array>
#include <mutex>
#include <random>
#include <string>

#include "rvelab/pool/status.hpp"

namespace rvelab::pool {

namespace {

/// Pools of this process by tag; two may have one if the second has read the file of the first.
std::mutex tags_mutex;
std::array<int, tag_limit> pools_of_tag{};

void change_tag(std::uint32_t from, std::uint32_t to) {
  const std::lock_guard lock(tags_mutex);
  if (from != 0) --pools_of_tag[from];
  if (to != 0) ++pools_of_tag[to];
}

void extend(std::deque<Slot>& slots, std::size_t size) {
  while (slots.size() < size) slots.emplace_back();
}

void expect_slots(bool enough) {
  if (!enough)
    throw Refused(Status::no_slot, "pool: all " + std::to_string(slot_limit) +
                                       " slots are in use or retired; release RVEs, or spread them over more pools");
}

}  // namespace

std::int64_t drawn_below(std::int64_t limit) {
  std::random_device device;
  const std::uint64_t high = device();
  return std::int64_t(1 + (high << 32 | device()) % std::uint64_t(limit - 1));
}

IdTable::~IdTable() { change_tag(tag_, 0); }

void IdTable::take_tag() {
  if (tag_ != 0) return;
  const std::lock_guard lock(tags_mutex);
  const auto from = pools_of_tag.begin() + (drawn_ ? drawn_below(tag_limit) : 1);
  auto unused = std::find(from, pools_of_tag.end(), 0);
  if (unused == pools_of_tag.end()) unused = std::find(pools_of_tag.begin() + 1, from, 0);
  if (*unused != 0)
    throw Refused(Status::no_slot, "pool: " + std::to_string(tag_limit - 1) +
                                       " pools have RVEs already; destroy some that are not needed");
  tag_ = std::uint32_t(unused - pools_of_tag.begin());
  ++*unused;
}

void IdTable::go_on_as(const Id& first) {
  change_tag(tag_, first.tag);
  tag_ = first.tag;
  first_generation_ = first.generation;
}

std::uint32_t IdTable::slot_of(std::int64_t value) const {
  const auto refuse = [&](const std::string& what) {
    throw Refused(Status::bad_id, "id " + std::to_string(value) + ": " + what);
  };
  if (value == 0) refuse("it is null; give one that spawn, clone or a pool file returned");
  const Id id = Id::of(value);
  if (value < 0 || value != id.value() || value >> 53 != 0)
    refuse("it is no id: ids are positive integers below 2^53; give one that spawn, clone or a pool file returned");
  if (!is_usable(id.slot))
    refuse("it was rounded, as single precision does; keep ids in 64-bit integers or in double precision");
  const auto refuse_foreign = [&](const std::string& seen_by) {
    refuse("another pool or process made it (" + seen_by +
           "); give it to the pool that made it, or take the RVE over by a snapshot or a pool file");
  };
  if (id.tag != tag_)
    refuse_foreign("of tag " + std::to_string(id.tag) + ", and this pool " +
                   (tag_ == 0 ? "has no RVEs yet" : "is of tag " + std::to_string(tag_)));
  if (id.slot >= generations_.size() || id.generation > generations_[id.slot])
    refuse_foreign("no RVE of this pool ever had it");
  if (generations_[id.slot] != id.generation || !used_[id.slot])
    refuse(
        "it is stale: its RVE was released, or another pool or process made it; give one that spawn, clone or a pool "
        "file returned");
  return id.slot;
}

std::vector<std::int64_t> IdTable::all() const {
  std::vector<std::int64_t> ids;
  ids.reserve(population_);
  for (std::size_t slot = 0; slot < size(); ++slot)
    if (used_[slot]) ids.push_back(id_of(slot));
  return ids;
}

void IdTable::make_room(std::size_t n) {
  take_tag();
  if (n <= free_.size()) return;
  const std::size_t missing = n - free_.size(), before = size();
  expect_slots(missing < slot_limit - before);
  std::size_t after = before;
  for (std::size_t found = 0; found < missing; ++after) found += is_usable(std::uint32_t(after));
  expect_slots(after <= slot_limit);
  std::vector<std::uint32_t> made;
  made.reserve(missing);
  for (std::size_t slot = after; slot-- > before;)
    if (is_usable(std::uint32_t(slot))) made.push_back(std::uint32_t(slot));
  free_.reserve(after);  // give_back() then needs no room
  grow(after);
  free_.insert(free_.begin(), made.begin(), made.end());
}

/// More slots; all or nothing.
void IdTable::grow(std::size_t slots) {
  if (slots <= size()) return;
  generations_.reserve(slots);
  used_.resize(slots, false);
  generations_.resize(slots, 1);
}

std::int64_t IdTable::take() noexcept {
  const std::uint32_t slot = free_.back();
  free_.pop_back();
  used_[slot] = true;
  ++population_;
  generations_[slot] = std::max(generations_[slot], first_generation_);
  return id_of(slot);
}

void IdTable::give_back(std::int64_t id) noexcept {
  const std::uint32_t slot = Id::of(id).slot;
  used_[slot] = false;
  --population_;
  if (++generations_[slot] < generation_limit) free_.push_back(slot);  // else it is retired
}

void IdTable::restore(std::uint32_t tag, std::vector<std::uint32_t> generations, std::span<const std::int64_t> ids) {
  std::vector<bool> used(generations.size(), false);
  for (const std::int64_t id : ids) used[Id::of(id).slot] = true;
  std::vector<std::uint32_t> unused;
  unused.reserve(generations.size());
  for (std::size_t slot = generations.size(); slot-- > 0;)
    if (!used[slot] && is_usable(std::uint32_t(slot)) && generations[slot] < generation_limit)
      unused.push_back(std::uint32_t(slot));
  change_tag(tag_, tag);
  tag_ = tag;
  generations_ = std::move(generations);
  used_ = std::move(used);
  free_ = std::move(unused);
  population_ = ids.size();
}

void IdTable::claim(std::span<const std::int64_t> ids) {
  std::size_t slots = 0;
  for (const std::int64_t id : ids) slots = std::max<std::size_t>(slots, Id::of(id).slot + 1u);
  grow(slots);
  for (const std::int64_t value : ids) {
    const Id id = Id::of(value);
    if (tag_ != id.tag) {
      change_tag(tag_, id.tag);
      tag_ = id.tag;
    }
    generations_[id.slot] = id.generation;
    used_[id.slot] = true;
    ++population_;
  }
}

void IdTable::give_up(std::int64_t id) noexcept {
  used_[Id::of(id).slot] = false;
  --population_;
}

void Slots::make_room(std::size_t n) {
  IdTable::make_room(n);
  extend(slots_, IdTable::size());
}

void Slots::settle(std::size_t index, std::unique_ptr<Resident> resident) noexcept {
  Slot& slot = slots_[index];
  slot.allocated = !resident->rve.released();
  slot.resident = std::move(resident);
  slot.grain_steps = slot.last_grain_steps = 0;
}

void Slots::settle(std::span<const std::int64_t> ids, Residents& residents) noexcept {
  for (std::size_t k = 0; k < ids.size(); ++k) settle(Id::of(ids[k]).slot, std::move(residents[k]));
}

void Slots::clear(std::int64_t id) noexcept {
  Slot& slot = slots_[Id::of(id).slot];
  slot.allocated = false;
  slot.resident.reset();
}

std::int64_t Slots::add(std::unique_ptr<Resident> resident) noexcept {
  const std::int64_t id = take();
  settle(Id::of(id).slot, std::move(resident));
  return id;
}

void Slots::remove(std::int64_t id) noexcept {
  clear(id);
  give_back(id);
}

void Slots::restore(std::uint32_t tag, const std::vector<std::uint32_t>& generations, std::span<const std::int64_t> ids,
                    Residents residents) {
  extend(slots_, generations.size());
  IdTable::restore(tag, generations, ids);
  settle(ids, residents);
}

void Slots::claim(std::span<const std::int64_t> ids, Residents residents) {
  for (const std::int64_t id : ids) extend(slots_, Id::of(id).slot + 1u);
  IdTable::claim(ids);
  settle(ids, residents);
}

void Slots::give_up(std::int64_t id) noexcept {
  clear(id);
  IdTable::give_up(id);
}

}  // namespace rvelab::pool
