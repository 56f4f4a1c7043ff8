// Steered quasi-static loading: a stricter target takes more sub-steps and comes nearer to the well-resolved path. The
// list follows its counts: a slow specimen shrinks its skin and stays right.
#include <algorithm>

#include "tests/solver/brute_force.hpp"
#include "tests/specimens.hpp"

using namespace rvelab;
using namespace rvelab::test;

namespace {

/// 0.2 % of simple shear at constant volume in 20 increments.
struct Path {
  std::vector<Matrix3> stress;
  long substeps = 0;
};

Path sheared(Specimen s, double target, long fixed_substeps = 0) {
  s.solver.target_unbalanced = target;
  s.solver.fixed_substeps = fixed_substeps;
  Rve rve(s);
  Path path;
  for (int k = 0; k < 20; ++k) {
    const Response response = rve.apply(gradient(0, 1e-4, 0, 0), 0);
    path.stress.push_back(response.stress);
    path.substeps += response.report.substeps;
  }
  return path;
}

double error(const Path& path, const Path& reference) {
  double largest_difference = 0;
  for (std::size_t k = 0; k < path.stress.size(); ++k)
    largest_difference = std::max(largest_difference, largest(path.stress[k] - reference.stress[k]));
  return largest_difference;
}

}  // namespace

TEST_CASE("A stricter target_unbalanced takes more sub-steps and errs less", "[solver]") {
  const Specimen s = reference_specimen("dense");
  const double p0 = 1e5;
  const Path reference = sheared(s, 1e-3, 4000);
  const Path usual = sheared(s, 1e-3), strict = sheared(s, 1e-4);
  CHECK(strict.substeps > 3 * usual.substeps);
  CHECK(error(strict, reference) < 0.5 * error(usual, reference));
  CHECK(error(usual, reference) < 3e-3 * p0);
  CHECK(error(strict, reference) < 1e-3 * p0);
}

TEST_CASE("A slow specimen fits its skin down, and its list stays complete", "[solver]") {
  Specimen s = reference_specimen("dense");
  s.solver.skin = 0.3;
  Rve rve(s);
  for (int k = 0; k < 40; ++k) rve.apply(gradient(0, 1e-5, 0, 0), 0);
  rve.relax(1e-15, 8'000);
  const Specimen now = rve.specimen();
  const double mean_radius = [&] {
    double sum = 0;
    for (double r : now.grains.radius) sum += r;
    return sum / double(now.grains.size());
  }();
  CHECK(now.state.list.skin < 0.1 * mean_radius);
  CHECK(now.state.list.skin >= 0.01 * mean_radius * (1 - 1e-12));
  // Every touching pair of all images is a contact, and no other.
  const auto touching = brute_force_pairs(now.cell, now.grains.position, now.grains.radius, 0);
  const Network network = rve.network();
  REQUIRE(network.contacts.size() == touching.size());
  // The way on does not depend on the skin: sums of forces do not know the list.
  Specimen wide = now;
  wide.state.list.skin = 0.3 * mean_radius;
  Rve other(wide);
  for (int k = 0; k < 5; ++k) {
    const Matrix3 a = rve.apply(gradient(0, 1e-5, 0, 0), 0).stress, b = other.apply(gradient(0, 1e-5, 0, 0), 0).stress;
    CHECK(largest(a - b) <= 1e-6 * 1e5);
  }
}
