#include "rvelab/protocol/stage_readers.hpp"

#include <cmath>

namespace rvelab::protocol {

using keys::TableReader;

double pressure_of(TableReader& reader, const std::string& name, Protocol& protocol) {
  if (reader.has(name)) return reader.number(name);
  const bool nowhere = std::isnan(protocol.pressure);
  if (nowhere && !reader.has_in_another_unit(name)) {
    reader.mistake(name, "is missing, and so is test.pressure_Pa; allowed: > 0 Pa; add one of them");
  }
  protocol.uses_pressure = protocol.uses_pressure || !nowhere;
  return reader.number(name, nowhere ? 0 : protocol.pressure);
}

void refuse_pressure(TableReader& reader, const std::string& name, const std::string& other) {
  reader.leave(name);
  if (reader.has(name)) reader.mistake(name, "contradicts " + other + "; allowed: one of the two; remove one");
}

double spacing_of(TableReader& reader, double to_strain) {
  const double spacing = reader.number("record_every");
  if (std::abs(to_strain) / spacing > most_records) {
    reader.mistake("record_every", "gives " + std::to_string(std::abs(to_strain) / spacing) +
                                       " records; allowed: at most 1000000; give a larger spacing");
  }
  return spacing;
}

}  // namespace rvelab::protocol
