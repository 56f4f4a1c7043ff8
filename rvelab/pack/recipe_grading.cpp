#include "rvelab/pack/recipe_grading.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "rvelab/error.hpp"
#include "rvelab/pack/largest_grain.hpp"
#include "rvelab/pack/mass_curve.hpp"
#include "rvelab/pack/scatter.hpp"

namespace rvelab::pack {
namespace {

std::vector<NumberCurve> curves_of(const Recipe& recipe) {
  std::vector<NumberCurve> curves;
  for (const GrainFraction& fraction : recipe.fractions)
    curves.push_back(number_curve(fraction.grading, dimension_of(recipe.shape)));
  return curves;
}

double density_of(const Recipe& recipe, std::size_t fraction) {
  return recipe.materials[recipe.fractions[fraction].material].density;
}

/// Means of one grain of a recipe, and its largest.
struct MeanGrain {
  double smallest = 0, top = 0;  ///< radii at the ends of the grading, m
  double solid = 0, mass = 0;    ///< mean volume, m^3, and mass, kg
  double heaviest = 0;           ///< kg
  double space = 0;              ///< m^d, with its voids
};

MeanGrain mean_grain(const Recipe& recipe) {
  const int d = dimension_of(recipe.shape);
  const std::vector<NumberCurve> curves = curves_of(recipe);
  const std::vector<double> parts = parts_of(recipe, curves);
  const double sum = std::accumulate(parts.begin(), parts.end(), 0.0);
  const double volume = grain_volume(recipe.shape, 1, recipe.thickness);
  MeanGrain mean;
  mean.smallest = curves.front().radii.front();
  for (std::size_t f = 0; f < curves.size(); ++f) {
    const double solid = parts[f] / sum * volume * curves[f].mean_power(d), top = curves[f].radii.back();
    mean.smallest = std::min(mean.smallest, curves[f].radii.front());
    mean.top = std::max(mean.top, top);
    mean.heaviest = std::max(mean.heaviest, density_of(recipe, f) * volume * power_of(top, d));
    mean.solid += solid;
    mean.mass += density_of(recipe, f) * solid;
  }
  const double e = recipe.void_ratio.value_or(d == 2 ? 0.2 : 0.65);
  mean.space = mean.solid * (1 + e) / (d == 2 ? recipe.thickness : 1);
  return mean;
}

/// By the largest grain of the grading, the numbers of grains that it takes.
LargestGrain largest_of(const MeanGrain& mean, double number, int d) {
  LargestGrain largest;
  largest.mass_share = mean.heaviest / (number * mean.mass);
  largest.cell_widths = std::pow(number * mean.space, 1.0 / d) / (2 * mean.top);
  largest.number_by_share = mean.heaviest / (usual_mass_share * mean.mass);
  largest.number_by_widths = std::pow(2 * mean.top * usual_cell_widths, d) / mean.space;
  return largest;
}

/// The same by the grains that the seed draws; the numbers are those of the grading.
LargestGrain drawn_largest(const Recipe& recipe, const MeanGrain& mean) {
  constexpr std::size_t drawn_quickly = 100'000;
  const int d = dimension_of(recipe.shape);
  LargestGrain largest = largest_of(mean, double(recipe.number), d);
  if (recipe.number > drawn_quickly) return largest;
  const Grains grains = graded_grains(recipe);
  double mass = 0, heaviest = 0, radius = 0, solid = 0;
  for (std::size_t g = 0; g < grains.size(); ++g) {
    const double power = power_of(grains.radius[g], d),
                 each = recipe.materials[std::size_t(grains.material[g])].density * power;
    radius = std::max(radius, grains.radius[g]);
    heaviest = std::max(heaviest, each);
    solid += power;
    mass += each;
  }
  largest.mass_share = heaviest / mass;
  const double volume = grain_volume(recipe.shape, 1, recipe.thickness);
  largest.cell_widths = std::pow(solid * volume * mean.space / mean.solid, 1.0 / d) / (2 * radius);
  return largest;
}

/// ", or cut the grading (grains.scalp_above_mm = 0.31 makes these enough and cuts off 45 % of the mass)": the largest
/// diameter, by halving, in three digits. Of several fractions the key alone; "" of grains of one size.
std::string scalping_in_words(const Recipe& recipe) {
  const std::string cut = ", or cut the grading (grains.scalp_above_mm";
  if (recipe.fractions.size() > 1) return cut + ")";
  const int d = dimension_of(recipe.shape);
  const NumberCurve curve = number_curve(recipe.fractions[0].grading, d);
  Recipe scalped = recipe;
  const auto enough = [&](double radius) {
    scalped.fractions[0].grading.scalp_above = radius;
    constexpr double reserve = 0.8;  // the density is not known yet
    return largest_of(mean_grain(scalped), reserve * double(recipe.number), d).is_usual();
  };
  double low = curve.radii.front(), high = curve.radii.back();
  for (int halving = 0; halving < 30; ++halving) {
    const double middle = 0.5 * (low + high);
    (enough(middle) ? low : high) = middle;
  }
  const double diameter = in_three_digits_down(2e3 * low), radius = 5e-4 * diameter;
  if (!(radius > curve.radii.front()) || !enough(radius)) return "";
  return cut + " = " + in_words(diameter) + " makes these enough and cuts off " +
         in_words(0.1 * std::round(1000 * (1 - MassCurve(curve, d).passing_at(radius)))) + " % of the mass)";
}

}  // namespace

std::vector<double> asked_diameters(const Recipe& recipe) {
  const int d = dimension_of(recipe.shape);
  const std::vector<NumberCurve> by_number = curves_of(recipe);
  const std::vector<double> parts = parts_of(recipe, by_number);
  std::vector<MassCurve> curves;
  std::vector<double> masses;
  double low = by_number.front().radii.front(), high = low, all = 0;
  for (std::size_t f = 0; f < by_number.size(); ++f) {
    curves.emplace_back(by_number[f], d);
    masses.push_back(parts[f] * density_of(recipe, f) * curves[f].mean_power());
    all += masses[f];
    low = std::min(low, by_number[f].radii.front());
    high = std::max(high, by_number[f].radii.back());
  }
  std::vector<double> diameters;
  for (const double part : compared_parts) {
    double below = low, above = high;
    for (int halving = 0; halving < 60; ++halving) {
      const double middle = 0.5 * (below + above);
      double passing = 0;
      for (std::size_t f = 0; f < curves.size(); ++f) passing += masses[f] * curves[f].passing_at(middle);
      (passing < part * all ? below : above) = middle;
    }
    diameters.push_back(2 * above);
  }
  return diameters;
}

ScalpedMass scalped_mass(const GrainFraction& fraction, int dimension) {
  Grading whole = fraction.grading;
  whole.scalp_below = Grading{}.scalp_below;
  whole.scalp_above = Grading{}.scalp_above;
  const MassCurve curve(number_curve(whole, dimension), dimension);
  return {curve.passing_at(fraction.grading.scalp_below), 1 - curve.passing_at(fraction.grading.scalp_above)};
}

std::vector<std::string> too_few_grains(const Recipe& recipe) {
  const MeanGrain mean = mean_grain(recipe);
  const LargestGrain largest = drawn_largest(recipe, mean);
  if (largest.is_usual()) return {};
  return {"pack.number = " + std::to_string(recipe.number) + " is few for radii of " + in_words(mean.smallest) +
          " to " + in_words(mean.top) + " m (1 : " + in_words(mean.top / mean.smallest) +
          "): " + unusual_in_words(largest, "of this grading") + "; give more" + scalping_in_words(recipe)};
}

}  // namespace rvelab::pack
