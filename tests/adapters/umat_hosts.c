/* Hosts of umat_, each in the shape that it really calls: Abaqus, CalculiX, Kratos, MOOSE; and calls that are refused.
 *
 *     umat_hosts HOST FOLDER     in FOLDER: discs.h5, spheres.h5, as tests/CMakeLists.txt packs them
 *
 * What comes back is held against the same increments through rvelab.h. */
#include "tests/adapters/umat_hosts.h"
#include <dlfcn.h>

int failures = 0;

/* ---- Abaqus: everything is given, four calls an increment, each from the state at its start ---- */

static void abaqus(void) {
  const double tries[] = {0.75, 1.25, 1, 1}; /* predictor, iterations, a last repeat at the converged state */
  struct reference of = reference_of("discs.h5");
  struct point at = new_point(3, 1, 2, 0);
  first_stress("discs.h5", 3, 1, at.stress);
  at.noel = 7;
  at.npt = 3;
  for (int step = 1; step <= 6; ++step) {
    const struct point start = at;
    for (int k = 0; k < 4; ++k) {
      at = start;
      at.F1[3] = start.F0[3] + tries[k] * shear_step; /* F_12, column-major */
      at.dstran[3] = tries[k] * shear_step;
      at.pnewdt = 1;
      call_in_full(&at);
      CHECK(at.pnewdt == 1);
      CHECK(at.statev[0] != 0 && memcmp(at.statev, start.statev, sizeof at.statev) != 0);
    }
    double dH[9] = {0}, sigma[9], tangent[36], stress[6], ddsdde[36];
    dH[1] = shear_step;
    reference_step(&of, dH, 0, sigma, tangent);
    to_host(sigma, 3, 1, stress);
    tangent_to_host(tangent, 3, 1, ddsdde);
    for (int k = 0; k < 4; ++k) CHECK(at.stress[k] == stress[k]);
    for (int j = 0; j < 4; ++j)
      for (int i = 0; i < 4; ++i) CHECK(at.ddsdde[i + 4 * j] == ddsdde[i + 4 * j] + (j < 3 ? stress[i] : 0));
    CHECK(fabs(at.ddsdde[3 + 4 * 3]) > 1e6);
    memcpy(at.F0, at.F1, sizeof at.F0);
  }
  CHECK(fabs(at.stress[3]) > 1000);

  /* A step that cannot be made asks for a smaller one, with stress and state as they were. */
  struct point before = at;
  at.F1[3] += 0.5;
  call_in_full(&at);
  CHECK(at.pnewdt > 0 && at.pnewdt < 1);
  CHECK(memcmp(at.stress, before.stress, sizeof at.stress) == 0);
  CHECK(memcmp(at.statev, before.statev, sizeof at.statev) == 0);

  /* Tries of a first increment, each of which may be the one that is accepted; a second point has its own. */
  struct point first[3], other;
  for (int k = 0; k < 3; ++k) {
    first[k] = new_point(3, 1, 1, 0);
    first_stress("discs.h5", 3, 1, first[k].stress);
    first[k].F1[3] = (k + 1) * shear_step;
    call_in_full(&first[k]);
  }
  for (int k = 0; k < 3; ++k) {
    struct reference alone = reference_of("discs.h5");
    double dH[9] = {0}, sigma[9], tangent[36], stress[6];
    dH[1] = (k + 1) * shear_step;
    reference_step(&alone, dH, 0, sigma, tangent);
    memcpy(first[k].F0, first[k].F1, sizeof first[k].F0);
    other = first[k];
    call_in_full(&first[k]);
    call_in_full(&other);
    CHECK(first[k].statev[0] == other.statev[0] && (k == 0 || first[k].statev[0] != first[0].statev[0]));
    dH[1] = 0;
    reference_step(&alone, dH, 0, sigma, tangent);
    to_host(sigma, 3, 1, stress);
    CHECK(memcmp(first[k].stress, stress, 4 * sizeof *stress) == 0);
    rvelab_pool_destroy(alone.pool);
  }
  rvelab_pool_destroy(of.pool);
}

/* ---- CalculiX: R^T sigma R, threads, plane strain in solids with round-off in z, a first call with dstran = 0 ---- */

enum { threads = 4, points_each = 3, steps = 5 };

static double expected[steps][6], expected_tangent[steps][36];

/* Simple shear of `shear` steps, then turned by 0.1 a step, in the plane, row-major. */
static void turned_shear(double shear, double* F) {
  double R[9], S[9];
  rotation_in_plane(0.1 * shear, R);
  identity(S);
  S[1] = shear * shear_step;
  product(R, S, F);
}

