// Features of measured curves: with noise, cut short, with unloading, repeated; their errors; five parameters by them.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "rvelab/fit/components.hpp"
#include "rvelab/fit/measured_features.hpp"
#include "rvelab/fit/posterior.hpp"
#include "rvelab/grains/uniform.hpp"
#include "tests/catch.hpp"

using namespace rvelab;
using Catch::Matchers::Contains;
using ensemble::TestKind;
using fit::MeasuredFeature;

namespace {

double gaussian(Uniform& random) {
  double sum = 0;
  for (int k = 0; k < 12; ++k) sum += random();
  return sum - 6;  // of variance 1
}

/// A curve of the laboratory: strain in %, q in kPa, eps_v in %; q peaks at `peak` % and softens.
struct Sand {
  double largest = 400, peak = 5, residual = 300;
  double q(double percent) const {
    const double x = percent / peak;
    return percent <= peak ? largest * std::sin(0.5 * std::numbers::pi * std::sqrt(x))
                           : residual + (largest - residual) * std::exp(-0.5 * (x - 1) * (x - 1));
  }
  /// The largest mean of q over 1 % to either side, beyond 4 % of strain; kPa.
  double largest_mean() const {
    double found = 0;
    for (double center = 4; center < 8; center += 0.05) {
      double sum = 0;
      for (int k = 0; k < 2000; ++k) sum += q(center - 1 + (k + 0.5) / 1000);
      found = std::max(found, sum / 2000);
    }
    return found;
  }
  double eps_v(double percent) const { return 0.3 * percent - 0.06 * percent * percent; }
  std::string table(double end, double noise = 0, std::uint64_t seed = 1) const {
    Uniform random(seed);
    std::string text = "eps_a [%],q [kPa],eps_v [%]\n";
    for (double percent = 0; percent <= end * (1 + 1e-9); percent += 0.05)
      text += std::to_string(percent) + "," + std::to_string(q(percent) * (1 + noise * gaussian(random))) + "," +
              std::to_string(eps_v(percent)) + "\n";
    return text;
  }
};

std::vector<MeasuredFeature> features_of(const std::vector<std::string>& tables, TestKind kind,
                                         std::vector<std::string>* left_out = nullptr) {
  std::vector<std::vector<fit::Curve>> tests;
  for (const std::string& table : tables) tests.push_back(fit::parsed_curves(table, "lab.csv"));
  std::vector<std::string> own;
  return fit::measured_features(ensemble::usual_features(kind), tests, left_out != nullptr ? *left_out : own);
}

const MeasuredFeature& named(const std::vector<MeasuredFeature>& features, const std::string& name) {
  for (const MeasuredFeature& each : features)
    if (each.feature.name == name) return each;
  FAIL(name << " is not there");
  return features.front();
}

}  // namespace

TEST_CASE("A measured curve has the features of its formula, q as far as the peak, and noise moves them little") {
  const Sand sand;
  std::vector<std::string> left_out;
  const auto clean = features_of({sand.table(16)}, TestKind::drained, &left_out);
  CHECK(left_out.empty());
  for (const double percent : {0.1, 0.5, 1.0, 2.0}) {
    std::string digits = std::to_string(percent);
    digits.erase(digits.find_last_not_of("0.") + 1);
    if (percent >= 1) digits = std::to_string(int(percent));
    CHECK(named(clean, "q_at_" + digits + "_percent_Pa").value == Approx(1e3 * sand.q(percent)).epsilon(1e-3));
  }
  const double largest = sand.largest_mean();
  CHECK(largest < 400);
  CHECK(named(clean, "largest_q_Pa").value == Approx(1e3 * largest).epsilon(1e-4));
  CHECK(named(clean, "last_q_Pa").value == Approx(1e3 * sand.q(16)));
  CHECK(named(clean, "eps_v_at_15_percent").value == Approx(0.01 * sand.eps_v(15)));
  // 0.95 = sin(pi/2 sqrt(x)), 0.5 at sqrt(x) = 1/3
  const double near = std::pow(std::asin(0.95 * largest / 400) * 2 / std::numbers::pi, 2);
  CHECK(named(clean, "strain_at_95_percent_of_q").value == Approx(0.05 * near).epsilon(1e-3));
  CHECK(named(clean, "E50_Pa").value == Approx(200e3 / (0.05 / 9)).epsilon(0.01));
  const auto noisy = features_of({sand.table(16, 0.01)}, TestKind::drained);
  for (const MeasuredFeature& each : noisy) {
    CAPTURE(each.feature.name);
    CHECK(std::abs(each.value - named(clean, each.feature.name).value) < 1.2 * each.error);
  }
  left_out.clear();
  features_of({Sand{400, 1.5, 300}.table(3)}, TestKind::drained, &left_out);
  CHECK(left_out == std::vector<std::string>{"q_at_2_percent_Pa", "q_at_5_percent_Pa", "eps_v_at_5_percent",
                                             "eps_v_at_15_percent"});
}

