// Protocols on a real packing: what a stage prescribes is what the records show.
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>

#include "rvelab/calibrate/calibrate.hpp"
#include "rvelab/error.hpp"
#include "rvelab/measure/probe.hpp"
#include "rvelab/protocol/run.hpp"
#include "rvelab/records/loading_direction.hpp"
#include "rvelab/solver/rve.hpp"
#include "tests/catch.hpp"
#include "tests/protocol/texts.hpp"
#include "tests/reference_specimen.hpp"
#include "tests/side_by_side.hpp"

using namespace rvelab;
using namespace rvelab::test;

namespace {

void expect_same(const std::vector<records::Record>& a, const std::vector<records::Record>& b) {
  REQUIRE(a.size() == b.size());
  for (std::size_t k = 0; k < a.size(); ++k) {
    CHECK(a[k].strain == b[k].strain);
    CHECK(a[k].stress == b[k].stress);
    CHECK(a[k].deformation_gradient == b[k].deformation_gradient);
    CHECK(a[k].void_ratio == b[k].void_ratio);
  }
}

}  // namespace

TEST_CASE("Drained compression records at its fixed strains, with the lateral stress held and no shear strain") {
  const protocol::TestRun run =
      run_stages("[[stage]]\nkind = \"compression\"\nto_strain = 0.0033\nrecord_every = 0.0005\n",
                 reference_specimen("dense_p20"));
  const auto& records = run.result.records;
  REQUIRE(records.size() == 8);  // 0, 0.05 % ... 0.30 %, and the end
  CHECK(run.result.axis == "y");
  CHECK(run.result.pressure == 20e3);
  for (std::size_t k = 0; k < records.size(); ++k) {
    const records::Record& record = records[k];
    const double strain = k < 7 ? 0.0005 * static_cast<double>(k) : 0.0033;
    CHECK(record.strain == Approx(strain).epsilon(1e-14));
    CHECK(1 - record.deformation_gradient(1, 1) == Approx(strain).margin(1e-13));
    CHECK(std::abs(record.deformation_gradient(0, 1)) < 1e-15);
    CHECK(std::abs(record.deformation_gradient(1, 0)) < 1e-15);
    if (record.target_held) CHECK(std::abs(record.stress(0, 0) + 20e3) <= 0.005 * 20e3 * (1 + 1e-9));
    if (k > 0) CHECK(record.substeps > 0);
  }
  // A dense packing is stiff at first and carries more and more.
  CHECK(records.back().stress(1, 1) < -40e3);
  CHECK(records[0].stress(1, 1) == Approx(-20e3).epsilon(1e-3));
}

TEST_CASE("The integral term of one stage does not move the strains that the next one prescribes") {
  const protocol::TestRun run = run_stages(
      "[[stage]]\nkind = \"isotropic\"\npressure_Pa = 24e3\n"
      "[[stage]]\nkind = \"compression\"\nto_strain = 0.003\nlateral_pressure_Pa = 24e3\n",
      reference_specimen("dense_p20"));
  REQUIRE(run.result.records.size() == 7);
  for (const records::Record& record : run.result.records) {
    CHECK(record.stage == 1);
    CHECK(1 - record.deformation_gradient(1, 1) == Approx(record.strain).margin(1e-13));
    CHECK(std::abs(record.deformation_gradient(0, 1)) < 1e-15);
  }
}

TEST_CASE("Constant-volume stages keep the volume to 1e-12") {
  const Specimen specimen = reference_specimen("dense_p20");
  const protocol::TestRun run = run_stages(
      "[[stage]]\nkind = \"compression\"\nto_strain = 0.002\nlateral = \"constant_volume\"\n"
      "[[stage]]\nkind = \"simple_shear\"\nto_strain = -0.002\nrecord_every = 0.0005\n",
      specimen);
  REQUIRE(run.result.records.size() == 10);
  for (const records::Record& record : run.result.records) {
    CHECK(record.deformation_gradient.determinant() == Approx(1).margin(1e-12));
    CHECK(record.void_ratio == Approx(run.result.records[0].void_ratio).epsilon(1e-11));
    const Matrix3& f = record.deformation_gradient;
    CHECK((record.stage == 0 ? 1 - f(1, 1) : f(0, 1)) == Approx(record.strain).margin(1e-13));
  }
  CHECK(run.result.records[5].strain == 0);  // strains count from the start of their stage
  CHECK(run.result.axis == "xy");
  CHECK(run.end_state.cell.volume() == Approx(specimen.cell.volume()).epsilon(1e-12));
}

