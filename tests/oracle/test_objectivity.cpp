// What an observer, a choice of origin, of lattice basis or of period must not change.
//
// Equalities as rvelab/solver/README.md gives them: bitwise where the arithmetic is the same (rigid rotations at dt =
// 0, quarter turns); 1e-10 of p over the first 0.02 % of strain from a state at rest where it is not (round-off grows
// with strain: chaos).
#include <Eigen/LU>

#include "tests/specimens.hpp"

using namespace rvelab;
using namespace rvelab::test;

namespace {

/// Everything but the frame as bytes: two snapshots with the frame and its counter taken out.
std::vector<std::byte> without_frame(const Rve& rve) {
  Specimen s = rve.specimen();
  s.cell.rotation.setIdentity();
  s.cell.increments = 0;
  Rve plain(s);
  return plain.save();
}

const Matrix3 path_step = gradient(1e-5, 2.3e-5, -0.7e-5, -4e-5);

/// 0.02 % of strain in all.
constexpr int path_length = 4;

/// Stress along the path, turned back by `frame`, which is the rotation of the whole experiment.
std::vector<Matrix3> path_of(Rve rve, const Matrix3& frame = Matrix3::Identity()) {
  std::vector<Matrix3> stresses = {frame.transpose() * rve.stress() * frame};
  for (int k = 0; k < path_length; ++k)
    stresses.push_back(frame.transpose() * rve.apply(frame * path_step * frame.transpose(), 0).stress * frame);
  return stresses;
}

double difference(const std::vector<Matrix3>& a, const std::vector<Matrix3>& b) {
  REQUIRE(a.size() == b.size());
  double most = 0;
  for (std::size_t k = 0; k < a.size(); ++k) most = std::max(most, largest(a[k] - b[k]));
  return most;
}

const std::vector<Matrix3>& dense_path() {
  static const std::vector<Matrix3> path = path_of(Rve(reference_specimen("dense")));
  return path;
}

/// Positions moved and brought back into the cell, contacts told of it.
Specimen shifted(Specimen s, const Vector3& shift) {
  std::vector<Image> moved;
  for (Vector3& x : s.grains.position) {
    x += shift;
    moved.push_back(wrap(s.cell, x));
  }
  for (Contact& c : s.contacts)
    for (int k = 0; k < 3; ++k)
      c.image[std::size_t(k)] += moved[std::size_t(c.i)][std::size_t(k)] - moved[std::size_t(c.j)][std::size_t(k)];
  return s;
}

/// The same specimen with cell vectors L N, turned into the frame of that basis.
Specimen in_basis(Specimen s, const Eigen::Matrix3i& basis) {
  const Matrix3 vectors = s.cell.lattice * basis.cast<double>();
  const Vector3 a = vectors.col(0).normalized();
  const double angle = std::atan2(a[1], a[0]);
  const Matrix3 turn = rotation_about_z(angle);
  s.cell.lattice = (turn.transpose() * vectors).triangularView<Eigen::Upper>();
  s.cell.rotation = s.cell.rotation * turn;
  for (Vector3& x : s.grains.position) x = turn.transpose() * x;
  const Matrix3 inverse = basis.cast<double>().inverse();
  for (Contact& c : s.contacts) {
    const Vector3 n = inverse * Vector3(c.image[0], c.image[1], c.image[2]);
    for (int k = 0; k < 3; ++k) c.image[std::size_t(k)] = int(std::lround(n[k]));
  }
  // Not to be reduced before the path begins.
  s.state.list.built = true;
  s.state.list.lattice = s.cell.lattice;
  return s;
}

/// nx x ny copies of the cell as one cell; contacts go on to the copy that their image lies in.
Specimen supercell(const Specimen& s, int nx, int ny) {
  Specimen big = s;
  big.cell.lattice.col(0) *= nx;
  big.cell.lattice.col(1) *= ny;
  big.grains = {};
  big.contacts.clear();
  const int n = int(s.grains.size());
  const auto place = [&](int g, int i, int j) { return g + n * (i + nx * j); };
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i)
      for (int g = 0; g < n; ++g)
        add_grain(big, s.grains.position[std::size_t(g)] + s.cell.lattice * Vector3(i, j, 0),
                  s.grains.radius[std::size_t(g)], s.grains.material[std::size_t(g)]);
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i)
      for (const Contact& c : s.contacts) {
        const int ti = i + c.image[0], tj = j + c.image[1];
        const int wrapped_i = ((ti % nx) + nx) % nx, wrapped_j = ((tj % ny) + ny) % ny;
        Contact copy = c;
        copy.i = place(c.i, i, j);
        copy.j = place(c.j, wrapped_i, wrapped_j);
        copy.image = {(ti - wrapped_i) / nx, (tj - wrapped_j) / ny, 0};
        if (copy.i > copy.j) {
          // The component of a force along t = (-n_y, n_x) keeps its sign as the pair turns round; a moment does not.
          std::swap(copy.i, copy.j);
          for (int& m : copy.image) m = -m;
          copy.rolling_moment = -copy.rolling_moment;
        }
        big.contacts.push_back(copy);
      }
  std::sort(big.contacts.begin(), big.contacts.end(), [](const Contact& a, const Contact& b) {
    return std::tie(a.i, a.j, a.image) < std::tie(b.i, b.j, b.image);
  });
  // Wrapped into the primary cuboid about the origin, as an import would.
  return shifted(big, Vector3::Zero());
}

}  // namespace

