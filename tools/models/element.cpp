#include "tools/models/element.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "rvelab/error.hpp"

namespace rvelab::models {
namespace {

constexpr double tolerance = 1e-5;  ///< of a step, relative
constexpr int most_steps = 20000;   ///< of a test
constexpr double liquefied = 1e-3;  ///< p over p at the start

/// Of the length at the time, and of the length at the start.
double natural(double strain) { return -std::log1p(-strain); }
double of_laboratory(double strain) { return -std::expm1(-strain); }

bool stress_driven(Loading loading) { return loading == Loading::oedometer || loading == Loading::isotropic; }

/// Radial strain rate at which the radial stress stays, beside an axial rate of `sign`: secant method from the last
/// one, else bisection. The radial stress rate grows with the radial strain rate.
std::optional<double> radial_rate(const Law& law, const Element& at, double sign, double last) {
  const auto stress_rate = [&](double r) { return law.rate(at, {sign, r}).sigma_r; };
  double x0 = last, f0 = stress_rate(x0);
  double x1 = x0 + (f0 > 0 ? -0.02 : 0.02), f1 = stress_rate(x1);
  const double close = 1e-9 * std::max({std::abs(f1 - f0), std::abs(f0), std::abs(f1)});
  for (int k = 0; k < 15; ++k) {
    if (std::abs(f1) <= close) return x1;
    if (f1 == f0) break;
    const double x2 = x1 - f1 * (x1 - x0) / (f1 - f0);
    if (!(std::abs(x2) < 20)) break;
    x0 = x1, f0 = f1, x1 = x2, f1 = stress_rate(x2);
  }
  double low = -20, high = 20;
  if (stress_rate(low) > 0 || stress_rate(high) < 0) return std::nullopt;
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (low + high);
    (stress_rate(middle) > 0 ? high : low) = middle;
  }
  return 0.5 * (low + high);
}

class Path {
 public:
  Path(const Law& law, const ElementTest& test)
      : element{test.p0, test.p0, 0, 0, test.e0, {}}, law(law), loading(test.loading) {
    law.start(element);
    p0 = test.p0;
    e0 = test.e0;
    step = stress_driven(loading) ? 0.01 * p0 : 1e-5;
  }

  /// Goes on to an axial strain, or (stress-driven) an axial stress; false: it cannot.
  bool to(double target) {
    double left = target - position();
    if (std::abs(left) <= 1e-12 * (stress_driven(loading) ? p0 : 1)) return true;
    const double way = left > 0 ? 1 : -1;
    if (way == -sign) law.reverse(element), step = std::min(step, stress_driven(loading) ? 0.01 * p0 : 1e-5);
    sign = way;
    const double shortest = 1e-9 * (stress_driven(loading) ? p0 : 0.01);
    while ((left = std::abs(target - position())) > 1e-12 * (stress_driven(loading) ? p0 : 1)) {
      const double length = std::min(step, left);
      const double error = advance(length);
      if (++steps > most_steps) return refuse("more than " + std::to_string(most_steps) + " steps are needed");
      if (error > tolerance && length > shortest) {
        step = length * std::clamp(0.9 * std::cbrt(tolerance / error), 0.1, 0.7);
        continue;
      }
      if (!std::isfinite(error)) return refuse(why.empty() ? "the law has no stress" : why);
      element = next;
      law.settle(element);
      if (element.p() < liquefied * p0) return refuse("p falls to zero");
      if (length < left || error > 0)
        step = std::max(step, length) * std::clamp(0.9 * std::cbrt(tolerance / std::max(error, 1e-12)), 0.3, 3.0);
    }
    return true;
  }

  Element element;
  std::string why;

 private:
  struct Slope {
    Rate rate;
    StrainRate strain;
  };

  double position() const { return stress_driven(loading) ? element.sigma_a : element.eps_a; }
  bool refuse(std::string reason) {
    why = std::move(reason);
    return false;
  }

  /// Rates per unit of what drives the test.
  std::optional<Slope> slope(const Element& at) {
    if (!(at.sigma_a > 0) || !(at.sigma_r > 0)) return std::nullopt;
    StrainRate strain{sign, 0};
    if (loading == Loading::undrained) strain.r = -0.5 * sign;
    if (loading == Loading::isotropic) strain.r = sign;
    if (loading == Loading::drained) {
      const auto r = radial_rate(law, at, sign, last_radial * sign);
      if (!r) return std::nullopt;
      strain.r = *r;
    }
    Rate rate = law.rate(at, strain);
    if (stress_driven(loading)) {
      const double stiffness = sign * rate.sigma_a;
      if (!(stiffness > 0)) {
        why = "the law gives way under stress";
        return std::nullopt;
      }
      strain.a /= stiffness, strain.r /= stiffness, rate.sigma_a /= stiffness, rate.sigma_r /= stiffness;
      for (double& value : rate.memory) value /= stiffness;
    }
    return Slope{rate, strain};
  }

