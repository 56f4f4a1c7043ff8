#include "rvelab/solver/inertia.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "rvelab/solver/pair_geometry.hpp"

namespace rvelab {

namespace {

/// Stiffnesses of one contact at an overlap.
struct ContactStiffness {
  double normal, tangential, rolling, dashpot;
};

ContactStiffness stiffness_of(const Fixture& f, const PairTable& pairs, std::size_t p, double overlap) {
  const bool needs_root = f.law != KernelLaw::linear || f.damping.dashpot != Dashpot::none;
  const double root = needs_root ? std::sqrt(overlap) : 0;
  const double kr = f.contact.rolling ? pairs.kr[p] : 0.0;
  double cn = 0;
  if (f.damping.dashpot != Dashpot::none) {
    const double power = dashpot_power(f.contact.law, f.damping.dashpot);
    cn = pairs.cn[p] * (power == 0 ? 1.0 : (power == 0.5 ? root : std::sqrt(root)));
  }
  switch (f.law) {
    case KernelLaw::linear:
      return {pairs.kn[p], pairs.kt[p], kr, cn};
    case KernelLaw::hertz_given:
      return {1.5 * pairs.kn[p] * root, pairs.kt[p], kr, cn};
    case KernelLaw::hertz_mindlin:
      return {1.5 * pairs.kn[p] * root, pairs.kt[p] * root, kr * root, cn};
  }
  return {};
}

/// Symmetric 3x3 matrix; the z entries stay zero in the plane.
struct Symmetric {
  double xx = 0, xy = 0, yy = 0, xz = 0, yz = 0, zz = 0;
};

/// Adds along n n + across I.
void add_contact(double along, double across, double nx, double ny, double nz, int dimension, Symmetric& m) {
  m.xx += along * (nx * nx) + across;
  m.xy += along * (nx * ny);
  m.yy += along * (ny * ny) + across;
  if (dimension == 2) return;
  m.xz += along * (nx * nz);
  m.yz += along * (ny * nz);
  m.zz += along * (nz * nz) + across;
}

/// Largest eigenvalue of a symmetric positive matrix, from above: exact in the plane, (tr M^8)^(1/8) in space, at most
/// 3^(1/8) = 1.15 too much. Nothing that depends on the axes (row sums) will do: the scaled masses, and with them the
/// path, must not know how the specimen is turned. An eigenvalue solver took a tenth of the stepping time.
double largest_eigenvalue(const Symmetric& m, int dimension) {
  if (dimension == 2) {
    const double half = 0.5 * (m.xx + m.yy), difference = 0.5 * (m.xx - m.yy);
    return half + std::sqrt(difference * difference + m.xy * m.xy);
  }
  const double scale = m.xx + m.yy + m.zz;
  if (!(scale > 0)) return 0;
  Matrix3 one;
  one << m.xx, m.xy, m.xz, m.xy, m.yy, m.yz, m.xz, m.yz, m.zz;
  one /= scale;
  const Matrix3 two = one * one, four = two * two;
  return scale * std::sqrt(std::sqrt(four.norm()));
}

double median(std::vector<double>& values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Two of the largest grains as a pair table of one, and their radius.
std::pair<PairTable, double> typical_pair(const Fixture& f) {
  const auto g = std::size_t(std::max_element(f.radius.begin(), f.radius.end()) - f.radius.begin());
  const Material& m = f.materials[f.material[g]];
  const PairParameters q = mix(f.contact, f.damping, m, f.radius[g], f.mass[g], m, f.radius[g], f.mass[g]);
  PairTable one;
  one.kn = {q.kn};
  one.kt = {q.kt};
  one.kr = {q.kr};
  one.cn = {q.cn};
  return {std::move(one), f.radius[g]};
}

}  // namespace

double typical_normal_force(const Fixture& f, double overlap) {
  const double stiffness = stiffness_of(f, typical_pair(f).first, 0, overlap).normal;
  return (f.law == KernelLaw::linear ? stiffness : stiffness / 1.5) * overlap;
}

namespace {

template <int D>
RowSums sums_over_pairs(const Fixture& f, const Assembly& a) {
  const std::size_t n = f.size();
  RowSums sums;
  std::vector<Symmetric> rows(n);
  sums.rotation.assign(n, 0.0);
  sums.translation.assign(n, 0.0);
  const bool dashpot = f.damping.dashpot != Dashpot::none;
  if (dashpot) sums.dashpot.assign(n, 0.0);
  std::vector<double> translations, rotations;
  // A listed pair may touch within the steps to come: a grain that is ready for the stiffest of them stays stable even
  // where that contact is ten thousand times stiffer than those it has.
  std::vector<double> stiffest(n, 0.0), stiffest_turn(n, 0.0);
  const Branches<D> branch(a);
  for (const std::int32_t place : a.pairs.order) {
    const auto p = std::size_t(place);
    const auto i = a.pairs.i[p], j = a.pairs.j[p];
    const Branch b = branch(p);
    const double length = b.length();
    const double overlap = (f.radius[i] + f.radius[j]) - length;
    // Barely touching Hertz contacts are soft but will not stay so: floors see them at a quarter of p0's overlap.
    const ContactStiffness firm = stiffness_of(f, a.pairs, p, std::max(overlap, 0.25 * a.state.reference_overlap));
    const double firm_translation = std::max(2 * firm.normal, 4 * firm.tangential);
    for (const auto g : {i, j}) {
      stiffest[g] = std::max(stiffest[g], firm_translation);
      stiffest_turn[g] = std::max(stiffest_turn[g], 4 * firm.tangential * f.radius[g] * f.radius[g] + 2 * firm.rolling);
    }
    if (!(overlap > 0)) continue;
    const ContactStiffness k = stiffness_of(f, a.pairs, p, overlap);
    const double normal_force = f.law == KernelLaw::linear ? k.normal * overlap : k.normal * overlap / 1.5;
    // The force turning with the branch (initial stress) adds f_n / length to the tangential stiffness at most.
    const double kt = k.tangential + 0.5 * normal_force / length;
    const double nx = b.x / length, ny = b.y / length, nz = b.z / length, along = 2 * k.normal - 4 * kt;
    add_contact(along, 4 * kt, nx, ny, nz, D, rows[i]);
    add_contact(along, 4 * kt, nx, ny, nz, D, rows[j]);
    const double ri = f.radius[i], rj = f.radius[j];
    const double turn_i = 4 * k.tangential * ri * ri + 2 * k.rolling;
    const double turn_j = 4 * k.tangential * rj * rj + 2 * k.rolling;
    sums.rotation[i] += turn_i;
    sums.rotation[j] += turn_j;
    if (dashpot) {
      const double c = 2 * k.dashpot * std::max(1.0, 2 * f.damping.tangential_ratio);
      sums.dashpot[i] += c;
      sums.dashpot[j] += c;
    }
    translations.push_back(firm_translation);
    rotations.push_back(4 * firm.tangential + 2 * firm.rolling / std::min(ri * ri, rj * rj));
  }
  for (std::size_t g = 0; g < n; ++g) {
    sums.translation[g] = std::max(largest_eigenvalue(rows[g], D), stiffest[g]);
    sums.rotation[g] = std::max(sums.rotation[g], stiffest_turn[g]);
  }
  if (translations.empty()) {
    // Nothing touches: what two contacts of typical grains would have at a thousandth of a radius of overlap.
    const auto [one, radius] = typical_pair(f);
    const ContactStiffness k = stiffness_of(f, one, 0, 1e-3 * radius);
    translations.push_back(std::max(2 * k.normal, 4 * k.tangential));
    rotations.push_back(4 * k.tangential + 2 * k.rolling / (radius * radius));
  }
  sums.floor_translation = 2 * median(translations);
  sums.floor_rotation = 2 * median(rotations);
  // Without tangential and rolling stiffness nothing turns the grains; any inertia serves.
  if (sums.floor_rotation == 0) sums.floor_rotation = sums.floor_translation;
  return sums;
}

}  // namespace

RowSums row_sums(const Fixture& f, const Assembly& a) {
  return f.shape == Shape::disc ? sums_over_pairs<2>(f, a) : sums_over_pairs<3>(f, a);
}

double critical_step(const Fixture& f, const RowSums& sums) {
  double smallest = std::numeric_limits<double>::infinity();
  for (std::size_t g = 0; g < f.size(); ++g) {
    const double by_translation = sums.translation[g] / f.mass[g], by_rotation = sums.rotation[g] / f.inertia[g];
    const double omega = std::sqrt(std::max(by_translation, by_rotation));
    if (!(omega > 0)) continue;
    double step = 2 / omega;
    if (!sums.dashpot.empty()) {
      const double rate =
          std::max(sums.dashpot[g] / f.mass[g], sums.dashpot[g] * f.radius[g] * f.radius[g] / f.inertia[g]);
      const double zeta = rate / (2 * omega);
      step *= std::sqrt(1 + zeta * zeta) - zeta;
    }
    smallest = std::min(smallest, step);
  }
  return smallest;
}

RowSums with_floor(RowSums sums, const Fixture& f) {
  for (std::size_t g = 0; g < f.size(); ++g) {
    sums.translation[g] = std::max(sums.translation[g], sums.floor_translation);
    sums.rotation[g] = std::max(sums.rotation[g], sums.floor_rotation * f.radius[g] * f.radius[g]);
  }
  return sums;
}

namespace {

double scaled(double row_sum, double floor, double factor) { return std::max(row_sum, floor) / (4 * factor * factor); }

}  // namespace

void scale_inertia(const Fixture& f, const RowSums& sums, Assembly& a) {
  const double factor = f.options.time_step_factor;
  for (std::size_t g = 0; g < f.size(); ++g) {
    a.mass[g] = scaled(sums.translation[g], sums.floor_translation, factor);
    const double inertia = scaled(sums.rotation[g], sums.floor_rotation * f.radius[g] * f.radius[g], factor);
    a.inverse_mass[g] = 1 / a.mass[g];
    a.inverse_inertia[g] = 1 / inertia;
  }
}

bool inertia_outgrown(const Fixture& f, const RowSums& sums, const Assembly& a) {
  // omega dt = 2 factor when the masses were set; up to 2 it stays stable. Nine tenths of that is the alarm.
  const double margin = 4 * 0.81;
  for (std::size_t g = 0; g < f.size(); ++g)
    if (sums.translation[g] * a.inverse_mass[g] > margin || sums.rotation[g] * a.inverse_inertia[g] > margin)
      return true;
  return false;
}

void use_physical_inertia(const Fixture& f, Assembly& a) {
  for (std::size_t g = 0; g < f.size(); ++g) {
    a.mass[g] = f.mass[g];
    a.inverse_mass[g] = 1 / f.mass[g];
    a.inverse_inertia[g] = 1 / f.inertia[g];
  }
}

}  // namespace rvelab
