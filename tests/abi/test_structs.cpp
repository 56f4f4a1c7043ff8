// Structs in the sizes of older and newer headers, and where their fields lie.
#include <cstddef>

#include "tests/abi/host.hpp"

using namespace rvelab;
using namespace rvelab::test;
using Catch::Matchers::Contains;

extern "C" int header_as_c11(void);

// Version 1.0: nothing of this ever changes; later fields come behind.
static_assert(sizeof(rvelab_pool_def) == 72 && sizeof(rvelab_batch) == 112);
static_assert(offsetof(rvelab_pool_def, workers) == 8 && offsetof(rvelab_pool_def, trial_memory) == 12);
static_assert(offsetof(rvelab_pool_def, tolerance_rel) == 16 && offsetof(rvelab_pool_def, tolerance_abs) == 24);
static_assert(offsetof(rvelab_pool_def, max_substeps) == 32 && offsetof(rvelab_pool_def, damping) == 40);
static_assert(offsetof(rvelab_pool_def, min_height) == 48 && offsetof(rvelab_pool_def, run_tasks) == 56);
static_assert(offsetof(rvelab_pool_def, host) == 64);
static_assert(offsetof(rvelab_batch, n) == 8 && offsetof(rvelab_batch, dt) == 16 && offsetof(rvelab_batch, ids) == 24);
static_assert(offsetof(rvelab_batch, dH) == 32 && offsetof(rvelab_batch, tokens_in) == 40);
static_assert(offsetof(rvelab_batch, sigma) == 48 && offsetof(rvelab_batch, contact) == 56);
static_assert(offsetof(rvelab_batch, reynolds) == 64 && offsetof(rvelab_batch, tangent) == 72);
static_assert(offsetof(rvelab_batch, error_estimate) == 80 && offsetof(rvelab_batch, dt_scale) == 88);
static_assert(offsetof(rvelab_batch, status) == 96 && offsetof(rvelab_batch, tokens_out) == 104);
static_assert(offsetof(rvelab_info, dimension) == 8 && offsetof(rvelab_info, grains) == 16);
static_assert(offsetof(rvelab_info, contacts) == 24 && offsetof(rvelab_info, lattice) == 32);
static_assert(offsetof(rvelab_info, rotation) == 104 && offsetof(rvelab_info, volume) == 176);
static_assert(offsetof(rvelab_info, void_ratio) == 184 && offsetof(rvelab_info, coordination_number) == 192);
static_assert(offsetof(rvelab_info, fabric) == 200 && offsetof(rvelab_info, fabric_anisotropy) == 272);
static_assert(offsetof(rvelab_info, sliding_fraction) == 280 && offsetof(rvelab_info, p) == 288);
static_assert(offsetof(rvelab_info, q) == 296 && offsetof(rvelab_info, unbalanced_force_ratio) == 304);
static_assert(offsetof(rvelab_info, inertial_number) == 312 && offsetof(rvelab_info, permeability_ratio) == 320);
static_assert(offsetof(rvelab_info, min_height_ratio) == 328 && offsetof(rvelab_info, grain_steps) == 336);
static_assert(offsetof(rvelab_info, bytes_resting) == 344 && offsetof(rvelab_info, bytes_trial) == 352);
static_assert(offsetof(rvelab_info, bytes_working) == 360 && offsetof(rvelab_info, token) == 368);
// Version 1.2.
static_assert(offsetof(rvelab_info, sigma) == 376 && offsetof(rvelab_info, contact) == 448);
static_assert(offsetof(rvelab_info, reynolds) == 520 && offsetof(rvelab_info, error_estimate) == 592);
static_assert(sizeof(rvelab_info) == 600 && sizeof(rvelab_array) == 56);
static_assert(offsetof(rvelab_array, name) == 8 && offsetof(rvelab_array, unit) == 16);
static_assert(offsetof(rvelab_array, meaning) == 24 && offsetof(rvelab_array, of) == 32);
static_assert(offsetof(rvelab_array, type) == 36 && offsetof(rvelab_array, rows) == 40);
static_assert(offsetof(rvelab_array, columns) == 48 && sizeof(rvelab_mixed) == 144);
static_assert(offsetof(rvelab_mixed, rows) == 16 && offsetof(rvelab_mixed, tolerance) == 32);
static_assert(offsetof(rvelab_mixed, ids) == 40 && offsetof(rvelab_mixed, spin) == 88);
static_assert(offsetof(rvelab_mixed, sigma) == 96 && offsetof(rvelab_mixed, tokens_out) == 136);

