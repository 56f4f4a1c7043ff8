#include "rvelab/pack/sampling.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>

namespace rvelab::pack {
namespace {

/// d10 is the grain that holds 10 % of the mass between its own ends, by at least this part of it from each: sums of
/// masses are rounded.
constexpr double margin = 0.05;

/// A radius that the curve has: of one in a gap or beyond the ends, the next larger, or the end.
double of_curve(const NumberCurve& curve, double radius) {
  const double next = curve.radius_at(curve.passing_at(radius));
  return std::abs(next - radius) > 1e-9 * radius ? next : radius;
}

/// Adds `count` strata of equal number between two parts of the mass, each a grain of its mean mass, times `scale` in
/// mass; none where the curve has no grain between the two.
void add_strata(const MassCurve& curve, double from, double to, std::size_t count, double scale,
                std::vector<double>& radii) {
  const double first = curve.number_at(from), last = to < 1 ? curve.number_at(to) : 1, width = last - first;
  if (!(width > 0)) return;
  double below = from;
  for (std::size_t k = 1; k <= count; ++k) {
    const double up_to = k == count ? to : curve.mass_at(first + width * (double(k) / double(count)));
    const double power = (up_to - below) * curve.mean_power() * double(count) / width;
    radii.push_back(of_curve(curve.by_number(), root_of(scale * power, curve.dimension())));
    below = up_to;
  }
}

/// Strata between two parts of the mass.
struct Block {
  double from, to;
  std::size_t count;
  double wanted;  ///< number of grains of the curve that have this mass, not whole
};

/// Blocks between the grains at d90, d50 and d10, from the largest grains to the smallest.
struct Design {
  std::vector<Block> blocks;
  std::vector<double> fixed;  ///< radii at d90, d50, d10
  double grains = 0;          ///< in all, of which those of the last block need not be whole
};

/// The design whose mass is that of `total` grains of the curve; none if the three grains overlap.
std::optional<Design> design_of(const MassCurve& curve, double total) {
  Design design;
  double upper = 1;
  for (const double part : {compared_parts[2], compared_parts[1], compared_parts[0]}) {
    const double radius = curve.radius_at(part);
    const double width = power_of(radius, curve.dimension()) / (total * curve.mean_power());
    // The upper end of this grain lies between these, and below the grains above.
    const double low = part + margin * width, high = std::min(part + (1 - margin) * width, upper);
    if (!(low <= high)) return std::nullopt;
    const double number = upper < 1 ? curve.number_at(upper) : 1;
    const auto above = [&](double mass) { return mass < 1 ? total * (number - curve.number_at(mass)) : 0; };
    const double fewest = above(high), most = above(low);
    double count = std::round(above(std::min(part + 0.5 * width, high)));
    if (std::ceil(fewest) <= std::floor(most))
      count = std::clamp(count, std::ceil(fewest), std::floor(most));
    else
      count = std::max(1.0, count);
    const double end = std::clamp(curve.mass_at(number - count / total), low, high);
    design.blocks.push_back({end, upper, std::size_t(count), above(end)});
    design.fixed.push_back(radius);
    design.grains += 1 + count;
    upper = end - width;
  }
  if (!(upper >= 0)) return std::nullopt;
  design.blocks.push_back({0, upper, 0, total * curve.number_at(upper)});
  design.grains += design.blocks.back().wanted;
  return design;
}

/// The design of `count` grains; none if d10, d50 and d90 cannot have grains of their own.
std::optional<Design> design_for(const MassCurve& curve, std::size_t count) {
  double low = 0.25 * double(count), high = 4 * double(count);
  for (int halving = 0; halving < 60; ++halving) {
    const double total = 0.5 * (low + high);
    const auto design = design_of(curve, total);
    (design && design->grains > double(count) ? high : low) = total;
  }
  auto design = design_of(curve, low);
  if (!design) design = design_of(curve, high);
  if (!design) return std::nullopt;
  std::size_t larger = design->fixed.size();
  for (const Block& block : design->blocks) larger += block.count;
  if (larger >= count) return std::nullopt;
  design->blocks.back().count = count - larger;
  return design;
}

std::vector<double> grains_of(const Design& design, const MassCurve& curve) {
  std::vector<double> radii = design.fixed;
  for (const Block& block : design.blocks) {
    if (block.count == 0) continue;
    add_strata(curve, block.from, block.to, block.count, block.wanted / double(block.count), radii);
  }
  std::sort(radii.begin(), radii.end());
  return radii;
}

}  // namespace

double deviation_of(const std::vector<double>& radii, const MassCurve& curve) {
  std::vector<std::pair<double, double>> grains;
  for (const double radius : radii) grains.emplace_back(radius, power_of(radius, curve.dimension()));
  const std::vector<double> parts(std::begin(compared_parts), std::end(compared_parts));
  const std::vector<double> drawn = radii_passing(std::move(grains), parts);
  double largest = 0;
  for (std::size_t k = 0; k < parts.size(); ++k)
    largest = std::max(largest, std::abs(drawn[k] / curve.radius_at(parts[k]) - 1));
  return largest;
}

Sample stratified_sample(const MassCurve& curve, std::size_t count, double mean_power) {
  constexpr double near_enough = 0.01;  // up to here the strata alone, whose ends have the mass of the curve
  // Powers of the radii that no double holds.
  const bool countable = curve.mean_power() > 0 && std::isfinite(curve.mean_power());
  if (!countable) return {std::vector(count, curve.by_number().radii.front()), std::numeric_limits<double>::infinity()};
  Sample sample;
  add_strata(curve, 0, 1, count, 1, sample.radii);
  sample.deviation = deviation_of(sample.radii, curve);
  if (sample.deviation > near_enough) {
    if (const auto design = design_for(curve, count)) {
      Sample other{grains_of(*design, curve), 0};
      other.deviation = deviation_of(other.radii, curve);
      if (other.radii.size() == count && other.deviation < sample.deviation) sample = std::move(other);
    }
  }
  const NumberCurve& by_number = curve.by_number();
  if (by_number.radii.front() == by_number.radii.back()) sample = {std::vector(count, by_number.radii.front()), 0};
  if (mean_power > 0) {
    double sum = 0;
    for (const double radius : sample.radii) sum += power_of(radius, curve.dimension());
    const double factor = root_of(mean_power * double(count) / sum, curve.dimension());
    for (double& radius : sample.radii) radius *= factor;
    sample.deviation = deviation_of(sample.radii, curve);
  }
  return sample;
}

}  // namespace rvelab::pack
