// rvelab run: one test on one specimen. Declared in commands.hpp.
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "rvelab/cli/commands.hpp"
#include "rvelab/cli/ensemble.hpp"
#include "rvelab/cli/interrupt.hpp"
#include "rvelab/cli/progress_line.hpp"
#include "rvelab/cli/protocol_input.hpp"
#include "rvelab/cli/recording.hpp"
#include "rvelab/cli/report.hpp"
#include "rvelab/cli/run_report.hpp"
#include "rvelab/io/publish.hpp"
#include "rvelab/protocol/run.hpp"
#include "rvelab/solver/loading/sweep.hpp"

namespace rvelab::cli {
namespace {

struct RunArguments {
  std::vector<std::string> specimens, more, against;
  std::string output;
  TestOptions test;
};

/// Several specimens, or two groups of them.
void run_several(const RunArguments& arguments, const protocol::Protocol& protocol, std::vector<std::string> files,
                 const std::vector<std::string>& against) {
  Ensemble ensemble{{protocol}, std::move(files), {}, {"group 1"}};
  ensemble.groups.assign(ensemble.files.size(), 0);
  if (!against.empty()) ensemble.names.emplace_back("group 2");
  for (const std::string& file : against) {
    ensemble.files.push_back(file);
    ensemble.groups.push_back(1);
  }
  run_ensemble(ensemble, arguments.output, arguments.test);
}

/// Prints how many records a stopped run left, and ends the program with the code of the signal.
[[noreturn]] void end_stopped(const protocol::TestRun& run, const std::string& output) {
  const std::string made = std::to_string(run.result.records.size()) + " records";
  const std::string kept = output.empty()               ? "they are not kept without -o"
                           : run.result.records.empty() ? "continue with --resume"
                                                        : output + " holds them; continue with --resume";
  tell("stopped by " + std::string(signal_name()) + " after " + made + "; " + kept);
  throw Exit(128 + signal_received());
}

void run_test(const RunArguments& arguments) {
  const protocol::Protocol protocol =
      protocol::read_protocol(protocol_path(arguments.test.protocol), arguments.test.settings);
  arguments.test.expect_output(arguments.output);
  auto words = arguments.specimens;
  words.insert(words.end(), arguments.more.begin(), arguments.more.end());
  const auto given = files_of(words), against = files_of(arguments.against);
  if (given.size() > 1 || !against.empty()) return run_several(arguments, protocol, given, against);
  const auto specimens = specimens_for(protocol, given);
  const Specimen& specimen = specimens.front();
  std::unique_ptr<io::RecordStore> store;
  if (!arguments.output.empty()) {
    expect_folder_of(arguments.output);
    protocol::with_overrides(protocol, specimen);  // reports mistakes before a file is touched
    auto inputs = specimen_files(protocol, given);
    inputs.push_back(protocol.path);
    io::expect_place(arguments.output, inputs);
    store = open_store(arguments.output, protocol, specimen, arguments.test);
    if (store->complete()) tell(arguments.output + " is complete; nothing was run");
  } else if (!arguments.test.json && protocol::planned_records(protocol) > 0 && isatty(STDERR_FILENO) == 1) {
    tell("the records will not be kept: no -o R.h5 is given");  // before the work; off a terminal the listing says it
  }
  tell_of_shear(protocol, specimen);
  protocol::TestRun run;
  double wall = 0;
  {
    ProgressLine line;
    protocol::Watch watch;
    watch.on_moment = [&](const protocol::Moment& moment) { line.show(moment); };
    watch.stop = &stop_on_signals();
    std::unique_ptr<Workers> team;
    if (specimen.grains.size() >= least_shared_grains) {
      const unsigned cores = std::max(1u, std::thread::hardware_concurrency());
      team = std::make_unique<Workers>(arguments.test.threads > 0 ? arguments.test.threads : cores);
    }
    watch.team = team.get();
    watch.measure_time = true;
    const auto begin = std::chrono::steady_clock::now();
    run = run_recorded(protocol, specimen, store.get(), watch);
    wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  }
  if (!run.complete) end_stopped(run, arguments.output);
  report_run(protocol, run, wall, arguments.output, arguments.test.json);
}

}  // namespace

Command run_command() {
  auto arguments = std::make_shared<RunArguments>();
  Command command{"run", "Run a test, a protocol in TOML, on a specimen"};
  command.add("--specimen", arguments->specimens,
              "specimen, or record file: its end state; default: [specimen] file of the protocol;\n"
              "several of them, or \"S_*.h5\": an ensemble");
  command.add("--against", arguments->against, "a second group of specimens; prints the differences of the means");
  command.add("-o,--output", arguments->output,
              "record file to write, R.h5; of several specimens the folder for records and summary");
  arguments->test.add_to(command, "test.pressure_Pa=2e4", "for specimens of 30,000 grains or more; tests at a time");
  command.add("specimens", arguments->more, "further specimens");
  command.notes =
      "A specimen of less than 30,000 grains runs on one thread; `rvelab calibrate --threads` runs several tests at a\n"
      "time. The number of threads changes no bit. Each record is written to R.h5.journal at once, and R.h5 is "
      "brought\n"
      "up to date from time to time; Ctrl-C and SIGTERM stop the test and keep both. Without -o and --json the "
      "records\n"
      "are lost.\n"
      "The keys peak_... are of the last stage, where sigma_1 - sigma_3 is largest. p: mean stress, compression\n"
      "positive; q: deviatoric stress, sqrt(s:s/2) in 2D, sqrt(3 s:s/2) in 3D; eps_q: deviatoric strain, sqrt(2 e:e)\n"
      "and sqrt(2 e:e/3), with s and e the deviators of stress and strain. More: protocols/README.md.\n"
      "Several specimens run one to a core; summary.json and summary.csv give mean, standard deviation, standard "
      "error\n"
      "and 95 % interval of every measure. --resume after a kill gives the same summary.\n"
      "Examples:\n"
      "  rvelab run biaxial --specimen dense.h5 -o R.h5\n"
      "  rvelab run biaxial --specimen dense.h5 --set stage.compression.to_strain=0.05 --json\n"
      "  rvelab run biaxial --specimen dense.h5 -o R.h5 --resume\n"
      "  rvelab run biaxial --specimen 'S_*.h5' -o D\n"
      "  rvelab run biaxial --specimen 'dense_*.h5' --against 'loose_*.h5' -o D";
  command.run = [arguments] { run_test(*arguments); };
  return command;
}

}  // namespace rvelab::cli
