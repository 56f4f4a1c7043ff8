/* rvelab over MPI: the RVEs of one pool spread over many processes, for more of them than one machine holds.
 *
 * librvelab-mpi.so beside librvelab.so, of the same version. The pool is called with the functions of rvelab.h, by the
 * first rank alone: it sends each RVE's increments to the rank that holds it and gathers the results, bit for bit those
 * of a pool in one process. RVEs move between ranks when their counted work (grain-steps) at the busiest rank is more
 * than 10 % above the mean; ids, tokens and pending trials stay as they are.
 *
 * What differs from a pool in one process: calls from several threads follow one another (MPI_THREAD_SERIALIZED or more
 * is then needed), where rvelab.h has RVELAB_E_BUSY for two on one id; rvelab_cost counts an RVE's work on all ranks.
 *
 * C11 and C++17; no mpi.h is needed to read this. */
#ifndef RVELAB_RVELAB_MPI_H
#define RVELAB_RVELAB_MPI_H

#include <rvelab/rvelab.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Collective over the communicator, MPI being initialised: every rank calls it, with fortran_comm = MPI_Comm_c2f(comm),
 * or the handle of Fortran itself. On the first rank *pool is the pool. The others serve it inside this call until
 * rvelab_pool_destroy on the first, before MPI_Finalize; then they return RVELAB_OK with *pool null.
 *
 * def, as in rvelab_pool_create: workers, run_tasks and host are each rank's own (workers 0: the cores of its machine,
 * divided by the ranks there); the rest is that of the first rank. Errors, the same on all ranks, *pool untouched:
 * RVELAB_E_INPUT (no MPI, no communicator, a bad option), RVELAB_E_LIBRARY (versions differ), RVELAB_E_MEMORY. */
int32_t rvelab_mpi_pool_create(const rvelab_pool_def* def, int32_t fortran_comm, rvelab_pool** pool);

#ifdef __cplusplus
}
#endif

#endif /* RVELAB_RVELAB_MPI_H */
