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
  V nx, ny, overlap;
  V lever_i, lever_j;          ///< torque of a force of 1 along t, m
  V slip_rate = {};            ///< velocity of j less that of i along t where they touch, m/s
  V spin_difference = {};      ///< w_j - w_i, rad/s (rolling)
  V opening = {};              ///< along n, m/s (dashpots)
  V turn_i = {}, turn_j = {};  ///< torque of a force of 1 along n, m (shapes that are not round)
  V radius_ratio = {};         ///< R*/r* (Hertz's radius from curvature)
};

/// Branches {x, y} of pairs, from the places in the cell of j less those of i.
template <class V>
inline __attribute__((always_inline)) void add_image_in_plane(const StepConstants& c, const PairArrays& p, long at,
                                                              V& x, V& y) {
  if (!p.shifted[std::size_t(at) / 8]) return;
  const V image_x = load_as<V>(p.image[0] + at), image_y = load_as<V>(p.image[1] + at);
  x = x + (c.lattice.xx * image_x + c.lattice.xy * image_y);
  y = y + c.lattice.yy * image_y;
}

/// Places and velocities of j less those of i, and both spins, of W pairs, from grain rows to columns k .. k + W - 1.
template <class T, int W, class Scratch>
inline __attribute__((always_inline)) void motion_to_columns(const double* rows, const std::int32_t (&i)[W],
                                                             const std::int32_t (&j)[W], long k, Scratch& out) {
  typename Lanes<W>::V d[4];
  gather_differences<W>(rows, i, j, d);
  store_as(out.dx.at + k, d[0]);
  store_as(out.dy.at + k, d[1]);
  if constexpr (T::Advance || T::Dashpot) {
    store_as(out.du.at + k, d[2]);
    store_as(out.dv.at + k, d[3]);
    store_as(out.spin_i.at + k, gather_spins<W>(rows, i));
    store_as(out.spin_j.at + k, gather_spins<W>(rows, j));
  }
}

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
    if constexpr (T::Curvature)
      root = square_root(touching ? overlap * contact.radius_ratio : zero);
    else if constexpr (Law::needs_root_overlap || T::Dashpot)
      root = square_root(touching ? overlap : zero);
    if constexpr (Law::has_law_constant) law_constant = load_as<V>(p.law_constant + at);

    V normal = Law::normal_force(load_as<V>(p.kn + at), overlap, root, law_constant);
    [[maybe_unused]] V c_normal = zero;
    if constexpr (T::Dashpot) {
      c_normal = dashpot_coefficient(load_as<V>(p.cn + at), root, c.dashpot_quarters);
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
          const double last_kt = Law::stores_root_overlap ? p.kt[at] * last_root : kt;
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
          const double last_kr = Law::stores_root_overlap ? p.kr[at] * last_root : kr;
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
    const V columns[4] = {contact.nx * normal - contact.ny * total, contact.ny * normal + contact.nx * total, torque_j,
                          torque_i};
    rows_of<W>(columns, p.force + 4 * at, 4);
  }
}

/// The pair loop of a shape in the plane.
template <class Shape, class Law, class T>
void plane_pairs(const StepConstants& constants, const PairArrays& arrays, const double* rows, long begin, long end,
                 Dissipation* dissipation) {
  // Copies that no store can change: else every store would make the compiler read all pointers again.
  const StepConstants c = constants;
  const PairArrays p = arrays;
  typename Shape::Scratch scratch;
  constexpr int narrow = T::W < 4 ? T::W : 4;
  for (PairRun run{begin, 0, begin}; run.next < end;) {
    run = next_run(p, run.next, end, [&](long at) { return Shape::template may_touch<narrow>(c, p, rows, at); });
    Shape::template locate<T>(c, p, rows, run.first, run.count, scratch);
    plane_forces<Shape, Law, T>(c, p, run.first, run.count, scratch, dissipation);
  }
}

}  // namespace
}  // namespace rvelab
