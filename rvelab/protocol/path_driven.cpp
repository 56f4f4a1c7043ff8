#include "rvelab/protocol/path_driven.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "rvelab/cell/cell.hpp"
#include "rvelab/measure/measures.hpp"
#include "rvelab/measure/tensor_order.hpp"

namespace rvelab::protocol {
namespace {

/// What a miss of a stress row is relative to, Pa: its value, or the stage's first p where that is more (a row with
/// targets, which may be small: a tenth of it), times the norm of B.
double scale_of(const RunningTest& test, const PathRow& row, double target) {
  const double floor = (row.to.empty() ? 1.0 : 0.1) * std::abs(test.run.progress.first_pressure) * row.stress.norm();
  const double scale = std::max(std::abs(target), floor);
  if (scale > 0) return scale;
  throw test.failed("row \"" + row.name +
                    "\": a stress of 0 Pa cannot be held from a state without pressure; allowed: a pressure > 0; "
                    "compress first");
}

/// The symmetric displacement gradient that rows of pure strain prescribe.
Matrix3 prescribed(const std::vector<PathRow>& rows, const std::vector<double>& changes, int dimension) {
  const int n = component_count(dimension);
  Eigen::MatrixXd system(n, n);
  Eigen::VectorXd right(n);
  for (int r = 0; r < n; ++r) {
    const auto at = static_cast<std::size_t>(r);
    system.row(r) = stress_components(rows[at].strain, dimension).transpose();  // A over engineering shear
    right[r] = changes[at];
  }
  const Eigen::VectorXd strain = Eigen::FullPivLU<Eigen::MatrixXd>(system).solve(right);
  Matrix3 gradient = Matrix3::Zero();
  for (int k = 0; k < n; ++k) gradient += strain[k] * unit_strain(k, dimension);
  return gradient;
}

/// The strain that a record is known by: the first row of pure strain that has targets, else eps_q.
double driving_strain(const RunningTest& test, const PathStage& stage, long step) {
  for (const PathRow& row : stage.rows) {
    if (!row.in_stress() && !row.to.empty()) return row_target(stage, row, step, test.run.progress.first_stress);
  }
  const records::Progress& at = test.run.progress;
  if (stage.isotropic) return 1 - at.deformation.determinant();
  return deviatoric_strain(at.strain_sum, test.dimension());
}

Report increment(RunningTest& test, const PathStage& stage, const std::vector<PathRow>& rows, long step) {
  const records::Progress& at = test.run.progress;
  const int dimension = test.dimension();
  MixedTarget target;
  std::vector<double> changes;
  bool in_stress = false;
  for (const PathRow& row : rows) {
    const double wanted = row_target(stage, row, step, at.first_stress);
    MixedTarget::Row constraint{row.strain, row.stress, wanted - row_value(row, at.strain_sum, at.stress), 0};
    if (row.in_stress()) constraint.scale = scale_of(test, row, wanted);
    in_stress = in_stress || row.in_stress();
    changes.push_back(constraint.value);
    target.rows.push_back(constraint);
  }
  const std::vector<double> volume = volume_factors(rows, dimension);
  double volumetric_strain = 0, size = 0;
  for (std::size_t r = 0; r < volume.size(); ++r) {
    const double wanted = volume[r] * row_target(stage, rows[r], step, at.first_stress);
    volumetric_strain += wanted;
    size = std::max(size, std::abs(wanted));
  }
  if (!volume.empty() && std::abs(volumetric_strain) <= 1e-14 * size) {
    target.volume_ratio = 1 / at.deformation.determinant();
  }
  if (in_stress) return test.apply(target, 0, test.loading.held_tolerance);
  Matrix3 gradient = prescribed(rows, changes, dimension);
  if (target.volume_ratio > 0) gradient = with_volume_ratio(gradient, target.volume_ratio, dimension);
  return test.apply(gradient, {}, 0, 0);
}

}  // namespace

void follow_path(RunningTest& test, const PathStage& stage) {
  const std::vector<PathRow> rows = completed(stage, test.dimension());
  records::Progress& at = test.run.progress;
  at.axis = stage.axis;
  at.pressure = at.first_pressure;
  const long steps = path_steps(stage);
  while (!test.ended() && at.step <= steps) {
    if (at.step == 0) {
      test.record_now(0);
    } else {
      const Report report = increment(test, stage, rows, static_cast<long>(at.step));
      // Twice the cycles done, as where a strain goes to and fro.
      at.turns = at.step / stage.records_per_point * 2 / stage.points;
      test.record(driving_strain(test, stage, static_cast<long>(at.step)), report);
    }
    test.step_done();
  }
}

std::size_t path_records(const PathStage& stage) { return static_cast<std::size_t>(path_steps(stage)) + 1; }

}  // namespace rvelab::protocol
