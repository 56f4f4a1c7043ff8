// A host of the C interface: pools and templates of small packings, increments drawn at random, statuses in words.
#pragma once

#include <rvelab/rvelab.h>

#include <array>
#include <cstring>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "rvelab/pool/rve_state.hpp"
#include "rvelab/solver/rve.hpp"
#include "tests/catch.hpp"
#include "tests/specimens.hpp"

namespace rvelab::test {

using Nine = std::array<double, 9>;

inline bool same(const Nine& a, const Nine& b) { return std::memcmp(a.data(), b.data(), sizeof a) == 0; }
inline Matrix3 matrix_of(const Nine& a) {
  Matrix3 m;
  for (int k = 0; k < 9; ++k) m(k / 3, k % 3) = a[std::size_t(k)];
  return m;
}
inline Nine nine_of(const Matrix3& m) {
  Nine a;
  for (int k = 0; k < 9; ++k) a[std::size_t(k)] = m(k / 3, k % 3);
  return a;
}

/// A status of a call, with its text where it is not what was expected.
#define CHECK_STATUS(call, expected)            \
  do {                                          \
    const int32_t found_status = (call);        \
    INFO(#call << ": " << rvelab_last_error()); \
    CHECK(found_status == (expected));          \
  } while (false)
#define REQUIRE_OK(call)                        \
  do {                                          \
    const int32_t found_status = (call);        \
    INFO(#call << ": " << rvelab_last_error()); \
    REQUIRE(found_status >= RVELAB_OK);         \
  } while (false)

/// Discs or spheres at rest under some pressure, with friction; made once for each size.
inline const Specimen& packed(Shape shape, int side, std::uint64_t seed = 1) {
  static std::map<std::array<std::uint64_t, 3>, Specimen> made;
  const std::array<std::uint64_t, 3> key{std::uint64_t(shape), std::uint64_t(side), seed};
  const auto found = made.find(key);
  if (found != made.end()) return found->second;
  Rve rve(disordered(shape, side, linear_material(2e6, 1e6, 0.4), Law::linear_stiffness, 0.515, seed));
  rve.relax(1e-5, 100'000);
  rve.take_as_reference();
  return made.emplace(key, rve.specimen()).first->second;
}

inline std::vector<std::byte> snapshot_of(const Specimen& specimen) {
  pool::RveState state;
  state.initial_void_ratio = 0.2;
  return pool::to_bytes(state, Rve(specimen).save());
}

inline rvelab_pool_def default_def(int workers = 1) {
  rvelab_pool_def def;
  REQUIRE(rvelab_pool_def_init(&def, sizeof def) == RVELAB_OK);
  def.workers = workers;
  return def;
}

/// A pool with RVEs from templates.
class Host {
 public:
  explicit Host(const rvelab_pool_def& def) { REQUIRE_OK(rvelab_pool_create(&def, &pool)); }
  explicit Host(int workers = 1) : Host(default_def(workers)) {}
  ~Host() { rvelab_pool_destroy(pool); }
  Host(const Host&) = delete;
  Host& operator=(const Host&) = delete;

  std::int64_t template_of(const Specimen& specimen) {
    const auto bytes = snapshot_of(specimen);
    std::int64_t made = 0;
    REQUIRE_OK(rvelab_template_from_snapshot(pool, bytes.data(), bytes.size(), &made));
    return made;
  }
  std::vector<std::int64_t> spawn(const Specimen& specimen, std::size_t n = 1) {
    std::vector<std::int64_t> ids(n);
    REQUIRE_OK(rvelab_spawn(pool, template_of(specimen), std::int64_t(n), ids.data()));
    return ids;
  }
  Nine apply(std::int64_t id, const Nine& dH, double dt = 0) {
    Nine sigma{};
    REQUIRE_OK(rvelab_apply(pool, id, dH.data(), dt, sigma.data()));
    return sigma;
  }
  std::vector<std::byte> snapshot(std::int64_t id) {
    std::size_t need = 0;
    REQUIRE_OK(rvelab_snapshot_save(pool, id, nullptr, 0, &need));
    std::vector<std::byte> bytes(need);
    REQUIRE_OK(rvelab_snapshot_save(pool, id, bytes.data(), bytes.size(), &need));
    return bytes;
  }
  /// The state without its tokens, whose numbers tell of detours.
  Specimen state(std::int64_t id) { return pool::rve_state_of(snapshot(id)).specimen; }
  rvelab_info info(std::int64_t id) {
    rvelab_info found;
    REQUIRE(rvelab_info_init(&found, sizeof found) == RVELAB_OK);
    REQUIRE_OK(rvelab_get_info(pool, id, &found));
    return found;
  }

  rvelab_pool* pool = nullptr;
};

/// Trials of many RVEs with all arrays there.
struct Trials {
  explicit Trials(std::vector<std::int64_t> of) : ids(std::move(of)) {
    const std::size_t n = ids.size();
    dH.resize(n);
    sigma.resize(n);
    contact.resize(n);
    reynolds.resize(n);
    tangent.resize(36 * n);
    error_estimate.resize(n);
    dt_scale.resize(n);
    status.resize(n, 99);
    tokens.resize(n);
    REQUIRE(rvelab_batch_init(&batch, sizeof batch) == RVELAB_OK);
    batch.n = std::int64_t(n);
    batch.ids = ids.data();
    batch.dH = dH.empty() ? nullptr : dH[0].data();
    batch.sigma = sigma.empty() ? nullptr : sigma[0].data();
    batch.dt_scale = dt_scale.data();
    batch.status = status.data();
    batch.tokens_out = tokens.data();
  }
  void ask_for_all() {
    batch.contact = contact[0].data();
    batch.reynolds = reynolds[0].data();
    batch.tangent = tangent.data();
    batch.error_estimate = error_estimate.data();
  }

  std::vector<std::int64_t> ids;
  std::vector<Nine> dH, sigma, contact, reynolds;
  std::vector<double> tangent, error_estimate, dt_scale;
  std::vector<std::int32_t> status;
  std::vector<std::int64_t> tokens;
  rvelab_batch batch;
};

/// Increments in the plane or in space, spin included.
class Increments {
 public:
  explicit Increments(std::uint64_t seed, int dimension = 2) : generator_(seed), dimension_(dimension) {}
  double uniform() { return 2 * double(generator_() >> 11) / 9007199254740992.0 - 1; }
  std::uint64_t below(std::uint64_t bound) { return generator_() % bound; }
  Nine next(double size) {
    Nine dH{};
    for (int i = 0; i < dimension_; ++i)
      for (int j = 0; j < dimension_; ++j) dH[std::size_t(3 * i + j)] = size * uniform();
    return dH;
  }

 private:
  std::mt19937_64 generator_;
  int dimension_;
};

}  // namespace rvelab::test
