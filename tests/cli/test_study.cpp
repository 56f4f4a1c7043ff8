// rvelab study as a user runs it: results and their files, the way back from study.toml, resume, refusals, the figure.

#include "tests/child.hpp"
#include "tests/program.hpp"

using namespace rvelab::test;
using Catch::Matchers::Contains;
using OrderedJson = nlohmann::ordered_json;

namespace {

const std::string small_test = "biaxial S.h5 --set stage.compression.to_strain=0.002 --increments 3 ";
const std::string grid = "--vary solver.target_unbalanced=1e-2,1e-3 --reference solver.fixed_substeps=200 ";

/// A result without the times and what they decide.
OrderedJson without_times(OrderedJson json) {
  const auto strip = [](OrderedJson& run) {
    for (const char* name : {"processor_s_per_increment", "processor_s_per_path", "on_front_of_processor_time"}) {
      run.erase(name);
    }
  };
  strip(json["reference"]);
  for (OrderedJson& point : json["points"]) strip(point);
  json["study"].erase("specimens");  // called from another folder
  return json;
}

std::size_t pieces_in(const Workplace& here, const std::string& folder) {
  std::size_t count = 0;
  std::error_code none_yet;
  for (const auto& entry : std::filesystem::directory_iterator(here / (folder + "/pieces"), none_yet)) {
    count += entry.path().extension() == ".json" ? 1 : 0;
  }
  return count;
}

}  // namespace

TEST_CASE("a study prints and writes its results, and its file runs it again") {
  const Workplace here;
  here.import_packing("dense_p20");
  const std::string outcome = here.succeeds("study " + small_test + grid + "--repeat 2 -o F");
  CHECK_THAT(outcome, Contains("over p, 3 increments") && Contains("in tol.") && Contains("angle_deg") &&
                          Contains("means of 2 repeats") && Contains("tools/plot/study.py F -o F/study.png"));
  const OrderedJson json = OrderedJson::parse(bytes_of(here / "F/study.json"));
  REQUIRE(json["points"].size() == 2);
  CHECK(json["points"][0]["values"]["solver.target_unbalanced"] == "1e-2");
  CHECK(json["points"][0]["rms_error_over_p"].get<double>() > json["points"][1]["rms_error_over_p"].get<double>());
  CHECK(json["points"][1]["peak_friction_angle_deg_standard_error"].is_number());
  CHECK(pieces_in(here, "F") == 9);
  const std::string csv = bytes_of(here / "F/study.csv");
  CHECK(std::count(csv.begin(), csv.end(), '\n') == 4);
  CHECK_THAT(csv, Contains("run,solver.target_unbalanced,increments,failed_increments,rms_error_over_p") &&
                      Contains("\nreference,,3,0,") && Contains("\n2,1e-3,3,0,"));

  const std::string again = here.succeeds("study F/study.toml --json --threads 1");
  CHECK(without_times(OrderedJson::parse(again)) == without_times(json));

  const std::string figure =
      here.succeeds("-B '" RVELAB_SOURCE_DIR "/tools/plot/study.py' F -o F/study.png", "/usr/bin/python3");
  CHECK_THAT(figure, Contains("2 grid points"));
  CHECK(bytes_of(here / "F/study.png").starts_with("\x89PNG"));
}

