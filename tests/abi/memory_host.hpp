// A host whose memory can run out, and what it can see of its pool: for memory_host.cpp, whose one process this is.
#pragma once

#include <execinfo.h>
#include <rvelab/rvelab.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

namespace {

using Snapshot = std::vector<char>;

void (*fail_requests)(long number, int lasting) = nullptr;
void (*fail_new_only)(int only) = nullptr;
long (*requests_made)() = nullptr;
long (*blocks_held)() = nullptr;

/// Seen by the process that waits: which request finds no memory, in which call.
struct Progress {
  const char* call;
  long number, sites, refused, wrong;
  int lasting;
};
Progress* progress = nullptr;

void wrong(const std::string& what) {
  ++progress->wrong;
  std::printf("WRONG %s, request %ld%s: %s\n", progress->call, progress->number, progress->lasting ? " and on" : "",
              what.c_str());
}

extern "C" void crashed(int signal) {
  fail_requests(0, 0);
  char text[200];
  const int size = std::snprintf(text, sizeof text, "WRONG %s, request %ld%s: signal %d at\n", progress->call,
                                 progress->number, progress->lasting ? " and on" : "", signal);
  void* places[30];
  if (write(1, text, std::size_t(size)) == size) backtrace_symbols_fd(places, backtrace(places, 30), 1);
  _exit(3);
}

void require(bool holds, const char* what, int line) {
  if (holds) return;
  wrong("line " + std::to_string(line) + ": " + what + ": " + rvelab_last_error());
  std::fflush(stdout);
  _exit(2);
}
#define REQUIRE(condition) require(condition, #condition, __LINE__)

Snapshot snapshot_of(rvelab_pool* pool, std::int64_t id) {
  std::size_t need = 0;
  REQUIRE(rvelab_snapshot_save(pool, id, nullptr, 0, &need) == RVELAB_OK);
  Snapshot bytes(need);
  REQUIRE(rvelab_snapshot_save(pool, id, bytes.data(), need, &need) == RVELAB_OK);
  return bytes;
}

constexpr double untouched = -7;
constexpr double increment[9] = {2e-3, 1e-4, 0, 0, -2e-3, 0, 0, 0, 0};
constexpr double deferred_increment[9] = {1e-9, 0, 0, 0, -1e-9, 0, 0, 0, 0};

/// A pool with three RVEs: as their template, gone on from it, and with a strain that is deferred.
struct Host {
  Host(const std::string& folder, const std::string& file, int workers, int trial_memory)
      : now(folder + "/now.h5"), kept(folder + "/kept.h5"), file(file) {
    REQUIRE(rvelab_pool_def_init(&def, sizeof def) == RVELAB_OK);
    def.workers = workers;
    def.trial_memory = trial_memory;
    REQUIRE(rvelab_pool_create(&def, &pool) == RVELAB_OK);
    REQUIRE(rvelab_template_load(pool, file.c_str(), &made) == RVELAB_OK);
    REQUIRE(rvelab_spawn(pool, made, 3, ids) == RVELAB_OK);
    double sigma[9];
    for (int k = 1; k < 3; ++k) REQUIRE(rvelab_apply(pool, ids[k], increment, 0, sigma) >= RVELAB_OK);
    REQUIRE(rvelab_apply(pool, ids[2], deferred_increment, 0, sigma) >= RVELAB_OK);
    for (int k = 0; k < 3; ++k) start[k] = snapshot_of(pool, ids[k]);
    saved.resize(start[2].size());
    for (int k = 0; k < 27; ++k) gradients[k] = (k < 9 ? 1 : k < 18 ? 2 : 0.5) * increment[k % 9];
  }
  ~Host() {
    REQUIRE(rvelab_pool_destroy(pool) == RVELAB_OK);
    REQUIRE(rvelab_pool_destroy(other) == RVELAB_OK);
  }

  /// The RVEs as they were in the beginning, nothing pending, outputs untouched.
  void begin() {
    for (int k = 0; k < 3; ++k)
      REQUIRE(rvelab_snapshot_load(pool, ids[k], start[k].data(), start[k].size()) == RVELAB_OK);
    REQUIRE(rvelab_batch_init(&batch, sizeof batch) == RVELAB_OK);
    batch.n = 3;
    batch.ids = ids;
    batch.dH = gradients;
    batch.sigma = values;
    batch.contact = values + 27;
    batch.reynolds = values + 54;
    batch.tangent = values + 81;
    batch.error_estimate = values + 189;
    batch.dt_scale = scale;
    batch.status = status;
    batch.tokens_out = tokens_out;
    REQUIRE(rvelab_info_init(&info, sizeof info) == RVELAB_OK);
    untouch();
  }
  void untouch() {
    std::fill(std::begin(values), std::end(values), untouched);
    std::fill(std::begin(status), std::end(status), RVELAB_E_MEMORY);
    std::fill(std::begin(numbers), std::end(numbers), std::int64_t(untouched));
    std::fill(saved.begin(), saved.end(), char(untouched));
  }
  /// Those of an entry of a batch: all of one size, one kind after the other.
  bool entry_untouched(int k) const {
    const auto is = [&](int from, int each) {
      return std::all_of(values + from + k * each, values + from + (k + 1) * each,
                         [](double value) { return value == untouched; });
    };
    return is(0, 9) && is(27, 9) && is(54, 9) && is(81, 36) && is(189, 1);
  }
  bool all_untouched() const {
    return entry_untouched(0) && entry_untouched(1) && entry_untouched(2) &&
           std::all_of(std::begin(numbers), std::end(numbers), [](std::int64_t n) { return n == untouched; }) &&
           std::all_of(saved.begin(), saved.end(), [](char byte) { return byte == char(untouched); });
  }

  std::string now, kept, file;  ///< paths, made before requests for memory are counted
  rvelab_pool_def def;
  rvelab_pool *pool = nullptr, *other = nullptr;
  std::int64_t made = 0, ids[3] = {}, tokens_in[3] = {}, tokens_out[3] = {}, numbers[40];
  double gradients[27], values[192], scale[3];
  std::int32_t status[3];
  rvelab_batch batch;
  rvelab_info info;
  Snapshot start[3], saved;
};

/// What a host can see of the RVEs of a pool.
struct Seen {
  explicit Seen(const Host& host) {
    std::int64_t n = 0;
    REQUIRE(rvelab_ids(host.pool, 0, nullptr, &n) == RVELAB_OK);
    ids.resize(std::size_t(n));
    REQUIRE(rvelab_ids(host.pool, n, ids.data(), &n) == RVELAB_OK);
    for (const std::int64_t id : ids) states.push_back(snapshot_of(host.pool, id));
  }
  std::vector<std::int64_t> ids;
  std::vector<Snapshot> states;
};

}  // namespace
