// Work on RVEs: apply, trials, commit and revert. Declared in handle.hpp.
#include "rvelab/abi/handle.hpp"
#include "rvelab/abi/structs.hpp"

using namespace rvelab;
using namespace rvelab::abi;

int32_t rvelab_apply(rvelab_pool* pool, int64_t id, const double* dH, double dt, double* sigma) {
  return at_c_boundary([&] {
    pool::Pool& of = pool_of(pool);
    expect_pointer(dH, "dH");
    expect_pointer(sigma, "sigma");
    Matrix3 gradient;
    for (int k = 0; k < 9; ++k) gradient(k / 3, k % 3) = dH[k];
    return of.apply(id, gradient, dt, sigma);
  });
}

int32_t rvelab_batch_init(rvelab_batch* batch, size_t struct_size) {
  return at_c_boundary([&] {
    expect_pointer(batch, "batch");
    init_struct(batch, struct_size);
  });
}

int32_t rvelab_trial(rvelab_pool* pool, rvelab_batch* batch) {
  return at_c_boundary([&] {
    pool::Pool& of = pool_of(pool);
    expect_pointer(batch, "batch");
    const rvelab_batch given = read_struct(batch);
    if (given.n > 0) {
      expect_pointer(given.ids, "batch.ids");
      expect_pointer(given.dH, "batch.dH");
      expect_pointer(given.sigma, "batch.sigma");
    }
    pool::Batch asked;
    asked.n = given.n;
    asked.dt = given.dt;
    asked.ids = given.ids;
    asked.displacement_gradients = given.dH;
    asked.tokens_in = given.tokens_in;
    asked.stress = given.sigma;
    asked.contact_stress = given.contact;
    asked.reynolds_stress = given.reynolds;
    asked.tangent = given.tangent;
    asked.error_estimate = given.error_estimate;
    asked.dt_scale = given.dt_scale;
    asked.status = given.status;
    asked.tokens_out = given.tokens_out;
    return of.trial(asked);
  });
}

int32_t rvelab_commit(rvelab_pool* pool, int64_t n, const int64_t* ids) {
  return at_c_boundary([&] {
    pool::Pool& of = pool_of(pool);
    of.commit(ids == nullptr ? std::span<const std::int64_t>() : ids_of(n, ids));
  });
}

int32_t rvelab_revert(rvelab_pool* pool, int64_t n, const int64_t* ids) {
  return at_c_boundary([&] {
    pool::Pool& of = pool_of(pool);
    of.revert(ids == nullptr ? std::span<const std::int64_t>() : ids_of(n, ids));
  });
}
