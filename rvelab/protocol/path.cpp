#include "rvelab/protocol/path.hpp"

#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "rvelab/cell/cell.hpp"
#include "rvelab/measure/measures.hpp"
#include "rvelab/measure/probe.hpp"
#include "rvelab/measure/tensor_order.hpp"

namespace rvelab::protocol {

namespace {

/// A over the components of strain with engineering shear, as B over those of stress is with every shear once.
Eigen::VectorXd strain_factors(const Matrix3& a, int dimension) { return stress_components(a, dimension); }
Eigen::VectorXd stress_factors(const Matrix3& b, int dimension) {
  Eigen::VectorXd factors = stress_components(b, dimension);
  for (int k = dimension; k < factors.size(); ++k) factors[k] *= 2;
  return factors;
}

/// One row of [A B], each row of unit length.
Eigen::MatrixXd both_of(const std::vector<PathRow>& rows, int dimension) {
  const int n = component_count(dimension);
  Eigen::MatrixXd both(Eigen::Index(rows.size()), 2 * n);
  for (std::size_t r = 0; r < rows.size(); ++r) {
    both.row(Eigen::Index(r)) << strain_factors(rows[r].strain, dimension).transpose(),
        stress_factors(rows[r].stress, dimension).transpose();
  }
  for (Eigen::Index r = 0; r < both.rows(); ++r) {
    const double size = both.row(r).norm();
    if (size > 0) both.row(r) /= size;
  }
  return both;
}

std::string quoted(const std::string& name) { return "\"" + name + "\""; }

/// Names of the rows before `row` that it is a combination of; empty if it is none. Their factors go into `factors`.
std::string combination(const Eigen::MatrixXd& both, const std::vector<PathRow>& rows, Eigen::Index row,
                        Eigen::VectorXd& factors) {
  if (row == 0) return "";
  const Eigen::MatrixXd before = both.topRows(row).transpose();
  factors = before.completeOrthogonalDecomposition().solve(both.row(row).transpose());
  if ((before * factors - both.row(row).transpose()).norm() > 1e-9) return "";
  std::string names;
  for (Eigen::Index k = 0; k < row; ++k) {
    if (std::abs(factors[k]) < 1e-9) continue;
    names += (names.empty() ? "" : ", ") + quoted(rows[std::size_t(k)].name);
  }
  return names;
}

/// A combination of rows that is met at every point if the others are.
bool agrees(const std::vector<PathRow>& rows, Eigen::Index row, const Eigen::VectorXd& factors, int dimension,
            long points) {
  const auto size_of = [&](std::size_t r) {
    return std::sqrt(strain_factors(rows[r].strain, dimension).squaredNorm() +
                     stress_factors(rows[r].stress, dimension).squaredNorm());
  };
  const auto at = [&](std::size_t r, long point) {
    return rows[r].to.empty() ? 0.0 : rows[r].to[std::size_t(point)] / size_of(r);
  };
  for (long point = 0; point < points; ++point) {
    double sum = 0, largest = 0;
    for (Eigen::Index k = 0; k < row; ++k) {
      sum += factors[k] * at(std::size_t(k), point);
      largest = std::max(largest, std::abs(factors[k] * at(std::size_t(k), point)));
    }
    const double own = at(std::size_t(row), point);
    if (std::abs(sum - own) > 1e-9 * std::max(largest, std::abs(own))) return false;
  }
  return true;
}

/// True if the rows determine the strain increment of a solid, isotropic one as an example.
bool determine_strain(const std::vector<PathRow>& rows, int dimension) {
  const int n = component_count(dimension);
  Eigen::MatrixXd stiffness = Eigen::MatrixXd::Zero(n, n);
  for (int k = 0; k < n; ++k) {
    stiffness(k, k) = k < dimension ? 1.6 : 0.45;
    for (int l = 0; l < dimension && k < dimension; ++l) stiffness(k, l) += 0.7;
  }
  Eigen::MatrixXd system(n, n);
  for (int r = 0; r < n; ++r) {
    const PathRow& row = rows[std::size_t(r)];
    Eigen::RowVectorXd a = strain_factors(row.strain, dimension).transpose();
    Eigen::RowVectorXd b = stress_factors(row.stress, dimension).transpose() * stiffness;
    if (row.in_stress() && !row.strain.isZero(0)) b *= a.norm() / std::max(1e-300, b.norm());
    system.row(r) = a + b;
    system.row(r) /= std::max(1e-300, system.row(r).norm());
  }
  return Eigen::FullPivLU<Eigen::MatrixXd>(system).isInvertible();
}

double logarithm(double x) {
  // ln x = 2 (y + y^3/3 + ...), y = (x - 1)/(x + 1): increments are small, and no libm touches state.
  const double y = (x - 1) / (x + 1), square = y * y;
  double sum = 0;
  for (int k = 41; k >= 1; k -= 2) sum = sum * square + 1.0 / k;
  return 2 * y * sum;
}

/// Records after the first.
long path_steps(const PathStage& stage) { return stage.cycles * stage.points * stage.records_per_point; }

/// A : E + B : sigma.
double row_value(const PathRow& row, const Matrix3& strain_sum, const Matrix3& stress) {
  return row.strain.cwiseProduct(strain_sum).sum() + row.stress.cwiseProduct(stress).sum();
}

/// Value of a row at record `step` (0: the start), in its unit.
double row_target(const PathStage& stage, const PathRow& row, long step, const Matrix3& first_stress) {
  const double first = row_value(row, Matrix3::Zero(), first_stress);
  if (row.to.empty() || step == 0) return first;
  const long part = (step - 1) / stage.records_per_point, point = part % stage.points;
  const long within = (step - 1) % stage.records_per_point + 1;
  const double end = row.to[std::size_t(point)];
  if (within == stage.records_per_point) return end;
  const double start = std::isnan(row.from) ? first : row.from;
  const double begin = part == 0 ? start : point == 0 ? row.to.back() : row.to[std::size_t(point - 1)];
  return begin + (end - begin) * double(within) / double(stage.records_per_point);
}

/// Combination of the rows of pure strain that is the volumetric strain, one factor a row; empty if there is none.
std::vector<double> volume_factors(const std::vector<PathRow>& rows, int dimension) {
  Eigen::MatrixXd strains = Eigen::MatrixXd::Zero(component_count(dimension), Eigen::Index(rows.size()));
  for (std::size_t r = 0; r < rows.size(); ++r) {
    if (!rows[r].in_stress()) strains.col(Eigen::Index(r)) = strain_factors(rows[r].strain, dimension);
  }
  Eigen::VectorXd volume = Eigen::VectorXd::Zero(strains.rows());
  volume.head(dimension).setOnes();
  const Eigen::VectorXd factors = strains.completeOrthogonalDecomposition().solve(volume);
  if ((strains * factors - volume).norm() > 1e-12) return {};
  return {factors.data(), factors.data() + factors.size()};
}

/// The rows and, for every strain component that none of them names (in A or in B), one that keeps it at zero.
std::vector<PathRow> completed(const PathStage& stage, int dimension) {
  std::vector<PathRow> rows = stage.rows;
  for (int k = 0; k < component_count(dimension); ++k) {
    const auto [i, j] = component_axes(k, dimension);
    const bool named = std::any_of(stage.rows.begin(), stage.rows.end(), [&, i = i, j = j](const PathRow& row) {
      return row.strain(i, j) != 0 || row.stress(i, j) != 0;
    });
    if (named) continue;
    PathRow row;
    row.name = "strain " + component_names(dimension)[std::size_t(k)] + " = 0, since no row names it";
    row.strain(i, j) = row.strain(j, i) = 1;
    rows.push_back(row);
  }
  return rows;
}

}  // namespace

std::string mistake_of_rows(const PathStage& stage, int dimension) {
  for (const PathRow& row : stage.rows) {
    if (dimension == 2 && !(row.strain.col(2).isZero(0) && row.stress.col(2).isZero(0))) {
      return "row " + quoted(row.name) + " names a component along z, which a 2D specimen has not; allowed: xx, yy, xy";
    }
  }
  const std::vector<PathRow> rows = completed(stage, dimension);
  const Eigen::MatrixXd both = both_of(rows, dimension);
  for (Eigen::Index r = 0; r < both.rows(); ++r) {
    Eigen::VectorXd factors;
    const std::string others = combination(both, rows, r, factors);
    if (others.empty()) continue;
    const bool same = agrees(rows, r, factors, dimension, stage.points);
    return "row " + quoted(rows[std::size_t(r)].name) + (same ? " follows from " : " contradicts ") + others +
           (same ? " (dependent constraints)" : ", from which it would follow with other targets") +
           "; remove one of them";
  }
  const int needed = component_count(dimension);
  if (int(rows.size()) != needed) {
    std::string names;
    for (const PathRow& row : rows) names += (names.empty() ? "" : ", ") + quoted(row.name);
    return std::to_string(rows.size()) + " constraints (" + names + "); allowed in " + std::to_string(dimension) +
           "D: " + std::to_string(needed) + "; " + (int(rows.size()) > needed ? "remove" : "add") + " a row";
  }
  if (!determine_strain(rows, dimension)) {
    return "the rows leave a strain open and prescribe others twice; give one row for each component or independent "
           "combination";
  }
  return "";
}

Matrix3 strain_increment(const Matrix3& displacement_gradient, int dimension) {
  Matrix3 strain = 0.5 * (displacement_gradient + displacement_gradient.transpose());
  const double volume = logarithm((Matrix3::Identity() + displacement_gradient).determinant());
  const double shift = (volume - strain.trace()) / dimension;
  for (int k = 0; k < dimension; ++k) strain(k, k) += shift;
  return strain;
}

namespace {

/// What a miss of a stress row is relative to, Pa: its value, or the stage's first p where that is more (a row with
/// targets, which may be small: a tenth of it), times the norm of B.
double scale_of(const RunningTest& test, const PathRow& row, double target) {
  const double floor = (row.to.empty() ? 1.0 : 0.1) * std::abs(test.run.progress.first_pressure) * row.stress.norm();
  const double scale = test.with_bonds(std::max(std::abs(target), floor), row.stress.norm());
  if (scale > 0) return scale;
  throw test.failed("row \"" + row.name +
                    "\": a stress of 0 Pa cannot be held from a state without pressure; allowed: a pressure > 0; "
                    "compress first, or cement the grains");
}

/// The symmetric displacement gradient that rows of pure strain prescribe.
Matrix3 prescribed(const std::vector<PathRow>& rows, const std::vector<double>& changes, int dimension) {
  const int n = component_count(dimension);
  Eigen::MatrixXd system(n, n);
  Eigen::VectorXd right(n);
  for (int r = 0; r < n; ++r) {
    const auto at = std::size_t(r);
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
      const Report report = increment(test, stage, rows, long(at.step));
      // Twice the cycles done, as where a strain goes to and fro.
      at.turns = at.step / stage.records_per_point * 2 / stage.points;
      test.record(driving_strain(test, stage, long(at.step)), report);
    }
    test.step_done();
  }
}

std::size_t path_records(const PathStage& stage) { return std::size_t(path_steps(stage)) + 1; }

}  // namespace rvelab::protocol
