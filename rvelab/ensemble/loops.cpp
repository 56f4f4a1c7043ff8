#include "rvelab/ensemble/loops.hpp"

#include <cmath>
#include <numbers>

#include "rvelab/ensemble/statistics.hpp"

namespace rvelab::ensemble {
namespace {

/// Shear strain and stress of a record, both growing with the driving strain; Pa.
struct Shear {
  double driving = 0;  ///< strain that the stage drives: it turns where it is prescribed, lateral strains may waver
  double gamma = 0, tau = 0;
};

/// Axial less the mean of the lateral diagonal entries.
double axial_less_lateral(const Matrix3& tensor, int axis, int dimension) {
  double difference = tensor(axis, axis);
  for (int k = 0; k < dimension; ++k)
    if (k != axis) difference -= tensor(k, k) / (dimension - 1);
  return difference;
}

std::vector<Shear> shear_of(std::span<const records::Record> stage, const std::string& axis, int dimension) {
  std::vector<Shear> all;
  for (const records::Record& record : stage) {
    const int a = axis[0] - 'x';
    if (axis.size() == 2) {
      const int b = axis[1] - 'x';
      all.push_back(
          {record.strain, record.deformation_gradient(a, b), 0.5 * (record.stress(a, b) + record.stress(b, a))});
    } else {
      all.push_back({record.strain, -axial_less_lateral(record.deformation_gradient, a, dimension),
                     -0.5 * axial_less_lateral(record.stress, a, dimension)});
    }
  }
  return all;
}

/// Rows at which the driving strain turns.
std::vector<std::size_t> turns_of(const std::vector<Shear>& path) {
  std::vector<std::size_t> turns;
  double before = 0;
  for (std::size_t k = 1; k < path.size(); ++k) {
    const double step = path[k].driving - path[k - 1].driving;
    if (step == 0) continue;
    if (step * before < 0) turns.push_back(k - 1);
    before = step;
  }
  return turns;
}

/// The loop of three turns: it opens at the first and closes at the last, on the same side.
Loop loop_of(const std::vector<Shear>& path, std::size_t first, std::size_t opposite, std::size_t last) {
  const double strain = 0.5 * (path[first].gamma + path[last].gamma) - path[opposite].gamma;
  const double stress = 0.5 * (path[first].tau + path[last].tau) - path[opposite].tau;
  double area = 0;
  for (std::size_t k = first + 1; k <= last; ++k)
    area += 0.5 * (path[k].tau + path[k - 1].tau) * (path[k].gamma - path[k - 1].gamma);
  // The loop need not close: a straight line back to its beginning closes it.
  area += 0.5 * (path[first].tau + path[last].tau) * (path[first].gamma - path[last].gamma);
  return {0.5 * std::abs(strain), stress / strain, area / (0.5 * std::numbers::pi * stress * strain)};
}

bool has_plane(const std::string& axis) {
  return (axis.size() == 1 || axis.size() == 2) && axis.find_first_not_of("xyz") == std::string::npos;
}

}  // namespace

std::vector<Loop> loops_of(std::span<const records::Record> stage, const std::string& axis, int dimension) {
  std::vector<Loop> loops;
  if (!has_plane(axis)) return loops;
  const std::vector<Shear> path = shear_of(stage, axis, dimension);
  std::vector<std::size_t> turns = turns_of(path);
  // The last turn is at the last record, if the strain came back by then.
  if (turns.size() > 1) {
    const auto travelled = [&](std::size_t from, std::size_t to) {
      return std::abs(path[to].driving - path[from].driving);
    };
    const std::size_t last = turns.back(), end = path.size() - 1;
    if (travelled(last, end) > 0.95 * travelled(turns[turns.size() - 2], last)) turns.push_back(end);
  }
  for (std::size_t k = 2; k < turns.size(); k += 2)
    loops.push_back(loop_of(path, turns[k - 2], turns[k - 1], turns[k]));
  return loops;
}

double initial_shear_modulus(std::span<const records::Record> stage, const std::string& axis, int dimension,
                             double gamma) {
  if (!has_plane(axis)) return nan;
  const std::vector<Shear> path = shear_of(stage, axis, dimension);
  for (std::size_t k = 1; k < path.size(); ++k) {
    const double strain = path[k].gamma - path[0].gamma;
    if (strain != 0 && std::abs(strain) >= gamma) return (path[k].tau - path[0].tau) / strain;
  }
  return nan;
}

ReferenceModulus reference_modulus(std::span<const records::Record> stage, const std::vector<Loop>& loops,
                                   const std::vector<records::ProbeResult>& probes, const std::string& axis,
                                   int dimension) {
  if (!probes.empty()) {
    const Eigen::MatrixXd& stiffness = probes.front().stiffness;
    return {stiffness.diagonal().tail(stiffness.rows() - dimension).mean(), "probe"};
  }
  ReferenceModulus found{initial_shear_modulus(stage, axis, dimension), "first record"};
  for (const Loop& loop : loops)
    if (!(found.G >= loop.G)) found = {loop.G, "stiffest loop"};
  return found;
}

}  // namespace rvelab::ensemble
