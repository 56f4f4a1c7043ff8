// What the estimate of an increment's error is worth (tools/validate estimates): increments drawn by seed, as many from
// each class: specimen x state (isotropic, near the peak, critical) x direction (loading on, unloading, turned), of
// lengths from 1e-7 to 1e-2, each against 10,000 sub-steps and relaxation to an unbalanced ratio of 1e-8.
//
// A reference that changes by more than a third of the tolerance, when every grain is moved by 1e-12 of its radius, is
// chaotic: counted apart, and its estimate must be at least that change. Above lengths of 1e-3 the reference is the
// mean of 16 such copies.
//
//   rvelab-estimates NUMBER NAME=SPECIMEN.h5 ...     NUMBER: increments in all; prints a line of each class
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "rvelab/io/specimen_file.hpp"
#include "rvelab/measure/measures.hpp"
#include "rvelab/protocol/drive.hpp"
#include "rvelab/solver/rve.hpp"

using namespace rvelab;

namespace {

constexpr long resolved_substeps = 10'000, relax_steps = 1'000'000;
constexpr int copies = 16;
constexpr const char* states[] = {"isotropic", "near peak", "critical"};
constexpr const char* directions[] = {"loading", "unloading", "turned"};

/// Portable numbers in (0, 1).
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  double operator()(double low, double high) {
    return low + (high - low) * (double(engine_() >> 11) + 0.5) / 9007199254740992.0;
  }

 private:
  std::mt19937_64 engine_;
};

Matrix3 gradient(double xx, double yy, double xy = 0) {
  Matrix3 m = Matrix3::Zero();
  m(0, 0) = xx;
  m(1, 1) = yy;
  m(0, 1) = m(1, 0) = xy;
  return m;
}

struct State {
  Specimen specimen;
  Matrix3 direction;  ///< of the last increments, unit Frobenius norm
};

double deviator(const Matrix3& stress) { return 0.5 * (stress(0, 0) - stress(1, 1)); }

/// States of a biaxial compression at constant lateral stress to 15 %, every 0.25 %, at the default tolerance.
std::vector<State> states_of_path(const Specimen& start) {
  Rve rve(start);
  const double held = rve.stress()(0, 0);
  std::vector<State> path{{start, gradient(0, -1)}};
  constexpr double step = 5e-4;
  for (int k = 1; k <= 300; ++k) {
    std::vector<protocol::HeldStress> lateral{{0, 0, held, std::abs(held)}};
    MixedTarget target = protocol::mixed_target(gradient(0, -step), lateral, rve.stress(), 2, k > 1);
    const Response made = rve.apply(target, 0);
    if (k % 5 == 0) path.push_back({rve.specimen(), made.displacement_gradient / made.displacement_gradient.norm()});
  }
  return path;
}

/// The states that a class draws from.
std::vector<State> of_class(const std::vector<State>& path, std::size_t kind) {
  if (kind == 0) return {path[0]};
  std::size_t peak = 1;
  for (std::size_t k = 1; k < path.size(); ++k) {
    if (deviator(Rve(path[k].specimen).stress()) > deviator(Rve(path[peak].specimen).stress())) peak = k;
  }
  // Near: within a fifth of the strain at the peak, three states at least. Critical: the last third.
  const std::size_t around = std::max<std::size_t>(1, peak / 5);
  const std::size_t first = kind == 1 ? std::max<std::size_t>(1, peak - around) : 2 * path.size() / 3;
  const std::size_t last = kind == 1 ? std::min(path.size() - 1, peak + around) : path.size() - 1;
  return {path.begin() + std::ptrdiff_t(first), path.begin() + std::ptrdiff_t(last) + 1};
}

Specimen moved(const Specimen& from, std::uint64_t seed) {
  Specimen s = from;
  if (seed == 0) return s;
  Random random(seed);
  for (std::size_t g = 0; g < s.grains.size(); ++g)
    for (int k = 0; k < 2; ++k) s.grains.position[g][k] += 1e-12 * s.grains.radius[g] * random(-1, 1);
  return s;
}

Matrix3 resolved(const Specimen& from, const Matrix3& increment, std::uint64_t seed) {
  Specimen s = moved(from, seed);
  s.solver.fixed_substeps = resolved_substeps;
  Rve rve(s);
  rve.apply(increment, 0);
  rve.relax(1e-8, relax_steps);
  return rve.stress();
}

struct Drawn {
  std::size_t specimen = 0, state = 0, direction = 0;
  double length = 0, error = 0, estimate = 0, allowed = 0, spread = 0;
  bool chaotic = false, failed = false;
};

