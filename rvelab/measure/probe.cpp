// Stiffness probes by quasi-static increments.
#include "rvelab/measure/probe.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "rvelab/error.hpp"
#include "rvelab/measure/tensor_order.hpp"

namespace rvelab {
namespace {

/// The stress is read at an unbalanced ratio this low if it can be reached, so that the remaining error (about this
/// times p) is far below the change of stress by a small probe.
constexpr double wanted_ratio = 1e-13;

/// Steps at a time towards it: round-off may keep a stiff specimen above this ratio, and further steps are then
/// useless.
constexpr long relaxing_steps = 2000;

double relax_fully(Rve& rve, long max_steps) {
  double smallest = rve.unbalanced_ratio();
  for (long made = 0; made < max_steps && smallest > wanted_ratio;) {
    const Report report = rve.relax(wanted_ratio, std::min(relaxing_steps, max_steps - made));
    made += std::max(report.substeps, 1L);
    // A late contact of a grain raises the ratio again: the state then needs further relaxation.
    const bool stalled = report.unbalanced_ratio > 0.5 * smallest && report.unbalanced_ratio < relaxed_ratio;
    smallest = std::min(smallest, report.unbalanced_ratio);
    if (stalled) break;
  }
  return rve.unbalanced_ratio();
}

/// Orthonormal symmetric tensors (A:B), the first along `direction`.
std::vector<Matrix3> tensors_from(const Matrix3& direction, int dimension) {
  const int components = component_count(dimension);
  std::vector<Matrix3> units;
  Eigen::VectorXd along(components);
  for (int k = 0; k < components; ++k) {
    const Matrix3 strain = unit_strain(k, dimension);
    units.push_back(strain / strain.norm());
    along[k] = units.back().cwiseProduct(direction).sum();
  }
  const double length = along.norm();
  if (!(length > 0 && std::isfinite(length)))
    throw InputError("the direction of loading is no strain; give a symmetric part that is finite and not zero");
  const Eigen::MatrixXd basis = Eigen::HouseholderQR<Eigen::MatrixXd>(along).householderQ();
  std::vector<Matrix3> tensors(std::size_t(components), Matrix3::Zero());
  for (int k = 0; k < components; ++k) {
    tensors[0] += along[k] / length * units[std::size_t(k)];
    for (int t = 1; t < components; ++t) tensors[std::size_t(t)] += basis(k, t) * units[std::size_t(k)];
  }
  return tensors;
}

/// Change of stress over strain in the second half of a path.
Eigen::VectorXd second_half(const Rve& rve, const Matrix3& strain, double size) {
  Rve copy(rve);
  const int dimension = rve.cell().dimension;
  const Matrix3 half = 0.5 * size * strain;
  copy.apply(half, 0);
  const Eigen::VectorXd middle = stress_components(copy.stress(), dimension);
  copy.apply(half, 0);
  return (stress_components(copy.stress(), dimension) - middle) / (0.5 * size);
}

}  // namespace

Probe probe_stiffness(const Rve& rve, double size, long max_steps) {
  if (!(size > 0 && size <= 0.01))
    throw InputError("probe size = " + in_words(size) +
                     " is out of range; allowed: above 0 to 0.01; give 1e-7 for an elastic probe");
  const int dimension = rve.cell().dimension, components = component_count(dimension);
  const Eigen::VectorXd start = stress_components(rve.stress(), dimension);
  Probe probe;
  probe.size = size;
  Eigen::MatrixXd plus(components, components), minus(components, components);
  for (int k = 0; k < components; ++k) {
    for (const int sign : {1, -1}) {
      Rve copy(rve);
      copy.apply(sign * size * unit_strain(k, dimension), 0);
      probe.unbalanced_ratio = std::max(probe.unbalanced_ratio, relax_fully(copy, max_steps));
      const Eigen::VectorXd change = stress_components(copy.stress(), dimension) - start;
      (sign > 0 ? plus : minus).col(k) = change / (sign * size);
    }
  }
  probe.stiffness = 0.5 * (plus + minus);
  const double largest = probe.stiffness.cwiseAbs().maxCoeff();
  if (largest > 0) probe.plus_minus_difference = (plus - minus).cwiseAbs().maxCoeff() / largest;
  probe.relaxed = probe.unbalanced_ratio < relaxed_ratio;
  return probe;
}

Eigen::MatrixXd loading_stiffness(const Rve& rve, const Matrix3& direction, double size) {
  if (!(size >= smallest_loading_probe && size <= largest_loading_probe))
    throw InputError("size of a loading probe = " + in_words(size) +
                     " is out of range; allowed: " + in_words(smallest_loading_probe) + " to " +
                     in_words(largest_loading_probe) + "; give " + in_words(usual_loading_probe));
  constexpr double aside = 0.3;
  const int dimension = rve.cell().dimension, components = component_count(dimension);
  const std::vector<Matrix3> tensors = tensors_from(direction, dimension);
  Eigen::MatrixXd stiffness = Eigen::MatrixXd::Zero(components, components);
  for (std::size_t t = 0; t < tensors.size(); ++t) {
    const Matrix3& tensor = tensors[t];
    const Eigen::VectorXd response = t == 0 ? second_half(rve, tensor, size)
                                            : Eigen::VectorXd((second_half(rve, tensors[0] + aside * tensor, size) -
                                                               second_half(rve, tensors[0] - aside * tensor, size)) /
                                                              (2 * aside));
    for (int k = 0; k < components; ++k)
      stiffness.col(k) += response * tensor.cwiseProduct(unit_strain(k, dimension)).sum();
  }
  return stiffness;
}

void forbid_slip(Rve& rve) {
  std::vector<Material> materials = rve.specimen().materials;
  for (Material& material : materials) material.friction = material.rolling_friction = 1e6;
  rve.set_materials(materials);
}

std::vector<std::string> component_names(int dimension) {
  constexpr char axis[] = "xyz";
  std::vector<std::string> names;
  for (int k = 0; k < component_count(dimension); ++k) {
    const auto [row, column] = component_axes(k, dimension);
    names.push_back({axis[row], axis[column]});
  }
  return names;
}

}  // namespace rvelab
