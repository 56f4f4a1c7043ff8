// Studies run: known answers, the same bits on any number of threads, resumed and stopped ones.
#include <atomic>
#include <cmath>
#include <cstring>

#include "rvelab/keys/material_toml.hpp"
#include "rvelab/study/measures.hpp"
#include "rvelab/study/summary.hpp"
#include "tests/study/studies.hpp"

using namespace rvelab;
using namespace rvelab::test;

namespace {

bool is_time(const std::string& column) { return column == "seconds"; }

/// Equal in every bit, times apart.
void expect_same_bits(const study::Pieces& a, const study::Pieces& b) {
  REQUIRE(a.by_name.size() == b.by_name.size());
  for (const auto& [name, piece] : a.by_name) {
    const study::Piece& other = b.by_name.at(name);
    CHECK(piece.failure == other.failure);
    for (const auto& [column, values] : piece.columns) {
      CAPTURE(name, column);
      const auto& others = other.column(column);
      REQUIRE(values.size() == others.size());
      if (!is_time(column)) CHECK(std::memcmp(values.data(), others.data(), 8 * values.size()) == 0);
    }
  }
}

}  // namespace

TEST_CASE("a grid point with the settings of the reference errs by what relaxing the answer changes", "[study]") {
  study::Study study = small_study();
  study.grid = {{"solver.fixed_substeps", {"1000", "30"}}};
  const study::Pieces pieces = run_all_of(study, few_discs());
  const auto& reference = pieces.by_name.at("increments_0_1");
  const auto &equal = pieces.by_name.at("increments_1_1"), &coarse = pieces.by_name.at("increments_2_1");
  REQUIRE(equal.column("error_Pa").size() == 6);
  for (std::size_t k = 0; k < 6; ++k) {
    CHECK(equal.column("error_Pa")[k] == reference.column("error_Pa")[k]);
    CHECK(equal.column("grain_steps")[k] == 36 * 1000);
    CHECK(coarse.column("grain_steps")[k] == 36 * 30);
    CHECK(coarse.column("seconds")[k] > 0);
    CHECK(reference.column("at_rest")[k] == 1);
  }
  // The first path of the reference is the one that the states are of, and the same settings make it again.
  const auto &first = pieces.by_name.at("path_0_1_1"), &again = pieces.by_name.at("path_1_1_1");
  CHECK(first.column("grain_steps") == again.column("grain_steps"));
  CHECK(first.column("end_void_ratio") == again.column("end_void_ratio"));
}

TEST_CASE("an error is the distance of the stress from that of the resolved increment from the same state", "[study]") {
  study::Study study = small_study();
  study.repeats = 0;
  study.grid = {{"solver.fixed_substeps", {"30"}}};
  const Specimen specimen = few_discs();
  const study::Pieces pieces = run_all_of(study, specimen);
  // The first state is the specimen itself: the shear is made by hand here.
  const auto stress_after = [&](const std::string& assignment, bool relaxed) {
    Specimen mine = specimen;
    keys::set_key(mine, assignment);
    Matrix3 increment = Matrix3::Zero();
    increment(0, 1) = 5e-4;
    Rve rve(mine);
    const Matrix3 stress = rve.apply(increment, 0).stress;
    if (relaxed) CHECK(rve.relax(study.relaxation.unbalanced, study.relaxation.max_steps).target_held);
    return relaxed ? rve.stress() : stress;
  };
  const Matrix3 answer = stress_after("solver.fixed_substeps=1000", true);
  const auto& loose = pieces.by_name.at("increments_1_1");
  const double by_hand = (stress_after("solver.fixed_substeps=30", false) - answer).norm();
  CHECK(loose.column("error_Pa")[0] == Approx(by_hand));
  CHECK(by_hand > 0);
  CHECK(loose.column("estimate_Pa")[0] > 0);
  CHECK(loose.column("allowed_Pa")[0] > 1e-4 * loose.column("pressure_Pa")[0]);  // solver.absolute_tolerance alone
  CHECK(loose.column("pressure_Pa")[0] == Approx(-0.5 * (answer(0, 0) + answer(1, 1))));
  CHECK(loose.column("increment_Pa")[0] == Approx((answer - Rve(specimen).stress()).norm()));
}

