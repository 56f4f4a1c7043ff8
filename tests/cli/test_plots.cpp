// The scripts of tools/plot on what the protocols give: figures where they make sense, else one line that says what
// they need. (Their functions: tests/adapters/test_plot_functions.py.)
#include "tests/program.hpp"

using namespace rvelab::test;
using Catch::Matchers::Contains;

namespace {

enum Answer { draws, refuses };

/// A script with the words of its command line (-o figure.png where they name no output), and a part of what it says.
struct Drawing {
  std::string script, words;
  Answer answer;
  std::string part;
};

/// What the scripts say, one after the other in one interpreter. A figure is there, with words about it; a refusal is
/// one line, and nothing is there.
std::vector<std::string> expect(const Workplace& here, const std::vector<Drawing>& drawings) {
  auto commands = nlohmann::json::array();
  std::vector<std::string> files, said;
  for (const Drawing& each : drawings) {
    const auto output = each.words.find("-o ");
    const bool named = output != std::string::npos;
    files.push_back(named ? each.words.substr(output + 3, each.words.find(' ', output + 3) - output - 3)
                          : "figure_" + std::to_string(files.size()) + ".png");
    commands.push_back({each.script, each.words + (named ? "" : " -o " + files.back())});
  }
  here.write("commands.json", commands.dump());
  const std::string run = here.succeeds("-B '" RVELAB_SOURCE_DIR "/tests/cli/run_plots.py' '" RVELAB_SOURCE_DIR
                                        "/tools/plot' commands.json",
                                        "/usr/bin/python3");
  const auto outcomes = nlohmann::json::parse(run);
  REQUIRE(outcomes.size() == drawings.size());
  for (std::size_t k = 0; k < drawings.size(); ++k) {
    const Drawing& each = drawings[k];
    const std::string output = outcomes[k][1], errors = outcomes[k][2];
    CAPTURE(each.script, each.words, output, errors);
    CHECK(outcomes[k][0] == (each.answer == draws ? 0 : 2));
    CHECK((each.answer == draws ? errors : output).empty());
    CHECK_THAT(output + errors, Contains(each.part));
    CHECK(std::filesystem::exists(here / files[k]) == (each.answer == draws));
    if (each.answer == refuses && !errors.starts_with("usage: ")) {  // mpm.py tells its options first
      CHECK(std::count(errors.begin(), errors.end(), '\n') == 1);
      CHECK(errors.starts_with(each.script + ".py: "));
    } else if (each.answer == draws && files[k].ends_with(".png")) {
      CHECK(bytes_of(here / files[k]).starts_with("\x89PNG"));
    }
    said.push_back(output);
  }
  return said;
}

/// What a line of Python prints that has the scripts as modules.
std::string printed_by(const Workplace& here, const std::string& line) {
  here.write("line.py", "import sys; sys.path.insert(0, '" RVELAB_SOURCE_DIR "/tools/plot')\n" + line);
  return here.succeeds("-B line.py", "/usr/bin/python3");
}

const std::string angle = "peak friction angle ";

double number_after(const std::string& words, const std::string& text) {
  const std::size_t at = text.find(words);
  REQUIRE(at != std::string::npos);
  return std::stod(text.substr(at + words.size()));
}

}  // namespace

