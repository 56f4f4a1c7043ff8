// The search for the contact of one pair of superellipsoids, which all step kernels share. Declared in
// superellipsoid_places.hpp.
#include "rvelab/solver/kernels/superellipsoid_places.hpp"

namespace rvelab {

void search_contact(const double* row_i, const double* row_j, const double* branch, double* contact) {
  const auto i = shape_in_row(row_i), j = shape_in_row(row_j);
  const ContactsOf<double> found =
      searched_contact({i.form(), j.form(), i.axes(), j.axes(), {branch[0], branch[1], branch[2]}});
  const double numbers[7] = {found.overlap, found.n.x,     found.n.y,    found.n.z,
                             found.point.x, found.point.y, found.point.z};
  for (int k = 0; k < 7; ++k) contact[k] = numbers[k];
}

}  // namespace rvelab
