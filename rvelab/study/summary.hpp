// Results of each grid point: errors of the increments, their cost, the Pareto fronts, and the measures of the whole
// paths.
#pragma once

#include <string>
#include <vector>

#include "rvelab/calibrate/calibrate.hpp"
#include "rvelab/study/run_study.hpp"

namespace rvelab::study {

/// Of a set of errors. NaN: there are none.
struct ErrorSummary {
  double rms = 0, median = 0, percentile_95 = 0, largest = 0;
};

/// Root of the mean square, median (of an even number the mean of the middle two), the least value that 95 % do not
/// exceed, and the largest.
ErrorSummary summary_of(std::vector<double> errors);

/// Quality of the error estimates. NaN: there are none (at a rate).
struct EstimateSummary {
  double median_over_error = 0;  ///< of estimate over error
  double covered = 0;            ///< share of the increments whose error is at most the estimate
  double allowed = 0;            ///< the same of what the tolerances allow
};

/// Of errors, their estimates and what is allowed, in the same order.
EstimateSummary summary_of_estimates(const std::vector<double>& errors, const std::vector<double>& estimates,
                                     const std::vector<double>& allowed);

struct PointSummary {
  std::vector<std::string> values;  ///< of the varied keys; empty for the reference
  std::size_t increments = 0, failed = 0;
  ErrorSummary of_pressure;   ///< error over p
  ErrorSummary of_increment;  ///< error over the change of stress that the reference's answer makes
  EstimateSummary estimate;
  double seconds = 0, grain_steps = 0;  ///< processor time and grain-steps of an increment, means
  /// On the Pareto front of this cost and the median error over p. The rms is that of the few increments that fall into
  /// an avalanche, whose answers scatter at any resolution.
  bool front_seconds = false, front_grain_steps = false;
  /// Of each measure: mean over the specimens of their means over the repeats, and its standard error from the scatter
  /// of the repeats alone: specimens are the same at every point. NaN: fewer than two repeats, or one not defined.
  std::vector<double> means, standard_errors;
  std::size_t failed_paths = 0;
  double path_seconds = 0, path_grain_steps = 0;  ///< of a whole path, means
  std::string failure;                            ///< the first reason of what failed; empty: nothing did
};

struct StudySummary {
  PointSummary reference;       ///< errors: what relaxing its answers changes
  std::size_t not_at_rest = 0;  ///< of its answers
  std::vector<PointSummary> points;
};

StudySummary summary_of(const Study& study, const Prepared& prepared, const Pieces& pieces);

struct Standing {
  double cost = 0, error = 0;
};

/// True for each standing on the front: no other one has at most its cost and at most its error, and less of one. Equal
/// ones are all on it. Standings that are not finite are ignored.
std::vector<bool> pareto_front(const std::vector<Standing>& standings);

}  // namespace rvelab::study
