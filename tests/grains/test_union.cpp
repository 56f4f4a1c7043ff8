// Unions of discs and spheres against exact sections by another program (tests/data/grains/clump.csv) and closed forms.
#include <cmath>
#include <fstream>
#include <sstream>
#include <string>

#include <Eigen/Geometry>

#include "rvelab/grains/union.hpp"
#include "tests/catch.hpp"

using namespace rvelab;

namespace {

constexpr double pi_of_union = 3.14159265358979323846;

struct UnionRow {
  std::string name;
  std::vector<Ball> spheres;
  double volume;
  Eigen::Vector3d centre;
  Eigen::Matrix3d inertia;
};

std::vector<UnionRow> rows_of_unions() {
  std::ifstream file(RVELAB_TEST_DATA "/grains/clump.csv");
  std::string line;
  std::getline(file, line);
  std::vector<UnionRow> rows;
  while (std::getline(file, line)) {
    UnionRow row;
    const auto open = line.find('"'), close = line.rfind('"');
    row.name = line.substr(0, open - 1);
    std::string spheres = line.substr(open + 1, close - open - 1), numbers = line.substr(close + 2);
    for (char& c : spheres) c = c == ';' ? ' ' : c;
    for (char& c : numbers) c = c == ',' ? ' ' : c;
    std::istringstream of_spheres(spheres), of_numbers(numbers);
    for (Ball ball; of_spheres >> ball.at[0] >> ball.at[1] >> ball.at[2] >> ball.radius;) row.spheres.push_back(ball);
    double v[10];
    for (double& value : v) of_numbers >> value;
    row.volume = v[0];
    row.centre = {v[1], v[2], v[3]};
    row.inertia << v[4], v[7], v[8], v[7], v[5], v[9], v[8], v[9], v[6];
    rows.push_back(row);
  }
  return rows;
}

}  // namespace

TEST_CASE("Volume, centre and inertia of a union of spheres are those of exact sections") {
  const std::vector<UnionRow> rows = rows_of_unions();
  REQUIRE(rows.size() == 8);
  for (const UnionRow& row : rows) {
    const MassProperties p = union_of_spheres(row.spheres);
    CAPTURE(row.name, p.volume, p.centre.transpose(), p.inertia);
    const double size = std::cbrt(row.volume);
    CHECK(std::abs(p.volume - row.volume) < 2e-11 * row.volume);
    CHECK((p.centre - row.centre).norm() < 2e-11 * size);
    CHECK((p.inertia - row.inertia).norm() < 5e-11 * row.inertia.norm());
  }
}

TEST_CASE("A union of spheres does not know how it is turned") {
  std::vector<Ball> spheres{{{0, 0, 0}, 1}, {{1.1, 0, 0}, 0.9}, {{0.5, 0.9, 0.1}, 0.8}, {{0.2, 0.3, 0.9}, 0.6}};
  const MassProperties before = union_of_spheres(spheres);
  Eigen::Matrix3d turn;
  turn = Eigen::AngleAxisd(0.83, Eigen::Vector3d(0.3, -0.8, 0.5).normalized());
  for (Ball& ball : spheres) ball.at = turn * ball.at + Eigen::Vector3d(0.4, -1.3, 2.2);
  const MassProperties after = union_of_spheres(spheres);
  CHECK(std::abs(after.volume - before.volume) < 1e-10 * before.volume);
  CHECK((after.inertia - turn * before.inertia * turn.transpose()).norm() < 1e-10 * before.inertia.norm());
}

TEST_CASE("Two equal discs: the lens of their overlap counts once") {
  for (const double apart : {0.01, 0.5, 1.0, 1.7, 1.999, 2.5}) {
    const MassProperties p = union_of_discs({{{0, 0, 0}, 1}, {{apart, 0, 0}, 1}});
    const double half = std::min(1.0, 0.5 * apart), angle = std::acos(half), root = std::sqrt(1 - half * half);
    const double area = 2 * pi_of_union - 2 * (angle - half * root);
    // Of one disc, about its centre, beyond the line at `half`: x^2 and y^2 of the segment.
    const double x2 = 0.25 * angle + 0.25 * half * root * (1 - 2 * half * half),
                 y2 = 0.25 * angle - half * root / 12 * (5 - 2 * half * half);
    const double segment = angle - half * root, first = 2.0 / 3 * root * root * root;
    // About the middle: each disc less its segment.
    const double one = 0.5 * pi_of_union - x2 - y2 + 0.25 * apart * apart * (pi_of_union - segment) + apart * first;
    CAPTURE(apart);
    CHECK(std::abs(p.volume - area) < 1e-13 * area);
    CHECK(std::abs(p.centre.x() - 0.5 * apart) < 1e-13);
    CHECK(std::abs(p.inertia(2, 2) - 2 * one) < 1e-12 * one);
  }
}

TEST_CASE("Discs that hide, equal discs, a ring with a hole") {
  const MassProperties hidden = union_of_discs({{{0.1, 0.2, 0}, 0.3}, {{0, 0, 0}, 1}, {{0, 0, 0}, 1}});
  CHECK(std::abs(hidden.volume - pi_of_union) < 1e-13);
  CHECK(std::abs(hidden.inertia(2, 2) - 0.5 * pi_of_union) < 1e-13);
  // Six discs around a hole, by counting points of a fine grid.
  std::vector<Ball> ring;
  for (int k = 0; k < 6; ++k) ring.push_back({{std::cos(k * pi_of_union / 3), std::sin(k * pi_of_union / 3), 0}, 0.6});
  const MassProperties p = union_of_discs(ring);
  const int n = 1500;
  long inside = 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const Eigen::Vector3d at(-1.6 + 3.2 * (i + 0.5) / n, -1.6 + 3.2 * (j + 0.5) / n, 0);
      for (const Ball& ball : ring)
        if ((at - ball.at).squaredNorm() < 0.36) {
          ++inside;
          break;
        }
    }
  CHECK(std::abs(p.volume - inside * 3.2 * 3.2 / n / n) < 1e-4 * p.volume);
  CHECK(p.centre.norm() < 1e-13);
}