namespace {

/// A struct of a header of some size, in bytes that are all `fill` at the start.
template <class Struct>
struct Sized {
  explicit Sized(unsigned char fill) { std::memset(bytes, fill, sizeof bytes); }
  Struct* get() { return reinterpret_cast<Struct*>(bytes); }
  alignas(Struct) unsigned char bytes[sizeof(Struct) + 64];
};

template <class Struct, class Init>
void check_init(Init init) {
  for (std::size_t size = 8; size <= sizeof(Struct) + 64; size += 8) {
    Sized<Struct> given(0xAB);
    if (init(given.get(), size) == RVELAB_E_INPUT) {  // within a tensor
      CHECK(sizeof(Struct) == sizeof(rvelab_info));
      continue;
    }
    CHECK(given.get()->struct_size == size);
    const std::size_t written = std::min(size, sizeof(Struct));
    for (std::size_t at = 4; at < sizeof given.bytes; ++at)
      if (given.bytes[at] != (at < written ? 0 : 0xAB)) FAIL_CHECK("size " << size << ", byte " << at);
  }
  for (const std::size_t size : {std::size_t(0), std::size_t(7), std::size_t(1) << 20}) {
    Sized<Struct> given(0xAB);
    CHECK(init(given.get(), size) == RVELAB_E_INPUT);
    CHECK(given.bytes[0] == 0xAB);
  }
}

}  // namespace

TEST_CASE("The header compiles as C11 and says the version of the library") {
  CHECK(header_as_c11() == rvelab_abi_version());
  CHECK(rvelab_abi_version() >> 16 == RVELAB_ABI_MAJOR);
  CHECK_THAT(rvelab_version(), Contains("."));
  CHECK((rvelab_capabilities() & RVELAB_CAN_FILES) != 0);
  CHECK(std::string(rvelab_status_name(RVELAB_E_STALE)) == "RVELAB_E_STALE");
  CHECK(std::string(rvelab_status_name(RVELAB_DISCARD)) == "RVELAB_DISCARD");
  CHECK(std::string(rvelab_status_name(-999)) == "unknown status");
}

TEST_CASE("init writes min(struct_size, own size) bytes") {
  check_init<rvelab_pool_def>(rvelab_pool_def_init);
  check_init<rvelab_batch>(rvelab_batch_init);
  check_init<rvelab_info>(rvelab_info_init);
  check_init<rvelab_array>(rvelab_array_init);
  check_init<rvelab_mixed>(rvelab_mixed_init);
}

TEST_CASE("A smaller struct has defaults in the missing fields, a larger one must be zero beyond") {
  rvelab_pool* pool = nullptr;
  Sized<rvelab_pool_def> def(0);
  def.get()->struct_size = sizeof(rvelab_pool_def) + 64;
  REQUIRE_OK(rvelab_pool_create(def.get(), &pool));
  rvelab_pool_destroy(pool);
  pool = nullptr;
  def.bytes[sizeof(rvelab_pool_def) + 21] = 1;
  CHECK(rvelab_pool_create(def.get(), &pool) == RVELAB_E_UNSUPPORTED);
  CHECK_THAT(rvelab_last_error(), Contains("offset " + std::to_string(sizeof(rvelab_pool_def) + 21)));
  for (const std::uint32_t size : {0u, 7u, 1u << 20}) {
    def.get()->struct_size = size;
    CHECK(rvelab_pool_create(def.get(), &pool) == RVELAB_E_INPUT);
  }
  CHECK(pool == nullptr);
  // A header that ends after `workers`: what stands behind is not looked at.
  def.get()->struct_size = 12;
  def.get()->workers = 2;
  def.get()->trial_memory = 99;
  def.get()->tolerance_rel = -1;
  REQUIRE_OK(rvelab_pool_create(def.get(), &pool));
  rvelab_pool_destroy(pool);

  Host host;
  Trials trials(host.spawn(packed(Shape::disc, 6)));
  trials.ask_for_all();
  Sized<rvelab_batch> batch(0);
  std::memcpy(batch.bytes, &trials.batch, sizeof trials.batch);
  batch.get()->struct_size = offsetof(rvelab_batch, contact);  // of a header without what comes behind sigma
  trials.contact[0][0] = trials.dt_scale[0] = 77;
  REQUIRE_OK(rvelab_trial(host.pool, batch.get()));
  CHECK((trials.contact[0][0] == 77 && trials.dt_scale[0] == 77 && trials.status[0] == 99));
  batch.get()->struct_size = offsetof(rvelab_batch, sigma);
  CHECK(rvelab_trial(host.pool, batch.get()) == RVELAB_E_NULL);
  batch.get()->struct_size = sizeof(rvelab_batch) + 8;
  batch.bytes[sizeof(rvelab_batch) + 3] = 9;
  CHECK(rvelab_trial(host.pool, batch.get()) == RVELAB_E_UNSUPPORTED);
}

