// The pair loop of discs (kernel_pairs.hpp). Moments lie along z; the tangent is t = (-n_y, n_x).
#pragma once

#include "rvelab/contact/damping.hpp"
#include "rvelab/contact/hertz.hpp"
#include "rvelab/contact/linear.hpp"
#include "rvelab/contact/rolling.hpp"
#include "rvelab/solver/kernel_pairs.hpp"

namespace rvelab {
namespace {

/// What the first pass leaves for the second.
struct DiscScratch {
  ScratchColumn nx, ny, length, inverse_length;
  ScratchColumn vx, vy;               ///< velocity of j's centre less that of i's image, over the step
  ScratchColumn spins, radius_spins;  ///< w_i + w_j and r_i w_i + r_j w_j
};

template <class T>
inline __attribute__((always_inline)) void disc_places(const StepConstants& c, const PairArrays& p, const double* rows,
                                                       long first, long count, DiscScratch& out) {
  constexpr int W = T::W;
  using V = typename Lanes<W>::V;
  const double half_dt = 0.5 * c.dt;
  for (long k = 0; k < count; k += W) {
    const long at = first + k;
    const std::int32_t *i = p.row_i + at, *j = p.row_j + at;
    V d[4];
    gather_differences<W>(rows, i, j, d);
    const V image_x = load_as<V>(p.image[0] + at), image_y = load_as<V>(p.image[1] + at);
    const V bx = d[0] + (c.lattice.xx * image_x + c.lattice.xy * image_y);
    const V by = d[1] + c.lattice.yy * image_y;
    const V length = square_root(bx * bx + by * by);
    const V inverse = 1.0 / length;
    store_as(out.nx.at + k, bx * inverse);
    store_as(out.ny.at + k, by * inverse);
    store_as(out.length.at + k, length);
    if constexpr (T::slip == Slip::full_radius_ratcheting) store_as(out.inverse_length.at + k, inverse);
    if constexpr (T::Advance || T::Dashpot) {
      const V px = bx - half_dt * d[2], py = by - half_dt * d[3];
      store_as(out.vx.at + k, d[2] + (c.rate.xx * px + c.rate.xy * py));
      store_as(out.vy.at + k, d[3] + c.rate.yy * py);
      V s[2];
      gather_spins<W>(rows, i, j, s);
      store_as(out.spins.at + k, s[0]);
      store_as(out.radius_spins.at + k, s[1]);
    }
  }
}

template <class Law, class T>
inline __attribute__((always_inline)) void disc_forces(const StepConstants& c, const PairArrays& p, const double* rows,
                                                       long first, long count, const DiscScratch& in,
                                                       Dissipation* dissipation) {
  constexpr int W = T::W;
  using L = Lanes<W>;
  using V = typename L::V;
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
    if constexpr (T::Advance || T::Dashpot) {
      const V vx = load_as<V>(in.vx.at + k), vy = load_as<V>(in.vy.at + k);
      V along = nx * vy - ny * vx;
      if constexpr (T::slip == Slip::full_radius_ratcheting)
        along = along * (radii * load_as<V>(in.inverse_length.at + k));
      slip_rate = along - (load_as<V>(in.radius_spins.at + k) + c.spin[2] * radii);
      if constexpr (T::slip == Slip::consistent)
        slip_rate = slip_rate + half_overlap * (load_as<V>(in.spins.at + k) + 2.0 * c.spin[2]);
      opening = nx * vx + ny * vy;
    }
    if constexpr (T::Dashpot) {
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
      const V magnitude = (normal < 0.0) ? -normal : normal;
      const V limit = load_as<V>(p.friction + at) * magnitude;
      if constexpr (Law::stores_root_overlap) tangential = tangential * Law::carried(root, last_root, c.unload_rescale);
      tangential = tangential - kt * (slip_rate * c.dt);
      trial = tangential;
      if constexpr (T::Dashpot) {
        const V viscous = (c.tangential_ratio * c_normal) * slip_rate;
        const V total = tangential - viscous;
        const V capped = (total > limit) ? limit : ((total < -limit) ? -limit : total);
        tangential = ((total > limit) | (total < -limit)) ? capped + viscous : tangential;
      } else {
        tangential = (tangential > limit) ? limit : ((tangential < -limit) ? -limit : tangential);
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
      const V spin_difference = gather_spin_difference<W>(rows, p.row_i + at, p.row_j + at);
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
        if (kr > 0.0) dissipation->rolling += sum_of((moment_trial - moment) * (moment / kr));
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
        dissipation->friction += (trial - tangential) * tangential / kt;
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

    typename L::Quad out[W];
    const V columns[4] = {nx * normal - ny * total, ny * normal + nx * total,
                          moment - (radius_j - half_overlap) * total, -moment - (radius_i - half_overlap) * total};
    L::untranspose(columns, out);
    for (int lane = 0; lane < W; ++lane) store_as(p.force + 4 * (at + lane), out[lane]);
  }
}

/// Discs in 2D.
template <class Law, class T>
void disc_pairs(const StepConstants& constants, const PairArrays& arrays, const double* rows, long begin, long end,
                Dissipation* dissipation) {
  // Copies that no store can change: else every store would make the compiler read all pointers again.
  const StepConstants c = constants;
  const PairArrays p = arrays;
  DiscScratch scratch;
  for (long first = begin; first < end; first += chunk_pairs) {
    const long count = end - first < chunk_pairs ? end - first : chunk_pairs;
    disc_places<T>(c, p, rows, first, count, scratch);
    disc_forces<Law, T>(c, p, rows, first, count, scratch, dissipation);
  }
}

}  // namespace
}  // namespace rvelab
