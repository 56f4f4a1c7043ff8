// Contact forces of an assembly as they stand: evaluation, sums over pairs, balance of the grains.
#include <algorithm>
#include <cmath>

#include "rvelab/solver/pair_geometry.hpp"

namespace rvelab {

Matrix3 upper_inverse(const Matrix3& m) {
  const double xx = 1 / m(0, 0), yy = 1 / m(1, 1), zz = 1 / m(2, 2);
  const double xy = -m(0, 1) * xx * yy, yz = -m(1, 2) * yy * zz;
  Matrix3 inverse;
  inverse << xx, xy, -(m(0, 1) * yz + m(0, 2) * zz) * xx, 0, yy, yz, 0, 0, zz;
  return inverse;
}

UpperTriangle upper_triangle(const Matrix3& m) { return {m(0, 0), m(0, 1), m(0, 2), m(1, 1), m(1, 2), m(2, 2)}; }

void set_rate(const Matrix3& rate, StepConstants& c) {
  c.rate = upper_triangle(rate);
  c.spin[0] = -0.5 * rate(1, 2);
  c.spin[1] = 0.5 * rate(0, 2);
  c.spin[2] = -0.5 * rate(0, 1);
}

StepConstants base_constants(const Fixture& f, const Assembly& a) {
  StepConstants c;
  c.dt = a.state.last_step;
  c.lattice = upper_triangle(a.cell.lattice);
  set_rate(a.state.last_rate, c);
  c.global_viscous = f.damping.global_viscous;
  c.tangential_ratio = f.damping.tangential_ratio;
  c.dashpot_quarters = int(4 * dashpot_power(f.contact.law, f.damping.dashpot));
  c.no_tension = f.damping.no_tension;
  c.unload_rescale = f.contact.unload_rescale;
  return c;
}

void evaluate_forces(const Fixture& f, Assembly& a) {
  const StepConstants c = base_constants(f, a);
  f.kernels.evaluate(c, arrays_of(a.pairs), a.rows.data(), 0, long(a.pairs.padded()), nullptr);
}

Vector3 branch_of(const Fixture& f, const Assembly& a, std::size_t p) {
  const double* xi = a.rows.data() + std::size_t(a.pairs.i[p]) * f.row_length();
  const double* xj = a.rows.data() + std::size_t(a.pairs.j[p]) * f.row_length();
  const Image& n = a.pairs.image[p];
  const Matrix3& l = a.cell.lattice;
  if (f.shape == Shape::disc)
    return {(xj[0] - xi[0]) + (l(0, 0) * n[0] + l(0, 1) * n[1]), (xj[1] - xi[1]) + l(1, 1) * n[1], 0};
  return {(xj[0] - xi[0]) + (l(0, 0) * n[0] + (l(0, 1) * n[1] + l(0, 2) * n[2])),
          (xj[1] - xi[1]) + (l(1, 1) * n[1] + l(1, 2) * n[2]), (xj[2] - xi[2]) + l(2, 2) * n[2]};
}

Vector3 force_of(const Fixture& f, const PairTable& pairs, std::size_t p) {
  const double* row = pairs.force.data() + p * force_row_length(f.shape);
  return {row[0], row[1], f.shape == Shape::disc ? 0.0 : row[2]};
}

Matrix3 contact_moment(const Fixture& f, const Assembly& a) {
  // Called every few sub-steps under stress control.
  const double* force = a.pairs.force.data();
  Matrix3 sum = Matrix3::Zero();
  if (f.shape == Shape::disc) {
    const Branches<2> branch(a);
    double xx = 0, xy = 0, yx = 0, yy = 0;
    for (const std::int32_t place : a.pairs.order) {
      const auto p = std::size_t(place);
      const Branch b = branch(p);
      xx += force[4 * p] * b.x;
      xy += force[4 * p] * b.y;
      yx += force[4 * p + 1] * b.x;
      yy += force[4 * p + 1] * b.y;
    }
    sum(0, 0) = xx;
    sum(0, 1) = xy;
    sum(1, 0) = yx;
    sum(1, 1) = yy;
    return sum;
  }
  const Branches<3> branch(a);
  double m[9] = {};
  for (const std::int32_t place : a.pairs.order) {
    const auto p = std::size_t(place);
    const Branch b = branch(p);
    for (int r = 0; r < 3; ++r) {
      m[3 * r] += force[8 * p + r] * b.x;
      m[3 * r + 1] += force[8 * p + r] * b.y;
      m[3 * r + 2] += force[8 * p + r] * b.z;
    }
  }
  for (int k = 0; k < 9; ++k) sum(k / 3, k % 3) = m[k];
  return sum;
}

namespace {

template <int D>
Balance balance_in(const Fixture& f, const Assembly& a) {
  Balance balance;
  std::vector<double> resultant(3 * f.size(), 0.0);
  const Branches<D> branch(a);
  const double* force = a.pairs.force.data();
  double contact_force = 0, overlap_sum = 0;
  for (const std::int32_t place : a.pairs.order) {
    const auto p = std::size_t(place);
    const auto i = std::size_t(a.pairs.i[p]), j = std::size_t(a.pairs.j[p]);
    const double overlap = (f.radius[i] + f.radius[j]) - branch(p).length();
    if (!std::isfinite(overlap)) balance.finite = false;
    if (!(overlap > 0)) continue;
    const double* on_j = force + p * (D == 2 ? 4 : 8);
    double squared = 0;
    for (int k = 0; k < D; ++k) {
      resultant[3 * i + std::size_t(k)] -= on_j[k];
      resultant[3 * j + std::size_t(k)] += on_j[k];
      squared += on_j[k] * on_j[k];
    }
    contact_force += std::sqrt(squared);
    overlap_sum += overlap;
    ++balance.touching;
    balance.largest_overlap_ratio =
        std::max(balance.largest_overlap_ratio, overlap / std::min(f.radius[i], f.radius[j]));
  }
  for (std::size_t g = 0; g < f.size(); ++g) {
    const double* r = resultant.data() + 3 * g;
    balance.mean_resultant += std::sqrt(r[0] * r[0] + r[1] * r[1] + r[2] * r[2]) / double(f.size());
  }
  if (balance.touching > 0) {
    balance.mean_contact_force = contact_force / double(balance.touching);
    balance.mean_overlap = overlap_sum / double(balance.touching);
  }
  // A sum is finite only if all its terms are, or if infinities cancel, which sums of squares cannot.
  double squares = 0;
  for (double value : a.rows) squares += value * value;
  balance.finite =
      balance.finite && std::isfinite(balance.mean_resultant) && std::isfinite(contact_force) && std::isfinite(squares);
  return balance;
}

}  // namespace

Balance balance_of(const Fixture& f, const Assembly& a) {
  return f.shape == Shape::disc ? balance_in<2>(f, a) : balance_in<3>(f, a);
}

double unbalanced_ratio(const Balance& balance, double reference_contact_force) {
  const double scale = std::max(balance.mean_contact_force, 1e-3 * reference_contact_force);
  return scale > 0 ? balance.mean_resultant / scale : 0.0;
}

}  // namespace rvelab
