// Anisotropies, the relation of stress, force and fabric, and the angle between the axes of two tensors.
#include "rvelab/measure/anisotropy.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <functional>

#include "rvelab/measure/deviator.hpp"
#include "rvelab/measure/measures.hpp"
#include "tests/catch.hpp"
#include "tests/measure/crystals.hpp"
#include "tests/specimens.hpp"

using namespace rvelab;
using namespace rvelab::test;

namespace {

/// x in [from, to] where a growing function is `value`, by bisection.
double where(const std::function<double(double)>& growing, double value, double from, double to) {
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (from + to);
    (growing(middle) < value ? from : to) = middle;
  }
  return 0.5 * (from + to);
}

/// Directions of the density E = (1 + a cos 2(theta - theta_a) + b cos 4 theta)/2pi, as many in each stretch of equal
/// probability.
std::vector<Vector3> directions_in_plane(int count, double a, double theta_a, double b) {
  std::vector<Vector3> all;
  const auto below = [&](double theta) {
    return (theta + 0.5 * a * (std::sin(2 * (theta - theta_a)) + std::sin(2 * theta_a)) +
            0.25 * b * std::sin(4 * theta)) /
           (2 * pi);
  };
  for (int k = 0; k < count; ++k) {
    const double theta = where(below, (k + 0.5) / count, 0, 2 * pi);
    all.emplace_back(std::cos(theta), std::sin(theta), 0);
  }
  return all;
}

/// Directions of E = (1 + a (z^2 - 1/3) + b P_4(z))/4pi: z at equal steps of probability, turned by the golden angle.
std::vector<Vector3> directions_in_space(int count, double a, double b) {
  std::vector<Vector3> all;
  const auto below = [&](double z) {
    const double z3 = z * z * z;
    return 0.5 * (z + 1 + a * (z3 - z) / 3 + b / 8 * (7 * z3 * z * z - 10 * z3 + 3 * z));
  };
  for (int k = 0; k < count; ++k) {
    const double z = where(below, (k + 0.5) / count, -1, 1), r = std::sqrt(1 - z * z);
    const double turn = k * pi * (3 - std::sqrt(5.0));
    all.emplace_back(r * std::cos(turn), r * std::sin(turn), z);
  }
  return all;
}

/// What the contacts of a network are to have.
struct Fields {
  Matrix3 a_n = Matrix3::Zero(), a_t = Matrix3::Zero(), a_l = Matrix3::Zero(), a_lt = Matrix3::Zero();
};

Vector3 vector_of(double mean, const Matrix3& along, const Matrix3& across, const Vector3& n) {
  return mean * ((1 + n.dot(along * n)) * n + across * n - n.dot(across * n) * n);
}

Network network_of(int dimension, const std::vector<Vector3>& normals, const Fields& fields) {
  Network network;
  network.shape = dimension == 2 ? Shape::disc : Shape::sphere;
  network.cell.dimension = dimension;
  network.grains.resize(1);
  for (const Vector3& n : normals) {
    ContactState contact;
    contact.normal = n;
    contact.branch = vector_of(0.02, fields.a_l, fields.a_lt, n);
    const Vector3 force = vector_of(30, fields.a_n, fields.a_t, n);
    contact.normal_force = n.dot(force);
    contact.tangential_force = force - contact.normal_force * n;
    network.contacts.push_back(contact);
  }
  return network;
}

/// Traceless, amplitude a, major axis at an angle to x (2D), along z (3D).
Matrix3 plane_tensor(double a, double angle) {
  Matrix3 tensor = Matrix3::Zero();
  tensor(0, 0) = a * std::cos(2 * angle);
  tensor(1, 1) = -tensor(0, 0);
  tensor(0, 1) = tensor(1, 0) = a * std::sin(2 * angle);
  return tensor;
}
Matrix3 axial_tensor(double a) { return a * Vector3(-1.0 / 3, -1.0 / 3, 2.0 / 3).asDiagonal().toDenseMatrix(); }

double off(const Matrix3& a, const Matrix3& b) { return (a - b).cwiseAbs().maxCoeff(); }

struct Errors {
  double integral, published;
};
/// Of q/p by the integral and by the published formula, where all amplitudes are `size` times those given here, axes
/// those of the stress.
Errors errors_of_relation(int dimension, double size) {
  const auto tensor = [&](double a) { return dimension == 2 ? plane_tensor(size * a, 0) : axial_tensor(size * a); };
  const auto normals =
      dimension == 2 ? directions_in_plane(4000, 0.5 * size, 0, 0) : directions_in_space(40000, 0.5 * size, 0);
  const StressForceFabric a =
      stress_force_fabric(network_of(dimension, normals, {tensor(0.8), tensor(0.3), tensor(0.2), tensor(0.1)}));
  // Rothenburg and Bathurst (1992); Guo and Zhao (2013).
  const double products = a.a_c * a.a_n + a.a_c * a.a_l + a.a_n * a.a_l + a.a_t * a.a_lt;
  const double published = dimension == 2 ? 0.5 * (a.a_c + a.a_n + a.a_t + a.a_l + a.a_lt) / (1 + 0.5 * products)
                                          : 0.4 * (a.a_c + a.a_n + a.a_l + 1.5 * (a.a_t + a.a_lt));
  return {std::abs(a.predicted - a.measured), std::abs(published - a.measured)};
}

}  // namespace

