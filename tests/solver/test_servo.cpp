// The stress servo by itself, on a specimen whose answer is known: sigma = C eps, or C eps + V d(eps)/dt. What its
// header says of it is held to the recursions that follow from it.
#include "rvelab/solver/quasi_static/servo.hpp"

#include <Eigen/Eigenvalues>
#include <functional>
#include <random>
#include <string>

#include "rvelab/error.hpp"
#include "tests/refusal.hpp"
#include "tests/specimens.hpp"

using namespace rvelab;
using namespace rvelab::test;
using Catch::Matchers::Contains;

namespace {

class Random {
 public:
  explicit Random(std::uint64_t seed) : generator_(seed) {}
  double number() { return 2 * double(generator_() >> 11) / 9007199254740992.0 - 1; }
  /// Entries within [-1, 1]; in the plane those along z are zero.
  Matrix3 symmetric(int dimension) {
    Matrix3 m = Matrix3::Zero();
    for (int i = 0; i < dimension; ++i)
      for (int j = 0; j <= i; ++j) m(i, j) = m(j, i) = number();
    return m;
  }
  /// Symmetric and positive, with eigenvalues of 1 to about 10 times `scale` (Pa); no plane is a special one.
  Matrix6 stiffness(double scale) {
    Matrix6 m;
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) m(i, j) = number();
    return scale * (Matrix6::Identity() + m * m.transpose());
  }

 private:
  std::mt19937_64 generator_;
};

const std::vector<std::pair<int, int>>& components(int dimension) {
  static const std::vector<std::pair<int, int>> plane = {{0, 0}, {1, 1}, {0, 1}};
  static const std::vector<std::pair<int, int>> space = {{0, 0}, {1, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}};
  return dimension == 2 ? plane : space;
}

Matrix3 unit(std::pair<int, int> component) {
  Matrix3 m = Matrix3::Zero();
  m(component.first, component.second) += 0.5;
  m(component.second, component.first) += 0.5;
  return m;
}

/// Every stress changes by that of `change` (Pa).
MixedTarget stress_target(int dimension, const Matrix3& change, double scale) {
  MixedTarget target;
  for (const auto& component : components(dimension)) {
    MixedTarget::Row row;
    row.stress = unit(component);
    row.value = change.cwiseProduct(row.stress).sum();
    row.scale = scale;
    target.rows.push_back(row);
  }
  return target;
}

/// As many strains as dimensions, along oblique directions; the other rows hold stresses.
MixedTarget oblique_target(int dimension, Random& random, double stress_scale, double strain_scale) {
  MixedTarget target = stress_target(dimension, stress_scale * random.symmetric(dimension), stress_scale);
  for (int k = 0; k < dimension; ++k) {
    MixedTarget::Row& row = target.rows[std::size_t(k)];
    row.strain = random.symmetric(dimension) + 2 * unit(components(dimension)[std::size_t(k)]);
    row.stress.setZero();
    row.value = strain_scale * random.number();
  }
  return target;
}

/// sigma = C eps with C in six components.
Matrix3 stress_of(const Matrix6& stiffness, const Matrix3& strain, int dimension) {
  const Vector6 v = stiffness * strain_components(strain);
  Matrix3 s;
  s << v[0], v[5], v[4], v[5], v[1], v[3], v[4], v[3], v[2];
  if (dimension == 2) {
    s.row(2).setZero();
    s.col(2).setZero();
  }
  return s;
}

double largest_entry(const Vector6& v) { return v.cwiseAbs().maxCoeff(); }

}  // namespace