TEST_CASE("An undrained curve that only contracts has no phase transformation") {
  const auto table = [](double back) {
    std::string text = "eps_a [%],q [kPa],p [kPa]\n";
    for (int k = 0; k <= 60; ++k) {
      const double percent = 0.05 * k, p = 200 - 100 * percent + back * percent * percent;
      text += std::to_string(percent) + "," + std::to_string(80 * std::sqrt(percent)) + "," + std::to_string(p) + "\n";
    }
    return text;
  };
  std::vector<std::string> left_out;
  const auto turning = features_of({table(40)}, TestKind::undrained, &left_out);
  CHECK(named(turning, "p_at_phase_transformation_Pa").value == Approx(1e3 * (200 - 62.5)).epsilon(1e-3));
  CHECK(named(turning, "q_at_phase_transformation_Pa").value == Approx(80e3 * std::sqrt(1.25)).epsilon(1e-3));
  CHECK(named(turning, "p_at_2_percent_Pa").value == Approx(1e3 * (200 - 200 + 160)));
  CHECK(left_out.size() == 4);  // at 5 and 10 %
  left_out.clear();
  features_of({table(12)}, TestKind::undrained, &left_out);
  CHECK(left_out.front() == "q_at_phase_transformation_Pa");
}

TEST_CASE("The unloading of an oedometer test is read as well, up to where it is loaded again") {
  std::string text = "axial_stress_kPa,axial_strain_percent\n";
  const auto row = [&](double stress, double strain) {
    text += std::to_string(stress) + "," + std::to_string(strain) + "\n";
  };
  for (const double stress : {10.0, 20.0, 40.0, 80.0, 160.0, 320.0, 400.0})
    row(stress, 0.1 + 0.3 * std::log(stress / 10));
  const double most = 0.1 + 0.3 * std::log(40);
  for (const double stress : {400.0, 200.0, 100.0, 40.0, 10.0}) row(stress, most - 0.05 * std::log(400 / stress));
  for (const double stress : {50.0, 390.0}) row(stress, most);
  std::vector<std::string> left_out;
  const auto found = features_of({text}, TestKind::oedometer, &left_out);
  CHECK(named(found, "loading_strain_at_100_kPa").value == Approx(0.003 * std::log(10)).epsilon(1e-3));
  CHECK(named(found, "unloading_strain_at_50_kPa").value ==
        Approx(0.003 * std::log(40) - 0.0005 * std::log(8)).epsilon(1e-3));
  CHECK(left_out == std::vector<std::string>{"loading_strain_at_800_kPa", "loading_strain_at_1600_kPa",
                                             "unloading_strain_at_800_kPa"});
}

TEST_CASE("Repeated tests give the mean and its error, and the scatter of their quantity") {
  const Sand low{380, 5, 300}, high{420, 5, 300};
  auto twice = features_of({low.table(16), high.table(16)}, TestKind::drained);
  const MeasuredFeature& largest = named(twice, "largest_q_Pa");
  const double mean = 0.5e3 * (low.largest_mean() + high.largest_mean());
  CHECK(largest.value == Approx(mean).epsilon(1e-4));
  CHECK(largest.tests.size() == 2);
  CHECK(largest.error == Approx(0.045 * largest.value / std::sqrt(2.0)));
  const auto factors = fit::scatter_factors({twice});
  double squares = 0, count = 0;  // of q: 5 % to either side but for the last
  for (const MeasuredFeature& each : twice) {
    if (each.feature.quantity != "deviator") continue;
    const double off = (each.tests[1] - each.tests[0]) / 2 / (each.feature.relative * each.value);
    squares += 2 * off * off;
    count += 1;
  }
  CHECK(factors.at("deviator") == Approx(std::sqrt((4 + squares / count) / 5)));
  CHECK(factors.at("volumetric_strain") == Approx(std::sqrt(4.0 / 5)));  // equal curves: less than assumed
  CHECK(fit::scatter_factors({features_of({low.table(16)}, TestKind::drained)}).empty());
}

