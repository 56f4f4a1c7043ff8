/* A host of version 1.3, compiled with the header of that version: consumer_1_3 SPECIMEN.h5 prints "ok". */
#include "consumer.h"

static const char* const cement =
    "[[stage]]\nkind = \"cement\"\nyoung_modulus_Pa = 5e6\ntensile_strength_Pa = 1e5\ncohesion_Pa = 1e5\ngap = 0.05\n";
static const char* const weaker = "[[stage]]\nkind = \"dissolve\"\nstrength_left = 0.5\nstep_count = 1\n";

/* Rows of an array of interactions, -1 without one of that name. */
static int64_t rows_of(const rvelab_array* arrays, int64_t n, const char* name) {
  int64_t k;
  for (k = 0; k < n; ++k)
    if (strcmp(arrays[k].name, name) == 0) return arrays[k].of == RVELAB_OF_INTERACTIONS ? arrays[k].rows : -1;
  return -1;
}

int main(int argc, char** argv) {
  rvelab_pool_def def;
  rvelab_info before, after;
  static rvelab_array arrays[512];
  rvelab_pool* pool = NULL;
  int64_t specimen = 0, id = 0, n = 0, k, bonds;
  double sigma[9] = {0}, dH[9] = {0, 0, 0, 0, -1e-5}, *strength, *weakened;
  int32_t status = -1;
  size_t need = 0;
  EXPECT(argc == 2);
  EXPECT(rvelab_abi_version() >> 16 == RVELAB_ABI_MAJOR &&
         rvelab_abi_version() >= (RVELAB_ABI_MAJOR << 16 | RVELAB_ABI_MINOR));
  EXPECT(rvelab_pool_def_init(&def, sizeof def) == RVELAB_OK && rvelab_pool_create(&def, &pool) == RVELAB_OK);
  EXPECT(rvelab_template_load(pool, argv[1], &specimen) == RVELAB_OK &&
         rvelab_spawn(pool, specimen, 1, &id) == RVELAB_OK);
  EXPECT(rvelab_info_init(&before, sizeof before) == RVELAB_OK && rvelab_get_info(pool, id, &before) == RVELAB_OK);
  EXPECT(rvelab_array_init(arrays, sizeof arrays[0]) == RVELAB_OK);
  for (k = 1; k < 512; ++k) arrays[k] = arrays[0];
  EXPECT(rvelab_list_arrays(pool, id, 512, arrays, &n) == RVELAB_OK && n > 10 && n <= 512);
  EXPECT(rows_of(arrays, n, "bonds/tensile_strength_Pa") <= 0);

  /* A text is checked without RVEs; a stage that is wrong changes none. */
  EXPECT(rvelab_run_stages(pool, 0, NULL, cement, NULL, NULL) == RVELAB_OK);
  EXPECT(rvelab_run_stages(pool, 1, &id, "[[stage]]\nkind = \"no such stage\"\n", NULL, NULL) == RVELAB_E_INPUT);
  EXPECT(strstr(rvelab_last_error(), "no such stage") != NULL);
  EXPECT(rvelab_run_stages(pool, 1, &id, cement, sigma, &status) == RVELAB_OK && status == RVELAB_OK && sigma[0] < 0);
  EXPECT(rvelab_info_init(&after, sizeof after) == RVELAB_OK && rvelab_get_info(pool, id, &after) == RVELAB_OK);
  EXPECT(after.token != before.token && after.sigma[0] == sigma[0]);

  EXPECT(rvelab_list_arrays(pool, id, 512, arrays, &n) == RVELAB_OK && n <= 512);
  bonds = rows_of(arrays, n, "bonds/tensile_strength_Pa");
  EXPECT(bonds >= after.contacts / 2 && bonds > 0);
  EXPECT(rvelab_get_array(pool, id, "bonds/tensile_strength_Pa", NULL, 0, &need) == RVELAB_OK &&
         need == 8 * (size_t)bonds);
  EXPECT((strength = malloc(need)) != NULL && (weakened = malloc(need)) != NULL);
  EXPECT(rvelab_get_array(pool, id, "bonds/tensile_strength_Pa", strength, need, &need) == RVELAB_OK &&
         strength[0] == 1e5);
  EXPECT(rvelab_run_stages(pool, 1, &id, weaker, sigma, NULL) == RVELAB_OK);
  EXPECT(rvelab_get_array(pool, id, "bonds/tensile_strength_Pa", weakened, need, &need) == RVELAB_OK);
  for (k = 0; k < bonds; ++k) EXPECT(weakened[k] == 0.5 * strength[k]);
  free(strength);
  free(weakened);
  EXPECT(rvelab_apply(pool, id, dH, 0, sigma) >= RVELAB_OK && sigma[4] < 0);
  EXPECT(rvelab_pool_destroy(pool) == RVELAB_OK);
  printf("ok\n");
  return 0;
}
