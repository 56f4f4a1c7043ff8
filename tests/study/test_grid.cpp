// Grids, Pareto fronts, summaries, and studies as files.
#include <cmath>
#include <limits>

#include "rvelab/study/summary.hpp"
#include "tests/refusal.hpp"
#include "tests/study/studies.hpp"

using namespace rvelab;
using namespace rvelab::test;
using Catch::Matchers::Contains;

TEST_CASE("values of a variation are apart by commas outside of brackets and quotation marks", "[study]") {
  using Values = std::vector<std::string>;
  CHECK(study::parsed_variation("a.b=1e-2, 1e-3,word").values == Values{"1e-2", "1e-3", "word"});
  CHECK(study::parsed_variation("a.b=[1, 2],[3]").values == Values{"[1, 2]", "[3]"});
  CHECK(study::parsed_variation("a.b=\"x,y\",{xx = 1, yy = 2}").values == Values{"\"x,y\"", "{xx = 1, yy = 2}"});
  for (const auto& [text, part] : {std::pair{"a.b", "has no values"},
                                   {"a.b=", "has no values"},
                                   {"=1", "names no key"},
                                   {"a.b=1,,2", "has an empty value"},
                                   {"a.b=1,2,1", "has the value 1 twice"}}) {
    CAPTURE(text);
    CHECK_THAT(input_error([&, text = text] { study::parsed_variation(text); }),
               Contains(std::string("--vary ") + text + " " + part));
  }
}

TEST_CASE("a grid is the product of its variations, the last one turning fastest", "[study]") {
  const std::vector<study::Variation> grid{{"a.x", {"1", "2"}}, {"b.y", {"u", "v", "w"}}};
  REQUIRE(study::points_in(grid) == 6);
  std::string all;
  for (std::size_t k = 0; k < 6; ++k) all += study::name_of(study::assignments_at(grid, k)) + "; ";
  CHECK(all == "a.x=1, b.y=u; a.x=1, b.y=v; a.x=1, b.y=w; a.x=2, b.y=u; a.x=2, b.y=v; a.x=2, b.y=w; ");
  CHECK(study::points_in({}) == 1);
  const std::vector<std::string> many(101, "1");
  CHECK_THROWS_AS(study::points_in({{"a", many}, {"b", many}}), InputError);
}

TEST_CASE("the Pareto front holds what no other run beats in cost and error at once", "[study]") {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  const std::vector<study::Standing> runs{{1, 9}, {2, 5}, {3, 5}, {2, 7}, {4, 1}, {4, 1}, {5, 2}, {none, 0}, {0, none}};
  CHECK(study::pareto_front(runs) == std::vector<bool>{true, true, false, false, true, true, false, false, false});
}

TEST_CASE("a summary of errors gives rms, median, 95th percentile and largest", "[study]") {
  std::vector<double> errors;
  for (int k = 100; k >= 1; --k) errors.push_back(k);
  const study::ErrorSummary found = study::summary_of(errors);
  CHECK(found.rms == Approx(std::sqrt(338350.0 / 100)));  // sum of squares of 1 to 100
  CHECK(found.median == 50.5);
  CHECK(found.percentile_95 == 95);
  CHECK(found.largest == 100);
  CHECK(study::summary_of(std::vector<double>{3, 1, 2}).median == 2);
  CHECK(std::isnan(study::summary_of(std::vector<double>{}).rms));
}

TEST_CASE("a summary of estimates gives their median over the error, and the shares of errors within them", "[study]") {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  const auto found = study::summary_of_estimates({1, 2, 4, 0}, {2, 6, 2, 1}, {1, 1, 1, 1});
  CHECK(found.median_over_error == 2);  // of 2, 3 and 1/2; an error of zero has no ratio
  CHECK(found.covered == 0.75);
  CHECK(found.allowed == 0.5);
  CHECK(std::isnan(study::summary_of_estimates({1, 2}, {none, none}, {none, none}).covered));
}

