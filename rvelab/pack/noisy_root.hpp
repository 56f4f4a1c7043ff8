// Root of a function of one variable whose values scatter.
#pragma once

#include <vector>

namespace rvelab::pack {

/// Newton's method from the weighted mean of the points near the root, by the slope of least squares through them; that
/// of the start counts as further points.
class NoisyRoot {
 public:
  /// Between `low` and `high`, first at `start`; `slope`: about that of the function, not 0; `scatter`: values that
  /// small are near the root.
  NoisyRoot(double low, double high, double start, double slope, double scatter);
  void add(double at, double value);
  double next() const;
  /// Whether two points at the same end say that the root lies beyond it.
  bool out_of_range() const;

 private:
  struct Point {
    double at, value;
  };
  double low_, high_, start_, slope_, scatter_;
  std::vector<Point> points_;
};

}  // namespace rvelab::pack
