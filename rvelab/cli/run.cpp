// rvelab run: one test on one specimen. Declared in command.hpp.
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <string>
#include <thread>
#include <type_traits>
#include <vector>

#include "rvelab/calibrate/mohr.hpp"
#include "rvelab/cli/command.hpp"
#include "rvelab/cli/ensemble.hpp"
#include "rvelab/cli/grading_sizes.hpp"
#include "rvelab/cli/interrupt.hpp"
#include "rvelab/cli/progress_line.hpp"
#include "rvelab/cli/protocol_input.hpp"
#include "rvelab/cli/recording.hpp"
#include "rvelab/cli/report.hpp"
#include "rvelab/cli/warnings.hpp"
#include "rvelab/error.hpp"
#include "rvelab/io/publish.hpp"
#include "rvelab/protocol/run.hpp"
#include "rvelab/records/record_fields.hpp"
#include "rvelab/solver/loading/sweep.hpp"

namespace rvelab::cli {

namespace {

struct RunArguments {
  std::vector<std::string> specimens, more, against;
  std::string output;
  bool progress = false;
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

/// An archive for records::describe_records: each column becomes an array by its name.
struct ArraysOfColumns {
  Json& arrays;

  template <class Member>
  void column(const std::vector<records::Record>& records, const fields::Field<records::Record, Member>& column) {
    Json values = Json::array();
    for (const records::Record& record : records) {
      if constexpr (std::is_same_v<Member, Matrix3>) {
        values.push_back(row_major(record.*column.member));
      } else {
        values.push_back(record.*column.member);
      }
    }
    arrays[column.name] = std::move(values);
  }
  template <class... Columns>
  void table(const std::string&, const std::vector<records::Record>& records, const Columns&... columns) {
    (column(records, columns), ...);
  }
  template <class Member>
  void choice(const std::string&, const std::vector<records::Record>&, const fields::Field<records::Record, Member>&) {}
  template <class Member>
  void chosen(const std::string&, const std::vector<records::Record>& records,
              const fields::Field<records::Record, Member>& column, std::uint64_t records::Record::*mask,
              std::uint64_t bit) {
    if (!records.empty() && (records.front().*mask & bit) != 0) this->column(records, column);
  }
};

Json arrays_of(const std::vector<records::Record>& records) {
  Json arrays;
  ArraysOfColumns archive{arrays};
  records::describe_records(archive, records);
  return arrays;
}

/// Moduli of the oedometer stages that have records at small strain.
void add_oedometers(const protocol::Protocol& protocol, const protocol::TestRun& run, Listing& listing) {
  for (std::size_t k = 0; k < protocol.stages.size(); ++k) {
    const protocol::StageRole role = protocol::role_of(protocol.stages[k]);
    if (role.gives != protocol::StageRole::Gives::oedometric_stiffness) continue;
    std::vector<records::Record> records;
    for (const records::Record& record : run.result.records) {
      if (record.stage == int(k)) records.push_back(record);
    }
    const int dimension = run.end_state.cell.dimension;
    const std::string axis = !role.axis.empty() ? role.axis : dimension == 2 ? "y" : "z";
    const calibrate::OedometerStiffness found = calibrate::oedometer_stiffness(records, axis, dimension);
    if (!std::isfinite(found.C11)) continue;
    const std::string stem = "stage_" + protocol.stages[k].name + "_";
    listing.add(stem + "C11_Pa", found.C11, "Pa");
    listing.add(stem + "C12_Pa", found.C12, "Pa");
    listing.add(stem + "G_Pa", found.G, "Pa");
    listing.add(stem + "K_3D_Pa", found.K_3D, "Pa");
    listing.add(stem + "K_2D_Pa", found.K_2D, "Pa");
  }
}

/// Whether a stress-controlled cyclic test liquefied, and after how many cycles.
void add_liquefaction(const protocol::Protocol& protocol, const protocol::TestRun& run, Listing& listing) {
  const ensemble::Liquefaction found = ensemble::liquefaction_of(protocol, run.result, run.end_state.cell.dimension);
  if (!found.cyclic) return;
  listing.add("stress_ratio", found.stress_ratio, "of p at the start");
  listing.add("cycles", found.cycles);
  listing.add_to_json("liquefied", found.liquefied);
  listing.add_to_json("least_p_over_first", found.least_p);
  const std::string limit = in_words(100 * found.limit) + " %";
  listing.add_to_text("liquefaction",
                      found.liquefied
                          ? "after " + in_words(found.cycles) + " cycles: p below " + limit + " of its start"
                          : "none: the least p is " + in_words(std::round(1e3 * found.least_p) / 10) +
                                " % of its start, and " + limit + " counts as liquefied");
}

/// Of p: an error above which the largest one is commented, beyond the scatter of peaks over specimens.
constexpr double noted_error = 0.1;

/// Where the time of this run went, and the error estimates of its stresses; nothing of a test that was complete
/// before.
void add_costs(const protocol::TestRun& run, double wall, Listing& listing) {
  const protocol::Costs& costs = run.costs;
  if (costs.judged > 0) {
    listing.add("mean_error_estimate", costs.mean_error, "of p");
    listing.add("largest_error_estimate", costs.largest_error,
                "of p at strain " + in_words(costs.largest_error_strain) +
                    ": how far the stress of a record may be from that of infinitely slow loading" +
                    (costs.largest_error > noted_error
                         ? "; the grains rearrange within that record: judge the curve by the mean, or give a lower "
                           "solver.relative_tolerance"
                         : ""));
  }
  if (costs.waited > 0)
    listing.add("waited_for_held_stress", double(costs.waited) / double(costs.substeps), "of the sub-steps");
  const double calls = costs.grains + costs.pairs + costs.list + costs.control;
  if (!(calls > 0)) return;
  listing.add("time_grains_s", costs.grains, "s");
  listing.add("time_pairs_s", costs.pairs, "s");
  listing.add("time_list_s", costs.list, "s");
  listing.add("time_control_s", costs.control, "s");
  listing.add("time_files_s", costs.files, "s");
  listing.add("time_other_s", std::max(0.0, wall - calls - costs.files), "s");  // measured quantities, progress line
}

/// Whether the largest deviator of a stage is a strength: not on a path of pressures, of response envelopes, nor where
/// cement dissolves under a stress that stays.
bool leads_to_failure(const protocol::Stage& stage) {
  return stage.kind != "pressure_path" && stage.kind != "envelope" && stage.kind != "dissolve";
}

/// The peak of the last stage, and where the test ended.
void add_end(const protocol::Protocol& protocol, const protocol::TestRun& run, Listing& listing) {
  const auto records = calibrate::last_stage(run.result);
  if (leads_to_failure(protocol.stages.at(std::size_t(records.back().stage)))) {
    const calibrate::Peak highest = calibrate::peak(records, run.end_state.cell.dimension);
    listing.add("peak_strain", highest.strain);
    listing.add("peak_sigma_1_Pa", highest.stresses.major, "Pa");
    listing.add("peak_sigma_3_Pa", highest.stresses.minor, "Pa");
    listing.add_or_why("peak_friction_angle_deg", calibrate::friction_angle_deg(highest.stresses), "degrees",
                       "the minor principal stress is in tension, or there is no stress");
    listing.add("rising_at_end", calibrate::rising_at_end(records, highest));
  }
  listing.add("end_strain", records.back().strain);
  listing.add("end_stress_Pa", row_major(records.back().stress), "Pa");
  if ((records.back().quantities & records::asked<records::VoidRatio>) != 0)
    listing.add("end_void_ratio", records.back().void_ratio);
}

void report_run(const protocol::Protocol& protocol, const Specimen& specimen, const protocol::TestRun& run, double wall,
                const std::string& output, bool json) {
  const records::TestResult& result = run.result;
  const FlaggedRecords flagged = flagged_records(result.records, run.end_state.cell.dimension);
  Listing listing;
  listing.add("protocol", result.protocol);
  if (!result.axis.empty()) {
    listing.add("axis", result.axis);
    listing.add("pressure_Pa", result.pressure, "Pa");
  }
  listing.add("stages", result.stages);
  if (!run.events.empty()) listing.add("ended_by", run.events);
  listing.add("records", json ? arrays_of(result.records) : Json(result.records.size()));
  listing.add("flagged", flagged.not_held);
  listing.add("not_quasi_static", flagged.not_quasi_static);
  listing.add("cell_thin", flagged.thin);
  if (!result.records.empty()) add_end(protocol, run, listing);
  add_liquefaction(protocol, run, listing);
  for (const records::ProbeResult& probe : result.probes) {
    const bool only = result.probes.size() == 1;
    listing.add(only ? "stiffness_Pa" : "stiffness_Pa_" + probe.stage, row_major(probe.stiffness), "Pa");
  }
  add_oedometers(protocol, run, listing);
  if (!output.empty()) {
    listing.add("file", output);
  } else if (!json && !result.records.empty()) {
    listing.add("file", "none: the records are not kept without -o R.h5");
  }
  listing.add("wall_s", result.wall_seconds, "s");
  listing.add("grain_steps", result.grain_steps);
  add_costs(run, wall, listing);
  listing.print(json);
  warn_records(specimen, run, flagged);
}

void run_test(const RunArguments& arguments) {
  const protocol::Protocol protocol =
      protocol::read_protocol(protocol_path(arguments.test.protocol), arguments.test.settings);
  arguments.test.expect_output(arguments.output);
  const auto given = files_of(arguments.specimens, arguments.more), against = files_of(arguments.against);
  if (arguments.progress && (given.size() > 1 || !against.empty()))
    throw InputError("--progress is given with several specimens; allowed: with one; leave it out");
  if (given.size() > 1 || !against.empty()) return run_several(arguments, protocol, given, against);
  if (arguments.test.share)
    throw InputError("--share is given with one specimen; allowed: tests on several; give more, or leave --share out");
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
  warn_of_units(protocol.path, protocol::unusual_in(protocol, specimen));
  warn_of_shear(protocol, specimen);
  warn_of_largest_grain(specimen_files(protocol, given).front(), specimen);
  protocol::TestRun run;
  double wall = 0;
  {
    ProgressLine line;
    ProgressReport report;
    protocol::Watch watch;
    watch.on_path_point = [&](const protocol::PathPoint& reached) {
      if (arguments.progress) return report.show(reached);
      line.show(0, "", reached);
    };
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
  if (!run.complete) {
    const std::size_t made = run.result.records.size();
    end_stopped(" after " + std::to_string(made) + " records; " +
                (arguments.output.empty() ? "they are not kept without -o"
                 : made == 0              ? "continue with --resume"
                                          : arguments.output + " holds them; continue with --resume"));
  }
  report_run(protocol, specimen, run, wall, arguments.output, arguments.test.json);
}

}  // namespace

void add_run(CLI::App& app) {
  CLI::App& command = *app.add_subcommand("run", "Run a test, a protocol in TOML, on a specimen");
  const auto arguments = std::make_shared<RunArguments>();
  command
      .add_option("--specimen", arguments->specimens,
                  "specimen, or record file: its end state; default: [specimen] file of the protocol;\n"
                  "several of them, or \"S_*.h5\": an ensemble")
      ->allow_extra_args(false);
  command
      .add_option("--against", arguments->against, "a second group of specimens; prints the differences of the means")
      ->allow_extra_args(false);
  command.add_option("-o,--output", arguments->output,
                     "record file to write, R.h5; of several specimens the folder for records and summary");
  arguments->test.add_to(command, "test.pressure_Pa=2e4", "for specimens of 30,000 grains or more; tests at a time");
  command.add_flag("--progress", arguments->progress,
                   "on standard error some times a second \"progress \" and a JSON object: records, stage, strain");
  command.add_option("specimens", arguments->more, "further specimens");
  command.footer(
      "A specimen of less than 30,000 grains runs on one thread; `rvelab calibrate --threads` runs several tests at a\n"
      "time. Any number of threads gives the same bits. Each record is written to R.h5.journal at once, and R.h5 is "
      "brought\n"
      "up to date from time to time; Ctrl-C and SIGTERM stop the test and keep both. Without -o and --json the "
      "records\n"
      "are lost.\n"
      "The keys peak_... are of the last stage, where sigma_1 - sigma_3 is largest. p: mean stress, compression\n"
      "positive; q: deviatoric stress, sqrt(s:s/2) in 2D, sqrt(3 s:s/2) in 3D; eps_q: deviatoric strain, sqrt(2 e:e)\n"
      "and sqrt(2 e:e/3), with s and e the deviators of stress and strain. More: protocols/README.md.\n"
      "Several specimens run one to a core; summary.json and summary.csv give mean, standard deviation, standard "
      "error\n"
      "and 95 % interval of every measure. --resume after a kill gives the same summary. With --share several "
      "processes\n"
      "carry them out, each the next one that no other has in hand; the first rank of mpirun prints.\n"
      "Examples:\n"
      "  rvelab run biaxial --specimen dense.h5 -o R.h5\n"
      "  rvelab run biaxial --specimen dense.h5 --set stage.compression.to_strain=0.05 --json\n"
      "  rvelab run biaxial --specimen dense.h5 -o R.h5 --resume\n"
      "  rvelab run biaxial --specimen 'S_*.h5' -o D\n"
      "  rvelab run biaxial --specimen 'dense_*.h5' --against 'loose_*.h5' -o D\n"
      "  mpirun -np 8 rvelab run biaxial --specimen 'S_*.h5' -o D --share");
  command.callback([arguments] { run_test(*arguments); });
}

}  // namespace rvelab::cli
