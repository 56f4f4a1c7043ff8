// Hidden parameters of a synthetic material are found, and lie in the 95 % intervals as often as these say.
#include <cmath>

#include "rvelab/error.hpp"
#include "rvelab/fit/posterior.hpp"
#include "rvelab/fit/search.hpp"
#include "rvelab/grains/uniform.hpp"
#include "tests/catch.hpp"

using namespace rvelab;

namespace {

constexpr std::size_t specimens = 10, data_tests = 10;
constexpr double scatter[] = {1.6, 0.9, 2.0, 0.06};  // of one test: degrees, degrees, degrees, log10 Pa

/// Peak angle, angle at large strain, dilation angle and log10 of a modulus by friction, rolling and void ratio; the
/// material of tools/validate.d/fit_schemes.py.
std::vector<double> material(const Eigen::VectorXd& u) {
  const double friction = 0.1 + 0.9 * u[0], rolling = 0.5 * u[1], e = u.size() > 2 ? 0.16 + 0.08 * u[2] : 0.19;
  const double large = 10 + 12 * (1 - std::exp(-friction / 0.3)) + 9 * rolling / (rolling + 0.2);
  const double psi = (0.24 - e) * 250 * (0.4 + 0.6 * friction);
  return {large + 0.8 * psi, large, psi, 7.6 - 4 * (e - 0.16) + 0.3 * std::sqrt(friction)};
}

double normal(Uniform& random) {
  double sum = 0;
  for (int k = 0; k < 12; ++k) sum += random();
  return sum - 6;  // of variance 1
}

/// A laboratory: half of the variance of a test is its specimen's.
struct Laboratory {
  Laboratory(Eigen::Index unknowns, std::uint64_t seed, std::size_t count = specimens) : random(seed), truth(unknowns) {
    outputs = unknowns == 2 ? 2 : 4;
    for (std::size_t s = 0; s < count; ++s)
      for (std::size_t k = 0; k < outputs; ++k) effects.push_back(std::sqrt(0.5) * scatter[k] * normal(random));
    for (double& point : truth) point = 0.1 + 0.8 * random();
    const auto mean = material(truth);
    for (std::size_t k = 0; k < outputs; ++k) {
      const double error = scatter[k] / std::sqrt(double(data_tests));
      problem.targets.push_back({"t", mean[k] + error * normal(random), error, -1});
    }
    problem.parameters = unknowns;
    problem.specimens = count;
    problem.tests = fit::usual_tests(unknowns);
    problem.sample = 600;
  }
  /// Targets of tests on the one specimen that the fit has too.
  void measure_the_specimen() {
    const auto mean = material(truth);
    for (std::size_t k = 0; k < outputs; ++k) {
      const double error = std::sqrt(0.5) * scatter[k] / std::sqrt(double(data_tests));
      problem.targets[k].value = mean[k] + effects[k] + error * normal(random);
      problem.targets[k].error = error;
    }
  }
  std::vector<fit::Answer> tests(const std::vector<fit::Candidate>& candidates) {
    std::vector<fit::Answer> answers;
    for (const fit::Candidate& candidate : candidates) {
      auto answer = material(candidate.point);
      answer.resize(outputs);
      for (std::size_t k = 0; k < outputs; ++k)
        answer[k] += effects[candidate.specimen * outputs + k] + std::sqrt(0.5) * scatter[k] * normal(random);
      answers.push_back(answer);
    }
    return answers;
  }
  fit::Finding found() {
    return fit::search(problem, [this](const auto& candidates) { return tests(candidates); });
  }

  Uniform random;
  std::size_t outputs = 0;
  std::vector<double> effects;
  Eigen::VectorXd truth;
  fit::Problem problem;
};

bool within(const fit::Finding& found, const Eigen::VectorXd& truth) {
  for (Eigen::Index k = 0; k < truth.size(); ++k)
    if (truth[k] < fit::quantile(found.sample.col(k), 0.025) || truth[k] > fit::quantile(found.sample.col(k), 0.975))
      return false;
  return true;
}

int sets_within(Eigen::Index unknowns) {
  int count = 0;
  for (std::uint64_t set = 1; set <= 20; ++set) {
    Laboratory laboratory(unknowns, set);
    count += within(laboratory.found(), laboratory.truth) ? 1 : 0;
  }
  return count;
}

}  // namespace

TEST_CASE("Of 20 hidden sets of two parameters 18 lie in their intervals", "[slow]") { CHECK(sets_within(2) >= 18); }

TEST_CASE("Of 20 hidden sets of three parameters 18 lie in their intervals", "[slow]") { CHECK(sets_within(3) >= 18); }

