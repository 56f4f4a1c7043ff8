#include "rvelab/protocol/strain_driven.hpp"

#include <algorithm>
#include <cmath>

#include "rvelab/protocol/stage_readers.hpp"

namespace rvelab::protocol {

using keys::TableReader;

double strain_of(StageSource& source) {
  const double strain = source.reader.number("to_strain");
  if (source.table["to_strain"].value<double>() == 0.0) {
    source.reader.mistake("to_strain", "goes nowhere; allowed: not 0; give the strain at which the stage ends");
  }
  return strain;
}

void expect_in_plane(TableReader& reader, const std::string& key, const std::string& axes, const Protocol& protocol) {
  if (protocol.dimension == 2 && axes.find('z') != std::string::npos) {
    reader.mistake(key, "leaves the plane of test.dimension = 2; allowed: x and y; change one of the two");
  }
}

std::string out_of_plane(const std::string& key, const std::string& axes, int dimension) {
  if (dimension == 3 || axes.find('z') == std::string::npos) return "";
  return key + " = \"" + axes + "\" leaves the plane of a 2D specimen; allowed: x and y; change it";
}

Cycles read_cycles(TableReader& reader, double to_strain, double record_every) {
  Cycles cycles;
  cycles.count = reader.whole_number("cycles");
  cycles.reverse_at = reader.optional_number("reverse_at_Pa").value_or(0);
  if (reader.has("reverse_at_Pa") && cycles.count == 0) {
    reader.mistake("reverse_at_Pa", "has nothing to turn; allowed: with cycles > 0 only; give cycles, or remove it");
  }
  const double records = 4 * static_cast<double>(cycles.count) * std::abs(to_strain) / record_every;
  if (records > most_records) {
    reader.mistake("cycles", "gives up to " + std::to_string(records) +
                                 " records; allowed: at most 1000000; give fewer cycles or a larger record_every");
  }
  return cycles;
}

std::vector<double> record_strains(double to_strain, double spacing) {
  std::vector<double> strains{0};
  const double direction = to_strain < 0 ? -1 : 1;
  // A last interval below a millionth of the spacing is round-off of the file's numbers.
  const auto whole = static_cast<long>(std::abs(to_strain) / spacing - 1e-6);
  for (long k = 1; k <= whole; ++k) strains.push_back(direction * static_cast<double>(k) * spacing);
  strains.push_back(to_strain);
  return strains;
}

long steps_to(double to_strain, double spacing) { return std::max(1L, std::lround(std::abs(to_strain) / spacing)); }

std::size_t strain_records(double to_strain, double spacing, const Cycles& cycles) {
  if (cycles.count == 0) return record_strains(to_strain, spacing).size();
  return static_cast<std::size_t>(4 * cycles.count * steps_to(to_strain, spacing)) + 1;
}

}  // namespace rvelab::protocol
