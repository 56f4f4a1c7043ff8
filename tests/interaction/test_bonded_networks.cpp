// Bonds between many grains: crystals in closed form, the elastic tangent, energy and momentum, trials and restarts,
// cells that are reduced, cement drawn by seed.
#include <map>
#include <random>

#include "rvelab/measure/measures.hpp"
#include "rvelab/measure/probe.hpp"
#include "rvelab/measure/tangent.hpp"
#include "rvelab/pack/repeated.hpp"
#include "tests/interaction/bonded.hpp"

using namespace rvelab;
using namespace rvelab::test;

namespace {

protocol::Cementation beams_of(double strength, double gap = 0.05) {
  protocol::Cementation cement = cement_of(strength, gap);
  cement.shear_ratio = 0.5;
  return cement;
}

/// A square or cubic crystal whose grains lie apart, every neighbour bonded.
Rve crystal(Shape shape, int side, double spacing, double radius, const protocol::Cementation& cement) {
  const bool plane = dimension_of(shape) == 2;
  Specimen s = empty_specimen(shape, side * spacing, linear_material(1e6, 1e6, 0.5));
  for (int k = 0; k < (plane ? 1 : side); ++k)
    for (int j = 0; j < side; ++j)
      for (int i = 0; i < side; ++i) add_grain(s, Vector3(i, j, plane ? 0 : k) * spacing, radius);
  Rve rve(s);
  rve.set_interactions(protocol::cemented(rve, cement));
  return rve;
}

Rve cemented_packing(Shape shape, double strength, Law law = Law::linear_stiffness, double scatter = 0) {
  Material m = material_of_every_law();
  Rve rve = at_rest(disordered(shape, dimension_of(shape) == 2 ? 9 : 5, m, law, 0.51, 5), 1e-9);
  protocol::Cementation cement = beams_of(strength);
  cement.strength_scatter = scatter;
  rve.set_interactions(protocol::cemented(rve, cement));
  return rve;
}

}  // namespace

TEST_CASE("bonded crystals have the elastic constants of their beams", "[bond]") {
  for (const Shape shape : {Shape::disc, Shape::sphere}) {
    INFO(name(shape));
    const bool plane = dimension_of(shape) == 2;
    const double a = 0.01, r = 0.0049;
    const Rve rve = crystal(shape, 4, a, r, beams_of(1e30));
    REQUIRE(bonds_of(rve).size() == (plane ? 2 : 3) * rve.size());
    CHECK(rve.network().contacts.empty());
    const double kn = 1e8 / (2 * r), area = section_of(shape, r).area;
    // A bond along x elongates by a eps: force kn A a eps on the face a t, or a^2. Under gamma each of two slips by
    // gamma a/2 without that a grain turns: stress ks A a (gamma/2) over that face.
    const double face = plane ? a : a * a, axial = kn * area * a / face, shear = 0.25 * kn * area * a / face;
    const Eigen::MatrixXd tangent = elastic_tangent(rve.network());
    const int n = plane ? 2 : 3;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) CHECK(std::abs(tangent(i, j) - (i == j ? axial : 0)) < 1e-8 * axial);
    for (int k = n; k < tangent.rows(); ++k) CHECK(tangent(k, k) == Approx(shear).epsilon(1e-8));
  }
}

TEST_CASE("what bonds alone hold without force is strained in a thousand sub-steps, within the tolerance", "[bond]") {
  for (const Shape shape : {Shape::disc, Shape::sphere}) {
    INFO(name(shape));
    const int side = dimension_of(shape) == 2 ? 8 : 4;
    const double a = 0.01;
    Specimen s = crystal(shape, side, a, 0.004, beams_of(1e30)).specimen();
    static_cast<Interactions&>(s) = {};
    std::mt19937 engine(1);
    for (Vector3& x : s.grains.position)
      for (int k = 0; k < dimension_of(shape); ++k) x[k] += 0.1 * a * (double(engine()) / 4294967296.0 - 0.5);
    Rve rve(s);
    rve.set_interactions(protocol::cemented(rve, beams_of(1e30, 0.9)));
    REQUIRE(contact_stress(rve.network()).norm() < 1e-6);  // Pa
    for (const double strain : {1e-6, 1e-4}) {
      Rve strained(rve);
      const Response made = strained.apply(strain * gradient(0, 0, 1, 0), 0);
      CHECK(made.report.substeps < 1000);
      CHECK(made.report.tolerance_met);
      REQUIRE(strained.relax(1e-6, 1'000'000).target_held);
      const double error = (made.stress - strained.stress()).norm();
      CHECK(error <= made.report.error_estimate);
      CHECK(error < 1e-2 * strained.stress().norm());
    }
  }
}

