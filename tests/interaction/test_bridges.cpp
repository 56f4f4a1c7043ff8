// Bridges between spheres against solutions of the Young-Laplace equation that the table was not made from, and against
// laws that hold whatever the table: the force is the slope of the energy, sizes scale, radii may change places.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "rvelab/interaction/capillary.hpp"
#include "tests/catch.hpp"
#include "tests/specimens.hpp"

using namespace rvelab::interaction;
using rvelab::test::pi;

namespace {

using Row = std::map<std::string, double>;

/// Rows of numbers under a line of names; `held` is 1 for suction.
std::vector<Row> rows_of(const std::string& name) {
  std::ifstream file(std::string(RVELAB_TEST_DATA) + "/interaction/" + name);
  std::vector<std::string> names;
  std::vector<Row> rows;
  for (std::string line; std::getline(file, line);) {
    std::istringstream cells(line);
    std::string cell;
    if (names.empty()) {
      while (std::getline(cells, cell, ',')) names.push_back(cell);
      continue;
    }
    Row row;
    for (const std::string& each : names) {
      std::getline(cells, cell, ',');
      row[each] = cell == "volume" ? 0 : cell == "suction" ? 1 : std::stod(cell);
    }
    rows.push_back(row);
  }
  return rows;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values.at(values.size() / 2);
}

}  // namespace

TEST_CASE("bridges of given volume meet the Young-Laplace solutions of the oracle", "[interaction]") {
  std::vector<double> force_error, suction_error;
  for (Row& row : rows_of("young_laplace.csv")) {
    const VolumeBridge bridge =
        volume_bridge(row["volume"], 1, row["radius_2"], row["contact_angle_deg"] * pi / 180, 1);
    CAPTURE(row["volume"], row["radius_2"], row["contact_angle_deg"], row["gap"]);
    if (row["gap"] > 0.985 * bridge.rupture_gap) continue;  // the oracle's last rows lie at the fold
    const double gap = std::max(row["gap"], 0.0);
    const BridgeState found = bridge.at(gap), contact = bridge.at(0);
    force_error.push_back(std::abs(found.force / -row["force"] - 1));
    suction_error.push_back(std::abs(found.suction - row["suction"]) / contact.suction);
    const bool poorly = row["contact_angle_deg"] > 30;
    CHECK(force_error.back() < (poorly ? 2e-3 : 5e-4));
    CHECK(suction_error.back() < (poorly ? 1e-2 : 5e-4));
    CHECK(found.volume == row["volume"]);
  }
  REQUIRE(force_error.size() > 50);
  CHECK(median(force_error) < 3e-4);
  CHECK(median(suction_error) < 2e-4);
}

TEST_CASE("bridges of given volume or suction meet solutions off the table's points", "[interaction]") {
  const std::vector<Row> rows = rows_of("bridges.csv");
  REQUIRE(rows.size() == 108);
  for (Row row : rows) {
    const bool suction = row["held"] != 0, poorly = !suction && row["contact_angle"] > bridge_table::wetting.last_angle;
    CAPTURE(suction, row["contact_angle"], row["radius_2"], row["volume"], row["gap"]);
    const double gap = row["gap"], rupture = row["rupture_gap"];
    const auto check = [&](const auto& bridge) {
      // Above 30 degrees nearly equal spheres rupture by tilting, which a smooth table follows less well (README.md).
      const double rupture_error = suction ? 1e-4 : poorly ? 2e-2 : 1e-3;
      CHECK(std::abs(bridge.rupture_gap / rupture - 1) < rupture_error);
      if (poorly && gap > 0.6 * rupture) return;
      if (gap > bridge.rupture_gap) return;
      const double limit = suction ? 1e-3 : poorly ? 2e-2 : 4e-3;
      const BridgeState found = bridge.at(gap);
      CHECK(std::abs(found.force / -row["force"] - 1) < limit);
      CHECK(std::abs(found.volume / row["volume"] - 1) < 1e-3);
      CHECK(std::abs(found.suction - row["suction"]) < 3 * limit * bridge.at(0).suction);
      CHECK(std::abs(found.energy + row["energy"]) < limit * -bridge.at(0).energy);
    };
    if (suction)
      check(suction_bridge(row["suction"], row["radius_2"], 1, row["contact_angle"], 1));
    else
      check(volume_bridge(row["volume"], row["radius_2"], 1, row["contact_angle"], 1));
  }
}

