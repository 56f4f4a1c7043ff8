// A material point: what moves with the soil.
#pragma once

#include "tools/mpm/tensors.hpp"

namespace mpm {

template <int D>
struct Point {
  Vec<D> position = Vec<D>::Zero();  ///< m
  Vec<D> velocity = Vec<D>::Zero();  ///< m/s
  Mat<D> stress = Mat<D>::Zero();    ///< Pa, Cauchy, tension positive
  double stress_zz = 0;              ///< Pa, out of the plane (D = 2; zero for grains, which have no such model)
  double mass = 0;                   ///< kg
  double volume = 0;                 ///< m^3, now
  double work = 0;                   ///< J, of the stress since the start
  Mat<D> affine = Mat<D>::Zero();    ///< 1/s, velocity gradient at the end of the step before, where the points are now
  Mat<D> gradient = Mat<D>::Zero();  ///< logarithm of the deformation increment of the step that is made
  Mat<D> F = Mat<D>::Identity();     ///< deformation gradient since the start
  Mat<D> strain = Mat<D>::Zero();    ///< sum of the symmetric parts of dH (Liang and Zhao 2019, step b-ii)
  Vec<D> first = Vec<D>::Zero();     ///< m, position at the start
  Vec<D> half = Vec<D>::Zero();      ///< m, half the sides of the point's first domain
};

}  // namespace mpm
