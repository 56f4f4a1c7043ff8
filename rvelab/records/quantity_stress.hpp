// Parts of the stress, laboratory frame, tension positive; both together are that of the record.
#pragma once

#include "rvelab/records/quantity.hpp"

namespace rvelab::records {

struct ContactStress {
  Matrix3 contact_stress = Matrix3::Zero();
  static constexpr QuantityText text{"contact_stress_Pa", "Pa", "of the contact forces alone"};
  static constexpr auto member = &ContactStress::contact_stress;
  static Matrix3 measure(const Rve& rve, const Network&) { return rve.contact_stress(); }
};

struct ReynoldsStress {
  Matrix3 reynolds_stress = Matrix3::Zero();
  static constexpr QuantityText text{"reynolds_stress_Pa", "Pa", "of the fluctuations alone"};
  static constexpr auto member = &ReynoldsStress::reynolds_stress;
  static Matrix3 measure(const Rve& rve, const Network&) { return rve.reynolds_stress(); }
};

}  // namespace rvelab::records
