// The scripts of tools/plot on what the protocols give: figures where they make sense, else one line that says what
// they need.
#include <nlohmann/json.hpp>

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
  test("biaxial", "network.h5",
       "--set stage.compression.to_strain=0.01 --set 'output.quantities=[\"a_c\",\"a_n\",\"a_t\",\"a_l\","
       "\"stress_force_fabric\",\"strong_contacts\",\"strong_deviator\"]'");
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
  expect_figure(here, "stiffness", "cyclic.h5", "1 loop, G_max");
  expect_refusal(here, "stiffness", "compression.h5", "no whole loop");
  expect_figure(here, "stress_force_fabric", "network.h5", "q/p of force and fabric within 0.0");
  expect_refusal(here, "stress_force_fabric", "compression.h5", "[output] quantities");
  expect_figure(here, "e_log_p", "isotropic.h5", "recompression index C_r");
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

namespace {

/// What a line of Python prints that has the scripts as modules.
std::string printed_by(const Workplace& here, const std::string& line) {
  here.write("line.py", "import sys; sys.path.insert(0, '" RVELAB_SOURCE_DIR "/tools/plot')\n" + line);
  const Outcome outcome = here.run("-B line.py", "/usr/bin/python3");
  CAPTURE(line, outcome.errors);
  CHECK(outcome.code == 0);
  return outcome.output;
}

}  // namespace

TEST_CASE("e_log_p.py finds the indices of a path of straight parts, and where first loading bends") {
  const Workplace here;
  // First loading 10 to 100 kPa by 0.05 and on to 1600 by 0.30, swelling to 100 by 0.04, reloading to 1600 by 0.06.
  const std::string path =
      "import numpy as np, e_log_p\n"
      "x = np.concatenate([np.linspace(1, 3.2, 23), np.linspace(3.2, 2, 13), np.linspace(2, 3.2, 13)[1:]])\n"
      "e = np.concatenate([1 - 0.05 * (x[:23] - 1) - 0.25 * np.maximum(x[:23] - 2, 0), np.zeros(25)])\n"
      "e[23:36] = e[22] + 0.04 * (3.2 - x[23:36])\n"
      "e[36:] = e[35] - 0.06 * (x[36:] - 2)\n"
      "for fit in e_log_p.fits_of(1e3 * 10 ** x, e): print(fit[0], *('%.4f' % v for v in fit[1:3]), '%.3g' % fit[4])\n";
  CHECK(printed_by(here, path) == "C_c 0.3000 0.0000 1e+05\nC_s 0.0400 0.0000 1.58e+06\nC_r 0.0600 0.0000 1e+05\n");
  // A straight path has no bend; one within the tolerance of a held stress does not turn.
  CHECK(printed_by(here,
                   "import numpy as np, e_log_p\nx = np.linspace(4, 5, 20)\n"
                   "p = 10 ** x * (1 + 1e-3 * (-1) ** np.arange(20))\n"
                   "print(*('%s %.3f' % fit[:2] for fit in e_log_p.fits_of(p, 1 - 0.2 * np.log10(p))))\n") ==
        "C_c 0.200\n");
}

TEST_CASE("stiffness.py has the loops that rvelab measure has, of the smallest amplitudes too") {
  const Workplace here;
  here.import_packing("dense_p20");
  for (const char* amplitude : {"1e-5", "2e-3"}) {
    REQUIRE(here.run("run cyclic_shear --specimen S.h5 -o C.h5 --force --set test.pressure_Pa=20e3 --set "
                     "stage.cycles.cycles=3 --set stage.cycles.to_strain=" +
                     std::string(amplitude) +
                     " --set stage.cycles.record_every=" + (amplitude[0] == '1' ? "2e-7" : "4e-5"))
                .code == 0);
    const auto measured = nlohmann::json::parse(here.run("measure C.h5 --json").output).at("loops");
    const auto drawn = nlohmann::json::parse(
        printed_by(here,
                   "import json, records, stiffness\nstage, = records.read_driven_stages(['C.h5'])\n"
                   "print(json.dumps(stiffness.loops_of(stage).tolist()))\n"));
    CAPTURE(amplitude);
    REQUIRE(drawn.size() == measured.size());
    REQUIRE(drawn.size() == 2);
    for (std::size_t k = 0; k < 2; ++k) {
      CHECK(drawn[k][0].get<double>() == Approx(measured[k].at("gamma").get<double>()));
      CHECK(drawn[k][1].get<double>() == Approx(measured[k].at("G_Pa").get<double>()));
      CHECK(drawn[k][2].get<double>() == Approx(measured[k].at("damping_ratio").get<double>()).margin(1e-9));
    }
  }
}

