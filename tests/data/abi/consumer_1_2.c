/* A host of version 1.2, compiled with the header of that version: consumer_1_2 SPECIMEN.h5 prints "ok". */
#include <math.h>
#include "consumer.h"

/* Its text in memory of the caller, or null. */
static char* parameters_of(rvelab_pool* pool, int64_t id) {
  size_t need = 0;
  char* text = NULL;
  if (rvelab_get_parameters(pool, id, NULL, 0, &need) == RVELAB_OK && (text = malloc(need)) != NULL)
    if (rvelab_get_parameters(pool, id, text, need, &need) != RVELAB_OK) text[0] = 0;
  return text;
}

int main(int argc, char** argv) {
  rvelab_pool_def def;
  rvelab_mixed mixed;
  rvelab_info before, after;
  rvelab_array arrays[128];
  rvelab_pool* pool = NULL;
  int64_t specimen = 0, id = 0, n = 0, k, token = 0;
  /* Drained biaxial compression: d eps_yy = -1e-5, d eps_xy = 0, d sigma_xx = 0. */
  const double strain[27] = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0.5, 0, 0.5};
  const double stress[27] = {1};
  double value[3] = {0, -1e-5, 0}, scale[3] = {1e5, 1e-5, 1e-5}, sigma[9], dH[9], held = 1, estimate = -1, *force;
  int32_t status = -1;
  size_t need = 0;
  char* text;
  EXPECT(argc == 2);
  EXPECT(rvelab_abi_version() >> 16 == RVELAB_ABI_MAJOR &&
         rvelab_abi_version() >= (RVELAB_ABI_MAJOR << 16 | RVELAB_ABI_MINOR));
  EXPECT(rvelab_pool_def_init(&def, sizeof def) == RVELAB_OK && rvelab_pool_create(&def, &pool) == RVELAB_OK);
  EXPECT(rvelab_template_load(pool, argv[1], &specimen) == RVELAB_OK &&
         rvelab_spawn(pool, specimen, 1, &id) == RVELAB_OK);
  EXPECT(rvelab_info_init(&before, sizeof before) == RVELAB_OK && rvelab_get_info(pool, id, &before) == RVELAB_OK);
  EXPECT(before.sigma[0] < 0 && before.reynolds[0] == 0 && before.contact[4] == before.sigma[4]);
  EXPECT(rvelab_mixed_init(&mixed, sizeof mixed) == RVELAB_OK);
  mixed.n = 1;
  mixed.rows = 3;
  mixed.ids = &id;
  mixed.strain = strain;
  mixed.stress = stress;
  mixed.value = value;
  mixed.scale = scale;
  mixed.sigma = sigma;
  mixed.dH = dH;
  mixed.held_error = &held;
  mixed.error_estimate = &estimate;
  mixed.status = &status;
  mixed.tokens_out = &token;
  EXPECT(rvelab_apply_mixed(pool, &mixed) >= RVELAB_OK && status >= RVELAB_OK);
  EXPECT(fabs(dH[4] / -1e-5 - 1) < 1e-6 && held <= 0.005 && estimate >= 0 && sigma[4] < before.sigma[4]);
  EXPECT(rvelab_info_init(&after, sizeof after) == RVELAB_OK && rvelab_get_info(pool, id, &after) == RVELAB_OK);
  EXPECT(after.sigma[0] == sigma[0] && after.token == token && token != before.token);
  EXPECT(rvelab_array_init(arrays, sizeof arrays[0]) == RVELAB_OK);
  for (k = 1; k < 128; ++k) arrays[k] = arrays[0];
  EXPECT(rvelab_list_arrays(pool, id, 128, arrays, &n) == RVELAB_OK && n > 10);
  for (k = 0; k < (n < 128 ? n : 128); ++k)
    if (strcmp(arrays[k].name, "contacts/force_N") == 0) break;
  EXPECT(k < n && arrays[k].of == RVELAB_OF_CONTACTS && arrays[k].rows == after.contacts &&
         strcmp(arrays[k].unit, "N") == 0);
  EXPECT(rvelab_get_array(pool, id, "contacts/force_N", NULL, 0, &need) == RVELAB_OK &&
         need == 8 * (size_t)(3 * after.contacts));
  EXPECT((force = malloc(need)) != NULL &&
         rvelab_get_array(pool, id, "contacts/force_N", force, need - 1, &need) == RVELAB_E_BUFFER);
  EXPECT(rvelab_get_array(pool, id, "contacts/force_N", force, need, &need) == RVELAB_OK);
  free(force);
  EXPECT(rvelab_get_array(pool, id, "no such array", NULL, 0, &need) == RVELAB_E_INPUT);
  EXPECT(rvelab_set_parameters(pool, id, "solver.relative_tolerance = 0.03125") == RVELAB_OK);
  EXPECT((text = parameters_of(pool, id)) != NULL && strstr(text, "0.03125") != NULL &&
         strstr(text, "[contact]") != NULL);
  free(text);
  EXPECT(rvelab_set_parameters(pool, id, "solver.relative_tolerance = -1") == RVELAB_E_INPUT);
  EXPECT(rvelab_relax(pool, id, 1e-3, 10000, sigma) >= RVELAB_OK && sigma[0] < 0);
  EXPECT(rvelab_pool_destroy(pool) == RVELAB_OK);
  printf("ok\n");
  return 0;
}
