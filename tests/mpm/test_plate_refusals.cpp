// Plates under pressure that mean nothing are refused: key and remedy are told.
#include "tests/mpm/plates.hpp"

using namespace mpm::test;

TEST_CASE("plates that are none are refused: key and remedy are told") {
  const auto lid = [](const std::string& assignment) { return set("body.lid." + assignment); };
  const auto instead = [](const std::string& keys) { return edit("pressure_Pa = 1e4", keys); };
  expect_said(
      pressed_block,
      {{{}, {"accepted"}},
       {edit("kind = \"half_space\"\ncentre_m = [0, 0.3]\nnormal = [0, -1]",
             "kind = \"box\"\ncentre_m = [0.2, 0.4]\nsize_m = [0.4, 0.2]"),
        {"body.lid.pressure_Pa", "set kind = \"half_space\" and a normal along an axis"}},
       {set({"body.lid.normal=[0.1, -1]", "body.lid.centre_m=[0, 0.4]"}), {"body.lid.pressure_Pa", "along an axis"}},
       {lid("normal=[0, -3]"), {"accepted"}},
       {lid("contact=nodes"), {"body.lid.contact", "remove the key"}},
       {lid("pressure_history=[[0, 0], [1, 1e4]]"), {"body.pressure_history", "pressure_Pa", "remove one of them"}},
       {lid("pressure_Pa=-1"), {"body.pressure_Pa", "negative", "0 and more"}},
       {instead("pressure_history = [[0, 1e4], [1, -2]]"), {"body.pressure_history", "negative"}},
       {instead("pressure_history = [[0, 1e4], [0, 2e4]]"), {"body.pressure_history"}},
       {set("fluid={conductivity_m_s=1e-3, porosity=0.4}"), {"body.lid.pressure_Pa", "[fluid]", "set motion"}},
       {lid("motion=[[0, 0, -0.1]]"), {"body.lid.motion", "pressure_until_s"}},
       {set({"body.lid.motion=[[0, 0, -0.1]]", "body.lid.pressure_until_s=0.005"}), {"accepted"}},
       {lid("pressure_until_s=-1"), {"body.pressure_until_s = -1"}},
       {edit("pressure_Pa", "presure_Pa"), {"nearest known key is body.pressure_Pa"}}});
  for (const std::string key : {"plate_mass_kg", "area_m2", "pressure_until_s"})
    expect_said(pressed_block, {{instead(key + " = 0.5"), {"body." + key, "give pressure_Pa"}}});
  for (const std::string key : {"plate_mass_kg", "area_m2", "pressure_Pa"}) {
    for (const std::string value : {"0", "-1", "nan", "inf"}) {
      if (key != "pressure_Pa" || value != "0") expect_said(pressed_block, {{lid(key + "=" + value), {"body." + key}}});
    }
  }
}

TEST_CASE("plates without one boundary on each side are refused unless their area is given") {
  const auto right = boundary("right", "roller", "x", "0.4", below),
             second = boundary("other", "roller", "x", "0.5", below);
  expect_said(pressed_block,
              {{edit(right, ""), {"body.lid.pressure_Pa", "0 bound", "along x from above", "body.lid.area_m2"}},
               {edit(right, right + second), {"body.lid.pressure_Pa", "2 bound", "along x from above", "area_m2"}}});
  for (const auto& sides : {std::string(), right + second})
    expect_said(edited(pressed_block, right, sides),
                {{edit("pressure_Pa", "area_m2 = 0.8\npressure_Pa"), {"accepted"}}});
}

TEST_CASE("a rock that stands in a plate is refused, also where the mass of the plate is not given") {
  const auto with_disc = [](const std::string& centre) {
    return pressed_block + basalt() + rock("disc", centre, "radius_m = 0.08\n");
  };
  expect_said(with_disc("[0.2, 0.25]"), {{{}, {"rock.disc: stands", "body.lid"}}});
  expect_said(with_disc("[0.2, 0.2]"), {{{}, {"accepted"}}});
}
