#include "rvelab/solver/assembly/listing.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <utility>

#include "rvelab/error.hpp"
#include "rvelab/solver/assembly/gather_table.hpp"
#include "rvelab/solver/assembly/interactions.hpp"
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

void store(const Model& model, PairTable& pairs, std::size_t p, const Contact& c) {
  if (model.dimension() == 2) {
    pairs.tangential[0][p] = c.tangential_force[0];
    if (model.contact.rolling) pairs.moment[0][p] = c.rolling_moment[2];
  } else {
    for (int k = 0; k < 3; ++k) pairs.tangential[k][p] = c.tangential_force[k];
    if (model.contact.rolling)
      for (int k = 0; k < 3; ++k) pairs.moment[k][p] = c.rolling_moment[k];
  }
  if (model.stores_root_overlap()) pairs.root_overlap[p] = c.last_root_overlap;
}

/// What becomes of a history whose pair is not listed: in a run the grains parted in the sub-step just made, and their
/// force ends with it as that of every contact that opens; in a specimen it is a mistake.
enum class Lost { dropped, refused };

template <Shape shape>
bool touches(const Model& model, const Assembly& assembly, const UpperTriangle& l, const ListedPair& pair) {
  const double* xi = assembly.rows.data() + std::size_t(pair.i) * model.row_length();
  const double* xj = assembly.rows.data() + std::size_t(pair.j) * model.row_length();
  const Image& n = pair.image;
  const double x = xj[0] - xi[0] + l.xx * n[0] + l.xy * n[1] + l.xz * n[2];
  const double y = xj[1] - xi[1] + l.yy * n[1] + l.yz * n[2];
  const double z = dimension_of(shape) == 2 ? 0 : xj[2] - xi[2] + l.zz * n[2];
  if constexpr (!is_round(shape)) return Outline<shape>::place({x, y, z}, xi, xj).overlap > 0;
  const double radii = model.radius[std::size_t(pair.i)] + model.radius[std::size_t(pair.j)];
  return x * x + y * y + z * z < radii * radii;
}

