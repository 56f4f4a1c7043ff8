#include "rvelab/pack/recipe.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "rvelab/error.hpp"
#include "rvelab/pack/regular.hpp"

namespace rvelab::pack {

Matrix3 isotropic_stress(double pressure, Shape shape) {
  Matrix3 stress = Matrix3::Zero();
  for (int k = 0; k < dimension_of(shape); ++k) stress(k, k) = -pressure;
  return stress;
}

std::vector<Material> preparing(const Recipe& recipe, double friction) {
  std::vector<Material> materials = recipe.materials;
  for (Material& material : materials) {
    material.friction = friction;
    material.rolling_friction = std::min(material.rolling_friction, recipe.preparation.rolling_friction);
  }
  return materials;
}

double growth_void_ratio(const Recipe& recipe) {
  if (!recipe.stress) return *recipe.void_ratio;
  if (recipe.preparation.growth_void_ratio) return *recipe.preparation.growth_void_ratio;
  if (recipe.void_ratio) return *recipe.void_ratio + 0.1;
  return dimension_of(recipe.shape) == 2 ? 0.3 : 0.9;
}

void check_recipe(const Recipe& recipe) {
  if (recipe.number == 0 || recipe.fractions.empty() || recipe.materials.empty())
    throw InputError("a recipe needs at least one grain, one fraction and one material; add what is missing");
  if (!recipe.stress && !recipe.void_ratio)
    throw InputError("target has neither a stress nor a void ratio; allowed: one or both; add target.pressure_Pa");
  if (recipe.stress && recipe.void_ratio && recipe.preparation.friction)
    throw InputError(
        "preparation.friction contradicts target.void_ratio, for which the friction is searched; allowed: "
        "one of the two; remove one");
  check_parameters(recipe.contact, recipe.damping, recipe.materials);
  if (recipe.preparation.method == Preparation::Method::regular) check_regular(recipe);
  if (moves_as_body(recipe.shape) && (recipe.preparation.method != Preparation::Method::compression || !recipe.stress))
    throw InputError(
        "pack.shape = \"ellipsoid\" or \"superellipsoid\" with preparation.method = \"growth\" or \"regular\", or "
        "without a stress; allowed: method = \"compression\" with target.pressure_Pa or target.stress_Pa; change one");
  if (recipe.clumps && (recipe.preparation.method != Preparation::Method::compression || !recipe.stress))
    throw InputError(
        "pack.shape = \"clump\" with preparation.method = \"growth\" or \"regular\", or without a stress; allowed: "
        "method "
        "= \"compression\" with target.pressure_Pa or target.stress_Pa; change one");
  if (recipe.clumps && !is_round(recipe.shape)) throw InputError("clumps are made of discs or spheres");
  double shares = 0;
  for (const GrainFraction& fraction : recipe.fractions) {
    if (recipe.clumps != fraction.clump.has_value())
      throw InputError(fraction.table() + " has " + (recipe.clumps ? "no clump" : "a clump") + ", pack.shape is " +
                       (recipe.clumps ? "\"clump\"" : "not \"clump\"") + "; correct one");
    check_grading(fraction.grading, fraction.table().c_str());
    if (fraction.material >= recipe.materials.size())
      throw InputError(fraction.table() + " names a material that is not there; add it");
    shares += fraction.share;
  }
  if (!(std::abs(shares - 1) <= 1e-6)) {
    TextStream text;
    text << "the shares of the grains add up to " << shares << "; allowed: 1; correct grains.share";
    throw InputError(text.str());
  }
}

}  // namespace rvelab::pack
