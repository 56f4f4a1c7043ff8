// A million spheres, once: memory, and time per grain that does not grow with their number.
#include <sys/resource.h>

#include <chrono>

#include "tests/catch.hpp"
#include "tests/extreme/specimens.hpp"

using namespace rvelab;
using namespace rvelab::test;

namespace {

/// Simple cubic crystal of n^3 spheres of radius 1 that overlap by 0.01.
Specimen cubic_crystal(int n) {
  const double spacing = 1.99, side = n * spacing;
  std::vector<Vector3> positions;
  positions.reserve(std::size_t(n) * n * n);
  for (int c = 0; c < n; ++c)
    for (int b = 0; b < n; ++b)
      for (int a = 0; a < n; ++a)
        positions.emplace_back((a + 0.5 - 0.5 * n) * spacing, (b + 0.5 - 0.5 * n) * spacing,
                               (c + 0.5 - 0.5 * n) * spacing);
  Specimen s = specimen_of(cell_of(3, side, side, side), positions, std::vector<double>(positions.size(), 1.0),
                           material(stiffness, 0.5 * stiffness, 0.5));
  s.solver.fixed_substeps = 5;
  return s;
}

/// Stress of the crystal after strains along its axes: one contact per face, f = kn (2 - spacing).
Matrix3 crystal_stress(const Vector3& strain) {
  Vector3 spacing, stress;
  for (int k = 0; k < 3; ++k) spacing[k] = 1.99 * (1 + strain[k]);
  for (int k = 0; k < 3; ++k) stress[k] = -stiffness * (2 - spacing[k]) * spacing[k] / spacing.prod();
  return stress.asDiagonal();
}

/// Opens a crystal, applies one increment, compares; returns seconds per grain.
double seconds_per_grain(int n) {
  const Specimen s = cubic_crystal(n);
  const auto start = std::chrono::steady_clock::now();
  Rve rve(s);
  CHECK(largest(rve.stress() - crystal_stress(Vector3::Zero())) <= 1e-9 * largest(rve.stress()));
  const Vector3 strain(1e-4, 0, -1e-3);
  const Response response = rve.apply(strain.asDiagonal(), 0);
  const auto seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  CHECK(response.report.substeps == 5);
  CHECK(largest(response.stress - crystal_stress(strain)) <= 1e-9 * largest(response.stress));
  CHECK(rve.size() == std::size_t(n) * n * n);
  CHECK(response.report.unbalanced_ratio < 1e-9);
  return seconds / double(rve.size());
}

}  // namespace

TEST_CASE("A million spheres open and deform in memory and time proportional to their number", "[extreme][slow]") {
  double few = 1;
  for (int repeat = 0; repeat < 5; ++repeat) few = std::min(few, seconds_per_grain(10));
  const double some = seconds_per_grain(32), many = seconds_per_grain(100);
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const double gibibytes = double(usage.ru_maxrss) / (1024.0 * 1024.0);
  WARN("us per grain at 1e3, 3.3e4, 1e6 spheres: " << 1e6 * few << ", " << 1e6 * some << ", " << 1e6 * many
                                                   << "; peak memory " << gibibytes << " GiB");
  CHECK(gibibytes < 8);
  CHECK(many * 1e6 < 120);
  // 1e3 spheres live in the cache and 1e6 do not; anything beyond O(N) would show as a factor of a thousand.
  CHECK(many < 20 * few);
}
