// Orders of convergence (tools/validate orders): of the time step at dt > 0, and of the loading rate at dt = 0.
//
// Time step. A packing at rest, without damping and with friction that none of its contacts reaches, is sheared by 1e-7
// over twenty times its longest step; no contact opens, closes or slips, so that the motion is smooth. Error of the
// stress over its change, against a step 64 times finer. Leapfrog: order 2.
//
// Loading rate. An increment of 1e-4 at dt = 0 in n sub-steps from a state at rest, and 1e-3 of a path whose sub-steps
// are all alike, against 200,000 sub-steps, relaxed to an unbalanced ratio of 1e-9: the order of the error in strain
// per sub-step.
//
//   rvelab-orders SPECIMEN.h5 ...
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "rvelab/error.hpp"
#include "rvelab/io/hdf5/specimen_file.hpp"
#include "rvelab/solver/rve.hpp"

using namespace rvelab;

namespace {

struct Found {
  double step, error;
};

/// Least squares of ln error over ln step, of the errors of at least `times` the least.
double order_of(const std::vector<Found>& all, double times) {
  double x = 0, y = 0, xx = 0, xy = 0, n = 0, least = all.front().error;
  for (const Found& f : all) least = std::min(least, f.error);
  for (const Found& f : all) {
    if (f.error < times * least) continue;
    ++n;
    const double a = std::log(f.step), b = std::log(f.error);
    x += a, y += b, xx += a * a, xy += a * b;
  }
  return (n * xy - x * y) / (n * xx - x * x);
}

double print(const char* title, const char* unit, const std::vector<Found>& all, double times) {
  std::printf("%s\n  %s, error:", title, unit);
  for (const Found& f : all) std::printf("  %.3g %.3g", f.step, f.error);
  const double order = order_of(all, times);
  std::printf("\n  order %.2f\n", order);
  std::fflush(stdout);
  return order;
}

/// Pure shear in the plane of x and the last axis.
Matrix3 shear(int dimension, double size) {
  Matrix3 d = Matrix3::Zero();
  d(0, dimension - 1) = d(dimension - 1, 0) = size;
  return d;
}

int dimension_of(const Specimen& s) { return s.shape == Shape::sphere ? 3 : 2; }

bool time_step(const Specimen& packed) {
  Specimen s = packed;
  s.damping = {};
  for (Material& m : s.materials) m.friction = 1e3, m.rolling_friction = 1e3;
  Rve still(s);
  still.relax(1e-13, 1'000'000);
  s = still.specimen();
  const double longest = 0.4 * Rve(s).critical_time_step(), time = 20 * longest;
  const Matrix3 before = Rve(s).stress();
  const auto answer = [&](double step) {
    Specimen fine = s;
    fine.solver.fixed_time_step = step;
    return Matrix3(Rve(fine).apply(shear(dimension_of(s), 1e-7), time).stress - before);
  };
  const Matrix3 exact = answer(longest / 128);
  std::vector<Found> all;
  for (int halved = 1; halved <= 8; halved *= 2)
    all.push_back({1.0 / halved, (answer(longest / halved) - exact).norm() / exact.norm()});
  return std::abs(print("dt > 0, shear of 1e-7", "time step over 0.4 of the critical one", all, 1) - 2) < 0.1;
}

/// `parts` increments that make the strain together, n sub-steps in all.
Matrix3 loaded(const Specimen& packed, double strain, long substeps, int parts) {
  Specimen s = packed;
  s.solver.fixed_substeps = substeps / parts;
  Rve rve(s);
  for (int k = 0; k < parts; ++k) rve.apply(shear(dimension_of(s), strain / parts), 0);
  return rve.stress();
}

Matrix3 resolved(const Specimen& packed, double strain) {
  Specimen s = packed;
  s.solver.fixed_substeps = 200'000;
  Rve rve(s);
  rve.apply(shear(dimension_of(s), strain), 0);
  rve.relax(1e-9, 1'000'000);
  return rve.stress();
}

void loading_rate(const Specimen& specimen, const char* title, double strain, int parts) {
  const Matrix3 exact = resolved(specimen, strain), before = Rve(specimen).stress();
  std::vector<Found> all;
  for (long n = 20; n <= 5120; n *= 2)
    all.push_back({strain / double(n), (loaded(specimen, strain, n, parts) - exact).norm() / (exact - before).norm()});
  print(title, "strain per sub-step", all, 5);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fputs("usage: rvelab-orders SPECIMEN.h5 ...\n", stderr);
    return 2;
  }
  bool met = true;
  for (int k = 1; k < argc; ++k) {
    try {
      const Specimen specimen = io::read_specimen(argv[k]);
      std::printf("%zu %s; errors over the change of stress\n", specimen.grains.size(),
                  specimen.shape == Shape::sphere ? "spheres" : "discs");
      met = time_step(specimen) && met;
      loading_rate(specimen, "dt = 0, one increment of 1e-4 from rest", 1e-4, 1);
      loading_rate(specimen, "dt = 0, 1e-3 from rest at one rate, in ten increments", 1e-3, 10);
    } catch (const Error& error) {
      std::fprintf(stderr, "rvelab-orders: %s: %s\n", argv[k], error.what());
      return 1;
    }
  }
  return met ? 0 : 3;  // a whole table that misses bars
}