TEST_CASE("a stricter tolerance errs less and costs more, and both may be on the front", "[study]") {
  const study::Study study = small_study();
  const auto all = study::prepared(study, "test.toml", {few_discs()});
  const auto summary = study::summary_of(study, all, study::run_study(study, all, {}));
  REQUIRE(summary.points.size() == 2);
  const auto &loose = summary.points[0], &strict = summary.points[1];
  CHECK(strict.of_pressure.rms < loose.of_pressure.rms);
  CHECK(strict.grain_steps > loose.grain_steps);
  CHECK(loose.front_grain_steps);
  CHECK(strict.front_grain_steps);
  CHECK(summary.not_at_rest == 0);
  CHECK(loose.estimate.median_over_error > 0.5);
  CHECK(loose.estimate.covered >= 0.5);
  CHECK(loose.increments == 6);
  CHECK(loose.failed == 0);
  for (std::size_t k = 0; k < study::measures().size(); ++k) {
    CAPTURE(study::measures()[k].name);
    CHECK(std::isfinite(strict.means[k]));
    CHECK(std::isfinite(strict.standard_errors[k]));
    CHECK(strict.standard_errors[k] <= 0.01 * std::abs(strict.means[k]) + 1e-6);  // 1e-10 grows little by 0.4 %
  }
}

TEST_CASE("an increment of the coarsest records is made by all, in parts where records are denser", "[study]") {
  study::Study study = small_study();
  study.grid = {{"stage.simple_shear.record_every", {"0.001", "0.0005", "0.00025"}}};
  study.settings = {"solver.fixed_substeps=100"};
  study.repeats = 0;
  const study::Pieces pieces = run_all_of(study, few_discs());
  const auto steps = [&](int point) {
    return pieces.by_name.at("increments_" + std::to_string(point) + "_1").column("grain_steps").at(0) / 36;
  };
  CHECK(steps(0) == 2000);  // two increments of the reference
  CHECK(steps(1) == 100);
  CHECK(steps(2) == 200);
  CHECK(steps(3) == 400);
}

TEST_CASE("at a rate an increment takes the time that the path took; the reference's settings make it again bit by bit",
          "[study]") {
  study::Study study = small_study();
  study.settings = {"loading.mode=at_rate", "loading.rate_1_s=0.5"};
  study.reference = {"solver.time_step_factor=0.1"};
  study.grid = {{"solver.time_step_factor", {"0.1", "0.7"}}};
  study.repeats = 0;
  const study::Pieces pieces = run_all_of(study, few_discs());
  const auto &same = pieces.by_name.at("increments_1_1"), &coarse = pieces.by_name.at("increments_2_1");
  for (std::size_t k = 0; k < 6; ++k) {
    CHECK(same.column("error_Pa")[k] == 0);
    CHECK(coarse.column("error_Pa")[k] > 0);
    CHECK(std::isnan(coarse.column("estimate_Pa")[k]));  // estimates are those of quasi-static increments
    CHECK(coarse.column("error_Pa")[k] < 0.1 * coarse.column("pressure_Pa")[k]);
    CHECK(coarse.column("grain_steps")[k] < same.column("grain_steps")[k]);
  }
}

TEST_CASE("increments and paths that cannot be carried out are counted, with the first reason", "[study]") {
  study::Study study = small_study();
  study.grid = {{"solver.max_substeps", {"10", "100000"}}};
  const auto all = study::prepared(study, "test.toml", {few_discs()});
  const auto summary = study::summary_of(study, all, study::run_study(study, all, {}));
  const auto &failing = summary.points.at(0), &fine = summary.points.at(1);
  CHECK(failing.failed == 6);
  CHECK(failing.failed_paths == 2);
  CHECK(failing.failure.find("solver.max_substeps allows 10") != std::string::npos);
  CHECK(std::isnan(failing.of_pressure.median));
  CHECK(std::isnan(failing.means[0]));
  CHECK(!failing.front_grain_steps);
  CHECK(fine.failed == 0);
  CHECK(fine.failed_paths == 0);
  CHECK(fine.front_grain_steps);
}

TEST_CASE("a study gives the same bits on one thread and on two, times apart", "[study]") {
  const study::Study study = small_study();
  const Specimen specimen = few_discs();
  study::Keeper one, two;
  one.threads = 1;
  two.threads = 2;
  expect_same_bits(run_all_of(study, specimen, one), run_all_of(study, specimen, two));
}

