// Work on RVEs, their measures and snapshots, files of pools. Declared in c_boundary.hpp.
#include <algorithm>
#include <new>

#include "rvelab/abi/c_boundary.hpp"
#include "rvelab/abi/structs.hpp"

using namespace rvelab;
using namespace rvelab::abi;

namespace {

/// Their size to *need, and bytes to a buffer of cap, unless it is null. Refused (small_buffer).
void copy_out(const char* call, std::span<const std::byte> bytes, void* buf, std::size_t cap, std::size_t* need) {
  *need = bytes.size();
  if (buf == nullptr) return;
  if (cap < bytes.size())
    throw pool::Refused(pool::Status::small_buffer, std::string(call) + ": cap is " + std::to_string(cap) +
                                                        " bytes; needed: " + std::to_string(bytes.size()));
  std::memcpy(buf, bytes.data(), bytes.size());
}

}  // namespace

int32_t rvelab_apply(rvelab_pool* pool, int64_t id, const double* dH, double dt, double* sigma) {
  return of_pool(pool, {{dH, "dH"}, {sigma, "sigma"}},
                 [&](pool::Pool& of) { return of.apply(id, pool::tensor_at(dH), dt, sigma); });
}

int32_t rvelab_batch_init(rvelab_batch* batch, size_t struct_size) {
  return at_c_boundary([&] { init_struct(batch, "batch", struct_size); });
}

int32_t rvelab_trial(rvelab_pool* pool, rvelab_batch* batch) {
  return of_pool(pool, {{batch, "batch"}}, [&](pool::Pool& of) {
    const rvelab_batch given = read_struct(batch);
    if (given.n > 0) expect_pointers({{given.ids, "batch.ids"}, {given.dH, "batch.dH"}, {given.sigma, "batch.sigma"}});
    return of.trial(given);
  });
}

int32_t rvelab_mixed_init(rvelab_mixed* mixed, size_t struct_size) {
  return at_c_boundary([&] { init_struct(mixed, "mixed", struct_size); });
}

int32_t rvelab_apply_mixed(rvelab_pool* pool, rvelab_mixed* mixed) {
  return of_pool(pool, {{mixed, "mixed"}}, [&](pool::Pool& of) {
    const rvelab_mixed given = read_struct(mixed);
    if (given.n > 0)
      expect_pointers({{given.ids, "mixed.ids"},
                       {given.strain, "mixed.strain"},
                       {given.stress, "mixed.stress"},
                       {given.value, "mixed.value"},
                       {given.scale, "mixed.scale"},
                       {given.sigma, "mixed.sigma"}});
    return pool::apply_mixed(of, given);
  });
}

int32_t rvelab_relax(rvelab_pool* pool, int64_t id, double unbalanced, int64_t max_substeps, double* sigma) {
  return of_pool(pool, {}, [&](pool::Pool& of) -> pool::Verdict {
    const pool::RelaxDone done = of.at<&pool::Share::relax>(id, unbalanced, max_substeps);
    if (sigma != nullptr) std::copy_n(done.sigma, 9, sigma);
    if (done.reached != 0) return {};
    pool::Verdict verdict{pool::Status::not_quasi_static, {}};
    try {
      verdict.text = "relax: the unbalanced ratio is " + in_words(done.unbalanced) + " after " +
                     std::to_string(done.substeps) + " sub-steps, not " + in_words(unbalanced) +
                     "; give more, or a larger ratio";
    } catch (const std::bad_alloc&) {  // the steps are made: without memory for words the status says it
    }
    return verdict;
  });
}

int32_t rvelab_commit(rvelab_pool* pool, int64_t n, const int64_t* ids) {
  return of_pool(pool, {},
                 [&](pool::Pool& of) { of.commit(ids == nullptr ? std::span<const std::int64_t>() : ids_of(n, ids)); });
}

int32_t rvelab_revert(rvelab_pool* pool, int64_t n, const int64_t* ids) {
  return of_pool(pool, {},
                 [&](pool::Pool& of) { of.revert(ids == nullptr ? std::span<const std::int64_t>() : ids_of(n, ids)); });
}

int32_t rvelab_info_init(rvelab_info* info, size_t struct_size) {
  return at_c_boundary([&] { init_struct(info, "info", struct_size); });
}

int32_t rvelab_get_info(rvelab_pool* pool, int64_t id, rvelab_info* info) {
  return of_pool(pool, {{info, "info"}}, [&](pool::Pool& of) {
    const std::uint32_t size = read_struct(info).struct_size;
    rvelab_info found = of.at<&pool::Share::info>(id);
    found.struct_size = size;
    std::memcpy(static_cast<void*>(info), &found, std::min<std::size_t>(size, sizeof found));
  });
}

int32_t rvelab_get_parameters(rvelab_pool* pool, int64_t id, char* text, size_t cap, size_t* need) {
  return of_pool(
      pool, {{need, "need"}, {cap > 0 ? text : static_cast<const void*>(need), "text"}}, [&](pool::Pool& of) {
        const std::string found = parameters_text(pool::rve_state_of(of.at<&pool::Share::save>(id)).specimen);
        copy_out("get_parameters", std::as_bytes(std::span(found.c_str(), found.size() + 1)), text, cap, need);
      });
}

int32_t rvelab_set_parameters(rvelab_pool* pool, int64_t id, const char* toml) {
  return of_pool(pool, {{toml, "toml"}}, [&](pool::Pool& of) {
    pool::RveState state = pool::rve_state_of(of.at<&pool::Share::save>(id));
    const std::int64_t token = state.tokens.committed();
    set_parameters(state.specimen, toml);
    state.tokens.go_on();
    state.last.error_estimate = 0;
    const auto bytes = pool::to_bytes(state, to_bytes(state.specimen));
    of.at<&pool::Share::replace>(id, std::span<const std::byte>(bytes), token);
  });
}

int32_t rvelab_cost(rvelab_pool* pool, int64_t n, const int64_t* ids, int64_t* grain_steps) {
  return of_pool(pool, {}, [&](pool::Pool& of) {
    const auto asked = ids_of(n, ids);
    if (n > 0) expect_pointers({{grain_steps, "grain_steps"}});
    of.cost(asked, grain_steps);
  });
}

int32_t rvelab_snapshot_save(rvelab_pool* pool, int64_t id, void* buf, size_t cap, size_t* need) {
  return of_pool(pool, {{need, "need"}, {cap > 0 ? buf : need, "buf"}},
                 [&](pool::Pool& of) { copy_out("snapshot_save", of.at<&pool::Share::save>(id), buf, cap, need); });
}

int32_t rvelab_snapshot_load(rvelab_pool* pool, int64_t id, const void* buf, size_t size) {
  return of_pool(pool, {{buf, "buf"}}, [&](pool::Pool& of) {
    of.at<&pool::Share::load>(id, std::span(static_cast<const std::byte*>(buf), size));
  });
}

int32_t rvelab_pool_write(rvelab_pool* pool, const char* path) {
  return of_pool(pool, {{path, "path"}}, [&](pool::Pool& of) {
    of.expect_this_process();
    write_pool(of, path);
  });
}

int32_t rvelab_pool_read(rvelab_pool* pool, const char* path) {
  return of_pool(pool, {{path, "path"}}, [&](pool::Pool& of) {
    of.expect_this_process();
    read_pool(of, path);
  });
}
