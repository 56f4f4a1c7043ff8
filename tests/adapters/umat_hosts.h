/* What hosts of umat_ have in common: a material point, calls of it, and tensors in both orders. */
#ifndef RVELAB_TESTS_UMAT_HOSTS_H
#define RVELAB_TESTS_UMAT_HOSTS_H

#include <math.h>
#include <pthread.h>
#include <rvelab/rvelab.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

extern int failures;

/* In umat_stand_ins.c. */
void kratos_in_space(void);
void moose_turns(void);
void disobeys(void);
void obeys(void);
void moves(void);
void environment(void);
void unnamed(void);

#define CHECK(condition)                                                        \
  do {                                                                          \
    if (!(condition)) {                                                         \
      fprintf(stderr, "%s:%d: not true: %s\n", __FILE__, __LINE__, #condition); \
      __atomic_add_fetch(&failures, 1, __ATOMIC_RELAXED);                       \
    }                                                                           \
  } while (0)
#define REQUIRE(condition)                                                                               \
  do {                                                                                                   \
    if (!(condition)) {                                                                                  \
      fprintf(stderr, "%s:%d: not true: %s; %s\n", __FILE__, __LINE__, #condition, rvelab_last_error()); \
      exit(1);                                                                                           \
    }                                                                                                    \
  } while (0)

/* As a Fortran compiler calls it: the length of CMNAME follows the arguments. */
void umat_(double* stress, double* statev, double* ddsdde, double* sse, double* spd, double* scd, double* rpl,
           double* ddsddt, double* drplde, double* drpldt, const double* stran, const double* dstran,
           const double* time, const double* dtime, const double* temp, const double* dtemp, const double* predef,
           const double* dpred, const char* cmname, const int* ndi, const int* nshr, const int* ntens,
           const int* nstatv, const double* props, const int* nprops, const double* coords, const double* drot,
           double* pnewdt, const double* celent, const double* dfgrd0, const double* dfgrd1, const int* noel,
           const int* npt, const int* layer, const int* kspt, const int* kstep, const int* kinc, size_t length);

struct reference {
  rvelab_pool* pool;
  int64_t id;
};

struct point {
  int ndi, nshr, ntens, noel, npt;
  double stress[6], ddsdde[36], statev[3], props[3];
  double stran[6], dstran[6], F0[9], F1[9], drot[9]; /* column-major */
  double pnewdt, time, dtime;
};

static inline void identity(double* F) {
  memset(F, 0, 9 * sizeof *F);
  F[0] = F[4] = F[8] = 1;
}

static inline void call_in_full(struct point* at) {
  double energy[4] = {0}, thermal[6] = {0}, time[2] = {at->time, at->time}, other = 0, coords[3] = {0};
  const int nstatv = 3, nprops = 3, layer = 1, kspt = 1, kstep = 1, kinc = 1;
  umat_(at->stress, at->statev, at->ddsdde, energy, energy + 1, energy + 2, energy + 3, thermal, thermal, &other,
        at->stran, at->dstran, time, &at->dtime, &other, &other, &other, &other, "GRANULAR", &at->ndi, &at->nshr,
        &at->ntens, &nstatv, at->props, &nprops, coords, at->drot, &at->pnewdt, &other, at->F0, at->F1, &at->noel,
        &at->npt, &layer, &kspt, &kstep, &kinc, 8);
}

static inline void call_with_nulls(struct point* at) {
  double energy[3] = {0}, time = 0;
  const int nstatv = 2, nprops = 2, none = 0;
  umat_(at->stress, at->statev, at->ddsdde, energy, energy + 1, energy + 2, NULL, NULL, NULL, NULL, at->stran,
        at->dstran, &time, &at->dtime, NULL, NULL, NULL, NULL, "", &at->ndi, &at->nshr, &at->ntens, &nstatv, at->props,
        &nprops, NULL, NULL, NULL, NULL, NULL, NULL, &none, &none, NULL, NULL, &none, &none, 0);
}

/* Axes of 11 22 33 12 13 23, and where they stand in rvelab.h's xx yy zz yz xz xy. */
static const int axes_of_host[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}};
static const int place_in_rvelab[6] = {0, 1, 2, 5, 4, 3};

static inline int place_of(int k, int ndi) { return k < ndi ? k : 3 + k - ndi; }

/* Row-major stress, shear by its symmetric part. */
static inline void to_host(const double* sigma, int ndi, int nshr, double* stress) {
  for (int k = 0; k < ndi + nshr; ++k) {
    const int* axes = axes_of_host[place_of(k, ndi)];
    const double a = sigma[3 * axes[0] + axes[1]], b = sigma[3 * axes[1] + axes[0]];
    stress[k] = axes[0] == axes[1] ? a : 0.5 * (a + b);
  }
}

static inline void tangent_to_host(const double* tangent, int ndi, int nshr, double* ddsdde) {
  const int n = ndi + nshr;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i)
      ddsdde[i + n * j] = tangent[6 * place_in_rvelab[place_of(i, ndi)] + place_in_rvelab[place_of(j, ndi)]];
}

static inline void rotation_in_plane(double angle, double* R) {
  identity(R);
  R[0] = R[4] = cos(angle);
  R[1] = -sin(angle);
  R[3] = sin(angle);
}