TEST_CASE("tests that differ by their specimen alone are one curve, the mean with their standard deviation") {
  const Workplace here;
  REQUIRE(here.run("pack pack_dense -o S.h5 --count 2 --set pack.number=36 --set target.void_ratio=0.2").code == 0);
  const auto test = [&](const std::string& output, const std::string& more) {
    const Outcome outcome =
        here.run("run biaxial --set stage.compression.to_strain=0.02 -o " + output + ".h5 --specimen " + more);
    INFO(outcome.errors);
    REQUIRE(outcome.code == 0);
  };
  for (const std::string number : {"1", "2"}) {
    test("low_" + number, "S_" + number + ".h5 --set test.pressure_Pa=20e3");
    test("high_" + number, "S_" + number + ".h5 --set test.pressure_Pa=40e3");
  }
  test("slippery", "S_1.h5 --set test.pressure_Pa=20e3 --set material.friction=0.1");
  CHECK(
      printed_by(here,
                 "import curves, records, numpy as np\n"
                 "found = curves.curves_of(records.read_driven_stages(['.']))\n"
                 "for c in found: print(sorted(s.path.stem for s in c.stages), c.label)\n"
                 "c = [c for c in found if len(c.stages) == 2][0]\n"
                 "x, mean, deviation = c.mean(lambda stage: stage.volumetric_strain)\n"
                 "a, b = (np.interp(x, s.strain, s.volumetric_strain) for s in c.stages)\n"
                 "print(abs(mean - (a + b) / 2).max() < 1e-15, abs(deviation - abs(a - b) / 2 ** 0.5).max() < 1e-15,\n"
                 "      abs(a - b).max() > 1e-5)\n") ==
      "['low_1', 'low_2'] low_1, 20 kPa (n = 2)\n"
      "['slippery'] slippery, 20 kPa\n"
      "['high_1', 'high_2'] 40 kPa (n = 2)\n"
      "True True True\n");
  // Of each pressure one entry in the legend of Mohr's circles, however many specimens; the interval is Student's.
  const Outcome mohr = plot(here, "mohr", "low_1.h5 low_2.h5 high_1.h5 high_2.h5 -o mohr.svg");
  INFO(mohr.errors);
  CHECK_THAT(mohr.output, Contains(" degrees (mean of 2 specimens and its 95 % interval)"));
  // Circles through one lateral stress have no envelope but that through the origin.
  const Outcome one_pressure = plot(here, "mohr", "low_1.h5 low_2.h5 -o mohr.svg");
  INFO(one_pressure.errors);
  CHECK_THAT(one_pressure.output,
             Contains("peak friction angle ") && Contains("mean of 2 specimens") && !Contains("cohesion"));
  CHECK_THAT(bytes_of(here / "mohr.svg"), Contains("<svg"));
  CHECK(plot(here, "mohr", "low_1.h5 -o mohr.pdf").code == 0);
  CHECK(bytes_of(here / "mohr.pdf").starts_with("%PDF"));
  // Quantiles of the printed tables: 1, 10, 20 and 60 degrees of freedom.
  CHECK(printed_by(here, "import mohr\nprint(*('%.3f' % mohr.student(n) for n in (1, 10, 20, 60)))\n") ==
        "12.706 2.228 2.086 2.000\n");
}

TEST_CASE("a logarithmic axis has four numbers or more, and no two that touch") {
  const Workplace here;
  CHECK(printed_by(
            here,
            "import math, curves\n"
            "for low, high in ((1, 1.55), (0.36, 0.72), (0.0025, 0.011), (0.055, 0.21), (0.3, 6), (10, 2000), (1e-5, "
            "3)):\n"
            "    subs = curves.ticks_of_decade(low, high)\n"
            "    ticks = sorted(s * 10.0 ** k for s in subs for k in range(-7, 6) if low <= s * 10.0 ** k <= high)\n"
            "    near = min(math.log(b / a) for a, b in zip(ticks, ticks[1:])) / math.log(high / low)\n"
            "    print(4 <= len(ticks) <= 10 and near > 0.05)\n") == "True\nTrue\nTrue\nTrue\nTrue\nTrue\nTrue\n");
}

