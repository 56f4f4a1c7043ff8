// The scripts of tools/plot on what the protocols give: figures where they make sense, else one line that says what
// they need.
#include "tests/cli/program.hpp"

using namespace rvelab::test;
using Catch::Matchers::Contains;

namespace {

Outcome plot(const Workplace& here, const std::string& script, const std::string& arguments) {
  return here.run("-B '" RVELAB_SOURCE_DIR "/tools/plot/" + script + ".py' " + arguments, "/usr/bin/python3");
}

/// A figure that is there, and words about it.
void expect_figure(const Workplace& here, const std::string& script, const std::string& file, const std::string& part) {
  const Outcome outcome = plot(here, script, file + " -o figure.png");
  CAPTURE(script, file, outcome.output, outcome.errors);
  CHECK(outcome.code == 0);
  CHECK(outcome.errors.empty());
  CHECK_THAT(outcome.output, Contains(part));
  CHECK(bytes_of(here / "figure.png").starts_with("\x89PNG"));
  std::filesystem::remove(here / "figure.png");
}

void expect_refusal(const Workplace& here, const std::string& script, const std::string& file,
                    const std::string& part) {
  const Outcome outcome = plot(here, script, file + " -o figure.png");
  CAPTURE(script, file, outcome.output, outcome.errors);
  CHECK(outcome.code == 2);
  CHECK(outcome.output.empty());
  CHECK(std::count(outcome.errors.begin(), outcome.errors.end(), '\n') == 1);
  CHECK(outcome.errors.starts_with(script + ".py: "));
  CHECK_THAT(outcome.errors, Contains(part));
  CHECK(!std::filesystem::exists(here / "figure.png"));
}

}  // namespace

TEST_CASE("every plot script draws what is its own and refuses the rest in one line") {
  const Workplace here;
  here.import_packing("dense_p20");
  const auto test = [&](const std::string& protocol, const std::string& file, const std::string& settings) {
    const Outcome outcome = here.run("run " + protocol + " --specimen S.h5 -o " + file + " " + settings);
    INFO(outcome.errors);
    REQUIRE(outcome.code == 0);
  };
  test("biaxial", "compression.h5", "--set stage.compression.to_strain=0.03");
  test("biaxial", "rising.h5", "--set stage.compression.to_strain=0.003");
  test("biaxial_extension", "extension.h5", "--set stage.compression.to_strain=-0.04");
  test("simple_shear", "shear.h5", "--set stage.shear.to_strain=0.02");
  test("cyclic_shear", "cyclic.h5", "--set stage.cycles.cycles=2 --set test.pressure_Pa=20e3");
  test("oedometer", "oedometer.h5", "--set test.pressure_Pa=20e3 --set stage.large.to_strain=0.002");
  test("isotropic_compression", "isotropic.h5", "--set stage.compression.records_per_point=1");
  test("envelope", "envelope.h5", "--set test.pressure_Pa=20e3");
  test("probe", "probe.h5", "--set test.pressure_Pa=20e3 --set stage.probe.method=linear");

  expect_figure(here, "stress_strain", "compression.h5", "Biaxial compression: 1 stage");
  expect_figure(here, "stress_strain", "extension.h5", "Biaxial extension: 1 stage");
  expect_figure(here, "stress_strain", "shear.h5", "Simple shear at constant volume: 1 stage");
  expect_figure(here, "stress_strain", "oedometer.h5", "Oedometer: 2 stages");
  expect_refusal(here, "stress_strain", "cyclic.h5", "loops.py");
  expect_refusal(here, "stress_strain", "isotropic.h5", "e_log_p.py");
  expect_figure(here, "mohr", "compression.h5", "peak friction angle 32.");
  expect_figure(here, "mohr", "extension.h5", "peak friction angle 3");
  expect_refusal(here, "mohr", "rising.h5", "still rising at the end (0.3 % strain): no peak");
  expect_figure(here, "mohr", "compression.h5 rising.h5", "warning: not drawn: rising.h5: still rising at the end");
  expect_refusal(here, "mohr", "shear.h5", "biaxial, triaxial");
  expect_refusal(here, "mohr", "compression.h5 cyclic.h5", "cyclic.h5");
  expect_figure(here, "loops", "cyclic.h5", "2.0 cycles");
  expect_refusal(here, "loops", "compression.h5", "monotonic");
  expect_figure(here, "e_log_p", "isotropic.h5", "recompression");
  expect_figure(here, "e_log_p", "oedometer.h5", "large");
  expect_refusal(here, "e_log_p", "compression.h5", "isotropic_compression or oedometer");
  expect_figure(here, "envelope", "envelope.h5", "2 envelopes");
  expect_refusal(here, "envelope", "compression.h5", "envelope.toml");
  expect_refusal(here, "mu_I", "shear.h5", "quasi-static");
  expect_refusal(here, "mu_I", "compression.h5", "no simple shear");
  for (const char* script : {"stress_path", "fabric", "volumetric"}) {
    expect_figure(here, script, "compression.h5", "1 stage");
    expect_figure(here, script, "cyclic.h5", "1 stage");
    expect_figure(here, script, "oedometer.h5", "2 stages");
    expect_refusal(here, script, "probe.h5", "holds no records");
    expect_refusal(here, script, "S.h5", "not a record file");
    expect_refusal(here, script, "none.h5", "none.h5");
  }
}