TEST_CASE("Simple shear at constant normal stress lets the height go and nothing else") {
  const protocol::TestRun run =
      run_stages("[[stage]]\nkind = \"simple_shear\"\nto_strain = 0.004\nnormal = \"constant_stress\"\n",
                 reference_specimen("dense_p20"));
  REQUIRE(run.result.records.size() == 5);
  for (const records::Record& record : run.result.records) {
    const Matrix3& f = record.deformation_gradient;
    CHECK(f(0, 1) == Approx(record.strain).margin(1e-13));
    CHECK(f(0, 0) == Approx(1).margin(1e-14));
    CHECK(std::abs(f(1, 0)) < 1e-14);
    if (record.target_held) CHECK(std::abs(record.stress(1, 1) + 20e3) <= 0.005 * 20e3 * (1 + 1e-9));
  }
  CHECK(run.result.records.back().stress(0, 1) > 2e3);  // v_x(y) > 0 shears with sigma_xy > 0
}

TEST_CASE("An isotropic stage ends at its pressure and at rest") {
  const std::string stage =
      "[[stage]]\nkind = \"isotropic\"\npressure_Pa = 60e3\nrecord = true\n[[stage]]\nkind = \"probe\"\nmethod = "
      "\"linear\"\n";
  const protocol::TestRun run = run_stages(stage, reference_specimen("dense"));  // from 100 kPa
  REQUIRE(run.result.records.size() == 2);
  const records::Record& end = run.result.records[1];
  CHECK(std::abs(end.stress(0, 0) + 60e3) <= 1e-4 * 60e3);
  CHECK(std::abs(end.stress(1, 1) + 60e3) <= 1e-4 * 60e3);
  CHECK(end.unbalanced_force_ratio <= 1e-5);
  CHECK(std::abs(end.deformation_gradient(0, 1)) < 1e-15);
  CHECK(end.strain < 0);  // unloading swells
  CHECK(end.strain == Approx(1 - end.deformation_gradient.determinant()));
  // The shear stress is not driven, and stays of the order that it had.
  CHECK(std::abs(end.stress(0, 1)) > 1e-4 * 60e3);
  REQUIRE(run.result.probes.size() == 1);
  CHECK(run.result.probes[0].stiffness.rows() == 3);

  const protocol::TestRun freed =
      run_stages("[[stage]]\nkind = \"isotropic\"\npressure_Pa = 60e3\nshear = \"zero_stress\"\nrecord = true\n",
                 reference_specimen("dense"));
  CHECK(std::abs(freed.result.records[1].stress(0, 1)) <= 1e-4 * 60e3);
  CHECK(std::abs(freed.result.records[1].deformation_gradient(0, 1)) > 1e-9);
}

TEST_CASE(
    "An isotropic stage that ends far from the reference pressure makes its end the reference, and no other does") {
  const Specimen start = reference_specimen("dense");
  REQUIRE(start.state.reference.pressure == 1e5);
  const auto after = [&](double pressure) {
    const std::string stage = "[[stage]]\nkind = \"isotropic\"\npressure_Pa = " + std::to_string(pressure) + "\n";
    return run_stages(stage, start).end_state.state.reference;
  };
  const Reference near = after(10e3), far = after(1e3);
  CHECK(near.pressure == 1e5);
  CHECK(far.pressure == Approx(1e3).epsilon(1e-3));
  // Linear contacts: overlaps and forces go with the pressure, but for the contacts that open.
  CHECK(far.overlap < 0.02 * near.overlap);
  CHECK(far.contact_force < 0.02 * near.contact_force);
  CHECK(far.contact_force > 0.005 * near.contact_force);
}

TEST_CASE("A specimen that is where a stage wants it is left exactly as it was") {
  const Specimen specimen = reference_specimen("dense_p20");
  const protocol::TestRun run = run_stages(
      "[[stage]]\nkind = \"isotropic\"\nstress_tolerance = 1e-3\n[[stage]]\nkind = \"relax\"\n"
      "[[stage]]\nkind = \"probe\"\nmethod = \"linear\"\n",
      specimen);
  const Specimen untouched = Rve(specimen).specimen();
  REQUIRE(run.end_state.grains.size() == untouched.grains.size());
  for (std::size_t g = 0; g < untouched.grains.size(); ++g) {
    CHECK(run.end_state.grains.position[g] == untouched.grains.position[g]);
  }
  CHECK(run.end_state.cell.lattice == untouched.cell.lattice);
}

