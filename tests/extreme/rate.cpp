// Physical rates, dt > 0: from creeping to faster than the grains can follow. Energy and momentum are the judges.
#include <algorithm>
#include <cmath>

#include "rvelab/measure/measures.hpp"
#include "tests/extreme/energy.hpp"
#include "tests/extreme/matrix.hpp"
#include "tests/extreme/specimens.hpp"

namespace rvelab::test {

namespace {

/// Shear rate of an inertial number, 1/s.
double rate_of(double inertial_number, const Rve& rve) {
  const Network network = rve.network();
  const double p = mean_pressure(rve.stress(), network.dimension());
  return inertial_number / (mean_diameter(network) * std::sqrt(solid_density(network) / p));
}

void sheared_at_rate(const Case& asked, Verdict& verdict) {
  const int d = int(asked("dimension"));
  Specimen s = asked("hertz") != 0 ? usual(d, true, asked("friction"))
                                   : jammed_linear(d, 64, asked("kappa"), asked("kt_over_kn"), asked("friction"),
                                                   asked("aspect_ratio"));
  for (Material& m : s.materials) {
    m.density = asked("density");
    m.rolling_stiffness = asked("rolling_stiffness");
    m.rolling_friction = asked("rolling_stiffness") > 0 ? 0.1 : 0;
  }
  s.contact.rolling = asked("rolling_stiffness") > 0;
  s.solver.time_step_factor = asked("time_step_factor");
  s.damping.local = asked("local_damping");
  // Grains damped by 0.99 move as if they were a hundred times heavier, and are pushed deep.
  if (s.damping.local > 0.9) s.solver.max_overlap_ratio = 0.5;
  set_restitution(s, asked("restitution"));
  s.solver.energy_balance = true;
  Tested tested(s, verdict);
  const double rate = rate_of(asked("inertial_number"), tested.rve());
  const int increments = 50;
  const double dt = asked("default_steps") * 0.7 * tested.rve().critical_time_step() / increments;
  EnergyBalance energy(tested.rve());
  for (int k = 0; k < increments; ++k) {
    tested.apply(rate * dt * shear_direction(d), dt);
    energy.look(rate * shear_direction(d));
  }
  tested.check_laws();
  verdict.law("energy closes, of the largest of work, change and loss", energy.residual(), asked.tolerance);
  if (asked("local_damping") == 0) tested.check_momentum();
}

void shock_compression(const Case& asked, Verdict& verdict) {
  const int d = int(asked("dimension"));
  Specimen s = usual(d, asked("hertz") != 0, 0.5);
  s.solver.energy_balance = true;
  s.solver.time_step_factor = asked("time_step_factor");
  Tested tested(s, verdict);
  // The speed at which the sides of a grain come together over that of sound in the packing, about r omega_max.
  const double critical = tested.rve().critical_time_step(), rate = asked("mach") / critical;
  const double strain = 0.06;
  tested.apply(isotropic(d, strain), 0);           // a gas
  tested.apply(Matrix3::Zero(), 1e-9 * critical);  // physical masses from here on
  EnergyBalance energy(tested.rve());
  const int increments = 20;
  double size = 1;
  for (int k = 1; k <= increments; ++k) {
    const double next = 1 - 1.2 * strain * k / increments;
    tested.apply(isotropic(d, next / size - 1), (size - next) / rate);
    energy.look(isotropic(d, -rate / next));
    size = next;
  }
  tested.check_laws();
  verdict.law("energy closes, of the largest of work, change and loss", energy.residual(), asked.tolerance);
  tested.check_momentum();
}

void slow_is_static(const Case& asked, Verdict& verdict) {
  // So slowly that inertia has no part: the stress of a resolved run at dt = 0, whatever damps the oscillations.
  Specimen s = usual(2, false, 0);
  s.damping.local = asked("local_damping");
  Specimen still = s;
  still.solver.fixed_substeps = 100'000;
  Tested moving(s, verdict);
  Rve resolved(still);
  const double p = moving.pressure(), steps = asked("critical_steps");
  const Matrix3 increment = 2e-4 * biaxial_direction(2);
  const Report report = moving.apply(increment, steps * moving.rve().critical_time_step()).report;
  verdict.law("every critical step is a sub-step at least", double(report.substeps) >= steps);
  verdict.law("inertial number", report.inertial_number, 1e-5);
  resolved.apply(increment, 0);
  moving.check_laws();
  verdict.law("stress against quasi-static loading, of p", largest(moving.rve().stress() - resolved.stress()) / p,
              asked.tolerance);
}

void flow_under_stress(const Case& asked, Verdict& verdict) {
  // Simple shear at a given rate while the cell keeps sigma_yy = -p by its height alone.
  const int increments = int(asked("increments"));
  const double gamma = asked("gamma") / increments;
  Specimen s = jammed_linear(2, 200, 1e4, 0.5, 0.5);
  set_restitution(s, asked("restitution"));
  Tested tested(s, verdict);
  const double p = tested.pressure(), rate = rate_of(asked("inertial_number"), tested.rve());
  const auto target_from = [&](const Matrix3& stress) {
    MixedTarget target;
    target.rows = {strain_row(0, 0, 0), stress_row(1, 1, -p - stress(1, 1), p), strain_row(0, 1, 0.5 * gamma)};
    target.spin = entry(0, 1, 0.5 * gamma) - entry(1, 0, 0.5 * gamma);
    return target;
  };
  double sum = 0, squares = 0;
  long counted = 0;
  Matrix3 stress = tested.rve().stress();
  for (int k = 0; k < increments; ++k) {
    const Response response = tested.apply(target_from(stress), gamma / rate);
    stress = response.stress;
    verdict.law("the shear strain is the one asked for",
                std::abs(response.displacement_gradient(0, 1) - gamma) + std::abs(response.displacement_gradient(1, 0)),
                1e-12);
    if (2 * k < increments) continue;
    const double miss = -stress(1, 1) / p - 1;
    sum += miss;
    squares += miss * miss;
    ++counted;
  }
  tested.check_laws();
  const double mean = sum / double(counted), scatter = std::sqrt(squares / double(counted) - mean * mean);
  verdict.agreement("mean of the held stress, of p", std::abs(mean), asked.tolerance);
  verdict.agreement("scatter of the held stress, of p", scatter, 10 * asked.tolerance);
  // The time that truly passes, counted in steps of known length: a wait for the stress would make the rate another.
  Specimen counting = tested.rve().specimen();
  counting.solver.fixed_time_step = gamma / rate / 39.7;
  while (counting.solver.fixed_time_step > 0.7 * tested.rve().critical_time_step())
    counting.solver.fixed_time_step /= 2;
  const double wanted = std::ceil(gamma / rate / counting.solver.fixed_time_step);
  Rve clock(counting);
  stress = clock.stress();
  double made = 0;
  for (int k = 0; k < 50; ++k) {
    const Response response = clock.apply(target_from(stress), gamma / rate);
    made += double(response.report.substeps);
    stress = response.stress;
  }
  verdict.law("true over asked time, less one", std::abs(made / (50 * wanted) - 1), 1e-9);
}

}  // namespace

std::vector<Experiment> rate_experiments() {
  return {{"rate/shear", sheared_at_rate,
           "dimension 2, hertz 0, inertial_number 1e-3, default_steps 20000, friction 0.5, kt_over_kn 0.5, "
           "rolling_stiffness 0, local_damping 0, restitution 1, density 2650, kappa 1e3, time_step_factor 0.7, "
           "aspect_ratio 1"},
          {"rate/shock", shock_compression, "dimension 3, hertz 1, mach 0.1, time_step_factor 0.7"},
          {"rate/slow", slow_is_static, "local_damping 0.3, critical_steps 1e5"},
          {"rate/flow", flow_under_stress, "inertial_number 1e-2, restitution 0.5, gamma 4, increments 800"}};
}

}  // namespace rvelab::test
