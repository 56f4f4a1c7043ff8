/* rvelab: granular representative volume elements as the material of a continuum code.
 *
 * An RVE is a periodic cell of discs, ellipses or spheres. An increment of displacement gradient dH goes in, the Cauchy
 * stress comes out. A pool holds many RVEs, one for each material point, and works on them with the threads given.
 *
 * dH      nine doubles, row-major, dH_ij = d(du_i)/dx_j over the step, laboratory frame, finite: F_inc = I + dH, spin
 *         included. A host that truncates a rotation inflates the volume by |dH|^2/2 a step: send the exponential.
 * sigma   nine doubles, row-major, Pa, laboratory frame, Cauchy, tension positive. SI units throughout. Symmetric to
 *         some 1e-5 of the mean pressure at dt = 0: the torques on grains balance only within the tolerance.
 * dt      s. dt > 0: physical time, real inertia and rate. dt = 0: quasi-static, the RVE chooses its sub-steps within
 *         its tolerance.
 * 2D      a slab of grains in the plane x, y: the z-components of dH must be zero (within 1e-12 + 1e-9 max|dH|); those
 *         of sigma are zero.
 *
 * Every call returns a status: RVELAB_OK, a warning above it (the result is usable), RVELAB_DISCARD or an error below
 * it (the RVE is as before, and the call writes only the outputs that it names). rvelab_last_error() then gives cause
 * and remedy. Nothing exits, prints or throws across this interface. Calls run in the default floating-point
 * environment and restore that of the host.
 *
 * Threads: calls on different ids of one pool may run at once. Two calls on one id, or a call for population or files
 * beside any other call of the pool, return RVELAB_E_BUSY. Results do not depend on the number of workers. A child
 * process gets RVELAB_E_FORKED from the pools of its parent.
 *
 * C11 and C++17. Structs begin with struct_size and flags, hold no implicit padding and only ever grow at their end;
 * zero is the default of every field. A smaller struct of an older header: its missing fields have their defaults. A
 * larger one of a newer header is accepted if what is beyond this version is zero, else RVELAB_E_UNSUPPORTED names the
 * offset: a host of a newer header zeroes its structs before init. A size that ends within a field is RVELAB_E_INPUT.
 * Outputs are written up to struct_size. flags must be zero, but for those named below.
 *
 * Hosts that iterate for equilibrium (implicit finite elements) do with tolerance_rel = 0.1 and tolerance_abs = 1e-3: a
 * drained biaxial test of 400 discs, in increments of 1e-3 by Newton's iteration with the tangent, has a peak of 30.4
 * degrees by these and by the tolerances of the specimen, with a ninth of the sub-steps. At dt = 0 a trial also brings
 * the state closer to equilibrium, by up to the tolerance, and a finite difference divides that by its increment h:
 * central ones take h = 1e-5 or more (1e-5: 0 to 10 % from the elastic tangent; 1e-6: up to 33 %; 1e-7: anything, the
 * wrong sign included), one-sided ones 1e-4 or more (up to 9 %; 1e-5: up to a factor of 1.9). That is C_xxxx of dense
 * discs and spheres, at rest and after strains of 1e-3 and 1e-2; tools/bench/implicit measures all of this. Or settle
 * the committed state first: after rvelab_relax(pool, id, 1e-8, ...) one-sided differences of 1e-7 to 1e-5 are within
 * 5 % of those to the other side. Trials of one committed state settle it once: those of 1e-6 after steps of 1e-3 take
 * the time of seven sub-steps each (tools/bench/trials). */
#ifndef RVELAB_RVELAB_H
#define RVELAB_RVELAB_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ---- version ---- */

#define RVELAB_ABI_MAJOR 1
#define RVELAB_ABI_MINOR 4

/* major << 16 | minor of the library at hand. Same major: a program built with an older header runs. */
int32_t rvelab_abi_version(void);

/* Version of rvelab, "major.minor.patch". Never null. */
const char* rvelab_version(void);

/* What this library does, bits of RVELAB_CAN_*; other bits are zero. */
int64_t rvelab_capabilities(void);

