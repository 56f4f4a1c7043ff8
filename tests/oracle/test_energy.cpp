// The energy balance at dt > 0 (solver/README.md): change of elastic and kinetic energy = boundary work less all
// losses.
//
// Kinetic energy is the mean of the two half steps about the state, with v' and the whole spin w' + axial(W + Omega).
// The residual is a matter of the time step alone. It falls as dt^2 for normal forces. Tangential springs are stretched
// along the tangent at the end of a step (as everywhere in DEM), which leaves a part that falls as dt; so do dashpots,
// whose velocity is half a step old, sliding and damping.
#include <array>
#include <map>
#include <tuple>

#include "rvelab/measure/measures.hpp"
#include "rvelab/specimen/field_layout.hpp"
#include "tests/specimens.hpp"

using namespace rvelab;
using namespace rvelab::test;

namespace {

double kinetic(const Network& n, const Vector3& mean_spin) {
  double sum = 0;
  for (const GrainState& g : n.grains)
    sum += 0.5 * (g.mass * g.velocity.squaredNorm() + g.inertia * (g.spin + mean_spin).squaredNorm());
  return sum;
}

struct Energies {
  double stored = 0, work = 0, lost = 0;
};

/// Energies of a state in steady flow at `rate` (1/s): a copy goes one step on to give the second half step.
Energies energies(const Rve& rve, const Matrix3& rate, double dt) {
  Rve next(rve);
  next.apply(rate * dt, dt);
  const Vector3 spin = 0.5 * Vector3(rate(2, 1) - rate(1, 2), rate(0, 2) - rate(2, 0), rate(1, 0) - rate(0, 1));
  const Network a = rve.network(), b = next.network();
  const EnergyTerms l = rve.specimen().state.energy_balance;
  return {elastic_energy(a) +
              0.5 * (kinetic(a, a.cell.rotation.transpose() * spin) + kinetic(b, b.cell.rotation.transpose() * spin)),
          l.boundary_work,
          l.friction + l.rolling + l.dashpot + l.local_damping + l.global_damping + l.law_loss + l.removed_kinetic};
}

struct Flow {
  std::array<double, 5> residual{};  ///< J, at dt, dt/2, ... dt/16
  double work = 0;                   ///< J, at the smallest step
  EnergyTerms energy_balance;
  double largest = 0;  ///< largest residual
};

/// The specimen at rest, prepared without damping, dashpot and rolling; made once for all tests that share it.
Specimen resting(const Specimen& s) {
  using Key = std::tuple<Shape, Law, double, double>;
  static std::map<Key, Specimen> known;
  const Key key(s.shape, s.contact.law, s.materials[0].friction, s.materials[0].tangential_stiffness);
  if (known.count(key) == 0) {
    Specimen quiet = s;
    quiet.damping = {};
    quiet.contact.rolling = false;
    quiet.solver.energy_balance = true;
    known[key] = at_rest(quiet, 1e-8).specimen();
  }
  return known[key];
}

/// Strain `strain` at rate `pattern` over 64 steps of a quarter of the critical one, from rest.
Flow flow(const Specimen& s, const Matrix3& pattern, double strain) {
  Specimen start = resting(s);
  start.contact = s.contact;
  start.damping = s.damping;
  start.state.energy_balance = {};
  const double step = 0.25 * Rve(start).critical_time_step(), count = 64;
  const Matrix3 rate = strain / (count * step) * pattern;
  Flow found;
  for (int halving = 0; halving < 5; ++halving) {
    const double dt = step / (1 << halving);
    start.solver.fixed_time_step = dt * (1 + 1e-9);
    Rve rve(start);
    rve.apply(rate * step, step);
    const Energies before = energies(rve, rate, dt);
    for (int k = 0; k < count; ++k) rve.apply(rate * step, step);
    const Energies after = energies(rve, rate, dt);
    found.work = after.work - before.work;
    found.residual[std::size_t(halving)] = (after.stored - before.stored) - found.work + (after.lost - before.lost);
    found.largest = std::max(found.largest, std::abs(found.residual[std::size_t(halving)]));
    found.energy_balance = rve.specimen().state.energy_balance;
  }
  return found;
}

/// Extrapolated to no time step at all nothing is left, and at dt/16 not much. "Nothing" is a tenth of the largest
/// residual or, where all of them are small, a fiftieth of what is allowed.
void check_closed(const Flow& f, double share_of_work) {
  INFO("residuals " << f.residual[0] << " " << f.residual[1] << " " << f.residual[2] << " " << f.residual[3] << " "
                    << f.residual[4] << " J of work " << f.work);
  CHECK(std::abs(f.residual[4]) < share_of_work * std::abs(f.work));
  CHECK(std::abs(2 * f.residual[4] - f.residual[3]) <
        std::max(0.1 * f.largest, 0.02 * share_of_work * std::abs(f.work)));
  CHECK(std::abs(f.residual[4]) < 0.6 * std::abs(f.largest));
}

Material material(double friction, double rolling_friction) {
  Material m = linear_material(2e6, 1e6, friction);
  m.young_modulus = 2e8;
  m.poisson_ratio = 0.2;
  m.roughness = 2e-5;
  m.cone_slope = 0.05;
  m.rolling_stiffness = 0.8;
  m.rolling_friction = rolling_friction;
  return m;
}

Specimen packing(Shape shape, Law law, double friction = 1e6, double rolling_friction = 1e6) {
  return disordered(shape, dimension_of(shape) == 2 ? 6 : 3, material(friction, rolling_friction), law,
                    shape == Shape::ellipse ? 0.57 : 0.53, 5);  // without friction they find more room
}

/// Shear that the frame follows (no spin of it), or with components below the diagonal: the frame turns.
Matrix3 pattern(Shape shape, bool turning) {
  Matrix3 p = gradient(-0.2, 1, turning ? -0.6 : 0, -0.6);
  if (shape == Shape::sphere) {
    p(0, 2) = -0.4;
    p(2, 2) = 0.3;
  }
  return p;
}

}  // namespace

