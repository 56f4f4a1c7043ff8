// rvelab stress-test: the matrix of stiff and extreme cases, each in a process of its own.
#include "rvelab/stress_test/runner.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>
#include <thread>

#include "rvelab/cli/commands.hpp"
#include "rvelab/cli/interrupt.hpp"
#include "rvelab/cli/report.hpp"
#include "rvelab/error.hpp"
#include "rvelab/keys/key.hpp"
#include "rvelab/stress_test/run_case.hpp"

namespace rvelab::cli {

namespace {

using stress_test::Case;
using stress_test::Outcome;
using stress_test::Result;

struct Arguments {
  std::vector<std::string> wanted;
  std::string matrix;  ///< "": the installed one
  std::string child;   ///< the case that this process is to run itself
  unsigned jobs = std::max(1u, std::thread::hardware_concurrency());
  double patience = 1;
  bool quick = false, json = false, list = false;
};

/// ../share/rvelab/stress/matrix.toml beside the program, which is where installation and build put it.
std::string installed_matrix() {
  namespace fs = std::filesystem;
  std::error_code ignored;
  const fs::path program = fs::read_symlink("/proc/self/exe", ignored);
  return (program.parent_path().parent_path() / "share/rvelab/stress/matrix.toml").string();
}

bool is_named(const Case& one, const std::string& wanted) {
  return one.name == wanted || one.name.starts_with(wanted + "/");
}

std::vector<Case> chosen(const std::vector<Case>& all, const Arguments& arguments) {
  for (const std::string& wanted : arguments.wanted) {
    if (std::any_of(all.begin(), all.end(), [&](const Case& one) { return is_named(one, wanted); })) continue;
    std::vector<std::string> names;
    for (const Case& one : all) names.push_back(one.name);
    throw InputError("stress-test: no case \"" + wanted + "\"; the nearest is " + keys::nearest(wanted, names) +
                     "; see rvelab stress-test --list");
  }
  std::vector<Case> cases;
  for (const Case& one : all) {
    const auto& wanted = arguments.wanted;
    const auto names_it = [&](const std::string& word) { return is_named(one, word); };
    if (!wanted.empty() && std::none_of(wanted.begin(), wanted.end(), names_it)) continue;
    if (arguments.quick && !one.quick) continue;
    cases.push_back(one);
    cases.back().seconds *= arguments.patience;
  }
  if (cases.empty()) throw InputError("stress-test: none of these cases is quick; leave --quick out");
  return cases;
}

Json entry(const Result& result) {
  Json row;
  row["name"] = result.asked->name;
  row["asked"] = result.asked->asked;
  row["outcome"] = name(result.answer.outcome);
  row["status"] = result.answer.status;
  row["seconds"] = result.seconds;
  row["error"] = result.answer.error ? Json(*result.answer.error) : Json();
  if (result.answer.hash) {
    char text[20];
    std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(*result.answer.hash));
    row["hash"] = text;
  }
  return row;
}

/// One line a case, and below it what a wrong or refused one said.
class Table {
 public:
  explicit Table(const std::vector<Case>& cases) {
    for (const Case& one : cases) {
      name_ = std::max(name_, int(one.name.size()));
      asked_ = std::max(asked_, int(one.asked.size()));
    }
  }
  void head() const {
    std::printf("%-*s  %-*s  outcome     time s  error/allowed\n", name_, "case", asked_, "asked");
    std::fflush(stdout);
  }
  void row(const Result& result) const {
    const auto& answer = result.answer;
    std::printf("%-*s  %-*s  %-7s  %9.2f  ", name_, result.asked->name.c_str(), asked_, result.asked->asked.c_str(),
                name(answer.outcome), result.seconds);
    std::printf(answer.error ? "%.3g" : "-", answer.error.value_or(0));
    if (answer.status != "ok") std::printf("\n    %s", answer.status.c_str());
    std::printf("\n");
    std::fflush(stdout);
  }
  static void foot(const std::vector<Result>& results) {
    const auto count = [&](Outcome outcome) {
      return std::count_if(results.begin(), results.end(),
                           [&](const Result& result) { return result.answer.outcome == outcome; });
    };
    std::printf("%zu cases: %ld right, %ld refused, %ld WRONG\n", results.size(), long(count(Outcome::right)),
                long(count(Outcome::refused)), long(count(Outcome::wrong)));
    std::fflush(stdout);
  }

