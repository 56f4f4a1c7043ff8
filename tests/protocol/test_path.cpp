// Paths: what the rows prescribe is what the records show; rows that cannot be are refused by name.
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>

#include "rvelab/error.hpp"
#include "rvelab/measure/measures.hpp"
#include "rvelab/protocol/directions.hpp"
#include "rvelab/protocol/run.hpp"
#include "tests/catch.hpp"
#include "tests/protocol/texts.hpp"
#include "tests/reference_specimen.hpp"

using namespace rvelab;
using namespace rvelab::test;

namespace {

protocol::TestRun run_path(const std::string& stages, const std::string& specimen) {
  return run_stages(stages, reference_specimen(specimen));
}

std::string row(const std::string& name, const std::string& rest) {
  return "[[stage.row]]\nname = \"" + name + "\"\n" + rest + "\n";
}

std::string message_of_rows(const std::string& rows, int dimension) {
  return message_of("[test]\nname = \"test\"\ndimension = " + std::to_string(dimension) +
                    "\n[[stage]]\nkind = \"path\"\n" + rows);
}

}  // namespace

TEST_CASE("Rows of strain: the logarithmic strain goes from point to point in equal parts") {
  const protocol::TestRun run = run_path("[[stage]]\nkind = \"path\"\nrecords_per_point = 4\n" +
                                             row("axial", "strain = {yy = -1}\nto = [0.002, 0.001]") +
                                             row("shear", "strain = {xy = 1}\nto = [0.0, 0.0004]"),
                                         "dense_p20");
  const auto& records = run.result.records;
  REQUIRE(records.size() == 9);
  for (std::size_t k = 0; k < 9; ++k) {
    const double axial = k <= 4 ? 0.0005 * double(k) : 0.002 - 0.00025 * double(k - 4);
    const double shear = k <= 4 ? 0 : 0.0001 * double(k - 4);
    const Matrix3& f = records[k].deformation_gradient;
    CHECK(records[k].strain == Approx(axial).margin(1e-15));
    // To first order in an increment's size: sums of symmetric gradients are logarithms of straight paths.
    CHECK(-std::log(f(1, 1)) == Approx(axial).margin(4e-7));
    CHECK(f(0, 0) == Approx(1).margin(4e-7));
    CHECK(f(0, 1) + f(1, 0) == Approx(shear).margin(4e-7));
    CHECK(records[k].target_held);
  }
}

TEST_CASE("Rows of stress and strain: both are held, in any combination") {
  // A spring beside the specimen: sigma_xx + 20 MPa eps_xx stays; p itself; and their records.
  const protocol::TestRun run = run_path("[[stage]]\nkind = \"path\"\nrecords_per_point = 10\n" +
                                             row("axial", "strain = {yy = -1}\nto = [0.005]") +
                                             row("spring", "strain_Pa = {xx = 20e6}\nstress = {xx = 1}"),
                                         "dense_p20");
  const double first = run.result.records[0].stress(0, 0);
  for (const records::Record& record : run.result.records) {
    const double lateral = std::log(record.deformation_gradient(0, 0));
    const double value = record.stress(0, 0) + 20e6 * lateral;
    if (record.target_held) CHECK(std::abs(value - first) <= 0.005 * std::abs(first) * (1 + 1e-6) + 20e6 * 1e-7);
  }
  CHECK(run.result.records.back().stress(0, 0) < 1.2 * first);  // the lateral pressure has grown
}

TEST_CASE("A volume that the rows say stays, stays to 1e-12, stress-driven or not") {
  const std::string cycles = "[[stage]]\nkind = \"path\"\nrecords_per_point = 6\ncycles = 2\n";
  for (const std::string& rows :
       {row("volume", "strain = {xx = 1, yy = 1}") + row("xx", "strain = {xx = 1}") +
            row("tau", "stress = {xy = 1}\nto_Pa = [2e3, -2e3]"),
        row("volume", "strain = {xx = 1, yy = 1}") + row("axial", "strain = {yy = -1}\nto = [0.003, -0.001]"),
        row("volume", "strain = {xx = 1, yy = 1}") + row("q", "stress = {xx = 1, yy = -1}\nto_Pa = [6e3, -6e3]")}) {
    const protocol::TestRun run = run_path(cycles + rows, "dense_p20");
    REQUIRE(run.result.records.size() == 25);
    for (const records::Record& record : run.result.records) {
      CHECK(record.deformation_gradient.determinant() == Approx(1).margin(1e-12));
    }
    CHECK(run.end_state.cell.volume() == Approx(reference_specimen("dense_p20").cell.volume()).epsilon(1e-12));
  }
}

