// Quantities of how grains are packed (rvelab/measure/measures.hpp).
#pragma once

#include "rvelab/measure/measures.hpp"
#include "rvelab/records/quantity.hpp"

namespace rvelab::records {

struct VoidRatio {
  double void_ratio = 0;
  static constexpr QuantityText text{"void_ratio", "1", "overlaps not subtracted", true};
  static constexpr auto member = &VoidRatio::void_ratio;
  static double measure(const Rve&, const Network& network) { return rvelab::void_ratio(network); }
};

struct CoordinationNumber {
  double coordination_number = 0;
  static constexpr QuantityText text{"coordination_number", "1", "2 Nc/N, all grains", true};
  static constexpr auto member = &CoordinationNumber::coordination_number;
  static double measure(const Rve&, const Network& network) { return rvelab::coordination_number(network); }
};

struct SlidingFraction {
  double sliding_fraction = 0;
  static constexpr QuantityText text{"sliding_fraction", "1", "contacts on the Coulomb cone", true};
  static constexpr auto member = &SlidingFraction::sliding_fraction;
  static double measure(const Rve&, const Network& network) { return rvelab::sliding_fraction(network); }
};

struct MechanicalVoidRatio {
  double mechanical_void_ratio = 0;
  static constexpr QuantityText text{"mechanical_void_ratio", "1", "rattlers counted as voids"};
  static constexpr auto member = &MechanicalVoidRatio::mechanical_void_ratio;
  static double measure(const Rve&, const Network& network) { return rvelab::mechanical_void_ratio(network); }
};

struct MechanicalCoordinationNumber {
  double mechanical_coordination_number = 0;
  static constexpr QuantityText text{"mechanical_coordination_number", "1", "without rattlers and their contacts"};
  static constexpr auto member = &MechanicalCoordinationNumber::mechanical_coordination_number;
  static double measure(const Rve&, const Network& network) { return rvelab::mechanical_coordination_number(network); }
};

}  // namespace rvelab::records
