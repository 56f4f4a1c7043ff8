// Where pairs of superellipsoids lie: normal and overlap by superellipsoid/lanes.hpp, of specimens of ellipsoids alone
// by superellipsoid/ellipsoids.hpp. The contact point halves the line between the points of both, x_i from the centre
// of i and x_j = x_i - b from that of j.
#pragma once

#include "rvelab/contact/hertz_curvature.hpp"
#include "rvelab/grains/turns.hpp"
#include "rvelab/solver/kernels/space.hpp"
#include "rvelab/superellipsoid/ellipsoids.hpp"
#include "rvelab/superellipsoid/lanes.hpp"

namespace rvelab {

/// searched_contact of two grain rows and the branch {x, y, z}: {overlap, n, point}. Compiled once, for one pair (the
/// types of its formulas belong to the file that includes them).
void search_contact(const double* row_i, const double* row_j, const double* branch, double* contact);

namespace {

/// Form and axes from a grain row (grains/superellipsoid.hpp): its columns 12 to 23, and the rolling radius.
template <class V>
struct SuperellipsoidColumns {
  V turn[4], half[4], rest[4], rolling;

  SuperellipsoidForm<V> form() const {
    // Rows that pad the lanes hold zeros: they are spheres of 1e-30 m.
    return {{half[0] + 1e-30, half[1] + 1e-30, half[2] + 1e-30},
            1.0 - half[3],
            1.0 - rest[0],
            rest[1] - 0.5,
            rest[2] - 0.5,
            rolling};
  }
  SuperellipsoidAxes<V> axes() const {
    const LaneAxes<V> of = axes_of(LaneTurn<V>{turn[0], {turn[1], turn[2], turn[3]}});
    const Triple<V>&a = of.row[0], &b = of.row[1], &c = of.row[2];
    return {{a.x, b.x, c.x}, {a.y, b.y, c.y}, {a.z, b.z, c.z}};
  }
};
template <int W>
inline __attribute__((always_inline)) SuperellipsoidColumns<typename Lanes<W>::V> columns_of_shapes(
    const double* rows, const std::int32_t* row) {
  SuperellipsoidColumns<typename Lanes<W>::V> c;
  ColumnsOf<W>::load([=](int lane) { return rows + row[lane] + 12; }, c.turn);
  ColumnsOf<W>::load([=](int lane) { return rows + row[lane] + 16; }, c.half);
  ColumnsOf<W>::load([=](int lane) { return rows + row[lane] + 20; }, c.rest);
  c.rolling = Lanes<W>::collected([=](int lane) { return rows[row[lane] + 3]; });
  return c;
}

/// From one row, for what looks at pairs one by one.
inline SuperellipsoidColumns<double> shape_in_row(const double* row) {
  const std::int32_t start = 0;
  return columns_of_shapes<1>(row, &start);
}

template <int W>
inline __attribute__((always_inline)) SuperellipsoidPair<typename Lanes<W>::V> superellipsoid_pair(
    const StepConstants& c, const PairArrays& p, const double* rows, long at) {
  using V = typename Lanes<W>::V;
  const std::int32_t *i = p.row_i + at, *j = p.row_j + at;
  const SuperellipsoidColumns<V> of_i = columns_of_shapes<W>(rows, i), of_j = columns_of_shapes<W>(rows, j);
  const Triple<V> branch = branch_of(c, p, at, gather_differences<W, 3>(rows, i, j));
  return {of_i.form(), of_j.form(), of_i.axes(), of_j.axes(), branch};
}

/// What the passes hand on.
struct SuperellipsoidScratch : SpaceScratch {
  ScratchColumn overlap, radius;  ///< radius: R*, where it is that of the curvature (contact/hertz_curvature.hpp)
  TripleColumn branch, arm_i, arm_j;
};

template <int W, class V>
inline __attribute__((always_inline)) void put_contacts(const Triple<V>& branch, const ContactsOf<V>& contacts, long k,
                                                        SuperellipsoidScratch& s) {
  const auto touch = contacts.overlap > 0.0;
  const Triple<V> none = {V{}, V{}, V{}};
  s.normal.store(k, contacts.n);
  store_as(s.overlap.at + k, contacts.overlap);
  s.arm_i.store(k, chosen(touch, contacts.point, none));
  s.arm_j.store(k, chosen(touch, contacts.point - branch, none));
}

/// Any W pairs of a chunk, by their numbers in it.
template <int W>
struct PairGroup {
  long k[W];
  std::int32_t i[W], j[W];

