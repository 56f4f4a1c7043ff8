// Grains that stick: Mohr circles show a cohesion, those of the same grains without adhesion show none.
#include <cmath>

#include "rvelab/calibrate/calibrate.hpp"
#include "rvelab/measure/measures.hpp"
#include "tests/catch.hpp"
#include "tests/reference_specimen.hpp"
#include "tests/side_by_side.hpp"

using namespace rvelab;

namespace {

constexpr double radians_per_degree = 3.14159265358979323846 / 180;

struct Tests {
  calibrate::Calibration found;
  double contacts_at_peak = 0;  ///< of a test at the middle pressure
};

Tests compressed(double pull_off_force) {
  Specimen specimen = reference_specimen("dense_p20");
  specimen.contact.law = Law::linear_adhesive;
  for (Material& material : specimen.materials) material.pull_off_force = pull_off_force;
  std::vector<protocol::Protocol> protocols;
  for (const std::string pressure : {"10e3", "20e3", "40e3"})
    protocols.push_back(
        protocol::parse_protocol("[test]\nname = \"cohesion\"\npressure_Pa = " + pressure +
                                     "\n[[stage]]\nkind = \"isotropic\"\nshear = \"zero_strain\"\n"
                                     "[[stage]]\nkind = \"compression\"\nto_strain = 0.025\nrecord_every = 0.0005\n",
                                 "cohesion.toml"));
  std::vector<records::TestResult> results;
  for (const protocol::TestRun& run : test::run_all(protocols, {specimen}, 2)) results.push_back(run.result);
  Tests tests{calibrate::calibrate(results, 2)};
  const auto records = calibrate::last_stage(results[1]);
  tests.contacts_at_peak =
      0.5 * records[calibrate::peak(records, 2).record].coordination_number * double(specimen.grains.size());
  return tests;
}

}  // namespace

TEST_CASE("A pull-off force shows as cohesion, of the size that its contacts give") {
  const calibrate::Calibration plain = compressed(0).found;
  CHECK(std::abs(plain.cohesion) < 2 * plain.cohesion_error);

  const double pull_off = 20;
  const auto [found, contacts] = compressed(pull_off);
  CAPTURE(plain.cohesion, plain.cohesion_error, found.cohesion, found.cohesion_error, contacts);
  CHECK(found.cohesion > 5 * found.cohesion_error);
  // Contacts that all bear c pull the cell together as a pressure of sum c l/(2 V) would: c_macro = tan(phi) times
  // that, if all branches stayed as they are (Richefeu et al. 2006). Those that slip or open take from it.
  const Specimen specimen = reference_specimen("dense_p20");
  double branch = 0;
  for (const double radius : specimen.grains.radius) branch += 2 * radius / double(specimen.grains.size());
  const double internal_pressure = contacts * pull_off * branch / (2 * specimen.cell.volume());
  const double bound = std::tan(found.friction_angle_with_cohesion_deg * radians_per_degree) * internal_pressure;
  CHECK(found.cohesion < 1.2 * bound);
  CHECK(found.cohesion > 0.4 * bound);
}
