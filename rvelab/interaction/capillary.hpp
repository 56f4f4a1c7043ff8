// A bridge of liquid between two spheres: at given volume (trapped water) or given suction (water in exchange with a
// reservoir). For discs in the plane: planar_bridge.hpp.
//
// S = p_air - p_water, gamma the surface tension, theta the contact angle, R = 2 R1 R2/(R1 + R2), V the volume. The
// force is the solution of the Young-Laplace equation as a table (bridge_table.hpp), with a toroid's closed form as its
// scale:
//   given V:  F = -2 pi gamma R (1 - gap/h) G,   S = gamma K/h,   h = sqrt(gap^2 + 2 V/(pi R)),   gap <= s_c
//   given S:  F = -2 pi gamma R P,   V = R h^2 W,   h = 2 gamma cos(theta)/S,   gap <= s_c
// G, K, P, W are polynomials in t = sqrt(1 - gap/s_c), whose coefficients a pair makes once from its size, angle and
// radii; s_c, the rupture gap, is tabled too: it is (1 + theta/2) V^(1/3) within some per cent (Lian, Thornton and
// Adams 1993, J. Colloid Interface Sci. 161, 138). How exact, against which laws of the literature: README.md.
//
// F is positive in compression, so that a bridge pulls with F < 0; the energy is that over the broken bridge, the work
// of pulling it to rupture taken negative: F = -dU/d(gap). As the gap nears s_c the stiffness goes to -infinity as 1/t:
// no bridge is in balance beyond. Overlapping grains (gap < 0): the force of gap 0, constant.
//
// Volumes V^(1/3)/R1 from 1e-3 to 0.464 (V = 0.1 R1^3; R1 the smaller radius), angles 0 to 45 degrees, suctions
// gamma cos(theta)/(S R1) from 3e-5 to 0.3. A smaller or larger bridge takes the coefficients of the nearest that is in
// the table; above 30 degrees the table begins at V = 1e-6 R1^3.
#pragma once

#include "rvelab/interaction/arithmetic.hpp"
#include "rvelab/interaction/bridge_table.hpp"

namespace rvelab::interaction {

/// A bridge at a gap. All zero: ruptured.
struct BridgeState {
  double force = 0;      ///< N, below 0: it pulls
  double stiffness = 0;  ///< dF/d(overlap) = -dF/d(gap), N/m: below 0, the pull weakens as the gap grows
  double energy = 0;     ///< J, over the broken bridge: 0 or below
  double suction = 0;    ///< Pa; below 0: the water is under pressure
  double volume = 0;     ///< m^3
};

namespace bridge_range {
inline constexpr double largest_angle = 0.78539816339744831;  ///< 45 degrees
inline constexpr double largest_volume = 0.1;                 ///< over the cube of the smaller radius
inline constexpr double least_suction = 1 / 0.3;              ///< S R1/(gamma cos(theta)), R1 the smaller radius
inline constexpr double largest_suction = 1 / 3e-5;
}  // namespace bridge_range

/// Series of Chebyshev polynomials in 2 t - 1, t from 0 (rupture) to 1 (contact).
struct BridgeSeries {
  static constexpr int most = 16;
  double coefficient[most] = {};
  int count = 0;

