// Cement that dissolves: sections, forces and energies of one bond in closed form, crystals and packings under held
// stress, what breaks, who dissolves, tests gone on with.
#include "rvelab/error.hpp"
#include "rvelab/measure/measures.hpp"
#include "rvelab/measure/tangent.hpp"
#include "rvelab/protocol/dissolution.hpp"
#include "rvelab/protocol/run.hpp"
#include "tests/interaction/bonded.hpp"
#include "tests/io/random_specimen.hpp"

using namespace rvelab;
using namespace rvelab::test;
using Catch::Contains;

namespace {

constexpr double grain_radius = 0.0049, grain_spacing = 0.01;

/// A square or cubic crystal whose grains lie apart: bonds alone bear.
Rve loose_crystal(Shape shape, int side) {
  const bool plane = dimension_of(shape) == 2;
  Specimen s = empty_specimen(shape, side * grain_spacing, linear_material(1e6, 1e6, 0.5));
  s.materials.push_back(s.materials.front());
  s.materials.back().name = "other";
  for (int k = 0; k < (plane ? 1 : side); ++k)
    for (int j = 0; j < side; ++j)
      for (int i = 0; i < side; ++i) add_grain(s, Vector3(i, j, plane ? 0 : k) * grain_spacing, grain_radius, j % 2);
  Rve rve(s);
  rve.set_interactions(protocol::cemented(rve, cement_of(1e9, 0.1)));
  return rve;
}

Rve bonded_packing(Shape shape, double strength) {
  Rve rve = small_packing_at_rest(shape, 0.3);
  rve.set_interactions(protocol::cemented(rve, cement_of(strength)));
  return rve;
}

std::vector<Bond> bonds_after(const Rve& rve, const protocol::Dissolution& d, double before = 0, double part = 1) {
  protocol::Dissolved result = protocol::dissolved(rve, d, before, part);
  return bonds_of(result.interactions);
}

protocol::Protocol dissolving(const std::string& stage, const std::string& quantities = "") {
  const std::string measured = quantities.empty() ? "" : "[output]\nquantities = [" + quantities + "]\n";
  return protocol::parse_protocol("[test]\nname = \"t\"\n" + measured + "[[stage]]\nkind = \"dissolve\"\n" + stage,
                                  "t.toml");
}

std::string refusal_of(const std::string& stage, const Rve& rve) {
  try {
    protocol::run_protocol(dissolving(stage), rve.specimen());
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("the rim of a bond takes its share of force, moment and energy with it", "[dissolve]") {
  for (const Shape shape : {Shape::disc, Shape::sphere}) {
    INFO(name(shape));
    Rve rve = bonded_packing(shape, 1e30);
    Matrix3 dH = gradient(-1e-4, 3e-4, -1e-4, 1e-4);
    if (shape == Shape::sphere) dH(0, 2) = 2e-4;
    rve.apply(dH, 0);
    REQUIRE(rve.relax(1e-9, 1'000'000).target_held);
    protocol::Dissolution d;
    d.radius = 0.6;
    const double before = elastic_energy(rve.network());
    const std::vector<Bond> was = bonds_of(rve), is = bonds_after(rve, d);
    const double thickness = shape == Shape::disc ? rve.cell().lattice(2, 2) : 1;
    double released = 0, twisted = 0;
    REQUIRE(was.size() == is.size());
    for (std::size_t k = 0; k < was.size(); ++k) {
      const double r = column(was[k], ParallelBond::radius);
      const Section full = section_of(shape, r), left = section_of(shape, 0.6 * r);
      CHECK(column(is[k], ParallelBond::radius) == Approx(0.6 * r).epsilon(1e-14));
      const Vector3 shear = triple(was[k], ParallelBond::shear_force) * (left.area / full.area),
                    bending = triple(was[k], ParallelBond::bending_moment) * (left.inertia / full.inertia);
      CHECK((triple(is[k], ParallelBond::shear_force) - shear).norm() <= 1e-13 * shear.norm());
      CHECK((triple(is[k], ParallelBond::bending_moment) - bending).norm() <= 1e-13 * bending.norm());
      if (shape == Shape::sphere) {
        const double twist = column(was[k], ParallelBond::twisting_moment) * left.polar / full.polar;
        CHECK(column(is[k], ParallelBond::twisting_moment) == Approx(twist).epsilon(1e-12));
        twisted += std::abs(twist);
      }
      // Stress of what is left is as it was, but at the rim by bending, where the rim came nearer.
      CHECK(column(is[k], ParallelBond::length) == column(was[k], ParallelBond::length));
      released += column(is[k], ParallelBond::released);
    }
    CHECK(thickness > 0);
    CHECK((twisted > 0) == (shape == Shape::sphere));
    Rve after = rve;
    after.set_interactions(protocol::dissolved(rve, d, 0, 1).interactions);
    CHECK(released > 0);
    CHECK(before - elastic_energy(after.network()) == Approx(released).epsilon(1e-6));
    // Without strength what is left breaks at once, and gives up the rest.
    d.strength = 0;
    after.set_interactions(protocol::dissolved(rve, d, 0, 1).interactions);
    double all = 0;
    for (const Bond& bond : bonds_of(after)) {
      CHECK(column(bond, ParallelBond::broken) > 0);
      CHECK(triple(bond, ParallelBond::shear_force).norm() == 0);
      all += column(bond, ParallelBond::released);
    }
    CHECK(before - elastic_energy(after.network()) == Approx(all).epsilon(1e-6));
    CHECK(all > released);
  }
}

TEST_CASE("steps of a dissolution lead to the same bond as one", "[dissolve]") {
  const Rve start = bonded_packing(Shape::sphere, 1e6);
  protocol::Dissolution d;
  d.radius = 0.3, d.strength = 0;
  Rve rve = start;
  for (int k = 0; k < 5; ++k) {
    const auto now = protocol::dissolved(rve, d, k / 5.0, (k + 1) / 5.0);
    CHECK(now.bonds == bonds_of(start).size());
    rve.set_interactions(now.interactions);
    const Bond bond = bonds_of(rve).front();
    // Both fall as straight lines: a constant rate.
    CHECK(column(bond, ParallelBond::radius) ==
          Approx((1 - 0.14 * (k + 1)) * column(bonds_of(start).front(), ParallelBond::radius)).epsilon(1e-13));
    CHECK(column(bond, ParallelBond::cohesion) == Approx(1e6 * (1 - 0.2 * (k + 1))).margin(1e-9));
  }
}

TEST_CASE("a share and a material dissolve, the others stay", "[dissolve]") {
  const Rve rve = loose_crystal(Shape::sphere, 8);
  const double whole = column(bonds_of(rve).front(), ParallelBond::radius);
  protocol::Dissolution d;
  d.radius = 0.5;
  d.material = "other";
  const Specimen s = rve.specimen();
  for (const Bond& b : bonds_after(rve, d)) {
    const bool touched = s.grains.material[std::size_t(b.i)] == 1 || s.grains.material[std::size_t(b.j)] == 1;
    CHECK(column(b, ParallelBond::radius) == Approx(touched ? 0.5 * whole : whole).epsilon(1e-14));
  }
  d.material = "";
  d.share = 0.3;
  const auto drawn = [&](std::uint64_t seed) {
    d.seed = seed;
    std::vector<bool> smaller;
    for (const Bond& b : bonds_after(rve, d)) smaller.push_back(column(b, ParallelBond::radius) < 0.9 * whole);
    return smaller;
  };
  const auto one = drawn(1), two = drawn(2);
  const auto count = [](const std::vector<bool>& v) { return double(std::count(v.begin(), v.end(), true)); };
  CHECK(one != two);
  CHECK(one == drawn(1));
  CHECK(std::abs(count(one) / double(one.size()) - 0.3) < 4 * std::sqrt(0.21 / double(one.size())));
  // Drawn beside cement of the same share and seed, not the same bonds again.
  protocol::Cementation cement;
  cement.gap = 0.1, cement.share = 0.3, cement.seed = 1;
  cement.young_modulus = cement.tensile_strength = cement.cohesion = 1e6;
  Rve bare = rve;
  bare.set_interactions({});
  bare.set_interactions(protocol::cemented(bare, cement));
  double again = 0;
  for (const Bond& b : bonds_after(bare, d)) again += column(b, ParallelBond::radius) < 0.9 * whole;
  const double cemented = double(bonds_of(bare).size());
  CHECK(std::abs(again / cemented - 0.3) < 4 * std::sqrt(0.21 / cemented));
  d.material = "sandd";
  CHECK_THROWS_WITH(protocol::dissolved(rve, d, 0, 1), Contains("\"sandd\"") && Contains("other"));
}

TEST_CASE("a crystal in tension lengthens as its sections fall", "[dissolve]") {
  for (const Shape shape : {Shape::disc, Shape::sphere}) {
    INFO(name(shape));
    const bool plane = dimension_of(shape) == 2;
    Rve rve = loose_crystal(shape, 4);
    const Matrix3 stretch =
        1e-4 * Matrix3::Identity() - (plane ? 1e-4 : 0) * Vector3::UnitZ() * Vector3::UnitZ().transpose();
    rve.apply(stretch, 0);
    const auto protocol = dissolving("radius_left = 0.5\nstep_count = 4\nstress_tolerance = 1e-5\nunbalanced = 1e-8\n",
                                     "\"bonds\", \"bond_released_energy_J\"");
    const protocol::TestRun run = protocol::run_protocol(protocol, rve.specimen());
    REQUIRE(run.result.records.size() == 5);
    for (int k = 0; k <= 4; ++k) {
      const records::Record& record = run.result.records[std::size_t(k)];
      CHECK(largest(record.stress - run.result.records.front().stress) < 2e-5 * largest(record.stress));
      // Bonds of stiffness E A/(r_i + r_j) side by side: strain at one stress goes as 1/A.
      const double left = 1 - 0.125 * k, area = plane ? left : left * left;
      CHECK(record.deformation_gradient(0, 0) * (1 + 1e-4) - 1 == Approx(1e-4 / area).epsilon(2e-3));
      CHECK(record.bonds == double(bonds_of(rve).size()));
    }
    // Under a held stress the work of it feeds both what is stored and what dissolves: half of it is stored.
    CHECK(run.result.records.back().bond_released_energy > 0);
    const double stiffness = elastic_tangent(Rve(run.end_state).network())(0, 0);
    CHECK(stiffness == Approx(elastic_tangent(rve.network())(0, 0) * (plane ? 0.5 : 0.25)).epsilon(1e-3));
  }
}

TEST_CASE("strength that falls breaks what is loaded, and held stress goes on to be borne", "[dissolve]") {
  for (const Shape shape : {Shape::disc, Shape::sphere}) {
    INFO(name(shape));
    Rve rve = bonded_packing(shape, 5e5);
    rve.apply(shape == Shape::disc ? gradient(-1e-3, 0, 0, -1.5e-3) : Matrix3(-1e-3 * Matrix3::Identity()), 0);
    REQUIRE(rve.relax(1e-7, 1'000'000).target_held);
    const double first = double(bonds_of(rve).size());
    for (const char* hold : {"stress", "axial_stress", "strain"}) {
      INFO(hold);
      const auto protocol = dissolving("strength_left = 0\nstep_count = 6\nhold = \"" + std::string(hold) + "\"\n",
                                       "\"bonds\", \"bonds_broken_in_tension\", \"bonds_broken_in_shear\", "
                                       "\"bond_released_energy_J\"");
      const protocol::TestRun run = protocol::run_protocol(protocol, rve.specimen());
      const records::Record &start = run.result.records.front(), &end = run.result.records.back();
      CHECK(end.bonds < 0.5 * first);
      const int axis = rve.cell().dimension - 1;
      const double p = pressure(start.stress, rve.cell().dimension);
      for (const records::Record& record : run.result.records) {
        CHECK(record.bonds + record.bonds_broken_in_tension + record.bonds_broken_in_shear == first);
        CHECK(record.unbalanced_force_ratio <= 1e-5);
        const Matrix3 change = record.stress - start.stress, moved = record.deformation_gradient - Matrix3::Identity();
        if (hold != std::string("strain")) CHECK(std::abs(change(axis, axis)) < 1.01e-3 * p * 2);
        if (hold == std::string("stress")) CHECK(std::abs(change(0, 0)) < 1.01e-3 * p * 2);
        if (hold != std::string("stress")) CHECK(std::abs(moved(0, 0)) < 1e-14);
        if (hold == std::string("strain")) CHECK(largest(moved) < 1e-14);
      }
      CHECK(end.bond_released_energy > start.bond_released_energy);
      if (hold == std::string("strain")) CHECK(std::abs(end.stress(0, 0) - start.stress(0, 0)) > 1e-3 * p);
      if (hold != std::string("strain")) CHECK(end.strain > 0);  // it settles
    }
  }
}

TEST_CASE("a dissolution is gone on with from any of its moments", "[dissolve]") {
  Rve rve = bonded_packing(Shape::disc, 5e5);
  rve.apply(gradient(-1e-3, 0, 0, -1.5e-3), 0);
  const auto protocol =
      dissolving("strength_left = 0.1\nradius_left = 0.4\nstep_count = 4\nshare = 0.8\n", "\"bonds\"");
  std::vector<std::pair<records::Checkpoint, records::TestResult>> stops;
  protocol::Watch watch;
  watch.on_path_point = [&](const protocol::PathPoint& at) { stops.emplace_back(at.checkpoint(), at.result); };
  const protocol::TestRun whole = protocol::run_protocol(protocol, rve.specimen(), watch);
  REQUIRE(stops.size() >= 6);
  for (const auto& [checkpoint, result] : stops) {
    const protocol::TestRun run = protocol::resume_protocol(protocol, checkpoint, result);
    CHECK(differences(run.end_state, whole.end_state) == 0);
    CHECK(run.result.records.size() == whole.result.records.size());
    CHECK(same_bits(run.result.records.back().stress, whole.result.records.back().stress));
  }
}

TEST_CASE("a dissolution that cannot be says why", "[dissolve]") {
  const Rve rve = loose_crystal(Shape::disc, 4);
  CHECK_THAT(refusal_of("", rve), Contains("radius_left") && Contains("strength_left"));
  CHECK_THAT(refusal_of("radius_left = 0\n", rve), Contains("radius_left = 0") && Contains("allowed"));
  CHECK_THAT(refusal_of("radius_left = 0.5\naxis = \"y\"\n", rve), Contains("axis") && Contains("axial_stress"));
  CHECK_THAT(refusal_of("radius_left = 0.5\nmaterial = \"mud\"\n", rve), Contains("mud") && Contains("other"));
  CHECK_THAT(refusal_of("radius_left = 0.5\nhold = \"axial_stress\"\naxis = \"z\"\n", rve), Contains("z"));
  Rve bare = rve;
  bare.set_interactions({});
  bare.apply(gradient(-0.1, 0, 0, -0.1), 0);
  CHECK_THAT(refusal_of("radius_left = 0.5\n", bare), Contains("bond") && Contains("cement"));
}
