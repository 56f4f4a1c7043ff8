// rvelab report: one page of tests that loads nothing, and what it says when it cannot be drawn.
#include "tests/cli/program.hpp"

using namespace rvelab::test;
using Catch::Matchers::Contains;

namespace {

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

/// The page without the bytes of its film: ffmpeg promises none.
std::string without_film(std::string page) {
  for (const char* kind : {"data:video/mp4", "data:image/gif"}) {
    const auto begin = page.find(kind);
    if (begin != std::string::npos) page.erase(begin, page.find('"', begin) - begin);
  }
  return page;
}

void make_two_tests(const Workplace& here) {
  here.import_packing("dense_p20");
  std::filesystem::create_directory(here / "records");
  for (const std::string test :
       {"biaxial --set stage.compression.to_strain=0.03 --set output.snapshots_every=30 -o records/b.h5",
        "oedometer --set test.pressure_Pa=20e3 --set stage.large.to_strain=0.002 -o records/o.h5"}) {
    const Outcome outcome = here.run("run " + test + " --specimen S.h5");
    INFO(outcome.errors);
    REQUIRE(outcome.code == 0);
  }
}

}  // namespace

TEST_CASE("report draws every test of a folder into one page that loads nothing from elsewhere") {
  const Workplace here;
  make_two_tests(here);
  const Outcome outcome = here.run("report records -o page.html --title 'A <title> & more'");
  CAPTURE(outcome.output, outcome.errors);
  REQUIRE(outcome.code == 0);
  CHECK(outcome.errors.empty());
  CHECK_THAT(outcome.output, Contains("page.html: 2 tests, "));
  const std::string page = bytes_of(here / "page.html");
  CHECK_THAT(page, Contains("<h1>A &lt;title&gt; &amp; more</h1>") && Contains("biaxial compression, 2D") &&
                       Contains("oedometer, 2D") && Contains("Mohr circles") && Contains("<h3>Film</h3>"));
  // The angle is that which `run` prints.
  CHECK_THAT(page, Contains("peak friction angle 32.") || Contains("Peak friction angle 32."));
  CHECK(count_of(page, "<figure>") > 8);
  std::size_t sources = 0;
  for (const char* word : {"src=\"", "href=\""}) {
    CHECK(count_of(page, word) == count_of(page, std::string(word) + "data:"));
    sources += count_of(page, word);
  }
  CHECK(sources > count_of(page, "<figure>"));
  CHECK(count_of(page, "<script") == 0);

  // The same records, the same page; it is not written over without --force.
  expect_mistake(here.run("report records -o page.html"), "--force");
  const Outcome again =
      here.run("report records/b.h5 records/o.h5 -o page.html --title 'A <title> & more' --force --json");
  CHECK(again.code == 0);
  CHECK_THAT(again.output, Contains("\"tests\": 2"));
  CHECK(without_film(bytes_of(here / "page.html")) == without_film(page));
}

TEST_CASE("report names what is missing: records, a folder, a Python with the packages") {
  const Workplace here;
  make_two_tests(here);
  std::filesystem::create_directory(here / "empty");
  expect_mistake(here.run("report none.h5 -o page.html"), "none.h5: is not there");
  expect_mistake(here.run("report empty -o page.html"), "no record file with records there");
  expect_mistake(here.run("report S.h5 -o page.html"), "S.h5: not a record file of rvelab");
  expect_mistake(here.run("report records -o none/page.html"), "none");
  expect_mistake(here.run("report records/b.h5 -o records/b.h5 --force"), "records/b.h5");
  // A Python without the site packages of Debian, as a program that the variable names.
  here.write("bare_python", "#!/bin/sh\nexec /usr/bin/python3 -S \"$@\"\n");
  std::filesystem::permissions(here / "bare_python", std::filesystem::perms::owner_all);
  expect_mistake(
      here.run("RVELAB_PYTHON=./bare_python '" RVELAB_PROGRAM "' report records -o page.html", "/usr/bin/env"),
      "apt-get install python3-h5py python3-matplotlib, or let RVELAB_PYTHON name one");
  CHECK(!std::filesystem::exists(here / "page.html"));
}