TEST_CASE("A probe of loading goes on as the test before it, and asks for one") {
  const Specimen specimen = reference_specimen("dense_p20");
  const std::string probe = "[[stage]]\nkind = \"probe\"\nmethod = \"loading\"\n";
  const std::string shear = "[[stage]]\nkind = \"simple_shear\"\nto_strain = 0.004\n";
  const protocol::TestRun run = run_stages(shear + probe, specimen);
  REQUIRE(run.result.probes.size() == 1);
  const Matrix3 direction = records::loading_direction(run.result.records);
  CHECK(direction(0, 1) == Approx(0.002).epsilon(1e-3));
  const Eigen::MatrixXd& stiffness = run.result.probes[0].stiffness;
  CHECK(stiffness == loading_stiffness(Rve(run.end_state), direction));
  CHECK(stiffness(2, 2) > 0);
  CHECK_THROWS_WITH(run_stages(probe, specimen), Catch::Matchers::Contains("needs a direction"));
}

TEST_CASE("A probe stage moves nothing: the test goes on as without it") {
  const Specimen specimen = reference_specimen("dense_p20");
  const std::string compression = "[[stage]]\nkind = \"compression\"\nto_strain = 0.001\n";
  const protocol::TestRun with = run_stages("[[stage]]\nkind = \"probe\"\nno_slip = true\n" + compression, specimen);
  const protocol::TestRun without = run_stages(compression, specimen);
  expect_same(with.result.records, without.result.records);
  REQUIRE(with.result.probes.size() == 1);
  // Positive definite: the packing is stable.
  CHECK(with.result.probes[0].stiffness.eigenvalues().real().minCoeff() > 0);
}

TEST_CASE("Physical loading runs at the inertial number that was asked for") {
  const protocol::TestRun run = run_stages(
      "[loading]\nmode = \"at_rate\"\ninertial_number = 2e-3\n"
      "[[stage]]\nkind = \"simple_shear\"\nto_strain = 0.002\nrecord_every = 0.001\n",
      reference_specimen("dense_p20"));
  REQUIRE(run.result.records.size() == 3);
  for (std::size_t k = 1; k < 3; ++k) {
    // I goes with 1/sqrt(p) of the moment; it was set at p0.
    const records::Record& record = run.result.records[k];
    const double p = -0.5 * (record.stress(0, 0) + record.stress(1, 1));
    CHECK(record.inertial_number * std::sqrt(p / 20e3) == Approx(2e-3).epsilon(1e-3));
  }
}

TEST_CASE("A stage that cannot reach its end says which stage and what it reached") {
  const auto message_of = [](const std::string& stages) {
    return error_text<Error>([&] { run_stages(stages, reference_specimen("dense")); });
  };
  const std::string relax =
      message_of("[[stage]]\nname = \"rest\"\nkind = \"relax\"\nunbalanced = 1e-17\nmax_steps = 30\n");
  CHECK(relax.find("stage \"rest\"") != std::string::npos);
  CHECK(relax.find("unbalanced ratio") != std::string::npos);
  const std::string isotropic = message_of("[[stage]]\nkind = \"isotropic\"\nmax_rounds = 1\nmax_steps = 1\n");
  CHECK(isotropic.find("stage \"isotropic\"") != std::string::npos);
  CHECK(isotropic.find("after 1 rounds") != std::string::npos);
  CHECK_THROWS_AS(
      run_stages("[[stage]]\nkind = \"compression\"\naxis = \"z\"\nto_strain = 0.1\n", reference_specimen("dense")),
      InputError);
}

TEST_CASE("Tests at several pressures do not depend on the number of threads") {
  const std::string text =
      "[test]\nname = \"test\"\npressure_Pa = 1e3\n[[stage]]\nkind = \"compression\"\nto_strain = 0.002\n";
  std::vector<protocol::Protocol> protocols;
  for (const char* pressure : {"test.pressure_Pa=10e3", "test.pressure_Pa=20e3", "test.pressure_Pa=30e3"}) {
    protocols.push_back(protocol::parse_protocol(text, "test.toml", {pressure}));
  }
  const std::vector<Specimen> specimens{reference_specimen("dense_p10"), reference_specimen("dense_p20"),
                                        reference_specimen("dense_p30")};
  const auto one = test::run_all(protocols, specimens, 1), many = test::run_all(protocols, specimens, 3);
  for (std::size_t k = 0; k < 3; ++k) expect_same(one[k].result.records, many[k].result.records);
  CHECK(one[2].result.pressure == 30e3);
  CHECK_THROWS_AS(calibrate::check_specimens(protocols, {specimens[0], specimens[1]}), InputError);
  // The error of one test is the error of all, and names its pressure.
  protocols[1] = protocol::parse_protocol(text, "test.toml", {"test.dimension=3", "test.pressure_Pa=20e3"});
  const std::string message = input_error([&] { test::run_all(protocols, specimens, 2); });
  CHECK(message.find("p = 20000 Pa") != std::string::npos);
}
