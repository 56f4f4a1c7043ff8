// A host whose memory runs out: each call of rvelab.h with its k-th request for memory finding none, for every k. Run
// with tests/memory_shim.cpp preloaded.
//
//     memory_host FOLDER SPECIMEN.h5 WORKERS STRIDE CALL
//
// Prints a line for each call, and one that begins with WRONG for each k after which something is not as it was: states
// of RVEs bit for bit, ids, output arrays, what the same call gives when it is made again, memory held in the end.
// STRIDE: above k = 10 only every STRIDE-th. CALL: calls whose names begin with this, "file" for those of files; "all":
// all others. Each call has a process of its own; of one that crashes it is told where, and another goes on behind that
// request.
#include <dlfcn.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "memory_host.hpp"

namespace {

enum class Kind {
  one,     ///< a call that fails leaves all as it was, and outputs untouched
  batch,   ///< each entry by itself
  accepts  ///< a batch that may have committed the trials which its tokens name
};

struct Call {
  const char* name;
  Kind kind;
  int trial_memory;
  std::function<void(Host&)> prepare;  ///< from Host::begin
  std::function<std::int32_t(Host&)> call;
  std::function<void(Host&)> undo;  ///< what Host::begin does not
  bool lasting = true;              ///< is tried without all requests from one on, too
};

void nothing(Host&) {}
std::int32_t trial(Host& h) { return rvelab_trial(h.pool, &h.batch); }
void make_trial(Host& h) {
  REQUIRE(trial(h) >= RVELAB_OK);
  h.untouch();
}
void release(Host& h, int n) { REQUIRE(rvelab_release(h.pool, n, h.numbers) == RVELAB_OK); }
std::int32_t apply(Host& h, int k, double dt) { return rvelab_apply(h.pool, h.ids[k], increment, dt, h.values); }

/// sigma_xx of the second RVE held, one normal strain given, the others none.
struct Held {
  double strain[54] = {}, stress[54] = {}, value[6] = {}, scale[6] = {};
  rvelab_mixed mixed;
} held;
void hold_stress(Host& h) {
  REQUIRE(rvelab_get_info(h.pool, h.ids[1], &h.info) == RVELAB_OK);
  REQUIRE(rvelab_mixed_init(&held.mixed, sizeof held.mixed) == RVELAB_OK);
  const int rows = h.info.dimension == 2 ? 3 : 6;
  const int entries[6][2] = {{0, 0}, {1, 1}, {rows == 3 ? 0 : 2, rows == 3 ? 1 : 2}, {1, 2}, {0, 2}, {0, 1}};
  for (int k = 0; k < rows; ++k) {
    const auto [i, j] = entries[k];
    double* const row = (k == 0 ? held.stress : held.strain) + 9 * k;
    row[3 * i + j] = row[3 * j + i] = i == j ? 1 : 0.5;
  }
  held.value[1] = -1e-4;
  held.scale[0] = h.info.p;
  held.mixed.n = 1;
  held.mixed.rows = rows;
  held.mixed.ids = h.ids + 1;
  held.mixed.strain = held.strain;
  held.mixed.stress = held.stress;
  held.mixed.value = held.value;
  held.mixed.scale = held.scale;
  held.mixed.sigma = h.values;
  held.mixed.dH = h.values + 27;
}

const Call calls[] = {
    {"pool_create", Kind::one, 0, nothing, [](Host& h) { return rvelab_pool_create(&h.def, &h.other); },
     [](Host& h) {
       REQUIRE(rvelab_pool_destroy(h.other) == RVELAB_OK);
       h.other = nullptr;
     }},
    {"template_from_snapshot", Kind::one, 0, nothing,
     [](Host& h) { return rvelab_template_from_snapshot(h.pool, h.start[1].data(), h.start[1].size(), h.numbers); },
     [](Host& h) { REQUIRE(rvelab_template_release(h.pool, h.numbers[0]) == RVELAB_OK); }},
    {"template_release", Kind::one, 0,
     [](Host& h) {
       REQUIRE(rvelab_template_from_snapshot(h.pool, h.start[1].data(), h.start[1].size(), h.tokens_in) == RVELAB_OK);
     },
     [](Host& h) { return rvelab_template_release(h.pool, h.tokens_in[0]); }, nothing},
    {"spawn", Kind::one, 0, nothing, [](Host& h) { return rvelab_spawn(h.pool, h.made, 40, h.numbers); },
     [](Host& h) { release(h, 40); }},
    {"clone", Kind::one, 0, nothing, [](Host& h) { return rvelab_clone(h.pool, h.ids[2], h.numbers); },
     [](Host& h) { release(h, 1); }},
    {"clone beside a trial", Kind::one, 0, make_trial,
     [](Host& h) { return rvelab_clone(h.pool, h.ids[1], h.numbers); }, [](Host& h) { release(h, 1); }},
    {"release", Kind::one, 0, [](Host& h) { REQUIRE(rvelab_spawn(h.pool, h.made, 3, h.tokens_in) == RVELAB_OK); },
     [](Host& h) { return rvelab_release(h.pool, 3, h.tokens_in); }, nothing},
    {"ids", Kind::one, 0, nothing, [](Host& h) { return rvelab_ids(h.pool, 39, h.numbers, h.numbers + 39); }, nothing},
    {"apply", Kind::one, 0, nothing, [](Host& h) { return apply(h, 1, 0); }, nothing},
    {"apply to an RVE with a deferred strain", Kind::one, 0, nothing, [](Host& h) { return apply(h, 2, 0); }, nothing},
    {"apply that is deferred", Kind::one, 0, nothing,
     [](Host& h) { return rvelab_apply(h.pool, h.ids[1], deferred_increment, 0, h.values); }, nothing},
    {"apply over time", Kind::one, 0, nothing, [](Host& h) { return apply(h, 1, 1e-5); }, nothing},
    {"apply to an RVE at work", Kind::one, 0,
     [](Host& h) {
       REQUIRE(rvelab_apply(h.pool, h.ids[1], increment, 1e-7, h.values) >= RVELAB_OK);
       h.untouch();
     },
     [](Host& h) { return apply(h, 1, 0); }, nothing},
    {"trial", Kind::batch, 0, nothing, trial, nothing},
    {"trial without its state", Kind::batch, 1, nothing, trial, nothing},
    {"trial over time", Kind::batch, 0, [](Host& h) { h.batch.dt = 1e-5; }, trial, nothing},
    {"trial beside a trial", Kind::batch, 0, make_trial, trial, nothing},
    {"trial from tokens", Kind::accepts, 0,
     [](Host& h) {  // of the last trial, and of one that must be made again
       make_trial(h);
       std::copy_n(h.tokens_out, 3, h.tokens_in);
       rvelab_batch one = h.batch;
       one.n = 1;
       REQUIRE(rvelab_trial(h.pool, &one) >= RVELAB_OK);
       h.batch.tokens_in = h.tokens_in;
       h.untouch();
     },
     trial, nothing},
    {"commit", Kind::one, 0, make_trial, [](Host& h) { return rvelab_commit(h.pool, 3, h.ids); }, nothing},
    {"commit of all", Kind::one, 0, make_trial, [](Host& h) { return rvelab_commit(h.pool, 0, nullptr); }, nothing},
    {"commit of trials that are made again", Kind::one, 1, make_trial,
     [](Host& h) { return rvelab_commit(h.pool, 3, h.ids); }, nothing},
    {"revert", Kind::one, 0, make_trial, [](Host& h) { return rvelab_revert(h.pool, 0, nullptr); }, nothing},
    {"get_info", Kind::one, 0, nothing, [](Host& h) { return rvelab_get_info(h.pool, h.ids[2], &h.info); }, nothing},
    {"apply_mixed", Kind::one, 0, hold_stress, [](Host& h) { return rvelab_apply_mixed(h.pool, &held.mixed); },
     nothing},
    {"relax", Kind::one, 0, nothing, [](Host& h) { return rvelab_relax(h.pool, h.ids[1], 1e-9, 20, h.values); },
     nothing},
    {"list_arrays", Kind::one, 0, nothing,
     [](Host& h) {
       static rvelab_array arrays[100];
       for (auto& each : arrays) REQUIRE(rvelab_array_init(&each, sizeof each) == RVELAB_OK);
       return rvelab_list_arrays(h.pool, h.ids[2], 100, arrays, h.numbers);
     },
     nothing},
    {"get_array", Kind::one, 0, nothing,
     [](Host& h) {
       std::size_t need = 0;
       return rvelab_get_array(h.pool, h.ids[2], "contacts/force_N", h.saved.data(), h.saved.size(), &need);
     },
     nothing},
    {"cost", Kind::one, 0, nothing, [](Host& h) { return rvelab_cost(h.pool, 3, h.ids, h.numbers); }, nothing},
    {"snapshot_save", Kind::one, 0, nothing,
     [](Host& h) {
       std::size_t need = 0;
       return rvelab_snapshot_save(h.pool, h.ids[2], h.saved.data(), h.saved.size(), &need);
     },
     nothing},
    {"snapshot_load", Kind::one, 0, nothing,
     [](Host& h) { return rvelab_snapshot_load(h.pool, h.ids[1], h.start[2].data(), h.start[2].size()); }, nothing},
    {"file: template_load", Kind::one, 0, nothing,
     [](Host& h) { return rvelab_template_load(h.pool, h.file.c_str(), h.numbers); }, nothing},
    {"file: get_parameters", Kind::one, 0, nothing,
     [](Host& h) {
       std::size_t need = 0;
       return rvelab_get_parameters(h.pool, h.ids[2], reinterpret_cast<char*>(h.saved.data()), h.saved.size(), &need);
     },
     nothing},
    {"file: set_parameters", Kind::one, 0, make_trial,
     [](Host& h) {
       return rvelab_set_parameters(h.pool, h.ids[1], "material.friction = 0.3\n[solver]\nabsolute_tolerance = 1e-3");
     },
     nothing, false},  // toml++ ends the process where it finds no memory while it unwinds
    {"file: pool_write", Kind::one, 0, nothing, [](Host& h) { return rvelab_pool_write(h.pool, h.now.c_str()); },
     nothing},
    {"file: pool_read", Kind::one, 0,
     [](Host& h) {
       REQUIRE(rvelab_pool_write(h.pool, h.kept.c_str()) == RVELAB_OK);
       REQUIRE(rvelab_pool_create(&h.def, &h.other) == RVELAB_OK);
     },
     [](Host& h) { return rvelab_pool_read(h.other, h.kept.c_str()); },
     [](Host& h) {
       std::int64_t n = 0;
       REQUIRE(rvelab_ids(h.other, 0, nullptr, &n) == RVELAB_OK);
       if (n != 3) wrong("the pool that was read has " + std::to_string(n) + " RVEs");
       for (int k = 0; k < n; ++k)
         if (snapshot_of(h.other, h.ids[k]) != h.start[k]) wrong("a state that was read is another");
       REQUIRE(rvelab_pool_destroy(h.other) == RVELAB_OK);
       h.other = nullptr;
     }},
};

/// What a call that could be made gave.
struct Result {
  std::int32_t status;
  std::vector<double> values;
  Seen seen;
  Result(const Host& host, std::int32_t status)
      : status(status), values(std::begin(host.values), std::end(host.values)), seen(host) {}
  bool same(const Result& other, Kind kind) const {
    if (status != other.status || std::memcmp(values.data(), other.values.data(), values.size() * sizeof(double)) != 0)
      return false;
    return kind != Kind::one || seen.states == other.seen.states;  // tokens of trials tell how often they were made
  }
};

void check_refused(const Call& call, const Host& host, std::int32_t status, const Seen& before) {
  if (status != RVELAB_E_MEMORY) wrong(std::string(rvelab_status_name(status)) + ": " + rvelab_last_error());
  const Seen after(host);
  if (after.ids != before.ids) return wrong("the ids are others");
  if (call.kind == Kind::one) {
    if (after.states != before.states) wrong("a state is another");
    if (!host.all_untouched()) wrong("an output was written");
    return;
  }
  for (int k = 0; k < 3; ++k) {
    if (host.status[k] >= RVELAB_OK) continue;
    if (host.status[k] != RVELAB_E_MEMORY) wrong(std::string("an entry has ") + rvelab_status_name(host.status[k]));
    if (!host.entry_untouched(k)) wrong("an output of an entry that failed was written");
    if (call.kind == Kind::batch && after.states[std::size_t(k)] != before.states[std::size_t(k)])
      wrong("the state of an entry that failed is another");
  }
}

/// The call without its `number`-th request. False: it makes fewer.
bool try_without(const Call& call, Host& host, const Result& expected) {
  host.begin();
  call.prepare(host);
  const Seen before(host);
  fail_requests(progress->number, progress->lasting);
  std::int32_t status = call.call(host);
  const bool met = requests_made() >= progress->number;
  fail_requests(0, 0);
  if (met) ++progress->sites;
  if (status < RVELAB_OK) {
    ++progress->refused;
    check_refused(call, host, status, before);
    host.untouch();
    status = call.call(host);  // with memory, from what the one without has left
  }
  if (!Result(host, status).same(expected, call.kind)) wrong("made again it gives something else");
  call.undo(host);
  return met;
}

struct Options {
  std::string folder, file;
  int workers;
  long stride;
  /// From one request without memory to the next.
  long step(long number) const { return number < 10 ? 1 : stride; }
};

void run(const Call& call, const Options& options, bool all) {
  Host host(options.folder, options.file, options.workers, call.trial_memory);
  host.begin();
  call.prepare(host);
  const std::int32_t status = call.call(host);
  REQUIRE(status >= RVELAB_OK);
  const Result expected(host, status);
  call.undo(host);
  while (all) {
    const bool met = try_without(call, host, expected);
    if (met) {
      progress->number += options.step(progress->number);
    } else if (!progress->lasting && call.lasting) {
      progress->lasting = 1;
      progress->number = 1;
    } else {
      return;
    }
  }
}

/// One process: all requests, on from where `progress` stands.
void work(const Call& call, const Options& options) {
  for (const int number : {SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL}) signal(number, crashed);
  alarm(300);
  void* places[2];
  backtrace(places, 2);  // what it loads is there then
  const bool of_file = std::strncmp(call.name, "file", 4) == 0;
  fail_new_only(of_file);  // HDF5's library does not stand a want of memory
  for (int k = 0; k < 2; ++k) run(call, options, false);
  const long held = blocks_held();
  run(call, options, true);
  const long left = blocks_held() - held;
  // What HDF5 keeps for its next use is its own.
  if (left != 0 && !of_file) wrong(std::to_string(left) + " blocks are held in the end");
  std::fflush(stdout);
  _exit(0);
}

template <class Function>
void find(Function& function, const char* name) {
  function = reinterpret_cast<Function>(dlsym(RTLD_DEFAULT, name));
  if (function != nullptr) return;
  std::fprintf(stderr, "memory_host: %s is missing: preload memory_shim\n", name);
  std::exit(2);
}

}  // namespace

