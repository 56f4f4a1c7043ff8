// The pair loops: W listed pairs at a time, from grain rows to force rows. The physics stands in rvelab/contact; here
// are geometry, slip and the order of things.
//
// n from i to j, overlap delta = ri + rj - |b|, forces are those on j. Velocities: the relative velocity of the
// centres over the step is dv' + D+ (b - dt/2 dv'), exactly (b_new - b_old)/dt. Slip (design 6):
//   consistent              s v_t - a_j w_j - a_i w_i,  a = r - delta/2, s = 1
//   full_radius             a = r, s = 1 (LAMMPS; twist of the history is left out as there)
//   full_radius_ratcheting  a = r, s = (ri + rj)/|b| (YADE)
// Torques act at r - delta/2 for all of them. In 2D the tangent is t = (-n_y, n_x) and all moments lie along z.
#pragma once

#include "rvelab/contact/damping.hpp"
#include "rvelab/contact/hertz.hpp"
#include "rvelab/contact/linear.hpp"
#include "rvelab/contact/rolling.hpp"
#include "rvelab/solver/lanes.hpp"
#include "rvelab/solver/scene.hpp"

namespace rvelab {
namespace {

/// What a pair loop is compiled for beside its law.
template <int W_, bool Rolling_, Slip slip_, bool Dashpot_, bool Advance_, bool Ledger_>
struct PairTraits {
  static constexpr int W = W_;
  static constexpr bool Rolling = Rolling_, Dashpot = Dashpot_, Advance = Advance_, Ledger = Ledger_;
  static constexpr Slip slip = slip_;
};

struct SquareRoot {
  template <class V>
  inline __attribute__((always_inline)) V operator()(V v) const {
    return square_root(v);
  }
};

/// Loads one Quad of each of W grain rows and turns them into columns; `sign` multiplies the first set before adding.
template <int W>
inline __attribute__((always_inline)) void gather_columns(const double* rows, const std::int32_t* first,
                                                          const std::int32_t* second, int offset,
                                                          typename Lanes<W>::Quad sign, typename Lanes<W>::V* columns) {
  using L = Lanes<W>;
  typename L::Quad quads[W];
  for (int k = 0; k < W; ++k) {
    const auto a = load_as<typename L::Quad>(rows + first[k] + offset);
    const auto b = load_as<typename L::Quad>(rows + second[k] + offset);
    quads[k] = L::add(b, L::mul(sign, a));
  }
  L::transpose(quads, columns);
}

template <int W>
inline __attribute__((always_inline)) typename Lanes<W>::Quad quad(double a, double b, double c, double d) {
  const double values[4] = {a, b, c, d};
  return load_as<typename Lanes<W>::Quad>(values);
}

template <class V>
inline __attribute__((always_inline)) double sum_of(V v) {
  double values[sizeof(V) / sizeof(double)];
  std::memcpy(values, &v, sizeof(V));
  double sum = 0;
  for (double value : values) sum += value;
  return sum;
}

template <int W>
inline __attribute__((always_inline)) typename Lanes<W>::Quad quad_at(const double* from) {
  return load_as<typename Lanes<W>::Quad>(from);
}

/// First Quad of row j minus that of row i, as columns.
template <int W>
inline __attribute__((always_inline)) void gather_differences(const double* rows, const std::int32_t* i,
                                                              const std::int32_t* j, typename Lanes<W>::V* columns) {
  using L = Lanes<W>;
  typename L::Quad quads[W];
  for (int k = 0; k < W; ++k) quads[k] = L::sub(quad_at<W>(rows + j[k]), quad_at<W>(rows + i[k]));
  L::transpose(quads, columns);
}

/// Sums of {w, r w} of discs i and j, as two columns.
template <int W>
inline __attribute__((always_inline)) void gather_spins(const double* rows, const std::int32_t* i,
                                                        const std::int32_t* j, typename Lanes<W>::V* columns) {
  V2 sums[W];
  for (int k = 0; k < W; ++k) sums[k] = load_as<V2>(rows + j[k] + 4) + load_as<V2>(rows + i[k] + 4);
  Lanes<W>::transpose_pairs(sums, columns);
}

template <int W>
inline __attribute__((always_inline)) typename Lanes<W>::V gather_spin_difference(const double* rows,
                                                                                  const std::int32_t* i,
                                                                                  const std::int32_t* j) {
  double differences[W];
  for (int k = 0; k < W; ++k) differences[k] = rows[j[k] + 4] - rows[i[k] + 4];
  return load_as<typename Lanes<W>::V>(differences);
}

/// Discs in 2D.
template <class Law, class T>
void disc_pairs(const StepConstants& c, const PairArrays& p, const double* rows, long begin, long end,
                Dissipation* dissipation) {
  constexpr int W = T::W;
  using L = Lanes<W>;
  using V = typename L::V;
  const double half_dt = 0.5 * c.dt;
  for (long at = begin; at < end; at += W) {
    const std::int32_t *i = p.row_i + at, *j = p.row_j + at;
    V d[4];
    gather_differences<W>(rows, i, j, d);
    const V radius_i = load_as<V>(p.radius_i + at), radius_j = load_as<V>(p.radius_j + at);
    const V radii = radius_i + radius_j;
    const V image_x = load_as<V>(p.image[0] + at), image_y = load_as<V>(p.image[1] + at);
    const V bx = d[0] + (c.lattice.xx * image_x + c.lattice.xy * image_y);
    const V by = d[1] + c.lattice.yy * image_y;
    const V length = square_root(bx * bx + by * by);
    const V inverse = 1.0 / length;
    const V nx = bx * inverse, ny = by * inverse;
    const V overlap = radii - length;
    const auto touching = overlap > 0.0;
    const V zero = V{};
    V root = zero;
    if constexpr (Law::needs_root_overlap || T::Dashpot) root = square_root(touching ? overlap : zero);

    V normal = Law::normal_force(load_as<V>(p.kn + at), overlap, root);
    const V half_overlap = 0.5 * overlap;
    V slip_rate = zero, c_normal = zero, opening = zero;
    if constexpr (T::Advance || T::Dashpot) {
      const V px = bx - half_dt * d[2], py = by - half_dt * d[3];
      const V vx = d[2] + (c.rate.xx * px + c.rate.xy * py), vy = d[3] + c.rate.yy * py;
      V along = nx * vy - ny * vx;
      if constexpr (T::slip == Slip::full_radius_ratcheting) along = along * (radii * inverse);
      V s[2];  // w_i + w_j and r_i w_i + r_j w_j
      gather_spins<W>(rows, i, j, s);
      slip_rate = along - (s[1] + c.spin[2] * radii);
      if constexpr (T::slip == Slip::consistent) slip_rate = slip_rate + half_overlap * (s[0] + 2.0 * c.spin[2]);
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
      const V spin_difference = gather_spin_difference<W>(rows, i, j);
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
    for (int k = 0; k < W; ++k) store_as(p.force + 4 * (at + k), out[k]);
  }
}

/// Three columns of a vector quantity.
template <class V>
struct Triple {
  V x, y, z;
};
template <class V>
inline __attribute__((always_inline)) V dot(const Triple<V>& a, const Triple<V>& b) {
  return a.x * b.x + (a.y * b.y + a.z * b.z);
}
template <class V>
inline __attribute__((always_inline)) Triple<V> cross(const Triple<V>& a, const Triple<V>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class V>
inline __attribute__((always_inline)) Triple<V> plus(const Triple<V>& a, V factor, const Triple<V>& b) {
  return {a.x + factor * b.x, a.y + factor * b.y, a.z + factor * b.z};
}
template <class V>
inline __attribute__((always_inline)) Triple<V> times(V factor, const Triple<V>& b) {
  return {factor * b.x, factor * b.y, factor * b.z};
}

/// History vector carried to the new normal: into the tangent plane at its old length, then turned about n by `angle`
/// (mean spin times dt; first order, restored to length).
template <class V>
inline __attribute__((always_inline)) Triple<V> carried_history(const Triple<V>& history, const Triple<V>& n, V angle,
                                                                bool twist) {
  const V one = V{} + 1.0;
  const V before = dot(history, history);
  Triple<V> h = plus(history, -dot(history, n), n);
  if (twist) h = plus(h, angle, cross(n, h));
  const V after = dot(h, h);
  const V factor = square_root(before / ((after > 0.0) ? after : one));
  return times((after > 0.0) ? factor : V{}, h);
}

/// Spheres in 3D.
template <class Law, class T>
void sphere_pairs(const StepConstants& c, const PairArrays& p, const double* rows, long begin, long end,
                  Dissipation* dissipation) {
  constexpr int W = T::W;
  using L = Lanes<W>;
  using V = typename L::V;
  const auto difference = L::broadcast(-1.0), sum = L::broadcast(1.0);
  const auto places = quad<W>(-1.0, -1.0, -1.0, 1.0);
  const double half_dt = 0.5 * c.dt;
  for (long at = begin; at < end; at += W) {
    const std::int32_t *i = p.row_i + at, *j = p.row_j + at;
    V d[4], v[4], ws[4], rw[4];
    gather_columns<W>(rows, i, j, 0, places, d);
    gather_columns<W>(rows, i, j, 4, difference, v);
    const V image_x = load_as<V>(p.image[0] + at), image_y = load_as<V>(p.image[1] + at);
    const V image_z = load_as<V>(p.image[2] + at);
    const Triple<V> b = {d[0] + (c.lattice.xx * image_x + (c.lattice.xy * image_y + c.lattice.xz * image_z)),
                         d[1] + (c.lattice.yy * image_y + c.lattice.yz * image_z), d[2] + c.lattice.zz * image_z};
    const V length = square_root(dot(b, b));
    const V inverse = 1.0 / length;
    const Triple<V> n = times(inverse, b);
    const V radii = d[3], overlap = radii - length;
    const auto touching = overlap > 0.0;
    const V zero = V{}, one = zero + 1.0;
    V root = zero;
    if constexpr (Law::needs_root_overlap || T::Dashpot) root = square_root(touching ? overlap : zero);

    V normal = Law::normal_force(load_as<V>(p.kn + at), overlap, root);
    const V half_overlap = 0.5 * overlap;
    Triple<V> slip_rate = {zero, zero, zero};
    V c_normal = zero, opening = zero, mean_twist = zero;
    if constexpr (T::Advance || T::Dashpot) {
      // Spins enter as w_i + w_j and r_i w_i + r_j w_j; the mean spin of the cell is added to both.
      gather_columns<W>(rows, i, j, 8, sum, ws);
      typename L::Quad quads[W];
      for (int k = 0; k < W; ++k) {
        const double *ri = rows + i[k], *rj = rows + j[k];
        quads[k] = L::add(L::mul(L::broadcast(rj[3]), load_as<typename L::Quad>(rj + 8)),
                          L::mul(L::broadcast(ri[3]), load_as<typename L::Quad>(ri + 8)));
      }
      L::transpose(quads, rw);
      const Triple<V> px = {b.x - half_dt * v[0], b.y - half_dt * v[1], b.z - half_dt * v[2]};
      const Triple<V> u = {v[0] + (c.rate.xx * px.x + (c.rate.xy * px.y + c.rate.xz * px.z)),
                           v[1] + (c.rate.yy * px.y + c.rate.yz * px.z), v[2] + c.rate.zz * px.z};
      opening = dot(n, u);
      Triple<V> along = plus(u, -opening, n);
      if constexpr (T::slip == Slip::full_radius_ratcheting) along = times(radii * inverse, along);
      const Triple<V> spins = {ws[0] + 2.0 * c.spin[0], ws[1] + 2.0 * c.spin[1], ws[2] + 2.0 * c.spin[2]};
      Triple<V> arms = {rw[0] + c.spin[0] * radii, rw[1] + c.spin[1] * radii, rw[2] + c.spin[2] * radii};
      if constexpr (T::slip == Slip::consistent) arms = plus(arms, -half_overlap, spins);
      slip_rate = plus(along, -one, cross(arms, n));
      mean_twist = 0.5 * dot(n, spins);
    }
    if constexpr (T::Dashpot) {
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
    constexpr bool twist = T::slip != Slip::full_radius;
    if constexpr (T::Advance) {
      const V magnitude = (normal < 0.0) ? -normal : normal;
      const V limit = load_as<V>(p.friction + at) * magnitude;
      tangential = carried_history(tangential, n, mean_twist * c.dt, twist);
      if constexpr (Law::stores_root_overlap)
        tangential = times(Law::carried(root, last_root, c.unload_rescale), tangential);
      tangential = plus(tangential, -(kt * c.dt), slip_rate);
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
      V wd[4];
      gather_columns<W>(rows, i, j, 8, difference, wd);
      Triple<V> moment = {load_as<V>(p.moment[0] + at), load_as<V>(p.moment[1] + at), load_as<V>(p.moment[2] + at)};
      [[maybe_unused]] const V moment_before = dot(moment, moment);
      const V kr = Law::tangential_stiffness(load_as<V>(p.kr + at), root);
      moment = carried_history(moment, n, mean_twist * c.dt, twist);
      if constexpr (Law::stores_root_overlap) moment = times(Law::carried(root, last_root, c.unload_rescale), moment);
      [[maybe_unused]] const V moment_carried = dot(moment, moment);
      const Triple<V> w = {wd[0], wd[1], wd[2]};
      const Triple<V> bending = plus(w, -dot(n, w), n);
      moment = plus(moment, -(kr * c.dt), bending);
      const V cap = load_as<V>(p.moment_cap + at) * ((normal > 0.0) ? normal : zero);
      const V squared = dot(moment, moment);
      const auto rolling_over = squared > cap * cap;
      const V shrink = cap / square_root(rolling_over ? squared : one);
      [[maybe_unused]] const Triple<V> moment_trial = moment;
      moment = times(rolling_over ? shrink : one, moment);
      moment = {touching ? moment.x : zero, touching ? moment.y : zero, touching ? moment.z : zero};
      for (int k = 0; k < 3; ++k) store_as(p.moment[k] + at, k == 0 ? moment.x : (k == 1 ? moment.y : moment.z));
      if constexpr (T::Ledger) {
        if (touching && kr > 0.0) {
          dissipation->rolling += dot(plus(moment_trial, -one, moment), moment) / kr;
          if (Law::stores_root_overlap && last_root > 0)
            dissipation->law_loss += 0.5 * (moment_before / (p.kr[at] * last_root) - moment_carried / kr);
        }
      }
    }
    if constexpr (T::Ledger && T::Advance && T::Dashpot) {
      if (touching) dissipation->dashpot += c.dt * (c_normal * opening * opening + viscous * dot(slip_rate, slip_rate));
    }
    if constexpr (T::Ledger && T::Advance) {
      if (touching && kt > 0.0) {
        dissipation->friction += dot(plus(trial, -one, tangential), tangential) / kt;
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
    typename L::Quad forces[W], torques[W];
    const V first[4] = {n.x * normal + total.x, n.y * normal + total.y, n.z * normal + total.z, half_overlap};
    const V second[4] = {torque.x, torque.y, torque.z, zero};
    L::untranspose(first, forces);
    L::untranspose(second, torques);
    for (int k = 0; k < W; ++k) {
      store_as(p.force + 8 * (at + k), forces[k]);
      store_as(p.force + 8 * (at + k) + 4, torques[k]);
    }
  }
}

}  // namespace
}  // namespace rvelab