TEST_CASE("The servo follows a stress as half of the error and its sum over twenty say", "[solver]") {
  // A specimen 1/s as stiff as the gain was told. Of the error e before a segment, s e_1 = s (e + change) - e/2 - y
  // with y the strain rate that the integral term has, s y_1 = s y + e/20; both then as multiples of the target.
  for (const int dimension : {2, 3})
    for (const double s : {1.0, 1.3, 2.0}) {
      Random random(std::uint64_t(10 * s) + std::uint64_t(dimension));
      const Matrix6 told = random.stiffness(1e8), is = told / s;
      const Matrix3 change = 1e5 * random.symmetric(dimension), start = 3e5 * random.symmetric(dimension);
      Servo servo(stress_target(dimension, change, 1e5), dimension, start, Servo::Missed::evenly);
      servo.set_stiffness(told, 0);
      const Vector6 whole = servo.residual(1, Matrix3::Zero(), start);
      constexpr int segments = 200;
      const double paced = servo.predicted_strain() / segments;
      Matrix3 strain = Matrix3::Zero(), integral = Matrix3::Zero();
      double error = 0, rate = 0;
      for (int k = 1; k <= segments; ++k) {
        const double to = double(k) / segments;
        error += 1.0 / segments;
        const Matrix3 before = start + stress_of(is, strain, dimension);
        CHECK(largest_entry(servo.residual(to, strain, before) - error * whole) <= 1e-10 * largest_entry(whole));
        strain += servo.next_strain(to, paced, paced, 10 * paced, strain, before, integral);
        const double next = error - (0.5 * error + rate) / s;
        rate += 0.05 * error;
        error = next;
      }
      // The integral term has found the strain that a segment needs. What it brings to nothing is the error at the end
      // of a segment as seen at its start: the stress goes ahead of the target by the change of one segment.
      CHECK(error * segments == Approx(-1).epsilon(1e-3));
      CHECK(rate == Approx(s / segments).epsilon(1e-3));
      const Vector6 needed = is.inverse() * whole;
      if (dimension == 3)
        CHECK(largest(integral - strain_matrix(needed) / servo.predicted_strain()) <= 2e-3 * largest(integral));
      const double ahead = largest_entry(whole) / 1e5 / segments;
      CHECK(servo.held_error(strain, start + stress_of(is, strain, dimension)) == Approx(ahead).epsilon(1e-3));
    }
}

TEST_CASE("At the end of a target the servo takes half of the error at each of its updates", "[solver]") {
  for (const int dimension : {2, 3}) {
    Random random{std::uint64_t(dimension)};
    const Matrix6 stiffness = random.stiffness(1e8);
    const Matrix3 change = 1e5 * random.symmetric(dimension), none = Matrix3::Zero();
    Servo servo(stress_target(dimension, change, 1e5), dimension, none, Servo::Missed::evenly);
    servo.set_stiffness(stiffness, 0);
    Matrix3 strain = none, integral = none;
    double error = servo.held_error(strain, none);
    for (int k = 0; k < 30; ++k) {
      strain += servo.next_strain(1, 0, 1, 10, strain, stress_of(stiffness, strain, dimension), integral);
      error *= 0.5;
      CHECK(servo.held_error(strain, stress_of(stiffness, strain, dimension)) == Approx(error).margin(1e-13));
    }
    CHECK(largest(integral) == 0);  // no strain is paced: nothing was to be found
  }
}

TEST_CASE("With dashpots the servo takes half of the error at each of its updates as well", "[solver]") {
  // sigma = C eps + V (change/time): the stress that a stroke of the dashpots lets go of is in the account.
  for (const int dimension : {2, 3}) {
    Random random{std::uint64_t(7 + dimension)};
    const double time = 1e-3;
    const Matrix6 stiffness = random.stiffness(1e8), viscosity = random.stiffness(1e6);
    const Matrix3 change = 1e5 * random.symmetric(dimension), none = Matrix3::Zero();
    Servo servo(stress_target(dimension, change, 1e5), dimension, none, Servo::Missed::at_once);
    servo.set_stiffness(stiffness, 0);
    servo.set_viscosity(viscosity, time);
    Matrix3 strain = none, integral = none, rate = none, stress = none;
    double error = servo.held_error(strain, stress);
    for (int k = 0; k < 30; ++k) {
      const Matrix3 step = servo.next_strain_at_rate(1, 0, 1, 1, strain, stress, rate, integral);
      strain += step;
      rate = step / time;
      stress = stress_of(stiffness, strain, dimension) + stress_of(viscosity, rate, dimension);
      error *= 0.5;
      CHECK(servo.held_error(strain, stress) == Approx(error).margin(1e-12));
    }
  }
}

