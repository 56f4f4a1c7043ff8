// Response envelopes: equal probes in every direction of a plane, each from the same state. Declared in
// stage_kinds.hpp.
#include <algorithm>
#include <cmath>

#include "rvelab/error.hpp"
#include "rvelab/keys/table_reader.hpp"
#include "rvelab/protocol/directions.hpp"
#include "rvelab/protocol/drive.hpp"
#include "rvelab/protocol/stage_kinds.hpp"

namespace rvelab::protocol {
namespace {

using namespace keys;

/// The probe's tensor, of norm one, compression along the axis first: 2D in the plane of y and x, 3D in that of z and
/// the two lateral axes together (Rendulic).
Matrix3 direction(double turns, int dimension) {
  const UnitVector unit = unit_vector(turns);
  Matrix3 tensor = Matrix3::Zero();
  if (dimension == 2) {
    tensor(1, 1) = -unit.cosine;
    tensor(0, 0) = -unit.sine;
  } else {
    tensor(2, 2) = -unit.cosine;
    tensor(0, 0) = tensor(1, 1) = -unit.sine * std::sqrt(0.5);
  }
  return tensor;
}

Report probe(RunningTest& test, const EnvelopeStage& stage, const Matrix3& along) {
  const records::Progress& at = test.run.progress;
  const double part = 1 / double(stage.increments);
  Report worst;
  for (long k = 1; k <= stage.increments; ++k) {
    Report report;
    if (!stage.stress_probes) {
      report = test.apply(part * stage.size * along, {}, 0, test.loading.held_tolerance);
    } else {
      // A probe of stress misses by no more than a fraction of itself.
      std::vector<HeldStress> held;
      for (int i = 0; i < test.dimension(); ++i) {
        const double target = at.first_stress(i, i) + double(k) * part * stage.stress_size * along(i, i);
        held.push_back({i, i, target, stage.stress_size});
      }
      report = test.apply(Matrix3::Zero(), held, 0, test.loading.held_tolerance);
    }
    worst.held_error = std::max(worst.held_error, report.held_error);
    worst.target_held = worst.target_held && report.target_held;
  }
  // Not in slices: a test is not left in the middle of a probe.
  const Report rest = test.rve.relax(stage.unbalanced, stage.max_steps);
  test.run.progress.stress = test.rve.stress();
  test.run.progress.substeps += rest.substeps;
  worst.unbalanced_ratio = rest.unbalanced_ratio;
  if (rest.unbalanced_ratio > stage.unbalanced) {
    TextStream text;
    text << "a probe's unbalanced ratio is " << rest.unbalanced_ratio << " after " << rest.substeps
         << " steps; wanted: " << stage.unbalanced << "; raise max_steps or unbalanced";
    throw test.failed(text.str());
  }
  return worst;
}

struct Envelope : KindOf<EnvelopeStage> {
  const char* name() const override { return "envelope"; }
  bool takes_events() const override { return false; }

  void read(TableReader& reader, Protocol&) override {
    reader.choice("probes", stage.stress_probes, {"strain", "stress"},
                  "quantity whose size is equal in every direction");
    reader.number("size", stage.size, "1", {0, 0.1, true, false}, "probes = strain: norm of the strain");
    const auto size =
        reader.optional_number("size_Pa", "Pa", positive, "probes = stress: norm of the change of stress");
    stage.stress_size = size.value_or(0);
    if (stage.stress_probes) reader.expect("size_Pa", "is missing; allowed with probes = \"stress\": > 0 Pa; add it");
    const std::string probes = stage.stress_probes ? "stress" : "strain";
    const char* const other = stage.stress_probes ? "size" : "size_Pa";
    if (reader.has(other))
      reader.mistake(other, "contradicts probes = " + as_toml(probes) + "; allowed: the size of these only; remove it");
    reader.whole_number(
        "directions", stage.directions, {1, 1e4},
        "number of directions, from compression along the axis; in 2D in the plane of y and x, in 3D in "
        "that of z and of x and y together");
    reader.whole_number("increments", stage.increments, {1, 1e6}, "increments of each probe");
    reader.number("unbalanced", stage.unbalanced, "1", ratio, "unbalanced force ratio to which each probe is relaxed");
    reader.whole_number("max_steps", stage.max_steps, steps, "most sub-steps of that relaxation; then the stage fails");
  }

  std::size_t planned_records() const override { return std::size_t(stage.directions) + 1; }

  void drive(RunningTest& test) const override {
    records::Progress& at = test.run.progress;
    at.axis = test.dimension() == 2 ? "y" : "z";
    at.pressure = at.first_pressure;
    while (at.step <= stage.directions) {
      if (at.step == 0) {
        test.record_now(0);
      } else {
        const double turns = double(at.step - 1) / double(stage.directions);
        const Rve start(test.rve);
        const records::Progress before = at;
        const auto put_back = [&] {
          const std::int64_t records = at.records;
          test.rve = start;
          at = before;
          at.records = records;
        };
        try {
          const Report report = probe(test, stage, direction(turns, test.dimension()));
          test.record(turns, report);
        } catch (...) {
          put_back();
          throw;
        }
        put_back();
      }
      ++at.step;
      test.pause();
    }
  }
};

}  // namespace

std::unique_ptr<StageKind> envelope_kind() { return std::make_unique<Envelope>(); }

}  // namespace rvelab::protocol
