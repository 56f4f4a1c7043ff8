// rvelab fit as a user runs it: a target, a measured curve, a sweep; stopped and resumed; mistakes.
#include <cmath>
#include <map>

#include "tests/program.hpp"

using namespace rvelab::test;
using Catch::Matchers::Contains;

namespace {

constexpr const char* in_the_elastic_range = " --set stage.compression.to_strain=0.002 --set test.pressure_Pa=20e3 ";
constexpr const char* stiffness = " --vary material.young_modulus_Pa=2e8:3.2e9:log ";

Workplace& with_two_packings(Workplace& here) {
  here.import_packing("dense_p20", "S_a.h5");
  here.import_packing("medium_p20", "S_b.h5");
  return here;
}

}  // namespace

TEST_CASE("A fit finds the stiffness of the grains that a modulus was measured with, and goes on after a stop") {
  Workplace place;
  const Workplace& here = with_two_packings(place);
  // The truth: E = 800 MPa, as the specimens have it.
  const auto known = nlohmann::json::parse(
      here.run(std::string("run biaxial --specimen S_a.h5 S_b.h5 --json") + in_the_elastic_range).output);
  double modulus = 0;
  for (const auto& test : known["tests"]) modulus += test["E50_Pa"].get<double>() / 2;
  const std::string fit = std::string("fit biaxial --specimen 'S_*.h5' --tests 16 --target E50_Pa=") +
                          std::to_string(modulus) + stiffness + in_the_elastic_range;
  const std::string outcome = here.succeeds(fit + "-o F");
  CHECK_THAT(outcome, Contains("material.young_modulus_Pa") && Contains("95 % interval") && Contains("16"));
  const auto found = nlohmann::json::parse(bytes_of(here / "F/fit.json"));
  CHECK(found["parameters"][0]["low_95"].get<double>() <= 8e8);
  CHECK(found["parameters"][0]["high_95"].get<double>() >= 8e8);
  CHECK(found["parameters"][0]["high_95"].get<double>() < 3.2e9);
  CHECK(found["tests"].size() == 16);
  const std::string csv = bytes_of(here / "F/fit.csv");
  CHECK(std::count(csv.begin(), csv.end(), '\n') == 17);
  // Some tests are missing, as after a kill: they are made again, and nothing else changes.
  std::filesystem::copy(here / "F", here / "G", std::filesystem::copy_options::recursive);
  for (const char* name : {"G/fit.json", "G/fit.csv", "G/tests/0003.json", "G/tests/0016.json"})
    std::filesystem::remove(here / name);
  here.succeeds(fit + "-o G --resume --threads 2");
  CHECK(bytes_of(here / "G/fit.json") == bytes_of(here / "F/fit.json"));
  here.refuses(fit + "-o F", "--resume");
  here.refuses(fit + "-o F --resume --set material.friction=0.3", "is of another fit");
}

TEST_CASE("A measured curve is fitted, and the fit over the data is written and drawn") {
  Workplace place;
  const Workplace& here = with_two_packings(place);
  here.write("data.csv",
             "axial_strain_percent,deviator_kPa,deviator_kPa_error\n0.05,4,1\n0.1,7,1\n0.15,9,1\n0.2,11,1\n");
  here.succeeds(std::string("fit biaxial --specimen 'S_*.h5' --tests 10 --curve data.csv -o F") + stiffness +
                in_the_elastic_range);
  const std::string csv = bytes_of(here / "F/curves.csv");
  CHECK_THAT(csv, Contains("curve,pressure_Pa,quantity,abscissa,x,measured,error,fit,low_95,high_95,test\n") &&
                      Contains("1,0,deviator,strain,5e-04,4000,1000,"));
  CHECK(std::count(csv.begin(), csv.end(), '\n') == 5);
}

