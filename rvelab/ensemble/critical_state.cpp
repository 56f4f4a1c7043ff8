#include "rvelab/ensemble/critical_state.hpp"

#include <cmath>

#include "rvelab/ensemble/statistics.hpp"
#include "rvelab/measure/measures.hpp"

namespace rvelab::ensemble {
namespace {

/// What the line is straight in.
double abscissa(double p, LineForm form) {
  constexpr double kilopascal = 1e3, atmosphere = 101325, exponent = 0.7;
  return form == LineForm::logarithmic ? std::log(p / kilopascal) : std::pow(p / atmosphere, exponent);
}

bool has_void_ratio(const records::Record& record) {
  return (record.quantities & records::asked<records::VoidRatio>) != 0;
}

}  // namespace

CriticalState critical_state_of(std::span<const records::Record> stage, int dimension, double from) {
  CriticalState state{nan, nan, nan, nan, nan, nan};
  if (stage.empty()) return state;
  if (has_void_ratio(stage.front())) state.start_void_ratio = stage.front().void_ratio;
  state.start_p = mean_pressure(stage.front().stress, dimension);
  const double end = std::abs(stage.back().strain), middle = 0.5 * (from + end);
  Matrix3 stress = Matrix3::Zero();
  double early = 0, late = 0;
  int early_count = 0, late_count = 0;
  for (const records::Record& record : stage) {
    if (std::abs(record.strain) < from * (1 - 1e-9)) continue;
    stress += record.stress;
    const double void_ratio = has_void_ratio(record) ? record.void_ratio : nan;
    const bool first = std::abs(record.strain) < middle;
    (first ? early : late) += void_ratio;
    ++(first ? early_count : late_count);
  }
  const int count = early_count + late_count;
  if (count == 0) return state;
  state.p = mean_pressure(stress, dimension) / count;
  state.stress_ratio = deviatoric_stress(stress, dimension) / mean_pressure(stress, dimension);
  state.void_ratio = (early + late) / count;
  if (early_count > 0 && late_count > 0) state.void_ratio_change = late / late_count - early / early_count;
  return state;
}

double CriticalLine::void_ratio(double p) const { return Gamma - lambda * abscissa(p, form); }

CriticalLine fitted_line(const std::vector<CriticalState>& states, LineForm form) {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  const auto usable = [](const CriticalState& state) { return state.p > 0 && std::isfinite(state.void_ratio); };
  for (const CriticalState& state : states) {
    if (!usable(state)) continue;
    const double at = abscissa(state.p, form);
    n += 1, x += at, y += state.void_ratio, xx += at * at, xy += at * state.void_ratio;
  }
  CriticalLine line{form, nan, nan, nan};
  const double variance = n * xx - x * x;
  if (!(n >= 2 && variance > 1e-12 * n * xx)) return line;
  line.lambda = -(n * xy - x * y) / variance;
  line.Gamma = (y + line.lambda * x) / n;
  double squares = 0;
  for (const CriticalState& state : states)
    if (usable(state)) squares += std::pow(state.void_ratio - line.void_ratio(state.p), 2);
  line.deviation = std::sqrt(squares / n);
  return line;
}

}  // namespace rvelab::ensemble
