// Loading probes of spheres: against a crystal whose stiffness is known, against the elastic tangent of a packing, and
// turned with the specimen.
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <string>
#include <vector>

#include "rvelab/measure/acoustic.hpp"
#include "rvelab/measure/probe.hpp"
#include "rvelab/measure/tangent.hpp"
#include "rvelab/measure/tensor_order.hpp"
#include "tests/catch.hpp"
#include "tests/measure/crystals.hpp"
#include "tests/measure/turned.hpp"
#include "tests/reference_specimen.hpp"

using namespace rvelab;
using namespace rvelab::test;

namespace {

/// Turns the cell of a face-centred crystal so that its cube axes lie along those of the laboratory.
Matrix3 cube_along_axes(const Matrix3& lattice) {
  Matrix3 cubic;
  cubic << 1, 0, 1, 1, 1, 0, 0, 1, 1;
  return std::sqrt(0.5) * cubic * (lattice / lattice(0, 0)).inverse();
}

/// 27 spheres of diameter 1 m, overlaps of `overlap` m, contacts f = kn delta that do not slip.
Specimen crystal(double overlap, double kn, double kt) {
  const Network network = face_centred(1, 1 - overlap, 3, {kn, kt, 0});
  Specimen specimen;
  specimen.shape = Shape::sphere;
  specimen.cell = network.cell;
  specimen.cell.rotation = cube_along_axes(network.cell.lattice);
  specimen.contact.law = Law::linear_stiffness;
  Material material;
  material.normal_stiffness = kn, material.tangential_stiffness = kt, material.friction = 1e6;
  specimen.materials = {material};
  for (const GrainState& grain : network.grains) {
    specimen.grains.id.push_back(std::int64_t(specimen.grains.id.size()));
    specimen.grains.radius.push_back(grain.radius);
    specimen.grains.material.push_back(0);
    specimen.grains.position.push_back(grain.position);
    specimen.grains.velocity.push_back(Vector3::Zero());
    specimen.grains.spin.push_back(Vector3::Zero());
  }
  return specimen;
}

double determinant(const Eigen::MatrixXd& stiffness, const Vector3& normal) {
  return acoustic_tensor(stiffness, normal.normalized()).determinant();
}

const Matrix3 other_frame = Eigen::AngleAxisd(0.8, Vector3(1, -2, 0.5).normalized()).toRotationMatrix();
const Matrix3 compression = Vector3(0.3, 0.3, -1).asDiagonal();

}  // namespace

TEST_CASE("loading probes of a face-centred crystal give its cubic constants and its weakest bands", "[measure]") {
  // C11 = sqrt2 (kn + kt), C12 = (kn - kt)/sqrt2, C44 = (kn + kt)/sqrt2 over the diameter at no pressure. Spacing
  // and pressure, kn overlap sqrt2 over the diameter squared, change each by less than three times the overlap.
  const double kn = 2e6, kt = 1.5e6, overlap = 1e-3, accuracy = 3 * overlap, root = std::sqrt(2.0);
  const double c11 = root * (kn + kt), c12 = (kn - kt) / root, c44 = (kn + kt) / root;
  const Rve rve(crystal(overlap, kn, kt));
  for (const Matrix3& direction : {compression, unit_strain(3, 3)}) {
    CAPTURE(direction);
    const Eigen::MatrixXd c = loading_stiffness(rve, direction, 1e-5);
    // All bonds stretch by at most 1e-5, a hundredth of their overlap: none opens, the law is linear, only angles
    // change.
    CHECK(relative_distance(c, elastic_tangent(rve.network())) < 1e-4);
    for (int i = 0; i < 3; ++i) {
      CHECK(c(i, i) == Approx(c11).epsilon(accuracy));
      CHECK(c(i, (i + 1) % 3) == Approx(c12).margin(accuracy * c11));
      CHECK(c(3 + i, 3 + i) == Approx(c44).epsilon(accuracy));
    }
    // Waves along <100>, <110> and <111> of a cubic solid.
    const double shear = 0.5 * (c11 - c12), third = (c11 - c12 + c44) / 3;
    CHECK(determinant(c, {0, 1, 0}) == Approx(c11 * c44 * c44).epsilon(3 * accuracy));
    CHECK(determinant(c, {1, 0, -1}) == Approx(c44 * shear * (0.5 * (c11 + c12) + c44)).epsilon(3 * accuracy));
    CHECK(determinant(c, {1, 1, 1}) == Approx(third * third * (c11 + 2 * c12 + 4 * c44) / 3).epsilon(3 * accuracy));
  }
}