Drawn drawn(const std::vector<State>& from, std::size_t direction, std::uint64_t seed) {
  Random random(seed);
  const State& state = from[std::size_t(random(0, double(from.size())))];
  Drawn d;
  d.direction = direction;
  d.length = std::pow(10, random(-7, -2));
  Matrix3 way = state.direction;
  if (direction == 1) way = -way;
  if (direction == 2) {
    // The deviator turned: principal axes by up to 90 degrees, in either sense.
    const double angle = random(-1, 1) * 3.14159265358979323846 / 2, c = std::cos(angle), s = std::sin(angle);
    Matrix3 turn = Matrix3::Identity();
    turn.topLeftCorner<2, 2>() << c, -s, s, c;
    way = (turn * way * turn.transpose()).eval();
  }
  const Matrix3 increment = d.length * way;
  try {
    Rve rve(state.specimen);
    const Response made = rve.apply(increment, 0);
    d.estimate = made.report.error_estimate;
    d.allowed = made.report.allowed_error;
    Matrix3 reference = resolved(state.specimen, increment, 0);
    d.spread = (resolved(state.specimen, increment, seed) - reference).norm();
    d.chaotic = d.spread > d.allowed / 3;
    if (d.length > 1e-3) {
      for (std::uint64_t k = 1; k < copies; ++k) reference += resolved(state.specimen, increment, seed + k);
      reference /= copies;
    }
    d.error = (made.stress - reference).norm();
  } catch (const Error&) {
    d.failed = true;
  }
  return d;
}

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

void print(const std::string& name, const std::vector<Drawn>& all) {
  long failed = 0, chaotic = 0, covered = 0, within = 0, allowed = 0, counted = 0;
  std::vector<double> ratio, logs;
  for (const Drawn& d : all) {
    if (d.failed) {
      ++failed;
    } else if (d.chaotic) {
      ++chaotic;
      covered += d.estimate >= d.spread;
    } else {
      ++counted;
      within += d.error <= d.estimate;
      allowed += d.error <= d.allowed;
      if (!(d.error > 0 && d.estimate > 0)) continue;  // a specimen that came apart: no stress, no error
      ratio.push_back(d.estimate / d.error);
      logs.push_back(std::log(d.error / d.estimate));
    }
  }
  double mean = 0, square = 0;
  for (const double x : logs) mean += x / double(logs.size());
  for (const double x : logs) square += (x - mean) * (x - mean) / double(logs.size());
  const auto share = [](long part, long whole) { return whole > 0 ? 100.0 * double(part) / double(whole) : 0.0; };
  std::printf("%-32s %5ld %9.1f %9.1f %10.2f %8.2f %8ld %11.1f %7ld\n", name.c_str(), counted, share(within, counted),
              share(allowed, counted), median(ratio), std::sqrt(square), chaotic, share(covered, chaotic), failed);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fputs("usage: rvelab-estimates NUMBER NAME=SPECIMEN.h5 ...\n", stderr);
    return 2;
  }
  const std::size_t specimens = std::size_t(argc) - 2, classes = 9 * specimens;
  const std::size_t each = (std::size_t(std::atol(argv[1])) + classes - 1) / classes;
  std::puts("                                 increments, of them % within    estimate/ sd of ln          spread in");
  std::puts(
      "specimen, state, direction           n  estimate tolerance      error error/est. chaotic  estimate %  failed");
  std::vector<Drawn> all;
  std::vector<Drawn> of_length[5];
  for (std::size_t n = 0; n < specimens; ++n) {
    const std::string argument = argv[n + 2];
    const std::size_t equals = argument.find('=');
    const std::vector<State> path = states_of_path(io::read_specimen(argument.substr(equals + 1)));
    for (std::size_t k = 0; k < 3; ++k) {
      const std::vector<State> from = of_class(path, k);
      for (std::size_t direction = 0; direction < 3; ++direction) {
        std::vector<Drawn> of(each);
        const std::uint64_t first = ((n * 3 + k) * 3 + direction) * 1'000'000 + 1;
        const auto part = [&](std::size_t odd) {
          for (std::size_t m = odd; m < each; m += 2) of[m] = drawn(from, direction, first + 100 * m);
        };
        std::thread other(part, 1);
        part(0);
        other.join();
        print(argument.substr(0, equals) + ", " + states[k] + ", " + directions[direction], of);
        for (const Drawn& d : of) {
          all.push_back(d);
          of_length[std::clamp(int(std::floor(std::log10(d.length))) + 7, 0, 4)].push_back(d);
        }
      }
    }
  }
  for (int k = 0; k < 5; ++k)
    print("lengths 1e" + std::to_string(k - 7) + " to 1e" + std::to_string(k - 6), of_length[k]);
  print("all", all);
  return 0;
}