TEST_CASE("Errors of a group of features are half common, half independent") {
  // Two features that go together in all tests: one component along (1, 1)/sqrt(2) of the scaled values.
  Eigen::MatrixXd values(4, 2);
  values << -1, -1, 1, 1, -1, -1, 1, 1;
  const double scale = std::sqrt(1 + 0.25);  // deviation of the tests and the error
  std::vector<fit::Target> targets{{"a", 0, 0.5, 0, 0.5}, {"b", 0, 0.5, 0, 0.5}};
  const auto error = [&] { return fit::Components(targets, values, 2).error()[0] * scale; };
  CHECK(error() == Approx(std::sqrt(0.5 * 0.5 + 0.5 * 0.25)));
  for (fit::Target& target : targets) target.common.reset();
  CHECK(error() == Approx(std::sqrt(2.0) * 0.5));
}

TEST_CASE("Of 10 sands of five hidden parameters 9 lie in their intervals by features", "[slow]") {
  // Peak, softening and dilation by friction and rolling, stiffness by E, densities of a loose and a dense test by two.
  constexpr std::size_t specimens = 4;
  const auto sand = [](const Eigen::VectorXd& u, double density, double factor) {
    const double D = density + 0.3 * ((1 - density) * (u[4] - 0.5) + density * (u[3] - 0.5));
    Sand found;
    found.residual = 180 + 100 * u[0] + 60 * u[1];
    found.largest = factor * (found.residual * (1.05 + 0.6 * D * (0.5 + u[1])));
    found.peak = (14 - 9 * D) * std::pow(8, 0.5 - u[2]);
    return found;
  };
  const auto features = [&](const Eigen::VectorXd& u, const double* factors, Uniform* noise) {
    std::vector<double> values;
    for (const double density : {0.2, 0.85}) {
      const Sand own = sand(u, density, factors != nullptr ? *factors++ : 1);
      for (const double percent : {0.1, 0.5, 1.0, 2.0, 15.0}) values.push_back(own.q(percent));
      values.push_back(own.largest);
      for (double& value : values)
        if (noise != nullptr) value *= 1 + 0.02 * gaussian(*noise);
      for (const double percent : {5.0, 15.0})
        values.push_back(0.1 * percent * (1 - density * (1 + u[1]) - 0.4 * u[density < 0.5 ? 4 : 3]) +
                         (noise != nullptr ? 0.1 * gaussian(*noise) : 0));
    }
    return values;
  };
  int count = 0;
  double width = 0;
  for (std::uint64_t set = 1; set <= 10; ++set) {
    Uniform random(set, 11);
    double factors[specimens][2];
    for (auto& each : factors)
      for (double& factor : each) factor = 1 + 0.03 * gaussian(random);
    Eigen::VectorXd truth(5);
    for (double& point : truth) point = 0.1 + 0.8 * random();
    fit::Problem problem;
    problem.parameters = 5;
    problem.specimens = specimens;
    problem.tests = fit::usual_tests_of_features(5);
    problem.sample = 600;
    const auto measured = features(truth, nullptr, nullptr);
    for (std::size_t k = 0; k < measured.size(); ++k) {
      const bool volume = k % 8 >= 6;
      const double error = volume ? 0.2 : 0.06 * measured[k];
      problem.targets.push_back({"t", measured[k] + error * gaussian(random), error, int(2 * (k / 8)) + volume, 0.5});
    }
    const fit::Finding found = fit::search(problem, [&](const std::vector<fit::Candidate>& candidates) {
      std::vector<fit::Answer> answers;
      for (const fit::Candidate& candidate : candidates)
        answers.push_back(features(candidate.point, factors[candidate.specimen], &random));
      return answers;
    });
    bool all = true;
    for (Eigen::Index k = 0; k < 5; ++k) {
      const double low = fit::quantile(found.sample.col(k), 0.025), high = fit::quantile(found.sample.col(k), 0.975);
      all = all && truth[k] >= low && truth[k] <= high;
      width += (high - low) / 50;
    }
    count += all ? 1 : 0;
  }
  CAPTURE(width);
  CHECK(count >= 9);
  CHECK(width < 0.8);  // the prior's is 0.95
}
