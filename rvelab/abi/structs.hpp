// Structs of the interface in any of their sizes: an older host has a smaller one, a newer host a larger one.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#include "rvelab/abi/handle.hpp"

namespace rvelab::abi {

/// Bytes of a struct from `begin` on, up to `end`.
struct Field {
  const char* name;
  std::size_t begin, end;
};

/// `name` and `fields`, all of them, of each struct of the interface.
template <class Struct>
struct Layout;

#define RVELAB_FIELD(field) \
  Field { #field, offsetof(Struct, field), offsetof(Struct, field) + sizeof(Struct::field) }

template <>
struct Layout<rvelab_pool_def> {
  using Struct = rvelab_pool_def;
  static constexpr const char* name = "rvelab_pool_def";
  static constexpr Field fields[] = {
      RVELAB_FIELD(struct_size),   RVELAB_FIELD(flags),         RVELAB_FIELD(workers),      RVELAB_FIELD(trial_memory),
      RVELAB_FIELD(tolerance_rel), RVELAB_FIELD(tolerance_abs), RVELAB_FIELD(max_substeps), RVELAB_FIELD(damping),
      RVELAB_FIELD(min_height),    RVELAB_FIELD(run_tasks),     RVELAB_FIELD(host)};
};

template <>
struct Layout<rvelab_batch> {
  using Struct = rvelab_batch;
  static constexpr const char* name = "rvelab_batch";
  static constexpr Field fields[] = {RVELAB_FIELD(struct_size), RVELAB_FIELD(flags),   RVELAB_FIELD(n),
                                     RVELAB_FIELD(dt),          RVELAB_FIELD(ids),     RVELAB_FIELD(dH),
                                     RVELAB_FIELD(tokens_in),   RVELAB_FIELD(sigma),   RVELAB_FIELD(contact),
                                     RVELAB_FIELD(reynolds),    RVELAB_FIELD(tangent), RVELAB_FIELD(error_estimate),
                                     RVELAB_FIELD(dt_scale),    RVELAB_FIELD(status),  RVELAB_FIELD(tokens_out)};
};

template <>
struct Layout<rvelab_info> {
  using Struct = rvelab_info;
  static constexpr const char* name = "rvelab_info";
  static constexpr Field fields[] = {RVELAB_FIELD(struct_size),
                                     RVELAB_FIELD(flags),
                                     RVELAB_FIELD(dimension),
                                     RVELAB_FIELD(grains),
                                     RVELAB_FIELD(contacts),
                                     RVELAB_FIELD(lattice),
                                     RVELAB_FIELD(rotation),
                                     RVELAB_FIELD(volume),
                                     RVELAB_FIELD(void_ratio),
                                     RVELAB_FIELD(coordination_number),
                                     RVELAB_FIELD(fabric),
                                     RVELAB_FIELD(fabric_anisotropy),
                                     RVELAB_FIELD(sliding_fraction),
                                     RVELAB_FIELD(p),
                                     RVELAB_FIELD(q),
                                     RVELAB_FIELD(unbalanced_force_ratio),
                                     RVELAB_FIELD(inertial_number),
                                     RVELAB_FIELD(permeability_ratio),
                                     RVELAB_FIELD(min_height_ratio),
                                     RVELAB_FIELD(grain_steps),
                                     RVELAB_FIELD(bytes_resting),
                                     RVELAB_FIELD(bytes_trial),
                                     RVELAB_FIELD(bytes_working),
                                     RVELAB_FIELD(token)};
};
#undef RVELAB_FIELD

/// Refuses sizes that no struct of this kind has in any version, those that end within a field among them. Throws
/// pool::Refused (bad_input).
void expect_size(std::size_t size, const char* name, std::span<const Field> fields);

/// The same of the struct_size of a struct; refuses bytes beyond its fields that are not zero (unsupported). Returns
/// struct_size.
std::size_t checked_size(const void* given, const char* name, std::span<const Field> fields);

/// Refuses flags that are not zero.
void expect_no_flags(std::uint32_t flags, const char* name);

template <class Struct>
std::size_t checked_size(const Struct* given) {
  return checked_size(given, Layout<Struct>::name, Layout<Struct>::fields);
}

/// A struct of a host; fields that it does not have are zero.
template <class Struct>
Struct read_struct(const Struct* given) {
  const std::size_t size = checked_size(given);
  Struct own{};
  std::memcpy(&own, given, std::min(size, sizeof own));
  expect_no_flags(own.flags, Layout<Struct>::name);
  return own;
}

/// Writes min(size, own size) bytes of a struct whose fields are at their defaults; struct_size is `size`.
template <class Struct>
void init_struct(Struct* given, std::size_t size) {
  expect_size(size, Layout<Struct>::name, Layout<Struct>::fields);
  Struct own{};
  own.struct_size = std::uint32_t(size);
  std::memcpy(static_cast<void*>(given), &own, std::min(size, sizeof own));
}

}  // namespace rvelab::abi
