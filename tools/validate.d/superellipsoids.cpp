// Contacts of superellipsoids against brute force, and what ways of finding them cost (tools/validate superellipsoids).
//
//   rvelab-superellipsoids fuzz PAIRS [SEED]        # a line of figures; exit code 1 if any is wrong
//   rvelab-superellipsoids cost WAY PAIRS EXPONENT  # for valgrind --tool=callgrind; WAY: bodies, guess, halving,
//   ellipsoids, none
//
// A pair is wrong if a direction of brute force has a smaller f than the contact by more than 1e-9 of the sizes, or if
// f at its normal, by powers of libm, differs by more than 1e-12 of them. Brute force: 600 directions even over half of
// the sphere, the four best that are well apart go on by random steps that shrink to 1e-9.
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "rvelab/superellipsoid/ellipsoids.hpp"
#include "tests/superellipsoid/random_pairs.hpp"

namespace {

using namespace rvelab;
using namespace rvelab::test;

double power_height(const Superellipsoid& s, const Axes& axes, const Vector& n) {
  const Vector own = in_frame(axes, n);
  const double q = s.e / (s.e - 1), p = s.n / (s.n - 1);
  return norm_of(norm_of(s.a * std::abs(own.x), s.b * std::abs(own.y), q), s.c * std::abs(own.z), p);
}

struct Drawn {
  Superellipsoid i, j;
  OverlapPair pair;
  double along(const Vector& n) const {
    return power_height(i, pair.axes_i, n) + power_height(j, pair.axes_j, n) - dot(n, pair.branch);
  }
};

/// Exponents to 8, one in eight to 20; aspects to 1:10; faces, edges and tips; one in ten deep.
Drawn drawn(Draw& draw, long k) {
  const double exponent = k % 8 == 7 ? 20 : 8, aspect = k % 2 ? 10 : 2;
  const Superellipsoid i = draw.shape(exponent, aspect), j = draw.shape(exponent, aspect);
  return {i, j, known_pair(draw, i, j, int(k % 3), k % 10 == 9 ? 2 : 0.05).pair};
}

double brute_force(const Drawn& d, const std::vector<Vector>& grid, Draw& draw) {
  std::vector<std::pair<double, Vector>> all;
  for (const Vector& n : grid) {
    const Vector forward = dot(n, d.pair.branch) < 0 ? times(-1.0, n) : n;
    all.emplace_back(d.along(forward), forward);
  }
  double least = 1e300;
  std::vector<Vector> seeds;
  for (int seed = 0; seed < 4; ++seed) {
    const std::pair<double, Vector>* best = nullptr;
    for (const auto& one : all) {
      if (best != nullptr && one.first >= best->first) continue;
      if (std::any_of(seeds.begin(), seeds.end(), [&](const Vector& n) { return dot(n, one.second) > 0.9; })) continue;
      best = &one;
    }
    if (best == nullptr) break;
    seeds.push_back(best->second);
    auto [reached, n] = *best;
    int failed = 0;
    for (double size = 0.05; size > 1e-9;) {
      const Vector trial = of_length_1(plus(n, size, draw.direction()));
      const double there = d.along(trial);
      if (there < reached) {
        reached = there;
        n = trial;
        size *= 1.5;
        failed = 0;
      } else if (++failed > 6) {
        size *= 0.6;
        failed = 0;
      }
    }
    least = std::min(least, reached);
  }
  return least;
}

int fuzz(long count, long seed) {
  Draw draw;
  draw.generator.seed(std::uint64_t(seed));
  std::vector<Vector> grid;
  for (int k = 0; k < 600; ++k) {
    const double z = (k + 0.5) / 600, around = std::sqrt(1 - z * z), angle = 2.399963229728653 * k;
    grid.push_back({around * std::cos(angle), around * std::sin(angle), z});
  }
  long wrong = 0, lanes_wrong = 0;
  double worst = 0, off = 0;
  for (long k = 0; k < count; ++k) {
    const Drawn d = drawn(draw, k);
    const double size = size_of(d.pair);
    const SuperellipsoidContact contact = contact_of(d.pair);
    const double above = (contact.overlap - brute_force(d, grid, draw)) / size;
    const double differs = std::abs(d.along(contact.n) - contact.overlap) / size;
    Vector guess = {0, 0, 0};
    const double by_lanes = contacts_of(d.pair, guess).overlap;
    worst = std::max(worst, above);
    off = std::max(off, differs);
    if (std::abs(by_lanes - contact.overlap) > 1e-9 * size) ++lanes_wrong;
    if (above <= 1e-9 && differs <= 1e-12) continue;
    ++wrong;
    std::printf("pair %ld of seed %ld: %.3g above brute force, %.3g off\n", k, seed, above, differs);
  }
  std::printf(
      "%ld pairs, seed %ld: %ld wrong, over lanes %ld; above brute force by %.2g of the sizes at most, off by %.2g\n",
      count, seed, wrong, lanes_wrong, worst, off);
  return wrong + lanes_wrong > 0 ? 1 : 0;
}

int cost(const std::string& way, long count, double exponent) {
  Draw draw;
  double sum = 0;
  long evaluations = 0;
  for (long k = 0; k < count; ++k) {
    const auto shape = [&] {
      Superellipsoid s = draw.shape(8, 2);
      s.e = s.n = exponent;
      return s;
    };
    const KnownPair known = known_pair(draw, shape(), shape(), 0, 0.01);
    Vector guess = {0, 0, 0};
    if (way == "bodies") sum += contacts_of(known.pair, guess).overlap;
    if (way == "guess") {
      guess = of_length_1(plus(known.n, 1e-6, draw.direction()));
      sum += contacts_of(known.pair, guess).overlap;
    }
    if (way == "halving") {
      long each = 0;
      const double found =
          search_least(known.pair, overlap_at(known.pair, first_direction(known.pair)), false, &each).overlap;
      evaluations += each;
      sum = std::max(sum, found - known.depth);
    }
    if (way == "ellipsoids") {
      const EllipsoidPair<double> pair = {ellipsoid_matrix(known.pair.form_i.half, known.pair.axes_i),
                                          ellipsoid_matrix(known.pair.form_j.half, known.pair.axes_j),
                                          known.pair.branch};
      sum += contacts_of(pair, guess, [&](int) { return searched_contact(known.pair); }).overlap;
    }
  }
  std::printf("%s: %ld pairs of exponent %g; %.3g; evaluations a pair by halving %.1f\n", way.c_str(), count, exponent,
              sum, double(evaluations) / double(count));
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc >= 3 && std::strcmp(argv[1], "fuzz") == 0)
    return fuzz(std::atol(argv[2]), argc > 3 ? std::atol(argv[3]) : 20260101);
  if (argc == 5 && std::strcmp(argv[1], "cost") == 0) return cost(argv[2], std::atol(argv[3]), std::atof(argv[4]));
  std::fprintf(stderr, "rvelab-superellipsoids: fuzz PAIRS [SEED], or cost WAY PAIRS EXPONENT\n");
  return 2;
}
