// Beams (beam.hpp) that break where their load leaves a surface in the space of normal force, shear force and moments:
// cement of finite width after Jiang, Yu and Harris (2006, Int. J. Numer. Anal. Methods Geomech. 30, 723-761) and Shen,
// Jiang and Thornton (2016, Comput. Geotech. 75, 192-209), their form that is linear in the normal force.
//
//   f_n < -R_n,   or   (|f_s|/R_s)^2 + (|M_b|/R_b)^2 + (|M_t|/R_t)^2 > 1
//   R_n = tensile strength A,   R_s = f_s' (f_n + R_n),   R_b = f_b' R (f_n + R_n),   R_t = f_t' R (f_n + R_n)
//
// A factor f_b' or f_t' of 0: that moment does not break it. With the stress linear over the width f_b' is I/(A R^2),
// 1/4 of a disc and 1/3 of a rectangle. Broken in tension where it was pulled, in shear where it was pressed.
#pragma once

#include "rvelab/interaction/beam.hpp"

namespace rvelab {

struct LoadSurface {
  static constexpr const char* name = "surface_bonds";
  static constexpr InteractionField strengths[] = {{"tensile_strength_Pa", "Pa", number_from_zero},
                                                   {"shear_factor", "1", positive_number},
                                                   {"bending_factor", "1", number_from_zero},
                                                   {"twisting_factor", "1", number_from_zero}};
  enum Strength { tensile, shear_factor, bending_factor, twisting_factor };

  template <class V>
  static inline __attribute__((always_inline)) V broken_by(const V* strength, const BeamLoad<V>& load) {
    const V zero = V{}, one = zero + 1.0, two = zero + 2.0;
    const V margin = load.normal + strength[tensile] * load.area, lever = load.radius * load.radius;
    const auto part = [&](V squared, V factor) {
      const auto counts = factor > zero;
      return counts ? squared / (counts ? factor * factor : one) : zero;
    };
    const V used = part(load.shear_squared, strength[shear_factor]) +
                   (part(load.bending_squared, strength[bending_factor]) / lever +
                    part(load.twisting * load.twisting, strength[twisting_factor]) / lever);
    const auto breaks = (margin < zero) | (used > margin * margin);
    return breaks ? ((load.normal < zero) ? one : two) : zero;
  }
};

struct SurfaceBond : Beam<LoadSurface> {
  enum Strength { tensile_strength = strength, shear_factor, bending_factor, twisting_factor };  ///< columns
};

}  // namespace rvelab
