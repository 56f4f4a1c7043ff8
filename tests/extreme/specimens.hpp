// Specimens for the extremes: crystals, gases, jammed grains at a given stiffness ratio; and what physics says of them
// without the solver: contact stress by a sum over all images, net momentum, the crystal's stress.
#pragma once

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "rvelab/error.hpp"
#include "rvelab/grains/direction.hpp"
#include "rvelab/measure/measures.hpp"
#include "rvelab/solver/rve.hpp"
#include "tests/extreme/verdict.hpp"
#include "tests/refusal.hpp"
#include "tests/specimens.hpp"

namespace rvelab::test {

/// Normal stiffness of every contact between grains of material(), N/m.
constexpr double stiffness = 1e6;

inline Material material(double normal = stiffness, double tangential = 0, double friction = 0) {
  return linear_material(normal, tangential, friction);
}

inline Cell cell_of(int dimension, double x, double y, double z) {
  Cell cell;
  cell.dimension = dimension;
  cell.lattice = Vector3(x, y, z).asDiagonal();
  return cell;
}

/// Grains at rest of one material; linear springs as given.
inline Specimen specimen_of(const Cell& cell, const std::vector<Vector3>& positions, const std::vector<double>& radii,
                            const Material& grain = material()) {
  Specimen s;
  s.shape = cell.dimension == 2 ? Shape::disc : Shape::sphere;
  s.cell = cell;
  s.materials = {grain};
  s.contact.law = Law::linear_stiffness;
  for (std::size_t g = 0; g < positions.size(); ++g) add_grain(s, positions[g], radii[g]);
  return s;
}

/// Ellipses in place of discs: the long semi-axis is the disc's radius, so that what did not touch does not; each is
/// turned by the golden angle against the one before. An aspect ratio of 1 changes nothing.
inline Specimen with_aspect_ratio(Specimen s, double aspect_ratio) {
  if (aspect_ratio == 1) return s;
  if (s.shape != Shape::disc) throw InputError("aspect_ratio is for dimension = 2; allowed: 1 in 3D; leave it out");
  s.shape = Shape::ellipse;
  for (std::size_t g = 0; g < s.grains.size(); ++g) {
    const double a = s.grains.radius[g], b = aspect_ratio * a;
    const auto [x, y] = direction_of(std::fmod(137.5 * double(g), 360));
    s.grains.semi_major.push_back(a);
    s.grains.semi_minor.push_back(b);
    s.grains.orientation.emplace_back(x, y, 0);
    s.grains.radius[g] = std::sqrt(a * b);
  }
  return s;
}

/// One grain of radius 1 at the origin of a cell in which it overlaps with its own images.
inline Specimen lone_grain(int dimension, double spacing, const Material& grain = material()) {
  Specimen s = specimen_of(cell_of(dimension, spacing, spacing, dimension == 2 ? 0.5 : spacing), {Vector3::Zero()},
                           {1.0}, grain);
  s.solver.min_height = 1.0;
  return s;
}

/// Triangular lattice of discs of radius 1, m by 2 n of them, at `spacing`; thickness 0.5 m.
inline Specimen triangular(int m, int n, double spacing, const Material& grain = material()) {
  const double row = std::sqrt(3.0) / 2 * spacing;
  const Cell cell = cell_of(2, m * spacing, 2 * n * row, 0.5);
  std::vector<Vector3> positions;
  for (int k = 0; k < 2 * n; ++k)
    for (int i = 0; i < m; ++i)
      positions.emplace_back((i + 0.25 + 0.5 * (k % 2) - 0.5 * m) * spacing, (k + 0.5 - n) * row, 0.0);
  return specimen_of(cell, positions, std::vector<double>(positions.size(), 1.0), grain);
}

/// Simple cubic crystal of n^3 rough spheres of radius 1, which overlap by 0.01.
Specimen cubic_crystal(int n);
/// Its stress after strains along its axes, Pa: one contact a face, f = kn (2 - spacing).
Matrix3 cubic_crystal_stress(const Vector3& strain);

/// Stress of frictionless grains with springs of `stiffness`, Pa, laboratory frame: the sum over all pairs and all
/// images within `range` cells, from positions and lattice alone.
inline Matrix3 stress_by_hand(const Specimen& s, double kn = stiffness, int range = 6) {
  const int depth = s.cell.dimension == 3 ? range : 0;
  Matrix3 sum = Matrix3::Zero();
  for (std::size_t i = 0; i < s.grains.size(); ++i)
    for (std::size_t j = 0; j < s.grains.size(); ++j)
      for (int a = -range; a <= range; ++a)
        for (int b = -range; b <= range; ++b)
          for (int c = -depth; c <= depth; ++c) {
            const Vector3 branch = s.grains.position[j] + s.cell.lattice * Vector3(a, b, c) - s.grains.position[i];
            const double overlap = s.grains.radius[i] + s.grains.radius[j] - branch.norm();
            if (overlap <= 0 || branch.isZero(0)) continue;
            sum -= 0.5 * kn * overlap * branch * branch.transpose() / branch.norm();  // every pair comes twice
          }
  return s.cell.rotation * (sum / s.cell.volume()) * s.cell.rotation.transpose();
}

inline Matrix3 entry(int i, int k, double value) {
  Matrix3 m = Matrix3::Zero();
  m(i, k) = value;
  return m;
}

/// A component of the stress, symmetric, that changes by so much, Pa.
inline MixedTarget::Row stress_row(int i, int k, double change, double scale) {
  return {Matrix3::Zero(), entry(i, k, 0.5) + entry(k, i, 0.5), change, scale};
}

/// The same of the strain.
inline MixedTarget::Row strain_row(int i, int k, double change) {
  return {entry(i, k, 0.5) + entry(k, i, 0.5), Matrix3::Zero(), change, 0};
}

/// In 2D the plane part only.
inline Matrix3 isotropic(int dimension, double strain) {
  return Vector3(strain, strain, dimension == 2 ? 0.0 : strain).asDiagonal();
}

inline Matrix3 rotation_about(Vector3 axis, double angle) {
  return Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
}

/// Bitwise the same lattice, places, velocities, spins and contacts; the frame that carries them may have turned.
bool same_in_cell_frame(const Specimen& a, const Specimen& b);

/// sum m v', kg m/s, of the stored velocities: with the mean that the last sub-step left and the next one takes out.
inline Vector3 net_momentum(const Rve& rve) {
  const Specimen s = rve.specimen();
  const Network network = rve.network();
  Vector3 sum = Vector3::Zero();
  for (std::size_t g = 0; g < rve.size(); ++g) sum += network.grains[g].mass * s.grains.velocity[g];
  return sum;
}

/// sum m |v'|, the scale of the net momentum.
inline double momentum_scale(const Rve& rve) {
  double sum = 0;
  for (const GrainState& grain : rve.network().grains) sum += grain.mass * grain.velocity.norm();
  return sum;
}

/// Portable random numbers in (low, high).
class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double operator()(double low, double high) {
    return low + (high - low) * (double(engine_() >> 11) + 0.5) / 9007199254740992.0;
  }

