// Bridges in the solver against the exact laws (capillary.hpp, planar_bridge.hpp, which have oracles of their own):
// force along the gap, hysteresis between touching and rupture, energy, suction in a crystal, trials and restarts.
#include "rvelab/interaction/bridge_of_pair.hpp"
#include "rvelab/interaction/capillary.hpp"
#include "rvelab/interaction/planar_bridge.hpp"
#include "rvelab/measure/measures.hpp"
#include "rvelab/measure/probe.hpp"
#include "rvelab/measure/tangent.hpp"
#include "rvelab/protocol/protocol.hpp"
#include "rvelab/protocol/run.hpp"
#include "tests/interaction/bonded.hpp"

using namespace rvelab;
using namespace rvelab::test;

namespace {

constexpr double first_radius = 0.5e-3, second_radius = 0.4e-3, time_step = 1e-3, gamma_water = 0.0728,
                 thickness = 1e-3;

Water by_volume(double ratio, double angle = 0) {
  Water water;
  water.volume_ratio = ratio;
  water.contact_angle_deg = angle;
  return water;
}
Water by_suction(double suction, double angle = 0) {
  Water water;
  water.suction = suction;
  water.contact_angle_deg = angle;
  return water;
}

interaction::BridgeState exact(Shape shape, const Water& water, double gap) {
  const double theta = water.contact_angle_deg * pi / 180, r = std::min(first_radius, second_radius);
  if (dimension_of(shape) == 2)
    return interaction::planar_suction_bridge({first_radius, second_radius, theta, gamma_water}, water.suction, gap);
  if (water.suction > 0)
    return interaction::suction_bridge(water.suction, first_radius, second_radius, theta, gamma_water).at(gap);
  return interaction::volume_bridge(water.volume_ratio * r * r * r, first_radius, second_radius, theta, gamma_water)
      .at(gap);
}

void set_water(Rve& rve, const Water& water) { set_settings<CapillaryBridge>(rve, {water}); }
const std::vector<Water>& water_of(const Rve& rve) {
  return static_cast<const SettingsOf<CapillaryBridge>&>(rve.interaction_settings()).settings;
}

/// Grains so heavy that forces do not move them, `gap` apart along x.
Rve pair_at(Shape shape, double gap, const Water& water) {
  Material heavy = linear_material(1e3, 1e3, 0.5);
  heavy.density = 1e40;
  Specimen s = empty_specimen(shape, 10e-3, heavy);
  if (dimension_of(shape) == 2) s.cell.lattice(2, 2) = thickness;
  s.solver.fixed_time_step = time_step;
  const double length = first_radius + second_radius + gap;
  add_grain(s, {-0.5 * length, 0, 0}, first_radius);
  add_grain(s, {0.5 * length, 0, 0}, second_radius);
  Rve rve(s);
  set_water(rve, water);
  return rve;
}

/// Parts them by `distance`.
void part(Rve& rve, double distance, long steps) {
  const double wi = std::pow(first_radius, rve.cell().dimension), wj = std::pow(second_radius, rve.cell().dimension);
  const double v = distance / (double(steps) * time_step);
  rve.set_velocities({Vector3(-v * wj / (wi + wj), 0, 0), Vector3(v * wi / (wi + wj), 0, 0)},
                     {Vector3::Zero(), Vector3::Zero()});
  rve.apply(Matrix3::Zero(), double(steps) * time_step);
}

double gap_of(const Rve& rve) {
  const Specimen s = rve.specimen();
  return (s.grains.position[1] - s.grains.position[0]).norm() - (first_radius + second_radius);
}

std::size_t bridges(const Rve& rve) { return rve.network().interactions.size(); }

const std::vector<Water> waters = {by_volume(1e-3), by_volume(0.03, 20), by_suction(2e3), by_suction(500, 30)};

}  // namespace

