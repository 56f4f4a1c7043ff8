// Plates under pressure that mean nothing are refused: key and remedy are told.
#include "tests/mpm/plates.hpp"
#include "tests/mpm/rock_refusals.hpp"

using namespace mpm::test;
using Catch::Matchers::Contains;

namespace {

std::string block_with(const std::vector<std::string>& assignments) {
  return told_of(pressed_block, {assignments, "", "", {}});
}
std::string block_edited(const std::string& from, const std::string& to) {
  return told_of(pressed_block, {{}, from, to, {}});
}

}  // namespace

TEST_CASE("plates that are none are refused: key and remedy are told") {
  CHECK(block_with({}) == "accepted");
  CHECK_THAT(block_edited("kind = \"half_space\"\ncentre_m = [0, 0.3]\nnormal = [0, -1]",
                          "kind = \"box\"\ncentre_m = [0.2, 0.4]\nsize_m = [0.4, 0.2]"),
             Contains("body.lid.pressure_Pa") && Contains("set kind = \"half_space\" and a normal along an axis"));
  CHECK_THAT(block_with({"body.lid.normal=[0.1, -1]", "body.lid.centre_m=[0, 0.4]"}),
             Contains("body.lid.pressure_Pa") && Contains("a normal along an axis"));
  CHECK(block_with({"body.lid.normal=[0, -3]"}) == "accepted");
  CHECK_THAT(block_with({"body.lid.contact=nodes"}),
             Contains("body.lid.contact") && Contains("\"surface\"; remove the key"));
  CHECK_THAT(block_with({"body.lid.pressure_history=[[0, 0], [1, 1e4]]"}),
             Contains("body.pressure_history") && Contains("pressure_Pa") && Contains("remove one of them"));
  CHECK_THAT(block_with({"body.lid.pressure_Pa=-1"}),
             Contains("body.pressure_Pa") && Contains("negative") && Contains("give pressures of 0 and more"));
  CHECK_THAT(block_edited("pressure_Pa = 1e4", "pressure_history = [[0, 1e4], [1, -2]]"),
             Contains("body.pressure_history") && Contains("negative"));
  CHECK_THAT(block_edited("pressure_Pa = 1e4", "pressure_history = [[0, 1e4], [0, 2e4]]"),
             Contains("body.pressure_history"));
  CHECK_THAT(block_with({"fluid={conductivity_m_s=1e-3, porosity=0.4}"}),
             Contains("body.lid.pressure_Pa") && Contains("[fluid]") && Contains("set motion instead"));
  CHECK_THAT(block_with({"body.lid.motion=[[0, 0, -0.1]]"}),
             Contains("body.lid.motion") && Contains("pressure_until_s"));
  CHECK(block_with({"body.lid.motion=[[0, 0, -0.1]]", "body.lid.pressure_until_s=0.005"}) == "accepted");
  for (const char* key : {"plate_mass_kg", "area_m2", "pressure_until_s"}) {
    CAPTURE(key);
    CHECK_THAT(block_edited("pressure_Pa = 1e4", std::string(key) + " = 0.5"),
               Contains("body." + std::string(key)) && Contains("give pressure_Pa, or remove the key"));
  }
  for (const char* key : {"plate_mass_kg", "area_m2"}) {
    for (const char* value : {"0", "-1", "nan", "inf"}) {
      CAPTURE(key, value);
      CHECK_THAT(block_with({"body.lid." + std::string(key) + "=" + value}), Contains("body." + std::string(key)));
    }
  }
  for (const char* value : {"nan", "inf"})
    CHECK_THAT(block_with({"body.lid.pressure_Pa=" + std::string(value)}), Contains("body.pressure_Pa is "));
  CHECK_THAT(block_with({"body.lid.pressure_until_s=-1"}), Contains("body.pressure_until_s is -1"));
  CHECK_THAT(block_edited("pressure_Pa", "presure_Pa"), Contains("nearest known key is body.pressure_Pa"));
}

TEST_CASE("plates without one boundary on each side are refused unless their area is given") {
  const auto begin = pressed_block.find("[[boundary]]\nname = \"right\""),
             end = pressed_block.find("[[boundary]]\nname = \"bottom\"");
  const auto right = pressed_block.substr(begin, end - begin);
  CHECK_THAT(block_edited(right, ""), Contains("body.lid.pressure_Pa") && Contains("0 bound the specimen along x from "
                                                                                   "above; give body.lid.area_m2"));
  auto second = right;
  second.replace(second.find("right"), 5, "other").replace(second.find("0.4"), 3, "0.5");
  CHECK_THAT(block_edited(right, right + second), Contains("body.lid.pressure_Pa") &&
                                                      Contains("2 bound the specimen along x from above") &&
                                                      Contains("area_m2"));
  const auto bounded = "area_m2 = 0.8\npressure_Pa";
  const auto text = [&](const std::string& sides) {
    auto edited = pressed_block;
    edited.replace(begin, end - begin, sides);
    return edited;
  };
  CHECK(told_of(text(""), {{}, "pressure_Pa", bounded, {}}) == "accepted");
  CHECK(told_of(text(right + second), {{}, "pressure_Pa", bounded, {}}) == "accepted");
}

TEST_CASE("a rock that stands in a plate is refused, also where the mass of the plate is not given") {
  const std::string rock =
      "[[rock_material]]\nname = \"basalt\"\ndensity_kg_m3 = 2700\nyoung_modulus_Pa = 1e8\n[[rock]]\nname = \"disc\"\n"
      "material = \"basalt\"\nradius_m = 0.08\ncentre_m = ";
  CHECK_THAT(told_of(pressed_block + rock + "[0.2, 0.25]\n", {}),
             Contains("rock.disc: stands") && Contains("body.lid"));
  CHECK(told_of(pressed_block + rock + "[0.2, 0.2]\n", {}) == "accepted");
}