  template <class At>
  static PairGroup of(const PairArrays& p, long first, const At& at) {
    PairGroup group;
    for (int lane = 0; lane < W; ++lane) {
      group.k[lane] = at(lane);
      group.i[lane] = p.row_i[first + group.k[lane]];
      group.j[lane] = p.row_j[first + group.k[lane]];
    }
    return group;
  }
  template <class V>
  Triple<V> column(const TripleColumn& from) const {
    V columns[3];
    for (int m = 0; m < 3; ++m) columns[m] = Lanes<W>::collected([&](int lane) { return from.along[m].at[k[lane]]; });
    return first_of<3>(columns);
  }
  template <class V>
  void put(const Triple<V>& value, TripleColumn& to) const {
    for (int lane = 0; lane < W; ++lane) to.store(k[lane], in_lane(value, lane));
  }
};

template <class V>
inline __attribute__((always_inline)) EllipsoidPair<V> ellipsoids_of(const SuperellipsoidPair<V>& pair) {
  return {ellipsoid_matrix(pair.form_i.half, pair.axes_i), ellipsoid_matrix(pair.form_j.half, pair.axes_j),
          pair.branch};
}
/// As the steps take it.
template <bool Ellipsoids, class V>
inline __attribute__((always_inline)) auto searched_pair(const SuperellipsoidPair<V>& pair) {
  if constexpr (Ellipsoids)
    return ellipsoids_of(pair);
  else
    return pair;
}
template <class Pair, class At, class Mask>
inline __attribute__((always_inline)) auto contacts_seen(const Pair& pair, const At& at, const Mask& apart) {
  auto contacts = contacts_by(pair, at);
  contacts.overlap = apart ? contacts.overlap * 0.0 - 1.0 : contacts.overlap;
  return contacts;
}

/// Numbers of pairs, from the lanes of a mask.
struct PairNumbers {
  long at[chunk_pairs], count = 0;

  template <int W, class Mask, class Number>
  inline __attribute__((always_inline)) void add(Mask held, const Number& number) {
    if (!any_of(held)) return;
    if constexpr (W == 1) {
      at[count++] = number(0);
    } else {
      std::int64_t lanes[W];
      std::memcpy(lanes, &held, sizeof(held));
      for (int lane = 0; lane < W; ++lane)
        if (lanes[lane] != 0) at[count++] = number(lane);
    }
  }
};

/// Where the search of a pair begins the next time: its direction, extrapolated linearly from the last two, in a cell
/// of the grid. `last`: its direction now, of length 1, 0 where it has none (PairArrays::directions).
template <class V>
struct KeptDirections {
  Triple<V> place, last;

