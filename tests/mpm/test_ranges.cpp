// Every number of a scene that no soil has is refused by its key, before anything is made of it, and what is accepted
// runs.
#include "tests/mpm/scene_runs.hpp"
#include "tests/mpm/scenes.hpp"
#include "tests/refusal.hpp"
#include "tools/mpm/output/output.hpp"
#include "tools/mpm/step/watch.hpp"

using namespace mpm;
using namespace mpm::test;
using Catch::Matchers::Contains;
using rvelab::test::Folder;

namespace {

const std::string harmonic = "velocity_m_s = 0.1\nfrequency_Hz = 5\n";

/// What the shipped scenes below do not show.
const std::string other_keys =
    head("other_keys", "[0.25, 0.25]", "0.1\ncfl = 0.4\npic_fraction = 0.1\nrock_steps_per_collision = 50", 2,
         "thickness_m = 1\n") +
    "[loads]\ngravity_m_s2 = [0, -9.81]\nsurface_pressure_Pa = 0\n[loads.shaking]\n" + harmonic +
    "[[loads.strip]]\nlower_m = 0.5\nupper_m = 1\nhalf_sine_Pa = 1e3\nhalf_sine_s = 0.02\n"
    "[[loads.strip]]\nlower_m = 0\nupper_m = 0.5\nhistory = [[0, 0], [0.1, 500]]\n"
    "[initial]\nstress = \"isotropic\"\npressure_Pa = 1e3\n" +
    soil_of("soil", "drucker_prager", "2000", "2e7",
            "poisson_ratio = 0.3\nfriction_angle_deg = 30\ndilatancy_angle_deg = 5\ncohesion_Pa = 1e3\n"
            "hardening = \"linear\"\nfriction_slope_deg = 10\ncohesion_slope_Pa = 1e3\n") +
    soil_of("softening", "mohr_coulomb", "2000", "2e7",
            "hardening = \"cubic_exponential\"\ncubic_rad = [0, 0, 5, 0.5]\npeak_plastic_strain = 0.02\ndecay = 20\n"
            "peak_friction_angle_deg = 35\nresidual_friction_angle_deg = 28\n") +
    region("soil", "[0, 0]", "[1, 1]", "points_per_cell = 4\nvelocity_m_s = [0, 0]\n") +
    region("softening", "[1, 0]", "[2, 1]") + boundary("left", "roller", "x", "0", "removed_at_s = 5\n") +
    boundary("bottom", "fixed", "y", "0", "motion = [[0, 0, 0], [1, 0.1, 0]]\n") +
    box_body("footing", "[1.5, 1.5]", "[0.5, 0.5]", "rough = false\nfriction = 0.3\n") +
    "[[body]]\nname = \"pipe\"\nkind = \"disc\"\ncentre_m = [4, 0.5]\nradius_m = 0.25\n"
    "motion = [[0, 0, 0], [1, -0.1, 0]]\n" +
    half_space("lid", "[0, 3]", "[0, -1]",
               "pressure_Pa = 100\npressure_until_s = 1\nplate_mass_kg = 50\narea_m2 = 2\n") +
    "[output]\nframe_every_s = 0.01\nhistory_every_s = 0.001\ncheckpoint_every_s = 0.05\n"
    "watched_points_m = [[0.5, 0.5]]\n";

/// Rocks of all kinds on terrain, with soil as ghosts.
const std::string stones =
    head("stones", "0.25", "0.1") + "[loads]\ngravity_m_s2 = [0, -9.81]\n" + soil_of("soil", "elastic", "2000", "2e7") +
    region("soil", "[0, 0.5]", "[1, 1]") +
    "[[body]]\nname = \"ground\"\nkind = \"terrain\"\ncentre_m = [0, 0]\nfriction = 0.4\nspacing_m = 0.5\n"
    "heights_m = [[0.3, 0.2, 0.1, 0, 0]]\n" +
    basalt() + "poisson_ratio = 0.2\nfriction = 0.5\nrestitution = 0.5\n" +
    rock("slab", "[2.2, 1.5]",
         "shape = \"superquadric\"\nhalf_axes_m = [0.4, 0.3]\nblockiness = [4]\nrotation_deg = 20\n"
         "velocity_m_s = [-1, 0]\nspin_rad_s = 1\n") +
    rocks("coarse",
          "lower_m = [3, 1]\nupper_m = [5, 3]\nvolume_share = 0.2\ndiameters_m = [[0.6, 1], [0.5, 1]]\nspread = 0.1\n"
          "aspect = [1.2, 1]\nblockiness = [3]\ngap_m = 0.01\nseed = 3\n") +
    "[rock_soil]\ncontact = \"ghost\"\nfriction = 0.3\nporosity = 0.4\nyoung_modulus_Pa = 1e8\npoisson_ratio = 0.2\n";

/// Assignments to each number of a table, of rows to those of the first one: "region.0.lower_m=[V, 0]", V to be put in.
void each_number(const toml::table& table, const std::string& of, std::vector<std::string>& found) {
  for (const auto& [key, node] : table) {
    const auto path = (of.empty() ? "" : of + ".") + std::string(key.str());
    if (path == "case") continue;
    if (const auto* inner = node.as_table()) each_number(*inner, path, found);
    if (node.is_number()) found.push_back(path + "=V");
    const auto* array = node.as_array();
    if (array == nullptr || array->empty()) continue;
    const bool rows = array->front().is_array();
    if (array->front().is_table()) {
      for (std::size_t k = 0; k < array->size(); ++k) {
        each_number(*array->get(k)->as_table(), path + "." + std::to_string(k), found);
      }
    } else if (rows || array->front().is_number()) {
      const std::size_t count = rows ? array->front().as_array()->size() : array->size();
      for (std::size_t k = 0; k < std::min<std::size_t>(count, 6); ++k) {
        std::string list;
        for (std::size_t n = 0; n < array->size(); ++n) {
          const auto* row = array->get(n)->as_array();
          std::string numbers;
          for (std::size_t m = 0; rows && m < row->size(); ++m) {
            const bool here = n == 0 && m == k;
            numbers += (m == 0 ? "" : ", ") + (here ? "V" : std::to_string(*row->get(m)->value<double>()));
          }
          if (!rows) numbers = n == k ? "V" : std::to_string(*array->get(n)->value<double>());
          list += (n == 0 ? "" : ", ") + (rows ? "[" + numbers + "]" : numbers);
        }
        found.push_back(path + "=[" + list + "]");
      }
    }
  }
}

/// Three steps of the scene; "" if all that it writes is finite, else what was said.
template <int D>
std::string few_steps(const Scene& scene, const std::string& folder) {
  const auto model = set_up<D>(scene, 1, folder);
  auto& solver = model->solver;
  watch_length<D>(solver, solver.stable_step(), 1, scene.duration);
  const auto start = energy_start<D>(solver);
  std::vector<double> impulses;
  Rows history(folder + "/history.csv", {}), watched(folder + "/watched.csv", {});
  for (int k = 0; k < 3; ++k) {
    history.add(history_row<D>(solver, start, k == 0 ? 0 : 1e-3, impulses));
    watched.add(watched_row<D>(*model));
    double dt = std::min(solver.stable_step(), scene.duration);
    if (solver.points.empty()) dt = std::min(dt, scene.history_every);
    solver.step(dt);
  }
  history.add(history_row<D>(solver, start, 1e-3, impulses));
  return "";
}

/// How many values of the numbers of a scene were refused; each by its key.
long sweep(const std::string& path) {
  const Folder folder;
  std::vector<std::string> assignments;
  each_number(rvelab::keys::parse_toml_file(path), "", assignments);
  REQUIRE(assignments.size() > 10);
  long refused = 0;
  for (const auto& each : assignments) {
    for (const char* value : {"0", "-1", "nan", "inf", "1e300", "1e-300", "-1e300"}) {
      auto assignment = each;
      assignment.replace(assignment.find('V'), 1, value);
      CAPTURE(path, assignment);
      const auto dotted = each.substr(0, each.find('='));
      const auto key = dotted.substr(dotted.rfind('.') + 1);
      try {
        const auto scene = read_scene(path, {}, {assignment});
        const auto failed =
            scene.dimension == 2 ? few_steps<2>(scene, folder.path()) : few_steps<3>(scene, folder.path());
        CHECK(failed == "");
        const std::string far(value);
        if (far == "nan" || far == "inf" || far == "1e300" || far == "-1e300") FAIL_CHECK("accepted");
      } catch (const InputError& mistake) {
        ++refused;
        const std::string said = mistake.what();
        // A limit of two keys may go by the other.
        const bool pair = (key == "lower_m" && said.find("upper_m") != std::string::npos) ||
                          said.find(dotted.substr(0, dotted.find('.'))) != std::string::npos;
        if (said.find(key) == std::string::npos && !pair) CHECK_THAT(said, Contains(key));
        CHECK(said.size() < 800);
      }
    }
  }
  return refused;
}

std::string shipped(const char* name) { return std::string(RVELAB_SOURCE_DIR) + "/protocols/mpm/" + name + ".toml"; }

/// What is said of a scene that is refused when it is read or in a few steps; "".
std::string outcome_of(const std::string& text, const Change& change = {}) {
  const Folder folder;
  return rvelab::test::input_error([&] { few_steps<2>(scene_of(text, change, folder), folder.path()); });
}

void expect_in_steps(const std::vector<Said>& cases) {
  for (const auto& [change, words] : cases) {
    CAPTURE(change.assignments);
    const auto said = outcome_of(other_keys, change);
    for (const auto& word : words) CHECK_THAT(said, Contains(word));
  }
}

}  // namespace

