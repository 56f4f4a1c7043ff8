/* rvelab: granular representative volume elements as the material of a continuum code.
 *
 * An RVE is a periodic cell of grains. An increment of displacement gradient dH goes in, the Cauchy stress comes out. A
 * pool holds many RVEs, one for each material point, and a team of threads.
 *
 * dH      nine doubles, row-major, dH_ij = d(du_i)/dx_j over the step, laboratory frame, finite: F_inc = I + dH, spin
 *         included. Pass the exponential of a rotation: a truncated one increases the volume by |dH|^2/2 per step.
 * sigma   nine doubles, row-major, Pa, laboratory frame, Cauchy, tension positive. SI units throughout. Symmetric to
 *         some 1e-5 of the mean pressure at dt = 0: the torques on grains balance only within the tolerance.
 * dt      s. dt > 0: physical time, real inertia and rate. dt = 0: quasi-static, the RVE chooses its sub-steps within
 *         its tolerance.
 * 2D      a slab of grains in the plane x, y: the z-components of dH must be zero (within 1e-12 + 1e-9 max|dH|); those
 *         of sigma are zero.
 *
 * Every call returns a status: RVELAB_OK; above it a warning (the result is usable); below it RVELAB_DISCARD or an
 * error (the RVE keeps its state, and the call writes only the outputs that its description lists for this case).
 * rvelab_last_error() gives cause and remedy. No call exits, prints or throws. Calls run in the default floating-point
 * environment and restore that of the host.
 *
 * Threads: calls on different ids of one pool may run at once. Two calls on one id, or a call for population or files
 * beside any other call of the pool, return RVELAB_E_BUSY. Results do not depend on the number of workers. A child
 * process gets RVELAB_E_FORKED from the pools of its parent.
 *
 * C11 and C++17. Structs begin with struct_size and flags, have no implicit padding, and later versions add fields only
 * at their end; zero is the default of every field. A smaller struct comes from an older header: its missing fields
 * have their defaults. A larger one comes from a newer header: the bytes beyond this version must be zero, otherwise
 * RVELAB_E_UNSUPPORTED names the offset. A host of a newer header therefore zeroes its structs before init. A size that
 * ends within a field is RVELAB_E_INPUT. Outputs are written up to struct_size. flags must be zero, except those named
 * below.
 *
 * Hosts that iterate for equilibrium (implicit finite elements) use tolerance_rel = 0.1 and tolerance_abs = 1e-3. A
 * drained biaxial test of 400 discs, in increments of 1e-3 by Newton's method with the tangent, then has the same peak
 * of 30.4 degrees as with the tolerances of the specimen, for a ninth of the sub-steps (tools/bench/implicit).
 *
 * Finite differences: at dt = 0 a trial also brings the state closer to equilibrium, by up to the tolerance, and a
 * difference divides this change by its increment h. Deviation from the elastic tangent, C_xxxx of dense discs and
 * spheres, at rest and after strains of 1e-3 and 1e-2 (tools/bench/implicit):
 *
 * central     h = 1e-5: 0 to 10 %; 1e-6: up to 33 %; 1e-7: any value, also of the wrong sign. Use 1e-5 or more.
 * forward     (one-sided) h = 1e-4: up to 9 %; 1e-5: up to a factor of 1.9. Use 1e-4 or more.
 *
 * After rvelab_relax(pool, id, 1e-8, ...) of the committed state one-sided differences of 1e-7 to 1e-5 are within 5 %
 * of those to the other side. Trials of one committed state relax it once: those of 1e-6 after steps of 1e-3 take the
 * time of seven sub-steps each (tools/bench/trials). */
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

/* Capabilities of this library, bits of RVELAB_CAN_*; other bits are zero. */
int64_t rvelab_capabilities(void);

#define RVELAB_CAN_PLANE 1          /* 2D: discs, ellipses, clumps of discs */
#define RVELAB_CAN_SPACE 2          /* 3D: spheres, clumps of them, ellipsoids, superellipsoids */
#define RVELAB_CAN_TANGENT 4        /* batch.tangent */
#define RVELAB_CAN_ERROR_ESTIMATE 8 /* batch.error_estimate */
#define RVELAB_CAN_HOST_TASKS 16    /* pool_def.run_tasks */
#define RVELAB_CAN_FILES 32         /* template_load, pool_write, pool_read, parameters, by librvelab-h5.so */