  /// Of a contact along n; `edge`: of its place.
  inline __attribute__((always_inline)) void go_on(const Triple<V>& n, V edge) {
    const auto known = dot(last, last) > 0.25;
    const Triple<V> next = plus(plus(n, V{} + 1.0, n), V{} - 1.0, last);
    place = rounded_to(chosen(known, next, n), edge);
    last = n;
  }
};
template <int W, class RowOf>
inline __attribute__((always_inline)) KeptDirections<typename Lanes<W>::V> directions_of(const RowOf& row) {
  typename Lanes<W>::V place[4], last[4];
  ColumnsOf<W>::load([&](int lane) { return row(lane); }, place);
  ColumnsOf<W>::load([&](int lane) { return row(lane) + 4; }, last);
  return {{place[0], place[1], place[2]}, {last[0], last[1], last[2]}};
}

/// Branch, normal, overlap and arms. Each pair is looked at from its kept direction, and goes on in groups with others
/// until it is done: one that is in its place costs one look, whatever those beside it do. The kept directions stand in
/// rows of eight at `directions`. Not inlined: it is long, and the same for every law.
template <int W, bool Ellipsoids>
__attribute__((noinline)) void superellipsoid_places(const StepConstants& c, const PairArrays& p, const double* rows,
                                                     long first, long count, double* directions,
                                                     SuperellipsoidScratch& s) {
  using V = typename Lanes<W>::V;
  using Mask = decltype(V{} < 0.0);
  const Triple<V> zero = {V{}, V{}, V{}};
  PairNumbers open, left;
  double decided[chunk_pairs];
  // Updates the search direction: for the next evaluation of this sub-step or the first of the next.
  const auto kept_after = [&](const auto& look, const ContactsOf<V>& contacts, const Triple<V>& place,
                              KeptDirections<V>& kept) {
    KeptDirections<V> done = kept;
    done.go_on(contacts.n, look.edge);
    kept.place = chosen(look.final, done.place, place);
    kept.last = chosen(look.final, done.last, chosen(look.apart, zero, kept.last));
  };
  for (long k = 0; k < count; k += W) {
    const SuperellipsoidPair<V> pair = superellipsoid_pair<W>(c, p, rows, first + k);
    s.branch.store(k, pair.branch);
    KeptDirections<V> kept = directions_of<W>([=](int lane) { return directions + 8 * (k + lane); });
    Triple<V> place = kept.place;
    const Mask none = dot(place, place) < 0.25;
    if (any_of(none)) place = chosen(none, Triple<V>{V{} + 1.0, V{}, V{}}, place);
    Mask sure = V{} < 0.0;
    const auto both = searched_pair<Ellipsoids>(pair);
    SeenOf<std::remove_const_t<decltype(both)>> seen;
    evaluate(both, of_length_1(place), seen);
    const auto look = judged(both, seen, place, sure);
    const ContactsOf<V> contacts = contacts_seen(both, seen, look.apart);
    put_contacts<W>(pair.branch, contacts, k, s);
    kept_after(look, contacts, place, kept);
    const V next[4] = {kept.place.x, kept.place.y, kept.place.z, V{}},
            last[4] = {kept.last.x, kept.last.y, kept.last.z, V{}};
    rows_of<W>(next, directions + 8 * k, 8);
    rows_of<W>(last, directions + 8 * k + 4, 8);
    store_as(decided + k, sure ? V{} + 1.0 : V{});
    const Mask going = look.going & (!none), lost = (look.going & none) | (!(look.final | look.apart | look.going));
    open.template add<W>(going, [=](int lane) { return k + lane; });
    left.template add<W>(lost, [=](int lane) { return k + lane; });
  }
  if (open.count + left.count == 0) return;
  const auto in_groups = [&](const PairNumbers& numbers, const auto& work) {
    for (long from = 0; from < numbers.count; from += W) {
      const auto at = [&](int lane) { return from + lane < numbers.count ? from + lane : from; };
      const auto group = PairGroup<W>::of(p, first, [&](int lane) { return numbers.at[at(lane)]; });
      const SuperellipsoidColumns<V> of_i = columns_of_shapes<W>(rows, group.i),
                                     of_j = columns_of_shapes<W>(rows, group.j);
      const Triple<V> branch = group.template column<V>(s.branch);
      const SuperellipsoidPair<V> pair = {of_i.form(), of_j.form(), of_i.axes(), of_j.axes(), branch};
      KeptDirections<V> kept = directions_of<W>([&](int lane) { return directions + 8 * group.k[lane]; });
      const ContactsOf<V> contacts = work(group, pair, kept, from);
      for (int lane = 0; lane < W; ++lane) {
        double* row = directions + 8 * group.k[lane];
        row[0] = in_lane(kept.place.x, lane), row[1] = in_lane(kept.place.y, lane);
        row[2] = in_lane(kept.place.z, lane), row[4] = in_lane(kept.last.x, lane);
        row[5] = in_lane(kept.last.y, lane), row[6] = in_lane(kept.last.z, lane);
        s.overlap.at[group.k[lane]] = in_lane(contacts.overlap, lane);
      }
      const Mask touch = contacts.overlap > 0.0;
      group.put(contacts.n, s.normal);
      group.put(chosen(touch, contacts.point, zero), s.arm_i);
      group.put(chosen(touch, contacts.point - branch, zero), s.arm_j);
    }
  };
  for (int k = 0; k < steps_from_guess && open.count > 0; ++k) {
    const PairNumbers now = open;
    open.count = 0;
    in_groups(now,
              [&](const PairGroup<W>& group, const SuperellipsoidPair<V>& pair, KeptDirections<V>& kept, long from) {
                Mask sure = Lanes<W>::collected([&](int lane) { return decided[group.k[lane]]; }) > 0.5;
                const auto both = searched_pair<Ellipsoids>(pair);
                Triple<V> place = kept.place;
                SeenOf<std::remove_const_t<decltype(both)>> seen;
                evaluate(both, of_length_1(place), seen);
                const auto look = judged(both, seen, place, sure);
                const V held = sure ? V{} + 1.0 : V{};
                for (int lane = 0; lane < W; ++lane) decided[group.k[lane]] = in_lane(held, lane);
                const long here = now.count - from;
                const V number = Lanes<W>::collected([](int lane) { return double(lane); });
                const Mask counts = number < double(here), going = look.going & counts,
                           lost = (!(look.final | look.apart | look.going)) & counts;
                open.template add<W>(going, [&](int lane) { return group.k[lane]; });
                left.template add<W>(lost, [&](int lane) { return group.k[lane]; });
                const ContactsOf<V> contacts = contacts_seen(both, seen, look.apart);
                kept_after(look, contacts, place, kept);
                return contacts;
              });
  }
  for (long k = 0; k < open.count; ++k) left.at[left.count++] = open.at[k];
  in_groups(left, [&](const PairGroup<W>& group, const SuperellipsoidPair<V>& pair, KeptDirections<V>& kept, long) {
    ContactsOf<V> contacts;
    from_bodies(searched_pair<Ellipsoids>(pair), contacts, kept.place, [&](int lane) {
      const Triple<double> b = in_lane(pair.branch, lane);
      const double between[3] = {b.x, b.y, b.z};
      double found[7];
      search_contact(rows + group.i[lane], rows + group.j[lane], between, found);
      return ContactsOf<double>{found[0], {found[1], found[2], found[3]}, {found[4], found[5], found[6]}};
    });
    kept.last = zero;
    return contacts;
  });
}

/// R* by the normals that were found, 0 where pairs are apart: a pass of its own, so that others pay nothing for it.
template <int W, bool Ellipsoids>
__attribute__((noinline)) void hertz_radii(const StepConstants& c, const PairArrays& p, const double* rows, long first,
                                           long count, SuperellipsoidScratch& s) {
  using V = typename Lanes<W>::V;
  for (long k = 0; k < count; k += W) {
    const SuperellipsoidPair<V> pair = superellipsoid_pair<W>(c, p, rows, first + k);
    const Triple<V> n = s.normal.load<V>(k);
    V radius;
    if constexpr (Ellipsoids)
      radius = hertz_radius(ellipsoids_of(pair), n);
    else
      radius = hertz_radius(support_at(pair.form_i, pair.axes_i, n),
                            support_at(pair.form_j, pair.axes_j, times(V{} - 1.0, n)), largest_radius(pair.form_i.half),
                            largest_radius(pair.form_j.half));
    store_as(s.radius.at + k, (load_as<V>(s.overlap.at + k) > 0.0) ? radius : V{});
  }
}

/// What the kernels ask for: places, and R* where it is that of the curvature.
template <int W, bool Ellipsoids, bool Curvature>
inline __attribute__((always_inline)) void locate_superellipsoids(const StepConstants& c, const PairArrays& p,
                                                                  const double* rows, long first, long count,
                                                                  double* directions, SuperellipsoidScratch& s) {
  superellipsoid_places<W, Ellipsoids>(c, p, rows, first, count, directions, s);
  if constexpr (Curvature) hertz_radii<W, Ellipsoids>(c, p, rows, first, count, s);
}

}  // namespace
}  // namespace rvelab
