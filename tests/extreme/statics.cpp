// Quasi-static loading of what is no equilibrium any more: a right answer or a flag, never a silent wrong one.
#include "rvelab/measure/measures.hpp"
#include "tests/extreme/matrix.hpp"
#include "tests/extreme/specimens.hpp"

namespace rvelab::test {

namespace {

/// Packed with friction: loose, and held up by tangential forces. In increments of its own, so that the specimen is the
/// same whatever is made of tolerances.
Specimen propped(double friction) {
  Specimen loose = gas(2, spread_radii(100, 0.3), 0.4, 7, material(stiffness, 0.5 * stiffness, friction));
  loose.solver.target_unbalanced = 1e-3;
  Rve rve(loose);
  const double pressure = pressure_at(2, 1e3);
  while (mean_pressure(rve.stress(), 2) < pressure) {
    rve.apply(isotropic(2, mean_pressure(rve.stress(), 2) < 0.1 * pressure ? -2e-3 : -2e-4), 0);
    rve.relax(1e-3, 20'000);
  }
  rve.relax(1e-10, 400'000);
  rve.zero_velocities();
  Specimen s = rve.specimen();
  s.solver.target_unbalanced = 0;
  s.state = {};
  return s;
}

void made_frictionless(const Case& asked, Verdict& verdict) {
  // Without the friction that held it the packing falls in; what it falls to depends on the increments, so the run at
  // the solver's own must agree with a slow one or say that it is none.
  Specimen s = propped(asked("prepared_with"));
  const double p = mean_pressure(Rve(s).stress(), 2);
  for (Material& m : s.materials) m.friction = asked("friction");
  const Matrix3 direction = asked("shear") != 0 ? shear_direction(2) : biaxial_direction(2);
  const int increments = int(asked("increments"));
  const Matrix3 increment = direction * (asked("strain") / increments);
  Tested tested(s, verdict);
  for (int k = 0; k < increments; ++k) tested.apply(increment, 0);
  tested.check_laws();
  // Two resolved runs must agree: then the way down is one and not a matter of chance.
  const Matrix3 fine = stress_after(s, increment, increments, 100'000 / increments),
                coarser = stress_after(s, increment, increments, 40'000 / increments);
  verdict.law("the resolved run is resolved, of p", (fine - coarser).norm() / p, asked.tolerance);
  verdict.agreement("stress against 100,000 sub-steps, of p", (tested.rve().stress() - fine).norm() / p,
                    asked.tolerance);
}

enum Pull { one_axis, all_round, in_proportion };

void asked_for_tension(const Case& asked, Verdict& verdict) {
  // Grains without cohesion carry no tension: the target cannot be held, which must be said (or refused), in a bounded
  // time and without a stress that pretends to.
  const int d = int(asked("dimension"));
  Specimen s = usual(d, false, 0);
  Tested tested(s, verdict);
  const Matrix3 stress = tested.rve().stress();
  const double p = mean_pressure(stress, d);
  // Pulled along one axis with the other stresses held, all round, or in proportion to what it bears.
  const auto pull = int(asked("pull"));
  const auto change = [&](int i) {
    return pull == in_proportion ? -1.5 * stress(i, i) : i == 0 || pull == all_round ? 0.5 * p - stress(i, i) : 0;
  };
  MixedTarget target;
  for (int i = 0; i < d; ++i)
    for (int k = i; k < d; ++k) target.rows.push_back(i == k ? stress_row(i, i, change(i), p) : strain_row(i, k, 0));
  const double dt = asked("critical_steps") * tested.rve().critical_time_step();
  if (dt == 0) {
    const auto found = refused(tested.rve(), [&](Rve& r) { r.apply(target, 0); });
    verdict.refusal("a tension that grains cannot carry", found);
    const std::string text = found ? found->text : "";
    // In proportion the ratio of shear to pressure stays as it was until the grains part. All round the pull asks on
    // its way for a pressure that vanishes about when the shear stress of the start does: the cell flows, or they part.
    const bool part = contains(text, "none touches another"), flows = contains(text, "the cell sheared by");
    verdict.law("the refusal says why (" + text + ")",
                contains(text, "the grains cannot carry it") && (pull == in_proportion ? part
                                                                 : pull == all_round   ? part || flows
                                                                                       : flows));
    return;
  }
  const Response response = tested.apply(target, dt);
  tested.check_laws();
  verdict.law("a tension that grains cannot carry is said not to be held", !response.report.target_held);
  verdict.law("the error of the held stress is beyond its tolerance", response.report.held_error > target.tolerance);
  verdict.law("it ends, in sub-steps", double(response.report.substeps), 5e6);
  verdict.law("no tension in the answer, of p", std::max(0.0, response.stress.diagonal().maxCoeff()) / p,
              asked.tolerance);
}

}  // namespace

std::vector<Experiment> statics_experiments() {
  return {
      {"statics/frictionless", made_frictionless, "prepared_with 1, friction 0, shear 1, strain 1e-4, increments 1"},
      {"statics/tension", asked_for_tension, "dimension 2, critical_steps 0, pull 1"}};
}

}  // namespace rvelab::test
