// rvelab measure, and stress, force and fabric along tests.
#include <cmath>

#include "rvelab/io/journal/recorded_test.hpp"
#include "rvelab/measure/measures.hpp"
#include "tests/program.hpp"

using namespace rvelab;
using namespace rvelab::test;
using Catch::Matchers::Contains;

namespace {

const std::string quantities =
    " --set 'output.quantities=[\"a_c\",\"a_n\",\"a_t\",\"a_l\",\"a_lt\",\"stress_force_fabric\",\"fabric_angle_deg\","
    "\"strong_contacts\",\"strong_deviator\",\"sliding_fraction\"]'";

/// Records of a test that is run with the quantities above.
std::vector<records::Record> records_of(const Workplace& here, const std::string& test) {
  here.succeeds("run " + test + " --specimen S.h5 -o R.h5" + quantities);
  return io::read_recorded_test(here / "R.h5").result.records;
}

/// The prediction within 0.05 of q/p everywhere, and within 5 % on average where q/p is above 0.1.
void expect_relation(const std::vector<records::Record>& records, int dimension) {
  double sum = 0;
  int sheared = 0;
  for (const records::Record& record : records) {
    const double ratio = deviatoric_stress(record.stress, dimension) / mean_pressure(record.stress, dimension);
    CAPTURE(record.strain, ratio);
    CHECK(std::abs(record.stress_force_fabric - ratio) < 0.05);
    if (ratio <= 0.1) continue;
    sum += std::abs(record.stress_force_fabric / ratio - 1);
    ++sheared;
  }
  REQUIRE(sheared > 20);
  CHECK(sum / sheared < 0.05);
}

}  // namespace

TEST_CASE("measure prints anisotropies and both networks of a specimen and of the end of a test") {
  const Workplace here;
  here.import_packing("dense_p20");
  const std::string text = here.succeeds("measure S.h5");
  CHECK_THAT(text, Contains("\nq_over_p_predicted ") && Contains("\nstrong_deviator_share "));
  const auto json = here.json("measure S.h5");
  CHECK(json.at("strong_contacts").get<double>() + json.at("weak_contacts").get<double>() == Approx(1));
  CHECK(json.at("normals_tensor").size() == 3);
  const auto records = records_of(here, "biaxial --set stage.compression.to_strain=0.003");
  const auto end = here.json("measure R.h5");
  CHECK(end.at("a_n").get<double>() == Approx(records.back().a_n).epsilon(1e-6));
  CHECK(end.at("q_over_p_predicted").get<double>() == Approx(records.back().stress_force_fabric).epsilon(1e-6));
  CHECK(end.at("strong_deviator_share").get<double>() == Approx(records.back().strong_deviator).epsilon(1e-6));
  CHECK(end.at("fabric_angle_deg").get<double>() == Approx(records.back().fabric_angle_deg).epsilon(1e-6));
  here.refuses("measure", "file");
}

TEST_CASE("discs in a biaxial test: force and fabric make the stress, strong contacts bear the deviator", "[slow]") {
  const Workplace here;
  here.import_packing("dense_p20");
  const auto records = records_of(here, "biaxial --set stage.compression.to_strain=0.05");
  expect_relation(records, 2);
  const records::Record& end = records.back();
  // Radjai et al. (1998): about 40 % of the contacts are strong, and bear nearly the whole deviator.
  CHECK(end.strong_contacts > 0.3);
  CHECK(end.strong_contacts < 0.5);
  CHECK(end.strong_deviator > 0.8);
  // Forces and normals turn towards the major stress (Rothenburg and Bathurst 1989).
  CHECK(end.a_c > 0.1);
  CHECK(end.a_n > 0.1);
  CHECK(end.a_t > 0);
  CHECK(end.fabric_angle_deg < 10);
  CHECK(std::abs(end.a_lt) < 1e-9);
  const auto state = here.json("measure R.h5");
  // Of contacts that slide, most are weak.
  CHECK(state.at("weak_sliding").get<double>() > 2 * state.at("strong_sliding").get<double>());
  CHECK(state.at("strong_anisotropy").get<double>() > 3 * std::abs(state.at("weak_anisotropy").get<double>()));
}

