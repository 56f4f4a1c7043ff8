// What every contact law must be, whichever it is: a force with a potential, and stiffnesses that are its slopes.
#include <cmath>

#include "rvelab/contact/model.hpp"
#include "tests/catch.hpp"

using namespace rvelab;

namespace {

struct Normal {
  double force, stiffness, energy;
};

Normal normal_at(Law law, double kn, double overlap, double own) {
  return with_law(law, [&](auto each) -> Normal {
    using Force = typename decltype(each)::Force;
    const double root = Force::root(overlap, own);
    return {Force::normal_force(kn, overlap, root, own), Force::normal_stiffness(kn, root),
            Force::normal_energy(kn, overlap, root, own)};
  });
}

}  // namespace

TEST_CASE("the normal stiffness of a law is the slope of its force, the force that of its energy", "[contact][quick]") {
  const double kn = 3e6;
  for (int k = 0; k < law_count; ++k) {
    const double own = Law(k) == Law::hertz_rough ? 2e-6 : 40;  // m: the overlaps are of its three regimes; or N
    for (const double overlap : {1e-6, 1e-5, 2e-4}) {
      CAPTURE(name(Law(k)), overlap);
      const double h = 1e-3 * overlap;
      const Normal low = normal_at(Law(k), kn, overlap - h, own), high = normal_at(Law(k), kn, overlap + h, own);
      const Normal here = normal_at(Law(k), kn, overlap, own);
      CHECK((high.force - low.force) / (2 * h) == Approx(here.stiffness).epsilon(1e-5));
      CHECK((high.energy - low.energy) / (2 * h) == Approx(here.force).epsilon(1e-5));
      CHECK(normal_at(Law(k), kn, 0, own).energy == 0);
    }
  }
}

TEST_CASE("laws are found by their names, and each reads parameters of its own ranges", "[contact][quick]") {
  for (int k = 0; k < law_count; ++k) {
    CHECK(choice_from<Law>(name(Law(k))) == Law(k));
    CHECK(law_names().find(name(Law(k))) != std::string::npos);
    int read = 0;
    for (const LawParameter& each : law_parameters()) {
      if (each.law != Law(k)) continue;
      ++read;
      // A value just outside the range is refused by the law that reads it, naming the field.
      ContactModel model;
      model.law = Law(k);
      Material m;
      for (const LawParameter& other : law_parameters())
        if (other.law == Law(k)) m.*other.value = std::max(other.parameter.allowed.low, 0.0) + 0.1;
      CHECK_NOTHROW(check_parameters(model, {}, {m}));
      m.*each.value = each.parameter.allowed.low - 1;
      CHECK_THROWS_WITH(check_parameters(model, {}, {m}), Catch::Contains(each.parameter.field));
    }
    CHECK(read >= 2);
  }
}

TEST_CASE("the pull-off force is what the materials give and the section of the smaller grain bears",
          "[contact][quick]") {
  ContactModel model;
  model.law = Law::linear_adhesive;
  Material wet, dry;
  wet.young_modulus = dry.young_modulus = 1e8;
  wet.pull_off_force = 2;
  wet.adhesion_pressure = 500;
  const double section = 4e-3;  // m^2
  const auto mixed = [&](const Material& a, const Material& b) {
    return mix(model, {}, a, 1e-3, 1, b, 2e-3, 1, section);
  };
  CHECK(mixed(wet, wet).law_constant == Approx(2 + 500 * section));
  CHECK(mixed(wet, dry).law_constant == 0);
  Material half = wet;
  half.pull_off_force = 1;
  half.adhesion_pressure = 250;
  CHECK(mixed(wet, half).law_constant == Approx(2 * 4. * 2. / (4. + 2.)));
  CHECK(mixed(wet, half).law_constant == mixed(half, wet).law_constant);
  // Everything else is the linear law's.
  ContactModel linear;
  const PairParameters plain = mix(linear, {}, wet, 1e-3, 1, wet, 2e-3, 1, section);
  CHECK(mixed(wet, wet).kn == plain.kn);
  CHECK(mixed(wet, wet).kt == plain.kt);
}