#define RVELAB_CAN_PLANE 1          /* discs and ellipses, 2D */
#define RVELAB_CAN_SPACE 2          /* spheres, 3D */
#define RVELAB_CAN_TANGENT 4        /* batch.tangent */
#define RVELAB_CAN_ERROR_ESTIMATE 8 /* batch.error_estimate */
#define RVELAB_CAN_HOST_TASKS 16    /* pool_def.run_tasks */
#define RVELAB_CAN_FILES 32         /* template_load, pool_write, pool_read, parameters, by way of librvelab-h5.so */

/* ---- status: numbers are never reused ---- */

/* Of several warnings NOT_HELD comes first, then NOT_QUASI_STATIC, TOLERANCE, CELL_THIN, TANGENT_AFFINE; the text of
 * any tells of an affine tangent too. */
#define RVELAB_OK 0
#define RVELAB_W_TOLERANCE 1        /* dt = 0: the error to be expected, estimate/2, is above the tolerance    */
#define RVELAB_W_NOT_QUASI_STATIC 2 /* dt = 0: the state is no equilibrium, the specimen flows or collapses */
#define RVELAB_W_CELL_THIN 3        /* a height of the cell is below four mean diameters */
#define RVELAB_W_TANGENT_AFFINE 4   /* the network has no elastic tangent; the affine one (stiffer) was written */
#define RVELAB_W_NOT_HELD 5         /* dt > 0: a stress of a mixed target was missed by more than the tolerance */
#define RVELAB_DISCARD (-1)         /* the increment cannot be made: state as before, try dt_scale times the step */
#define RVELAB_E_INPUT (-2)         /* an argument is not allowed: not finite, det(I + dH) <= 0, dt < 0, bad option */
#define RVELAB_E_NULL (-3)          /* a pointer that is needed is null */
#define RVELAB_E_ID (-4)            /* null, stale, foreign or rounded id, or no such template */
#define RVELAB_E_STALE (-5)         /* no trial of this RVE has that token any more; the text names those that do */
#define RVELAB_E_DUPLICATE (-6)     /* an id stands twice in one call */
#define RVELAB_E_NO_TRIAL (-7)      /* commit of an RVE without a pending trial */
#define RVELAB_E_BUSY (-8)          /* another call is at work on it */
#define RVELAB_E_FORKED (-9)        /* the pool belongs to the parent process */
#define RVELAB_E_MEMORY (-10)       /* there is not enough memory */
#define RVELAB_E_UNSUPPORTED (-11)  /* a field, flag or value of a later version */
#define RVELAB_E_BUFFER (-12)       /* the buffer is too small; the size needed was written */
#define RVELAB_E_SNAPSHOT (-13)     /* damaged, or of another build */
#define RVELAB_E_FILE (-14)         /* a file is missing, damaged, of a later format, or cannot be written */
#define RVELAB_E_LIBRARY (-15)      /* librvelab-h5.so was not found or does not fit */
#define RVELAB_E_LIMIT (-16)        /* no slot or pool tag is left */
#define RVELAB_E_INTERNAL (-17)     /* a defect of rvelab: please report its text */
#define RVELAB_E_INTERRUPTED (-18)  /* rvelab_interrupt stopped it; since 1.4 */

/* "RVELAB_OK" and so on; "unknown status" for a number that this version does not know. Never null. */
const char* rvelab_status_name(int32_t status);

/* Text of the last call on this thread that did not return RVELAB_OK, warnings included: cause and remedy, with index
 * and id for batches. Valid until the next call on this thread; empty before the first. Never null. */
const char* rvelab_last_error(void);

/* ---- pool ---- */

typedef struct rvelab_pool rvelab_pool;

/* One piece of work of the pool. It neither throws nor blocks on other tasks, and may run on any thread. */
typedef void (*rvelab_task)(void* work, int64_t index);

/* Runs task(work, k) for every k in 0 .. count - 1, each once, in any order, on any threads, and returns when all are
 * done. Small k are the costliest: begin with them. `host` is pool_def.host. */
typedef void (*rvelab_run_tasks)(void* host, rvelab_task task, void* work, int64_t count);

#define RVELAB_TRIAL_KEEP 0      /* a pending trial is kept beside the committed state: commit costs nothing */
#define RVELAB_TRIAL_RECOMPUTE 1 /* only the committed state is kept: commit makes the trial again */

