// The critical step is 2/omega of a bound on the largest frequency (Gershgorin's row sums). Held here against the
// largest eigenvalue of the stiffness of small networks, assembled from the formulas of the contact laws:
//
//   2 E = kn (n.(u_j - u_i))^2 + kt |(I - nn)(u_j - u_i) - (a_i theta_i + a_j theta_j) x n|^2
//         + kr |(I - nn)(theta_j - theta_i)|^2,   a = r - overlap/2.
//
// A single grain that moves alone has the frequency of its own block, of at least a quarter of its row sum: kn beside
// 2 kn, kt beside 4 kt, kt a^2 + kr beside 4 kt r^2 + 2 kr. So the bound lies between omega and 2 omega, times what it
// adds on purpose: the force turning with the branch (kt + f_n/2l for kt), r for a, and (tr M^8)^(1/8) for the largest
// eigenvalue in space, 3^(1/8) at most.
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <random>
#include <set>
#include <tuple>
#include <vector>

#include "rvelab/error.hpp"
#include "rvelab/solver/loading/collisions.hpp"
#include "tests/solver/laws.hpp"

using namespace rvelab;
using namespace rvelab::test;

namespace {

struct Stiffness {
  double normal, tangential, rolling, normal_force;
};

/// Of two grains of one material: Hertz (1882) and Mindlin (1949), or constants; rolling of Liang and Zhao (2019).
Stiffness stiffness_between(const Specimen& s, double ri, double rj, double overlap) {
  const Material& m = s.materials[0];
  const double beta = s.contact.rolling ? m.rolling_stiffness : 0;
  if (s.contact.law == Law::linear_stiffness) {
    const double kn = m.normal_stiffness, kt = m.tangential_stiffness;
    return {kn, kt, kt * ri * rj * beta, kn * overlap};
  }
  REQUIRE(s.contact.law == Law::hertz_mindlin);
  const double nu = m.poisson_ratio, contact_radius = std::sqrt(overlap * ri * rj / (ri + rj));
  const double plane_modulus = m.young_modulus / (2 * (1 - nu * nu));
  const double shear_modulus = m.young_modulus / (2 * (1 + nu));
  const double kn = 2 * plane_modulus * contact_radius, kt = 8 * shear_modulus / (2 * (2 - nu)) * contact_radius;
  return {kn, kt, kt * ri * rj * beta, 4. / 3. * plane_modulus * contact_radius * overlap};
}

Matrix3 cross_matrix(const Vector3& n) {
  Matrix3 m;
  m << 0, -n[2], n[1], n[2], 0, -n[0], -n[1], n[0], 0;
  return m;
}

struct Touching {
  std::size_t i, j;
  Vector3 branch;  ///< from i to j, m
};

/// By looking at all pairs and images; of a grain and its own image, one of the two that mirror each other.
std::vector<Touching> touching_pairs(const Specimen& s) {
  std::vector<Touching> found;
  const int deep = s.shape == Shape::disc ? 0 : 1;
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y)
      for (int z = -deep; z <= deep; ++z)
        for (std::size_t i = 0; i < s.grains.size(); ++i)
          for (std::size_t j = i; j < s.grains.size(); ++j) {
            if (i == j && std::tuple(x, y, z) <= std::tuple(0, 0, 0)) continue;
            const Vector3 branch = s.grains.position[j] - s.grains.position[i] + s.cell.lattice * Vector3(x, y, z);
            if (branch.norm() < s.grains.radius[i] + s.grains.radius[j]) found.push_back({i, j, branch});
          }
  return found;
}

struct Frequency {
  double largest = 0;  ///< omega, rad/s
  double slack = 1;    ///< what the bound adds to a quarter of its row sums on purpose, see above
  bool all_touch = true;
};

/// Displacements, then rotations of each grain, six numbers.
class StiffNetwork {
 public:
  explicit StiffNetwork(const Specimen& s) : specimen_(s), size_(Eigen::Index(6 * s.grains.size())) {
    stiffness_ = Eigen::MatrixXd::Zero(size_, size_);
    for (const Touching& pair : touching_pairs(s)) add(pair);
  }