/* ---- status: each number keeps its meaning ---- */

/* Of several warnings the call returns the first of NOT_HELD, NOT_QUASI_STATIC, TOLERANCE, CELL_THIN, TANGENT_AFFINE;
 * the text always mentions an affine tangent. */
#define RVELAB_OK 0
#define RVELAB_W_TOLERANCE 1        /* dt = 0: the expected error, estimate/2, is above the tolerance */
#define RVELAB_W_NOT_QUASI_STATIC 2 /* dt = 0: the state is not in equilibrium, the specimen flows or collapses */
#define RVELAB_W_CELL_THIN 3        /* a height of the cell is below four mean diameters */
#define RVELAB_W_TANGENT_AFFINE 4   /* the network has no elastic tangent; the affine one (stiffer) was written */
#define RVELAB_W_NOT_HELD 5         /* dt > 0: the error of a held stress of a mixed target exceeds the tolerance */
#define RVELAB_DISCARD (-1)         /* the increment failed: state as before, try dt_scale times the step */
#define RVELAB_E_INPUT (-2)         /* an invalid argument: not finite, det(I + dH) <= 0, dt < 0, bad option */
#define RVELAB_E_NULL (-3)          /* a required pointer is null */
#define RVELAB_E_ID (-4)            /* null, stale, foreign or rounded id, or no such template */
#define RVELAB_E_STALE (-5)         /* no current trial of this RVE has that token; the text lists the valid ones */
#define RVELAB_E_DUPLICATE (-6)     /* an id occurs twice in one call */
#define RVELAB_E_NO_TRIAL (-7)      /* commit of an RVE without a pending trial */
#define RVELAB_E_BUSY (-8)          /* another call is using it */
#define RVELAB_E_FORKED (-9)        /* the pool belongs to the parent process */
#define RVELAB_E_MEMORY (-10)       /* there is not enough memory */
#define RVELAB_E_UNSUPPORTED (-11)  /* a field, flag or value of a later version */
#define RVELAB_E_BUFFER (-12)       /* the buffer is too small; the required size was written */
#define RVELAB_E_SNAPSHOT (-13)     /* damaged, or of another build */
#define RVELAB_E_FILE (-14)         /* a file is missing, damaged or of a later format, or writing it failed */
#define RVELAB_E_LIBRARY (-15)      /* librvelab-h5.so was not found or does not fit */
#define RVELAB_E_LIMIT (-16)        /* no slot or pool tag is left */
#define RVELAB_E_INTERNAL (-17)     /* a defect of rvelab: please report its text */
#define RVELAB_E_INTERRUPTED (-18)  /* rvelab_interrupt stopped it; since 1.4 */

/* "RVELAB_OK" and so on; "unknown status" for any other number. Never null. */
const char* rvelab_status_name(int32_t status);

/* Text of the last call on this thread that did not return RVELAB_OK, warnings included: cause and remedy, with index
 * and id for batches. Valid until the next call on this thread; empty before the first. Never null. */
const char* rvelab_last_error(void);

/* ---- pool ---- */

typedef struct rvelab_pool rvelab_pool;

/* One task of the pool. It neither throws nor waits for other tasks, and may run on any thread. */
typedef void (*rvelab_task)(void* work, int64_t index);

/* Runs task(work, k) once for every k in 0 .. count - 1, in any order, on any threads, and returns when all have ended.
 * Small k are the costliest: begin with them. `host` is pool_def.host. */
typedef void (*rvelab_run_tasks)(void* host, rvelab_task task, void* work, int64_t count);

#define RVELAB_TRIAL_KEEP 0      /* a pending trial is kept beside the committed state: commit costs nothing */
#define RVELAB_TRIAL_RECOMPUTE 1 /* only the committed state is kept: commit repeats the trial */

/* Ids and tokens of a pool begin with numbers drawn at random. With this flag, since 1.4, they count from the lowest:
 * the same calls write pool files of the same bytes, but the pool may accept ids of another process or of a destroyed
 * pool as its own. Only for hosts that never pass ids to another pool or process. */
#define RVELAB_POOL_COUNTED_IDS 2

