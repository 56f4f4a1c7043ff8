// Gaps of polyhedra. Every direction gives a lower bound of the gap; the largest is at a direction that faces, edges
// and corners tell, so that it is found among finitely many:
//   two polyhedra that overlap: normals of both, and what is across an edge of each where their normals can be opposite
//   two polyhedra apart: the line between the nearest corner and face, or edges
//   a polyhedron and a superquadric: normals of the polyhedron, feet of its corners, and one direction across each edge
// Declared in polyhedron.hpp.
#include <algorithm>

#include "tools/mpm/shapes/polyhedron.hpp"
#include "tools/mpm/shapes/superquadric.hpp"

namespace mpm {
namespace {

/// A polyhedron turned about its centre and laid where it is.
struct Laid {
  Polyhedron form;
  double bounding = 0;

  Laid(const Polyhedron& shape, const Mat<3>& turn, const Vec<3>& centre) : form(shape) {
    for (Vec<3>& corner : form.corners) {
      bounding = std::max(bounding, corner.norm());
      corner = (turn * corner + centre).eval();
    }
    for (auto& face : form.faces) {
      face.normal = (turn * face.normal).eval();
      face.height += face.normal.dot(centre);
    }
  }
  Vec<3> along(const Polyhedron::Edge& edge) const {
    return form.corner(edge.corners[1]) - form.corner(edge.corners[0]);
  }
};

/// The points of two segments that are next to each other.
std::pair<Vec<3>, Vec<3>> nearest_of_segments(const Vec<3>& p, const Vec<3>& p_end, const Vec<3>& q,
                                              const Vec<3>& q_end) {
  const Vec<3> u = p_end - p, v = q_end - q, w = q - p;
  const double uu = u.squaredNorm(), vv = v.squaredNorm(), uv = u.dot(v), across = uu * vv - uv * uv;
  std::pair<Vec<3>, Vec<3>> best(p, nearest_of_segment(q, q_end, p));
  const auto take = [&](const Vec<3>& on_p, const Vec<3>& on_q) {
    if ((on_q - on_p).squaredNorm() < (best.second - best.first).squaredNorm()) best = {on_p, on_q};
  };
  take(p_end, nearest_of_segment(q, q_end, p_end));
  take(nearest_of_segment(p, p_end, q), q);
  take(nearest_of_segment(p, p_end, q_end), q_end);
  if (!(across > 1e-14 * uu * vv)) return best;
  const double s = (w.dot(u) * vv - w.dot(v) * uv) / across, t = (w.dot(u) * uv - w.dot(v) * uu) / across;
  if (s > 0 && s < 1 && t > 0 && t < 1) take(p + s * u, q + t * v);
  return best;
}

struct PolyhedronPair {
  Laid a, b;
  double far = 0;  ///< no way from a point of a to one of b is longer
  Gap<3> best{-1e300, Vec<3>::UnitX(), Vec<3>::Zero()};
  std::vector<double> of_faces_a{}, of_faces_b{};
  bool placed = false;

  double along(const Vec<3>& n) const { return -b.form.height(-n) - a.form.height(n); }

  void try_faces(const Polyhedron& form, double sign, std::vector<double>& values) {
    for (const auto& face : form.faces) {
      const Vec<3> n = sign * face.normal;
      values.push_back(along(n));
      if (values.back() > best.gap + 1e-13 * far) best = {values.back(), n, Vec<3>::Zero()};
    }
  }

  /// An edge whose faces are both worse than the best by more than the value can rise between them is left out.
  std::vector<Polyhedron::Edge> edges_of(const Polyhedron& form, const std::vector<double>& values) const {
    std::vector<Polyhedron::Edge> kept;
    for (const auto& edge : form.edges) {
      const Vec<3>&first = form.face(edge.faces[0]).normal, &second = form.face(edge.faces[1]).normal;
      const double turn = 2 * std::asin(std::min(1.0, 0.5 * (first - second).norm()));
      const double better = std::max(values[std::size_t(edge.faces[0])], values[std::size_t(edge.faces[1])]);
      if (better + far * turn >= best.gap) kept.push_back(edge);
    }
    return kept;
  }