  Frequency frequency() const {
    const bool plane = specimen_.shape == Shape::disc;
    Eigen::VectorXd scale(size_);
    for (std::size_t g = 0; g < specimen_.grains.size(); ++g) {
      const double r = specimen_.grains.radius[g];
      const double volume = plane ? pi * r * r * specimen_.cell.lattice(2, 2) : 4. / 3. * pi * r * r * r;
      const double mass = specimen_.materials[0].density * volume;
      const auto at = Eigen::Index(6 * g);
      scale.segment<3>(at).setConstant(1 / std::sqrt(mass));
      scale.segment<3>(at + 3).setConstant(1 / std::sqrt((plane ? 0.5 : 0.4) * mass * r * r));
      if (plane) scale.segment<3>(at + 2).setZero();  // nothing moves along z or turns about x and y
    }
    const Eigen::MatrixXd scaled = scale.asDiagonal() * stiffness_ * scale.asDiagonal();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(scaled, Eigen::EigenvaluesOnly);
    const bool all_touch = touched_.size() == specimen_.grains.size();
    return {std::sqrt(solver.eigenvalues().maxCoeff()), slack_, all_touch};
  }

 private:
  void add(const Touching& pair) {
    const double ri = specimen_.grains.radius[pair.i], rj = specimen_.grains.radius[pair.j];
    const double length = pair.branch.norm(), overlap = ri + rj - length;
    const double ai = ri - 0.5 * overlap, aj = rj - 0.5 * overlap;
    const Stiffness c = stiffness_between(specimen_, ri, rj, overlap);
    const Vector3 n = pair.branch / length;
    const Matrix3 along = n * n.transpose(), across = Matrix3::Identity() - along, none = Matrix3::Zero();
    add(pair, c.normal, {-along, none, along, none});
    add(pair, c.tangential, {-across, ai * cross_matrix(n), across, aj * cross_matrix(n)});
    add(pair, c.rolling, {none, -across, none, across});
    slack_ = std::max(
        {slack_, 1 + 0.5 * c.normal_force / (length * c.tangential), std::pow(ri / ai, 2), std::pow(rj / aj, 2)});
    touched_.insert({pair.i, pair.j});
  }

  /// Twice the energy is `stiffness` times the square of what `of` makes of u_i, theta_i, u_j, theta_j.
  void add(const Touching& pair, double stiffness, const std::array<Matrix3, 4>& of) {
    const auto i = Eigen::Index(6 * pair.i), j = Eigen::Index(6 * pair.j);
    const std::array<Eigen::Index, 4> at = {i, i + 3, j, j + 3};
    for (std::size_t a = 0; a < 4; ++a)
      for (std::size_t b = 0; b < 4; ++b) stiffness_.block<3, 3>(at[a], at[b]) += stiffness * of[a].transpose() * of[b];
  }

  const Specimen& specimen_;
  Eigen::Index size_;
  Eigen::MatrixXd stiffness_;
  std::set<std::size_t> touched_;
  double slack_ = 1;
};

Material material_for(Law law, double tangential_over_normal) {
  Material m = law == Law::hertz_mindlin ? hertz_material() : linear_material(2e6, tangential_over_normal * 2e6, 0.5);
  m.rolling_stiffness = 0.5;
  m.rolling_friction = 0.1;
  return m;
}

/// With velocities of its own, m/s.
Specimen moving(Specimen start, double speed) {
  std::mt19937_64 generator(7);
  std::normal_distribution<double> normal;
  const int d = start.cell.dimension;
  start.state.last_step.loading = Loading::at_rate;
  for (Vector3& velocity : start.grains.velocity)
    velocity = speed * Vector3(normal(generator), normal(generator), d == 3 ? normal(generator) : 0);
  return start;
}

}  // namespace

