// Events, cycles, flows, given deformations, response envelopes, and what a record measures.
#include <Eigen/LU>
#include <cmath>

#include "rvelab/calibrate/mohr.hpp"
#include "rvelab/error.hpp"
#include "rvelab/measure/measures.hpp"
#include "rvelab/measure/tangent.hpp"
#include "rvelab/protocol/run.hpp"
#include "rvelab/solver/rve.hpp"
#include "tests/catch.hpp"
#include "tests/protocol/texts.hpp"
#include "tests/reference_specimen.hpp"

using namespace rvelab;
using namespace rvelab::test;

namespace {

double ratio(const records::Record& record) {
  return deviatoric_stress(record.stress, 2) / mean_pressure(record.stress, 2);
}

}  // namespace

TEST_CASE("An event ends its stage at the first record that meets it") {
  const protocol::TestRun run = run_stages(
      "[[stage]]\nkind = \"compression\"\nto_strain = 0.02\n"
      "  [[stage.until]]\n  quantity = \"q_over_p\"\n  above = 0.3\n",
      reference_specimen("dense_p20"));
  const auto& records = run.result.records;
  REQUIRE(records.size() < 41);
  CHECK(ratio(records.back()) > 0.3);
  for (std::size_t k = 0; k + 1 < records.size(); ++k) CHECK(ratio(records[k]) <= 0.3);
}

TEST_CASE("A peak is passed when the stress has fallen by the given part of it") {
  const protocol::TestRun run = run_stages(
      "[[stage]]\nkind = \"compression\"\nto_strain = 0.2\n"
      "  [[stage.until]]\n  quantity = \"q_Pa\"\n  falls_by = 0.05\n",
      reference_specimen("dense_p20"));
  const auto& records = run.result.records;
  REQUIRE(records.size() < 401);
  double largest = 0;
  for (std::size_t k = 0; k + 1 < records.size(); ++k) {
    largest = std::max(largest, deviatoric_stress(records[k].stress, 2));
    CHECK(deviatoric_stress(records[k].stress, 2) >= 0.95 * largest);
  }
  CHECK(deviatoric_stress(records.back().stress, 2) < 0.95 * largest);
}

TEST_CASE("Events switch to and fro between stages, until another ends the test") {
  // Stress-controlled cycles out of two monotonic stages.
  const protocol::TestRun run = run_stages(
      "[[stage]]\nname = \"forth\"\nkind = \"simple_shear\"\nto_strain = 0.01\nrecord_every = 1e-4\n"
      "  [[stage.until]]\n  quantity = \"visits\"\n  above = 2\n  then = \"end\"\n"
      "  [[stage.until]]\n  quantity = \"stress_xy_Pa\"\n  above = 2e3\n  then = \"back\"\n"
      "[[stage]]\nname = \"back\"\nkind = \"simple_shear\"\nto_strain = -0.01\nrecord_every = 1e-4\n"
      "  [[stage.until]]\n  quantity = \"stress_xy_Pa\"\n  below = -2e3\n  then = \"forth\"\n"
      "[[stage]]\nname = \"never\"\nkind = \"relax\"\nrecord = true\n",
      reference_specimen("dense_p20"));
  const auto& records = run.result.records;
  CHECK(run.result.stages == std::vector<std::string>{"forth", "back", "never"});
  int turns = 0;
  for (std::size_t k = 1; k < records.size(); ++k) {
    CHECK(records[k].stage < 2);
    if (records[k].stage == records[k - 1].stage) continue;
    ++turns;
    CHECK(std::abs(records[k].stress(0, 1)) > 1.9e3);
    CHECK(records[k].strain == 0);  // each stage counts its own strain
  }
  CHECK(turns == 4);  // forth, back, forth, back, and the third visit of forth ends it
  CHECK(records.back().stage == 0);
}

