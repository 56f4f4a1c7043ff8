// The linearised contact against finite differences of the incremental law, written here once more with finite
// rotations.
#include "rvelab/measure/contact_linear.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "tests/catch.hpp"
#include "tests/measure/reference_network.hpp"

using namespace rvelab;
using namespace rvelab::test;

namespace {

using Vector9 = Eigen::Matrix<double, 9, 1>;

/// A Hertz-Mindlin contact with rolling; exponents of the overlap as in the law.
struct Pair {
  double ri = 0.7, rj = 1.1, kn = 3e5, kt = 2e5, kr = 4e4;
  Slip slip = Slip::consistent;
  bool rescale = false;
};

/// Force on j and torques on i and j after the grains have moved by q = (db, dtheta_i, dtheta_j) from the state.
Vector9 after(const Pair& pair, const ContactState& state, const Vector9& q) {
  const Vector3 db = q.head<3>(), turn_i = q.segment<3>(3), turn_j = q.tail<3>();
  const Vector3 branch = state.branch + db, n = branch.normalized();
  const double length = branch.norm(), sum = pair.ri + pair.rj, overlap = sum - length, root = std::sqrt(overlap);
  const bool reduced = pair.slip == Slip::consistent;
  const double ci = reduced ? pair.ri - overlap / 2 : pair.ri, cj = reduced ? pair.rj - overlap / 2 : pair.rj;
  const double stretch = pair.slip == Slip::full_radius_ratcheting ? sum / length : 1;
  const double twist = pair.slip == Slip::full_radius ? 0 : 0.5 * n.dot(turn_i + turn_j);
  const double kept = pair.rescale && overlap < state.overlap ? root / std::sqrt(state.overlap) : 1;
  const auto carried = [&](const Vector3& history) -> Vector3 {
    const Vector3 axis = state.normal.cross(n);
    const double sine = axis.norm();
    Vector3 with_normal = history;
    if (sine > 0) with_normal = Eigen::AngleAxisd(std::asin(sine), axis / sine) * history;
    return kept * (Eigen::AngleAxisd(twist, n) * with_normal);
  };
  const auto tangential = [&](const Vector3& v) -> Vector3 { return v - n * n.dot(v); };
  const Vector3 slipped = tangential(stretch * db - cj * turn_j.cross(n) - ci * turn_i.cross(n));
  const Vector3 ft = carried(state.tangential_force) - pair.kt * root * slipped;
  const Vector3 moment = carried(state.rolling_moment) - pair.kr * root * tangential(turn_j - turn_i);
  Vector9 result;
  result << pair.kn * overlap * root * n + ft, -(pair.ri - overlap / 2) * n.cross(ft) - moment,
      -(pair.rj - overlap / 2) * n.cross(ft) + moment;
  return result;
}

ContactState state_of(const Pair& pair) {
  ContactState state;
  state.branch = 1.78 * Vector3(0.5, -0.3, 0.7).normalized();
  state.length = state.branch.norm();
  state.normal = state.branch / state.length;
  state.overlap = pair.ri + pair.rj - state.length;
  const double root = std::sqrt(state.overlap);
  state.normal_force = pair.kn * state.overlap * root;
  state.tangential_force = 0.4 * state.normal_force * state.normal.cross(Vector3(0.2, 0.9, -0.1));
  state.rolling_moment = 0.1 * state.normal_force * state.normal.cross(Vector3(-0.6, 0.1, 0.5));
  state.normal_stiffness = 1.5 * pair.kn * root;
  state.tangential_stiffness = pair.kt * root;
  state.rolling_stiffness = pair.kr * root;
  state.stiffness_growth = 0.5 / state.overlap;
  return state;
}

Vector9 rate(const LinearContact& linear, const Vector9& q) {
  Vector9 result;
  result << linear.force * q, linear.torque_i * q, linear.torque_j * q;
  return result;
}

}  // namespace

TEST_CASE("a linearised contact is the derivative of the incremental law", "[measure]") {
  for (const Slip slip : {Slip::consistent, Slip::full_radius, Slip::full_radius_ratcheting}) {
    Pair pair;
    pair.slip = slip;
    const ContactState state = state_of(pair);
    const LinearContact linear = linearised(state, pair.ri, pair.rj, slip);
    const double step = 1e-6;
    for (int k = 0; k < 9; ++k) {
      const Vector9 q = Vector9::Unit(k);
      const Vector9 difference = (after(pair, state, step * q) - after(pair, state, -step * q)) / (2 * step);
      CAPTURE(static_cast<int>(slip), k);
      CHECK((rate(linear, q) - difference).cwiseAbs().maxCoeff() < 1e-7 * state.normal_stiffness);
    }
  }
}

TEST_CASE("unloading with rescaling adds its terms, loading none", "[measure]") {
  Pair pair;
  pair.rescale = true;
  const ContactState state = state_of(pair);
  const LinearContact linear = linearised(state, pair.ri, pair.rj, pair.slip);
  const LinearContact extra = unloading_terms(state, pair.ri, pair.rj);
  Vector9 q;
  q << 0.3, 0.5, -0.2, 0.1, -0.7, 0.4, 0.6, 0.2, -0.5;
  const double step = 1e-8, elongation = state.normal.dot(q.head<3>());
  for (const double sign : {1.0, -1.0}) {
    const bool unloads = sign * elongation > 0;
    const Vector9 difference = (after(pair, state, step * sign * q) - after(pair, state, Vector9::Zero())) / step;
    const Vector9 with = rate(linear, sign * q) + rate(extra, sign * q);
    const Vector9 expected = unloads ? with : rate(linear, sign * q);
    CHECK((difference - expected).cwiseAbs().maxCoeff() < 1e-5 * state.normal_stiffness);
    CHECK((with - rate(linear, sign * q)).cwiseAbs().maxCoeff() > 1e-3 * state.normal_stiffness);
  }
}

TEST_CASE("a pair that turns as one body keeps its forces: consistent and ratcheting slip are objective", "[measure]") {
  for (const Slip slip : {Slip::consistent, Slip::full_radius_ratcheting}) {
    const Pair pair{.slip = slip};
    const ContactState state = state_of(pair);
    const LinearContact linear = linearised(state, pair.ri, pair.rj, slip);
    const Vector3 turn(0.3, -0.8, 0.5);
    Vector9 q;
    q << turn.cross(state.branch), turn, turn;
    const Vector9 change = rate(linear, q), now = after(pair, state, Vector9::Zero());
    Vector9 turned;
    turned << turn.cross(now.head<3>()), turn.cross(now.segment<3>(3)), turn.cross(now.tail<3>());
    CHECK((change - turned).cwiseAbs().maxCoeff() < 1e-12 * state.normal_stiffness);
  }
}

TEST_CASE("work of a consistent contact is that of its springs: stiffness without forces is symmetric", "[measure]") {
  const Pair pair;
  ContactState state = state_of(pair);
  state.normal_force = 0;
  state.tangential_force.setZero();
  state.rolling_moment.setZero();
  const LinearContact linear = linearised(state, pair.ri, pair.rj, Slip::consistent);
  Eigen::Matrix<double, 9, 9> stiffness;
  stiffness << -linear.force, -linear.torque_i, -linear.torque_j;
  CHECK((stiffness - stiffness.transpose()).cwiseAbs().maxCoeff() < 1e-12 * state.normal_stiffness);
  for (int k = 0; k < 100; ++k) {
    const Vector9 q = Vector9::Random();
    CHECK(q.dot(stiffness * q) > 0);
  }
}
