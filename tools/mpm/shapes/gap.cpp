// Gaps of smooth shapes by Newton on the sphere of directions.
//
// At a direction n the rocks have the points x_a and x_b whose normals are n and -n; the way from one to the other is
// w, the value is f = n.w, its gradient along the sphere is F = w - f n. With the radii of curvature C_a and C_b there
// (the inverses of the curvatures), (C_a + C_b + f) dn = F, and the points move by C_a dn and -C_b dn. Flat sides have
// n hardly change while the point crosses them: a step is taken by the new point of either rock, whose normal is the
// new direction, or by n + dn, whichever has the largest value. Declared in shape.hpp.
#include <algorithm>

#include "tools/mpm/shapes/polyhedron.hpp"
#include "tools/mpm/shapes/shape.hpp"
#include "tools/mpm/shapes/superquadric.hpp"

namespace mpm {
namespace {

template <int D>
using Across = Eigen::Matrix<double, D, D - 1>;
template <int D>
using Square = Eigen::Matrix<double, D - 1, D - 1>;

/// A superquadric turned into the world's axes.
template <int D>
struct Turned {
  const Superquadric<D>& form;
  Mat<D> turn;
  Vec<D> support(const Vec<D>& n) const { return turn * form.support(turn.transpose() * n); }
  Vec<D> normal(const Vec<D>& x) const { return turn * form.normal(turn.transpose() * x); }
  void bend(const Vec<D>& x, Vec<D>& normal, Mat<D>& curvature) const {
    form.bend(form.retract(turn.transpose() * x), normal, curvature);
    normal = (turn * normal).eval();
    curvature = (turn * curvature * turn.transpose()).eval();
  }
  /// Radii of curvature in the plane across a normal; 1e13 sizes at most.
  Square<D> radii(const Mat<D>& curvature, const Across<D>& T) const {
    const Square<D> K = T.transpose() * curvature * T;
    return (K + 1e-13 / form.half.minCoeff() * Square<D>::Identity()).inverse();
  }
};

template <int D>
struct Direction {
  Vec<D> n, a, b, F;  ///< unit; support points about the centres; gradient
  double f;
};

template <int D>
struct SmoothPair {
  Turned<D> a, b;
  Vec<D> d;  ///< from the centre of a to that of b

  Direction<D> at(const Vec<D>& n) const {
    Direction<D> here{n, a.support(n), b.support(-n), Vec<D>::Zero(), 0};
    const Vec<D> w = d + here.b - here.a;
    here.f = n.dot(w);
    here.F = w - here.f * n;
    return here;
  }
  double size() const { return a.form.half.maxCoeff() + b.form.half.maxCoeff(); }

  struct Step {
    Vec<D> n, a, b;  ///< changes
    double gain;     ///< twice what f wins by the quadratic
  };
  Step newton(const Direction<D>& here) const {
    const Across<D> T = across<D>(here.n);
    Vec<D> normal;
    Mat<D> K_a, K_b;
    a.bend(here.a, normal, K_a);
    b.bend(here.b, normal, K_b);
    const Square<D> C_a = a.radii(K_a, T), C_b = b.radii(K_b, T);
    const Eigen::Matrix<double, D - 1, 1> F = T.transpose() * here.F;
    const Eigen::Matrix<double, D - 1, 1> dn = descent<D>(C_a + C_b + here.f * Square<D>::Identity(), F);
    return {T * dn, T * (C_a * dn), -(T * (C_b * dn)), dn.dot(F)};
  }

  /// The direction to which a part of a step leads. Each rock has its own at its new point; both are weighed by the
  /// radii of curvature there: where a rock is flat it knows the direction best.
  Vec<D> weighed(const Direction<D>& here, const Step& step, double part) const {
    Vec<D> n_a, n_b;
    Mat<D> K_a, K_b;
    a.bend(here.a + part * step.a, n_a, K_a);
    b.bend(here.b + part * step.b, n_b, K_b);
    const Vec<D> middle = (n_a - n_b).normalized();
    if (!(n_a.dot(n_b) < -0.1)) return here.n;
    const Across<D> T = across<D>(middle);
    const Square<D> C_a = a.radii(K_a, T), C_b = b.radii(K_b, T);
    const Eigen::Matrix<double, D - 1, 1> from_a = T.transpose() * n_a / n_a.dot(middle);
    const Eigen::Matrix<double, D - 1, 1> from_b = T.transpose() * n_b / n_b.dot(middle);
    return middle + T * ((C_a + C_b).inverse() * (C_a * from_a + C_b * from_b));
  }

