// Bonds between grains: the parallel bond, a short beam of cement beside the contact, and the contact bond, a glued
// point.
//
// Parallel bond (Potyondy and Cundall 2004, Int. J. Rock Mech. Min. Sci. 41, 1329), of radius R = multiplier times that
// of the smaller grain; section: disc A = pi R^2, I = pi R^4/4, J = pi R^4/2; in the plane a rectangle of thickness t,
// A = 2 R t, I = 2 R^3 t/3, no twist. Stiffnesses kn, ks per area (Pa/m), or kn = E/(r_i + r_j), ks = kn/ratio:
//   F_n <- F_n + kn A d(overlap),   F_s <- F_s - ks A du_s,   M_b <- M_b - kn I dtheta_b,   M_t <- M_t - ks J dtheta_t
//   tensile stress at the rim = -F_n/A + beta |M_b| R/I,   shear stress = |F_s|/A + beta |M_t| R/J
// F_n is positive in compression, as in contact laws; F_s, M_b, M_t act on grain j, du_s and dtheta are those of j
// against i. beta, 0 to 1, is the moment-contribution factor (Potyondy 2011, ISRM 12th congress, 1055); 1 is the form
// of 2004. It breaks where the tensile stress passes sigma_c, or the shear stress passes c + tan(phi) F_n/A (tan(phi) =
// 0: the constant strength of 2004).
//
// Interaction surface, another criterion for cement of finite width, after Jiang, Yu and Harris (2006, Int. J. Numer.
// Anal. Methods Geomech. 30, 723) and Shen, Jiang and Thornton (2016, Comput. Geotech. 75, 192): it breaks where F_n <
// -R_n or
//   (|F_s|/R_s)^2 + (|M_b|/R_b)^2 + (|M_t|/R_t)^2 > 1,   R_x = f_x l_x (F_n + R_n) ln((R_c + R_n)/(F_n + R_n))^n_x
// with l_s = 1, l_b = l_t = R, R_n = sigma_c A, R_c = crushing strength times A. n = 0 is the linear law: with the
// stress linear over the width, f_b = I/(A R^2), which is 1/4 of a disc and 1/3 of a rectangle. f and n of a cement
// with a compressive strength are fitted to tests on pairs of its grains.
//
// What turns the vectors with the pair is the solver's; here they are in the frame of the moment.
#pragma once

#include <cmath>

