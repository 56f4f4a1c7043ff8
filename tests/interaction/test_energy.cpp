// The energy balance of specimens with interactions (solver/README.md): elastic and kinetic energy change by boundary
// work and what stages give, less losses and what is released by breaking, forming and parting.
#include <cmath>

#include "tests/extreme/energy.hpp"
#include "tests/interaction/bonded.hpp"

using namespace rvelab;
using namespace rvelab::test;

namespace {

constexpr double soft_young = 1e7, soft_poisson = 0.25, sticky_surface = 0.05;

InteractionTerms terms_of(const Rve& rve) { return rve.energy_balance()->of_interactions(); }

/// What a balance from `start` on lacks, J.
class Missing {
 public:
  explicit Missing(const Rve& rve, const Matrix3& rate = Matrix3::Zero()) : start_(of(rve, rate)) {}
  double at(const Rve& rve, const Matrix3& rate = Matrix3::Zero()) const { return of(rve, rate) - start_; }

 private:
  static double of(const Rve& rve, const Matrix3& rate) {
    const EnergyTerms& terms = *rve.energy_balance();
    return energy_in(rve, rate) - terms.boundary_work + losses_in(terms);
  }
  double start_;
};

Material adhesive() {
  Material m = linear_material(0, 0, 0.3);
  m.young_modulus = soft_young;
  m.poisson_ratio = soft_poisson;
  return m;
}

/// F1 and delta1 of two such grains (jkr.hpp).
struct JkrScales {
  static constexpr double work = 2 * sticky_surface, modulus = soft_young / (2 * (1 - soft_poisson * soft_poisson));
  double radius, force, overlap;
  explicit JkrScales(double r)
      : radius(r), force(4 * pi * work * r), overlap(std::pow(2 * pi * work * r * r / modulus, 2.0 / 3.0) / r) {}
  double cycle() const { return 7.09 * std::cbrt(std::pow(work, 5) * std::pow(radius, 4) / (modulus * modulus)); }
};

/// Spheres of these radii in a row along x through a periodic cell, `gap` between neighbours.
Rve row_of_spheres(const std::vector<double>& radii, double gap, double step) {
  Specimen s = empty_specimen(Shape::sphere, 4e-3, adhesive(), Law::hertz_mindlin);
  s.solver.energy_balance = true;
  s.solver.fixed_time_step = step;
  s.solver.min_height = 0.5e-3;
  double x = 0;
  for (const double r : radii) {
    add_grain(s, {x + r, 0, 0}, r);
    x += 2 * r + gap;
  }
  s.cell.lattice(0, 0) = x;
  return Rve(s);
}

}  // namespace

TEST_CASE("JKR: what cycles of meeting and parting lose is booked, and the balance closes", "[adhesion][energy]") {
  const double per_step = 5e-4, step = 1e-6;  // of delta1
  const JkrScales scales(0.25e-3);
  const double unit = scales.force * scales.overlap;
  Rve rve = row_of_spheres({0.5e-3}, scales.overlap, step);
  set_settings<JkrAdhesion>(rve, {{sticky_surface}});
  const Missing missing(rve);
  for (int cycle = 1; cycle <= 3; ++cycle) {
    const double strain = 3 * scales.overlap / rve.cell().lattice(0, 0), time = 3 / per_step * step;
    const double before = terms_of(rve).forming;
    rve.apply(gradient(-strain, 0, 0, 0), time);
    const double pressed = terms_of(rve).forming;
    rve.apply(gradient(1 / (1 - strain) - 1, 0, 0, 0), time);
    const double apart = terms_of(rve).forming;
    CHECK((pressed - before) / unit == Approx(0.15).epsilon(2e-3));
    CHECK((apart - pressed) / unit == Approx(0.01575).epsilon(1e-2));
    CHECK(apart == Approx(cycle * scales.cycle()).epsilon(2e-3));
    CHECK(std::abs(missing.at(rve)) < 1e-3 * apart);
  }
}

TEST_CASE("JKR: the balance of grains that snap together and apart closes", "[adhesion][energy]") {
  const JkrScales scales(0.5e-3 * 0.4e-3 / 0.9e-3);
  const double critical = row_of_spheres({0.5e-3, 0.4e-3}, -1e-2 * scales.overlap, 0).critical_time_step();
  Rve rve = row_of_spheres({0.5e-3, 0.4e-3}, scales.overlap, 0.01 * critical);
  set_settings<JkrAdhesion>(rve, {{sticky_surface}});
  const Missing missing(rve);
  for (int cycle = 1; cycle <= 3; ++cycle) {
    const double strain = 6 * scales.overlap / rve.cell().lattice(0, 0), time = 40 * critical;
    rve.apply(gradient(-strain, 0, 0, 0), time);
    const Matrix3 back = gradient(1 / (1 - strain) - 1, 0, 0, 0);
    rve.apply(back, time);
    // Two pairs; in the third cycle one of them holds.
    if (cycle < 3) CHECK(terms_of(rve).forming == Approx(2 * cycle * scales.cycle()).epsilon(3e-3));
    CHECK(std::abs(missing.at(rve, back / time)) < 1e-3 * terms_of(rve).forming);
  }
}