 private:
  std::mt19937_64 engine_;
};

/// Grains without a contact at random places in a square or cubic cell of the given solid fraction.
inline Specimen gas(int dimension, const std::vector<double>& radii, double solid_fraction, unsigned seed,
                    const Material& grain = material()) {
  const Shape shape = dimension == 2 ? Shape::disc : Shape::sphere;
  double solid = 0;
  for (double r : radii) solid += grain_volume(shape, r, 1.0);
  const double side = dimension == 2 ? std::sqrt(solid / solid_fraction) : std::cbrt(solid / solid_fraction);
  Random random(seed);
  std::vector<Vector3> positions;
  for (std::size_t g = 0; g < radii.size(); ++g) {
    bool free = false;
    for (int trial = 0; !free; ++trial) {
      if (trial > 100'000) throw Error("no free place is left at this solid fraction");
      Vector3 x = Vector3::Zero();
      for (int k = 0; k < dimension; ++k) x[k] = random(-0.5 * side, 0.5 * side);
      free = true;
      for (std::size_t h = 0; h < g && free; ++h) {
        Vector3 b = x - positions[h];
        for (int k = 0; k < dimension; ++k) b[k] -= side * std::round(b[k] / side);
        free = b.norm() > radii[g] + radii[h];
      }
      if (free) positions.push_back(x);
    }
  }
  return specimen_of(cell_of(dimension, side, side, dimension == 2 ? 0.5 : side), positions, radii, grain);
}

/// A gas compressed without friction until its pressure exceeds `pressure` (Pa), at rest; the materials' friction acts
/// from there on. At rest: the unbalanced ratio is 1e-12, or what round-off allows.
inline Specimen packed(const Specimen& loose, double pressure) {
  std::vector<Material> smooth = loose.materials;
  for (Material& m : smooth) m.friction = 0;
  Specimen s = loose;
  s.materials = smooth;
  Rve rve(s);
  const int d = s.cell.dimension;
  while (mean_pressure(rve.stress(), d) < pressure) {
    rve.apply(isotropic(d, mean_pressure(rve.stress(), d) < 0.1 * pressure ? -2e-3 : -2e-4), 0);
    rve.relax(1e-3, 20'000);
  }
  rve.relax(1e-12, 400'000);
  rve.zero_velocities();
  rve.set_materials(loose.materials);
  Specimen result = rve.specimen();
  result.state = {};  // reference force and pressure are those of the packing, not of the gas
  return result;
}

/// Relaxed to that unbalanced ratio, if it is reached within so many sub-steps, and without motion.
Specimen rested(const Specimen& specimen, double unbalanced, long substeps);

/// The stress after some increments at dt = 0 of so many sub-steps each.
Matrix3 stress_after(Specimen specimen, const Matrix3& increment, int increments, long substeps);

/// Dashpots of that restitution; none for 1.
inline void set_restitution(Specimen& s, double restitution) {
  if (restitution == 1) return;
  s.damping.dashpot = Dashpot::restitution;
  s.damping.restitution = restitution;
}

/// Stiffness for which two grains of that reduced mass (kg) that approach at `speed` (m/s) overlap by that at most (m):
/// f_n = k overlap, N/m, or k overlap^1.5 (Hertz, N/m^1.5; Landau and Lifshitz, Theory of Elasticity, section 9).
inline double constant_for(bool hertz, double overlap, double reduced_mass, double speed) {
  return hertz ? 1.25 * reduced_mass * speed * speed / std::pow(overlap, 2.5)
               : reduced_mass * speed * speed / (overlap * overlap);
}

/// `count` radii spread evenly over (1 - spread, 1 + spread).
inline std::vector<double> spread_radii(int count, double spread) {
  std::vector<double> radii;
  for (int k = 0; k < count; ++k) radii.push_back(1 - spread + 2 * spread * (k + 0.5) / count);
  return radii;
}

/// Pressure (Pa) at which grains of radius near 1 have the stiffness ratio kappa: kn/(p thickness) in 2D, kn/(p d) in
/// 3D, (E*/p)^(2/3) of Hertz contacts. The first: linear springs of `stiffness`, thickness 0.5 m.
double pressure_at(int dimension, double kappa);
double pressure_of_ratio(const Specimen& specimen, double kappa);

/// Grains at rest under an isotropic pressure (Pa), packed without friction in the cell of `loose`; the friction of the
/// materials acts from there on, no history yet.
Specimen jammed(const Specimen& loose, double pressure);

/// The same of radii within 30 % of 1: linear springs, or Hertz-Mindlin; ellipses where the aspect ratio is below 1.
Specimen jammed_linear(int dimension, int count, double kappa, double kt_over_kn, double friction,
                       double aspect_ratio = 1);
Specimen jammed_hertz(int dimension, int count, double young_modulus, double poisson_ratio, double friction,
                      double pressure);

/// Either, of 64 discs (ellipses: linear springs) or spheres, as most experiments want them; 100 kPa in Hertz contacts
/// of 1 GPa.
Specimen usual(int dimension, bool hertz, double friction = 0.5, double aspect_ratio = 1);

/// Biaxial compression along y, or simple shear v_x(y); dH of unit size.
Matrix3 biaxial_direction(int dimension);
Matrix3 shear_direction(int dimension);

/// A path with the solver's own steps against the same with so many fixed sub-steps an increment.
struct Path {
  Matrix3 direction;
  double strain = 1e-3;
  int increments = 10;
  long resolved = 10'000;
};

/// From rest, the stress at the end of the path: |sigma - resolved| <= p max(tolerance, 2 tolerance times the change of
/// stress over p). The resolved run must itself agree with one of 0.4 times its sub-steps to a third of that.
void compare_with_resolved(const Specimen& start, const Path& path, double tolerance, Verdict& verdict);

/// The stress of frictionless grains is the sum over all images within `range` cells.
void compare_with_images(const Rve& rve, int range, double tolerance, Verdict& verdict);

inline bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace rvelab::test
