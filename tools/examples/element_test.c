/* A biaxial compression test of one RVE: the axis is shortened, the width follows so that the side stress stays.
 *
 *     element_test SPECIMEN.h5 [STRAIN]
 *
 * Prints axial strain, volumetric strain and the stress ratio sigma_yy/sigma_xx. Any status below RVELAB_OK is printed
 * with its text; a host would repeat a step with RVELAB_DISCARD by a smaller one. */
#include <rvelab/rvelab.h>
#include <stdio.h>
#include <stdlib.h>

static int failed(const char* what) {
  fprintf(stderr, "%s: %s\n", what, rvelab_last_error());
  return 1;
}

int main(int argc, char** argv) {
  const double step = 1e-4, end = argc > 2 ? atof(argv[2]) : 0.02;
  rvelab_pool* pool = NULL;
  int64_t specimen = 0, id = 0;
  if (argc < 2) return fprintf(stderr, "element_test SPECIMEN.h5 [STRAIN]\n"), 2;
  if (rvelab_pool_create(NULL, &pool) < RVELAB_OK) return failed("pool");
  if (rvelab_template_load(pool, argv[1], &specimen) < RVELAB_OK) return failed("template");
  if (rvelab_spawn(pool, specimen, 1, &id) < RVELAB_OK) return failed("spawn");

  double zero[9] = {0}, sigma[9], tangent[36], dH[9];
  rvelab_batch batch;
  if (rvelab_apply(pool, id, zero, 0, sigma) < RVELAB_OK) return failed("stress at the start");
  const double side = sigma[0]; /* to be held, Pa, tension positive */
  double width = 0, height = 0;

  for (int k = 1; k * step <= end * (1 + 1e-9); ++k) {
    /* The tangent of the state as it is, from a trial that is then let go of. */
    if (rvelab_batch_init(&batch, sizeof batch) < RVELAB_OK) return failed("batch");
    batch.n = 1;
    batch.ids = &id;
    batch.dH = zero;
    batch.sigma = sigma;
    batch.tangent = tangent;
    if (rvelab_trial(pool, &batch) < RVELAB_OK) return failed("tangent");
    rvelab_revert(pool, 0, NULL);

    /* d sigma_xx = 0: the elastic guess of the widening, and what the last steps left over. */
    for (int c = 0; c < 9; ++c) dH[c] = 0;
    dH[4] = -step;
    dH[0] = (side - sigma[0] + tangent[1] * step) / tangent[0];
    if (rvelab_apply(pool, id, dH, 0, sigma) < RVELAB_OK) return failed("step");
    width += dH[0];
    height += dH[4];
    if (k % 20 == 0) printf("%.4f %9.6f %8.5f\n", -height, width + height, sigma[4] / sigma[0]);
  }
  return rvelab_pool_destroy(pool) < RVELAB_OK ? failed("end") : 0;
}
