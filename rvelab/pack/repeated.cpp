#include "rvelab/pack/repeated.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "rvelab/error.hpp"

namespace rvelab::pack {

namespace {

/// Place of a copy of the cell among all.
std::int32_t copy_index(const int (&place)[3], const Image& counts) {
  return (place[2] * counts[1] + place[1]) * counts[0] + place[0];
}

/// Pairs of grains of a cell of n, in each of its copies; `turn`: for j as i and i as j.
template <class Item, class Turn>
std::vector<Item> repeated_pairs(const std::vector<Item>& items, const Image& counts, std::int32_t n,
                                 const Turn& turn) {
  std::vector<Item> all;
  for (int z = 0; z < counts[2]; ++z)
    for (int y = 0; y < counts[1]; ++y)
      for (int x = 0; x < counts[0]; ++x)
        for (const Item& item : items) {
          int place[3] = {x + item.image[0], y + item.image[1], z + item.image[2]};
          Item copy = item;
          for (std::size_t k = 0; k < 3; ++k) {
            copy.image[k] = place[k] >= 0 ? place[k] / counts[k] : -((counts[k] - 1 - place[k]) / counts[k]);
            place[k] -= copy.image[k] * counts[k];
          }
          copy.i = copy_index({x, y, z}, counts) * n + item.i;
          copy.j = copy_index(place, counts) * n + item.j;
          if (copy.i > copy.j) {
            std::swap(copy.i, copy.j);
            for (int& m : copy.image) m = -m;
            turn(copy);
          }
          all.push_back(copy);
        }
  std::sort(all.begin(), all.end(), [](const Item& a, const Item& b) { return pair_of(a) < pair_of(b); });
  return all;
}

/// The same with the members of each body beside its centre, not on another side of the cell.
Specimen with_whole_bodies(Specimen s) {
  std::vector<Image> moved(s.grains.size(), Image{0, 0, 0});
  for (std::size_t b = 0; b < s.bodies.size(); ++b) {
    const std::size_t last = b + 1 < s.bodies.size() ? std::size_t(s.bodies[b + 1].first) : s.grains.size();
    const Matrix3 axes = axes_of(s.bodies[b].orientation);
    for (auto g = std::size_t(s.bodies[b].first); g < last; ++g) {
      const Vector3 away = s.grains.position[g] - s.bodies[b].position - axes * s.members[g].offset;
      const Vector3 periods = s.cell.lattice.triangularView<Eigen::Upper>().solve(away);
      for (int k = 0; k < s.cell.dimension; ++k) moved[g][std::size_t(k)] = int(std::lround(periods[k]));
      s.grains.position[g] -= translation(s.cell, moved[g]);
    }
  }
  for (Contact& c : s.contacts)
    for (std::size_t k = 0; k < 3; ++k) c.image[k] += moved[std::size_t(c.j)][k] - moved[std::size_t(c.i)][k];
  return s;
}

}  // namespace

Specimen repeated(const Specimen& of, const Image& times) {
  const Specimen one = of.bodies.empty() ? of : with_whole_bodies(of);
  const int d = one.cell.dimension;
  for (int k = 0; k < d; ++k)
    if (times[k] < 1)
      throw InputError("repeated: " + std::to_string(times[k]) + " times along " + "xyz"[k] +
                       "; allowed: 1 or more; correct it");
  Specimen all = one;
  all.grains = Grains{};
  all.bodies.clear();
  all.members.clear();
  all.contacts.clear();
  all.state = SolverState{};
  const int nz = d == 3 ? times[2] : 1;
  for (int k = 0; k < d; ++k) all.cell.lattice.col(k) *= times[k];
  const auto n = std::int32_t(one.grains.size());
  for (int z = 0; z < nz; ++z)
    for (int y = 0; y < times[1]; ++y)
      for (int x = 0; x < times[0]; ++x)
        for (Body body : one.bodies) {
          const auto copy = copy_index({x, y, z}, {times[0], times[1], nz});
          body.id = std::int64_t(all.bodies.size());
          body.first += copy * n;
          body.position += translation(one.cell, {x, y, z});
          all.bodies.push_back(body);
        }
  for (int z = 0; z < nz; ++z)
    for (int y = 0; y < times[1]; ++y)
      for (int x = 0; x < times[0]; ++x) {
        all.members.insert(all.members.end(), one.members.begin(), one.members.end());
        for (std::int32_t g = 0; g < n; ++g) {
          all.grains.id.push_back(std::int64_t(copy_index({x, y, z}, {times[0], times[1], nz})) * n + g);
          all.grains.radius.push_back(one.grains.radius[g]);
          all.grains.material.push_back(one.grains.material[g]);
          all.grains.position.push_back(one.grains.position[g] + translation(one.cell, {x, y, z}));
          all.grains.velocity.push_back(one.grains.velocity[g]);
          all.grains.spin.push_back(one.grains.spin[g]);
          if (is_round(one.shape)) continue;
          each_own_column(
              [&](const auto&, auto& to, const auto& from) {
                if (!from.empty()) to.push_back(from[std::size_t(g)]);
              },
              all.grains, one.grains);
          if (keeps_axis(one.shape)) all.grains.orientation.push_back(one.grains.orientation[g]);
        }
      }
  const auto turn_contact = [&](Contact& c) {
    c.rolling_moment = -c.rolling_moment;
    // 2D keeps the component along t, which turns round with the normal.
    if (d == 3) c.tangential_force = -c.tangential_force;
  };
  all.contacts = repeated_pairs(one.contacts, {times[0], times[1], nz}, n, turn_contact);
  each_interaction_law([&](auto, auto law) {
    using Law = decltype(law);
    static_cast<ListOf<Law>&>(all).items =
        repeated_pairs(static_cast<const ListOf<Law>&>(one).items, {times[0], times[1], nz}, n,
                       [&](Interaction<Law>& item) { turn_round<Law>(item, d); });
  });
  return all;
}

}  // namespace rvelab::pack
