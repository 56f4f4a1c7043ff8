// Measures and snapshots of RVEs, files of pools. Declared in handle.hpp.
#include <algorithm>

#include "rvelab/abi/file_library.hpp"
#include "rvelab/abi/handle.hpp"
#include "rvelab/abi/structs.hpp"

using namespace rvelab;
using namespace rvelab::abi;

namespace {

rvelab_info info_of(const pool::Info& found) {
  rvelab_info info{};
  info.dimension = found.dimension;
  info.grains = std::int64_t(found.grains);
  info.contacts = std::int64_t(found.contacts);
  std::ranges::copy(found.lattice, info.lattice);
  std::ranges::copy(found.rotation, info.rotation);
  info.volume = found.volume;
  info.void_ratio = found.void_ratio;
  info.coordination_number = found.coordination_number;
  std::ranges::copy(found.fabric, info.fabric);
  info.fabric_anisotropy = found.fabric_anisotropy;
  info.sliding_fraction = found.sliding_fraction;
  info.p = found.p;
  info.q = found.q;
  info.unbalanced_force_ratio = found.unbalanced_force_ratio;
  info.inertial_number = found.inertial_number;
  info.permeability_ratio = found.permeability_ratio;
  info.min_height_ratio = found.min_height_ratio;
  info.grain_steps = std::int64_t(found.grain_steps);
  info.bytes_resting = std::int64_t(found.memory.state + found.memory.list);
  info.bytes_trial = std::int64_t(found.memory.trial);
  info.bytes_working = std::int64_t(found.memory.working);
  info.token = found.token;
  return info;
}

}  // namespace

int32_t rvelab_info_init(rvelab_info* info, size_t struct_size) {
  return at_c_boundary([&] {
    expect_pointer(info, "info");
    init_struct(info, struct_size);
  });
}

int32_t rvelab_get_info(rvelab_pool* pool, int64_t id, rvelab_info* info) {
  return at_c_boundary([&] {
    pool::Pool& of = pool_of(pool);
    expect_pointer(info, "info");
    const std::size_t size = checked_size(info);
    expect_no_flags(info->flags, Layout<rvelab_info>::name);
    rvelab_info found = info_of(of.at<&pool::Share::info>(id));
    found.struct_size = std::uint32_t(size);
    std::memcpy(static_cast<void*>(info), &found, std::min(size, sizeof found));
  });
}

int32_t rvelab_cost(rvelab_pool* pool, int64_t n, const int64_t* ids, int64_t* grain_steps) {
  return at_c_boundary([&] {
    pool::Pool& of = pool_of(pool);
    const auto asked = ids_of(n, ids);
    if (n > 0) expect_pointer(grain_steps, "grain_steps");
    of.cost(asked, grain_steps);
  });
}

int32_t rvelab_snapshot_save(rvelab_pool* pool, int64_t id, void* buf, size_t cap, size_t* need) {
  return at_c_boundary([&] {
    pool::Pool& of = pool_of(pool);
    expect_pointer(need, "need");
    if (cap > 0) expect_pointer(buf, "buf");
    const std::vector<std::byte> bytes = of.at<&pool::Share::save>(id);
    *need = bytes.size();
    if (buf == nullptr) return;
    if (cap < bytes.size())
      throw pool::Refused(pool::Status::small_buffer, "snapshot_save: cap is " + std::to_string(cap) +
                                                          " bytes; the snapshot takes " + std::to_string(bytes.size()));
    std::memcpy(buf, bytes.data(), bytes.size());
  });
}

int32_t rvelab_snapshot_load(rvelab_pool* pool, int64_t id, const void* buf, size_t size) {
  return at_c_boundary([&] {
    pool::Pool& of = pool_of(pool);
    expect_pointer(buf, "buf");
    of.at<&pool::Share::load>(id, std::span(static_cast<const std::byte*>(buf), size));
  });
}

int32_t rvelab_pool_write(rvelab_pool* pool, const char* path) {
  return at_c_boundary([&] {
    pool::Pool& of = pool_of(pool);
    expect_pointer(path, "path");
    of.expect_this_process();
    write_pool(of, path);
  });
}

int32_t rvelab_pool_read(rvelab_pool* pool, const char* path) {
  return at_c_boundary([&] {
    pool::Pool& of = pool_of(pool);
    expect_pointer(path, "path");
    of.expect_this_process();
    read_pool(of, path);
  });
}
