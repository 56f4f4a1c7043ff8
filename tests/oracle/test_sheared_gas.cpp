// 500 spheres at porosity 0.738 sheared at dt > 0: the flow must not know along which axes it is looked at.
// A shear that the triangular frame follows without turning (xz) is set against ones under which the frame turns
// against the laboratory all the time, so that Coriolis terms, spins and both stresses stand the test.
//
// Tolerances. Round-off is not what limits: 1e-16 of a coordinate grows to no more than 1e-12 of the stress over the
// 0.2 s (the reference records find that 1e-10 m does not grow noticeably in that time). What two frames do differently
// is (1) the way within an increment, straight in the frame of the basis: (0.5 1/s x 3.7e-4 s)^2/4 = 8e-9 of strain,
// against overlaps of about 1e-3 of a radius, 1e-5 of a force, second order in the increment; (2) the velocities of the
// Reynolds stress, which belong to the last half step while the frame belongs to its end: 0.5 1/s x dt/2 = 1e-5 of it,
// first order in the step. Both orders are checked.
#include <Eigen/LU>
#include <map>

#include "tests/oracle/reference_table.hpp"
#include "tests/specimens.hpp"

using namespace rvelab;
using namespace rvelab::test;

namespace {

constexpr double time_step = 3.688e-5;  // s, that of the reference records
constexpr double rate = 0.5;            // 1/s
constexpr double duration = 0.2;        // s

Specimen gas() {
  Specimen s = empty_specimen(Shape::sphere, 2, linear_material(2e7, 2e6, 0.3), Law::hertz_stiffness);
  s.damping.dashpot = Dashpot::coefficient;
  s.damping.normal_coefficient = 20;
  const RecordedTable start("lammps/sheared/n738_s1_start.csv");
  for (std::size_t row = 0; row < start.rows(); ++row) {
    Vector3 x = start.vector(row, "", "");
    wrap(s.cell, x);
    add_grain(s, x, 0.1);
  }
  return s;
}

/// The specimen under an orthogonal map of the coordinates that permutes the axes: a mirror or a quarter turn.
Specimen mapped(Specimen s, const Matrix3& map) {
  for (Vector3& x : s.grains.position) {
    x = map * x;
    wrap(s.cell, x);
  }
  return s;
}

/// The same specimen with cell vectors L N, in the frame of that basis; not to be reduced before the flow begins.
Specimen in_lattice_basis(Specimen s, const Eigen::Matrix3i& basis) {
  const Matrix3 vectors = s.cell.lattice * basis.cast<double>();
  Matrix3 frame = vectors;
  for (int k = 0; k < 3; ++k) {
    for (int i = 0; i < k; ++i) frame.col(k) -= frame.col(i).dot(frame.col(k)) * frame.col(i);
    frame.col(k).normalize();
  }
  s.cell.lattice = (frame.transpose() * vectors).triangularView<Eigen::Upper>();
  s.cell.rotation = frame;
  for (Vector3& x : s.grains.position) x = frame.transpose() * x;
  s.state.list.built = true;
  s.state.list.lattice = s.cell.lattice;
  return s;
}

struct Stresses {
  std::vector<Matrix3> contact, reynolds;
};

/// Both stresses at every tenth of the time, turned back by `map`; shear v_x(z), seen through the map.
Stresses flow(Specimen s, const Matrix3& map, int steps_per_increment, int halvings = 0) {
  s.solver.fixed_time_step = time_step / (1 << halvings);
  Matrix3 shear = Matrix3::Zero();
  shear(0, 2) = rate * steps_per_increment * time_step;
  shear = Matrix3(map * shear * map.transpose());
  const int increments = int(duration / (steps_per_increment * time_step));
  Rve rve(s);
  Stresses found;
  for (int k = 1; k <= increments; ++k) {
    const Response r = rve.apply(shear, steps_per_increment * time_step);
    if (k % (increments / 10) != 0) continue;
    found.contact.push_back(map.transpose() * r.contact_stress * map);
    found.reynolds.push_back(map.transpose() * r.reynolds_stress * map);
  }
  return found;
}

/// Largest difference over the time, over the largest stress.
double relative_difference(const std::vector<Matrix3>& a, const std::vector<Matrix3>& b) {
  REQUIRE(a.size() == b.size());
  double most = 0, scale = 0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    most = std::max(most, largest(a[k] - b[k]));
    scale = std::max(scale, largest(a[k]));
  }
  return most / scale;
}

