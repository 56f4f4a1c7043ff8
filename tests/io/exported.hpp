// Specimens that tests export.
#pragma once

#include <Eigen/LU>
#include <cmath>
#include <string>

#include "random_specimen.hpp"
#include "rvelab/io/export/export.hpp"
#include "rvelab/solver/rve.hpp"
#include "tests/catch.hpp"
#include "tests/reference_specimen.hpp"

namespace rvelab::test {

/// Sheared and turned, so that the lattice leans and the frame is not the laboratory's.
inline Specimen sheared(const std::string& name) {
  Rve rve(reference_specimen(name));
  Matrix3 dh = Matrix3::Zero();
  const int d = rve.cell().dimension;
  dh(0, d - 1) = 0.004;
  dh(d - 1, 0) = -0.002;
  if (d == 3) dh(0, 1) = dh(2, 1) = 0.003;
  for (int k = 0; k < 3; ++k) rve.apply(dh, 0);
  Specimen specimen = rve.specimen();
  CHECK((specimen.cell.rotation - Matrix3::Identity()).norm() > 1e-3);
  return specimen;
}

inline io::ExportState state_of(const Specimen& specimen, long record = 0) {
  const Rve rve(specimen);
  return {record, 0, rve.specimen(), rve.network()};
}

/// x modulo the lattice, as fractions next to zero.
inline Vector3 apart(const Matrix3& lattice, const Vector3& difference) {
  Vector3 fraction = lattice.inverse() * difference;
  for (int k = 0; k < 3; ++k) fraction[k] -= std::round(fraction[k]);
  return fraction;
}

}  // namespace rvelab::test