  /// Directions across an edge of each: those that lie between the normals on both sides of either.
  void try_edges() {
    const auto edges_a = edges_of(a.form, of_faces_a), edges_b = edges_of(b.form, of_faces_b);
    for (const auto& edge_a : edges_a) {
      const Vec<3> u = a.along(edge_a), n_0 = a.form.face(edge_a.faces[0]).normal,
                   n_1 = a.form.face(edge_a.faces[1]).normal;
      for (const auto& edge_b : edges_b) {
        const Vec<3> v = b.along(edge_b), m_0 = b.form.face(edge_b.faces[0]).normal,
                     m_1 = b.form.face(edge_b.faces[1]).normal;
        if ((n_0.dot(v) > 0) == (n_1.dot(v) > 0) || (m_0.dot(u) > 0) == (m_1.dot(u) > 0)) continue;
        Vec<3> n = u.cross(v);
        const double length = n.norm();
        if (!(length > 1e-9 * u.norm() * v.norm())) continue;
        n /= n.dot(n_0 + n_1) < 0 ? -length : length;
        if (n.dot(m_0 + m_1) > 0) continue;
        const double value = along(n);
        if (value > best.gap + 1e-13 * far) best = {value, n, Vec<3>::Zero()};
      }
    }
  }

  void nearer(const Vec<3>& on_a, const Vec<3>& on_b, Gap<3>& nearest) const {
    const Vec<3> way = on_b - on_a;
    const double length = way.norm();
    if (length < nearest.gap) nearest = {length, way / length, 0.5 * (on_a + on_b)};
  }

