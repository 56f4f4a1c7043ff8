#include "rvelab/pool/slots.hpp"

#include <utility>

namespace rvelab::pool {

namespace {

void grow(std::deque<Slot>& slots, std::size_t size) {
  while (slots.size() < size) slots.emplace_back();
}

}  // namespace

void Slots::make_room(std::size_t n) {
  ids_.make_room(n);
  grow(slots_, ids_.size());
}

void Slots::settle(std::size_t index, std::unique_ptr<Resident> resident) noexcept {
  Slot& slot = slots_[index];
  slot.allocated = !resident->rve.released();
  slot.resident = std::move(resident);
  slot.grain_steps = slot.last_grain_steps = 0;
}

std::int64_t Slots::add(std::unique_ptr<Resident> resident) noexcept {
  const std::int64_t id = ids_.take();
  settle(Id::of(id).slot, std::move(resident));
  return id;
}

void Slots::remove(std::int64_t id) noexcept {
  Slot& slot = slots_[Id::of(id).slot];
  slot.allocated = false;
  slot.resident.reset();
  ids_.give_back(id);
}

void Slots::restore(std::uint32_t tag, const std::vector<std::uint32_t>& generations, std::span<const std::int64_t> ids,
                    Residents residents) {
  grow(slots_, generations.size());
  ids_.restore(tag, generations, ids);
  for (std::size_t k = 0; k < ids.size(); ++k) settle(Id::of(ids[k]).slot, std::move(residents[k]));
}

void Slots::claim(std::span<const std::int64_t> ids, Residents residents) {
  ids_.claim(ids);
  try {
    grow(slots_, ids_.size());
  } catch (...) {
    for (const std::int64_t id : ids) ids_.give_up(id);
    throw;
  }
  for (std::size_t k = 0; k < ids.size(); ++k) settle(Id::of(ids[k]).slot, std::move(residents[k]));
}

void Slots::give_up(std::int64_t id) noexcept {
  Slot& slot = slots_[Id::of(id).slot];
  slot.allocated = false;
  slot.resident.reset();
  ids_.give_up(id);
}

}  // namespace rvelab::pool
