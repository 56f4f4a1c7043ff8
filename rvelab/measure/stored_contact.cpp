#include "rvelab/measure/stored_contact.hpp"

#include <algorithm>
#include <cmath>

#include "rvelab/solver/assembly/pair_place.hpp"

namespace rvelab {

Vector3 branch_of(const Specimen& specimen, const Contact& contact) {
  const auto& position = specimen.grains.position;
  return position[static_cast<std::size_t>(contact.j)] + translation(specimen.cell, contact.image) -
         position[static_cast<std::size_t>(contact.i)];
}

namespace {

EllipsePlace ellipses_of(const Specimen& specimen, const Contact& contact) {
  const Vector3 b = branch_of(specimen, contact);
  const Grains& g = specimen.grains;
  const auto form = [&](std::int32_t k) {
    return EllipseForm{g.semi_major[std::size_t(k)], g.semi_minor[std::size_t(k)], g.orientation[std::size_t(k)][0],
                       g.orientation[std::size_t(k)][1]};
  };
  return place_of_ellipses({b[0], b[1], 0}, form(contact.i), form(contact.j));
}

}  // namespace

Vector3 normal_of(const Specimen& specimen, const Contact& contact) {
  if (specimen.shape != Shape::ellipse) return branch_of(specimen, contact).normalized();
  const Branch n = ellipses_of(specimen, contact).normal;
  return {n.x, n.y, 0};
}

double overlap_of(const Specimen& specimen, const Contact& contact) {
  if (specimen.shape == Shape::ellipse) return ellipses_of(specimen, contact).overlap;
  const auto& radius = specimen.grains.radius;
  return radius[static_cast<std::size_t>(contact.i)] + radius[static_cast<std::size_t>(contact.j)] -
         branch_of(specimen, contact).norm();
}

namespace {

/// What laws take for sqrt(overlap) > 0, m^0.5.
double root_overlap(const Specimen& specimen, const Contact& contact) {
  if (specimen.shape != Shape::ellipse || specimen.contact.hertz_radius == HertzRadius::equivalent)
    return std::sqrt(overlap_of(specimen, contact));
  const EllipsePlace at = ellipses_of(specimen, contact);
  const auto& radius = specimen.grains.radius;
  return std::sqrt(at.overlap * at.hertz_radius_ratio(radius[std::size_t(contact.i)], radius[std::size_t(contact.j)]));
}

}  // namespace

PairParameters parameters_of(const Specimen& specimen, const Contact& contact) {
  const auto& grains = specimen.grains;
  const double thickness = specimen.cell.lattice(2, 2);
  const auto material = [&](std::size_t k) -> const Material& {
    return specimen.materials[static_cast<std::size_t>(grains.material[k])];
  };
  const auto mass = [&](std::size_t k) {
    return material(k).density * grain_volume(specimen.shape, grains.radius[k], thickness);
  };
  const auto i = static_cast<std::size_t>(contact.i), j = static_cast<std::size_t>(contact.j);
  return mix(specimen.contact, specimen.damping, material(i), grains.radius[i], mass(i), material(j), grains.radius[j],
             mass(j), grain_section(specimen.shape, std::min(grains.radius[i], grains.radius[j]), thickness));
}

double normal_force_of(const Specimen& specimen, const Contact& contact) {
  const double overlap = overlap_of(specimen, contact);
  if (overlap <= 0) return 0;
  const PairParameters pair = parameters_of(specimen, contact);
  return with_law(specimen.contact.law, [&](auto law) {
    return decltype(law)::Force::normal_force(pair.kn, overlap, root_overlap(specimen, contact), pair.law_constant);
  });
}

void set_root_overlaps(Specimen& specimen) {
  for (Contact& contact : specimen.contacts) {
    const bool kept =
        with_law(specimen.contact.law, [](auto law) { return decltype(law)::Force::stores_root_overlap; });
    contact.last_root_overlap = kept ? root_overlap(specimen, contact) : 0;
  }
}

}  // namespace rvelab
