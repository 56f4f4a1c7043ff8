// Two grains that collide: m* x'' + f_n(x) = 0, for springs f_n = k x (linear), k x^(3/2) (Hertz) and k x^2 (cones). A
// law says which of these it collides like; dashpots that give a coefficient of restitution, and the step that resolves
// a collision (solver/loading/collisions.hpp), follow from that.
//
// omega: pi/omega is the duration of a linear collision; of the others, omega at the largest overlap: omega^2 = 3/2
// (k/m*) sqrt(delta) with sqrt(delta) = (5/4 m* v^2/k)^(1/5) (Hertz), 2 (k/m*) delta with delta^3 = 3/2 m* v^2/k
// (cones). `measure` is what omega grows with, without roots: k/m* (linear), (k/m*)^4 v^2 (Hertz), (k/m*)^2 v^2
// (cones).
//
// The dashpot that gives a coefficient of restitution e is the fraction zeta of the critical one.
// Linear: m* x'' + c x' + k x = 0 with c = 2 zeta sqrt(m* k). Hertz with c = cn delta^(1/4), cn = sqrt(5) zeta sqrt(m*
// k): y = x^(5/4) turns m* x'' + cn x^(1/4) x' + k x^(3/2) = 0 into the linear equation (Antypov and Elliott 2011). So
// does y = sqrt(2 U), U the energy of any spring, with c = 2 zeta sqrt(m*) f_n/sqrt(2 U): of cones cn = sqrt(6) zeta
// sqrt(m* k), c = cn delta^(1/2). All have the same e(zeta), at any speed:
//   the contact ends where the overlap does:      e = exp(-pi zeta / sqrt(1 - zeta^2)),
//   with no_tension, where the force does:        Schwager and Poeschel 2007; earlier, so faster.
// Only + - x / sqrt: pair parameters decide the next bit.
#pragma once

namespace rvelab {

// `own`: the law's own constant of the contact (ContactConstants::law_constant).
struct LinearImpact {
  static constexpr bool stiffens = false;
  static constexpr double exponent = 1;  ///< of x in f_n
  /// Dashpot of a restitution: cn = this zeta sqrt(m* k), acting as cn delta^(quarters/4) (damping.hpp).
  static constexpr double restitution_factor = 2;
  static constexpr double factor_squared = 4;
  static constexpr int restitution_quarters = 0;
  /// Sub-steps that a collision takes, over SolverOptions::collision_steps.
  static constexpr double steps = 1;

  static double spring_energy(double k, double overlap, double /*own*/) { return 0.5 * k * overlap * overlap; }
  /// `speed_squared`: of the approach, with what the spring already holds at `overlap`.
  static double measure(double k_over_mass, double /*speed_squared*/) { return k_over_mass; }
  static double held_speed_squared(double /*k_over_mass*/, double /*overlap*/, double /*own*/) { return 0; }
  static double frequency(double measure) { return __builtin_sqrt(measure); }
  /// Overlap from zero at which the spring has taken up the energy of a mass m* at speed v, m.
  static double reach(double k, double mass, double v, double /*own*/) { return v * __builtin_sqrt(mass / k); }
};

/// x^(1/5) for x >= 0, by Newton's method: no libm in what decides the next bit.
double fifth_root(double x);

struct HertzImpact {
  static constexpr bool stiffens = true;
  static constexpr double exponent = 1.5;
  static constexpr double restitution_factor = 2.236067977499789696;  ///< sqrt(5)
  static constexpr double factor_squared = 5;
  static constexpr int restitution_quarters = 1;
  /// A Hertz collision is steepest at its end: in as many steps as a linear one a gas of them lost 0.11 % of its energy
  /// in 1,000 collisions a grain, the linear one 0.02 %.
  static constexpr double steps = 1.25;

  static double spring_energy(double k, double overlap, double /*own*/) {
    return 0.4 * k * overlap * overlap * __builtin_sqrt(overlap);
  }
  static double measure(double k_over_mass, double speed_squared) {
    const double squared = k_over_mass * k_over_mass;
    return squared * squared * speed_squared;
  }
  static double held_speed_squared(double k_over_mass, double overlap, double /*own*/) {
    return 0.8 * k_over_mass * overlap * overlap * __builtin_sqrt(overlap);
  }
  static double frequency(double measure) { return __builtin_sqrt(1.5 * fifth_root(1.25 * measure)); }
  static double reach(double k, double mass, double v, double /*own*/) {
    const double root = fifth_root(1.25 * mass * v * v / k);
    return root * root;
  }
};

struct ConeImpact {
  static constexpr bool stiffens = true;
  static constexpr double exponent = 2;
  static constexpr double restitution_factor = 2.449489742783178098;  ///< sqrt(6)
  static constexpr double factor_squared = 6;
  static constexpr int restitution_quarters = 2;
  static constexpr double steps = 1;

  static double spring_energy(double k, double overlap, double /*own*/) { return k * overlap * overlap * overlap / 3; }
  static double measure(double k_over_mass, double speed_squared) { return k_over_mass * k_over_mass * speed_squared; }
  static double held_speed_squared(double k_over_mass, double overlap, double /*own*/) {
    return 2 * (k_over_mass * overlap * overlap * overlap) / 3;
  }
  static double frequency(double measure);
  static double reach(double k, double mass, double v, double own);
};

/// zeta >= 0 for a coefficient of restitution above 0 to 1; below 1 unless no_tension.
double damping_ratio(double restitution, bool no_tension);

}  // namespace rvelab