TEST_CASE("a rigid rotation at dt = 0 turns the stress and leaves every grain and contact bitwise as it was") {
  const bool spheres = GENERATE(false, true);
  Rve rve(reference_specimen(spheres ? "hertz" : "dense"));
  rve.apply(0.2 * path_step, 0);  // some history on the contacts, velocities too
  const std::vector<std::byte> before = without_frame(rve);
  const Matrix3 stress = rve.stress();
  std::mt19937_64 generator(7);
  std::uniform_real_distribution<double> angle(-pi, pi), coordinate(-1, 1);
  Matrix3 turned = Matrix3::Identity();
  for (int k = 0; k < 230; ++k) {  // over two renormalisations of Q
    Vector3 axis = Vector3::UnitZ();
    if (spheres) axis = Vector3(coordinate(generator), coordinate(generator), coordinate(generator)).normalized();
    const Matrix3 q = Eigen::AngleAxisd(angle(generator), axis).toRotationMatrix();
    const Response r = rve.apply(q - Matrix3::Identity(), 0);
    turned = q * turned;
    CHECK(r.report.substeps == 0);
    CHECK(largest(r.stress - turned * stress * turned.transpose()) < 1e-12 * largest(stress));
  }
  CHECK(bool(without_frame(rve) == before));
}

TEST_CASE("quarter turns between the steps of a path permute the stress and change no bit of it") {
  Rve still(reference_specimen("dense")), turning(reference_specimen("dense"));
  Matrix3 quarter = gradient(0, -1, 1, 0), turned = Matrix3::Identity();
  quarter(2, 2) = 1;
  for (int k = 0; k < 6; ++k) {
    turning.apply(quarter - Matrix3::Identity(), 0);
    turned = quarter * turned;
    const Matrix3 expected = still.apply(5 * path_step, 0).stress;
    const Matrix3 found = turning.apply(turned * (5 * path_step) * turned.transpose(), 0).stress;
    CHECK(same_bits(Matrix3(turned.transpose() * found * turned) + Matrix3::Zero(), expected + Matrix3::Zero()));
  }
  CHECK(bool(without_frame(turning) == without_frame(still)));
}

TEST_CASE("quarter turns of spheres about all axes permute the stress and change no bit of it") {
  const Rve start =
      at_rest(disordered(Shape::sphere, 3, linear_material(2e6, 1e6, 0.5), Law::hertz_stiffness, 0.52, 3));
  Rve still(start), turning(start);
  Matrix3 turned = Matrix3::Identity();
  Matrix3 step = Matrix3::Zero();
  step << -1e-3, 4e-4, 2e-4, 0, 5e-4, 1e-4, 0, 0, -3e-4;  // without spin of the frame: Q stays a quarter turn
  for (int k = 0; k < 6; ++k) {
    Matrix3 quarter = Matrix3::Zero();  // about axis k mod 3
    quarter(k % 3, k % 3) = 1;
    quarter((k + 2) % 3, (k + 1) % 3) = 1;
    quarter((k + 1) % 3, (k + 2) % 3) = -1;
    turning.apply(quarter - Matrix3::Identity(), 0);
    turned = quarter * turned;
    const Matrix3 expected = still.apply(step, 0).stress;
    const Matrix3 found = turning.apply(turned * step * turned.transpose(), 0).stress;
    CHECK(same_bits(Matrix3(turned.transpose() * found * turned) + Matrix3::Zero(), expected + Matrix3::Zero()));
  }
  CHECK(bool(without_frame(turning) == without_frame(still)));
}

