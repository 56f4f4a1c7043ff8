// Outlines of rigid bodies about their centre. A further shape is a struct with the members of these, and its name in
// BodyShape below.
//
//   kind, rough_by_default    its name in a scene, and whether it is rough unless the scene says otherwise
//   read, settle              its keys; checks and derived values once all keys of the body are read
//   distance                  from the surface (m), negative inside, and the outward unit normal there; r (m): from the
//                             centre. A box finds its nearest face by distances over `unit`, such as half the sides of
//                             the domain of the soil at r
//   spans                     whether soil with half sides `half` whose foot on the surface is `foot` touches the body
//   face_of                   one bit for each face whose contact is detected apart, from the outward normal
//   column_axis               the axis along which each surface point has its own column of nodes; -1: they share nodes
//   each_surface_point        visit(place, outward normal) for points of the surface, a cell apart
#pragma once

#include <algorithm>
#include <cmath>
#include <variant>

#include "tools/mpm/bodies/terrain.hpp"
#include "tools/mpm/grid/grid.hpp"
#include "tools/mpm/keys/keys.hpp"

namespace mpm {

template <int D>
Vec<D> vector_of(const std::vector<double>& values) {
  return Eigen::Map<const Vec<D>>(values.data());
}

/// A footing or a plate.
template <int D>
struct Box {
  static constexpr const char* kind = "box";
  static constexpr bool rough_by_default = true;
  Vec<D> half = Vec<D>::Zero();  ///< m, half the sides

  static Box read(Keys& keys) { return {0.5 * vector_of<D>(keys.vector("size_m", D, {}))}; }
  void settle(const Keys& keys) {
    for (const double each : half) keys.expect_positive("size_m", 2 * each);
  }
  /// Of two faces at one distance that across the last axis is the nearest, a footing's lower one.
  double distance(const Vec<D>& r, Vec<D>& outward, const Vec<D>& unit) const {
    int axis = 0;
    double nearest = -1e300;
    for (int i = 0; i < D; ++i) {
      const double beyond = (std::abs(r[i]) - half[i]) / unit[i];
      if (beyond < nearest - 1e-9 * half[i] / unit[i]) continue;
      nearest = beyond;
      axis = i;
    }
    outward.setZero();
    outward[axis] = r[axis] < 0 ? -1 : 1;
    return std::abs(r[axis]) - half[axis];
  }
  /// Soil below a box, or off its corner, is not beside it: its foot may lie off the face by half of its own size, or
  /// so far that a small body would slip between two points.
  bool spans(const Vec<D>& foot, const Vec<D>& soil) const {
    for (int i = 0; i < D; ++i) {
      const double at_most = std::max(0.5 * soil[i], soil[i] - (1 - 1e-6) * half[i]);
      if (std::abs(foot[i]) - half[i] > at_most) return false;
    }
    return true;
  }
  unsigned char face_of(const Vec<D>& normal) const {
    int axis = 0;
    normal.cwiseAbs().maxCoeff(&axis);
    return static_cast<unsigned char>(1 << (2 * axis + (normal[axis] > 0)));
  }
  int column_axis() const { return -1; }
  /// In the middle of equal parts of each face.
  template <class Visit>
  void each_surface_point(const Grid<D>& grid, const Vec<D>& centre, const Visit& visit) const {
    for (int axis = 0; axis < D; ++axis) {
      long parts[3] = {1, 1, 1}, total = 1;
      for (int i = 0; i < D; ++i) {
        if (i != axis) parts[i] = std::max(1L, std::lround(2 * half[i] / grid.cell[i]));
        total *= parts[i];
      }
      for (const int side : {-1, 1}) {
        for (long n = 0; n < total; ++n) {
          Vec<D> at = centre, normal = Vec<D>::Zero();
          normal[axis] = side;
          long rest = n;
          for (int i = 0; i < D; ++i) {
            if (i == axis) continue;
            at[i] += half[i] * ((2 * double(rest % parts[i]) + 1) / double(parts[i]) - 1);
            rest /= parts[i];
          }
          at[axis] += side * half[axis];
          visit(at, normal);
        }
      }
    }
  }
};

/// A pipe; in space a cylinder along z.
template <int D>
struct Disc {
  static constexpr const char* kind = "disc";
  static constexpr bool rough_by_default = true;
  double radius = 0;  ///< m

