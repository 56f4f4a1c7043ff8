// Quantities of the directions of contacts and grains, laboratory frame (rvelab/measure/measures.hpp).
#pragma once

#include "rvelab/measure/measures.hpp"
#include "rvelab/records/quantity.hpp"

namespace rvelab::records {

struct Fabric {
  Matrix3 fabric = Matrix3::Zero();
  static constexpr QuantityText text{"fabric", "1", "mean of n (x) n over the contacts"};
  static constexpr auto member = &Fabric::fabric;
  static Matrix3 measure(const Rve&, const Network& network) { return rvelab::fabric(network); }
};

struct BranchFabric {
  Matrix3 branch_fabric = Matrix3::Zero();
  static constexpr QuantityText text{"branch_fabric", "1", "sum b (x) b / sum b.b"};
  static constexpr auto member = &BranchFabric::branch_fabric;
  static Matrix3 measure(const Rve&, const Network& network) { return rvelab::branch_fabric(network); }
};

struct OrientationFabric {
  Matrix3 orientation_fabric = Matrix3::Zero();
  static constexpr QuantityText text{"orientation_fabric", "1",
                                     "ellipses: mean of e (x) e over the grains, e along the long axis; NaN if round"};
  static constexpr auto member = &OrientationFabric::orientation_fabric;
  static Matrix3 measure(const Rve&, const Network& network) { return rvelab::orientation_fabric(network); }
};

struct FabricAnisotropy {
  double fabric_anisotropy = 0;
  static constexpr QuantityText text{"fabric_anisotropy", "1", "of contact normals", true};
  static constexpr auto member = &FabricAnisotropy::fabric_anisotropy;
  static double measure(const Rve&, const Network& network) {
    return rvelab::fabric_anisotropy(fabric(network), network.dimension());
  }
};

}  // namespace rvelab::records