static void* work_of_thread(void* number) {
  for (int k = 0; k < points_each; ++k) {
    struct point at = new_point(3, 3, 1, 1);
    first_stress("discs.h5", 3, 3, at.stress);
    at.noel = 1 + *(const int*)number;
    at.npt = 1 + k;
    for (int step = 0; step < steps; ++step) {
      const struct point start = at;
      for (int call = 0; call < 4; ++call) {
        double F[9];
        at = start;
        turned_shear(step + (call == 1 ? 0.5 : 1), F);
        transpose(F, at.F1);
        at.F1[8] = 1 + (call % 2 == 0 ? 2.5e-16 : -1.2e-16);
        at.F1[6] = 1e-18;
        at.dstran[3] = call == 0 ? 0 : shear_step; /* the first call of a step: F1 has moved already */
        call_in_full(&at);
      }
      CHECK(near_to(at.stress, expected[step], 6, 1e-7));
      CHECK(near_to(at.ddsdde, expected_tangent[step], 36, 1e-6));
      memcpy(at.F0, at.F1, sizeof at.F0);
    }
  }
  return NULL;
}

static void calculix(void) {
  struct reference of = reference_of("discs.h5");
  for (int step = 0; step < steps; ++step) {
    double F0[9], F1[9], inverse[9], dH[9], sigma[9], turned[9], tangent[36], R[9];
    turned_shear(step, F0);
    turned_shear(step + 1, F1);
    const double cofactors[9] = {F0[4], -F0[1], 0, -F0[3], F0[0], 0, 0, 0, 1}; /* det F0 = 1 */
    memcpy(inverse, cofactors, sizeof inverse);
    for (int k = 0; k < 9; ++k) F1[k] -= F0[k];
    product(F1, inverse, dH);
    reference_step(&of, dH, 0, sigma, tangent);
    turned_shear(step + 1, F1);
    rotation_in_plane(atan2(F1[3] - F1[1], F1[0] + F1[4]), R); /* F = R U in the plane */
    turn_back(sigma, R, turned);
    to_host(turned, 3, 3, expected[step]);
    for (int column = 0; column < 6; ++column) turned_column(tangent, R, column, expected_tangent[step] + 6 * column);
    CHECK(fabs(turned[1] - sigma[1]) > 100 || step < 2);
  }
  pthread_t thread[threads];
  int number[threads];
  for (int k = 0; k < threads; ++k) {
    number[k] = k;
    REQUIRE(pthread_create(&thread[k], NULL, work_of_thread, &number[k]) == 0);
  }
  for (int k = 0; k < threads; ++k) pthread_join(thread[k], NULL);
  rvelab_pool_destroy(of.pool);
}

/* ---- Kratos: small strains, most pointers null, no name of the point ---- */

static void kratos(void) {
  struct reference of = reference_of("discs.h5");
  struct point at = new_point(3, 1, 1, 0), other;
  first_stress("discs.h5", 3, 1, at.stress);
  const struct point fresh = at;
  const double strain[4] = {-2e-4, 1e-4, 0, 3e-4};
  for (int step = 0; step < 4; ++step) {
    const struct point start = at;
    for (int call = 0; call < 3; ++call) {
      at = start;
      for (int k = 0; k < 4; ++k) at.dstran[k] = (call == 0 ? 0.3 : 1) * strain[k];
      call_with_nulls(&at);
    }
    const double e[3] = {strain[0], strain[1], 0.5 * strain[3]};
    double dH[9], sigma[9], tangent[36], stress[6];
    exponential_in_plane(e, dH);
    reference_step(&of, dH, 0, sigma, tangent);
    to_host(sigma, 3, 1, stress);
    CHECK(near_to(at.stress, stress, 4, 1e-6));
  }
  struct point first = fresh; /* points without a name never share an RVE */
  other = fresh;
  call_with_nulls(&first);
  call_with_nulls(&other);
  CHECK(first.statev[0] != 0 && other.statev[0] != 0 && other.statev[0] != first.statev[0]);

  /* A linear analysis hands in gradients that stand still beside its strains. */
  struct point still = fresh, strained = fresh;
  memcpy(still.dstran, strain, sizeof strain);
  memcpy(strained.dstran, strain, sizeof strain);
  call_in_full(&still);
  call_with_nulls(&strained);
  CHECK(memcmp(still.stress, strained.stress, sizeof still.stress) == 0);
  CHECK(still.stress[3] != fresh.stress[3]);

  /* Without PNEWDT a step that cannot be made is an error. */
  other.dstran[3] = 0.5;
  call_with_nulls(&other);
  CHECK(isnan(other.stress[0]) && isnan(other.stress[3]));
  rvelab_pool_destroy(of.pool);
}

