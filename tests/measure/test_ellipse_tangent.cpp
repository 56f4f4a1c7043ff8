// Elastic tangent of ellipses: one contact by finite differences, regular packings by a sum over three contacts and by
// increments, discs written as ellipses, and axes of stiffness that turn with the bedding.
#include <cmath>

#include "rvelab/measure/contact_linear.hpp"
#include "rvelab/measure/measures.hpp"
#include "rvelab/measure/probe.hpp"
#include "rvelab/measure/tangent.hpp"
#include "rvelab/measure/tensor_order.hpp"
#include "rvelab/pack/search.hpp"
#include "rvelab/solver/kernels/ellipse_search.hpp"
#include "tests/measure/reference_network.hpp"
#include "tests/pack/recipes.hpp"
#include "tests/specimens.hpp"

using namespace rvelab;
using namespace rvelab::test;

namespace {

using Vector9 = Eigen::Matrix<double, 9, 1>;

/// Two ellipses with Hertz-like springs and a history.
struct TwoEllipses {
  double a[2] = {0.9, 0.7}, b[2] = {0.5, 0.45}, angle[2] = {0.4, 1.7};
  Vector3 branch{0.95, 0.55, 0};
  double kn = 3e5, kt = 2e5, kr = 4e4, tangential = 3e3, moment = 700;
  bool rescale = false;
  HertzRadius radius = HertzRadius::equivalent;
};

EllipseMatrix<double> matrix_of(const TwoEllipses& pair, int k, double turn) {
  const double a = pair.a[k], b = pair.b[k], angle = pair.angle[k] + turn;
  return ellipse_matrix<double>({std::cos(angle), std::sin(angle)}, b * b, a * a - b * b, b * b / a);
}

Vector3 support_point(const EllipseMatrix<double>& m, const Vector3& n) {
  const Vector3 along(m.xx * n[0] + m.xy * n[1], m.xy * n[0] + m.yy * n[1], 0);
  return along / std::sqrt(along.dot(n));
}

/// The contact, and what the grains feel, after they have moved by q = (db, turns of i and j); `first` is the contact
/// before, whose slip counts.
struct Moved {
  ContactState contact;
  Vector9 forces;
};

Moved moved(const TwoEllipses& pair, const Vector9& q, const ContactState* first) {
  const EllipseMatrix<double> mi = matrix_of(pair, 0, q[5]), mj = matrix_of(pair, 1, q[8]);
  ContactState c;
  c.branch = pair.branch + Vector3(q.head<3>());
  const EllipsePair<double> both = {c.branch[0], c.branch[1], mi, mj};
  Direction<double> direction = search_smallest(both);
  // The search is content with the least overlap, which says the direction to 1e-8: differences need more.
  for (int step = 0; step < 2; ++step) direction = next_direction(direction, ellipse_gap(both, direction));
  c.normal = {direction.x, direction.y, 0};
  const Vector3 pi = support_point(mi, c.normal), pj = c.branch - support_point(mj, c.normal);
  c.overlap = (pi - pj).dot(c.normal);
  c.arm_i = 0.5 * (pi + pj);
  c.arm_j = c.arm_i - c.branch;
  double spread = 1;  // what R* is over r*, or goes with
  if (pair.radius == HertzRadius::curvature) {
    const auto radius = [&](int k, const EllipseMatrix<double>& m) {
      const Vector3 along(m.xx * c.normal[0] + m.xy * c.normal[1], m.xy * c.normal[0] + m.yy * c.normal[1], 0);
      return std::pow(pair.a[k] * pair.b[k], 2) / std::pow(along.dot(c.normal), 1.5);
    };
    spread = 1 / (1 / radius(0, mi) + 1 / radius(1, mj));
  }
  const double root = std::sqrt(c.overlap * spread);
  double tangential = pair.tangential, moment = pair.moment;
  if (first != nullptr) {
    const Vector3 across(-first->normal[1], first->normal[0], 0);
    const double last_root = first->tangential_stiffness / pair.kt;
    const double kept = pair.rescale && root < last_root ? root / last_root : 1;
    const double slip = across.dot(Vector3(q.head<3>()) + Vector3(0, 0, q[8]).cross(first->arm_j) -
                                   Vector3(0, 0, q[5]).cross(first->arm_i));
    tangential = kept * tangential - pair.kt * root * slip;
    moment = kept * moment - pair.kr * root * (q[8] - q[5]);
  }
  c.normal_force = pair.kn * c.overlap * root;
  c.tangential_force = tangential * Vector3(-c.normal[1], c.normal[0], 0);
  c.rolling_moment = {0, 0, moment};
  c.normal_stiffness = 1.5 * pair.kn * root;
  c.tangential_stiffness = pair.kt * root;
  c.rolling_stiffness = pair.kr * root;
  c.stiffness_growth = 0.5 / c.overlap;
  const Vector3 force = c.force(), turn(0, 0, moment);
  Moved result{c, Vector9::Zero()};
  result.forces << force, -c.arm_i.cross(force) - turn, c.arm_j.cross(force) + turn;
  return result;
}

pack::Recipe rows(std::size_t number, double angle) {
  pack::Recipe recipe = ellipses(number);
  recipe.contact.law = Law::linear_stiffness;
  recipe.materials[0].normal_stiffness = recipe.materials[0].tangential_stiffness = 6e6;
  recipe.materials[0].friction = 0.6;
  recipe.fractions[0].grading.smallest_radius = recipe.fractions[0].grading.largest_radius = 4.3e-3;
  recipe.fractions[0].bedding_angle = angle;
  recipe.fractions[0].bedding_spread = 0;
  recipe.preparation.method = pack::Preparation::Method::regular;
  recipe.unbalanced = 1e-10;
  return recipe;
}

Rve regular(std::size_t number, double angle) {
  Workers alone(1);
  return Rve(pack::pack(rows(number, angle), alone).specimen);
}

/// Stiffness of a packing in which all grains are alike and turn alike, each the centre of a point symmetry, summed
/// over the three contacts of one pair of sides: the turn that balances its torques is the one unknown.
Matrix3 condensed_sum(const Network& network) {
  const Matrix3& rotation = network.cell.rotation;
  const GrainState& grain = network.grains[0];
  const double a = grain.semi_major, b = grain.semi_minor,
               volume = network.cell.volume() / double(network.grains.size());
  const Vector3 axis = rotation * grain.orientation;
  struct Side {
    Vector3 n, t, branch, arm, force;
    double fn, ft, kn, kt, overlap, h, turned, rho;
  };
  std::vector<Side> sides;
  for (const ContactState& c : network.contacts) {
    if (c.i != 0 && c.j != 0) continue;
    Side s;
    const double sign = c.i == 0 ? 1 : -1;  // seen from grain 0
    s.n = sign * (rotation * c.normal);
    if (s.n.dot(Vector3(1, 1e-3, 0)) < 0) continue;  // its opposite side is counted
    s.t = {-s.n[1], s.n[0], 0};
    s.branch = sign * (rotation * c.branch);
    s.overlap = c.overlap;
    s.fn = c.normal_force;
    s.ft = (rotation * c.tangential_force).dot(sign * s.t);
    s.kn = c.normal_stiffness;
    s.kt = c.tangential_stiffness;
    const double along = axis.dot(s.n), across = axis.dot(s.t);
    s.h = std::sqrt(b * b + (a * a - b * b) * along * along);
    s.turned = (a * a - b * b) * along * across / s.h;
    s.rho = a * a * b * b / (s.h * s.h * s.h);
    s.arm = 0.5 * s.branch;
    s.force = s.fn * s.n + s.ft * s.t;
    sides.push_back(s);
  }
  REQUIRE(sides.size() == 3);
  struct Response {
    Vector3 force, branch;
  };
  const auto of = [&](const Side& s, const Matrix3& strain, double turn) {
    const Vector3 db = strain * s.branch;
    const double d_overlap = -s.n.dot(db) - 2 * s.turned * turn;
    const double d_phi = (s.t.dot(db) + 2 * (s.rho - s.h) * turn) / (2 * s.rho - s.overlap);
    const double d_ft = -s.kt * (s.t.dot(db) - (2 * s.h - s.overlap) * turn);
    return Response{(s.kn * d_overlap - s.ft * d_phi) * s.n + (d_ft + s.fn * d_phi) * s.t, db};
  };
  const auto torque = [&](const Matrix3& strain, double turn) {
    double sum = 0;
    for (const Side& s : sides) {
      const Response r = of(s, strain, turn);
      sum += (0.5 * r.branch).cross(s.force)[2] + s.arm.cross(r.force)[2];
    }
    return sum;
  };
  Matrix3 tangent, stress = Matrix3::Zero();
  for (const Side& s : sides) stress -= s.force * s.branch.transpose() / volume;
  for (int k = 0; k < 3; ++k) {
    const Matrix3 strain = unit_strain(k, 2);
    const double at_rest = torque(strain, 0), per_turn = torque(Matrix3::Zero(), 1);
    Matrix3 change = -strain.trace() * stress;
    for (const Side& s : sides) {
      const Response r = of(s, strain, -at_rest / per_turn);
      change -= (r.force * s.branch.transpose() + s.force * r.branch.transpose()) / volume;
    }
    tangent.col(k) = stress_components(change, 2);
  }
  return tangent;
}

/// Mean axis of stiffness, degrees.
double axis_of(const Eigen::MatrixXd& c) {
  return 0.5 * std::atan2(2 * (c(0, 2) + c(1, 2)), c(0, 0) - c(1, 1)) * 180 / pi;
}

}  // namespace

