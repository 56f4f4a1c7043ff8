#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "rvelab/io/hdf5/specimen_file.hpp"
#include "tests/catch.hpp"
#include "tests/child.hpp"
#include "tests/folder.hpp"
#include "tools/mpm/app/run.hpp"
#include "tools/mpm/output/checkpoint.hpp"
#include "tools/mpm/output/output.hpp"
#include "tools/mpm/setup/setup.hpp"

using namespace mpm;
using rvelab::test::bytes_of;
using rvelab::test::Child;
using rvelab::test::Folder;

namespace {

const std::string scenes = RVELAB_SOURCE_DIR "/protocols/mpm/";

/// A specimen of 400 discs at 20 kPa under a name that scenes know.
void specimen(const Folder& folder, const std::string& name, const std::vector<std::string>& more = {}) {
  const std::string from = RVELAB_TEST_DATA "/yade/dense_p20";
  std::vector<std::string> words{
      RVELAB_PROGRAM, "import", from + ".particles.csv", from + ".contacts.csv", from + ".json", "-o", folder / name};
  words.insert(words.end(), more.begin(), more.end());
  Child child(words, folder / "out", folder / "err");
  REQUIRE(child.wait() == 0);
}

Scene element(const std::vector<std::string>& more) {
  std::vector<std::string> set{"loads.surface_pressure_Pa=20e3", "initial.pressure_Pa=20e3"};
  set.insert(set.end(), more.begin(), more.end());
  return read_scene(scenes + "element.toml", {}, set);
}

}  // namespace

TEST_CASE("grains in a point answer as the pure cell does along the same path, bit for bit") {
  const Folder folder;
  specimen(folder, "dense.h5");
  auto model = set_up<2>(element({}), 2, folder.path());
  auto& solver = model->solver;
  // The pure cell: the state that was prepared for the points, alone in a pool of another host.
  rvelab::Workers workers(1);
  auto pool = std::make_shared<GrainPool>(workers, GrainOptions{});
  SpecimenFamily family(pool, {folder / "dense.h5"});
  const auto id = family.spawn(20e3);
  for (int k = 0; k < 40; ++k) {
    solver.step(solver.stable_step());
    double sigma[9], dH[9] = {};
    const Mat<2> map = finite_increment<2>(solver.points[1].gradient);
    for (int i = 0; i < 2; ++i) {
      for (int j = 0; j < 2; ++j) dH[3 * i + j] = map(i, j);
    }
    expect_ok(rvelab_apply(pool->get(), id, dH, 0, sigma));
    for (int i = 0; i < 2; ++i) {
      for (int j = 0; j < 2; ++j) REQUIRE(solver.points[1].stress(i, j) == sigma[3 * i + j]);
    }
  }
  CHECK(std::abs(solver.points[1].stress(1, 1)) > 21e3);  // it was compressed
}

TEST_CASE("loose grains that collapse on their way to a pressure are taken from the next specimen of the family") {
  const Folder folder;
  Child child({RVELAB_PROGRAM, "pack", RVELAB_SOURCE_DIR "/protocols/pack_saturated.toml", "-o", folder / "loose.h5",
               "--set", "pack.number=64", "--set", "target.void_ratio=0.2394", "--set", "pack.seed=3", "--set",
               "target.pressures_Pa=[1.5, 4935]"},
              folder / "out", folder / "err");
  REQUIRE(child.wait() == 0);
  specimen(folder, "dense.h5");
  // By ratio 4935 Pa is nearer to 1 Pa than the dense one is; unloaded, the loose grains lose all contacts before.
  rvelab::Workers workers(1);
  auto pool = std::make_shared<GrainPool>(workers, GrainOptions{});
  SpecimenFamily alone(pool, {folder / "loose_4935Pa.h5"});
  CHECK_THROWS_WITH(alone.spawn(1), Catch::Matchers::Contains("does not come to 1 Pa; pack one nearer"));
  SpecimenFamily family(pool, {folder / "loose_4935Pa.h5", folder / "dense.h5"});
  CHECK(pool->info(family.spawn(1)).p == Approx(1).epsilon(1e-3));
}

