// Rows and pairs of superellipsoids.
//
// Declared in outline.hpp and superellipsoid_rows.hpp.
#include <algorithm>

#include "rvelab/solver/assembly/outline.hpp"
#include "rvelab/solver/assembly/superellipsoid_rows.hpp"
#include "rvelab/solver/kernels/superellipsoid_places.hpp"
#include "rvelab/specimen/solids.hpp"

namespace rvelab {
namespace {

OverlapPair solids_of(const Branch& b, const double* row_i, const double* row_j) {
  const SuperellipsoidColumns<double> i = shape_in_row(row_i), j = shape_in_row(row_j);
  return {i.form(), j.form(), i.axes(), j.axes(), {b.x, b.y, b.z}};
}
bool is_ellipsoid(const double* row) { return row[19] == 0 && row[20] == 0; }

SolidPlace solid_place(const Branch& b, double overlap, const Triple<double>& n, const Triple<double>& at) {
  return {b, b.length(), overlap, {n.x, n.y, n.z}, {at.x, at.y, at.z}};
}

SolidPlace solid_place(const Branch& b, const OverlapPair& pair, const ContactsOf<double>& at) {
  SolidPlace place = solid_place(b, at.overlap, at.n, at.point);
  if (at.overlap > 0)
    place.hertz_radius = hertz_radius(support_at(pair.form_i, pair.axes_i, at.n),
                                      support_at(pair.form_j, pair.axes_j, times(-1.0, at.n)),
                                      largest_radius(pair.form_i.half), largest_radius(pair.form_j.half));
  return place;
}

/// The largest gap that the directions of a few steps show, m; it is enough to see `enough`.
double shown_gap(const OverlapPair& pair, double enough) {
  double largest = -1e300;
  Triple<double> n = of_length_1(pair.branch);
  for (int step = 0; step < 5; ++step) {
    const OverlapAt<double> at = overlap_at(pair, n);
    largest = std::max(largest, -at.overlap);
    if (largest > enough) break;
    n = step == 0 ? first_direction(pair) : turned_by(n, next_step(at, pair.form_i.rolling + pair.form_j.rolling).turn);
  }
  return largest;
}
/// The same of ellipsoids: along the branch, and where it leaves the ellipsoid of the summed matrices.
double shown_gap_of_ellipsoids(const OverlapPair& pair) {
  const EllipsoidMatrix<double> i = ellipsoid_matrix(pair.form_i.half, pair.axes_i),
                                j = ellipsoid_matrix(pair.form_j.half, pair.axes_j);
  double largest = -1e300;
  for (const Triple<double>& n : {of_length_1(pair.branch), first_direction(EllipsoidPair<double>{i, j, pair.branch})})
    largest = std::max(largest, dot(n, pair.branch) - ellipsoid_at(i, n).height - ellipsoid_at(j, n).height);
  return largest;
}

}  // namespace

std::vector<double> forms_of(const Grains& grains) {
  std::vector<double> forms;
  forms.reserve(9 * grains.size());
  const std::vector<double> rolling = rolling_radii_of(grains);
  for (std::size_t g = 0; g < grains.size(); ++g) {
    const Superellipsoid s = superellipsoid_of(grains, g);
    const SuperellipsoidForm<double> form = plain_form_of(s);
    for (const double value :
         {rolling[g], s.a, s.b, s.c, 1 - form.share_xy, 1 - form.share_z, form.root_xy + 0.5, form.root_z + 0.5,
          SuperellipsoidGrain::extent(own_of<SuperellipsoidGrain>(grains, g)).turning})
      forms.push_back(value);
  }
  return forms;
}

std::vector<double> form_of_grain(const Grains& grains, std::size_t g) {
  Grains one;
  const OwnValues own = own_of<SuperellipsoidGrain>(grains, g);
  each_column_of<SuperellipsoidGrain>([](const auto&, auto& column, double value) { column.push_back(value); }, one,
                                      own);
  one.id.push_back(0);
  return forms_of(one);
}

bool all_ellipsoids(const Grains& grains) {
  const auto two = [](double e) { return e == 2; };
  return !grains.half_x.empty() && std::all_of(grains.exponent_xy.begin(), grains.exponent_xy.end(), two) &&
         std::all_of(grains.exponent_z.begin(), grains.exponent_z.end(), two);
}

template <>
SolidPlace Outline<Shape::superellipsoid>::place(const Branch& b, const double* row_i, const double* row_j) {
  const OverlapPair pair = solids_of(b, row_i, row_j);
  const bool ellipsoids = is_ellipsoid(row_i) && is_ellipsoid(row_j);
  if (ellipsoids) {
    const double gap = shown_gap_of_ellipsoids(pair);
    if (gap > 0) return solid_place(b, -gap, of_length_1(pair.branch), {0, 0, 0});
  }
  Triple<double> guess = {0, 0, 0};
  if (!ellipsoids) return solid_place(b, pair, contacts_of(pair, guess));
  const EllipsoidPair<double> both = {ellipsoid_matrix(pair.form_i.half, pair.axes_i),
                                      ellipsoid_matrix(pair.form_j.half, pair.axes_j), pair.branch};
  return solid_place(b, pair, contacts_of(both, guess, [&](int) { return searched_contact(pair); }));
}

template <>
SolidPlace Outline<Shape::superellipsoid>::nearest_place(const SolidPlace& apart, const double* row_i,
                                                         const double* row_j) {
  const SuperellipsoidContact found = contact_of(solids_of(apart.branch, row_i, row_j));
  return solid_place(apart.branch, found.overlap, found.n, found.point);
}

template <>
bool Outline<Shape::superellipsoid>::farther_apart_than(double skin, const Branch& b, const double* row_i,
                                                        const double* row_j) {
  const OverlapPair pair = solids_of(b, row_i, row_j);
  const double gap = is_ellipsoid(row_i) && is_ellipsoid(row_j) ? shown_gap_of_ellipsoids(pair) : shown_gap(pair, skin);
  return gap > skin;
}

}  // namespace rvelab