TEST_CASE("pieces that are there are not run again, and what follows is as if nothing had been", "[study]") {
  const study::Study study = small_study();
  const Specimen specimen = few_discs();
  std::map<std::string, study::Piece> kept;
  study::Keeper keeper;
  keeper.keep = [&](const std::string& name, const study::Piece& piece) { kept[name] = piece; };
  const study::Pieces whole = run_all_of(study, specimen, keeper);
  REQUIRE(kept.size() == 9);  // the reference and two points: two paths and the increments of each
  kept.erase("increments_2_1");
  kept.erase("path_1_1_2");
  kept.at("path_2_1_1").failure = "a mark";
  std::vector<std::string> made;
  keeper.kept = [&](const std::string& name) {
    return kept.contains(name) ? std::optional(kept.at(name)) : std::nullopt;
  };
  keeper.keep = [&](const std::string& name, const study::Piece&) { made.push_back(name); };
  study::Pieces resumed = run_all_of(study, specimen, keeper);
  std::sort(made.begin(), made.end());
  CHECK(made == std::vector<std::string>{"increments_2_1", "path_1_1_2"});
  CHECK(resumed.by_name.at("path_2_1_1").failure == "a mark");
  resumed.by_name.at("path_2_1_1").failure.clear();
  expect_same_bits(whole, resumed);
}

TEST_CASE("a study that is stopped keeps what it has and says so", "[study]") {
  const study::Study study = small_study();
  std::atomic<bool> stop{false};
  study::Keeper keeper;
  keeper.threads = 1;
  keeper.stop = &stop;
  int kept = 0;
  keeper.keep = [&](const std::string&, const study::Piece&) { stop = ++kept == 4; };
  const study::Pieces pieces = run_all_of(study, few_discs(), keeper);
  CHECK(!pieces.complete);
  CHECK(kept == 4);
  CHECK(pieces.by_name.size() == 4);
}

TEST_CASE("a repeat moves grains by at most 1e-10 of their radius, always in the same way; the first not at all",
          "[study]") {
  const Specimen specimen = few_discs();
  const Specimen moved = study::perturbed(specimen, 2), again = study::perturbed(specimen, 2);
  const Specimen other = study::perturbed(specimen, 3);
  double largest = 0;
  for (std::size_t k = 0; k < specimen.grains.size(); ++k) {
    const Vector3& start = specimen.grains.position[k];
    CHECK(study::perturbed(specimen, 1).grains.position[k] == start);
    CHECK(moved.grains.position[k] == again.grains.position[k]);
    CHECK(moved.grains.position[k] != other.grains.position[k]);
    CHECK(moved.grains.position[k][2] == start[2]);
    largest = std::max(largest, (moved.grains.position[k] - start).cwiseAbs().maxCoeff() / specimen.grains.radius[k]);
  }
  CHECK(largest <= 1.001e-10);
  CHECK(largest > 5e-11);
}

TEST_CASE("measures of records with known answers", "[study]") {
  // sigma_yy grows with the strain to a peak at 2 % and falls; ln det F goes down, then up with slope 0.4.
  records::TestResult test;
  for (int k = 0; k <= 80; ++k) {
    records::Record record;
    record.strain = 0.0005 * k;
    const double rise = record.strain <= 0.02 ? 1e7 * record.strain : 2e5 - 5e6 * (record.strain - 0.02);
    record.stress = Vector3(-1e5, -1e5 - rise, 0).asDiagonal();
    record.deformation_gradient(1, 1) = std::exp(0.4 * (record.strain - 0.01));
    record.quantities = records::asked<records::VoidRatio>;
    record.void_ratio = 0.2 + record.strain;
    test.records.push_back(record);
  }
  const auto of = [&](const std::string& name) {
    for (const study::Measure& measure : study::measures()) {
      if (measure.name == name) return measure.of(test, 2);
    }
    throw std::logic_error(name);
  };
  CHECK(of("peak_friction_angle_deg") == Approx(30).epsilon(1e-9));  // (3 - 1)/(3 + 1) = sin 30
  CHECK(of("dilation_at_peak") == Approx(0.4).epsilon(1e-9));
  CHECK(of("end_void_ratio") == Approx(0.24));
  CHECK(of("small_strain_stiffness_Pa") == Approx(1e7));
  test.records.resize(2);  // ends before 0.1 %, without three records about a peak
  CHECK(std::isnan(of("small_strain_stiffness_Pa")));
  CHECK(std::isnan(of("dilation_at_peak")));
}
