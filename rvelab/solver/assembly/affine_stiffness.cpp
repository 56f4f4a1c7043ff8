#include "rvelab/solver/assembly/affine_stiffness.hpp"

#include <cmath>

#include "rvelab/solver/assembly/contact_stiffness.hpp"
#include "rvelab/solver/assembly/pair_geometry.hpp"

namespace rvelab {

Matrix3 strain_matrix(const Vector6& e) {
  Matrix3 m;
  m << e[0], 0.5 * e[5], 0.5 * e[4], 0.5 * e[5], e[1], 0.5 * e[3], 0.5 * e[4], 0.5 * e[3], e[2];
  return m;
}

Vector6 strain_components(const Matrix3& m) {
  Vector6 e;
  e << m(0, 0), m(1, 1), m(2, 2), m(1, 2) + m(2, 1), m(0, 2) + m(2, 0), m(0, 1) + m(1, 0);
  return e;
}

namespace {

/// Sums of l^2 (kn - kt) n n n n and l^2 kt n n over the contacts, cell frame: what the stiffness is made of.
struct Moments {
  Matrix6 fourth = Matrix6::Zero();  ///< [(i, j), (k, l)] in the order xx yy zz yz xz xy
  Matrix3 second = Matrix3::Zero();
};

/// Normal and tangential coefficient of a contact.
struct Coefficients {
  double normal, tangential;
};

template <Shape shape, class Of>
Moments moments_of(const Model& f, const Assembly& a, const Of& coefficients) {
  constexpr int D = dimension_of(shape);
  // Monomials of n of degree four and two; the servo renews its gain every few dozen sub-steps.
  constexpr int degree4 = D == 2 ? 5 : 15;
  double four[degree4] = {}, two[6] = {};
  const PairGeometry<shape> pair(f, a);
  for (const std::int32_t place : a.pairs.order) {
    const auto p = std::size_t(place);
    const PairPlace at = pair(p);
    const Branch& b = at.branch;
    if (!(at.overlap > 0)) continue;
    const auto [kn, kt] = coefficients(p, at);
    const double part = (kn - kt) / (b.x * b.x + b.y * b.y + b.z * b.z);
    const double x = b.x, y = b.y, xx = x * x, yy = y * y, xy = x * y;
    two[0] += kt * xx;
    two[1] += kt * yy;
    two[5] += kt * xy;
    four[0] += part * (xx * xx);
    four[1] += part * (xx * xy);
    four[2] += part * (xx * yy);
    four[3] += part * (xy * yy);
    four[4] += part * (yy * yy);
    if constexpr (D == 3) {
      const double z = b.z, zz = z * z, yz = y * z, xz = x * z;
      two[2] += kt * zz;
      two[3] += kt * yz;
      two[4] += kt * xz;
      four[5] += part * (zz * zz);
      four[6] += part * (xx * zz);
      four[7] += part * (yy * zz);
      four[8] += part * (xx * yz);
      four[9] += part * (xx * xz);
      four[10] += part * (yy * yz);
      four[11] += part * (yy * xz);
      four[12] += part * (zz * yz);
      four[13] += part * (zz * xz);
      four[14] += part * (zz * xy);
    }
  }
  Moments m;
  m.second << two[0], two[5], two[4], two[5], two[1], two[3], two[4], two[3], two[2];
  double z4 = 0, xxzz = 0, yyzz = 0, xxyz = 0, xxxz = 0, yyyz = 0, yyxz = 0, zzyz = 0, zzxz = 0, zzxy = 0;
  if constexpr (D == 3) {
    z4 = four[5];
    xxzz = four[6];
    yyzz = four[7];
    xxyz = four[8];
    xxxz = four[9];
    yyyz = four[10];
    yyxz = four[11];
    zzyz = four[12];
    zzxz = four[13];
    zzxy = four[14];
  }
  const double x4 = four[0], xxxy = four[1], xxyy = four[2], yyxy = four[3], y4 = four[4];
  m.fourth << x4, xxyy, xxzz, xxyz, xxxz, xxxy,  //
      xxyy, y4, yyzz, yyyz, yyxz, yyxy,          //
      xxzz, yyzz, z4, zzyz, zzxz, zzxy,          //
      xxyz, yyyz, zzyz, yyzz, zzxy, yyxz,        //
      xxxz, yyxz, zzxz, zzxy, xxzz, xxyz,        //
      xxxy, yyxy, zzxy, yyxz, xxyz, xxyy;
  return m;
}

/// Strain components of the cell frame from those of the laboratory frame, as a matrix.
Matrix6 strain_turn(const Matrix3& rotation) {
  Matrix6 turn;
  for (int k = 0; k < 6; ++k)
    turn.col(k) = strain_components(rotation.transpose() * strain_matrix(Vector6::Unit(k)) * rotation);
  return turn;
}

/// sum kn (n b)(n b) + kt (t b)(t b) over contacts whose normal is not along the branch, with symmetric parts of the
/// dyads: under eps such a contact changes by n . eps b along n and by t . eps b across it. Cell frame, in the plane.
template <Shape shape, class Of>
Matrix6 sum_over_outlines(const Model& f, const Assembly& a, const Of& coefficients) {
  Matrix6 sum = Matrix6::Zero();
  const PairGeometry<shape> pair(f, a);
  const auto dyad = [](double x, double y, const Branch& b) {
    Vector6 components = Vector6::Zero();
    components[0] = x * b.x;
    components[1] = y * b.y;
    components[5] = 0.5 * (x * b.y + y * b.x);
    return components;
  };
  for (const std::int32_t place : a.pairs.order) {
    const auto p = std::size_t(place);
    const OutlinePlace at = pair(p);
    if (!(at.overlap > 0)) continue;
    const auto [kn, kt] = coefficients(p, at);
    const Vector6 along = dyad(at.normal.x, at.normal.y, at.branch),
                  across = dyad(-at.normal.y, at.normal.x, at.branch);
    sum += kn * along * along.transpose() + kt * across * across.transpose();
  }
  return sum;
}

template <Shape shape, class Of>
Matrix6 sum_over_round(const Model& f, const Assembly& a, const Of& coefficients) {
  // C_ijkl = sum l^2 [(kn - kt) n_i n_j n_k n_l
  //                   + kt/4 (n_i n_k d_jl + n_i n_l d_jk + n_j n_k d_il + n_j n_l d_ik)], see README.md.
  const Moments m = moments_of<shape>(f, a, coefficients);
  constexpr int first[6] = {0, 1, 2, 1, 0, 0}, second[6] = {0, 1, 2, 2, 2, 1};
  Matrix6 stiffness = m.fourth;
  for (int r = 0; r < 6; ++r)
    for (int c = 0; c < 6; ++c) {
      const int i = first[r], j = second[r], k = first[c], l = second[c];
      stiffness(r, c) += 0.25 * ((j == l ? m.second(i, k) : 0) + (j == k ? m.second(i, l) : 0) +
                                 (i == l ? m.second(j, k) : 0) + (i == k ? m.second(j, l) : 0));
    }
  return stiffness;
}

template <class Of>
Matrix6 affine_sum(const Model& f, const Assembly& a, const Of& coefficients) {
  const Matrix6 stiffness = with_shape(f.shape, [&](auto shape) -> Matrix6 {
    if constexpr (is_round(shape.value))
      return sum_over_round<shape.value>(f, a, coefficients);
    else
      return sum_over_outlines<shape.value>(f, a, coefficients);
  });
  const Matrix6 turn = strain_turn(a.cell.rotation);
  return turn.transpose() * stiffness * turn / a.cell.volume();
}

}  // namespace

Matrix6 affine_stiffness(const Model& f, const Assembly& a) {
  return with_force(f, [&](auto force) {
    return affine_sum(f, a, [&](std::size_t p, const auto& at) -> Coefficients {
      const ContactStiffness k = stiffness_of<decltype(force)>(f, parameters_of(f, a.pairs, p), at.overlap,
                                                               hertz_radius_ratio(f, a.pairs, p, at));
      return {k.normal, k.tangential};
    });
  });
}

Matrix6 affine_viscosity(const Model& f, const Assembly& a) {
  if (f.damping.dashpot == Dashpot::none) return Matrix6::Zero();
  return affine_sum(f, a, [&](std::size_t p, const auto& at) -> Coefficients {
    const double root = root_overlap(at.overlap, hertz_radius_ratio(f, a.pairs, p, at));
    const double c = dashpot_now(f, a.pairs.cn[p], root);
    return {c, f.damping.tangential_ratio * c};
  });
}

}  // namespace rvelab
