// Deformation of the cell and its frame, wrapping, image shifts, heights. Only + - * / sqrt and exact rounding are
// used: the results decide the next bit of an RVE. (Qu, Feng and Wang, eq. 1-9, with the spin kept: solver/README.md.)
#include "rvelab/cell/cell.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <cstdio>
#include <limits>

#include "rvelab/error.hpp"

namespace rvelab {
namespace {

constexpr char axis[] = "xyz";
constexpr long increments_between_renormalisations = 100;

std::string text(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.9g", value);
  return buffer;
}

std::string entry(int i, int j) { return std::string("dH_") + axis[i] + axis[j]; }

// dH, in 2D with its z-components set to zero if they are round-off.
Matrix3 checked_gradient(int dimension, const Matrix3& gradient) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      if (!std::isfinite(gradient(i, j)))
        throw InvalidIncrement(entry(i, j) + " = " + text(gradient(i, j)) +
                               "; every entry of a displacement gradient must be finite: check the caller's increment");
  if (dimension != 2) return gradient;
  const double allowed = 1e-12 + 1e-9 * gradient.cwiseAbs().maxCoeff();
  Matrix3 in_plane = gradient;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      if (i != 2 && j != 2) continue;
      if (std::abs(gradient(i, j)) > allowed)
        throw InvalidIncrement(entry(i, j) + " = " + text(gradient(i, j)) + " in a 2D cell; at most " + text(allowed) +
                               " (1e-12 + 1e-9 of the largest entry) is taken as round-off: set the z-components to "
                               "zero or use a 3D specimen");
      in_plane(i, j) = 0.0;
    }
  return in_plane;
}

[[noreturn]] void refuse_determinant(double determinant) {
  throw InvalidIncrement("det(I + dH) = " + text(determinant) +
                         "; it must be finite and > 0: apply a smaller increment");
}

// The determinant alone is not sufficient: a shear of 1e17 keeps it at one, and squares of 1e200 overflow.
[[noreturn]] void refuse_stretch(int k, double stretch, const Matrix3& gradient) {
  throw InvalidIncrement(std::string("U_") + axis[k] + axis[k] + " = " + text(stretch) +
                         ", the stretch of I + dH along " + axis[k] + ", with entries of dH up to " +
                         text(gradient.cwiseAbs().maxCoeff()) +
                         "; it must be finite and > 0 beyond round-off: apply a smaller increment");
}

// Moves a point along lattice vector k until its k-th coordinate lies in [-L_kk/2, L_kk/2); returns the number of
// vectors added. Rounding can leave it on the upper face, or, from many cells away, outside: hence the loop.
int wrap_along(const Matrix3& lattice, int k, Vector3& position) {
  const double width = lattice(k, k);
  const double half = 0.5 * width;
  constexpr double largest = std::numeric_limits<int>::max();
  double total = 0.0;
  for (int pass = 0; pass < 8; ++pass) {
    if (position[k] >= -half && position[k] < half) return static_cast<int>(total);
    // Never zero here: beyond a face the quotient rounds to at least 1/2 above, to less than -1/2 below.
    const double shift = -std::floor(position[k] / width + 0.5);
    total += shift;
    if (!(std::abs(total) <= largest)) break;
    for (int i = 0; i <= k; ++i) position[i] += shift * lattice(i, k);
  }
  throw CellError(
      std::string("wrapping: coordinate ") + axis[k] + " = " + text(position[k]) + " m in a cell " + text(width) +
      " m wide; it must be finite and within 2^31 cell widths: the grain has been lost, use " + "smaller time steps");
}

// Rotates rows p and q so that entry (q, p) vanishes and the pivot (p, p) becomes positive.
void annihilate(TriangularFactors& factors, int p, int q) {
  const double a = factors.upper(p, p);
  const double b = factors.upper(q, p);
  if (b == 0.0 && a >= 0.0) return;
  const double length = std::sqrt(a * a + b * b);
  const double c = a / length;
  const double s = b / length;
  for (int k = 0; k < 3; ++k) {
    const double upper_p = factors.upper(p, k), upper_q = factors.upper(q, k);
    factors.upper(p, k) = c * upper_p + s * upper_q;
    factors.upper(q, k) = c * upper_q - s * upper_p;
    const double rotation_p = factors.rotation(k, p), rotation_q = factors.rotation(k, q);
    factors.rotation(k, p) = c * rotation_p + s * rotation_q;
    factors.rotation(k, q) = c * rotation_q - s * rotation_p;
  }
  factors.upper(p, p) = length;
  factors.upper(q, p) = 0.0;
}

bool is_identity(const Matrix3& m) { return (m.array() == Matrix3::Identity().array()).all(); }

