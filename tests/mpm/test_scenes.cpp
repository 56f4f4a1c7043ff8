#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <filesystem>

#include "tests/child.hpp"
#include "tests/mpm/scenes.hpp"

using namespace mpm;
using namespace mpm::test;
using rvelab::test::bytes_of;
using rvelab::test::Child;
using rvelab::test::Folder;

namespace {

const std::string kept_scenes = RVELAB_SOURCE_DIR "/protocols/mpm/";

}  // namespace

TEST_CASE("every scene is read, with each of its cases") {
  int files = 0, cases = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kept_scenes)) {
    const auto path = entry.path().string();
    CAPTURE(path);
    ++files;
    CHECK_NOTHROW(read_scene(path, {}, {}));
    for (const auto& name : cases_of(path)) {
      CAPTURE(name);
      ++cases;
      CHECK_NOTHROW(read_scene(path, {name}, {}));
      // Each says at its head where its numbers are from.
      CHECK(bytes_of(path).find("# Sources.") != std::string::npos);
    }
  }
  CHECK(files >= 7);
  CHECK(cases >= 12);
}

TEST_CASE("cases have the published meshes") {
  const auto points = [](const Scene& scene) {
    const auto& region = scene.regions.front();
    return std::lround((region.upper[0] - region.lower[0]) / scene.cell[0]) *
           std::lround((region.upper[1] - region.lower[1]) / scene.cell[1]) * region.points_per_cell;
  };
  CHECK(points(read_scene(kept_scenes + "biaxial.toml", {"C4"}, {})) == 16 * 8 * 4);
  CHECK(points(read_scene(kept_scenes + "biaxial.toml", {"M1"}, {})) == 20 * 10);
  CHECK(points(read_scene(kept_scenes + "biaxial.toml", {"M4", "published"}, {})) == 800);
  CHECK(read_scene(kept_scenes + "biaxial.toml", {"M4", "published"}, {}).planes[1].motion.back().back() == -0.02);
  CHECK(points(read_scene(kept_scenes + "biaxial.toml", {"M9"}, {})) == 1800);
  CHECK(points(read_scene(kept_scenes + "biaxial.toml", {"F4"}, {})) == 30 * 15 * 4);
  CHECK(points(read_scene(kept_scenes + "footing.toml", {"soft", "published"}, {})) == 7776);
  CHECK(points(read_scene(kept_scenes + "pipe.toml", {"published"}, {})) == 9800);
  CHECK(points(read_scene(kept_scenes + "column.toml", {"published"}, {})) == 1024);
}

TEST_CASE("bodies are met at their surface unless told") {
  for (const auto* name : {"footing", "pipe", "column"}) {
    const auto scene = read_scene(kept_scenes + name + ".toml", {}, {});
    REQUIRE(scene.bodies.size() == 1);
    CHECK(scene.bodies[0].at_surface);
  }
  CHECK_FALSE(read_scene(kept_scenes + "footing.toml", {}, {"body.footing.contact=nodes"}).bodies[0].at_surface);
}

TEST_CASE("a mistake in a scene names line, key, what is allowed and the remedy") {
  expect_said(
      bytes_of(kept_scenes + "elastic_block.toml"),
      {{edit("duration_s = 0.02", "duration_s = 0.02\npic_fracton = 0.1"),
        {"scene.toml:17: unknown key time.pic_fracton; the nearest known key is time.pic_fraction; correct"}},
       {edit("density_kg_m3", "density_kg"), {"material.density_kg", "material.density_kg_m3"}},
       {edit("kind = \"roller\"", "kind = \"rolling\""),
        {"scene.toml:32: boundary.kind = ", "rolling", "allowed: roller, fixed, absorbing, periodic",
         "nearest is roller"}},
       {edit("poisson_ratio = 0.3", "poisson_ratio = 0.7"), {"poisson_ratio = 0.7", "allowed: -0.99 to 0.499"}},
       {edit("young_modulus_Pa = 1e7\n", ""), {"material.young_modulus_Pa is missing"}},
       {edit("[[boundary]]", "[[boundry]]"), {"unknown key boundry; the nearest known key is boundary"}},
       {edit("material = \"block\"", "material = \"blok\""), {"region.material is \"blok\"", "nearest is block"}},
       {edit("[time]", "[time"), {"scene.toml:15: column 6"}},
       {edit("lower_m = [0, 0]", "lower_m = [0, 0, 0]"), {"region.lower_m", "2 numbers"}},
       {edit("upper_m = [1, 1]", "upper_m = [1, 1]\npoints_per_cell = 5"), {"must be a square"}},
       {edit("frame_every_s = 0.02", "networks = true"), {"name them in watched_points_m"}}});
  // A case is held to the same keys.
  CHECK_THROWS_AS(read_scene(kept_scenes + "biaxial.toml", {"M5"}, {}), InputError);
}

TEST_CASE("assignments of the command line go by the names of tables") {
  const auto scene =
      read_scene(kept_scenes + "pipe.toml", {}, {"body.pipe.radius_m=0.4", "time.cfl=0.2", "grid.shape=gimp"});
  CHECK(std::get<Disc<2>>(std::get<BodyShape<2>>(scene.bodies[0].shape)).radius == 0.4);
  CHECK(scene.cfl == 0.2);
  CHECK(scene.shape == Shape::gimp);
  CHECK_THROWS_AS(read_scene(kept_scenes + "pipe.toml", {}, {"body.pip.radius_m=0.4"}), InputError);
  CHECK_THROWS_AS(read_scene(kept_scenes + "pipe.toml", {}, {"time.clf=0.2"}), InputError);
}

TEST_CASE("the program ends with code 2 and one line for a user's mistake") {
  const Folder folder;
  const auto run = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), RVELAB_MPM_PROGRAM);
    Child child(arguments, folder / "out", folder / "err");
    const int code = child.wait();
    const auto text = bytes_of(folder / "err");
    CHECK(std::count(text.begin(), text.end(), '\n') == 1);
    return code;
  };
  CHECK(run({folder / "none.toml", "-o", folder / "run"}) == 2);
  CHECK(run({kept_scenes + "elastic_block.toml", "-o", folder / "run", "--set", "time.durations_s=1"}) == 2);
  CHECK(run({kept_scenes + "element.toml", "-o", folder / "run2", "--specimens", folder.path()}) == 2);
  CHECK(bytes_of(folder / "err").find("dense.h5") != std::string::npos);
  CHECK(run({"--resume", folder / "nowhere"}) == 2);
  // As a run holds its folder.
  const std::string busy = folder / "busy";
  std::filesystem::create_directories(busy);
  const int held = open(busy.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  REQUIRE(flock(held, LOCK_EX) == 0);
  for (const auto& given :
       {std::vector<std::string>{"--resume", busy}, {kept_scenes + "elastic_block.toml", "-o", busy}}) {
    CHECK(run(given) == 2);
    CHECK(bytes_of(folder / "err").find("another rvelab-mpm is writing there") != std::string::npos);
  }
  CHECK(std::filesystem::is_empty(busy));
  close(held);
}