/// Places of the pairs of a new list in memory: first those that touch or have a history, and of these and the others
/// first those without an image, so that few blocks of eight have one. The kernel that books losses adds up what all
/// pairs lose as they lie, so with it they lie in order.
void arrange(const Model& model, const Assembly& assembly, const std::vector<ListedPair>& listed,
             const std::vector<const Contact*>& histories, PairTable& pairs) {
  const std::size_t n = listed.size();
  const UpperTriangle l = upper_triangle(assembly.cell.lattice);
  std::vector<std::uint8_t> group(n, 0);  // 0, 1 near, 2, 3 beyond, the odd ones with an image
  if (!model.options.energy_balance)
    with_shape(model.shape, [&](auto is) {
      in_pieces(n, model.sharing(), [&](std::size_t, std::size_t first, std::size_t last) {
        for (std::size_t k = first; k < last; ++k) {
          const bool near = histories[k] != nullptr || touches<decltype(is)::value>(model, assembly, l, listed[k]);
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

/// Directions in which contacts of superellipsoids are looked for first. No contact depends on them, so that neither
/// image nor frame matters here: those of a pair of grains, in the order of (i, j).
struct KeptDirection {
  std::int32_t i, j;
  double at[8];
};
std::vector<KeptDirection> directions_in(const PairTable& pairs) {
  std::vector<KeptDirection> kept;
  if (pairs.directions.empty()) return kept;
  for (const std::int32_t listed : pairs.order) {
    const auto p = std::size_t(listed);
    const double* at = pairs.directions.data() + 8 * p;
    if (at[0] == 0 && at[1] == 0 && at[2] == 0) continue;
    kept.push_back({pairs.i[p], pairs.j[p], {}});
    std::copy_n(at, 8, kept.back().at);
  }
  return kept;
}
void put_directions(const std::vector<KeptDirection>& kept, PairTable& pairs) {
  std::size_t k = 0;
  for (const std::int32_t listed : pairs.order) {
    const auto p = std::size_t(listed);
    const auto pair = std::pair(pairs.i[p], pairs.j[p]);
    while (k < kept.size() && std::pair(kept[k].i, kept[k].j) < pair) ++k;
    if (k < kept.size() && std::pair(kept[k].i, kept[k].j) == pair)
      std::copy_n(kept[k].at, 8, pairs.directions.data() + 8 * p);
  }
}

/// Makes the arrays of a new list, of pairs nearer than `skin`, and fills in the carried history, sorted by key.
void fill(const Model& model, double skin, const std::vector<Contact>& carried, Interactions interactions, Lost lost,
          Assembly& assembly) {
  const std::vector<ListedPair> listed = near_pairs(model, assembly, skin);
  const std::size_t n = listed.size(), padded = padded_to_lanes(n);
  std::vector<const Contact*> histories(n, nullptr);
  std::size_t k = 0;
  for (const Contact& c : carried) {
    while (k < n && listed[k] < key_of(c)) ++k;
    if (k < n && listed[k] == key_of(c))
      histories[k] = &c;
    else if (lost == Lost::refused)
      throw InputError("specimen: grains " + std::to_string(model.id[c.i]) + " and " + std::to_string(model.id[c.j]) +
                       " have a contact history but lie apart by more than the skin: the history does not belong to "
                       "the positions");
  }

  const std::vector<KeptDirection> directions = directions_in(assembly.pairs);
  if (Replaced* kept = assembly.trial.replaced; kept != nullptr && !kept->list_taken) {
    std::swap(assembly.pairs, kept->list);
    std::swap(assembly.state.list.positions, kept->list_positions);
    kept->list_taken = true;
  }
  PairTable& pairs = assembly.pairs;
  pairs.listed = n;
  arrange(model, assembly, listed, histories, pairs);
  pairs.i.resize(padded);
  pairs.j.resize(padded);
  pairs.image.resize(padded);
  for (std::size_t p = n; p < padded; ++p) {
    pairs.i[p] = pairs.j[p] = std::int32_t(model.size());  // a padding grain: no extent, no mass
    pairs.image[p] = Image{1, 0, 0};
  }
  const double released = prepare_interactions(model, assembly, listed, skin, interactions);
  if (lost == Lost::dropped && assembly.state.list.built)
    assembly.state.energy_balance.book(&InteractionTerms::forming, released);
  set_interactions(model, interactions, pairs);
  for (int component = 0; component < model.tangential_components(); ++component) {
    pairs.tangential[component].assign(padded, 0.0);
    if (model.contact.rolling) pairs.moment[component].assign(padded, 0.0);
  }
  if (model.stores_root_overlap()) pairs.root_overlap.assign(padded, 0.0);
  in_pieces(n, model.sharing(), [&](std::size_t, std::size_t first, std::size_t last) {
    for (std::size_t q = first; q < last; ++q) {
      const auto p = std::size_t(pairs.order[q]);
      pairs.i[p] = listed[q].i;
      pairs.j[p] = listed[q].j;
      pairs.image[p] = listed[q].image;
      if (histories[q] != nullptr) store(model, pairs, p, *histories[q]);
    }
  });
  derive_pairs(model, pairs);
  if (!directions.empty()) put_directions(directions, pairs);
  fill_gather_table(padded_to_lanes(model.size()), force_row_length(model.dimension()), pairs);
}

/// The key of a pair after images changed; a grain's own image is kept pointing forward, forces turning round with it.
void turn_round_if_needed(const Model& model, Contact& c) {
  if (c.i != c.j || points_forward(c.image)) return;
  for (int& n : c.image) n = -n;
  c.rolling_moment = -c.rolling_moment;
  // In 2D the component along t = (-n_y, n_x) keeps its sign: force and t both turn.
  if (model.dimension() == 3) c.tangential_force = -c.tangential_force;
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

void rotate_rows(const Model& model, const Matrix3& turn, Buffer& rows) {
  for (std::size_t g = 0; g < model.size(); ++g) {
    double* row = rows.data() + g * model.row_length();
    const auto rotate = [&](double* v) {
      if (model.dimension() == 2) {
        const double x = turn(0, 0) * v[0] + turn(0, 1) * v[1], y = turn(1, 0) * v[0] + turn(1, 1) * v[1];
        v[0] = x;
        v[1] = y;
      } else {
        const Vector3 turned = turn * Vector3(v[0], v[1], v[2]);
        for (int k = 0; k < 3; ++k) v[k] = turned[k];
      }
    };
    rotate(row);
    rotate(row + model.velocity_offset());
    if (model.dimension() == 3) rotate(row + 8);
    if (keeps_axis(model.shape)) {
      rotate(row + 5);
      complete_row(model, g, row);
    }
  }
}

}  // namespace

std::vector<ListedPair> near_pairs(const Model& model, const Assembly& assembly, double skin) {
  std::vector<ListedPair> pairs =
      list_pairs(assembly.cell, assembly.rows.data(), model.row_length(), model.reach(), skin, model.sharing());
  keep_near_outlines(model, assembly, skin, pairs);
  leave_out_inner_pairs(model, assembly, pairs);
  return pairs;
}

std::vector<Contact> contacts_of(const Model& model, const PairTable& pairs) {
  std::vector<std::vector<Contact>> found(pieces_in(pairs.listed));
  const auto look_at = [&](std::size_t p, std::vector<Contact>& here) {
    Contact c{pairs.i[p], pairs.j[p], pairs.image[p]};
    for (int k = 0; k < model.tangential_components(); ++k) c.tangential_force[k] = pairs.tangential[k][p];
    if (model.contact.rolling) {
      if (model.dimension() == 2)
        c.rolling_moment[2] = pairs.moment[0][p];
      else
        for (int k = 0; k < 3; ++k) c.rolling_moment[k] = pairs.moment[k][p];
    }
    if (model.stores_root_overlap()) c.last_root_overlap = pairs.root_overlap[p];
    if (!c.tangential_force.isZero(0) || !c.rolling_moment.isZero(0) || c.last_root_overlap != 0) here.push_back(c);
  };
  in_pieces(pairs.listed, model.sharing(), [&](std::size_t piece, std::size_t first, std::size_t last) {
    found[piece].reserve(last - first);
    for (std::size_t k = first; k < last; ++k) look_at(std::size_t(pairs.order[k]), found[piece]);
  });
  if (found.size() == 1) return std::move(found.front());
  std::vector<Contact> all;
  for (const std::vector<Contact>& here : found) all.insert(all.end(), here.begin(), here.end());
  return all;
}

void list_with(const Model& model, std::vector<Contact> contacts, const Interactions& interactions,
               Assembly& assembly) {
  sort_by_key(contacts);
  // The state says how far grains have come since the list of its run was made, and they may come back that far and as
  // far beyond before it is made anew: its pairs, of gaps below the skin then, have gaps below the skin and that now.
  const double skin = assembly.state.list.skin,
               moved = assembly.state.list.built ? skin - listed_gap(model, assembly) : 0;
  fill(model, skin + std::min(std::max(0.0, moved), skin), contacts, interactions, Lost::refused, assembly);
}

void check_height(const Model& model, const Cell& cell) {
  const double shortest = shortest_vector(cell);
  if (shortest < model.min_height) {
    TextStream text;
    text << "cell too thin: the shortest lattice vector is " << shortest << " m, the limit solver.min_height_m is "
         << model.min_height << " m; deform less, start from an oriented cell, or use a larger specimen";
    throw IncrementFailed(text.str());
  }
}

Reduction rebuild(const Model& model, Assembly& assembly) {
  std::vector<Contact> carried = contacts_of(model, assembly.pairs);
  Interactions interactions = interactions_of(assembly.pairs, true);
  if (assembly.state.list.built) assembly.state.list.skin = next_skin(model, assembly.state.list);
  const Reduction reduction = reduced(assembly.cell);
  if (reduction.changed) {
    apply_reduction(assembly.cell, reduction);
    const Matrix3 back = reduction.rotation.transpose();
    rotate_rows(model, back, assembly.rows);
    assembly.state.last_step.mean_velocity = back * assembly.state.last_step.mean_velocity;
    assembly.state.control.interval.stress = back * assembly.state.control.interval.stress * reduction.rotation;
    assembly.state.last_step.rate = without_lower_part(back * assembly.state.last_step.rate * reduction.rotation);
    for (Contact& c : carried) {
      const Eigen::Vector3i n = reduction.inverse_basis * Eigen::Vector3i(c.image[0], c.image[1], c.image[2]);
      c.image = {n[0], n[1], n[2]};
      if (model.dimension() == 3) {
        c.tangential_force = back * c.tangential_force;
        c.rolling_moment = back * c.rolling_moment;
      }
    }
    follow_reduction(reduction, model.dimension(), interactions);
    reduce_bodies(reduction, model, assembly);
  }
  check_height(model, assembly.cell);
  wrap_bodies(model, assembly);
  std::vector<Image> moved(model.size(), Image{});
  const Vector3 half = 0.5 * assembly.cell.lattice.diagonal();
  in_pieces(model.size(), model.sharing(), [&](std::size_t, std::size_t first, std::size_t last) {
    for (std::size_t g = first; g < last; ++g) {
      double* row = assembly.rows.data() + g * model.row_length();
      bool inside = true;  // as most grains are: nothing to wrap
      for (int k = 0; k < model.dimension(); ++k) inside &= row[k] >= -half[k] && row[k] < half[k];
      if (inside) continue;
      Vector3 x = assembly.position(model, g);
      moved[g] = wrap(assembly.cell, x);
      for (int k = 0; k < model.dimension(); ++k) row[k] = x[k];
    }
  });
  for (Contact& c : carried) {
    for (int k = 0; k < 3; ++k) c.image[k] += moved[c.i][k] - moved[c.j][k];
    turn_round_if_needed(model, c);
  }
  sort_by_key(carried);
  follow_wrapping(moved, model.dimension(), interactions);
  follow_wrapping(moved, assembly);
  fill(model, assembly.state.list.skin, carried, interactions, Lost::dropped, assembly);
  assembly.state.list.built = true;
  assembly.state.list.lattice = assembly.cell.lattice;
  assembly.state.list.travel = 0;
  assembly.state.list.steps = 0;
  assembly.state.list.positions.resize(model.size());
  for (std::size_t g = 0; g < model.size(); ++g) assembly.state.list.positions[g] = listed_place(model, assembly, g);
  if (moves_as_body(model.shape)) {
    assembly.state.list.orientations.resize(model.size());
    for (std::size_t g = 0; g < model.size(); ++g)
      assembly.state.list.orientations[g] = noted_turn(assembly.rows.data() + g * std::size_t(model.row_length()));
  }
  ++assembly.state.list.builds;
  return reduction;
}

}  // namespace rvelab