  /// The best of four ways to take a part of a step: weighed, by the new point of one rock or the other, and straight.
  Direction<D> trial(const Direction<D>& here, const Step& step, double part) const {
    const bool a_first = step.a.norm() >= step.b.norm();
    Direction<D> best = here;
    best.f = -1e300;
    for (int way = 0; way < 4; ++way) {
      Vec<D> n = here.n + part * step.n;
      if (way == 0) {
        n = weighed(here, step, part);
      } else if (way < 3) {
        n = (way == 1) == a_first ? a.normal(here.a + part * step.a) : Vec<D>(-b.normal(here.b + part * step.b));
      }
      const Direction<D> there = at(n.normalized());
      if (there.f > best.f) best = there;
      if (best.f > here.f + 0.25 * part * step.gain) break;
    }
    return best;
  }

  /// Uphill from a direction to the maximum.
  Direction<D> climb(const Vec<D>& start) const {
    Direction<D> here = at(start);
    for (int iteration = 0; iteration < 100; ++iteration) {
      if (here.F.norm() < 1e-15 * size()) break;
      const Step step = newton(here);
      const double least = step.gain > 1e-14 * size() ? 1e-5 : 0.6;  // round-off is not searched
      bool moved = false;
      for (double part = 1; part > least && !moved; part /= 2) {
        const Direction<D> there = trial(here, step, part);
        moved = there.f > here.f + std::max(1e-4 * part * step.gain, 1e-15 * size()) ||
                (there.f >= here.f - 1e-15 * size() && there.F.norm() < 0.9 * here.F.norm());
        if (moved) here = there;
      }
      if (!moved) break;
    }
    return polished(here);
  }

  /// Along flat sides f comes to round-off first: it then says nothing of how the direction lies across an edge.
  Direction<D> polished(Direction<D> here) const {
    for (int iteration = 0; iteration < 3 && here.F.norm() > 1e-15 * size(); ++iteration) {
      const Direction<D> there = at(weighed(here, newton(here), 1).normalized());
      if (there.f < here.f - 1e-15 * size()) break;
      here = there;
    }
    return here;
  }
};

/// Directions to begin with, the best first.
template <int D>
struct Starts {
  const SmoothPair<D>& pair;
  std::vector<Direction<D>> all;