TEST_CASE("anisotropies in the plane are those that the contacts were given, each with axes of its own", "[measure]") {
  const Fields fields{plane_tensor(0.5, 0.2), plane_tensor(0.15, -0.1), plane_tensor(0.1, 0.6), plane_tensor(0.05, 1)};
  const Anisotropies a = anisotropies(network_of(2, directions_in_plane(4000, 0.3, 0.4, 0.1), fields));
  CHECK(off(a.normals, plane_tensor(0.3, 0.4)) < 1e-5);
  CHECK(a.fourth_order == Approx(0.1).epsilon(1e-4));
  CHECK(off(a.normal_forces, fields.a_n) < 1e-12);
  CHECK(off(a.tangential_forces, fields.a_t) < 1e-12);
  CHECK(off(a.branches, fields.a_l) < 1e-12);
  CHECK(off(a.tangential_branches, fields.a_lt) < 1e-12);
  CHECK(a.mean_normal_force == Approx(30));
  CHECK(a.mean_branch == Approx(0.02));
}

TEST_CASE("anisotropies in space are those that the contacts were given", "[measure]") {
  Fields fields{axial_tensor(0.6), axial_tensor(0.2), axial_tensor(-0.1), axial_tensor(0.07)};
  fields.a_n(0, 1) = fields.a_n(1, 0) = 0.3;
  fields.a_t(0, 2) = fields.a_t(2, 0) = -0.2;
  const Anisotropies a = anisotropies(network_of(3, directions_in_space(40000, 0.4, 0.2), fields));
  CHECK(off(a.normals, axial_tensor(0.4)) < 1e-3);
  CHECK(a.fourth_order == Approx(0.2).epsilon(0.01));
  CHECK(off(a.normal_forces, fields.a_n) < 1e-12);
  CHECK(off(a.tangential_forces, fields.a_t) < 1e-12);
  CHECK(off(a.branches, fields.a_l) < 1e-12);
  CHECK(off(a.tangential_branches, fields.a_lt) < 1e-12);
}

TEST_CASE("q/p of distributions is that of their contacts; of small ones the published formulas are near",
          "[measure]") {
  CHECK(errors_of_relation(2, 1).integral < 1e-5);
  CHECK(errors_of_relation(3, 1).integral < 1e-3);
  // Right to the third order in the plane, to the second in space.
  CHECK(errors_of_relation(2, 0.4).published < 0.01);
  CHECK(errors_of_relation(2, 0.4).published / errors_of_relation(2, 0.2).published == Approx(8).epsilon(0.1));
  CHECK(errors_of_relation(3, 0.4).published < 0.03);
  CHECK(errors_of_relation(3, 0.4).published / errors_of_relation(3, 0.2).published == Approx(4).epsilon(0.2));
}

TEST_CASE("q/p of strong anisotropies on axes of their own, with a fourth order of the normals", "[measure]") {
  const Fields fields{plane_tensor(0.5, 0.3), plane_tensor(0.3, -0.4), plane_tensor(0.4, 0.9), plane_tensor(0.3, 1.2)};
  const StressForceFabric plane = stress_force_fabric(network_of(2, directions_in_plane(4000, 0.7, 1.1, 0.25), fields));
  CHECK(plane.predicted == Approx(plane.measured).margin(1e-5));
  Fields space{axial_tensor(0.6), axial_tensor(0.2), axial_tensor(-0.3), axial_tensor(0.2)};
  space.a_n(0, 1) = space.a_n(1, 0) = 0.3;
  space.a_l(1, 2) = space.a_l(2, 1) = -0.2;
  space.a_t(0, 2) = space.a_t(2, 0) = -0.2;
  const StressForceFabric in_space = stress_force_fabric(network_of(3, directions_in_space(40000, 0.8, 0.3), space));
  CHECK(in_space.predicted == Approx(in_space.measured).margin(1e-3));
}