TEST_CASE("A sweep gives every combination on every specimen, as a table and as CSV") {
  Workplace place;
  const Workplace& here = with_two_packings(place);
  here.succeeds(std::string("fit biaxial --specimen 'S_*.h5' --vary material.friction=0.2:0.6:2 "
                            "--vary material.young_modulus_Pa=4e8:8e8:2 -o F") +
                in_the_elastic_range);
  const std::string csv = bytes_of(here / "F/sweep.csv");
  CHECK_THAT(csv, Contains("material.friction,material.young_modulus_Pa,friction_angle_deg,") &&
                      Contains("\n0.2,8e+08,") && Contains("\n0.6,4e+08,"));
  CHECK(std::count(csv.begin(), csv.end(), '\n') == 5);
  // One point of it is what a run gives.
  const auto run = here.json(std::string("run biaxial --specimen S_a.h5 S_b.h5 --set material.friction=0.6 "
                                         "--set material.young_modulus_Pa=4e8") +
                             in_the_elastic_range);
  const double mean =
      (run["tests"][0]["friction_angle_deg"].get<double>() + run["tests"][1]["friction_angle_deg"].get<double>()) / 2;
  std::istringstream row(csv.substr(csv.find("\n0.6,4e+08,") + 11));
  double found = 0;
  row >> found;
  CHECK(found == Approx(mean));
}

TEST_CASE("A recipe packs a specimen for each test, and its keys may be varied") {
  const Workplace here;
  const std::string outcome = here.succeeds(
      "fit biaxial --recipe pack_dense --count 2 --set pack.number=30 --set target.void_ratio_tolerance=0.02 "
      "--set stage.compression.to_strain=0.001 --set test.pressure_Pa=100e3 --vary target.void_ratio=0.2:0.24:2 "
      "--json");
  const auto sweep = nlohmann::json::parse(outcome)["sweep"];
  REQUIRE(sweep.size() == 2);
  CHECK(sweep[0]["start_void_ratio"]["mean"].get<double>() == Approx(0.2).margin(0.025));
  CHECK(sweep[1]["start_void_ratio"]["mean"].get<double>() == Approx(0.24).margin(0.025));
}

TEST_CASE("The scatter of the friction angle falls with the root of the number of grains", "[slow]") {
  const Workplace here;
  const auto sweep = here.json(
      "fit biaxial --recipe pack_dense --count 8 --vary pack.number=30:480:2 --set stage.compression.to_strain=0.05 "
      "--set target.void_ratio_tolerance=0.003")["sweep"];
  const auto error = [&](int point) { return sweep[point]["friction_angle_deg"]["standard_error"].get<double>(); };
  CHECK(sweep[1]["friction_angle_deg"]["n"] == 8);
  // Sixteen times the grains: a quarter. Ratios of two variances of eight numbers scatter as F with 7 and 7 degrees of
  // freedom, 1/4.99 to 4.99 in 95 %.
  CHECK(error(0) / error(1) > 4 / std::sqrt(4.99));
  CHECK(error(0) / error(1) < 4 * std::sqrt(4.99));
}

namespace {

// Thirty discs at two pressures, each with the modulus that they answer with at E = 800 MPa, and a curve.
std::string soil_file(double at_50_kPa, double at_100_kPa) {
  const auto test = [](const std::string& name, const std::string& pressure, const std::string& more) {
    return "[[measured]]\nname = \"" + name + "\"\nprotocol = \"biaxial\"\npressure_Pa = " + pressure + "\n" + more;
  };
  const auto target = [](double value) {
    return "targets = [\"E50_Pa=" + std::to_string(value) + "+-" + std::to_string(0.02 * value) + "\"]\n";
  };
  return "[fit]\nrecipe = \"pack_dense\"\ncount = 2\nsettings = [\"pack.number=30\", "
         "\"target.void_ratio_tolerance=0.02\", "
         "\"stage.compression.to_strain=0.002\"]\nvary = [\"material.young_modulus_Pa=2e8:3.2e9:log\"]\n" +
         test("low", "50e3", target(at_50_kPa)) +
         test("curve", "50e3",
              "curve = \"data.csv\"\ncolumns = [\"axial_strain_percent=eps\", \"deviator_kPa=q\"]\npredict = true\n") +
         test("high", "100e3", target(at_100_kPa) + "predict = true\n");
}

}  // namespace

