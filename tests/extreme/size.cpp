// How many grains, how unlike, in how thin a cell. Stresses are known from positions alone (frictionless grains, the
// sum over all images), from a crystal, or from a supercell in which no pair needs more than one image.
#include <algorithm>
#include <cmath>

#include "rvelab/measure/measures.hpp"
#include "rvelab/pack/repeated.hpp"
#include "tests/extreme/matrix.hpp"
#include "tests/extreme/specimens.hpp"

namespace rvelab::test {

namespace {

void few_grains(const Case& asked, Verdict& verdict) {
  const int d = int(asked("dimension")), count = int(asked("grains"));
  Specimen s;
  if (count == 1) {
    s = lone_grain(d, 1.95);
  } else {
    Specimen loose = gas(d, spread_radii(count, 0.1), 0.3, 9);
    loose.solver.min_height = 0.5;
    loose.solver.max_overlap_ratio = 0.5;  // so few grains cannot dodge one another
    s = packed(loose, 1e4);
  }
  Tested tested(s, verdict);
  const Matrix3 increment = 1e-3 * (biaxial_direction(d) + shear_direction(d));
  for (int k = 0; k < 20; ++k) {
    tested.apply(increment, 0);
    tested.check_laws();
    compare_with_images(tested.rve(), 6, asked.tolerance, verdict);
  }
}

void unlike_radii(const Case& asked, Verdict& verdict) {
  const int d = int(asked("dimension"));
  std::vector<double> radii(std::size_t(asked("large")), 1.0);
  radii.insert(radii.end(), std::size_t(asked("small")), 1 / asked("ratio"));
  Specimen loose = gas(d, radii, asked("solid_fraction"), 4);
  loose.solver.max_overlap_ratio = 0.5;
  const Specimen s = jammed(loose, pressure_at(d, 1e3));
  const double p = mean_pressure(Rve(s).stress(), d);
  compare_with_images(Rve(s), 1, 1e-10, verdict);
  Path path;
  path.direction = shear_direction(d);
  path.strain = 1e-5;
  path.increments = 1;
  path.resolved = 20'000;
  verdict.law("the packing carries a pressure", p > 0);
  compare_with_resolved(s, path, asked.tolerance, verdict);
}

void grains_in_pores(const Case& asked, Verdict& verdict) {
  // A crystal of large discs with 19 small ones loose in each of its pores: they carry nothing and must cost little.
  const int side = int(asked("side"));
  const double spacing = 1.95, row = std::sqrt(3.0) / 2 * spacing, small = 1.0 / 50;
  const Specimen frame = triangular(2 * side, side, spacing);
  Specimen s = frame;
  for (const Vector3& corner : frame.grains.position)
    for (const double pore : {row * 2 / 3, -row * 2 / 3})  // above and below a disc
      for (int a = -2; a <= 2; ++a)
        for (int b = -2; b <= 2; ++b)
          if (std::abs(a + b) <= 2)
            add_grain(s, corner + Vector3(2.2 * small * (a + 0.5 * b), pore + 1.9 * small * b, 0), small);
  Tested tested(s, verdict);
  Specimen moved = frame;
  for (int k = 0; k < 3; ++k) {
    const Matrix3 increment = isotropic(2, -1e-4) + 1e-4 * shear_direction(2);
    const Response response = tested.apply(increment, 0);
    // A Bravais crystal deforms as its cell does.
    const Matrix3 f = Matrix3::Identity() + increment;
    moved.cell.lattice = (f * moved.cell.lattice).eval();
    for (Vector3& x : moved.grains.position) x = f * x;
    const Matrix3 expected = stress_by_hand(moved, stiffness, 1);
    verdict.law("stress of the crystal", largest(response.stress - expected), asked.tolerance * largest(expected));
  }
  verdict.law("the grains in the pores carry nothing",
              tested.rve().network().contacts.size() == 3 * frame.grains.size());
  tested.check_laws();
}

void million_grains(const Case& asked, Verdict& verdict) {
  Specimen s = cubic_crystal(int(asked("side")));
  s.solver.fixed_substeps = 3;
  Tested tested(s, verdict);
  const Vector3 strain(1e-4, 0, -1e-3);
  const Response response = tested.apply(Matrix3(strain.asDiagonal()), 0);
  const Matrix3 expected = cubic_crystal_stress(strain);
  verdict.law("stress of the crystal", largest(response.stress - expected), asked.tolerance * largest(expected));
  tested.check_laws();
}

/// Whether a pair touches by more than one image, or a grain its own.
bool several_images(const Network& network) {
  const auto& contacts = network.contacts;
  for (std::size_t c = 0; c < contacts.size(); ++c)
    if (contacts[c].i == contacts[c].j ||
        (c > 0 && contacts[c - 1].i == contacts[c].i && contacts[c - 1].j == contacts[c].j))
      return true;
  return false;
}

void thin_cell(const Case& asked, Verdict& verdict) {
  const int d = int(asked("dimension")), copies = int(asked("copies"));
  Specimen loose = gas(d, spread_radii(int(asked("grains")), 0.2), d == 2 ? 0.4 : 0.25, 5,
                       material(stiffness, 0.5 * stiffness, 0.5));
  loose.solver.min_height = 0.5;
  Rve resting(packed(loose, 2e4));
  resting.apply(1e-3 * shear_direction(d), 0);  // so that tangential springs carry forces
  resting.relax(1e-13, 200'000);
  resting.zero_velocities();
  Specimen small = resting.specimen();
  small.state = {};
  small.solver.fixed_substeps = 100;
  Tested few(small, verdict), many(pack::repeated(small, {copies, copies, d == 3 ? copies : 1}), verdict);
  const double p = few.pressure();
  verdict.law("the grains are pressed together", p > 1e4);
  verdict.law("stress of the supercell at rest, of p", largest(few.rve().stress() - many.rve().stress()) / p, 1e-12);
  verdict.law("pairs touch by several images", several_images(few.rve().network()));
  verdict.law("none does in the supercell", !several_images(many.rve().network()));
  // The first 0.02 % strain from rest, over which round-off has not grown (solver/README.md).
  const Matrix3 increment = 5e-6 * biaxial_direction(d) + 1e-5 * shear_direction(d);
  for (int k = 0; k < 10; ++k) {
    const Response one = few.apply(increment, 0), all = many.apply(increment, 0);
    verdict.law("stress of the supercell, of p", largest(one.stress - all.stress) / p, asked.tolerance);
    verdict.law("the thin cell is flagged", one.report.cell_thin);
  }
  few.check_laws();
}

}  // namespace

std::vector<Experiment> size_experiments() {
  return {{"size/few", few_grains, "dimension 2, grains 3"},
          {"size/contrast", unlike_radii, "dimension 2, ratio 10, large 4, small 400, solid_fraction 0.6"},
          {"size/pores", grains_in_pores, "side 8"},
          {"size/million", million_grains, "side 100"},
          {"size/thin", thin_cell, "dimension 2, grains 4, copies 4"}};
}

}  // namespace rvelab::test
