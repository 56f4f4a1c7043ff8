// Bonds as elastic beams of cement beside the contact of two grains (Potyondy and Cundall 2004, Int. J. Rock Mech. Min.
// Sci. 41, 1329-1364), with a criterion by which they break.
//
//   f_n = kn A (l0 - l),   f_s <- f_s - ks A du_s,   M_b <- M_b - kn I dtheta_b,   M_t <- M_t - ks J dtheta_t
//   sphere: A = pi R^2, I = pi R^4/4, J = 2 I;   disc of thickness t: A = 2 R t, I = 2/3 R^3 t, no twist
//
// l is the length of the branch, l0 that when the bond was made, without force; f_n is positive in compression; du_s is
// the slip of j against i half way along the branch, dtheta the rotation of j less that of i. f_s and M_b turn with the
// normal and with the mean spin about it. The contact of the two grains acts beside the bond. A broken bond is without
// force for good.
//
// A criterion is the name of the law, its four strengths, and which bonds break: 1 in tension, 2 in shear, 0 not.
#pragma once

#include "rvelab/interaction/law.hpp"

namespace rvelab {

/// What a criterion reads, of W bonds.
template <class V>
struct BeamLoad {
  V normal;                          ///< N, positive in compression
  V shear_squared, bending_squared;  ///< N^2, N^2 m^2
  V twisting;                        ///< magnitude, N m
  V radius, area;                    ///< m, m^2
  double rim = 0;                    ///< A R/I, the stress of a moment at the rim times A R: 4, of a rectangle 3
};

/// Adds the energy of bonds that break now to their column `released`; `of(energy)` adds up that of their springs.
template <class V, class Of>
static inline __attribute__((always_inline)) void book_release(const InteractionArrays& p, int released, long at, V was,
                                                               V how, const Of& of) {
  const V zero = V{}, one = zero + 1.0;
  const V now = (was == 0.0) ? how : zero;
  if (!any_of(now != zero)) return;
  const auto energy = [&](V squared, V stiffness) {
    const auto there = stiffness > 0.0;
    return there ? 0.5 * squared / (there ? stiffness : one) : zero;
  };
  const V last = load_as<V>(p.column[released] + at);
  store_as(p.column[released] + at, (now != zero) ? last + of(energy) : last);
}

template <class Criterion>
struct Beam : BondLaw<Beam<Criterion>> {
  static constexpr const char* name = Criterion::name;  ///< group of files
  static constexpr InteractionField fields[] = {
      {"length_m", "m", positive_number},                   // l0
      {"radius_m", "m", positive_number},                   // R
      {"normal_stiffness_Pa_m", "Pa/m", number_from_zero},  // kn
      {"shear_stiffness_Pa_m", "Pa/m", number_from_zero},   // ks
      Criterion::strengths[0],
      Criterion::strengths[1],
      Criterion::strengths[2],
      Criterion::strengths[3],
      {"broken", "1", {0, 2}, Turning::scalar, true},  // 0 no, 1 in tension, 2 in shear
      {"released_energy_J", "J", number_from_zero},    // as it broke
      {"shear_force_N", "N", {-no_bound, no_bound}, Turning::tangent},
      {"bending_moment_N_m", "N m", {-no_bound, no_bound}, Turning::moment},
      {"twisting_moment_N_m", "N m", {-no_bound, no_bound}},
  };
  /// Where they stand among the columns.
  enum Column {
    length,
    radius,
    normal_stiffness,
    shear_stiffness,
    strength,
    broken = strength + 4,
    released,
    shear_force,
    bending_moment = shear_force + 3,
    twisting_moment = bending_moment + 3,
  };

  /// Of an intact bond; column(k): the value of column k. `thickness` (m): in the plane, else 0.
  template <class Columns>
  static InteractionStiffness stiffness(const Columns& column, double /*gap*/, double thickness) {
    const double r = column(radius), area = thickness > 0 ? 2 * r * thickness : pi * r * r;
    const double inertia = area * r * r / (thickness > 0 ? 3 : 4);
    if (column(broken) != 0) return {};
    return {column(normal_stiffness) * area, column(shear_stiffness) * area, column(normal_stiffness) * inertia,
            thickness > 0 ? 0 : 2 * column(shear_stiffness) * inertia};
  }
  /// Its energy is that of linear springs, 1/2 f^2/k each.
  static constexpr bool has_energy = false;

  static constexpr double pi = 3.14159265358979323846;

  template <class V>
  static inline __attribute__((always_inline)) V broken_by(const InteractionArrays& p, long at,
                                                           const BeamLoad<V>& load) {
    V s[4];
    for (int k = 0; k < 4; ++k) s[k] = load_as<V>(p.column[strength + k] + at);
    return Criterion::template broken_by<V>(s, load);
  }

