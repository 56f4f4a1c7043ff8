// A path of 1e-3 strain in 1, 10, 100, 1,000 and 10,000 pieces (tools/validate starts): sub-steps, time over that of
// ten pieces, and the error of the stress at its end. The path begins at rest, goes on from as much strain in the same
// direction, or goes back after that.
//
// The reference is the same path in ten pieces of 2,000 sub-steps each, relaxed at its end to an unbalanced ratio of
// 1e-8; up to such a strain paths of dense grains are not chaotic. The tolerance is that of one increment: relative
// |d sigma| + absolute p. Time is that of the processor, the least of the repeats, which take turns.
//
//   rvelab-starts SPECIMEN.h5... [REPEATS]
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <string>
#include <vector>

#include "rvelab/io/hdf5/specimen_file.hpp"
#include "rvelab/solver/rve.hpp"
#include "rvelab/study/measures.hpp"

using namespace rvelab;

namespace {

constexpr double length = 1e-3;
constexpr long counts[] = {1, 10, 100, 1000, 10'000};
constexpr std::size_t ten = 1;  ///< place of the count that times are compared with
/// What a call takes beside a sub-step, over a sub-step (tools/bench/calls.md, 400 discs): sums of stiffness, balance,
/// copies.
constexpr double rest_of_call = 0.97;
/// Sub-steps over those of ten pieces, at most; none is asked of one piece and of a hundred.
constexpr double substep_bars[] = {1e9, 1, 1e9, 2.5, 2.5};
/// Time likewise. Of 10,000 pieces each sub-step is a call of its own, with the rest of one.
constexpr double bars[] = {1e9, 1, 1e9, 2.5, 2.5 * (1 + rest_of_call)};

struct Path {
  const char* name;
  bool before, back;  ///< from a state that has made the path once; the other way
};
constexpr Path paths[] = {{"from rest", false, false}, {"going on", true, false}, {"back", true, true}};

/// A deviator along the last axis, of unit length.
Matrix3 direction(int dimension) {
  Matrix3 d = Matrix3::Zero();
  for (int k = 0; k < dimension - 1; ++k) d(k, k) = 1.0 / (dimension - 1);
  d(dimension - 1, dimension - 1) = -1;
  return d / d.norm();
}

struct Run {
  Matrix3 stress;
  double seconds = std::numeric_limits<double>::infinity();
  long substeps = 0;
};

Run along(Rve rve, const Matrix3& whole, long pieces) {
  Run run;
  const Matrix3 increment = whole / double(pieces);
  const double begin = study::processor_seconds();
  for (long k = 0; k < pieces; ++k) run.substeps += rve.apply(increment, 0).report.substeps;
  run.seconds = study::processor_seconds() - begin;
  run.stress = rve.stress();
  return run;
}

Matrix3 resolved(Specimen specimen, const Matrix3& whole) {
  specimen.solver.fixed_substeps = 2000;
  Rve rve(specimen);
  for (int k = 0; k < 10; ++k) rve.apply(whole / 10, 0);
  rve.relax(1e-8, 300'000);
  return rve.stress();
}

bool judged(const std::string& name, const Path& path, const Specimen& specimen, int repeats) {
  const int dimension = dimension_of(specimen.shape);
  const Matrix3 whole = length * direction(dimension);
  Rve start(specimen);
  if (path.before)
    for (int k = 0; k < 10; ++k) start.apply(whole / 10, 0);
  const Matrix3 way = path.back ? Matrix3(-whole) : whole, before = start.stress();
  const Matrix3 answer = resolved(start.specimen(), way);
  const double p = -before.trace() / dimension;
  const double allowed =
      specimen.solver.relative_tolerance * (answer - before).norm() + specimen.solver.absolute_tolerance * p;
  std::vector<Run> runs(std::size(counts));
  for (int repeat = 0; repeat < repeats; ++repeat)
    for (std::size_t n = 0; n < runs.size(); ++n) {
      const double least = runs[n].seconds;
      runs[n] = along(start, way, counts[n]);
      runs[n].seconds = std::min(runs[n].seconds, least);
    }
  bool all_met = true;
  for (std::size_t n = 0; n < runs.size(); ++n) {
    const double ratio = runs[n].seconds / runs[ten].seconds, error = (runs[n].stress - answer).norm();
    const double substeps = double(runs[n].substeps) / double(runs[ten].substeps);
    const bool met = ratio <= bars[n] && substeps <= substep_bars[n] && error <= allowed;
    const std::string bar = bars[n] < 1e9 ? std::to_string(bars[n]).substr(0, 3) : "-";
    std::printf("%-14s %-10s %6ld %9ld %9.3f %6.2f %4s %10.6f %10.6f  %s\n", name.c_str(), path.name, counts[n],
                runs[n].substeps, 1e3 * runs[n].seconds, ratio, bar.c_str(), error / p, allowed / p,
                met ? "met" : "MISSED");
    if (ratio > bars[n]) {
      const double step = runs[ten].seconds / double(runs[ten].substeps), steps = step * double(runs[n].substeps);
      std::printf(
          "    why: its sub-steps, at the time of those of ten pieces, take %.3f ms; %ld calls the rest, %.2f us "
          "each\n",
          1e3 * steps, counts[n], 1e6 * (runs[n].seconds - steps) / double(counts[n]));
    }
    std::fflush(stdout);
    all_met = all_met && met;
  }
  return all_met;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fputs("usage: rvelab-starts SPECIMEN.h5... [REPEATS]\n", stderr);
    return 2;
  }
  const bool counted = argc > 2 && std::atoi(argv[argc - 1]) > 0;
  const int repeats = counted ? std::atoi(argv[argc - 1]) : 5;
  std::puts(
      "1e-3 of strain in pieces; error of the stress at the end and tolerance, over p\n"
      "specimen       path       pieces sub-steps        ms  ratio  bar      error    allowed");
  bool met = true;
  for (int k = 1; k < argc - (counted ? 1 : 0); ++k) {
    const std::string file = argv[k], name = file.substr(file.rfind('/') + 1);
    const Specimen specimen = io::read_specimen(file);
    for (const Path& path : paths) met = judged(name, path, specimen, repeats) && met;
  }
  return met ? 0 : 3;  // a whole table that misses bars
}