  void add(const Vec<D>& direction) {
    const double length = direction.norm();
    if (!(length > 1e-6)) return;
    all.push_back(pair.at((direction.dot(pair.d) < 0 ? -1 : 1) / length * direction));
  }
  void sort() {
    std::stable_sort(all.begin(), all.end(), [](const auto& x, const auto& y) { return x.f > y.f; });
  }
  /// Between the centres, and the normals where that line leaves the rocks.
  void add_line() {
    const double apart = pair.d.norm();
    if (!(apart > 0)) return;
    const Vec<D> line = pair.d / apart, from_a = pair.a.normal(line), from_b = -pair.b.normal(-line);
    add(line);
    add(from_a);
    add(from_b);
    add(from_a + from_b);
  }
  /// The axes of both (faces of blocks) and, in space, what is across two of them (edges of blocks).
  void add_axes() {
    for (int i = 0; i < D; ++i) {
      add(pair.a.turn.col(i));
      add(pair.b.turn.col(i));
      if constexpr (D == 3) {
        for (int j = 0; j < D; ++j) add(Vec<3>(pair.a.turn.col(i)).cross(Vec<3>(pair.b.turn.col(j))));
      }
    }
  }
};

/// Apart there is one maximum, and where the overlap is no more than the balls that roll inside both: such a ball about
/// the point that parts them touches the surface of both together nowhere else. Deeper in each other they may have
/// several: starts well apart from each other climb unless they are worse than the best one found by a quarter of the
/// inner radii.
template <int D>
Direction<D> best_direction(const SmoothPair<D>& pair) {
  Starts<D> starts{pair, {}};
  starts.add_line();
  if (starts.all.empty()) starts.add_axes();
  starts.sort();
  Direction<D> best = pair.climb(starts.all.front().n);
  if (best.f >= -(pair.a.form.rolling_radius + pair.b.form.rolling_radius)) return best;
  std::vector<Vec<D>> tried = {starts.all.front().n, best.n};
  starts.add_axes();
  starts.sort();
  const double worse = 0.25 * (pair.a.form.half.minCoeff() + pair.b.form.half.minCoeff());
  for (const Direction<D>& start : starts.all) {
    if (start.f < best.f - worse) break;
    if (std::any_of(tried.begin(), tried.end(), [&](const Vec<D>& n) { return n.dot(start.n) > 0.97; })) continue;
    const Direction<D> found = pair.climb(start.n);
    tried.push_back(start.n);
    tried.push_back(found.n);
    if (found.f > best.f) best = found;
    if (best.f >= 0) break;
  }
  return best;
}

/// The middle of the points to which the last step leads: on a flat side round-off of the direction moves its own point
/// far, the other rock's stays.
template <int D>
Gap<D> smooth_gap(const Placed<D>& a, const Placed<D>& b, const Superquadric<D>& form_a,
                  const Superquadric<D>& form_b) {
  const SmoothPair<D> pair{{form_a, matrix_of(a.orientation)}, {form_b, matrix_of(b.orientation)}, b.centre - a.centre};
  const Direction<D> best = best_direction(pair);
  const auto step = pair.newton(best);
  const Vec<D> on_a = a.centre + best.a + step.a, on_b = b.centre + best.b + step.b;
  return {best.f, best.n, 0.5 * (on_a + on_b)};
}

/// Of a sphere with a shape that has a distance.
template <int D>
Gap<D> sphere_gap(const Placed<D>& a, const Placed<D>& sphere, double radius) {
  Vec<D> normal;
  const Vec<D> r = to_body<D>(a.orientation, sphere.centre - a.centre);
  const double far = a.shape->distance(r, normal);
  normal = to_world<D>(a.orientation, normal);
  return {far - radius, normal, sphere.centre - 0.5 * (far + radius) * normal};
}

template <int D>
Gap<D> gap_in_order(const Placed<D>& a, const Placed<D>& b) {
  const auto &form_a = a.shape->form(), &form_b = b.shape->form();
  if (const double* radius = std::get_if<0>(&form_b)) {
    if (!a.shape->is_sphere()) return sphere_gap(a, b, *radius);
    const Vec<D> d = b.centre - a.centre;
    const double apart = d.norm(), first = std::get<0>(form_a);
    const Vec<D> normal = apart > 0 ? Vec<D>(d / apart) : Vec<D>::Unit(0);
    const double gap = apart - (first + *radius);
    return {gap, normal, a.centre + (first + 0.5 * gap) * normal};
  }
  if (const double* radius = std::get_if<0>(&form_a)) {
    Gap<D> gap = sphere_gap(b, a, *radius);
    gap.normal = -gap.normal;
    return gap;
  }
  if constexpr (D == 3) {
    const auto *block_a = std::get_if<2>(&form_a), *block_b = std::get_if<2>(&form_b);
    if (block_a && block_b) return polyhedra_gap(a, **block_a, b, **block_b);
    if (block_b) return block_gap(a, *std::get<1>(form_a), b, **block_b);
    if (block_a) {
      Gap<D> gap = block_gap(b, *std::get<1>(form_b), a, **block_a);
      gap.normal = -gap.normal;
      return gap;
    }
  }
  return smooth_gap(a, b, *std::get<1>(form_a), *std::get<1>(form_b));
}

/// Whether the first entry that is not zero is negative.
template <int D>
bool backward(const Vec<D>& d) {
  for (int i = 0; i < D; ++i) {
    if (d[i] != 0) return d[i] < 0;
  }
  return false;
}

}  // namespace

template <int D>
Gap<D> gap_between(const Placed<D>& a, const Placed<D>& b) {
  if (!backward<D>(b.centre - a.centre)) return gap_in_order(a, b);
  Gap<D> gap = gap_in_order(b, a);  // one order of the two for both questions: the same bits
  gap.normal = -gap.normal;
  return gap;
}

template Gap<2> gap_between(const Placed<2>&, const Placed<2>&);
template Gap<3> gap_between(const Placed<3>&, const Placed<3>&);

}  // namespace mpm