  /// Of bonds of which one is broken or breaks: keeps how, and returns it. Most blocks of lanes have none and are
  /// spared the stores and selections.
  template <bool Advance, class V>
  static inline __attribute__((always_inline)) V keep_broken(const InteractionArrays& p, long at, V was, V how) {
    const V now = (was == 0.0) ? how : was;
    if constexpr (Advance) store_as(p.column[broken] + at, now);
    return now;
  }

  template <bool Advance, class V>
  static inline __attribute__((always_inline)) PlaneForces<V> in_plane(const InteractionArrays& p, long at,
                                                                       const PlaneMotion<V>& m) {
    const V zero = V{};
    const V r = load_as<V>(p.column[radius] + at), area = (2.0 * p.thickness) * r,
            inertia = area * (r * r) * (1.0 / 3.0);
    const V kn = load_as<V>(p.column[normal_stiffness] + at), ks = load_as<V>(p.column[shear_stiffness] + at);
    const V was = load_as<V>(p.column[broken] + at);
    V how = zero;
    PlaneForces<V> f;
    f.normal = (kn * area) * (load_as<V>(p.column[length] + at) - m.length);
    f.tangential = load_as<V>(p.column[shear_force] + at);
    f.moment = load_as<V>(p.column[bending_moment + 2] + at);
    if constexpr (Advance) {
      f.tangential = f.tangential - (ks * area) * m.slip;
      f.moment = f.moment - (kn * inertia) * m.turn;
      how = broken_by<V>(p, at, {f.normal, f.tangential * f.tangential, f.moment * f.moment, zero, r, area, 3});
    }
    if (any_of(was + how != zero)) {
      if constexpr (Advance)
        book_release(p, released, at, was, how, [&](auto energy) {
          return energy(f.normal * f.normal, kn * area) + energy(f.tangential * f.tangential, ks * area) +
                 energy(f.moment * f.moment, kn * inertia);
        });
      const auto intact = keep_broken<Advance>(p, at, was, how) == zero;
      f.normal = intact ? f.normal : zero;
      f.tangential = intact ? f.tangential : zero;
      f.moment = intact ? f.moment : zero;
    }
    if constexpr (Advance) {
      store_as(p.column[shear_force] + at, f.tangential);
      store_as(p.column[bending_moment + 2] + at, f.moment);
    }
    return f;
  }

  /// `turned`: shear force and bending moment, in the present tangent plane.
  template <bool Advance, class V>
  static inline __attribute__((always_inline)) SpaceForces<V> in_space(const InteractionArrays& p, long at,
                                                                       const SpaceTurn<V>& m, const Triple<V>* turned) {
    const V zero = V{};
    const Triple<V> none = {zero, zero, zero};
    const V r = load_as<V>(p.column[radius] + at), area = pi * (r * r), inertia = area * (r * r) * 0.25;
    const V kn = load_as<V>(p.column[normal_stiffness] + at), ks = load_as<V>(p.column[shear_stiffness] + at);
    const V was = load_as<V>(p.column[broken] + at);
    V how = zero, twist = load_as<V>(p.column[twisting_moment] + at);
    Triple<V> shear = turned[0], bending = turned[1];
    SpaceForces<V> f;
    f.normal = (kn * area) * (load_as<V>(p.column[length] + at) - m.length);
    if constexpr (Advance) {
      shear = minus(shear, ks * area, m.slip);
      const V about = dot(m.n, m.turn);
      bending = minus(bending, kn * inertia, minus(m.turn, about, m.n));
      twist = twist - (ks * (2.0 * inertia)) * about;
      how = broken_by<V>(p, at, {f.normal, dot(shear, shear), dot(bending, bending), magnitude_of(twist), r, area, 4});
    }
    if (any_of(was + how != zero)) {
      if constexpr (Advance)
        book_release(p, released, at, was, how, [&](auto energy) {
          return (energy(f.normal * f.normal, kn * area) + energy(dot(shear, shear), ks * area)) +
                 (energy(dot(bending, bending), kn * inertia) + energy(twist * twist, (2.0 * ks) * inertia));
        });
      const auto intact = keep_broken<Advance>(p, at, was, how) == zero;
      f.normal = intact ? f.normal : zero;
      shear = chosen(intact, shear, none);
      bending = chosen(intact, bending, none);
      twist = intact ? twist : zero;
    }
    f.tangential = shear;
    f.moment = plus(bending, twist, m.n);
    if constexpr (Advance) {
      store_vec(p.column + shear_force, at, f.tangential);
      store_vec(p.column + bending_moment, at, bending);
      store_as(p.column[twisting_moment] + at, twist);
    }
    return f;
  }
};

}  // namespace rvelab
