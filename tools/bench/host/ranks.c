/* A host over ranks: the same batches by a pool of one process and by one over all ranks of MPI_COMM_WORLD; their
 * stresses must be the same to the bit. Half of the RVEs are of each specimen, so that their cost is unlike, and every
 * third batch is of the first specimen alone, so that RVEs move.
 *
 *   mpirun -np 4 rvelab-bench-ranks RVES STEPS SIZE SPECIMEN.h5 SPECIMEN.h5
 *
 * Prints seconds of all batches in one process on as many threads as there are ranks, and over the ranks. */
#include <mpi.h>
#include <rvelab/rvelab_mpi.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void require(int holds, const char* what) {
  if (holds) return;
  fprintf(stderr, "ranks: %s: %s\n", what, rvelab_last_error());
  MPI_Abort(MPI_COMM_WORLD, 1);
}

/* Numbers in [-1, 1], the same in both pools. */
static double drawn(uint64_t* state) {
  *state = *state * 6364136223846793005ULL + 1442695040888963407ULL;
  return (double)(*state >> 11) / 4503599627370496.0 - 1;
}

/* Another pool of this process, which gives out its ids first. */
static rvelab_pool* other_pool(const char* specimen, int64_t* id) {
  rvelab_pool* other;
  int64_t tmpl;
  require(rvelab_pool_create(NULL, &other) == RVELAB_OK && rvelab_template_load(other, specimen, &tmpl) >= 0,
          "other pool");
  require(rvelab_spawn(other, tmpl, 1, id) == RVELAB_OK, "spawn");
  return other;
}

/* All batches; sigma[9 n] is that of the last, and its sum over all. */
static double batches(rvelab_pool* pool, int64_t n, int steps, double size, char** specimens, double* sigma,
                      double* sum) {
  int64_t* ids = malloc((size_t)n * sizeof *ids);
  double* dH = calloc((size_t)n * 9, sizeof *dH);
  int64_t tmpl;
  uint64_t state = 1;
  rvelab_batch batch;
  for (int half = 0; half < 2; ++half) {
    require(rvelab_template_load(pool, specimens[half], &tmpl) >= 0, specimens[half]);
    require(rvelab_spawn(pool, tmpl, half ? n - n / 2 : n / 2, ids + (half ? n / 2 : 0)) == RVELAB_OK, "spawn");
  }
  memset(sum, 0, (size_t)n * 9 * sizeof *sum);
  const double start = MPI_Wtime();
  for (int step = 0; step < steps; ++step) {
    for (int64_t k = 0; k < n; ++k)
      for (int c = 0; c < 9; ++c) dH[9 * k + c] = c == 0 || c == 1 || c == 3 || c == 4 ? size * drawn(&state) : 0;
    require(rvelab_batch_init(&batch, sizeof batch) == RVELAB_OK, "batch");
    batch.n = step % 3 == 2 ? n / 2 : n;
    batch.ids = ids;
    batch.dH = dH;
    batch.sigma = sigma;
    require(rvelab_trial(pool, &batch) >= 0, "trial");
    require(rvelab_commit(pool, 0, NULL) == RVELAB_OK, "commit");
    for (int64_t k = 0; k < 9 * batch.n; ++k) sum[k] += sigma[k];
  }
  const double seconds = MPI_Wtime() - start;
  free(ids);
  free(dH);
  return seconds;
}

int main(int argc, char** argv) {
  int rank, ranks;
  MPI_Init(&argc, &argv);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  require(argc == 6, "usage: rvelab-bench-ranks RVES STEPS SIZE SPECIMEN.h5 SPECIMEN.h5");
  const int64_t n = atoll(argv[1]);
  const int steps = atoi(argv[2]);
  const double size = atof(argv[3]);
  rvelab_pool_def def;
  require(rvelab_pool_def_init(&def, sizeof def) == RVELAB_OK, "def");
  def.workers = 1;
  rvelab_pool* pool = NULL;
  /* What one rank gets wrong is refused on all. */
  def.workers = rank == ranks - 1 ? -1 : 1;
  require(rvelab_mpi_pool_create(&def, MPI_Comm_c2f(MPI_COMM_WORLD), &pool) == RVELAB_E_INPUT && pool == NULL,
          "bad workers");
  require(strstr(rvelab_last_error(), rank == ranks - 1 ? "workers" : "another rank") != NULL, "text");
  require(rvelab_mpi_pool_create(&def, -77, &pool) == RVELAB_E_INPUT, "no communicator");
  def.workers = 1;
  pool = (rvelab_pool*)&def; /* must become null where there is none */
  require(rvelab_mpi_pool_create(&def, MPI_Comm_c2f(MPI_COMM_WORLD), &pool) == RVELAB_OK, "create");
  if (rank == 0) {
    const size_t bytes = (size_t)n * 9 * sizeof(double);
    double *over = calloc(4, bytes), *one = over + 9 * n, *sum_over = one + 9 * n, *sum_one = sum_over + 9 * n;
    int64_t foreign;
    rvelab_pool* other = other_pool(argv[5], &foreign);
    const double spread = batches(pool, n, steps, size, argv + 4, over, sum_over);
    require(rvelab_apply(pool, foreign, one, 0, over) == RVELAB_E_ID, "an id of another pool was taken");
    require(rvelab_pool_destroy(other) == RVELAB_OK, "destroy");
    require(rvelab_pool_destroy(pool) == RVELAB_OK, "destroy");
    def.workers = ranks;
    require(rvelab_pool_create(&def, &pool) == RVELAB_OK, "create");
    const double threads = batches(pool, n, steps, size, argv + 4, one, sum_one);
    require(rvelab_pool_destroy(pool) == RVELAB_OK, "destroy");
    require(memcmp(over, one, bytes) == 0 && memcmp(sum_over, sum_one, bytes) == 0, "the stresses are not the same");
    printf("%d ranks, %lld RVEs, %d batches of %g: the same bits; %.3f s over ranks, %.3f s on as many threads\n",
           ranks, (long long)n, steps, size, spread, threads);
    free(over);
  } else {
    require(pool == NULL, "the pool of another rank is not null");
  }
  MPI_Finalize();
  return 0;
}