TEST_CASE("numbers that nothing has are refused by their key, and the others run: dry soil, loads, bodies, plates") {
  const Folder folder;
  std::ofstream(folder / "scene.toml") << other_keys;
  CHECK(outcome_of(other_keys) == "");
  CHECK(sweep(folder / "scene.toml") > 300);
}

TEST_CASE("numbers that nothing has are refused by their key, and the others run: pore water, absorbing planes") {
  CHECK(sweep(shipped("mandel")) > 60);
  CHECK(sweep(shipped("site_response")) > 60);
}

TEST_CASE("numbers that nothing has are refused by their key, and the others run: rocks, terrain") {
  CHECK(sweep(shipped("ball_impact")) > 60);
  const Folder folder;
  std::ofstream(folder / "scene.toml") << stones;
  CHECK(outcome_of(stones) == "");
  CHECK(sweep(folder / "scene.toml") > 150);
}

TEST_CASE("a range is told with the value, its unit and what to do") {
  const std::string far = "out of range; allowed: ";
  expect_in_steps(
      {{set("material.soil.young_modulus_Pa=1e300"), {"material.young_modulus_Pa = 1e+300", far, "to 1e+13 Pa; give"}},
       {set("body.pipe.radius_m=1e-300"), {"body.radius_m = 1e-300", far + "1e-09 to 1e+09 m"}},
       {set("loads.gravity_m_s2=[0, -1e10]"), {"loads.gravity_m_s2", far + "each -1e+09 to 1e+09 m/s^2"}},
       {set("boundary.bottom.motion=[[0, 1e7, 0]]"), {"boundary.motion holds 1e+07", far + "-1e+06"}}});
}