typedef struct rvelab_pool_def {
  uint32_t struct_size;
  uint32_t flags;       /* 0 or RVELAB_POOL_COUNTED_IDS */
  int32_t workers;      /* threads of a batch, including the caller; 0: the number of hardware threads. They start
                           with the first batch that needs them */
  int32_t trial_memory; /* RVELAB_TRIAL_KEEP or RVELAB_TRIAL_RECOMPUTE */
  /* The next five apply to every template; 0: the value of the specimen. Values for implicit hosts: see above. */
  double tolerance_rel;       /* dt = 0: error of an increment over max(|d sigma|, 0.1 |C : d eps|); both: at most 1 */
  double tolerance_abs;       /* dt = 0: added to that, over p; at least a thousandth of the specimen's value */
  int64_t max_substeps;       /* an increment that needs more is discarded */
  double damping;             /* local damping at any dt, 0 < d < 1: damping force over the unbalanced force */
  double min_height;          /* m; shortest allowed lattice vector (not a height) */
  rvelab_run_tasks run_tasks; /* the host's own task system; null: the pool's workers */
  void* host;                 /* first argument of run_tasks */
} rvelab_pool_def;

/* Sets min(struct_size, own size) bytes to the defaults, and def->struct_size. struct_size = sizeof(rvelab_pool_def).
 */
int32_t rvelab_pool_def_init(rvelab_pool_def* def, size_t struct_size);

/* Makes an empty pool. On errors *pool is unchanged. def null: all defaults. */
int32_t rvelab_pool_create(const rvelab_pool_def* def, rvelab_pool** pool);

/* Joins the workers and frees all memory. Null is allowed. RVELAB_E_BUSY while a call is running: nothing is freed. */
int32_t rvelab_pool_destroy(rvelab_pool* pool);

/* Stops long calls, since 1.4. on = 1: running calls of this pool end within a few sub-steps, and later ones at their
 * first sub-step, with RVELAB_E_INTERRUPTED, until on = 0. An interrupted RVE is as before the call, bit for bit; in a
 * call on many RVEs finished ones keep their new state, as the status of each shows. Work without sub-steps continues
 * (measures, snapshots, a tangent). rvelab_spawn, rvelab_pool_write and rvelab_pool_read stop between two RVEs and
 * leave pool and file as they were. May be called from any thread, beside any other call but rvelab_pool_destroy, and
 * from a signal handler. In a pool over ranks it concerns the RVEs of this process. */
int32_t rvelab_interrupt(rvelab_pool* pool, int32_t on);

/* ---- population ----
 *
 * An id names one RVE of one pool: pool tag (10 bits), generation (17), slot (26), at most 53 bits: exact in a double.
 * Zero is null. A pool has 67,108,800 slots. Its tag and first generation are drawn at random. An id that was released,
 * or belongs to another pool, a destroyed one or another process, is therefore RVELAB_E_ID (one in 67 million is
 * accepted); so is an id that was rounded to single precision. A pool file keeps both: ids stay valid in the pool that
 * reads it. Pools that read one file have the same ids: use each RVE in one of them only.
 * RVEs are copies of a template; it exists until it is released, or as long as its pool. */

/* From a specimen file, or the end state of a record file. Needs librvelab-h5.so beside this library. */
int32_t rvelab_template_load(rvelab_pool* pool, const char* path, int64_t* tmpl);

/* From the bytes of rvelab_snapshot_save. Options of the pool override those of the specimen. */
int32_t rvelab_template_from_snapshot(rvelab_pool* pool, const void* buf, size_t size, int64_t* tmpl);

/* Ends a template, since 1.1; RVEs made from it stay. Its number is then RVELAB_E_ID, as is any other number that is
 * not a template of this pool. */
int32_t rvelab_template_release(rvelab_pool* pool, int64_t tmpl);

/* n independent RVEs in the state of the template; ids[n] is written. All or none. n = 0 is allowed. */
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
 * A trial is a pure function of the committed state, dH and dt: repeated, it gives the same bits. Commit accepts it. A
 * new trial on the same RVE replaces the pending one; after a failed trial none is pending.
 *
 * Tokens are for hosts that have no call for accepted steps. Each trial returns a new token, an integer that is exact
 * in a double. With tokens_in, each RVE starts from the state of the given token. That is the committed state (its
 * token is info.token, or the one returned by the committed trial), or the end of one of the last 16 trials since. The
 * call commits that trial (it repeats it if it is not the last one), even if the following step fails. Any other token
 * is RVELAB_E_STALE, also one of another pool or process: tokens of a pool count up from a number drawn at random.
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
  /* out; null: not computed; no request changes a bit of sigma */
  double* sigma;    /* [9 n], not null */
  double* contact;  /* [9 n] or null: stress of the contact forces, Pa */
  double* reynolds; /* [9 n] or null: stress of the velocity fluctuations, Pa; sigma is the sum. Zero at dt = 0, except
                       in a pure rotation after a step with dt > 0 */
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

