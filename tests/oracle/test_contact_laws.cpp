// One table test for all contact laws: parameters and expected forces stand in tests/data/contact_laws.json, computed
// from the published equations. A new law adds rows there.
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/specimens.hpp"

using namespace rvelab;
using namespace rvelab::test;

namespace {

Material material_of(const nlohmann::json& row) {
  Material m;
  m.density = 1e30;  // so heavy that the motion is as prescribed
  for (const LawParameter& each : law_parameters()) m.*each.value = row.value(each.parameter.field, 0.0);
  m.friction = row.at("friction");
  m.rolling_stiffness = row.at("rolling_stiffness");
  m.rolling_friction = row.at("rolling_friction");
  return m;
}

}  // namespace

TEST_CASE("every contact law has the forces of its published equations") {
  std::ifstream file(std::string(RVELAB_TEST_DATA) + "/contact_laws.json");
  REQUIRE(file);
  const nlohmann::json table = nlohmann::json::parse(file);
  REQUIRE(!table.at("cases").empty());
  for (const auto& row : table.at("cases"))
    for (const Shape shape : {Shape::disc, Shape::sphere}) {
      CAPTURE(row.at("name").get<std::string>(), shape == Shape::disc ? "discs" : "spheres");
      const double ri = row.at("radius_m")[0], rj = row.at("radius_m")[1], overlap = row.at("overlap_m");
      Specimen s = empty_specimen(shape, 1, material_of(row.at("materials")[0]), choice_from<Law>(row.at("law")));
      s.materials.push_back(material_of(row.at("materials")[1]));
      s.contact.rolling = true;
      s.solver.fixed_time_step = 1e-3;
      add_grain(s, Vector3(-ri + 0.5 * overlap, 0, 0), ri, 0);
      add_grain(s, Vector3(rj - 0.5 * overlap, 0, 0), rj, 1);
      // Turns about z that make the slip at the contact (arms r - delta/2) and the relative turn.
      const double slip = row.at("slip_m"), turn = row.at("turn_rad");
      const double ai = ri - 0.5 * overlap, aj = rj - 0.5 * overlap, steps = 1000, time = steps * 1e-3;
      const double turn_i = (slip - aj * turn) / (ai + aj), turn_j = turn_i + turn;
      Rve rve(s);
      rve.set_velocities({Vector3::Zero(), Vector3::Zero()},
                         {Vector3(0, 0, turn_i / time), Vector3(0, 0, turn_j / time)});
      rve.apply(Matrix3::Zero(), time);
      const Network n = rve.network();
      REQUIRE(n.contacts.size() == 1);
      const ContactState& c = n.contacts[0];
      CHECK(c.normal_force == Approx(row.at("normal_force_N").get<double>()).epsilon(1e-11));
      CHECK(c.tangential_force.y() == Approx(row.at("tangential_force_N").get<double>()).epsilon(1e-10));
      CHECK(c.rolling_moment.z() == Approx(-row.at("rolling_moment_Nm").get<double>()).epsilon(1e-10));
      CHECK(std::abs(c.tangential_force.x()) + std::abs(c.tangential_force.z()) < 1e-9 * std::abs(c.normal_force));
    }
}