/* Ids and tokens of a pool begin with numbers drawn at random. With this flag, since 1.4, they count from the lowest:
 * the same calls write pool files of the same bytes, but ids of another process, or of a pool that is gone, may be
 * taken for those of this one. For hosts whose ids stay where they were made. */
#define RVELAB_POOL_COUNTED_IDS 2

typedef struct rvelab_pool_def {
  uint32_t struct_size;
  uint32_t flags;       /* 0 or RVELAB_POOL_COUNTED_IDS */
  int32_t workers;      /* threads of a batch, the caller's included; 0: as many as the processor runs at once. They
                           start with the first batch that needs them */
  int32_t trial_memory; /* RVELAB_TRIAL_KEEP or RVELAB_TRIAL_RECOMPUTE */
  /* Of every specimen that a template is made from; 0: what the specimen says. Of implicit hosts: see above. */
  double tolerance_rel;       /* dt = 0: error of an increment over max(|d sigma|, 0.1 |C : d eps|); both: at most 1 */
  double tolerance_abs;       /* dt = 0: added to that, over p, a thousandth of the specimen's own at least */
  int64_t max_substeps;       /* an increment that needs more is discarded */
  double damping;             /* local damping at any dt, 0 < d < 1: share of the unbalanced force against motion */
  double min_height;          /* m; shortest lattice vector allowed */
  rvelab_run_tasks run_tasks; /* the host's own task system; null: the pool's workers */
  void* host;                 /* first argument of run_tasks */
} rvelab_pool_def;

/* Sets min(struct_size, own size) bytes to the defaults, and def->struct_size. struct_size = sizeof(rvelab_pool_def).
 */
int32_t rvelab_pool_def_init(rvelab_pool_def* def, size_t struct_size);

/* Makes an empty pool. *pool is untouched on errors. def null: all defaults. */
int32_t rvelab_pool_create(const rvelab_pool_def* def, rvelab_pool** pool);

/* Joins the workers and frees everything. Null is allowed. RVELAB_E_BUSY while a call is at work: nothing is freed. */
int32_t rvelab_pool_destroy(rvelab_pool* pool);

/* Stops long calls, since 1.4. on = 1: calls of this pool that are under way end within a few sub-steps, and later ones
 * at their first, with RVELAB_E_INTERRUPTED, until on = 0. An RVE that was interrupted is as before the call, bit for
 * bit; of a call on many, those that were done stay so, and the status of each tells. What makes no sub-step goes on
 * (measures, snapshots, a tangent); rvelab_spawn, rvelab_pool_write and rvelab_pool_read stop between two RVEs and
 * leave pool and file as they were. From any thread, beside any other call but rvelab_pool_destroy, and from a signal
 * handler. Of a pool over ranks: the RVEs of this process. */
int32_t rvelab_interrupt(rvelab_pool* pool, int32_t on);

/* ---- population ----
 *
 * An id names one RVE of one pool: pool tag (10 bits), generation (17), slot (26), at most 53 bits: exact in a double.
 * Zero is null. A pool has 67,108,800 slots. Its tag and first generation are drawn at random, so that an id that was
 * released, or is of another pool, of one that is gone or of another process, is RVELAB_E_ID (one in 67 million may be
 * taken); so is one that was passed through single precision. A pool file keeps both: ids go on in the pool that reads
 * it. Pools that read one file have the same ids: give each RVE to one of them.
 * A template is what RVEs are made from; it lives until it is released, or as long as its pool. */

/* From a specimen file, or the end state of a record file. Needs librvelab-h5.so beside this library. */
int32_t rvelab_template_load(rvelab_pool* pool, const char* path, int64_t* tmpl);

/* From the bytes of rvelab_snapshot_save. Options of the pool override those of the specimen. */
int32_t rvelab_template_from_snapshot(rvelab_pool* pool, const void* buf, size_t size, int64_t* tmpl);

/* Ends a template, since 1.1; RVEs made from it stay. Its number is not used again: from then on it is RVELAB_E_ID, as
 * is any number that is no template of this pool. */
int32_t rvelab_template_release(rvelab_pool* pool, int64_t tmpl);

/* n RVEs in the state of the template, each its own from now on; ids[n] is written. All or none. n = 0 is allowed. */
int32_t rvelab_spawn(rvelab_pool* pool, int64_t tmpl, int64_t n, int64_t* ids);

