#include "rvelab/pack/search.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <optional>

#include "rvelab/error.hpp"
#include "rvelab/pack/consolidation.hpp"
#include "rvelab/pack/not_found.hpp"

namespace rvelab::pack {

namespace {

constexpr double half_friction = 0.1;     ///< whose coordinate is one half
constexpr double least_deviation = 1e-3;  ///< of void ratios of one friction, where few draws show less
constexpr double bandwidth = 0.2;         ///< of the local line, over the range of coordinates

constexpr const char* remedy_of_unrest =
    "; raise target.unbalanced or target.stress_tolerance, give stiffer grains, some friction, or a stress that this "
    "packing can carry";

/// Level pieces of the best rising curve.
struct Level {
  double coordinate = 0, void_ratio = 0;  ///< means
  double weight = 1;
};

std::vector<Level> rising_fit(std::vector<CurvePoint> points) {
  std::stable_sort(points.begin(), points.end(),
                   [](const CurvePoint& a, const CurvePoint& b) { return a.coordinate < b.coordinate; });
  std::vector<Level> levels;
  for (const CurvePoint& point : points) {
    Level level{point.coordinate, point.void_ratio, 1};
    // Pool adjacent violators: a level that is not above the one before becomes one with it.
    while (!levels.empty() && levels.back().void_ratio >= level.void_ratio) {
      const Level& before = levels.back();
      const double weight = before.weight + level.weight;
      level.coordinate = (before.coordinate * before.weight + level.coordinate * level.weight) / weight;
      level.void_ratio = (before.void_ratio * before.weight + level.void_ratio * level.weight) / weight;
      level.weight = weight;
      levels.pop_back();
    }
    levels.push_back(level);
  }
  return levels;
}

/// Where the fit meets the target.
double crossing(const std::vector<Level>& levels, double target, double low, double high) {
  if (levels.empty() || target <= levels.front().void_ratio) return low;
  for (std::size_t k = 1; k < levels.size(); ++k) {
    if (target > levels[k].void_ratio) continue;
    const Level &a = levels[k - 1], &b = levels[k];
    return a.coordinate + (b.coordinate - a.coordinate) * ((target - a.void_ratio) / (b.void_ratio - a.void_ratio));
  }
  return high;
}

class Search {
 public:
  Search(const Recipe& recipe, Workers& workers, const PackWatch& watch)
      : recipe_(recipe),
        workers_(workers),
        watch_(watch),
        low_(coordinate_of(recipe.preparation.lowest_friction)),
        high_(coordinate_of(recipe.preparation.highest_friction)),
        uniform_(recipe.seed, std::numeric_limits<std::uint64_t>::max()) {}

  Packing run() {
    while (long(draws_.size()) < recipe_.preparation.max_draws) {
      const std::size_t first = draws_.size();
      const auto count = std::size_t(std::min(draws_at_a_time, recipe_.preparation.max_draws - long(first)));
      for (std::size_t k = 0; k < count; ++k) {
        draws_.emplace_back();
        draws_.back().friction = std::clamp(friction_of(next_coordinate(first + k, first)),
                                            recipe_.preparation.lowest_friction, recipe_.preparation.highest_friction);
      }
      if (const auto found = make(first, count)) return packing(*found);
      if (made().empty() && overlap_) std::rethrow_exception(overlap_);
      if (made().empty() && unrest_ == draws_.size() - begin_)
        throw IncrementFailed("packing: " + failures_[begin_] + remedy_of_unrest);
      if (contacts_out_of_reach())
        throw not_found(recipe_, made(), draws_.size() - begin_ - made().size(), End::contacts_out_of_reach);
      if (!reduced_expansion() && out_of_reach())
        throw not_found(recipe_, made(), draws_.size() - begin_ - made().size(), End::out_of_reach);
    }
    if (made().empty()) throw IncrementFailed(failures_[begin_]);
    throw not_found(recipe_, made(), draws_.size() - begin_ - made().size(), End::draws_spent);
  }

 private:
  /// With the present expansion.
  std::vector<Draw> made() const {
    std::vector<Draw> made;
    for (std::size_t k = begin_; k < draws_.size(); ++k)
      if (failures_[k].empty()) made.push_back(draws_[k]);
    return made;
  }