TEST_CASE("An event names stages and quantities that are there, and only stages with records have any") {
  const auto message_of = [](const std::string& text) {
    return input_error([&] { protocol::parse_protocol("[test]\nname = \"t\"\npressure_Pa = 1e4\n" + text, "t.toml"); });
  };
  using Catch::Matchers::Contains;
  const std::string stage = "[[stage]]\nkind = \"compression\"\nto_strain = 0.1\n  [[stage.until]]\n";
  CHECK_THAT(message_of(stage + "  quantity = \"q_Pa\"\n  above = 1\n  then = \"shaer\"\n"),
             Contains("t.toml:10: stage.compression.until.0.then") && Contains("\"shaer\"") &&
                 Contains("allowed: end, compression"));
  CHECK_THAT(message_of(stage + "  quantity = \"q_Pa\"\n  above = 1\n  then = \"compresion\"\n"),
             Contains("the nearest is compression"));
  CHECK_THAT(message_of(stage + "  quantity = \"qq\"\n  above = 1\n"),
             Contains("stage.compression.until.0.quantity = 'qq' is not known"));
  CHECK_THAT(message_of("[[stage]]\nkind = \"simple_sheer\"\n"), Contains("the nearest is simple_shear; choose one"));
  CHECK_THAT(message_of("[output]\nquantities = [\"void\"]\n" + stage), Contains("the nearest is void_ratio;"));
  CHECK_THAT(message_of(stage + "  quantity = \"q_Pa\"\n"), Contains("needs one of above, below, falls_by"));
  CHECK_THAT(message_of(stage + "  quantity = \"q_Pa\"\n  above = 1\n  below = 0\n"), Contains("allowed: exactly one"));
  CHECK_THAT(message_of("[[stage]]\nkind = \"relax\"\n  [[stage.until]]\n  quantity = \"q_Pa\"\n  above = 1\n"),
             Contains("has no records to check"));
  CHECK_THAT(message_of("[[stage]]\nkind = \"relax\"\nthen = \"nowhere\"\n"), Contains("names no stage"));
}

TEST_CASE("Cycles of strain go to both amplitudes at constant volume and end where they began") {
  const protocol::TestRun run =
      run_stages("[[stage]]\nkind = \"simple_shear\"\nto_strain = 0.001\nrecord_every = 0.0005\ncycles = 2\n",
                 reference_specimen("dense_p20"));
  const double expected[] = {0, 1, 2, 1, 0, -1, -2, -1, 0, 1, 2, 1, 0, -1, -2, -1, 0};
  REQUIRE(run.result.records.size() == 17);
  for (std::size_t k = 0; k < 17; ++k) {
    CHECK(run.result.records[k].strain == Approx(0.0005 * expected[k]).margin(1e-18));
    CHECK(run.result.records[k].deformation_gradient(0, 1) == Approx(0.0005 * expected[k]).margin(1e-15));
    CHECK(run.result.records[k].deformation_gradient.determinant() == Approx(1).margin(1e-12));
  }
}

TEST_CASE("Cycles of stress turn within 1 % beyond the stress, in both directions") {
  const protocol::TestRun run = run_stages(
      "[[stage]]\nkind = \"compression\"\nlateral = \"constant_volume\"\nto_strain = 0.01\nrecord_every = 5e-5\n"
      "cycles = 3\nreverse_at_Pa = 4e3\n",
      reference_specimen("dense_p20"));
  const auto& records = run.result.records;
  int turns = 0;
  for (std::size_t k = 1; k + 1 < records.size(); ++k) {
    const double before = records[k].strain - records[k - 1].strain, after = records[k + 1].strain - records[k].strain;
    const double q = records[k].stress(0, 0) - records[k].stress(1, 1);
    if (before * after < 0) {
      ++turns;
      CHECK((before > 0 ? q : -q) >= 4e3);
      CHECK((before > 0 ? q : -q) <= 1.01 * 4e3);
    } else {
      CHECK((before > 0 ? q : -q) < 4e3);
    }
  }
  CHECK(turns == 6);
}