/* A second RVE in the committed state of src, with its tokens. */
int32_t rvelab_clone(rvelab_pool* pool, int64_t src, int64_t* dst);

/* Ends n RVEs. All ids are checked first: all or none. */
int32_t rvelab_release(rvelab_pool* pool, int64_t n, const int64_t* ids);

/* The ids of all RVEs in ascending order of their slots: *n of them, of which the first min(cap, *n) are written to ids
 * (null with cap = 0: count only). */
int32_t rvelab_ids(rvelab_pool* pool, int64_t cap, int64_t* ids, int64_t* n);

/* ---- work, one RVE ---- */

/* Trial and commit in one: applies dH over dt to the committed state (a pending trial is reverted) and writes sigma[9].
 * The same bits as the C++ call Rve::apply. The error estimate is info.error_estimate (1.2). */
int32_t rvelab_apply(rvelab_pool* pool, int64_t id, const double* dH, double dt, double* sigma);

/* ---- work, many RVEs ----
 *
 * A trial is a pure function of the committed state, dH and dt: made again, it gives the same bits. Commit makes it the
 * state. A new trial on the same RVE takes the place of the pending one; one that fails leaves none pending.
 *
 * Tokens serve hosts that cannot say when a step is accepted. Each trial returns a new token, an integer that is exact
 * in a double. With tokens_in, each RVE starts from the state that the token names: the committed one (its token is
 * info.token, or what the trial returned that was committed), or the end of one of the last 16 trials since, which is
 * committed by this (made again if it is not the last), whatever becomes of the step that follows. Any other token is
 * RVELAB_E_STALE, and so is one of another pool or process: tokens of a pool count up from a number drawn at random.
 * Tokens survive snapshots, clones and pool files. */

typedef struct rvelab_batch {
  uint32_t struct_size;
  uint32_t flags;
  int64_t n;
  double dt; /* s, for all */
  /* in */
  const int64_t* ids;       /* [n], each once */
  const double* dH;         /* [9 n] */
  const int64_t* tokens_in; /* [n], or null: from the committed states */
  /* out; what is null is not computed, and what is asked for changes no bit of sigma */
  double* sigma;    /* [9 n], not null */
  double* contact;  /* [9 n] or null: stress of the contact forces, Pa */
  double* reynolds; /* [9 n] or null: stress of the velocity fluctuations, Pa; sigma is the sum. Zero at dt = 0, unless
                       the step before had dt > 0 and this one is no more than a rotation */
  double* tangent;  /* [36 n] or null: elastic tangent of the contact network at the end of the step, Pa, row-major
                       6 x 6: d sigma/d eps of the Cauchy stress (symmetric part) at zero spin, no contact slipping,
                       opening or closing; initial-stress terms included, not symmetrised. Rows and columns xx yy
                       zz yz xz xy, engineering shear in the columns; 2D: rows and columns of z are zero. One sparse
                       factorisation: the time of 300 sub-steps for 400 discs (4 ms), of 5,000 for 1000 spheres
                       (0.4 s); tools/bench/tangent measures it */
  double* error_estimate; /* [n] or null: estimate of the error of sigma, Frobenius norm, Pa; dt > 0: 0 */
  double* dt_scale;       /* [n] or null: 1; after RVELAB_DISCARD the factor on the step to try; after an error 0 */
  int32_t* status;        /* [n] or null: one for each RVE */
  int64_t* tokens_out;    /* [n] or null */
} rvelab_batch;

/* Sets min(struct_size, own size) bytes to zero, and batch->struct_size. struct_size = sizeof(rvelab_batch). */
int32_t rvelab_batch_init(rvelab_batch* batch, size_t struct_size);

/* Makes one trial for each id. Returns the worst status (error, DISCARD, warning, OK; the first in the arrays on ties),
 * which rvelab_last_error() explains with index and id. Output slots of an RVE that failed stay as they were, but
 * status and dt_scale. An id that is wrong, stale in its token or busy fails alone; a duplicate is an error before any
 * work, and so is what concerns the whole call (null arrays, n < 0, dt): no output is written then. n = 0 is RVELAB_OK.
 */
