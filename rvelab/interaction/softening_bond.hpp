// Beams that soften: past its strength a bond bears less and less, and breaks when it has spent its fracture energy.
// Springs as in beam.hpp, followed as if the bond were whole; r is the share of its strength that they use,
//
//   r = max((-f_n/A + beta |M_b| R/I)/sigma_t, (|f_s|/A + beta |M_t| R/J)/(c + tan(phi) f_n/A))
//   D = r_f (r - 1)/(r (r_f - 1)) of the largest r there was, 0 to 1,   r_f = 2 G kn/sigma_t^2
//
// and it bears 1 - D of them, pressure whole. In tension that is a straight line from sigma_t at the opening sigma_t/kn
// down to zero at 2 G/sigma_t, so that G (J/m^2) is spent (Hillerborg, Modeer and Petersson 1976, Cem. Concr. Res. 6,
// 773-781). Other modes soften over the same r_f. r_f <= 1 is brittle. Broken at D = 1, by what used most of the
// strength.
#pragma once

#include "rvelab/interaction/law.hpp"

namespace rvelab {

struct SofteningBond : BondLaw<SofteningBond> {
  static constexpr const char* name = "softening_bonds";
  static constexpr InteractionField fields[] = {
      {"gap_m", "m", any_number},                           // when it was made
      {"radius_m", "m", positive_number},                   // R
      {"normal_stiffness_Pa_m", "Pa/m", number_from_zero},  // kn
      {"shear_stiffness_Pa_m", "Pa/m", number_from_zero},   // ks
      {"tensile_strength_Pa", "Pa", positive_number},       // sigma_t
      {"cohesion_Pa", "Pa", number_from_zero},              // c
      {"friction", "1", number_from_zero},                  // tan(phi)
      {"moment_factor", "1", {0, 1}},                       // beta
      {"last_share", "1", number_from_zero},                // r_f
      {"largest_share", "1", number_from_zero},             // of r
      {"broken", "1", {0, 2}, Turning::scalar, true},       // 0 no, 1 in tension, 2 in shear
      {"released_energy_J", "J", number_from_zero},         // spent by softening so far
      {"whole_shear_force_N", "N", any_number, Turning::tangent},
      {"whole_bending_moment_N_m", "N m", any_number, Turning::moment},
      {"whole_twisting_moment_N_m", "N m", any_number},
  };
  enum Column {
    first_gap,
    radius,
    normal_stiffness,
    shear_stiffness,
    tensile_strength,
    cohesion,
    friction,
    moment_factor,
    last_share,
    largest_share,
    broken,
    released,
    shear_force,
    bending_moment = shear_force + 3,
    twisting_moment = bending_moment + 3,
  };

  static constexpr double pi = 3.14159265358979323846, smallest = 1e-300;

  /// Part of the springs' forces that is lost, of the largest share there was.
  template <class V>
  static inline __attribute__((always_inline)) V damage(V largest, V last) {
    const V zero = V{}, one = zero + 1.0;
    const auto softens = (largest > one) & (largest < last);
    const V d = last * (largest - one) / ((softens ? largest : one) * (softens ? last - one : one));
    return softens ? d : ((largest > one) ? one : zero);
  }

  template <class Columns>
  static InteractionStiffness stiffness(const Columns& column, double gap, double thickness) {
    if (column(broken) != 0) return {};
    const double r = column(radius), area = thickness > 0 ? 2 * r * thickness : pi * r * r;
    const double inertia = area * r * r / (thickness > 0 ? 3 : 4);
    const double left = 1 - damage<double>(column(largest_share), column(last_share));
    return {(gap < column(first_gap) ? 1 : left) * column(normal_stiffness) * area,
            left * column(shear_stiffness) * area, left * column(normal_stiffness) * inertia,
            thickness > 0 ? 0 : 2 * left * column(shear_stiffness) * inertia};
  }
  static constexpr bool has_energy = true;
  template <class Columns>
  static double energy(const Columns& column, double gap, double thickness) {
    if (column(broken) != 0) return 0;
    const double r = column(radius), area = thickness > 0 ? 2 * r * thickness : pi * r * r;
    const double inertia = area * r * r / (thickness > 0 ? 3 : 4), kn = column(normal_stiffness),
                 ks = column(shear_stiffness);
    const auto squared = [&](int first) {
      return column(first) * column(first) +
             (column(first + 1) * column(first + 1) + column(first + 2) * column(first + 2));
    };
    const auto of = [](double square, double stiffness) { return stiffness > 0 ? 0.5 * square / stiffness : 0; };
    const double normal = kn * area * (column(first_gap) - gap), twist = column(twisting_moment);
    const double left = 1 - damage<double>(column(largest_share), column(last_share));
    return (normal > 0 ? 1 : left) * of(normal * normal, kn * area) +
           left * (of(squared(shear_force), ks * area) +
                   (of(squared(bending_moment), kn * inertia) + of(twist * twist, 2 * ks * inertia)));
  }

