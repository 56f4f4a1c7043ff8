// Stratified sampling: sizes of grains that keep d10, d50 and d90 by mass of a grading however few the grains are.
//
// One grain from each of N equal parts of the number (grains.sampling = "random") has the curve by number. Its mass,
// which grows with r^3, is left to the few largest grains: of 500 spheres with d60/d10 = 4 the largest stands for a
// quarter of the mass, is drawn at random from it, and d90 is up to a third off. Here
//   1. each of N equal parts of the number (stratum) gets the grain of its mean mass, so that the mass up to the end of
//      each is that of the curve, and the total that of N grains;
//   2. if one of d10, d50, d90 is then off, the three get a grain of their own size each, so placed that the mass below
//      it is less than 10 (50, 90) % of all and the mass up to it more. Strata as above fill the mass between the
//      three. Their numbers are whole: each of the three grains may be shifted by half its mass for it. The mass of all
//      is that with which the grains are N.
#pragma once

#include "rvelab/pack/mass_curve.hpp"

namespace rvelab::pack {

/// Largest error of d10, d50 and d90 by mass of stratified grains.
inline constexpr double sampling_tolerance = 0.03;

struct Sample {
  std::vector<double> radii;  ///< m, ascending
  double deviation = 0;       ///< largest of |d/d of the curve - 1|, d10, d50, d90
};

/// `count` grains of a curve, the same for every seed. `mean_power`: mean of r^dimension to which all are scaled, m^d;
/// 0: as they are. The deviation is infinite where no double holds the powers of the radii.
Sample stratified_sample(const MassCurve& curve, std::size_t count, double mean_power = 0);

/// Largest of |d/d of the curve - 1| of radii, for d10, d50 and d90 by mass.
double deviation_of(const std::vector<double>& radii, const MassCurve& curve);

}  // namespace rvelab::pack
