// Shapes of rigid rocks in the plane (D = 2) and in space (D = 3), and the gap of two of them. A shape is seen from its
// own frame: the origin is the centre of mass, the axes are the principal axes of inertia. Lengths are in m.
//
// Gap of two rocks: the largest, over all unit vectors n from a to b, of n.(x_b - x_a) - h_a(n) - h_b(-n), where h(n)
// is the height of a shape, max x.n over its points x. Apart it is their distance; where they overlap it is minus the
// shortest way that parts them. A force along n whose size is a function of the gap has an energy: by the envelope
// theorem the gap changes with x_b by n.
//
// Superquadrics are those of rvelab/superellipsoid: gaps have the same bits on every machine; volumes, inertia and the
// ball that rolls inside take powers of libm, which another one need not share.
#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <memory>
#include <type_traits>
#include <variant>

#include "rvelab/grains/mesh.hpp"
#include "tools/mpm/tensors.hpp"

namespace mpm {

/// A spin, or what belongs to each axis of rotation: one number in the plane, a vector in space.
template <int D>
using Spin = std::conditional_t<D == 2, Eigen::Matrix<double, 1, 1>, Vec<D>>;
/// The orientation of a body: rad, anticlockwise, in the plane; from its frame into the world's in space.
template <int D>
using Rot = std::conditional_t<D == 2, double, Eigen::Quaterniond>;
using rvelab::Triangle;

template <int D>
struct Superquadric;  // superquadric.hpp
struct Polyhedron;    // polyhedron.hpp

template <int D>
class RockShape {
 public:
  /// InputError: the radius is not positive. D = 2: a disc.
  static RockShape sphere(double radius);
  /// D = 3: (|x/a|^n2 + |y/b|^n2)^(n1/n2) + |z/c|^n1 = 1, Li et al. 2023 eq 39; D = 2: |x/a|^n1 + |y/b|^n1 = 1, n2 is
  /// ignored. InputError: a half axis is not positive, or an exponent is outside [2, 50].
  static RockShape superquadric(const Vec<D>& half_axes, double n1, double n2);
  /// A convex polyhedron from triangles that close its surface; where they face inward all are turned round. Gives back
  /// the place of its centre of mass and the orientation of its principal axes in the frame of the triangles.
  /// InputError says what is wrong, and what to do: fewer than 4 faces, a number that is none, an open surface, a dent
  /// of more than 1e-6 of its size.
  static RockShape polyhedron(const std::vector<Triangle>& triangles, Vec<3>* centre,
                              Eigen::Quaterniond* orientation) requires(D == 3);

  bool is_sphere() const { return form_.index() == 0; }
  double volume() const { return volume_; }  ///< m^3; D = 2: area, m^2
  /// Moments of inertia about the axes for a density of 1, m^5; D = 2: about the centre, m^4.
  const Spin<D>& inertia() const { return inertia_; }
  double bounding_radius() const { return bounding_radius_; }  ///< of the ball about the centre that holds it
  double inner_radius() const { return inner_radius_; }        ///< of the largest ball about the centre inside it
  double equivalent_radius() const;                            ///< of the sphere (disc) of the same volume
  /// max x.n over its points x; n is a unit vector.
  double height(const Vec<D>& direction) const;
  /// The point where it is reached; of several the first corner of a polyhedron.
  Vec<D> support(const Vec<D>& direction) const;
  /// From the surface, negative inside, and the outward unit normal at the foot; where several points of the surface
  /// are nearest, the same one each time.
  double distance(const Vec<D>& r, Vec<D>& outward) const;
  /// visit(place, outward normal, area) for points of the surface about `spacing` apart, in an order that is always the
  /// same. D = 2: the area is a length.
  void each_surface_point(
      double spacing, const std::function<void(const Vec<D>& place, const Vec<D>& normal, double area)>& visit) const;

  /// The radius of a sphere, or one of the other two forms, which are shared by copies.
  using Form = std::variant<double, std::shared_ptr<const Superquadric<D>>, std::shared_ptr<const Polyhedron>>;
  const Form& form() const { return form_; }

 private:
  RockShape() = default;
  Form form_;
  double volume_ = 0, bounding_radius_ = 0, inner_radius_ = 0;
  Spin<D> inertia_ = Spin<D>::Zero();
};

/// A shape at its place in the world.
template <int D>
struct Placed {
  const RockShape<D>* shape;
  Vec<D> centre;
  Rot<D> orientation;
};

/// From the frame of a body into the world's, as a matrix.
inline Mat<2> matrix_of(double angle) {
  return (Mat<2>() << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle)).finished();
}
inline Mat<3> matrix_of(const Eigen::Quaterniond& orientation) { return orientation.toRotationMatrix(); }
/// Vectors; of a place subtract or add the centre.
template <int D>
Vec<D> to_world(const Rot<D>& orientation, const Vec<D>& in_body) {
  return matrix_of(orientation) * in_body;
}
template <int D>
Vec<D> to_body(const Rot<D>& orientation, const Vec<D>& in_world) {
  return matrix_of(orientation).transpose() * in_world;
}

template <int D>
struct Gap {
  double gap;     ///< m, negative: overlap
  Vec<D> normal;  ///< unit, from a to b
  Vec<D> place;   ///< the middle between the surfaces
};

/// The gap of two rocks depends on nothing but their shapes and places. gap_between(b, a) has the same bits, the normal
/// turned round. It is the largest value; of superquadrics
/// deeper in each other than their least radii of curvature the largest to 1e-10 of their sizes. Two polyhedra cost as
/// the product of their edges where they are apart.
template <int D>
Gap<D> gap_between(const Placed<D>& a, const Placed<D>& b);

}  // namespace mpm
