// What `run` and `calibrate` share: tests that are recorded while they run, stopped by signals, and gone on with.
#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "rvelab/io/journal/record_store.hpp"
#include "rvelab/protocol/run.hpp"

namespace rvelab::cli {

/// Options of a command that writes record files.
struct RecordingOptions {
  bool force = false, resume = false;
  double checkpoint_every = 0;  ///< s; 0: as often as costs little

  void add_to(CLI::App& command);
  /// InputError if they are given without a place to write to.
  void expect_output(const std::string& output) const;
  io::Existing existing() const;
};

/// The place for the records of a test.
std::unique_ptr<io::RecordStore> open_store(const std::string& path, const protocol::Protocol& protocol,
                                            const Specimen& specimen, const RecordingOptions& options);

/// Runs a test, or goes on with it, or (complete already) only returns it; every record and checkpoint goes into
/// `store` (nullptr: nowhere). `watch` may have on_moment and stop. A test that is stopped or fails leaves what it has.
protocol::TestRun run_recorded(const protocol::Protocol& protocol, const Specimen& specimen, io::RecordStore* store,
                               protocol::Watch watch);

}  // namespace rvelab::cli
