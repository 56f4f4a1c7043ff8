// Sheared cells of 500, 864 and 1201 spheres at dt > 0 against fine records of LAMMPS: porosity 0.738 to 0.371, shear
// xz at 0.5 1/s in a cube of 2 m, k delta^1.5 with a dashpot and sliding friction, spheres that start on the affine
// flow. The record's own sensitivity to its time step is the yardstick.
#include <cmath>

#include "rvelab/measure/measures.hpp"
#include "rvelab/solver/rve.hpp"
#include "tests/catch.hpp"
#include "tests/oracle/reference_table.hpp"

namespace {

using namespace rvelab;
using test::RecordedTable;

constexpr double shear_rate = 0.5;      // 1/s
constexpr double cell_size = 2;         // m
constexpr double time_step = 3.688e-5;  // s
constexpr double printed = 1e-12;       // m, last digit of the recorded positions

Specimen start_of(const std::string& name) {
  Specimen s;
  s.shape = Shape::sphere;
  s.cell = cubic_cell(3, cell_size * cell_size * cell_size);
  Material m;
  m.normal_stiffness = 2e7;
  m.tangential_stiffness = 2e6;
  m.friction = 0.3;
  s.materials = {m};
  s.contact.law = Law::hertz_stiffness;
  s.contact.slip = Slip::full_radius;
  s.damping.dashpot = Dashpot::coefficient;
  s.damping.normal_coefficient = 20;
  s.solver.fixed_time_step = time_step;
  s.state.last_step.loading = Loading::at_rate;
  const RecordedTable start("lammps/sheared/" + name + "_start.csv");
  for (std::size_t row = 0; row < start.rows(); ++row) {
    s.grains.id.push_back(std::int64_t(start.at(row, "id")));
    s.grains.radius.push_back(0.1);
    s.grains.material.push_back(0);
    s.grains.position.push_back(start.vector(row, "", ""));
    s.grains.velocity.push_back(Vector3::Zero());
    s.grains.spin.push_back(Vector3::Zero());
  }
  return s;
}

/// Distance of a sphere from a recorded place, to the nearest of its images: the record follows spheres without
/// wrapping.
double distance_from(const Cell& cell, const Vector3& position, const Vector3& recorded) {
  const Vector3 gap = cell.rotation.transpose() * recorded - position;
  Vector3 images = cell.lattice.triangularView<Eigen::Upper>().solve(gap);
  for (int k = 0; k < 3; ++k) images[k] = std::round(images[k]);
  return (gap - cell.lattice * images).norm();
}

/// Ids of the spheres that a record follows.
std::vector<std::string> followed(const RecordedTable& record) {
  std::vector<std::string> ids;
  for (const auto& column : record.columns())
    if (column.rfind("x_", 0) == 0) ids.push_back(column.substr(2));
  return ids;
}

/// Kinetic stress at the row's time, Pa, compression positive: velocities go half a step on from the leapfrog's, by
/// dv'/dt = f/m - D v'.
Matrix3 kinetic_stress(const Network& network) {
  Matrix3 sum = Matrix3::Zero();
  for (const auto& g : network.grains) {
    const Vector3 convected(shear_rate * g.velocity[2], 0, 0);
    const Vector3 v = g.velocity + 0.5 * time_step * (g.resultant / g.mass - convected);
    sum += g.mass * v * v.transpose();
  }
  return sum / network.cell.volume();
}

/// Largest difference between a recorded tensor (compression positive) and a stress. LAMMPS names the branch component
/// first.
double difference(const RecordedTable& record, std::size_t row, const std::string& name, const Matrix3& pressure,
                  bool symmetric) {
  double largest = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = symmetric ? i : 0; j < 3; ++j) {
      const std::string column = symmetric ? name + "xyz"[i] + "xyz"[j] : name + "xyz"[j] + "xyz"[i];
      largest = std::max(largest, std::abs(record.at(row, column) - pressure(i, j)));
    }
  return largest;
}

void check_cell(const std::string& name) {
  const RecordedTable record("lammps/sheared/" + name + ".csv");
  const RecordedTable sensitivity("lammps/sheared/" + name + "_sensitivity.csv");
  REQUIRE(record.rows() == sensitivity.rows());
  const auto ids = followed(record);
  REQUIRE(ids.size() == 10);
  Rve rve(start_of(name));
  long step = 0;
  for (std::size_t row = 1; row < record.rows(); ++row) {
    const long next = std::lround(record.at(row, "step"));
    const double dt = double(next - step) * time_step;
    step = next;
    Matrix3 shear = Matrix3::Zero();
    shear(0, 2) = shear_rate * dt;
    rve.apply(shear, dt);

    const Network network = rve.network();
    double moved = 0;
    for (const auto& id : ids) {
      const auto& grain = network.grains[std::size_t(std::stol(id) - 1)];
      const Vector3 recorded(record.at(row, "x_" + id), record.at(row, "y_" + id), record.at(row, "z_" + id));
      moved = std::max(moved, distance_from(network.cell, grain.position, recorded));
    }
    const double stress = difference(record, row, "P", -contact_stress(network), false);
    const double kinetic = difference(record, row, "R", kinetic_stress(network), true);
    const double largest = sensitivity.at(row, "Pmax");
    CAPTURE(name, step, moved, stress, kinetic);
    CHECK(moved <= 2 * sensitivity.at(row, "max_dx_half_dt") + printed);
    CHECK(stress <= 2 * sensitivity.at(row, "max_dP_half_dt") + 1e-11 * largest);
    CHECK(std::abs(double(network.contacts.size()) - record.at(row, "contacts")) <= 1);
    // No yardstick is recorded for it; it follows from forces and motion that agree to round-off.
    CHECK(kinetic <= 1e-6 * largest);
  }
  CHECK(step == 5450);
}

}  // namespace

TEST_CASE("500 spheres at porosity 0.738 flow as in LAMMPS, within its own time step's error", "[oracle]") {
  check_cell("n738_s1");
}

TEST_CASE("864 spheres at porosity 0.548 flow as in LAMMPS, within its own time step's error", "[oracle]") {
  check_cell("n548_s1");
}

TEST_CASE("1201 spheres at porosity 0.371 flow as in LAMMPS, within its own time step's error", "[oracle]") {
  check_cell("n371_s3");
}
