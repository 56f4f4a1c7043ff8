// The files of a sheet of made tests; the browser that tests/adapters/test_sheet_page.py drives opens its page.
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "rvelab/sheet/element_tests.hpp"
#include "rvelab/sheet/numbers.hpp"
#include "rvelab/sheet/write_sheet.hpp"
#include "tests/catch.hpp"
#include "tests/folder.hpp"
#include "tests/sheet/made_tests.hpp"

using namespace rvelab;
using Catch::Matchers::Contains;
using namespace rvelab::test;

TEST_CASE("a sheet of made tests is written, page and numbers", "[page]") {
  const char* const asked = std::getenv("RVELAB_SHEET");  // of the browser's test, which needs the files afterwards
  const Folder own;
  const std::filesystem::path folder = asked != nullptr ? asked : own.path();
  const std::vector<Test> tests = bolton_tests(3, 9.2, 3, 0.05);
  sheet::Sheet made = sheet::numbers_of(tests, "made sand");
  made.numbers.front().published = 33;
  made.numbers.front().published_by = "somebody";
  models::Fit fit;
  fit.model = "made model";
  fit.parameters = {{"E50_ref", "Pa", "stiffness", 40e6, 38e6, 42e6}};
  fit.calculated = sheet::element_tests(tests);
  for (const models::ElementTest& test : fit.calculated)
    fit.misfits.push_back({test.name, test.fitted, 0.02, 0.001, ""});
  sheet::write_sheet(made, {fit}, folder.string());
  CHECK_THAT(bytes_of((folder / "index.html").string()), Contains("made sand") && Contains("made model"));
  const auto summary = nlohmann::json::parse(bytes_of((folder / "summary.json").string()));
  CHECK(summary.at("numbers").size() == made.numbers.size());
  CHECK(summary.at("numbers").front().at("published") == 33);
  CHECK(summary.at("models").front().at("misfits").size() == fit.misfits.size());
  CHECK_THAT(bytes_of((folder / "summary.csv").string()), Contains(made.numbers.front().key));
}