  Element moved(const Element& from, const Slope& slope, double length) const {
    Element to = from;
    to.sigma_a += length * slope.rate.sigma_a;
    to.sigma_r += length * slope.rate.sigma_r;
    to.eps_a += length * slope.strain.a;
    to.eps_r += length * slope.strain.r;
    to.e = (1 + e0) * std::exp(-(to.eps_a + 2 * to.eps_r)) - 1;
    for (std::size_t k = 0; k < to.memory.size(); ++k) to.memory[k] += length * slope.rate.memory[k];
    return to;
  }

  /// One step of Kutta's third-order formula to `next`, its error from the midpoint rule (Fellin and Ostermann 2002).
  double advance(double length) {
    constexpr double none = std::numeric_limits<double>::infinity();
    why.clear();
    const auto k1 = slope(element);
    if (!k1) return none;
    const auto k2 = slope(moved(element, *k1, 0.5 * length));
    if (!k2) return none;
    const auto k3 = slope(moved(moved(element, *k1, -length), *k2, 2 * length));
    if (!k3) return none;
    const Element second = moved(element, *k2, length);
    next = moved(moved(moved(element, *k1, length / 6), *k2, 4 * length / 6), *k3, length / 6);
    if (!(next.sigma_a > 0) || !(next.sigma_r > 0)) return none;
    last_radial = k3->strain.r / k3->strain.a;
    const double stress = std::max(next.p(), 0.01 * p0);
    double error = std::max(std::abs(next.sigma_a - second.sigma_a), std::abs(next.sigma_r - second.sigma_r)) / stress;
    error = std::max(error, std::abs(next.eps_a - second.eps_a) / (1e-3 + std::abs(next.eps_a)));
    for (std::size_t k = 0; k < next.memory.size(); ++k) {
      const double size = std::max(std::abs(next.memory[k]), 1e-3);
      error = std::max(error, std::abs(next.memory[k] - second.memory[k]) / size);
    }
    return std::isfinite(error) ? error : none;
  }

  const Law& law;
  Loading loading;
  Element next{};
  double p0 = 0, e0 = 0, step = 0, sign = 0, last_radial = -0.3;
  int steps = 0;
};

/// Masing's rule: between two reversals the curve of first loading, doubled about the last reversal, until it meets the
/// curve of first loading again.
Calculation calculated_shear(const Law& law, const ElementTest& test) {
  Calculation result{test, ""};
  const auto first = [&](double gamma) { return std::copysign(law.shear_stress(std::abs(gamma), test.p0), gamma); };
  if (!std::isfinite(first(1e-6))) return {test, "the model is not calculated in cyclic shear"};
  double way = 0, from = 0, from_stress = 0, largest = 0, gamma = 0, stress = 0;
  for (std::size_t k = 0; k < test.strain.size(); ++k) {
    const double to = test.strain[k], direction = to > gamma ? 1 : -1;
    if (to != gamma && direction == -way) from = gamma, from_stress = stress;
    if (to != gamma) way = direction;
    largest = std::max(largest, std::abs(gamma));
    const bool virgin = std::abs(to) >= largest && way * to > 0;
    stress = virgin ? first(to) : from_stress + 2 * first(0.5 * (to - from));
    gamma = to;
    result.test.q[k] = stress;
    result.test.p[k] = test.p0;
    result.test.eps_v[k] = 0;
  }
  return result;
}

}  // namespace

Calculation calculate(const Law& law, const ElementTest& test) {
  if (test.loading == Loading::cyclic_shear) return calculated_shear(law, test);
  Calculation result{test, ""};
  Path path(law, test);
  bool goes_on = true;
  for (std::size_t k = 0; k < test.strain.size(); ++k) {
    double target = natural(test.strain[k]);
    if (test.loading == Loading::oedometer) target = axial_stress(test, k);
    if (test.loading == Loading::isotropic) target = test.p[k];
    if (goes_on && !path.to(target)) {
      goes_on = false;
      result.remark = "stops at an axial strain of " + in_words(of_laboratory(path.element.eps_a)) + ": " + path.why;
    }
    const Element& at = path.element;
    result.test.strain[k] = stress_driven(test.loading) ? of_laboratory(at.eps_a) : test.strain[k];
    result.test.q[k] = at.q();
    result.test.p[k] = at.p();
    result.test.eps_v[k] = of_laboratory(at.eps_a + 2 * at.eps_r);
  }
  return result;
}

}  // namespace rvelab::models
