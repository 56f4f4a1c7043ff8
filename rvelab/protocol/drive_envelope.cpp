// Response envelopes: equal probes in every direction of a plane, each from the same state.
#include <algorithm>
#include <cmath>
#include <sstream>

#include "rvelab/error.hpp"
#include "rvelab/protocol/directions.hpp"
#include "rvelab/protocol/drive.hpp"

namespace rvelab::protocol {
namespace {

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
  const Progress& at = test.run.progress;
  const double part = 1 / static_cast<double>(stage.increments);
  Report worst;
  for (long k = 1; k <= stage.increments; ++k) {
    Report report;
    if (!stage.stress_probes) {
      report = test.apply(part * stage.size * along, {}, 0, test.loading.held_tolerance);
    } else {
      // A probe of stress misses by no more than a fraction of itself.
      std::vector<HeldStress> held;
      for (int i = 0; i < test.dimension(); ++i) {
        const double target = at.first_stress(i, i) + static_cast<double>(k) * part * stage.stress_size * along(i, i);
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
    std::ostringstream text;
    text << "a probe's unbalanced ratio is " << rest.unbalanced_ratio << " after " << rest.substeps
         << " steps; wanted: " << stage.unbalanced << "; raise max_steps or unbalanced";
    throw test.failed(text.str());
  }
  return worst;
}

}  // namespace

void drive(RunningTest& test, const EnvelopeStage& stage) {
  Progress& at = test.run.progress;
  at.axis = test.dimension() == 2 ? "y" : "z";
  at.pressure = at.first_pressure;
  while (at.step <= stage.directions) {
    if (at.step == 0) {
      test.record_now(0);
    } else {
      const double turns = static_cast<double>(at.step - 1) / static_cast<double>(stage.directions);
      const Rve start(test.rve);
      const Progress before = at;
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

}  // namespace rvelab::protocol
