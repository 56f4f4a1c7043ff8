// Beams of bonded grains against beam theory. Grains clamp and load them whose mass no force moves: nothing else in a
// periodic cell can.
//
// A chain of equal grains, a apart, is a cantilever. A load P at its end gives each bond the shear force P and bond b,
// whose middle is at (b - 1/2) a, the moment P (L - (b - 1/2) a). The spring of the bond turns its ends by M/(kn I)
// against each other, its slip is P/(ks A), and
//   theta_b - theta_(b-1) = M_b/(kn I),   v_b - v_(b-1) = P/(ks A) + a (theta_(b-1) + theta_b)/2
// Summed, with EI = kn I a, at each grain exactly
//   theta = P/EI (x L - x^2/2),   v = P/EI (x^2 L/2 - x^3/6) + P x/GA,   1/GA = 1/(ks A a) - a^2/(12 EI)
// which is Timoshenko's beam. Euler and Bernoulli's is the first term of v.
//
// A square lattice under a moment keeps its sections plane; its bonds across the axis carry nothing, and
//   M = EI theta', EI = a (kn A sum of y^2 + number of layers times kn I),   v = theta' (x^2 - x L)/2
#include "tests/interaction/bonded.hpp"

using namespace rvelab;
using namespace rvelab::test;

namespace {

constexpr double a = 1, beam_grain = 0.45, cement_radius = 0.3, beam_kn = 2e6, beam_ks = 0.2e6;

struct Beam {
  Specimen specimen;
  std::vector<std::size_t> held;  ///< grains that no force moves

  explicit Beam(Shape shape) : specimen(empty_specimen(shape, 40, linear_material(1e6, 1e6, 0.5))) {
    specimen.materials.push_back(specimen.materials.front());
    specimen.materials.front().density = 1;
    specimen.materials.back().density = 1e30;
    specimen.damping.local = 0.5;
  }

  std::size_t add(const Vector3& position, bool hold) {
    if (hold) held.push_back(specimen.grains.size());
    add_grain(specimen, position, beam_grain, hold ? 1 : 0);
    return specimen.grains.size() - 1;
  }
  /// To be called in the order of (i, j).
  std::size_t bond(std::size_t i, std::size_t j) {
    Bond made;
    made.i = std::int32_t(i), made.j = std::int32_t(j);
    double columns[interaction_columns<ParallelBond>()] = {};
    columns[ParallelBond::length] = (specimen.grains.position[j] - specimen.grains.position[i]).norm();
    columns[ParallelBond::radius] = cement_radius;
    columns[ParallelBond::normal_stiffness] = beam_kn;
    columns[ParallelBond::shear_stiffness] = beam_ks;
    columns[ParallelBond::tensile_strength] = columns[ParallelBond::cohesion] = 1e30;
    columns[ParallelBond::moment_factor] = 1;
    take_columns<ParallelBond>(columns, made);
    bonds_of(specimen).push_back(made);
    return bonds_of(specimen).size() - 1;
  }
};

void set_column(Bond& bond, int k, double value) {
  double columns[interaction_columns<ParallelBond>()];
  put_columns<ParallelBond>(bond, columns);
  columns[k] = value;
  take_columns<ParallelBond>(columns, bond);
}
bool any_broken(const Rve& rve) {
  const auto bonds = bonds_of(rve);
  return std::any_of(bonds.begin(), bonds.end(), [](const Bond& b) { return column(b, ParallelBond::broken) != 0; });
}

/// Lets `steps` critical steps go by, one after the other; false as soon as a bond is broken.
bool stands(Rve& rve, int steps) {
  const double step = rve.critical_time_step();
  for (int k = 0; k < steps; ++k) {
    rve.apply(Matrix3::Zero(), step);
    if (any_broken(rve)) return false;
  }
  return true;
}

/// Lets the beam come to rest; false if a bond breaks first.
bool settle(Rve& rve, const Beam& beam, double force_scale) {
  for (int k = 0; k < 20'000; ++k) {
    if (!stands(rve, 50)) return false;
    double unbalanced = 0;
    const Network net = rve.network();
    for (std::size_t g = 0; g < net.grains.size(); ++g)
      if (std::find(beam.held.begin(), beam.held.end(), g) == beam.held.end())
        unbalanced = std::max({unbalanced, net.grains[g].resultant.norm(), net.grains[g].torque.norm() / a});
    if (unbalanced < 1e-8 * force_scale) return true;
  }
  FAIL("the beam does not come to rest");
  return false;
}

std::vector<Vector3> displacements(const Rve& rve, const Beam& beam) {
  std::vector<Vector3> u = rve.specimen().grains.position;
  for (std::size_t g = 0; g < u.size(); ++g) u[g] -= beam.specimen.grains.position[g];
  return u;
}

/// A chain along x, held at its first grain. Its last one hangs on a grain that is held below it, by a bond that is
/// soft, and so thin that it is a thread: its tension is the load.
struct Cantilever : Beam {
  static constexpr double thread_stiffness = 10;  // N/m
  int n;                                          ///< bonds of the chain; bond b joins grains b - 1 and b
  std::size_t thread;

