#include "rvelab/measure/proportions.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "rvelab/measure/measures.hpp"

namespace rvelab {

namespace {

std::string digits(const char* format, double value) {
  char text[32];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

/// Three digits, large numbers without an exponent: 8400.
std::string three_digits(double value) {
  if (!(value >= 100)) return digits("%.3g", value);
  const double step = std::pow(10.0, std::floor(std::log10(value)) - 2);
  return digits("%.0f", step * std::round(value / step));
}

}  // namespace

Proportions proportions_of(const Network& network) {
  constexpr double not_defined = std::numeric_limits<double>::quiet_NaN();
  Proportions p;
  p.dimension = network.dimension();
  p.void_ratio = void_ratio(network);
  p.largest_overlap = largest_overlap_ratio(network);
  const double diameter = mean_diameter(network), contacts = double(network.contacts.size());
  double stiffness = 0;
  for (const ContactState& contact : network.contacts) {
    const double smaller =
        std::min(network.grains[std::size_t(contact.i)].radius, network.grains[std::size_t(contact.j)].radius);
    p.mean_overlap += contact.overlap / smaller / contacts;
    stiffness += contact.normal_stiffness / contacts;
  }
  const double pressure = mean_pressure(contact_stress(network), p.dimension);
  const double width = p.dimension == 2 ? network.cell.lattice(2, 2) : diameter;
  p.stiffness_level = pressure > 0 ? stiffness / (pressure * width) : not_defined;
  if (network.contacts.empty()) p.mean_overlap = p.largest_overlap = not_defined;
  for (int k = 0; k < p.dimension; ++k) p.cell_edges[k] = network.cell.lattice.col(k).norm() / diameter;
  return p;
}

std::string in_words(const Proportions& p) {
  std::string text = "void ratio " + digits("%.4g", p.void_ratio) + ", ";
  if (std::isnan(p.largest_overlap))
    text += "no contact";
  else
    text += "overlap " + digits("%.3g", p.mean_overlap) + " r (largest " + digits("%.3g", p.largest_overlap) + " r)";
  if (!std::isnan(p.stiffness_level))
    text += std::string(", kn/(p ") + (p.dimension == 2 ? "t) " : "d) ") + three_digits(p.stiffness_level);
  text += ", cell ";
  for (int k = 0; k < p.dimension; ++k) text += (k > 0 ? " x " : "") + digits("%.3g", p.cell_edges[k]);
  return text + " diameters";
}

}  // namespace rvelab
