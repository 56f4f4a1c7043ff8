// Isotropic stages: consolidation to a pressure. Declared in stage_kinds.hpp.
#include <Eigen/LU>

#include "rvelab/error.hpp"
#include "rvelab/keys/table_reader.hpp"
#include "rvelab/measure/measures.hpp"
#include "rvelab/measure/tensor_order.hpp"
#include "rvelab/pack/consolidation.hpp"
#include "rvelab/protocol/drive.hpp"
#include "rvelab/protocol/stage_kinds.hpp"
#include "rvelab/protocol/stage_readers.hpp"

namespace rvelab::protocol {
namespace {

using namespace keys;

constexpr double far_off = 20;  ///< ratio to the reference pressure from which a specimen needs a new one

constexpr std::int32_t first_phase = 1;  ///< the phase before those of the consolidation

pack::StressGoal goal_of(const IsotropicStage& stage, int dimension, double scale) {
  pack::StressGoal goal;
  goal.least_pressure = scale;
  for (int k = 0; k < dimension; ++k) goal.stress(k, k) = -stage.pressure;
  goal.shear = stage.shear_stress_free;
  goal.dimension = dimension;
  return goal;
}

/// The consolidation of a running test, which may be left at each pause.
struct ConsolidatedTest {
  RunningTest& test;
  const pack::StressGoal& goal;
  records::Progress& at = test.run.progress;

  void bring(const Matrix3& stress, double scale, double tolerance) {
    std::vector<HeldStress> held;
    for (int k = 0; k < component_count(goal.dimension); ++k) {
      const auto [i, j] = component_axes(k, goal.dimension);
      if (i == j || goal.shear) held.push_back({i, j, stress(i, j), scale});
    }
    test.apply(Matrix3::Zero(), held, 0, tolerance, pack::short_wait);
  }
  double on_the_way() const { return test.loading.held_tolerance; }
  void relax(double unbalanced, long max_steps) {
    at.unbalanced_ratio = test.relax(unbalanced, max_steps).unbalanced_ratio;
  }
  void arrived() { at.unbalanced_ratio = test.rve.unbalanced_ratio(); }
  void pause() { test.pause(); }
};

struct Isotropic : KindOf<IsotropicStage> {
  const char* name() const override { return "isotropic"; }
  bool takes_events() const override { return false; }

  void read(TableReader& reader, Protocol& protocol) override {
    stage.pressure = pressure_of(reader, "pressure_Pa", pressures_from_zero,
                                 "target of all normal stresses, compression positive; 0: of bonded grains", protocol);
    reader.choice("shear", stage.shear_stress_free, {"zero_strain", "zero_stress"},
                  "zero_strain: the cell keeps its angles; zero_stress: shear stresses are driven to zero");
    reader.number("stress_tolerance", stage.stress_tolerance, "1", ratio,
                  "allowed error of the stress at the end of the stage, over the pressure");
    reader.number("unbalanced", stage.unbalanced, "1", ratio, "unbalanced force ratio below which the stage ends");
    reader.number("largest_change", stage.largest_change, "1", {0, 1, true, false},
                  "largest change of stress in one increment, over the pressure");
    reader.whole_number("max_rounds", stage.max_rounds, steps,
                        "most rounds of correction and relaxation; then the stage fails");
    reader.whole_number("max_steps", stage.max_steps, steps, "most sub-steps of one relaxation");
    reader.boolean("record", stage.record, "records the state at the start and at the end");
  }

  std::size_t planned_records() const override { return stage.record ? 2 : 0; }

  void drive(RunningTest& test) const override {
    const double scale = test.with_bonds(stage.pressure);
    if (!(scale > 0))
      throw test.failed(
          "pressure_Pa = 0 is for bonded grains, and the specimen has no bonds; allowed: above 0 Pa; give "
          "a pressure, or put a stage kind = \"cement\" before it");
    const pack::StressGoal goal = goal_of(stage, test.dimension(), scale);
    records::Progress& at = test.run.progress;
    if (at.phase == first_phase) {
      if (stage.record) test.record_now(0);
      at.phase = pack::approaching;
    }
    ConsolidatedTest consolidated{test, goal};
    const pack::Rest rest{stage.stress_tolerance, stage.unbalanced, stage.largest_change, stage.max_rounds,
                          stage.max_steps};
    const auto reached = pack::consolidate(consolidated, goal, rest, scale);
    if (reached == pack::Consolidated::far_off) {
      throw test.failed("p = " + std::to_string(mean_pressure(at.stress, test.dimension())) + " Pa after " +
                        std::to_string(pack::most_increments) + " increments; wanted: " +
                        std::to_string(stage.pressure) + " Pa; give a pressure that this packing can carry");
    }
    if (reached == pack::Consolidated::not_still) {
      TextStream text;
      text << "the normal stresses miss -" << stage.pressure << " Pa by " << pack::largest_gap(goal, at.stress) / scale
           << (stage.pressure == scale ? " of it" : " of " + in_words(scale) + " Pa") << " (allowed "
           << stage.stress_tolerance << ") at the unbalanced ratio " << at.unbalanced_ratio << " (allowed "
           << stage.unbalanced << ") after " << stage.max_rounds
           << " rounds; raise max_rounds, max_steps or the tolerances";
      throw test.failed(text.str());
    }
    if (stage.shear_stress_free)
      test.apply(pack::upright_again(at.deformation, Matrix3::Identity()), {}, 0, test.loading.held_tolerance);
    // Tolerances of the following stages refer to the pressure reached here, if the old one is far away (discs swelled
    // from 100 kPa to 40 Pa, then prescribed strain: p ended sixty times too high).
    // Bonds keep theirs: it is by their forces that out-of-balance forces are judged where there is little pressure.
    const double change = stage.pressure / test.rve.reference_pressure();
    if (scale == stage.pressure && !(change > 1 / far_off && change < far_off)) test.rve.take_as_reference();
    if (stage.record) test.record_now(1 - at.deformation.determinant());
  }
};

}  // namespace

std::unique_ptr<StageKind> isotropic_kind() { return std::make_unique<Isotropic>(); }

}  // namespace rvelab::protocol
