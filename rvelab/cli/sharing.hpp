// Tests that several processes share (--share): ranks of mpirun, or shells on one machine or several that see one
// folder. They send no messages: a test belongs to the process that holds the lock of its journal.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "rvelab/cli/recording.hpp"

namespace rvelab::cli {

/// Who this process is among those that a launcher started: Open MPI's mpirun, or one that speaks PMI (MPICH, Intel
/// MPI, srun --mpi=pmi2). The first and only one without a launcher.
struct Ranks {
  unsigned rank = 0, count = 1;
  unsigned on_machine = 1;  ///< ranks beside each other on this machine, this one included
};
Ranks launched_ranks();

/// A test whose records are kept.
struct KeptTest {
  const protocol::Protocol* protocol;
  std::function<Specimen()> specimen;
  std::string file;
};

/// With options.share: carries out what no other process has in hand. True on the first rank, once every test is
/// complete or has failed; it then reads them, and meets the failures again. False on other ranks, when nothing is left
/// for them to take. True at once without options.share. Exit through end_stopped if it is stopped.
bool shared_out(const std::vector<KeptTest>& tests, const TestOptions& options);

/// As open_store; with options.share it waits where another process is just looking at the file.
std::unique_ptr<io::RecordStore> open_shared_store(const std::string& path, const protocol::Protocol& protocol,
                                                   const Specimen& specimen, const TestOptions& options);

}  // namespace rvelab::cli
