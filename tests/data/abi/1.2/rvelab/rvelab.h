/* The declarations of rvelab.h in version 1.2; include/rvelab/rvelab.h tells what they mean. */
#ifndef RVELAB_RVELAB_H
#define RVELAB_RVELAB_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define RVELAB_ABI_MAJOR 1
#define RVELAB_ABI_MINOR 2

int32_t rvelab_abi_version(void);

const char* rvelab_version(void);

int64_t rvelab_capabilities(void);

#define RVELAB_CAN_PLANE 1
#define RVELAB_CAN_SPACE 2
#define RVELAB_CAN_TANGENT 4
#define RVELAB_CAN_ERROR_ESTIMATE 8
#define RVELAB_CAN_HOST_TASKS 16
#define RVELAB_CAN_FILES 32

#define RVELAB_OK 0
#define RVELAB_W_TOLERANCE 1
#define RVELAB_W_NOT_QUASI_STATIC 2
#define RVELAB_W_CELL_THIN 3
#define RVELAB_W_TANGENT_AFFINE 4
#define RVELAB_W_NOT_HELD 5
#define RVELAB_DISCARD (-1)
#define RVELAB_E_INPUT (-2)
#define RVELAB_E_NULL (-3)
#define RVELAB_E_ID (-4)
#define RVELAB_E_STALE (-5)
#define RVELAB_E_DUPLICATE (-6)
#define RVELAB_E_NO_TRIAL (-7)
#define RVELAB_E_BUSY (-8)
#define RVELAB_E_FORKED (-9)
#define RVELAB_E_MEMORY (-10)
#define RVELAB_E_UNSUPPORTED (-11)
#define RVELAB_E_BUFFER (-12)
#define RVELAB_E_SNAPSHOT (-13)
#define RVELAB_E_FILE (-14)
#define RVELAB_E_LIBRARY (-15)
#define RVELAB_E_LIMIT (-16)
#define RVELAB_E_INTERNAL (-17)

const char* rvelab_status_name(int32_t status);

const char* rvelab_last_error(void);

typedef struct rvelab_pool rvelab_pool;

typedef void (*rvelab_task)(void* work, int64_t index);

typedef void (*rvelab_run_tasks)(void* host, rvelab_task task, void* work, int64_t count);

#define RVELAB_TRIAL_KEEP 0
#define RVELAB_TRIAL_RECOMPUTE 1

typedef struct rvelab_pool_def {
  uint32_t struct_size;
  uint32_t flags;
  int32_t workers;
  int32_t trial_memory;

  double tolerance_rel;
  double tolerance_abs;
  int64_t max_substeps;
  double damping;
  double min_height;
  rvelab_run_tasks run_tasks;
  void* host;
} rvelab_pool_def;

int32_t rvelab_pool_def_init(rvelab_pool_def* def, size_t struct_size);

int32_t rvelab_pool_create(const rvelab_pool_def* def, rvelab_pool** pool);

int32_t rvelab_pool_destroy(rvelab_pool* pool);

int32_t rvelab_template_load(rvelab_pool* pool, const char* path, int64_t* tmpl);

int32_t rvelab_template_from_snapshot(rvelab_pool* pool, const void* buf, size_t size, int64_t* tmpl);

int32_t rvelab_template_release(rvelab_pool* pool, int64_t tmpl);

int32_t rvelab_spawn(rvelab_pool* pool, int64_t tmpl, int64_t n, int64_t* ids);

int32_t rvelab_clone(rvelab_pool* pool, int64_t src, int64_t* dst);

int32_t rvelab_release(rvelab_pool* pool, int64_t n, const int64_t* ids);

int32_t rvelab_ids(rvelab_pool* pool, int64_t cap, int64_t* ids, int64_t* n);

int32_t rvelab_apply(rvelab_pool* pool, int64_t id, const double* dH, double dt, double* sigma);