namespace {

Rve booked_packing(Shape shape, Law law) {
  Material m = linear_material(2e6, 1e6, 0.4);
  m.young_modulus = 2e8;
  m.poisson_ratio = 0.2;
  Specimen s = disordered(shape, dimension_of(shape) == 2 ? 9 : 5, m, law, 0.51, 5);
  s.solver.energy_balance = true;
  return at_rest(s, 1e-9);
}

/// Sheared in sub-steps of this part of the critical one, restarted on the way: what is missing over what is released.
template <class Stage>
double missing_of_released(const Rve& start, const Stage& stage, double part, const Matrix3& shear, double steps) {
  Specimen s = start.specimen();
  s.solver.fixed_time_step = part * start.critical_time_step();
  Rve rve(s);
  const Missing of_stage(rve);
  stage(rve);
  CHECK(std::abs(of_stage.at(rve)) < 1e-12);
  const double time = steps * start.critical_time_step();
  rve.apply(1e-3 * shear, 1e-3 * time);
  const Missing missing(rve, shear / time);
  for (int k = 0; k < 10; ++k) {
    Rve restarted(rve.specimen());
    rve.apply(0.1 * shear, 0.1 * time);
    if (k != 5) continue;
    restarted.attempt(-0.05 * shear, 0.05 * time);
    restarted.revert();
    restarted.apply(0.1 * shear, 0.1 * time);
    CHECK(bool(restarted.save() == rve.save()));
  }
  const InteractionTerms terms = terms_of(rve);
  CHECK(terms.breaking + terms.forming > 0);
  return missing.at(rve, shear / time) / (terms.breaking + terms.forming);
}

}  // namespace

TEST_CASE("the balance of cemented packings closes through breaking", "[bond][energy]") {
  using protocol::BondModel;
  for (const Shape shape : {Shape::disc, Shape::sphere}) {
    const Rve start = booked_packing(shape, Law::linear_stiffness);
    for (const BondModel model : {BondModel::parallel, BondModel::surface, BondModel::contact, BondModel::softening}) {
      INFO(name(shape) << ", bonds " << int(model));
      protocol::Cementation cement = cement_of(2e5, 0);
      cement.model = model;
      cement.friction_angle_deg = 20;
      cement.strength_scatter = 0.3;
      cement.fracture_energy = model == BondModel::softening ? 4 : 0;
      const double missing = missing_of_released(
          start, [&](Rve& rve) { rve.set_interactions(protocol::cemented(rve, cement)); }, 0.025,
          gradient(5e-3, 3e-2, 0, 0), 1000);
      // Friction takes 20 to 400 times what bonds release.
      CHECK(std::abs(missing) < 4e-3);
    }
  }
}

TEST_CASE("the balance of moist packings closes through rupture as the step shortens", "[bridge][energy]") {
  for (const Shape shape : {Shape::disc, Shape::sphere}) {
    INFO(name(shape));
    Water water;
    (shape == Shape::disc ? water.suction : water.volume_ratio) = shape == Shape::disc ? 1e3 : 1e-3;
    water.surface_tension = 5;
    const Rve start = booked_packing(shape, Law::hertz_mindlin);
    const auto missing = [&](double part) {
      return missing_of_released(
          start, [&](Rve& rve) { set_settings<CapillaryBridge>(rve, {water}); }, part, gradient(1e-2, 1e-1, 0, 0),
          2000);
    };
    const double coarse = missing(0.1), fine = missing(0.025);
    CHECK(std::abs(4 * fine - coarse) / 3 < 2e-3);  // Hertz-Mindlin's slip falls with the step
  }
}

TEST_CASE("what a stage changes of the stored energy is booked, and nothing without the balance", "[bridge][energy]") {
  for (const bool books : {true, false}) {
    Specimen s = booked_packing(Shape::sphere, Law::hertz_mindlin).specimen();
    s.solver.energy_balance = books;
    Rve rve(s);
    const double dry = elastic_energy(rve.network());
    CHECK(rve.specimen().state.energy_balance.interactions.empty());
    Water water;
    water.suction = 1e3;
    set_settings<CapillaryBridge>(rve, {water});
    const double wetted = elastic_energy(rve.network()) - dry;
    CHECK(wetted < 0);
    REQUIRE((rve.energy_balance() != nullptr) == books);
    if (books) CHECK(terms_of(rve).stages == Approx(wetted).epsilon(1e-9));
    set_settings<CapillaryBridge>(rve, {});
    if (books)
      CHECK(std::abs(terms_of(rve).stages) < 1e-12 * std::abs(wetted));
    else
      CHECK(rve.specimen().state.energy_balance.interactions.empty());
  }
}