TEST_CASE("more steps, points or nodes than a run can have are refused with their number before anything is made") {
  expect_in_steps(
      {{set({"material.soil.young_modulus_Pa=1e13", "material.soil.density_kg_m3=1e-3", "time.duration_s=1e4",
             "output.history_every_s=100", "output.frame_every_s=100", "output.checkpoint_every_s=100"}),
        {"time.duration_s = 10000", "1.16", "e+13 steps", "young_modulus_Pa"}},
       {set("grid.cell_m=1e-7"), {"GB)", "make grid.cell_m larger"}},
       {set({"region.1.lower_m=[4e4, 0]", "region.1.upper_m=[40001, 1e3]"}), {"box around all regions", "6.4", "GB)"}},
       {set("body.footing.size_m=[1e8, 0.5]"), {"body.footing.size_m", "8e+08"}}});
}

TEST_CASE("shaking that throws the soil about is refused, and a record of times and accelerations that nothing has") {
  const auto record = [](const std::string& rows) {
    return Change{{}, harmonic, "record_csv = \"shake.csv\"\n", {{"shake.csv", rows}}};
  };
  const std::string key = "loads.shaking.record";
  CHECK(outcome_of(other_keys, record("s,m/s2\n0,0\n0.01,3\n0.02,-3\n")) == "");
  expect_in_steps({{record("0,0\n1e300,3\n"), {key + " holds 1e+300", "allowed: -1e+12 to 1e+12 s"}},
                   {record("0,0\n0.01,1e300\n"), {key + " holds 1e+300", "allowed: -1e+09 to 1e+09 m/s^2"}},
                   {record("1e400,0\n0.01,3\n"), {"shake.csv:1: holds 1e400"}},
                   {record("0,0\n0.01,nan\n"), {"shake.csv:2: holds nan"}},
                   {record("0,0\n0.01,1e6\n0.02,1e6\n"), {key, "moves the box at up to 15000 m/s"}},
                   {set("loads.shaking.velocity_m_s=500"), {"loads.shaking.velocity_m_s", "moves the box"}}});
}

