#include "rvelab/fit/minimise.hpp"

#include <algorithm>
#include <vector>

namespace rvelab::fit {

Eigen::VectorXd minimised(const std::function<double(const Eigen::VectorXd&)>& function, const Eigen::VectorXd& start,
                          double size, int most_calls, double close) {
  struct Corner {
    Eigen::VectorXd at;
    double value;
  };
  int calls = 0;
  const auto corner = [&](const Eigen::VectorXd& at) {
    ++calls;
    return Corner{at, function(at)};
  };
  std::vector<Corner> simplex{corner(start)};
  for (Eigen::Index k = 0; k < start.size(); ++k) {
    Eigen::VectorXd at = start;
    at[k] += size;
    simplex.push_back(corner(at));
  }
  const auto by_value = [](const Corner& a, const Corner& b) { return a.value < b.value; };
  while (true) {
    std::stable_sort(simplex.begin(), simplex.end(), by_value);
    const Corner& best = simplex.front();
    Corner& worst = simplex.back();
    if (calls >= most_calls || worst.value - best.value < close) return best.at;
    Eigen::VectorXd centre = Eigen::VectorXd::Zero(start.size());
    for (std::size_t k = 0; k + 1 < simplex.size(); ++k) centre += simplex[k].at / double(simplex.size() - 1);
    const auto along = [&](double factor) { return corner(centre + factor * (worst.at - centre)); };
    const Corner reflected = along(-1);
    if (reflected.value < best.value) {
      const Corner expanded = along(-2);
      worst = expanded.value < reflected.value ? expanded : reflected;
      continue;
    }
    if (reflected.value < simplex[simplex.size() - 2].value) {
      worst = reflected;
      continue;
    }
    const Corner contracted = along(reflected.value < worst.value ? -0.5 : 0.5);
    if (contracted.value < std::min(reflected.value, worst.value)) {
      worst = contracted;
      continue;
    }
    for (std::size_t k = 1; k < simplex.size(); ++k) simplex[k] = corner(0.5 * (best.at + simplex[k].at));
  }
}

}  // namespace rvelab::fit