TEST_CASE("A flow of simple shear is simple shear, and any flow keeps its exponential") {
  const Specimen specimen = reference_specimen("dense_p20");
  const protocol::TestRun flow =
      run_stages("[[stage]]\nkind = \"flow\"\ngradient = {xy = 1}\nto_strain = 0.003\n", specimen);
  const protocol::TestRun shear = run_stages("[[stage]]\nkind = \"simple_shear\"\nto_strain = 0.003\n", specimen);
  REQUIRE(flow.result.records.size() == 4);
  for (std::size_t k = 0; k < 4; ++k) {
    CHECK((flow.result.records[k].stress - shear.result.records[k].stress).norm() < 1e-6 * 20e3);
  }
  // F = exp(s G) of a triangular G has exponentials on its diagonal.
  const protocol::TestRun mixed = run_stages(
      "[loading]\nmode = \"at_rate\"\nrate_1_s = 2\n"
      "[[stage]]\nkind = \"flow\"\ngradient = {xy = 1, xx = -0.02}\nto_strain = 0.01\n",
      specimen);
  const Matrix3& f = mixed.result.records.back().deformation_gradient;
  CHECK(f(0, 0) == Approx(std::exp(-0.0002)).epsilon(1e-13));
  CHECK(f(0, 1) == Approx((1 - std::exp(-0.0002)) / 0.02).epsilon(1e-12));
  CHECK(f(1, 1) == 1);
}

TEST_CASE("Recorded deformation gradients, given as a list, are passed through with their rotation") {
  const Specimen specimen = reference_specimen("dense_p20");
  const protocol::TestRun run = run_stages(
      "[[stage]]\nkind = \"deformation\"\ngradients = [[1.0001, 0.0, 0.0, 0.9995], [1.0, 0.001, -0.001, 1.0]]\n",
      specimen);
  REQUIRE(run.result.records.size() == 3);
  CHECK(run.result.records[1].deformation_gradient(1, 1) == Approx(0.9995).epsilon(1e-14));
  CHECK(run.result.records[2].deformation_gradient(0, 1) == Approx(0.001).epsilon(1e-12));
  CHECK(run.result.records[2].deformation_gradient(1, 0) == Approx(-0.001).epsilon(1e-12));
  CHECK(run.result.records[2].strain == 2);
}

TEST_CASE("Probes of an envelope start from one state, which the test goes on from; small ones are elastic") {
  const Specimen specimen = reference_specimen("dense_p20");
  const std::string shear = "[[stage]]\nkind = \"simple_shear\"\nto_strain = 0.001\n";
  const protocol::TestRun with =
      run_stages("[[stage]]\nkind = \"envelope\"\nsize = 1e-6\ndirections = 8\nunbalanced = 1e-9\n" + shear, specimen);
  const protocol::TestRun without = run_stages(shear, specimen);
  REQUIRE(with.result.records.size() == 9 + 2);
  for (std::size_t k = 0; k < 2; ++k) CHECK(with.result.records[9 + k].stress == without.result.records[k].stress);
  const Eigen::MatrixXd stiffness = elastic_tangent(Rve(specimen).network());
  const records::Record& first = with.result.records[0];
  for (std::size_t k = 1; k <= 8; ++k) {
    const records::Record& probe = with.result.records[k];
    const Matrix3 strain = probe.deformation_gradient - Matrix3::Identity();
    CHECK(strain.norm() == Approx(1e-6).epsilon(1e-9));
    const Eigen::Vector3d change = stiffness * Eigen::Vector3d(strain(0, 0), strain(1, 1), 0);
    CHECK(probe.stress(0, 0) - first.stress(0, 0) == Approx(change[0]).margin(0.02 * change.norm()));
    CHECK(probe.stress(1, 1) - first.stress(1, 1) == Approx(change[1]).margin(0.02 * change.norm()));
  }
  // Directions go round: the third is extension-free compression of x, the fifth lengthens y.
  CHECK(with.result.records[1].deformation_gradient(1, 1) < 1);
  CHECK(with.result.records[3].deformation_gradient(0, 0) < 1);
  CHECK(with.result.records[5].deformation_gradient(1, 1) > 1);
}