TEST_CASE("One set of parameters is fitted to some tests of a soil, and predicts the others") {
  const Workplace here;
  here.write("data.csv", "minute,eps,q\n0,0,0\n1,0.05,20\n2,0.1,30\n3,0.2,40\n");
  std::map<std::string, double> modulus;
  for (const std::string pressure : {"50e3", "100e3"}) {
    const std::string name = "S_" + pressure;
    here.succeeds(
        "pack pack_dense --count 2 --set pack.number=30 --set target.void_ratio_tolerance=0.02 "
        "--set target.pressure_Pa=" +
        pressure + " -o " + name + ".h5");
    const auto known = here.json("run biaxial --specimen '" + name +
                                 "_*.h5' --set stage.compression.to_strain=0.002 "
                                 "--set test.pressure_Pa=" +
                                 pressure);
    for (const auto& test : known["tests"]) modulus[pressure] += test["E50_Pa"].get<double>() / 2;
  }
  here.write("soil.toml", soil_file(modulus["50e3"], modulus["100e3"]));
  const Outcome outcome = here.run("fit soil.toml --tests 24 -o F");
  INFO(outcome.errors);
  REQUIRE(outcome.code == 0);
  CHECK_THAT(outcome.errors, Contains("deviator has no standard error in curve"));
  CHECK_THAT(outcome.output, Contains("predicted") && Contains("fitted"));
  const auto found = nlohmann::json::parse(bytes_of(here / "F/fit.json"));
  CHECK(found["parameters"][0]["low_95"].get<double>() <= 8e8);
  CHECK(found["parameters"][0]["high_95"].get<double>() >= 8e8);
  const auto predicted = [&](const std::string& name) {
    for (const auto& each : found["predictions"])
      if (each["test"] == name) return each;
    return nlohmann::json();
  };
  CHECK(predicted("high")["predicted"] == true);
  CHECK(predicted("high")["off_standard_errors"].get<double>() < 2.5);
  CHECK(predicted("low")["predicted"] == false);
  CHECK(predicted("curve")["largest"]["measured"].get<double>() == Approx(40e3));
  const std::string csv = bytes_of(here / "F/predictions.csv");
  CHECK_THAT(csv, Contains("\ncurve,1,deviator,strain,"));
  CHECK(std::count(csv.begin(), csv.end(), '\n') == 5);
  // After a kill what is missing is made again, predictions too, and nothing else changes.
  for (const char* name : {"F/fit.json", "F/tests/0003.json", "F/predictions/0002.json"})
    std::filesystem::remove(here / name);
  here.succeeds("fit soil.toml --tests 24 -o F --resume --threads 2");
  CHECK(nlohmann::json::parse(bytes_of(here / "F/fit.json")) == found);
  const Outcome other = here.run("fit soil.toml --tests 24 -o F --resume --set pack.seed=2");
  CHECK(other.code == 2);
  CHECK_THAT(other.errors, Contains("is of another fit"));
  here.refuses("fit soil.toml --predict lowe", "nearest", "low");
  here.refuses("fit soil.toml --predict low", "names every test");
  here.refuses("fit soil.toml --target E50_Pa=3e7", "targets of a [[measured]]");
}

namespace {

/// Forty spheres; the curve of the test is truth.csv.
std::string soil_by_features(const std::string& vary, const std::string& more) {
  return "[fit]\nrecipe = \"karlsruhe_compressed\"\ncount = 2\ne_min = 0.677\ne_max = 1.054\ncompare = \"features\"\n"
         "settings = [\"pack.number=40\", \"target.void_ratio_tolerance=0.03\", "
         "\"stage.compression.to_strain=0.012\"]\n"
         "vary = [" +
         vary +
         "]\n[[measured]]\nname = \"T\"\nprotocol = \"triaxial\"\npressure_Pa = 100e3\nvoid_ratio = 0.75\n"
         "curve = \"truth.csv\"\ncolumns = [\"axial_strain=x\", \"deviator_Pa=q\"]\n" +
         more;
}

}  // namespace

