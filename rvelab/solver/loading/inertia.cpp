#include "rvelab/solver/loading/inertia.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rvelab {

double critical_step(const Model& model, const RowSums& sums) {
  double smallest = std::numeric_limits<double>::infinity();
  for (std::size_t g = 0; g < model.size(); ++g) {
    const double by_translation = sums.translation[g] / model.mass[g],
                 by_rotation = sums.rotation[g] / model.inertia[g];
    const double omega = std::sqrt(std::max(by_translation, by_rotation));
    if (!(omega > 0)) continue;
    double step = 2 / omega;
    if (!sums.dashpot.empty()) {
      const double lever = model.bodies ? model.bodies->lever[std::size_t(model.bodies->owner[g])] : model.reach()[g];
      const double rate = std::max(sums.dashpot[g] / model.mass[g],
                                   sums.dashpot[g] / model.share_of(g) * lever * lever / model.inertia[g]);
      const double zeta = rate / (2 * omega);
      step *= std::sqrt(1 + zeta * zeta) - zeta;
    }
    smallest = std::min(smallest, step);
  }
  return smallest;
}

RowSums with_floor(RowSums sums, const Model& model) {
  for (std::size_t g = 0; g < model.size(); ++g) {
    sums.translation[g] = std::max(sums.translation[g], model.share_of(g) * sums.floor_translation);
    sums.rotation[g] = std::max(sums.rotation[g], sums.floor_rotation * model.size_of(g) * model.size_of(g));
  }
  return sums;
}

namespace {

double scaled(double row_sum, double floor, double factor) { return std::max(row_sum, floor) / (4 * factor * factor); }

/// Of the state that a trial began with, before they become others.
void keep_masses(const Assembly& assembly) {
  Replaced* kept = assembly.trial.replaced;
  if (kept == nullptr || kept->masses_taken) return;
  kept->mass = assembly.mass;
  kept->inverse_mass = assembly.inverse_mass;
  kept->inverse_inertia = assembly.inverse_inertia;
  kept->masses_taken = true;
}

}  // namespace

void scale_inertia(const Model& model, const RowSums& sums, Assembly& assembly) {
  keep_masses(assembly);
  const double factor = model.options.time_step_factor;
  for (std::size_t g = 0; g < model.size(); ++g) {
    assembly.mass[g] = scaled(sums.translation[g], model.share_of(g) * sums.floor_translation, factor);
    const double inertia = scaled(sums.rotation[g], sums.floor_rotation * model.size_of(g) * model.size_of(g), factor);
    assembly.inverse_mass[g] = 1 / assembly.mass[g];
    assembly.inverse_inertia[g] = 1 / inertia;
  }
}

double least_stiffness(const Model& model, const Assembly& assembly) {
  const double factor = model.options.time_step_factor;
  if (model.bodies) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t g = 0; g < model.size(); ++g) least = std::min(least, assembly.mass[g] / model.share_of(g));
    return 4 * factor * factor * least;
  }
  return 4 * factor * factor *
         *std::min_element(assembly.mass.begin(), assembly.mass.begin() + std::ptrdiff_t(model.size()));
}

void use_physical_inertia(const Model& model, Assembly& assembly) {
  keep_masses(assembly);
  for (std::size_t g = 0; g < model.size(); ++g) {
    assembly.mass[g] = model.mass[g];
    assembly.inverse_mass[g] = 1 / model.mass[g];
    assembly.inverse_inertia[g] = 1 / model.inertia[g];
  }
}

}  // namespace rvelab