  static Disc read(Keys& keys) { return {keys.positive("radius_m")}; }
  void settle(const Keys&) {}
  double distance(const Vec<D>& r, Vec<D>& outward, const Vec<D>&) const {
    outward = r;
    if (D == 3) outward[D - 1] = 0;
    const double length = outward.norm();
    if (length > 0) outward /= length;
    return length - radius;
  }
  bool spans(const Vec<D>&, const Vec<D>&) const { return true; }
  unsigned char face_of(const Vec<D>&) const { return 1; }
  int column_axis() const { return -1; }
  /// Around from the x-axis on, in space in each layer of nodes.
  template <class Visit>
  void each_surface_point(const Grid<D>& grid, const Vec<D>& centre, const Visit& visit) const {
    constexpr double two_pi = 6.283185307179586;
    const long around = std::max(8L, std::lround(two_pi * radius / grid.cell.template head<2>().minCoeff()));
    const long layers = D == 3 ? grid.count[D - 1] : 1;
    for (long layer = 0; layer < layers; ++layer) {
      for (long n = 0; n < around; ++n) {
        const double angle = two_pi * double(n) / double(around);
        Vec<D> normal = Vec<D>::Zero();
        normal[0] = std::cos(angle);
        normal[1] = std::sin(angle);
        Vec<D> at = centre + radius * normal;
        if (D == 3) at[D - 1] = grid.anchor[D - 1] + (grid.low[D - 1] + double(layer)) * grid.cell[D - 1];
        visit(at, normal);
      }
    }
  }
};

/// A base, a slope or a wall; its centre is a point of its surface.
template <int D>
struct HalfSpace {
  static constexpr const char* kind = "half_space";
  static constexpr bool rough_by_default = false;
  Vec<D> normal = Vec<D>::Zero();  ///< into the soil

  static HalfSpace read(Keys& keys) { return {vector_of<D>(keys.vector("normal", D, {}))}; }
  void settle(const Keys& keys) {
    if (normal.isZero(0)) keys.wrong("normal", "is zero; give the direction from the surface into the soil");
    normal = (normal / normal.cwiseAbs().maxCoeff()).normalized();  // squares of very small entries vanish
  }
  double distance(const Vec<D>& r, Vec<D>& outward, const Vec<D>&) const {
    outward = normal;
    return r.dot(normal);
  }
  bool spans(const Vec<D>&, const Vec<D>&) const { return true; }
  unsigned char face_of(const Vec<D>&) const { return 1; }
  /// The axis that brings columns closest together.
  int axis(const Grid<D>& grid) const {
    int found = 0;
    normal.cwiseProduct(grid.cell).cwiseAbs().maxCoeff(&found);
    return found;
  }
  int column_axis() const {
    if (normal.cwiseAbs().maxCoeff() != normal.cwiseAbs().sum()) return -1;
    int found = 0;
    normal.cwiseAbs().maxCoeff(&found);
    return found;
  }
  /// Where columns of nodes come through the surface.
  template <class Visit>
  void each_surface_point(const Grid<D>& grid, const Vec<D>& centre, const Visit& visit) const {
    const int along = axis(grid);
    long columns = 1;
    for (int i = 0; i < D; ++i) columns *= i == along ? 1 : grid.count[i];
    for (long column = 0; column < columns; ++column) {
      auto node = grid.low;
      long rest = column;
      for (int i = 0; i < D; ++i) {
        if (i == along) continue;
        node[i] += int(rest % grid.count[i]);
        rest /= grid.count[i];
      }
      Vec<D> at = grid.position(node);
      at[along] = centre[along];
      for (int i = 0; i < D; ++i) {
        if (i != along) at[along] -= normal[i] * (at[i] - centre[i]) / normal[along];
      }
      visit(at, normal);
    }
  }
};

template <int D>
using BodyShape = std::variant<Box<D>, Disc<D>, HalfSpace<D>, Terrain<D>>;

/// The kinds of shapes in a scene.
template <class... Shapes>
std::vector<std::string> kinds_of(const std::variant<Shapes...>&) {
  return {Shapes::kind...};
}
/// The shape of that kind.
template <class... Shapes>
void read_shape(std::variant<Shapes...>& shape, const std::string& kind, Keys& keys) {
  ((kind == Shapes::kind && (shape = Shapes::read(keys), true)) || ...);
}

}  // namespace mpm