  Cantilever(Shape shape, int count) : Beam(shape), n(count) {
    for (int k = 0; k <= n; ++k) add({(k - 0.5 * n) * a, 0, 0}, k == 0);
    const std::size_t anchor = add({0.5 * n * a, -1.5 * a, 0}, true);
    for (int k = 1; k <= n; ++k) bond(std::size_t(k - 1), std::size_t(k));
    thread = bond(std::size_t(n), anchor);
    Bond& b = bonds_of(specimen)[thread];
    const double thin = 1e-6;
    set_column(b, ParallelBond::radius, thin);
    set_column(b, ParallelBond::normal_stiffness, thread_stiffness / section_of(shape, thin).area);
    set_column(b, ParallelBond::shear_stiffness, 0);
  }
  double branch(const Rve& rve) const {
    const std::vector<Vector3> x = rve.specimen().grains.position;
    return (x[std::size_t(n) + 1] - x[std::size_t(n)]).norm();
  }
  double load(const Rve& rve) const {
    return thread_stiffness * (branch(rve) - column(bonds_of(rve)[thread], ParallelBond::length));
  }
  /// At the tip where it is now.
  void pull(Rve& rve, double load) const {
    Interactions all = rve.interactions();
    set_column(bonds_of(all)[thread], ParallelBond::length, branch(rve) - load / thread_stiffness);
    rve.set_interactions(all);
  }
};

/// Raises the load, in the end by a hundredth of `expected` each time, until a bond breaks; that bond.
std::size_t broken_by(Rve& rve, const Cantilever& beam, double expected) {
  const double step = 0.01 * expected;
  double held = 0;  // the largest load that the beam stood
  for (double load = 0.05 * expected; load < 1.1 * expected; load += load < 0.9 * expected ? 5 * step : step) {
    beam.pull(rve, load);
    const bool stood = settle(rve, beam, expected);
    if (!stood) break;
    held = beam.load(rve);
    CHECK(held < expected);
  }
  CHECK(any_broken(rve));
  CHECK(held > expected - 1.5 * step);
  const auto bonds = bonds_of(rve);
  std::size_t which = bonds.size();
  for (std::size_t b = 0; b < bonds.size(); ++b)
    if (column(bonds[b], ParallelBond::broken) != 0) {
      CHECK(which == bonds.size());  // one only
      which = b;
    }
  return which;
}

}  // namespace

