// The affine stiffness, the servo's gain, contact by contact from its definition: the branch changes by eps b.
#include <random>

#include "rvelab/solver/assembly/affine_stiffness.hpp"
#include "rvelab/solver/rve.hpp"
#include "tests/solver/laws.hpp"

using namespace rvelab;
using namespace rvelab::test;

namespace {

/// d sigma of every contact stuck to the affine motion, laboratory frame: (1/V) sum f(du) (x) b, symmetric part.
Matrix3 affine_stress(const Network& net, const Matrix3& strain) {
  const Matrix3& q = net.cell.rotation;
  Matrix3 sum = Matrix3::Zero();
  for (const ContactState& c : net.contacts) {
    const Vector3 b = q * c.branch, n = q * c.normal, change = strain * b;
    const Vector3 along = n.dot(change) * n;
    const Vector3 force = c.normal_stiffness * along + c.tangential_stiffness * (change - along);
    sum += force * b.transpose() / net.cell.volume();
  }
  return 0.5 * (sum + sum.transpose());
}

}  // namespace

TEST_CASE("The affine stiffness is the sum over contacts that move with the strain", "[solver]") {
  std::mt19937_64 generator(1);
  std::normal_distribution<double> normal;
  for (const Specimen& start : disordered_of_each_law()) {
    const int d = start.cell.dimension;
    Rve rve(start);
    // A turned frame: spin moves it, the answer is asked for in the laboratory's.
    Matrix3 strained = Matrix3::Identity() + gradient(-5e-3, 4e-3, 0, -5e-3);
    if (d == 3) strained(0, 2) = 3e-3;
    const Matrix3 turn = rotation_about_z(0.3) * strained - Matrix3::Identity();
    rve.apply(turn, 0);
    Model model;
    Assembly assembly;
    open_assembly(rve.specimen(), model, assembly);
    const Matrix6 stiffness = affine_stiffness(model, assembly);
    const Network net = rve.network();
    REQUIRE(net.contacts.size() > 50);
    for (int k = 0; k < 5; ++k) {
      Matrix3 strain = Matrix3::Zero();
      for (int r = 0; r < d; ++r)
        for (int c = r; c < d; ++c) strain(r, c) = strain(c, r) = normal(generator);
      const Matrix3 expected = affine_stress(net, strain);
      const Vector6 found = stiffness * strain_components(strain);
      const double scale = largest(expected);
      const Vector6 wanted{expected(0, 0), expected(1, 1), expected(2, 2),
                           expected(1, 2), expected(0, 2), expected(0, 1)};
      CHECK((found - wanted).cwiseAbs().maxCoeff() <= 1e-12 * scale);
    }
  }
}