 private:
  int name_ = 4, asked_ = 5;
};

void list(const std::vector<Case>& cases, bool json) {
  Listing listing;
  for (const Case& one : cases) listing.add(one.name, one.asked);
  listing.print(json);
}

/// The hidden half: this process is the child of another and answers for one case.
void answer_for(const std::vector<Case>& all, const std::string& name) {
  for (const Case& one : all) {
    if (one.name != name) continue;
    std::cout << stress_test::written_answer(stress_test::run_case(one)) << std::flush;
    return;
  }
  throw InputError("stress-test: no case \"" + name + "\"");
}

void run_stress_test(const Arguments& arguments) {
  const std::string path = arguments.matrix.empty() ? installed_matrix() : arguments.matrix;
  const std::vector<Case> all = stress_test::read_matrix(path);
  if (!arguments.child.empty()) return answer_for(all, arguments.child);
  const std::vector<Case> cases = chosen(all, arguments);
  if (arguments.list) return list(cases, arguments.json);
  const Table table(cases);
  stress_test::Running running;
  running.command = {"rvelab", "stress-test", "--matrix", path, "--child"};
  running.jobs = arguments.jobs;
  running.stop = &stop_on_signals();
  if (!arguments.json) {
    table.head();
    running.on_result = [&](const Result& result) { table.row(result); };
  }
  std::vector<Result> results;
  try {
    results = stress_test::run(cases, running);
  } catch (const Interrupted&) {
    std::cerr << "rvelab: stress-test: stopped by " << signal_name() << "; no case goes on" << std::endl;
    throw Exit(128 + signal_received());
  }
  if (arguments.json) {
    Listing listing;
    Json rows = Json::array();
    for (const Result& result : results) rows.push_back(entry(result));
    listing.add("cases", rows);
    listing.print(true);
  } else {
    table.foot(results);
  }
  const bool any_wrong = std::any_of(results.begin(), results.end(),
                                     [](const Result& result) { return result.answer.outcome == Outcome::wrong; });
  if (any_wrong) throw Exit(1);
}

}  // namespace

Command stress_test_command() {
  auto arguments = std::make_shared<Arguments>();
  Command command{"stress-test", "Stiff and extreme cases against laws of nature and theory"};
  command.add("--case", arguments->wanted, "this case, or all whose names begin so; several may be given");
  command.add("--quick", arguments->quick, "the quick ones only, about a minute on two cores");
  command.add("--jobs", arguments->jobs, "cases at a time; without: one a core").between(1, 1024);
  command.add("--patience", arguments->patience, "limits on time are multiplied by this: for slow builds")
      .between(1, 1000);
  command.add("--list", arguments->list, "only list the cases");
  command.add("--matrix", arguments->matrix, "another file of cases");
  command.add_json(arguments->json);
  command.add("--child", arguments->child, "");
  command.notes =
      "Each case runs in a process of its own with limits on time and memory. It is right if its law or theory holds,\n"
      "refused if the program says no, as it should or may, and changes nothing; anything else is WRONG. The last\n"
      "column is the largest deviation over what the case allows. Exit code 1 if any case is WRONG.\n"
      "Examples:\n"
      "  rvelab stress-test --quick\n"
      "  rvelab stress-test --case impact --case size/million --json";
  command.run = [arguments] { run_stress_test(*arguments); };
  return command;
}

}  // namespace rvelab::cli