TEST_CASE("Measured on the specimen of the fit, 18 of 20 sets lie in intervals that are narrower", "[slow]") {
  int count = 0;
  double narrow = 0, wide = 0;
  const auto width = [](const fit::Finding& found) {
    return fit::quantile(found.sample.col(0), 0.975) - fit::quantile(found.sample.col(0), 0.025);
  };
  for (std::uint64_t set = 1; set <= 20; ++set) {
    Laboratory same(2, set, 1), other(2, set, 1);
    for (Laboratory* each : {&same, &other}) each->measure_the_specimen();
    same.problem.same_specimens = true;
    const fit::Finding found = same.found();
    count += within(found, same.truth) ? 1 : 0;
    narrow += width(found);
    wide += width(other.found());
  }
  CHECK(count >= 18);
  CHECK(narrow < 0.8 * wide);
}

TEST_CASE("Better targets give narrower intervals, and a search is the same each time") {
  Laboratory coarse(2, 5), fine(2, 5), again(2, 5);
  // The scatter of the tests themselves, which both have, is about as large as the errors of the targets.
  for (fit::Target& target : fine.problem.targets) target.error *= 0.2;
  for (Laboratory* each : {&coarse, &again})
    for (fit::Target& target : each->problem.targets) target.error *= 5;
  const fit::Finding wide = coarse.found(), narrow = fine.found();
  const auto width = [](const fit::Finding& found) {
    return fit::quantile(found.sample.col(0), 0.975) - fit::quantile(found.sample.col(0), 0.025);
  };
  CHECK(width(narrow) < width(wide));
  CHECK(again.found().sample == wide.sample);
  CHECK(wide.candidates.size() == fit::usual_tests(2));
}

TEST_CASE("Of 20 curves with two hidden parameters 18 lie in their intervals", "[slow]") {
  // y = a (1 - exp(-x/b)), each specimen with a factor of its own, a test's scatter smooth along the curve.
  int count = 0;
  for (std::uint64_t set = 1; set <= 20; ++set) {
    Uniform random(set, 7);
    double factors[specimens];
    for (double& factor : factors) factor = 1 + 0.03 * normal(random);
    const Eigen::Vector2d truth(0.1 + 0.8 * random(), 0.1 + 0.8 * random());
    const auto curve = [](const Eigen::VectorXd& u, double x) {
      return (1 + u[0]) * (1 - std::exp(-x / (0.1 + 0.4 * u[1])));
    };
    fit::Problem problem;
    problem.parameters = 2;
    problem.specimens = specimens;
    problem.tests = fit::usual_tests(2);
    problem.sample = 600;
    for (int k = 1; k <= 12; ++k) problem.targets.push_back({"y", curve(truth, 0.1 * k), 0.01, 0});
    const fit::Finding found = fit::search(problem, [&](const std::vector<fit::Candidate>& candidates) {
      std::vector<fit::Answer> answers;
      for (const fit::Candidate& candidate : candidates) {
        fit::Answer answer;
        const double level = 0.02 * normal(random), tilt = 0.02 * normal(random);
        for (int k = 1; k <= 12; ++k)
          answer.push_back(curve(candidate.point, 0.1 * k) * factors[candidate.specimen] + level + tilt * 0.1 * k);
        answers.push_back(answer);
      }
      return answers;
    });
    count += within(found, truth) ? 1 : 0;
  }
  CHECK(count >= 18);
}

TEST_CASE("Targets out of reach are told by the misfit, and tests that fail are left out until too few are left") {
  Laboratory laboratory(2, 3);
  laboratory.problem.targets[0].value = 80;  // degrees, beyond any of its materials
  CHECK(laboratory.found().misfit > 2);
  Laboratory failing(2, 3);
  const fit::Finding found = fit::search(failing.problem, [&](const auto& candidates) {
    auto answers = failing.tests(candidates);
    for (std::size_t k = 0; k < answers.size(); ++k)
      if (candidates[k].number % 4 == 0) answers[k].clear();
    return answers;
  });
  CHECK(found.misfit < 2);
  CHECK_THROWS_AS(
      fit::search(failing.problem, [](const auto& candidates) { return std::vector<fit::Answer>(candidates.size()); }),
      Error);
}

TEST_CASE("The target that tests lack most often is named") {
  const double nan = std::nan("");
  const std::vector<fit::Target> targets{{"a", 1, 1}, {"b", 1, 1}};
  CHECK(fit::most_often_missing(targets, {{1, nan}, {nan, nan}, {1, 2}, {}}) == "; b is missing in 2");
  CHECK(fit::most_often_missing(targets, {{1, 2}, {}}).empty());
}
