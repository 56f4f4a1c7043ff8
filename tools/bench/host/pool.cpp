// What the C interface and the pool cost a host; called by tools/bench/pool.
//
//   overhead SPECIMEN.h5                        rvelab_apply over Rve::apply, time of a call, for a small specimen
//   batch SPECIMEN.h5 RVES WORKERS DH STEPS     batches of trials and commits: rate, and time over that of sub-steps
//   throughput SPECIMEN.h5 RVES WORKERS DH STEPS
//                                               the same batches, million grain-steps a second by the clock
//                                               (tools/bench/throughput)
//   bytes SPECIMEN.h5                           of an RVE at rest, ready, with a trial pending, a grain
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <numeric>
#include <string>
#include <vector>

#include "rvelab/io/hdf5/specimen_file.hpp"
#include "rvelab/solver/rve.hpp"
#include "tools/bench/host/measured.hpp"

namespace {

using namespace rvelab;

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

struct Host {
  Host(const char* specimen, std::size_t rves, int workers) : ids(rves) {
    rvelab_pool_def def;
    expect(rvelab_pool_def_init(&def, sizeof def));
    def.workers = workers;
    expect(rvelab_pool_create(&def, &pool));
    std::int64_t made = 0;
    expect(rvelab_template_load(pool, specimen, &made));
    expect(rvelab_spawn(pool, made, std::int64_t(rves), ids.data()));
  }
  rvelab_info info() {
    rvelab_info found;
    expect(rvelab_info_init(&found, sizeof found));
    expect(rvelab_get_info(pool, ids[0], &found));
    return found;
  }
  rvelab_pool* pool = nullptr;
  std::vector<std::int64_t> ids;
};

/// The same calls on two equal RVEs in turn; the least of many rounds on each side.
void overhead(const char* specimen) {
  Host host(specimen, 1, 1);
  Rve rve(io::read_specimen(specimen));
  constexpr int rounds = 300, calls = 2000;
  double through = 1e9, direct = 1e9;
  double dH[9] = {}, sigma[9];
  Matrix3 gradient = Matrix3::Zero();
  for (int round = 0; round < rounds; ++round) {
    dH[1] = gradient(0, 1) = round % 2 == 0 ? 1e-9 : -1e-9;
    const double start = now();
    for (int k = 0; k < calls; ++k) rve.apply(gradient, 0);
    const double middle = now();
    for (int k = 0; k < calls; ++k) expect(rvelab_apply(host.pool, host.ids[0], dH, 0, sigma));
    const double end = now();
    direct = std::min(direct, (middle - start) / calls);
    through = std::min(through, (end - middle) / calls);
  }
  std::printf("Rve::apply %.3f us, rvelab_apply %.3f us, over it %.3f us\n", 1e6 * direct, 1e6 * through,
              1e6 * (through - direct));
}

/// Seconds of a grain-step where a call makes hundreds of them: the time of sub-steps without that of calls.
double grain_step_seconds(const char* specimen) {
  Specimen long_calls = io::read_specimen(specimen);
  long_calls.solver.fixed_substeps = 1000;
  std::vector<double> times;
  Rve rve(long_calls);
  Matrix3 shear = Matrix3::Zero();
  for (int k = 0; k < 7; ++k) {
    shear(0, 1) = k % 2 == 0 ? 1e-4 : -1e-4;
    const double start = now();
    rve.apply(shear, 0);
    times.push_back((now() - start) / (1000 * double(rve.size())));
  }
  return median(times);
}

/// Seconds of a step where Rve::apply is called for one RVE after the other, the same increments on one thread.
double seconds_without_pool(const char* specimen, const std::vector<double>& dH, int steps) {
  std::vector<Rve> rves(dH.size() / 9, Rve(io::read_specimen(specimen)));
  std::vector<double> times;
  for (int step = -3; step < steps; ++step) {
    const double start = now();
    for (std::size_t k = 0; k < rves.size(); ++k) {
      Matrix3 gradient = Matrix3::Zero();
      gradient(0, 1) = dH[9 * k + 1];
      rves[k].apply(gradient, 0);
    }
    if (step >= 0) times.push_back(now() - start);
  }
  return median(times);
}

/// Batches of trials and commits on RVEs whose increments are size to twice size.
class Steps {
 public:
  Steps(const char* specimen, std::size_t rves, int workers, double size)
      : host(specimen, rves, workers), dH(9 * rves), sigma_(9 * rves) {
    expect(rvelab_batch_init(&batch_, sizeof batch_));
    batch_.n = std::int64_t(rves);
    batch_.ids = host.ids.data();
    batch_.dH = dH.data();
    batch_.sigma = sigma_.data();
    for (std::size_t k = 0; k < rves; ++k) dH[9 * k + 1] = size * (1 + double(k) / double(rves));
    for (int k = 0; k < 3; ++k) step();  // a start takes more sub-steps than what follows
  }
  void step() {
    expect(rvelab_trial(host.pool, &batch_));
    expect(rvelab_commit(host.pool, 0, nullptr));
  }
  /// Grain-steps of all RVEs since they were made.
  double made() {
    std::vector<std::int64_t> costs(host.ids.size());
    expect(rvelab_cost(host.pool, batch_.n, batch_.ids, costs.data()));
    return std::accumulate(costs.begin(), costs.end(), 0.0);
  }
  Host host;
  std::vector<double> dH;