int32_t rvelab_trial(rvelab_pool* pool, rvelab_batch* batch);

/* ---- mixed targets and relaxation, since 1.2 ----
 *
 * What is asked of strain and stress together: rows A : d eps + B : d sigma = c, 3 in 2D (over xx, yy, xy) and 6 in 3D,
 * d eps the symmetric part of dH, d sigma the change of the Cauchy stress over the step; A : d eps sums all nine
 * entries. A drained biaxial test: d eps_yy and d eps_xy given (A), sigma_xx brought to its target (B). A stress is
 * held by a servo within the sub-steps; rows that depend on each other are RVELAB_E_INPUT. At dt = 0 the step waits for
 * the stress, and one that the grains cannot carry is RVELAB_DISCARD. */

typedef struct rvelab_mixed {
  uint32_t struct_size;
  uint32_t flags;
  int64_t n;
  int64_t rows;     /* of each RVE, 3 or 6; row k of entry m is that of number rows m + k below */
  double dt;        /* s, for all */
  double tolerance; /* of rows with a stress, relative to their scale; 0: 0.005 */
  /* in */
  const int64_t* ids;   /* [n], each once */
  const double* strain; /* [9 rows n], A, symmetric */
  const double* stress; /* [9 rows n], B, symmetric; its unit and that of A are those of value over Pa and over 1 */
  const double* value;  /* [rows n], c */
  const double* scale;  /* [rows n]; of rows with a stress > 0: what the tolerance is relative to */
  const double* missed; /* [rows n] or null: part of value that the step before has left */
  const double* spin;   /* [9 n] or null: skew part of dH */
  /* out; what is null is not written */
  double* sigma;          /* [9 n], not null */
  double* dH;             /* [9 n]: what was applied */
  double* held_error;     /* [n]: largest |A : d eps + B : d sigma - c|/scale; dt > 0: of the mean over the step */
  double* error_estimate; /* [n], as of a batch */
  int32_t* status;        /* [n] */
  int64_t* tokens_out;    /* [n]: of the new committed states */
} rvelab_mixed;

/* Sets min(struct_size, own size) bytes to zero, and mixed->struct_size. struct_size = sizeof(rvelab_mixed). */
int32_t rvelab_mixed_init(rvelab_mixed* mixed, size_t struct_size);

/* Applies the target to the committed state of each id, whose end is the new one: trial and commit in one, a pending
 * trial is reverted. Returns the worst status as rvelab_trial does; an RVE that failed is as before, and its outputs
 * but status stay as they were. The same bits as the C++ call Rve::apply, and as the tests of the program. */
int32_t rvelab_apply_mixed(rvelab_pool* pool, rvelab_mixed* mixed);

/* Quasi-static sub-steps at a fixed cell until the unbalanced ratio is at most `unbalanced` or max_substeps are made
 * (RVELAB_W_NOT_QUASI_STATIC then); a pending trial is reverted. sigma[9] or null. */
int32_t rvelab_relax(rvelab_pool* pool, int64_t id, double unbalanced, int64_t max_substeps, double* sigma);

/* The pending trials of n RVEs become their states. ids null: all that are pending (n is not read). All ids are checked
 * first, all or none: RVELAB_E_NO_TRIAL if one has none. */
int32_t rvelab_commit(rvelab_pool* pool, int64_t n, const int64_t* ids);

/* Discards the pending trials of n RVEs; one without stays as it is. ids null: all. All ids are checked first. */
int32_t rvelab_revert(rvelab_pool* pool, int64_t n, const int64_t* ids);

/* ---- measures ---- */