TEST_CASE("Features of tests with known grains are found again, with a map of densities") {
  const Workplace here;
  here.write("truth.csv", "x,q\n0,0\n0.001,40e3\n0.005,100e3\n0.012,120e3\n");
  // What E = 2 GPa gives, as a measured curve.
  here.write("soil.toml", soil_by_features("\"material.young_modulus_Pa=1.999e9:2.001e9\"", ""));
  const Outcome first = here.run("fit soil.toml --tests 8 -o F");
  INFO(first.errors);
  REQUIRE(first.code == 0);
  CHECK_THAT(first.errors, Contains("T has no q_at_2_percent_Pa, q_at_5_percent_Pa, eps_v_at_2_percent"));
  std::istringstream predicted(bytes_of(here / "F/predictions.csv"));
  std::string line, truth = "x,q\n";
  std::getline(predicted, line);
  CHECK(line.starts_with("test,predicted,quantity,abscissa,x,measured,error,mean,"));
  while (std::getline(predicted, line)) {
    std::istringstream row(line);
    std::vector<std::string> cells;
    for (std::string cell; std::getline(row, cell, ',');) cells.push_back(cell);
    truth += cells.at(4) + "," + cells.at(7) + "\n";
  }
  here.write("truth.csv", truth);
  here.write("soil.toml",
             soil_by_features("\"material.young_modulus_Pa=0.5e9:8e9:log\", \"target.e_min=0.52:0.54\", "
                              "\"target.e_max=0.74:0.8\"",
                              "[[measured]]\nname = \"U\"\nprotocol = \"triaxial_undrained\"\npressure_Pa = 100e3\n"
                              "void_ratio = 0.8\npredict = true\ntargets = [\"q_at_1_percent_Pa=150e3+-20e3\"]\n"));
  here.succeeds("fit soil.toml --tests 30 -o G");
  const auto found = nlohmann::json::parse(bytes_of(here / "G/fit.json"));
  CHECK(found["parameters"][0]["low_95"].get<double>() <= 2e9);
  CHECK(found["parameters"][0]["high_95"].get<double>() >= 2e9);
  CHECK(found["parameters"][0]["high_95"].get<double>() < 7e9);
  // e_model = a + b e_sand passes the limits of both.
  const auto map = found["density_map"];
  const double a = map["intercept"]["mean"], b = map["slope"]["mean"];
  CHECK(a + 0.677 * b == Approx(found["parameters"][1]["mean"].get<double>()));
  CHECK(a + 1.054 * b == Approx(found["parameters"][2]["mean"].get<double>()));
  REQUIRE(found["features"].size() == 8);  // of T q at 0.1, 0.5, 1 %, E50, largest, last, strain at 95 %; and one of U
  for (const auto& each : found["features"])
    if (each["predicted"] == false) CHECK(std::abs(each["off_standard_errors"].get<double>()) < 3);
  const std::string csv = bytes_of(here / "G/features.csv");
  CHECK_THAT(csv, Contains("\nT,0,largest_q_Pa,") && Contains("\nU,1,q_at_1_percent_Pa,150000,20000,1,"));
  CHECK(!std::filesystem::exists(here / "G/curves.csv"));
  // A killed one goes on with the same bits.
  std::filesystem::remove(here / "G/tests/0007.json");
  std::filesystem::remove(here / "G/fit.json");
  here.succeeds("fit soil.toml --tests 30 -o G --resume --threads 2");
  CHECK(nlohmann::json::parse(bytes_of(here / "G/fit.json")) == found);
  here.refuses("fit soil.toml --set stage.compression.to_strain=0.0119", "beyond the end of the test");
  here.refuses("fit soil.toml --vary measured.X.target.void_ratio=0.5:0.6", "no such test to make");
  // What it takes is told after the first sets, long before the end.
  here.shell(std::string("'") + RVELAB_PROGRAM +
             "' fit soil.toml --tests 90000 --threads 1 >cost.out 2>cost.err & fit=$!\n"
             "for k in $(seq 600); do grep -q 'a set took' cost.err && break; sleep 0.1; done; kill $fit; wait $fit");
  CHECK_THAT(
      bytes_of(here / "cost.err"),
      Contains("90000 sets of parameters x 1 test, each on one of 2 specimens, then 4 predictions x 2 tests: about ") &&
          Contains(" on 1 thread, since a set took ") && Contains("for packing"));
}

