#include "rvelab/measure/stored_contact.hpp"

#include <algorithm>
#include <array>

#include "rvelab/solver/assembly/outline.hpp"
#include "rvelab/solver/assembly/superellipsoid_rows.hpp"

namespace rvelab {

namespace {

/// Overlap, normal and R*/r* (contact/hertz_curvature.hpp) of grains that are not round.
struct StoredPlace {
  double overlap = 0, radius_ratio = 1;
  Vector3 normal = Vector3::Zero();
};

template <Shape shape>
std::array<double, std::size_t(row_length_of(shape))> solid_row(const Specimen& specimen, std::int32_t k) {
  std::array<double, std::size_t(row_length_of(shape))> row{};
  const std::vector<double> form = form_of_grain(specimen.grains, std::size_t(k));
  row[3] = form[0];
  std::copy(form.begin() + 1, form.end(), row.begin() + 16);
  put_orientation(specimen.bodies[std::size_t(k)].orientation, row.data());
  return row;
}

StoredPlace place_of(const Specimen& specimen, const Contact& contact) {
  const Vector3 b = branch_of(specimen, contact);
  return with_shape(specimen.shape, [&](auto is) -> StoredPlace {
    using By = typename decltype(is)::By;
    constexpr Shape shape = decltype(is)::value;
    if constexpr (By::round) {
      return {};
    } else if constexpr (By::rigid) {
      const auto i = solid_row<shape>(specimen, contact.i), j = solid_row<shape>(specimen, contact.j);
      const auto at = Outline<shape>::place({b[0], b[1], b[2]}, i.data(), j.data());
      const auto& radius = specimen.grains.radius;
      return {at.overlap,
              radius_ratio_of(at.hertz_radius, radius[std::size_t(contact.i)], radius[std::size_t(contact.j)]),
              {at.normal.x, at.normal.y, at.normal.z}};
    } else {
      const auto row = [&](std::int32_t k) {
        const Vector3& axis = specimen.grains.orientation[std::size_t(k)];
        return LoneRow<shape>(own_of<By>(specimen.grains, std::size_t(k)), axis[0], axis[1]);
      };
      const auto at = Outline<shape>::place({b[0], b[1], 0}, row(contact.i).row, row(contact.j).row);
      const auto& radius = specimen.grains.radius;
      return {at.overlap,
              at.hertz_radius_ratio(radius[std::size_t(contact.i)], radius[std::size_t(contact.j)]),
              {at.normal.x, at.normal.y, 0}};
    }
  });
}

/// The root of the overlap (> 0) that laws use, m^0.5.
double overlap_root_of(const Specimen& specimen, const Contact& contact) {
  double overlap = 0;  // times R*/r*
  if (is_round(specimen.shape) || specimen.contact.hertz_radius == HertzRadius::equivalent) {
    overlap = overlap_of(specimen, contact);
  } else {
    const StoredPlace at = place_of(specimen, contact);
    overlap = at.overlap * at.radius_ratio;
  }
  const double own = parameters_of(specimen, contact).law_constant;
  return with_law(specimen.contact.law, [&](auto law) { return decltype(law)::Force::root(overlap, own); });
}

}  // namespace

Vector3 branch_of(const Specimen& specimen, const Contact& contact) {
  const auto& position = specimen.grains.position;
  return position[static_cast<std::size_t>(contact.j)] + translation(specimen.cell, contact.image) -
         position[static_cast<std::size_t>(contact.i)];
}

Vector3 normal_of(const Specimen& specimen, const Contact& contact) {
  if (is_round(specimen.shape)) return branch_of(specimen, contact).normalized();
  return place_of(specimen, contact).normal;
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
