// Records of a running test: each goes into a journal at once, all of them into R.h5 now and then.
//
// An HDF5 file that is open for writing may be ruined by kill -9, so R.h5 never is. Each record is one write to
// R.h5.journal; checkpoints go there too; R.h5 is written whole from memory and renamed (publish()). A run that is
// killed loses at most the record under way.
#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <string>

#include "rvelab/io/journal/record_journal.hpp"

namespace rvelab::io {

/// What to do with an R.h5, or its journal, that is there already.
enum class IfExists {
  refuse,
  overwrite,
  resume  ///< go on from it; start where there is none
};

class RecordStore {
 public:
  /// Takes the place: InputError if something is there that `existing` does not allow, if it is of another protocol or
  /// specimen, or if the folder cannot be written to; Busy if another process writes there. `checkpoint_every`: s
  /// between checkpoints, each published; 0: as often as costs little.
  RecordStore(const std::string& path, const RunStart& start, IfExists existing, double checkpoint_every = 0);

  RecordStore(const RecordStore&) = delete;
  RecordStore& operator=(const RecordStore&) = delete;
  ~RecordStore();

  /// Resumed, and nothing is left to do.
  bool complete() const { return test_.complete; }
  /// Resumed: where the run goes on. None: from its start.
  const std::optional<records::Checkpoint>& checkpoint() const { return from_; }
  /// What is recorded so far, beyond the checkpoint too.
  const RecordedTest& test() const { return test_; }

  /// Each throws Error if the journal cannot be written. A record that a resumed run makes again is not written again.
  void put(const records::Record& record);
  void put(const records::ProbeResult& probe);
  void put_snapshot(std::size_t record, const Specimen& state);

  /// Offers a checkpoint: takes, keeps and publishes it if it is time. Checkpoints and publishing together cost less
  /// than a hundredth of the run.
  void offer(const std::function<records::Checkpoint()>& take);
  /// Keeps a checkpoint and publishes the records so far as incomplete. There is no R.h5 without a record.
  void stop(const records::Checkpoint& checkpoint);
  /// The same after a failure, with the last checkpoint that was kept; does nothing after a failed write.
  void publish_what_is_there();
  /// Publishes the whole test and removes the journal.
  void finish(const records::TestResult& result, const Specimen& end_state);

 private:
  using Clock = std::chrono::steady_clock;
  /// When something was done last, and the time that it took.
  struct Last {
    Clock::time_point when;
    double cost = 0;  ///< s
  };

  void resume(const RunStart& start);
  void keep(const records::Checkpoint& checkpoint);
  void publish_now();
  void drop_old_checkpoints();
  bool ready(const Last& last, double shortest) const;

  std::string path_;
  Journal journal_;
  double checkpoint_every_;
  RecordedTest test_;  ///< as in the journal; rows up to made_ are of the present run
  std::optional<records::Checkpoint> from_;
  std::size_t made_records_ = 0, made_probes_ = 0;
  std::uint64_t size_without_ = 0;  ///< bytes of the journal when old checkpoints were dropped last
  bool keeps_something_ = false;    ///< a record or a checkpoint is in the journal
  Last kept_, published_;
};

}  // namespace rvelab::io
