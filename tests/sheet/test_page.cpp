// A page of made tests for the browser that tests/adapters/test_sheet_page.py drives; run by its name alone.
#include <cstdlib>

#include "rvelab/sheet/element_tests.hpp"
#include "rvelab/sheet/numbers.hpp"
#include "rvelab/sheet/write_sheet.hpp"
#include "tests/catch.hpp"
#include "tests/sheet/made_tests.hpp"

using namespace rvelab;
using namespace rvelab::test;

TEST_CASE("a sheet of made tests is written to the folder RVELAB_SHEET", "[.][page]") {
  const char* const folder = std::getenv("RVELAB_SHEET");
  REQUIRE(folder != nullptr);
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
  sheet::write_sheet(made, {fit}, folder);
}
