#include "rvelab/solver/assembly.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <sstream>

#include "rvelab/error.hpp"
#include "rvelab/solver/gather_table.hpp"
#include "rvelab/solver/memory_order.hpp"
#include "rvelab/solver/sweep.hpp"

namespace rvelab {

namespace {

[[noreturn]] void refuse(const std::string& what) { throw InputError(what); }

void check_grains(const Specimen& s) {
  const Grains& g = s.grains;
  const std::size_t n = g.size();
  if (n == 0) refuse("specimen: 0 grains; at least 1 is needed");
  if (n > 100'000'000) refuse("specimen: " + std::to_string(n) + " grains; at most 100000000 fit one cell");
  if (g.radius.size() != n || g.material.size() != n || g.position.size() != n || g.velocity.size() != n ||
      g.spin.size() != n)
    refuse("specimen: the grain arrays differ in length; each needs " + std::to_string(n) + " entries");
  const std::size_t listed = s.state.list_positions.size();
  if (listed != 0 && listed != n)
    refuse("specimen: the state has positions of " + std::to_string(listed) +
           " grains for the neighbour list; it needs " + std::to_string(n) + ", or none");
  for (std::size_t k = 0; k < n; ++k) {
    const std::string who = "grain " + std::to_string(g.id[k]) + ": ";
    if (k > 0 && g.id[k] <= g.id[k - 1]) refuse(who + "ids must ascend; sort the grains by id, each id once");
    if (!(g.radius[k] > 0) || !std::isfinite(g.radius[k])) {
      std::ostringstream text;
      text << who << "radius " << g.radius[k] << " m; it must be > 0 and finite";
      refuse(text.str());
    }
    if (g.material[k] < 0 || std::size_t(g.material[k]) >= s.materials.size())
      refuse(who + "material " + std::to_string(g.material[k]) + "; there are " + std::to_string(s.materials.size()));
    if (!g.position[k].allFinite() || !g.velocity[k].allFinite() || !g.spin[k].allFinite())
      refuse(who + "a position, velocity or spin is not finite");
  }
}

void check_cell(const Specimen& s) {
  const Matrix3& l = s.cell.lattice;
  if (s.cell.dimension != dimension_of(s.shape))
    refuse("specimen: the cell has dimension " + std::to_string(s.cell.dimension) + ", the grains " +
           std::to_string(dimension_of(s.shape)));
  if (!l.allFinite() || !(l(0, 0) > 0) || !(l(1, 1) > 0) || !(l(2, 2) > 0) || l(1, 0) != 0 || l(2, 0) != 0 ||
      l(2, 1) != 0)
    refuse(
        "specimen: the lattice must be upper triangular with a positive diagonal; turn cell and grains into that "
        "frame first");
  const double from_orthogonal = (s.cell.rotation.transpose() * s.cell.rotation - Matrix3::Identity()).norm();
  if (!(from_orthogonal < 1e-8) || !(s.cell.rotation.determinant() > 0))
    refuse("specimen: the rotation of the cell frame must be orthogonal with determinant +1");
}

void check_contacts(const Specimen& s) {
  const std::size_t n = s.grains.size();
  for (const Contact& c : s.contacts) {
    if (c.i < 0 || c.j < c.i || std::size_t(c.j) >= n)
      refuse("specimen: contact of grains " + std::to_string(c.i) + " and " + std::to_string(c.j) +
             "; indices must be 0 <= i <= j < " + std::to_string(n));
    if (!c.tangential_force.allFinite() || !c.rolling_moment.allFinite() || !std::isfinite(c.last_root_overlap))
      refuse("specimen: contact of grains " + std::to_string(s.grains.id[std::size_t(c.i)]) + " and " +
             std::to_string(s.grains.id[std::size_t(c.j)]) + ": its history is not finite");
  }
}

void check_options(const SolverOptions& o) {
  const auto expect = [](bool allowed, const char* key, double value, const char* range) {
    if (allowed && std::isfinite(value)) return;
    std::ostringstream text;
    text << "solver." << key << " = " << value << " is out of range; allowed: " << range;
    refuse(text.str());
  };
  expect(o.skin > 0, "skin", o.skin, "> 0");
  expect(o.time_step_factor > 0 && o.time_step_factor < 1, "time_step_factor", o.time_step_factor,
         "above 0 to below 1");
  expect(o.fixed_time_step >= 0, "fixed_time_step_s", o.fixed_time_step, ">= 0 s");
  expect(o.target_unbalanced > 0, "target_unbalanced", o.target_unbalanced, "> 0");
  expect(o.fixed_substeps >= 0, "fixed_substeps", double(o.fixed_substeps), ">= 0");
  expect(o.max_substeps > 0, "max_substeps", double(o.max_substeps), "> 0");
  expect(o.min_height >= 0, "min_height_m", o.min_height, ">= 0 m");
  expect(o.max_overlap_ratio > 0, "max_overlap_ratio", o.max_overlap_ratio, "> 0");
}

KernelLaw kernel_law(Law law) {
  switch (law) {
    case Law::linear:
    case Law::linear_given:
      return KernelLaw::linear;
    case Law::hertz_given:
      return KernelLaw::hertz_given;
    case Law::hertz_mindlin:
      return KernelLaw::hertz_mindlin;
  }
  return KernelLaw::linear;
}

/// A stored contact on its way from one list to the next.
struct Carried {
  ListedPair key;
  Vector3 tangential, moment;
  double root_overlap;
};

void store(const Fixture& f, PairTable& pairs, std::size_t p, const Carried& c) {
  if (f.shape == Shape::disc) {
    pairs.tangential[0][p] = c.tangential[0];
    if (f.contact.rolling) pairs.moment[0][p] = c.moment[2];
  } else {
    for (int k = 0; k < 3; ++k) pairs.tangential[k][p] = c.tangential[k];
    if (f.contact.rolling)
      for (int k = 0; k < 3; ++k) pairs.moment[k][p] = c.moment[k];
  }
  if (f.law == KernelLaw::hertz_mindlin) pairs.root_overlap[p] = c.root_overlap;
}

/// History of the pairs that have any, in their order. In 2D `tangential[0]` is the component along t.
std::vector<Carried> history_of(const Fixture& f, const PairTable& pairs) {
  std::vector<std::vector<Carried>> found(pieces_in(pairs.listed));
  const auto look_at = [&](std::size_t p, std::vector<Carried>& here) {
    Carried c{{pairs.i[p], pairs.j[p], pairs.image[p]}, Vector3::Zero(), Vector3::Zero(), 0};
    for (int k = 0; k < f.tangential_components(); ++k) c.tangential[k] = pairs.tangential[k][p];
    if (f.contact.rolling) {
      if (f.shape == Shape::disc)
        c.moment[2] = pairs.moment[0][p];
      else
        for (int k = 0; k < 3; ++k) c.moment[k] = pairs.moment[k][p];
    }
    if (f.law == KernelLaw::hertz_mindlin) c.root_overlap = pairs.root_overlap[p];
    if (!c.tangential.isZero(0) || !c.moment.isZero(0) || c.root_overlap != 0) here.push_back(c);
  };
  in_pieces(pairs.listed, f.sharing(), [&](std::size_t piece, std::size_t first, std::size_t last) {
    found[piece].reserve(last - first);
    for (std::size_t k = first; k < last; ++k) look_at(std::size_t(pairs.order[k]), found[piece]);
  });
  if (found.size() == 1) return std::move(found.front());
  std::vector<Carried> all;
  for (const std::vector<Carried>& here : found) all.insert(all.end(), here.begin(), here.end());
  return all;
}

/// What becomes of a history whose pair is not listed: in a run the grains parted in the sub-step just made, and their
/// force ends with it as that of every contact that opens; in a specimen it is a mistake.
enum class Lost { dropped, refused };

bool touches(const Fixture& f, const Assembly& a, const ListedPair& pair) {
  const double* xi = a.rows.data() + std::size_t(pair.i) * f.row_length();
  const double* xj = a.rows.data() + std::size_t(pair.j) * f.row_length();
  const UpperTriangle l = upper_triangle(a.cell.lattice);
  const Image& n = pair.image;
  const double x = xj[0] - xi[0] + l.xx * n[0] + l.xy * n[1] + l.xz * n[2];
  const double y = xj[1] - xi[1] + l.yy * n[1] + l.yz * n[2];
  const double z = f.shape == Shape::disc ? 0 : xj[2] - xi[2] + l.zz * n[2];
  const double radii = f.radius[std::size_t(pair.i)] + f.radius[std::size_t(pair.j)];
  return x * x + y * y + z * z < radii * radii;
}

/// Places of the pairs of a new list in memory: first those that touch or have a history. The ledger's kernel adds up
/// what all pairs lose as they lie, so with it they lie in order.
void arrange(const Fixture& f, const Assembly& a, const std::vector<ListedPair>& listed,
             const std::vector<const Carried*>& histories, PairTable& pairs) {
  const std::size_t n = listed.size();
  std::vector<std::uint8_t> near(n);
  in_pieces(n, f.sharing(), [&](std::size_t, std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k)
      near[k] = f.options.ledger || histories[k] != nullptr || touches(f, a, listed[k]);
  });
  std::int32_t here = 0, beyond = std::int32_t(std::count(near.begin(), near.end(), 1));
  pairs.near = (std::size_t(beyond) + 7) / 8 * 8;
  pairs.order.resize(n);
  for (std::size_t k = 0; k < n; ++k) pairs.order[k] = near[k] ? here++ : beyond++;
}

/// Makes the arrays of a new list and fills in the carried history, which is sorted by key.
void fill(const Fixture& f, const std::vector<ListedPair>& listed, const std::vector<Carried>& carried, Lost lost,
          Assembly& a) {
  const std::size_t n = listed.size(), padded = padded_to_lanes(n);
  std::vector<const Carried*> histories(n, nullptr);
  std::size_t k = 0;
  for (const Carried& c : carried) {
    while (k < n && listed[k] < c.key) ++k;
    if (k < n && listed[k] == c.key)
      histories[k] = &c;
    else if (lost == Lost::refused)
      throw InputError("specimen: grains " + std::to_string(f.id[c.key.i]) + " and " + std::to_string(f.id[c.key.j]) +
                       " have a contact history but lie apart by more than the skin: the history does not belong to "
                       "the positions");
  }

  PairTable& pairs = a.pairs;
  pairs.listed = n;
  arrange(f, a, listed, histories, pairs);
  const auto outside = std::int32_t(f.size());  // a padding grain: no extent, no mass
  pairs.i.assign(padded, outside);
  pairs.j.assign(padded, outside);
  pairs.image.assign(padded, Image{1, 0, 0});
  for (int component = 0; component < f.tangential_components(); ++component) {
    pairs.tangential[component].assign(padded, 0.0);
    if (f.contact.rolling) pairs.moment[component].assign(padded, 0.0);
  }
  if (f.law == KernelLaw::hertz_mindlin) pairs.root_overlap.assign(padded, 0.0);
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
  fill_gather_table(padded_to_lanes(f.size()), force_row_length(f.shape), pairs);
}

/// The key of a pair after images changed; a grain's own image is kept pointing forward, forces turning round with it.
void turn_round_if_needed(const Fixture& f, Carried& c) {
  if (c.key.i != c.key.j || points_forward(c.key.image)) return;
  for (int& n : c.key.image) n = -n;
  c.moment = -c.moment;
  // In 2D the component along t = (-n_y, n_x) keeps its sign: force and t both turn.
  if (f.shape == Shape::sphere) c.tangential = -c.tangential;
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

void rotate_rows(const Fixture& f, const Matrix3& turn, Buffer& rows) {
  for (std::size_t g = 0; g < f.size(); ++g) {
    double* row = rows.data() + g * f.row_length();
    const auto rotate = [&](double* v) {
      if (f.shape == Shape::disc) {
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
    if (f.shape == Shape::sphere) rotate(row + 8);
  }
}

}  // namespace

Vector3 Assembly::position(const Fixture& f, std::size_t g) const {
  const double* row = rows.data() + g * f.row_length();
  return {row[0], row[1], f.shape == Shape::disc ? 0.0 : row[2]};
}

Vector3 Assembly::velocity(const Fixture& f, std::size_t g) const {
  const double* v = rows.data() + g * f.row_length() + f.velocity_offset();
  return {v[0], v[1], f.shape == Shape::disc ? 0.0 : v[2]};
}

Vector3 Assembly::spin(const Fixture& f, std::size_t g) const {
  const double* row = rows.data() + g * f.row_length();
  return f.shape == Shape::disc ? Vector3(0, 0, row[4]) : Vector3(row[8], row[9], row[10]);
}

void Assembly::set_velocity(const Fixture& f, std::size_t g, const Vector3& v, const Vector3& w) {
  double* row = rows.data() + g * f.row_length();
  for (int k = 0; k < f.dimension(); ++k) row[f.velocity_offset() + k] = v[k];
  if (f.shape == Shape::disc) {
    row[4] = w[2];
    row[5] = row[6] * w[2];
  } else {
    for (int k = 0; k < 3; ++k) row[8 + k] = w[k];
  }
}

void open(const Specimen& specimen, Fixture& f, Assembly& a) {
  check(specimen.contact, specimen.damping, specimen.materials);
  check_options(specimen.solver);
  check_cell(specimen);
  check_grains(specimen);
  check_contacts(specimen);
  const std::size_t n = specimen.grains.size(), padded = padded_to_lanes(n);
  std::vector<std::int32_t> order = specimen.state.memory_order;
  if (!order.empty() && !is_permutation(order, n))
    refuse("specimen: the memory order of the state is no permutation of the " + std::to_string(n) +
           " grains; leave it empty");
  if (order.empty() && n >= least_ordered_grains) order = space_filling_order(specimen.cell, specimen.grains.position);
  const Specimen arranged = order.empty() ? Specimen() : in_memory_order(specimen, order);
  const Specimen& s = order.empty() ? specimen : arranged;
  f.shape = s.shape;
  f.materials = s.materials;
  f.contact = s.contact;
  f.damping = s.damping;
  f.options = s.solver;
  f.id = s.grains.id;
  f.material = s.grains.material;
  f.radius = s.grains.radius;
  f.law = kernel_law(s.contact.law);
  f.kernels = kernels_for({f.shape, f.law, f.contact.rolling, f.contact.slip, f.damping.dashpot != Dashpot::none});
  f.largest_radius = *std::max_element(f.radius.begin(), f.radius.end());
  f.smallest_radius = *std::min_element(f.radius.begin(), f.radius.end());
  f.mean_radius = std::accumulate(f.radius.begin(), f.radius.end(), 0.0) / double(n);
  f.largest_skin = f.options.skin * f.mean_radius;
  f.min_height = f.options.min_height > 0 ? f.options.min_height : 2 * f.largest_radius;
  std::vector<double> mass(n), inertia(n);
  a.cell = s.cell;
  a.state = s.state;
  a.state.memory_order = std::move(order);
  if (!(a.state.list_skin > 0 && a.state.list_skin < f.largest_skin)) a.state.list_skin = f.largest_skin;
  a.rows.assign(padded * f.row_length(), 0.0);
  for (Buffer* b : {&a.mass, &a.inverse_mass, &a.inverse_inertia}) b->assign(padded, 0.0);
  for (std::size_t g = 0; g < n; ++g) {
    const Material& m = f.materials[f.material[g]];
    mass[g] = m.density * grain_volume(f.shape, f.radius[g], s.cell.lattice(2, 2));
    inertia[g] = moment_of_inertia(f.shape, mass[g], f.radius[g]);
    double* row = a.rows.data() + g * f.row_length();
    for (int k = 0; k < f.dimension(); ++k) row[k] = s.grains.position[g][k];
    row[f.shape == Shape::disc ? 6 : 3] = f.radius[g];
    if (f.shape == Shape::sphere) row[11] = f.radius[g];
    a.set_velocity(f, g, s.grains.velocity[g], s.grains.spin[g]);
  }
  f.mass = std::move(mass);
  f.inertia = std::move(inertia);

  std::vector<Carried> carried;
  for (const Contact& c : s.contacts)
    carried.push_back({{c.i, c.j, c.image}, c.tangential_force, c.rolling_moment, c.last_root_overlap});
  const auto by_key = [](const Carried& x, const Carried& y) { return x.key < y.key; };
  if (!std::is_sorted(carried.begin(), carried.end(), by_key)) std::sort(carried.begin(), carried.end(), by_key);
  fill(f, list_pairs(a.cell, a.rows.data(), f.row_length(), f.radius, a.state.list_skin), carried, Lost::refused, a);
  if (a.state.has_reference) return;
  try {
    rebuild(f, a);
  } catch (const IncrementFailed& error) {
    refuse(std::string("specimen: ") + error.what());
  }
}

Specimen close(const Fixture& f, const Assembly& a) {
  Specimen s;
  s.shape = f.shape;
  s.cell = a.cell;
  s.materials = f.materials;
  s.contact = f.contact;
  s.damping = f.damping;
  s.solver = f.options;
  s.state = a.state;
  s.grains.id = f.id;
  s.grains.radius = f.radius;
  s.grains.material = f.material;
  for (std::size_t g = 0; g < f.size(); ++g) {
    s.grains.position.push_back(a.position(f, g));
    s.grains.velocity.push_back(a.velocity(f, g));
    s.grains.spin.push_back(a.spin(f, g));
  }
  for (const Carried& c : history_of(f, a.pairs))
    s.contacts.push_back({c.key.i, c.key.j, c.key.image, c.tangential, c.moment, c.root_overlap});
  return in_id_order(std::move(s), a.state.memory_order);
}

void check_height(const Fixture& f, const Cell& cell) {
  const double shortest = shortest_vector(cell);
  if (shortest < f.min_height) {
    std::ostringstream text;
    text << "cell too thin: the shortest lattice vector is " << shortest << " m, the limit solver.min_height_m is "
         << f.min_height << " m; deform less, start from an oriented cell, or use a larger specimen";
    throw IncrementFailed(text.str());
  }
}

namespace {

/// Sub-steps after which a list is too old for its skin, or too young. A build costs ten sub-steps, so it takes 2 to 5
/// % of the time; a listed pair that does not touch costs a third of a contact. Twice as old at most: 1.5 % fewer
/// instructions for discs at I = 1e-3, none for spheres.
constexpr std::int64_t old_list = 500, young_list = 200;
constexpr double smallest_skin = 0.01;  ///< mean radii

/// The skin of the next list, by counts alone: no clock decides what is computed.
double next_skin(const Fixture& f, const SolverState& state) {
  double skin = state.list_skin;
  if (state.list_steps >= old_list) skin *= 0.7;
  if (state.list_steps < young_list) skin *= 1.4;
  return std::clamp(skin, std::min(smallest_skin * f.mean_radius, f.largest_skin), f.largest_skin);
}

}  // namespace

Reduction rebuild(const Fixture& f, Assembly& a) {
  std::vector<Carried> carried = history_of(f, a.pairs);
  if (a.state.has_reference) a.state.list_skin = next_skin(f, a.state);
  const Reduction reduction = reduced(a.cell);
  if (reduction.changed) {
    apply_reduction(a.cell, reduction);
    const Matrix3 back = reduction.rotation.transpose();
    rotate_rows(f, back, a.rows);
    a.state.mean_velocity = back * a.state.mean_velocity;
    a.state.last_rate = without_lower_part(back * a.state.last_rate * reduction.rotation);
    for (Carried& c : carried) {
      const Eigen::Vector3i n =
          reduction.inverse_basis * Eigen::Vector3i(c.key.image[0], c.key.image[1], c.key.image[2]);
      c.key.image = {n[0], n[1], n[2]};
      if (f.shape == Shape::sphere) {
        c.tangential = back * c.tangential;
        c.moment = back * c.moment;
      }
    }
  }
  check_height(f, a.cell);
  std::vector<Image> moved(f.size());
  in_pieces(f.size(), f.sharing(), [&](std::size_t, std::size_t first, std::size_t last) {
    for (std::size_t g = first; g < last; ++g) {
      Vector3 x = a.position(f, g);
      moved[g] = wrap(a.cell, x);
      double* row = a.rows.data() + g * f.row_length();
      for (int k = 0; k < f.dimension(); ++k) row[k] = x[k];
    }
  });
  for (Carried& c : carried) {
    for (int k = 0; k < 3; ++k) c.key.image[k] += moved[c.key.i][k] - moved[c.key.j][k];
    turn_round_if_needed(f, c);
  }
  const auto by_key = [](const Carried& x, const Carried& y) { return x.key < y.key; };
  if (!std::is_sorted(carried.begin(), carried.end(), by_key)) std::sort(carried.begin(), carried.end(), by_key);
  fill(f, list_pairs(a.cell, a.rows.data(), f.row_length(), f.radius, a.state.list_skin, f.sharing()), carried,
       Lost::dropped, a);
  a.state.has_reference = true;
  a.state.list_lattice = a.cell.lattice;
  a.state.list_travel = 0;
  a.state.list_steps = 0;
  a.state.list_positions.resize(f.size());
  for (std::size_t g = 0; g < f.size(); ++g) a.state.list_positions[g] = a.position(f, g);
  ++a.state.list_builds;
  return reduction;
}

namespace {

/// Sum of the two largest displacements of grains since the list was built, beside the affine motion, m.
double measured_displacements(const Fixture& f, const Assembly& a, const Matrix3& f_since) {
  double most = 0, second = 0;
  const UpperTriangle m = upper_triangle(f_since);
  for (std::size_t g = 0; g < f.size(); ++g) {
    const double* x = a.rows.data() + g * f.row_length();
    const Vector3& from = a.state.list_positions[g];
    const double dx = x[0] - (m.xx * from[0] + m.xy * from[1] + m.xz * from[2]);
    const double dy = x[1] - (m.yy * from[1] + m.yz * from[2]);
    const double dz = f.shape == Shape::disc ? 0 : x[2] - m.zz * from[2];
    const double squared = dx * dx + dy * dy + dz * dz;
    second = std::max(second, std::min(squared, most));
    most = std::max(most, squared);
  }
  return std::sqrt(most) + std::sqrt(second);
}

}  // namespace

bool list_is_stale(const Fixture& f, Assembly& a) {
  // A pair beyond reach r_i + r_j + skin when listed is, after the affine map F and two displacements of at most
  // `travel`, still beyond sigma_min(F) reach - 2 |F| travel, with sigma_min >= 1 - |F - I|, |F| <= 1 + |F - I|.
  const Matrix3 f_since = a.cell.lattice * upper_inverse(a.state.list_lattice);
  const double strain = (f_since - Matrix3::Identity()).norm();
  const double reach = 2 * f.largest_radius;
  const double skin = a.state.list_skin, allowed = (1 - strain) * (reach + skin) - reach;
  if (a.state.list_steps >= old_list && next_skin(f, a.state) < skin) return true;
  if (2 * (1 + strain) * a.state.list_travel < allowed) return false;
  if (a.state.list_positions.size() != f.size()) return true;
  // The bound sums the fastest grain of every step; what the grains really moved is a fifth of it (measured: a third of
  // the rebuilds). Looking is worth it while a tenth of the skin is left.
  const double moved = measured_displacements(f, a, f_since);
  if (!(moved < allowed - 0.1 * skin)) return true;
  a.state.list_travel = moved / (2 * (1 + strain));
  return false;
}

PairArrays arrays_of(PairTable& t) {
  PairArrays p;
  p.near = long(t.near);
  p.touched = t.touched.data();
  p.row_i = t.row_i.data();
  p.row_j = t.row_j.data();
  for (int k = 0; k < 3; ++k) {
    p.image[k] = t.image_number[k].data();
    p.tangential[k] = t.tangential[k].data();
    p.moment[k] = t.moment[k].data();
  }
  p.kn = t.kn.data();
  p.kt = t.kt.data();
  p.friction = t.friction.data();
  p.kr = t.kr.data();
  p.moment_cap = t.moment_cap.data();
  p.cn = t.cn.data();
  p.root_overlap = t.root_overlap.data();
  p.radius_i = t.radius_i.data();
  p.radius_j = t.radius_j.data();
  p.force = t.force.data();
  return p;
}

GrainArrays arrays_of(Assembly& a) {
  return {a.rows.data(),
          a.mass.data(),
          a.inverse_mass.data(),
          a.inverse_inertia.data(),
          a.pairs.slot_begin.data(),
          a.pairs.slots.data(),
          a.pairs.tasks.data()};
}

}  // namespace rvelab