const Stresses& along_xz(int steps_per_increment, int halvings = 0) {
  static std::map<std::pair<int, int>, Stresses> known;
  const auto key = std::make_pair(steps_per_increment, halvings);
  if (known.count(key) == 0) known[key] = flow(gas(), Matrix3::Identity(), steps_per_increment, halvings);
  return known[key];
}

Matrix3 matrix(std::initializer_list<double> entries) {
  Matrix3 m;
  auto at = entries.begin();
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) m(i, j) = *at++;
  return m;
}

/// The oracle: agreement as reckoned at the head of this file, and its orders.
void check_map(const Matrix3& map) {
  const Specimen s = mapped(gas(), map);
  const Stresses fine = flow(s, map, 10), coarse = flow(s, map, 40), half = flow(s, map, 10, 1);
  CHECK(fine.reynolds.back().diagonal().maxCoeff() < 0);
  CHECK(relative_difference(along_xz(10).contact, fine.contact) < 5e-5);
  CHECK(relative_difference(along_xz(10).reynolds, fine.reynolds) < 3e-5);
  CHECK(relative_difference(along_xz(40).contact, coarse.contact) >
        4 * relative_difference(along_xz(10).contact, fine.contact));
  CHECK(relative_difference(along_xz(10, 1).reynolds, half.reynolds) <
        0.7 * relative_difference(along_xz(10).reynolds, fine.reynolds));
}

}  // namespace

TEST_CASE("shear xz and its mirror image under zx have mirrored contact and Reynolds stresses") {
  check_map(matrix({0, 0, 1, 0, 1, 0, 1, 0, 0}));
}

TEST_CASE("shear xy and its mirror image under yx have mirrored contact and Reynolds stresses") {
  // The flow xz seen as xy, and as its mirror image yx.
  const Matrix3 as_xy = matrix({1, 0, 0, 0, 0, 1, 0, 1, 0}), as_yx = matrix({0, 0, 1, 1, 0, 0, 0, 1, 0});
  const Stresses xy = flow(mapped(gas(), as_xy), as_xy, 10), yx = flow(mapped(gas(), as_yx), as_yx, 10);
  CHECK(relative_difference(xy.contact, yx.contact) < 5e-5);
  CHECK(relative_difference(xy.reynolds, yx.reynolds) < 3e-5);
}

TEST_CASE("shear xz and the same turned by a quarter turn agree after rotation") {
  check_map(matrix({0, 0, 1, 0, 1, 0, -1, 0, 0}));                     // about y: v_z(x), reversed
  const Matrix3 about_diagonal = matrix({0, 0, 1, 1, 0, 0, 0, 1, 0});  // v_y(x)
  const Stresses turned = flow(mapped(gas(), about_diagonal), about_diagonal, 10);
  CHECK(relative_difference(along_xz(10).contact, turned.contact) < 5e-5);
  CHECK(relative_difference(along_xz(10).reynolds, turned.reynolds) < 3e-5);
}

TEST_CASE("shear along a 45 degree axis agrees after rotation") {
  // The specimen turned with its cell, as a rigid body: the frame carries the rotation.
  const Vector3 axis = GENERATE(Vector3(0, 1, 0), Vector3(0, 0, 1));
  const Matrix3 turn = Eigen::AngleAxisd(pi / 4, axis).toRotationMatrix();
  Specimen s = gas();
  s.cell.rotation = turn;
  const Stresses turned = flow(s, turn, 10);
  // The arithmetic differs by round-off alone, some 5000 steps of it.
  CHECK(relative_difference(along_xz(10).contact, turned.contact) < 1e-8);
  CHECK(relative_difference(along_xz(10).reynolds, turned.reynolds) < 1e-8);
}

