// Tests that several processes share: the ranks of mpirun, on one machine or on several that see one folder. No rank
// sends messages: a test belongs to the rank that holds the lock of its journal.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "rvelab/cli/recording.hpp"

namespace rvelab::cli {

/// Who this process is among those that a launcher started: Open MPI's mpirun, or one that speaks PMI (MPICH, Intel
/// MPI, srun --mpi=pmi2). Alone without one.
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

/// Carries out what no other rank has in hand, each rank on its share of the cores. True on the first rank, when all
/// tests are complete, failed or stopped: it goes on with `options`, which then say to resume, and reads them. False on
/// the others, when nothing is left for them to take. True at once for a process that is alone. InputError without
/// files (`kept` false) and with --force.
bool shared_out(const std::vector<KeptTest>& tests, bool kept, TestOptions& options);

}  // namespace rvelab::cli