  struct Value {
    double value, slope;  ///< and d/dt
  };
  Value at(double t) const {
    const double x = 2 * t - 1;
    double b1 = 0, b2 = 0, d1 = 0, d2 = 0;  // Clenshaw, and its derivative
    for (int k = count - 1; k >= 1; --k) {
      const double d0 = 2 * (x * d1 + b1) - d2, b0 = 2 * x * b1 - b2 + coefficient[k];
      d2 = d1, d1 = d0, b2 = b1, b1 = b0;
    }
    return {x * b1 - b2 + coefficient[0], 2 * (x * d1 + b1 - d2)};
  }
};

namespace bridge_detail {

inline constexpr double pi = 3.14159265358979323846;

/// The polynomials of sizes, angles and radii at one point of a table.
struct TablePoint {
  double size[16], angle[8], radii[8];
  TablePoint(const bridge_table::Panel& panel, double size_root, double theta, double unlikeness) {
    const double held = size_root < panel.low ? panel.low : (size_root > panel.high ? panel.high : size_root);
    polynomials(size, panel.sizes, 2 * (held - panel.low) / (panel.high - panel.low) - 1);
    polynomials(angle, panel.angles, 2 * (theta - panel.first_angle) / (panel.last_angle - panel.first_angle) - 1);
    polynomials(radii, panel.radii, 2 * unlikeness - 1);
  }
  static void polynomials(double* T, int count, double x) {
    T[0] = 1, T[1] = x;
    for (int k = 2; k < count; ++k) T[k] = 2 * x * T[k - 1] - T[k - 2];
  }
  BridgeSeries collapse(const bridge_table::Panel& panel, const bridge_table::Series& series) const {
    BridgeSeries out;
    out.count = series.points;
    const unsigned char* length = series.length;
    const int* c = series.coefficient;
    for (int i = 0; i < panel.sizes; ++i)
      for (int j = 0; j < panel.angles; ++j) {
        const double both = size[i] * angle[j] * bridge_table::unit;
        for (int k = 0; k < panel.radii; ++k, ++length) {
          const double weight = both * radii[k];
          for (int m = 0; m < *length; ++m) out.coefficient[m] += weight * double(*c++);
        }
      }
    return out;
  }
};

/// Gauss's rule over 0 to 1, eight points: (node, weight) of the upper half.
inline constexpr double gauss[4][2] = {{0.59171732124782490, 0.18134189168918099},
                                       {0.76276620495816449, 0.15685332293894364},
                                       {0.89833323870681337, 0.11119051722668724},
                                       {0.98014492824876812, 0.05061426814518813}};
/// Integral of f over 0 to 1 by `parts` equal parts.
template <class Integrand>
double integral(int parts, const Integrand& f) {
  double sum = 0;
  for (int p = 0; p < parts; ++p)
    for (const auto& [node, weight] : gauss) sum += weight * (f((p + node) / parts) + f((p + 1 - node) / parts));
  return sum / parts;
}

/// Radii of a pair: R, the smaller one, |R1 - R2|/(R1 + R2).
struct Radii {
  double mean, smaller, unlikeness;
};
inline Radii radii_of(double r1, double r2) {
  const double sum = r1 + r2, difference = r1 - r2;
  return {2 * r1 * r2 / sum, r1 < r2 ? r1 : r2, __builtin_fabs(difference) / sum};
}
inline double fourth_root(double x) { return __builtin_sqrt(__builtin_sqrt(x)); }

/// Keeps the stiffness finite at rupture itself.
inline constexpr double least_t = 1e-6;
inline double parameter(double gap, double rupture_gap) {
  const double t = __builtin_sqrt(1 - gap / rupture_gap);
  return t > least_t ? t : least_t;
}

}  // namespace bridge_detail

/// What a bridge of given volume is, made once as it forms or as its volume changes (a microsecond).
struct VolumeBridge {
  double rupture_gap = 0;          ///< m
  double volume = 0, tension = 0;  ///< V, m^3; gamma, N/m
  double scale = 0;                ///< 2 pi gamma R, N
  double square = 0;               ///< 2 V/(pi R), m^2
  BridgeSeries pull, suction;      ///< G, K

  bool bridges(double gap) const { return gap <= rupture_gap; }

  /// Force and stiffness, for the loop over pairs.
  BridgeState force(double gap) const {
    BridgeState out;
    if (!bridges(gap)) return out;
    const double s = gap > 0 ? gap : 0, t = bridge_detail::parameter(s, rupture_gap);
    const double h = __builtin_sqrt(s * s + square), base = 1 - s / h;
    const auto [g, slope] = pull.at(t);
    out.force = -scale * base * g;
    if (gap >= 0) out.stiffness = scale * (-square / (h * h * h) * g - base * slope / (2 * t * rupture_gap));
    return out;
  }
  /// With energy, suction and volume, for records.
  BridgeState at(double gap) const {
    BridgeState out = force(gap);
    if (!bridges(gap)) return out;
    const double s = gap > 0 ? gap : 0, t = bridge_detail::parameter(s, rupture_gap);
    // U = -integral of the pull, by parts: the base has an integral in closed form, the rest is small and smooth.
    const double inside = integral_of_base(s) * pull.at(t).value -
                          t * bridge_detail::integral(4, [&](double part) {
                            const double at = t * part;
                            return integral_of_base(rupture_gap * (1 - at * at)) * pull.at(at).slope;
                          });
    out.energy = -scale * inside + out.force * (s - gap);
    out.suction = tension * suction.at(t).value / __builtin_sqrt(s * s + square);
    out.volume = volume;
    return out;
  }

