// Records of tests that are made by hand.
#pragma once

#include <cmath>
#include <vector>

#include "rvelab/records/record.hpp"

namespace rvelab::test {

/// Of a plane compression along y: strains compression positive, stresses compression positive.
inline records::Record biaxial_record(double axial, double lateral, double axial_stress, double lateral_stress) {
  records::Record record;
  record.strain = axial;
  record.deformation_gradient(0, 0) = 1 - lateral;
  record.deformation_gradient(1, 1) = 1 - axial;
  record.stress(0, 0) = -lateral_stress;
  record.stress(1, 1) = -axial_stress;
  return record;
}

/// Of simple shear in xy under a normal stress (compression positive).
inline records::Record shear_record(double gamma, double tau, double normal_stress = 1e5) {
  records::Record record;
  record.strain = gamma;
  record.deformation_gradient(0, 1) = gamma;
  record.stress(0, 0) = record.stress(1, 1) = -normal_stress;
  record.stress(0, 1) = record.stress(1, 0) = tau;
  return record;
}

}  // namespace rvelab::test