TEST_CASE("Rows of strain are met to round-off at each update of the servo", "[solver]") {
  // Whatever the stress does, and with an integral term of a target that asked for something else.
  for (const int dimension : {2, 3})
    for (const bool at_rate : {false, true})
      for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        Random random(seed);
        const Matrix6 told = random.stiffness(1e8), is = random.stiffness(3e7);
        const MixedTarget target = oblique_target(dimension, random, 1e5, 1e-3);
        const Matrix3 start = 1e5 * random.symmetric(dimension);
        Servo servo(target, dimension, start, Servo::Missed::evenly);
        servo.set_stiffness(told, 1e4);
        servo.set_viscosity(0.1 * told, 1e-2);
        Matrix3 strain = Matrix3::Zero(), integral = 3 * random.symmetric(dimension), rate = integral;
        constexpr int segments = 50;
        const double paced = servo.predicted_strain() / segments;
        double limited = 0;
        for (int k = 1; k <= segments; ++k) {
          const double to = double(k) / segments;
          const Matrix3 stress = start + stress_of(is, strain, dimension) + 1e6 * random.symmetric(dimension);
          const Matrix3 step =
              at_rate ? servo.next_strain_at_rate(to, paced, paced, 10 * paced, strain, stress, rate, integral)
                      : servo.next_strain(to, paced, paced, 10 * paced, strain, stress, integral);
          strain += step;
          limited = std::max(limited, step.norm() / paced);
          CHECK(step == step.transpose());
          for (int r = 0; r < dimension; ++r) {
            const MixedTarget::Row& row = target.rows[std::size_t(r)];
            CHECK(std::abs(row.strain.cwiseProduct(strain).sum() - to * row.value) <= 1e-15 + 1e-11 * limited * paced);
          }
        }
        CHECK(limited > 5);  // the noise of the stress was large enough for the limit of ten paces to matter
      }
}

TEST_CASE("The answer of the servo to a stress is at most its limit", "[solver]") {
  Random random(5);
  Servo servo(stress_target(3, 1e5 * random.symmetric(3), 1e5), 3, Matrix3::Zero(), Servo::Missed::evenly);
  servo.set_stiffness(random.stiffness(1e8), 0);
  Matrix3 integral = Matrix3::Zero();
  const double pace = 1e-9;
  const Matrix3 step = servo.next_strain(1, pace, pace, 10 * pace, Matrix3::Zero(), Matrix3::Zero(), integral);
  CHECK(step.norm() == Approx(10 * pace));
  CHECK(largest(integral) == 0);  // an answer that was cut is no measure of what is needed
}

TEST_CASE("What an increment before has missed is made good at once where that is asked for", "[solver]") {
  Random random(6);
  MixedTarget target = stress_target(2, Matrix3::Zero(), 1e5);
  target.rows[0].value = 3e4;
  target.rows[0].missed = 1e4;
  const Matrix3 none = Matrix3::Zero();
  const Servo evenly(target, 2, none, Servo::Missed::evenly), at_once(target, 2, none, Servo::Missed::at_once);
  CHECK(evenly.residual(0, none, none)[0] == 0);
  CHECK(at_once.residual(0, none, none)[0] == 1e4);
  CHECK(evenly.residual(0.5, none, none)[0] == 1.5e4);
  CHECK(at_once.residual(0.5, none, none)[0] == 2e4);
  CHECK(evenly.residual(1, none, none)[0] == at_once.residual(1, none, none)[0]);
}