TEST_CASE("the force of a bridge is the slope of its energy, its stiffness the slope of its force", "[interaction]") {
  for (const double theta : {0.0, 0.3, 0.7})
    for (const double r2 : {1e-3, 4e-3}) {
      const auto check = [&](const auto& bridge) {
        for (const double part : {0.001, 0.1, 0.5, 0.9, 0.99}) {
          CAPTURE(theta, r2, part);
          const double gap = part * bridge.rupture_gap, h = 1e-4 * std::min(gap, bridge.rupture_gap - gap);
          const BridgeState low = bridge.at(gap - h), high = bridge.at(gap + h), here = bridge.at(gap);
          CHECK(-(high.energy - low.energy) / (2 * h) == Approx(here.force).epsilon(1e-6));
          CHECK(-(high.force - low.force) / (2 * h) == Approx(here.stiffness).epsilon(1e-5));
          CHECK(bridge.force(gap).force == here.force);
          CHECK(bridge.force(gap).stiffness == here.stiffness);
        }
        // To rupture: the energy is the work of the pull, and ends at zero.
        double work = 0;
        const int n = 4000;
        for (int k = 0; k < n; ++k) {  // midpoints in t = sqrt(1 - gap/rupture)
          const double t = (k + 0.5) / n;
          work += bridge.force(bridge.rupture_gap * (1 - t * t)).force * 2 * t * bridge.rupture_gap / n;
        }
        CHECK(bridge.at(0).energy == Approx(work).epsilon(1e-6));
        CHECK(std::abs(bridge.at(bridge.rupture_gap).energy) < 1e-10 * -bridge.at(0).energy);
        CHECK(bridge.at(1.0000001 * bridge.rupture_gap).force == 0);
        CHECK(bridge.at(1.0000001 * bridge.rupture_gap).volume == 0);
        // Overlapping: the force of contact, and the work that it does.
        const BridgeState over = bridge.at(-1e-6), contact = bridge.at(0);
        CHECK(over.force == contact.force);
        CHECK(over.stiffness == 0);
        CHECK(over.energy == Approx(contact.energy + contact.force * 1e-6).epsilon(1e-12));
      };
      check(volume_bridge(2e-12, 1e-3, r2, theta, 0.073));
      check(suction_bridge(900, 1e-3, r2, theta, 0.073));
    }
}

TEST_CASE("energy, volume and suction obey thermodynamics: dU/dS = V, d(force)/dS = -dV/d(gap)", "[interaction]") {
  // Of the separate series for force and volume, so that a wrong one shows.
  const double r1 = 1e-3, r2 = 2.5e-3, theta = 0.35, tension = 0.073, S = 600, dS = 0.5;
  for (const double gap : {2e-5, 5e-5, 8e-5}) {
    CAPTURE(gap);
    const SuctionBridge here = suction_bridge(S, r1, r2, theta, tension);
    const SuctionBridge low = suction_bridge(S - dS, r1, r2, theta, tension);
    const SuctionBridge high = suction_bridge(S + dS, r1, r2, theta, tension);
    REQUIRE(here.rupture_gap > 1e-4);
    const double h = 1e-7;
    const double pull_over_suction = -(high.at(gap).force - low.at(gap).force) / (2 * dS);
    const double volume_over_gap = (here.at(gap + h).volume - here.at(gap - h).volume) / (2 * h);
    CHECK(pull_over_suction == Approx(volume_over_gap).epsilon(2e-3));
  }
  // The two tables tell the same bridge: volume at a suction, suction at that volume.
  const SuctionBridge open = suction_bridge(S, r1, r2, theta, tension);
  for (const double gap : {0.0, 4e-5, 1e-4}) {
    const BridgeState held = open.at(gap);
    const BridgeState closed = volume_bridge(held.volume, r1, r2, theta, tension).at(gap);
    CHECK(closed.force == Approx(held.force).epsilon(1e-3));
    CHECK(closed.suction == Approx(S).epsilon(2e-3));
  }
}

TEST_CASE("a small bridge in contact pulls with 2 pi gamma R cos(theta), whatever its volume", "[interaction]") {
  const double tension = 0.073, r1 = 1e-3, r2 = 3e-3, R = 2 * r1 * r2 / (r1 + r2);
  for (const double theta : {0.0, 0.4}) {
    const double limit = 2 * pi * tension * R * std::cos(theta);
    CHECK(-volume_bridge(1e-9 * std::pow(r1, 3), r1, r2, theta, tension).force(0).force == Approx(limit).epsilon(0.02));
    CHECK(-suction_bridge(3e4 * tension * std::cos(theta) / r1, r1, r2, theta, tension).force(0).force ==
          Approx(limit).epsilon(0.02));
  }
  // Rupture near (1 + theta/2) V^(1/3) of equal spheres (Lian, Thornton and Adams 1993).
  for (const double theta : {0.0, 0.3, 0.6})
    CHECK(volume_bridge(1e-12, r1, r1, theta, tension).rupture_gap == Approx((1 + theta / 2) * 1e-4).epsilon(0.035));
}

TEST_CASE("bridges scale with the radii, and do not ask which grain comes first", "[interaction]") {
  const VolumeBridge one = volume_bridge(3e-3, 1, 2, 0.2, 1), other = volume_bridge(3e-3, 2, 1, 0.2, 1);
  const VolumeBridge large = volume_bridge(3e-3 * 8, 2, 4, 0.2, 5);
  for (const double gap : {0.0, 0.03, 0.1}) {
    CHECK(one.at(gap).force == other.at(gap).force);
    CHECK(large.at(2 * gap).force == Approx(10 * one.at(gap).force).epsilon(1e-12));
    CHECK(large.at(2 * gap).energy == Approx(20 * one.at(gap).energy).epsilon(1e-12));
    CHECK(large.at(2 * gap).suction == Approx(2.5 * one.at(gap).suction).epsilon(1e-12));
  }
  CHECK(suction_bridge(20, 1, 2, 0.2, 1).force(0.02).force == suction_bridge(20, 2, 1, 0.2, 1).force(0.02).force);
}
