// Secant modulus and damping of loops that are known in closed form.
#include "rvelab/ensemble/loops.hpp"

#include <algorithm>
#include <cmath>

#include "tests/catch.hpp"
#include "tests/ensemble/made_records.hpp"

using namespace rvelab;
using namespace rvelab::ensemble;
using namespace rvelab::test;

namespace {

const double pi = std::acos(-1.0);

/// Strains of cycles between +-amplitude, linear in time, `steps` a quarter.
std::vector<double> cycles(double amplitude, int count, int steps = 200) {
  std::vector<double> strains{0};
  for (int quarter = 0; quarter < 4 * count; ++quarter) {
    const int direction = quarter % 4 == 0 || quarter % 4 == 3 ? 1 : -1;
    for (int k = 0; k < steps; ++k) strains.push_back(strains.back() + direction * amplitude / steps);
  }
  return strains;
}

/// Elastic with the modulus G up to the shear stress `yield`, ideally plastic there.
std::vector<double> ideally_plastic(const std::vector<double>& strains, double G, double yield) {
  std::vector<double> stresses{0};
  for (std::size_t k = 1; k < strains.size(); ++k)
    stresses.push_back(std::clamp(stresses.back() + G * (strains[k] - strains[k - 1]), -yield, yield));
  return stresses;
}

}  // namespace

TEST_CASE("an ideally plastic solid dissipates 2/pi (1 - gamma_y/gamma), by shear and by compression") {
  const double G = 4e7, yield = 2e4, amplitude = 2e-3;
  const auto strains = cycles(amplitude, 3);
  const auto stresses = ideally_plastic(strains, G, yield);
  std::vector<records::Record> shear, compression;
  for (std::size_t k = 0; k < strains.size(); ++k) {
    shear.push_back(shear_record(strains[k], stresses[k]));
    compression.push_back(biaxial_record(0.5 * strains[k], -0.5 * strains[k], 1e5 + stresses[k], 1e5 - stresses[k]));
  }
  for (const auto& [records, axis] : {std::pair(shear, "xy"), std::pair(compression, "y")}) {
    CAPTURE(axis);
    const auto loops = loops_of(records, axis, 2);
    REQUIRE(loops.size() == 2);  // three cycles from zero: two whole ones between turns
    for (const Loop& loop : loops) {
      CHECK(loop.gamma == Approx(amplitude).epsilon(1e-9));
      CHECK(loop.G == Approx(yield / amplitude).epsilon(1e-9));
      CHECK(loop.damping_ratio == Approx(2 / pi * (1 - yield / G / amplitude)).epsilon(1e-3));
    }
    CHECK(initial_shear_modulus(records, axis, 2) == Approx(G).epsilon(1e-9));
    CHECK(initial_shear_modulus(records, axis, 2, amplitude) == Approx(yield / amplitude).epsilon(1e-9));
  }
}

TEST_CASE("a viscous solid has the damping ratio eta omega/(2 G), an elastic one none") {
  const double G = 3e7, loss = 4.5e6, amplitude = 1e-4;
  for (const double part : {0.0, 1.0}) {
    std::vector<records::Record> records;
    for (int k = 0; k <= 3000; ++k) {
      const double phase = 2 * pi * k / 1000;
      records.push_back(
          shear_record(amplitude * std::sin(phase), amplitude * (G * std::sin(phase) + part * loss * std::cos(phase))));
    }
    const auto loops = loops_of(records, "xy", 3);
    REQUIRE(loops.size() == 2);
    CHECK(loops[0].G == Approx(G).epsilon(1e-4));
    CHECK(loops[0].damping_ratio == Approx(part * loss / (2 * G)).epsilon(1e-4).margin(1e-10));
  }
}

TEST_CASE("a test that does not turn has no loop, and one cycle ends at its last record") {
  std::vector<records::Record> records;
  for (int k = 0; k < 50; ++k) records.push_back(shear_record(1e-5 * k, 1e3 * k));
  CHECK(loops_of(records, "xy", 2).empty());
  CHECK(loops_of(records, "", 2).empty());
  records.clear();
  // From +gamma to -gamma and back to +gamma, where the records end.
  for (const double strain : cycles(1e-3, 2)) records.push_back(shear_record(strain, 1e7 * strain));
  const std::size_t quarter = 200;
  CHECK(loops_of(std::span(records).first(5 * quarter + 1), "xy", 2).size() == 1);
  CHECK(loops_of(std::span(records).first(4 * quarter + 1), "xy", 2).empty());
}
