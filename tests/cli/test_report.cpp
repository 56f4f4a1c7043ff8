// rvelab report: one page of tests that loads nothing, and what it says when it cannot be made.
#include "tests/program.hpp"

using namespace rvelab::test;
using Catch::Matchers::Contains;
using Json = nlohmann::json;

namespace {

void make_two_tests(const Workplace& here) {
  here.import_packing("dense_p20");
  std::filesystem::create_directory(here / "records");
  for (const std::string test :
       {"biaxial --set stage.compression.to_strain=0.03 --set output.snapshots_every=30 -o records/b.h5",
        "oedometer --set test.pressure_Pa=20e3 --set stage.large.to_strain=0.002 -o records/o.h5"}) {
    here.succeeds("run " + test + " --specimen S.h5");
  }
}

/// What the page holds.
Json data_of(const std::string& page) {
  const std::string mark = "<script type=\"application/json\" id=\"data\">";
  const auto begin = page.find(mark) + mark.size();
  return Json::parse(page.substr(begin, page.find("</script>", begin) - begin));
}

const Json& column_of(const Json& run, const std::string& key) {
  for (const Json& column : run["columns"])
    if (column["key"] == key) return column;
  throw std::runtime_error("no column " + key);
}

}  // namespace

TEST_CASE("report puts every test of a folder into one page that loads nothing from elsewhere") {
  const Workplace here;
  make_two_tests(here);
  const Outcome outcome = here.run("report records -o page.html --title 'A <title> & more'");
  CAPTURE(outcome.output, outcome.errors);
  REQUIRE(outcome.code == 0);
  CHECK(outcome.errors.empty());
  CHECK_THAT(outcome.output, Contains("page.html: 2 tests, "));
  const std::string page = bytes_of(here / "page.html");
  CHECK_THAT(page, Contains("<title>A &lt;title> &amp; more</title>") && Contains("default-src 'none'"));
  const Json data = data_of(page);
  CHECK(data["title"] == "A <title> & more");
  REQUIRE(data["sections"].size() == 2);
  const Json &biaxial = data["sections"][0], &run = biaxial["runs"][0];
  CHECK(biaxial["name"] == "biaxial compression, 2D");
  CHECK(data["sections"][1]["name"] == "oedometer, 2D");

  // The angle is that which `measure` and `run` print, to three digits.
  const Json measured =
      Json::parse(here.run("run biaxial --specimen S.h5 --set stage.compression.to_strain=0.03 --json").output);
  CHECK(biaxial["strength"][0]["angle"].get<double>() ==
        Approx(measured["peak_friction_angle_deg"].get<double>()).epsilon(1e-5));
  CHECK_THAT(biaxial["strength"][0]["words"].get<std::string>(), Contains("riction angle 32."));
  CHECK_THAT(biaxial["errors_in_words"].get<std::string>(), Contains("of the mean stress p in the mean"));

  // Every 30th state and the end, with the grains of the specimen.
  const std::size_t records = column_of(run, "strain")["values"].size();
  const Json& states = run["states"]["states"];
  CHECK(states.size() == (records - 1) / 30 + 1 + ((records - 1) % 30 == 0 ? 0 : 1));
  CHECK(states.back()["record"] == records - 1);
  CHECK(run["states"]["grains"].get<int>() > 100);
  CHECK(column_of(run, "q")["errors"].size() == records);

  // The same records, the same page; it is not written over without --force.
  here.refuses("report records -o page.html", "--force");
  const std::string again =
      here.succeeds("report records/b.h5 records/o.h5 -o page.html --title 'A <title> & more' --force --json");
  CHECK(Json::parse(again)["tests"] == 2);
  CHECK(bytes_of(here / "page.html") == page);
}

TEST_CASE("report thins states that would make a page too large, and says so") {
  const Workplace here;
  here.import_packing("dense_p20");
  here.succeeds(
      "run biaxial --specimen S.h5 --set stage.compression.to_strain=0.01 --set output.snapshots_every=1 "
      "-o b.h5");
  const Outcome whole = here.run("report b.h5 -o whole.html"),
                thin = here.run("report b.h5 -o thin.html --states-MB 0.1");
  CHECK(whole.errors.empty());
  CHECK_THAT(thin.errors, Contains("states that the tests kept is in the page") && Contains("--states-MB"));
  const Json all = data_of(bytes_of(here / "whole.html"))["sections"][0]["runs"][0],
             few = data_of(bytes_of(here / "thin.html"))["sections"][0]["runs"][0];
  CHECK(few["states"]["states"].size() < all["states"]["states"].size() / 2);
  CHECK(few["states"]["states"].front()["record"] == 0);
  CHECK(few["states"]["states"].back()["record"] == all["states"]["states"].back()["record"]);
  CHECK(few["columns"] == all["columns"]);
}

TEST_CASE("report names what is missing: records, a folder") {
  const Workplace here;
  make_two_tests(here);
  std::filesystem::create_directory(here / "empty");
  here.refuses("report none.h5 -o page.html", "none.h5: is not there");
  here.refuses("report empty -o page.html", "has no *.h5, nor history.csv");
  here.refuses("report S.h5 -o page.html", "S.h5: holds a specimen and no records");
  here.refuses("report records -o none/page.html", "none");
  here.refuses("report records/b.h5 -o records/b.h5 --force", "records/b.h5");
  here.refuses("report records -o page.html --states-MB 0", "--states-MB");
  here.succeeds("run probe --specimen S.h5 -o records/probe.h5");
  here.refuses("report records/probe.h5 -o page.html", "holds no record");
  CHECK(!std::filesystem::exists(here / "page.html"));
  const Outcome rest = here.run("report records -o page.html");
  CHECK(rest.code == 0);
  CHECK_THAT(rest.errors, Contains("left out: records/probe.h5 holds no record"));
  // A specimen beside the records of a folder is none of them.
  std::filesystem::copy(here / "S.h5", here / "records/S.h5");
  const std::string beside = here.succeeds("report records -o page.html --force");
  CHECK_THAT(beside, Contains("2 tests, "));
}