TEST_CASE("A contact of ellipses, linearised: finite differences of the law", "[measure]") {
  for (const auto& [unloading, radius] : {std::pair{false, HertzRadius::equivalent},
                                          {true, HertzRadius::equivalent},
                                          {false, HertzRadius::curvature},
                                          {true, HertzRadius::curvature}}) {
    TwoEllipses pair;
    pair.rescale = unloading;
    pair.radius = radius;
    const Moved start = moved(pair, Vector9::Zero(), nullptr);
    REQUIRE(start.contact.overlap > 0.01);
    REQUIRE(start.contact.overlap < 0.3);
    GrainState grains[2];
    for (int k = 0; k < 2; ++k) {
      grains[k].semi_major = pair.a[k];
      grains[k].semi_minor = pair.b[k];
    }
    const LinearOutlineContact linear =
        linearised_outlines(Shape::ellipse, start.contact, grains[0], grains[1], radius);
    for (const int column : {0, 1, 5, 8}) {
      CAPTURE(unloading, radius == HertzRadius::curvature, column);
      Vector9 q = Vector9::Zero();
      const double step = 1e-5;
      q[column] = step;
      // With rescaling only the side that opens has the terms of unloading: one-sided differences, two of them.
      const double sign = unloading && linear.opening[column] < 0 ? -1 : 1;
      Vector9 slope;
      if (unloading) {
        const Vector9 once = moved(pair, sign * q, &start.contact).forces;
        const Vector9 twice = moved(pair, 2 * sign * q, &start.contact).forces;
        slope = sign * (4 * (once - start.forces) - (twice - start.forces)) / (2 * step);
      } else {
        slope = (moved(pair, q, &start.contact).forces - moved(pair, -q, &start.contact).forces) / (2 * step);
      }
      Vector9 expected;
      expected << linear.law.force.col(column), linear.law.torque_i.col(column), linear.law.torque_j.col(column);
      if (unloading) {
        Vector9 more;
        more << linear.unloading.force.col(column), linear.unloading.torque_i.col(column),
            linear.unloading.torque_j.col(column);
        CHECK(more.norm() > 1e-3 * expected.norm());
        expected += more;
      }
      CHECK((slope - expected).norm() < 1e-6 * expected.norm());
    }
  }
}

