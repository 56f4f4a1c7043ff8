#include "rvelab/study/summary.hpp"

#include <algorithm>
#include <cmath>

#include "rvelab/study/measures.hpp"

namespace rvelab::study {

namespace {

double mean_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return values.empty() ? no_value : sum / double(values.size());
}

void add_increments(const std::vector<const Piece*>& pieces, PointSummary& point) {
  std::vector<double> of_pressure, of_increment, made, estimates, allowed, seconds, grain_steps;
  for (const Piece* piece : pieces) {
    const auto& error = piece->column("error_Pa");
    point.increments += error.size();
    for (std::size_t k = 0; k < error.size(); ++k) {
      if (!std::isfinite(error[k])) {
        ++point.failed;
        continue;
      }
      of_pressure.push_back(error[k] / piece->column("pressure_Pa")[k]);
      of_increment.push_back(error[k] / piece->column("increment_Pa")[k]);
      made.push_back(error[k]);
      estimates.push_back(piece->column("estimate_Pa")[k]);
      allowed.push_back(piece->column("allowed_Pa")[k]);
      seconds.push_back(piece->column("seconds")[k]);
      grain_steps.push_back(piece->column("grain_steps")[k]);
    }
  }
  point.of_pressure = summary_of(std::move(of_pressure));
  point.of_increment = summary_of(std::move(of_increment));
  point.estimate = summary_of_estimates(made, estimates, allowed);
  point.seconds = mean_of(seconds);
  point.grain_steps = mean_of(grain_steps);
}

/// `paths`: the repeats of each specimen.
void add_paths(const std::vector<std::vector<const Piece*>>& paths, PointSummary& point) {
  std::vector<double> seconds, grain_steps;
  for (const auto& repeats : paths) {
    for (const Piece* piece : repeats) {
      if (!piece->failure.empty()) {
        ++point.failed_paths;
        continue;
      }
      seconds.push_back(piece->column("seconds").at(0));
      grain_steps.push_back(piece->column("grain_steps").at(0));
    }
  }
  point.path_seconds = mean_of(seconds);
  point.path_grain_steps = mean_of(grain_steps);
  for (const Measure& measure : measures()) {
    double mean = 0, square = 0;
    const auto specimens = double(paths.size());
    for (const auto& repeats : paths) {
      std::vector<double> values;
      for (const Piece* piece : repeats) values.push_back(piece->column(measure.name).at(0));
      const calibrate::Statistics found = calibrate::statistics(values);
      mean += values.empty() ? no_value : found.mean / specimens;
      square += found.standard_error * found.standard_error;
    }
    point.means.push_back(mean);
    point.standard_errors.push_back(std::sqrt(square) / specimens);
  }
}

void mark_front(std::vector<PointSummary>& points, double PointSummary::*cost, bool PointSummary::*mark) {
  std::vector<Standing> standings;
  for (const PointSummary& point : points) standings.push_back({point.*cost, point.of_pressure.median});
  const std::vector<bool> front = pareto_front(standings);
  for (std::size_t k = 0; k < points.size(); ++k) points[k].*mark = front[k];
}

}  // namespace

ErrorSummary summary_of(std::vector<double> errors) {
  if (errors.empty()) return {no_value, no_value, no_value, no_value};
  std::sort(errors.begin(), errors.end());
  const std::size_t count = errors.size();
  double squares = 0;
  for (const double error : errors) squares += error * error;
  const auto rank_95 = std::size_t(std::ceil(0.95 * double(count) - 1e-9));
  return {std::sqrt(squares / double(count)), 0.5 * (errors[(count - 1) / 2] + errors[count / 2]), errors[rank_95 - 1],
          errors.back()};
}

EstimateSummary summary_of_estimates(const std::vector<double>& errors, const std::vector<double>& estimates,
                                     const std::vector<double>& allowed) {
  std::vector<double> ratios;
  double count = 0, below_estimate = 0, below_allowed = 0;
  for (std::size_t k = 0; k < errors.size(); ++k) {
    if (!std::isfinite(estimates[k])) continue;
    count += 1;
    below_estimate += errors[k] <= estimates[k] ? 1 : 0;
    below_allowed += errors[k] <= allowed[k] ? 1 : 0;
    if (errors[k] > 0) ratios.push_back(estimates[k] / errors[k]);
  }
  return {summary_of(std::move(ratios)).median, below_estimate / count, below_allowed / count};
}

StudySummary summary_of(const Study& study, const Prepared& prepared, const Pieces& pieces) {
  const auto summarised = [&](std::size_t number) {
    PointSummary point;
    if (number > 0) point.values = values_at(study.grid, number - 1);
    std::vector<const Piece*> increments;
    std::vector<std::vector<const Piece*>> paths;
    for (std::size_t s = 1; s <= prepared.specimens.size(); ++s) {
      paths.emplace_back();
      for (std::size_t r = 1; r <= std::size_t(study.repeats); ++r) {
        paths.back().push_back(&pieces.by_name.at(path_piece(number, s, r)));
      }
      if (study.increments > 0) increments.push_back(&pieces.by_name.at(increments_piece(number, s)));
      for (const Piece* piece : paths.back()) {
        if (point.failure.empty()) point.failure = piece->failure;
      }
      if (!increments.empty() && point.failure.empty()) point.failure = increments.back()->failure;
    }
    add_increments(increments, point);
    add_paths(paths, point);
    return point;
  };
  StudySummary summary;
  summary.reference = summarised(0);
  for (std::size_t point = 1; point <= prepared.points.size(); ++point) summary.points.push_back(summarised(point));
  mark_front(summary.points, &PointSummary::seconds, &PointSummary::front_seconds);
  mark_front(summary.points, &PointSummary::grain_steps, &PointSummary::front_grain_steps);
  for (std::size_t s = 1; s <= prepared.specimens.size() && study.increments > 0; ++s) {
    const auto& at_rest = pieces.by_name.at(increments_piece(0, s)).column("at_rest");
    summary.not_at_rest += std::size_t(std::count(at_rest.begin(), at_rest.end(), 0.0));
  }
  return summary;
}

std::vector<bool> pareto_front(const std::vector<Standing>& standings) {
  const auto finite = [](const Standing& one) { return std::isfinite(one.cost) && std::isfinite(one.error); };
  std::vector<bool> front;
  for (const Standing& one : standings) {
    const bool beaten = std::any_of(standings.begin(), standings.end(), [&](const Standing& other) {
      return finite(other) && other.cost <= one.cost && other.error <= one.error &&
             (other.cost < one.cost || other.error < one.error);
    });
    front.push_back(finite(one) && !beaten);
  }
  return front;
}

}  // namespace rvelab::study
