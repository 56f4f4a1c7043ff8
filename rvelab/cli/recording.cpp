#include "rvelab/cli/recording.hpp"

#include "rvelab/error.hpp"

namespace rvelab::cli {

void RecordingOptions::add_to(CLI::App& command) {
  CLI::Option* over = command.add_flag("--force", force, "overwrite record files that are there (they go at once)");
  command.add_flag("--resume", resume, "go on with a test that was stopped or killed, from its last checkpoint")
      ->excludes(over);
  command
      .add_option("--checkpoint-every", checkpoint_every,
                  "seconds between checkpoints (else as often as costs less than 1 %)")
      ->check(CLI::PositiveNumber);
}

void RecordingOptions::expect_output(const std::string& output) const {
  if (!output.empty()) return;
  const char* given = force ? "--force" : resume ? "--resume" : checkpoint_every > 0 ? "--checkpoint-every" : nullptr;
  if (given == nullptr) return;
  throw InputError(std::string(given) + " is given without -o; allowed: with -o; name the output");
}

Existing RecordingOptions::existing() const {
  return force ? Existing::overwrite : resume ? Existing::resume : Existing::refuse;
}

std::unique_ptr<RecordStore> open_store(const std::string& path, const Protocol& protocol, const Specimen& specimen,
                                        const RecordingOptions& options) {
  io::RunStart start{protocol.name, protocol.resolved, {}, specimen};
  for (const Stage& stage : protocol.stages) start.stages.push_back(stage.name);
  return std::make_unique<RecordStore>(path, start, options.existing(), options.checkpoint_every);
}

TestRun run_recorded(const Protocol& protocol, const Specimen& specimen, RecordStore* store, Watch watch) {
  if (store == nullptr) return run_protocol(protocol, specimen, watch);
  if (store->complete()) return {store->test().result, store->test().checkpoint.specimen, {}, true};

  watch.on_record = [&](const Record& record) { store->put(record); };
  watch.on_probe = [&](const ProbeResult& probe) { store->put(probe); };
  watch.on_snapshot = [&](std::size_t record, const Specimen& state) { store->put_snapshot(record, state); };
  watch.on_moment = [&, shown = watch.on_moment](const Moment& moment) {
    if (shown) shown(moment);
    store->offer([&] { return moment.checkpoint(); });
  };
  try {
    const TestRun run = store->checkpoint()
                            ? resume_protocol(protocol, *store->checkpoint(), store->test().result, watch)
                            : run_protocol(protocol, specimen, watch);
    if (run.complete) {
      store->finish(run.result, run.end_state);
    } else {
      store->stop({run.progress, run.end_state});
    }
    return run;
  } catch (...) {
    try {
      store->publish_what_is_there();
    } catch (const std::exception&) {
      // The failure that ended the run is the one to be told; the journal still holds every record.
    }
    throw;
  }
}

}  // namespace rvelab::cli
