/* A host of version 1.0 or 1.1, compiled with the header of that version: abi_consumer_1_0 SPECIMEN.h5 prints "ok". */
#include "consumer.h"

int main(int argc, char** argv) {
  rvelab_pool_def def;
  rvelab_batch batch;
  rvelab_info info;
  rvelab_pool* pool = NULL;
  int64_t specimen = 0, ids[2], twin = 0, n = 0, tokens[2], cost[2];
  double dH[18] = {0}, sigma[18], contact[18], reynolds[18], tangent[72], estimate[2], scale[2], one[9];
  int32_t status[2];
  size_t need = 0;
  void* bytes = NULL;
  EXPECT(argc == 2);
  EXPECT(rvelab_abi_version() >> 16 == RVELAB_ABI_MAJOR &&
         rvelab_abi_version() >= (RVELAB_ABI_MAJOR << 16 | RVELAB_ABI_MINOR));
  EXPECT((rvelab_capabilities() & RVELAB_CAN_FILES) != 0 && strlen(rvelab_version()) > 2);
  EXPECT(strcmp(rvelab_status_name(RVELAB_E_BUSY), "RVELAB_E_BUSY") == 0);
  EXPECT(rvelab_pool_def_init(&def, sizeof def) == RVELAB_OK);
  def.workers = 2;
  def.tolerance_rel = 0.02;
  EXPECT(rvelab_pool_create(&def, &pool) == RVELAB_OK);
  EXPECT(rvelab_template_load(pool, argv[1], &specimen) == RVELAB_OK);
  EXPECT(rvelab_spawn(pool, specimen, 2, ids) == RVELAB_OK);
  EXPECT(rvelab_batch_init(&batch, sizeof batch) == RVELAB_OK);
  batch.n = 2;
  batch.ids = ids;
  batch.dH = dH;
  batch.sigma = sigma;
  batch.contact = contact;
  batch.reynolds = reynolds;
  batch.tangent = tangent;
  batch.error_estimate = estimate;
  batch.dt_scale = scale;
  batch.status = status;
  batch.tokens_out = tokens;
  dH[0] = dH[9] = -1e-5;
  EXPECT(rvelab_trial(pool, &batch) >= RVELAB_OK);
  EXPECT(sigma[0] < 0 && sigma[0] == sigma[9] && contact[0] == sigma[0] && reynolds[0] == 0 && tangent[0] > 0);
  EXPECT(status[1] >= RVELAB_OK && scale[1] == 1 && estimate[1] >= 0);
  EXPECT(rvelab_revert(pool, 1, &ids[1]) == RVELAB_OK && rvelab_commit(pool, 0, NULL) == RVELAB_OK);
  EXPECT(rvelab_apply(pool, ids[1], dH, 0, one) >= RVELAB_OK && one[0] == sigma[0]);
  batch.tokens_in = tokens;
  EXPECT(rvelab_trial(pool, &batch) >= RVELAB_E_STALE);
  EXPECT(rvelab_info_init(&info, sizeof info) == RVELAB_OK && rvelab_get_info(pool, ids[0], &info) == RVELAB_OK);
  EXPECT(info.grains > 0 && info.p > 0 && info.token >= 2);
  EXPECT(rvelab_cost(pool, 2, ids, cost) == RVELAB_OK && cost[1] > 0);
  EXPECT(rvelab_snapshot_save(pool, ids[0], NULL, 0, &need) == RVELAB_OK && (bytes = malloc(need)) != NULL);
  EXPECT(rvelab_snapshot_save(pool, ids[0], bytes, need, &need) == RVELAB_OK);
  EXPECT(rvelab_snapshot_load(pool, ids[1], bytes, need) == RVELAB_OK);
  EXPECT(rvelab_template_from_snapshot(pool, bytes, need, &specimen) == RVELAB_OK);
#if RVELAB_ABI_MINOR >= 1
  EXPECT(rvelab_template_release(pool, specimen) == RVELAB_OK &&
         rvelab_template_release(pool, specimen) == RVELAB_E_ID);
#endif
  free(bytes);
  EXPECT(rvelab_clone(pool, ids[0], &twin) == RVELAB_OK && rvelab_release(pool, 1, &twin) == RVELAB_OK);
  EXPECT(rvelab_apply(pool, twin, dH, 0, one) == RVELAB_E_ID);
  EXPECT(rvelab_ids(pool, 0, NULL, &n) == RVELAB_OK && n == 2);
  EXPECT(rvelab_pool_read(pool, "none.h5") == RVELAB_E_INPUT);
  EXPECT(rvelab_pool_write(pool, "nowhere/at/all.h5") == RVELAB_E_FILE);
  EXPECT(rvelab_pool_destroy(pool) == RVELAB_OK);
  printf("ok\n");
  return 0;
}
