// Structs of the interface in any of their sizes: an older host has a smaller one, a newer host a larger one.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <span>

#include "rvelab/abi/c_boundary.hpp"

namespace rvelab::abi {

/// Bytes of a struct from `begin` on, up to `end`.
struct Field {
  const char* name;
  std::size_t begin, end;
};

/// Name and all fields of each struct of the interface.
#define RVELAB_FIELDS_OF_POOL_DEF(each)                                                                  \
  each(struct_size) each(flags) each(workers) each(trial_memory) each(tolerance_rel) each(tolerance_abs) \
      each(max_substeps) each(damping) each(min_height) each(run_tasks) each(host)
#define RVELAB_FIELDS_OF_BATCH(each)                                                                          \
  each(struct_size) each(flags) each(n) each(dt) each(ids) each(dH) each(tokens_in) each(sigma) each(contact) \
      each(reynolds) each(tangent) each(error_estimate) each(dt_scale) each(status) each(tokens_out)
#define RVELAB_FIELDS_OF_INFO(each)                                                                                   \
  each(struct_size) each(flags) each(dimension) each(grains) each(contacts) each(lattice) each(rotation) each(volume) \
      each(void_ratio) each(coordination_number) each(fabric) each(fabric_anisotropy) each(sliding_fraction) each(p)  \
          each(q) each(unbalanced_force_ratio) each(inertial_number) each(permeability_ratio) each(min_height_ratio)  \
              each(grain_steps) each(bytes_resting) each(bytes_trial) each(bytes_working) each(token) each(sigma)     \
                  each(contact) each(reynolds) each(error_estimate)
#define RVELAB_FIELDS_OF_MIXED(each)                                                                             \
  each(struct_size) each(flags) each(n) each(rows) each(dt) each(tolerance) each(ids) each(strain) each(stress)  \
      each(value) each(scale) each(missed) each(spin) each(sigma) each(dH) each(held_error) each(error_estimate) \
          each(status) each(tokens_out)
#define RVELAB_FIELDS_OF_ARRAY(each) \
  each(struct_size) each(flags) each(name) each(unit) each(meaning) each(of) each(type) each(rows) each(columns)

template <class Struct>
struct Layout;
#define RVELAB_FIELD(field) Field{#field, offsetof(Struct, field), offsetof(Struct, field) + sizeof(Struct::field)},
#define RVELAB_LAYOUT(type, list)                           \
  template <>                                               \
  struct Layout<type> {                                     \
    using Struct = type;                                    \
    static constexpr const char* name = #type;              \
    static constexpr Field fields[] = {list(RVELAB_FIELD)}; \
  };
RVELAB_LAYOUT(rvelab_pool_def, RVELAB_FIELDS_OF_POOL_DEF)
RVELAB_LAYOUT(rvelab_batch, RVELAB_FIELDS_OF_BATCH)
RVELAB_LAYOUT(rvelab_info, RVELAB_FIELDS_OF_INFO)
RVELAB_LAYOUT(rvelab_mixed, RVELAB_FIELDS_OF_MIXED)
RVELAB_LAYOUT(rvelab_array, RVELAB_FIELDS_OF_ARRAY)
#undef RVELAB_LAYOUT
#undef RVELAB_FIELD

/// Refuses sizes that no struct of this kind has in any version, those that end within a field among them. Throws
/// pool::Refused (bad_input).
void expect_size(std::size_t size, const char* name, std::span<const Field> fields);

/// The same of the struct_size of a struct; refuses bytes beyond its fields that are not zero, and flags that are not
/// known (unsupported). Returns struct_size.
std::size_t checked_size(const void* given, const char* name, std::span<const Field> fields, std::uint32_t known_flags);

template <class Struct>
constexpr std::uint32_t known_flags = 0;
template <>
inline constexpr std::uint32_t known_flags<rvelab_pool_def> = RVELAB_POOL_COUNTED_IDS;

/// A struct of a host; fields that it does not have are zero.
template <class Struct>
Struct read_struct(const Struct* given) {
  const std::size_t size = checked_size(given, Layout<Struct>::name, Layout<Struct>::fields, known_flags<Struct>);
  Struct own{};
  std::memcpy(&own, given, std::min(size, sizeof own));
  return own;
}

/// Writes min(size, own size) bytes of a struct whose fields are at their defaults; struct_size is `size`.
template <class Struct>
void init_struct(Struct* given, const char* argument, std::size_t size) {
  expect_pointers({{given, argument}});
  expect_size(size, Layout<Struct>::name, Layout<Struct>::fields);
  Struct own{};
  own.struct_size = std::uint32_t(size);
  std::memcpy(static_cast<void*>(given), &own, std::min(size, sizeof own));
}

}  // namespace rvelab::abi