 private:
  /// Integral of 1 - gap/h from s to rupture.
  double integral_of_base(double s) const {
    const double sum = __builtin_sqrt(rupture_gap * rupture_gap + square) + __builtin_sqrt(s * s + square);
    return (rupture_gap - s) * (1 - (rupture_gap + s) / sum);
  }
};

/// V > 0 (m^3), radii (m), theta (radians, 0 to bridge_range::largest_angle), gamma (N/m).
inline VolumeBridge volume_bridge(double volume, double r1, double r2, double theta, double tension) {
  const auto [mean, smaller, unlikeness] = bridge_detail::radii_of(r1, r2);
  const bool wetting = theta <= bridge_table::wetting.last_angle;
  const bridge_table::Panel& panel = wetting ? bridge_table::wetting : bridge_table::poorly_wetting;
  const double length = cube_root(volume);
  const bridge_detail::TablePoint point(panel, bridge_detail::fourth_root(length / smaller), theta,
                                        __builtin_sqrt(unlikeness));
  VolumeBridge out;
  out.rupture_gap = length * point.collapse(panel, panel.rupture).coefficient[0];
  out.volume = volume;
  out.tension = tension;
  out.scale = 2 * bridge_detail::pi * tension * mean;
  out.square = 2 * volume / (bridge_detail::pi * mean);
  out.pull = point.collapse(panel, panel.force);
  out.suction = point.collapse(panel, panel.other);
  return out;
}

/// What a bridge of given suction is. Its energy is that of bridge and reservoir: S V is counted.
struct SuctionBridge {
  double rupture_gap = 0;        ///< m
  double suction = 0;            ///< S, Pa
  double scale = 0;              ///< 2 pi gamma R, N
  double volume_scale = 0;       ///< R h^2, m^3
  BridgeSeries pull, contained;  ///< P, W

  bool bridges(double gap) const { return gap <= rupture_gap; }

  /// Force and stiffness, for the loop over pairs.
  BridgeState force(double gap) const {
    BridgeState out;
    if (!bridges(gap)) return out;
    const double s = gap > 0 ? gap : 0, t = bridge_detail::parameter(s, rupture_gap);
    const auto [p, slope] = pull.at(t);
    out.force = -scale * p;
    if (gap >= 0) out.stiffness = -scale * slope / (2 * t * rupture_gap);
    return out;
  }
  /// With energy, suction and volume, for records.
  BridgeState at(double gap) const {
    BridgeState out = force(gap);
    if (!bridges(gap)) return out;
    const double s = gap > 0 ? gap : 0, t = bridge_detail::parameter(s, rupture_gap);
    const double work = scale * rupture_gap * t * t *
                        bridge_detail::integral(2, [&](double part) { return 2 * part * pull.at(t * part).value; });
    out.energy = -work + out.force * (s - gap);
    out.suction = suction;
    out.volume = volume_scale * contained.at(t).value;
    return out;
  }
};

/// S > 0 (Pa), radii (m), theta (radians, 0 to bridge_range::largest_angle), gamma (N/m).
inline SuctionBridge suction_bridge(double suction, double r1, double r2, double theta, double tension) {
  const auto [mean, smaller, unlikeness] = bridge_detail::radii_of(r1, r2);
  const bridge_table::Panel& panel = bridge_table::suction;
  const double half = tension * cosine(theta) / suction, height = 2 * half;
  const bridge_detail::TablePoint point(panel, bridge_detail::fourth_root(half / smaller), theta, unlikeness);
  SuctionBridge out;
  out.rupture_gap = height * point.collapse(panel, panel.rupture).coefficient[0];
  out.suction = suction;
  out.scale = 2 * bridge_detail::pi * tension * mean;
  out.volume_scale = mean * height * height;
  out.pull = point.collapse(panel, panel.force);
  out.contained = point.collapse(panel, panel.other);
  return out;
}

}  // namespace rvelab::interaction
