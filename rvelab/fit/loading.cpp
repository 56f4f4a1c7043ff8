#include "rvelab/fit/loading.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rvelab::fit {
namespace {

using Rows = std::vector<std::size_t>;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Rows in the range: from the first that enters it, until the abscissa leaves it at its end for more than a glitch.
Rows rows_in_range(const Readings& readings) {
  const auto& x = readings.x;
  const double from = readings.from.value_or(-infinity), to = readings.to.value_or(infinity);
  Rows finite, kept;
  for (std::size_t k = 0; k < x.size(); ++k)
    if (std::isfinite(x[k])) finite.push_back(k);
  for (std::size_t i = 0; i < finite.size(); ++i) {
    const double at = x[finite[i]];
    if (at >= from && at <= to) kept.push_back(finite[i]);
    if (at <= to || kept.empty()) continue;
    const bool goes_on = i + 2 < finite.size() && x[finite[i + 1]] <= to && x[finite[i + 1]] >= x[kept.back()] &&
                         x[finite[i + 2]] > x[finite[i + 1]];
    if (!goes_on) break;
  }
  return kept;
}

/// Takes out the largest as long as it is a glitch: one row that stands out by three times what any other step is.
void take_out_glitches(const std::vector<double>& x, Rows& rows, Rows& out) {
  while (rows.size() > 3) {
    const auto at = std::max_element(rows.begin(), rows.end(), [&](auto a, auto b) { return x[a] < x[b]; });
    const auto place = std::size_t(at - rows.begin());
    if (place + 2 >= rows.size()) return;
    double largest_step = 0;
    for (std::size_t k = 1; k < rows.size(); ++k)
      if (k != place && k != place + 1) largest_step = std::max(largest_step, std::abs(x[rows[k]] - x[rows[k - 1]]));
    const double before = place == 0 ? -infinity : x[rows[place - 1]], next = x[rows[place + 1]];
    const bool goes_on = place == 0 || next >= before - largest_step;
    if (!goes_on || x[*at] - std::max(before, next) <= 3 * largest_step) return;
    out.push_back(*at);
    rows.erase(at);
  }
}

/// Sorts the rows of readings into those of the loading and those that are left out.
class RowSorter {
 public:
  explicit RowSorter(const Readings& readings)
      : x_(readings.x), y_(readings.deviator), is_strain_(readings.is_strain) {}

  Loading sort(Rows in_range, bool with_seating) {
    rows_ = in_range;
    if (rows_.empty()) return found_;
    take_out_glitches(x_, rows_, found_.glitches);
    for (const std::size_t row : rows_) largest_deviator_ = std::max(largest_deviator_, deviator(row));  // not of NaN
    if (!with_seating) leave_out_seating();
    keep_up_to_largest();
    leave_out_end();
    if (rows_.empty()) return found_;
    learn_sensor();
    walk();
    join_near();
    const Rows& glitches = found_.glitches;
    for (const std::size_t row : in_range)
      if (row > rows_.back() && std::find(glitches.begin(), glitches.end(), row) == glitches.end())
        found_.after.push_back(row);
    for (const LoadingPoint& point : found_.points)
      if (point.rows.size() > 1) found_.joined.insert(found_.joined.end(), point.rows.begin(), point.rows.end());
    return found_;
  }

 private:
  double deviator(std::size_t row) const { return row < y_.size() ? y_[row] : std::nan(""); }

  /// Rows before contact; of a stress, those that are not above zero.
  void leave_out_seating() {
    std::size_t contact = rows_.size();
    if (!is_strain_) {
      contact = 0;
      while (contact < rows_.size() && !(x_[rows_[contact]] > 0)) ++contact;
    } else if (largest_deviator_ > 0) {
      for (std::size_t k = 0; k < rows_.size() && !(deviator(rows_[k]) > 0.05 * largest_deviator_); ++k)
        if (deviator(rows_[k]) <= 0) contact = k;
      if (contact == rows_.size()) return;
      found_.counts_from_contact = x_[rows_[contact]] != 0;
      found_.contact = rows_[contact];
    } else {
      return;
    }
    const auto begin = rows_.begin() + std::ptrdiff_t(contact);
    found_.before.assign(rows_.begin(), begin);
    rows_.erase(rows_.begin(), begin);
  }

  void keep_up_to_largest() {
    if (rows_.empty()) return;
    auto end = std::max_element(rows_.begin(), rows_.end(), [&](auto a, auto b) { return x_[a] < x_[b]; });
    const double largest = x_[*end];
    while (end != rows_.end() && x_[*end] == largest) ++end;
    rows_.erase(end, rows_.end());
  }

