// Overlap of two superellipsoids: the least f(n) = h_i(n) + h_j(-n) - n.d over all directions n, d the branch from i to
// j. f(n) is how far the two have to move apart along n to touch no more; f < 0 for any n shows that they are apart. A
// force along n of a size that f gives has an energy: f changes with d by -n alone, wherever the least lies.
//
// On the sphere of directions f has the slope F = x_i - x_j - d + ..., across n, of the support points, and the second
// derivative C - f, C the radii of curvature of both: four modes k U U (support.hpp). Newton's step fails where a
// surface is flat: the height goes with a power q of the direction, 1 < q < 2, its point with the power q - 1 of it. So
// each mode is taken by its own law: Newton's step says how its point moves, the power how its direction follows, r' =
// r |1 + z|^(1/(q - 1)), and the modes are joined again, weighed by their k there. Where one mode alone bends this is
// exact.
//
// Where f is stationary and not above the radii of two balls that roll inside both it is the least of all (Blaschke).
// What is deeper, and what does not converge, is left to search.hpp.
#pragma once

#include "rvelab/superellipsoid/support.hpp"

namespace rvelab {
namespace {

/// Two superellipsoids and the branch from i to j, m.
template <class V>
struct SuperellipsoidPair {
  SuperellipsoidForm<V> form_i, form_j;
  SuperellipsoidAxes<V> axes_i, axes_j;
  Triple<V> branch;
};

/// f and what the next step takes at a direction n of length 1.
template <class V>
struct OverlapAt {
  Triple<V> n;
  SupportAt<V> i, j;   ///< of i along n, of j along -n
  V overlap;           ///< f
  Triple<V> downhill;  ///< -F, m
};

template <class V>
inline __attribute__((always_inline)) void overlap_at(const SuperellipsoidPair<V>& pair, const Triple<V>& n,
                                                      OverlapAt<V>& at) {
  at.n = n;
  support_at(pair.form_i, pair.axes_i, n, at.i);
  support_at(pair.form_j, pair.axes_j, Triple<V>{-n.x, -n.y, -n.z}, at.j);
  const V minus = V{} - 1.0;
  const Triple<V> apart = plus(plus(pair.branch, V{} + 1.0, at.j.point), minus, at.i.point);
  at.overlap = (at.i.height + at.j.height) - dot(n, pair.branch);
  at.downhill = plus(apart, at.overlap, n);
  at.downhill = plus(at.downhill, -dot(at.downhill, n), n);
}
template <class V>
inline __attribute__((always_inline)) OverlapAt<V> overlap_at(const SuperellipsoidPair<V>& pair, const Triple<V>& n) {
  OverlapAt<V> at;
  overlap_at(pair, n, at);
  return at;
}

/// Two vectors of length 1 across n.
template <class V>
inline __attribute__((always_inline)) void across(const Triple<V>& n, Triple<V>& first, Triple<V>& second) {
  const V one = V{} + 1.0, sign = (n.z < 0.0) ? -one : one, a = -1.0 / (sign + n.z), b = n.x * n.y * a;
  first = {1.0 + sign * (n.x * n.x * a), sign * b, -(sign * n.x)};
  second = {b, sign + n.y * n.y * a, -n.y};
}

/// Four modes, U seen as two components in a frame across n whose first axis is the U of the stiffest.
template <class V>
struct Modes {
  V k[4];
  Triple<V> along[4];
  V growth[4], share[4];
};
template <class V>
inline __attribute__((always_inline)) Modes<V> modes_of(const OverlapAt<V>& at) {
  const SupportMode<V>* all[4] = {&at.i.xy, &at.i.z, &at.j.xy, &at.j.z};
  Modes<V> modes;
  for (int m = 0; m < 4; ++m) {
    modes.k[m] = all[m]->stiffness;
    modes.along[m] = all[m]->along;
    modes.growth[m] = m < 2 ? all[m]->growth : -all[m]->growth;  // j is seen along -n
    modes.share[m] = all[m]->share;
  }
  return modes;
}

/// A frame across n along the U of the stiffest mode, which so stands in one component alone: the others are not lost
/// beside it (near flat sides k is beyond 1e100).
template <class V>
struct ModeFrame {
  Triple<V> first, second;
  V u1[4], u2[4];   ///< components of each U
  V c11, c12, c22;  ///< of sum k U U - shift
};
template <class V>
inline __attribute__((always_inline)) ModeFrame<V> frame_of(const V* k, const Triple<V>* along, const Triple<V>& n,
                                                            V shift) {
  const V one = V{} + 1.0, zero = V{};
  V size[4], most = zero;
  for (int m = 0; m < 4; ++m) {
    size[m] = k[m] * dot(along[m], along[m]);
    most = larger_of(most, size[m]);
  }
  Triple<V> first = along[3];
  for (int m = 2; m >= 0; --m) first = chosen(size[m] >= most, along[m], first);
  const V squared = dot(first, first);
  ModeFrame<V> frame;
  frame.first = times(one / square_root((squared > 0.0) ? squared : one), first);
  frame.second = cross(n, frame.first);
  frame.c11 = frame.c22 = -shift;
  frame.c12 = zero;
  auto taken = most < zero;  // none yet
  for (int m = 0; m < 4; ++m) {
    const auto stiffest = (size[m] >= most) & !taken;
    taken = taken | stiffest;
    frame.u1[m] = dot(along[m], frame.first);
    frame.u2[m] = stiffest ? zero : dot(along[m], frame.second);
    frame.c11 = frame.c11 + k[m] * (frame.u1[m] * frame.u1[m]);
    frame.c12 = frame.c12 + k[m] * frame.u2[m] * frame.u1[m];
    frame.c22 = frame.c22 + k[m] * frame.u2[m] * frame.u2[m];
  }
  return frame;
}
/// Components of a vector across n.
template <class V>
struct Across {
  V first, second;
};
template <class V>
inline __attribute__((always_inline)) Across<V> solved(const ModeFrame<V>& f, V F1, V F2) {
  const V lever = f.c12 / f.c11, rest = f.c22 - f.c12 * lever;
  const V y2 = (F2 - lever * F1) / ((rest > 0.0) ? rest : V{} + 1.0);
  return {(F1 - f.c12 * y2) / f.c11, y2};
}

/// Newton's step from a direction; what f falls by it, twice over, if f is a parabola; the farthest that a mode goes,
/// as a part of where it is, and its direction.
template <class V>
struct PlainStep {
  Triple<V> plain;  ///< the turn, across n
  V s[4];           ///< U.plain
  V gain, farthest, reach, shift;
};
/// y of (sum k U U - s) y = F in two components across n: y det = sum k (V.F) V - s F, V the U a right angle further,
/// det = sum k_m k_l A_ml^2 - s (sum k U.U - s), A_ml = U_m.V_l. So a mode without bound beside others loses none of
/// them, nor its own s_m = U_m.y = (sum k_l A_ml (V_l.F) - s U_m.F)/det.
template <class V>
inline __attribute__((always_inline)) void plain_step(const OverlapAt<V>& at, const Modes<V>& modes, V rolling,
                                                      PlainStep<V>& step) {
  const V most = 0.9 * rolling;  // C is not below the rolling radii
  step.shift = (at.overlap < most) ? at.overlap : most;
  Triple<V> first, second;
  across(at.n, first, second);
  const V F1 = dot(at.downhill, first), F2 = dot(at.downhill, second), sF1 = step.shift * F1, sF2 = step.shift * F2;
  V u1[4], u2[4], force[4], trace = -step.shift, det = V{}, y1 = -sF1, y2 = -sF2;
  for (int m = 0; m < 4; ++m) {
    u1[m] = dot(modes.along[m], first);
    u2[m] = dot(modes.along[m], second);
    force[m] = modes.k[m] * (u1[m] * F2 - u2[m] * F1);
    trace = trace + modes.k[m] * (u1[m] * u1[m] + u2[m] * u2[m]);
    y1 = y1 - force[m] * u2[m];
    y2 = y2 + force[m] * u1[m];
    step.s[m] = -(sF1 * u1[m] + sF2 * u2[m]);
  }
  for (int m = 0; m < 4; ++m) {
    for (int l = m + 1; l < 4; ++l) {
      const V area = u2[m] * u1[l] - u1[m] * u2[l];
      det = det + (modes.k[m] * area) * (modes.k[l] * area);
      step.s[m] = step.s[m] + area * force[l];
      step.s[l] = step.s[l] - area * force[m];
    }
  }
  det = det - step.shift * trace;
  const V inverse = 1.0 / ((det > 0.0) ? det : V{} + 1.0);
  step.plain = plus(times(inverse * y1, first), inverse * y2, second);
  step.gain = inverse * (y1 * F1 + y2 * F2);
  step.farthest = step.reach = V{};
  for (int m = 0; m < 4; ++m) {
    step.s[m] = inverse * step.s[m];
    const V reach = magnitude_of(modes.growth[m] * step.s[m]);
    step.reach = larger_of(step.reach, reach);
    step.farthest = larger_of(step.farthest, modes.share[m] * reach);
  }
}

/// The same in the frame of the stiffest mode, slower: beside flat sides it loses none of n to rounding (a pair of
/// exponents up to 50 that turns as a whole keeps n to 1e-13, by the sums above to 4e-12).
template <class V>
inline __attribute__((always_inline)) PlainStep<V> plain_step_in_frame(const OverlapAt<V>& at, const Modes<V>& modes,
                                                                       V rolling) {
  PlainStep<V> step;
  const V most = 0.9 * rolling;
  step.shift = (at.overlap < most) ? at.overlap : most;
  const ModeFrame<V> frame = frame_of(modes.k, modes.along, at.n, step.shift);
  const Across<V> y = solved(frame, dot(at.downhill, frame.first), dot(at.downhill, frame.second));
  step.plain = plus(times(y.first, frame.first), y.second, frame.second);
  step.gain = dot(step.plain, at.downhill);
  step.farthest = step.reach = V{};
  for (int m = 0; m < 4; ++m) {
    step.s[m] = frame.u1[m] * y.first + frame.u2[m] * y.second;
    const V reach = magnitude_of(modes.growth[m] * step.s[m]);
    step.reach = larger_of(step.reach, reach);
    step.farthest = larger_of(step.farthest, modes.share[m] * reach);
  }
  return step;
}

/// The same with the turn by the laws of the modes.
template <class V>
struct OverlapStep : PlainStep<V> {
  Triple<V> turn;
};
/// `InFrame`: by the slower of the two.
template <bool InFrame = false, class V>
inline __attribute__((always_inline)) OverlapStep<V> next_step(const OverlapAt<V>& at, V rolling) {
  const V one = V{} + 1.0;
  Modes<V> modes = modes_of(at);
  OverlapStep<V> step;
  if constexpr (InFrame)
    static_cast<PlainStep<V>&>(step) = plain_step_in_frame(at, modes, rolling);
  else
    plain_step(at, modes, rolling, step);
  V followed[4];
  for (int m = 0; m < 4; ++m) {
    const V relative = (modes.growth[m] * modes.share[m]) * step.s[m];
    const V z = clamped(one + relative, V{} + 1e100), size = larger_of(magnitude_of(z), V{} + 1e-6);
    const V P = exp2_of(clamped((one / modes.share[m] - 1.0) * log2_of(size), V{} + 600.0));
    modes.k[m] = modes.k[m] / P;
    followed[m] = (z * P - 1.0) / modes.growth[m];
  }
  const ModeFrame<V> next = frame_of(modes.k, modes.along, at.n, step.shift);
  V F1 = -(step.shift * dot(step.plain, next.first)), F2 = -(step.shift * dot(step.plain, next.second));
  for (int m = 0; m < 4; ++m) {
    const V force = modes.k[m] * followed[m];
    F1 = F1 + force * next.u1[m];
    F2 = F2 + force * next.u2[m];
  }
  const Across<V> t = solved(next, F1, F2);
  step.turn = plus(times(t.first, next.first), t.second, next.second);
  return step;
}

/// n turned: of length 1.
template <class V>
inline __attribute__((always_inline)) Triple<V> turned_by(const Triple<V>& n, const Triple<V>& turn) {
  const V squared = dot(turn, turn), one = V{} + 1.0;
  return of_length_1(plus(n, (squared > 1.0) ? one / square_root(squared) : one, turn));
}

/// The direction that two bodies make of their own normals n_i and -n_j, each weighed by its radii of curvature there:
/// a flat side knows it best. n is near both; turn: what n turns by otherwise (-shift turn stands on the right).
template <class V>
inline __attribute__((always_inline)) Triple<V> joined_turn(const Triple<V>& n, const SupportAt<V>& i,
                                                            const Triple<V>& n_i, const SupportAt<V>& j,
                                                            const Triple<V>& n_j, V shift, const Triple<V>& turn) {
  const SupportMode<V>* modes[4] = {&i.xy, &i.z, &j.xy, &j.z};
  V k[4];
  Triple<V> along[4];
  for (int m = 0; m < 4; ++m) {
    k[m] = modes[m]->stiffness;
    along[m] = plus(modes[m]->along, -dot(modes[m]->along, n), n);
  }
  const ModeFrame<V> frame = frame_of(k, along, n, shift);
  V F1 = -(shift * dot(turn, frame.first)), F2 = -(shift * dot(turn, frame.second));
  for (int m = 0; m < 4; ++m) {
    const Triple<V> to = m < 2 ? plus(n_i, V{} - 1.0, n) : times(V{} - 1.0, plus(n_j, V{} + 1.0, n));
    const V force = k[m] * (frame.u1[m] * dot(to, frame.first) + frame.u2[m] * dot(to, frame.second));
    F1 = F1 + force * frame.u1[m];
    F2 = F2 + force * frame.u2[m];
  }
  const Across<V> y = solved(frame, F1, F2);
  return plus(times(y.first, frame.first), y.second, frame.second);
}

/// Where to begin: the normals where the line between the centres leaves both, joined. d of any length but 0.
template <class V>
inline __attribute__((always_inline)) Triple<V> first_direction(const SuperellipsoidPair<V>& pair) {
  const V one = V{} + 1.0, zero = V{};
  const Triple<V> back = times(-one, pair.branch);
  const Triple<V> n_i = normal_at(pair.form_i, pair.axes_i, pair.branch),
                  n_j = normal_at(pair.form_j, pair.axes_j, back);
  const SupportAt<V> i = support_at(pair.form_i, pair.axes_i, n_i), j = support_at(pair.form_j, pair.axes_j, n_j);
  const Triple<V> middle = of_length_1(plus(n_i, -one, n_j));
  return turned_by(middle, joined_turn(middle, i, n_i, j, n_j, zero, Triple<V>{zero, zero, zero}));
}

}  // namespace
}  // namespace rvelab
