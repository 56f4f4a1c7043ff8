// Hertz-Mindlin contacts of rough surfaces (Otsubo, O'Sullivan, Hanley and Sim 2017, Geotechnique 67, 452-459): the
// asperities give way first, then asperities and grain, then the grain alone.
//
//   delta < t1        f_n = N1 (delta/t1)^c                     asperities
//   t1 <= delta < t2  f_n = N2 ((delta - d1)/(t2 - d1))^b       transition
//   t2 <= delta       f_n = 4/3 E* sqrt(r*) (delta - d1 - d2)^(3/2)   Hertz, behind what the asperities gave way
//
//   N1 = S E* sqrt(2 r* S),   N2 = 100 N1,   d1 = 0.82 S,   d2 = 1.24 S,   S^2 = S_i^2 + S_j^2
//
// S_i is the root mean square height of a surface. t2 follows from the force at it, t2 = d1 + d2 + (3 N2/(4 E*
// sqrt(r*)))^(2/3), b, t1 and c from stiffness and force that are continuous: b = 3/2 (t2 - d1)/(t2 - d1 - d2), t1 = d1
// + (t2 - d1) 100^(-1/b), c = b t1/(t1 - d1). Over S all of them are numbers: t1 = 2.11 S, t2 = 24.5 S, b = 1.58, c
// = 2.59.
//
// With the overlap x = delta, delta - d1, delta - d1 - d2 and the exponent n = c, b, 3/2 of the three regimes, and
// `root` defined by d f_n/d delta = 3/2 k root, k = 4/3 E* sqrt(r*) as in Hertz's law: f_n = k root l, l = 3/2 x/n,
// which is the largest of the three. kt = 8 G* sqrt(r*) root, so that kt/kn is that of Mindlin in all regimes, and f_t
// is carried by the ratio of roots (hertz_mindlin.hpp). S = 0 is Hertz's law bit by bit.
//
// At the same force a rough contact is softer than a smooth one, so at the same energy too: the frequency of a Hertz
// collision is an upper bound, and its reach falls short by d1 + d2 at most.
#pragma once

#include "rvelab/contact/hertz_mindlin.hpp"
#include "rvelab/lanes/powers.hpp"

namespace rvelab {

/// One of the three regimes; lengths over S, forces over k S^1.5, energies over k S^2.5.
struct RoughRegime {
  double offset;    ///< delta - x
  double exponent;  ///< n
  double factor;    ///< root^2 = factor x^(2 (n - 1))
  double energy;    ///< U = f_n x/(n + 1) + energy, so that it is continuous
  double lever;     ///< l/x
  double stored;    ///< 2 f_n x/(n + 1) over root l^2
};
consteval RoughRegime rough_regime(double offset, double exponent, double factor, double energy) {
  return {offset, exponent, factor, energy, 1.5 / exponent, 4 * exponent / (3 * (exponent + 1))};
}
namespace rough {
constexpr double first = 2.1093188701006973, second = 24.467023732785824;  // t1, t2
constexpr RoughRegime asperities = rough_regime(0, 2.5897954953306643, 0.070238743111199496, 0);
constexpr RoughRegime transition = rough_regime(0.82, 1.5830096858101890, 0.56044652118892462, 0.093798171138188617);
constexpr RoughRegime grains = rough_regime(2.06, 1.5, 1, 20.461025134817898);
}  // namespace rough

struct RoughImpact : HertzImpact {
  static double spring_energy(double k, double overlap, double own);
  static double held_speed_squared(double k_over_mass, double overlap, double own) {
    return 2 * spring_energy(k_over_mass, overlap, own);
  }
  static double reach(double k, double mass, double v, double own) {
    return HertzImpact::reach(k, mass, v, own) + rough::grains.offset * own;
  }
};

struct RoughForce : HertzMindlinForce {
  static constexpr bool has_law_constant = true;  ///< S, m
  static constexpr bool has_hertz_radius = false;
  static constexpr bool is_hertz = false;
  static constexpr bool root_has_constant = true;
  using Impact = RoughImpact;

