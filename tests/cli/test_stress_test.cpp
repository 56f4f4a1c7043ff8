// rvelab stress-test: what it prints, what it makes of children that end badly, and how it ends itself.
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/child.hpp"
#include "tests/cli/program.hpp"

using namespace rvelab::test;
using Catch::Matchers::Contains;

namespace {

/// One case for each experiment of self.cpp; `hanging`: limit of the one that never ends, s. Those that end have a
/// limit that they do not reach on a busy machine either.
void write_matrix(const Workplace& here, double hanging = 1) {
  std::ofstream file(here / "m.toml");
  for (const char* name : {"right", "wrong", "refuse", "crash", "hang", "sleep", "memory"})
    file << "[[case]]\nname = \"" << name << "\"\nexperiment = \"self/" << name
         << "\"\nasked = \"x\"\ninvariant = \"x\"\nsource = \"definition\"\ntolerance = 1\nseconds = "
         << (std::string(name) == "sleep"  ? 0.2
             : std::string(name) == "hang" ? hanging
                                           : 60)
         << "\nmemory_MiB = 512\nquick = " << (std::string(name) == "right" ? "true" : "false") << "\n";
  file << "[[case]]\nname = \"may_refuse\"\nexperiment = \"self/refuse\"\nasked = \"x\"\ninvariant = \"x\"\n"
          "source = \"definition\"\ntolerance = 1\nseconds = 5\nmemory_MiB = 512\nmay_refuse = true\n";
}

}  // namespace

TEST_CASE("stress-test tells how each case ended, whatever becomes of its process") {
  const Workplace here;
  write_matrix(here);
  const Outcome outcome = here.run("stress-test --matrix m.toml --json --jobs 8");
  INFO(outcome.output << outcome.errors);
  CHECK(outcome.code == 1);
  const auto cases = nlohmann::json::parse(outcome.output)["cases"];
  REQUIRE(cases.size() == 8);
  const auto check = [&](int index, const char* name, const char* verdict, const std::string& status) {
    const auto& one = cases[std::size_t(index)];
    CAPTURE(one.dump());
    CHECK(one["name"] == name);
    CHECK(one["asked"] == "x");
    CHECK(one["outcome"] == verdict);
    CHECK_THAT(one["status"].get<std::string>(), Catch::Matchers::StartsWith(status));
    CHECK(one["seconds"].is_number());
    CHECK(one.contains("error"));
  };
  check(0, "right", "right", "ok");
  check(1, "wrong", "WRONG", "two: 2, allowed 1");
  check(2, "refuse", "WRONG", "refused: ");
  check(3, "crash", "WRONG", "");
  CHECK_THAT(cases[3]["status"].get<std::string>(), Contains("signal 11") || Contains("exit code"));  // a sanitizer's
  check(4, "hang", "WRONG", "time limit");
  check(5, "sleep", "WRONG", "time limit");
  check(6, "memory", "WRONG", "memory limit");
  check(7, "may_refuse", "refused", "refused: ");
  CHECK(cases[0]["error"] == 0.5);
  CHECK(cases[0]["hash"] == "a8c7f832281a39c5");  // FNV-1a of eight zero bytes
  CHECK(cases[3]["error"].is_null());
}

TEST_CASE("stress-test prints a table with a line of counts, and exits with 0 where nothing is WRONG") {
  const Workplace here;
  write_matrix(here);
  const Outcome right = here.run("stress-test --matrix m.toml --quick");
  CHECK(right.code == 0);
  CHECK_THAT(right.output, Contains("case") && Contains("error/allowed") && Contains("right") &&
                               Contains("\n1 cases: 1 right, 0 refused, 0 WRONG\n"));
  const Outcome some = here.run("stress-test --matrix m.toml --case wrong may_refuse right --jobs 1");
  CHECK(some.code == 1);
  CHECK_THAT(some.output, Contains("\n3 cases: 1 right, 1 refused, 1 WRONG\n"));
}

TEST_CASE("stress-test answers a user's mistakes with exit code 2") {
  const Workplace here;
  write_matrix(here);
  expect_mistake(here.run("stress-test --matrix m.toml --case crahs"),
                 "no case \"crahs\"; the nearest is crash; see rvelab stress-test --list");
  expect_mistake(here.run("stress-test --matrix m.toml --case wrong --quick"), "none of these cases is quick");
  expect_mistake(here.run("stress-test --matrix none.toml"), "none.toml: no such file");
  expect_mistake(here.run("stress-test --jobs 0"), "--jobs");
  std::ofstream(here / "bad.toml") << "[[case]]\nname = 3\n";
  expect_mistake(here.run("stress-test --matrix bad.toml"), "bad.toml:2: case.name is no text");
}

TEST_CASE("stress-test lists the installed cases") {
  const Workplace here;
  const auto all = nlohmann::json::parse(here.run("stress-test --list --json").output);
  const auto quick = nlohmann::json::parse(here.run("stress-test --list --quick --json").output);
  CHECK(all.size() >= 120);
  CHECK(quick.size() >= 40);
  CHECK(quick.size() < all.size());
  for (const auto& [name, asked] : quick.items()) CHECK(all[name] == asked);
}

TEST_CASE("Ctrl-C ends stress-test and its children with 130") {
  const Workplace here;
  write_matrix(here, 60);
  Child child({RVELAB_PROGRAM, "stress-test", "--matrix", here / "m.toml", "--case", "hang"}, here / "out",
              here / "err");
  CHECK(child.wait_for(2) == -1);
  child.signal(SIGINT);
  CHECK(child.wait_for(20) == 130);
  CHECK_THAT(bytes_of(here / "err"), Contains("stopped by Ctrl-C"));
}
