// Contact parameters: mixing, dashpots, ranges, names.
#include "rvelab/contact/impact.hpp"
#include "rvelab/contact/model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "rvelab/error.hpp"
#include "tests/catch.hpp"
#include "tests/refusal.hpp"

using namespace rvelab;

namespace {

Material quartz() {
  Material m;
  m.young_modulus = 70e9;
  m.stiffness_ratio = 0.5;
  m.poisson_ratio = 0.2;
  m.normal_stiffness = 3e6;
  m.tangential_stiffness = 2e6;
  m.friction = 0.5;
  m.rolling_stiffness = 1.0;
  m.rolling_friction = 0.05;
  return m;
}

Material rubber() {
  Material m;
  m.name = "rubber";
  m.density = 1100;
  m.young_modulus = 5e6;
  m.stiffness_ratio = 0.8;
  m.poisson_ratio = 0.45;
  m.normal_stiffness = 1e6;
  m.tangential_stiffness = 0.5e6;
  m.friction = 0.9;
  m.rolling_stiffness = 0.25;
  m.rolling_friction = 0.02;
  return m;
}

ContactModel model_of(Law law, bool rolling = false) {
  ContactModel model;
  model.law = law;
  model.rolling = rolling;
  return model;
}

std::string finding(const ContactModel& model, const Damping& damping, const std::vector<Material>& materials) {
  return test::input_error([&] { check_parameters(model, damping, materials); });
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// Speed ratio of one head-on collision with f = kn delta^power + cn delta^dashpot_power v, followed in 4e5 steps.
double rebound_ratio(const PairParameters& pair, double power, double dashpot_power, double reduced_mass) {
  const double speed = 1.0;
  const double largest = std::pow(0.5 * (power + 1) * reduced_mass * speed * speed / pair.kn, 1 / (power + 1));
  const double step = largest / speed * 1e-5;
  double overlap = 0, velocity = speed;
  const auto acceleration = [&](double d, double v) {
    return d > 0 ? -(pair.kn * std::pow(d, power) + pair.cn * std::pow(d, dashpot_power) * v) / reduced_mass : 0.0;
  };
  while (overlap >= 0) {
    const double half_velocity = velocity + 0.5 * step * acceleration(overlap, velocity);
    const double half_overlap = overlap + 0.5 * step * velocity;
    velocity += step * acceleration(half_overlap, half_velocity);
    overlap += step * half_velocity;
  }
  return -velocity / speed;
}

}  // namespace

TEST_CASE("linear stiffness is that of two springs in series", "[contact][quick]") {
  const auto pair = mix(model_of(Law::linear), {}, quartz(), 2e-3, 1, rubber(), 5e-3, 1, 0);
  const double a = 70e9 * 2e-3, b = 5e6 * 5e-3;
  CHECK(pair.kn == Approx(2 / (1 / a + 1 / b)).epsilon(1e-14));
  CHECK(pair.kt == Approx(2 / (1 / (0.5 * a) + 1 / (0.8 * b))).epsilon(1e-14));
  CHECK(pair.friction == 0.5);
}

TEST_CASE("linear stiffness of one material is kt = nu kn and kn = 2 E r*", "[contact][quick]") {
  const auto pair = mix(model_of(Law::linear), {}, quartz(), 2e-3, 1, quartz(), 5e-3, 1, 0);
  CHECK(pair.kn == Approx(2 * 70e9 * (2e-3 * 5e-3 / 7e-3)).epsilon(1e-14));
  CHECK(pair.kt == Approx(0.5 * pair.kn).epsilon(1e-14));
}

TEST_CASE("a contact with a frictionless spring on one side has no tangential stiffness", "[contact][quick]") {
  Material smooth = quartz();
  smooth.stiffness_ratio = 0;
  smooth.tangential_stiffness = 0;
  for (const Law law : {Law::linear, Law::linear_stiffness, Law::hertz_stiffness}) {
    CHECK(mix(model_of(law), {}, quartz(), 1e-3, 1, smooth, 1e-3, 1, 0).kt == 0);
    CHECK(mix(model_of(law), {}, smooth, 1e-3, 1, smooth, 1e-3, 1, 0).kt == 0);
  }
}

TEST_CASE("Hertz and Mindlin stiffness from elastic constants", "[contact][quick]") {
  const double ri = 1e-3, rj = 2e-3, reduced = ri * rj / (ri + rj);
  SECTION("one material: 4/3 E/(2(1 - nu^2)) and 4 G/(2 - nu)") {
    const auto pair = mix(model_of(Law::hertz_mindlin), {}, quartz(), ri, 1, quartz(), rj, 1, 0);
    const double shear_modulus = 70e9 / (2 * (1 + 0.2));
    CHECK(pair.kn == Approx(4.0 / 3 * 70e9 / (2 * (1 - 0.04)) * std::sqrt(reduced)).epsilon(1e-14));
    CHECK(pair.kt == Approx(4 * shear_modulus * std::sqrt(reduced) / (2 - 0.2)).epsilon(1e-14));
    CHECK(pair.kt / pair.kn == Approx(2 * (1 - 0.2) / (2 - 0.2) * 1.5).epsilon(1e-14));
  }
  SECTION("two materials: compliances add, sums of (1 - nu^2)/E and (2 - nu)/G") {
    const auto pair = mix(model_of(Law::hertz_mindlin), {}, quartz(), ri, 1, rubber(), rj, 1, 0);
    const double compliance = (1 - 0.04) / 70e9 + (1 - 0.45 * 0.45) / 5e6;
    const double ga = 70e9 / (2 * 1.2), gb = 5e6 / (2 * 1.45);
    CHECK(pair.kn == Approx(4 / (3 * compliance) * std::sqrt(reduced)).epsilon(1e-14));
    CHECK(pair.kt == Approx(8 / ((2 - 0.2) / ga + (2 - 0.45) / gb) * std::sqrt(reduced)).epsilon(1e-14));
  }
}

TEST_CASE("given stiffnesses of one material are the contact's own", "[contact][quick]") {
  for (const Law law : {Law::linear_stiffness, Law::hertz_stiffness}) {
    const auto same = mix(model_of(law), {}, quartz(), 1e-3, 1, quartz(), 2e-3, 1, 0);
    CHECK(same.kn == 3e6);
    CHECK(same.kt == 2e6);
    const auto unlike = mix(model_of(law), {}, quartz(), 1e-3, 1, rubber(), 2e-3, 1, 0);
    CHECK(unlike.kn == Approx(1.5e6).epsilon(1e-14));
    CHECK(unlike.kt == Approx(0.8e6).epsilon(1e-14));
  }
}

TEST_CASE("rolling parameters: k_r = kt ri rj beta, cap min(eta_i ri, eta_j rj)", "[contact][quick]") {
  for (const Law law : {Law::linear, Law::linear_stiffness, Law::hertz_mindlin, Law::hertz_stiffness}) {
    const auto pair = mix(model_of(law, true), {}, quartz(), 2e-3, 1, rubber(), 6e-3, 1, 0);
    CHECK(pair.kr == Approx(pair.kt * 2e-3 * 6e-3 * 0.4).epsilon(1e-14));
    CHECK(pair.moment_cap == Approx(0.05 * 2e-3).epsilon(1e-14));
    const auto without = mix(model_of(law, false), {}, quartz(), 2e-3, 1, rubber(), 6e-3, 1, 0);
    CHECK(without.kr == 0);
    CHECK(without.moment_cap == 0);
  }
}

TEST_CASE("action equals reaction: mixing does not depend on the order of the grains", "[contact][quick]") {
  Damping damping;
  damping.dashpot = Dashpot::restitution;
  damping.restitution = 0.6;
  for (const Law law : {Law::linear, Law::linear_stiffness, Law::hertz_mindlin, Law::hertz_stiffness}) {
    const auto ab = mix(model_of(law, true), damping, quartz(), 2e-3, 0.1, rubber(), 6e-3, 0.3, 0);
    const auto ba = mix(model_of(law, true), damping, rubber(), 6e-3, 0.3, quartz(), 2e-3, 0.1, 0);
    CHECK(ab.kn == ba.kn);
    CHECK(ab.kt == ba.kt);
    CHECK(ab.kr == ba.kr);
    CHECK(ab.cn == ba.cn);
    CHECK(ab.friction == ba.friction);
    CHECK(ab.moment_cap == ba.moment_cap);
  }
}

TEST_CASE("a restitution dashpot gives the rebound of its formula", "[contact][quick]") {
  const double mi = 0.2, mj = 0.3, reduced_mass = mi * mj / (mi + mj);
  Damping damping;
  damping.dashpot = Dashpot::restitution;
  SECTION("linear spring, the closed form: v'/v = exp(-pi zeta/sqrt(1 - zeta^2)) over half a damped period") {
    for (const double e : {1e-3, 0.05, 0.3, 0.5, 0.9, 0.99, 1.0}) {
      damping.restitution = e;
      const auto pair = mix(model_of(Law::linear_stiffness), damping, quartz(), 1e-3, mi, quartz(), 1e-3, mj, 0);
      const double zeta = pair.cn / (2 * std::sqrt(reduced_mass * pair.kn));
      const double pi = std::acos(-1.0);
      CHECK(std::exp(-pi * zeta / std::sqrt(1 - zeta * zeta)) == Approx(e).epsilon(1e-13));
    }
  }
  SECTION("Hertz spring, by integration") {
    for (const Law law : {Law::hertz_mindlin, Law::hertz_stiffness}) {
      for (const double e : {0.05, 0.3, 0.6, 0.8, 0.9}) {
        damping.restitution = e;
        const auto pair = mix(model_of(law), damping, quartz(), 1e-3, mi, quartz(), 1e-3, mj, 0);
        const double rebound = rebound_ratio(pair, 1.5, dashpot_power(law, damping.dashpot), reduced_mass);
        CHECK(rebound == Approx(e).epsilon(5e-3));
      }
    }
  }
  SECTION("no_tension: the force ends the contact, and what is left is what was asked for") {
    damping.no_tension = true;
    for (const double e : {0.05, 0.3, 0.6, 0.9, 0.99}) {
      damping.restitution = e;
      const auto pair = mix(model_of(Law::linear_stiffness), damping, quartz(), 1e-3, mi, quartz(), 1e-3, mj, 0);
      // m* x'' = -k x - c x' by the midpoint rule, in units of 1/omega, until the force would pull.
      const double zeta = pair.cn / (2 * std::sqrt(reduced_mass * pair.kn)), dt = 1e-4;
      double x = 0, v = 1;
      const auto force = [&](double at, double speed) { return -at - 2 * zeta * speed; };
      while (v > 0 || force(x, v) < 0) {
        const double middle_x = x + 0.5 * dt * v, middle_v = v + 0.5 * dt * force(x, v);
        x += dt * middle_v;
        v += dt * force(middle_x, middle_v);
      }
      CHECK(-v == Approx(e).epsilon(1e-3));
      // The exact solution: decay rate over frequency times the duration in units of it.
      const double root = std::sqrt(std::abs(1 - zeta * zeta));
      const double duration = zeta < 1 ? 2 * std::atan(root / zeta) : std::log((zeta + root) / (zeta - root));
      CHECK(std::exp(-zeta / root * duration) == Approx(e).epsilon(1e-12));
    }
  }
  SECTION("tsuji, by integration: the polynomial alpha(e) with the reduced mass in place of one grain's") {
    damping.dashpot = Dashpot::tsuji;
    for (const Law law : {Law::hertz_mindlin, Law::hertz_stiffness}) {
      for (const double e : {0.3, 0.6, 0.8, 0.9}) {
        damping.restitution = e;
        const auto pair = mix(model_of(law), damping, quartz(), 1e-3, mi, quartz(), 1e-3, mj, 0);
        const double pi = std::acos(-1.0), fraction = -std::log(e) / std::hypot(pi, std::log(e)) / std::sqrt(2.0);
        const double expected = std::exp(-pi * fraction / std::sqrt(1 - fraction * fraction));
        const double rebound = rebound_ratio(pair, 1.5, dashpot_power(law, damping.dashpot), reduced_mass);
        CHECK(rebound == Approx(expected).margin(5e-3));
        if (e == 0.8) CHECK(rebound == Approx(0.8534).margin(1e-4));  // LAMMPS, head_hertzmat_tsuji: 1.52418 - 0.67078
      }
    }
  }
  SECTION("an elastic impact has no dashpot") {
    damping.restitution = 1;
    for (const Law law : {Law::linear, Law::linear_stiffness, Law::hertz_mindlin, Law::hertz_stiffness}) {
      CHECK(mix(model_of(law), damping, quartz(), 1e-3, mi, quartz(), 1e-3, mj, 0).cn == 0);
    }
  }
}

TEST_CASE("dashpot constants as stated", "[contact][quick]") {
  const double mi = 0.2, mj = 0.3, reduced_mass = 0.12;
  Damping damping;
  damping.normal_coefficient = 7;
  const auto constant = [&](Law law, Dashpot dashpot) {
    damping.dashpot = dashpot;
    return mix(model_of(law), damping, quartz(), 1e-3, mi, quartz(), 3e-3, mj, 0).cn;
  };
  CHECK(constant(Law::linear, Dashpot::none) == 0);
  CHECK(constant(Law::linear, Dashpot::coefficient) == 7);
  CHECK(constant(Law::hertz_mindlin, Dashpot::viscoelastic) == Approx(7 * std::sqrt(0.75e-3) * reduced_mass));
  CHECK(dashpot_power(Law::linear, Dashpot::restitution) == 0);
  CHECK(dashpot_power(Law::linear_stiffness, Dashpot::coefficient) == 0);
  CHECK(dashpot_power(Law::hertz_mindlin, Dashpot::coefficient) == 0);
  CHECK(dashpot_power(Law::hertz_stiffness, Dashpot::restitution) == 0.25);
  CHECK(dashpot_power(Law::hertz_mindlin, Dashpot::restitution) == 0.25);
  CHECK(dashpot_power(Law::hertz_stiffness, Dashpot::viscoelastic) == 0.5);
}

TEST_CASE("a parameter out of range is named with value and range", "[contact][quick]") {
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  struct Case {
    Law law;
    double Material::*field;
    double value;
    const char* key;
    const char* range;
  };
  const Case cases[] = {{Law::linear, &Material::density, 0, "density", "1e-50 to 1e+50 kg/m^3"},
                        {Law::linear, &Material::density, 1e300, "density", "1e-50 to 1e+50 kg/m^3"},
                        {Law::linear, &Material::young_modulus, -1, "young_modulus", "> 0 Pa"},
                        {Law::hertz_mindlin, &Material::young_modulus, nan, "young_modulus", "> 0 Pa"},
                        {Law::linear, &Material::young_modulus, infinity, "young_modulus", "> 0 Pa"},
                        {Law::linear, &Material::stiffness_ratio, 10.5, "stiffness_ratio", "0 to 10"},
                        {Law::hertz_mindlin, &Material::poisson_ratio, 0.51, "poisson_ratio", "-0.99 to 0.5"},
                        {Law::linear_stiffness, &Material::normal_stiffness, 0, "normal_stiffness", "> 0 N/m"},
                        {Law::hertz_stiffness, &Material::normal_stiffness, -2, "normal_stiffness", "> 0 N/m^1.5"},
                        {Law::linear_stiffness, &Material::tangential_stiffness, -2, "tangential_stiffness", ">= 0"},
                        {Law::linear, &Material::friction, -0.1, "friction", "0 to 1e+06"},
                        {Law::linear, &Material::friction, 2e6, "friction", "0 to 1e+06"},
                        {Law::linear, &Material::rolling_stiffness, -1, "rolling_stiffness", ">= 0"},
                        {Law::linear, &Material::rolling_friction, nan, "rolling_friction", ">= 0"}};
  for (const Case& one : cases) {
    Material bad = rubber();
    bad.*one.field = one.value;
    const std::string text = finding(model_of(one.law, true), {}, {quartz(), bad});
    CAPTURE(one.key, one.value, text);
    CHECK(contains(text, "material \"rubber\": " + std::string(one.key) + " = "));
    CHECK(contains(text, std::string("allowed: ") + one.range));
    CHECK_FALSE(contains(text, "\n"));
  }
}

TEST_CASE("damping out of range is named with value and range", "[contact][quick]") {
  struct Case {
    Dashpot dashpot;
    double Damping::*field;
    double value;
    const char* key;
  };
  const Case cases[] = {{Dashpot::none, &Damping::local, 1, "damping.local"},
                        {Dashpot::none, &Damping::local, -0.1, "damping.local"},
                        {Dashpot::none, &Damping::local_quasi_static, 0, "damping.local_quasi_static"},
                        {Dashpot::none, &Damping::global_viscous, -1, "damping.global_viscous"},
                        {Dashpot::coefficient, &Damping::normal_coefficient, -1, "damping.normal_coefficient"},
                        {Dashpot::viscoelastic, &Damping::normal_coefficient, -1, "damping.normal_coefficient"},
                        {Dashpot::restitution, &Damping::restitution, 0, "damping.restitution"},
                        {Dashpot::restitution, &Damping::restitution, 1.1, "damping.restitution"},
                        {Dashpot::coefficient, &Damping::tangential_ratio, -1, "damping.tangential_ratio"}};
  for (const Case& one : cases) {
    Damping bad;
    bad.dashpot = one.dashpot;
    bad.*one.field = one.value;
    const std::string text = finding(model_of(Law::hertz_mindlin), bad, {quartz()});
    CAPTURE(one.key, one.value, text);
    CHECK(contains(text, std::string(one.key) + " = "));
    CHECK(contains(text, "allowed: "));
  }
}

TEST_CASE("only what is used is checked, and all that is wrong is said at once", "[contact][quick]") {
  Material linear_only;
  linear_only.young_modulus = 8e8;
  linear_only.poisson_ratio = 3;
  linear_only.normal_stiffness = -1;
  linear_only.rolling_friction = -1;
  Damping damping;
  damping.restitution = 5;
  damping.tangential_ratio = -1;
  CHECK(finding(model_of(Law::linear), damping, {linear_only}).empty());

  damping.local = 2;
  linear_only.density = -1;
  linear_only.friction = -1;
  const std::string text = finding(model_of(Law::linear), damping, {linear_only});
  const auto local = text.find("damping.local"), density = text.find("density"), friction = text.find("friction");
  CHECK(local < density);
  CHECK(density < friction);
  CHECK(friction != std::string::npos);
  CHECK(std::count(text.begin(), text.end(), '\n') == 2);
}

TEST_CASE("a viscoelastic dashpot needs a Hertz law, a specimen needs a material", "[contact][quick]") {
  Damping damping;
  damping.dashpot = Dashpot::viscoelastic;
  CHECK(contains(finding(model_of(Law::linear_stiffness), damping, {quartz()}), "hertz_mindlin"));
  CHECK(contains(finding(model_of(Law::linear), damping, {quartz()}), "contact.law = linear"));
  CHECK(finding(model_of(Law::hertz_stiffness), damping, {quartz()}).empty());
  damping.dashpot = Dashpot::tsuji;
  CHECK(contains(finding(model_of(Law::linear), damping, {quartz()}), "use damping.dashpot = restitution"));
  CHECK(finding(model_of(Law::hertz_stiffness), damping, {quartz()}).empty());
  CHECK(contains(finding(model_of(Law::linear), {}, {}), "materials"));
}

TEST_CASE("Hertz's radius from curvature needs a law whose stiffness holds a radius", "[contact][quick]") {
  ContactModel model = model_of(Law::hertz_mindlin);
  model.hertz_radius = HertzRadius::curvature;
  CHECK(finding(model, {}, {quartz()}).empty());
  for (const Law law : {Law::linear, Law::linear_stiffness, Law::hertz_stiffness, Law::linear_adhesive}) {
    model.law = law;
    const std::string text = finding(model, {}, {quartz()});
    CAPTURE(text);
    CHECK(contains(text,
                   "contact.hertz_radius = \"curvature\" does not go with contact.law = " + std::string(name(law))));
    CHECK(contains(text, "allowed: hertz_mindlin; use contact.hertz_radius = \"equivalent\""));
  }
}

TEST_CASE("names go there and back", "[contact][quick]") {
  for (const Law law : {Law::linear, Law::linear_stiffness, Law::hertz_mindlin, Law::hertz_stiffness}) {
    CHECK(choice_from<Law>(name(law)) == law);
  }
  for (const Slip slip : {Slip::consistent, Slip::full_radius, Slip::full_radius_ratcheting}) {
    CHECK(choice_from<Slip>(name(slip)) == slip);
  }
  for (const HertzRadius radius : {HertzRadius::equivalent, HertzRadius::curvature}) {
    CHECK(choice_from<HertzRadius>(name(radius)) == radius);
  }
  for (const Dashpot d :
       {Dashpot::none, Dashpot::coefficient, Dashpot::restitution, Dashpot::viscoelastic, Dashpot::tsuji}) {
    CHECK(choice_from<Dashpot>(name(d)) == d);
  }
  for (const LocalDampingForm form : {LocalDampingForm::vector, LocalDampingForm::component}) {
    CHECK(choice_from<LocalDampingForm>(name(form)) == form);
  }
  CHECK(contains(test::input_error([] { choice_from<Law>("hertz"); }), "\"hertz\""));
  CHECK_THROWS_AS(choice_from<Slip>(""), InputError);
}
