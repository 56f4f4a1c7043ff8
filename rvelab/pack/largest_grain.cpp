#include "rvelab/pack/largest_grain.hpp"

#include <algorithm>
#include <cmath>

#include "rvelab/error.hpp"
#include "rvelab/pack/mass_curve.hpp"

namespace rvelab::pack {

std::vector<std::pair<double, double>> radii_and_masses(const Specimen& specimen) {
  const Grains& grains = specimen.grains;
  const int d = specimen.cell.dimension;
  const double unit = grain_volume(specimen.shape, 1, specimen.cell.lattice(2, 2));
  std::vector<std::pair<double, double>> found;
  const auto add = [&](double volume, std::size_t row) {
    found.emplace_back(root_of(volume / unit, d),
                       specimen.materials[std::size_t(grains.material[row])].density * volume);
  };
  if (!specimen.bodies.empty()) {
    for (const Body& body : specimen.bodies) add(body.volume, std::size_t(body.first));
  } else {
    for (std::size_t g = 0; g < grains.size(); ++g) add(unit * power_of(grains.radius[g], d), g);
  }
  return found;
}

LargestGrain largest_grain(const Specimen& specimen) {
  double mass = 0, heaviest = 0, radius = 0;
  const auto grains = radii_and_masses(specimen);
  for (const auto& grain : grains) {
    mass += grain.second;
    heaviest = std::max(heaviest, grain.second);
    radius = std::max(radius, grain.first);
  }
  const int d = specimen.cell.dimension;
  const double number = double(grains.size());
  LargestGrain largest{heaviest / mass, heights(specimen.cell).head(d).minCoeff() / (2 * radius)};
  largest.number_by_share = number * largest.mass_share / usual_mass_share;
  largest.number_by_widths = number * std::pow(usual_cell_widths / largest.cell_widths, d);
  return largest;
}

std::string unusual_in_words(const LargestGrain& largest, const std::string& grains) {
  const auto takes = [&](double number) {
    const std::string whole = number < 1e15 ? std::to_string(long(std::ceil(number))) : in_words(number);
    return ", which takes " + whole + " grains " + grains;
  };
  std::string text;
  if (largest.mass_share > usual_mass_share)
    text = "the largest grain has " + in_words(0.1 * std::round(1000 * largest.mass_share)) +
           " % of the mass; usual: up to 5 %" + takes(largest.number_by_share);
  if (largest.cell_widths < usual_cell_widths)
    text += (text.empty() ? "" : "; ") + std::string("the cell is about ") +
            in_words(0.01 * std::round(100 * largest.cell_widths)) + " largest diameters wide; usual: 3 or more" +
            takes(largest.number_by_widths);
  return text;
}

}  // namespace rvelab::pack
