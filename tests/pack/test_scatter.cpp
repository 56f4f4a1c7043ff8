// Grains scattered in a cell: none touches another, their grading is the recipe's.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>
#include <numeric>

#include "rvelab/error.hpp"
#include "rvelab/pack/scatter.hpp"
#include "tests/catch.hpp"
#include "tests/pack/recipes.hpp"

using namespace rvelab;
using namespace rvelab::test;
using Catch::Matchers::Contains;

namespace {

/// Smallest gap between two grains of a cell over all images near, over the smaller radius.
double smallest_gap(const Cell& cell, const Grains& grains) {
  double smallest = 1e300;
  const int nz = cell.dimension == 3 ? 2 : 0;
  for (std::size_t i = 0; i < grains.size(); ++i)
    for (std::size_t j = i; j < grains.size(); ++j)
      for (int z = -nz; z <= nz; ++z)
        for (int y = -2; y <= 2; ++y)
          for (int x = -2; x <= 2; ++x) {
            if (i == j && x == 0 && y == 0 && z == 0) continue;
            const Vector3 b = grains.position[j] - grains.position[i] + translation(cell, {x, y, z});
            const double gap = b.norm() - grains.radius[i] - grains.radius[j];
            smallest = std::min(smallest, gap / std::min(grains.radius[i], grains.radius[j]));
          }
  return smallest;
}

}  // namespace

TEST_CASE("scattered grains do not touch, across the faces of upright and oriented cells") {
  for (const bool oriented : {false, true}) {
    for (pack::Recipe recipe : {discs(60), spheres(60)}) {
      recipe.oriented = oriented;
      Grains grains = pack::graded_grains(recipe);
      const double fraction = recipe.shape == Shape::disc ? 0.45 : 0.25;
      const Cell cell = pack::cell_of(recipe, pack::solid_volume(recipe, grains) / fraction);
      Uniform uniform(5);
      REQUIRE(pack::scatter(recipe.shape, cell, 1, grains, uniform));
      CHECK(smallest_gap(cell, grains) > 0);
      for (const Vector3& at : grains.position)
        for (int k = 0; k < cell.dimension; ++k) CHECK(std::abs(at[k]) <= 0.5 * cell.lattice(k, k) * (1 + 1e-12));
    }
  }
}

TEST_CASE("few grains, and one, find their place; too many in too small a cell do not") {
  for (const std::size_t number : {std::size_t{1}, std::size_t{2}, std::size_t{5}}) {
    const pack::Recipe recipe = discs(number);
    Grains grains = pack::graded_grains(recipe);
    Uniform uniform(1);
    const double solid = pack::solid_volume(recipe, grains);
    CHECK(!pack::scatter(recipe.shape, pack::cell_of(recipe, 1.01 * solid), 1, grains, uniform));
    REQUIRE(pack::scatter(recipe.shape, pack::cell_of(recipe, 4 * solid), 1, grains, uniform));
    CHECK(smallest_gap(pack::cell_of(recipe, 4 * pack::solid_volume(recipe, grains)), grains) > 0);
  }
}

TEST_CASE("a mixture has its shares by number or by mass, densities counted") {
  pack::Recipe recipe = spheres(3000);
  recipe.materials.push_back(recipe.materials[0]);
  recipe.materials[1].name = "heavy";
  recipe.materials[1].density = 2 * recipe.materials[0].density;
  recipe.fractions = {{"coarse", 0.4, 1, {}}, {"fine", 0.6, 0, {}}};
  recipe.fractions[0].grading.smallest_radius = recipe.fractions[0].grading.largest_radius = 2e-3;
  recipe.fractions[1].grading.smallest_radius = recipe.fractions[1].grading.largest_radius = 1e-3;
  const auto shares = [&](bool by_mass) {
    recipe.share_by_mass = by_mass;
    const Grains grains = pack::graded_grains(recipe);
    std::map<int, double> sum;
    double all = 0;
    for (std::size_t g = 0; g < grains.size(); ++g) {
      const Material& material = recipe.materials[std::size_t(grains.material[g])];
      const double weight = by_mass ? material.density * std::pow(grains.radius[g], 3) : 1;
      sum[grains.material[g]] += weight;
      all += weight;
    }
    CHECK(grains.size() == 3000);
    return sum[1] / all;
  };
  CHECK(shares(false) == Approx(0.4).margin(1e-12));
  CHECK(shares(true) == Approx(0.4).margin(0.002));  // one coarse grain is 16 fine ones
  recipe.number = 10;
  CHECK_THROWS_WITH(pack::graded_grains(recipe), Contains("grains.coarse gets no grain of 10"));
}

TEST_CASE("the grains of a recipe are the same for every draw, and others for another seed") {
  pack::Recipe recipe = discs();
  const auto radii = pack::graded_grains(recipe).radius;
  CHECK(pack::graded_grains(recipe).radius == radii);
  recipe.seed = 2;
  CHECK(pack::graded_grains(recipe).radius != radii);
}

TEST_CASE("grains of a wide grading get the places that looking at all of them gives") {
  for (pack::Recipe recipe : {discs(300), spheres(300)}) {
    Grading& grading = recipe.fractions[0].grading;
    grading = {GradingCurve::linear, false, 2e-5, 2e-3, {}, {}};  // 1 : 100, seven halvings of the radius
    Grains grains = pack::graded_grains(recipe), compared = grains;
    const Cell cell = pack::cell_of(recipe, pack::solid_volume(recipe, grains) / 0.25);
    Uniform uniform(3), again(3);
    REQUIRE(pack::scatter(recipe.shape, cell, 1, grains, uniform));
    std::vector<std::size_t> order(grains.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return grains.radius[a] > grains.radius[b]; });
    for (std::size_t n = 0; n < order.size(); ++n) {
      const std::size_t g = order[n];
      const auto free = [&](const Vector3& at) {
        for (std::size_t m = 0; m < n; ++m) {
          Vector3 branch = compared.position[order[m]] - at;
          wrap(cell, branch);
          const double reach = compared.radius[order[m]] + compared.radius[g];
          for (int image = 0; image < 27; ++image) {
            const Image shift{image % 3 - 1, image / 3 % 3 - 1, cell.dimension == 3 ? image / 9 - 1 : 0};
            if ((branch + translation(cell, shift)).squaredNorm() < reach * reach) return false;
          }
        }
        return true;
      };
      Vector3 at;
      do {
        Vector3 part = Vector3::Zero();
        for (int axis = 0; axis < cell.dimension; ++axis) part[axis] = again() - 0.5;
        at = cell.lattice * part;
        wrap(cell, at);
      } while (!free(at));
      compared.position[g] = at;
    }
    CHECK(grains.position == compared.position);
  }
}

TEST_CASE("a draw says where it is, and stops in every phase") {
  const pack::Recipe recipe = discs(60);
  std::vector<std::string> phases;
  pack::draw(recipe, 1, 0.1, {nullptr, [&](const std::string& phase) {
                                const std::string name = phase.substr(0, phase.find(','));
                                if (phases.empty() || phases.back() != name) phases.push_back(name);
                              }});
  REQUIRE(phases.size() >= 4);
  CHECK(phases.front() == "scattering the grains");
  for (const std::string& phase : phases) {
    CAPTURE(phase);
    std::atomic<bool> stop{false};
    CHECK_THROWS_AS(
        pack::draw(recipe, 1, 0.1, {&stop, [&](const std::string& now) { stop = stop || now.starts_with(phase); }}),
        Interrupted);
  }
}
