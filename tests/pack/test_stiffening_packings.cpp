// How the stiffness of specimens at small strain grows with the pressure: G0 ~ p^(1/3) of smooth spheres, p^(1/2) of
// cones, by roughness of rough spheres (Goddard 1990; Otsubo et al. 2017).
#include <cmath>

#include "rvelab/measure/measures.hpp"
#include "rvelab/measure/tangent.hpp"
#include "rvelab/specimen/specimen_check.hpp"
#include "tests/pack/recipes.hpp"
#include "tests/solver/resolved.hpp"

using namespace rvelab;
using namespace rvelab::test;

namespace {

Material glass(double modulus) {
  Material m;
  m.young_modulus = modulus;
  m.poisson_ratio = 0.25;
  m.roughness = 4e-7;
  m.cone_slope = 0.05;
  m.friction = 0.5;
  return m;
}

double shear_modulus(const Rve& rve) {
  const Eigen::MatrixXd c = elastic_tangent(rve.network());
  return (c(3, 3) + c(4, 4) + c(5, 5)) / 3;
}

double overlap_at(Law law, const Material& m, double radius, double force) {
  ContactModel model;
  model.law = law;
  const PairParameters q = mix(model, {}, m, radius, 1, m, radius, 1, 0);
  return with_law(law, [&](auto each) {
    using Force = typename decltype(each)::Force;
    double low = 0, high = radius;
    for (int halving = 0; halving < 200; ++halving) {
      const double middle = 0.5 * (low + high);
      (Force::normal_force(q.kn, middle, Force::root(middle, q.law_constant), q.law_constant) < force ? low : high) =
          middle;
    }
    return high;
  });
}

/// G of a face-centred crystal of spheres of radius 1 mm at a pressure, Pa.
double crystal_modulus(Law law, double roughness, double pressure) {
  constexpr double radius = 1e-3;
  Material m = glass(70e9);
  m.roughness = roughness;
  double spacing = 2 * radius;  // p = 2 f l/V, V = l^3/sqrt2
  for (int round = 0; round < 5; ++round)
    spacing = 2 * radius - overlap_at(law, m, radius, pressure * spacing * spacing / (2 * std::sqrt(2.0)));
  const double edge = std::sqrt(2.0) * spacing;
  Specimen s = empty_specimen(Shape::sphere, 2 * edge, m, law);
  for (int k = 0; k < 4; ++k)
    for (int j = 0; j < 4; ++j)
      for (int i = 0; i < 4; ++i)
        if ((i + j + k) % 2 == 0) add_grain(s, 0.5 * edge * Vector3(i + 0.1, j + 0.2, k + 0.3), radius);
  const Rve rve(s);
  REQUIRE(test::pressure(rve.stress(), 3) == Approx(pressure).epsilon(1e-6));
  return shear_modulus(rve);
}

MixedTarget to_pressure(const Rve& rve, double wanted) {
  MixedTarget target;
  const Matrix3 now = rve.stress();
  for (int i = 0; i < 3; ++i)
    for (int j = i; j < 3; ++j) {
      MixedTarget::Row row;
      if (i == j) {
        row.stress(i, i) = 1;
        row.value = -wanted - now(i, i);
        row.scale = wanted;
      } else {
        row.strain(i, j) = row.strain(j, i) = 0.5;
      }
      target.rows.push_back(row);
    }
  target.tolerance = 1e-3;
  return target;
}

/// 200 spheres at 50 kPa.
Specimen packed_by(Law law) {
  pack::Recipe recipe = spheres(200);
  recipe.contact.law = law;
  const Material grain = glass(7e9);
  recipe.materials[0].roughness = grain.roughness;
  recipe.materials[0].cone_slope = grain.cone_slope;
  recipe.stress = pack::isotropic_stress(5e4, Shape::sphere);
  return pack::draw(recipe, 1, 0.2, nullptr).specimen;
}

/// Exponent of G0 between 50 and 800 kPa, and G0 at 50 kPa.
struct Growth {
  double exponent, modulus, contacts_gained;
};
Growth growth_of(Law law) {
  Rve rve(packed_by(law));
  REQUIRE(rve.relax(1e-8, 1'000'000).target_held);
  const double first = shear_modulus(rve), contacts = coordination_number(rve.network());
  for (const double p : {1e5, 2e5, 4e5, 8e5}) REQUIRE(rve.apply(to_pressure(rve, p), 0).report.target_held);
  REQUIRE(rve.relax(1e-8, 1'000'000).target_held);
  const double p = test::pressure(rve.stress(), 3);
  return {std::log(shear_modulus(rve) / first) / std::log(p / 5e4), first,
          coordination_number(rve.network()) - contacts};
}

}  // namespace