int main(int n, char** words) {
  if (n != 6) {
    std::fprintf(stderr, "memory_host FOLDER SPECIMEN.h5 WORKERS STRIDE CALL\n");
    return 2;
  }
  find(fail_requests, "fail_requests");
  find(fail_new_only, "fail_new_only");
  find(requests_made, "requests_made");
  find(blocks_held, "blocks_held");
  const Options options{words[1], words[2], std::atoi(words[3]), std::atol(words[4])};
  const std::string asked = words[5];
  progress = static_cast<Progress*>(
      mmap(nullptr, sizeof(Progress), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0));
  for (const Call& call : calls) {
    const std::string name = call.name;
    if (asked == "all" ? name.starts_with("file") : !name.starts_with(asked)) continue;
    *progress = {call.name, 1, 0, 0, 0, 0};
    while (true) {
      std::fflush(stdout);
      const pid_t child = fork();
      if (child == 0) work(call, options);
      int status = 0;
      waitpid(child, &status, 0);
      if (WIFEXITED(status) && WEXITSTATUS(status) == 0) break;
      ++progress->wrong;
      std::printf("WRONG %s, request %ld%s: the process ended (%x)\n", call.name, progress->number,
                  progress->lasting ? " and on" : "", unsigned(status));
      if (WIFEXITED(status) && WEXITSTATUS(status) == 2) break;
      progress->number += options.step(progress->number);
    }
    std::printf("%s: %ld requests, %ld refused, %ld wrong\n", call.name, progress->sites, progress->refused,
                progress->wrong);
    std::fflush(stdout);
  }
}
