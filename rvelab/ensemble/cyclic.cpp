#include "rvelab/ensemble/cyclic.hpp"

#include <algorithm>
#include <cmath>

#include "rvelab/ensemble/statistics.hpp"

namespace rvelab::ensemble {
namespace {

/// Stresses of a record that count, compression positive: the one that drives, and the one that liquefaction takes.
struct CyclicStresses {
  double driving = 0, effective = 0;
};

CyclicStresses stresses_of(const Matrix3& stress, const std::string& axis, int dimension) {
  const int a = axis[0] - 'x';
  if (axis.size() == 2) {
    const int b = axis[1] - 'x';
    return {0.5 * (stress(a, b) + stress(b, a)), -stress(b, b)};
  }
  double lateral = 0;
  for (int k = 0; k < dimension; ++k)
    if (k != a) lateral -= stress(k, k) / (dimension - 1);
  return {-stress(a, a) - lateral, lateral};
}

/// From `turns` that were made and the part of the way from one turn to the next, -1 to 1.
double cycles_at(int turns, double part) {
  const double kept = std::clamp(part, -1.0, 1.0);
  return turns == 0 ? 0.25 * std::max(0.0, kept) : 0.25 + 0.5 * (turns - 1) + 0.25 * (kept + 1);
}

}  // namespace

CyclesTo cycles_to(std::span<const records::Record> stage, const std::string& axis, const protocol::Cycles& cycles,
                   double to_strain, int dimension) {
  constexpr double pore_pressure = 0.95, strain = 0.025;
  CyclesTo found{nan, nan};
  if (stage.empty() || axis.empty()) return found;
  const bool by_stress = cycles.reverse_at > 0;
  const double first = stresses_of(stage.front().stress, axis, dimension).effective;
  int turns = 0;
  double made = 0;
  double direction = to_strain < 0 ? -1 : 1, before = 0;
  for (std::size_t k = 1; k < stage.size(); ++k) {
    const double step = stage[k].strain - stage[k - 1].strain;
    if (step * before < 0) {
      ++turns;
      direction = -direction;
    }
    before = step;
    const CyclicStresses at = stresses_of(stage[k].stress, axis, dimension);
    const double part = by_stress ? at.driving / cycles.reverse_at : stage[k].strain / std::abs(to_strain);
    made = std::max(made, cycles_at(turns, direction * part));  // grains that flow lose the driving stress
    if (std::isnan(found.pore_pressure) && 1 - at.effective / first >= pore_pressure) found.pore_pressure = made;
    if (by_stress && std::isnan(found.strain) && std::abs(stage[k].strain) >= strain) found.strain = made;
  }
  return found;
}

}  // namespace rvelab::ensemble
