// Agitated grains (agitation.hpp) and the search for a number of contacts and a fabric (contact_search.hpp).
#include <cmath>

#include "rvelab/error.hpp"
#include "rvelab/measure/measures.hpp"
#include "rvelab/pack/agitation.hpp"
#include "rvelab/pack/noisy_root.hpp"
#include "rvelab/pack/search.hpp"
#include "tests/pack/recipes.hpp"

using namespace rvelab;
using namespace rvelab::test;
using Catch::Matchers::Contains;

namespace {

pack::Recipe clumps(std::size_t number) {
  pack::Recipe recipe = spheres(number);
  recipe.clumps = true;
  recipe.fractions[0].clump = published_clump("tetrapod", 3);
  return recipe;
}

pack::Recipe solids(std::size_t number) {
  pack::Recipe recipe = spheres(number);
  recipe.shape = Shape::superellipsoid;
  recipe.fractions[0].half_axes = {1.25, 1, 0.8};
  return recipe;
}

pack::Recipe agitated_recipe(pack::Recipe recipe, double expansion) {
  recipe.preparation.friction = 0;
  recipe.preparation.expansion = expansion;
  return recipe;
}

pack::Packing packed_by(const pack::Recipe& recipe, unsigned threads = 1) {
  Workers workers(threads);
  return pack::pack(recipe, workers);
}

double part_that_bears_nothing(const Network& network) {
  double free = 0;
  for (const bool rattler : rattlers(network)) free += rattler ? 1 : 0;
  return free / double(network.grains.size());
}

}  // namespace

TEST_CASE("agitated grains are apart, at rest and elsewhere, in a cell that is wider by the strain along each axis") {
  for (const pack::Recipe& recipe : {discs(), ellipses(), spheres(), clumps(100), solids(60)}) {
    const int d = dimension_of(recipe.shape);
    CAPTURE(d);
    const Rve rve(packed_by(recipe).specimen);
    Uniform uniform(5);
    const double expansion = 0.01;
    const Rve after = pack::agitated(rve, expansion, uniform, {});
    CHECK(after.cell().volume() == Approx(rve.cell().volume() * std::pow(1 + expansion, d)).epsilon(1e-9));
    const Network before = rve.network(), network = after.network();
    // Few pairs are in the middle of a collision, and these overlap by a tenth of the gap.
    CHECK(coordination_number(network) < 0.3 * coordination_number(before));
    double moved = 0, diameter = 0;
    for (std::size_t g = 0; g < network.grains.size(); ++g) {
      CHECK(network.grains[g].velocity == Vector3::Zero());
      Vector3 way = network.grains[g].position - before.grains[g].position * (1 + expansion);
      wrap(after.cell(), way);
      moved += way.norm();
      diameter += 2 * network.grains[g].radius;
    }
    CHECK(moved > 0.3 * expansion * diameter);
    const double force = before.contacts.front().normal_force;
    for (const ContactState& contact : network.contacts) CHECK(contact.tangential_force.norm() < 1e-9 * force);
  }
}

TEST_CASE("agitated grains keep the density and lose contacts, the more the further they were apart") {
  const auto state = [](double expansion) {
    pack::Recipe recipe = spheres(300);
    recipe.preparation.friction = 0;
    if (expansion > 0) recipe.preparation.expansion = expansion;
    return Rve(packed_by(recipe).specimen).network();
  };
  const Network lubricated = state(0), tapped = state(0.002), shaken = state(0.01);
  CHECK(mechanical_coordination_number(lubricated) > mechanical_coordination_number(tapped) + 0.3);
  CHECK(mechanical_coordination_number(tapped) > mechanical_coordination_number(shaken) + 0.2);
  CHECK(void_ratio(shaken) == Approx(void_ratio(lubricated)).margin(0.015));
  // State C of Agnolin and Roux (2007): 4.56 contacts and 13 % without load where lubricated grains have 6.07 and 1.4
  // %.
  CHECK(part_that_bears_nothing(shaken) > 2 * part_that_bears_nothing(lubricated));
}