/* Of the committed state, whether a trial is pending or not. Tensors row-major, laboratory frame unless said. */
typedef struct rvelab_info {
  uint32_t struct_size;
  uint32_t flags;    /* written as zero */
  int64_t dimension; /* 2 or 3 */
  int64_t grains;
  int64_t contacts;
  double lattice[9];             /* m; its columns are the cell vectors, upper triangular, in the frame of the cell */
  double rotation[9];            /* from the frame of the cell to the laboratory */
  double volume;                 /* m^3 */
  double void_ratio;             /* overlaps not subtracted */
  double coordination_number;    /* 2 contacts/grains */
  double fabric[9];              /* mean of n (x) n over the contacts, trace 1; NaN without a contact */
  double fabric_anisotropy;      /* of the contact normals: 2D a of (1 + a cos 2(theta - theta_a))/2 pi; NaN as above */
  double sliding_fraction;       /* contacts on the Coulomb cone */
  double p;                      /* Pa, -tr(sigma)/dimension, compression positive */
  double q;                      /* Pa; with s the deviator 2D sqrt(s:s/2), 3D sqrt(3 s:s/2) */
  double unbalanced_force_ratio; /* mean resultant (or torque over radius, where larger) over mean contact force */
  double inertial_number;        /* of the last step that was committed; dt = 0: zero; infinite at p <= 0 */
  double permeability_ratio;     /* e^3/(1 + e) over its value when the RVE was spawned */
  double min_height_ratio;       /* least height of the cell over the mean diameter */
  int64_t grain_steps;           /* grains (members of clumps) times sub-steps, since its specimen was made */
  int64_t bytes_resting;         /* held by the RVE at rest, without what its copies share */
  int64_t bytes_trial;           /* held by its pending trial; 0 without */
  int64_t bytes_working;         /* held beside that between calls in quick succession; 0 at rest */
  int64_t token;                 /* of the committed state */
  /* since 1.2 */
  double sigma[9];    /* Pa, Cauchy stress, as a trial returns it: contact + reynolds */
  double contact[9];  /* Pa, of the contact forces */
  double reynolds[9]; /* Pa, of the velocity fluctuations */
  double
      error_estimate; /* Pa, of sigma after the last step that was committed, as batch.error_estimate; 0 without one */
} rvelab_info;

/* Sets min(struct_size, own size) bytes to zero, and info->struct_size. struct_size = sizeof(rvelab_info). */
int32_t rvelab_info_init(rvelab_info* info, size_t struct_size);

/* Fills info up to its struct_size. */
int32_t rvelab_get_info(rvelab_pool* pool, int64_t id, rvelab_info* info);

/* ---- arrays, since 1.2 ----
 *
 * What the committed state of an RVE holds, by name: measures of the cell by the names that records have, columns of
 * its grains and contacts. Vectors and tensors are in the laboratory frame, velocities those of dt > 0 (zero after dt =
 * 0). A contact joins the grains of rows i and j, i <= j, where j is shifted by lattice columns times image; force and
 * moment are those on j; contacts are in the order of (i, j, image), and are those that touch now. */

#define RVELAB_OF_CELL 0 /* one row */
#define RVELAB_OF_GRAINS 1
#define RVELAB_OF_CONTACTS 2
#define RVELAB_OF_INTERACTIONS 3 /* since 1.3: bonds and bridges; the name says which, "bonds/radius_m" */

#define RVELAB_DOUBLE 0
#define RVELAB_INT64 1

typedef struct rvelab_array {
  uint32_t struct_size;
  uint32_t flags;      /* written as zero */
  const char* name;    /* as long as the library is loaded, as the next two */
  const char* unit;    /* "1" of a pure number */
  const char* meaning; /* in a few words */
  int32_t of;          /* RVELAB_OF_CELL, RVELAB_OF_GRAINS, RVELAB_OF_CONTACTS or RVELAB_OF_INTERACTIONS */
  int32_t type;        /* of an entry, RVELAB_DOUBLE or RVELAB_INT64: 8 bytes */
  int64_t rows;        /* in this state */
  int64_t columns;     /* 1; a vector 3, a tensor 9, row-major */
} rvelab_array;

/* Sets min(struct_size, own size) bytes to zero, and array->struct_size. struct_size = sizeof(rvelab_array). */
int32_t rvelab_array_init(rvelab_array* array, size_t struct_size);

/* All arrays of an RVE: *n of them, of which the first min(cap, *n) are described in arrays[cap] (null with cap = 0:
 * count only). Entries of arrays are arrays[0].struct_size bytes apart, all of them as rvelab_array_init leaves them.
 */
int32_t rvelab_list_arrays(rvelab_pool* pool, int64_t id, int64_t cap, rvelab_array* arrays, int64_t* n);

/* Writes an array, row after row, to buf of cap bytes; *need (not null): 8 rows columns. buf null with cap = 0: only
 * that. RVELAB_E_BUFFER if cap < *need. RVELAB_E_INPUT: no such name; the text names the nearest. */
