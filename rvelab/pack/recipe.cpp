#include "rvelab/pack/recipe.hpp"

#include <algorithm>
#include <cmath>

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

bool is_agitated(const Recipe& recipe) { return recipe.contacts.coordination_number || recipe.preparation.expansion; }

int fabric_axis(const Recipe& recipe) { return recipe.contacts.axis.value_or(dimension_of(recipe.shape) - 1); }

double anisotropy_along(const Matrix3& fabric, int dimension, int axis) {
  const double part = fabric(axis, axis);
  return dimension == 2 ? 4 * (part - 0.5) : 45.0 / 4 * (part - 1.0 / 3);
}

/// What agitates without need or means.
void check_agitation(const Recipe& recipe) {
  const Preparation& p = recipe.preparation;
  const ContactTarget& contacts = recipe.contacts;
  if (contacts.coordination_number && p.expansion)
    throw InputError(
        "preparation.expansion contradicts target.coordination_number, for which it is searched; allowed: one of the "
        "two; remove one");
  if (p.least_expansion && !(p.expansion && recipe.void_ratio && *p.least_expansion <= *p.expansion))
    throw InputError(
        "preparation.least_expansion = " + in_words(*p.least_expansion) +
        " is what a larger preparation.expansion is reduced to for a density; allowed: with "
        "preparation.expansion, not above it, and target.void_ratio or relative_density; add or change one");
  if (p.least_expansion == 0.0 && (contacts.fabric_anisotropy || p.strain_difference))
    throw InputError(
        "preparation.least_expansion = 0 ends without agitation, which target.fabric_anisotropy and "
        "preparation.strain_difference need; allowed: above 0; give a small one, 1e-4");
  if (contacts.fabric_anisotropy && p.strain_difference)
    throw InputError(
        "preparation.strain_difference contradicts target.fabric_anisotropy, for which it is searched; allowed: one of "
        "the two; remove one");
  if ((contacts.fabric_anisotropy || p.strain_difference) && !is_agitated(recipe))
    throw InputError(
        std::string(contacts.fabric_anisotropy ? "target.fabric_anisotropy" : "preparation.strain_difference") +
        " needs agitated grains; allowed: with target.coordination_number or preparation.expansion; add one");
  if (is_agitated(recipe) && !recipe.stress)
    throw InputError(
        std::string(contacts.coordination_number ? "target.coordination_number" : "preparation.expansion") +
        " needs a stress, which the contacts carry; allowed: with target.pressure_Pa or target.stress_Pa; add one");
  if (contacts.axis && *contacts.axis >= dimension_of(recipe.shape))
    throw InputError("target.fabric_direction = \"z\" is across the plane; allowed: \"x\" or \"y\" in 2D; give one");
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
  check_agitation(recipe);
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
