// What `run` and `calibrate` share: tests that are recorded while they run, stopped by signals, and continued.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "rvelab/cli/command.hpp"
#include "rvelab/io/journal/record_store.hpp"
#include "rvelab/protocol/run.hpp"

namespace rvelab::cli {

/// What --force and --resume say of files that are there.
inline io::IfExists if_exists(bool force, bool resume) {
  return force ? io::IfExists::overwrite : resume ? io::IfExists::resume : io::IfExists::refuse;
}

/// What a command takes that runs a test and writes record files.
struct TestOptions {
  std::string protocol;
  std::vector<std::string> settings;
  unsigned threads = 0;  ///< 0: one per core
  bool force = false, resume = false;
  bool share = false;           ///< with other processes; implies resume
  double checkpoint_every = 0;  ///< s; 0: as often as costs little
  bool json = false;

  /// Adds them; `example` of --set, and what --threads stands for.
  void add_to(CLI::App& command, const std::string& example, const std::string& threads_help);
  /// InputError if they are given without a place to write to.
  void expect_output(const std::string& output) const;
};

/// The place for the records of a test.
std::unique_ptr<io::RecordStore> open_store(const std::string& path, const protocol::Protocol& protocol,
                                            const Specimen& specimen, const TestOptions& options);

/// Runs a test, continues it, or returns it if it is complete already. `store` gets every record and checkpoint;
/// nullptr: they are not kept. `watch` may have on_path_point and stop. A test that is stopped or fails keeps its
/// records.
protocol::TestRun run_recorded(const protocol::Protocol& protocol, const Specimen& specimen, io::RecordStore* store,
                               protocol::Watch watch);

}  // namespace rvelab::cli
