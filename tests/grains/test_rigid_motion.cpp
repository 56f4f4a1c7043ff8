// The free asymmetric top against Jacobi's elliptic functions (tests/data/grains/top.csv; Landau and Lifshitz,
// Mechanics, 37).
#include <cmath>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "rvelab/grains/rigid_motion.hpp"
#include "tests/catch.hpp"

using namespace rvelab;
using Eigen::Vector3d;

namespace {

struct TopRow {
  Vector3d moments, start, spin;
  double period, time;
};

std::vector<TopRow> rows_of_tops() {
  std::ifstream file(RVELAB_TEST_DATA "/grains/top.csv");
  std::string line;
  std::getline(file, line);
  std::vector<TopRow> rows;
  while (std::getline(file, line)) {
    for (char& c : line) c = c == ',' ? ' ' : c;
    std::istringstream in(line);
    TopRow r;
    in >> r.moments[0] >> r.moments[1] >> r.moments[2] >> r.start[0] >> r.start[1] >> r.start[2] >> r.period >>
        r.time >> r.spin[0] >> r.spin[1] >> r.spin[2];
    rows.push_back(r);
  }
  return rows;
}

/// Distance of the spin from the table's after `steps_per_period` steps a period.
double error_of(const TopRow& row, double steps_per_period) {
  Vector3d momentum = row.moments.cwiseProduct(row.start);
  Turn q;
  const long steps = std::lround(std::ceil(row.time / row.period * steps_per_period - 1e-9));
  for (long k = 0; k < steps; ++k) rotate_freely(row.time / double(steps), row.moments, momentum, q);
  return (momentum.cwiseQuotient(row.moments) - row.spin).norm() / row.start.norm();
}

}  // namespace

TEST_CASE("A free asymmetric top spins as Jacobi's functions say, with errors of second order") {
  const std::vector<TopRow> rows = rows_of_tops();
  REQUIRE(rows.size() == 18);
  for (const TopRow& row : rows) {
    const double coarse = error_of(row, 100), fine = error_of(row, 200);
    CAPTURE(row.moments.transpose(), row.time / row.period, coarse, fine);
    CHECK(coarse < 3e-3 * std::max(1.0, row.time / row.period));
    CHECK((fine < 1e-12 || std::abs(coarse / fine - 4) < 0.1));
    // Two second-order answers give one of fourth order (Richardson).
    CHECK(error_of(row, 4000) < 2e-6 * std::max(1.0, row.time / row.period));
  }
}

TEST_CASE("A free top keeps its energy and its momentum in space over 1e6 steps of a hundredth of its period") {
  std::vector<TopRow> rows = rows_of_tops();
  for (std::size_t k = 0; k < rows.size(); k += 6) {
    const TopRow& row = rows[k];
    const Vector3d start = row.moments.cwiseProduct(row.start);
    const double energy = start.dot(row.start);
    Vector3d momentum = start;
    Turn q;
    double largest = 0;
    for (long step = 0; step < 1'000'000; ++step) {
      rotate_freely(row.period / 100, row.moments, momentum, q);
      if (step % 100 == 0)
        largest = std::max(largest, std::abs(momentum.dot(momentum.cwiseQuotient(row.moments)) / energy - 1));
    }
    CAPTURE(row.moments.transpose(), largest);
    CHECK(largest < 1e-9);  // 1e-12 as measured
    CHECK((axes_of(q) * momentum - start).norm() < 1e-9 * start.norm());
  }
}

TEST_CASE("Turns: products, vectors, axes") {
  const Turn a = cayley_turn({0.3, -0.2, 0.5}), b = cayley_turn({-0.1, 0.7, 0.2});
  CHECK((axes_of(after(a, b)) - axes_of(a) * axes_of(b)).norm() < 1e-15);
  CHECK((axes_of(after(a, inverse(a))) - Eigen::Matrix3d::Identity()).norm() < 1e-15);
  CHECK((cayley_vector(a) - Vector3d(0.3, -0.2, 0.5)).norm() < 1e-15);
  const Vector3d arm(0.4, 1.1, -0.6), turned = axes_of(a) * arm;
  CHECK((turned - arm - Vector3d(0.3, -0.2, 0.5).cross(0.5 * (turned + arm))).norm() < 1e-15);
  CHECK((axes_of(turn_of(axes_of(a))) - axes_of(a)).norm() < 1e-15);
}
