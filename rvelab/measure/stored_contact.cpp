#include "rvelab/measure/stored_contact.hpp"

#include <algorithm>
#include <cmath>

#include "rvelab/solver/assembly/outline.hpp"

namespace rvelab {

namespace {

/// Of grains that are not round.
OutlinePlace place_of(const Specimen& specimen, const Contact& contact) {
  const Vector3 b = branch_of(specimen, contact);
  return with_shape(specimen.shape, [&](auto is) -> OutlinePlace {
    using By = typename decltype(is)::By;
    if constexpr (By::round) {
      return {};
    } else {
      constexpr Shape shape = decltype(is)::value;
      const auto row = [&](std::int32_t k) {
        const Vector3& axis = specimen.grains.orientation[std::size_t(k)];
        return LoneRow<shape>(own_of<By>(specimen.grains, std::size_t(k)), axis[0], axis[1]);
      };
      return Outline<shape>::place({b[0], b[1], 0}, row(contact.i).row, row(contact.j).row);
    }
  });
}

/// What laws take for sqrt(overlap) > 0, m^0.5.
double overlap_root_of(const Specimen& specimen, const Contact& contact) {
  if (is_round(specimen.shape) || specimen.contact.hertz_radius == HertzRadius::equivalent)
    return std::sqrt(overlap_of(specimen, contact));
  const OutlinePlace at = place_of(specimen, contact);
  const auto& radius = specimen.grains.radius;
  return std::sqrt(at.overlap * at.hertz_radius_ratio(radius[std::size_t(contact.i)], radius[std::size_t(contact.j)]));
}

}  // namespace

Vector3 branch_of(const Specimen& specimen, const Contact& contact) {
  const auto& position = specimen.grains.position;
  return position[static_cast<std::size_t>(contact.j)] + translation(specimen.cell, contact.image) -
         position[static_cast<std::size_t>(contact.i)];
}

Vector3 normal_of(const Specimen& specimen, const Contact& contact) {
  if (is_round(specimen.shape)) return branch_of(specimen, contact).normalized();
  const Branch n = place_of(specimen, contact).normal;
  return {n.x, n.y, 0};
}

double overlap_of(const Specimen& specimen, const Contact& contact) {
  if (!is_round(specimen.shape)) return place_of(specimen, contact).overlap;
  const auto& radius = specimen.grains.radius;
  return radius[static_cast<std::size_t>(contact.i)] + radius[static_cast<std::size_t>(contact.j)] -
         branch_of(specimen, contact).norm();
}

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
    return decltype(law)::Force::normal_force(pair.kn, overlap, overlap_root_of(specimen, contact), pair.law_constant);
  });
}

void set_root_overlaps(Specimen& specimen) {
  for (Contact& contact : specimen.contacts) {
    const bool kept =
        with_law(specimen.contact.law, [](auto law) { return decltype(law)::Force::stores_root_overlap; });
    contact.last_root_overlap = kept ? overlap_root_of(specimen, contact) : 0;
  }
}

}  // namespace rvelab
