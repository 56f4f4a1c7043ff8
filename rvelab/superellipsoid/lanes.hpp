// Contacts of W pairs of superellipsoids at a time. Each pair goes its own way: what is done for one lane depends on it
// alone, so that all widths give the same bits.
#pragma once

#include "rvelab/superellipsoid/search.hpp"

namespace rvelab {
namespace {

/// Overlaps, m, below 0 beyond rounding for pairs that are apart (then no more than a direction that shows it); n from
/// i to j; the middle of the points of both, from the centres of i.
template <class V>
struct ContactsOf {
  V overlap;
  Triple<V> n, point;
};

/// Which lanes a search has to be asked for; the search itself, `found` for one lane.
template <class Mask, class V, class Found>
__attribute__((noinline)) void ask_search(Mask left, ContactsOf<V>& c, const Found& found) {
  constexpr int lanes = sizeof(V) / sizeof(double);
  V* columns[7] = {&c.overlap, &c.n.x, &c.n.y, &c.n.z, &c.point.x, &c.point.y, &c.point.z};
  double values[7][lanes];
  std::int64_t held[lanes];
  if constexpr (lanes == 1) {
    held[0] = left;
  } else {
    std::memcpy(held, &left, sizeof(left));
  }
  for (int k = 0; k < 7; ++k) std::memcpy(values[k], columns[k], sizeof(V));
  for (int lane = 0; lane < lanes; ++lane) {
    if (held[lane] == 0) continue;
    const ContactsOf<double> one = found(lane);
    const double all[7] = {one.overlap, one.n.x, one.n.y, one.n.z, one.point.x, one.point.y, one.point.z};
    for (int k = 0; k < 7; ++k) values[k][lane] = all[k];
  }
  for (int k = 0; k < 7; ++k) std::memcpy(columns[k], values[k], sizeof(V));
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

/// f of a pair along a direction and Newton's step from there.
template <class V>
struct OverlapAndStep {
  OverlapAt<V> at;
  PlainStep<V> step;

  V overlap() const { return at.overlap; }
  V heights() const { return at.i.height + at.j.height; }
  const Triple<V>& n() const { return at.n; }
  const Triple<V>& turn() const { return step.plain; }
  V reach() const { return step.reach; }
  Triple<V> next() const { return turned_by(at.n, step.plain); }
};
/// What is seen of a pair along a direction.
template <class Pair>
struct SeenOfPair;
template <class V>
struct SeenOfPair<SuperellipsoidPair<V>> {
  using Type = OverlapAndStep<V>;
};
template <class Pair>
using SeenOf = typename SeenOfPair<Pair>::Type;
template <class V>
inline __attribute__((always_inline)) V rolling_of(const SuperellipsoidPair<V>& pair) {
  return pair.form_i.rolling + pair.form_j.rolling;
}
/// Of a direction, by rounding.
template <class V>
inline __attribute__((always_inline)) V noise_of(const SuperellipsoidPair<V>& pair) {
  return 8e-15 + 2e-15 * (size_of(pair) / rolling_of(pair));
}
template <class V>
inline __attribute__((always_inline)) void evaluate(const SuperellipsoidPair<V>& pair, const Triple<V>& n,
                                                    OverlapAndStep<V>& there) {
  overlap_at(pair, n, there.at);
  plain_step(there.at, modes_of(there.at), rolling_of(pair), there.step);
}
/// The direction after n where Newton's step would lead astray. Seldom, and so not inlined.
template <class V>
__attribute__((noinline)) Triple<V> far_direction(const SuperellipsoidPair<V>& pair, const Triple<V>& n) {
  return turned_by(n, next_step(overlap_at(pair, n), rolling_of(pair)).turn);
}

/// What a contact is from where Newton's step leads to it.
template <class V>
inline __attribute__((always_inline)) ContactsOf<V> contacts_by(const SuperellipsoidPair<V>& pair,
                                                                const OverlapAndStep<V>& there) {
  const OverlapAt<V>& at = there.at;
  Triple<V> both = plus(plus(at.i.point, V{} + 1.0, at.j.point), V{} + 1.0, pair.branch);
  const SupportMode<V>* modes[4] = {&at.i.xy, &at.i.z, &at.j.xy, &at.j.z};
  for (int m = 0; m < 4; ++m) {
    const V moves = modes[m]->stiffness * there.step.s[m];
    both = plus(both, m < 2 ? moves : -moves, modes[m]->along);
  }
  return {at.overlap - 0.5 * there.step.gain, turned_by(at.n, there.step.plain), times(V{} + 0.5, both)};
}

/// The last step is taken from a place of a grid of directions, that in which f is least, so that it has the same bits
/// wherever the steps before came from. Places are as wide as the last step may be long, so that a contact that moves
/// little stays in one, and the place kept from the last time is all that has to be looked at.
///
/// A place is a cube of the edge s about p; a direction is in the place to which it rounds. Beside flat sides s follows
/// the least component u of n along the axes of both bodies: a step goes by its law while it is short beside u. Where u
/// is below `flat_component` n has no place.
constexpr double widest_place = 0x1p-15, place_over_component = 0x1p-13, least_component = 0x1p-27,
                 flat_component = 0x1p-31;
/// |turn|^2 and reach of a step of which the error is known: what it misses, beside other modes too.
constexpr double known_turn = 2.5e-9, known_reach = 0.01;

template <class V>
inline __attribute__((always_inline)) V most_of(const Triple<V>& v) {
  return larger_of(magnitude_of(v.x), larger_of(magnitude_of(v.y), magnitude_of(v.z)));
}
/// The multiples of s nearest to n.
template <class V>
inline __attribute__((always_inline)) Triple<V> rounded_to(const Triple<V>& n, V s) {
  const V magic = 6755399441055744.0 * s;
  return {(n.x + magic) - magic, (n.y + magic) - magic, (n.z + magic) - magic};
}

template <class V, class Mask>
struct GridPlace {
  Triple<V> at;
  V edge;           ///< s
  Mask sure, flat;  ///< beyond the error of the step that led there
};
/// Of n, to which a step led.
template <class V>
inline __attribute__((always_inline)) auto place_of(const SuperellipsoidPair<V>& pair, const Triple<V>& n,
                                                    const OverlapAndStep<V>& there) {
  using Bits = typename BitsOf<V>::Type;
  const auto smaller = [](V p, V q) { return p < q ? p : q; };
  const auto least_of = [&](const Triple<V>& v) {
    return smaller(magnitude_of(v.x), smaller(magnitude_of(v.y), magnitude_of(v.z)));
  };
  const V turn = most_of(there.turn()), error = turn * (16.0 * there.reach() + 90.0 * turn) + noise_of(pair);
  const V u = smaller(least_of(in_frame(pair.axes_i, n)), least_of(in_frame(pair.axes_j, n)));
  const auto power_of_2 = [&](V v) {
    constexpr std::uint64_t exponent = 0x7ff0000000000000;
    const V within = smaller(larger_of(v, V{} + least_component), V{} + widest_place / place_over_component);
    return same_bits<V>(same_bits<Bits>(within) & exponent);
  };
  const V low = power_of_2(u - error), high = power_of_2(u + error);
  const V s = place_over_component * low;
  GridPlace<V, decltype(u < low)> place = {rounded_to(n, s), s, u < low, u + error < flat_component};
  place.sure =
      (most_of(plus(n, V{} - 1.0, place.at)) + error < 0.5 * s) & (low == high) & (u - error >= flat_component);
  return place;
}

/// What is seen from a direction: whether f is least in its place; whether it shows that the pair is apart; else
/// whether to go on. The edge of the place to which it leads.
template <class V, class Mask>
struct Look {
  Mask final, apart, going;
  V edge;
};
/// From `place`, along which the pair is `seen`; it goes on where the look is not the last. `decided`: the look before
/// was sure of it.
template <class Pair, class Seen, class V, class Mask>
inline __attribute__((always_inline)) Look<V, Mask> judged(const Pair& pair, const Seen& seen, Triple<V>& place,
                                                           Mask& decided) {
  const V rolling = rolling_of(pair);
  Look<V, Mask> look;
  look.apart = (seen.overlap() < -1e-12 * seen.heights()) | (rolling < 1e-25);  // pairs that pad a chunk have no size
  const Mask near = (seen.reach() <= known_reach) & (dot(seen.turn(), seen.turn()) <= known_turn);
  Triple<V> next = seen.next();
  const auto found = place_of(pair, next, seen);
  look.edge = found.edge;
  const Mask stays = (found.at.x == place.x) & (found.at.y == place.y) & (found.at.z == place.z);
  look.final = near & (seen.overlap() <= 0.5 * rolling) & (decided | (found.sure & stays));
  const Mask open = !(look.final | look.apart), sure = near & found.sure;
  const Mask far = open & (!((seen.reach() <= 0.5) & (dot(seen.turn(), seen.turn()) <= 0.01)));
  look.going = open & !(near & found.flat);
  if (!any_of(look.going)) return look;
  if (any_of(far)) next = chosen(!far, next, far_direction(pair, seen.n()));
  place = chosen(look.going, chosen(sure, found.at, next), place);
  decided = (look.going & sure) | (decided & (!look.going));
  return look;
}

/// Looks from a direction on, until no lane goes on.
template <class Seen, class Look>
struct Led {
  Seen seen;
  Look look;
};
template <class Pair, class V>
inline __attribute__((always_inline)) auto led_from(const Pair& pair, Triple<V>& place, int steps) {
  decltype(V{} < 0.0) decided = V{} < 0.0;
  Led<SeenOf<Pair>, Look<V, decltype(decided)>> led;
  for (int k = 0;; ++k) {
    evaluate(pair, of_length_1(place), led.seen);
    led.look = judged(pair, led.seen, place, decided);
    if (k == steps || !any_of(led.look.going)) return led;
  }
}

template <class Mask, class V>
inline __attribute__((always_inline)) ContactsOf<V> chosen(Mask held, const ContactsOf<V>& a, const ContactsOf<V>& b) {
  return {held ? a.overlap : b.overlap, chosen(held, a.n, b.n), chosen(held, a.point, b.point)};
}

/// What the search finds of one pair, by its place where it has one.
inline ContactsOf<double> searched_contact(const OverlapPair& pair) {
  const SuperellipsoidContact found = contact_of(pair);
  Triple<double> place = found.n;
  const auto last = led_from(pair, place, 3);
  if (last.look.final) return contacts_by(pair, last.seen);
  return {found.overlap, found.n, found.point};
}

/// From the bodies alone: by the place where f is least if there is one, else by the direction to which the steps lead,
/// or by `search`, which gives searched_contact of one lane. `next`: where to begin next time.
template <class V, class Search>
__attribute__((noinline)) void from_bodies(const SuperellipsoidPair<V>& pair, ContactsOf<V>& contacts, Triple<V>& next,
                                           const Search& search) {
  using Mask = decltype(V{} < 0.0);
  const V rolling = rolling_of(pair), size = size_of(pair);
  next = first_direction(pair);
  const auto led = led_from(pair, next, superellipsoid_steps);
  contacts = contacts_by(pair, led.seen);
  contacts.overlap = led.look.apart ? V{} - rolling : contacts.overlap;
  Mask left = !(led.look.apart | led.look.final);
  if (!any_of(left)) return;
  // Flat on flat, or deep, or astray.
  OverlapAt<V> at = led.seen.at;
  OverlapStep<V> step = next_step(at, rolling);
  Mask settled = is_near_least(step, 1e-6) | is_least(at, step, size), going = left & !settled;
  for (int k = 0; k < superellipsoid_steps && any_of(going); ++k) {
    at = overlap_at(pair, chosen(settled, at.n, turned_by(at.n, step.turn)));
    step = next_step(at, rolling);
    settled = settled | is_near_least(step, 1e-6) | is_least(at, step, size);
    going = left & !settled;
  }
  Triple<V> place = at.n;
  const auto last = led_from(pair, place, 3);
  const ContactsOf<V> by_steps = contacts_by(pair, OverlapAndStep<V>{at, step});
  contacts = chosen(left, chosen(last.look.final, contacts_by(pair, last.seen), by_steps), contacts);
  next = chosen(left, chosen(last.look.final, place, at.n), next);
  left = left & !(settled & (at.overlap <= rolling));
  if (!any_of(left)) return;
  ask_search(left, contacts, search);
  next = chosen(left, contacts.n, next);
}

/// Steps that a kept direction is given before the pair is left to those from the bodies.
constexpr int steps_from_guess = 4;

/// `guess`: a direction to begin with, longer than 1/2, or 0 where there is none; afterwards the next one. The contacts
/// do not depend on it.
template <class V>
inline __attribute__((always_inline)) ContactsOf<V> contacts_of(const SuperellipsoidPair<V>& pair, Triple<V>& guess) {
  using Mask = decltype(V{} < 0.0);
  const Mask guessed = dot(guess, guess) >= 0.25;
  const V zero = V{}, one = zero + 1.0;
  const auto search = [&](int lane) {
    return searched_contact({in_lane(pair.form_i, lane), in_lane(pair.form_j, lane), in_lane(pair.axes_i, lane),
                             in_lane(pair.axes_j, lane), in_lane(pair.branch, lane)});
  };
  if (!any_of(guessed)) {
    ContactsOf<V> contacts;
    from_bodies(pair, contacts, guess, search);
    return contacts;
  }
  guess = chosen(guessed, guess, Triple<V>{one, zero, zero});
  const auto led = led_from(pair, guess, steps_from_guess);
  ContactsOf<V> contacts = contacts_by(pair, led.seen);
  contacts.overlap = led.look.apart ? zero - one : contacts.overlap;
  const Mask left = !(led.look.apart | (guessed & led.look.final));
  if (any_of(left)) {
    ContactsOf<V> others;
    Triple<V> next;
    from_bodies(pair, others, next, search);
    contacts = chosen(left, others, contacts);
    guess = chosen(left, next, guess);
  }
  return contacts;
}

}  // namespace
}  // namespace rvelab
