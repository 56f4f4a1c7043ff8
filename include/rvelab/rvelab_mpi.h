/* rvelab over MPI: the RVEs of one pool spread over many processes, for more RVEs than fit on one machine.
 *
 * librvelab-mpi.so must be beside librvelab.so, of the same version. Only the first rank calls the functions of
 * rvelab.h on the pool. It sends the increments of each RVE to its rank and gathers the results, bit for bit those of a
 * pool in one process. RVEs move between ranks when the counted work (grain-steps) of the busiest rank is more than 10
 * % above the mean; ids, tokens and pending trials do not change.
 *
 * Differences from a pool in one process: calls from several threads run one after the other (they need
 * MPI_THREAD_SERIALIZED or more), instead of RVELAB_E_BUSY for two calls on one id. rvelab_cost counts the work of an
 * RVE on all ranks.
 *
 * C11 and C++17; this header does not need mpi.h. */
#ifndef RVELAB_RVELAB_MPI_H
#define RVELAB_RVELAB_MPI_H

#include <rvelab/rvelab.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Collective over the communicator after MPI_Init: every rank calls it, with fortran_comm = MPI_Comm_c2f(comm) or the
 * handle of Fortran. On the first rank *pool is the pool. The other ranks serve it inside this call until the first
 * rank calls rvelab_pool_destroy, before MPI_Finalize; then they return RVELAB_OK with *pool null.
 *
 * def, as in rvelab_pool_create: each rank has its own workers, run_tasks and host (workers 0: the cores of its machine
 * over the ranks on it); the other fields are those of the first rank. Errors are the same on all ranks and leave *pool
 * unchanged: RVELAB_E_INPUT (no MPI, no communicator, a bad option), RVELAB_E_LIBRARY (versions differ),
 * RVELAB_E_MEMORY. */
int32_t rvelab_mpi_pool_create(const rvelab_pool_def* def, int32_t fortran_comm, rvelab_pool** pool);

#ifdef __cplusplus
}
#endif

#endif /* RVELAB_RVELAB_MPI_H */
