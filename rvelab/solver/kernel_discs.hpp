// The pair loop of discs (kernel_pairs.hpp). Moments lie along z; the tangent is t = (-n_y, n_x).
#pragma once

#include "rvelab/contact/damping.hpp"
#include "rvelab/contact/hertz.hpp"
#include "rvelab/contact/linear.hpp"
#include "rvelab/contact/rolling.hpp"
#include "rvelab/solver/kernel_pairs.hpp"

namespace rvelab {
namespace {

/// What the passes hand on.
struct DiscScratch {
  ScratchColumn dx, dy, du, dv;  ///< place and velocity of j less those of i
  ScratchColumn spin_i, spin_j;
  ScratchColumn nx, ny, length;
  ScratchColumn along, opening;  ///< relative velocity of the centres over the step, along t and along n
};

/// Grain rows to columns. Shuffles cost the same at every width, so this pass keeps to four lanes.
template <class T>
inline __attribute__((always_inline)) void disc_rows(const PairArrays& p, const double* rows, long first, long count,
                                                     DiscScratch& out) {
  constexpr int W = T::W < 4 ? T::W : 4;
  using V = typename Lanes<W>::V;
  for (long k = 0; k < count; k += W) {
    // Copies: no store of a column can change them, so each is read once.
    std::int32_t i[W], j[W];
    for (int lane = 0; lane < W; ++lane) i[lane] = p.row_i[first + k + lane], j[lane] = p.row_j[first + k + lane];
    V d[4];
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
}

/// Branch, normal and the motion of the centres.
template <class T>
inline __attribute__((always_inline)) void disc_places(const StepConstants& c, const PairArrays& p, long first,
                                                       long count, DiscScratch& s) {
  using V = typename Lanes<T::W>::V;
  const double half_dt = 0.5 * c.dt;
  for (long k = 0; k < count; k += T::W) {
    const long at = first + k;
    const V image_x = load_as<V>(p.image[0] + at), image_y = load_as<V>(p.image[1] + at);
    const V bx = load_as<V>(s.dx.at + k) + (c.lattice.xx * image_x + c.lattice.xy * image_y);
    const V by = load_as<V>(s.dy.at + k) + c.lattice.yy * image_y;
    const V length = square_root(bx * bx + by * by);
    const V inverse = 1.0 / length;
    const V nx = bx * inverse, ny = by * inverse;
    store_as(s.nx.at + k, nx);
    store_as(s.ny.at + k, ny);
    store_as(s.length.at + k, length);
    if constexpr (T::Advance || T::Dashpot) {
      const V du = load_as<V>(s.du.at + k), dv = load_as<V>(s.dv.at + k);
      const V px = bx - half_dt * du, py = by - half_dt * dv;
      const V vx = du + (c.rate.xx * px + c.rate.xy * py), vy = dv + c.rate.yy * py;
      V along = nx * vy - ny * vx;
      if constexpr (T::slip == Slip::full_radius_ratcheting)
        along = along * ((load_as<V>(p.radius_i + at) + load_as<V>(p.radius_j + at)) * inverse);
      store_as(s.along.at + k, along);
      if constexpr (T::Dashpot) store_as(s.opening.at + k, nx * vx + ny * vy);
    }
  }
}

template <class Law, class T>
inline __attribute__((always_inline)) void disc_forces(const StepConstants& c, const PairArrays& p, long first,
                                                       long count, const DiscScratch& in, Dissipation* dissipation) {
  constexpr int W = T::W;
  using V = typename Lanes<W>::V;
  for (long k = 0; k < count; k += W) {
    const long at = first + k;
    const V nx = load_as<V>(in.nx.at + k), ny = load_as<V>(in.ny.at + k);
    const V radius_i = load_as<V>(p.radius_i + at), radius_j = load_as<V>(p.radius_j + at);
    const V radii = radius_i + radius_j;
    const V overlap = radii - load_as<V>(in.length.at + k);
    const auto touching = overlap > 0.0;
    const V zero = V{};
    V root = zero;
    if constexpr (Law::needs_root_overlap || T::Dashpot) root = square_root(touching ? overlap : zero);

    V normal = Law::normal_force(load_as<V>(p.kn + at), overlap, root);
    const V half_overlap = 0.5 * overlap;
    V slip_rate = zero, c_normal = zero, opening = zero;
    [[maybe_unused]] V spin_i = zero, spin_j = zero;
    if constexpr (T::Advance || T::Dashpot) {
      spin_i = load_as<V>(in.spin_i.at + k);
      spin_j = load_as<V>(in.spin_j.at + k);
      slip_rate = load_as<V>(in.along.at + k) - ((radius_j * spin_j + radius_i * spin_i) + c.spin[2] * radii);
      if constexpr (T::slip == Slip::consistent)
        slip_rate = slip_rate + half_overlap * ((spin_j + spin_i) + 2.0 * c.spin[2]);
    }
    if constexpr (T::Dashpot) {
      opening = load_as<V>(in.opening.at + k);
      c_normal = dashpot_coefficient(load_as<V>(p.cn + at), root, c.dashpot_quarters, SquareRoot{});
      normal = normal - c_normal * opening;
      if (c.no_tension) normal = (normal > 0.0) ? normal : zero;
    }
    V tangential = load_as<V>(p.tangential[0] + at);
    const V kt = Law::tangential_stiffness(load_as<V>(p.kt + at), root);
    V last_root = zero;
    if constexpr (Law::stores_root_overlap) last_root = load_as<V>(p.root_overlap + at);
    [[maybe_unused]] const V before = tangential;
    [[maybe_unused]] V trial = tangential;
    if constexpr (T::Advance) {
      const V limit = load_as<V>(p.friction + at) * magnitude_of(normal);
      if constexpr (Law::stores_root_overlap) tangential = tangential * Law::carried(root, last_root, c.unload_rescale);
      tangential = tangential - kt * (slip_rate * c.dt);
      trial = tangential;
      if constexpr (T::Dashpot) {
        const V viscous = (c.tangential_ratio * c_normal) * slip_rate;
        const V total = tangential - viscous;
        const V capped = clamped(total, limit);
        tangential = ((total > limit) | (total < -limit)) ? capped + viscous : tangential;
      } else {
        tangential = clamped(tangential, limit);
      }
      tangential = touching ? tangential : zero;
      store_as(p.tangential[0] + at, tangential);
      if constexpr (Law::stores_root_overlap) store_as(p.root_overlap + at, root);
    }
    V total = tangential;
    if constexpr (T::Dashpot) total = touching ? tangential - (c.tangential_ratio * c_normal) * slip_rate : zero;
    normal = touching ? normal : zero;

    V moment = zero;
    if constexpr (T::Rolling) moment = load_as<V>(p.moment[0] + at);
    if constexpr (T::Rolling && T::Advance) {
      const V spin_difference = spin_j - spin_i;
      [[maybe_unused]] const V moment_before = moment;
      const V kr = Law::tangential_stiffness(load_as<V>(p.kr + at), root);
      if constexpr (Law::stores_root_overlap) moment = moment * Law::carried(root, last_root, c.unload_rescale);
      [[maybe_unused]] const V moment_carried = moment;
      const V moment_trial = moment - kr * (spin_difference * c.dt);
      const V pushing = (normal > 0.0) ? normal : zero;
      moment = capped_moment(moment_trial, load_as<V>(p.moment_cap + at) * pushing);
      moment = touching ? moment : zero;
      store_as(p.moment[0] + at, moment);
      if constexpr (T::Ledger) {
        if (touching && kr > 0.0)
          dissipation->rolling +=
              0.5 * (moment_trial - moment) * (moment + moment_trial + kr * (spin_difference * c.dt)) / kr;
        if (!touching && moment_before != 0.0) {
          const double last_kr = Law::stores_root_overlap ? p.kr[at] * last_root : kr;
          if (last_kr > 0) dissipation->rolling += 0.5 * moment_before * moment_before / last_kr;
        }
        if (Law::stores_root_overlap && kr > 0.0 && touching)
          dissipation->law_loss += 0.5 *
                                   (moment_before * moment_before / (p.kr[at] * (last_root > 0 ? last_root : root)) -
                                    moment_carried * moment_carried / kr) *
                                   double(Law::stores_root_overlap && last_root > 0);
      }
    }
    if constexpr (T::Ledger && T::Advance && T::Dashpot) {
      if (touching)
        dissipation->dashpot +=
            c.dt * (c_normal * opening * opening + c.tangential_ratio * c_normal * slip_rate * slip_rate);
    }
    if constexpr (T::Ledger && T::Advance) {
      if (touching && kt > 0.0) {
        // Work of the mean of old and new force: with the new one alone, what a cap that falls takes out of a soft
        // spring is missing (kt/kn = 1e-3: 15 % of the energy).
        dissipation->friction += 0.5 * (trial - tangential) * (tangential + trial + kt * (slip_rate * c.dt)) / kt;
        if constexpr (Law::stores_root_overlap) {
          const double carried = before * Law::carried(root, last_root, c.unload_rescale);
          if (last_root > 0)
            dissipation->law_loss += 0.5 * (before * before / (p.kt[at] * last_root) - carried * carried / kt);
        }
      } else if (!touching && before != 0.0) {
        const double last_kt = Law::stores_root_overlap ? p.kt[at] * last_root : kt;
        if (last_kt > 0) dissipation->friction += 0.5 * before * before / last_kt;
      }
    }

    V torque_j = (half_overlap - radius_j) * total, torque_i = (half_overlap - radius_i) * total;
    if constexpr (T::Rolling) {
      torque_j = torque_j + moment;
      torque_i = torque_i - moment;
    }
    const V columns[4] = {nx * normal - ny * total, ny * normal + nx * total, torque_j, torque_i};
    rows_of<W>(columns, p.force + 4 * at, 4);
  }
}

/// Whether one of eight pairs touches.
template <int W>
inline __attribute__((always_inline)) bool discs_touch(const StepConstants& c, const PairArrays& p, const double* rows,
                                                       long first) {
  using V = typename Lanes<W>::V;
  auto touching = V{} > 0.0;
#pragma GCC unroll 8
  for (long at = first; at < first + 8; at += W) {
    V d[2];
    gather_place_differences<W>(rows, p.row_i + at, p.row_j + at, d);
    const V image_x = load_as<V>(p.image[0] + at), image_y = load_as<V>(p.image[1] + at);
    const V bx = d[0] + (c.lattice.xx * image_x + c.lattice.xy * image_y);
    const V by = d[1] + c.lattice.yy * image_y;
    const V radii = load_as<V>(p.radius_i + at) + load_as<V>(p.radius_j + at);
    touching = touching | (bx * bx + by * by < radii * radii);
  }
  return any_of(touching);
}

/// Discs in 2D.
template <class Law, class T>
void disc_pairs(const StepConstants& constants, const PairArrays& arrays, const double* rows, long begin, long end,
                Dissipation* dissipation) {
  // Copies that no store can change: else every store would make the compiler read all pointers again.
  const StepConstants c = constants;
  const PairArrays p = arrays;
  DiscScratch scratch;
  constexpr int narrow = T::W < 4 ? T::W : 4;
  for (PairRun run{begin, 0, begin}; run.next < end;) {
    run = next_run(p, run.next, end, [&](long at) { return discs_touch<narrow>(c, p, rows, at); });
    const long first = run.first, count = run.count;
    disc_rows<T>(p, rows, first, count, scratch);
    disc_places<T>(c, p, first, count, scratch);
    disc_forces<Law, T>(c, p, first, count, scratch, dissipation);
  }
}

}  // namespace
}  // namespace rvelab