TEST_CASE("loading probes of spheres that do not slip: the elastic tangent, its weakest band, and both turned",
          "[measure][slow]") {
  // Hertz contacts stiffen by half of the change of their overlap, of which a probe of 1e-5 is a hundredth.
  Specimen specimen = reference_specimen("hertz", {"solver.relative_tolerance=1e-4", "solver.absolute_tolerance=1e-8"});
  Rve rve(specimen);
  forbid_slip(rve);
  const Eigen::MatrixXd elastic = elastic_tangent(rve.network());
  const Band stuck = weakest_band(elastic);
  CHECK(stuck.determinant > 0);
  const Eigen::MatrixXd loading = loading_stiffness(rve, compression, 1e-5);
  CHECK(relative_distance(loading, elastic) < 0.01);
  const Band band = weakest_band(loading);
  CHECK(band.determinant == Approx(stuck.determinant).epsilon(0.03));  // det: of the third power

  specimen.cell.rotation = other_frame;
  Rve turned(specimen);
  forbid_slip(turned);
  const Matrix3 direction = other_frame * compression * other_frame.transpose();
  const Eigen::MatrixXd there = loading_stiffness(turned, direction, 1e-5);
  CHECK(relative_distance(there, turned_stiffness(loading, other_frame)) < 1e-3);
  CHECK(weakest_band(there).determinant == Approx(band.determinant).epsilon(3e-3));
}

TEST_CASE("spheres that slide: the probe gives what loading gives, in a turned frame too, and less than unloading",
          "[measure][slow]") {
  Rve rve(reference_specimen("hertz"));
  for (int k = 0; k < 6; ++k) rve.apply(1e-3 * compression, 0);
  const double size = 2e-4;
  const Matrix3 half = 0.5 * size * compression / compression.norm();
  Rve copy(rve);
  copy.apply(half, 0);
  const Eigen::VectorXd middle = stress_components(copy.stress(), 3);
  copy.apply(half, 0);
  const Eigen::VectorXd change = stress_components(copy.stress(), 3) - middle, strain = strain_components(half, 3);
  const Eigen::MatrixXd loading = loading_stiffness(rve, compression, size);
  CHECK((loading * strain - change).norm() < 1e-12 * change.norm());

  const Eigen::MatrixXd elastic = elastic_tangent(rve.network());
  const double work = strain.dot(loading * strain);
  CHECK(work < 0.5 * strain.dot(elastic * strain));
  CHECK(work < 0.5 * strain.dot(loading_stiffness(rve, Matrix3(-compression), 2e-5) * strain));
  const Band band = weakest_band(loading), stuck = weakest_band(elastic);
  CHECK(stuck.determinant > 0);
  CHECK(band.determinant < 0.5 * stuck.determinant);

  // Beside the direction of loading, the probes of another frame take other strains, whose response is another.
  Specimen specimen = rve.specimen();
  specimen.cell.rotation = other_frame * specimen.cell.rotation;
  const Matrix3 direction = other_frame * compression * other_frame.transpose();
  const Eigen::VectorXd there = loading_stiffness(Rve(specimen), direction, size) * strain_components(direction, 3);
  const Eigen::VectorXd here = turned_stiffness(loading, other_frame) * strain_components(direction, 3);
  CHECK((there - here).norm() < 1e-6 * here.norm());
}
