// Dissolve stages: bonds lose radius or strength step by step, each of which comes to rest under what is held. Declared
// in stage_kinds.hpp.
#include <algorithm>
#include <cmath>

#include "rvelab/error.hpp"
#include "rvelab/keys/table_reader.hpp"
#include "rvelab/protocol/dissolution.hpp"
#include "rvelab/protocol/drive.hpp"
#include "rvelab/protocol/stage_kinds.hpp"
#include "rvelab/protocol/stage_readers.hpp"

namespace rvelab::protocol {
namespace {

using namespace keys;

struct DissolveSettings {
  enum class Hold { stress, axial_stress, strain };
  Dissolution dissolution;
  long step_count = 20;
  Hold hold = Hold::stress;
  std::string axis;
  double stress_tolerance = 1e-3, unbalanced = 1e-5;
  long max_rounds = 100, max_steps = 1'000'000;
};

/// Phases of a dissolve stage, gone through at each step.
enum Phase : std::int32_t { dissolving = 1, correcting, relaxing };

struct Dissolve : KindOf<DissolveSettings> {
  using Hold = DissolveSettings::Hold;
  const char* name() const override { return "dissolve"; }

  void read(TableReader& reader, Protocol& protocol) override {
    Dissolution& d = stage.dissolution;
    reader.number("radius_left", d.radius, "1", {0.001, 1},
                  "part of its present radius that a bond has left at the end; the rim takes with it what it bore");
    reader.number("strength_left", d.strength, "1", {0, 1},
                  "part of its present strengths that a bond has left at the end; 0: bonds that bear anything break");
    reader.whole_number("step_count", stage.step_count, {1, 1e6},
                        "steps in which they fall, evenly; each comes to rest and is a record");
    reader.number("share", d.share, "1", {0, 1, true, false}, "share of the bonds that dissolves, drawn by seed");
    reader.whole_number("seed", d.seed, {0, 1e15}, "of the draw of bonds");
    reader.text("material", d.material, "only bonds with a grain of this material", "(all)");
    reader.choice("hold", stage.hold, {"stress", "axial_stress", "strain"},
                  "stress: all normal stresses stay as the stage finds them; axial_stress: that along axis stays, the "
                  "other strains are zero (oedometer); strain: the cell stays");
    stage.axis = read_axes(reader, "axis", {"x", "y", "z"}, "hold = \"axial_stress\": laboratory axis of the stress",
                           "y", "z", protocol);
    reader.number("stress_tolerance", stage.stress_tolerance, "1", ratio,
                  "allowed error of a held stress at the end of each step, over the larger of it and p at the start");
    reader.number("unbalanced", stage.unbalanced, "1", ratio, "unbalanced force ratio below which a step ends");
    reader.whole_number("max_rounds", stage.max_rounds, steps,
                        "most rounds of correction and relaxation of a step; then the stage fails");
    reader.whole_number("max_steps", stage.max_steps, steps, "most sub-steps of one relaxation");
    if (d.radius == 1 && d.strength == 1)
      reader.mistake("radius_left",
                     "or strength_left is missing; give one of them below 1, for example "
                     "radius_left = 0.5: otherwise nothing dissolves");
    if (stage.hold != Hold::axial_stress) reader.refuse("axis", "has no meaning unless hold = \"axial_stress\"");
  }

  std::size_t planned_records() const override { return std::size_t(stage.step_count) + 1; }
  std::string misfit(int dimension) const override { return out_of_plane("axis", stage.axis, dimension); }

  std::string lacking_in(const Specimen& specimen) const override {
    return protocol::lacking_in(specimen, stage.dissolution);
  }