/* Makes one trial for each id. Returns the worst status (error, DISCARD, warning, OK; the first in the arrays on ties);
 * rvelab_last_error() explains it with index and id. For a failed RVE only status and dt_scale are written. A wrong or
 * busy id or a stale token is an error of this RVE only. A duplicate id or an error of the whole call (null arrays,
 * n < 0, dt) is found before any work: no output is written then. n = 0 is RVELAB_OK. */
int32_t rvelab_trial(rvelab_pool* pool, rvelab_batch* batch);

/* ---- mixed targets and relaxation, since 1.2 ----
 *
 * Targets for strain and stress together: rows A : d eps + B : d sigma = c, 3 in 2D (over xx, yy, xy) and 6 in 3D, with
 * d eps the symmetric part of dH and d sigma the change of the Cauchy stress over the step; A : d eps sums all nine
 * entries. In a drained biaxial test d eps_yy and d eps_xy are given (A), and sigma_xx has a target (B). A servo within
 * the sub-steps holds the stress. Linearly dependent rows are RVELAB_E_INPUT. At dt = 0 the strain stops until the
 * stress is restored; a stress that the grains cannot carry is RVELAB_DISCARD. */

typedef struct rvelab_mixed {
  uint32_t struct_size;
  uint32_t flags;
  int64_t n;
  int64_t rows;     /* of each RVE, 3 or 6; row k of entry m has the index rows m + k below */
  double dt;        /* s, for all */
  double tolerance; /* of rows with a stress, relative to their scale; 0: 0.005 */
  /* in */
  const int64_t* ids;   /* [n], each once */
  const double* strain; /* [9 rows n], A, symmetric */
  const double* stress; /* [9 rows n], B, symmetric; value in Pa: A in Pa, B without unit */
  const double* value;  /* [rows n], c */
  const double* scale;  /* [rows n]; for rows with a stress > 0: the reference of the tolerance */
  const double* missed; /* [rows n] or null: part of value that the step before has not reached */
  const double* spin;   /* [9 n] or null: skew part of dH */
  /* out; null: not written */
  double* sigma;          /* [9 n], not null */
  double* dH;             /* [9 n]: the applied increment */
  double* held_error;     /* [n]: largest |A : d eps + B : d sigma - c|/scale; dt > 0: of the mean over the step */
  double* error_estimate; /* [n], as of a batch */
  int32_t* status;        /* [n] */
  int64_t* tokens_out;    /* [n]: of the new committed states */
} rvelab_mixed;

/* Sets min(struct_size, own size) bytes to zero, and mixed->struct_size. struct_size = sizeof(rvelab_mixed). */
int32_t rvelab_mixed_init(rvelab_mixed* mixed, size_t struct_size);

/* Applies the target to the committed state of each id and commits the result; a pending trial is reverted. Returns the
 * worst status as rvelab_trial does; a failed RVE is as before, and only its status is written. The same bits as the
 * C++ call Rve::apply, and as the tests of the program. */
int32_t rvelab_apply_mixed(rvelab_pool* pool, rvelab_mixed* mixed);

/* Quasi-static sub-steps at a fixed cell until the unbalanced ratio is at most `unbalanced` or max_substeps are made
 * (RVELAB_W_NOT_QUASI_STATIC then); a pending trial is reverted. sigma[9] or null. */
int32_t rvelab_relax(rvelab_pool* pool, int64_t id, double unbalanced, int64_t max_substeps, double* sigma);

/* The pending trials of n RVEs become their states. ids null: all pending ones (n is ignored). All ids are checked
 * first, all or none: RVELAB_E_NO_TRIAL if an RVE has no trial. */
int32_t rvelab_commit(rvelab_pool* pool, int64_t n, const int64_t* ids);