TEST_CASE("numbers in figures have the digits that their error leaves, and no exponent where it can be read without") {
  const Workplace here;
  CHECK(printed_by(
            here,
            "from records import plain, with_error\n"
            "print(plain(1600.4), plain(99950), plain(0.18736), plain(20000), plain(2.5e7), plain(0), plain(1e-7))\n"
            "print(with_error(0.04483, 0.0036), with_error(37.62, 6.41), with_error(1234.5, 56), with_error(2.345, "
            "0))\n") == "1600 100000 0.187 20000 2.5e+07 0 1e-07\n0.0448 +- 0.0036 37.6 +- 6.4 1234 +- 56 2.35\n");
}

TEST_CASE("of a test at constant volume stress_strain.py draws the mean stress, else the volumetric strain") {
  const Workplace here;
  here.import_packing("dense_p20");
  for (const auto& [test, words] : {std::pair{"biaxial_undrained --set test.pressure_Pa=20e3", "at constant volume"},
                                    std::pair{"biaxial", "dilation negative"}}) {
    const std::string run =
        std::string("run ") + test + " --specimen S.h5 -o R.h5 --force --set stage.compression.to_strain=0.005";
    REQUIRE(here.run(run).code == 0);
    const std::string line =
        "import matplotlib; matplotlib.rcParams['svg.fonttype'] = 'none'\n"
        "import sys; sys.argv = ['stress_strain.py', 'R.h5', '-o', 'R.svg']\n"
        "import runpy; runpy.run_path('" RVELAB_SOURCE_DIR "/tools/plot/stress_strain.py', run_name='__main__')\n";
    printed_by(here, line);
    CHECK_THAT(bytes_of(here / "R.svg"), Contains(words));
  }
}

TEST_CASE("stages that go on driving one strain are one curve") {
  const Workplace here;
  here.import_packing("dense_p20");
  const Outcome outcome =
      here.run("run oedometer --specimen S.h5 -o R.h5 --set test.pressure_Pa=20e3 --set stage.large.to_strain=0.002");
  REQUIRE(outcome.code == 0);
  // In an oedometer the volumetric strain is the axial strain, over both stages together.
  CHECK(printed_by(here,
                   "import curves, records\n"
                   "stages = records.read_driven_stages(['R.h5'])\n"
                   "one, = curves.joined(stages)\n"
                   "print(len(stages), len(one.strain) == sum(len(s.strain) for s in stages), one.parts,\n"
                   "      abs(one.strain - one.volumetric_strain).max() < 1e-12, '%.6f' % one.strain[-1])\n") ==
        "2 True [" + std::to_string(11) + "] True 0.002010\n");
}

TEST_CASE("a logarithmic axis stands zeros, negative values and a single decade") {
  const Workplace here;
  CHECK(
      printed_by(here,
                 "import records, curves, matplotlib.pyplot as plt\n"
                 "figure, axes = plt.subplots()\n"
                 "curves.log_axis(axes.xaxis, [-5, 0, float('nan'), 20, 60])\n"
                 "axes.plot([-5, 0, 20, 60], [1, 2, 3, 4])\n"
                 "figure.canvas.draw()\n"
                 "low, high = axes.get_xlim()\n"
                 "ticks = [float(t.get_text()) for t in axes.get_xticklabels() if t.get_text()]\n"
                 "print(axes.get_xscale(), 15 < low < 20, 60 < high < 80, sum(low <= t <= high for t in ticks) >= 3)\n"
                 "try: curves.log_axis(axes.xaxis, [0, -1])\n"
                 "except ValueError as error: print(error)\n") ==
      "log True True True\nno value above 0 for a logarithmic axis; give records with a pressure above 0\n");
}