  /// Springs of W bonds: N, N m, and their section. `bending` and `shear` are magnitudes.
  template <class V>
  struct Springs {
    V normal, shear, bending, twisting, area, kn, ks, inertia;
  };
  /// What is left of the springs after this step; 0: broken. `rim`: A R/I; `polar`: J/I or 0.
  template <bool Advance, class V>
  static inline __attribute__((always_inline)) V left_of(const InteractionArrays& p, long at, const Springs<V>& s,
                                                         double rim) {
    const V zero = V{}, one = zero + 1.0, two = zero + 2.0;
    const auto load = [&](int k) { return load_as<V>(p.column[k] + at); };
    V was = load(broken), largest = load(largest_share);
    const V last = load(last_share), before = damage<V>(largest, last);
    if constexpr (Advance) {
      const auto over = [&](V load, V limit) { return load / ((limit > smallest) ? limit : zero + smallest); };
      const V r = load(radius), factor = load(moment_factor);
      const V tension = over(over(rim * factor * s.bending, r) - s.normal, load(tensile_strength) * s.area);
      const V shear =
          over(s.shear + over(2.0 * (factor * s.twisting), r), load(cohesion) * s.area + load(friction) * s.normal);
      const V share = (tension > shear) ? tension : shear;
      largest = (share > largest) ? share : largest;
      const V now = damage<V>(largest, last);
      // Softening spends the energy of what is lost: that of the whole springs, pressure apart, times dD.
      const auto of = [&](V square, V stiffness) {
        const auto there = stiffness > 0.0;
        return there ? 0.5 * square / (there ? stiffness : one) : zero;
      };
      const V pull = (s.normal < zero) ? s.normal : zero;
      const V whole =
          (of(pull * pull, s.kn * s.area) + of(s.shear * s.shear, s.ks * s.area)) +
          (of(s.bending * s.bending, s.kn * s.inertia) + of(s.twisting * s.twisting, 2.0 * (s.ks * s.inertia)));
      const auto intact = was == zero;
      const V spent = load(released);
      const V how = (now < one) ? zero : ((tension > shear) ? one : two);
      // One that breaks lets go of what pressure stored in it too.
      const V push = (s.normal > zero) ? s.normal : zero;
      const V pressed = (how == zero) ? zero : of(push * push, s.kn * s.area);
      store_as(p.column[released] + at, intact ? spent + ((now - before) * whole + pressed) : spent);
      was = intact ? how : was;
      store_as(p.column[broken] + at, was);
      store_as(p.column[largest_share] + at, largest);
      return (was == zero) ? one - now : zero;
    }
    return (was == zero) ? one - before : zero;
  }

  template <bool Advance, class V>
  static inline __attribute__((always_inline)) PlaneForces<V> in_plane(const InteractionArrays& p, long at,
                                                                       const PlaneMotion<V>& m) {
    const V zero = V{};
    const V r = load_as<V>(p.column[radius] + at), area = (2.0 * p.thickness) * r,
            inertia = area * (r * r) * (1.0 / 3.0);
    const V kn = load_as<V>(p.column[normal_stiffness] + at), ks = load_as<V>(p.column[shear_stiffness] + at);
    const V gap = m.length - (load_as<V>(p.radius_i + at) + load_as<V>(p.radius_j + at));
    const V normal = (kn * area) * (load_as<V>(p.column[first_gap] + at) - gap);
    V shear = load_as<V>(p.column[shear_force] + at), bending = load_as<V>(p.column[bending_moment + 2] + at);
    if constexpr (Advance) {
      shear = shear - (ks * area) * m.slip;
      bending = bending - (kn * inertia) * m.turn;
    }
    const V left = left_of<Advance, V>(
        p, at, {normal, magnitude_of(shear), magnitude_of(bending), zero, area, kn, ks, inertia}, 3);
    if constexpr (Advance) {
      const auto intact = left > zero;
      store_as(p.column[shear_force] + at, intact ? shear : zero);
      store_as(p.column[bending_moment + 2] + at, intact ? bending : zero);
    }
    const auto pressed = (normal > zero) & (left > zero);
    return {pressed ? normal : left * normal, left * shear, left * bending};
  }

  /// `turned`: shear force and bending moment, in the present tangent plane.
  template <bool Advance, class V>
  static inline __attribute__((always_inline)) SpaceForces<V> in_space(const InteractionArrays& p, long at,
                                                                       const SpaceTurn<V>& m, const Triple<V>* turned) {
    const V zero = V{};
    const V r = load_as<V>(p.column[radius] + at), area = pi * (r * r), inertia = area * (r * r) * 0.25;
    const V kn = load_as<V>(p.column[normal_stiffness] + at), ks = load_as<V>(p.column[shear_stiffness] + at);
    const V gap = m.length - (load_as<V>(p.radius_i + at) + load_as<V>(p.radius_j + at));
    const V normal = (kn * area) * (load_as<V>(p.column[first_gap] + at) - gap);
    Triple<V> shear = turned[0], bending = turned[1];
    V twist = load_as<V>(p.column[twisting_moment] + at);
    if constexpr (Advance) {
      shear = plus(shear, -(ks * area), m.slip);
      const V about = dot(m.n, m.turn);
      bending = plus(bending, -(kn * inertia), plus(m.turn, -about, m.n));
      twist = twist - (ks * (2.0 * inertia)) * about;
    }
    const V left = left_of<Advance, V>(p, at,
                                       {normal, square_root(dot(shear, shear)), square_root(dot(bending, bending)),
                                        magnitude_of(twist), area, kn, ks, inertia},
                                       4);
    if constexpr (Advance) {
      const auto intact = left > zero;
      const Triple<V> none = {zero, zero, zero};
      store_vec(p.column + shear_force, at, chosen(intact, shear, none));
      store_vec(p.column + bending_moment, at, chosen(intact, bending, none));
      store_as(p.column[twisting_moment] + at, intact ? twist : zero);
    }
    const auto pressed = (normal > zero) & (left > zero);
    SpaceForces<V> f;
    f.normal = pressed ? normal : left * normal;
    f.tangential = times(left, shear);
    f.moment = times(left, plus(bending, twist, m.n));
    return f;
  }
};

}  // namespace rvelab