  /// l, m.
  template <class V>
  static inline __attribute__((always_inline)) V lever(V overlap, V s) {
    const V soft = rough::asperities.lever * overlap;
    const V middle = rough::transition.lever * (overlap - rough::transition.offset * s);
    const V firm = overlap - rough::grains.offset * s, larger = (soft > middle) ? soft : middle;
    return (larger > firm) ? larger : firm;
  }
  /// One power for both soft regimes. Where there is no contact, or no roughness, it is of no number and is not taken
  /// (clamping its argument first: 523 instead of 517 instructions a grain-step of spheres, AVX2).
  template <class V>
  static inline __attribute__((always_inline)) V root(V overlap, V s) {
    constexpr RoughRegime a = rough::asperities, b = rough::transition;
    const auto soft = overlap < rough::first * s;
    const V x = soft ? overlap : overlap - b.offset * s;
    const V power = soft ? V{} + 2 * (a.exponent - 1) : V{} + 2 * (b.exponent - 1);
    const V factor = soft ? V{} + a.factor : V{} + b.factor;
    const V grown = (factor * s) * power_of(x / s, power);
    const V squared = (overlap < rough::second * s) ? grown : overlap - rough::grains.offset * s;
    return square_root((overlap > 0.0) ? squared : V{});
  }
  template <class V>
  static inline __attribute__((always_inline)) V normal_force(V kn, V overlap, V root, V s) {
    return kn * (lever(overlap, s) * root);
  }
  static double stiffness_growth(double overlap, double s) {
    const RoughRegime now = regime(overlap, s);
    return (now.exponent - 1) / (overlap - now.offset * s);
  }
  static double normal_energy(double kn, double overlap, double root, double s) {
    const RoughRegime now = regime(overlap, s);
    const double x = overlap - now.offset * s;
    return normal_force(kn, overlap, root, s) * x / (now.exponent + 1) + now.energy * kn * (s * s) * __builtin_sqrt(s);
  }
  /// The dashpot of a restitution is c = 2 zeta sqrt(m*) f_n/sqrt(2 U) (impact.hpp), Hertz's delta^(1/4) where S = 0.
  template <class V>
  static inline __attribute__((always_inline)) V dashpot(V cn, V overlap, V root, V s, int quarters) {
    if (quarters == 0) return cn;
    const auto of_regime = [&](double soft, double middle, double firm) {
      return (overlap < rough::first * s) ? V{} + soft : ((overlap < rough::second * s) ? V{} + middle : V{} + firm);
    };
    const V l = lever(overlap, s), zero = V{}, one = zero + 1.0;
    const V before = of_regime(rough::asperities.energy, rough::transition.energy, rough::grains.energy);
    const V part = of_regime(rough::asperities.stored, rough::transition.stored, rough::grains.stored);
    const V twice = (part * root) * (l * l) + (2.0 * before) * ((s * s) * square_root(s));  // 2 U/k
    const V now = (2 / Impact::restitution_factor) * cn * (root * l) / square_root((twice > 0.0) ? twice : one);
    return (overlap > 0.0) ? now : zero;
  }

 private:
  static RoughRegime regime(double overlap, double s) {
    if (overlap < rough::first * s) return rough::asperities;
    return overlap < rough::second * s ? rough::transition : rough::grains;
  }
};

inline double RoughImpact::spring_energy(double k, double overlap, double own) {
  return RoughForce::normal_energy(k, overlap, RoughForce::root(overlap, own), own);
}

struct SurfaceRoughness {
  double roughness = 0;  ///< S_i, m, > 0
  static constexpr StoredConstant<SurfaceRoughness> stored[] = {
      {"roughness_m", &SurfaceRoughness::roughness, "m", true}};
};

struct HertzRoughLaw {
  static constexpr const char* name = "hertz_rough";
  using Force = RoughForce;

  template <class Each>
  static void parameters(Each each) {
    HertzMindlinLaw::parameters(each);
    each(Parameter{"roughness_m", "roughness", "m", positive_number,
                   "root mean square height S_q of the surface of a grain",
                   "give S_q, 1e-7 to 1e-6 for sand; smooth grains have contact.law = hertz_mindlin"},
         &SurfaceRoughness::roughness);
  }
  template <class Material>
  static ContactConstants mix(const Material& a, double ri, const Material& b, double rj, double section) {
    ContactConstants constants = HertzMindlinLaw::mix(a, ri, b, rj, section);
    constants.law_constant = __builtin_sqrt(a.roughness * a.roughness + b.roughness * b.roughness);
    return constants;
  }
};

}  // namespace rvelab
