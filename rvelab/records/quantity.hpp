// The declaration of a quantity of records, and the table of such quantities.
//
// A quantity is a struct with one member, the value (a number or a 3x3 tensor), and
//   static constexpr QuantityText text   its name, unit and meaning
//   static constexpr auto member         its member
//   static measure(state)                the function that measures it
// A record inherits the structs of the table (quantities.hpp), so that the value is a member of the record by its name.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <type_traits>

#include "rvelab/cell/cell.hpp"
#include "rvelab/measure/anisotropy.hpp"
#include "rvelab/measure/force_networks.hpp"
#include "rvelab/solver/assembly/network.hpp"
#include "rvelab/solver/rve.hpp"

namespace rvelab::records {

/// A state that is measured. Intermediate results of several quantities are computed once, for the first of them.
class MeasuredState {
 public:
  explicit MeasuredState(const Rve& measured) : rve(measured), network(measured.network()) {}
  const Rve& rve;
  const Network network;
  const StressForceFabric& relation() const {
    if (!relation_) relation_ = stress_force_fabric(network);
    return *relation_;
  }
  std::size_t acting(Family family) const;  ///< number of active interactions
  double water_volume() const;              ///< of the bridges, m^3
  const ForceNetworks& networks() const {
    if (!networks_) networks_ = force_networks(network);
    return *networks_;
  }

 private:
  mutable std::optional<StressForceFabric> relation_;
  mutable std::optional<ForceNetworks> networks_;
};

struct QuantityText {
  const char* name;  ///< in [output] quantities, in --json, and of the dataset under /records; ends in its unit
  const char* unit;  ///< "1" for a pure number
  const char* meaning;
  bool usual = false;  ///< measured by default
};

/// A row of the table without the type of its struct.
struct QuantityRow {
  QuantityText text;
  std::uint64_t bit;  ///< in RecordedState::quantities
  bool tensor;        ///< shape 3, 3 and not one number
};

/// Value of a quantity: double or Matrix3.
template <class Quantity>
using ValueOf = std::remove_reference_t<decltype(std::declval<Quantity&>().*Quantity::member)>;

/// The quantities of a record, in the order of their bits.
template <class... Each>
struct QuantityTable : Each... {
  static_assert(sizeof...(Each) <= 64, "each has a bit of RecordedState::quantities");

  /// visit(std::type_identity<Quantity>, bit) for each, in order.
  template <class Visit>
  static constexpr void for_each(Visit visit) {
    std::uint64_t bit = 1;
    ((visit(std::type_identity<Each>{}, bit), bit <<= 1), ...);
  }

  static constexpr std::array<QuantityRow, sizeof...(Each)> rows() {
    std::array<QuantityRow, sizeof...(Each)> list{};
    std::size_t k = 0;
    for_each([&]<class Quantity>(std::type_identity<Quantity>, std::uint64_t bit) {
      list[k++] = {Quantity::text, bit, std::is_same_v<ValueOf<Quantity>, Matrix3>};
    });
    return list;
  }

  /// Bit of a quantity; the table must have it.
  template <class Quantity>
  static constexpr std::uint64_t bit_of() {
    static_assert((std::is_same_v<Quantity, Each> || ...));
    std::uint64_t found = 0;
    for_each([&]<class Other>(std::type_identity<Other>, std::uint64_t bit) {
      if (std::is_same_v<Quantity, Other>) found = bit;
    });
    return found;
  }
};

}  // namespace rvelab::records
