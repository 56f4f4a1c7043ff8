// The pair loop of spheres (kernel_pairs.hpp), in four passes: grain rows to columns; place and velocity; what the old
// history and the motion give in the new tangent plane; the capped forces.
#pragma once

#include "rvelab/contact/damping.hpp"
#include "rvelab/contact/hertz.hpp"
#include "rvelab/contact/linear.hpp"
#include "rvelab/contact/rolling.hpp"
#include "rvelab/solver/kernel_pairs.hpp"

namespace rvelab {
namespace {

/// What the passes hand on.
struct SphereScratch {
  TripleColumn normal;  ///< first the place of j less that of i
  ScratchColumn length, radii;
  TripleColumn velocity;             ///< of j less that of i; then of the centres over the step; then the slip rate
  TripleColumn spins, radius_spins;  ///< w_i + w_j and r_i w_i + r_j w_j; then the carried history (and moment)
  TripleColumn spin_difference;      ///< w_j - w_i (rolling)
  ScratchColumn root, opening;       ///< sqrt(overlap), rate at which the centres part
};

/// Grain rows to columns. Shuffles cost the same at every width, so this pass keeps to four lanes.
template <class T>
inline __attribute__((always_inline)) void sphere_rows(const PairArrays& p, const double* rows, long first, long count,
                                                       SphereScratch& out) {
  constexpr int W = T::W < 4 ? T::W : 4;
  using V = typename Lanes<W>::V;
  for (long k = 0; k < count; k += W) {
    const std::int32_t *i = p.row_i + first + k, *j = p.row_j + first + k;
    V d[4];
    gather_columns<W>(rows, i, j, 0, quad<W>(-1.0, -1.0, -1.0, 1.0), d);
    out.normal.store(k, Triple<V>{d[0], d[1], d[2]});
    store_as(out.radii.at + k, d[3]);
    if constexpr (T::Advance || T::Dashpot) {
      V v[4];
      gather_differences<W>(rows + 4, i, j, v);
      out.velocity.store(k, Triple<V>{v[0], v[1], v[2]});
    }
  }
  if constexpr (T::Advance || T::Dashpot)
    for (long k = 0; k < count; k += W) {
      const std::int32_t *i = p.row_i + first + k, *j = p.row_j + first + k;
      V a[4], b[4];
      ColumnsOf<W>::load([=](int lane) { return rows + i[lane] + 8; }, a);
      ColumnsOf<W>::load([=](int lane) { return rows + j[lane] + 8; }, b);
      out.spins.store(k, Triple<V>{a[0] + b[0], a[1] + b[1], a[2] + b[2]});
      out.radius_spins.store(
          k, Triple<V>{b[3] * b[0] + a[3] * a[0], b[3] * b[1] + a[3] * a[1], b[3] * b[2] + a[3] * a[2]});
      if constexpr (T::Rolling && T::Advance)
        out.spin_difference.store(k, Triple<V>{b[0] - a[0], b[1] - a[1], b[2] - a[2]});
    }
}

/// Branch of pairs, from the places in the cell of j less that of i.
template <class V>
inline __attribute__((always_inline)) Triple<V> branch_of(const StepConstants& c, const PairArrays& p, long at,
                                                          const Triple<V>& d) {
  const V image_x = load_as<V>(p.image[0] + at), image_y = load_as<V>(p.image[1] + at);
  const V image_z = load_as<V>(p.image[2] + at);
  return {d.x + (c.lattice.xx * image_x + (c.lattice.xy * image_y + c.lattice.xz * image_z)),
          d.y + (c.lattice.yy * image_y + c.lattice.yz * image_z), d.z + c.lattice.zz * image_z};
}

/// Branch, normal and the motion of the centres.
template <class T>
inline __attribute__((always_inline)) void sphere_places(const StepConstants& c, const PairArrays& p, long first,
                                                         long count, SphereScratch& s) {
  using V = typename Lanes<T::W>::V;
  const double half_dt = 0.5 * c.dt;
  for (long k = 0; k < count; k += T::W) {
    const long at = first + k;
    const Triple<V> b = branch_of<V>(c, p, at, s.normal.load<V>(k));
    const V length = square_root(dot(b, b));
    s.normal.store(k, times(1.0 / length, b));
    store_as(s.length.at + k, length);
    if constexpr (T::Advance || T::Dashpot) {
      const Triple<V> v = s.velocity.load<V>(k);
      const Triple<V> px = plus(b, V{} - half_dt, v);
      s.velocity.store(k, Triple<V>{v.x + (c.rate.xx * px.x + (c.rate.xy * px.y + c.rate.xz * px.z)),
                                    v.y + (c.rate.yy * px.y + c.rate.yz * px.z), v.z + c.rate.zz * px.z});
    }
  }
}

/// The slip rate and the carried histories.
template <class Law, class T>
inline __attribute__((always_inline)) void sphere_motion(const StepConstants& c, const PairArrays& p, long first,
                                                         long count, SphereScratch& s) {
  using V = typename Lanes<T::W>::V;
  constexpr bool twist = T::slip != Slip::full_radius;
  const V zero = V{}, one = zero + 1.0;
  for (long k = 0; k < count; k += T::W) {
    const long at = first + k;
    const Triple<V> n = s.normal.load<V>(k);
    const V length = load_as<V>(s.length.at + k), radii = load_as<V>(s.radii.at + k);
    const V overlap = radii - length;
    V root = zero;
    if constexpr (Law::needs_root_overlap || T::Dashpot) {
      root = square_root((overlap > 0.0) ? overlap : zero);
      store_as(s.root.at + k, root);
    }
    V mean_twist = zero;
    if constexpr (T::Advance || T::Dashpot) {
      // The mean spin of the cell is added to both grains.
      const Triple<V> u = s.velocity.load<V>(k), sum = s.spins.load<V>(k), weighted = s.radius_spins.load<V>(k);
      const Triple<V> spins = {sum.x + 2.0 * c.spin[0], sum.y + 2.0 * c.spin[1], sum.z + 2.0 * c.spin[2]};
      Triple<V> arms = {weighted.x + c.spin[0] * radii, weighted.y + c.spin[1] * radii, weighted.z + c.spin[2] * radii};
      const V opening = dot(n, u);
      Triple<V> along = plus(u, -opening, n);
      if constexpr (T::slip == Slip::full_radius_ratcheting) along = times(radii / length, along);
      if constexpr (T::slip == Slip::consistent) arms = plus(arms, -(0.5 * overlap), spins);
      s.velocity.store(k, plus(along, -one, cross(arms, n)));
      if constexpr (T::Dashpot) store_as(s.opening.at + k, opening);
      mean_twist = 0.5 * dot(n, spins);
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

template <class Law, class T>
inline __attribute__((always_inline)) void sphere_forces(const StepConstants& c, const PairArrays& p, long first,
                                                         long count, const SphereScratch& s, Dissipation* dissipation) {
  constexpr int W = T::W;
  using V = typename Lanes<W>::V;
  const V zero = V{}, one = zero + 1.0;
  for (long k = 0; k < count; k += W) {
    const long at = first + k;
    const Triple<V> n = s.normal.load<V>(k);
    const V overlap = load_as<V>(s.radii.at + k) - load_as<V>(s.length.at + k), half_overlap = 0.5 * overlap;
    const auto touching = overlap > 0.0;
    V root = zero;
    if constexpr (Law::needs_root_overlap || T::Dashpot) root = load_as<V>(s.root.at + k);
    V normal = Law::normal_force(load_as<V>(p.kn + at), overlap, root);
    Triple<V> slip_rate = {zero, zero, zero};
    if constexpr (T::Advance || T::Dashpot) slip_rate = s.velocity.load<V>(k);
    V c_normal = zero, opening = zero;
    if constexpr (T::Dashpot) {
      opening = load_as<V>(s.opening.at + k);
      c_normal = dashpot_coefficient(load_as<V>(p.cn + at), root, c.dashpot_quarters, SquareRoot{});
      normal = normal - c_normal * opening;
      if (c.no_tension) normal = (normal > 0.0) ? normal : zero;
    }
    Triple<V> tangential = {load_as<V>(p.tangential[0] + at), load_as<V>(p.tangential[1] + at),
                            load_as<V>(p.tangential[2] + at)};
    const V kt = Law::tangential_stiffness(load_as<V>(p.kt + at), root);
    V last_root = zero;
    if constexpr (Law::stores_root_overlap) last_root = load_as<V>(p.root_overlap + at);
    const V viscous = c.tangential_ratio * c_normal;
    [[maybe_unused]] const Triple<V> before = tangential;
    [[maybe_unused]] Triple<V> trial = tangential;
    if constexpr (T::Advance) {
      const V limit = load_as<V>(p.friction + at) * magnitude_of(normal);
      tangential = plus(s.spins.load<V>(k), -(kt * c.dt), slip_rate);
      trial = tangential;
      Triple<V> total = tangential;
      if constexpr (T::Dashpot) total = plus(total, -viscous, slip_rate);
      const V squared = dot(total, total);
      const auto sliding = squared > limit * limit;
      const V shrink = limit / square_root(sliding ? squared : one);
      Triple<V> capped = times(shrink, total);
      if constexpr (T::Dashpot) capped = plus(capped, viscous, slip_rate);
      tangential = {sliding ? capped.x : tangential.x, sliding ? capped.y : tangential.y,
                    sliding ? capped.z : tangential.z};
      tangential = {touching ? tangential.x : zero, touching ? tangential.y : zero, touching ? tangential.z : zero};
      store_as(p.tangential[0] + at, tangential.x);
      store_as(p.tangential[1] + at, tangential.y);
      store_as(p.tangential[2] + at, tangential.z);
      if constexpr (Law::stores_root_overlap) store_as(p.root_overlap + at, root);
    }
    Triple<V> total = tangential;
    if constexpr (T::Dashpot) {
      total = plus(total, -viscous, slip_rate);
      total = {touching ? total.x : zero, touching ? total.y : zero, touching ? total.z : zero};
    }
    normal = touching ? normal : zero;

    if constexpr (T::Rolling && T::Advance) {
      Triple<V> moment = {load_as<V>(p.moment[0] + at), load_as<V>(p.moment[1] + at), load_as<V>(p.moment[2] + at)};
      [[maybe_unused]] const V moment_before = dot(moment, moment);
      const V kr = Law::tangential_stiffness(load_as<V>(p.kr + at), root);
      moment = s.radius_spins.load<V>(k);
      [[maybe_unused]] const V moment_carried = dot(moment, moment);
      const Triple<V> w = s.spin_difference.load<V>(k);
      const Triple<V> bending = plus(w, -dot(n, w), n);
      moment = plus(moment, -(kr * c.dt), bending);
      const V cap = load_as<V>(p.moment_cap + at) * ((normal > 0.0) ? normal : zero);
      const V squared = dot(moment, moment);
      const auto rolling_over = squared > cap * cap;
      const V shrink = cap / square_root(rolling_over ? squared : one);
      [[maybe_unused]] const Triple<V> moment_trial = moment;
      moment = times(rolling_over ? shrink : one, moment);
      moment = {touching ? moment.x : zero, touching ? moment.y : zero, touching ? moment.z : zero};
      store_as(p.moment[0] + at, moment.x);
      store_as(p.moment[1] + at, moment.y);
      store_as(p.moment[2] + at, moment.z);
      if constexpr (T::Ledger) {
        if (touching && kr > 0.0) {
          const Triple<V> both = plus(plus(moment, one, moment_trial), kr * c.dt, bending);
          dissipation->rolling += 0.5 * dot(plus(moment_trial, -one, moment), both) / kr;
          if (Law::stores_root_overlap && last_root > 0)
            dissipation->law_loss += 0.5 * (moment_before / (p.kr[at] * last_root) - moment_carried / kr);
        } else if (!touching && moment_before > 0.0) {
          const double last_kr = Law::stores_root_overlap ? p.kr[at] * last_root : kr;
          if (last_kr > 0) dissipation->rolling += 0.5 * moment_before / last_kr;
        }
      }
    }
    if constexpr (T::Ledger && T::Advance && T::Dashpot) {
      if (touching) dissipation->dashpot += c.dt * (c_normal * opening * opening + viscous * dot(slip_rate, slip_rate));
    }
    if constexpr (T::Ledger && T::Advance) {
      if (touching && kt > 0.0) {
        // Work of the mean of old and new force, as for discs.
        const Triple<V> both = plus(plus(tangential, one, trial), kt * c.dt, slip_rate);
        dissipation->friction += 0.5 * dot(plus(trial, -one, tangential), both) / kt;
        if constexpr (Law::stores_root_overlap) {
          const double scale = Law::carried(root, last_root, c.unload_rescale);
          if (last_root > 0)
            dissipation->law_loss += 0.5 * dot(before, before) * (1 / (p.kt[at] * last_root) - scale * scale / kt);
        }
      } else if (!touching) {
        const double last_kt = Law::stores_root_overlap ? p.kt[at] * last_root : kt;
        if (last_kt > 0) dissipation->friction += 0.5 * dot(before, before) / last_kt;
      }
    }

    const Triple<V> torque = cross(n, total);
    const V first_half[4] = {n.x * normal + total.x, n.y * normal + total.y, n.z * normal + total.z, half_overlap};
    const V second_half[4] = {torque.x, torque.y, torque.z, zero};
    rows_of<W>(first_half, p.force + 8 * at, 8);
    rows_of<W>(second_half, p.force + 8 * at + 4, 8);
  }
}

/// Whether one of eight pairs touches.
template <int W>
inline __attribute__((always_inline)) bool spheres_touch(const StepConstants& c, const PairArrays& p,
                                                         const double* rows, long first) {
  using V = typename Lanes<W>::V;
  auto touching = V{} > 0.0;
#pragma GCC unroll 8
  for (long at = first; at < first + 8; at += W) {
    V d[4];
    gather_columns<W>(rows, p.row_i + at, p.row_j + at, 0, quad<W>(-1.0, -1.0, -1.0, 1.0), d);
    const Triple<V> b = branch_of<V>(c, p, at, {d[0], d[1], d[2]});
    touching = touching | (dot(b, b) < d[3] * d[3]);
  }
  return any_of(touching);
}

/// Spheres in 3D.
template <class Law, class T>
void sphere_pairs(const StepConstants& constants, const PairArrays& arrays, const double* rows, long begin, long end,
                  Dissipation* dissipation) {
  const StepConstants c = constants;
  const PairArrays p = arrays;
  SphereScratch scratch;
  constexpr int narrow = T::W < 4 ? T::W : 4;
  for (PairRun run{begin, 0, begin}; run.next < end;) {
    run = next_run(p, run.next, end, [&](long at) { return spheres_touch<narrow>(c, p, rows, at); });
    const long first = run.first, count = run.count;
    sphere_rows<T>(p, rows, first, count, scratch);
    sphere_places<T>(c, p, first, count, scratch);
    sphere_motion<Law, T>(c, p, first, count, scratch);
    sphere_forces<Law, T>(c, p, first, count, scratch, dissipation);
  }
}

}  // namespace
}  // namespace rvelab