typedef struct rvelab_batch {
  uint32_t struct_size;
  uint32_t flags;
  int64_t n;
  double dt;

  const int64_t* ids;
  const double* dH;
  const int64_t* tokens_in;

  double* sigma;
  double* contact;
  double* reynolds;
  double* tangent;
  double* error_estimate;
  double* dt_scale;
  int32_t* status;
  int64_t* tokens_out;
} rvelab_batch;

int32_t rvelab_batch_init(rvelab_batch* batch, size_t struct_size);

int32_t rvelab_trial(rvelab_pool* pool, rvelab_batch* batch);

typedef struct rvelab_mixed {
  uint32_t struct_size;
  uint32_t flags;
  int64_t n;
  int64_t rows;
  double dt;
  double tolerance;

  const int64_t* ids;
  const double* strain;
  const double* stress;
  const double* value;
  const double* scale;
  const double* missed;
  const double* spin;

  double* sigma;
  double* dH;
  double* held_error;
  double* error_estimate;
  int32_t* status;
  int64_t* tokens_out;
} rvelab_mixed;

int32_t rvelab_mixed_init(rvelab_mixed* mixed, size_t struct_size);

int32_t rvelab_apply_mixed(rvelab_pool* pool, rvelab_mixed* mixed);

int32_t rvelab_relax(rvelab_pool* pool, int64_t id, double unbalanced, int64_t max_substeps, double* sigma);

int32_t rvelab_commit(rvelab_pool* pool, int64_t n, const int64_t* ids);

int32_t rvelab_revert(rvelab_pool* pool, int64_t n, const int64_t* ids);

typedef struct rvelab_info {
  uint32_t struct_size;
  uint32_t flags;
  int64_t dimension;
  int64_t grains;
  int64_t contacts;
  double lattice[9];
  double rotation[9];
  double volume;
  double void_ratio;
  double coordination_number;
  double fabric[9];
  double fabric_anisotropy;
  double sliding_fraction;
  double p;
  double q;
  double unbalanced_force_ratio;
  double inertial_number;
  double permeability_ratio;
  double min_height_ratio;
  int64_t grain_steps;
  int64_t bytes_resting;
  int64_t bytes_trial;
  int64_t bytes_working;
  int64_t token;

  double sigma[9];
  double contact[9];
  double reynolds[9];
  double error_estimate;
} rvelab_info;

int32_t rvelab_info_init(rvelab_info* info, size_t struct_size);

int32_t rvelab_get_info(rvelab_pool* pool, int64_t id, rvelab_info* info);

#define RVELAB_OF_CELL 0
#define RVELAB_OF_GRAINS 1
#define RVELAB_OF_CONTACTS 2

#define RVELAB_DOUBLE 0
#define RVELAB_INT64 1

typedef struct rvelab_array {
  uint32_t struct_size;
  uint32_t flags;
  const char* name;
  const char* unit;
  const char* meaning;
  int32_t of;
  int32_t type;
  int64_t rows;
  int64_t columns;
} rvelab_array;

int32_t rvelab_array_init(rvelab_array* array, size_t struct_size);

int32_t rvelab_list_arrays(rvelab_pool* pool, int64_t id, int64_t cap, rvelab_array* arrays, int64_t* n);

int32_t rvelab_get_array(rvelab_pool* pool, int64_t id, const char* name, void* buf, size_t cap, size_t* need);

int32_t rvelab_get_parameters(rvelab_pool* pool, int64_t id, char* text, size_t cap, size_t* need);

int32_t rvelab_set_parameters(rvelab_pool* pool, int64_t id, const char* toml);

int32_t rvelab_cost(rvelab_pool* pool, int64_t n, const int64_t* ids, int64_t* grain_steps);

int32_t rvelab_snapshot_save(rvelab_pool* pool, int64_t id, void* buf, size_t cap, size_t* need);

int32_t rvelab_snapshot_load(rvelab_pool* pool, int64_t id, const void* buf, size_t size);

int32_t rvelab_pool_write(rvelab_pool* pool, const char* path);

int32_t rvelab_pool_read(rvelab_pool* pool, const char* path);

#ifdef __cplusplus
}
#endif

#endif
