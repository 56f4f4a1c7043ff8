// The quick cases of the matrix, a test for each topic; all of them or chosen ones by the hidden test "the matrix"
// (README.md); and what runs and judges them.
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <thread>

#include "rvelab/error.hpp"
#include "tests/catch.hpp"
#include "tests/extreme/matrix.hpp"
#include "tests/extreme/specimens.hpp"
#include "tests/folder.hpp"

using namespace rvelab;
using namespace rvelab::test;
using Catch::Matchers::Contains;

namespace {

/// Those of a second or more of processor time are left to "the matrix".
bool is_long(const Case& one) {
  for (const char* name :
       {"stiffness/ellipses/", "size/contrast/", "deformation/shear_large_increments/", "deformation/gas_and_back/",
        "rate/ellipses/", "rate/flow/", "gas/energy/", "gas/energy_resolved/", "numbers/kernels_ellipses/"})
    if (one.name.starts_with(name)) return true;
  return false;
}

void expect_quick_cases(const std::string& topic) {
  std::vector<Case> cases;
  for (const Case& one : read_matrix())
    if (one.quick && !is_long(one) && one.name.starts_with(topic + "/")) cases.push_back(one);
  REQUIRE_FALSE(cases.empty());
  for (const Result& result : run(cases)) {
    CAPTURE(result.asked->name, result.answer.status, result.seconds);
    CHECK(result.answer.outcome != Outcome::wrong);
  }
}

std::string environment(const char* name, const char* otherwise) {
  const char* value = std::getenv(name);
  return value != nullptr ? value : otherwise;
}

/// Cases of these names, or whose names go on with a slash; "quick" and "all".
std::vector<Case> chosen(const std::string& names, double patience) {
  std::vector<Case> cases;
  for (const Case& one : read_matrix()) {
    bool wanted = false;
    std::istringstream words(names);
    for (std::string word; words >> word;)
      wanted = wanted || word == "all" || (word == "quick" && one.quick) || one.name == word ||
               one.name.starts_with(word + "/");
    if (!wanted) continue;
    cases.push_back(one);
    cases.back().seconds *= patience;
  }
  return cases;
}

nlohmann::ordered_json row_of(const Result& result) {
  const Answer& answer = result.answer;
  nlohmann::ordered_json row = {{"name", result.asked->name},      {"asked", result.asked->asked},
                                {"outcome", name(answer.outcome)}, {"status", answer.status},
                                {"seconds", result.seconds},       {"error", nullptr}};
  if (answer.error) row["error"] = *answer.error;
  char text[20];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(answer.hash.value_or(0)));
  if (answer.hash) row["hash"] = text;
  return row;
}

/// A case of an experiment that is none of the matrix.
Case case_of(const Experiment& experiment) {
  Case one;
  one.name = experiment.name;
  one.experiment = &experiment;
  one.seconds = 60;
  one.memory_MiB = 512;
  return one;
}

/// The cases of a row with these further keys.
std::vector<Case> read(const std::string& keys) {
  const Folder folder;
  write_bytes(folder / "m.toml",
              "[limits]\nseconds = 3\nmemory_MiB = 9\n[[series]]\nexperiment = \"rate/slow\"\nasked = \"x\"\n"
              "invariant = \"x\"\nsource = \"x\"\ntolerance = 1\ncase = [{name = \"a\", " +
                  keys + "}]\n");
  return read_matrix(folder / "m.toml");
}

}  // namespace

TEST_CASE("from soft grains to rigid ones the stress is that of a resolved run", "[extreme][matrix]") {
  expect_quick_cases("stiffness");
}
TEST_CASE("loading of what is no equilibrium is right or flagged", "[extreme][matrix]") {
  expect_quick_cases("statics");
}
TEST_CASE("few, many and unlike grains and thin cells have the stress of their places", "[extreme][matrix]") {
  expect_quick_cases("size");
}
TEST_CASE("far deformed grains have the stress of their places, or are refused", "[extreme][matrix]") {
  expect_quick_cases("deformation");
}
TEST_CASE("the error of many increments does not add up", "[extreme][matrix]") { expect_quick_cases("increments"); }
TEST_CASE("energy closes and momentum is kept at any rate", "[extreme][matrix]") { expect_quick_cases("rate"); }
TEST_CASE("two grains part at the speed that energy and restitution give", "[extreme][matrix]") {
  expect_quick_cases("impact");
}
TEST_CASE("a gas keeps its energy", "[extreme][matrix]") { expect_quick_cases("gas"); }
TEST_CASE("units, denormals, what is no number, and instruction sets", "[extreme][matrix]") {
  expect_quick_cases("numbers");
}

