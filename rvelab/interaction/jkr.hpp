// Adhesion of soft, sticky, small grains (Johnson, Kendall and Roberts 1971, Proc. R. Soc. A 324, 301-313): what it
// adds to the Hertz contact beside it. With the radius a of the area of contact
//
//   F = 4 E* a^3/(3 R*) - sqrt(8 pi w E* a^3),   delta = a^2/R* - sqrt(2 pi w a/E*)
//
// F is positive in compression, delta the overlap. In y = sqrt(a/a1), a1^3 = 2 pi w R*^2/E*, delta1 = a1^2/R*:
//   F = F1 (2/3 y^6 - y^3),   F1 = 4 pi w R*,   delta = delta1 (y^4 - y),
//   U = F1 delta1 (4/15 y^10 - 2/3 y^7 + y^4/4)
// and Hertz's force is F1 2/3 (delta/delta1)^(3/2). U is the energy over that of grains apart. Surfaces meet at delta =
// 0, where F jumps from 0 to -4/3 pi w R*, and stay together down to y^3 = 1/4: there delta = -3/4 (1/4)^(1/3) delta1,
// F = -5/6 pi w R*, dF/d(delta) goes to -infinity, and the grains part. Under a held force they part at y^3 = 3/4, F =
// -3/2 pi w R*. A cycle of meeting and parting loses 7.09 (w^5 R*^4/E*^2)^(1/3) (Thornton and Ning 1998).
//
// w = 2 gamma is the work of adhesion; E* is that of the contact law. Friction goes with Hertz's force (as in DMT;
// Thornton 1991 takes F + 3 pi w R*), tangential stiffness with Hertz's area.
#pragma once

#include "rvelab/interaction/arithmetic.hpp"
#include "rvelab/interaction/law.hpp"

namespace rvelab {

struct SurfaceEnergy {
  double surface_energy = 0;  ///< gamma, J/m^2, > 0
};
inline constexpr SettingsField<SurfaceEnergy> surface_energy_fields[] = {
    {"surface_energy_J_m2", &SurfaceEnergy::surface_energy, "J/m^2", number_from_zero,
     "of the grains, half the work of adhesion", true}};

struct JkrAdhesion : NormalForceAlone<JkrAdhesion> {
  static constexpr const char* name = "jkr_contacts";
  static constexpr Family family = Family::adhesion;
  using Settings = SurfaceEnergy;
  static constexpr const char* settings_name = "jkr";
  static constexpr const auto& settings_fields = surface_energy_fields;
  static constexpr RemovalKey removal{"removed", "the grains stick no longer"};
  static constexpr InteractionField fields[] = {
      {"touching", "1", {0, 1}, Turning::scalar, true},  // 0: the grains are near and have not met
      {"force_scale_N", "N", positive_number},           // F1
      {"overlap_scale_m", "m", positive_number},         // delta1
  };
  enum Column { touching, force_scale, overlap_scale };

  static constexpr double pi = 3.14159265358979323846;
  static constexpr double least_y = 0.62996052494743658;    ///< (1/4)^(1/3)
  static constexpr double least_overlap = -0.75 * least_y;  ///< of y^4 - y
  static constexpr double least_rise = 1e-3;                ///< keeps the stiffness finite at parting

  static const char* misfit(const SurfaceEnergy& surface, const SpecimenKind& specimen) {
    if (!(surface.surface_energy > 0)) return "surface_energy_J_m2 above 0";
    return specimen.hertz ? nullptr : "grains of a Hertz law (contact.law), whose modulus JKR takes";
  }
  static double reach(const SurfaceEnergy&) { return 0; }
  static void prepare(const SurfaceEnergy& surface, const GrainPair& pair, double* columns) {
    const double radius = pair.radius_i * pair.radius_j / (pair.radius_i + pair.radius_j);
    const double scale = 8 * pi * surface.surface_energy * radius;  // F1, w = 2 gamma
    // F1 2/3 (delta/delta1)^(3/2) is k delta^(3/2): delta1^3 = (2 F1/(3 k))^2
    const double ratio = 2 * scale / (3 * pair.contact_stiffness);
    if (pair.gap < 0) columns[touching] = 1;
    columns[force_scale] = scale;
    columns[overlap_scale] = interaction::cube_root(ratio * ratio);
  }