TEST_CASE("Discs written as ellipses have the tangent of discs", "[measure]") {
  Material m = linear_material(2e6, 1e6, 0.4);
  m.rolling_stiffness = 0.8;
  m.rolling_friction = 0.05;
  m.young_modulus = 2e8;
  m.poisson_ratio = 0.2;
  for (const Law law : {Law::linear_stiffness, Law::hertz_mindlin}) {
    Specimen s = disordered(Shape::disc, 8, m, law, 0.53, 4);
    s.contact.rolling = law == Law::linear_stiffness;
    Rve rve(s);
    REQUIRE(rve.relax(1e-8, 200'000).target_held);
    Network discs = rve.network(), same = discs;
    same.shape = Shape::ellipse;
    for (std::size_t g = 0; g < same.grains.size(); ++g) {
      same.grains[g].semi_major = same.grains[g].semi_minor = same.grains[g].radius;
      same.grains[g].orientation = {std::cos(double(g)), std::sin(double(g)), 0};
    }
    CHECK(relative_distance(elastic_tangent(same), elastic_tangent(discs)) < 1e-9);
    CHECK(relative_distance(affine_tangent(same), affine_tangent(discs)) < 1e-12);
  }
}

TEST_CASE("Disordered ellipses: increments of 1e-7 meet the elastic tangent", "[measure]") {
  const Material m = material_of_every_law();
  for (const auto& [law, radius] : {std::pair{Law::linear_stiffness, HertzRadius::equivalent},
                                    {Law::hertz_mindlin, HertzRadius::equivalent},
                                    {Law::hertz_mindlin, HertzRadius::curvature}}) {
    CAPTURE(name(law), name(radius));
    Specimen s = disordered(Shape::ellipse, 6, m, law, 0.53, 8);
    s.contact.hertz_radius = radius;
    s.contact.rolling = law == Law::linear_stiffness;
    s.contact.unload_rescale = false;  // the mean over loading and unloading is of 1e-5 at this size
    Rve rve(s);
    forbid_slip(rve);
    REQUIRE(rve.relax(1e-11, 2'000'000).target_held);
    const Probe probe = probe_stiffness(rve, 1e-7);
    CHECK(probe.relaxed);
    CHECK(relative_distance(probe.stiffness, elastic_tangent(rve.network())) < 2e-6);
    CHECK(affine_tangent(rve.network()).trace() > 1.01 * elastic_tangent(rve.network()).trace());
  }
}

TEST_CASE("Regular packings have the stiffness of a sum over three contacts", "[measure]") {
  for (const double angle : {0.0, 30.0}) {
    const Rve rve = regular(angle == 0 ? 16 : 24, angle);
    CAPTURE(angle);
    const Network network = rve.network();
    REQUIRE(network.contacts.size() == 3 * network.grains.size());
    const Eigen::MatrixXd tangent = elastic_tangent(network);
    CHECK(relative_distance(tangent, condensed_sum(network)) < 1e-6);
    Rve stuck = rve;
    forbid_slip(stuck);
    CHECK(relative_distance(probe_stiffness(stuck, 1e-7).stiffness, tangent) < 2e-6);
  }
}

TEST_CASE("The axis of stiffness turns with the bedding angle of a regular packing", "[measure]") {
  const double first = axis_of(elastic_tangent(regular(16, 0).network()));
  CHECK(std::abs(std::remainder(first, 90)) < 0.1);
  for (const double angle : {30.0, 67.5, -20.0}) {
    CAPTURE(angle);
    const Rve rve = regular(16, angle);
    CHECK(std::abs(std::remainder(axis_of(elastic_tangent(rve.network())) - first - angle, 180)) < 0.1);
    // Orientations lie along the bedding; their fabric says so.
    const Matrix3 phi = orientation_fabric(rve.network());
    CHECK(std::abs(std::remainder(0.5 * std::atan2(2 * phi(0, 1), phi(0, 0) - phi(1, 1)) * 180 / pi - angle, 180)) <
          0.1);
    CHECK(phi.trace() == Approx(1));
  }
}

TEST_CASE("The orientation fabric of round grains is not defined", "[measure]") {
  const Rve rve(disordered(Shape::disc, 3, linear_material(2e6, 1e6, 0.4), Law::linear_stiffness, 0.53, 4));
  CHECK(std::isnan(orientation_fabric(rve.network())(0, 0)));
}