  /// The machine lets go: at the end the deviator drops to nothing, in big steps, while the strain hardly goes on.
  void leave_out_end() {
    const double largest = largest_deviator_;
    if (rows_.empty() || !is_strain_ || !(largest > 0) || !(deviator(rows_.back()) <= 0.02 * largest)) return;
    const double hardly = 0.01 * (x_[rows_.back()] - x_[rows_.front()]);
    std::size_t end = rows_.size();
    while (end > 0 && !(deviator(rows_[end - 1]) > 0.02 * largest)) --end;
    if (end < 2 || x_[rows_.back()] - x_[rows_[end - 1]] > hardly) return;
    while (end > 1 && deviator(rows_[end - 2]) - deviator(rows_[end - 1]) > 0.1 * largest &&
           x_[rows_[end - 1]] - x_[rows_[end - 2]] <= hardly)
      --end;
    rows_.resize(end);
  }

  void learn_sensor() {
    range_ = x_[rows_.back()] - x_[rows_.front()];
    step_ = infinity;
    std::vector<double> falls;
    bool falling = false;
    int times = 0;
    for (std::size_t k = 1; k < rows_.size(); ++k) {
      const double change = x_[rows_[k]] - x_[rows_[k - 1]];
      if (change != 0) step_ = std::min(step_, std::abs(change));
      if (change < 0) falls.push_back(-change);
      times += change < 0 && !falling;
      falling = change < 0;
    }
    if (times < 3) return;
    std::nth_element(falls.begin(), falls.begin() + std::ptrdiff_t(falls.size() / 2), falls.end());
    step_ = std::max(step_, falls[falls.size() / 2]);
  }

  bool is_noise(double largest, double lowest) const {
    const double fall = largest - lowest;
    if (!is_strain_ && fall > 0.2 * std::abs(largest)) return false;
    return fall <= 0.005 * (is_strain_ ? range_ : largest) || (fall <= 3 * step_ && fall <= 0.05 * range_);
  }

  void walk() {
    double largest = -infinity;
    for (std::size_t i = 0; i < rows_.size();) {
      if (x_[rows_[i]] > largest) {
        largest = x_[rows_[i]];
        found_.points.push_back({largest, {rows_[i]}});
        ++i;
        continue;
      }
      const std::size_t begin = i;
      double lowest = largest, lowest_deviator = infinity;
      for (; i < rows_.size() && x_[rows_[i]] <= largest; ++i) {
        lowest = std::min(lowest, x_[rows_[i]]);
        lowest_deviator = std::min(lowest_deviator, deviator(rows_[i]));
      }
      const double before = deviator(rows_[begin - 1]);
      const bool has_deviator = is_strain_ && std::isfinite(before) && std::isfinite(lowest_deviator);
      const bool unloaded = has_deviator && before - lowest_deviator > 0.03 * largest_deviator_;
      const bool noise = is_noise(largest, lowest);
      if (noise && !unloaded) {
        deepest_ = std::max(deepest_, largest - lowest);
        for (std::size_t k = begin; k < i; ++k) join(rows_[k]);
      } else {
        if (has_deviator && !unloaded && !found_.backwards) found_.backwards = rows_[begin];
        found_.unloading.insert(found_.unloading.end(), rows_.begin() + std::ptrdiff_t(begin),
                                rows_.begin() + std::ptrdiff_t(i));
      }
    }
  }

  /// A further point, joined with those before it that are not below it.
  void join(std::size_t row) {
    auto& points = found_.points;
    points.push_back({x_[row], {row}});
    while (points.size() > 1 && points[points.size() - 2].x >= points.back().x) {
      take_in(points[points.size() - 2], points.back());
      points.pop_back();
    }
  }
  static void take_in(LoadingPoint& point, const LoadingPoint& next) {
    const auto own = double(point.rows.size()), further = double(next.rows.size());
    point.x += (next.x - point.x) * further / (own + further);
    point.rows.insert(point.rows.end(), next.rows.begin(), next.rows.end());
  }

  /// Joined points and those beside them that lie within the noise.
  void join_near() {
    std::vector<LoadingPoint> points;
    for (LoadingPoint& point : found_.points) {
      const bool joined = !points.empty() && (points.back().rows.size() > 1 || point.rows.size() > 1);
      if (joined && point.x - x_[points.back().rows.front()] <= deepest_)
        take_in(points.back(), point);
      else
        points.push_back(std::move(point));
    }
    found_.points = std::move(points);
  }

  const std::vector<double>&x_, &y_;
  bool is_strain_;
  Rows rows_;
  double range_ = 0, step_ = 0;
  double largest_deviator_ = 0;
  double deepest_ = 0;  ///< fall that was taken for noise
  Loading found_;
};

}  // namespace

Loading loading_of(const Readings& readings) {
  return RowSorter(readings).sort(rows_in_range(readings), readings.from.has_value());
}

}  // namespace rvelab::fit