TEST_CASE("info is written up to its struct_size") {
  Host host;
  const auto ids = host.spawn(packed(Shape::disc, 6));
  for (const std::size_t size : {std::size_t(8), std::size_t(24), offsetof(rvelab_info, p), sizeof(rvelab_info)}) {
    Sized<rvelab_info> info(0xAB);
    info.get()->struct_size = std::uint32_t(size);
    info.get()->flags = 0;
    REQUIRE_OK(rvelab_get_info(host.pool, ids[0], info.get()));
    CHECK(info.get()->struct_size == size);
    for (std::size_t at = size; at < sizeof info.bytes; ++at) CHECK(info.bytes[at] == 0xAB);
    if (size >= 24) CHECK(info.get()->grains == 36);
  }
}

namespace {

/// Whether a status is that of a size which ends within a field, and its text names both.
bool is_cut(std::int32_t status, std::size_t size, const char* field) {
  const std::string text = rvelab_last_error();
  return status == RVELAB_E_INPUT && text.find("struct_size is " + std::to_string(size) + ",") != std::string::npos &&
         text.find(std::string("field ") + field) != std::string::npos;
}

}  // namespace

TEST_CASE("A struct_size that ends within a field is refused, and the text names size and field") {
  Host host;
  const Specimen& start = packed(Shape::disc, 3);
  const auto ids = host.spawn(start);
  for (std::size_t size = 8; size <= sizeof(rvelab_batch); ++size) {
    CAPTURE(size);
    Trials trials(ids);
    trials.ask_for_all();
    std::vector<std::byte> exact(size);  // of that length and no more
    std::memcpy(exact.data(), &trials.batch, size);
    const auto length = std::uint32_t(size);
    std::memcpy(exact.data(), &length, sizeof length);
    auto* const batch = reinterpret_cast<rvelab_batch*>(exact.data());
    const std::int32_t status = rvelab_trial(host.pool, batch);
    if (size % 8 != 0) {
      const char* const names[] = {"n",        "dt",      "ids",       "dH",      "tokens_in",
                                   "sigma",    "contact", "reynolds",  "tangent", "error_estimate",
                                   "dt_scale", "status",  "tokens_out"};
      CHECK(is_cut(status, size, names[size / 8 - 1]));
      CHECK(is_cut(rvelab_batch_init(batch, size), size, names[size / 8 - 1]));
    } else if (size == 8) {
      CHECK(status == RVELAB_OK);  // n is 0
    } else {
      CHECK(std::min(status, RVELAB_OK) == (size > offsetof(rvelab_batch, sigma) ? RVELAB_OK : RVELAB_E_NULL));
    }
  }
  for (std::size_t size = 8; size <= sizeof(rvelab_pool_def); ++size) {
    CAPTURE(size);
    rvelab_pool_def def = default_def();
    def.struct_size = std::uint32_t(size);
    rvelab_pool* pool = nullptr;
    const std::int32_t status = rvelab_pool_create(&def, &pool);
    if (size % 8 == 0 || size == 12) {
      CHECK(status == RVELAB_OK);
      rvelab_pool_destroy(pool);
    } else {
      CHECK(is_cut(status, size,
                   size < 12   ? "workers"
                   : size < 16 ? "trial_memory"
                   : size < 24 ? "tolerance_rel"
                               : ""));
      CHECK(pool == nullptr);
      CHECK(rvelab_pool_def_init(&def, size) == RVELAB_E_INPUT);
    }
  }
  for (std::size_t size = 8; size <= sizeof(rvelab_info); ++size) {
    CAPTURE(size);
    rvelab_info info{};
    info.struct_size = std::uint32_t(size);
    const std::int32_t status = rvelab_get_info(host.pool, ids[0], &info);
    const std::pair<const char*, std::size_t> tensors[] = {
        {"lattice", offsetof(rvelab_info, lattice)}, {"rotation", offsetof(rvelab_info, rotation)},
        {"fabric", offsetof(rvelab_info, fabric)},   {"sigma", offsetof(rvelab_info, sigma)},
        {"contact", offsetof(rvelab_info, contact)}, {"reynolds", offsetof(rvelab_info, reynolds)}};
    const char* tensor = nullptr;
    for (const auto& [name, begin] : tensors)
      if (begin < size && size < begin + 9 * sizeof(double)) tensor = name;
    if (tensor != nullptr || size % 8 != 0) {
      CHECK(is_cut(status, size, tensor != nullptr ? tensor : ""));
      CHECK(info.dimension == 0);
      CHECK(rvelab_info_init(&info, size) == RVELAB_E_INPUT);
    } else {
      CHECK(status == RVELAB_OK);
    }
  }
}