  void drive(RunningTest& test) const override {
    records::Progress& at = test.run.progress;
    const std::vector<HeldStress> held = held_stresses(test);
    if (stage.hold == Hold::axial_stress) at.axis = axis_name(test);
    if (at.step == 0 && !test.ended()) {
      test.record_now(0);
      test.step_done();
    }
    while (!test.ended() && at.step <= stage.step_count) {
      if (at.phase == dissolving) {
        dissolve(test);
        at.place = 0;
        at.phase = correcting;
      }
      while (at.phase != dissolving) come_to_rest(test, held);
      Report report;
      report.unbalanced_ratio = at.unbalanced_ratio;
      report.held_error = missed(at.stress, held);
      test.record(1 - at.deformation.determinant(), report);
      test.step_done();
    }
  }

 private:
  std::string axis_name(const RunningTest& test) const {
    return !stage.axis.empty() ? stage.axis : test.dimension() == 2 ? "y" : "z";
  }

  std::vector<HeldStress> held_stresses(const RunningTest& test) const {
    std::vector<HeldStress> held;
    if (stage.hold == Hold::strain) return held;
    const int axis = stage.hold == Hold::axial_stress ? axis_index(axis_name(test)[0]) : -1;
    for (int k = 0; k < test.dimension(); ++k) {
      if (axis >= 0 && k != axis) continue;
      const double target = test.run.progress.first_stress(k, k);
      held.push_back({k, k, target, std::max(std::abs(test.run.progress.first_pressure), test.held_scale(target))});
    }
    return held;
  }

  void dissolve(RunningTest& test) const {
    const double steps_planned = double(stage.step_count), step = double(test.run.progress.step);
    try {
      const Dissolved after = dissolved(test.rve, stage.dissolution, (step - 1) / steps_planned, step / steps_planned);
      if (after.bonds == 0 && step == 1) {
        throw InputError(
            "no intact bond is there to dissolve" +
            (stage.dissolution.material.empty() ? std::string() : " at grains of " + stage.dissolution.material) +
            "; allowed: a specimen with bonds; put a stage kind = \"cement\" before it");
      }
      if (after.bonds > 0) test.rve.set_interactions(after.interactions);
    } catch (const InputError& error) {
      throw InputError(test.failed(error.what()).what());
    }
    test.run.progress.stress = test.rve.stress();
  }

  /// Largest error of a held stress, over its scale.
  static double missed(const Matrix3& stress, const std::vector<HeldStress>& held) {
    double largest = 0;
    for (const HeldStress& h : held) largest = std::max(largest, std::abs(stress(h.i, h.j) - h.target) / h.scale);
    return largest;
  }

  /// One round: held stresses, then rest at fixed cell. Its phase is changed together with the state alone, so that it
  /// goes on from any pause.
  void come_to_rest(RunningTest& test, const std::vector<HeldStress>& held) const {
    records::Progress& at = test.run.progress;
    if (at.phase == correcting) {
      // Half the tolerance: the relaxation that follows moves the stress a little.
      if (missed(at.stress, held) > 0.5 * stage.stress_tolerance)
        test.apply(Matrix3::Zero(), held, 0, 0.5 * stage.stress_tolerance);
      at.phase = relaxing;
    }
    at.unbalanced_ratio = test.relax(stage.unbalanced, stage.max_steps).unbalanced_ratio;
    at.phase = correcting;
    ++at.place;
    const double error = missed(at.stress, held);
    if (error <= stage.stress_tolerance && at.unbalanced_ratio <= stage.unbalanced) {
      at.phase = dissolving;
    } else if (at.place >= stage.max_rounds) {
      TextStream text;
      text << "step " << at.step << ": the held stress is missed by " << error << " of it (allowed "
           << stage.stress_tolerance << ") at the unbalanced ratio " << at.unbalanced_ratio << " (allowed "
           << stage.unbalanced << ") after " << stage.max_rounds
           << " rounds; raise step_count, max_rounds, max_steps or the tolerances, or hold less stress: what is left "
              "of the cement may not bear it";
      throw test.failed(text.str());
    } else {
      test.pause();
    }
  }
};

}  // namespace

std::unique_ptr<StageKind> dissolve_kind() { return std::make_unique<Dissolve>(); }

}  // namespace rvelab::protocol
