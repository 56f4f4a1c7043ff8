// Tests whose records are kept, run side by side (protocol/runner.hpp), by this process or by several that share them
// (--share): ranks of mpirun, or shells on one machine or several that see one folder. They send no messages: a test
// belongs to the process that holds the lock of its journal.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "rvelab/cli/recording.hpp"
#include "rvelab/protocol/runner.hpp"

namespace rvelab::cli {

/// Who this process is among those that a launcher started: Open MPI's mpirun, or one that speaks PMI (MPICH, Intel
/// MPI, srun --mpi=pmi2). The first and only one without a launcher.
struct Ranks {
  unsigned rank = 0, count = 1;
  unsigned on_machine = 1;  ///< ranks on this machine, this one included
};
Ranks launched_ranks();
/// Tests at a time: the cores that this process is bound to, or its part of those of the machine.
unsigned threads_of(const Ranks& ranks);

struct RecordedTest : protocol::PlannedTest {
  std::string file;  ///< of its records; "": they are not kept
};

/// When the files of records are opened, and refused: that of each test as it begins, or all before the first.
enum class Opening { one_by_one, all_first };

/// Runs the tests, goes on with those that were stopped, and reads those that are complete; `take` gets each, on the
/// thread of the test. Returns why tests could not be carried out (protocol::Runner::run). With options.share other
/// processes take tests too: none is returned on all ranks but the first, which gets all. Ends by end_stopped after a
/// signal.
std::optional<std::vector<std::string>> run_tests(const std::vector<RecordedTest>& tests, const TestOptions& options,
                                                  Opening opening, const protocol::Runner::Take& take);

}  // namespace rvelab::cli
