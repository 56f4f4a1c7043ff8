// Work on RVEs, their measures and snapshots, files of pools. Declared in include/rvelab/rvelab.h.
#include <algorithm>
#include <new>

#include "rvelab/abi/c_boundary.hpp"
#include "rvelab/abi/structs.hpp"
#include "rvelab/pool/mixed.hpp"

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

/// The committed state becomes what change(state) makes of it, which returns the grain-steps made; it has a new token,
/// and no trial.
template <class Change>
void change(pool::Pool& rves, std::int64_t id, const Change& change) {
  pool::RveState state = pool::rve_state_of(rves.at<&pool::Share::save>(id));
  const std::int64_t token = state.tokens.committed(), made = change(state);
  state.tokens.go_on();
  state.last.error_estimate = 0;
  const auto bytes = pool::to_bytes(state, to_bytes(state.specimen));
  rves.at<&pool::Share::replace>(id, std::span<const std::byte>(bytes), token, made);
}

}  // namespace

int32_t rvelab_apply(rvelab_pool* handle, int64_t id, const double* dH, double dt, double* sigma) {
  return of_pool(handle, {{dH, "dH"}, {sigma, "sigma"}},
                 [&](pool::Pool& rves) { return rves.apply(id, pool::tensor_at(dH), dt, sigma); });
}

int32_t rvelab_batch_init(rvelab_batch* batch, size_t struct_size) {
  return at_c_boundary([&] { init_struct(batch, "batch", struct_size); });
}

int32_t rvelab_trial(rvelab_pool* handle, rvelab_batch* batch) {
  return of_pool(handle, {{batch, "batch"}}, [&](pool::Pool& rves) {
    const rvelab_batch given = read_struct(batch);
    if (given.n > 0) expect_pointers({{given.ids, "batch.ids"}, {given.dH, "batch.dH"}, {given.sigma, "batch.sigma"}});
    return rves.trial(given);
  });
}

int32_t rvelab_mixed_init(rvelab_mixed* mixed, size_t struct_size) {
  return at_c_boundary([&] { init_struct(mixed, "mixed", struct_size); });
}

int32_t rvelab_apply_mixed(rvelab_pool* handle, rvelab_mixed* mixed) {
  return of_pool(handle, {{mixed, "mixed"}}, [&](pool::Pool& rves) {
    const rvelab_mixed given = read_struct(mixed);
    if (given.n > 0)
      expect_pointers({{given.ids, "mixed.ids"},
                       {given.strain, "mixed.strain"},
                       {given.stress, "mixed.stress"},
                       {given.value, "mixed.value"},
                       {given.scale, "mixed.scale"},
                       {given.sigma, "mixed.sigma"}});
    return pool::apply_mixed(rves, given);
  });
}

int32_t rvelab_relax(rvelab_pool* handle, int64_t id, double unbalanced, int64_t max_substeps, double* sigma) {
  return of_pool(handle, {}, [&](pool::Pool& rves) -> pool::Verdict {
    const pool::RelaxDone done = rves.at<&pool::Share::relax>(id, unbalanced, max_substeps);
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

int32_t rvelab_commit(rvelab_pool* handle, int64_t n, const int64_t* ids) {
  return of_pool(handle, {}, [&](pool::Pool& rves) {
    rves.commit(ids == nullptr ? std::span<const std::int64_t>() : ids_of(n, ids));
  });
}

int32_t rvelab_revert(rvelab_pool* handle, int64_t n, const int64_t* ids) {
  return of_pool(handle, {}, [&](pool::Pool& rves) {
    rves.revert(ids == nullptr ? std::span<const std::int64_t>() : ids_of(n, ids));
  });
}

int32_t rvelab_info_init(rvelab_info* info, size_t struct_size) {
  return at_c_boundary([&] { init_struct(info, "info", struct_size); });
}

int32_t rvelab_get_info(rvelab_pool* handle, int64_t id, rvelab_info* info) {
  return of_pool(handle, {{info, "info"}}, [&](pool::Pool& rves) {
    const std::uint32_t size = read_struct(info).struct_size;
    rvelab_info found = rves.at<&pool::Share::info>(id);
    found.struct_size = size;
    std::memcpy(static_cast<void*>(info), &found, std::min<std::size_t>(size, sizeof found));
  });
}

int32_t rvelab_get_parameters(rvelab_pool* handle, int64_t id, char* text, size_t cap, size_t* need) {
  return of_pool(
      handle, {{need, "need"}, {cap > 0 ? text : static_cast<const void*>(need), "text"}}, [&](pool::Pool& rves) {
        const std::string found =
            file_calls().parameters_text(pool::rve_state_of(rves.at<&pool::Share::save>(id)).specimen);
        copy_out("get_parameters", std::as_bytes(std::span(found.c_str(), found.size() + 1)), text, cap, need);
      });
}

int32_t rvelab_set_parameters(rvelab_pool* handle, int64_t id, const char* toml) {
  return of_pool(handle, {{toml, "toml"}}, [&](pool::Pool& rves) {
    change(rves, id, [&](pool::RveState& state) {
      text_calls(toml).set_parameters(state.specimen, toml);
      return std::int64_t(0);
    });
  });
}

int32_t rvelab_run_stages(rvelab_pool* handle, int64_t n, const int64_t* ids, const char* toml, double* sigma,
                          int32_t* status) {
  return of_pool(handle, {{toml, "toml"}}, [&](pool::Pool& rves) {
    const auto asked = ids_of(n, ids);
    text_calls(toml).check_stages(toml);
    return pool::each_entry(rves, "run_stages", n, asked.data(), status, [&](std::size_t m, pool::Verdict&) {
      change(rves, asked[m], [&](pool::RveState& state) {
        state.last.inertial_number = 0;
        return text_calls(toml).run_stages(state.specimen, toml, rves.interrupted());
      });
      if (sigma == nullptr) return;
      const rvelab_info info = rves.at<&pool::Share::info>(asked[m]);
      std::copy_n(info.sigma, 9, sigma + 9 * m);
    });
  });
}

int32_t rvelab_cost(rvelab_pool* handle, int64_t n, const int64_t* ids, int64_t* grain_steps) {
  return of_pool(handle, {}, [&](pool::Pool& rves) {
    const auto asked = ids_of(n, ids);
    if (n > 0) expect_pointers({{grain_steps, "grain_steps"}});
    rves.cost(asked, grain_steps);
  });
}

int32_t rvelab_snapshot_save(rvelab_pool* handle, int64_t id, void* buf, size_t cap, size_t* need) {
  return of_pool(handle, {{need, "need"}, {cap > 0 ? buf : need, "buf"}},
                 [&](pool::Pool& rves) { copy_out("snapshot_save", rves.at<&pool::Share::save>(id), buf, cap, need); });
}

int32_t rvelab_snapshot_load(rvelab_pool* handle, int64_t id, const void* buf, size_t size) {
  return of_pool(handle, {{buf, "buf"}}, [&](pool::Pool& rves) {
    rves.at<&pool::Share::load>(id, std::span(static_cast<const std::byte*>(buf), size));
  });
}

int32_t rvelab_pool_write(rvelab_pool* handle, const char* path) {
  return of_pool(handle, {{path, "path"}}, [&](pool::Pool& rves) {
    rves.expect_this_process();
    write_pool(rves, path);
  });
}

int32_t rvelab_pool_read(rvelab_pool* handle, const char* path) {
  return of_pool(handle, {{path, "path"}}, [&](pool::Pool& rves) {
    rves.expect_this_process();
    read_pool(rves, path);
  });
}
