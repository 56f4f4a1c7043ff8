#include "rvelab/cli/recording.hpp"

#include <chrono>
#include <cmath>

#include "rvelab/cli/protocol_input.hpp"
#include "rvelab/error.hpp"

namespace rvelab::cli {

void TestOptions::add_to(CLI::App& command, const std::string& example, const std::string& threads_help) {
  command.add_option("protocol", protocol, "PROTOCOL.toml, or the name of an installed test: biaxial")->required();
  add_set(command, settings, example);
  add_threads(command, threads, threads_help + "; default: one per core");
  command.add_flag("--force", force, "overwrite existing record files; they are removed at once");
  command.add_flag("--resume", resume, "continue a stopped or killed test from its last checkpoint")
      ->excludes("--force");
  command
      .add_flag("--share", share,
                "share the tests with other processes that are given the same command: ranks\n"
                "of mpirun, or shells; as --resume, in a folder with locks that all see")
      ->excludes("--force");
  command
      .add_option("--checkpoint-every", checkpoint_every,
                  "seconds between checkpoints; default: as often as costs less than 1 % of the time")
      ->check(CLI::Range(1e-3, 1e9));
  add_json(command, json);
}

void TestOptions::expect_output(const std::string& output) const {
  if (std::isnan(checkpoint_every))
    throw InputError("--checkpoint-every nan is not a number of seconds; allowed: 0.001 to 1e9; leave it out");
  expect_output_given(
      output,
      {{"--force", force}, {"--resume", resume}, {"--share", share}, {"--checkpoint-every", checkpoint_every > 0}},
      "output");
}

std::unique_ptr<io::RecordStore> open_store(const std::string& path, const protocol::Protocol& protocol,
                                            const Specimen& specimen, const TestOptions& options) {
  const std::vector<std::string> doubts = protocol::unusual_in(protocol, specimen);
  io::RunStart start{protocol.name, keys::with_doubts(doubts, protocol.resolved), {}, specimen};
  for (const protocol::Stage& stage : protocol.stages) start.stages.push_back(stage.name);
  return std::make_unique<io::RecordStore>(path, start, if_exists(options.force, options.resume || options.share),
                                           options.checkpoint_every);
}

protocol::TestRun run_recorded(const protocol::Protocol& protocol, const Specimen& specimen, io::RecordStore* store,
                               protocol::Watch watch) {
  if (store == nullptr) return protocol::run_protocol(protocol, specimen, watch);
  if (store->complete()) return {store->test().result, store->test().checkpoint.specimen, {}, true, {}, {}};

  double seconds = 0;
  const auto timed = [&](auto write) {
    const auto begin = std::chrono::steady_clock::now();
    write();
    seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  };
  watch.on_record = [&](const records::Record& record) { timed([&] { store->put(record); }); };
  watch.on_probe = [&](const records::ProbeResult& probe) { timed([&] { store->put(probe); }); };
  watch.on_snapshot = [&](std::size_t record, const Specimen& state) {
    timed([&] { store->put_snapshot(record, state); });
  };
  watch.on_path_point = [&, shown = watch.on_path_point](const protocol::PathPoint& reached) {
    if (shown) shown(reached);
    timed([&] { store->offer([&] { return reached.checkpoint(); }); });
  };
  try {
    protocol::TestRun run = store->checkpoint()
                                ? protocol::resume_protocol(protocol, *store->checkpoint(), store->test().result, watch)
                                : protocol::run_protocol(protocol, specimen, watch);
    timed([&] {
      if (run.complete)
        store->finish(run.result, run.end_state);
      else
        store->stop({run.progress, run.end_state});
    });
    run.costs.files = seconds;
    return run;
  } catch (...) {
    try {
      store->publish_what_is_there();
    } catch (const std::exception&) {
      // Report the failure that ended the run, not this one; the journal still holds every record.
    }
    throw;
  }
}

}  // namespace rvelab::cli
