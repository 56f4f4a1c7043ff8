#include "rvelab/pack/plausible.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "rvelab/error.hpp"
#include "rvelab/keys/material_toml.hpp"
#include "rvelab/keys/shortened.hpp"
#include "rvelab/keys/table_reader.hpp"

namespace rvelab::pack {
namespace {

constexpr double most_usual_overlap = 0.1, least_usual_overlap = 1e-9;  // over the radius

/// Force of a contact, N.
double mean_force(const Pressed& pressed) {
  const double r = pressed.radius;
  if (dimension_of(pressed.shape) == 2)
    return pressed.pressure * pressed.thickness * std::numbers::pi * r * 1.2 * 2 / 4;
  return pressed.pressure * std::numbers::pi * r * r * 1.65 * 4 / 5.5;
}

/// f_n of two grains of a material and this radius, N.
double force_at(const Pressed& pressed, const ContactModel& model, const Material& material, double overlap) {
  const double r = pressed.radius, section = grain_section(pressed.shape, r, pressed.thickness);
  const PairParameters pair = mix(model, Damping{}, material, r, 1, material, r, 1, section);
  return with_law(model.law, [&](auto law) {
    using Force = typename decltype(law)::Force;
    return Force::normal_force(pair.kn, overlap, Force::root(overlap, pair.law_constant), pair.law_constant);
  });
}

/// f_n grows in proportion to the stiffness that a law reads, but for a pull-off force, which stays: its value over
/// that of the material with which grains of that mean force overlap by so much.
double stiffness_ratio_at(const Pressed& pressed, const ContactModel& model, const Material& material, double overlap) {
  const double pull = -force_at(pressed, model, material, 0);
  return (mean_force(pressed) + pull) / (force_at(pressed, model, material, overlap) + pull);
}

/// The stiffness that a law reads is the first of its parameters.
const LawParameter& stiffness_of(Law law) {
  return *std::find_if(law_parameters().begin(), law_parameters().end(),
                       [&](const LawParameter& each) { return each.law == law; });
}

/// "material.sand.young_modulus_Pa = 70".
std::string stiffness_in_words(const ContactModel& model, const Material& material) {
  const LawParameter& stiffness = stiffness_of(model.law);
  return "material." + keys::shortened(material.name) + "." + stiffness.parameter.key + " = " +
         keys::as_toml(material.*stiffness.value);
}

/// "; likely in MPa or GPa: write ..." of a stiffness, by what leads to overlaps that are usual.
std::string likely(const Pressed& pressed, const ContactModel& model, const Material& material) {
  const LawParameter& stiffness = stiffness_of(model.law);
  const double given = material.*stiffness.value;
  const std::vector<keys::Key>& known = keys::known_keys();
  const auto key = std::find_if(known.begin(), known.end(),
                                [&](const keys::Key& each) { return each.name == stiffness.parameter.key; });
  const auto stiffness_at = [&](double wanted) {
    return given * stiffness_ratio_at(pressed, model, material, wanted * pressed.radius);
  };
  std::string text = keys::likely_unit(
      stiffness.parameter.unit, given,
      {{stiffness_at(most_usual_overlap), std::min(stiffness_at(least_usual_overlap), key->usual.values.high)}});
  if (dimension_of(pressed.shape) == 2 && pressed.thickness > 20 * pressed.radius)
    text += "; the slab is " + in_words(pressed.thickness / (2 * pressed.radius)) +
            " diameters thick, and the force on a grain grows with it";
  return text;
}

}  // namespace

double expected_overlap(const Pressed& pressed, const ContactModel& model, const Material& material) {
  // f_n grows with the overlap: halving of ratios, to the last bit.
  const double wanted = mean_force(pressed);
  double low = 1e-30, high = 1e30;
  while (high > low * (1 + 1e-15)) {
    const double middle = std::sqrt(low * high);
    if (middle <= low || middle >= high) break;
    (force_at(pressed, model, material, middle * pressed.radius) < wanted ? low : high) = middle;
  }
  return high;
}

void expect_possible(const Pressed& pressed, const ContactModel& model, const std::vector<Material>& materials) {
  if (!(pressed.pressure > 0) || !(pressed.radius > 0)) return;
  for (const Material& material : materials) {
    const double overlap = expected_overlap(pressed, model, material);
    if (!(overlap > 1)) continue;
    const LawParameter& stiffness = stiffness_of(model.law);
    const double least = material.*stiffness.value * stiffness_ratio_at(pressed, model, material, pressed.radius);
    throw InputError(stiffness_in_words(model, material) + " is too soft for " + pressed.by + " = " +
                     in_words(pressed.pressure) + ": grains would overlap by " + in_words(overlap) +
                     " of their radius, no such specimen exists; allowed: less than 1, above some " + in_words(least) +
                     " " + stiffness.parameter.unit + " here; " + likely(pressed, model, material));
  }
}

std::vector<std::string> unusual_overlaps(const Pressed& pressed, const ContactModel& model,
                                          const std::vector<Material>& materials) {
  std::vector<std::string> found;
  if (!(pressed.pressure > 0) || !(pressed.radius > 0)) return found;
  for (const Material& material : materials) {
    const double overlap = expected_overlap(pressed, model, material);
    if (overlap <= most_usual_overlap && overlap >= least_usual_overlap) continue;
    found.push_back(stiffness_in_words(model, material) + " with " + pressed.by + " = " + in_words(pressed.pressure) +
                    " is unusual: grains overlap by some " + in_words(overlap) +
                    " of their radius; usual: 1e-09 to 0.1; " + likely(pressed, model, material));
    break;  // one line a key
  }
  return found;
}

namespace {

/// Seconds that 60 superellipsoids of a longest over shortest half axis and a largest exponent up to these take. Flat
/// sides with sharp edges leave more pairs to the search by bounds, which took 0.7 of the time of exponents of 20; of
/// the last row, the whole range, no packing of 10 : 1 was awaited beyond a quarter of an hour.
constexpr struct {
  double aspect, exponent, seconds;
} measured_solids[] = {{10, 2, 0.4}, {10, 4, 20}, {2, 8, 23}, {10, largest_exponent, 1000}};

double seconds_of_solids(const GrainFraction& fraction) {
  const double aspect = fraction.half_axes.maxCoeff() / fraction.half_axes.minCoeff();
  const double exponent = std::max(fraction.exponent_xy, fraction.exponent_z);
  double seconds = std::numeric_limits<double>::infinity();
  for (const auto& row : measured_solids)
    if (aspect <= row.aspect && exponent <= row.exponent) seconds = std::min(seconds, row.seconds);
  return seconds;
}

}  // namespace

double expected_seconds(const Recipe& recipe) {
  const double number = double(recipe.number);
  if (moves_as_body(recipe.shape)) {
    double seconds = 0;
    for (const GrainFraction& fraction : recipe.fractions) seconds = std::max(seconds, seconds_of_solids(fraction));
    return seconds * std::pow(number / 60, 4.0 / 3);
  }
  double members = 1;
  for (const GrainFraction& fraction : recipe.fractions)
    if (fraction.clump) members = std::max(members, double(fraction.clump->members.size()));
  // 800 spheres of radii 1 : 2 take 0.70 s, 3200 discs 0.91 s; the steps grow with the edge of the cell.
  return members * (dimension_of(recipe.shape) == 2 ? 0.91 * std::pow(number / 3200, 1.5)
                                                    : 0.70 * std::pow(number / 800, 4.0 / 3));
}

Pressed pressed(const Specimen& specimen, const std::string& by, double pressure) {
  const auto& radius = specimen.grains.radius;
  if (radius.empty()) return {};
  const double mean = std::accumulate(radius.begin(), radius.end(), 0.0) / double(radius.size());
  return {by, pressure, specimen.shape, mean, specimen.cell.lattice(2, 2)};
}

std::vector<std::string> unusual_in(const Specimen& specimen) {
  std::vector<std::string> found = keys::unusual_materials(specimen.contact, specimen.materials);
  keys::Key radius;
  radius.unit = "m";
  radius.usual = keys::radii.usual;
  for (const double each : specimen.grains.radius) {
    const std::string why = keys::unusual_in(radius, each);
    if (why.empty()) continue;
    found.push_back("a radius of " + keys::as_toml(each) + " m " + why);
    break;
  }
  return found;
}

}  // namespace rvelab::pack