/* ---- MOOSE: spheres; residuals and tangents in calls of their own, line searches; physical time ---- */

static void moose(void) {
  struct reference of = reference_of("spheres.h5");
  struct point at = new_point(3, 3, 3, 0);
  first_stress("spheres.h5", 3, 3, at.stress);
  at.noel = 1;
  at.npt = 1;
  for (int step = 0; step < 4; ++step) {
    const struct point start = at;
    const double search[] = {1, 1, 0.5, 0.25, 1, 1}; /* residual and tangent, line search, residual and tangent */
    for (int call = 0; call < 6; ++call) {
      at = start;
      at.F1[6] = start.F0[6] + search[call] * shear_step; /* F_13 */
      call_in_full(&at);
    }
    double dH[9] = {0}, sigma[9], tangent[36], stress[6], ddsdde[36];
    dH[2] = shear_step;
    reference_step(&of, dH, 0, sigma, tangent);
    to_host(sigma, 3, 3, stress);
    tangent_to_host(tangent, 3, 3, ddsdde);
    for (int k = 0; k < 6; ++k) CHECK(at.stress[k] == stress[k]);
    for (int k = 0; k < 36; ++k) CHECK(at.ddsdde[k] == ddsdde[k]);
    memcpy(at.F0, at.F1, sizeof at.F0);
  }
  CHECK(fabs(at.stress[4]) > 1000 && fabs(at.stress[4]) > 3 * fabs(at.stress[3]));

  /* PROPS(3) = 1: DTIME counts. */
  struct point slow = at, fast = at;
  slow.props[2] = fast.props[2] = 1;
  slow.dtime = 1e-3;
  fast.dtime = 1e-6;
  slow.F1[6] = fast.F1[6] = at.F0[6] + shear_step;
  call_in_full(&slow);
  call_in_full(&fast);
  double dH[9] = {0}, sigma[9], tangent[36], stress[6];
  dH[2] = shear_step;
  reference_step(&of, dH, 1e-6, sigma, tangent);
  to_host(sigma, 3, 3, stress);
  CHECK(memcmp(fast.stress, stress, sizeof stress) == 0);
  CHECK(fabs(fast.stress[4] - slow.stress[4]) > 1000);
  rvelab_pool_destroy(of.pool);
}

/* ---- refused: NaN, and one text in the log ---- */

static void expect_refused(struct point at, const char* words) {
  const double statev[2] = {at.statev[0], at.statev[1]};
  struct point again = at;
  call_in_full(&at);
  call_in_full(&again);
  for (int k = 0; k < at.ntens; ++k) CHECK(isnan(at.stress[k]));
  CHECK(at.statev[0] == statev[0] && at.statev[1] == statev[1]);
  const int times = count_in_log(words);
  if (times != 1) fprintf(stderr, "\"%s\" stands %d times in the log\n", words, times);
  CHECK(times == 1);
}

static void refused(void) {
  remove("rvelab_umat.log");
  struct point good = new_point(3, 1, 1, 0);
  first_stress("discs.h5", 3, 1, good.stress);
  good.F1[3] = shear_step;
  struct point bad = good;
  bad.stress[1] *= 1.05;
  expect_refused(bad, "STRESS of the first call is");
  bad = good;
  bad.stress[1] *= 1.001;
  call_in_full(&bad);
  CHECK(isfinite(bad.stress[1]));
  bad = good;
  memset(bad.stress, 0, sizeof bad.stress);
  expect_refused(bad, "write initial_stress = \"specimen\" under its [[material]] in rvelab_umat.toml");
  bad = good;
  bad.props[0] = 9;
  expect_refused(bad, "PROPS(1) is 9; ");
  bad = good;
  bad.props[0] = 1.5;
  expect_refused(bad, "PROPS(1) is 1.5");
  bad = good;
  bad.props[1] = 3;
  expect_refused(bad, "PROPS(2) is 3; allowed: 0 (global Cauchy");
  bad = good;
  bad.F1[0] = -1;
  expect_refused(bad, "det DFGRD1 -1");
  bad = good;
  bad.ntens = 6;
  expect_refused(bad, "NDI, NSHR, NTENS are 3, 1, 6");
  bad = good;
  call_in_full(&bad);
  bad.statev[1] += 1; /* of a first increment of another process */
  expect_refused(bad, "the state variables name a first increment that this process did not make");
  bad.statev[1] -= 1;
  bad.statev[0] -= 100;
  expect_refused(bad, "a restart file of the host or another process (MPI) does not have them");
  bad = good;
  call_in_full(&bad);
  memcpy(bad.F0, bad.F1, sizeof bad.F0);
  call_in_full(&bad); /* now it has an RVE */
  bad.statev[1] += 5;
  expect_refused(bad, "RVELAB_E_STALE");
  const double id = bad.statev[0];
  bad.statev[0] = 1.5; /* an id may be so large that it has no halves */
  expect_refused(bad, "STATEV(1) is ");
  bad.statev[0] = (double)(float)id; /* passed through single precision */
  expect_refused(bad, "RVELAB_E_ID");
  bad = good;
  bad.ndi = 2, bad.ntens = 3;
  bad.stress[2] = bad.stress[3], bad.stress[3] = 0;
  bad.F1[8] = 1.001;
  expect_refused(bad, "NDI is 2, and DFGRD0(3,3) and DFGRD1(3,3) are 1.000000 and 1.001000");
  bad = good;
  bad.props[0] = 4; /* its specimen is missing */
  expect_refused(bad, "none.h5");
  bad = new_point(2, 1, 3, 0);
  first_stress("spheres.h5", 2, 1, bad.stress);
  expect_refused(bad, "NDI is 2 and the specimen is 3D");
}