/* Discards the pending trials of n RVEs; an RVE without one is unchanged. ids null: all. All ids are checked first. */
int32_t rvelab_revert(rvelab_pool* pool, int64_t n, const int64_t* ids);

/* ---- measures ---- */

/* Of the committed state, with or without a pending trial. Tensors are row-major, in the laboratory frame unless
 * stated. */
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
  double sliding_fraction;       /* share of contacts on the Coulomb cone */
  double p;                      /* Pa, -tr(sigma)/dimension, compression positive */
  double q;                      /* Pa; with s the deviator 2D sqrt(s:s/2), 3D sqrt(3 s:s/2) */
  double unbalanced_force_ratio; /* mean resultant (or torque over radius, where larger) over mean contact force */
  double inertial_number;        /* of the last committed step; dt = 0: zero; infinite at p <= 0 */
  double permeability_ratio;     /* e^3/(1 + e) over its value when the RVE was spawned */
  double min_height_ratio;       /* least height of the cell over the mean diameter */
  int64_t grain_steps;           /* grains (members of clumps) times sub-steps, since its specimen was made */
  int64_t bytes_resting;         /* memory of the RVE at rest, without parts shared by its copies */
  int64_t bytes_trial;           /* memory of its pending trial; 0 without */
  int64_t bytes_working;         /* further memory kept between calls in quick succession; 0 at rest */
  int64_t token;                 /* of the committed state */
  /* since 1.2 */
  double sigma[9];       /* Pa, Cauchy stress, as a trial returns it: contact + reynolds */
  double contact[9];     /* Pa, of the contact forces */
  double reynolds[9];    /* Pa, of the velocity fluctuations */
  double error_estimate; /* Pa, of sigma after the last committed step, as in a batch; 0 without */
} rvelab_info;

/* Sets min(struct_size, own size) bytes to zero, and info->struct_size. struct_size = sizeof(rvelab_info). */
int32_t rvelab_info_init(rvelab_info* info, size_t struct_size);

/* Fills info up to its struct_size. */
int32_t rvelab_get_info(rvelab_pool* pool, int64_t id, rvelab_info* info);

/* ---- arrays, since 1.2 ----
 *
 * Arrays of the committed state of an RVE, by name: measures of the cell with the names of records, columns of its
 * grains and contacts. Vectors and tensors are in the laboratory frame, velocities those of dt > 0 (zero after dt = 0).
 * A contact joins the grains of rows i and j, i <= j, with j shifted by lattice columns times image; force and moment
 * act on j. Contacts are those that touch now, in the order of (i, j, image). */

#define RVELAB_OF_CELL 0 /* one row */
#define RVELAB_OF_GRAINS 1
#define RVELAB_OF_CONTACTS 2
#define RVELAB_OF_INTERACTIONS 3 /* since 1.3: bonds and bridges, with the kind in the name: "bonds/radius_m" */

#define RVELAB_DOUBLE 0
#define RVELAB_INT64 1

typedef struct rvelab_array {
  uint32_t struct_size;
  uint32_t flags;      /* written as zero */
  const char* name;    /* valid while the library is loaded, like the next two */
  const char* unit;    /* "1" of a pure number */
  const char* meaning; /* in a few words */
  int32_t of;          /* RVELAB_OF_CELL, RVELAB_OF_GRAINS, RVELAB_OF_CONTACTS or RVELAB_OF_INTERACTIONS */
  int32_t type;        /* of an entry, RVELAB_DOUBLE or RVELAB_INT64: 8 bytes */
  int64_t rows;        /* in this state */
  int64_t columns;     /* 1; a vector 3, a tensor 9, row-major */
} rvelab_array;

/* Sets min(struct_size, own size) bytes to zero, and array->struct_size. struct_size = sizeof(rvelab_array). */
int32_t rvelab_array_init(rvelab_array* array, size_t struct_size);

/* All arrays of an RVE: *n of them; the first min(cap, *n) are described in arrays[cap] (null with cap = 0: count
 * only). Entries of arrays are arrays[0].struct_size bytes apart; initialise each by rvelab_array_init. */
int32_t rvelab_list_arrays(rvelab_pool* pool, int64_t id, int64_t cap, rvelab_array* arrays, int64_t* n);

