// One path of 1 % strain, whole and cut into pieces (tools/validate pieces): time, sub-steps, and the error of the
// stress at its quarter points, for increments of 1e-4, 1e-5, 1e-6 and 1e-7. The path goes straight, turns back, turns
// by 30 and by 90 degrees, or stands still for a hundred increments.
//
// The reference is the same path in increments of 1e-4 with 2,000 sub-steps each, relaxed at each quarter point (a
// copy) to an unbalanced ratio of 1e-7. Paths of grains are chaotic: up to 0.3 % the stress is compared by value,
// beyond it the means over perturbed specimens (every grain moved by up to 1e-12 of its radius), with the standard
// error of their difference.
//
// Time is that of the processor, and like the sub-steps a mean over the same specimens.
//
// The tolerance of a point is that of an increment from where the path began or turned last: relative |d sigma| +
// absolute p, d sigma of the reference.
//
// pieces.py prints and judges the table.
//
//   rvelab-pieces SPECIMEN.h5 [REPEATS]
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <thread>
#include <vector>

#include "rvelab/io/hdf5/specimen_file.hpp"
#include "rvelab/solver/rve.hpp"
#include "rvelab/study/measures.hpp"

using namespace rvelab;

namespace {

constexpr double sizes[] = {1e-4, 1e-5, 1e-6, 1e-7};
constexpr double by_value = 0.003;  ///< strain
constexpr int quarters = 4, pauses = 100;
constexpr double quarter_length = 2.5e-3;
constexpr double displacement = 5e-7;  ///< over the radius

/// A deviator of unit largest principal value whose axes are turned, in the space of deviators, by an angle.
Matrix3 direction(double degrees) {
  const double angle = degrees * 3.14159265358979323846 / 180;
  Matrix3 d = Matrix3::Zero();
  d(0, 0) = std::cos(angle);
  d(1, 1) = -d(0, 0);
  d(0, 1) = d(1, 0) = std::sin(angle);
  return d;
}

/// A quarter of the length in each direction; the path may turn after the second quarter.
struct Path {
  const char* name;
  double second_half;  ///< degrees to the first
  bool pause;          ///< between the halves
};
constexpr Path paths[] = {{"straight", 0, false},
                          {"reversal", 180, false},
                          {"turn by 30", 30, false},
                          {"turn by 90", 90, false},
                          {"pause", 0, true}};

struct Run {
  Matrix3 stress[quarters];
  double seconds = 0;
  long substeps = 0;
};

Specimen moved(const Specimen& from, std::uint64_t seed) {
  Specimen s = from;
  if (seed == 0) return s;  // as it is: compared by value
  std::mt19937_64 engine(seed);
  for (std::size_t g = 0; g < s.grains.size(); ++g)
    for (int k = 0; k < 2; ++k) {
      const double number = double(engine() >> 11) / 4503599627370496.0 - 1;
      s.grains.position[g][k] += displacement * s.grains.radius[g] * number;
    }
  return s;
}

template <class AtQuarter>
Run along(const Path& path, const Specimen& specimen, double size, AtQuarter stress_of) {
  Run run;
  Rve rve(specimen);
  for (int quarter = 0; quarter < quarters; ++quarter) {
    const Matrix3 increment = size * direction(quarter < 2 ? 0 : path.second_half);
    const double begin = study::processor_seconds();
    if (quarter == 2 && path.pause)
      for (int k = 0; k < pauses; ++k) run.substeps += rve.apply(Matrix3::Zero(), 0).report.substeps;
    for (long k = std::lround(quarter_length / size); k > 0; --k)
      run.substeps += rve.apply(increment, 0).report.substeps;
    run.seconds += study::processor_seconds() - begin;
    run.stress[quarter] = stress_of(rve);
  }
  return run;
}

Run resolved(const Path& path, Specimen specimen) {
  specimen.solver.fixed_substeps = 2000;
  return along(path, specimen, 1e-4, [](const Rve& rve) {
    Rve still = rve;
    still.relax(1e-7, 1'000'000);
    return still.stress();
  });
}

/// `run` of 0 to `count` - 1, on two threads.
template <class Make>
std::vector<Run> repeated(int count, Make make) {
  std::vector<Run> runs(static_cast<std::size_t>(count));
  const auto part = [&](int first) {
    for (int k = first; k < count; k += 2) runs[std::size_t(k)] = make(std::uint64_t(k));
  };
  std::thread other(part, 1);
  part(0);
  other.join();
  return runs;
}

Matrix3 mean(const std::vector<Run>& runs, int quarter) {
  Matrix3 sum = Matrix3::Zero();
  for (const Run& run : runs) sum += run.stress[quarter];
  return sum / double(runs.size());
}

/// Of the mean, as the norm of a tensor.
double standard_error(const std::vector<Run>& runs, int quarter) {
  const Matrix3 middle = mean(runs, quarter);
  double square = 0;
  for (const Run& run : runs) square += (run.stress[quarter] - middle).squaredNorm();
  return std::sqrt(square / double(runs.size() - 1) / double(runs.size()));
}

/// A line for each size: name, size, sub-steps, processor time (s), and of each quarter point error, its standard error
/// and the tolerance, over p.
void measured(const Path& path, const Specimen& specimen, int repeats) {
  const std::vector<Run> references =
      repeated(repeats, [&](std::uint64_t seed) { return resolved(path, moved(specimen, seed)); });
  const Matrix3 start = Rve(specimen).stress();
  for (const double size : sizes) {
    const auto stress_of = [](const Rve& rve) { return rve.stress(); };
    const std::vector<Run> runs =
        repeated(repeats, [&](std::uint64_t seed) { return along(path, moved(specimen, seed), size, stress_of); });
    double seconds = 0, substeps = 0;
    for (const Run& run : runs) seconds += run.seconds / repeats, substeps += double(run.substeps) / repeats;
    std::printf("%s,%g,%.9g,%.9g", path.name, size, substeps, seconds);
    for (int quarter = 0; quarter < quarters; ++quarter) {
      const bool value = (quarter + 1) * quarter_length <= by_value;
      const Matrix3 answer = value ? references[0].stress[quarter] : mean(references, quarter);
      const Matrix3 found = value ? runs[0].stress[quarter] : mean(runs, quarter);
      const bool turned = quarter >= 2 && path.second_half != 0;
      const Matrix3 from = !turned ? start : value ? references[0].stress[1] : mean(references, 1);
      const double p = -0.5 * (answer(0, 0) + answer(1, 1));
      const double allowed =
          specimen.solver.relative_tolerance * (answer - from).norm() + specimen.solver.absolute_tolerance * p;
      const double scatter = value ? 0 : std::hypot(standard_error(references, quarter), standard_error(runs, quarter));
      std::printf(",%.9g,%.9g,%.9g", (found - answer).norm() / p, scatter / p, allowed / p);
    }
    std::puts("");
    std::fflush(stdout);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fputs("usage: rvelab-pieces SPECIMEN.h5 [REPEATS]\n", stderr);
    return 2;
  }
  const Specimen specimen = io::read_specimen(argv[1]);
  const int repeats = argc > 2 ? std::max(2, std::atoi(argv[2])) : 16;
  for (const Path& path : paths) measured(path, specimen, repeats);
}