TEST_CASE("each amplitude alone gives q/p by its coefficient", "[measure]") {
  // Spheres with forces alone: 2/5 a_n and 3/5 a_t (Chantawarangul 1993); discs: half of each.
  const auto isotropic_plane = directions_in_plane(360, 0, 0, 0), isotropic_space = directions_in_space(40000, 0, 0);
  Fields normal, tangential;
  normal.a_n = plane_tensor(0.4, 0.3);
  tangential.a_t = plane_tensor(0.4, 0.3);
  CHECK(stress_force_fabric(network_of(2, isotropic_plane, normal)).measured == Approx(0.2));
  CHECK(stress_force_fabric(network_of(2, isotropic_plane, normal)).predicted == Approx(0.2));
  CHECK(stress_force_fabric(network_of(2, isotropic_plane, tangential)).measured == Approx(0.2));
  normal.a_n = axial_tensor(0.4);
  tangential.a_t = axial_tensor(0.4);
  CHECK(stress_force_fabric(network_of(3, isotropic_space, normal)).measured == Approx(0.16).epsilon(1e-3));
  CHECK(stress_force_fabric(network_of(3, isotropic_space, tangential)).measured == Approx(0.24).epsilon(1e-3));
  CHECK(stress_force_fabric(network_of(3, isotropic_space, tangential)).predicted == Approx(0.24).epsilon(1e-3));
}

TEST_CASE("an amplitude across the stress adds nothing to q, one against it takes away", "[measure]") {
  Fields fields;
  fields.a_n = plane_tensor(0.4, 0);
  fields.a_l = plane_tensor(0.1, 0.5 * pi);  // axes exchanged
  const StressForceFabric found =
      stress_force_fabric(network_of(2, directions_in_plane(2000, 0.2, 0.25 * pi, 0), fields));
  CHECK(found.a_l < -0.08);
  CHECK(found.a_n > 0.3);
  CHECK(found.measured == Approx(found.predicted).margin(1e-5));
}

TEST_CASE("a crystal has no anisotropy of the second order, a square one a fourth order of 2", "[measure]") {
  for (const Network& network : {triangular(1, 0.99, 2, {1e6, 0, 0}), square(1, 0.99, 2, {1e6, 0, 0})}) {
    const Anisotropies a = anisotropies(network);
    CHECK(off(a.normals, Matrix3::Zero()) < 1e-14);
    CHECK(off(a.normal_forces, Matrix3::Zero()) < 1e-12);
    CHECK(a.mean_normal_force == Approx(1e4));
    CHECK(std::abs(stress_force_fabric(network).predicted) < 1e-10);
  }
  CHECK(anisotropies(square(1, 0.99, 2, {1e6, 0, 0})).fourth_order == Approx(2));  // cos 4 theta = 1 at each
  CHECK(anisotropies(triangular(1, 0.99, 2, {1e6, 0, 0})).fourth_order == Approx(0).margin(1e-7));
  CHECK(std::isnan(stress_force_fabric(Network{}).predicted));
  CHECK(std::isnan(anisotropies(Network{}).normals(0, 0)));
}

TEST_CASE("a turned frame turns anisotropies and leaves the relation", "[measure]") {
  Network network = yade_network("hertz");
  const Anisotropies before = anisotropies(network);
  const StressForceFabric relation = stress_force_fabric(network);
  const Matrix3 turn = Eigen::AngleAxisd(0.7, Vector3(1, 2, 3).normalized()).toRotationMatrix();
  network.cell.rotation = turn;
  const Anisotropies after = anisotropies(network);
  CHECK(off(after.normals, turn * before.normals * turn.transpose()) < 1e-13);
  CHECK(off(after.normal_forces, turn * before.normal_forces * turn.transpose()) < 1e-13);
  CHECK(off(after.tangential_forces, turn * before.tangential_forces * turn.transpose()) < 1e-13);
  CHECK(after.fourth_order == Approx(before.fourth_order).epsilon(1e-12));
  CHECK(stress_force_fabric(network).predicted == Approx(relation.predicted).epsilon(1e-9));
  CHECK(stress_force_fabric(network).a_t == Approx(relation.a_t).epsilon(1e-9));
}

TEST_CASE("the angle between the axes of two tensors is the one that they were turned by", "[measure]") {
  for (const double angle : {1e-6, 0.3, 1.2}) {
    const Matrix3 one = plane_tensor(2, 0.4) + 5 * identity_in(2), other = plane_tensor(0.1, 0.4 + angle);
    CHECK(axes_angle_deg(one, other, 2) == Approx(angle * 180 / pi).epsilon(1e-8));
    const Matrix3 turn = Eigen::AngleAxisd(angle, Vector3(0, 1, 0)).toRotationMatrix();
    const Matrix3 space = Vector3(1, 2, 4).asDiagonal();
    CHECK(axes_angle_deg(space, turn * space * turn.transpose(), 3) == Approx(angle * 180 / pi).epsilon(1e-8));
  }
  CHECK(axes_angle_deg(plane_tensor(1, 0), plane_tensor(1, 2), 2) == Approx((pi - 2) * 180 / pi));  // acute
  CHECK(std::isnan(axes_angle_deg(identity_in(2), plane_tensor(1, 0), 2)));
  CHECK(std::isnan(axes_angle_deg(axial_tensor(-1), axial_tensor(1), 3)));  // two equal largest
}
