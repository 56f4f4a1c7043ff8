// Increments that are resolved so finely that their own error is far below any tolerance.
#pragma once

#include "tests/specimens.hpp"

namespace rvelab::test {

inline const Matrix3 biaxial_step = gradient(0.45, 0, 0, -0.9), shear_step = gradient(0.3, 0.6, 0, -0.3);

inline Matrix3 resolved_stress(Specimen s, const Matrix3& increment, long substeps = 4000) {
  s.solver.fixed_substeps = substeps;
  Rve rve(s);
  rve.apply(increment, 0);
  rve.relax(1e-7, 100'000);
  return rve.stress();
}

}  // namespace rvelab::test