TEST_CASE("density and number of contacts are both met, by every shape, with the same bits on any number of threads") {
  struct Case {
    pack::Recipe recipe;
    double void_ratio, coordination_number;
  };
  Case cases[] = {{discs(200), 0.20, 3.5}, {spheres(200), 0.62, 4.9}, {clumps(100), 0.56, 6.4}};
  for (Case& at : cases) {
    at.recipe.void_ratio = at.void_ratio;
    at.recipe.void_ratio_tolerance = 4e-3;
    at.recipe.contacts.coordination_number = at.coordination_number;
    at.recipe.contacts.coordination_tolerance = 0.1;
    const pack::Packing one = packed_by(at.recipe, 1), two = packed_by(at.recipe, 2);
    const Network network = Rve(one.specimen).network();
    CHECK(std::abs(void_ratio(network) - at.void_ratio) <= 4e-3);
    CHECK(std::abs(mechanical_coordination_number(network) - at.coordination_number) <= 0.1);
    CHECK(network.contacts.front().friction == at.recipe.materials[0].friction);
    REQUIRE(one.agitation);
    CHECK(one.agitation->expansion > 0);
    CHECK(one.draw == two.draw);
    CHECK(Rve(one.specimen).save() == Rve(two.specimen).save());
  }
}

TEST_CASE("compression along an axis leaves more contacts along it, across it fewer") {
  for (const int axis : {0, 2}) {
    for (const double difference : {-1.0, 1.2}) {
      pack::Recipe recipe = agitated_recipe(spheres(300), 0.01);
      recipe.preparation.strain_difference = difference;
      recipe.contacts.axis = axis;
      const Rve rve(packed_by(recipe).specimen);
      const double along = pack::anisotropy_along(fabric(rve.network()), 3, axis);
      CAPTURE(axis, difference, along);
      CHECK(along * difference > 0.05);
      CHECK((rve.stress() + 1e5 * Matrix3::Identity()).norm() < 1e-3 * 1e5);
    }
  }
  pack::Recipe recipe = agitated_recipe(discs(300), 0.01);
  recipe.contacts.fabric_anisotropy = 0.1;
  const Network network = Rve(packed_by(recipe).specimen).network();
  CHECK(pack::anisotropy_along(fabric(network), 2, 1) == Approx(0.1).margin(0.05));
}

TEST_CASE("the anisotropy along an axis is that of the fabric with its sign") {
  Matrix3 fabric = Matrix3::Zero();
  fabric.diagonal() << 0.3, 0.3, 0.4;
  CHECK(pack::anisotropy_along(fabric, 3, 2) == Approx(fabric_anisotropy(fabric, 3)));
  fabric.diagonal() << 0.35, 0.35, 0.3;
  CHECK(pack::anisotropy_along(fabric, 3, 2) == Approx(-fabric_anisotropy(fabric, 3)));
  fabric.diagonal() << 0.45, 0.55, 0;
  CHECK(pack::anisotropy_along(fabric, 2, 1) == Approx(fabric_anisotropy(fabric, 2)));
  CHECK(pack::anisotropy_along(fabric, 2, 0) == Approx(-fabric_anisotropy(fabric, 2)));
}

TEST_CASE("a number of contacts out of reach is reported with what can be had at this density") {
  pack::Recipe recipe = spheres(120);
  recipe.void_ratio = 0.62;
  recipe.void_ratio_tolerance = 0.01;
  recipe.contacts.coordination_number = 9;
  CHECK_THROWS_WITH(packed_by(recipe), Contains("target.coordination_number = 9") && Contains("reached") &&
                                           Contains("void ratios") && Contains("give a target"));
}

