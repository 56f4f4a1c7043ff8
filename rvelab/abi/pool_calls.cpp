// Pools and their population. Declared in handle.hpp.
#include <algorithm>
#include <memory>

#include "rvelab/abi/file_library.hpp"
#include "rvelab/abi/handle.hpp"
#include "rvelab/abi/rank_calls.hpp"
#include "rvelab/abi/structs.hpp"
#include "rvelab/io/version.hpp"
#include "rvelab/pool/rve_state.hpp"
#include "rvelab/pool/threaded_pool.hpp"

namespace rvelab::abi {

using pool::Refused;
using pool::Status;

std::span<const std::int64_t> ids_of(std::int64_t n, const std::int64_t* ids) {
  if (n < 0) throw Refused(Status::bad_input, "n is " + std::to_string(n) + "; allowed: 0 or more");
  if (n > 0) expect_pointer(ids, "ids");
  static const std::int64_t none = 0;  // a pointer that is not null: no ids are meant, not all
  return {n > 0 ? ids : &none, std::size_t(n)};
}

namespace {

pool::Options options_of(const rvelab_pool_def* given) {
  if (given == nullptr) return {};
  const rvelab_pool_def def = read_struct(given);
  if (def.workers < 0)
    throw Refused(Status::bad_input, "pool_def.workers is " + std::to_string(def.workers) +
                                         "; allowed: 1 or more, or 0 for as many as the processor runs at once");
  if (def.trial_memory != RVELAB_TRIAL_KEEP && def.trial_memory != RVELAB_TRIAL_RECOMPUTE)
    throw Refused(Status::unsupported, "pool_def.trial_memory is " + std::to_string(def.trial_memory) +
                                           "; allowed: RVELAB_TRIAL_KEEP (0), RVELAB_TRIAL_RECOMPUTE (1)");
  pool::Options options;
  options.workers = unsigned(def.workers);
  options.trial_memory = def.trial_memory == RVELAB_TRIAL_KEEP ? pool::TrialMemory::keep : pool::TrialMemory::recompute;
  options.tolerance_rel = def.tolerance_rel;
  options.tolerance_abs = def.tolerance_abs;
  options.max_substeps = long(def.max_substeps);
  options.damping = def.damping;
  options.min_height = def.min_height;
  options.run_tasks = def.run_tasks;
  options.host = def.host;
  return options;
}

std::span<const std::byte> bytes_of(const void* buf, std::size_t size) {
  return {static_cast<const std::byte*>(buf), size};
}

rvelab_pool* handle_of(std::unique_ptr<pool::Pool> made) { return reinterpret_cast<rvelab_pool*>(made.release()); }

std::unique_ptr<pool::Share> open_share(const pool::Options& options) {
  return std::make_unique<pool::ThreadedPool>(options);
}

std::int32_t give_pool(const rvelab_pool_def* def, void* self, MakePool make, rvelab_pool** pool) noexcept {
  return at_c_boundary([&] {
    std::unique_ptr<pool::Pool> made = make(self, [&] {
      expect_pointer(pool, "pool");
      return options_of(def);
    });
    *pool = handle_of(std::move(made));
  });
}

}  // namespace
}  // namespace rvelab::abi

const void* rvelab_rank_calls() {
  static constexpr rvelab::abi::RankCalls calls{rvelab::io::version, rvelab::abi::open_share, rvelab::abi::give_pool};
  return &calls;
}

using namespace rvelab;
using namespace rvelab::abi;

int32_t rvelab_pool_def_init(rvelab_pool_def* def, size_t struct_size) {
  return at_c_boundary([&] {
    expect_pointer(def, "def");
    init_struct(def, struct_size);
  });
}

int32_t rvelab_pool_create(const rvelab_pool_def* def, rvelab_pool** pool) {
  return at_c_boundary([&] {
    expect_pointer(pool, "pool");
    *pool = handle_of(std::make_unique<pool::ThreadedPool>(options_of(def)));
  });
}

int32_t rvelab_pool_destroy(rvelab_pool* pool) {
  return at_c_boundary([&] {
    if (pool == nullptr) return;
    pool_of(pool).close();
    delete &pool_of(pool);
  });
}

int32_t rvelab_template_load(rvelab_pool* pool, const char* path, int64_t* tmpl) {
  return at_c_boundary([&] {
    pool::Pool& of = pool_of(pool);
    expect_pointer(path, "path");
    expect_pointer(tmpl, "tmpl");
    of.expect_this_process();
    *tmpl = of.add_template(read_specimen(path));
  });
}

int32_t rvelab_template_from_snapshot(rvelab_pool* pool, const void* buf, size_t size, int64_t* tmpl) {
  return at_c_boundary([&] {
    pool::Pool& of = pool_of(pool);
    expect_pointer(buf, "buf");
    expect_pointer(tmpl, "tmpl");
    of.expect_this_process();
    *tmpl = of.add_template(pool::rve_state_of(abi::bytes_of(buf, size)).specimen);
  });
}

int32_t rvelab_template_release(rvelab_pool* pool, int64_t tmpl) {
  return at_c_boundary([&] { pool_of(pool).everywhere<&pool::Share::release_template>(tmpl); });
}

int32_t rvelab_spawn(rvelab_pool* pool, int64_t tmpl, int64_t n, int64_t* ids) {
  return at_c_boundary([&] {
    pool::Pool& of = pool_of(pool);
    if (n > 0) expect_pointer(ids, "ids");
    of.spawn(tmpl, n, ids);
  });
}

int32_t rvelab_clone(rvelab_pool* pool, int64_t src, int64_t* dst) {
  return at_c_boundary([&] {
    pool::Pool& of = pool_of(pool);
    expect_pointer(dst, "dst");
    *dst = of.clone(src);
  });
}

int32_t rvelab_release(rvelab_pool* pool, int64_t n, const int64_t* ids) {
  return at_c_boundary([&] { pool_of(pool).release(ids_of(n, ids)); });
}

int32_t rvelab_ids(rvelab_pool* pool, int64_t cap, int64_t* ids, int64_t* n) {
  return at_c_boundary([&] {
    pool::Pool& of = pool_of(pool);
    expect_pointer(n, "n");
    if (cap < 0) throw Refused(Status::bad_input, "rvelab_ids: cap is " + std::to_string(cap) + "; allowed: 0 or more");
    if (cap > 0) expect_pointer(ids, "ids");
    const std::vector<std::int64_t> all = of.ids();
    *n = std::int64_t(all.size());
    std::copy_n(all.begin(), std::min(*n, cap), ids);
  });
}