TEST_CASE("rotations between the steps of a path turn the stress with them, to 1e-10 of p") {
  Rve rve(reference_specimen("dense"));
  const double p = pressure(rve.stress(), 2);
  Matrix3 turned = Matrix3::Identity();
  for (int k = 0; k < path_length; ++k) {
    const Matrix3 q = rotation_about_z(0.7 + 1.3 * k);
    rve.apply(q - Matrix3::Identity(), 0);
    turned = q * turned;
    const Matrix3 stress = rve.apply(turned * path_step * turned.transpose(), 0).stress;
    CHECK(largest(turned.transpose() * stress * turned - dense_path()[std::size_t(k + 1)]) < 1e-10 * p);
  }
}

TEST_CASE("the spin of an increment turns the stress by exactly that spin") {
  // Straining within the cell, then turning, is one increment: F = R (I + dH).
  Rve rve(reference_specimen("dense"));
  const double p = pressure(rve.stress(), 2);
  Matrix3 turned = Matrix3::Identity();
  for (int k = 0; k < path_length; ++k) {
    const Matrix3 q = rotation_about_z(0.4 - 1.9 * k);
    const Matrix3 whole = q * turned * (Matrix3::Identity() + path_step) * turned.transpose();
    const Matrix3 stress = rve.apply(whole - Matrix3::Identity(), 0).stress;
    turned = q * turned;
    CHECK(largest(turned.transpose() * stress * turned - dense_path()[std::size_t(k + 1)]) < 1e-10 * p);
  }
}

TEST_CASE("the frame stays a rotation over any number of increments with spin") {
  Specimen s = empty_specimen(Shape::sphere, 1, linear_material(1e6, 1e5, 0.3));
  add_grain(s, Vector3(0, 0, 0), 0.1);
  Rve rve(s);
  Matrix3 step, deformation = Matrix3::Identity();
  step << 0.01, 0.02, -0.01, -0.03, -0.02, 0.02, 0.01, -0.04, 0.01;
  double off = 0, shape = 0;
  for (int k = 0; k < 500; ++k) {
    const Matrix3 increment = k % 2 == 0 ? step : Matrix3((Matrix3::Identity() + step).inverse() - Matrix3::Identity());
    rve.apply(increment, 0);
    deformation = (Matrix3::Identity() + increment) * deformation;
    const Matrix3& q = rve.cell().rotation;
    off = std::max(off, largest(q.transpose() * q - Matrix3::Identity()));
    shape = std::max(shape, largest(q * rve.cell().lattice - deformation));
  }
  CHECK(off < 1e-13);
  CHECK(shape < 1e-12);  // no reduction here: the cell vectors are those of the start, deformed
}

TEST_CASE("a shift of the origin changes the stress by no more than round-off") {
  const Specimen s = reference_specimen("dense");
  const double p = pressure(Rve(s).stress(), 2);
  const double l = s.cell.lattice(0, 0);
  for (const Vector3& shift : {Vector3(0.123 * l, -0.391 * l, 0), Vector3(-2.71 * l, 3.14 * l, 0)})
    CHECK(difference(path_of(Rve(shifted(s, shift))), dense_path()) < 1e-10 * p);
}

