#include "rvelab/protocol/stage_readers.hpp"

#include <algorithm>
#include <cmath>

namespace rvelab::protocol {

using keys::TableReader;

double pressure_of(TableReader& reader, const char* name, const keys::Range& range, const char* meaning,
                   Protocol& protocol, const std::string& unless) {
  const auto own = reader.optional_number(name, "Pa", range, meaning, "(test.pressure_Pa)");
  if (!unless.empty()) reader.refuse(name, "contradicts " + unless + "; allowed: one of the two; remove one");
  if (reader.has(name) || !unless.empty()) return own.value_or(0);
  if (std::isnan(protocol.pressure)) {
    reader.expect(name, "is missing, and so is test.pressure_Pa; allowed: > 0 Pa; add one of them");
    return 0;
  }
  protocol.uses_pressure = true;
  reader.resolve(name, protocol.pressure);
  return protocol.pressure;
}

void read_spacing(TableReader& reader, double& record_every, double to_strain, const char* meaning) {
  reader.number("record_every", record_every, "1", keys::positive, meaning);
  const double records = std::abs(to_strain) / record_every;
  if (records > most_records)
    reader.mistake("record_every",
                   "gives " + std::to_string(records) + " records; allowed: at most 1000000; give a larger spacing");
}

void read_strain(TableReader& reader, double& to_strain, const Interval& range, const char* meaning,
                 const char* allowed) {
  if (reader.required_number("to_strain", to_strain, "1", range, meaning, allowed) && to_strain == 0)
    reader.mistake("to_strain", "goes nowhere; allowed: not 0; give the strain at which the stage ends");
}

void read_cycles(TableReader& reader, Cycles& cycles, double to_strain, double record_every,
                 const char* reverse_meaning) {
  reader.whole_number("cycles", cycles.count, {0, 1e6},
                      "number of cycles between +-to_strain; 0: monotonic to to_strain");
  cycles.reverse_at = reader.optional_number("reverse_at_Pa", "Pa", keys::positive, reverse_meaning).value_or(0);
  if (reader.has("reverse_at_Pa") && cycles.count == 0)
    reader.mistake("reverse_at_Pa", "has nothing to turn; allowed: with cycles > 0 only; give cycles, or remove it");
  const double records = 4 * double(cycles.count) * std::abs(to_strain) / record_every;
  if (records > most_records)
    reader.mistake("cycles", "gives up to " + std::to_string(records) +
                                 " records; allowed: at most 1000000; give fewer cycles or a larger record_every");
}

std::string read_axes(TableReader& reader, const char* name, const keys::Choices& axes, const char* meaning,
                      const char* usual_2d, const char* usual_3d, const Protocol& protocol) {
  const std::string usual = protocol.dimension == 0 ? "" : protocol.dimension == 2 ? usual_2d : usual_3d;
  const std::string initial = std::string("(") + usual_2d + " in 2D, " + usual_3d + " in 3D)";
  const std::string found = reader.choice(name, usual, axes, meaning, initial.c_str());
  if (protocol.dimension == 2 && found.find('z') != std::string::npos)
    reader.mistake(name, "leaves the plane of test.dimension = 2; allowed: x and y; change one of the two");
  return found;
}

std::string out_of_plane(const std::string& key, const std::string& axes, int dimension) {
  if (dimension == 3 || axes.find('z') == std::string::npos) return "";
  return key + " = \"" + axes + "\" leaves the plane of a 2D specimen; allowed: x and y; change it";
}

std::vector<double> record_strains(double to_strain, double spacing) {
  std::vector<double> strains{0};
  const double direction = to_strain < 0 ? -1 : 1;
  // A last interval below a millionth of the spacing is round-off of the file's numbers.
  const auto whole = long(std::abs(to_strain) / spacing - 1e-6);
  for (long k = 1; k <= whole; ++k) strains.push_back(direction * double(k) * spacing);
  strains.push_back(to_strain);
  return strains;
}

long steps_to(double to_strain, double spacing) { return std::max(1L, std::lround(std::abs(to_strain) / spacing)); }

std::size_t strain_records(double to_strain, double spacing, const Cycles& cycles) {
  if (cycles.count == 0) return record_strains(to_strain, spacing).size();
  return std::size_t(4 * cycles.count * steps_to(to_strain, spacing)) + 1;
}

}  // namespace rvelab::protocol