TEST_CASE("The bound of the largest frequency lies between it and its double, as Gershgorin says", "[solver]") {
  int networks = 0;
  for (const Shape shape : {Shape::disc, Shape::sphere})
    for (const Law law : {Law::linear_stiffness, Law::hertz_mindlin})
      for (const bool rolling : {false, true})
        for (const double ratio : {0.2, 1.0, 3.0})
          for (const int side : {1, 2, 3, 4})
            for (const std::uint64_t seed : {1u, 2u}) {
              if (law == Law::hertz_mindlin && ratio != 1.0) continue;        // Poisson's ratio says it
              if (shape == Shape::sphere && side == 4 && seed > 1) continue;  // 384 degrees of freedom, once
              Specimen s = disordered(shape, side, material_for(law, ratio), law, 0.55, seed, 0.04);
              s.contact.rolling = rolling;
              s.solver.min_height = 1e-3;  // a grain may touch its own images
              const Frequency exact = StiffNetwork(s).frequency();
              REQUIRE(exact.all_touch);
              const double bound = 2 / Rve(s).critical_time_step();
              CAPTURE(shape == Shape::disc, name(law), rolling, ratio, side, seed, bound, exact.largest, exact.slack);
              CHECK(bound >= exact.largest * (1 - 1e-12));
              ++networks;
              if (side < 3) continue;  // pairs of a grain and its image hold no translation, which the bound counts
              const double in_space = shape == Shape::sphere ? std::pow(3.0, 0.125) : 1.0;
              CHECK(bound <= 2 * std::sqrt(exact.slack * in_space) * exact.largest);
            }
  CHECK(networks > 80);
}

TEST_CASE(
    "A given time step is taken up to 2 over the largest frequency, though it is beyond the bound, and refused above",
    "[solver]") {
  for (const Shape shape : {Shape::disc, Shape::sphere})
    for (const Law law : {Law::linear_stiffness, Law::hertz_mindlin})
      for (const bool rolling : {false, true}) {
        Specimen s = disordered(shape, 3, material_for(law, 1.0), law, 0.55, 1, 0.04);
        s.contact.rolling = rolling;
        s.solver.min_height = 1e-3;
        const double limit = 2 / StiffNetwork(s).frequency().largest;
        CAPTURE(shape == Shape::disc, name(law), rolling, limit);
        REQUIRE(0.99 * limit > Rve(s).critical_time_step());
        for (const double factor : {0.99, 1.05}) {
          s.solver.fixed_time_step = factor * limit;
          Rve rve(s);
          const auto step = [&] { rve.apply(Matrix3::Zero(), factor * limit); };
          if (factor < 1)
            CHECK_NOTHROW(step());
          else
            CHECK_THROWS_AS(step(), IncrementFailed);
        }
      }
}

TEST_CASE("Two equal grains without friction have the frequency of the bound itself", "[solver]") {
  // omega^2 = 2 kn/m: the bound is not a factor on the safe side, but reached.
  for (const Shape shape : {Shape::disc, Shape::sphere}) {
    Specimen s = empty_specimen(shape, 0.1, linear_material(2e6, 0, 0));
    add_grain(s, Vector3(-0.0099, 0, 0), 0.01);
    add_grain(s, Vector3(0.0099, 0, 0), 0.01);
    const Frequency exact = StiffNetwork(s).frequency();
    // The force that turns with the branch acts across it only, where kn does not; the eighth power in space finds the
    // one eigenvalue that stands out.
    CHECK(2 / Rve(s).critical_time_step() == Approx(exact.largest).epsilon(1e-6));
  }
}

TEST_CASE("Row sums that collisions leave out would have asked for no shorter step", "[solver]") {
  for (const Specimen& start : disordered_of_each_law()) {
    for (const double speed : {1e-6, 1e-3, 0.1}) {
      CAPTURE(int(start.shape), int(start.contact.law), speed);
      Model model;
      Assembly assembly;
      open_assembly(moving(start, speed), model, assembly);
      const double horizon = 100 * critical_step(model, row_sums(model, assembly));
      Outlook outlook{Matrix3::Zero(), horizon, std::numeric_limits<double>::infinity()};
      const double exact = collisions_ahead(model, assembly, nullptr, true, outlook).step;
      REQUIRE(exact > 0);
      REQUIRE(std::isfinite(exact));
      for (const double part : {0.01, 0.1, 0.5, 0.9, 0.999, 1.0, 1.001, 1.1, 2.0, 10.0}) {
        outlook.step = part * exact;
        const double found = collisions_ahead(model, assembly, nullptr, true, outlook).step;
        CAPTURE(part);
        CHECK(std::min(found, outlook.step) == std::min(exact, outlook.step));
        CHECK(found <= exact);
      }
    }
  }
}
