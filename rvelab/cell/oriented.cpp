// Initial cells: axis-aligned, and those oriented so that a flow with known principal axes never makes them thin.
//
// The oriented ones are Minkowski embeddings of the integers of a totally real number field. The product of the
// coordinates of a vector is a norm, with an absolute value of at least one except for zero, and a diagonal flow of
// constant volume conserves it. By the inequality of means every vector then has at least the length sqrt(d) in a cell
// of volume sqrt(discriminant): sqrt(2)/5^(1/4) = 0.9457 of V^(1/2) in 2D, sqrt(3)/7^(1/3) = 0.9054 of V^(1/3) in 3D.
// Declared in cell.hpp.
#include <cmath>
#include <cstdio>
#include <string>

#include "rvelab/cell/cell.hpp"
#include "rvelab/cell/cube_root.hpp"
#include "rvelab/error.hpp"

namespace rvelab {
namespace {

void check_positive(const char* name, const char* unit, double value) {
  if (value > 0.0 && std::isfinite(value)) return;
  char found[64];
  std::snprintf(found, sizeof found, " = %.9g %s", value, unit);
  throw InputError(std::string(name) + found + "; it must be finite and > 0: correct the specimen's size");
}

}  // namespace

Cell cubic_cell(int dimension, double volume, double thickness) {
  if (dimension != 2 && dimension != 3)
    throw InputError("cell dimension = " + std::to_string(dimension) + "; it must be 2 (discs) or 3 (spheres)");
  check_positive("cell volume", "m^3", volume);
  Cell cell;
  cell.dimension = dimension;
  if (dimension == 3) {
    cell.lattice = Matrix3::Identity() * cube_root(volume);
    return cell;
  }
  check_positive("slab thickness", "m", thickness);
  const double side = std::sqrt(volume / thickness);
  cell.lattice = Vector3(side, side, thickness).asDiagonal();
  return cell;
}

Cell kraynik_reinelt_cell(double volume, double thickness) {
  Cell cell = cubic_cell(2, volume, thickness);
  // tan 31.717 deg = (sqrt 5 - 1)/2, the inverse of the golden ratio.
  const double tangent = 0.5 * (std::sqrt(5.0) - 1.0);
  const double cosine = 1.0 / std::sqrt(1.0 + tangent * tangent);
  const double sine = tangent * cosine;
  cell.rotation << cosine, -sine, 0, sine, cosine, 0, 0, 0, 1;
  return cell;
}

Cell cubic_field_cell(double volume) {
  check_positive("cell volume", "m^3", volume);
  // Roots of x^3 + x^2 - 2x - 1: 2 cos(2 pi/7), 2 cos(4 pi/7), 2 cos(6 pi/7). A row of the embedding is one root's
  // 1, rho, rho^2; the determinant is sqrt(49). Rows in this order make it +7.
  const double roots[3] = {-1.8019377358048382525, -0.44504186791262880858, 1.2469796037174670611};
  const double unit = cube_root(volume / 7.0);
  Matrix3 embedding;
  for (int i = 0; i < 3; ++i) embedding.row(i) << unit, unit * roots[i], unit * (roots[i] * roots[i]);
  const TriangularFactors factors = triangular_factors(embedding);
  Cell cell;
  cell.rotation = factors.rotation;
  cell.lattice = factors.upper;
  apply_reduction(cell, reduced(cell));
  cell.rotation = renormalised(cell.rotation);
  cell.increments = 0;
  return cell;
}

}  // namespace rvelab