TEST_CASE("the energy balance of normal forces closes as the square of the time step") {
  const Shape shape = GENERATE(Shape::disc, Shape::sphere, Shape::ellipse);
  const Law law = GENERATE(Law::linear_stiffness, Law::hertz_stiffness);
  const bool turning = GENERATE(false, true);
  CAPTURE(fields::text_of(shape), name(law), turning);
  Specimen s = packing(shape, law);
  s.materials[0].tangential_stiffness = 0;
  const Flow f = flow(s, pattern(shape, turning), 1e-3);
  CHECK(std::abs(f.residual[4]) < 1e-6 * std::abs(f.work));
  // Four to the fourth is 256; where a linear contact opens, its kink falls anywhere within a step.
  const double ratio = f.residual[0] / f.residual[4];
  CAPTURE(ratio);
  CHECK(ratio > 130);
  CHECK(ratio < 500);
}

TEST_CASE("the energy balance of stuck contacts closes") {
  const Shape shape = GENERATE(Shape::disc, Shape::sphere, Shape::ellipse);
  const Law law =
      GENERATE(Law::linear_stiffness, Law::hertz_stiffness, Law::hertz_mindlin, Law::hertz_rough, Law::cones);
  const bool turning = GENERATE(false, true), rolling = GENERATE(false, true);
  CAPTURE(fields::text_of(shape), name(law), turning, rolling);
  Specimen s = packing(shape, law);
  s.contact.rolling = rolling;
  const Flow f = flow(s, pattern(shape, turning), 1e-3);
  check_closed(f, 1e-6);
  // With kt constant nothing is lost; with kt falling as a contact opens, something is.
  CHECK(f.energy_balance.friction == 0);
  CHECK(f.energy_balance.rolling == 0);
  CHECK(f.energy_balance.dashpot == 0);
  if (law == Law::hertz_mindlin || law == Law::hertz_rough || law == Law::cones)
    CHECK(f.energy_balance.law_loss > 0);
  else
    CHECK(f.energy_balance.law_loss == 0);
}

TEST_CASE("the energy balance of dashpots closes with the time step, and they only take") {
  const Shape shape = GENERATE(Shape::disc, Shape::sphere, Shape::ellipse);
  const Law law = GENERATE(Law::linear_stiffness, Law::hertz_mindlin, Law::hertz_rough, Law::cones);
  const bool turning = GENERATE(false, true);
  CAPTURE(fields::text_of(shape), name(law), turning);
  Specimen s = packing(shape, law);
  s.damping.dashpot = Dashpot::restitution;
  s.damping.restitution = 0.5;
  s.damping.tangential_ratio = 0.5;
  const Flow f = flow(s, pattern(shape, turning), 1e-3);
  check_closed(f, 1e-6);
  CHECK(f.energy_balance.dashpot > 1e3 * std::abs(f.residual[4]));
}

TEST_CASE("the energy balance of sliding and rolling contacts closes with the time step") {
  const Shape shape = GENERATE(Shape::disc, Shape::sphere, Shape::ellipse);
  const bool turning = GENERATE(false, true);
  CAPTURE(fields::text_of(shape), turning);
  Specimen s = packing(shape, Law::hertz_stiffness, 0.2, 0.02);
  s.contact.rolling = true;
  const Flow f = flow(s, pattern(shape, turning), 1e-2);
  check_closed(f, 1e-4);
  CHECK(f.energy_balance.friction > 0.01 * f.work);
  CHECK(f.energy_balance.rolling > 1e-3 * f.work);
}

TEST_CASE("the energy balance of viscous and of local damping closes with the time step") {
  const Shape shape = GENERATE(Shape::disc, Shape::sphere, Shape::ellipse);
  const bool local = GENERATE(false, true), global = GENERATE(false, true);
  CAPTURE(fields::text_of(shape), local, global);
  Specimen s = packing(shape, Law::hertz_stiffness);
  s.damping.local = local ? 0.2 : 0;
  s.damping.global_viscous = global ? 2 : 0;
  // A flow without spin: local damping acts on w', which is then the whole spin.
  Matrix3 stretch = gradient(1, 0, 0, -0.6);
  if (shape == Shape::sphere) stretch(2, 2) = -0.7;
  const Flow f = flow(s, stretch, 1e-3);
  check_closed(f, 1e-4);
  CHECK((f.energy_balance.local_damping > 0) == local);
  CHECK((f.energy_balance.global_damping > 0) == global);
}

TEST_CASE("momentum stays zero to round-off without local and viscous damping") {
  const Shape shape = GENERATE(Shape::disc, Shape::sphere, Shape::ellipse);
  Specimen s = packing(shape, Law::hertz_stiffness, 0.3);
  s.damping.dashpot = Dashpot::coefficient;
  s.damping.normal_coefficient = 1;
  s.damping.tangential_ratio = 0.5;
  s.solver.max_overlap_ratio = 0.9;
  Rve rve(s);
  const Matrix3 p = pattern(shape, true);
  for (int k = 0; k < 50; ++k) {
    const double dt = 20 * rve.critical_time_step();
    rve.apply(2e-3 * p, dt);
    Vector3 momentum = Vector3::Zero();
    double scale = 0;
    for (const GrainState& g : rve.network().grains) {
      momentum += g.mass * g.velocity;
      scale += g.mass * g.velocity.norm();
    }
    CHECK(momentum.norm() < 1e-14 * scale);
  }
}