TEST_CASE("the elastic tangent of cemented packings is what small steps measure", "[bond]") {
  for (const Shape shape : {Shape::disc, Shape::sphere}) {
    INFO(name(shape));
    Rve rve = cemented_packing(shape, 1e30);
    rve.apply(gradient(-1e-5, 2e-5, 0, 0), 0);
    REQUIRE(rve.relax(1e-9, 2'000'000).target_held);
    Rve stuck(rve);
    std::vector<Material> materials = rve.specimen().materials;
    for (Material& m : materials) m.friction = 1e6;
    stuck.set_materials(materials);
    const Eigen::MatrixXd tangent = elastic_tangent(stuck.network()), measured = probe_stiffness(stuck, 1e-7).stiffness;
    CHECK((tangent - measured).norm() < 2e-3 * measured.norm());
  }
}

TEST_CASE("bonds conserve energy and momentum, and what breaks gives up what it held", "[bond]") {
  for (const Shape shape : {Shape::disc, Shape::sphere}) {
    for (const double strength : {1e30, 5e4}) {
      INFO(name(shape) << ", strength " << strength);
      double lost[2];
      for (int fine = 0; fine < 2; ++fine) {
        Specimen s = cemented_packing(shape, strength).specimen();
        s.damping.local = 0;
        s.materials.front().friction = 1e6;  // nothing else takes energy
        s.materials.front().rolling_friction = 1e6;
        Rve plain(s);
        s.solver.fixed_time_step = plain.critical_time_step() / (fine == 0 ? 20 : 80);
        Rve rve(s);
        std::mt19937_64 generator(1);
        std::vector<Vector3> v, w;
        for (std::size_t g = 0; g < rve.size(); ++g) {
          const auto number = [&] { return double(generator() >> 11) / 9007199254740992.0 - 0.5; };
          v.push_back({number(), number(), s.cell.dimension == 3 ? number() : 0.0});
          w.push_back(s.cell.dimension == 3 ? Vector3(number(), number(), number()) * 100
                                            : Vector3(0, 0, 100 * number()));
        }
        rve.set_velocities(v, w);
        const auto energy = [&] {
          const Network net = rve.network();
          double sum = elastic_energy(net) + kinetic_energy(net);
          for (const Bond& bond : bonds_of(rve)) sum += column(bond, ParallelBond::released);
          return sum;
        };
        rve.apply(Matrix3::Zero(), plain.critical_time_step());
        const double before = energy();
        rve.apply(Matrix3::Zero(), 40 * plain.critical_time_step());
        lost[fine] = std::abs(energy() / before - 1);
        if (strength < 1e30) {
          const auto bonds = bonds_of(rve);
          CHECK(std::any_of(bonds.begin(), bonds.end(),
                            [](const Bond& b) { return column(b, ParallelBond::broken) > 0; }));
        }
        Vector3 momentum = Vector3::Zero(), force = Vector3::Zero();
        for (const GrainState& g : rve.network().grains) momentum += g.mass * g.velocity, force += g.resultant;
        CHECK(momentum.norm() < 1e-9 * rve.network().grains.front().mass);
        CHECK(force.norm() < 1e-9 * rve.network().grains.front().resultant.norm());
      }
      CHECK(lost[0] < 2e-2);
      CHECK(lost[1] < 2e-3);
    }
  }
}

TEST_CASE("trials, restarts and snapshots carry bonds bit by bit", "[bond]") {
  for (const Shape shape : {Shape::disc, Shape::sphere})
    for (const double dt : {0.0, 1e-3}) {
      INFO(name(shape));
      // Lists are made anew and lattices reduced on the way.
      const Rve end = after_path_bit_by_bit(cemented_packing(shape, 2e5, Law::hertz_mindlin, 0.5),
                                            gradient(-2e-3, 3e-2, 1e-2, 1e-3), dt, 12);
      const auto bonds = bonds_of(end);
      CHECK(std::any_of(bonds.begin(), bonds.end(), [](const Bond& b) { return column(b, ParallelBond::broken) > 0; }));
    }
}

TEST_CASE("bonds follow grains through reduced lattices and wrapped cells", "[bond]") {
  for (const Shape shape : {Shape::disc, Shape::sphere}) {
    INFO(name(shape));
    Rve rve = cemented_packing(shape, 3e6);
    Matrix3 step = gradient(0, 0.05, 0, 0);
    if (shape == Shape::sphere) step(0, 2) = 0.03;
    const std::size_t count = bonds_of(rve).size();
    for (int k = 0; k < 40; ++k) rve.apply(step, 0);
    const Specimen s = rve.specimen();
    const auto bonds = bonds_of(rve);
    REQUIRE(bonds.size() == count);
    std::size_t intact = 0;
    for (const Bond& b : bonds) {
      if (column(b, ParallelBond::broken) != 0) continue;
      ++intact;
      const double branch =
          (s.grains.position[std::size_t(b.j)] + translation(s.cell, b.image) - s.grains.position[std::size_t(b.i)])
              .norm();
      // Of a strength of 3e6 Pa at kn = 1e8/(r_i + r_j): an elongation of a thirtieth of the branch at most.
      CHECK(branch < 1.035 * column(b, ParallelBond::length));
    }
    CHECK(intact > 0);
    CHECK(intact < count);
  }
}