 private:
  rvelab_batch batch_;
  std::vector<double> sigma_;
};

void batch(const char* specimen, std::size_t rves, int workers, double size, int steps) {
  Steps run(specimen, rves, workers, size);
  const double before = run.made();
  std::vector<double> times;
  for (int k = 0; k < steps; ++k) {
    const double start = now();
    run.step();
    times.push_back(now() - start);
  }
  const double made = run.made() - before, seconds = std::accumulate(times.begin(), times.end(), 0.0);
  const double alone = grain_step_seconds(specimen), one_step = median(times);
  std::printf(
      "%zu RVEs, %d workers, dH %g: %.3f M grain-steps a second of processor time, %.2f sub-steps a call; %.2f times "
      "the time of the sub-steps, %.2f times that of Rve::apply in a loop\n",
      rves, workers, size, 1e-6 * made / seconds, made / double(steps) / double(rves) / double(run.host.info().grains),
      one_step * steps / (made * alone), one_step / seconds_without_pool(specimen, run.dH, steps));
}

void throughput(const char* specimen, std::size_t rves, int workers, double size, int steps) {
  Steps run(specimen, rves, workers, size);
  const double before = run.made();
  const auto start = std::chrono::steady_clock::now();
  for (int k = 0; k < steps; ++k) run.step();
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  std::printf("%.3f\n", 1e-6 * (run.made() - before) / seconds.count());
}

void bytes(const char* specimen) {
  Host host(specimen, 1, 1);
  double dH[9] = {}, sigma[9];
  const auto show = [&](const char* what) {
    const rvelab_info info = host.info();
    const auto each = [&](std::int64_t bytes) { return double(bytes) / double(info.grains); };
    std::printf("%s: at rest %.0f, for the trial %.0f, ready for the next call %.0f bytes a grain\n", what,
                each(info.bytes_resting), each(info.bytes_trial), each(info.bytes_working));
  };
  show("spawned");
  dH[1] = 1e-6;
  expect(rvelab_apply(host.pool, host.ids[0], dH, 0, sigma));
  show("after a call of few sub-steps");
  rvelab_batch batch;
  expect(rvelab_batch_init(&batch, sizeof batch));
  batch.n = 1;
  batch.ids = host.ids.data();
  batch.dH = dH;
  batch.sigma = sigma;
  expect(rvelab_trial(host.pool, &batch));
  show("trial of few sub-steps pending");
  dH[1] = 2e-2;
  expect(rvelab_trial(host.pool, &batch));
  show("trial of many sub-steps pending");
}

}  // namespace

int main(int argc, char** argv) {
  const std::string what = argc > 2 ? argv[1] : "";
  if (what == "overhead") {
    overhead(argv[2]);
  } else if (what == "batch" && argc == 7) {
    batch(argv[2], std::size_t(std::atol(argv[3])), std::atoi(argv[4]), std::atof(argv[5]), std::atoi(argv[6]));
  } else if (what == "throughput" && argc == 7) {
    throughput(argv[2], std::size_t(std::atol(argv[3])), std::atoi(argv[4]), std::atof(argv[5]), std::atoi(argv[6]));
  } else if (what == "bytes") {
    bytes(argv[2]);
  } else {
    std::fprintf(stderr, "rvelab-bench-pool: see the head of tools/bench/host/pool.cpp, or tools/bench/pool\n");
    return 2;
  }
  return 0;
}