TEST_CASE("a change of lattice basis changes the stress by no more than round-off") {
  const Specimen s = reference_specimen("dense");
  const double p = pressure(Rve(s).stress(), 2);
  Eigen::Matrix3i basis;
  SECTION("sheared by one period") { basis << 1, 1, 0, 0, 1, 0, 0, 0, 1; }
  SECTION("sheared by two periods backwards") { basis << 1, -2, 0, 0, 1, 0, 0, 0, 1; }
  const Specimen other = in_basis(s, basis);
  CHECK(difference(path_of(Rve(other)), dense_path()) < 1e-10 * p);
  // The same, reduced on opening.
  Specimen anew = other;
  anew.state.list.built = false;
  CHECK(difference(path_of(Rve(anew)), dense_path()) < 1e-10 * p);
}

TEST_CASE("an exchange of the cell vectors changes no bit under strain along the axes") {
  const Specimen s = reference_specimen("dense");
  Eigen::Matrix3i basis;
  basis << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  Specimen other = in_basis(s, basis);
  // Exactly a quarter turn.
  other.cell.rotation << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  other.cell.lattice = Vector3(s.cell.lattice(1, 1), s.cell.lattice(0, 0), s.cell.lattice(2, 2)).asDiagonal();
  for (std::size_t g = 0; g < s.grains.size(); ++g)
    other.grains.position[g] = other.cell.rotation.transpose() * s.grains.position[g];
  other.state.list.lattice = other.cell.lattice;
  Rve first(s), second(other);
  for (int k = 0; k < path_length; ++k) {
    const Matrix3 step = gradient(1e-5, 0, 0, -4e-5);
    CHECK(largest(first.apply(step, 0).stress - second.apply(step, 0).stress) == 0);
  }
}

TEST_CASE("a basis that turns the cell frame shows in the second order of an increment only") {
  // The lattice goes straight in the frame of its basis, so that on the way the strains of two frames differ by the
  // square of the increment, at its end not at all.
  Specimen s = reference_specimen("dense");
  s.solver.fixed_substeps = 20;  // of both increments, so that they differ by their size alone
  const double p = pressure(Rve(s).stress(), 2);
  Eigen::Matrix3i basis;
  SECTION("turned by 45 degrees and sheared") { basis << 1, -1, 0, 1, 0, 0, 0, 0, 1; }
  SECTION("far from reduced") { basis << 2, 3, 0, 1, 2, 0, 0, 0, 1; }
  const Specimen other = in_basis(s, basis);
  const auto after = [&](double size) {
    Rve first(s), second(other);
    return largest(first.apply(size * path_step, 0).stress - second.apply(size * path_step, 0).stress);
  };
  const double wide = after(1), narrow = after(0.1);
  CHECK(largest(Rve(s).stress() - Rve(other).stress()) < 1e-12 * p);
  CHECK(wide < 1e-7 * p);
  CHECK(narrow < 1e-10 * p);
  CHECK(narrow < 0.02 * wide);
}

TEST_CASE("a supercell of 2 x 2 periods has the stress of one") {
  const Specimen s = reference_specimen("dense");
  const double p = pressure(Rve(s).stress(), 2);
  CHECK(difference(path_of(Rve(supercell(s, 2, 2))), dense_path()) < 1e-10 * p);
}

TEST_CASE("the order of the grains in memory and their ids are names only") {
  // Reversed order turns every pair and every sum round: no bit is promised, round-off is.
  const Specimen s = reference_specimen("dense");
  const double p = pressure(Rve(s).stress(), 2);
  Specimen reversed = s;
  const int n = int(s.grains.size());
  for (int g = 0; g < n; ++g) {
    reversed.grains.position[std::size_t(g)] = s.grains.position[std::size_t(n - 1 - g)];
    reversed.grains.radius[std::size_t(g)] = s.grains.radius[std::size_t(n - 1 - g)];
  }
  for (Contact& c : reversed.contacts) {
    const int i = c.i;
    c.i = n - 1 - c.j;
    c.j = n - 1 - i;
    for (int& m : c.image) m = -m;
    c.rolling_moment = -c.rolling_moment;
  }
  const auto key = [](const Contact& c) { return std::tuple(c.i, c.j, c.image); };
  std::sort(reversed.contacts.begin(), reversed.contacts.end(),
            [&](const Contact& a, const Contact& b) { return key(a) < key(b); });
  CHECK(difference(path_of(Rve(reversed)), dense_path()) < 1e-10 * p);
}