TEST_CASE("specimens come to a pressure as exactly in a scene of coarse tolerances") {
  const Folder folder;
  specimen(folder, "dense.h5");
  rvelab::Workers workers(1);
  GrainOptions coarse;
  coarse.tolerance_rel = 0.5;
  coarse.tolerance_abs = 0.05;
  auto pool = std::make_shared<GrainPool>(workers, coarse),
       usual = std::make_shared<GrainPool>(workers, GrainOptions{});
  SpecimenFamily family(pool, {folder / "dense.h5"}), exact(usual, {folder / "dense.h5"});
  for (const double pressure : {12e3, 45e3}) {
    CAPTURE(pressure);
    CHECK(family.prepared(pressure).p == Approx(pressure).epsilon(1e-3));
    const auto id = family.spawn(pressure), twin = exact.spawn(pressure);
    double sigma[9], other[9];
    read_state(pool->get(), id, sigma, nullptr);
    read_state(usual->get(), twin, other, nullptr);
    for (int k = 0; k < 9; ++k) CHECK(sigma[k] == other[k]);
    // From there on each keeps its own tolerances.
    const double dH[9] = {0, 0, 0, 0, -1e-4, 0, 0, 0, 0};
    for (int k = 0; k < 20; ++k) {
      expect_ok(rvelab_apply(pool->get(), id, dH, 0, sigma));
      expect_ok(rvelab_apply(usual->get(), twin, dH, 0, other));
    }
    std::int64_t few = 0, many = 0;
    expect_ok(rvelab_cost(pool->get(), 1, &id, &few));
    expect_ok(rvelab_cost(usual->get(), 1, &twin, &many));
    CHECK(few < many);
  }
}

TEST_CASE("a single element strains evenly, and carries what its RVE carries under stress control") {
  const Folder folder;
  specimen(folder, "dense.h5");
  auto model = set_up<2>(element({"boundary.top.motion=[[0, 0, 0], [0.1, 0, -0.02]]"}), 2, folder.path());
  auto& solver = model->solver;
  while (solver.time < 0.3) solver.step(solver.stable_step());  // 0.5 %
  double low = 1e300, high = -1e300, side = 0;
  for (const auto& point : solver.points) {
    low = std::min(low, point.F(0, 0));
    high = std::max(high, point.F(0, 0));
    side += point.stress(0, 0) / 4;
  }
  CHECK(high - low < 0.05 * (high - 1));
  CHECK(side == Approx(-20e3).epsilon(0.03));
  // The same axial strain by the element test of a host: side stress held with the tangent.
  rvelab::Workers workers(1);
  auto pool = std::make_shared<GrainPool>(workers, GrainOptions{});
  SpecimenFamily family(pool, {folder / "dense.h5"});
  const auto id = family.spawn(20e3);
  const double end = std::log(solver.grid.cell[1]), step = -1e-5;
  double sigma[9] = {-20e3, 0, 0, 0, -20e3, 0, 0, 0, 0}, lateral = 0.4 * -step, last = -20e3;
  for (double strain = 0; strain > end; strain += step) {
    const double dH[9] = {lateral, 0, 0, 0, step, 0, 0, 0, 0};
    expect_ok(rvelab_apply(pool->get(), id, dH, 0, sigma));
    // Secant in the side stress: the modulus is some 15 MPa.
    lateral = std::max(0.0, lateral + 0.3 * (-20e3 - sigma[0] - 0.5 * (sigma[0] - last)) / 15e6);
    last = sigma[0];
  }
  CHECK(sigma[0] == Approx(-20e3).epsilon(0.03));
  double axial = 0;
  for (const auto& point : solver.points) axial += point.stress(1, 1) / 4;
  CHECK(axial == Approx(sigma[4]).epsilon(0.04));
  CHECK(axial < -30e3);
}

namespace {

/// Rows of numbers of a CSV file under one line of comment and one of names; what is no number is 0.
std::vector<std::map<std::string, double>> rows_of(const std::string& path) {
  std::ifstream file(path);
  std::string line, cell;
  std::getline(file, line);
  std::vector<std::string> names;
  std::getline(file, line);
  for (std::istringstream head(line); std::getline(head, cell, ',');) names.push_back(cell);
  std::vector<std::map<std::string, double>> rows;
  while (std::getline(file, line)) {
    rows.emplace_back();
    std::istringstream cells(line);
    for (const auto& name : names) {
      std::getline(cells, cell, ',');
      rows.back()[name] = std::strtod(cell.c_str(), nullptr);
    }
  }
  return rows;
}

}  // namespace