TEST_CASE("A key of one test is varied for it alone") {
  const Workplace here;
  here.write("truth.csv", "x,q\n0,0\n0.001,40e3\n0.005,100e3\n0.012,120e3\n");
  // Of two tests alike one gets its own friction, and differs; the other stays as it is.
  const std::string other =
      "[[measured]]\nname = \"V\"\nprotocol = \"triaxial\"\npressure_Pa = 100e3\nvoid_ratio = 0.75\n"
      "curve = \"truth.csv\"\ncolumns = [\"axial_strain=x\", \"deviator_Pa=q\"]\n";
  here.write("soil.toml", soil_by_features("\"measured.V.material.friction=0.05:0.06\"", other));
  here.succeeds("fit soil.toml --tests 8 -o F");
  const auto test = nlohmann::json::parse(bytes_of(here / "F/tests/0001.json"));
  const auto last = [&](int made) { return test["compared"][made][3].get<double>(); };
  CHECK(last(1) < 0.8 * last(0));
}

TEST_CASE("Mistakes of a fit are told before any test") {
  Workplace place;
  const Workplace& here = with_two_packings(place);
  const std::string fit = "fit biaxial --specimen S_a.h5 ";
  here.refuses(fit + "--target friction_angle_deg=30", "nothing is varied");
  here.refuses(fit + "--vary material.friction=0.1:1", "no number of values");
  here.refuses(fit + "--target friction_angle_deg=30 --vary material.friction=0.1:1:5", "without a target");
  here.refuses(fit + "--target friction_angle_deg=30 --vary material.frction=0.1:1", "nearest", "material.friction");
  here.refuses(fit + "--target friction_angle_deg=30 --vary target.void_ratio=0.2:0.3", "--recipe");
  here.refuses("fit biaxial --vary material.friction=0.1:1 --target friction_angle_deg=30", "no specimen is given");
  here.refuses(fit + "--recipe pack_dense --vary material.friction=0.1:1 --target friction_angle_deg=30",
               "--recipe and --specimen are both given");
  here.refuses(
      "fit biaxial --recipe pack_dense --same-specimens --vary material.friction=0.1:1 --target "
      "friction_angle_deg=30",
      "--same-specimens is given with --recipe");
  here.refuses(fit + "--same-specimens --vary material.friction=0.1:1:5", "without a target");
  here.refuses(fit +
                   "--target q_at_5_percent_Pa=1e5 --set stage.compression.to_strain=0.03 --vary "
                   "material.friction=0.1:1",
               "q_at_5_percent_Pa lies beyond", "to_strain");
  here.refuses(fit + "--target angle=30 --vary material.friction=0.1:1", "the nearest is");
  here.refuses(fit + "--predict A --vary material.friction=0.1:1", "with a protocol");
  here.refuses(fit + "--column q_over_p --target friction_angle_deg=30 --vary material.friction=0.1:1",
               "--column is given without --curve");
  // A curve that no test of the protocol reaches, before a specimen is packed.
  here.write("far.csv", "axial_strain,q_over_p\n0.001,0.2\n0.02,0.5\n");
  const std::string far = " --recipe pack_dense --vary material.friction=0.1:1 --curve far.csv --set ";
  here.refuses(
      "fit biaxial --set pack.number=1000000 --set stage.compression.to_strain=0.012" + far + "test.pressure_Pa=2e4",
      "far.csv", "0.02", "0.008", "stage.compression.to_strain = 0.012");
  here.write("far.csv", "axial_stress_kPa,axial_strain\n50,0\n100,0.03\n");
  here.refuses("fit oedometer" + far + "test.pressure_Pa=5e4", "stage.large.to_strain");
  here.refuses("fit oedometer" + far + "stage.large.to_strain=0.04", "begins at a stress in Pa of 50000");
  here.refuses(fit + "--curve none.csv --vary material.friction=0.1:1", "none.csv: no such file");
}