  /// Apart: the nearest of corners and faces, edges and edges. The best direction so far is kept where it is as good.
  void try_nearest() {
    Gap<3> nearest{1e300, best.normal, Vec<3>::Zero()};
    Vec<3> outward;
    for (const Vec<3>& corner : b.form.corners) {
      const double apart = a.form.distance(corner, outward);
      nearer(corner - apart * outward, corner, nearest);
    }
    for (const Vec<3>& corner : a.form.corners) {
      const double apart = b.form.distance(corner, outward);
      nearer(corner, corner - apart * outward, nearest);
    }
    for (const auto& edge_a : a.form.edges) {
      const Vec<3>&p = a.form.corner(edge_a.corners[0]), &p_end = a.form.corner(edge_a.corners[1]);
      for (const auto& edge_b : b.form.edges) {
        const Vec<3>&q = b.form.corner(edge_b.corners[0]), &q_end = b.form.corner(edge_b.corners[1]);
        const double reach = nearest.gap + 0.5 * ((p_end - p).norm() + (q_end - q).norm());
        if ((0.5 * (q + q_end - p - p_end)).norm() > reach) continue;
        const auto [on_a, on_b] = nearest_of_segments(p, p_end, q, q_end);
        nearer(on_a, on_b, nearest);
      }
    }
    if (!(nearest.gap > best.gap + 1e-12 * far)) return;
    best = {along(nearest.normal), nearest.normal, nearest.place};
    placed = true;
  }
};

/// The corners that are farthest along a direction within 1e-6 of the size: those of their convex hull, anticlockwise
/// about it.
std::vector<Vec<3>> flat_of(const Polyhedron& form, const Vec<3>& n) {
  const double level = form.height(n) - 1e-6 * form.size(), least = 1e-9 * form.size() * form.size();
  int axis = 0;
  n.cwiseAbs().minCoeff(&axis);
  Eigen::Matrix<double, 3, 2> T;
  T.col(0) = n.cross(Vec<3>::Unit(axis)).normalized();
  T.col(1) = n.cross(Vec<3>(T.col(0)));
  std::vector<std::pair<Vec<2>, Vec<3>>> flat;  // in the plane across the direction, in space
  for (const Vec<3>& corner : form.corners) {
    if (corner.dot(n) >= level) flat.emplace_back(T.transpose() * corner, corner);
  }
  std::vector<Vec<3>> hull;
  if (flat.size() < 3) {
    for (const auto& corner : flat) hull.push_back(corner.second);
    return hull;
  }
  std::sort(flat.begin(), flat.end(), [](const auto& x, const auto& y) {
    return x.first[0] != y.first[0] ? x.first[0] < y.first[0] : x.first[1] < y.first[1];
  });
  std::vector<std::size_t> chain;
  for (const bool lower : {true, false}) {
    const std::size_t from = lower ? 0 : chain.size() - 1;
    for (std::size_t k = 0; k < flat.size(); ++k) {
      const std::size_t here = lower ? k : flat.size() - 1 - k;
      const auto turns_left = [&] {
        const Vec<2> side = flat[chain.back()].first - flat[chain[chain.size() - 2]].first;
        const Vec<2> next = flat[here].first - flat[chain.back()].first;
        return side[0] * next[1] - side[1] * next[0] > least;
      };
      while (chain.size() >= from + 2 && !turns_left()) chain.pop_back();
      if (chain.empty() || chain.back() != here) chain.push_back(here);
    }
  }
  if (chain.size() > 1 && chain.front() == chain.back()) chain.pop_back();
  for (const std::size_t k : chain) hull.push_back(flat[k].second);
  return hull;
}

/// Cuts off what lies on the outer side of a plane.
std::vector<Vec<3>> cut(const std::vector<Vec<3>>& polygon, const Vec<3>& outward, double height) {
  std::vector<Vec<3>> kept;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec<3>&here = polygon[k], &next = polygon[(k + 1) % polygon.size()];
    const double beyond = outward.dot(here) - height, beyond_next = outward.dot(next) - height;
    if (beyond <= 0) kept.push_back(here);
    if ((beyond <= 0) != (beyond_next <= 0)) kept.push_back(here + beyond / (beyond - beyond_next) * (next - here));
  }
  return kept;
}

/// The middle between the parts of both that are farthest along the normal: where two faces lie on each other the
/// middle of the polygon that they have in common.
Vec<3> place_of(const Polyhedron& a, const Polyhedron& b, const Gap<3>& gap) {
  std::vector<Vec<3>> on_a = flat_of(a, gap.normal), on_b = flat_of(b, -gap.normal);
  const Vec<3> half_gap = 0.5 * gap.gap * gap.normal;
  if (on_a.size() == 2 && on_b.size() == 2) {
    const auto [p, q] = nearest_of_segments(on_a[0], on_a[1], on_b[0], on_b[1]);
    return 0.5 * (p + q);
  }
  const bool a_is_face = on_a.size() >= on_b.size();
  const std::vector<Vec<3>>& face = a_is_face ? on_a : on_b;
  std::vector<Vec<3>> polygon = a_is_face ? on_b : on_a;
  if (face.size() >= 3) {
    const Vec<3> up = a_is_face ? gap.normal : Vec<3>(-gap.normal);  // the corners lie anticlockwise about it
    for (std::size_t k = 0; k < face.size(); ++k) {
      const Vec<3> side = face[(k + 1) % face.size()] - face[k];
      const Vec<3> outward = side.cross(up);
      const std::vector<Vec<3>> kept = cut(polygon, outward, outward.dot(face[k]));
      if (!kept.empty()) polygon = kept;
    }
  }
  Vec<3> middle = Vec<3>::Zero();
  for (const Vec<3>& corner : polygon) middle += corner / double(polygon.size());
  return middle + (a_is_face ? Vec<3>(-half_gap) : half_gap);
}

/// In the frame of a superquadric: the polyhedron beside it, and the best direction from it to there.
struct BesideSmooth {
  const Superquadric<3>& smooth;
  Laid block;
  Gap<3> best{-1e300, Vec<3>::UnitX(), Vec<3>::Zero()};

