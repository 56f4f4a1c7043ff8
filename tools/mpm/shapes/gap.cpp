// Gaps of two shapes, by their kinds. Declared in shape.hpp.
#include "tools/mpm/shapes/polyhedron.hpp"
#include "tools/mpm/shapes/shape.hpp"
#include "tools/mpm/shapes/superquadric_pair.hpp"

namespace mpm {
namespace {

template <int D>
Gap<D> smooth_gap(const Placed<D>& a, const Placed<D>& b, const Superquadric<D>& form_a,
                  const Superquadric<D>& form_b) {
  const auto contact = rvelab::contact_of({form_of(form_a), form_of(form_b), axes_of<D>(matrix_of(a.orientation)),
                                           axes_of<D>(matrix_of(b.orientation)), triple_of<D>(b.centre - a.centre)});
  return {-contact.overlap, vector_of<D>(contact.n), a.centre + vector_of<D>(contact.point)};
}

/// Of a sphere with a shape that has a distance.
template <int D>
Gap<D> sphere_gap(const Placed<D>& a, const Placed<D>& sphere, double radius) {
  Vec<D> normal;
  const Vec<D> r = to_body<D>(a.orientation, sphere.centre - a.centre);
  const double far = a.shape->distance(r, normal);
  normal = to_world<D>(a.orientation, normal);
  return {far - radius, normal, sphere.centre - 0.5 * (far + radius) * normal};
}

template <int D>
Gap<D> gap_in_order(const Placed<D>& a, const Placed<D>& b) {
  const auto &form_a = a.shape->form(), &form_b = b.shape->form();
  if (const double* radius = std::get_if<0>(&form_b)) {
    if (!a.shape->is_sphere()) return sphere_gap(a, b, *radius);
    const Vec<D> d = b.centre - a.centre;
    const double apart = d.norm(), first = std::get<0>(form_a);
    const Vec<D> normal = apart > 0 ? Vec<D>(d / apart) : Vec<D>::Unit(0);
    const double gap = apart - (first + *radius);
    return {gap, normal, a.centre + (first + 0.5 * gap) * normal};
  }
  if (const double* radius = std::get_if<0>(&form_a)) {
    Gap<D> gap = sphere_gap(b, a, *radius);
    gap.normal = -gap.normal;
    return gap;
  }
  if constexpr (D == 3) {
    const auto *block_a = std::get_if<2>(&form_a), *block_b = std::get_if<2>(&form_b);
    if (block_a && block_b) return polyhedra_gap(a, **block_a, b, **block_b);
    if (block_b) return block_gap(a, *std::get<1>(form_a), b, **block_b);
    if (block_a) {
      Gap<D> gap = block_gap(b, *std::get<1>(form_b), a, **block_a);
      gap.normal = -gap.normal;
      return gap;
    }
  }
  return smooth_gap(a, b, *std::get<1>(form_a), *std::get<1>(form_b));
}

/// Whether the first entry that is not zero is negative.
template <int D>
bool backward(const Vec<D>& d) {
  for (int i = 0; i < D; ++i) {
    if (d[i] != 0) return d[i] < 0;
  }
  return false;
}

}  // namespace

template <int D>
Gap<D> gap_between(const Placed<D>& a, const Placed<D>& b) {
  if (!backward<D>(b.centre - a.centre)) return gap_in_order(a, b);
  Gap<D> gap = gap_in_order(b, a);  // one order of the two for both questions: the same bits
  gap.normal = -gap.normal;
  return gap;
}

template Gap<2> gap_between(const Placed<2>&, const Placed<2>&);
template Gap<3> gap_between(const Placed<3>&, const Placed<3>&);

}  // namespace mpm