TEST_CASE("loops.py counts cycles by the strain travelled, a quarter to the first turn") {
  const Workplace here;
  const Outcome outcome = here.run(
      "-B -c 'import sys; sys.path.insert(0, \"" RVELAB_SOURCE_DIR
      "/tools/plot\"); import loops, numpy; "
      "print(*loops.cycles_of(numpy.array([0, 2, 4, 0, -4, -1, 4, 1])), *loops.cycles_of(numpy.array([0, 4, 0])))'",
      "/usr/bin/python3");
  INFO(outcome.errors);
  CHECK(outcome.output == "0.0 0.125 0.25 0.5 0.75 0.9375 1.25 1.4375 0.0 0.25 0.5\n");
}

TEST_CASE("mpm.py draws any column of a history, and names the columns, frames and limits that it takes") {
  const Workplace here;
  std::filesystem::create_directory(here / "run");
  here.write("run/history.csv",
             "time_s,steps,kinetic_J,plate.force_y_N,plate.displacement_y_m,plate.displacement_x_m\n0,0,0,0,0,0\n1,9,2,1e3,-0.1,0.2\n");
  const std::string force = "run --force plate.force_y";
  expect_figure(here, "mpm", force + " --against plate.displacement_y", "plate.force_y_N against plate.displacement_y_m");
  expect_figure(here, "mpm", force + "_N --against plate.displacement_x_m", "plate.force_y_N against plate.displacement_x_m");
  expect_figure(here, "mpm", "run --force kinetic --against time", "kinetic_J against time_s");
  expect_figure(here, "mpm", "run --force kinetic_J", "kinetic_J against time_s");
  const auto refused = [&](const std::string& arguments, const std::string& part) {
    const Outcome outcome = plot(here, "mpm", arguments + " -o figure.png");
    CAPTURE(arguments, outcome.errors);
    CHECK(outcome.code == 2);
    CHECK_THAT(outcome.errors, Contains(part));
  };
  refused("run --force kinetik", "no column kinetik; it has time_s, steps, kinetic_J");
  refused("run --field eps_q --limits 2 1", "LOW below HIGH");
  here.write("run/points_0000.h5", "");
  refused("run --field eps_q --frame 300", "--frame 300: run has 1 frames; allowed: 0 to 0");
}

TEST_CASE("the friction angle that mohr.py draws is the one that run prints, in compression and in extension") {
  const Workplace here;
  here.import_packing("dense_p20");
  for (const std::string test : {"biaxial --set stage.compression.to_strain=0.03",
                                 "biaxial_extension --set stage.compression.to_strain=-0.04"}) {
    CAPTURE(test);
    const Outcome run = here.run("run " + test + " --specimen S.h5 -o R.h5 --force --json");
    REQUIRE(run.code == 0);
    const std::string key = "\"peak_friction_angle_deg\": ";
    const double printed = std::stod(run.output.substr(run.output.find(key) + key.size()));
    CHECK(printed > 25);
    const std::string drawn = plot(here, "mohr", "R.h5 -o R.png").output, words = "peak friction angle ";
    REQUIRE(drawn.find(words) != std::string::npos);
    CHECK(std::stod(drawn.substr(drawn.find(words) + words.size())) == Approx(printed).margin(6e-4));
  }
}

TEST_CASE("a plot script without its Python packages names the Debian package, exit code 1") {
  const Workplace here;
  for (const auto& entry : std::filesystem::directory_iterator(RVELAB_SOURCE_DIR "/tools/plot")) {
    const std::string script = entry.path().stem().string();
    if (entry.path().extension() != ".py" || script == "records" || script == "state") continue;
    CAPTURE(script);
    // Without the site packages of Debian.
    const Outcome outcome =
        here.run("-S -B '" RVELAB_SOURCE_DIR "/tools/plot/" + script + ".py' R.h5 -o R.png", "/usr/bin/python3");
    CHECK(outcome.code == 1);
    CHECK(std::count(outcome.errors.begin(), outcome.errors.end(), '\n') == 1);
    CHECK_THAT(outcome.errors, Contains(script + ".py: ") && Contains("apt-get install python3-"));
  }
}
