// Probes of the stiffness in tests, with the state in which each was made. Internal to the module.
#pragma once

#include <vector>

#include "rvelab/sheet/sheet.hpp"

namespace rvelab::sheet {

struct Probed {
  const Test* test = nullptr;
  double G = unknown;           ///< Pa, mean shear stiffness
  double pressure = unknown;    ///< Pa: that the stages before it bring the grains to
  double p = unknown;           ///< Pa: at the record before it, else that pressure
  double void_ratio = unknown;  ///< the same; without records that of the start of the test
};

/// Of the tests of isotropic compression, and of others before their loading begins.
std::vector<Probed> probed_moduli(const std::vector<Test>& tests);

}  // namespace rvelab::sheet