TEST_CASE("the matrix", "[.]") {
  const double patience = std::stod(environment("RVELAB_PATIENCE", "1"));
  const std::vector<Case> cases = chosen(environment("RVELAB_CASES", "all"), patience);
  REQUIRE_FALSE(cases.empty());
  const auto at_a_time = unsigned(std::stoul(environment("RVELAB_JOBS", "0")));
  const auto results = run(cases, at_a_time > 0 ? at_a_time : std::max(1u, std::thread::hardware_concurrency()));
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  std::map<std::string, int> count;
  for (const Result& result : results) {
    rows.push_back(row_of(result));
    ++count[name(result.answer.outcome)];
    std::printf("%-7s %6.2f s  %-9s  %s: %s\n", name(result.answer.outcome), result.seconds,
                result.answer.error ? in_words(*result.answer.error).c_str() : "-", result.asked->name.c_str(),
                result.answer.status.c_str());
  }
  std::printf("%zu cases: %d right, %d refused, %d WRONG\n", cases.size(), count["right"], count["refused"],
              count["WRONG"]);
  if (const std::string file = environment("RVELAB_JSON", ""); !file.empty())
    std::ofstream(file) << nlohmann::ordered_json{{"cases", rows}}.dump(1) << "\n";
  CHECK(count["WRONG"] == 0);
}

TEST_CASE("all cases of the matrix have different names, and end within a minute") {
  std::set<std::string> names;
  for (const Case& one : read_matrix()) {
    CAPTURE(one.name);
    CHECK(names.insert(one.name).second);
    CHECK(one.seconds <= 60);
  }
}

TEST_CASE("a case with varied parameters is one for each combination") {
  const auto cases = read("vary = {critical_steps = [1e4, 4.9e-324, 0.5, true]}, quick = {critical_steps = [0.5]}");
  REQUIRE(cases.size() == 4);
  CHECK(cases[0].name == "a/critical_steps=1e4");
  CHECK(cases[1].name == "a/critical_steps=4.940656458e-324");
  CHECK(cases[2].name == "a/critical_steps=0.5");
  CHECK(cases[3]("critical_steps") == 1);
  for (const Case& one : cases) CHECK(one.quick == (one("critical_steps") == 0.5));
  CHECK(cases[0]("local_damping") == 0.3);
  CHECK(cases[0].memory_MiB == 9);
  CHECK(read("seconds = 5")[0].seconds == 5);
  for (const char* wrong : {"tolerence = 2", "with = {kappa = 1}", "vary = {kappa = [1]}",
                            "vary = {critical_steps = [1]}, quick = {critical_steps = [2]}"})
    CHECK_THROWS(read(wrong));
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

TEST_CASE("a case that crashes, hangs or lacks memory is WRONG, and the others go on") {
  const std::vector<Experiment> ways = {
      {"right",
       [](const Case&, Verdict& verdict) {
         verdict.law("a half", 0.5, 1);
         verdict.bits(0);
       },
       {}},
      {"refused",
       [](const Case&, Verdict& verdict) { Tested(lone_grain(2, 1.95), verdict).apply(entry(0, 0, -2), 0); },
       {}},
      {"crash", [](const Case&, Verdict&) { std::raise(SIGSEGV); }, {}},
      {"hang",
       [](const Case&, Verdict&) {
         for (volatile long turns = 0;;) turns = turns + 1;
       },
       {}},
      {"sleep", [](const Case&, Verdict&) { std::this_thread::sleep_for(std::chrono::hours(1)); }, {}},
      {"exit", [](const Case&, Verdict&) { std::_Exit(3); }, {}},
      {"silent", [](const Case&, Verdict&) { std::_Exit(0); }, {}},
      {"memory",
       [](const Case&, Verdict& verdict) {  // written to, so that it is resident
         std::vector<std::vector<char>> blocks;
         for (int k = 0; k < 1024; ++k) blocks.emplace_back(std::size_t(1) << 20, char(k));
         verdict.law("a gibibyte was given", blocks.size() > 0);
       },
       {}}};
  std::vector<Case> cases;
  for (const Experiment& way : ways) cases.push_back(case_of(way));
  cases[3].seconds = 1;
  cases[4].seconds = 0.05;
  cases.push_back(cases[1]);
  cases.back().may_refuse = true;
  const auto results = run(cases, 8);
  REQUIRE(results.size() == 9);
  const char* said[] = {"ok",          "refused: ", "signal 11",    "time limit", "time limit",
                        "exit code 3", "no answer", "memory limit", "refused: "};
  for (std::size_t k = 0; k < results.size(); ++k) {
    const Answer& answer = results[k].answer;
    CAPTURE(results[k].asked->name, answer.status);
    CHECK(answer.outcome == (k == 0 ? Outcome::right : k == 8 ? Outcome::refused : Outcome::wrong));
    CHECK_THAT(answer.status, Catch::Matchers::StartsWith(said[k]));
  }
  CHECK(results[0].answer.error == 0.5);
  CHECK(results[0].answer.hash == 0xa8c7f832281a39c5);  // FNV-1a of eight zero bytes
  CHECK_FALSE(results[2].answer.error);
}