  /// y of an overlap over delta1, on the branch that is stable at held gap: y^4 - y = overlap, y >= least_y. With y =
  /// least_y + u it is u sqrt(6 least_y^2 + 4 least_y u + u^2) = sqrt(overlap - least), convex: Newton's steps from
  /// above fall to the root, to the last bit in five.
  template <class V>
  static inline __attribute__((always_inline)) V root_of(V overlap_ratio) {
    const V zero = V{}, above = overlap_ratio - least_overlap;
    const V wanted = square_root((above > zero) ? above : zero);
    const V near = wanted * (1 / (2.44948974278317810 * least_y)), far = square_root(wanted);
    V u = (near < far) ? near : far;
    for (int step = 0; step < 6; ++step) {
      const V inside = 6 * least_y * least_y + u * (4 * least_y + u), root = square_root(inside);
      const V next = u - (u * root - wanted) / (root + u * (2 * least_y + u) / root);
      u = (next < u) ? next : u;
    }
    return u + least_y;
  }
  /// Force over that of Hertz, by F1.
  template <class V>
  static inline __attribute__((always_inline)) V force_ratio(V overlap_ratio) {
    const V zero = V{}, y = root_of<V>(overlap_ratio), y3 = y * (y * y);
    const V pressed = (overlap_ratio > zero) ? overlap_ratio : zero;
    return y3 * ((2.0 / 3.0) * y3 - 1.0) - (2.0 / 3.0) * (pressed * square_root(pressed));
  }

  template <class Columns>
  static bool acts(const Columns& column, double /*gap*/) {
    return column(touching) != 0;
  }
  template <class Columns>
  static bool kept(const Columns& column) {
    return column(touching) != 0;
  }
  template <class Columns>
  static InteractionStiffness stiffness(const Columns& column, double gap, double /*thickness*/) {
    if (!acts(column, gap)) return {};
    const double d = -gap / column(overlap_scale), y = root_of<double>(d), y3 = y * (y * y), rise = 4 * y3 - 1;
    const double hertz = __builtin_sqrt(d > 0 ? d : 0.0);
    return {column(force_scale) / column(overlap_scale) *
                (y * y * (4 * y3 - 3) / (rise > least_rise ? rise : least_rise) - hertz),
            0, 0, 0};
  }
  static constexpr bool has_energy = true;
  /// U less Hertz's, over that of grains apart, J.
  template <class Columns>
  static double energy(const Columns& column, double gap, double /*thickness*/) {
    if (!acts(column, gap)) return 0;
    const double d = -gap / column(overlap_scale), y = root_of<double>(d), y3 = y * (y * y);
    const double pressed = d > 0 ? d : 0, hertz = 4.0 / 15.0 * pressed * pressed * __builtin_sqrt(pressed);
    return column(force_scale) * column(overlap_scale) * (y * y3 * ((4.0 / 15.0 * y3 - 2.0 / 3.0) * y3 + 0.25) - hertz);
  }

  template <bool Advance, bool plane, class V>
  static inline __attribute__((always_inline)) V normal_force(const InteractionArrays& p, long at, V length) {
    const V zero = V{}, one = zero + 1.0;
    const V overlap = (load_as<V>(p.radius_i + at) + load_as<V>(p.radius_j + at)) - length;
    const V scale = load_as<V>(p.column[overlap_scale] + at);
    V there = load_as<V>(p.column[touching] + at);
    if constexpr (Advance) {
      there = (overlap > zero) ? one : ((overlap < least_overlap * scale) ? zero : there);
      store_as(p.column[touching] + at, there);
    }
    const V safe = (scale > zero) ? scale : one;
    return (there > zero) ? load_as<V>(p.column[force_scale] + at) * force_ratio<V>(overlap / safe) : zero;
  }
};

}  // namespace rvelab
