// The mixed target of an increment: A : dE + B : d sigma = c, row by row.
#include <Eigen/LU>

#include "rvelab/measure/tensor_order.hpp"
#include "rvelab/protocol/drive.hpp"
#include "tests/catch.hpp"

using namespace rvelab;
using namespace rvelab::protocol;

namespace {

double doubled(const Matrix3& a, const Matrix3& b) { return a.cwiseProduct(b).sum(); }

/// What a row says of an increment: zero where it is met.
double residual(const MixedTarget::Row& row, const Matrix3& strain, const Matrix3& stress_change) {
  return doubled(row.strain, strain) + doubled(row.stress, stress_change) - row.value;
}

}  // namespace

TEST_CASE("An increment that does what was asked leaves no row open, and any other leaves one") {
  for (const int dimension : {2, 3}) {
    Matrix3 gradient = Matrix3::Zero(), stress = Matrix3::Zero();
    gradient(1, 1) = -5e-4;
    gradient(0, 1) = 2e-4;  // shear with spin
    stress.diagonal() = Vector3(-21e3, -50e3, dimension == 2 ? 0 : -19e3);
    stress(0, 1) = 800;
    stress(1, 0) = 600;
    std::vector<HeldStress> held{{0, 0, -20e3, 20e3}};
    if (dimension == 3) held.push_back({2, 2, -20e3, 20e3});
    const MixedTarget target = mixed_target(gradient, held, stress, dimension, false);
    REQUIRE(target.rows.size() == (dimension == 2 ? 3 : 6));

    // What the specimen does: lateral strains as it likes, lateral stresses to the target, the rest as prescribed.
    Matrix3 done = gradient, after = stress;
    done(0, 0) = 3e-4;
    after(0, 0) = -20e3;
    after(1, 1) = -53e3;
    after(0, 1) = 900;
    after(1, 0) = 950;
    if (dimension == 3) {
      done(2, 2) = 1e-4;
      after(2, 2) = -20e3;
    }
    const auto strain_of = [](const Matrix3& h) -> Matrix3 { return 0.5 * (h + h.transpose()); };
    for (const auto& row : target.rows)
      CHECK(residual(row, strain_of(done), after - stress) == Approx(0).margin(1e-11));
    CHECK((target.spin - 0.5 * (gradient - gradient.transpose())).norm() == 0);

    // Independent rows: missing any one component shows.
    for (int k = 0; k < component_count(dimension); ++k) {
      const auto [i, j] = component_axes(k, dimension);
      Matrix3 other = done, missed = after;
      const bool is_held = i == j && i != 1;
      if (is_held) {
        missed(i, j) += 100;
      } else {
        other(i, j) += 1e-5;
      }
      double open = 0;
      for (const auto& row : target.rows) open += std::abs(residual(row, strain_of(other), missed - stress));
      CHECK(open > (is_held ? 50 : 1e-6));
    }
    for (const auto& row : target.rows) CHECK((row.stress.isZero(0) || row.scale == 20e3));
  }
}

TEST_CASE("A held stress is driven from where it is, so that misses do not add up") {
  Matrix3 stress = Matrix3::Zero();
  stress(0, 0) = -20.1e3;
  const MixedTarget target = mixed_target(Matrix3::Zero(), {{0, 0, -20e3, 20e3}}, stress, 2, false);
  CHECK(target.rows[0].value == Approx(100));
  CHECK(target.rows[0].strain.isZero(0));
}