TEST_CASE("the network written of a watched point carries its stress: (1/V) sum f (x) l") {
  const Folder folder;
  specimen(folder, "dense.h5");
  const auto scene = element({"output.networks=true"});
  auto model = set_up<2>(scene, 2, folder.path());
  auto& solver = model->solver;
  while (solver.time < 0.3) solver.step(solver.stable_step());
  write_networks<2>(*model, folder.path(), 7);
  for (const int k : {0, 1}) {
    const auto& point = solver.points[std::size_t(model->watched[std::size_t(k)])];
    const auto name = folder / ("network_" + std::to_string(k) + "_0007.h5");
    Child child({RVELAB_PROGRAM, "export", name, "--format", "csv", "-o", folder / "n", "--force"}, folder / "out",
                folder / "err");
    REQUIRE(child.wait() == 0);
    const auto cell = rvelab::io::read_specimen(name).cell;
    const rvelab::Matrix3 lattice = cell.rotation * cell.lattice;
    std::map<long, Vec<2>> position;
    for (auto& row : rows_of(folder / "n.particles.csv")) position[long(row["id"])] = Vec<2>(row["x"], row["y"]);
    Mat<2> sum = Mat<2>::Zero();
    auto contacts = rows_of(folder / "n.contacts.csv");
    CHECK(contacts.size() > 500);
    for (auto& row : contacts) {
      Vec<2> branch = position.at(long(row["id2"])) - position.at(long(row["id1"]));
      for (int i = 0; i < 2; ++i) branch[i] += lattice(i, 0) * row["sx"] + lattice(i, 1) * row["sy"];
      const Vec<2> push = Vec<2>(row["fsx"], row["fsy"]) + row["fn"] * branch.normalized();  // on the second grain
      sum -= push * branch.transpose();                                                      // traction = sigma n
    }
    sum /= lattice.determinant();
    CHECK((sum - point.stress).norm() < 1e-10 * mean_pressure<2>(point.stress));
    CHECK(deviatoric_stress<2>(point.stress) > 3e3);
  }
  // Material points without grains have none.
  auto continuum =
      read_scene(scenes + "elastic_block.toml", {}, {"output.networks=true", "output.watched_points_m=[[0, 0]]"});
  CHECK_THROWS_WITH(set_up<2>(continuum, 1, "."), Catch::Matchers::Contains("has no grains; take that point away"));
}

TEST_CASE("geostatic cells carry the pressure of their depth, and a column of them stays at rest") {
  const Folder folder;
  specimen(folder, "sand.h5");
  const auto scene = read_scene(scenes + "column.toml", {},
                                {"material.sand.specimens=[\"sand.h5\"]", "grid.cell_m=0.5", "time.pic_fraction=0.1",
                                 "boundary.gate.removed_at_s=9"});
  auto model = set_up<2>(scene, 2, folder.path());
  auto& solver = model->solver;
  CHECK(model->pressure_classes == 4);  // rows of points, sixteen points
  const double density = solver.points[0].mass / solver.points[0].volume;
  for (const auto& point : solver.points) {
    const double p = density * 9.81 * (1 - point.position[1]);
    CHECK(-point.stress(0, 0) == Approx(p).epsilon(0.01));
    CHECK(-point.stress(1, 1) == Approx(p).epsilon(0.01));
    CHECK(std::abs(point.stress(0, 1)) < 2e-3 * p);
  }
  while (solver.time < 0.1) solver.step(solver.stable_step());
  for (const auto& point : solver.points) CHECK((point.position - point.first).norm() < 1e-3);
}

TEST_CASE("increments that wait for others change the answer by less than the tolerance") {
  const Folder folder;
  specimen(folder, "dense.h5");
  double stress[2], called[2];
  for (const int gathered : {0, 1}) {
    auto model =
        set_up<2>(element({"time.cfl=0.05", gathered ? "material.dense.gather=1e-5" : "material.dense.gather=0"}), 2,
                  folder.path());
    while (model->solver.time < 0.15) model->solver.step(model->solver.stable_step());
    stress[gathered] = model->solver.points[0].stress(1, 1);
    called[gathered] = model->grains.at("dense")->called;
  }
  CHECK(called[1] < 0.7 * called[0]);
  CHECK(stress[1] == Approx(stress[0]).epsilon(0.01));
}

namespace {

/// A scene run at one go, and stopped and resumed on other threads.
void expect_resumed(const std::string& scene, const std::vector<std::string>& assignments, const std::string& stop_at) {
  CAPTURE(scene);
  const Folder folder;
  specimen(folder, "sand.h5");
  const auto run = [&](std::vector<std::string> arguments, bool fresh) {
    arguments.insert(arguments.begin(), RVELAB_MPM_PROGRAM);
    if (fresh) {
      arguments.insert(arguments.end(), {scenes + scene, "--specimens", folder.path(), "-q"});
      for (const auto& each : assignments) arguments.insert(arguments.end(), {"--set", each});
    }
    Child child(arguments, folder / "out", folder / "err");
    const int code = child.wait();
    UNSCOPED_INFO(bytes_of(folder / "err"));
    return code;
  };
  const auto grain_steps = [&] {
    const auto text = bytes_of(folder / "out");
    const auto at = text.find("grain-steps ");
    return text.substr(at, text.find(',', at) - at);
  };
  REQUIRE(run({"-o", folder / "whole", "-j", "1"}, true) == 0);
  const auto all_steps = grain_steps();
  REQUIRE(run({"-o", folder / "parts", "-j", "2", "--stop-at", stop_at}, true) == 0);
  CHECK(bytes_of(folder / "out").find("go on with") != std::string::npos);
  CHECK(grain_steps() != all_steps);
  REQUIRE(run({"--resume", folder / "parts", "-j", "3"}, false) == 0);
  CHECK(grain_steps() == all_steps);
  for (const char* name : {"history.csv", "watched.csv", "points.xdmf"}) {
    CAPTURE(name);
    const auto whole = bytes_of(folder / ("whole/" + std::string(name)));
    CHECK(whole.size() > 100);
    CHECK(whole == bytes_of(folder / ("parts/" + std::string(name))));
  }
  for (const auto& file : std::filesystem::directory_iterator(folder / "whole")) {
    const auto name = file.path().filename().string();
    if (name.starts_with("network_")) CHECK(bytes_of(file.path()) == bytes_of(folder / ("parts/" + name)));
  }
  const auto whole = rvelab::io::Hdf5File::open(folder / "whole/checkpoint.h5"),
             parts = rvelab::io::Hdf5File::open(folder / "parts/checkpoint.h5");
  for (const char* name : {"/points", "/reactions"}) CHECK(whole.read<double>(name) == parts.read<double>(name));
}

}  // namespace

