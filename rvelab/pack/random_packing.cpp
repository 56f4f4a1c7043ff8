#include "rvelab/pack/random_packing.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "rvelab/error.hpp"
#include "rvelab/solver/rve.hpp"

namespace rvelab {

namespace {

/// SplitMix64 (Steele, Lea and Flood 2014): own generator, so that every standard library packs the same grains.
class Uniform {
 public:
  explicit Uniform(std::uint64_t seed) : state_(seed) {}
  double operator()() {
    state_ += 0x9e3779b97f4a7c15ULL;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return double((z ^ (z >> 31)) >> 11) * 0x1.0p-53;
  }

 private:
  std::uint64_t state_;
};

Specimen loose_grains(const PackingRecipe& r) {
  const int d = dimension_of(r.shape);
  Uniform uniform(r.seed);
  std::size_t side = 1;
  while ((d == 2 ? side * side : side * side * side) < r.grains) ++side;
  const double spacing = 2.02 * r.largest_radius, edge = spacing * double(side);
  Specimen s;
  s.shape = r.shape;
  s.cell = cubic_cell(d, d == 2 ? edge * edge * r.thickness : edge * edge * edge, r.thickness);
  s.materials = {r.material};
  s.materials[0].friction = r.preparation_friction;
  s.materials[0].rolling_friction = 0;
  s.contact = r.contact;
  // Sites of the grid in random order, so that sizes mix.
  std::vector<std::size_t> site(d == 2 ? side * side : side * side * side);
  std::iota(site.begin(), site.end(), std::size_t{0});
  for (std::size_t k = site.size() - 1; k > 0; --k) std::swap(site[k], site[std::size_t(uniform() * double(k + 1))]);
  for (std::size_t g = 0; g < r.grains; ++g) {
    const double radius = r.smallest_radius + (r.largest_radius - r.smallest_radius) * uniform();
    const std::size_t at[3] = {site[g] % side, site[g] / side % side, site[g] / (side * side)};
    Vector3 x = Vector3::Zero();
    for (int k = 0; k < d; ++k)
      x[k] = (double(at[k]) + 0.5) * spacing - 0.5 * edge + (uniform() - 0.5) * (spacing - 2 * radius);
    s.grains.id.push_back(std::int64_t(g));
    s.grains.radius.push_back(radius);
    s.grains.material.push_back(0);
    s.grains.position.push_back(x);
    s.grains.velocity.push_back(Vector3::Zero());
    s.grains.spin.push_back(Vector3::Zero());
  }
  return s;
}

double pressure_of(const Matrix3& stress, int d) {
  double sum = 0;
  for (int k = 0; k < d; ++k) sum -= stress(k, k) / d;
  return sum;
}

/// All normal stresses to -p, no shear strain.
MixedTarget isotropic_target(const Matrix3& stress, int d, double p) {
  MixedTarget target;
  for (int k = 0; k < d; ++k) {
    MixedTarget::Row row;
    row.stress(k, k) = 1;
    row.value = -p - stress(k, k);
    row.scale = p;
    target.rows.push_back(row);
  }
  for (int a = 0; a < d; ++a)
    for (int b = a + 1; b < d; ++b) {
      MixedTarget::Row row;
      row.strain(a, b) = row.strain(b, a) = 0.5;
      target.rows.push_back(row);
    }
  target.wait = 2000;
  return target;
}

}  // namespace

Specimen random_packing(const PackingRecipe& r) {
  if (r.grains == 0 || !(r.smallest_radius > 0) || !(r.largest_radius >= r.smallest_radius) || !(r.pressure > 0))
    throw InputError(
        "packing: at least one grain, 0 < smallest radius <= largest radius and a pressure > 0 are needed");
  // While the grains are still finding each other the pace is fixed: no network is there whose balance could steer it.
  Specimen loose = loose_grains(r);
  loose.solver.fixed_substeps = 50;
  // Nor does a bound on overlaps say anything yet: one light grain caught between two others is pushed out again.
  loose.solver.max_overlap_ratio = 1e3;
  Rve rve(loose);
  const int d = rve.cell().dimension;
  Matrix3 squeeze = Matrix3::Zero();
  for (int k = 0; k < d; ++k) squeeze(k, k) = -1e-3;
  for (int round = 0; pressure_of(rve.apply(squeeze, 0).stress, d) < 0.1 * r.pressure; ++round)
    if (round == 1000) throw IncrementFailed("packing: no pressure after 1000 compressions; check radii and stiffness");
  Specimen jammed = rve.specimen();
  jammed.solver = SolverOptions{};
  rve = Rve(jammed);
  const auto far_off = [&] {
    const Matrix3 stress = rve.stress();
    double worst = 0;
    for (int k = 0; k < d; ++k) worst = std::max(worst, std::abs(stress(k, k) + r.pressure));
    return worst > 0.01 * r.pressure;
  };
  for (int round = 0; round < 20; ++round) {
    rve.apply(isotropic_target(rve.stress(), d, r.pressure), 0);
    if (rve.relax(1e-4, 5000).target_held && !far_off()) break;
  }
  rve.set_materials({r.material});
  Specimen packed = rve.specimen();
  packed.state = SolverState{};
  for (auto* v : {&packed.grains.velocity, &packed.grains.spin}) std::fill(v->begin(), v->end(), Vector3::Zero());
  return packed;
}

Specimen repeated(const Specimen& one, const Image& times) {
  const int d = one.cell.dimension;
  for (int k = 0; k < d; ++k)
    if (times[k] < 1) throw InputError("repeated: each count must be at least 1");
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

}  // namespace rvelab
