// Anisotropies of a contact network, and the resulting relation of stress, force and fabric.
//
// Distributions over the directions n of contact normals, to the second order (E: density of contacts; f_n, f_t:
// normal and tangential force, l_n, l_t: branch along and across n; a: symmetric, traceless tensors):
//   E(n)   = (1 + n.a_c n + fourth order)/2pi in 2D, /4pi in 3D
//   f_n(n) = f_0 (1 + n.a_n n)                f_t(n) = f_0 (a_t n - (n.a_t n) n)
//   l_n(n) = l_0 (1 + n.a_l n)                l_t(n) = l_0 (a_lt n - (n.a_lt n) n), zero where grains are round
// a_c follows from the moments of n: 4 (phi - I/2) in 2D, 15/2 (phi - I/3) in 3D, phi = <n (x) n>. The others are least
// squares over the contacts (Kanatani 1984); with equal weight of all directions they are the integrals over f_n(n) of
// the literature. The stress of these distributions, compression positive, is N/V times the integral of
// E(n) f(n) (x) l(n) over the directions, f and l with their parts along and across n. It is integrated numerically
// and not expanded for small amplitudes: anisotropies of bedded ellipses are of order one, with different axes. For
// small ones with the axes of the stress it is, with the amplitudes (2D sqrt(a:a/2), 3D sqrt(3 a:a/2)),
//   2D: q/p = (a_c + a_n + a_t + a_l + a_lt)/2 / (1 + (a_c a_n + a_c a_l + a_n a_l + a_t a_lt)/2)
//   3D: q/p = 2/5 (a_c + a_n + a_l + 3/2 (a_t + a_lt))
// 2D: Rothenburg and Bathurst (1989); ellipses, with a_lt: Rothenburg and Bathurst (1992). 3D: Chantawarangul (1993),
// Guo and Zhao (2013).
#pragma once

#include "rvelab/solver/assembly/network.hpp"

namespace rvelab {

/// Laboratory frame, symmetric, traceless. NaN without contacts.
struct Anisotropies {
  Matrix3 normals = Matrix3::Zero();              ///< a_c
  Matrix3 normal_forces = Matrix3::Zero();        ///< a_n
  Matrix3 tangential_forces = Matrix3::Zero();    ///< a_t
  Matrix3 branches = Matrix3::Zero();             ///< a_l
  Matrix3 tangential_branches = Matrix3::Zero();  ///< a_lt
  double fourth_order = 0;       ///< of the normals: 2D the b of b cos 4 (theta - theta_b), 3D the size of D in
                                 ///< D_ijkl n_i n_j n_k n_l, as the amplitude of a P_4 about one axis
  double mean_normal_force = 0;  ///< f_0, N: the mean over the directions
  double mean_branch = 0;        ///< l_0, m
};
Anisotropies anisotropies(const Network& network);

/// Amplitudes along the deviator s of the contact stress (compression positive): sqrt(1/2) a:s/|s| in 2D, sqrt(3/2)
/// a:s/|s| in 3D. For a tensor with the axes of the stress this is its amplitude, positive if it adds to q. All are
/// zero without a deviator, NaN without contacts. q, p as in measures.hpp.
struct StressForceFabric {
  double a_c = 0, a_n = 0, a_t = 0, a_l = 0, a_lt = 0;
  double predicted = 0;  ///< q/p of the stress of these distributions, along the same deviator
  double measured = 0;   ///< q/p of the contact stress
};
StressForceFabric stress_force_fabric(const Network& network);

}  // namespace rvelab
