// The search for a void ratio.
//
// The void ratio depends on the preparation friction, and on chance: other places of the grains, or a friction that
// differs by 1e-9 of itself, change it by several thousandths. So every draw (trial packing) places the grains again,
// with the friction at which the mean curve of the draws so far meets the target. The first one within the tolerance is
// taken.
#pragma once

#include <atomic>
#include <functional>
#include <vector>

#include "rvelab/pack/draw.hpp"
#include "rvelab/threads/workers.hpp"

namespace rvelab::pack {

/// A friction as a coordinate between 0 and 1, in which the mean curve is well spread: x = mu/(mu + 0.1).
double coordinate_of(double friction);
double friction_of(double coordinate);

/// A draw as the fit sees it.
struct CurvePoint {
  double coordinate = 0, void_ratio = 0;
};

/// Where the mean curve of the points meets the target, between `low` and `high`; one of these where the target lies
/// beyond the curve. The curve is the rising one of least squares (isotonic), smoothed by a local line.
double fitted_coordinate(const std::vector<CurvePoint>& points, double target, double low, double high);

/// Draws made at a time, whatever the number of threads: so the next ones know the same draws.
inline constexpr long draws_at_a_time = 4;

/// Progress of a search, on any thread.
struct PackWatch {
  std::function<void(long draw, double void_ratio)> on_draw;          ///< after each draw
  std::function<void(long draw, const std::string& phase)> on_phase;  ///< often, while it is made
  const std::atomic<bool>* stop = nullptr;
  DrawWatch of(long draw) const {
    if (!on_phase) return {stop};
    return {stop, [this, draw](const std::string& phase) { on_phase(draw, phase); }};
  }
};

/// Makes the specimen of a recipe. The same recipe gives the same bits, whatever the number of workers. Error naming
/// the reached range if no draw of a search is within the tolerance; IncrementFailed if the only draw fails;
/// InputError; Interrupted.
Packing pack(const Recipe& recipe, Workers& workers, const PackWatch& watch = {});

}  // namespace rvelab::pack
