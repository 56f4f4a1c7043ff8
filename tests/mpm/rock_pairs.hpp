// Random rocks and directions, and the largest of a function over all directions by brute force.
#pragma once

#include <algorithm>
#include <numbers>
#include <random>
#include <vector>

#include "tools/mpm/shapes/shape.hpp"

namespace mpm::test {

/// The same numbers on every machine.
struct Draw {
  std::mt19937 generator{20230615};
  double between(double low, double high) { return low + (high - low) * (double(generator()) / 4294967296.0); }
  template <int D>
  Vec<D> direction() {
    for (;;) {
      Vec<D> v;
      for (int i = 0; i < D; ++i) v[i] = between(-1, 1);
      if (v.norm() < 1 && v.norm() > 0.1) return v.normalized();
    }
  }
  template <int D>
  Rot<D> orientation() {
    if constexpr (D == 2) {
      return between(0, 6.28);
    } else {
      const Vec<3> axis = direction<3>();
      return Eigen::Quaterniond(Eigen::AngleAxisd(between(0, 3.14), axis));
    }
  }
  template <int D>
  RockShape<D> superquadric(double least_n, double most_n) {
    Vec<D> half;
    for (int i = 0; i < D; ++i) half[i] = between(0.4, 1.2);
    const double n1 = between(least_n, most_n), n2 = between(least_n, most_n);
    return RockShape<D>::superquadric(half, n1, n2);
  }
};

/// Directions spread evenly.
template <int D>
std::vector<Vec<D>> directions(int count) {
  std::vector<Vec<D>> all;
  for (int k = 0; k < count; ++k) {
    Vec<D> n;
    if constexpr (D == 2) {
      n << std::cos(2 * std::numbers::pi * k / count), std::sin(2 * std::numbers::pi * k / count);
    } else {
      const double z = 1 - (2 * k + 1.0) / count, around = std::sqrt(1 - z * z), golden = 2.399963229728653 * k;
      n << around * std::cos(golden), around * std::sin(golden), z;
    }
    all.push_back(n);
  }
  return all;
}

/// The largest value over all directions: of a grid the five best that are well apart climb by random steps, which
/// shrink to 1e-13. A lower bound in any case.
template <int D, class Value>
double brute_force(Draw& draw, int grid, const Value& value) {
  std::vector<std::pair<double, Vec<D>>> all;
  for (const auto& n : directions<D>(grid)) all.emplace_back(value(n), n);
  std::sort(all.begin(), all.end(), [](const auto& x, const auto& y) { return x.first > y.first; });
  std::vector<Vec<D>> seeds;
  double best = all.front().first;
  for (const auto& [first, seed] : all) {
    if (std::any_of(seeds.begin(), seeds.end(), [&](const Vec<D>& n) { return n.dot(seed) > 0.95; })) continue;
    if (seeds.size() == 5) break;
    seeds.push_back(seed);
    Vec<D> n = seed;
    double reached = first, size = 0.05;
    for (int k = 0, failed = 0; k < 6000 && size > 1e-13; ++k) {
      const Vec<D> trial = (n + size * draw.direction<D>()).normalized();
      const double there = value(trial);
      if (there > reached) {
        reached = there;
        n = trial;
        size *= 1.5;
        failed = 0;
      } else if (++failed > 10) {
        size *= 0.7;
        failed = 0;
      }
    }
    best = std::max(best, reached);
  }
  return best;
}

/// The value whose maximum is the gap.
template <int D>
double gap_along(const Placed<D>& a, const Placed<D>& b, const Vec<D>& n) {
  return n.dot(b.centre - a.centre) - a.shape->height(to_body<D>(a.orientation, n)) -
         b.shape->height(to_body<D>(b.orientation, Vec<D>(-n)));
}

/// Two rocks at random; b is moved along a random line until the gap is about as asked for.
template <int D>
struct PlacedPair {
  RockShape<D> first, second;
  Vec<D> place_a, place_b;
  Rot<D> turn_a, turn_b;
  PlacedPair(Draw& draw, const RockShape<D>& one, const RockShape<D>& other, double gap)
      : first(one),
        second(other),
        place_a(2 * draw.direction<D>()),
        turn_a(draw.orientation<D>()),
        turn_b(draw.orientation<D>()) {
    const Vec<D> line = draw.direction<D>();
    double low = 0, high = one.bounding_radius() + other.bounding_radius() + std::abs(gap);
    for (int k = 0; k < 30; ++k) {
      place_b = place_a + 0.5 * (low + high) * line;
      (gap_between(a(), b()).gap < gap ? low : high) = 0.5 * (low + high);
    }
  }
  Placed<D> a() const { return {&first, place_a, turn_a}; }
  Placed<D> b() const { return {&second, place_b, turn_b}; }
};

}  // namespace mpm::test