int32_t rvelab_get_array(rvelab_pool* pool, int64_t id, const char* name, void* buf, size_t cap, size_t* need);

/* ---- parameters, since 1.2 ----
 *
 * Of contact law, damping, solver and materials, by the keys of material files (`rvelab keys`), as text of TOML. By way
 * of librvelab-h5.so. */

/* All of them, in the tables [contact], [damping], [solver] and a [[material]] for each; *need (not null): bytes, with
 * the zero at the end. text null with cap = 0: only that. RVELAB_E_BUFFER if cap < *need. */
int32_t rvelab_get_parameters(rvelab_pool* pool, int64_t id, char* text, size_t cap, size_t* need);

/* Sets the keys that the text has, "solver.relative_tolerance = 1e-3" or as rvelab_get_parameters writes them; all
 * others stay. [material] is for all materials, [material.sand] for one. Grains, contacts and their forces stay as they
 * are; the state has a new token, its trials are over, a pending one is reverted. RVELAB_E_INPUT names line, key, value
 * and range: the RVE is then as before. */
int32_t rvelab_set_parameters(rvelab_pool* pool, int64_t id, const char* toml);

/* ---- stages of a test, since 1.3 ----
 *
 * What the program does with a specimen, done with RVEs of a host: bonds and water are made, cement dissolves, pores
 * are flooded, a pressure is reached. By the keys of protocols (`rvelab keys`), as text of TOML; [test] may be missing:
 *
 *   [[stage]]
 *   kind = "cement"
 *   young_modulus_Pa = 50e6
 *   tensile_strength_Pa = 200e3
 *   cohesion_Pa = 200e3
 *
 * By way of librvelab-h5.so. */

/* Runs the stages, one after the other, on the committed state of each id; their end is its new state, with a new
 * token; its trials are over, a pending one is reverted. The same bits as `rvelab run` on that specimen. Records are
 * not kept; what the state then holds is in its arrays. The RVEs are shared out among the threads of the pool.
 *
 * sigma[9 n] or null: Pa, of the new states; status[n] or null. Returns the worst status as rvelab_trial does; an RVE
 * that failed is as before, and its sigma stays. RVELAB_E_INPUT names line, key, value and range. RVELAB_DISCARD: a
 * stage cannot be carried out (a stress that the grains do not bear, no rest); the text names it. What is wrong in the
 * text by itself is an error before any work: n = 0 (ids null) checks a text alone. */
int32_t rvelab_run_stages(rvelab_pool* pool, int64_t n, const int64_t* ids, const char* toml, double* sigma,
                          int32_t* status);

/* grain_steps[n]: grains (members of clumps) times sub-steps made for each id in this pool: its cost. Trials that were
 * reverted, discarded or made again are included, and so is what trials of one committed state share, as if each had
 * made it. */
int32_t rvelab_cost(rvelab_pool* pool, int64_t n, const int64_t* ids, int64_t* grain_steps);

/* ---- state ----
 *
 * Snapshots are bitwise, for the same build of rvelab: magic, version, layout and checksum are held against it. Across
 * builds and versions a pool file is the way. Both hold committed states with their tokens; the last 16 trials are in
 * them as dH and dt, so that a token accepted later gives the same bits. */

/* *need (not null): bytes of the snapshot. buf null with cap = 0: only that. RVELAB_E_BUFFER if cap < *need. */
int32_t rvelab_snapshot_save(rvelab_pool* pool, int64_t id, void* buf, size_t cap, size_t* need);

/* The RVE takes the state of the snapshot, of any specimen; a pending trial is discarded. */
int32_t rvelab_snapshot_load(rvelab_pool* pool, int64_t id, const void* buf, size_t size);

/* All RVEs, with ids and tokens; templates are not written. An existing file is replaced as a whole, or not at all. */
int32_t rvelab_pool_write(rvelab_pool* pool, const char* path);

/* The RVEs of the file, with their ids and tokens, become those of this pool, which must be without RVEs. */
int32_t rvelab_pool_read(rvelab_pool* pool, const char* path);

#ifdef __cplusplus
}
#endif

#endif /* RVELAB_RVELAB_H */
