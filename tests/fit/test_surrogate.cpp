// Parts of the fit against what is known exactly: functions, Gaussian posteriors, sequences.
#include <Eigen/LU>
#include <cmath>

#include "rvelab/fit/components.hpp"
#include "rvelab/fit/minimise.hpp"
#include "rvelab/fit/posterior.hpp"
#include "rvelab/fit/surrogate.hpp"
#include "tests/catch.hpp"

using namespace rvelab;

TEST_CASE("The simplex method finds the minimum of Rosenbrock's valley") {
  const auto valley = [](const Eigen::VectorXd& x) {
    return 100 * std::pow(x[1] - x[0] * x[0], 2) + std::pow(1 - x[0], 2);
  };
  const Eigen::VectorXd found = fit::minimised(valley, Eigen::Vector2d(-1.2, 1), 0.5, 2000, 1e-14);
  CHECK(found[0] == Approx(1).margin(1e-4));
  CHECK(found[1] == Approx(1).margin(1e-4));
}

TEST_CASE("Halton's points are the mirrored digits of the numbers") {
  const Eigen::MatrixXd points = fit::halton(4, 2);
  const double expected[4][2] = {{1.0 / 2, 1.0 / 3}, {1.0 / 4, 2.0 / 3}, {3.0 / 4, 1.0 / 9}, {1.0 / 8, 4.0 / 9}};
  for (int k = 0; k < 4; ++k)
    for (int j = 0; j < 2; ++j) CHECK(points(k, j) == Approx(expected[k][j]));
}

TEST_CASE("A sample of a Gaussian likelihood has its mean, its deviations and its correlation") {
  Eigen::Matrix2d covariance;
  covariance << 9e-4, 6e-4, 6e-4, 16e-4;
  const Eigen::Matrix2d inverse = covariance.inverse();
  const Eigen::Vector2d centre(0.4, 0.6);
  const Eigen::MatrixXd sample = fit::sampled(
      [&](const Eigen::MatrixXd& points) {
        const Eigen::MatrixXd off = points.rowwise() - centre.transpose();
        return Eigen::VectorXd(-0.5 * (off * inverse).cwiseProduct(off).rowwise().sum());
      },
      2, 4000, 1);
  const Eigen::RowVectorXd mean = sample.colwise().mean();
  const Eigen::MatrixXd off = sample.rowwise() - mean;
  const Eigen::Matrix2d found = off.transpose() * off / 3999;
  CHECK(mean[0] == Approx(0.4).margin(0.004));
  CHECK(mean[1] == Approx(0.6).margin(0.005));
  CHECK(std::sqrt(found(0, 0)) == Approx(0.03).epsilon(0.08));
  CHECK(std::sqrt(found(1, 1)) == Approx(0.04).epsilon(0.08));
  CHECK(found(0, 1) / std::sqrt(found(0, 0) * found(1, 1)) == Approx(0.5).margin(0.08));
  CHECK(fit::quantile(sample.col(0), 0.975) == Approx(0.4 + 1.96 * 0.03).margin(0.006));
  CHECK((sample.array() >= 0 && sample.array() <= 1).all());
}

TEST_CASE("A flat likelihood leaves the uniform prior") {
  const Eigen::MatrixXd sample = fit::sampled(
      [](const Eigen::MatrixXd& points) { return Eigen::VectorXd(Eigen::VectorXd::Zero(points.rows())); }, 1, 2000, 3);
  CHECK(sample.mean() == Approx(0.5).margin(0.03));
  CHECK(fit::quantile(sample.col(0), 0.1) == Approx(0.1).margin(0.03));
  CHECK(fit::quantile(sample.col(0), 0.9) == Approx(0.9).margin(0.03));
}

TEST_CASE("A quantile lies between the values beside it") {
  CHECK(fit::quantile(Eigen::Vector3d(3, 1, 2), 0) == 1);
  CHECK(fit::quantile(Eigen::Vector3d(3, 1, 2), 0.5) == 2);
  CHECK(fit::quantile(Eigen::Vector3d(3, 1, 2), 0.75) == 2.5);
  CHECK(fit::quantile(Eigen::Vector3d(3, 1, 2), 1) == 3);
}

TEST_CASE("A surrogate of a smooth function without scatter gives the function") {
  const auto function = [](double a, double b) { return 20 + 8 * (1 - std::exp(-a / 0.4)) - 3 * b * b; };
  const Eigen::MatrixXd points = fit::halton(40, 2);
  Eigen::VectorXd values(40);
  std::vector<std::size_t> specimens;
  for (Eigen::Index k = 0; k < 40; ++k) {
    values[k] = function(points(k, 0), points(k, 1));
    specimens.push_back(std::size_t(k) % 5);
  }
  const fit::Surrogate surrogate(points, specimens, values);
  Eigen::MatrixXd there(3, 2);
  there << 0.3, 0.4, 0.6, 0.7, 0.5, 0.2;
  const fit::Prediction found = surrogate.at(there);
  for (Eigen::Index k = 0; k < 3; ++k) CHECK(found.mean[k] == Approx(function(there(k, 0), there(k, 1))).margin(0.05));
}