TEST_CASE("Stress-driven components move by a symmetric gradient: the cell does not spin") {
  const protocol::TestRun run =
      run_path("[[stage]]\nkind = \"path\"\nrecords_per_point = 8\n" + row("xx", "stress = {xx = 1}") +
                   row("yy", "stress = {yy = 1}") + row("tau", "stress = {xy = 1}\nto_Pa = [3e3]"),
               "dense_p20");
  const Matrix3& f = run.result.records.back().deformation_gradient;
  CHECK(std::abs(f(0, 1)) > 1e-6);
  CHECK(std::abs(f(0, 1) - f(1, 0)) < 1e-3 * std::abs(f(0, 1)));
  CHECK(run.result.records.back().stress(0, 1) == Approx(3e3).margin(0.005 * 3e3 * 1.01));
}

TEST_CASE("Constant p: held within the tolerance, 2D and 3D; the Lode angle stays") {
  const protocol::TestRun plane = run_path("[[stage]]\nkind = \"deviatoric\"\nto_strain = 0.006\n", "dense_p20");
  for (const records::Record& record : plane.result.records) {
    if (record.target_held) CHECK(mean_pressure(record.stress, 2) == Approx(20e3).epsilon(0.0051));
  }
  CHECK(deviatoric_stress(plane.result.records.back().stress, 2) > 4e3);
  CHECK_THROWS_WITH(run_path("[[stage]]\nkind = \"deviatoric\"\nto_strain = 0.006\nlode_angle_deg = 30\n", "dense_p20"),
                    Catch::Matchers::Contains("lode_angle_deg means nothing in 2D"));
  for (const double angle : {0.0, 40.0}) {
    const protocol::TestRun run =
        run_path("[[stage]]\nkind = \"deviatoric\"\nto_strain = 0.002\nlode_angle_deg = " + std::to_string(angle) +
                     "\npressure_Pa = 100e3\n",
                 "hertz");
    REQUIRE(run.result.records.size() == 3);
    const records::Record& end = run.result.records.back();
    CHECK(end.target_held);
    CHECK(mean_pressure(end.stress, 3) == Approx(100e3).epsilon(0.0051));
    const Matrix3 s = end.stress + 100e3 * Matrix3::Identity();
    const double pi = std::acos(-1.0);
    // Compression positive deviators over axes z, x, y stand at theta, theta - 120, theta + 120 degrees.
    const double along = -(s(2, 2) * std::cos(angle * pi / 180) + s(0, 0) * std::cos((angle - 120) * pi / 180) +
                           s(1, 1) * std::cos((angle + 120) * pi / 180));
    const double across = -(s(2, 2) * std::sin(angle * pi / 180) + s(0, 0) * std::sin((angle - 120) * pi / 180) +
                            s(1, 1) * std::sin((angle + 120) * pi / 180));
    CHECK(along > 10e3);
    CHECK(std::abs(across) < 0.005 * 1.5 * 100e3);  // held_tolerance times p, over 2/3 in the row
    CHECK(std::abs(across) < 0.05 * along);
  }
}

TEST_CASE("Directions without libm are those of libm") {
  for (int k = -40; k <= 40; ++k) {
    const protocol::UnitVector unit = protocol::unit_vector(k / 37.0);
    const double angle = 2 * std::acos(-1.0) * k / 37.0;
    CHECK(unit.cosine == Approx(std::cos(angle)).margin(2e-14));
    CHECK(unit.sine == Approx(std::sin(angle)).margin(2e-14));
  }
}