TEST_CASE("a cantilever of bonded grains bends as Timoshenko's beam", "[bond]") {
  for (const Shape shape : {Shape::disc, Shape::sphere})
    for (const int n : {3, 12}) {
      INFO(name(shape) << ", " << n << " bonds");
      const Cantilever beam(shape, n);
      const Section section = section_of(shape, cement_radius);
      const double L = n * a, EI = beam_kn * section.inertia * a;
      const double GA = 1 / (1 / (beam_ks * section.area * a) - a * a / (12 * EI));
      Rve rve(beam.specimen);
      beam.pull(rve, 1e-3 * L * 3 * EI / (L * L * L));  // a deflection of some thousandth of its length
      REQUIRE(settle(rve, beam, beam.load(rve)));
      const double P = beam.load(rve);
      const std::vector<Vector3> u = displacements(rve, beam);
      const auto bonds = bonds_of(rve);
      const auto euler = [&](double x) { return P / EI * (x * x * L / 2 - x * x * x / 6); };
      for (int k = 1; k <= n; ++k) {
        INFO("grain " << k);
        const double x = k * a, middle = x - 0.5 * a;
        CHECK(-u[std::size_t(k)][1] == Approx(euler(x) + P * x / GA).epsilon(1e-4));
        const Bond& b = bonds[std::size_t(k - 1)];
        CHECK(triple(b, ParallelBond::bending_moment)[2] == Approx(P * (L - middle)).epsilon(1e-4));
        CHECK(triple(b, ParallelBond::shear_force)[shape == Shape::disc ? 0 : 1] == Approx(P).epsilon(1e-4));
      }
      // Euler and Bernoulli's alone is 4 to 7 % short of three bonds.
      const double shear_share = 1 - euler(L) / -u[std::size_t(n)][1];
      CHECK(shear_share == Approx(1 / (1 + GA * L * L / (3 * EI))).margin(1e-4));
      if (n == 3) CHECK(shear_share > 0.04);
    }
}

TEST_CASE("a cantilever of bonded grains breaks at the load, the bond and by the mode of beam theory", "[bond]") {
  for (const Shape shape : {Shape::disc, Shape::sphere}) {
    INFO(name(shape));
    const int n = 8;
    const Section section = section_of(shape, cement_radius);
    {
      // The moment is largest in the bond at the clamp: M R/I = tensile strength.
      Cantilever beam(shape, n);
      const double strength = 1e3, lever = (n - 0.5) * a;
      for (int b = 0; b < n; ++b)
        set_column(bonds_of(beam.specimen)[std::size_t(b)], ParallelBond::tensile_strength, strength);
      Rve rve(beam.specimen);
      const double expected = strength * section.inertia / (cement_radius * lever);
      const std::size_t which = broken_by(rve, beam, expected);
      REQUIRE(which == 0);
      const Bond broken = bonds_of(rve)[0];
      CHECK(column(broken, ParallelBond::broken) == 1);
      const double moment = expected * lever;
      const double energy =
          0.5 * moment * moment / (beam_kn * section.inertia) + 0.5 * expected * expected / (beam_ks * section.area);
      CHECK(column(broken, ParallelBond::released) == Approx(energy).epsilon(0.03));
    }
    // The shear force is the same everywhere: the weakest breaks, P/A = cohesion.
    Cantilever beam(shape, n);
    const double cohesion = 2;
    for (int b = 0; b < n; ++b)
      set_column(bonds_of(beam.specimen)[std::size_t(b)], ParallelBond::cohesion, b == 5 ? cohesion : 2 * cohesion);
    Rve rve(beam.specimen);
    REQUIRE(broken_by(rve, beam, cohesion * section.area) == 5);
    CHECK(column(bonds_of(rve)[5], ParallelBond::broken) == 2);
  }
}

namespace {

/// A square lattice, its end sections held: m layers over y, and two over z in space.
struct LatticeBeam : Beam {
  int n, m, depth;
  std::vector<std::vector<std::size_t>> along;  ///< bonds along x between columns k and k + 1, by k

  LatticeBeam(Shape shape, int columns, int layers)
      : Beam(shape), n(columns), m(layers), depth(dimension_of(shape) == 2 ? 1 : 2), along(std::size_t(columns)) {
    for (int k = 0; k <= n; ++k)
      for (int j = 0; j < m; ++j)
        for (int l = 0; l < depth; ++l)
          add({(k - 0.5 * n) * a, (j - 0.5 * (m - 1)) * a, (l - 0.5 * (depth - 1)) * a}, k == 0 || k == n);
    for (int k = 0; k <= n; ++k)
      for (int j = 0; j < m; ++j)
        for (int l = 0; l < depth; ++l) {
          if (l + 1 < depth) bond(at(k, j, l), at(k, j, l + 1));
          if (j + 1 < m) bond(at(k, j, l), at(k, j + 1, l));
          if (k < n) along[std::size_t(k)].push_back(bond(at(k, j, l), at(k + 1, j, l)));
        }
  }
  std::size_t at(int k, int j, int l) const { return std::size_t((k * m + j) * depth + l); }

