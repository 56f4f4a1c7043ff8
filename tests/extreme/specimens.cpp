#include "tests/extreme/specimens.hpp"

#include <algorithm>
#include <cmath>

#include "rvelab/error.hpp"
#include "rvelab/measure/measures.hpp"

namespace rvelab::test {

Specimen cubic_crystal(int n) {
  const double spacing = 1.99, side = n * spacing;
  std::vector<Vector3> positions;
  positions.reserve(std::size_t(n) * n * n);
  for (int c = 0; c < n; ++c)
    for (int b = 0; b < n; ++b)
      for (int a = 0; a < n; ++a) positions.push_back((Vector3(a, b, c).array() + 0.5 - 0.5 * n) * spacing);
  return specimen_of(cell_of(3, side, side, side), positions, std::vector<double>(positions.size(), 1.0),
                     material(stiffness, 0.5 * stiffness, 0.5));
}

Matrix3 cubic_crystal_stress(const Vector3& strain) {
  const Vector3 spacing = 1.99 * (Vector3::Ones() + strain);
  return Matrix3((-stiffness * (2 - spacing.array()) * spacing.array() / spacing.prod()).matrix().asDiagonal());
}

bool same_in_cell_frame(const Specimen& a, const Specimen& b) {
  const auto same = [](const Contact& x, const Contact& y) {
    return x.i == y.i && x.j == y.j && x.image == y.image && x.tangential_force == y.tangential_force &&
           x.rolling_moment == y.rolling_moment && x.last_root_overlap == y.last_root_overlap;
  };
  return a.cell.lattice == b.cell.lattice && a.grains.position == b.grains.position &&
         a.grains.velocity == b.grains.velocity && a.grains.spin == b.grains.spin &&
         std::equal(a.contacts.begin(), a.contacts.end(), b.contacts.begin(), b.contacts.end(), same);
}

double pressure_at(int dimension, double kappa) { return stiffness / (kappa * (dimension == 2 ? 0.5 : 2.0)); }

double pressure_of_ratio(const Specimen& s, double kappa) {
  if (s.contact.law == Law::linear_stiffness) {
    const double length = s.cell.dimension == 2 ? s.cell.lattice(2, 2) : 2.0;
    return s.materials[0].normal_stiffness / (kappa * length);
  }
  const double nu = s.materials[0].poisson_ratio;
  return s.materials[0].young_modulus / (2 * (1 - nu * nu)) / (kappa * std::sqrt(kappa));  // kappa = (E*/p)^(2/3)
}

namespace {

/// Compresses a gas quickly until it carries `pressure` at rest. How it gets there is of no matter.
void bring_together(Rve& rve, double pressure) {
  const int d = rve.cell().dimension;
  const auto p = [&] { return mean_pressure(rve.stress(), d); };
  double step = 2e-3;
  while (p() < pressure) {
    while (p() < pressure) {
      rve.apply(isotropic(d, -step), 0);
      if (p() > 0.1 * pressure) step = 5e-4;
    }
    rve.relax(1e-4, 20'000);  // a moment's crowding is no pressure
  }
}

/// Changes the volume until the pressure is right within 1 %. Beyond jamming p^power rises about straight with strain
/// (power 1 for linear springs, 2/3 for Hertz contacts), by `slope`, which is found as one goes.
void bring_to(Rve& rve, double pressure, double power, double slope) {
  const int d = rve.cell().dimension;
  const double usual_slope = slope;
  double p = mean_pressure(rve.stress(), d), lost = 1;
  for (int round = 0; round < 200 && std::abs(p / pressure - 1) > 0.01; ++round) {
    const double aim = std::max(pressure, 0.1 * p);
    const double strain = lost * (std::pow(p, power) - std::pow(aim, power)) / slope;
    rve.apply(isotropic(d, strain), 0);
    rve.relax(1e-5, 50'000);
    const double now = std::max(0.0, mean_pressure(rve.stress(), d));
    lost = now > 1e-3 * pressure ? 1 : 2 * lost;  // out of contact: ever longer steps back
    const double found = (std::pow(p, power) - std::pow(now, power)) / strain;
    if (lost == 1) slope = std::clamp(found, 0.05 * usual_slope, 2 * usual_slope);
    p = lost == 1 ? now : 0;
  }
  if (!(std::abs(p / pressure - 1) <= 0.01)) throw Error("the packing did not come to its pressure");
}

}  // namespace

Specimen jammed(const Specimen& loose, double pressure) {
  Specimen s = loose;
  for (Material& m : s.materials) m.friction = 0;
  s.solver.fixed_substeps = 100;
  Rve rve(s);
  // Grains are pressed together at a moderate stiffness ratio first: at a high one any increment is too large.
  const double power = loose.contact.law == Law::linear_stiffness ? 1 : 2.0 / 3;
  bring_together(rve, std::max(pressure, pressure_of_ratio(loose, 1e3)));
  bring_to(rve, pressure, power, std::pow(pressure_of_ratio(loose, 1), power));
  rve.relax(1e-8, 50'000);
  rve.zero_velocities();
  rve.set_materials(loose.materials);
  Specimen result = rve.specimen();
  result.solver = loose.solver;
  result.state = {};
  return result;
}

Specimen jammed_linear(int dimension, int count, double kappa, double kt_over_kn, double friction,
                       double aspect_ratio) {
  const Material grain = material(stiffness, kt_over_kn * stiffness, friction);
  Specimen loose =
      with_aspect_ratio(gas(dimension, spread_radii(count, 0.3), dimension == 2 ? 0.4 : 0.25, 5, grain), aspect_ratio);
  if (kappa < 100) loose.solver.max_overlap_ratio = 0.9;  // as soft as that, grains overlap by tenths of their radii
  return jammed(loose, pressure_at(dimension, kappa));
}

Specimen jammed_hertz(int dimension, int count, double young_modulus, double poisson_ratio, double friction,
                      double pressure) {
  Material grain;
  grain.young_modulus = young_modulus;
  grain.poisson_ratio = poisson_ratio;
  grain.friction = friction;
  Specimen loose = gas(dimension, spread_radii(count, 0.3), dimension == 2 ? 0.4 : 0.25, 5, grain);
  loose.contact.law = Law::hertz_mindlin;
  if (pressure > pressure_of_ratio(loose, 100)) loose.solver.max_overlap_ratio = 0.9;
  return jammed(loose, pressure);
}

Specimen usual(int dimension, bool hertz, double friction, double aspect_ratio) {
  return hertz ? jammed_hertz(dimension, 64, 1e9, 0.2, friction, 1e5)
               : jammed_linear(dimension, 64, 1e3, 0.5, friction, aspect_ratio);
}

Matrix3 biaxial_direction(int dimension) {
  return dimension == 2 ? Matrix3(entry(0, 0, 0.5) + entry(1, 1, -1))
                        : Matrix3(entry(0, 0, 0.5) + entry(1, 1, 0.25) + entry(2, 2, -1));
}

Matrix3 shear_direction(int dimension) { return entry(0, dimension - 1, 1); }

Specimen rested(const Specimen& specimen, double unbalanced, long substeps) {
  Rve rve(specimen);
  rve.relax(unbalanced, substeps);
  rve.zero_velocities();
  return rve.specimen();
}

Matrix3 stress_after(Specimen s, const Matrix3& increment, int increments, long substeps) {
  s.solver.fixed_substeps = substeps;
  Rve rve(s);
  for (int k = 0; k < increments; ++k) rve.apply(increment, 0);
  return rve.stress();
}

void compare_with_resolved(const Specimen& specimen, const Path& path, double tolerance, Verdict& verdict) {
  const Specimen start = rested(specimen, 1e-7, 100'000);
  Tested tested(start, verdict);
  const Matrix3 first = tested.rve().stress(), increment = path.direction * (path.strain / path.increments);
  const double p = tested.pressure();
  for (int k = 0; k < path.increments; ++k) {
    tested.apply(increment, 0);
    tested.check_laws();
  }
  const Matrix3 fine = stress_after(start, increment, path.increments, path.resolved),
                coarser = stress_after(start, increment, path.increments, path.resolved * 2 / 5);
  const double allowed = tolerance * std::max(1.0, 2 * (fine - first).norm() / p);
  verdict.law("the resolved run is resolved, of p", (fine - coarser).norm() / p, allowed / 3);
  verdict.agreement("stress against the resolved run, of p", (tested.rve().stress() - fine).norm() / p, allowed);
}

void compare_with_images(const Rve& rve, int range, double tolerance, Verdict& verdict) {
  const Matrix3 expected = stress_by_hand(rve.specimen(), stiffness, range);
  verdict.law("stress = sum over all images", largest(rve.stress() - expected),
              tolerance * std::max(largest(expected), 1.0));
}

}  // namespace rvelab::test
