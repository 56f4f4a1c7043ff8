// rvelab run: one test on one specimen. Declared in commands.hpp.
#include <unistd.h>

#include <algorithm>
#include <any>
#include <chrono>
#include <cmath>
#include <memory>
#include <numeric>
#include <string>
#include <thread>
#include <vector>

#include "rvelab/calibrate/mohr.hpp"
#include "rvelab/calibrate/oedometer.hpp"
#include "rvelab/cli/commands.hpp"
#include "rvelab/cli/interrupt.hpp"
#include "rvelab/cli/progress_line.hpp"
#include "rvelab/cli/protocol_input.hpp"
#include "rvelab/cli/recording.hpp"
#include "rvelab/cli/report.hpp"
#include "rvelab/io/publish.hpp"
#include "rvelab/protocol/run.hpp"
#include "rvelab/protocol/stage_kind.hpp"
#include "rvelab/records/record_fields.hpp"
#include "rvelab/solver/loading/sweep.hpp"

namespace rvelab::cli {
namespace {

struct RunArguments {
  std::string protocol, specimen, output;
  std::vector<std::string> settings;
  RecordingOptions recording;
  unsigned threads = 0;  ///< 0: one per core
  bool json = false;
};

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

/// Moduli of oedometer stages that have records at small strain.
void add_oedometers(const protocol::Protocol& protocol, const protocol::TestRun& run, Listing& listing) {
  for (std::size_t k = 0; k < protocol.stages.size(); ++k) {
    const protocol::StageRole role = protocol::role_of(protocol.stages[k]);
    if (role.gives != protocol::StageRole::Gives::oedometric_stiffness) continue;
    std::vector<records::Record> records;
    for (const records::Record& record : run.result.records) {
      if (record.stage == static_cast<int>(k)) records.push_back(record);
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

/// Where the time of this run went, and what its stresses may err by. Nothing for a test that was complete before.
void add_costs(const protocol::TestRun& run, double wall, Listing& listing) {
  const protocol::Costs& costs = run.costs;
  if (costs.judged > 0) {
    listing.add("mean_error_estimate", costs.mean_error, "of p");
    listing.add("largest_error_estimate", costs.largest_error, "of p");
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
  // Measured quantities, the progress line.
  listing.add("time_other_s", std::max(0.0, wall - calls - costs.files), "s");
}

/// Whether the largest deviator of a stage is a strength: not where pressure goes up and down, or small steps are
/// tried to all sides.
bool leads_to_failure(const protocol::Stage& stage) {
  return stage.kind != "pressure_path" && stage.kind != "envelope";
}

/// Tells before the work of a stage of simple shear that goes further than the cell stands.
void tell_of_shear(const protocol::Protocol& protocol, const Specimen& specimen) {
  const int dimension = specimen.cell.dimension;
  const double diameter = 2 * std::accumulate(specimen.grains.radius.begin(), specimen.grains.radius.end(), 0.0) /
                          double(specimen.grains.size());
  for (const protocol::Stage& stage : protocol.stages) {
    const auto* shear = protocol::settings_of<protocol::SimpleShearStage>(stage);
    if (shear == nullptr) continue;
    const std::string plane = !shear->plane.empty() ? shear->plane : dimension == 2 ? "xy" : "xz";
    const double most = std::abs(shear->to_strain);
    const double thin_from = shear_until_thin(specimen.cell, plane[0] - 'x', plane[1] - 'x', 4 * diameter, most);
    if (!std::isfinite(thin_from) || thin_from == 0) continue;  // thin from the start: its records tell of that
    tell("stage \"" + stage.name + "\": sheared beyond " + in_words(thin_from) +
         " a height of the cell is below four "
         "mean diameters, and its records are flagged (cell_thin): no vector of the cell lies along " +
         plane[0] + ", or it is small; pack the specimen anew, upright and with more grains, or shear it less");
  }
}

/// Tells of records whose cell was too thin to stand for the material.
void tell_of_thin(const records::TestResult& result, long thin) {
  if (thin == 0) return;
  const auto first = std::find_if(result.records.begin(), result.records.end(),
                                  [](const records::Record& record) { return record.cell_thin; });
  tell(std::to_string(thin) + " of " + std::to_string(result.records.size()) +
       " records are of a thin cell (cell_thin), from strain " + in_words(first->strain) + " of stage \"" +
       result.stages.at(static_cast<std::size_t>(first->stage)) +
       "\" on: a height is below four mean diameters, so that the cell stands for less and less of the material; "
       "use more grains, or a cell that suits the deformation (pack.cell)");
}

void report(const protocol::Protocol& protocol, const protocol::TestRun& run, double wall,
            const RunArguments& arguments) {
  const records::TestResult& result = run.result;
  const int dimension = run.end_state.cell.dimension;
  long flagged = 0, moving = 0, marked = 0, thin = 0;
  for (const records::Record& record : result.records) {
    flagged += record.target_held ? 0 : 1;
    moving += record.quasi_static ? 0 : 1;
    thin += record.cell_thin ? 1 : 0;
    marked += record.target_held && record.quasi_static ? 0 : 1;
  }
  Listing listing;
  listing.add("protocol", result.protocol);
  if (!result.axis.empty()) {
    listing.add("axis", result.axis);
    listing.add("pressure_Pa", result.pressure, "Pa");
  }
  listing.add("stages", result.stages);
  if (!run.events.empty()) listing.add("ended_by", run.events);
  if (arguments.json) {
    listing.add("records", arrays_of(result.records));
  } else {
    listing.add("records", result.records.size());
  }
  listing.add("flagged", flagged);
  listing.add("not_quasi_static", moving);
  listing.add("cell_thin", thin);
  if (!result.records.empty()) {
    const auto records = calibrate::last_stage(result);
    if (leads_to_failure(protocol.stages.at(static_cast<std::size_t>(records.back().stage)))) {
      const calibrate::Peak highest = calibrate::peak(records, dimension);
      listing.add("peak_strain", highest.strain);
      listing.add("peak_sigma_1_Pa", highest.stresses.major, "Pa");
      listing.add("peak_sigma_3_Pa", highest.stresses.minor, "Pa");
      listing.add_or_why("peak_friction_angle_deg", calibrate::friction_angle_deg(highest.stresses), "degrees",
                         "the minor principal stress is in tension, or there is no stress");
      listing.add("rising_at_end", calibrate::rising_at_end(records, highest));
    }
    listing.add("end_strain", records.back().strain);
    listing.add("end_stress_Pa", row_major(records.back().stress), "Pa");
    if ((records.back().quantities & records::asked<records::VoidRatio>) != 0) {
      listing.add("end_void_ratio", records.back().void_ratio);
    }
  }
  for (const records::ProbeResult& probe : result.probes) {
    const bool only = result.probes.size() == 1;
    listing.add(only ? "stiffness_Pa" : "stiffness_Pa_" + probe.stage, row_major(probe.stiffness), "Pa");
  }
  add_oedometers(protocol, run, listing);
  if (!arguments.output.empty()) {
    listing.add("file", arguments.output);
  } else if (!arguments.json && !result.records.empty()) {
    listing.add("file", "none: the records are not kept without -o R.h5");
  }
  listing.add("wall_s", result.wall_seconds, "s");
  listing.add("grain_steps", result.grain_steps);
  add_costs(run, wall, listing);
  listing.print(arguments.json);
  // A record or two in an avalanche are the specimen's; more are the test's.
  if (20 * marked > static_cast<long>(result.records.size())) {
    tell(std::to_string(marked) + " of " + std::to_string(result.records.size()) + " records are doubtful: " +
         std::to_string(flagged) + " are flagged, their stress was not held (target_held), " + std::to_string(moving) +
         " are not quasi-static, no equilibrium (quasi_static in the records); lower the tolerances of [solver] or the "
         "rate, or raise loading.held_tolerance");
  }
  tell_of_thin(result, thin);
  if (2 * run.costs.waited > run.costs.substeps)
    tell(std::to_string(run.costs.waited) + " of " + std::to_string(run.costs.substeps) +
         " sub-steps went into waiting for a held stress that the grains had let go in avalanches");
}

/// Says what a stopped run left, and ends the program with the code of its signal.
[[noreturn]] void end_stopped(const protocol::TestRun& run, const std::string& output) {
  const std::string made = std::to_string(run.result.records.size()) + " records";
  const std::string kept = output.empty()               ? "they are not kept without -o"
                           : run.result.records.empty() ? "go on with --resume"
                                                        : output + " holds them; go on with --resume";
  tell("stopped by " + std::string(signal_name()) + " after " + made + "; " + kept);
  throw Stopped(128 + signal_received());
}

void run_test(const RunArguments& arguments) {
  const protocol::Protocol protocol = protocol::read_protocol(protocol_path(arguments.protocol), arguments.settings);
  arguments.recording.expect_output(arguments.output);
  const auto given = arguments.specimen.empty() ? std::vector<std::string>{} : std::vector{arguments.specimen};
  const auto specimens = specimens_for(protocol, given);
  const Specimen& specimen = specimens.front();
  std::unique_ptr<io::RecordStore> store;
  if (!arguments.output.empty()) {
    expect_folder_of(arguments.output);
    protocol::with_overrides(protocol, specimen);  // its mistakes are told before a file is touched
    auto inputs = specimen_files(protocol, given);
    inputs.push_back(protocol.path);
    io::expect_place(arguments.output, inputs);
    store = open_store(arguments.output, protocol, specimen, arguments.recording);
    if (store->complete()) tell(arguments.output + " is complete; nothing was run");
  } else if (!arguments.json && protocol::planned_records(protocol) > 0 && isatty(STDERR_FILENO) == 1) {
    tell("the records will not be kept: no -o R.h5 is given");  // before the work; off a terminal the listing says it
  }
  tell_of_shear(protocol, specimen);
  protocol::TestRun run;
  double wall = 0;  // of this run; result.wall_seconds is that of all parts of a test that was gone on with
  {
    ProgressLine line;
    protocol::Watch watch;
    watch.on_moment = [&](const protocol::Moment& moment) { line.show(moment); };
    watch.stop = &stop_on_signals();
    std::unique_ptr<Workers> team;
    if (specimen.grains.size() >= least_shared_grains) {
      const unsigned cores = std::max(1u, std::thread::hardware_concurrency());
      team = std::make_unique<Workers>(arguments.threads > 0 ? arguments.threads : cores);
    }
    watch.team = team.get();
    watch.measure_time = true;
    const auto begin = std::chrono::steady_clock::now();
    run = run_recorded(protocol, specimen, store.get(), watch);
    wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  }
  if (!run.complete) end_stopped(run, arguments.output);
  report(protocol, run, wall, arguments);
}

}  // namespace

void add_run(CLI::App& app) {
  auto arguments = std::make_shared<RunArguments>();
  CLI::App* command = app.add_subcommand("run", "Run a test, a protocol in TOML, on a specimen");
  command->add_option("protocol", arguments->protocol, "PROTOCOL.toml, or the name of an installed one: biaxial")
      ->required();
  command->add_option("--specimen", arguments->specimen,
                      "specimen (or record file: its end state); else [specimen] file");
  command->add_option("-o,--output", arguments->output, "record file to write, R.h5");
  add_set_option(*command, arguments->settings, "test.pressure_Pa=2e4");
  command->add_option("--threads", arguments->threads, "threads of a specimen from 30,000 grains on; else one per core")
      ->check(CLI::Range(1u, 4096u));
  arguments->recording.add_to(*command);
  command->add_flag("--json", arguments->json, "print one JSON object, records as arrays by name");
  command->footer(
      "A specimen below 30,000 grains runs on one thread; `rvelab calibrate --threads` runs several tests at a time.\n"
      "The number of threads changes no bit. Records go to\n"
      "R.h5.journal at once and to R.h5 now and then; Ctrl-C and SIGTERM stop the test and keep both.\n"
      "Without -o and --json the records are lost. peak_: of the last stage, where sigma_1 - sigma_3 is largest.\n"
      "p: mean stress, compression positive; q: deviatoric stress, sqrt(s:s/2) in 2D, sqrt(3 s:s/2) in 3D; eps_q: its\n"
      "strain, sqrt(2 e:e) and sqrt(2 e:e/3), with s and e the deviators (more: protocols/README.md).\n"
      "Examples:\n"
      "  rvelab run biaxial --specimen dense.h5 -o R.h5\n"
      "  rvelab run biaxial --specimen dense.h5 --set stage.compression.to_strain=0.05 --json\n"
      "  rvelab run biaxial --specimen dense.h5 -o R.h5 --resume");
  command->callback([arguments] { run_test(*arguments); });
}

}  // namespace rvelab::cli