TEST_CASE("Probes of stress make the change of stress that was asked for in every direction") {
  const protocol::TestRun run =
      run_stages("[[stage]]\nkind = \"envelope\"\nprobes = \"stress\"\nsize_Pa = 100\ndirections = 4\n",
                 reference_specimen("dense_p20"));
  const records::Record& first = run.result.records[0];
  for (std::size_t k = 1; k <= 4; ++k) {
    const Matrix3 change = run.result.records[k].stress - first.stress;
    CHECK(Eigen::Vector2d(change(0, 0), change(1, 1)).norm() == Approx(100).epsilon(0.02));
  }
}

TEST_CASE("Oedometer and probes have the same moduli at small strain, 2 %") {
  for (const std::string name : {"dense", "hertz"}) {
    const Specimen specimen = reference_specimen(name);
    const int dimension = specimen.cell.dimension;
    const protocol::TestRun run = run_stages(
        "[solver]\nrelative_tolerance = 1e-3\nabsolute_tolerance = 1e-6\n"  // C12 is a fifth of C11; a record changes
                                                                            // 6e-4 p
        "[[stage]]\nkind = \"relax\"\nunbalanced = 1e-8\n"
        "[[stage]]\nkind = \"compression\"\nlateral = \"zero_strain\"\nto_strain = 1e-5\nrecord_every = 2e-6\n"
        "[[stage]]\nkind = \"probe\"\nmethod = \"linear\"\n",
        specimen);
    REQUIRE(run.result.records.size() == 6);
    const std::string axis = dimension == 2 ? "y" : "z";
    const calibrate::OedometerStiffness found = calibrate::oedometer_stiffness(run.result.records, axis, dimension);
    const Eigen::MatrixXd& c = run.result.probes.at(0).stiffness;
    const int a = dimension - 1;
    double lateral = 0;
    for (int k = 0; k < a; ++k) lateral += c(k, a) / a;
    CHECK(found.C11 == Approx(c(a, a)).epsilon(0.02));
    CHECK(found.C12 == Approx(lateral).epsilon(0.02));
    CHECK(found.G == Approx(0.5 * (c(a, a) - lateral)).epsilon(0.02));
    CHECK(found.K_2D == Approx(found.K_3D + found.G / 3));
    CHECK(found.K_3D == Approx((found.C11 + 2 * found.C12) / 3));
  }
}

TEST_CASE("A record measures what is asked for and nothing else; the parts of the stress add up") {
  const protocol::TestRun run = run_stages(
      "[loading]\nmode = \"at_rate\"\nrate_1_s = 5\n"
      "[output]\nquantities = [\"contact_stress_Pa\", \"reynolds_stress_Pa\", \"fabric\", \"kinetic_energy_J\"]\n"
      "[[stage]]\nkind = \"simple_shear\"\nto_strain = 0.004\n",
      reference_specimen("dense_p20"));
  const records::Record& end = run.result.records.back();
  using namespace records;
  CHECK(end.quantities == (asked<ContactStress> | asked<ReynoldsStress> | asked<Fabric> | asked<KineticEnergy>));
  CHECK((end.contact_stress + end.reynolds_stress - end.stress).norm() < 1e-12 * end.stress.norm());
  CHECK(end.reynolds_stress.trace() < 0);
  CHECK(end.fabric.trace() == Approx(1));
  CHECK(end.kinetic_energy > 0);
  CHECK(end.void_ratio == 0);
  CHECK(end.coordination_number == 0);
  const protocol::TestRun none =
      run_stages("[output]\nquantities = []\n[[stage]]\nkind = \"simple_shear\"\nto_strain = 0.001\n",
                 reference_specimen("dense_p20"));
  CHECK(none.result.records.back().quantities == 0);
  CHECK(none.result.records.back().void_ratio == 0);
}
