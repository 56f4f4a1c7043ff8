// Quasi-static increments to a tolerance: errors against resolved increments from the same state, estimates above them,
// a path cut finely, turns. Formulas by hand.
#include <algorithm>

#include "rvelab/pack/search.hpp"
#include "rvelab/solver/assembly/contact_states.hpp"
#include "rvelab/solver/quasi_static/accuracy.hpp"
#include "tests/solver/resolved.hpp"

using namespace rvelab;
using namespace rvelab::test;

namespace {

/// The dense packing after a biaxial strain (constant lateral strain rate), resolved so finely that its own lag is far
/// below the tolerances.
Specimen dense_after(double strain) {
  Specimen s = reference_specimen("dense");
  if (strain > 0) {
    s.solver.fixed_substeps = 2000;
    Rve rve(s);
    for (int k = 0; k < 10; ++k) rve.apply(strain / 10 * biaxial_step, 0);
    rve.relax(1e-7, 100'000);
    s = rve.specimen();
    s.solver.fixed_substeps = 0;
  }
  return s;
}

/// yy shortened by `strain` at the stress xx of -100 kPa.
MixedTarget compressed(double strain, double present_xx) {
  MixedTarget target;
  for (const auto& [i, j] : {std::pair{0, 0}, std::pair{1, 1}, std::pair{0, 1}}) {
    MixedTarget::Row row;
    (i == 0 && j == 0 ? row.stress : row.strain)(i, j) = 1;
    row.value = i == 1 ? -strain : j == 1 ? 0 : -1e5 - present_xx;
    row.scale = 1e5;
    target.rows.push_back(row);
  }
  target.rows.back().strain(1, 0) = 1;
  return target;
}

/// Grains of radii 1 to `ratio` at 100 kPa, kn/(p t) or (E*/p)^(2/3) of 1e3; spheres have Hertz contacts.
Specimen packed_grains(Shape shape, std::size_t number, double ratio, double friction) {
  pack::Recipe recipe;
  recipe.shape = shape;
  recipe.number = number;
  recipe.fractions[0].grading.smallest_radius = 2e-3;
  recipe.fractions[0].grading.largest_radius = 2e-3 * ratio;
  Material& m = recipe.materials[0];
  m = linear_material(1e3 * 1e5 * recipe.thickness, 8e2 * 1e5 * recipe.thickness, friction);
  m.young_modulus = 3e9;
  m.poisson_ratio = 0.2;
  recipe.contact.law = shape == Shape::sphere ? Law::hertz_mindlin : Law::linear_stiffness;
  recipe.stress = pack::isotropic_stress(1e5, shape);
  recipe.stress_tolerance = 2e-3;
  Workers alone(1);
  return pack::pack(recipe, alone).specimen;
}

}  // namespace

TEST_CASE("The error allowed is that of its two tolerances", "[solver]") {
  CHECK(allowed_error(0.01, 1e-4, 2e3, 5e3, 1e5) == Approx(0.01 * 2e3 + 10));
  CHECK(allowed_error(0.01, 1e-4, 100, 5e3, 1e5) == Approx(0.01 * 500 + 10));  // soft: a tenth of the network's answer
  CHECK(allowed_error(0.01, 1e-4, 2e3, 5e3, -1e5) == Approx(20));              // in tension the relative part alone
}

TEST_CASE("A network is stiff by its pressure over the strain of its overlaps", "[solver]") {
  const double stiffness = network_stiffness(1e5, 1e-5, 1e-2, 1);
  CHECK(stiffness > 0.5 * 1e5 / 1e-3);  // stress and overlap are proportional, but for the directions of the contacts
  CHECK(stiffness < 1e5 / 1e-3);
  CHECK(network_stiffness(3e5, 1e-5, 1e-2, 1) == Approx(3 * stiffness));
  CHECK(network_stiffness(1e5, 2e-5, 2e-2, 1) == Approx(stiffness));
  CHECK(network_stiffness(1e5, 1e-5, 1e-2, 1.5) == Approx(1.5 * stiffness));  // Hertz: forces go with overlap^(3/2)
  CHECK(network_stiffness(0, 0, 1e-2, 1) == 0);
  CHECK(strain_of_overlap(1e5, stiffness, 1) == Approx(1e-3));
}

TEST_CASE("The error per unbalance grows as a packing goes soft, and has neither jumps nor ends", "[solver]") {
  for (const int dimension : {2, 3}) {
    const auto of_sliding = [&](double s) { return error_per_unbalance(s, 0, 0.3, dimension); };
    const auto of_constraints = [&](double c) { return error_per_unbalance(1, c, 0.3, dimension); };
    for (double x = 0.02; x < 1; x += 0.02) {
      CAPTURE(dimension, x);
      CHECK(of_sliding(x) >= of_sliding(x + 0.02));
      CHECK(of_sliding(x) < 1.2 * of_sliding(x + 0.02));
      CHECK(of_constraints(1 + x) >= of_constraints(1.02 + x));
      CHECK(of_constraints(1 + x) < 1.2 * of_constraints(1.02 + x));
      // The larger of what sliding and what few contacts leave soft.
      CHECK(error_per_unbalance(x, 1 + x, 0.3, dimension) == std::max(of_sliding(x), of_constraints(1 + x)));
    }
    CHECK(of_sliding(0.6) > 2 * of_sliding(1));
    CHECK(of_constraints(1) > 2 * of_constraints(2));
    CHECK(of_sliding(0.01) == of_sliding(0));         // flow lags no more than at constant width
    CHECK(of_constraints(0.8) == of_constraints(1));  // c = 0 is one that is not known
    CHECK(error_per_unbalance(1, 2, 0.1, dimension) == of_constraints(2));
    CHECK(error_per_unbalance(1, 2, 0.6, dimension) == Approx(2 * of_constraints(2)));  // damping hides lag in u
  }
  // In space soft modes follow later than in the plane.
  CHECK(error_per_unbalance(1, 1.1, 0.3, 3) == error_per_unbalance(1, 1.1, 0.3, 2));
  CHECK(error_per_unbalance(0.6, 0, 0.3, 3) > 1.2 * error_per_unbalance(0.6, 0, 0.3, 2));
}

TEST_CASE("A long increment errs by a power of its strain, a start by what is new in its rate", "[solver]") {
  CHECK(error_growth(9.9e-4, 1e-3) == 1);
  CHECK(error_growth(2e-3, 1e-3) > 1);
  CHECK(error_growth(6e-3, 1e-3) == Approx(error_growth(2e-3, 1e-3) * error_growth(3e-3, 1e-3)));
  const double start = unbalance_of_start(1, 1e-4, 1e-3, 16);
  CHECK(start > 0);
  CHECK(unbalance_of_start(2, 1e-4, 1e-3, 16) == Approx(2 * start));
  CHECK(unbalance_of_start(1, 2e-4, 2e-3, 16) == Approx(start));
  CHECK(unbalance_of_start(1, 2e-4, 1e-3, 16) > 2 * start);
  CHECK(unbalance_of_start(1, 1e-4, 1e-3, 32) < start / 2);  // faster than 1/n
  CHECK(unbalance_of_start(0, 1e-4, 1e-3, 1) == 0);
}

TEST_CASE("What a contact holds across its normal goes with its friction, without a jump", "[solver]") {
  CHECK(grip_of(0) == 0);
  CHECK(grip_of(1e-6) < 1e-5);
  for (double friction = 0; friction < 1; friction += 0.01) {
    CHECK(grip_of(friction) < grip_of(friction + 0.01));
    CHECK(grip_of(friction + 0.01) < grip_of(friction) + 0.1);
  }
  CHECK(grip_of(1e6) == Approx(1));
}

TEST_CASE("Increments keep below their estimate, and nearly all to their tolerance", "[solver][slow]") {
  Ratios to_tolerance;
  for (const double strain : {0.0, 1e-3, 1e-2}) {
    const Specimen s = dense_after(strain);
    for (const Matrix3& direction : {biaxial_step, Matrix3(-biaxial_step), shear_step})
      for (const double size : {1e-6, 1e-5, 1e-4, 1e-3}) {
        CAPTURE(strain, size, direction(1, 1), direction(0, 1));
        const Judged made = judged(s, size * direction);
        CHECK(made.within_estimate());
        CHECK(made.report.in_equilibrium);
        to_tolerance.push_back(made.error / made.report.allowed_error);
      }
  }
  CHECK(to_tolerance.root_mean_square() < 0.6);
  CHECK(to_tolerance.largest() < 1.5);
  CHECK(to_tolerance.share_below_one() >= 0.95);
}

TEST_CASE("Nine of ten long increments of packings at rest keep below their estimate", "[solver][slow]") {
  // What slides on the way is not seen in the balance at the end.
  Ratios to_estimate;
  for (const char* packing : {"dense", "medium", "soft"}) {
    const Specimen s = reference_specimen(packing);
    for (const Matrix3& direction : {biaxial_step, Matrix3(-biaxial_step), shear_step, Matrix3(-shear_step)})
      for (const double size : {1.2e-3, 2e-3, 3e-3, 5e-3, 8e-3}) {
        const Judged made = judged(s, size * direction);
        to_estimate.push_back(made.error / made.report.error_estimate);
      }
  }
  CHECK(to_estimate.root_mean_square() < 0.35);
  CHECK(to_estimate.share_below_one() >= 0.9);
}

TEST_CASE("Long increments of little friction and of wide spheres keep below an estimate that is of use",
          "[solver][slow]") {
  // Where the contacts slide, each lag on the way leaves an error of its own. Increments that end elsewhere when they
  // are made at half the rate, and cells that come apart, whose stress of nothing anyone finds, do not count.
  Ratios to_estimate;
  for (const Specimen& s : {packed_grains(Shape::disc, 100, 2, 0.07), packed_grains(Shape::disc, 100, 2, 0.1),
                            packed_grains(Shape::sphere, 80, 4, 0.3)})
    for (const Matrix3& direction : {biaxial_step, Matrix3(-biaxial_step), shear_step, Matrix3(-shear_step)})
      for (const double size : {1e-3, 2e-3, 4e-3}) {
        CAPTURE(size, direction(1, 1), direction(0, 1));
        Rve rve(s);
        const double before = rve.stress().norm();
        const Response response = rve.apply(size * direction, 0);
        const Matrix3 truth = resolved_stress(s, size * direction, 8000);
        if ((resolved_stress(s, size * direction) - truth).norm() > response.report.allowed_error / 3) continue;
        if (truth.norm() < 0.01 * before) continue;
        to_estimate.push_back((response.stress - truth).norm() / response.report.error_estimate);
      }
  REQUIRE(to_estimate.size() >= 12);
  CHECK(to_estimate.largest() <= 1);
  std::nth_element(to_estimate.begin(), to_estimate.begin() + long(to_estimate.size() / 2), to_estimate.end());
  CHECK(to_estimate[to_estimate.size() / 2] > 1.0 / 15);
}

TEST_CASE("What a coarser path lags by is made up for before an increment to a tolerance ends", "[solver]") {
  Specimen s = reference_specimen("dense");
  s.solver.target_unbalanced = 5e-3;
  Rve coarse(s);
  for (int k = 0; k < 100; ++k) coarse.apply(2e-4 * biaxial_step, 0);
  s = coarse.specimen();
  s.solver.target_unbalanced = 0;
  double met = 0, increments = 0;
  const double lag = (coarse.stress() - resolved_stress(s, Matrix3::Zero())).norm();
  for (const Matrix3& direction : {biaxial_step, Matrix3(-biaxial_step), shear_step, Matrix3(-shear_step)})
    for (const double size : {1e-7, 1e-6, 1e-5, 1e-4}) {
      CAPTURE(size, direction(1, 1), direction(0, 1));
      const Judged made = judged(s, size * direction);
      CHECK(made.report.allowed_error < 0.1 * lag);
      CHECK(made.within_estimate());
      CHECK(made.error <= 2 * made.report.allowed_error);
      met += made.report.tolerance_met;
      ++increments;
      CHECK(made.report.substeps < 3000);
    }
  CHECK(met >= 0.85 * increments);  // the estimate is above what is found
}

TEST_CASE("A packing that few contacts hold is loaded from rest to its tolerance, like a dense one", "[solver]") {
  const Specimen s = reference_specimen("noroll");  // friction alone: near isostatic at 3 contacts a grain
  Ratios to_tolerance;
  for (const Matrix3& direction : {biaxial_step, Matrix3(-biaxial_step), shear_step})
    for (const double size : {1e-6, 1e-5, 3e-5, 1e-4}) {
      CAPTURE(size, direction(1, 1), direction(0, 1));
      const Judged made = judged(s, size * direction);
      CHECK(made.within_estimate());
      to_tolerance.push_back(made.error / made.report.allowed_error);
    }
  CHECK(to_tolerance.root_mean_square() < 0.5);
  CHECK(to_tolerance.largest() < 1);
}

TEST_CASE("Constraints are those of the contacts that hold, over the motions of the grains that they hold",
          "[solver]") {
  // A triangular lattice has three contacts a grain. Stuck, each holds 2 of the grain's 3 motions; without friction 1
  // of 2, since discs then turn as they like. A grain in between, held by none, counts for nothing.
  const double spacing = 0.01, radius = 0.00501;
  const auto ratio = [&](double friction, double shear) {
    Specimen s = empty_specimen(Shape::disc, 4 * spacing, linear_material(1e6, 5e5, friction));
    s.cell.lattice(1, 1) = 4 * spacing * std::sqrt(0.75);
    s.cell.lattice(2, 2) = 0.1;
    for (int j = 0; j < 4; ++j)
      for (int i = 0; i < 4; ++i)
        add_grain(s, {(i + 0.5 * (j % 2) - 1.75) * spacing, (j - 1.5) * std::sqrt(0.75) * spacing, 0}, radius);
    add_grain(s, {0.25 * spacing, (-0.5 + 1.0 / 3) * std::sqrt(0.75) * spacing, 0}, 1e-5);
    Rve rve(s);
    rve.apply(gradient(0, shear, 0, 0), 0);
    return rve.specimen().state.control.constraint_ratio;
  };
  CHECK(ratio(1e6, 1e-7) == Approx(2).epsilon(1e-4));
  CHECK(ratio(0, 1e-7) == Approx(1.5));
  CHECK(ratio(1e-6, 1e-9) == Approx(1.5).epsilon(1e-3));
}

TEST_CASE("Of packings of low friction and of wide Hertz spheres most increments keep below their estimate",
          "[solver]") {
  Ratios to_estimate, said_to_be_met;
  for (const Specimen& s : {packed_grains(Shape::disc, 80, 2, 0.02), packed_grains(Shape::disc, 80, 2, 0.05),
                            packed_grains(Shape::disc, 80, 2, 0.1), packed_grains(Shape::sphere, 80, 4, 0.3)})
    for (const Matrix3& direction : {biaxial_step, Matrix3(-biaxial_step), shear_step})
      for (const double size : {1e-6, 1e-5, 1e-4}) {
        const Judged made = judged(s, size * direction);
        to_estimate.push_back(made.error / made.report.error_estimate);
        if (made.report.tolerance_met) said_to_be_met.push_back(made.error / made.report.allowed_error);
      }
  CHECK(to_estimate.root_mean_square() < 0.6);
  CHECK(to_estimate.share_below_one() >= 0.94);
  CHECK(said_to_be_met.size() >= to_estimate.size() / 8);
  CHECK(said_to_be_met.root_mean_square() < 0.8);
}

TEST_CASE("An increment that takes a specimen apart ends after a bounded number of sub-steps", "[solver]") {
  const Specimen s = packed_grains(Shape::disc, 80, 2, 0.05);
  const double overlap = Rve(s).specimen().state.reference.overlap / 6e-3;  // mean diameter 6 mm
  long apart = 0;
  for (const double size : {1e-3, 3e-3, 1e-2}) {
    Rve rve(s);
    const Response response = rve.apply(size * gradient(1, 0.3, 0, 0.5), 0);
    CHECK(double(response.report.substeps) <= 60'000 + 1200 * size * std::sqrt(1.3) / overlap);
    apart += response.stress.norm() < 0.01 * Rve(s).stress().norm();
  }
  CHECK(apart > 0);
}

TEST_CASE("What a rest has shown is a part of the state: trials, copies and restarts go on bit for bit", "[solver]") {
  Rve straight(reference_specimen("dense")), restored(straight), tried(straight);
  bool measured = false;
  for (int k = 0; k < 60; ++k) {
    const Matrix3 increment = (k % 8 < 5 ? 2e-4 : -1e-4) * (k % 3 == 2 ? shear_step : biaxial_step);
    const Response a = straight.apply(increment, 0), b = restored.apply(increment, 0);
    tried.attempt(0.5 * increment, 0);
    tried.revert();
    tried.attempt(increment, 0);
    tried.commit();
    CHECK(same_bits(a.stress, b.stress));
    CHECK(a.report.error_estimate == b.report.error_estimate);
    CHECK(straight.save() == restored.save());
    CHECK(straight.save() == tried.save());
    const SolverState state = straight.specimen().state;
    measured = measured || (k > 3 && state.control.lag.error_factor > 0 && state.control.lag.steps == 0);
    const std::vector<std::byte> bytes = restored.save();
    restored = Rve(reference_specimen("dense"));
    restored.restore(bytes);
  }
  CHECK(measured);
}

TEST_CASE("A rest costs a few of a hundred sub-steps of a path that goes on", "[solver]") {
  Rve rve(reference_specimen("dense"));
  for (int k = 0; k < 100; ++k) rve.apply(2e-5 * biaxial_step, 0);
  const std::uint64_t made = rve.grain_steps_made(), kept = rve.grain_steps();
  for (int k = 0; k < 400; ++k) rve.apply(1e-5 * biaxial_step, 0);
  const auto all = double(rve.grain_steps_made() - made), path = double(rve.grain_steps() - kept);
  CHECK(all > path);  // there were some
  CHECK(all < 1.3 * path);
}

TEST_CASE("A relaxation cut into calls is the same relaxation, the stop of grains that swing included", "[solver]") {
  Specimen s = disordered(Shape::disc, 6, linear_material(1e6, 5e5, 0.3), Law::linear_stiffness, 0.52, 3);
  Rve whole(s), cut(s);
  whole.relax(1e-40, 21'000);
  for (int k = 0; k < 21; ++k) cut.relax(1e-40, 1000);
  CHECK(whole.specimen().state.control.steps_at_fixed_shape == 21'000);
  CHECK(whole.save() == cut.save());
  // Once the cell moves, the count begins anew.
  whole.apply(gradient(1e-6, 0, 0, 0), 0);
  CHECK(whole.specimen().state.control.steps_at_fixed_shape == 0);
}

TEST_CASE("Stricter tolerances take more sub-steps and err less", "[solver]") {
  Specimen s = dense_after(1e-3);
  const Matrix3 increment = 3e-4 * shear_step, truth = resolved_stress(s, increment);
  const auto answer = [&](double factor) {
    s.solver.relative_tolerance = 1e-2 * factor;
    s.solver.absolute_tolerance = 1e-4 * factor;
    return Rve(s).apply(increment, 0);
  };
  const Response usual = answer(1), strict = answer(0.03);
  CHECK(strict.report.substeps > 3 * usual.report.substeps);
  CHECK((strict.stress - truth).norm() < 0.3 * (usual.stress - truth).norm());
  CHECK((strict.stress - truth).norm() <= strict.report.allowed_error);
  CHECK(strict.report.allowed_error == Approx(0.03 * usual.report.allowed_error).epsilon(0.02));
}

TEST_CASE("A cell that has come apart is strained on in as many sub-steps as another", "[solver]") {
  Rve rve(reference_specimen("dense"));
  const auto pressure = [&] { return -0.5 * rve.stress().topLeftCorner<2, 2>().trace(); };
  for (int k = 0; k < 200 && pressure() > 20; ++k) rve.apply(gradient(1e-4, 0, 0, 0.5e-4), 0);
  REQUIRE(pressure() < 20);  // of 1e5
  long substeps = 0;
  for (int k = 0; k < 40; ++k)
    substeps += rve.apply((k % 8 < 4 ? 1e-5 : -1e-5) * gradient(1, 2, 0, -1), 0).report.substeps;
  CHECK(substeps < 50'000);  // measured by its own pressure, of some mPa, one start alone takes a million
  // Errors are measured by a thousandth of the pressure that the specimen was opened with.
  CHECK(rve.apply(1e-5 * gradient(1, 2, 0, -1), 0).report.allowed_error >= 1e-4 * 1e-3 * 0.99e5);
}

TEST_CASE("Under stress control the larger tolerance, times the pressure, is kept", "[solver]") {
  struct Found {
    Matrix3 stress = Matrix3::Zero();
    Report last;
    double unbalanced = 0;
    long substeps = 0;
  };
  const auto found = [](double relative, double absolute, double given) {
    Specimen s = reference_specimen("dense");
    s.solver.relative_tolerance = relative;
    s.solver.absolute_tolerance = absolute;
    s.solver.target_unbalanced = given;
    Rve rve(s);
    Found f;
    for (int k = 0; k < 10; ++k) {
      f.last = rve.apply(compressed(5e-5, rve.stress()(0, 0)), 0).report;
      f.unbalanced = std::max(f.unbalanced, f.last.unbalanced_ratio);
      f.substeps += f.last.substeps;
    }
    f.stress = rve.stress();
    return f;
  };
  const Matrix3 truth = found(1e-2, 1e-4, 3e-6).stress;
  long substeps = 0;
  for (const double tolerance : {3e-2, 1e-2, 3e-3, 1e-3, 3e-4}) {
    CAPTURE(tolerance);
    const Found f = found(tolerance, 1e-5, 0);
    const double pressure = -0.5 * (f.stress(0, 0) + f.stress(1, 1));
    CHECK(f.last.allowed_error == Approx(tolerance * pressure));
    CHECK(f.last.tolerance_met);
    CHECK(f.unbalanced <= 3 * tolerance / 10);  // what Report::in_equilibrium allows
    CHECK(std::abs(f.stress(1, 1) - truth(1, 1)) <= f.last.allowed_error);
    CHECK(f.substeps > substeps);
    substeps = f.substeps;
    CHECK(same_bits(found(1e-5, tolerance, 0).stress, f.stress));
  }
}
