// The matrix file as it is read, and what a verdict makes of measures, flags and refusals.
#include <cmath>
#include <fstream>
#include <set>

#include "rvelab/error.hpp"
#include "rvelab/stress_test/run_case.hpp"
#include "tests/catch.hpp"
#include "tests/cli/program.hpp"

using namespace rvelab;
using namespace rvelab::stress_test;
using Catch::Matchers::Contains;

namespace {

const char* const good_case =
    "[[case]]\n"
    "name = \"a\"\n"
    "experiment = \"self/right\"\n"
    "asked = \"x\"\n"
    "invariant = \"x\"\n"
    "source = \"definition\"\n"
    "tolerance = 1\n"
    "seconds = 5\n"
    "memory_MiB = 512\n";

std::vector<Case> read(const std::string& text) {
  const test::Workplace here;
  std::ofstream(here / "m.toml") << text;
  return read_matrix(here / "m.toml");
}

std::string mistakes(const std::string& text) {
  try {
    read(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("the matrix has at least 120 cases, 40 of them quick, all of different names") {
  const auto cases = read_matrix(RVELAB_SOURCE_DIR "/tests/extreme/matrix.toml");
  std::set<std::string> names;
  std::size_t quick = 0;
  for (const Case& one : cases) {
    names.insert(one.name);
    quick += one.quick ? 1 : 0;
    CAPTURE(one.name);
    CHECK(one.seconds <= 60);
    CHECK(!one.experiment.starts_with("self/"));
  }
  CHECK(cases.size() >= 120);
  CHECK(quick >= 40);
  CHECK(names.size() == cases.size());
}

TEST_CASE("a case with varied parameters is one for each combination") {
  const auto cases = read(std::string(good_case) + "vary = {value = [1e4, -2, 0.5, true]}\nquick = {value = [-2]}\n");
  REQUIRE(cases.size() == 4);
  CHECK(cases[0].name == "a/value=1e4");
  CHECK(cases[1].name == "a/value=-2");
  CHECK(cases[2].name == "a/value=0.5");
  CHECK(cases[3]("value") == 1);
  for (const Case& one : cases) CHECK(one.quick == (one("value") == -2));
  CHECK(read(good_case)[0]("value") == 0);
  CHECK(read(std::string("[limits]\nseconds = 3\nmemory_MiB = 9\n") + good_case)[0].seconds == 5);
  for (const auto& [value, text] : std::map<double, std::string>{{1e-9, "1e-9"},
                                                                 {1.5e300, "1.5e300"},
                                                                 {5e-324, "4.940656458e-324"},
                                                                 {1000, "1000"},
                                                                 {0, "0"},
                                                                 {1e-3, "0.001"}})
    CHECK(written_number(value) == text);
}

TEST_CASE("a bad matrix file is refused with its lines") {
  CHECK_THAT(mistakes("[[case]\n"), Contains("m.toml:1: ") && Contains("is not TOML"));
  CHECK_THAT(mistakes(""), Contains("no [[case]]"));
  CHECK_THAT(mistakes("[[cases]]\n"), Contains("m.toml:1: unknown key cases"));
  CHECK_THAT(mistakes(std::string("[limits]\nsecond = 3\n") + good_case),
             Contains("m.toml:2: unknown key limits.second;"));
  CHECK_THAT(mistakes(std::string(good_case) + "tolerence = 2\n"),
             Contains("m.toml:10: unknown key case.tolerence; the nearest is tolerance"));
  CHECK_THAT(mistakes(std::string(good_case) + "with = {valeu = 2}\n"),
             Contains("m.toml:10: experiment self/right has no parameter valeu; the nearest is value"));
  CHECK_THAT(mistakes(std::string(good_case) + "vary = {value = [\"x\"]}\n"), Contains("m.toml:10: case.vary.value"));
  CHECK_THAT(mistakes(std::string(good_case) + "quick = {value = [3]}\n"),
             Contains("m.toml:10: case.quick names value"));
  CHECK_THAT(mistakes(std::string(good_case) + good_case), Contains("m.toml:10: case \"a\" is there twice"));
  const auto with = [](const std::string& from, const std::string& to) {
    std::string text = good_case;
    return mistakes(text.replace(text.find(from), from.size(), to));
  };
  CHECK_THAT(with("self/right", "self/ritgh"), Contains("m.toml:3: unknown experiment") && Contains("self/right"));
  CHECK_THAT(with("seconds = 5", "seconds = 500"), Contains("m.toml:8: case.seconds = 500 is out of range"));
  CHECK_THAT(with("tolerance = 1", "tolerance = \"1\""), Contains("m.toml:7: case.tolerance"));
  CHECK_THAT(with("source = \"definition\"\n", ""), Contains("m.toml:1: case.source is missing"));
}

TEST_CASE("laws hold whatever the solver says; agreements may be excused by a flag") {
  Report flag;
  flag.target_held = false;
  for (const bool may_flag : {false, true}) {
    Verdict agreement, law;
    agreement.law("a law", 0.5, 1);
    agreement.agreement("a run", 3, 2);
    law.law("a law", 3, 2);
    for (Verdict* verdict : {&agreement, &law}) {
      CHECK(verdict->answer(may_flag).outcome == Outcome::wrong);
      verdict->note(flag);
    }
    CHECK(agreement.answer(may_flag).outcome == (may_flag ? Outcome::right : Outcome::wrong));
    CHECK(agreement.answer(may_flag).error == 1.5);
    CHECK(law.answer(may_flag).outcome == Outcome::wrong);
    CHECK_THAT(law.answer(may_flag).status, Contains("a law: 3, allowed 2"));
  }
  Verdict none, nan;
  CHECK(none.answer(true).outcome == Outcome::wrong);
  nan.law("NaN", std::nan(""), 1);
  CHECK(nan.answer(true).outcome == Outcome::wrong);
}

TEST_CASE("a refusal is an answer only where it is allowed, with a remedy and an unchanged state") {
  const Verdict verdict;
  const Refused good{"too much; apply it in smaller parts", true}, changed{good.text, false}, mute{"no", true};
  CHECK(verdict.answer(good, true).outcome == Outcome::refused);
  CHECK(verdict.answer(good, false).outcome == Outcome::wrong);
  CHECK(verdict.answer(changed, true).outcome == Outcome::wrong);
  CHECK(verdict.answer(mute, true).outcome == Outcome::wrong);
  const auto asked = [](const std::optional<Refused>& found) {
    Verdict required;
    required.refusal("a thing", found);
    return required.answer(false).outcome;
  };
  CHECK(asked(good) == Outcome::refused);
  CHECK(asked(changed) == Outcome::wrong);
  CHECK(asked(mute) == Outcome::wrong);
  CHECK(asked(std::nullopt) == Outcome::wrong);
}

TEST_CASE("an answer comes through a pipe as it was, and what is no answer is WRONG") {
  Answer answer;
  answer.outcome = Outcome::refused;
  answer.status = "two\nlines";
  answer.error = 0.1;
  answer.hash = 0xfedcba9876543210;
  const Answer back = read_answer(written_answer(answer));
  CHECK(back.outcome == Outcome::refused);
  CHECK(back.status == "two lines");
  CHECK(back.error == 0.1);
  CHECK(back.hash == answer.hash);
  CHECK(read_answer("").outcome == Outcome::wrong);
  CHECK(read_answer("").status == "no answer");
}
