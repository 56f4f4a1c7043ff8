// Version and statuses, pools and their population. Declared in c_boundary.hpp.
#include <algorithm>

#include "rvelab/abi/c_boundary.hpp"
#include "rvelab/abi/structs.hpp"
#include "rvelab/io/version.hpp"

namespace rvelab::abi {

namespace {

pool::Options options_of(const rvelab_pool_def* given) {
  return given == nullptr ? pool::Options() : pool::Options(read_struct(given));
}

rvelab_pool* handle_of(std::unique_ptr<pool::Pool> made) { return reinterpret_cast<rvelab_pool*>(made.release()); }

std::unique_ptr<pool::Share> open_share(const pool::Options& options) {
  return std::make_unique<pool::ThreadedPool>(options);
}

std::int32_t give_pool(const rvelab_pool_def* def, void* self, MakePool make, rvelab_pool** pool) noexcept {
  return at_c_boundary([&] {
    *pool = handle_of(make(self, [&] {
      expect_pointers({{pool, "pool"}});
      return options_of(def);
    }));
  });
}

}  // namespace
}  // namespace rvelab::abi

using namespace rvelab;
using namespace rvelab::abi;

const void* rvelab_rank_calls() {
  static constexpr RankCalls calls{io::version, open_share, give_pool};
  return &calls;
}

int32_t rvelab_abi_version(void) { return RVELAB_ABI_MAJOR << 16 | RVELAB_ABI_MINOR; }

const char* rvelab_version(void) { return io::version; }

int64_t rvelab_capabilities(void) {
  return RVELAB_CAN_PLANE | RVELAB_CAN_SPACE | RVELAB_CAN_TANGENT | RVELAB_CAN_ERROR_ESTIMATE | RVELAB_CAN_HOST_TASKS |
         RVELAB_CAN_FILES;
}

const char* rvelab_status_name(int32_t status) {
  switch (status) {
#define RVELAB_NAMED(status, number) \
  case number:                       \
    return #number;
    RVELAB_STATUSES(RVELAB_NAMED)
#undef RVELAB_NAMED
  }
  return "unknown status";
}

int32_t rvelab_pool_def_init(rvelab_pool_def* def, size_t struct_size) {
  return at_c_boundary([&] { init_struct(def, "def", struct_size); });
}

int32_t rvelab_pool_create(const rvelab_pool_def* def, rvelab_pool** pool) {
  return at_c_boundary([&] {
    expect_pointers({{pool, "pool"}});
    *pool = handle_of(open_share(options_of(def)));
  });
}

int32_t rvelab_pool_destroy(rvelab_pool* handle) {
  if (handle == nullptr) return RVELAB_OK;
  return of_pool(handle, {}, [](pool::Pool& rves) {
    rves.close();
    delete &rves;
  });
}

int32_t rvelab_interrupt(rvelab_pool* handle, int32_t on) {
  // Without the boundary of other calls: a signal handler may not set the floating-point environment.
  if (handle == nullptr) return of_pool(handle, {}, [](pool::Pool&) {});
  reinterpret_cast<pool::Pool*>(handle)->interrupt(on != 0);
  return RVELAB_OK;
}

int32_t rvelab_template_load(rvelab_pool* handle, const char* path, int64_t* tmpl) {
  return of_pool(handle, {{path, "path"}, {tmpl, "tmpl"}}, [&](pool::Pool& rves) {
    rves.expect_this_process();
    *tmpl = rves.add_template(read_specimen(path));
  });
}

int32_t rvelab_template_from_snapshot(rvelab_pool* handle, const void* buf, size_t size, int64_t* tmpl) {
  return of_pool(handle, {{buf, "buf"}, {tmpl, "tmpl"}}, [&](pool::Pool& rves) {
    rves.expect_this_process();
    *tmpl = rves.add_template(pool::rve_state_of({static_cast<const std::byte*>(buf), size}).specimen);
  });
}

int32_t rvelab_template_release(rvelab_pool* handle, int64_t tmpl) {
  return of_pool(handle, {}, [&](pool::Pool& rves) { rves.everywhere<&pool::Share::release_template>(tmpl); });
}

int32_t rvelab_spawn(rvelab_pool* handle, int64_t tmpl, int64_t n, int64_t* ids) {
  return of_pool(handle, {{n > 0 ? ids : &n, "ids"}}, [&](pool::Pool& rves) { rves.spawn(tmpl, n, ids); });
}

int32_t rvelab_clone(rvelab_pool* handle, int64_t src, int64_t* dst) {
  return of_pool(handle, {{dst, "dst"}}, [&](pool::Pool& rves) { *dst = rves.clone(src); });
}

int32_t rvelab_release(rvelab_pool* handle, int64_t n, const int64_t* ids) {
  return of_pool(handle, {}, [&](pool::Pool& rves) { rves.release(ids_of(n, ids)); });
}

int32_t rvelab_ids(rvelab_pool* handle, int64_t cap, int64_t* ids, int64_t* n) {
  return of_pool(handle, {{n, "n"}}, [&](pool::Pool& rves) {
    if (cap < 0)
      throw pool::Refused(pool::Status::bad_input,
                          "rvelab_ids: cap is " + std::to_string(cap) + "; allowed: 0 or more");
    if (cap > 0) expect_pointers({{ids, "ids"}});
    const std::vector<std::int64_t> all = rves.ids();
    *n = std::int64_t(all.size());
    std::copy_n(all.begin(), std::min(*n, cap), ids);
  });
}
