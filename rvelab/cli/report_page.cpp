// rvelab report: tests as one HTML page. Declared in command.hpp.
#include <string>
#include <vector>

#include "rvelab/cli/command.hpp"
#include "rvelab/cli/protocol_input.hpp"
#include "rvelab/cli/report.hpp"
#include "rvelab/io/publish.hpp"
#include "rvelab/report/page.hpp"
#include "rvelab/report/words.hpp"

namespace rvelab::cli {
namespace {

struct ReportArguments {
  std::vector<std::string> inputs;
  std::string output, title;
  double states_MB = 24;
  bool force = false, json = false;
};

void run_report_page(const ReportArguments& arguments) {
  expect_folder_of(arguments.output);
  io::expect_output(arguments.output, arguments.force, report::files_of(arguments.inputs));
  const report::Page page = report::page_of(arguments.inputs, {arguments.title, 1e6 * arguments.states_MB});
  io::publish_text(arguments.output, page.html);
  for (const std::string& remark : page.remarks) tell(arguments.output + ": " + remark);
  Listing listing;
  listing.add_to_json("report", arguments.output);
  listing.add_to_json("tests", page.tests);
  listing.add_to_json("mpm_runs", page.mpm_runs);
  listing.add_to_json("states", page.states);
  listing.add_to_json("bytes", page.html.size());
  std::string held;
  if (page.tests > 0) held = report::counted(page.tests, "test") + ", ";
  if (page.mpm_runs > 0) held += report::counted(page.mpm_runs, "MPM run") + ", ";
  listing.add_to_text("report", arguments.output + ": " + held + report::counted(page.states, "state") + ", " +
                                    report::in_three_digits(double(page.html.size()) / 1e6) + " MB");
  listing.print(arguments.json);
}

}  // namespace

void add_report(CLI::App& app) {
  CLI::App& command =
      *app.add_subcommand("report", "Show tests in a browser: one HTML page with grains, chains, curves, Mohr circles");
  const auto arguments = std::make_shared<ReportArguments>();
  command.add_option("records", arguments->inputs, "record files, folders of them, or folders of rvelab-mpm")
      ->required();
  command.add_option("-o,--output", arguments->output, "page to write, report.html")->required();
  command.add_option("--title", arguments->title, "of the page; default: the names of the tests");
  command
      .add_option("--states-MB", arguments->states_MB,
                  "states of all tests may take so much before they are compressed; default 24")
      ->check(CLI::Range(0.1, 1000.0));
  add_force(command, arguments->force, "an existing page");
  add_json(command, arguments->json);
  command.footer(
      "The page contains all its data and loads nothing: any browser of 2023 or later opens it, without a network.\n"
      "Tests that differ only by their specimen form one curve, their mean, with a band. Grains and force chains are\n"
      "shown at the end of each test, and along it where a test was run with --set output.snapshots_every=10. Where "
      "the\n"
      "states would be larger than --states-MB, every second, third, ... of them is kept, and the first and the last.\n"
      "Examples:\n"
      "  rvelab report R.h5 -o report.html\n"
      "  rvelab report dense loose -o report.html --title \"Dense and loose sand, biaxial tests\"\n"
      "  rvelab report column -o column.html");
  command.callback([arguments] { run_report_page(*arguments); });
}

}  // namespace rvelab::cli
