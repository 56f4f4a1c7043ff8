// Exact solutions of the equations of saturated elastic soil in one dimension, from their derivation:
//
//   (1-n) rho_s a_s + n rho_f a_f = M u'' - p',   n rho_f a_f = -n p' - (n^2 rho_f g/k) w,   v_s + n w = 0
//
// (closed base, incompressible water and grains) give r u_tt + d u_t = M u_yy with r = (1-n) rho_s + (1-n)^2 rho_f/n
// and d = rho_f g/k.
#pragma once

#include <cmath>
#include <complex>
#include <numbers>
#include <utility>
#include <vector>

namespace rvelab::oracle {

struct SaturatedColumn {
  double porosity, solids, water, modulus, conductivity;  ///< 1, kg/m^3, kg/m^3, Pa, m/s
  double height = 1, load = 1e4;                          ///< m, Pa on a drained top, at once
  double gravity = 9.81;

  double inertia() const {
    const double s = 1 - porosity;
    return s * solids + s * s / porosity * water;
  }
  double drag() const { return water * gravity / conductivity; }
  double consolidation() const { return modulus / drag(); }  ///< m^2/s
  /// Settlement of the top over its last value.
  double degree(double time) const {
    double sum = 0;
    for (int m = 0; m < terms; ++m) {
      const auto [value, acceleration] = mode(m, time);
      const double w = wave(m);
      sum += 2 / (height * height * w * w) * value;
    }
    return 1 - sum;
  }
  /// p over the load at a height. From the mixture: p = M (u'(y) - u'(H)) + (1-n)(rho_s - rho_f) int_y^H u_tt.
  double pressure(double y, double time) const {
    double strain = 0, momentum = 0;
    for (int m = 0; m < terms; ++m) {
      const auto [value, acceleration] = mode(m, time);
      const double w = wave(m), amplitude = 2 / (modulus * height * w * w) * (m % 2 == 0 ? 1 : -1);
      const double smooth = m == 0 ? 1 : std::sin(std::numbers::pi * m / terms) / (std::numbers::pi * m / terms);
      strain += smooth * amplitude * value * w * std::cos(w * y);
      momentum += smooth * amplitude * acceleration * std::cos(w * y) / w;
    }
    return modulus * strain + (1 - porosity) * (solids - water) * momentum;
  }

 private:
  static constexpr int terms = 4000;
  double wave(int m) const { return (2 * m + 1) * std::numbers::pi / (2 * height); }
  /// Of r q'' + d q' + M w^2 q = 0 with q = 1, q' = 0 at the start: q and q''.
  std::pair<double, double> mode(int m, double time) const {
    using Complex = std::complex<double>;
    const double decay = drag() / (2 * inertia()), square = modulus / inertia() * wave(m) * wave(m);
    const Complex root = std::sqrt(Complex(decay * decay - square, 0));
    const Complex a = -decay + root, b = -decay - root;
    const Complex ea = std::exp(a * time), eb = std::exp(b * time);
    return {((a * eb - b * ea) / (a - b)).real(), (a * b * (b * eb - a * ea) / (a - b)).real()};
  }
};

/// Terzaghi's degree of consolidation at the time factor T.
inline double terzaghi_degree(double T) {
  double sum = 0;
  for (int m = 0; m < 2000; ++m) {
    const double a = (2 * m + 1) * std::numbers::pi / 2;
    sum += 2 / (a * a) * std::exp(-a * a * T);
  }
  return 1 - sum;
}

/// Squares of the two speeds of plane waves without drag, and fluid over solid velocity in each, the slow one first.
/// stiffness: n/K_f compressible water; M of the skeleton.
struct UndraggedWaves {
  double slow, fast;              ///< m/s
  double slow_ratio, fast_ratio;  ///< v_f/v_s
};
inline UndraggedWaves undragged_waves(double n, double solids, double water, double modulus, double bulk) {
  const double q = bulk / n, s = 1 - n;
  const double a = (modulus + s * s * q) / (s * solids), b = s * n * q / (s * solids);
  const double c = s * n * q / (n * water), d = n * n * q / (n * water);
  const double mean = 0.5 * (a + d), half = std::sqrt(0.25 * (a - d) * (a - d) + b * c);
  const double slow = mean - half, fast = mean + half;
  return {std::sqrt(slow), std::sqrt(fast), (slow - a) / b, (fast - a) / b};
}

/// Of a wave that a drained top sends down at a frequency (Hz), incompressible: speed (m/s) and length of decay (m).
inline std::pair<double, double> slow_wave(const SaturatedColumn& column, double frequency) {
  const double omega = 2 * std::numbers::pi * frequency;
  const std::complex<double> square(omega * omega * column.inertia() / column.modulus,
                                    omega * column.drag() / column.modulus);
  const auto k = std::sqrt(square);
  return {omega / k.real(), 1 / std::abs(k.imag())};
}

}  // namespace rvelab::oracle