TEST_CASE("chains.py and rose.py draw the states of several files, and of all files in a folder") {
  const Workplace here;
  std::filesystem::create_directory(here / "all");
  std::filesystem::create_directory(here / "none");
  here.import_packing("dense_p20", "all/dense.h5");
  here.import_packing("soft_p20", "all/soft.h5");
  REQUIRE(
      here.run("run biaxial --specimen all/dense.h5 -o all/ended.h5 --set stage.compression.to_strain=0.001").code ==
      0);
  const auto contacts = [&](const std::string& file) {
    const auto found = nlohmann::json::parse(here.run("inspect " + file + " --json").output);
    return std::to_string(found.at("contacts").get<int>()) + " contacts, ";
  };
  const std::string dense = contacts("all/dense.h5"), soft = contacts("all/soft.h5");
  expect_figure(here, "chains", "all/dense.h5", "figure.png: " + dense);
  expect_figure(here, "chains", "all/dense.h5 all/soft.h5", "dense.h5: " + dense);
  expect_figure(here, "chains", "all", "dense.h5: " + dense);
  expect_figure(here, "chains", "all", "; ended.h5: ");
  expect_figure(here, "chains", "all", "; soft.h5: " + soft);
  expect_figure(here, "rose", "all --together", "figure.png: ");
  for (const char* script : {"chains", "rose"}) expect_refusal(here, script, "none", "none: no *.h5 there");
}

TEST_CASE("a film has a frame for each snapshot and the end, and says how to get snapshots") {
  const Workplace here;
  here.import_packing("dense_p20");
  REQUIRE(here.run("run biaxial --specimen S.h5 -o R.h5 --set stage.compression.to_strain=0.002 --set "
                   "output.snapshots_every=2")
              .code == 0);
  // Records 0 to 4 at every 0.05 %: snapshots 0, 2 and 4, which is the end.
  const Outcome outcome = plot(here, "film", "R.h5 -o R.gif --field p");
  INFO(outcome.errors);
  CHECK_THAT(outcome.output, Contains("R.gif: 3 frames of p"));
  CHECK(printed_by(here, "from PIL import Image\nprint(Image.open('R.gif').n_frames)\n") == "3\n");
  const auto refused = [&](const std::string& arguments, const std::string& part) {
    const Outcome wrong = plot(here, "film", arguments);
    CAPTURE(arguments, wrong.errors);
    CHECK(wrong.code == 2);
    CHECK_THAT(wrong.errors, Contains(part));
  };
  refused("S.h5 -o S.gif", "output.snapshots_every=10");
  refused("R.h5 -o R.png", "allowed: *.mp4, *.gif");
  refused("R.h5 -o R.gif --field eps_q", "allowed: chains, p");
}

TEST_CASE("fit.py draws posteriors over the data that were fitted, and sweeps") {
  const Workplace here;
  std::filesystem::create_directory(here / "fit");
  std::filesystem::create_directory(here / "sweep");
  here.write("fit/fit.json", R"({"parameters": [{"key": "material.friction", "range": [0.1, 1], "mean": 0.5,
      "standard_deviation": 0.05, "low_95": 0.4, "high_95": 0.6}], "tests": [{"values": {"material.friction": 0.3}}],
      "posterior_sample": {"material.friction": [0.4, 0.45, 0.5, 0.55, 0.6]}, "targets": [
      {"name": "friction_angle_deg", "value": 30, "standard_error": 0.5, "fit": {"mean": 31, "standard_deviation": 1}},
      {"name": "q_over_p", "value": 0.5, "standard_error": 0, "of_curve": true, "fit": {"mean": 0.5, "standard_deviation": 0.1}},
      {"name": "q_over_p", "value": 0.6, "standard_error": 0, "of_curve": true, "fit": {"mean": 0.6, "standard_deviation": 0.1}}]})");
  here.write(
      "fit/curves.csv",
      "curve,pressure_Pa,quantity,abscissa,x,measured,error,fit,low_95,high_95\n"
      "1,100000,q_over_p,strain,0.01,0.5,0.02,0.5,0.4,0.6\n1,100000,q_over_p,strain,0.02,0.6,0.02,0.6,0.5,0.7\n");
  here.write("sweep/sweep.csv",
             "material.friction,friction_angle_deg,friction_angle_deg_standard_error,friction_angle_deg_n\n"
             "0.1,20,0.5,5\n0.5,30,0.5,5\n");
  expect_figure(here, "fit", "fit", "material.friction 0.50 (0.40 to 0.60); 1 tests");
  expect_figure(here, "fit", "sweep", "1 measure against material.friction, 2 points");
  here.write("fit/predictions.csv",
             "test,predicted,quantity,abscissa,x,measured,error,mean,standard_deviation,n\n"
             "A,0,deviator,strain,0.01,5e4,2e3,5.1e4,3e3,8\nA,0,deviator,strain,0.02,6e4,2e3,6.2e4,3e3,8\n"
             "B,1,strain,axial_stress,1e4,0,2e-3,0,0,8\nB,1,strain,axial_stress,1e5,1e-2,2e-3,1.1e-2,1e-3,8\n");
  expect_figure(here, "fit", "fit", "material.friction 0.50 (0.40 to 0.60); 1 tests");
  std::filesystem::remove(here / "fit/fit.json");
  expect_refusal(here, "fit", "fit", "fit.json: is not there");
  here.write("fit/fit.json", "{}");
  expect_refusal(here, "fit", "fit", "not the fit.json of rvelab");
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
             "time_s,steps,kinetic_J,plate.force_y_N,plate.displacement_y_m,plate.displacement_x_m\n0,0,0,0,0,0\n1,9,2,"
             "1e3,-0.1,0.2\n");
  const std::string force = "run --force plate.force_y";
  expect_figure(here, "mpm", force + " --against plate.displacement_y",
                "plate.force_y_N against plate.displacement_y_m");
  expect_figure(here, "mpm", force + "_N --against plate.displacement_x_m",
                "plate.force_y_N against plate.displacement_x_m");
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

