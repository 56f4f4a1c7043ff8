#include "rvelab/solver/assembly/listing.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include "rvelab/error.hpp"
#include "rvelab/solver/assembly/gather_table.hpp"
#include "rvelab/solver/assembly/oriented_bounds.hpp"
#include "rvelab/solver/assembly/outline.hpp"
#include "rvelab/solver/assembly/staleness.hpp"

namespace rvelab {

namespace {

ListedPair key_of(const Contact& c) { return {c.i, c.j, c.image}; }

void sort_by_key(std::vector<Contact>& contacts) {
  const auto before = [](const Contact& x, const Contact& y) { return key_of(x) < key_of(y); };
  if (!std::is_sorted(contacts.begin(), contacts.end(), before)) std::sort(contacts.begin(), contacts.end(), before);
}

void store(const Model& f, PairTable& pairs, std::size_t p, const Contact& c) {
  if (f.dimension() == 2) {
    pairs.tangential[0][p] = c.tangential_force[0];
    if (f.contact.rolling) pairs.moment[0][p] = c.rolling_moment[2];
  } else {
    for (int k = 0; k < 3; ++k) pairs.tangential[k][p] = c.tangential_force[k];
    if (f.contact.rolling)
      for (int k = 0; k < 3; ++k) pairs.moment[k][p] = c.rolling_moment[k];
  }
  if (f.stores_root_overlap()) pairs.root_overlap[p] = c.last_root_overlap;
}

/// Pairs closer than the skin as the grains lie now.
std::vector<ListedPair> near_pairs(const Model& f, const Assembly& a, double skin) {
  std::vector<ListedPair> pairs = list_pairs(a.cell, a.rows.data(), f.row_length(), f.reach(), skin, f.sharing());
  keep_near_outlines(f, a, skin, pairs);
  return pairs;
}

/// What becomes of a history whose pair is not listed: in a run the grains parted in the sub-step just made, and their
/// force ends with it as that of every contact that opens; in a specimen it is a mistake.
enum class Lost { dropped, refused };

template <Shape shape>
bool touches(const Model& f, const Assembly& a, const UpperTriangle& l, const ListedPair& pair) {
  const double* xi = a.rows.data() + std::size_t(pair.i) * f.row_length();
  const double* xj = a.rows.data() + std::size_t(pair.j) * f.row_length();
  const Image& n = pair.image;
  const double x = xj[0] - xi[0] + l.xx * n[0] + l.xy * n[1] + l.xz * n[2];
  const double y = xj[1] - xi[1] + l.yy * n[1] + l.yz * n[2];
  const double z = dimension_of(shape) == 2 ? 0 : xj[2] - xi[2] + l.zz * n[2];
  if constexpr (!is_round(shape)) return Outline<shape>::place({x, y, 0}, xi, xj).overlap > 0;
  const double radii = f.radius[std::size_t(pair.i)] + f.radius[std::size_t(pair.j)];
  return x * x + y * y + z * z < radii * radii;
}

/// Places of the pairs of a new list in memory: first those that touch or have a history, and of these and the others
/// first those without an image, so that few blocks of eight have one. The kernel that books losses adds up what all
/// pairs lose as they lie, so with it they lie in order.
void arrange(const Model& f, const Assembly& a, const std::vector<ListedPair>& listed,
             const std::vector<const Contact*>& histories, PairTable& pairs) {
  const std::size_t n = listed.size();
  const UpperTriangle l = upper_triangle(a.cell.lattice);
  std::vector<std::uint8_t> group(n, 0);  // 0, 1 near, 2, 3 beyond, the odd ones with an image
  if (!f.options.energy_balance)
    with_shape(f.shape, [&](auto is) {
      in_pieces(n, f.sharing(), [&](std::size_t, std::size_t first, std::size_t last) {
        for (std::size_t k = first; k < last; ++k) {
          const bool near = histories[k] != nullptr || touches<decltype(is)::value>(f, a, l, listed[k]);
          group[k] = std::uint8_t((near ? 0 : 2) + int(is_shifted(listed[k].image)));
        }
      });
    });
  std::int32_t next[5] = {};
  for (const std::uint8_t of_pair : group) ++next[of_pair + 1];
  for (int k = 1; k < 5; ++k) next[k] += next[k - 1];
  pairs.near = (std::size_t(next[2]) + 7) / 8 * 8;
  pairs.order.resize(n);
  for (std::size_t k = 0; k < n; ++k) pairs.order[k] = next[group[k]]++;
}

/// Makes the arrays of a new list and fills in the carried history, which is sorted by key.
void fill(const Model& f, const std::vector<ListedPair>& listed, const std::vector<Contact>& carried, Lost lost,
          Assembly& a) {
  const std::size_t n = listed.size(), padded = padded_to_lanes(n);
  std::vector<const Contact*> histories(n, nullptr);
  std::size_t k = 0;
  for (const Contact& c : carried) {
    while (k < n && listed[k] < key_of(c)) ++k;
    if (k < n && listed[k] == key_of(c))
      histories[k] = &c;
    else if (lost == Lost::refused)
      throw InputError("specimen: grains " + std::to_string(f.id[c.i]) + " and " + std::to_string(f.id[c.j]) +
                       " have a contact history but lie apart by more than the skin: the history does not belong to "
                       "the positions");
  }

  if (Replaced* kept = a.trial.replaced; kept != nullptr && !kept->list_taken) {
    std::swap(a.pairs, kept->list);
    std::swap(a.state.list_positions, kept->list_positions);
    kept->list_taken = true;
  }
  PairTable& pairs = a.pairs;
  pairs.listed = n;
  arrange(f, a, listed, histories, pairs);
  pairs.i.resize(padded);
  pairs.j.resize(padded);
  pairs.image.resize(padded);
  for (std::size_t p = n; p < padded; ++p) {
    pairs.i[p] = pairs.j[p] = std::int32_t(f.size());  // a padding grain: no extent, no mass
    pairs.image[p] = Image{1, 0, 0};
  }
  for (int component = 0; component < f.tangential_components(); ++component) {
    pairs.tangential[component].assign(padded, 0.0);
    if (f.contact.rolling) pairs.moment[component].assign(padded, 0.0);
  }
  if (f.stores_root_overlap()) pairs.root_overlap.assign(padded, 0.0);
  in_pieces(n, f.sharing(), [&](std::size_t, std::size_t first, std::size_t last) {
    for (std::size_t q = first; q < last; ++q) {
      const auto p = std::size_t(pairs.order[q]);
      pairs.i[p] = listed[q].i;
      pairs.j[p] = listed[q].j;
      pairs.image[p] = listed[q].image;
      if (histories[q] != nullptr) store(f, pairs, p, *histories[q]);
    }
  });
  derive_pairs(f, pairs);
  fill_gather_table(padded_to_lanes(f.size()), force_row_length(f.dimension()), pairs);
}

/// The key of a pair after images changed; a grain's own image is kept pointing forward, forces turning round with it.
void turn_round_if_needed(const Model& f, Contact& c) {
  if (c.i != c.j || points_forward(c.image)) return;
  for (int& n : c.image) n = -n;
  c.rolling_moment = -c.rolling_moment;
  // In 2D the component along t = (-n_y, n_x) keeps its sign: force and t both turn.
  if (f.dimension() == 3) c.tangential_force = -c.tangential_force;
}

/// A velocity gradient less the rigid spin that cancels its lower triangle. Grains and branches share that spin, so no
/// contact slips or opens by it; the step kernel takes upper-triangular rates only.
Matrix3 without_lower_part(const Matrix3& rate) {
  Matrix3 rest = rate;
  for (int r = 0; r < 3; ++r)
    for (int k = 0; k < r; ++k) {
      rest(k, r) += rate(r, k);
      rest(r, k) = 0;
    }
  return rest;
}

void rotate_rows(const Model& f, const Matrix3& turn, Buffer& rows) {
  for (std::size_t g = 0; g < f.size(); ++g) {
    double* row = rows.data() + g * f.row_length();
    const auto rotate = [&](double* v) {
      if (f.dimension() == 2) {
        const double x = turn(0, 0) * v[0] + turn(0, 1) * v[1], y = turn(1, 0) * v[0] + turn(1, 1) * v[1];
        v[0] = x;
        v[1] = y;
      } else {
        const Vector3 turned = turn * Vector3(v[0], v[1], v[2]);
        for (int k = 0; k < 3; ++k) v[k] = turned[k];
      }
    };
    rotate(row);
    rotate(row + f.velocity_offset());
    if (f.dimension() == 3) rotate(row + 8);
    if (!f.round()) {
      rotate(row + 5);
      complete_row(f, g, row);
    }
  }
}

}  // namespace

std::vector<Contact> contacts_of(const Model& f, const PairTable& pairs) {
  std::vector<std::vector<Contact>> found(pieces_in(pairs.listed));
  const auto look_at = [&](std::size_t p, std::vector<Contact>& here) {
    Contact c{pairs.i[p], pairs.j[p], pairs.image[p]};
    for (int k = 0; k < f.tangential_components(); ++k) c.tangential_force[k] = pairs.tangential[k][p];
    if (f.contact.rolling) {
      if (f.dimension() == 2)
        c.rolling_moment[2] = pairs.moment[0][p];
      else
        for (int k = 0; k < 3; ++k) c.rolling_moment[k] = pairs.moment[k][p];
    }
    if (f.stores_root_overlap()) c.last_root_overlap = pairs.root_overlap[p];
    if (!c.tangential_force.isZero(0) || !c.rolling_moment.isZero(0) || c.last_root_overlap != 0) here.push_back(c);
  };
  in_pieces(pairs.listed, f.sharing(), [&](std::size_t piece, std::size_t first, std::size_t last) {
    found[piece].reserve(last - first);
    for (std::size_t k = first; k < last; ++k) look_at(std::size_t(pairs.order[k]), found[piece]);
  });
  if (found.size() == 1) return std::move(found.front());
  std::vector<Contact> all;
  for (const std::vector<Contact>& here : found) all.insert(all.end(), here.begin(), here.end());
  return all;
}

void list_with(const Model& f, std::vector<Contact> contacts, Assembly& a) {
  sort_by_key(contacts);
  // The state says how far grains have come since the list of its run was made, and they may come back that far and as
  // far beyond before it is made anew: its pairs, of gaps below the skin then, have gaps below the skin and that now.
  const double skin = a.state.list_skin, moved = a.state.has_reference ? skin - listed_gap(f, a) : 0;
  fill(f, near_pairs(f, a, skin + std::min(std::max(0.0, moved), skin)), contacts, Lost::refused, a);
}

void check_height(const Model& f, const Cell& cell) {
  const double shortest = shortest_vector(cell);
  if (shortest < f.min_height) {
    std::ostringstream text;
    text << "cell too thin: the shortest lattice vector is " << shortest << " m, the limit solver.min_height_m is "
         << f.min_height << " m; deform less, start from an oriented cell, or use a larger specimen";
    throw IncrementFailed(text.str());
  }
}

Reduction rebuild(const Model& f, Assembly& a) {
  std::vector<Contact> carried = contacts_of(f, a.pairs);
  if (a.state.has_reference) a.state.list_skin = next_skin(f, a.state);
  const Reduction reduction = reduced(a.cell);
  if (reduction.changed) {
    apply_reduction(a.cell, reduction);
    const Matrix3 back = reduction.rotation.transpose();
    rotate_rows(f, back, a.rows);
    a.state.mean_velocity = back * a.state.mean_velocity;
    a.state.interval_stress = back * a.state.interval_stress * reduction.rotation;
    a.state.last_rate = without_lower_part(back * a.state.last_rate * reduction.rotation);
    for (Contact& c : carried) {
      const Eigen::Vector3i n = reduction.inverse_basis * Eigen::Vector3i(c.image[0], c.image[1], c.image[2]);
      c.image = {n[0], n[1], n[2]};
      if (f.dimension() == 3) {
        c.tangential_force = back * c.tangential_force;
        c.rolling_moment = back * c.rolling_moment;
      }
    }
  }
  check_height(f, a.cell);
  std::vector<Image> moved(f.size(), Image{});
  const Vector3 half = 0.5 * a.cell.lattice.diagonal();
  in_pieces(f.size(), f.sharing(), [&](std::size_t, std::size_t first, std::size_t last) {
    for (std::size_t g = first; g < last; ++g) {
      double* row = a.rows.data() + g * f.row_length();
      bool inside = true;  // as most grains are: nothing to wrap
      for (int k = 0; k < f.dimension(); ++k) inside &= row[k] >= -half[k] && row[k] < half[k];
      if (inside) continue;
      Vector3 x = a.position(f, g);
      moved[g] = wrap(a.cell, x);
      for (int k = 0; k < f.dimension(); ++k) row[k] = x[k];
    }
  });
  for (Contact& c : carried) {
    for (int k = 0; k < 3; ++k) c.image[k] += moved[c.i][k] - moved[c.j][k];
    turn_round_if_needed(f, c);
  }
  sort_by_key(carried);
  fill(f, near_pairs(f, a, a.state.list_skin), carried, Lost::dropped, a);
  a.state.has_reference = true;
  a.state.list_lattice = a.cell.lattice;
  a.state.list_travel = 0;
  a.state.list_steps = 0;
  a.state.list_positions.resize(f.size());
  for (std::size_t g = 0; g < f.size(); ++g) a.state.list_positions[g] = listed_place(f, a, g);
  ++a.state.list_builds;
  return reduction;
}

}  // namespace rvelab