static inline void product(const double* A, const double* B, double* C) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) C[3 * i + j] = A[3 * i] * B[j] + A[3 * i + 1] * B[3 + j] + A[3 * i + 2] * B[6 + j];
}

static inline void transpose(const double* A, double* B) {
  for (int k = 0; k < 9; ++k) B[k] = A[3 * (k % 3) + k / 3];
}

/* R^T S R, row-major */
static inline void turn_back(const double* S, const double* R, double* turned) {
  double transposed[9], half[9];
  transpose(R, transposed);
  product(transposed, S, half);
  product(half, R, turned);
}

/* Stress in axes turned by R of a unit strain there (engineering shear), order of the host. */
static inline void turned_column(const double* tangent, const double* R, int column, double* stress) {
  const int* axes = axes_of_host[column];
  double E[9] = {0}, Rt[9], lab[9], S[9] = {0}, turned[9];
  E[3 * axes[0] + axes[1]] += 0.5;
  E[3 * axes[1] + axes[0]] += 0.5;
  transpose(R, Rt);
  turn_back(E, Rt, lab); /* R E R^T */
  for (int i = 0; i < 6; ++i) {
    double sum = 0;
    for (int j = 0; j < 6; ++j) {
      const int* at = axes_of_host[j];
      const double strain = (at[0] == at[1] ? 1 : 2) * lab[3 * at[0] + at[1]];
      sum += tangent[6 * place_in_rvelab[i] + place_in_rvelab[j]] * strain;
    }
    S[3 * axes_of_host[i][0] + axes_of_host[i][1]] = S[3 * axes_of_host[i][1] + axes_of_host[i][0]] = sum;
  }
  turn_back(S, R, turned);
  to_host(turned, 3, 3, stress);
}

/* exp of {{a, c}, {c, b}} less I, row-major 3 x 3, by its eigenvectors */
static inline void exponential_in_plane(const double* e, double* dH) {
  const double mean = 0.5 * (e[0] + e[1]), half = 0.5 * (e[0] - e[1]), radius = hypot(half, e[2]);
  const double cosh_part = expm1(mean) + exp(mean) * (cosh(radius) - 1), sinh_part = exp(mean) * sinh(radius) / radius;
  memset(dH, 0, 9 * sizeof *dH);
  dH[0] = cosh_part + sinh_part * half;
  dH[4] = cosh_part - sinh_part * half;
  dH[1] = dH[3] = sinh_part * e[2];
}

static inline int near_to(const double* a, const double* b, int n, double tolerance) {
  double error = 0, size = 0;
  for (int k = 0; k < n; ++k) {
    error += (a[k] - b[k]) * (a[k] - b[k]);
    size += b[k] * b[k];
  }
  return size > 0 && error <= tolerance * tolerance * size;
}

static inline int count_in_log(const char* words) {
  char line[4096];
  int times = 0;
  FILE* log = fopen("rvelab_umat.log", "r");
  if (log == NULL) return -1;
  while (fgets(line, sizeof line, log) != NULL) times += strstr(line, words) != NULL;
  fclose(log);
  return times;
}

static inline void print_log(FILE* to) {
  char line[4096];
  FILE* log = fopen("rvelab_umat.log", "r");
  if (log == NULL) return;
  while (fgets(line, sizeof line, log) != NULL) fputs(line, to);
  fclose(log);
}

/* A step of the reference: trial and commit, with the tangent. */
static inline void reference_step(struct reference* of, const double* dH, double dt, double* sigma, double* tangent) {
  rvelab_batch batch;
  REQUIRE(rvelab_batch_init(&batch, sizeof batch) == RVELAB_OK);
  batch.n = 1;
  batch.ids = &of->id;
  batch.dH = dH;
  batch.dt = dt;
  batch.sigma = sigma;
  batch.tangent = tangent;
  REQUIRE(rvelab_trial(of->pool, &batch) >= RVELAB_OK);
  REQUIRE(rvelab_commit(of->pool, 1, &of->id) == RVELAB_OK);
}

static inline struct reference reference_of(const char* specimen) {
  struct reference made = {NULL, 0};
  int64_t tmpl = 0;
  REQUIRE(rvelab_pool_create(NULL, &made.pool) == RVELAB_OK);
  REQUIRE(rvelab_template_load(made.pool, specimen, &tmpl) == RVELAB_OK);
  REQUIRE(rvelab_spawn(made.pool, tmpl, 1, &made.id) == RVELAB_OK);
  return made;
}

/* Stress that the specimen has, as initial condition of the host. */
static inline void first_stress(const char* specimen, int ndi, int nshr, double* stress) {
  struct reference of = reference_of(specimen);
  const double zero[9] = {0};
  double sigma[9], tangent[36];
  reference_step(&of, zero, 0, sigma, tangent);
  rvelab_pool_destroy(of.pool);
  to_host(sigma, ndi, nshr, stress);
}

/* Shear by steps of 2^-13: gradients and their differences are exact, so that both ways see the same bits. */
static const double shear_step = 1.0 / 8192;

static inline struct point new_point(int ndi, int nshr, double material, double corotational) {
  struct point made;
  memset(&made, 0, sizeof made);
  made.ndi = ndi;
  made.nshr = nshr;
  made.ntens = ndi + nshr;
  made.props[0] = material;
  made.props[1] = corotational;
  identity(made.F0);
  identity(made.F1);
  identity(made.drot);
  made.pnewdt = made.dtime = 1;
  return made;
}

#endif
