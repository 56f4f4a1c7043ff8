// The strength of one cemented specimen: unconfined and confined compression, direct tension; grains without bonds at 0
// Pa.
#include "tests/program.hpp"

using namespace rvelab::test;
using Catch::Matchers::Contains;

TEST_CASE("one cemented specimen is tested without lateral stress, at a pressure and in tension") {
  const Workplace here;
  here.succeeds("pack pack_dense -o S.h5 --set pack.number=60");
  here.succeeds("run cementing --specimen S.h5 -o C.h5");
  const auto found =
      here.json("calibrate cemented_strength --specimen C.h5 --pressures 0,4e4 --tension direct_tension -o envelope");
  CHECK(found["cohesive"] == true);
  CHECK_THAT(found["cohesion"].get<std::string>(), Contains("bonds"));
  CHECK(!found.contains("warning"));  // all tests pass a peak: they break
  const double c = found["cohesion_Pa"], tension = found["tensile_strength_Pa"], apex = found["tension_at_apex_Pa"];
  const double unconfined = found["unconfined_strength_Pa"], angle = found["friction_angle_deg"];
  // Two circles: the line touches both, and the unconfined one is at 0.
  CHECK(unconfined == found["per_pressure"][0]["peak_sigma_1_Pa"]);
  CHECK(std::abs(found["per_pressure"][0]["peak_sigma_3_Pa"].get<double>()) < 0.01 * unconfined);
  const double phi = angle * std::acos(-1.0) / 180;
  CHECK(unconfined == Approx(2 * c * std::cos(phi) / (1 - std::sin(phi))).epsilon(0.02));
  CHECK(apex == Approx(c / std::tan(phi)));
  // Bonds of 200 kPa: tension is borne, less than compression and than the line says.
  CHECK(tension > 5e3);
  CHECK(tension < 0.6 * unconfined);
  CHECK(found["bearing_capacity_of_cohesion_Pa"].get<double>() ==
        Approx(c * found["bearing_capacity_Nc"].get<double>()));
  CHECK(std::filesystem::exists(here / "envelope/T.h5"));
  CHECK(std::filesystem::exists(here / "envelope/R_0.h5"));
  CHECK(found["per_pressure"].size() == 2);

  // Without bonds no stress of 0 Pa is held, and the program says what to do.
  const Outcome loose = here.run("run cemented_strength --specimen S.h5 --set test.pressure_Pa=0");
  CHECK(loose.code != 0);
  CHECK_THAT(loose.errors, Contains("pressure_Pa = 0") && Contains("cement"));
}
