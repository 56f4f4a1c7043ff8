// The critical-state line through the ends of several tests, and the state parameter.
//   logarithmic: e_c = Gamma - lambda ln(p/1 kPa)                      (Schofield and Wroth 1968)
//   power:       e_c = Gamma - lambda (p/p_a)^0.7, p_a = 101.325 kPa   (Li and Wang 1998)
// psi = e - e_c(p) (Been and Jefferies 1985): positive in loose, contractive states.
#pragma once

#include <span>
#include <vector>

#include "rvelab/records/record.hpp"

namespace rvelab::ensemble {

/// Means over the end of a test. p in Pa. NaN where the test does not go so far or recorded no void ratio.
struct CriticalState {
  double p = 0, void_ratio = 0, stress_ratio = 0;  ///< stress_ratio: q/p of the mean stress
  double start_p = 0, start_void_ratio = 0;        ///< of the first record
  double void_ratio_change = 0;  ///< of the second half of the range less the first: how steady the state is
};

/// Over the records of a stage with |strain| >= `from`, up to the end.
CriticalState critical_state_of(std::span<const records::Record> stage, int dimension, double from);

enum class LineForm { logarithmic, power };

/// Least squares over states with a p > 0 and a void ratio. NaN from fewer than two different p.
struct CriticalLine {
  LineForm form = LineForm::logarithmic;
  double Gamma = 0, lambda = 0;
  double deviation = 0;  ///< root of the mean square of e less e_c
  double void_ratio(double p) const;
};
CriticalLine fitted_line(const std::vector<CriticalState>& states, LineForm form);

}  // namespace rvelab::ensemble
