#include "rvelab/pack/repeated.hpp"

#include <algorithm>
#include <tuple>

#include "rvelab/error.hpp"

namespace rvelab::pack {

Specimen repeated(const Specimen& one, const Image& times) {
  const int d = one.cell.dimension;
  for (int k = 0; k < d; ++k)
    if (times[k] < 1)
      throw InputError("repeated: " + std::to_string(times[k]) + " times along " + "xyz"[k] +
                       "; allowed: 1 or more; correct it");
  Specimen all = one;
  all.grains = Grains{};
  all.contacts.clear();
  all.state = SolverState{};
  const int nz = d == 3 ? times[2] : 1;
  for (int k = 0; k < d; ++k) all.cell.lattice.col(k) *= times[k];
  const auto n = std::int32_t(one.grains.size());
  const auto copy_index = [&](int x, int y, int z) { return (z * times[1] + y) * times[0] + x; };
  for (int z = 0; z < nz; ++z)
    for (int y = 0; y < times[1]; ++y)
      for (int x = 0; x < times[0]; ++x)
        for (std::int32_t g = 0; g < n; ++g) {
          all.grains.id.push_back(std::int64_t(copy_index(x, y, z)) * n + g);
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
          all.grains.orientation.push_back(one.grains.orientation[g]);
        }
  for (int z = 0; z < nz; ++z)
    for (int y = 0; y < times[1]; ++y)
      for (int x = 0; x < times[0]; ++x)
        for (const Contact& c : one.contacts) {
          const int counts[3] = {times[0], times[1], nz};
          int place[3] = {x + c.image[0], y + c.image[1], z + c.image[2]};
          Contact copy = c;
          for (int k = 0; k < 3; ++k) {
            copy.image[k] = place[k] >= 0 ? place[k] / counts[k] : -((counts[k] - 1 - place[k]) / counts[k]);
            place[k] -= copy.image[k] * counts[k];
          }
          copy.i = copy_index(x, y, z) * n + c.i;
          copy.j = copy_index(place[0], place[1], place[2]) * n + c.j;
          if (copy.i > copy.j) {
            std::swap(copy.i, copy.j);
            for (int& m : copy.image) m = -m;
            copy.rolling_moment = -copy.rolling_moment;
            // 2D keeps the component along t, which turns round with the normal.
            if (d == 3) copy.tangential_force = -copy.tangential_force;
          }
          all.contacts.push_back(copy);
        }
  std::sort(all.contacts.begin(), all.contacts.end(), [](const Contact& a, const Contact& b) {
    return std::tie(a.i, a.j, a.image) < std::tie(b.i, b.j, b.image);
  });
  return all;
}

}  // namespace rvelab::pack
