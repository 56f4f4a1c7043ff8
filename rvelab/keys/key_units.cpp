// Keys in another unit of the same quantity. Declared in key.hpp.
#include "rvelab/keys/key.hpp"

namespace rvelab::keys {
namespace {

/// A unit that a user may think in, as a key ends in it, and what one of it is in the unit of the key.
struct OtherUnit {
  const char* suffix;
  const char* factor;
};

struct Quantity {
  const char* unit;    ///< as Key::unit says it
  const char* suffix;  ///< as keys end in it; "" for pure numbers
  std::vector<OtherUnit> others;
};

const std::vector<Quantity>& quantities() {
  static const std::vector<Quantity> all{
      {"Pa",
       "_Pa",
       {{"_kPa", "1 kPa = 1000 Pa"},
        {"_MPa", "1 MPa = 1e6 Pa"},
        {"_GPa", "1 GPa = 1e9 Pa"},
        {"_bar", "1 bar = 1e5 Pa"},
        {"_mbar", "1 mbar = 100 Pa"},
        {"_atm", "1 atm = 101325 Pa"},
        {"_psi", "1 psi = 6894.757293168 Pa"},
        {"_N_m2", "1 N/m^2 = 1 Pa"},
        {"_kN_m2", "1 kN/m^2 = 1000 Pa"},
        {"_N_mm2", "1 N/mm^2 = 1e6 Pa"}}},
      {"m",
       "_m",
       {{"_cm", "1 cm = 0.01 m"}, {"_mm", "1 mm = 1e-3 m"}, {"_um", "1 um = 1e-6 m"}, {"_km", "1 km = 1000 m"}}},
      {"s",
       "_s",
       {{"_ms", "1 ms = 1e-3 s"},
        {"_us", "1 us = 1e-6 s"},
        {"_ns", "1 ns = 1e-9 s"},
        {"_min", "1 min = 60 s"},
        {"_h", "1 h = 3600 s"}}},
      {"1/s",
       "_1_s",
       {{"_1_ms", "1 1/ms = 1000 1/s"},
        {"_1_min", "60 1/min = 1 1/s"},
        {"_1_h", "3600 1/h = 1 1/s"},
        {"_percent_s", "100 percent/s = 1 1/s"},
        {"_percent_min", "6000 percent/min = 1 1/s"},
        {"_percent_h", "360000 percent/h = 1 1/s"}}},
      {"kg/m^3",
       "_kg_m3",
       {{"_g_cm3", "1 g/cm^3 = 1000 kg/m^3"},
        {"_t_m3", "1 t/m^3 = 1000 kg/m^3"},
        {"_g_m3", "1 g/m^3 = 1e-3 kg/m^3"},
        {"_kg_dm3", "1 kg/dm^3 = 1000 kg/m^3"}}},
      {"N/m",
       "_N_m",
       {{"_kN_m", "1 kN/m = 1000 N/m"},
        {"_MN_m", "1 MN/m = 1e6 N/m"},
        {"_N_mm", "1 N/mm = 1000 N/m"},
        {"_kN_mm", "1 kN/mm = 1e6 N/m"}}},
      {"N/m^1.5", "_N_m1_5", {{"_kN_m1_5", "1 kN/m^1.5 = 1000 N/m^1.5"}, {"_MN_m1_5", "1 MN/m^1.5 = 1e6 N/m^1.5"}}},
      {"N s/m", "_N_s_m", {{"_kN_s_m", "1 kN s/m = 1000 N s/m"}, {"_N_s_mm", "1 N s/mm = 1000 N s/m"}}},
      {"degree", "_deg", {{"_rad", "1 rad = 57.29577951308232 degrees"}, {"_degree", "the same unit"}}},
      {"1", "", {{"_percent", "1 percent = 0.01"}, {"_pct", "1 percent = 0.01"}}}};
  return all;
}

}  // namespace

std::optional<UnitAnswer> in_another_unit(const std::string& name, const std::vector<Key>& known) {
  for (const Key& key : known) {
    for (const Quantity& quantity : quantities()) {
      if (key.unit != quantity.unit || !key.name.ends_with(quantity.suffix)) continue;
      const std::string stem = key.name.substr(0, key.name.size() - std::string(quantity.suffix).size());
      for (const OtherUnit& other : quantity.others) {
        if (name == stem + other.suffix) return UnitAnswer{key, other.factor};
      }
    }
  }
  return std::nullopt;
}

}  // namespace rvelab::keys