TEST_CASE("a repeated cell has the bonds of each copy", "[bond]") {
  for (const Shape shape : {Shape::disc, Shape::sphere}) {
    INFO(name(shape));
    Rve one = cemented_packing(shape, 1e30);
    one.apply(gradient(-1e-4, 2e-4, 0, 1e-4), 0);
    const Rve all(pack::repeated(one.specimen(), {2, 3, shape == Shape::disc ? 1 : 2}));
    CHECK(bonds_of(all).size() == bonds_of(one).size() * (all.size() / one.size()));
    CHECK(largest(all.contact_stress() - one.contact_stress()) < 1e-10 * largest(one.contact_stress()));
    const double copies = double(all.size() / one.size());
    CHECK(elastic_energy(all.network()) == Approx(copies * elastic_energy(one.network())).epsilon(1e-10));
  }
}

TEST_CASE("cement is drawn by seed, ids and share, and its strength by Weibull's distribution", "[bond]") {
  const Rve rve =
      at_rest(disordered(Shape::sphere, 8, linear_material(2e6, 1e6, 0.3), Law::linear_stiffness, 0.51, 9), 1e-5);
  const auto made = [&](protocol::Cementation cement) {
    Interactions all = protocol::cemented(rve, cement);
    return bonds_of(all);
  };
  protocol::Cementation cement = beams_of(1e6, 0);
  const auto touching = made(cement);
  CHECK(touching.size() == rve.network().contacts.size());
  cement.share = 0.4;
  cement.seed = 7;
  const double part = double(made(cement).size()) / double(touching.size());
  CHECK(std::abs(part - 0.4) < 4 * std::sqrt(0.24 / double(touching.size())));
  cement.seed = 8;
  CHECK(std::abs(double(made(cement).size()) / double(touching.size()) - part) > 0);
  cement = beams_of(1e6, 0.1);
  const auto wide = made(cement);
  CHECK(wide.size() > touching.size());
  // Of modulus m the squared mean is Gamma(1 + 1/m)^2, the mean square Gamma(1 + 2/m).
  const double scatter = std::sqrt(std::tgamma(1.5) / std::pow(std::tgamma(1.25), 2) - 1);
  cement.strength_scatter = scatter;
  CHECK(protocol::weibull_modulus(scatter) == Approx(4).epsilon(1e-9));
  double mean = 0, squares = 0;
  for (const Bond& b : made(cement)) {
    const double strength = column(b, ParallelBond::tensile_strength) / 1e6;
    mean += strength / double(wide.size());
    squares += strength * strength / double(wide.size());
    CHECK(column(b, ParallelBond::cohesion) == column(b, ParallelBond::tensile_strength));
  }
  CHECK(std::abs(mean - 1) < 4 * scatter / std::sqrt(double(wide.size())));
  CHECK(std::sqrt(squares - mean * mean) == Approx(scatter).epsilon(0.15));
}

TEST_CASE("bonds that cannot be are refused by name", "[bond]") {
  Rve rve = crystal(Shape::disc, 3, 0.01, 0.0049, beams_of(1e6));
  const std::vector<std::byte> before = rve.save();
  const auto refused = [&](const auto& spoil, const std::string& word) {
    Interactions all = rve.interactions();
    spoil(bonds_of(all));
    CHECK_THROWS_WITH(rve.set_interactions(all), Catch::Contains(word));
    CHECK(rve.save() == before);
  };
  refused([](auto& b) { b[1].j = 99; }, "bonds/j[1] = 99");
  refused([](auto& b) { b[2] = b[1]; }, "stands twice");
  refused([](auto& b) { std::swap(b[0], b[3]); }, "out of order");
  refused([](auto& b) { b[0].j = b[0].i, b[0].image = {}; }, "bonds");
  refused([](auto& b) { static_cast<FieldOf<ParallelBond, 1>&>(b[0]).value = -1; }, "bonds/radius_m[0]");
  refused([](auto& b) { static_cast<FieldOf<ParallelBond, 9>&>(b[0]).value = std::nan(""); },
          "bonds/released_energy_J[0]");
}