  /// Draws with one friction scatter by thousandths, those of few grains by hundredths. Where those at the end of the
  /// range that is nearer to the target miss it by many times their standard deviation, no draw to come will meet it:
  /// ten times of four draws, which know that deviation poorly, towards five times of many.
  bool out_of_reach(double deviations = 5) const {
    const double target = *recipe_.void_ratio, near_end = 0.05 * (high_ - low_);
    const std::vector<Draw> draws = made();
    const auto too_low = [&](const Draw& draw) { return draw.void_ratio < target; };
    const bool above = !draws.empty() && too_low(draws.front());
    if (!std::all_of(draws.begin(), draws.end(), [&](const Draw& draw) { return too_low(draw) == above; }))
      return false;
    double n = 0, sum = 0, squares = 0;
    for (const Draw& draw : draws) {
      const double at = coordinate_of(draw.friction), missed = draw.void_ratio - target;
      if (above ? at < high_ - near_end : at > low_ + near_end) continue;
      ++n;
      sum += missed;
      squares += missed * missed;
    }
    if (n < double(draws_at_a_time)) return false;
    const double mean = sum / n, deviation = std::sqrt(std::max(0.0, squares - n * mean * mean) / (n - 1));
    return std::abs(mean) >
           recipe_.void_ratio_tolerance + deviations * (1 + 4 / n) * std::max(deviation, least_deviation);
  }

  /// Agitated grains become denser: a third of the expansion for the draws to come, where the recipe allows it, in the
  /// end no agitation. To miss a density that could be had costs no more than the expansion.
  bool reduced_expansion() {
    Preparation& p = recipe_.preparation;
    constexpr double unlikely = 0.5;
    if (!p.expansion || !p.least_expansion || *p.expansion <= *p.least_expansion || !out_of_reach(unlikely) ||
        made().front().void_ratio >= *recipe_.void_ratio || long(draws_.size()) >= p.max_draws)
      return false;
    p.expansion = std::max(*p.least_expansion, *p.expansion / 3);
    if (*p.least_expansion == 0 && *p.expansion < smallest_expansion) p.expansion.reset();
    begin_ = draws_.size();
    unrest_ = 0;
    overlap_ = nullptr;
    return true;
  }

  /// Whether draws near the void ratio of the target all had other contacts than its.
  bool contacts_out_of_reach() const {
    std::size_t in_vain = 0;
    for (const Draw& draw : made()) {
      if (draw.compressed.empty()) continue;
      const Compressed& last = draw.compressed.back();
      if (std::abs(last.void_ratio - *recipe_.void_ratio) > near_density(recipe_)) continue;
      if (last.meets(recipe_.contacts)) return false;
      if (draw.contacts_in_vain) ++in_vain;
    }
    return in_vain >= 3;
  }

  /// What the known draw of the nearest friction, the last of such, learnt.
  Agitation first_agitation(double friction, std::size_t known) const {
    Agitation first{recipe_.preparation.expansion.value_or(Agitation{}.expansion), 0};
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t k = begin_; k < known; ++k) {
      const Draw& draw = draws_[k];
      const double distance = std::abs(coordinate_of(draw.friction) - coordinate_of(friction));
      if (!failures_[k].empty() || draw.compressed.empty() || distance > nearest) continue;
      nearest = distance;
      first = draw.next_agitation;
    }
    return first;
  }

  double next_coordinate(std::size_t number, std::size_t known) {
    // The first ones over the range, at its middles rather than its ends.
    if (known == begin_) {
      const double part = (double(number - begin_) + 0.5) / double(draws_at_a_time);
      return low_ + (high_ - low_) * (begin_ == 0 ? part : 0.5 * (1 + part));  // reduced: the target is loose
    }
    std::vector<CurvePoint> points;
    for (std::size_t k = begin_; k < known; ++k) {
      if (failures_[k].empty()) points.push_back({coordinate_of(draws_[k].friction), draws_[k].void_ratio});
    }
    if (points.empty()) return low_ + (high_ - low_) * uniform_();
    const double near = fitted_coordinate(points, *recipe_.void_ratio, low_, high_);
    const double width = 0.03 * (high_ - low_) / (1 + 0.25 * double(known));
    return std::clamp(near + width * (uniform_() - 0.5), low_, high_);
  }

  bool accepted(const Draw& draw) const {
    return draw.at_rest && std::abs(draw.void_ratio - *recipe_.void_ratio) <= recipe_.void_ratio_tolerance &&
           (draw.compressed.empty() || draw.compressed.back().meets(recipe_.contacts));
  }

  /// Makes some draws; the first that is accepted by number, not by time.
  std::optional<std::size_t> make(std::size_t first, std::size_t count) {
    failures_.resize(first + count);
    std::atomic<std::size_t> found{first + count};
    workers_.for_each_in_turn(count, [&](std::size_t k) {
      const std::size_t number = first + k;
      if (number > found) return;  // an earlier one was accepted: nobody will look at this one
      Draw& made = draws_[number];
      try {
        made = draw(recipe_, long(number) + 1, made.friction, watch_.of(long(number) + 1),
                    first_agitation(made.friction, first));
      } catch (const OverlapBeyondLimit& failure) {
        failures_[number] = failure.what();
        if (number == begin_) overlap_ = std::current_exception();
        return;
      } catch (const NotAtRest& failure) {
        failures_[number] = failure.what();
        ++unrest_;
        return;
      } catch (const IncrementFailed& failure) {
        failures_[number] = failure.what();
        return;
      }
      if (watch_.on_draw) watch_.on_draw(long(number) + 1, made.void_ratio);
      if (!accepted(made)) {
        made.specimen = Specimen{};
        return;
      }
      std::size_t earliest = found;
      while (number < earliest && !found.compare_exchange_weak(earliest, number)) {
      }
    });
    if (found == first + count) return std::nullopt;
    return found.load();
  }