TEST_CASE("the expansion is reduced for a density that agitated grains are beyond, where the recipe allows it") {
  pack::Recipe loosest = spheres(120);
  loosest.void_ratio.reset();
  loosest.preparation.friction = 1e6;
  const double loose = packed_by(loosest).void_ratio;
  loosest.preparation.expansion = 0.03;
  const double agitated = packed_by(loosest).void_ratio;
  REQUIRE(agitated < loose - 0.05);

  pack::Recipe recipe = spheres(120);
  recipe.void_ratio = 0.5 * (agitated + loose);
  recipe.void_ratio_tolerance = 0.01;
  recipe.preparation.expansion = 0.03;
  recipe.preparation.max_draws = 60;
  CHECK_THROWS_WITH(packed_by(recipe),
                    Contains("target.void_ratio") && Contains("reached") && Contains("preparation.least_expansion"));
  recipe.preparation.least_expansion = 3e-4;
  recipe.preparation.max_draws = 8;  // it would be reduced after them: what they reached is reported
  CHECK_THROWS_WITH(packed_by(recipe), Contains("target.void_ratio") && Contains("reached"));
  recipe.preparation.max_draws = 60;
  const pack::Packing packing = packed_by(recipe);
  CHECK(std::abs(packing.void_ratio - *recipe.void_ratio) <= recipe.void_ratio_tolerance);
  CHECK(packing.agitation->expansion < 0.03);
  CHECK(packing.agitation->expansion >= 3e-4);
}

TEST_CASE("what contradicts agitation, or cannot be agitated, is refused by name") {
  const auto refused = [](void (*change)(pack::Recipe&), const std::string& key) {
    pack::Recipe recipe = spheres();
    change(recipe);
    CHECK_THROWS_WITH(pack::check_recipe(recipe), Contains(key) && Contains("allowed"));
  };
  refused([](pack::Recipe& r) { r.contacts.coordination_number = 5, r.preparation.expansion = 0.01; },
          "preparation.expansion");
  refused([](pack::Recipe& r) { r.contacts.fabric_anisotropy = 0.2; }, "target.fabric_anisotropy");
  refused([](pack::Recipe& r) { r.preparation.strain_difference = 0.2; }, "preparation.strain_difference");
  refused(
      [](pack::Recipe& r) {
        r.contacts = {5, 0.05, 0.1, 0.05, 2};
        r.preparation.strain_difference = 0.2;
      },
      "preparation.strain_difference");
  refused([](pack::Recipe& r) { r.stress.reset(), r.void_ratio = 0.6, r.preparation.expansion = 0.01; },
          "preparation.expansion");
  refused([](pack::Recipe& r) { r.void_ratio = 0.6, r.preparation.least_expansion = 0.01; },
          "preparation.least_expansion");
  refused(
      [](pack::Recipe& r) {
        r.void_ratio = 0.6, r.preparation.expansion = 0.01, r.preparation.least_expansion = 0;
        r.contacts.fabric_anisotropy = 0.2;
      },
      "preparation.least_expansion = 0");
  refused([](pack::Recipe& r) { r = discs(), r.contacts.coordination_number = 3, r.contacts.axis = 2; },
          "target.fabric_direction");
}

TEST_CASE("the root of a function that scatters is found, and one beyond the range is known to be") {
  Uniform uniform(3);
  for (const double slope : {-0.8, 0.4}) {
    pack::NoisyRoot root(-5, 5, 4, 2 * slope, 0.05);
    const auto value = [&](double x) { return slope * (x - 1) + 0.05 * slope * (x - 1) * (x - 1); };
    int within = 0;
    for (int k = 0; k < 40; ++k) {
      const double at = root.next(), found = value(at) + 0.1 * (uniform() - 0.5);
      root.add(at, found);
      if (k >= 20 && std::abs(found) < 0.05) ++within;
    }
    CHECK(within >= 16);
    CHECK(root.next() == Approx(1).margin(0.05));
    CHECK_FALSE(root.out_of_range());
  }
  pack::NoisyRoot beyond(0, 1, 0.5, 1, 0.05);
  for (int k = 0; k < 8 && !beyond.out_of_range(); ++k) {
    const double at = beyond.next();
    beyond.add(at, at - 2);
  }
  CHECK(beyond.out_of_range());
  CHECK(beyond.next() == 1);
}
