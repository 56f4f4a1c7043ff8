// Motion of grains between two states: relative to the mean deformation, and the strain around each grain.
//
// The fluctuation of a grain is x' - F x to the nearest image, F the deformation between the states. The strain around
// it is that of the gradient with the best fit to the changes of the branches of its contacts and those of its
// neighbours (least squares; as Falk and Langer 1998): F - I + (sum dw (x) b)(sum b (x) b)^-1, with b the branch at the
// earlier state and dw the difference of the fluctuations.
#pragma once

#include <vector>

#include "rvelab/solver/assembly/network.hpp"

namespace rvelab::report {

/// Laboratory frame.
struct Motion {
  explicit Motion(const Network& first);
  void go_on(const Network& before, const Network& after, const Matrix3& deformation);

  std::vector<Vector3> fluctuation;  ///< m, since the first state, convected with the mean deformation
  std::vector<double> shear;         ///< eps_q of the last step (measures.hpp); NaN: too few neighbours
  std::vector<double> volume;        ///< compression positive
};

}  // namespace rvelab::report
