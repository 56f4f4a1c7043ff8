// The median beside that of a sorted copy.
#include "rvelab/solver/loading/median.hpp"

#include <random>

#include "tests/catch.hpp"

TEST_CASE("The median is the middle one of the sorted values, of few and many, equal and in order") {
  std::mt19937 numbers(1);
  std::lognormal_distribution<double> drawn(0, 2);
  for (std::size_t n = 1; n < 3000; n += 1 + n / 9) {
    std::vector<double> random(n), few(n), rising(n), falling(n);
    for (std::size_t k = 0; k < n; ++k) {
      random[k] = drawn(numbers);
      few[k] = double(numbers() % 3);
      rising[k] = double(k);
      falling[k] = double(n - k);
    }
    few.front() = 0;
    // A few far from all others, the first of them too.
    std::vector<double> unlucky(n, 1.0);
    for (std::size_t k = 0; k < 63; ++k) unlucky[k * n / 63] = 5;
    for (std::vector<double> values : {random, few, rising, falling, unlucky}) {
      std::vector<double> sorted = values;
      std::sort(sorted.begin(), sorted.end());
      INFO(n);
      CHECK(rvelab::median(values) == sorted[n / 2]);
    }
  }
  std::vector<double> none;
  CHECK(rvelab::median(none) == 0);
}
