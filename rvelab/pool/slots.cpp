#include "rvelab/pool/slots.hpp"

#include <algorithm>
#include <array>
#include <mutex>
#include <string>
#include <utility>

#include "rvelab/pool/status.hpp"

namespace rvelab::pool {

namespace {

/// Pools of this process by tag; two may have one if the second has read the file of the first.
std::mutex tags_mutex;
std::array<int, tag_limit> pools_of_tag{};

void expect_slots(bool enough) {
  if (!enough)
    throw Refused(Status::no_slot, "pool: all " + std::to_string(slot_limit) +
                                       " slots are in use or retired; release RVEs, or spread them over more pools");
}

}  // namespace

void Slots::take_tag() {
  if (tag_ != 0) return;
  const std::lock_guard lock(tags_mutex);
  const auto unused = std::find(pools_of_tag.begin() + 1, pools_of_tag.end(), 0);
  if (unused == pools_of_tag.end())
    throw Refused(Status::no_slot, "pool: " + std::to_string(tag_limit - 1) +
                                       " pools have RVEs already; destroy some that are not needed");
  tag_ = std::uint32_t(unused - pools_of_tag.begin());
  ++*unused;
}

Slots::~Slots() {
  if (tag_ == 0) return;
  const std::lock_guard lock(tags_mutex);
  --pools_of_tag[tag_];
}

Slot& Slots::at(std::int64_t value) {
  const auto refuse = [&](const std::string& what) {
    throw Refused(Status::bad_id, "id " + std::to_string(value) + ": " + what);
  };
  if (value == 0) refuse("it is null; give one that spawn, clone or a pool file returned");
  const Id id = Id::of(value);
  if (value < 0 || value != id.value() || value >> 53 != 0)
    refuse("it is no id: ids are positive integers below 2^53; give one that spawn, clone or a pool file returned");
  if (!is_usable(id.slot))
    refuse("it was rounded, as single precision does; keep ids in 64-bit integers or in double precision");
  if (id.tag != tag_)
    refuse("it is of the pool with tag " + std::to_string(id.tag) + "; this one has " +
           (tag_ == 0 ? "no RVEs yet" : "the tag " + std::to_string(tag_)) + ": give it to the pool that made it");
  if (id.slot >= slots_.size()) refuse("no RVE of this pool ever had it");
  Slot& slot = slots_[id.slot];
  if (slot.generation != id.generation || !slot.resident) refuse("it is stale: its RVE was released");
  return slot;
}

void Slots::make_room(std::size_t n) {
  take_tag();
  if (n <= free_.size()) return;
  const std::size_t missing = n - free_.size();
  expect_slots(missing < slot_limit - slots_.size());
  free_.reserve(slots_.size() + missing + slot_limit / (1u << 20));  // remove() then needs no room
  std::vector<std::uint32_t> made;
  made.reserve(missing);
  const std::size_t before = slots_.size();
  try {
    while (made.size() < missing) {
      expect_slots(slots_.size() < slot_limit);
      slots_.emplace_back();
      if (is_usable(std::uint32_t(slots_.size() - 1))) made.push_back(std::uint32_t(slots_.size() - 1));
    }
  } catch (...) {
    while (slots_.size() > before) slots_.pop_back();
    throw;
  }
  free_.insert(free_.begin(), made.rbegin(), made.rend());
}

std::int64_t Slots::add(std::unique_ptr<Resident> resident) noexcept {
  const std::uint32_t index = free_.back();
  free_.pop_back();
  Slot& slot = slots_[index];
  slot.awake = !resident->rve.resting();
  slot.resident = std::move(resident);
  slot.grain_steps = slot.last_grain_steps = 0;
  ++population_;
  return id_of(index);
}

void Slots::remove(std::int64_t id) noexcept {
  const std::uint32_t index = Id::of(id).slot;
  Slot& slot = slots_[index];
  slot.awake = false;
  slot.resident.reset();
  --population_;
  if (++slot.generation < generation_limit) free_.push_back(index);  // else it is retired
}

std::vector<std::uint32_t> Slots::generations() const {
  std::vector<std::uint32_t> all;
  for (const Slot& slot : slots_) all.push_back(slot.generation);
  return all;
}

void Slots::restore(std::uint32_t tag, const std::vector<std::uint32_t>& generations,
                    std::vector<std::pair<std::uint32_t, std::unique_ptr<Resident>>> residents) {
  Slots read;
  read.free_.reserve(generations.size());
  for (const std::uint32_t generation : generations) read.slots_.emplace_back().generation = generation;
  for (auto& [index, resident] : residents) {
    read.slots_[index].awake = !resident->rve.resting();
    read.slots_[index].resident = std::move(resident);
    ++read.population_;
  }
  for (std::size_t index = generations.size(); index-- > 0;)
    if (!read.slots_[index].resident && is_usable(std::uint32_t(index)) && generations[index] < generation_limit)
      read.free_.push_back(std::uint32_t(index));
  {
    const std::lock_guard lock(tags_mutex);
    ++pools_of_tag[tag];
  }
  read.tag_ = tag;
  std::swap(slots_, read.slots_);
  std::swap(free_, read.free_);
  std::swap(population_, read.population_);
  std::swap(tag_, read.tag_);
}

}  // namespace rvelab::pool
