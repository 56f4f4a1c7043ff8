// The contact update in space, for every shape and law: histories carried to the new tangent plane, spring and slip,
// dashpot, rolling moment, losses. The shape gives the geometry: where pairs are, how they overlap, how they move.
#pragma once

#include "rvelab/contact/coulomb.hpp"
#include "rvelab/contact/damping.hpp"
#include "rvelab/contact/rolling.hpp"
#include "rvelab/solver/kernels/losses.hpp"
#include "rvelab/solver/kernels/pairs.hpp"

namespace rvelab {
namespace {

/// What the passes hand on. A shape's scratch begins with it.
struct SpaceScratch {
  TripleColumn normal;
  TripleColumn velocity;             ///< of j less that of i; then of the centres over the step; then the slip rate
  TripleColumn spins, radius_spins;  ///< a shape's sums of spins; then the carried history (and moment)
  TripleColumn spin_difference;      ///< w_j - w_i (rolling)
  ScratchColumn root, opening;       ///< sqrt(overlap), rate at which the centres part
};

/// Motion of W pairs where they touch.
template <class V>
struct SpaceMotion {
  Triple<V> slip_rate;  ///< of j less that of i, m/s
  V opening;            ///< along n, m/s
  V twist;              ///< mean spin of the two about n, rad/s
};

/// The slip rate and the carried histories.
template <class Shape, class Law, class T>
inline __attribute__((always_inline)) void space_motion(const StepConstants& c, const PairArrays& p, long first,
                                                        long count, typename Shape::Scratch& s) {
  using V = typename Lanes<T::W>::V;
  constexpr bool twist = T::slip != Slip::full_radius;
  const V zero = V{}, one = zero + 1.0;
  for (long k = 0; k < count; k += T::W) {
    const long at = first + k;
    const Triple<V> n = s.normal.template load<V>(k);
    V root = zero;
    if constexpr (Law::needs_root_overlap || T::Dashpot) {
      const V overlap = Shape::template overlap<V>(k, s);
      root = square_root((overlap > 0.0) ? overlap : zero);
      store_as(s.root.at + k, root);
    }
    V mean_twist = zero;
    if constexpr (T::Advance || T::Dashpot) {
      const SpaceMotion<V> motion = Shape::template motion<T>(c, n, k, s);
      s.velocity.store(k, motion.slip_rate);
      if constexpr (T::Dashpot) store_as(s.opening.at + k, motion.opening);
      mean_twist = motion.twist;
    }
    if constexpr (T::Advance) {
      V ratio = one;
      if constexpr (Law::stores_root_overlap)
        ratio = Law::carried(root, load_as<V>(p.root_overlap + at), c.unload_rescale);
      const Triple<V> tangential = {load_as<V>(p.tangential[0] + at), load_as<V>(p.tangential[1] + at),
                                    load_as<V>(p.tangential[2] + at)};
      s.spins.store(k, times(ratio, carried_history(tangential, n, mean_twist * c.dt, twist)));
      if constexpr (T::Rolling) {
        const Triple<V> moment = {load_as<V>(p.moment[0] + at), load_as<V>(p.moment[1] + at),
                                  load_as<V>(p.moment[2] + at)};
        s.radius_spins.store(k, times(ratio, carried_history(moment, n, mean_twist * c.dt, twist)));
      }
    }
  }
}

/// Three columns of pair arrays.
template <class V>
inline __attribute__((always_inline)) Triple<V> load_triple(double* const* from, long at) {
  return {load_as<V>(from[0] + at), load_as<V>(from[1] + at), load_as<V>(from[2] + at)};
}
template <class V>
inline __attribute__((always_inline)) void store_triple(double* const* to, long at, const Triple<V>& value) {
  store_as(to[0] + at, value.x);
  store_as(to[1] + at, value.y);
  store_as(to[2] + at, value.z);
}

template <class Shape, class Law, class T>
inline __attribute__((always_inline)) void space_forces(const StepConstants& c, const PairArrays& p, long first,
                                                        long count, const typename Shape::Scratch& s,
                                                        Dissipation* dissipation) {
  constexpr int W = T::W;
  using V = typename Lanes<W>::V;
  const V zero = V{};
  const Triple<V> none = {zero, zero, zero};
  for (long k = 0; k < count; k += W) {
    const long at = first + k;
    const Triple<V> n = s.normal.template load<V>(k);
    const V overlap = Shape::template overlap<V>(k, s), half_overlap = 0.5 * overlap;
    const auto touching = overlap > 0.0;
    V root = zero, law_constant = zero;
    if constexpr (Law::needs_root_overlap || T::Dashpot) root = load_as<V>(s.root.at + k);
    if constexpr (Law::has_law_constant) law_constant = load_as<V>(p.law_constant + at);
    V normal = Law::normal_force(load_as<V>(p.kn + at), overlap, root, law_constant);
    Triple<V> slip_rate = none;
    if constexpr (T::Advance || T::Dashpot) slip_rate = s.velocity.template load<V>(k);
    V c_normal = zero, opening = zero;
    if constexpr (T::Dashpot) {
      opening = load_as<V>(s.opening.at + k);
      c_normal = dashpot_coefficient(load_as<V>(p.cn + at), root, c.dashpot_quarters);
      normal = normal - c_normal * opening;
      if (c.no_tension) normal = without_tension<Law>(normal, law_constant);
    }
    const V pressing = Law::pressing_force(normal, law_constant);
    Triple<V> tangential = load_triple<V>(p.tangential, at);
    const V kt = Law::tangential_stiffness(load_as<V>(p.kt + at), root);
    [[maybe_unused]] V last_root = zero;
    if constexpr (Law::stores_root_overlap && T::Ledger) last_root = load_as<V>(p.root_overlap + at);
    const V viscous = c.tangential_ratio * c_normal;
    if constexpr (T::Advance) {
      const V limit = friction_limit(load_as<V>(p.friction + at), pressing);
      [[maybe_unused]] const Triple<V> before = tangential;
      const Triple<V> carried = s.spins.template load<V>(k);
      const Triple<V> trial = plus(carried, -(kt * c.dt), slip_rate);
      tangential = chosen(touching, within_friction<T::Dashpot>(trial, limit, viscous, slip_rate), none);
      store_triple(p.tangential, at, tangential);
      if constexpr (Law::stores_root_overlap) store_as(p.root_overlap + at, root);
      if constexpr (T::Ledger)
        if (dissipation != nullptr) {
          const double last_kt = Law::stores_root_overlap ? p.kt[at] * last_root : kt;
          book_spring<Law::stores_root_overlap>(
              SpringStep<Triple<V>>{before, carried, trial, tangential, times(kt * c.dt, slip_rate), kt, last_kt},
              touching, dissipation->friction, dissipation->law_loss);
          if (T::Dashpot && touching)
            dissipation->dashpot += c.dt * (c_normal * opening * opening + viscous * dot(slip_rate, slip_rate));
        }
    }
    Triple<V> total = tangential;
    if constexpr (T::Dashpot) total = chosen(touching, plus(total, -viscous, slip_rate), none);
    normal = touching ? normal : zero;

    if constexpr (T::Rolling && T::Advance) {
      const V kr = Law::tangential_stiffness(load_as<V>(p.kr + at), root);
      [[maybe_unused]] Triple<V> before = none;
      if constexpr (T::Ledger) before = load_triple<V>(p.moment, at);
      const Triple<V> carried = s.radius_spins.template load<V>(k);
      const Triple<V> w = s.spin_difference.template load<V>(k);
      const Triple<V> bending = plus(w, -dot(n, w), n);
      const Triple<V> trial = plus(carried, -(kr * c.dt), bending);
      const V pushing = (pressing > 0.0) ? pressing : zero;
      const Triple<V> moment = chosen(touching, capped_moment(trial, load_as<V>(p.moment_cap + at) * pushing), none);
      store_triple(p.moment, at, moment);
      if constexpr (T::Ledger)
        if (dissipation != nullptr) {
          const double last_kr = Law::stores_root_overlap ? p.kr[at] * last_root : kr;
          book_spring<Law::stores_root_overlap>(
              SpringStep<Triple<V>>{before, carried, trial, moment, times(kr * c.dt, bending), kr, last_kr}, touching,
              dissipation->rolling, dissipation->law_loss);
        }
    }

    const Triple<V> torque = cross(n, total);
    const V first_half[4] = {n.x * normal + total.x, n.y * normal + total.y, n.z * normal + total.z, half_overlap};
    const V second_half[4] = {torque.x, torque.y, torque.z, zero};
    rows_of<W>(first_half, p.force + 8 * at, 8);
    rows_of<W>(second_half, p.force + 8 * at + 4, 8);
  }
}

/// The pair loop of a shape in space.
template <class Shape, class Law, class T>
void space_pairs(const StepConstants& constants, const PairArrays& arrays, const double* rows, long begin, long end,
                 Dissipation* dissipation) {
  const StepConstants c = constants;
  const PairArrays p = arrays;
  typename Shape::Scratch scratch;
  constexpr int narrow = T::W < 4 ? T::W : 4;
  for (PairRun run{begin, 0, begin}; run.next < end;) {
    run = next_run(p, run.next, end, [&](long at) { return Shape::template may_touch<narrow>(c, p, rows, at); });
    Shape::template locate<T>(c, p, rows, run.first, run.count, scratch);
    space_motion<Shape, Law, T>(c, p, run.first, run.count, scratch);
    space_forces<Shape, Law, T>(c, p, run.first, run.count, scratch, dissipation);
  }
}

}  // namespace
}  // namespace rvelab