TEST_CASE("a bridge forms on touching, pulls as the exact law along its gap, and lives to rupture", "[bridge]") {
  for (const Shape shape : {Shape::disc, Shape::sphere})
    for (const Water& water : waters) {
      if (dimension_of(shape) == 2 && water.volume_ratio > 0) continue;  // discs have bridges by suction
      INFO(name(shape) << ", suction " << water.suction << ", volume " << water.volume_ratio);
      Rve rve = pair_at(shape, 1e-7, water);
      part(rve, 0.5e-7, 1);
      CHECK(bridges(rve) == 0);  // near, but never touched
      part(rve, -2e-7, 1);
      CHECK(bridges(rve) == 1);
      const double unit = dimension_of(shape) == 2 ? thickness : 1;  // planar laws are per unit of thickness
      const double most = unit * std::abs(exact(shape, water, 0).force);
      const double overlapping = rve.network().interactions.front().normal_force;
      CHECK(overlapping == Approx(-most).epsilon(1e-8));
      double last_gap = 0, work = 0;
      const double start_energy = rve.network().interactions.front().elastic_energy;
      for (int k = 0; k < 400 && bridges(rve) == 1; ++k) {
        last_gap = gap_of(rve);
        const interaction::BridgeState at = exact(shape, water, last_gap);
        const InteractionState& found = rve.network().interactions.front();
        CHECK(std::abs(found.normal_force - unit * at.force) < 1e-8 * most);
        const double before = found.normal_force;
        part(rve, 2e-6, 1);
        if (bridges(rve) == 1)
          work -= 0.5 * (before + rve.network().interactions.front().normal_force) * (gap_of(rve) - last_gap);
      }
      CHECK(bridges(rve) == 0);
      const Specimen plane = rve.specimen();
      // Rupture lies between the last two gaps, by the exact law too.
      CHECK(exact(shape, water, last_gap).force < 0);
      CHECK(exact(shape, water, gap_of(rve)).force == 0);
      CHECK(largest(rve.contact_stress()) == 0);
      // What pulling took is what the bridge was worth, but for the last piece.
      CHECK(work == Approx(-start_energy).epsilon(0.03));
      part(rve, -gap_of(rve) + 1e-7, 10);
      CHECK(bridges(rve) == 0);  // back within reach: hysteresis
      part(rve, -2e-7, 1);
      CHECK(bridges(rve) == 1);
    }
}

TEST_CASE("water in a crystal: its stress and saturation", "[bridge]") {
  for (const Shape shape : {Shape::disc, Shape::sphere}) {
    INFO(name(shape));
    const bool plane = dimension_of(shape) == 2;
    const double a = 1e-3, overlap = 1e-7, r = 0.5 * (a + overlap), kn = 2e4;
    Specimen s = empty_specimen(shape, 4 * a, linear_material(kn, 0.5 * kn, 0.5));
    if (plane) s.cell.lattice(2, 2) = thickness;
    for (int k = 0; k < (plane ? 1 : 4); ++k)
      for (int j = 0; j < 4; ++j)
        for (int i = 0; i < 4; ++i) add_grain(s, Vector3(i, j, plane ? 0 : k) * a, r);
    Rve rve(s);
    const Matrix3 dry = rve.contact_stress();
    set_water(rve, by_suction(3e3, 10));
    const int bridges_each = plane ? 2 : 3;
    CHECK(bridges(rve) == std::size_t(bridges_each) * rve.size());
    const double theta = 10 * pi / 180, face = plane ? a * thickness : a * a;
    const interaction::PlanarPair pair{r, r, theta, gamma_water};
    const interaction::BridgeState one = plane ? interaction::planar_suction_bridge(pair, 3e3, 0)
                                               : interaction::suction_bridge(3e3, r, r, theta, gamma_water).at(0);
    const double unit = plane ? thickness : 1, pull = -unit * one.force;
    const Matrix3 wet = rve.contact_stress();
    for (int k = 0; k < rve.cell().dimension; ++k) CHECK(wet(k, k) - dry(k, k) == Approx(pull / face).epsilon(1e-7));
    CHECK(largest(interaction_stress(rve.network(), Family::water) - (wet - dry)) < 1e-9 * pull / face);
    const double solid = (plane ? pi * r * r * thickness : 4 * pi / 3 * r * r * r) * double(rve.size());
    double water_volume = 0;
    for (const InteractionState& c : rve.network().interactions)
      water_volume += content_of_bridge(water_of(rve).front(), {r, r, plane ? thickness : 0, -c.overlap}).volume;
    CHECK(water_volume / (rve.cell().volume() - solid) ==
          Approx(bridges_each * double(rve.size()) * unit * one.volume / (rve.cell().volume() - solid)).epsilon(1e-9));
  }
}

TEST_CASE("moist packings: trials, restarts and released buffers bit by bit", "[bridge]") {
  for (const Shape shape : {Shape::disc, Shape::sphere})
    for (const Water& water : {by_suction(300), by_volume(1e-3, 10)}) {
      if (dimension_of(shape) == 2 && water.volume_ratio > 0) continue;
      INFO(name(shape) << ", suction " << water.suction);
      const int side = dimension_of(shape) == 2 ? 8 : 5;
      Rve start =
          at_rest(disordered(shape, side, linear_material(2e4, 1e4, 0.4), Law::linear_stiffness, 0.51, 4), 1e-8);
      set_water(start, water);
      start.apply(gradient(1e-4, 0, 0, 0), 0);
      REQUIRE(bridges(start) > start.size() / 2);
      for (const double dt : {0.0, 1e-3})
        CHECK(bridges(after_path_bit_by_bit(start, gradient(1e-3, 2e-2, 5e-3, 1e-3), dt, 5)) > 0);
    }
}