TEST_CASE("A mixed target that is none is refused, with what is wrong with it", "[solver]") {
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinite = std::numeric_limits<double>::infinity();
  const auto refused = [](int dimension, const std::function<void(MixedTarget&)>& spoil, const std::string& says) {
    CAPTURE(dimension, says);
    MixedTarget target = stress_target(dimension, Matrix3::Identity(), 1.0);
    const Matrix3 none = Matrix3::Zero();
    CHECK_NOTHROW(Servo(target, dimension, none, Servo::Missed::evenly));
    spoil(target);
    CHECK_THAT(input_error([&] { Servo(target, dimension, none, Servo::Missed::evenly); }),
               Contains("mixed target") && Contains(says));
  };
  for (const int dimension : {2, 3}) {
    const std::string rows = dimension == 2 ? "2D needs 3" : "3D needs 6";
    refused(
        dimension, [](MixedTarget& t) { t.rows.pop_back(); }, rows);
    refused(
        dimension, [](MixedTarget& t) { t.rows.push_back(t.rows[0]); }, rows);
    refused(
        dimension, [](MixedTarget& t) { t.rows.clear(); }, rows);
    refused(
        dimension, [&](MixedTarget& t) { t.rows[1].stress(0, 1) = nan; }, "row 2 is not finite");
    refused(
        dimension, [&](MixedTarget& t) { t.rows[0].strain(1, 1) = infinite; }, "row 1 is not finite");
    refused(
        dimension, [&](MixedTarget& t) { t.rows[2].value = nan; }, "row 3 is not finite");
    refused(
        dimension, [&](MixedTarget& t) { t.rows[2].missed = infinite; }, "row 3 is not finite");
    refused(
        dimension, [](MixedTarget& t) { t.rows[1].stress = 2 * t.rows[0].stress; }, "depend on each other");
    refused(
        dimension, [](MixedTarget& t) { t.rows[1].stress.setZero(); }, "depend on each other");
    refused(
        dimension, [](MixedTarget& t) { t.rows[0].scale = 0; }, "row 1 holds a stress and needs a scale");
    refused(
        dimension, [&](MixedTarget& t) { t.rows[0].scale = infinite; }, "row 1 holds a stress and needs a scale");
    refused(
        dimension, [&](MixedTarget& t) { t.rows[0].scale = nan; }, "row 1 holds a stress and needs a scale");
    refused(
        dimension, [](MixedTarget& t) { t.spin(0, 1) = 0.1; }, "skew");
    refused(
        dimension, [&](MixedTarget& t) { t.spin(0, 1) = infinite, t.spin(1, 0) = -infinite; }, "skew");
    refused(
        dimension, [](MixedTarget& t) { t.volume_ratio = -1; }, "volume ratio");
    refused(
        dimension, [&](MixedTarget& t) { t.volume_ratio = infinite; }, "volume ratio");
    refused(
        dimension, [](MixedTarget& t) { t.tolerance = 0; }, "tolerance");
    refused(
        dimension, [&](MixedTarget& t) { t.tolerance = nan; }, "tolerance");
  }
  // In the plane, what is along z is nothing.
  refused(
      2,
      [](MixedTarget& t) {
        t.rows[1].stress = unit({2, 2});
      },
      "depend on each other");
}

TEST_CASE("Rows that the stiffness makes one are refused when it is known", "[solver]") {
  // eps_xx = c and sigma_xx = c' are two conditions; with a stiffness without Poisson's effect they are one.
  MixedTarget target = stress_target(2, Matrix3::Identity(), 1.0);
  target.rows[1].strain = unit({0, 0});
  target.rows[1].stress.setZero();
  Servo servo(target, 2, Matrix3::Zero(), Servo::Missed::evenly);
  CHECK_THROWS_AS(servo.set_stiffness(1e8 * Matrix6::Identity(), 0), InputError);
  Matrix6 with_poisson = 1e8 * Matrix6::Identity();
  with_poisson(0, 1) = with_poisson(1, 0) = 3e7;
  CHECK_NOTHROW(servo.set_stiffness(with_poisson, 0));
}