TEST_CASE("shear of a lattice whose basis lies at 45 degrees is that of the cube, through its reduction too") {
  // Cell vectors a + c, b, c: the frame turns until the list is built anew, and the lattice is reduced in mid-flow.
  Eigen::Matrix3i basis;
  basis << 1, 0, 0, 0, 1, 0, 1, 0, 1;
  const Specimen s = in_lattice_basis(gas(), basis);
  const Stresses fine = flow(s, Matrix3::Identity(), 10);
  CHECK(relative_difference(along_xz(10).contact, fine.contact) < 5e-5);
  CHECK(relative_difference(along_xz(10).reynolds, fine.reynolds) < 3e-5);
  // In increments as long as the intervals between renewals of the step, 50 steps, the way may differ by 25 times as
  // much, and the reduction falls into the middle of one.
  const Stresses coarse = flow(s, Matrix3::Identity(), 50);
  CHECK(relative_difference(along_xz(50).contact, coarse.contact) < 1e-3);
  CHECK(relative_difference(along_xz(50).reynolds, coarse.reynolds) < 1e-4);
}

TEST_CASE("a gas without contacts keeps its laboratory velocities whatever the cell does") {
  // Grains that never meet fly straight: v' relative to any affine motion of the cell, turned into the laboratory, plus
  // the affine velocity at the grain's place is constant. The images carry the velocity of the cell.
  const bool spheres = GENERATE(false, true);
  Specimen s = empty_specimen(spheres ? Shape::sphere : Shape::disc, 1000, linear_material(1e6, 1e5, 0.3));
  for (const Vector3& x : {Vector3(-40, 10, spheres ? 30 : 0), Vector3(50, -60, spheres ? -10 : 0)})
    add_grain(s, x, 0.1);
  s.solver.fixed_time_step = 1e-3;
  Rve rve(s);
  const Vector3 v(3, 5, spheres ? -4 : 0), w(spheres ? 1 : 0, spheres ? -2 : 0, 3);
  rve.set_velocities({v, -v}, {w, -w});
  Matrix3 rate_of_strain = gradient(0.1, 0.4, -0.7, -0.2);
  if (spheres) {
    rate_of_strain(0, 2) = 0.5;
    rate_of_strain(2, 1) = -0.3;
    rate_of_strain(2, 0) = 0.6;
  }
  const auto spin_of = [](const Matrix3& g) -> Vector3 {
    return 0.5 * Vector3(g(2, 1) - g(1, 2), g(0, 2) - g(2, 0), g(1, 0) - g(0, 1));
  };
  const auto laboratory = [&](const Rve& r, std::size_t g) -> Vector3 {
    const Specimen now = r.specimen();
    return now.cell.rotation * (now.grains.velocity[g]);
  };
  const Matrix3 identity = Matrix3::Identity();
  // v' changes by -(grad v) v' as the place changes: dv'/dt = -G v', v'(t) = exp(-G t) v' at constant G; by steps of
  // dH = G h the deformation is (I + G h)^n and v'(n) = (I + G h)^-n v'(0) to second order in h.
  Vector3 expected = v;
  const double h = 1e-3;
  for (int k = 0; k < 1000; ++k) {
    rve.apply(rate_of_strain * h, h);
    expected = (identity + 0.5 * h * rate_of_strain).inverse() * ((identity - 0.5 * h * rate_of_strain) * expected);
  }
  CHECK((laboratory(rve, 0) - expected).norm() < 1e-3 * v.norm());
  // Spins: w in the laboratory stays as it was, w' = w - axial of the spin of the flow.
  const Specimen now = rve.specimen();
  const Vector3 whole = now.cell.rotation * now.grains.spin[0] + spin_of(rate_of_strain);
  CHECK((whole - w).norm() < 2e-3 * w.norm());
}