TEST_CASE("every plot script draws what is its own and refuses the rest in one line") {
  const Workplace here;
  here.import_packing("dense_p20");
  const auto test = [&](const std::string& protocol, const std::string& file, const std::string& settings) {
    here.succeeds("run " + protocol + " --specimen S.h5 -o " + file + " " + settings);
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

  std::vector<Drawing> drawings{
      {"stress_strain", "compression.h5", draws, "Biaxial compression: 1 stage"},
      {"stress_strain", "extension.h5", draws, "Biaxial extension: 1 stage"},
      {"stress_strain", "shear.h5", draws, "Simple shear at constant volume: 1 stage"},
      {"stress_strain", "oedometer.h5", draws, "Oedometer: 2 stages"},
      {"stress_strain", "cyclic.h5", refuses, "loops.py"},
      {"stress_strain", "isotropic.h5", refuses, "e_log_p.py"},
      {"mohr", "compression.h5", draws, "peak friction angle 32."},
      {"mohr", "extension.h5", draws, "peak friction angle 3"},
      {"mohr", "rising.h5", refuses, "still rising at the end (0.3 % strain): no peak"},
      {"mohr", "compression.h5 rising.h5", draws, "warning: not drawn: rising.h5: still rising at the end"},
      {"mohr", "shear.h5", refuses, "biaxial, triaxial"},
      {"mohr", "compression.h5 cyclic.h5", refuses, "cyclic.h5"},
      {"loops", "cyclic.h5", draws, "2.0 cycles"},
      {"loops", "compression.h5", refuses, "monotonic"},
      {"stiffness", "cyclic.h5", draws, "1 loop, G_max"},
      {"stiffness", "compression.h5", refuses, "no whole loop"},
      {"stress_force_fabric", "network.h5", draws, "q/p of force and fabric within 0.0"},
      {"stress_force_fabric", "compression.h5", refuses, "[output] quantities"},
      {"e_log_p", "isotropic.h5", draws, "recompression index C_r"},
      {"e_log_p", "oedometer.h5", draws, "large"},
      {"e_log_p", "compression.h5", refuses, "isotropic_compression or oedometer"},
      {"envelope", "envelope.h5", draws, "2 envelopes"},
      {"envelope", "compression.h5", refuses, "envelope.toml"},
      {"mu_I", "shear.h5", refuses, "quasi-static"},
      {"mu_I", "compression.h5", refuses, "no simple shear"}};
  for (const char* script : {"stress_path", "fabric", "volumetric"})
    drawings.insert(drawings.end(), {{script, "compression.h5", draws, "1 stage"},
                                     {script, "cyclic.h5", draws, "1 stage"},
                                     {script, "oedometer.h5", draws, "2 stages"},
                                     {script, "probe.h5", refuses, "holds no records"},
                                     {script, "S.h5", refuses, "not a record file"},
                                     {script, "none.h5", refuses, "none.h5"}});
  expect(here, drawings);
}

TEST_CASE("stiffness.py has the loops that rvelab measure has, of the smallest amplitudes too") {
  const Workplace here;
  here.import_packing("dense_p20");
  for (const char* amplitude : {"1e-5", "2e-3"}) {
    here.succeeds(
        "run cyclic_shear --specimen S.h5 -o C.h5 --force --set test.pressure_Pa=20e3 --set "
        "stage.cycles.cycles=3 --set stage.cycles.to_strain=" +
        std::string(amplitude) + " --set stage.cycles.record_every=" + (amplitude[0] == '1' ? "2e-7" : "4e-5"));
    const auto measured = here.json("measure C.h5").at("loops");
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
  here.succeeds("pack pack_dense -o S.h5 --count 2 --set pack.number=36 --set target.void_ratio=0.2");
  const auto test = [&](const std::string& output, const std::string& more) {
    here.succeeds("run biaxial --set stage.compression.to_strain=0.02 -o " + output + ".h5 --specimen " + more);
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
  // Of several specimens the mean and its interval; circles through one lateral stress have no envelope but that
  // through the origin.
  const auto said = expect(here, {{"mohr", "low_1.h5 low_2.h5 high_1.h5 high_2.h5", draws, "mean of 2 specimens"},
                                  {"mohr", "low_1.h5 low_2.h5 -o mohr.svg", draws, angle},
                                  {"mohr", "low_1.h5 -o mohr.pdf", draws, angle}});
  CHECK_THAT(said[0], Contains("interval"));
  CHECK_THAT(said[1], Contains("mean of 2 specimens") && !Contains("cohesion"));
  CHECK_THAT(bytes_of(here / "mohr.svg"), Contains("<svg"));
  CHECK(bytes_of(here / "mohr.pdf").starts_with("%PDF"));
}

TEST_CASE("of a test at constant volume stress_strain.py draws the mean stress, else the volumetric strain") {
  const Workplace here;
  here.import_packing("dense_p20");
  for (const auto& [test, words] : {std::pair{"biaxial_undrained --set test.pressure_Pa=20e3", "at constant volume"},
                                    std::pair{"biaxial", "dilation negative"}}) {
    const std::string run =
        std::string("run ") + test + " --specimen S.h5 -o R.h5 --force --set stage.compression.to_strain=0.005";
    here.succeeds(run);
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
  here.succeeds("run oedometer --specimen S.h5 -o R.h5 --set test.pressure_Pa=20e3 --set stage.large.to_strain=0.002");
  // In an oedometer the volumetric strain is the axial strain, over both stages together.
  CHECK(printed_by(here,
                   "import curves, records\n"
                   "stages = records.read_driven_stages(['R.h5'])\n"
                   "one, = curves.joined(stages)\n"
                   "print(len(stages), len(one.strain) == sum(len(s.strain) for s in stages), one.parts,\n"
                   "      abs(one.strain - one.volumetric_strain).max() < 1e-12, '%.6f' % one.strain[-1])\n") ==
        "2 True [11] True 0.002010\n");
}

TEST_CASE("chains.py and rose.py draw the states of several files, and of all files in a folder") {
  const Workplace here;
  std::filesystem::create_directory(here / "all");
  std::filesystem::create_directory(here / "none");
  here.import_packing("dense_p20", "all/dense.h5");
  here.import_packing("soft_p20", "all/soft.h5");
  here.succeeds("run biaxial --specimen all/dense.h5 -o all/ended.h5 --set stage.compression.to_strain=0.001");
  const auto contacts = [&](const std::string& file) {
    return std::to_string(here.json("inspect " + file).at("contacts").get<int>()) + " contacts, ";
  };
  const std::string dense = contacts("all/dense.h5"), soft = contacts("all/soft.h5");
  const auto said = expect(here, {{"chains", "all/dense.h5", draws, "figure_0.png: " + dense},
                                  {"chains", "all/dense.h5 all/soft.h5", draws, "dense.h5: " + dense},
                                  {"chains", "all", draws, "dense.h5: " + dense},
                                  {"rose", "all --together", draws, "figure_3.png: "},
                                  {"chains", "none", refuses, "none: no *.h5 there"},
                                  {"rose", "none", refuses, "none: no *.h5 there"}});
  CHECK_THAT(said[2], Contains("; ended.h5: ") && Contains("; soft.h5: " + soft));
}

TEST_CASE("a film has a frame for each snapshot and the end, and says how to get snapshots") {
  const Workplace here;
  here.import_packing("dense_p20");
  here.succeeds(
      "run biaxial --specimen S.h5 -o R.h5 --set stage.compression.to_strain=0.002 "
      "--set output.snapshots_every=2");
  // Records 0 to 4 at every 0.05 %: snapshots 0, 2 and 4, which is the end.
  expect(here, {{"film", "R.h5 -o R.gif --field p", draws, "R.gif: 3 frames of p"},
                {"film", "S.h5 -o S.gif", refuses, "output.snapshots_every=10"},
                {"film", "R.h5 -o R.png", refuses, "allowed: *.mp4, *.gif"},
                {"film", "R.h5 -o Q.gif --field eps_q", refuses, "allowed: chains, p"}});
  CHECK(printed_by(here, "from PIL import Image\nprint(Image.open('R.gif').n_frames)\n") == "3\n");
}

TEST_CASE("fit.py draws posteriors over the data that were fitted, and sweeps") {
  const Workplace here;
  for (const char* folder : {"fit", "predicted", "sweep", "missing", "empty"})
    std::filesystem::create_directory(here / folder);
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
  here.write("predicted/predictions.csv",
             "test,predicted,quantity,abscissa,x,measured,error,mean,standard_deviation,n\n"
             "A,0,deviator,strain,0.01,5e4,2e3,5.1e4,3e3,8\nA,0,deviator,strain,0.02,6e4,2e3,6.2e4,3e3,8\n"
             "B,1,strain,axial_stress,1e4,0,2e-3,0,0,8\nB,1,strain,axial_stress,1e5,1e-2,2e-3,1.1e-2,1e-3,8\n");
  here.write("empty/fit.json", "{}");
  // The same fit without and with predictions of other tests.
  for (const char* file : {"fit.json", "curves.csv"})
    std::filesystem::copy_file(here / ("fit/" + std::string(file)), here / ("predicted/" + std::string(file)));
  std::filesystem::create_directory(here / "features");
  std::string with_features = bytes_of(here / "fit/fit.json");
  with_features.insert(with_features.size() - 1,
                       R"(, "features": [{"test": "A", "predicted": false, "feature": "largest_q_Pa", "measured": 4e5,
      "standard_error": 2e4, "mean": 4.1e5, "standard_deviation": 1e4, "n": 8}, {"test": "A", "predicted": false,
      "feature": "eps_v_at_5_percent", "measured": -0.02, "standard_error": 0.002, "mean": null, "standard_deviation": null,
      "n": 0}])");
  here.write("features/fit.json", with_features);
  expect(here, {{"fit", "features", draws, "material.friction 0.50 (0.40 to 0.60); 1 tests"},
                {"fit", "fit", draws, "material.friction 0.50 (0.40 to 0.60); 1 tests"},
                {"fit", "sweep", draws, "1 measure against material.friction, 2 points"},
                {"fit", "predicted", draws, "material.friction 0.50 (0.40 to 0.60); 1 tests"},
                {"fit", "missing", refuses, "fit.json: is not there"},
                {"fit", "empty", refuses, "not the fit.json of rvelab"}});
}

TEST_CASE("mpm.py draws any column of a history, and names the columns, frames and limits that it takes") {
  const Workplace here;
  std::filesystem::create_directory(here / "run");
  here.write("run/history.csv",
             "time_s,steps,kinetic_J,plate.force_y_N,plate.displacement_y_m,plate.displacement_x_m\n0,0,0,0,0,0\n1,9,2,"
             "1e3,-0.1,0.2\n");
  here.write("run/points_0000.h5", "");
  const std::string against = " --against plate.displacement_";
  expect(here,
         {{"mpm", "run --force plate.force_y" + against + "y", draws, "plate.force_y_N against plate.displacement_y_m"},
          {"mpm", "run --force plate.force_y_N" + against + "x_m", draws,
           "plate.force_y_N against plate.displacement_x_m"},
          {"mpm", "run --force kinetic --against time", draws, "kinetic_J against time_s"},
          {"mpm", "run --force kinetic_J", draws, "kinetic_J against time_s"},
          {"mpm", "run --force kinetik", refuses, "no column kinetik; it has time_s, steps, kinetic_J"},
          {"mpm", "run --field eps_q --limits 2 1", refuses, "LOW below HIGH"},
          {"mpm", "run --field eps_q --frame 300", refuses, "--frame 300: run has 1 frames; allowed: 0 to 0"}});
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
  here.succeeds("frames.py", "/usr/bin/python3");
  std::filesystem::copy(here / "run", here / "alone");
  std::filesystem::remove(here / "alone/rocks_0001.h5");
  expect(here, {{"mpm", "run --segregation", draws,
                 "smaller rocks, 200 mm: +0 m along x, +2 m up; larger rocks, 400 mm: +2 m along x, +0 m up"},
                {"mpm", "alone --segregation", refuses, "[[rock]]"}});
}

TEST_CASE("the friction angle that mohr.py draws is the one that run prints, in compression and in extension") {
  const Workplace here;
  here.import_packing("dense_p20");
  const std::pair<const char*, const char*> tests[]{{"biaxial", "0.03"}, {"biaxial_extension", "-0.04"}};
  std::vector<double> printed;
  for (const auto& [test, strain] : tests) {
    const auto run = here.json("run " + std::string(test) + " --specimen S.h5 -o " + test +
                               ".h5 --set stage.compression.to_strain=" + strain);
    printed.push_back(run.at("peak_friction_angle_deg"));
    CHECK(printed.back() > 25);
  }
  const auto drawn =
      expect(here, {{"mohr", "biaxial.h5", draws, angle}, {"mohr", "biaxial_extension.h5", draws, angle}});
  for (std::size_t k = 0; k < 2; ++k) CHECK(number_after(angle, drawn[k]) == Approx(printed[k]).margin(0.051));
}

TEST_CASE("of grains that stick mohr.py draws the envelope with a cohesion, as calibrate tells it") {
  const Workplace here;
  here.import_packing("dense_p20");
  const std::string brief =
      "calibrate biaxial --specimen S.h5 --pressures 10e3,20e3,40e3 --set stage.compression.to_strain=0.02 "
      "--set contact.law=linear_adhesive --set material.adhesion_Pa=";
  std::vector<nlohmann::json> found;
  for (const std::string adhesion : {"5e4", "0"}) found.push_back(here.json(brief + adhesion + " -o K" + adhesion));
  const auto drawn = expect(here, {{"mohr", "K5e4", draws, angle}, {"mohr", "K0", draws, angle}});
  for (std::size_t k = 0; k < 2; ++k) {
    CAPTURE(drawn[k]);
    CHECK(number_after(angle, drawn[k]) == Approx(found[k]["friction_angle_deg"].get<double>()).margin(0.051));
  }
  CHECK(number_after("cohesion ", drawn[0]) == Approx(found[0]["cohesion_Pa"].get<double>()).margin(1));
  CHECK_THAT(drawn[1], !Contains("cohesion"));
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