TEST_CASE("A surrogate knows the mean of all specimens no better than so many specimens tell") {
  // A straight line; each of ten specimens is off by its own amount in all of its tests.
  const double effects[] = {1.1, -0.7, 0.2, -1.4, 0.9, 0.4, -0.1, 1.2, -0.8, -0.8};
  const Eigen::MatrixXd points = fit::halton(50, 1);
  Eigen::VectorXd values(50);
  std::vector<std::size_t> specimens;
  for (Eigen::Index k = 0; k < 50; ++k) {
    values[k] = 10 + 4 * points(k, 0) + effects[k % 10];
    specimens.push_back(std::size_t(k % 10));
  }
  const fit::Surrogate surrogate(points, specimens, values);
  double squares = 0;
  for (const double effect : effects) squares += effect * effect;
  const double expected = std::sqrt(squares / 9);
  CHECK(surrogate.scatter() == Approx(expected).epsilon(0.3));
  const fit::Prediction found = surrogate.at(Eigen::MatrixXd::Constant(1, 1, 0.5));
  CHECK(std::sqrt(found.variance[0]) == Approx(expected / std::sqrt(10)).epsilon(0.3));
  CHECK(found.mean[0] == Approx(12).margin(0.1));
}

TEST_CASE("Of its own specimens a surrogate knows the mean well, of one alone too") {
  // A straight line, three specimens of ten, or only the first: each is off by its own amount in all of its tests.
  const double effects[] = {0.9, -0.4, 0.1};
  for (const std::size_t count : {std::size_t(3), std::size_t(1)}) {
    CAPTURE(count);
    const Eigen::MatrixXd points = fit::halton(30, 1);
    Eigen::VectorXd values(30);
    std::vector<std::size_t> specimens;
    for (Eigen::Index k = 0; k < 30; ++k) {
      specimens.push_back(std::size_t(k) % count);
      values[k] = 10 + 4 * points(k, 0) + effects[specimens.back()] + 0.05 * std::sin(37.0 * double(k));
    }
    const fit::Surrogate surrogate(points, specimens, values);
    const Eigen::MatrixXd middle = Eigen::MatrixXd::Constant(1, 1, 0.5);
    const fit::Prediction own = surrogate.at(middle, count), any = surrogate.at(middle);
    CHECK(own.mean[0] == Approx(12 + (count == 1 ? 0.9 : 0.2)).margin(0.03));  // three standard errors
    CHECK(std::sqrt(own.variance[0]) < 0.05);
    CHECK(std::sqrt(any.variance[0]) > 0.2);  // 0.66/sqrt 3; of one specimen the prior alone
  }
}

TEST_CASE("A point of a curve that was measured worse than the tests differ does not blur the others") {
  std::vector<fit::Target> targets;
  Eigen::MatrixXd values(9, 12);
  for (int point = 0; point < 12; ++point) {
    targets.push_back({"y", 1.5, 0.05, 0});
    for (int test = 0; test < 9; ++test) values(test, point) = 1 + (0.5 + 0.1 * test) * (point + 1) / 12.0;
  }
  // The curve begins where all tests agree but for 1e-5, known like every other point to 0.05.
  std::vector<fit::Target> more = targets;
  more.insert(more.begin(), {"y", 1.0, 0.05, 0});
  Eigen::MatrixXd wider(9, 13);
  for (int test = 0; test < 9; ++test) wider(test, 0) = 1 + 1e-5 * ((5 * test) % 9);
  wider.rightCols(12) = values;
  const auto blur = [](const fit::Components& components, const Eigen::MatrixXd& tests) {
    const Eigen::VectorXd scores = components.of(tests).col(0);
    return components.error()[0] / std::sqrt((scores.array() - scores.mean()).square().mean());
  };
  const double without = blur(fit::Components(targets, values, 2), values);
  CHECK(blur(fit::Components(more, wider, 2), wider) == Approx(without).epsilon(0.01));
}

TEST_CASE("The points of a curve go into few components and come back") {
  // Two shapes in twelve points: two components hold them.
  std::vector<fit::Target> targets;
  Eigen::MatrixXd values(9, 12);
  for (int point = 0; point < 12; ++point) {
    const double x = 0.1 * point;
    targets.push_back({"y", 1 + x + 2 * x * x, 0.1, 0});
    for (int test = 0; test < 9; ++test)
      values(test, point) = 1 + (0.5 + 0.2 * (test % 3)) * x + (1 + test / 3) * x * x;
  }
  const fit::Components components(targets, values, 2);
  CHECK(components.of(values).cols() <= 2);
  CHECK((components.back(components.of(values)) - values).norm() < 0.1 * values.norm());
  CHECK((components.error().array() > 0).all());
  // A number by itself stays what it is, up to its scale.
  const fit::Components alone({{"a", 3, 0.5, -1}}, Eigen::Vector3d(1, 2, 3), 1);
  CHECK(alone.back(alone.target().transpose())(0, 0) == Approx(3));
  CHECK(alone.error()[0] / alone.of(Eigen::VectorXd::Constant(1, 3.0))(0, 0) == Approx(0.5 / (3 - 2)));
}