TEST_CASE("ellipses in a biaxial test: force and fabric make the stress", "[slow]") {
  const Workplace here;
  here.succeeds(
      "pack pack_dense --set pack.shape=ellipse --set grains.smallest_aspect_ratio=0.5 --set "
      "grains.largest_aspect_ratio=0.8 -o S.h5");
  const auto records = records_of(here, "biaxial --set stage.compression.to_strain=0.05");
  expect_relation(records, 2);
  CHECK(std::abs(records.back().a_lt) > 1e-6);  // branches across the normals
}

TEST_CASE("measure gives modulus and damping of each loop of a cyclic test, and no instability") {
  const Workplace here;
  here.import_packing("dense_p20");
  here.succeeds("run cyclic_shear --specimen S.h5 -o C.h5 --set stage.cycles.cycles=3");
  const auto json = here.json("measure C.h5");
  CHECK(!json.contains("unstable_from_strain"));
  REQUIRE(json.at("loops").size() == 2);
  for (const auto& loop : json.at("loops")) {
    CHECK(loop.at("gamma").get<double>() == Approx(0.005).epsilon(0.01));
    CHECK(loop.at("G_over_G_max").get<double>() < 1);
    CHECK(loop.at("G_over_G_max").get<double>() > 0);
    CHECK(loop.at("G_over_G_max").get<double>() ==
          Approx(loop.at("G_Pa").get<double>() / json.at("G_max_Pa").get<double>()));
    // Of a solid that yields at once it is 2/pi (Masing); grains that are stuck dissipate nothing.
    CHECK(loop.at("damping_ratio").get<double>() > 0.01);
    CHECK(loop.at("damping_ratio").get<double>() < 0.64);
  }
}

TEST_CASE("a dense biaxial test turns unstable at its peak; bands by Roscoe, Arthur and Coulomb", "[slow]") {
  const Workplace here;
  here.import_packing("dense_p20");
  const Outcome run = here.run("run biaxial --specimen S.h5 -o R.h5 --json");
  REQUIRE(run.code == 0);
  const auto json = here.json("measure R.h5");
  const double peak = nlohmann::json::parse(run.output).at("peak_strain").get<double>();
  CHECK(json.at("unstable_from_strain").get<double>() < peak + 0.005);
  CHECK(json.at("second_order_work_least").get<double>() < 0);
  CHECK(json.at("strains").size() == json.at("second_order_work_Pa").size());
  const double coulomb = json.at("coulomb_angle_deg"), arthur = json.at("arthur_angle_deg"),
               roscoe = json.at("roscoe_angle_deg");
  CHECK(arthur == Approx(0.5 * (coulomb + roscoe)));
  CHECK(roscoe > 45);  // dense grains dilate
  CHECK(coulomb > roscoe);
  // A sheared state is weaker in its weakest band than its contacts would be, were all of them stuck.
  const auto probe = here.json("probe R.h5 --bands --method dynamic --size 1e-5");
  CHECK(probe.at("acoustic_ratio").get<double>() < 0.95);
  CHECK(probe.at("acoustic_ratio").get<double>() <= probe.at("acoustic_mean_ratio").get<double>() + 0.05);
  const auto elastic = here.json("probe R.h5 --bands --method linear");
  CHECK(elastic.at("acoustic_ratio").get<double>() == 1);
}

TEST_CASE("at its peak a biaxial test takes no more second-order work, and a band is about to form", "[slow]") {
  const Workplace here;
  here.import_packing("dense_p20");
  const Outcome whole = here.run("run biaxial --specimen S.h5 -o W.h5 --json --set test.pressure_Pa=1e5");
  const double peak = nlohmann::json::parse(whole.output).at("peak_strain").get<double>();
  const auto probed = [&](double strain, const std::string& options) {
    here.run(
        "run biaxial --specimen S.h5 -o R.h5 --force --set test.pressure_Pa=1e5 --set stage.compression.to_strain=" +
        std::to_string(strain));
    return here.json("probe R.h5 --bands " + options);
  };
  const auto early = probed(0.001, ""), at_peak = probed(peak, "");
  CHECK(early.at("method") == "loading");
  CHECK(early.at("acoustic_ratio").get<double>() > 0.5);
  CHECK(early.at("second_order_work_ratio").get<double>() > 0.5);
  CHECK(std::abs(at_peak.at("acoustic_ratio").get<double>()) < 0.15);
  CHECK(std::abs(at_peak.at("second_order_work_ratio").get<double>()) < 0.15);
  // The band of the loading stiffness lies where those of soils do, the averaged one does not form.
  CHECK(at_peak.at("band_angle_deg").get<double>() > at_peak.at("roscoe_angle_deg").get<double>() - 8);
  CHECK(at_peak.at("band_angle_deg").get<double>() < at_peak.at("coulomb_angle_deg").get<double>() + 8);
  const auto averaged = here.json("probe R.h5 --bands --method dynamic --size 1e-3");
  CHECK(averaged.at("acoustic_ratio").get<double>() > at_peak.at("acoustic_ratio").get<double>() + 0.1);

  here.refuses("probe S.h5 --bands", "give the record file of a test");
}