  Packing packing(std::size_t number) {
    Packing packing;
    packing.draw = long(number) + 1;
    packing.preparation_friction = draws_[number].friction;
    packing.void_ratio = draws_[number].void_ratio;
    if (!draws_[number].compressed.empty()) packing.agitation = draws_[number].compressed.back().by;
    packing.specimen = std::move(draws_[number].specimen);
    return packing;
  }

  Recipe recipe_;  ///< with the present expansion
  Workers& workers_;
  const PackWatch& watch_;
  double low_, high_;
  Uniform uniform_;
  std::vector<Draw> draws_;
  std::size_t begin_ = 0;               ///< of the draws with the present expansion
  std::atomic<std::size_t> unrest_{0};  ///< draws whose grains did not come to rest
  std::exception_ptr overlap_;          ///< of the first draw, if its grains overlapped too much
  std::vector<std::string> failures_;   ///< of each draw, written by its own thread; empty: it was made
};

/// The friction of a draw that no void ratio is searched with.
double only_friction(const Recipe& recipe) {
  if (recipe.preparation.friction) return *recipe.preparation.friction;
  if (!recipe.stress) return 0;
  double friction = recipe.materials.front().friction;
  for (const Material& material : recipe.materials) friction = std::min(friction, material.friction);
  return friction;
}

}  // namespace

double coordinate_of(double friction) { return friction / (friction + half_friction); }

double friction_of(double coordinate) {
  return coordinate < 1 ? half_friction * coordinate / (1 - coordinate) : std::numeric_limits<double>::max();
}

double fitted_coordinate(const std::vector<CurvePoint>& points, double target, double low, double high) {
  double at = crossing(rising_fit(points), target, low, high);
  if (at == low || at == high) return at;
  // The rising fit follows each point of a close cluster. The straight line of least squares around its answer looks at
  // the cluster's mean and at its surroundings.
  for (int round = 0; round < 4; ++round) {
    double weights = 0, x = 0, e = 0, xx = 0, xe = 0;
    for (const CurvePoint& point : points) {
      const double far = (point.coordinate - at) / (bandwidth * (high - low));
      const double weight = 1 / ((1 + far * far) * (1 + far * far));
      weights += weight;
      x += weight * point.coordinate;
      e += weight * point.void_ratio;
    }
    x /= weights;
    e /= weights;
    for (const CurvePoint& point : points) {
      const double far = (point.coordinate - at) / (bandwidth * (high - low));
      const double weight = 1 / ((1 + far * far) * (1 + far * far)), from = point.coordinate - x;
      xx += weight * from * from;
      xe += weight * from * (point.void_ratio - e);
    }
    if (!(xe > 0)) return at;
    const double next = x + (target - e) * xx / xe;
    at = std::clamp(std::clamp(next, at - 0.5 * bandwidth * (high - low), at + 0.5 * bandwidth * (high - low)), low,
                    high);
  }
  return at;
}

Packing pack(const Recipe& recipe, Workers& workers, const PackWatch& watch) {
  check_recipe(recipe);
  if (recipe.stress && recipe.void_ratio) return Search(recipe, workers, watch).run();
  Draw made;
  const auto meets = [&] { return made.compressed.empty() || made.compressed.back().meets(recipe.contacts); };
  long number = 0;
  do {  // again where the last of the way to rest changed contacts that had met the target
    ++number;
    try {
      made = draw(recipe, number, only_friction(recipe), watch.of(number));
    } catch (const NotAtRest& failure) {
      throw IncrementFailed("packing: " + std::string(failure.what()) + remedy_of_unrest);
    }
  } while (!meets() && !made.contacts_in_vain && number < recipe.preparation.max_draws);
  if (!meets()) throw not_found(recipe, {made}, 0, End::contacts_out_of_reach);
  if (!made.at_rest)
    throw IncrementFailed("packing: the grains did not come to rest at the target stress" +
                          (made.why_not.empty() ? "" : ": " + made.why_not) + remedy_of_unrest);
  if (watch.on_draw) watch.on_draw(number, made.void_ratio);
  Packing packing{std::move(made.specimen), number, made.friction, made.void_ratio};
  if (!made.compressed.empty()) packing.agitation = made.compressed.back().by;
  return packing;
}

}  // namespace rvelab::pack
