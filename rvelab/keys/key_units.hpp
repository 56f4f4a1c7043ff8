// Keys end in their unit. A key that ends in another unit of the same quantity ("pressure_kPa") is answered with the
// right key and the factor; nothing is converted silently.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "rvelab/keys/key.hpp"

namespace rvelab::keys {

/// The right key and how the two units go together: "pressure_Pa", "1 kPa = 1000 Pa".
struct UnitAnswer {
  Key key;
  std::string factor;
};

/// The known key that `name` (without its table) means in another unit; none if it is no known key with another unit.
std::optional<UnitAnswer> in_another_unit(const std::string& name, const std::vector<Key>& known);

}  // namespace rvelab::keys
