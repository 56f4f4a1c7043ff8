#include "rvelab/cli/doubts.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <string>

#include "rvelab/cli/report.hpp"
#include "rvelab/error.hpp"
#include "rvelab/keys/key.hpp"
#include "rvelab/protocol/stage_kinds.hpp"

namespace rvelab::cli {

namespace {

double mean_diameter_of(const Specimen& specimen) {
  const auto& radius = specimen.grains.radius;
  return 2 * std::accumulate(radius.begin(), radius.end(), 0.0) / double(radius.size());
}

/// Tells of records whose cell was too thin to represent the material.
void tell_of_thin(const records::TestResult& result, long thin) {
  if (thin == 0) return;
  const auto first = std::find_if(result.records.begin(), result.records.end(),
                                  [](const records::Record& record) { return record.cell_thin; });
  tell(std::to_string(thin) + " of " + std::to_string(result.records.size()) +
       " records are of a thin cell (cell_thin), from strain " + in_words(first->strain) + " of stage \"" +
       result.stages.at(std::size_t(first->stage)) +
       "\" on: a height is less than four mean diameters, too little to represent the material; use more grains, or a "
       "cell that suits the deformation (pack.cell)");
}

/// Tells of a cell that the test made low, though not thin (tools/validate thin).
void tell_of_low(const Specimen& specimen, const protocol::TestRun& run) {
  constexpr double low = 10;  // mean diameters
  const double diameter = mean_diameter_of(specimen), first = heights(specimen.cell).minCoeff() / diameter,
               last = heights(run.end_state.cell).minCoeff() / diameter;
  if (last >= low || last >= 0.75 * first) return;
  tell("the cell became " + in_words(last) + " mean diameters high, from " + in_words(first) +
       ": below ten, few grains bear more than many; of quasi-static discs at constant volume p is higher by 10 to "
       "30 % at seven; use more grains, or a cell that suits the deformation (pack.cell)");
}

}  // namespace

Doubtful doubtful_of(const std::vector<records::Record>& records, int dimension) {
  constexpr double small_part = 0.05;
  Doubtful found;
  const double first = records.empty() ? 0 : mean_pressure(records.front().stress, dimension);
  for (const records::Record& record : records) {
    found.not_held += record.target_held ? 0 : 1;
    found.not_quasi_static += record.quasi_static ? 0 : 1;
    const bool doubtful = !(record.target_held && record.quasi_static);
    found.either += doubtful ? 1 : 0;
    found.without_pressure += doubtful && mean_pressure(record.stress, dimension) < small_part * first ? 1 : 0;
    found.thin += record.cell_thin ? 1 : 0;
  }
  return found;
}

void warn_records(const Specimen& specimen, const protocol::TestRun& run, const Doubtful& doubtful) {
  const std::size_t records = run.result.records.size();
  // One record or two may be an avalanche of the specimen; more are the fault of the test's settings.
  if (20 * doubtful.either > long(records) && 2 * doubtful.without_pressure > doubtful.either)
    tell(std::to_string(doubtful.without_pressure) + " of " + std::to_string(records) +
         " records are of a specimen whose grains carry almost nothing, p below 5 % of its start: it has liquefied. No "
         "tolerance makes them equilibria (quasi_static, target_held); let the test end there, with an "
         "[[stage.until]] of quantity = \"p_over_first\"");
  else if (20 * doubtful.either > long(records))
    tell(std::to_string(doubtful.either) + " of " + std::to_string(records) +
         " records are doubtful: " + std::to_string(doubtful.not_held) + " did not hold their stress (target_held), " +
         std::to_string(doubtful.not_quasi_static) +
         " are not quasi-static (quasi_static); lower the tolerances of [solver] or the rate, or raise "
         "loading.held_tolerance");
  tell_of_thin(run.result, doubtful.thin);
  constexpr long noticed = 1000;  // sub-steps: fewer cost no time
  if (run.costs.waited > noticed && 2 * run.costs.waited > run.costs.substeps)
    tell(std::to_string(run.costs.waited) + " of " + std::to_string(run.costs.substeps) +
         " sub-steps waited for a held stress to return after avalanches");
  tell_of_low(specimen, run);
}

void tell_of_units(const std::string& file, const std::vector<std::string>& doubts) {
  static std::set<std::string> told;
  for (const std::string& doubt : doubts)
    if (told.insert(keys::key_of_doubt(doubt)).second) tell("warning: " + file + ": " + doubt);
}

void tell_of_shear(const protocol::Protocol& protocol, const Specimen& specimen) {
  const int dimension = specimen.cell.dimension;
  const double diameter = mean_diameter_of(specimen);
  for (const protocol::Stage& stage : protocol.stages) {
    const auto* shear = protocol::settings_of<protocol::SimpleShearStage>(stage);
    if (shear == nullptr) continue;
    const std::string plane = !shear->plane.empty() ? shear->plane : dimension == 2 ? "xy" : "xz";
    const double most = std::abs(shear->to_strain);
    const double thin_from = shear_until_thin(specimen.cell, plane[0] - 'x', plane[1] - 'x', 4 * diameter, most);
    if (!std::isfinite(thin_from) || thin_from == 0) continue;  // thin from the start: its records say so
    tell(
        "stage \"" + stage.name + "\": beyond a shear strain of " + in_words(thin_from) +
        " a height of the cell is less than four mean diameters, and the records are flagged (cell_thin): no vector of "
        "the cell lies along " +
        plane[0] + ", or the cell is small; pack an upright specimen with more grains, or shear it less");
  }
}

}  // namespace rvelab::cli