TEST_CASE("a crystal, whose contacts stay, has exponents of 1/3, 1/2, and by roughness of 0.61, 0.37 and 1/3") {
  // d f/d overlap ~ f^((n - 1)/n), n = 3/2, 2, and 2.59, 1.58, 3/2 in the three regimes. Forces from 0.07 to 1.1 N:
  // those that end the first two regimes are 0.063 and 6.3 N at S_q = 0.1 um, and go with S_q^(3/2).
  const double pressures[] = {50e3, 100e3, 200e3, 400e3, 800e3};
  const auto exponent = [&](Law law, double roughness, int first, int last) {
    return std::log(crystal_modulus(law, roughness, pressures[last]) /
                    crystal_modulus(law, roughness, pressures[first])) /
           std::log(pressures[last] / pressures[first]);
  };
  for (int k = 0; k < 4; ++k) {
    CHECK(exponent(Law::hertz_mindlin, 0, k, k + 1) == Approx(1.0 / 3).margin(1e-3));
    CHECK(exponent(Law::cones, 0, k, k + 1) == Approx(0.5).margin(2e-3));
    CHECK(exponent(Law::hertz_rough, 1e-6, k, k + 1) == Approx(1 - 1 / 2.5897955).margin(2e-3));
    CHECK(exponent(Law::hertz_rough, 1e-7, k, k + 1) == Approx(1 - 1 / 1.5830097).margin(1e-3));
    CHECK(exponent(Law::hertz_rough, 1e-9, k, k + 1) == Approx(1.0 / 3).margin(1e-3));
  }
  double last = exponent(Law::hertz_mindlin, 0, 0, 4);
  for (const double roughness : {1e-8, 5e-8, 2e-7, 5e-7, 9e-7}) {
    const double now = exponent(Law::hertz_rough, roughness, 0, 4);
    CHECK(now >= last - 1e-4);
    CHECK(crystal_modulus(Law::hertz_rough, roughness, 1e5) < crystal_modulus(Law::hertz_mindlin, 0, 1e5));
    last = now;
  }
}

TEST_CASE("random packings stiffen a little faster than their contacts, since contacts are gained") {
  const Growth hertz = growth_of(Law::hertz_mindlin), rough = growth_of(Law::hertz_rough),
               cones = growth_of(Law::cones);
  CAPTURE(hertz.exponent, rough.exponent, cones.exponent, hertz.modulus, rough.modulus, cones.modulus,
          hertz.contacts_gained, rough.contacts_gained, cones.contacts_gained);
  CHECK(hertz.contacts_gained > 0);
  CHECK(hertz.exponent > 0.33);
  CHECK(hertz.exponent < 0.42);
  CHECK(cones.exponent > 0.5);
  CHECK(cones.exponent < 0.6);
  CHECK(rough.exponent > hertz.exponent + 0.02);
  CHECK(rough.exponent < cones.exponent - 0.02);
  CHECK(rough.modulus < hertz.modulus);
}

TEST_CASE("increments of packings that stiffen keep below their estimate") {
  Ratios to_estimate;
  for (const Law law : {Law::hertz_rough, Law::cones}) {
    const Specimen s = packed_by(law);
    for (const Matrix3& direction : {biaxial_step, Matrix3(-biaxial_step), shear_step})
      for (const double size : {1e-6, 1e-5, 1e-4}) {
        const Judged made = judged(s, size * direction);
        to_estimate.push_back(made.error / made.report.error_estimate);
      }
  }
  CHECK(to_estimate.root_mean_square() < 0.6);
  CHECK(to_estimate.share_below_one() >= 0.94);
}

TEST_CASE("tangential forces stay as they are where another law, or another roughness, changes their stiffness") {
  // What is stored of the stiffness so far is of the law so far: the next step must not take its ratio.
  const Specimen before = packed_by(Law::hertz_mindlin);
  const auto stored_in = [](const Specimen& s) {
    double sum = 0;
    for (const Contact& c : s.contacts) sum += c.last_root_overlap;
    return sum;
  };
  const auto changed = [&](Law law, double roughness) {
    Specimen s = before;
    s.contact.law = law;
    s.materials[0].roughness = roughness;
    fit_state_to_parameters(s, before.contact, before.materials);
    return s;
  };
  CHECK(stored_in(before) > 0);
  CHECK(stored_in(changed(Law::hertz_mindlin, 1e-6)) == stored_in(before));
  CHECK(stored_in(changed(Law::cones, 1e-6)) == 0);
  Rve rve(changed(Law::hertz_rough, 1e-7));
  CHECK(stored_in(rve.specimen()) == 0);
  double forces = 0, as_before = 0;
  for (const ContactState& c : rve.network().contacts) forces += c.tangential_force.norm();
  for (const Contact& c : before.contacts) as_before += c.tangential_force.norm();
  CHECK(forces == Approx(as_before).epsilon(1e-9));
  rve.relax(1e-4, 100'000);
  CHECK(stored_in(rve.specimen()) > 0);
  std::vector<Material> materials = rve.specimen().materials;
  materials[0].roughness = 4e-7;
  rve.set_materials(materials);
  CHECK(stored_in(rve.specimen()) == 0);
}