  void attempt(const Vec<3>& n, const Vec<3>& on_block) {
    const double value = -block.form.height(-n) - smooth.height(n);
    if (value > best.gap) best = {value, n, on_block - 0.5 * value * n};
  }

  /// Where a corner alone is nearest the gap is its distance. The gap is at most the distance of any corner: outside,
  /// with a gauge g, that is between (g - 1) inner radii and the way along its ray; inside it is below (g - 1) inner
  /// radii.
  void try_corners() {
    double at_most = 1e300;
    std::vector<double> levels;
    const double inner = smooth.half.minCoeff();
    for (const Vec<3>& corner : block.form.corners) {
      levels.push_back(smooth.gauge(corner));
      const double level = levels.back();
      at_most = std::min(at_most, level > 1 ? corner.norm() * (1 - 1 / level) : (level - 1) * inner);
    }
    Vec<3> n;
    for (std::size_t k = 0; k < levels.size(); ++k) {
      if (levels[k] > 1 && (levels[k] - 1 - 1e-9) * inner > at_most) continue;
      smooth.distance(block.form.corners[k], n);
      attempt(n, block.form.corners[k]);
    }
  }

  /// Between the normals of its faces the direction across an edge at which the support point of the superquadric lies
  /// beside it.
  void try_edge(const Polyhedron::Edge& edge) {
    const Vec<3>& corner = block.form.corner(edge.corners[0]);
    const Vec<3> first = -block.form.face(edge.faces[0]).normal, last = -block.form.face(edge.faces[1]).normal;
    const Vec<3> across = (last - first * first.dot(last)).normalized();
    double low = 0, high = std::atan2(across.dot(last), first.dot(last));
    Vec<3> n = first, x;
    const auto rises = [&](double angle) {
      n = std::cos(angle) * first + std::sin(angle) * across;
      x = smooth.support(n);
      return (std::cos(angle) * across - std::sin(angle) * first).dot(corner - x) > 0;
    };
    if (!rises(low) || rises(high)) return;
    for (int k = 0; k < 60 && low < high; ++k) (rises(0.5 * (low + high)) ? low : high) = 0.5 * (low + high);
    attempt(n, nearest_of_segment(corner, block.form.corner(edge.corners[1]), x));
  }

  void try_faces() {
    for (const auto& face : block.form.faces) {
      const Vec<3> n = -face.normal, x = smooth.support(n);
      attempt(n, x + n * (-face.height - n.dot(x)));
    }
  }
};

}  // namespace

Gap<3> polyhedra_gap(const Placed<3>& a, const Polyhedron& form_a, const Placed<3>& b, const Polyhedron& form_b) {
  PolyhedronPair pair{{form_a, matrix_of(a.orientation), Vec<3>::Zero()},
                      {form_b, matrix_of(b.orientation), b.centre - a.centre}};
  pair.far = (b.centre - a.centre).norm() + pair.a.bounding + pair.b.bounding;
  pair.try_faces(pair.a.form, 1, pair.of_faces_a);
  pair.try_faces(pair.b.form, -1, pair.of_faces_b);
  pair.try_edges();
  if (pair.best.gap > 0) pair.try_nearest();
  if (!pair.placed) pair.best.place = place_of(pair.a.form, pair.b.form, pair.best);
  pair.best.place += a.centre;
  return pair.best;
}

Gap<3> block_gap(const Placed<3>& smooth, const Superquadric<3>& form, const Placed<3>& block,
                 const Polyhedron& polyhedron) {
  const Mat<3> turn = matrix_of(smooth.orientation);
  BesideSmooth pair{form, Laid(polyhedron, turn.transpose() * matrix_of(block.orientation),
                               turn.transpose() * (block.centre - smooth.centre))};
  pair.try_faces();
  for (const auto& edge : pair.block.form.edges) pair.try_edge(edge);
  pair.try_corners();
  return {pair.best.gap, turn * pair.best.normal, smooth.centre + turn * pair.best.place};
}

}  // namespace mpm