/* ---- told: one call, whatever stands in the file of materials; prints what the log says of it ---- */

static void told(void) {
  remove("rvelab_umat.log");
  struct point at = new_point(3, 1, 1, 0);
  first_stress("discs.h5", 3, 1, at.stress);
  call_in_full(&at);
  printf("%s\n", isnan(at.stress[0]) ? "refused" : "done");
  print_log(stdout);
}

/* ---- a host whose memory runs out (tests/memory_shim.cpp is preloaded) ---- */

static void without_memory(void) {
  void (*fail_requests)(long, int) = NULL;
  long (*requests_made)(void) = NULL;
  *(void**)&fail_requests = dlsym(RTLD_DEFAULT, "fail_requests");
  *(void**)&requests_made = dlsym(RTLD_DEFAULT, "requests_made");
  REQUIRE(fail_requests != NULL && requests_made != NULL);
  struct point start = new_point(3, 1, 1, 0);
  first_stress("discs.h5", 3, 1, start.stress);
  start.noel = start.npt = 1;
  start.F1[3] = shear_step;
  for (int step = 0; step < 2; ++step) { /* a point that is new, and one that goes on */
    struct point expected = start;
    call_in_full(&expected);
    CHECK(isfinite(expected.stress[3]));
    long refused = 0;
    for (int lasting = 0; lasting < 2; ++lasting)
      for (long number = 1, met = 1; met; number += number < 20 ? 1 : 13) {
        struct point at = start;
        if (step == 0) at.noel = 1000 * (lasting + 1) + (int)number;
        const struct point before = at;
        fail_requests(number, lasting);
        call_in_full(&at);
        met = requests_made() >= number;
        fail_requests(0, 0);
        if (!isfinite(at.stress[0])) {
          ++refused;
          CHECK(memcmp(at.statev, before.statev, sizeof at.statev) == 0 && at.pnewdt == before.pnewdt);
          at = before;
          call_in_full(&at); /* with memory */
        }
        CHECK(memcmp(at.stress, expected.stress, sizeof at.stress) == 0);
        CHECK(memcmp(at.ddsdde, expected.ddsdde, sizeof at.ddsdde) == 0);
      }
    CHECK(refused > 20);
    call_in_full(&start);
    memcpy(start.F0, start.F1, sizeof start.F0);
    start.F1[3] += shear_step;
  }
}

int main(int argc, char** argv) {
  static const struct {
    const char* name;
    void (*run)(void);
  } hosts[] = {{"abaqus", abaqus},     {"calculix", calculix},
               {"kratos", kratos},     {"kratos_in_space", kratos_in_space},
               {"moose", moose},       {"moose_turns", moose_turns},
               {"disobeys", disobeys}, {"obeys", obeys},
               {"moves", moves},       {"environment", environment},
               {"unnamed", unnamed},   {"refused", refused},
               {"told", told},         {"without_memory", without_memory}};
  REQUIRE(argc == 3 && chdir(argv[2]) == 0);
  for (size_t k = 0; k < sizeof hosts / sizeof *hosts; ++k) {
    if (strcmp(argv[1], hosts[k].name) != 0) continue;
    hosts[k].run();
    if (failures > 0) print_log(stderr);
    return failures > 0;
  }
  for (size_t k = 0; k < sizeof hosts / sizeof *hosts; ++k) fprintf(stderr, "%s FOLDER\n", hosts[k].name);
  return 2;
}