TEST_CASE("a run that was stopped and resumed ends with the bits of one that was not, on other threads too") {
  expect_resumed("column.toml",
                 {"material.sand.specimens=[\"sand.h5\"]", "grid.cell_m=0.5", "time.duration_s=0.06",
                  "output.frame_every_s=0.02", "time.pic_fraction=0.01"},
                 "0.033");
  // A grid that follows a plane.
  expect_resumed("element.toml",
                 {"material.dense.specimens=[\"sand.h5\"]", "time.duration_s=0.1", "output.history_every_s=0.01",
                  "output.frame_every_s=0.02", "output.networks=true"},
                 "0.05");
}

TEST_CASE("a checkpoint removes RVEs of earlier ones, and never those of a material whose name begins alike") {
  const Folder folder;
  specimen(folder, "dense.h5");
  // Two materials of grains side by side.
  std::ofstream(folder / "scene.toml") << bytes_of(scenes + "element.toml") << R"(
[[material]]
name = "dense_2"
kind = "grains"
specimens = ["dense.h5"]
[[region]]
material = "dense_2"
lower_m = [1, 0]
upper_m = [2, 1]
)";
  const auto scene = read_scene(folder / "scene.toml", {}, {"initial.pressure_Pa=20e3", "region.0.points_per_cell=1"});
  auto model = set_up<2>(scene, 1, folder.path());
  std::filesystem::create_directories(folder / "run");
  const std::string other = folder / "run/grains_dense_2_old.h5";  // nobody's: not of a step
  std::ofstream(other) << "mine";
  Progress progress;
  for (const long steps : {2, 3}) {
    model->solver.steps = steps;
    write_checkpoint<2>(*model, progress, folder / "run");
    const auto at = std::to_string(steps) + ".h5";
    CHECK(std::filesystem::exists(folder / ("run/grains_dense_" + at)));
    CHECK(std::filesystem::exists(folder / ("run/grains_dense_2_" + at)));
  }
  CHECK(!std::filesystem::exists(folder / "run/grains_dense_2.h5"));
  CHECK(!std::filesystem::exists(folder / "run/grains_dense_2_2.h5"));
  CHECK(std::filesystem::exists(other));
  auto again = set_up<2>(scene, 1, folder.path(), false);
  read_checkpoint<2>(*again, progress, folder / "run");
  CHECK(again->solver.steps == 3);
  std::filesystem::remove(folder / "run/grains_dense_2_3.h5");
  again = set_up<2>(scene, 1, folder.path(), false);
  CHECK_THROWS_WITH(read_checkpoint<2>(*again, progress, folder / "run"),
                    Catch::Matchers::Contains("the RVEs of the checkpoint are missing"));
}

TEST_CASE("an increment that an RVE cannot make ends the run, and names the point and the reason") {
  const Folder folder;
  specimen(folder, "dense.h5", {"--set", "solver.max_overlap_ratio=0.02"});  // 0.008 at the start
  auto model = set_up<2>(element({"boundary.top.motion=[[0, 0, -0.5]]", "time.duration_s=1",
                                  "material.dense.tolerance_rel=0.1", "material.dense.tolerance_abs=1e-3"}),
                         2, folder.path());
  std::string message;
  try {
    for (int k = 0; k < 2000; ++k) model->solver.step(model->solver.stable_step());
  } catch (const InputError&) {
    FAIL("it is nobody's mistake: exit code 1, not 2");
  } catch (const std::runtime_error& failure) {
    message = failure.what();
  }
  CHECK_THAT(message, Catch::Matchers::StartsWith("RVELAB_DISCARD, at the material point at ") &&
                          Catch::Matchers::Contains("solver.max_overlap_ratio allows 0.02"));
}
