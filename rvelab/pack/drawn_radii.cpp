#include "rvelab/pack/drawn_radii.hpp"

#include <cmath>
#include <utility>

#include "rvelab/error.hpp"
#include "rvelab/pack/sampling.hpp"

namespace rvelab::pack {
namespace {

/// Of a recipe of several fractions whose shares are by mass: the mean of r^d that gives this one its share; else 0.
double mean_power_by_share(const Recipe& recipe, std::size_t f, const std::vector<NumberCurve>& curves,
                           const std::vector<std::size_t>& numbers) {
  if (!recipe.share_by_mass || curves.size() == 1) return 0;
  const int d = dimension_of(recipe.shape);
  const auto density = [&](std::size_t each) { return recipe.materials[recipe.fractions[each].material].density; };
  double mass = 0;
  for (std::size_t each = 0; each < curves.size(); ++each)
    mass += double(numbers[each]) * density(each) * curves[each].mean_power(d);
  return recipe.fractions[f].share * mass / (double(numbers[f]) * density(f));
}

/// A number of grains, above `count`, that keeps the tolerance; 0: none up to a million does.
std::size_t enough(const MassCurve& curve, std::size_t count, bool by_share) {
  const auto keeps = [&](std::size_t number) {
    // By shares of the mass, the number is off by up to half a grain.
    const double mean_power = by_share ? curve.mean_power() * (1 + 0.5 / double(number)) : 0;
    return stratified_sample(curve, number, mean_power).deviation <= sampling_tolerance;
  };
  constexpr std::size_t most = 1'000'000;
  std::size_t low = count, high = count;
  do {
    low = high;
    high *= 2;
    if (high > most) return 0;
  } while (!keeps(high));
  while (high - low > 1 + high / 100) {
    const std::size_t middle = low + (high - low) / 2;
    (keeps(middle) ? high : low) = middle;
  }
  return high;
}

/// ", or grains.scalp_below_mm = 0.31, which cuts off 12 % of the mass": the smallest cut in steps of a percent with
/// which `count` grains keep the tolerance; "" if none does.
std::string sufficient_scalping(const GrainFraction& fraction, int dimension, std::size_t count) {
  Grading grading = fraction.grading;
  const MassCurve all(number_curve(grading, dimension), dimension);
  for (int percent = 1; percent < 50; ++percent) {
    const double diameter = in_three_digits_down(2e3 * all.radius_at(0.01 * percent));  // mm
    if (!(5e-4 * diameter > all.by_number().radii.front())) continue;
    grading.scalp_below = 5e-4 * diameter;
    const MassCurve rest(number_curve(grading, dimension), dimension);
    if (stratified_sample(rest, count).deviation > sampling_tolerance) continue;
    return ", or " + fraction.table() + ".scalp_below_mm = " + in_words(diameter) + ", which cuts off " +
           in_words(0.1 * std::round(1000 * all.passing_at(grading.scalp_below))) + " % of the mass";
  }
  return "";
}

[[noreturn]] void refuse_sample(const Recipe& recipe, std::size_t f, const MassCurve& curve, std::size_t count,
                                double deviation) {
  const GrainFraction& fraction = recipe.fractions[f];
  const std::size_t takes = enough(curve, count, recipe.share_by_mass && recipe.fractions.size() > 1);
  const std::string number = std::to_string(std::size_t(std::ceil(double(takes) / double(count) * recipe.number)));
  throw InputError(fraction.table() + ".sampling = \"stratified\" keeps d10, d50 and d90 by mass within 3 %; with " +
                   std::to_string(count) + " grains one of them is off by " +
                   in_words(0.1 * std::round(1000 * deviation)) + " %; allowed: " +
                   (takes > 0 ? "pack.number = " + number + " or more" : "more than a million grains of this grading") +
                   sufficient_scalping(fraction, curve.dimension(), count) +
                   "; raise the number, cut the grading, or give sampling = \"random\"");
}

}  // namespace

std::vector<double> drawn_radii(const Recipe& recipe, std::size_t f, const std::vector<NumberCurve>& curves,
                                const std::vector<std::size_t>& numbers, Uniform& uniform) {
  if (recipe.fractions[f].sampling == Sampling::random) return radii_of(curves[f], numbers[f], uniform);
  const MassCurve curve(curves[f], dimension_of(recipe.shape));
  Sample sample = stratified_sample(curve, numbers[f], mean_power_by_share(recipe, f, curves, numbers));
  if (!(sample.deviation <= sampling_tolerance)) refuse_sample(recipe, f, curve, numbers[f], sample.deviation);
  shuffle(sample.radii, uniform);
  return std::move(sample.radii);
}

}  // namespace rvelab::pack