// Cube root of a number near one by Newton's method: no libm in what touches state.
double cube_root_near_one(double x) {
  double y = 1;
  for (int step = 0; step < 60; ++step) y -= (y * y * y - x) / (3 * y * y);
  return y;
}

}  // namespace

double Cell::volume() const { return lattice(0, 0) * lattice(1, 1) * lattice(2, 2); }

FrameSplit split_increment(const Cell& cell, const Matrix3& displacement_gradient) {
  const Matrix3 gradient = checked_gradient(cell.dimension, displacement_gradient);
  const double determinant = (Matrix3::Identity() + gradient).determinant();
  if (!(determinant > 0.0) || !std::isfinite(determinant)) refuse_determinant(determinant);
  // I + Q^T dH Q rather than Q^T (I + dH) Q, with Q at its most orthogonal: det(Q)^2 - 1 of round-off would
  // otherwise inflate the cell at every increment, and push a rotation over the limit of `rigid`.
  // A frame without rotation needs neither.
  Matrix3 in_frame = gradient;
  if (!is_identity(cell.rotation)) {
    const Matrix3 frame = renormalised(cell.rotation);
    in_frame = frame.transpose() * gradient * frame;
  }
  const TriangularFactors factors = triangular_factors(Matrix3::Identity() + in_frame);
  for (int k = 0; k < 3; ++k)
    if (!(factors.upper(k, k) > 0.0) || !std::isfinite(factors.upper(k, k)))
      refuse_stretch(k, factors.upper(k, k), gradient);
  const double deviation = (factors.upper - Matrix3::Identity()).cwiseAbs().maxCoeff();
  const bool rigid = deviation <= 8.0 * std::numeric_limits<double>::epsilon();
  return {factors.rotation, rigid ? Matrix3(Matrix3::Identity()) : factors.upper, rigid};
}

Matrix3 with_volume_ratio(const Matrix3& displacement_gradient, double ratio, int dimension) {
  Matrix3 f = Matrix3::Identity() + displacement_gradient;
  const double off = ratio / f.determinant();
  if (!(off > 0)) throw InvalidIncrement("the increment turns the cell inside out; apply it in smaller parts");
  const double stretch = dimension == 2 ? std::sqrt(off) : cube_root_near_one(off);
  for (int k = 0; k < dimension; ++k) f.row(k) *= stretch;
  return f - Matrix3::Identity();
}

void turn_frame(Cell& cell, const Matrix3& frame_rotation) {
  if (!is_identity(frame_rotation)) cell.rotation = (cell.rotation * frame_rotation).eval();
  cell.rotation.array() += 0.0;  // no -0, so that four quarter turns give the same bits
  if (++cell.increments < increments_between_renormalisations) return;
  cell.rotation = renormalised(cell.rotation);
  cell.increments = 0;
}

Matrix3 renormalised(const Matrix3& rotation) {
  return rotation * (0.5 * (3.0 * Matrix3::Identity() - rotation.transpose() * rotation));
}

Image wrap(const Cell& cell, Vector3& position) {
  Image image{};
  // L is upper triangular: vector k changes only coordinates up to k, so wrapped coordinates stay wrapped.
  for (int k = cell.dimension - 1; k >= 0; --k) image[k] = wrap_along(cell.lattice, k, position);
  return image;
}

Vector3 translation(const Cell& cell, const Image& image) {
  const Matrix3& l = cell.lattice;
  return {l(0, 0) * image[0] + l(0, 1) * image[1] + l(0, 2) * image[2], l(1, 1) * image[1] + l(1, 2) * image[2],
          l(2, 2) * image[2]};
}

Vector3 heights(const Cell& cell) {
  // h_k = V / (area of the face spanned by the other two vectors).
  const Vector3 a = cell.lattice.col(0), b = cell.lattice.col(1), c = cell.lattice.col(2);
  const double volume = cell.volume();
  if (cell.dimension == 2)
    return {cell.lattice(0, 0) * cell.lattice(1, 1) / b.norm(), cell.lattice(1, 1),
            std::numeric_limits<double>::infinity()};
  return {volume / b.cross(c).norm(), volume / c.cross(a).norm(), cell.lattice(2, 2)};
}

TriangularFactors triangular_factors(const Matrix3& matrix) {
  TriangularFactors factors{Matrix3::Identity(), matrix};
  // The sign of the pivot is corrected by the neighbouring row, so that in 2D the z-row does not change.
  annihilate(factors, 0, 1);
  annihilate(factors, 0, 2);
  annihilate(factors, 1, 2);
  // After three rotations R deviates from orthogonality by some units of round-off, which would add up in the frame.
  if (!is_identity(factors.rotation)) factors.rotation = renormalised(factors.rotation);
  // Adding zero turns -0 into +0: equal states then are equal bit for bit.
  factors.rotation.array() += 0.0;
  factors.upper.array() += 0.0;
  return factors;
}

}  // namespace rvelab