namespace rvelab::interaction {

struct BondSection {
  double radius = 0;   ///< R, m: half the width
  double area = 0;     ///< A, m^2
  double inertia = 0;  ///< I, m^4
  double polar = 0;    ///< J, m^4; in the plane 0
};

inline BondSection disc_section(double radius) {
  constexpr double pi = 3.14159265358979323846;
  const double square = radius * radius;
  return {radius, pi * square, pi * square * square / 4, pi * square * square / 2};
}
inline BondSection rectangle_section(double radius, double thickness) {
  return {radius, 2 * radius * thickness, 2 * radius * radius * radius * thickness / 3, 0};
}

/// Stiffnesses of a bond: kn A and ks A, N/m; kn I and ks J, N m.
struct BondStiffness {
  double normal = 0, shear = 0, bending = 0, twisting = 0;
};
/// kn, ks: per area, Pa/m.
inline BondStiffness bond_stiffness(const BondSection& section, double kn, double ks) {
  return {kn * section.area, ks * section.area, kn * section.inertia, ks * section.polar};
}
/// Modulus, Pa, of cement as long as the branch, m; ratio = kn/ks.
inline BondStiffness bond_stiffness_of_modulus(const BondSection& section, double modulus, double length,
                                               double ratio) {
  return bond_stiffness(section, modulus / length, modulus / (length * ratio));
}

/// What a bond carries in space: F_n, N; F_s on grain j, N; M_b and M_t on grain j, N m.
struct BondForces {
  double normal = 0, shear[3] = {}, bending[3] = {}, twist = 0;
};
/// Motion of grain j against i: overlap gained, m; slip, m; rotation about axes in the section and about the normal.
struct BondIncrement {
  double overlap = 0, slip[3] = {}, bend[3] = {}, twist = 0;
};
inline void advance(BondForces& forces, const BondStiffness& k, const BondIncrement& step) {
  forces.normal += k.normal * step.overlap;
  for (int c = 0; c < 3; ++c) {
    forces.shear[c] -= k.shear * step.slip[c];
    forces.bending[c] -= k.bending * step.bend[c];
  }
  forces.twist -= k.twisting * step.twist;
}

/// In the plane the shear force and the bending moment are one number each.
struct PlanarBondForces {
  double normal = 0, shear = 0, bending = 0;
};
inline void advance(PlanarBondForces& forces, const BondStiffness& k, double overlap, double slip, double bend) {
  forces.normal += k.normal * overlap;
  forces.shear -= k.shear * slip;
  forces.bending -= k.bending * bend;
}

/// What criteria read: F_n (compression positive) and the magnitudes of the others.
struct BondLoad {
  double normal = 0, shear = 0, bending = 0, twist = 0;
};
inline BondLoad load_of(const BondForces& f) {
  const auto magnitude = [](const double* v) { return std::sqrt(v[0] * v[0] + (v[1] * v[1] + v[2] * v[2])); };
  return {f.normal, magnitude(f.shear), magnitude(f.bending), std::fabs(f.twist)};
}
inline BondLoad load_of(const PlanarBondForces& f) { return {f.normal, std::fabs(f.shear), std::fabs(f.bending), 0}; }

/// Energy stored in the springs, J.
inline double bond_energy(const BondStiffness& k, const BondLoad& f) {
  const double twist = k.twisting > 0 ? f.twist * f.twist / k.twisting : 0;
  return 0.5 * (f.normal * f.normal / k.normal + (k.shear > 0 ? f.shear * f.shear / k.shear : 0) +
                f.bending * f.bending / k.bending + twist);
}

struct RimStress {
  double tensile = 0, shear = 0;  ///< Pa, the largest at the rim
};
inline RimStress rim_stress(const BondSection& s, const BondLoad& f, double moment_contribution) {
  const double twist = s.polar > 0 ? f.twist * s.radius / s.polar : 0;
  return {-f.normal / s.area + moment_contribution * f.bending * s.radius / s.inertia,
          f.shear / s.area + moment_contribution * twist};
}

enum class BondFailure { none, tension, shear, bending, twisting, crushing };

/// How much of its strength a bond uses, and what would break it: it breaks above 1.
struct BondUse {
  double share = 0;
  BondFailure by = BondFailure::none;
};

/// Strength at the rim, Pa.
struct RimStrength {
  double tensile = 0;              ///< sigma_c
  double cohesion = 0;             ///< c
  double tan_friction = 0;         ///< tan(phi), 0: constant shear strength
  double moment_contribution = 1;  ///< beta
};
inline BondUse bond_use(const RimStrength& strength, const BondSection& section, const BondLoad& load) {
  const RimStress at = rim_stress(section, load, strength.moment_contribution);
  const double limit = strength.cohesion + strength.tan_friction * load.normal / section.area;
  const double tension = at.tensile > 0 ? at.tensile / strength.tensile : 0;
  const double shear = at.shear > 0 ? (limit > 0 ? at.shear / limit : HUGE_VAL) : 0;
  if (tension >= shear) return {tension, tension > 0 ? BondFailure::tension : BondFailure::none};
  return {shear, BondFailure::shear};
}

/// f and n of one strength of the interaction surface.
struct SurfaceStrength {
  double factor = 0, power = 0;
};
struct InteractionSurface {
  double tensile = 0;                        ///< R_n/A, Pa
  double crushing = HUGE_VAL;                ///< R_c/A, Pa; read where a power is not 0
  SurfaceStrength shear, bending, twisting;  ///< a factor 0 of bending or twisting: that moment does not break it
};
/// The linear surface of cement whose stress is linear over its width, with f_s = tan(phi) of the cement.
inline InteractionSurface surface_of_width(const BondSection& s, double tensile, double tan_friction) {
  const double lever = s.area * s.radius * s.radius;
  return {tensile, HUGE_VAL, {tan_friction, 0}, {s.inertia / lever, 0}, {tan_friction * s.polar / lever, 0}};
}
inline BondUse bond_use(const InteractionSurface& surface, const BondSection& section, const BondLoad& load) {
  const double pulled = surface.tensile * section.area, margin = load.normal + pulled;
  if (margin <= 0) return {pulled > 0 ? -load.normal / pulled : HUGE_VAL, BondFailure::tension};
  const bool logarithmic = surface.shear.power != 0 || surface.bending.power != 0 || surface.twisting.power != 0;
  double left = 1;
  if (logarithmic) {
    const double ratio = (surface.crushing * section.area + pulled) / margin;
    if (ratio <= 1) return {load.normal / (surface.crushing * section.area), BondFailure::crushing};
    left = std::log(ratio);
  }
  const auto part = [&](const SurfaceStrength& strength, double lever, double carried) {
    const double limit = strength.factor * lever * margin;
    const double used =
        limit > 0 ? carried / (strength.power != 0 ? limit * std::pow(left, strength.power) : limit) : 0;
    return used * used;
  };
  const double shear = part(surface.shear, 1, load.shear),
               bending = part(surface.bending, section.radius, load.bending),
               twisting = part(surface.twisting, section.radius, load.twist);
  const double all = std::sqrt(shear + (bending + twisting)), pull = load.normal < 0 ? -load.normal / pulled : 0;
  if (pull >= all) return {pull, pull > 0 ? BondFailure::tension : BondFailure::none};
  return {all, shear >= bending && shear >= twisting ? BondFailure::shear
               : bending >= twisting                 ? BondFailure::bending
                                                     : BondFailure::twisting};
}

/// Contact bond: a glued point that carries forces, not moments, through the springs of the contact; limits in N. While
/// it holds the contact does not slip.
struct ContactBond {
  double tension = 0, shear = 0;
};
inline BondUse bond_use(const ContactBond& bond, double normal, double shear) {
  const double pull = normal < 0 ? (bond.tension > 0 ? -normal / bond.tension : HUGE_VAL) : 0;
  const double across = shear > 0 ? (bond.shear > 0 ? shear / bond.shear : HUGE_VAL) : 0;
  if (pull >= across) return {pull, pull > 0 ? BondFailure::tension : BondFailure::none};
  return {across, BondFailure::shear};
}

/// Part of an increment at which a bond breaks: share(x), x from 0 to 1, passes 1 once between. Bisection, to 2^-50.
template <class Share>
double breaking_part(const Share& share) {
  double low = 0, high = 1;
  for (int halving = 0; halving < 50; ++halving) {
    const double middle = 0.5 * (low + high);
    (share(middle) > 1 ? high : low) = middle;
  }
  return high;
}

}  // namespace rvelab::interaction