TEST_CASE("mpm.py draws how far rocks are ahead of the soil and above it, by classes of size") {
  const Workplace here;
  std::filesystem::create_directory(here / "run");
  // Soil of volumes 1 and 3 at the start at x = 0 and 4: its middle is 3; rocks of 0.1 and 0.2 m at 3 and 5.
  here.write("frames.py", R"(import h5py, numpy as np
for frame, up in ((0, 1.0), (1, 2.0)):
    with h5py.File(f"run/points_{frame:04}.h5", "w") as f:
        f["position_m"] = np.array([[0.0, 0, 0], [4, 0, 0]])
        f["deformation_gradient"] = np.array([np.diag([2.0, 1, 0]).ravel(), np.diag([1.0, 1, 0]).ravel()])
        f["volume_m3"] = np.array([2.0, 3])
    with h5py.File(f"run/rocks_{frame:04}.h5", "w") as f:
        f["position_m"] = np.array([[3, up, 0], [5, 0, 0]])
        f["radius_m"], f["mass_kg"], f["time_s"] = np.array([0.1, 0.2]), np.array([1.0, 8]), np.array([frame * 0.5])
)");
  REQUIRE(here.run("frames.py", "/usr/bin/python3").code == 0);
  expect_figure(here, "mpm", "run --segregation",
                "smaller rocks, 200 mm: +0 m along x, +2 m up; larger rocks, 400 mm: +2 m along x, +0 m up");
  std::filesystem::remove(here / "run/rocks_0001.h5");
  const Outcome outcome = plot(here, "mpm", "run --segregation -o figure.png");
  CHECK(outcome.code == 2);
  CHECK_THAT(outcome.errors, Contains("segregation is of runs with [[rock]] or [[rocks]]"));
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
    CHECK(std::stod(drawn.substr(drawn.find(words) + words.size())) == Approx(printed).margin(0.051));
  }
}

TEST_CASE("of grains that stick mohr.py draws the envelope with a cohesion, as calibrate tells it") {
  const Workplace here;
  here.import_packing("dense_p20");
  const std::string brief =
      "calibrate biaxial --specimen S.h5 --pressures 10e3,20e3,40e3 --set stage.compression.to_strain=0.02 --json "
      "--set contact.law=linear_adhesive --set material.adhesion_Pa=";
  for (const char* adhesion : {"5e4", "0"}) {
    CAPTURE(adhesion);
    const std::string folder = std::string("K") + adhesion;
    const Outcome run = here.run(brief + adhesion + " -o " + folder);
    REQUIRE(run.code == 0);
    const auto found = nlohmann::json::parse(run.output);
    const std::string drawn = plot(here, "mohr", folder + " -o M.png").output;
    CAPTURE(drawn);
    const auto number_after = [&](const std::string& words) {
      const std::size_t at = drawn.find(words);
      return at == std::string::npos ? -1 : std::stod(drawn.substr(at + words.size()));
    };
    CHECK(number_after("peak friction angle ") == Approx(found["friction_angle_deg"].get<double>()).margin(0.051));
    if (found["cohesive"].get<bool>())
      CHECK(number_after("cohesion ") == Approx(found["cohesion_Pa"].get<double>()).margin(1));
    else
      CHECK(number_after("cohesion ") == -1);
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
