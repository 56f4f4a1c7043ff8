// rvelab-mpm-mpi: the same program, its RVEs spread over the ranks of mpirun. The first rank is the driver, the others
// serve its pool.
#define OMPI_SKIP_MPICXX 1
#define MPICH_SKIP_MPICXX 1
#include <mpi.h>
#include <rvelab/rvelab_mpi.h>

#include <cstdio>

#include "tools/mpm/app/program.hpp"

namespace {

/// What the first rank tells the others: whether there is a pool to serve.
int agreed(int served) {
  MPI_Bcast(&served, 1, MPI_INT, 0, MPI_COMM_WORLD);
  return served;
}

int32_t create_over_ranks(const rvelab_pool_def* def, rvelab_pool** pool) {
  agreed(1);
  return rvelab_mpi_pool_create(def, MPI_Comm_c2f(MPI_COMM_WORLD), pool);
}

/// Serves each pool of the first rank, one after the other.
int serve() {
  while (agreed(0) == 1) {
    rvelab_pool* none = nullptr;
    if (rvelab_mpi_pool_create(nullptr, MPI_Comm_c2f(MPI_COMM_WORLD), &none) != RVELAB_OK) {
      std::fprintf(stderr, "rvelab-mpm-mpi: %s\n", rvelab_last_error());
      return 1;
    }
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  int threads = 0, rank = 0;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &threads);  // the driver calls its pool from the main thread
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  int code = 0;
  if (rank == 0) {
    code = mpm::program(argc, argv, {create_over_ranks, true});
    agreed(0);
  } else {
    code = serve();
  }
  MPI_Finalize();
  return code;
}