TEST_CASE(
    "spheres in triaxial compression: force and fabric make the stress; elastic at first, and at the peak no band "
    "before the work is spent",
    "[slow]") {
  // Axisymmetric compression resists bands (Rudnicki and Rice 1975): with second-order work at zero det Q is not below.
  const Workplace here;
  here.import_packing("hertz");
  const auto probed = [&](const std::string& settings, const std::string& size) {
    here.succeeds("run triaxial --specimen S.h5 -o R.h5 --force " + settings);
    return here.json("probe R.h5 --bands " + size);
  };
  const auto early =
      probed("--set stage.compression.to_strain=1e-4 --set stage.compression.record_every=2e-5", "--size 5e-5");
  CHECK(early.at("acoustic_ratio").get<double>() > 0.8);
  CHECK(early.at("acoustic_ratio").get<double>() < 1.05);
  CHECK(early.at("second_order_work_ratio").get<double>() > 0.9);
  const auto whole =
      here.json("run triaxial --specimen S.h5 -o W.h5 --set stage.compression.to_strain=0.03" + quantities);
  expect_relation(io::read_recorded_test(here / "W.h5").result.records, 3);
  const double peak = whole.at("peak_strain").get<double>();
  const auto at_peak = probed("--set stage.compression.to_strain=" + std::to_string(peak), "");
  CHECK(at_peak.at("stiffness_Pa").size() == 6);
  CHECK(std::abs(at_peak.at("second_order_work_ratio").get<double>()) < 0.15);
  CHECK(at_peak.at("acoustic_ratio").get<double>() > -0.05);  // what one specimen scatters by
  CHECK(at_peak.at("acoustic_ratio").get<double>() < 0.15);
  CHECK(at_peak.at("acoustic_mean_ratio").get<double>() > 0);
  CHECK(at_peak.at("band_angle_deg").get<double>() > at_peak.at("roscoe_angle_deg").get<double>() - 8);
  CHECK(at_peak.at("band_angle_deg").get<double>() < at_peak.at("coulomb_angle_deg").get<double>() + 8);
}

TEST_CASE("critical fits the line through the ends of tests, and says what it lacks", "[slow]") {
  const Workplace here;
  here.import_packing("dense_p20");
  for (const char* p : {"100", "400"}) {
    const std::string pressure = p;
    here.succeeds("run simple_shear_drained --specimen S.h5 -o R" + pressure + ".h5 --set test.pressure_Pa=" +
                  pressure + "e3 --set stage.shear.to_strain=0.5 --set stage.shear.record_every=0.02");
  }
  const auto json = here.json("critical R100.h5 R400.h5");
  const auto& states = json.at("states");
  REQUIRE(states.size() == 2);
  for (const auto& state : states) {
    // The line goes through two states; a dense packing lies below it.
    const double p = state.at("p_Pa"), e = state.at("void_ratio");
    CHECK(json.at("logarithmic_Gamma").get<double>() -
              json.at("logarithmic_lambda").get<double>() * std::log(p / 1e3) ==
          Approx(e).epsilon(1e-9));
    CHECK(state.at("state_parameter").get<double>() < 0);
    CHECK(state.at("q_over_p").get<double>() > 0.1);
  }
  here.refuses("critical R100.h5 --from 3", "beyond the end");
  here.refuses("critical S.h5", "S.h5");
  here.succeeds(
      "run biaxial --specimen S.h5 -o N.h5 --set 'output.quantities=[]' --set "
      "stage.compression.to_strain=0.001");
  here.refuses("critical N.h5", "void_ratio");
}