TEST_CASE("the elastic tangent of moist packings is what small steps measure", "[bridge]") {
  for (const Shape shape : {Shape::disc, Shape::sphere}) {
    INFO(name(shape));
    // Nine: discs in an even square turn like gears, a motion that nothing but round-off resists.
    const int side = dimension_of(shape) == 2 ? 9 : 5;
    Rve rve = at_rest(disordered(shape, side, linear_material(2e4, 1e4, 1e6), Law::linear_stiffness, 0.51, 4), 1e-8);
    set_water(rve, by_suction(300));
    for (int k = 0; k < 12; ++k) rve.apply(gradient(1e-3, 2e-3, 0, 1e-3), 0);  // some contacts open, their bridges hold
    REQUIRE(rve.relax(1e-10, 2'000'000).target_held);
    const Network net = rve.network();
    const auto apart = std::count_if(net.interactions.begin(), net.interactions.end(),
                                     [](const InteractionState& c) { return c.overlap < 0; });
    CHECK(apart > 0);  // those whose pull changes with the gap
    const Eigen::MatrixXd tangent = elastic_tangent(net), measured = probe_stiffness(rve, 1e-8).stiffness;
    CHECK((tangent - measured).norm() < 1e-5 * measured.norm());
  }
}

TEST_CASE("flooding takes the bridges away, and what water cannot be is refused", "[bridge]") {
  Rve rve = pair_at(Shape::sphere, -1e-7, by_suction(2e3));
  part(rve, 1e-8, 1);
  REQUIRE(bridges(rve) == 1);
  set_water(rve, by_suction(4e3));  // the bridge stays, as that of the new suction
  CHECK(rve.network().interactions.front().normal_force ==
        Approx(exact(Shape::sphere, by_suction(4e3), 0).force).epsilon(1e-8));
  set_settings<CapillaryBridge>(rve, {});
  CHECK(bridges(rve) == 0);
  CHECK(water_of(rve).empty());
  Specimen without = pair_at(Shape::sphere, -1e-7, by_suction(2e3)).specimen();
  static_cast<SettingsOf<CapillaryBridge>&>(without).settings.clear();
  CHECK_THROWS_WITH(Rve(without), Catch::Contains("bridges without water"));
  Water both = by_suction(1e3);
  both.volume_ratio = 0.01;
  CHECK_THROWS_WITH(set_water(rve, both), Catch::Contains("water/suction_Pa = 1000") && Catch::Contains("one of them"));
  Rve discs = pair_at(Shape::disc, -1e-7, by_suction(2e3));
  CHECK_THROWS_WITH(set_water(discs, by_volume(0.01)), Catch::Contains("between discs"));
  CHECK_THROWS_WITH(set_water(rve, by_volume(0.5)), Catch::Contains("water/volume_ratio"));
}

TEST_CASE("a stage of water reaches the saturation that is asked", "[bridge]") {
  for (const Shape shape : {Shape::disc, Shape::sphere}) {
    INFO(name(shape));
    const int side = dimension_of(shape) == 2 ? 8 : 5;
    const Rve dry =
        at_rest(disordered(shape, side, linear_material(2e4, 1e4, 0.4), Law::linear_stiffness, 0.51, 4), 1e-8);
    const auto run = [&](const std::string& keys) {
      const std::string text =
          "[test]\nname = \"moist\"\ndimension = " + std::to_string(dimension_of(shape)) +
          "\npressure_Pa = 1e3\n[loading]\nmode = \"quasi_static\"\n[[stage]]\nkind = \"water\"\n" + keys;
      return protocol::run_protocol(protocol::parse_protocol(text, "moist.toml"), dry.specimen(), {}).end_state;
    };
    const Rve moist(run("saturation = 0.03\n"));
    const Network net = moist.network();
    double volume = 0;
    for (const InteractionState& c : net.interactions)
      volume += content_of_bridge(water_of(moist).front(),
                                  {net.grains[std::size_t(c.i)].radius, net.grains[std::size_t(c.j)].radius,
                                   dimension_of(shape) == 2 ? net.cell.lattice(2, 2) : 0, -c.overlap})
                    .volume;
    CHECK(volume / pore_volume(net) == Approx(0.03).epsilon(1e-6));
    CHECK((water_of(moist).front().suction > 0) == (dimension_of(shape) == 2));
    CHECK_THROWS_WITH(run("saturation = 0.03\nsuction_Pa = 100\n"), Catch::Contains("contradicts suction_Pa"));
    CHECK_THROWS_WITH(run("suction_Pa = 0.1\n"), Catch::Contains("stage.water.saturation would be"));
    CHECK_THROWS_WITH(run(""), Catch::Contains("stage.water.suction_Pa is missing"));
  }
}