TEST_CASE("Pressures one after the other: both normal stresses reach each") {
  const protocol::TestRun run =
      run_path("[[stage]]\nkind = \"pressure_path\"\nto_Pa = [40e3, 10e3]\nrecords_per_point = 3\n", "dense_p20");
  REQUIRE(run.result.records.size() == 7);
  const double expected[] = {20e3, 26667, 33333, 40e3, 30e3, 20e3, 10e3};
  for (std::size_t k = 0; k < 7; ++k) {
    CHECK(run.result.records[k].stress(0, 0) == Approx(-expected[k]).epsilon(0.0051));
    CHECK(run.result.records[k].stress(1, 1) == Approx(-expected[k]).epsilon(0.0051));
    CHECK(run.result.records[k].strain == Approx(1 - run.result.records[k].deformation_gradient.determinant()));
  }
  CHECK(run.result.records[3].strain > 0);
}

TEST_CASE("Rows that say the same, or contradict each other, are refused by name") {
  const std::string xx = row("xx", "stress = {xx = -1}\nto_Pa = [1e4]"),
                    yy = row("yy", "stress = {yy = -1}\nto_Pa = [1e4]");
  CHECK(message_of_rows(xx + yy, 2).empty());
  const std::string same = message_of_rows(xx + yy + row("p", "stress = {xx = -0.5, yy = -0.5}\nto_Pa = [1e4]"), 2);
  CHECK(contains(same, "row \"p\" follows from \"xx\", \"yy\" (dependent constraints)"));
  const std::string other = message_of_rows(xx + yy + row("p", "stress = {xx = -0.5, yy = -0.5}\nto_Pa = [2e4]"), 2);
  CHECK(contains(other, "row \"p\" contradicts \"xx\", \"yy\""));
  CHECK(contains(other, "remove one of them"));
  const std::string volume =
      message_of_rows(row("volume", "strain = {xx = 1, yy = 1}") + row("a", "strain = {xx = 1}\nto = [0.1]") +
                          row("b", "strain = {yy = 2}\nto = [0.3]"),
                      2);
  CHECK(contains(volume, "row \"b\" contradicts \"volume\", \"a\""));
  const std::string few = message_of_rows(row("p", "stress = {xx = -0.5, yy = -0.5}\nto_Pa = [1e4]"), 2);
  CHECK(contains(few, "2 constraints (\"p\", \"strain xy = 0, since no row names it\"); allowed in 2D: 3; add a row"));
  CHECK(contains(message_of_rows(row("z", "strain = {zz = 1}\nto = [0.1]"), 2), "names a component along z"));
  CHECK(contains(message_of_rows(row("a", "strain = {xx = 1}"), 2), "gives no targets"));
  CHECK(contains(message_of_rows(row("a", "to = [1]"), 2), "neither strain nor stress"));
  CHECK(contains(message_of_rows(row("a", "stress = {xx = 1}\nto = [1]"), 2), "allowed: to_Pa; rename it"));
  CHECK(
      contains(message_of_rows(row("a", "strain = {xx = 1}\nto_Pa = [1]"), 2), "allowed in a row without stress: to"));
  CHECK(contains(message_of_rows(row("a", "strain = {yx = 1}\nto = [1]"), 2), "names no component \"yx\""));
  CHECK(contains(message_of_rows(row("a", "strain = {xx = 1}\nto = [1]") + row("a", "strain = {yy = 1}"), 2),
                 "is there twice"));
  CHECK(
      contains(message_of_rows(row("a", "strain = {xx = 1}\nto = [1]") + row("b", "strain = {yy = 1}\nto = [1, 2]"), 2),
               "allowed: the same number"));
}

TEST_CASE("Without a dimension in the file the rows are checked when the specimen is there, before anything runs") {
  const std::string rows = row("z", "strain = {zz = 1}\nto = [0.1]");
  const protocol::Protocol protocol = protocol::parse_protocol(
      "[test]\nname = \"test\"\npressure_Pa = 20e3\n[[stage]]\nkind = \"path\"\n" + rows, "t.toml");
  CHECK_THROWS_AS(protocol::run_protocol(protocol, reference_specimen("dense_p20")), InputError);
}
