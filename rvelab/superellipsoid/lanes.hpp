// Contacts of W pairs of superellipsoids at a time. Each pair goes its own way: what is done for one lane depends on it
// alone, so that all widths give the same bits.
#pragma once

#include "rvelab/superellipsoid/search.hpp"

namespace rvelab {
namespace {

/// Overlaps, m, below 0 beyond rounding for pairs that are apart (then no more than a direction that shows it); n from
/// i to j; the middle of the points of both, from the centres of i; radii of curvature there.
template <class V>
struct ContactsOf {
  V overlap;
  Triple<V> n, point;
  RadiiOfCurvature<V> radii_i, radii_j;
};

/// Which lanes a search has to be asked for; the search itself, `found` for one lane.
template <class Mask, class V, class Found>
__attribute__((noinline)) void ask_search(Mask left, ContactsOf<V>& c, const Found& found) {
  constexpr int lanes = sizeof(V) / sizeof(double);
  V* columns[11] = {&c.overlap,
                    &c.n.x,
                    &c.n.y,
                    &c.n.z,
                    &c.point.x,
                    &c.point.y,
                    &c.point.z,
                    &c.radii_i.sum,
                    &c.radii_i.product,
                    &c.radii_j.sum,
                    &c.radii_j.product};
  double values[11][lanes];
  std::int64_t held[lanes];
  if constexpr (lanes == 1) {
    held[0] = left;
  } else {
    std::memcpy(held, &left, sizeof(left));
  }
  for (int k = 0; k < 11; ++k) std::memcpy(values[k], columns[k], sizeof(V));
  for (int lane = 0; lane < lanes; ++lane) {
    if (held[lane] == 0) continue;
    const ContactsOf<double> one = found(lane);
    const double all[11] = {one.overlap,
                            one.n.x,
                            one.n.y,
                            one.n.z,
                            one.point.x,
                            one.point.y,
                            one.point.z,
                            one.radii_i.sum,
                            one.radii_i.product,
                            one.radii_j.sum,
                            one.radii_j.product};
    for (int k = 0; k < 11; ++k) values[k][lane] = all[k];
  }
  for (int k = 0; k < 11; ++k) std::memcpy(columns[k], values[k], sizeof(V));
}

template <class V>
inline double in_lane(const V& v, int lane) {
  double values[sizeof(V) / sizeof(double)];
  std::memcpy(values, &v, sizeof(V));
  return values[lane];
}
template <class V>
inline Triple<double> in_lane(const Triple<V>& v, int lane) {
  return {in_lane(v.x, lane), in_lane(v.y, lane), in_lane(v.z, lane)};
}
template <class V>
inline SuperellipsoidForm<double> in_lane(const SuperellipsoidForm<V>& f, int lane) {
  return {in_lane(f.half, lane),    in_lane(f.share_xy, lane), in_lane(f.share_z, lane),
          in_lane(f.root_xy, lane), in_lane(f.root_z, lane),   in_lane(f.rolling, lane)};
}
template <class V>
inline SuperellipsoidAxes<double> in_lane(const SuperellipsoidAxes<V>& a, int lane) {
  return {in_lane(a.x, lane), in_lane(a.y, lane), in_lane(a.z, lane)};
}

/// What a contact is from where Newton's step leads to it.
template <class V>
inline __attribute__((always_inline)) ContactsOf<V> contacts_by(const SuperellipsoidPair<V>& pair,
                                                                const OverlapAt<V>& at, const PlainStep<V>& step) {
  ContactsOf<V> contacts;
  contacts.overlap = at.overlap - 0.5 * step.gain;
  contacts.n = turned_by(at.n, step.plain);
  Triple<V> both = plus(plus(at.i.point, V{} + 1.0, at.j.point), V{} + 1.0, pair.branch);
  const SupportMode<V>* modes[4] = {&at.i.xy, &at.i.z, &at.j.xy, &at.j.z};
  for (int m = 0; m < 4; ++m) {
    const V moves = modes[m]->stiffness * step.s[m];
    both = plus(both, m < 2 ? moves : -moves, modes[m]->along);
  }
  contacts.point = times(V{} + 0.5, both);
  contacts.radii_i = radii_of_curvature(at.i);
  contacts.radii_j = radii_of_curvature(at.j);
  return contacts;
}

/// The last step is taken from a direction on a grid, so that it has the same bits wherever the steps before came from:
/// they lead to the least within 1e-12, and a direction that near the border of two places of the grid is left to the
/// search, which starts from the bodies alone.
constexpr double grid_places = 67108864, near_border = 1e-3, last_turn = 1e-4, turn_before = 1e-6;

template <class V>
struct OnGrid {
  Triple<V> n;
  V farthest;  ///< from the middle of its place, parts of it: 1/2 is the border
};
template <class V>
inline __attribute__((always_inline)) OnGrid<V> on_grid(const Triple<V>& n) {
  constexpr double magic = 6755399441055744.0;
  const auto nearest = [&](V v) { return (v * grid_places + magic) - magic; };
  const Triple<V> place = {nearest(n.x), nearest(n.y), nearest(n.z)};
  const auto off = [&](V v, V at) { return magnitude_of(v * grid_places - at); };
  return {of_length_1(place), larger_of(off(n.x, place.x), larger_of(off(n.y, place.y), off(n.z, place.z)))};
}

/// Steps from a direction on: where they lead, whether they are done, by nothing but rounding too, and whether the pair
/// was seen to be apart.
template <class V, class Mask>
struct Led {
  Triple<V> n;
  Mask done, settled, apart;
};
template <class V>
inline __attribute__((always_inline)) auto led_from(const SuperellipsoidPair<V>& pair, const Triple<V>& start) {
  const V rolling = pair.form_i.rolling + pair.form_j.rolling;
  const V size = size_of(pair);
  auto apart = rolling < 0.0;
  Led<V, decltype(apart)> led = {start, apart, apart, apart};
  for (int k = 0; k < superellipsoid_steps && any_of(!led.done); ++k) {
    const OverlapAt<V> at = overlap_at(pair, led.n);
    const OverlapStep<V> step = next_step(at, rolling);
    const auto open = !led.done;
    led.apart = led.apart | (open & (at.overlap < -1e-12 * (at.i.height + at.j.height)));
    led.settled = led.settled | (open & (step.gain <= 1e-15 * size) & (dot(step.turn, step.turn) <= 1e-30));
    led.n = chosen(led.done | led.settled, led.n, turned_by(led.n, step.turn));
    led.done = led.done | led.apart | led.settled | is_near_least(step, turn_before);
  }
  return led;
}

/// Contacts by the grid, and where they are final.
template <class V, class Mask>
struct ByGrid {
  ContactsOf<V> contacts;
  Mask final;
  V farthest;
};
template <class V>
inline __attribute__((always_inline)) auto by_grid(const SuperellipsoidPair<V>& pair, const Triple<V>& n) {
  const V rolling = pair.form_i.rolling + pair.form_j.rolling;
  const OnGrid<V> grid = on_grid(n);
  const OverlapAt<V> at = overlap_at(pair, grid.n);
  const PlainStep<V> step = plain_step(at, modes_of(at), rolling);
  ByGrid<V, decltype(at.overlap <= rolling)> result;
  result.contacts = contacts_by(pair, at, step);
  result.final = is_near_least(step, last_turn) & (at.overlap <= rolling);
  result.farthest = grid.farthest;
  return result;
}

template <class Mask, class V>
inline __attribute__((always_inline)) ContactsOf<V> chosen(Mask held, const ContactsOf<V>& a, const ContactsOf<V>& b) {
  return {held ? a.overlap : b.overlap,
          chosen(held, a.n, b.n),
          chosen(held, a.point, b.point),
          {held ? a.radii_i.sum : b.radii_i.sum, held ? a.radii_i.product : b.radii_i.product},
          {held ? a.radii_j.sum : b.radii_j.sum, held ? a.radii_j.product : b.radii_j.product}};
}

/// From the bodies alone: by the grid where that serves, else by the direction to which the steps lead, or by the
/// search.
template <class V>
__attribute__((noinline)) void from_bodies(const SuperellipsoidPair<V>& pair, ContactsOf<V>& contacts) {
  const V rolling = pair.form_i.rolling + pair.form_j.rolling;
  const auto led = led_from(pair, first_direction(pair));
  const auto grid = by_grid(pair, led.n);
  const OverlapAt<V> at = overlap_at(pair, led.n);
  const PlainStep<V> step = plain_step(at, modes_of(at), rolling);
  const auto least = (led.settled | (led.done & is_near_least(step, last_turn))) & (at.overlap <= rolling);
  contacts = chosen(led.done & grid.final, grid.contacts, contacts_by(pair, at, step));
  contacts.overlap = led.apart ? V{} - rolling : contacts.overlap;
  const auto left = !(led.apart | least | (led.done & grid.final));
  if (!any_of(left)) return;
  ask_search(left, contacts, [&](int lane) {
    const OverlapPair one = {in_lane(pair.form_i, lane), in_lane(pair.form_j, lane), in_lane(pair.axes_i, lane),
                             in_lane(pair.axes_j, lane), in_lane(pair.branch, lane)};
    const SuperellipsoidContact found = contact_of(one);
    const auto last = by_grid(one, found.n);
    if (last.final) return last.contacts;
    return ContactsOf<double>{found.overlap, found.n, found.point, radii_of_curvature(found.at.i),
                              radii_of_curvature(found.at.j)};
  });
}

/// `guess`: a direction to begin with, of length 1, or shorter than 1/2 where there is none; afterwards the next one.
/// The contacts do not depend on it.
template <class V>
inline __attribute__((always_inline)) ContactsOf<V> contacts_of(const SuperellipsoidPair<V>& pair, Triple<V>& guess) {
  const auto guessed = dot(guess, guess) >= 0.25;
  const V zero = V{}, one = zero + 1.0;
  if (!any_of(guessed)) {
    ContactsOf<V> contacts;
    from_bodies(pair, contacts);
    guess = contacts.n;
    return contacts;
  }
  const auto led = led_from(pair, chosen(guessed, guess, Triple<V>{one, zero, zero}));
  const auto grid = by_grid(pair, led.n);
  ContactsOf<V> contacts = grid.contacts;
  contacts.overlap = led.apart ? zero - one : contacts.overlap;
  const auto left = !(led.apart | (guessed & led.done & (grid.farthest < 0.5 - near_border) & grid.final));
  if (any_of(left)) {
    ContactsOf<V> others;
    from_bodies(pair, others);
    contacts = chosen(left, others, contacts);
  }
  guess = chosen(led.apart, led.n, contacts.n);
  return contacts;
}

}  // namespace
}  // namespace rvelab