  /// Turns the end sections by -turn/2 and turn/2 about z, in `steps` critical steps; false if a bond breaks.
  bool bend(Rve& rve, double turn, int steps) const {
    const auto move = [&](double rate) {
      Grains now = rve.specimen().grains;
      for (const std::size_t g : held) {
        const double w = (specimen.grains.position[g][0] < 0 ? -0.5 : 0.5) * rate;
        now.spin[g] = {0, 0, w};
        now.velocity[g] = {-w * specimen.grains.position[g][1], 0, 0};
      }
      rve.set_velocities(now.velocity, now.spin);
    };
    move(turn / (steps * rve.critical_time_step()));
    if (!stands(rve, steps)) return false;
    move(0);
    return true;
  }
};

}  // namespace

TEST_CASE("a beam of layers keeps its sections plane, and breaks in its outermost layer", "[bond]") {
  for (const Shape shape : {Shape::disc, Shape::sphere})
    for (const int m : {2, 5}) {
      INFO(name(shape) << ", " << m << " layers");
      const int n = 12;
      const Section section = section_of(shape, cement_radius);
      LatticeBeam beam(shape, n, m);
      const double height = 0.5 * (m - 1) * a, L = n * a;
      double EI = 0;
      for (int j = 0; j < m; ++j)
        EI += beam.depth * a * beam_kn * (section.area * std::pow((j - 0.5 * (m - 1)) * a, 2) + section.inertia);
      {
        Rve rve(beam.specimen);
        const double turn = 1e-4, curvature = turn / L;
        REQUIRE(beam.bend(rve, turn, 1000));
        REQUIRE(settle(rve, beam, EI * curvature / a));
        const std::vector<Vector3> u = displacements(rve, beam), x0 = beam.specimen.grains.position;
        for (std::size_t g = 0; g < u.size(); ++g) {
          const double x = x0[g][0] + 0.5 * L, y = x0[g][1];
          const double deflection = 0.5 * curvature * (x * x - x * L), scale = curvature * L * L / 8;
          CHECK(std::abs(u[g][1] - deflection) < 1e-3 * scale);
          CHECK(std::abs(u[g][0] + y * curvature * (x - 0.5 * L)) < 1e-3 * scale);
        }
        const auto bonds = bonds_of(rve);
        for (const auto& section_bonds : beam.along) {
          double moment = 0;
          for (const std::size_t b : section_bonds) {
            const std::size_t i = std::size_t(bonds[b].i), j = std::size_t(bonds[b].j);
            const double stretch = (x0[j] + u[j] - x0[i] - u[i]).norm() - a;
            moment -= beam_kn * section.area * stretch * x0[i][1] + triple(bonds[b], ParallelBond::bending_moment)[2];
          }
          CHECK(moment == Approx(EI * curvature).epsilon(1e-3));
        }
      }
      // Tension at the rim of the lowest layer: kn a theta' (height + R) = strength, first in the bond that is weaker.
      const double strength = 100;
      for (Bond& b : bonds_of(beam.specimen)) set_column(b, ParallelBond::tensile_strength, strength);
      const std::size_t weak = beam.along[4].front();
      REQUIRE(beam.specimen.grains.position[std::size_t(bonds_of(beam.specimen)[weak].i)][1] == -height);
      set_column(bonds_of(beam.specimen)[weak], ParallelBond::tensile_strength, 0.97 * strength);
      const double expected = 0.97 * strength / (beam_kn * a * (height + cement_radius)) * L, step = 0.01 * expected;
      Rve rve(beam.specimen);
      double turn = 0.9 * expected;
      REQUIRE(beam.bend(rve, turn, 4000));
      while (settle(rve, beam, EI * expected / L)) {
        CHECK(turn < expected);
        turn += step;
        if (!beam.bend(rve, step, 500)) break;
      }
      CHECK(turn > expected - 0.5 * step);
      CHECK(turn < expected + 1.5 * step);
      const auto bonds = bonds_of(rve);
      for (std::size_t b = 0; b < bonds.size(); ++b) {
        INFO("bond " << b);
        CHECK(column(bonds[b], ParallelBond::broken) == (b == weak ? 1 : 0));
      }
    }
}
