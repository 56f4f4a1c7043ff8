// The contact update in the plane, for every shape and law: spring and slip, dashpot, rolling moment, losses. The shape
// gives the geometry: where pairs are, how they overlap, how they move. Moments lie along z, t = (-n_y, n_x).
#pragma once

#include "rvelab/contact/coulomb.hpp"
#include "rvelab/contact/damping.hpp"
#include "rvelab/contact/rolling.hpp"
#include "rvelab/solver/kernels/losses.hpp"
#include "rvelab/solver/kernels/pairs.hpp"

namespace rvelab {
namespace {

/// Geometry and motion of W pairs.
template <class V>
struct PlaneContact {
  Vec<V, 2> n;
  V overlap;
  V lever_i, lever_j;          ///< torque of a force of 1 along t, m
  V slip_rate = {};            ///< velocity of j less that of i along t where they touch, m/s
  V spin_difference = {};      ///< w_j - w_i, rad/s (rolling)
  V opening = {};              ///< along n, m/s (dashpots)
  V turn_i = {}, turn_j = {};  ///< torque of a force of 1 along n, m (shapes that are not round)
  V radius_ratio = {};         ///< R*/r* (Hertz's radius from curvature)
};

template <class Shape, class Law, class T>
inline __attribute__((always_inline)) void plane_forces(const StepConstants& c, const PairArrays& p, long first,
                                                        long count, const typename Shape::Scratch& in,
                                                        Dissipation* dissipation) {
  constexpr int W = T::W;
  using V = typename Lanes<W>::V;
  const V zero = V{};
  for (long k = 0; k < count; k += W) {
    const long at = first + k;
    const PlaneContact<V> contact = Shape::template contact<T>(c, p, at, k, in);
    const V overlap = contact.overlap, slip_rate = contact.slip_rate;
    const auto touching = overlap > 0.0;
    V root = zero, law_constant = zero;
    if constexpr (Law::has_law_constant) law_constant = load_as<V>(p.law_constant + at);
    if constexpr (T::Curvature)
      root = Law::root(touching ? overlap * contact.radius_ratio : zero, law_constant);
    else if constexpr (Law::needs_root_overlap || T::Dashpot)
      root = Law::root(touching ? overlap : zero, law_constant);

    V normal = Law::normal_force(load_as<V>(p.kn + at), overlap, root, law_constant);
    [[maybe_unused]] V c_normal = zero;
    if constexpr (T::Dashpot) {
      c_normal = Law::dashpot(load_as<V>(p.cn + at), overlap, root, law_constant, c.dashpot_quarters);
      normal = normal - c_normal * contact.opening;
      if (c.no_tension) normal = without_tension<Law>(normal, law_constant);
    }
    const V pressing = Law::pressing_force(normal, law_constant);

    V tangential = load_as<V>(p.tangential[0] + at);
    [[maybe_unused]] V last_root = zero, carried = zero;
    if constexpr (Law::stores_root_overlap) last_root = load_as<V>(p.root_overlap + at);
    [[maybe_unused]] const V viscous = (c.tangential_ratio * c_normal) * slip_rate;
    if constexpr (T::Advance) {
      const V kt = Law::tangential_stiffness(load_as<V>(p.kt + at), root);
      const V limit = friction_limit(load_as<V>(p.friction + at), pressing);
      [[maybe_unused]] const V before = tangential;
      if constexpr (Law::stores_root_overlap) {
        carried = Law::carried(root, last_root, c.unload_rescale);
        tangential = tangential * carried;
      }
      [[maybe_unused]] const V started = tangential;
      const V increment = kt * (slip_rate * c.dt);
      const V trial = tangential - increment;
      if constexpr (T::Dashpot)
        tangential = within_friction(trial, limit, viscous);
      else
        tangential = within_friction(trial, limit);
      tangential = touching ? tangential : zero;
      store_as(p.tangential[0] + at, tangential);
      if constexpr (Law::stores_root_overlap) store_as(p.root_overlap + at, root);
      if constexpr (T::Ledger)
        if (dissipation != nullptr) {
          const double last_kt = Law::stores_root_overlap ? Law::tangential_stiffness(p.kt[at], last_root) : kt;
          book_spring<Law::stores_root_overlap>(
              SpringStep<V>{before, started, trial, tangential, increment, kt, last_kt}, touching,
              dissipation->friction, dissipation->law_loss);
          if (T::Dashpot && touching)
            dissipation->dashpot += c.dt * (c_normal * contact.opening * contact.opening + viscous * slip_rate);
        }
    }
    V total = tangential;
    if constexpr (T::Dashpot) total = touching ? tangential - viscous : zero;
    normal = touching ? normal : zero;

    V moment = zero;
    if constexpr (T::Rolling) moment = load_as<V>(p.moment[0] + at);
    if constexpr (T::Rolling && T::Advance) {
      const V kr = Law::tangential_stiffness(load_as<V>(p.kr + at), root);
      [[maybe_unused]] const V before = moment;
      if constexpr (Law::stores_root_overlap) moment = moment * carried;
      [[maybe_unused]] const V started = moment;
      const V increment = kr * (contact.spin_difference * c.dt);
      const V trial = moment - increment;
      const V pushing = (pressing > 0.0) ? pressing : zero;
      moment = capped_moment(trial, load_as<V>(p.moment_cap + at) * pushing);
      moment = touching ? moment : zero;
      store_as(p.moment[0] + at, moment);
      if constexpr (T::Ledger)
        if (dissipation != nullptr) {
          const double last_kr = Law::stores_root_overlap ? Law::tangential_stiffness(p.kr[at], last_root) : kr;
          book_spring<Law::stores_root_overlap>(SpringStep<V>{before, started, trial, moment, increment, kr, last_kr},
                                                touching, dissipation->rolling, dissipation->law_loss);
        }
    }

    V torque_j = contact.lever_j * total, torque_i = contact.lever_i * total;
    if constexpr (!Shape::By::round) {
      torque_j = torque_j + contact.turn_j * normal;
      torque_i = torque_i + contact.turn_i * normal;
    }
    if constexpr (T::Rolling) {
      torque_j = torque_j + moment;
      torque_i = torque_i - moment;
    }
    const Vec<V, 2>& n = contact.n;
    const V columns[4] = {n.x * normal - n.y * total, n.y * normal + n.x * total, torque_j, torque_i};
    rows_of<W>(columns, p.force + force_row_length(2) * at, force_row_length(2));
  }
}

/// The passes over a run of pairs of a shape, after they are located.
template <class Shape, class Law, class T>
struct PlaneUpdate {
  static inline __attribute__((always_inline)) void run(const StepConstants& c, const PairArrays& p, const double*,
                                                        long first, long count, typename Shape::Scratch& scratch,
                                                        Dissipation* dissipation) {
    plane_forces<Shape, Law, T>(c, p, first, count, scratch, dissipation);
  }
};

}  // namespace
}  // namespace rvelab
