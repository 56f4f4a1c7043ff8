// The table of the quantities that may be measured at a record beside strain and stress. Everything takes them from
// here: records, record files and journals, the key output.quantities, the events of stages (those that are numbers)
// and the program's --json.
//
// A new quantity is a header with its struct (quantity.hpp), its #include and its line here.
#pragma once

#include "rvelab/records/quantity.hpp"
#include "rvelab/records/quantity_energy.hpp"
#include "rvelab/records/quantity_fabric.hpp"
#include "rvelab/records/quantity_packing.hpp"
#include "rvelab/records/quantity_stress.hpp"

namespace rvelab::records {

/// New ones come last: journals name what was asked for by the places here.
using Quantities = QuantityTable<  //
    VoidRatio,                     //
    CoordinationNumber,            //
    FabricAnisotropy,              //
    SlidingFraction,               //
    MechanicalVoidRatio,           //
    MechanicalCoordinationNumber,  //
    Fabric,                        //
    BranchFabric,                  //
    ContactStress,                 //
    ReynoldsStress,                //
    ElasticEnergy,                 //
    KineticEnergy,                 //
    OrientationFabric              //
    >;

inline constexpr auto quantity_rows = Quantities::rows();

/// Bit of a quantity in RecordedState::quantities.
template <class Quantity>
inline constexpr std::uint64_t asked = Quantities::bit_of<Quantity>();

/// Measured where a protocol does not say.
inline constexpr std::uint64_t usual_quantities = [] {
  std::uint64_t bits = 0;
  for (const QuantityRow& row : quantity_rows) bits |= row.text.usual ? row.bit : 0;
  return bits;
}();

/// Every quantity of the table.
inline constexpr std::uint64_t all_quantities = [] {
  std::uint64_t bits = 0;
  for (const QuantityRow& row : quantity_rows) bits |= row.bit;
  return bits;
}();

}  // namespace rvelab::records
