#include "rvelab/cli/warnings.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <string>

#include "rvelab/error.hpp"
#include "rvelab/keys/key.hpp"
#include "rvelab/protocol/stage_kinds.hpp"

namespace rvelab::cli {

namespace {

double mean_diameter_of(const Specimen& specimen) {
  const auto& radius = specimen.grains.radius;
  return 2 * std::accumulate(radius.begin(), radius.end(), 0.0) / double(radius.size());
}

/// Records whose cell was too thin to represent the material.
void warn_of_thin(const records::TestResult& result, long thin) {
  if (thin == 0) return;
  const auto first = std::find_if(result.records.begin(), result.records.end(),
                                  [](const records::Record& record) { return record.cell_thin; });
  tell(std::to_string(thin) + " of " + std::to_string(result.records.size()) +
       " records are of a thin cell (cell_thin), from strain " + in_words(first->strain) + " of stage \"" +
       result.stages.at(std::size_t(first->stage)) +
       "\" on: a height is less than four mean diameters, too little to represent the material; use more grains, or a "
       "cell that suits the deformation (pack.cell)");
}

/// A cell that the test made low, but not thin (tools/validate thin).
void warn_of_low(const Specimen& specimen, const protocol::TestRun& run) {
  constexpr double low = 10;  // mean diameters
  const double diameter = mean_diameter_of(specimen), first = heights(specimen.cell).minCoeff() / diameter,
               last = heights(run.end_state.cell).minCoeff() / diameter;
  if (last >= low || last >= 0.75 * first) return;
  tell("the cell became " + in_words(last) + " mean diameters high, from " + in_words(first) +
       ": below ten, cells are too strong; at seven, p of quasi-static discs at constant volume is 10 to 30 % too "
       "high; use more grains, or a cell that suits the deformation (pack.cell)");
}

}  // namespace

FlaggedRecords flagged_records(const std::vector<records::Record>& records, int dimension) {
  constexpr double small_part = 0.05;
  FlaggedRecords found;
  const double first = records.empty() ? 0 : mean_pressure(records.front().stress, dimension);
  for (const records::Record& record : records) {
    found.not_held += record.target_held ? 0 : 1;
    found.not_quasi_static += record.quasi_static ? 0 : 1;
    const bool flagged = !(record.target_held && record.quasi_static);
    found.either += flagged ? 1 : 0;
    found.without_pressure += flagged && mean_pressure(record.stress, dimension) < small_part * first ? 1 : 0;
    found.thin += record.cell_thin ? 1 : 0;
  }
  return found;
}

void warn_records(const Specimen& specimen, const protocol::TestRun& run, const FlaggedRecords& flagged) {
  const std::size_t records = run.result.records.size();
  // One or two records may be an avalanche of the specimen; more are caused by the settings of the test.
  if (20 * flagged.either > long(records) && 2 * flagged.without_pressure > flagged.either)
    tell(std::to_string(flagged.without_pressure) + " of " + std::to_string(records) +
         " records are of a liquefied specimen, p below 5 % of its start. They are no equilibria with any tolerance "
         "(quasi_static, target_held); end the test there, with an [[stage.until]] of quantity = \"p_over_first\"");
  else if (20 * flagged.either > long(records))
    tell(std::to_string(flagged.either) + " of " + std::to_string(records) +
         " records are doubtful: " + std::to_string(flagged.not_held) + " did not hold their stress (target_held), " +
         std::to_string(flagged.not_quasi_static) +
         " are not quasi-static (quasi_static); lower the tolerances of [solver] or the rate, or raise "
         "loading.held_tolerance");
  warn_of_thin(run.result, flagged.thin);
  constexpr long noticed = 1000;  // sub-steps: fewer take negligible time
  if (run.costs.waited > noticed && 2 * run.costs.waited > run.costs.substeps)
    tell(std::to_string(run.costs.waited) + " of " + std::to_string(run.costs.substeps) +
         " sub-steps waited for a held stress to return after avalanches");
  warn_of_low(specimen, run);
}

void warn_of_units(const std::string& file, const std::vector<std::string>& warnings) {
  static std::set<std::string> reported;
  for (const std::string& warning : warnings)
    if (reported.insert(keys::key_of_doubt(warning)).second) tell("warning: " + file + ": " + warning);
}

void warn_of_sizes(const Sizes& sizes) {
  constexpr double boulder = 0.5;  // m
  if (!(sizes.mean_diameter > boulder) || sizes.pressure != 0) return;
  tell("the mean diameter is " + in_words(sizes.mean_diameter) +
       " m, and no grains press each other: if millimetres were meant, multiply coordinates, radii and cell by 1e-3");
}

void warn_of_shear(const protocol::Protocol& protocol, const Specimen& specimen) {
  const int dimension = specimen.cell.dimension;
  const double diameter = mean_diameter_of(specimen);
  for (const protocol::Stage& stage : protocol.stages) {
    const auto* shear = protocol::settings_of<protocol::SimpleShearStage>(stage);
    if (shear == nullptr) continue;
    const std::string plane = !shear->plane.empty() ? shear->plane : dimension == 2 ? "xy" : "xz";
    const double most = std::abs(shear->to_strain);
    const double thin_from = shear_until_thin(specimen.cell, plane[0] - 'x', plane[1] - 'x', 4 * diameter, most);
    if (!std::isfinite(thin_from) || thin_from == 0) continue;  // thin from the start: the records are flagged
    tell(
        "stage \"" + stage.name + "\": beyond a shear strain of " + in_words(thin_from) +
        " a height of the cell is less than four mean diameters, and the records are flagged (cell_thin): no vector of "
        "the cell lies along " +
        plane[0] + ", or the cell is small; pack an upright specimen with more grains, or shear it less");
  }
}

}  // namespace rvelab::cli
