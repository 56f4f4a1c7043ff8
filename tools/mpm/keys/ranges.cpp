// The ranges of units. Declared in keys.hpp.
#include "tools/mpm/keys/keys.hpp"

namespace mpm {
namespace {

struct Ending {
  const char* ending;
  Range range;
};

/// Longer endings before those that they end with.
constexpr Ending endings[] = {
    {"conductivity_m_s", {"m/s", 1e-18, 1e3}},  // clay 1e-12, gravel 1
    {"modulus_Pa", {"Pa", 1e-3, 1e13}},         // gels 1; diamond 1e12
    {"_kg_m3", {"kg/m^3", 1e-3, 1e9}},          // air 1; mass scaling of quasi-static tests
    {"_rad_s", {"rad/s", 1e-9, 1e9}},           //
    {"_m_s2", {"m/s^2", 1e-9, 1e9}},            // a centrifuge 1e3, an impact 1e6
    {"_m_s", {"m/s", 1e-12, 1e6}},              // waves in diamond 2e4
    {"_m2", {"m^2", 1e-18, 1e18}},              //
    {"_deg", {"degree", 1e-9, 36000}},          // a hundred turns
    {"_kg", {"kg", 1e-18, 1e18}},               //
    {"_Pa", {"Pa", 1e-3, 1e13}},                //
    {"_Hz", {"Hz", 1e-9, 1e9}},                 //
    {"_s", {"s", 1e-12, 1e12}},                 //
    {"_m", {"m", 1e-9, 1e9}},                   // clay 1e-6; coordinates of a map 1e7
};

}  // namespace

Range range_of(const std::string& key) {
  for (const auto& each : endings) {
    if (key.ends_with(each.ending)) return each.range;
  }
  return {"1", 1e-12, 1e12};
}

}  // namespace mpm
