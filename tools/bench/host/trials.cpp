// What trials cost an implicit host; called by tools/bench/trials.
//
//   trials SPECIMEN.h5     a row for each case: name, us a call (processor time, the least of five rounds), sub-steps
#include <algorithm>
#include <cstdio>
#include <functional>

#include "tools/bench/host/measured.hpp"

namespace {

class Host {
 public:
  explicit Host(const char* specimen) {
    rvelab_pool_def def;
    expect(rvelab_pool_def_init(&def, sizeof def));
    def.workers = 1;
    expect(rvelab_pool_create(&def, &pool_));
    expect(rvelab_template_load(pool_, specimen, &made_));
    expect(rvelab_spawn(pool_, made_, 1, &id_));
    rvelab_info info;
    expect(rvelab_info_init(&info, sizeof info));
    expect(rvelab_get_info(pool_, id_, &info));
    grains_ = info.grains;
  }
  Host(const Host&) = delete;
  Host& operator=(const Host&) = delete;
  ~Host() { rvelab_pool_destroy(pool_); }

  /// A trial of a shear and a compression of that size.
  void trial(double size) {
    const double dH[9] = {0, size, 0, 0, -0.5 * size, 0, 0, 0, 0};
    rvelab_batch batch;
    expect(rvelab_batch_init(&batch, sizeof batch));
    double sigma[9];
    batch.n = 1;
    batch.ids = &id_;
    batch.dH = dH;
    batch.sigma = sigma;
    expect(rvelab_trial(pool_, &batch));
  }
  void commit() { expect(rvelab_commit(pool_, 1, &id_)); }
  void advance(double size, int times) {
    for (int k = 0; k < times; ++k) {
      trial(size);
      commit();
    }
  }
  double substeps() {
    std::int64_t steps = 0;
    expect(rvelab_cost(pool_, 1, &id_, &steps));
    return double(steps) / double(grains_);
  }

 private:
  rvelab_pool* pool_ = nullptr;
  std::int64_t made_ = 0, id_ = 0, grains_ = 0;
};

/// One row. Each round begins with a fresh RVE that `before` brings to its state.
void row(const char* specimen, const char* name, int calls, const std::function<void(Host&)>& before,
         const std::function<void(Host&)>& call) {
  double least = 1e300, substeps = 0;
  for (int round = 0; round < 5; ++round) {
    Host host(specimen);
    before(host);
    call(host);  // buffers are there
    const double steps = host.substeps(), start = now();
    for (int k = 0; k < calls; ++k) call(host);
    least = std::min(least, (now() - start) / calls);
    substeps = (host.substeps() - steps) / calls;
  }
  std::printf("%s,%.2f,%.1f\n", name, 1e6 * least, substeps);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: trials SPECIMEN.h5\n");
    return 2;
  }
  const char* const specimen = argv[1];
  const auto rest = [](Host&) {};
  const auto trial = [](double size) { return [size](Host& host) { host.trial(size); }; };
  const auto step = [](double size) { return [size](Host& host) { host.advance(size, 1); }; };
  const auto after = [](double size) { return [size](Host& host) { host.advance(size, 20); }; };
  row(specimen, "trial 1e-6 from rest", 500, rest, trial(1e-6));
  row(specimen, "trial 1e-5 from rest", 300, rest, trial(1e-5));
  row(specimen, "trial 1e-4 from rest", 200, rest, trial(1e-4));
  row(specimen, "trial and commit 1e-6", 500, rest, step(1e-6));
  row(specimen, "trial and commit 1e-5", 200, rest, step(1e-5));
  row(specimen, "trial and commit 1e-4", 50, rest, step(1e-4));
  row(specimen, "after 20 of 1e-4: trial 1e-6", 50, after(1e-4), trial(1e-6));
  row(specimen, "after 20 of 1e-4: trial 1e-4", 50, after(1e-4), trial(1e-4));
  row(specimen, "after 20 of 1e-4: trial -1e-4", 50, after(1e-4), trial(-1e-4));
  row(specimen, "after 20 of 1e-3: trial 1e-6", 50, after(1e-3), trial(1e-6));
  row(specimen, "after 20 of 1e-3: trial 1e-5", 50, after(1e-3), trial(1e-5));
  row(specimen, "after 20 of 1e-3: trial 1e-4", 50, after(1e-3), trial(1e-4));
  row(specimen, "after 20 of 1e-3: trial 1e-3", 20, after(1e-3), trial(1e-3));
}