/* Writes an array, row after row, to buf of cap bytes; *need (not null): 8 rows columns. buf null with cap = 0: only
 * that. RVELAB_E_BUFFER if cap < *need. RVELAB_E_INPUT: no such name; the text names the nearest. */
int32_t rvelab_get_array(rvelab_pool* pool, int64_t id, const char* name, void* buf, size_t cap, size_t* need);

/* ---- parameters, since 1.2 ----
 *
 * Parameters of contact law, damping, solver and materials, by the keys of material files (`rvelab keys`), as text of
 * TOML. They need librvelab-h5.so. */

/* All of them, in the tables [contact], [damping], [solver] and a [[material]] for each; *need (not null): bytes, with
 * the zero at the end. text null with cap = 0: only that. RVELAB_E_BUFFER if cap < *need. */
int32_t rvelab_get_parameters(rvelab_pool* pool, int64_t id, char* text, size_t cap, size_t* need);

/* Sets the keys of the text, "solver.relative_tolerance = 1e-3" or in the form of rvelab_get_parameters; all others
 * stay. [material] is for all materials, [material.sand] for one. Grains, contacts and their forces do not change; the
 * state has a new token, its trials are no longer valid, a pending one is reverted. A key that the contact law does not
 * read goes with that law in one text. RVELAB_E_INPUT names line, key, value and range, and the RVE is as before. */
int32_t rvelab_set_parameters(rvelab_pool* pool, int64_t id, const char* toml);

/* ---- stages of a test, since 1.3 ----
 *
 * Stages of a test on the RVEs of a host: they make bonds and water, dissolve cement, flood pores, apply a pressure.
 * The text is TOML with the keys of protocols (`rvelab keys`); [test] may be missing:
 *
 *   [[stage]]
 *   kind = "cement"
 *   young_modulus_Pa = 50e6
 *   tensile_strength_Pa = 200e3
 *   cohesion_Pa = 200e3
 *
 * They need librvelab-h5.so. */

/* Runs the stages, one after the other, on the committed state of each id; their end is its new state, with a new
 * token. Its trials are no longer valid, a pending one is reverted. The same bits as `rvelab run` on that specimen.
 * Records are not stored; read the state by its arrays. The threads of the pool share the RVEs.
 *
 * sigma[9 n] or null: Pa, of the new states; status[n] or null. Returns the worst status as rvelab_trial does; a failed
 * RVE is as before, and its sigma is not written. RVELAB_E_INPUT: the text names line, key, value and range.
 * RVELAB_DISCARD: a stage failed (the grains cannot carry a stress, or do not come to rest); the text names it. Errors
 * of the TOML text are found before any work: n = 0 (ids null) checks only the text. */
int32_t rvelab_run_stages(rvelab_pool* pool, int64_t n, const int64_t* ids, const char* toml, double* sigma,
                          int32_t* status);

/* grain_steps[n]: cost of each id in this pool, as grains (members of clumps) times sub-steps. It includes reverted,
 * discarded and repeated trials. Work that trials of one committed state share counts for each of them. */
int32_t rvelab_cost(rvelab_pool* pool, int64_t n, const int64_t* ids, int64_t* grain_steps);

/* ---- state ----
 *
 * Snapshots are bitwise and for the same build of rvelab: magic, version, layout and checksum are checked. Use a pool
 * file between builds and versions. Both contain committed states with their tokens, and the last 16 trials as dH and
 * dt, so that a token accepted later gives the same bits. */

/* *need (not null): bytes of the snapshot. buf null with cap = 0: only that. RVELAB_E_BUFFER if cap < *need. */
int32_t rvelab_snapshot_save(rvelab_pool* pool, int64_t id, void* buf, size_t cap, size_t* need);

/* The RVE takes the state of the snapshot, of any specimen; a pending trial is discarded. */
int32_t rvelab_snapshot_load(rvelab_pool* pool, int64_t id, const void* buf, size_t size);

/* All RVEs, with ids and tokens, without templates. An existing file is replaced atomically. */
int32_t rvelab_pool_write(rvelab_pool* pool, const char* path);

/* The RVEs of the file, with their ids and tokens, become those of this pool, which must be without RVEs. */
int32_t rvelab_pool_read(rvelab_pool* pool, const char* path);

#ifdef __cplusplus
}
#endif

#endif /* RVELAB_RVELAB_H */
