// Mean curves of tests over their seeds. Internal to the module.
#pragma once

#include "rvelab/sheet/sheet.hpp"
#include "tools/models/models.hpp"

namespace rvelab::sheet {

/// Of one density, pressure and amplitude. Its name is the label of its curves in figures.
struct MeanTest {
  Purpose purpose = Purpose::drained;
  std::size_t density = 0;
  double pressure = unknown;
  models::ElementTest curve;      ///< of undrained simple shear strain is gamma, q tau, p the normal stress
  std::vector<double> deviation;  ///< half of the 95 % interval of q; empty of a single seed
};
std::vector<MeanTest> mean_tests(const std::vector<Test>& tests);

}  // namespace rvelab::sheet