TEST_CASE("a stopped study goes on with --resume, another study is refused, nothing is overwritten unasked") {
  const Workplace here;
  here.import_packing("dense_p20");
  const std::string study = "study " + small_test + grid;
  here.succeeds(study + "-o whole");
  {
    Child child({RVELAB_PROGRAM, "study", "biaxial", here / "S.h5", "--set", "stage.compression.to_strain=0.002",
                 "--increments", "3", "--vary", "solver.target_unbalanced=1e-2,1e-3", "--reference",
                 "solver.fixed_substeps=200", "--threads", "1", "-o", here / "F"},
                here / "out", here / "err");
    for (int k = 0; k < 30'000 && pieces_in(here, "F") == 0; ++k) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    child.signal(SIGINT);
    CHECK(child.wait() == 130);
    CHECK_THAT(bytes_of(here / "err"), Contains("stopped by Ctrl-C with ") && Contains("continue with --resume"));
  }
  const std::size_t kept = pieces_in(here, "F");
  CHECK(kept > 0);
  CHECK(kept < 6);
  const auto first_piece = [&] { return std::filesystem::last_write_time(here / "F/pieces/path_0_1_1.json"); };
  REQUIRE(std::filesystem::exists(here / "F/pieces/path_0_1_1.json"));
  const auto made = first_piece();

  here.refuses(study + "-o F", "F/study.toml: is there already; allowed: a new name, --resume");
  here.refuses(study + "--repeat 2 -o F --resume", "is another study: repeats = 1 there and 2 here");
  here.refuses(study + "--set damping.local=0.2 -o F --resume", "is another study: settings = ");
  CHECK(pieces_in(here, "F") == kept);

  here.succeeds("study F/study.toml -o F --resume");
  CHECK(first_piece() == made);
  CHECK(without_times(OrderedJson::parse(bytes_of(here / "F/study.json"))) ==
        without_times(OrderedJson::parse(bytes_of(here / "whole/study.json"))));

  here.write("F/pieces/path_1_1_1.json", "{");
  here.refuses("study F/study.toml -o F --resume", "path_1_1_1.json: is damaged");
  here.refuses("study F/study.toml -o F --force", "would replace F/study.toml");
  CHECK(here.run(study + "-o F --force --repeat 0").code == 0);
  CHECK(pieces_in(here, "F") == 3);
}

TEST_CASE("mistakes in the command of a study are told in one line that names key, value and remedy") {
  const Workplace here;
  here.import_packing("dense_p20");
  const std::string some = "study " + small_test + "--reference solver.fixed_substeps=200 ";
  here.refuses(some + "--vary solver.target_unbalancd=1e-2", "--vary solver.target_unbalancd=1e-2");
  here.refuses(some + "--vary solver.time_step_factor=0.5,2", "solver.time_step_factor=2: ");
  here.refuses(some + "--vary solver.skin=", "--vary solver.skin= has no values; allowed: KEY=v1,v2");
  here.refuses(some + "--vary solver.skin=0.1 --vary solver.skin=0.2", "varies solver.skin twice");
  here.refuses(some + "--vary loading.mode=quasi_static,at_rate", "loading.mode=at_rate: ");
  here.refuses("study " + small_test + "--vary solver.skin=0.1", "no reference is given");
  here.refuses("study biaxial --reference solver.skin=0.1", "no specimen is given");
  here.refuses("study biaxial none.h5 --reference solver.skin=0.1", "none.h5");
  here.refuses("study none.toml S.h5 --reference solver.skin=0.1", "none.toml: no such file");
  here.refuses(some + "--resume", "--resume is given without -o");
  here.refuses(some + "--repeat -1", "--repeat");
  here.refuses("study biaxial S.h5 --reference solver.skin=0.1 --repeat 0 --increments 0", "leave nothing to run");
  CHECK(here.run("run biaxial --specimen S.h5 --set stage.compression.to_strain=0.001 -o other.h5").code == 0);
  here.write("mine.toml", "[study]\nprotocol = \"biaxial\"\nspecimens = [\"other.h5\"]\ndigests = [\"00000000\"]\n");
  here.refuses("study mine.toml --reference solver.skin=0.1", "is not the specimen of mine.toml");
}

TEST_CASE("every kept study runs, cut short") {
  const Workplace here;
  here.import_packing("dense_p20");
  here.succeeds("pack pack_hertz --set pack.number=100 -o spheres.h5");
  std::size_t studies = 0;
  for (const auto& entry : std::filesystem::directory_iterator(RVELAB_SOURCE_DIR "/protocols/studies")) {
    CAPTURE(entry.path().string());
    const std::string specimen = entry.path().stem() == "tolerance_3d" ? "spheres.h5" : "S.h5";
    const std::string outcome =
        here.succeeds("study '" + entry.path().string() + "' " + specimen +
                      " --increments 1 --repeat 0 --json --set stage.compression.to_strain=0.002 "
                      "--reference solver.fixed_substeps=100");
    const OrderedJson points = OrderedJson::parse(outcome)["points"];
    CHECK(points.size() >= 5);
    for (const OrderedJson& point : points) {
      CAPTURE(point.dump());
      CHECK(point["failed_increments"] == 0);
      CHECK(point["rms_error_over_p"].get<double>() > 0);
    }
    ++studies;
  }
  CHECK(studies >= 7);
}
