// Isotropic stages: far changes of pressure in small increments, then rounds of relaxing and correcting. Declared in
// stage_kinds.hpp.
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <sstream>

#include "rvelab/error.hpp"
#include "rvelab/keys/key_builders.hpp"
#include "rvelab/measure/measures.hpp"
#include "rvelab/pack/consolidation.hpp"
#include "rvelab/protocol/drive.hpp"
#include "rvelab/protocol/stage_kinds.hpp"
#include "rvelab/protocol/stage_readers.hpp"

namespace rvelab::protocol {
namespace {

using namespace keys;

std::vector<TableKey> entries() {
  const char* t = "stage.isotropic";
  const IsotropicStage initial;
  return {
      number(t, "pressure_Pa", "Pa", "(test.pressure_Pa)", pressures, "all normal stresses are brought to minus this"),
      choice(t, "shear", {"zero_strain", "zero_stress"},
             "zero_strain: the cell keeps its angles; zero_stress: shear stresses are driven to zero"),
      number(t, "stress_tolerance", "1", initial.stress_tolerance, ratio, "of the pressure; the stage ends within it"),
      number(t, "unbalanced", "1", initial.unbalanced, ratio, "unbalanced force ratio below which the stage ends"),
      number(t, "largest_change", "1", initial.largest_change, {0, 1, true, false},
             "largest change of stress in one increment, over the pressure"),
      whole_number(t, "max_rounds", initial.max_rounds, steps, "rounds of relaxing and correcting before it fails"),
      whole_number(t, "max_steps", initial.max_steps, steps, "sub-steps of one relaxation before it fails"),
      boolean(t, "record", initial.record, "records the state at the start and at the end"),
  };
}

IsotropicStage read(StageSource& source) {
  TableReader& reader = source.reader;
  IsotropicStage stage;
  stage.pressure = pressure_of(reader, "pressure_Pa", source.protocol);
  stage.shear_stress_free = reader.choice("shear") == "zero_stress";
  stage.stress_tolerance = reader.number("stress_tolerance");
  stage.unbalanced = reader.number("unbalanced");
  stage.largest_change = reader.number("largest_change");
  stage.max_rounds = reader.whole_number("max_rounds");
  stage.max_steps = reader.whole_number("max_steps");
  stage.record = reader.boolean("record");
  return stage;
}

constexpr int most_increments = 1000;
constexpr double far_off = 20;  ///< from its reference pressure, a specimen needs another one

pack::StressGoal goal_of(const IsotropicStage& stage, int dimension) {
  pack::StressGoal goal;
  for (int k = 0; k < dimension; ++k) goal.stress(k, k) = -stage.pressure;
  goal.shear = stage.shear_stress_free;
  goal.dimension = dimension;
  return goal;
}

/// The driven components, each brought to its part of a stress; `scale` (Pa) is what tolerances are relative to.
std::vector<HeldStress> driven(const pack::StressGoal& goal, const Matrix3& stress, double scale) {
  std::vector<HeldStress> held;
  for (const auto& [i, j] : components(goal.dimension)) {
    if (i == j || goal.shear) held.push_back({i, j, stress(i, j), scale});
  }
  return held;
}

/// Increments of at most largest_change of the present pressure (geometric), until the rest is one increment.
void approach(RunningTest& test, const IsotropicStage& stage, const pack::StressGoal& goal) {
  records::Progress& at = test.run.progress;
  while (at.step < most_increments) {
    const Matrix3 next = pack::next_stress(goal, at.stress, stage.largest_change);
    if ((next - goal.stress).isZero(0)) return;
    const double scale = std::max(mean_pressure(at.stress, test.dimension()), 0.1 * stage.pressure);
    test.apply(Matrix3::Zero(), driven(goal, next, scale), 0, test.loading.held_tolerance, pack::short_wait);
    ++at.step;
    test.pause();
  }
  throw test.failed("p = " + std::to_string(mean_pressure(at.stress, test.dimension())) + " Pa after " +
                    std::to_string(most_increments) + " increments; wanted: " + std::to_string(stage.pressure) +
                    " Pa; give a pressure that this packing can carry");
}

/// Phases of an isotropic stage; the last two make a round, until both tolerances are met.
enum Phase : std::int32_t { begun = 1, approaching, correcting, relaxing };

void drive(RunningTest& test, const IsotropicStage& stage) {
  const pack::StressGoal goal = goal_of(stage, test.dimension());
  records::Progress& at = test.run.progress;
  if (at.phase == begun) {
    if (stage.record) test.record_now(0);
    at.phase = approaching;
  }
  if (at.phase == approaching) {
    approach(test, stage, goal);
    at.unbalanced_ratio = test.rve.unbalanced_ratio();
    at.phase = correcting;
    at.step = 0;
  }
  const auto reached = [&] {
    return pack::largest_gap(goal, at.stress) <= stage.stress_tolerance * stage.pressure &&
           at.unbalanced_ratio <= stage.unbalanced;
  };
  while (at.phase == relaxing || (at.step < stage.max_rounds && !reached())) {
    if (at.phase == correcting) {
      // Half the tolerance: the relaxation that follows moves the stress a little.
      if (pack::largest_gap(goal, at.stress) > 0.5 * stage.stress_tolerance * stage.pressure) {
        test.apply(Matrix3::Zero(), driven(goal, goal.stress, stage.pressure), 0, 0.5 * stage.stress_tolerance,
                   pack::short_wait);
      }
      at.phase = relaxing;
    }
    at.unbalanced_ratio = test.relax(stage.unbalanced, stage.max_steps).unbalanced_ratio;
    at.phase = correcting;
    ++at.step;
    test.pause();
  }
  if (!reached()) {
    std::ostringstream text;
    text << "the normal stresses miss -" << stage.pressure << " Pa by "
         << pack::largest_gap(goal, at.stress) / stage.pressure << " of it (allowed " << stage.stress_tolerance
         << ") at the unbalanced ratio " << at.unbalanced_ratio << " (allowed " << stage.unbalanced << ") after "
         << stage.max_rounds << " rounds; raise max_rounds, max_steps or the tolerances";
    throw test.failed(text.str());
  }
  if (stage.shear_stress_free)
    test.apply(pack::upright_again(at.deformation, Matrix3::Identity()), {}, 0, test.loading.held_tolerance);
  // Pace and tolerance of what follows go by the pressure reached here, not by one that is long left behind (discs
  // swelled from 100 kPa to 40 Pa, then prescribed strain: p ended sixty times too high).
  const double change = stage.pressure / test.rve.reference_pressure();
  if (!(change > 1 / far_off && change < far_off)) test.rve.take_as_reference();
  if (stage.record) test.record_now(1 - at.deformation.determinant());
}

}  // namespace

StageKind isotropic_kind() {
  return KindOf<IsotropicStage>{
      .name = "isotropic",
      .keys = entries,
      .read = read,
      .drive = drive,
      .planned_records = [](const IsotropicStage& stage) -> std::size_t { return stage.record ? 2 : 0; },
      .takes_events = false};
}

}  // namespace rvelab::protocol