TEST_CASE("a study comes back from its file, and differences are told by name", "[study]") {
  study::Study study = small_study();
  study.settings = {"contact.slip=consistent"};
  study.digests = {"0123abcd"};
  study.relaxation.unbalanced = 1e-7;
  study.made_with = "rvelab 0";
  const std::string text = study::written(study);
  const study::Study back = study::read_study(toml::parse(text), "study.toml");
  CHECK(study::difference(back, study).empty());
  CHECK(back.protocol_text == shear_text);
  CHECK(study::written(back) == text);

  study::Study other = study;
  other.repeats = 3;
  CHECK(study::difference(back, other) == "repeats = 2 there and 3 here");
  other = study;
  other.grid[0].values.pop_back();
  CHECK_THAT(study::difference(back, other), Contains("vary = ") && Contains("1e-6 there and "));
  other = study;
  other.protocol_text += "\n";
  CHECK(study::difference(back, other) == "another protocol there");
}

TEST_CASE("values of a study file may be numbers, words and truths", "[study]") {
  const study::Study study = study::read_study(
      toml::parse("[study]\nprotocol = \"biaxial\"\n[[vary]]\nkey = \"a.b\"\nvalues = [3e-3, 5, \"word\", true]\n"),
      "study.toml");
  CHECK(study.grid.at(0).values == std::vector<std::string>{"0.003", "5", "word", "true"});
  CHECK(study.increments == 300);
}

TEST_CASE("mistakes in a study file are told with their lines", "[study]") {
  const auto refusal = [](const std::string& text) {
    return input_error([&] { study::read_study(toml::parse(text), "study.toml"); });
  };
  CHECK_THAT(refusal("[study]\nprotocol = \"biaxial\"\nrepeat = 3\n"),
             Contains("study.toml:3: unknown key study.repeat; the nearest known key is study.repeats"));
  CHECK_THAT(refusal("[study]\nprotocol = \"biaxial\"\nrepeats = -1\n"), Contains("study.toml:3: study.repeats = -1"));
  CHECK_THAT(refusal("[study]\nprotocol = \"biaxial\"\nreference = \"a=1\"\n"),
             Contains("study.toml:3: study.reference = "));
  CHECK_THAT(refusal("[study]\n"), Contains("exactly one of them names the test"));
  CHECK_THAT(refusal("[study]\nprotocol = \"biaxial\"\n[[vary]]\nkey = \"a.b\"\nvalues = []\n"),
             Contains("study.toml:3: vary needs a key and values"));
  CHECK_THAT(refusal("[study]\nprotocol = \"biaxial\"\n[[vary]]\nkey = \"a.b\"\nvalue = [1]\n"),
             Contains("unknown key vary.value; the nearest known key is vary.values"));
}

TEST_CASE("every mistake of a grid point is refused before anything runs", "[study]") {
  const Specimen specimen = few_discs();
  const auto refusal = [&](auto change) {
    study::Study study = small_study();
    change(study);
    return input_error([&] { study::prepared(study, "test.toml", {specimen}); });
  };
  CHECK_THAT(refusal([](auto& s) { s.grid[0].key = "solver.target_unbalancd"; }),
             Contains("--vary solver.target_unbalancd=1e-3"));
  CHECK_THAT(refusal([](auto& s) { s.grid[0].values[1] = "-3"; }), Contains("solver.target_unbalanced=-3: "));
  CHECK_THAT(refusal([](auto& s) { s.reference = {"solver.fixed_substeps=-1"}; }),
             Contains("--reference solver.fixed_substeps=-1"));
  CHECK_THAT(refusal([](auto& s) { s.reference.clear(); }), Contains("no reference is given"));
  CHECK_THAT(refusal([](auto& s) { s.repeats = s.increments = 0; }), Contains("leave nothing to run"));
  // A key that is right by itself and does not go with the others at one point.
  CHECK_THAT(refusal([](auto& s) { s.grid = {{"loading.rate_1_s", {"1"}}}; }), Contains("loading.rate_1_s=1: "));
  CHECK_THAT(refusal([](auto& s) {
               s.grid = {{"loading.mode", {"quasi_static", "at_rate"}}};
               s.settings = {};
             }),
             Contains("loading.mode=at_rate: "));
  CHECK_THAT(refusal([](auto& s) {
               s.settings = {"loading.mode=at_rate", "loading.rate_1_s=1"};
               s.grid = {{"loading.rate_1_s", {"1", "2"}}};
             }),
             Contains("loading.rate_1_s=2: the loading"));
  CHECK_THAT(refusal([](auto& s) { s.grid = {{"stage.shear.to_strain", {"0.1"}}}; }), Contains("names no stage"));
  CHECK_THAT(refusal([](auto& s) {
               s.grid = {{"material.clay.friction", {"0.3"}}};
             }),
             Contains("material.clay.friction=0.3: "));
}