TEST_CASE("one point that flies off does not fill the memory with nodes") {
  Grid<3> grid;
  CHECK(Grid<3>::most_for(1000) == Grid<3>::most / 10);
  CHECK(Grid<3>::most_for(200'000) == 20'000'000);
  CHECK(Grid<3>::most_for(50'000'000) == Grid<3>::most);
  CHECK(grid.cover({0, 0, 0}, {10, 10, 10}, 4'000'000));
  CHECK_THROWS_WITH(grid.cover({0, 0, 0}, {20'000, 10, 10}, 4'000'000), Contains("and has 4e+06 at most"));
  CHECK(grid.nodes.size() == 19 * 19 * 19);
}

TEST_CASE("files that a scene names are regular files: what has no end is not read") {
  expect_in_steps(
      {{edit(harmonic, "record_csv = \"/dev/zero\"\n"), {"/dev/zero: is not a regular file", "record_csv"}}});
}

TEST_CASE("a step from which the end of the run cannot be reached ends it, and says how many there would be") {
  const auto model = model_of<2>(other_keys);
  auto& solver = model->solver;
  CHECK_NOTHROW(watch_length<2>(solver, 1e-3, 1, 1e8));
  CHECK_THROWS_AS(watch_length<2>(solver, 1e-3, 1, 1.01e8), InputError);
  CHECK_THROWS_WITH(watch_length<2>(solver, 1e-3, 1000, 1e6),
                    Contains("1e+12 steps; allowed: up to 1e+11") && Contains("the stiffest contact of rocks"));
  CHECK_THROWS_WITH(watch_length<2>(solver, std::nan(""), 1, 1), Contains("nan steps"));
  solver.steps = 7;
  CHECK_THROWS_WITH(watch_length<2>(solver, 1e-12, 1, 1),
                    Contains("the run would stand still: it ends") && Contains("the wave of material"));
}

TEST_CASE("what is not defined is an empty cell of a table, and what is broken ends the run") {
  const Folder folder;
  Rows rows(folder / "watched.csv", {});
  const auto add = [&](double time, double pressure, double void_ratio, double pore_ratio) {
    rows.add(
        {{"time_s", time}, {"0.p_Pa", pressure}, {"0.void_ratio", void_ratio}, {"0.pore_pressure_ratio", pore_ratio}});
  };
  add(0, 1, NAN, NAN);
  add(1, -2.5, 0.7, NAN);
  CHECK(rvelab::test::bytes_of(folder / "watched.csv") ==
        "time_s,0.p_Pa,0.void_ratio,0.pore_pressure_ratio\n0,1,,\n1,-2.5,0.7,\n");
  CHECK_THROWS_WITH(add(2, NAN, 0.7, 1), Contains("at 2 s 0.p_Pa is nan") && Contains("take a smaller time.cfl"));
  CHECK_THROWS_WITH(add(2, 1, 0.7, INFINITY), Contains("0.pore_pressure_ratio is inf"));
  FluidPoint<2> point;
  point.pressure = 5;
  CHECK(std::isnan(point.pressure_ratio()));
  point.first_vertical = 1e-12, point.first_pressure = 1e4;  // round-off of two weights
  CHECK(std::isnan(point.pressure_ratio()));
  point.first_vertical = 1e4, point.pressure = 1.9e4;
  CHECK(point.pressure_ratio() == Approx(0.9));
}

TEST_CASE("a saturated run from no stress writes tables without nan and inf, and goes on from them") {
  const SceneRuns runs("");
  const std::vector<std::string> scene{shipped("mandel"), "--set", "time.duration_s=0.02", "-q", "-j", "1"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), scene.begin(), scene.end());
    return runs.run(more);
  };
  REQUIRE(with({"-o", runs.folder / "a", "--set", "grid.cell_m=0.25"}) == 0);
  REQUIRE(with({"-o", runs.folder / "b", "--set", "grid.cell_m=0.25", "--stop-at", "0.01"}) == 0);
  REQUIRE(runs.resume("b", {"-q", "-j", "1"}) == 0);
  for (const char* name : {"history.csv", "watched.csv"}) {
    const auto text = rvelab::test::bytes_of(runs.folder / (std::string("a/") + name));
    CHECK(text.find("nan") == std::string::npos);
    CHECK(text.find(",inf") == std::string::npos);
    CHECK(text.find("-inf") == std::string::npos);
    CHECK(text == rvelab::test::bytes_of(runs.folder / (std::string("b/") + name)));
  }
}
