/* Stand-ins of hosts, by their sources: Kratos (SmallStrainUMATLaw) and MOOSE (AbaqusUMATStress, ComputeFiniteStrain)
 * as they hand in and take out; and hosts that lose, copy or do not name what they are given. umat_hosts.c runs them.
 */
#include <fenv.h>
#include <float.h>
#include <malloc.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include "tests/adapters/umat_hosts.h"

/* ---- Kratos in space: XX YY ZZ XY YZ XZ, no stress at first, null pointers, no names ---- */

static const int axes_of_kratos[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {0, 2}};

static void kratos_exponential(const double* strain, double* dH) {
  double E[9], term[9], next[9];
  for (int k = 0; k < 6; ++k) {
    const int *at = axes_of_kratos[k], i = at[0], j = at[1];
    E[3 * i + j] = E[3 * j + i] = (i == j ? 1 : 0.5) * strain[k];
  }
  memcpy(dH, E, sizeof E);
  memcpy(term, E, sizeof E);
  for (int n = 2; n < 20; ++n) {
    product(term, E, next);
    for (int k = 0; k < 9; ++k) dH[k] += term[k] = next[k] / n;
  }
}

void kratos_in_space(void) {
  struct reference of = reference_of("spheres.h5");
  struct point at = new_point(3, 3, 5, 0);
  const double strain[6] = {-4e-4, 2e-4, 1e-4, 0, 3e-4, -1e-4};
  call_with_nulls(&at); /* InitializeMaterialResponse: what it leaves is not kept */
  at = new_point(3, 3, 5, 0);
  for (int step = 0; step < 4; ++step) {
    const struct point start = at;
    for (int iteration = 0; iteration < 3; ++iteration)
      for (int call = 0; call < 2; ++call) { /* stress, then tangent */
        at = start;
        for (int k = 0; k < 6; ++k) at.dstran[k] = (iteration == 0 ? 0.5 : 1) * strain[k];
        call_with_nulls(&at);
      }
    for (int k = 0; k < 6; ++k) at.stran[k] += strain[k];
    double dH[9], sigma[9], tangent[36], stress[6], ddsdde[36];
    kratos_exponential(strain, dH);
    reference_step(&of, dH, 0, sigma, tangent);
    for (int i = 0; i < 6; ++i) {
      const int* axes = axes_of_kratos[i];
      stress[i] = 0.5 * (sigma[3 * axes[0] + axes[1]] + sigma[3 * axes[1] + axes[0]]);
      const int row[6] = {0, 1, 2, 5, 3, 4}; /* in rvelab.h's xx yy zz yz xz xy */
      for (int j = 0; j < 6; ++j) ddsdde[i + 6 * j] = tangent[6 * row[i] + row[j]];
    }
    CHECK(near_to(at.stress, stress, 6, 1e-7));
    CHECK(near_to(at.ddsdde, ddsdde, 36, 1e-6));
  }
  CHECK(fabs(at.stress[4]) > 1000 && fabs(at.stress[5]) > 1000 && fabs(at.stress[4] - at.stress[5]) > 1000);
  rvelab_pool_destroy(of.pool);

  /* Without the setting its order is not guessed. */
  struct point untold = new_point(3, 3, 6, 0);
  call_with_nulls(&untold);
  CHECK(isnan(untold.stress[0]) && count_in_log("write shear_order = \"kratos\", or \"abaqus\"") == 1);

  /* Any other order: 23 13 12, by DFGRD. */
  struct point ours = new_point(3, 3, 3, 0), theirs = new_point(3, 3, 7, 0);
  first_stress("spheres.h5", 3, 3, ours.stress);
  for (int k = 0; k < 6; ++k) theirs.stress[k] = ours.stress[k < 3 ? k : 8 - k];
  ours.F1[7] = theirs.F1[7] = shear_step;
  call_in_full(&ours);
  call_in_full(&theirs);
  for (int k = 0; k < 6; ++k) CHECK(theirs.stress[k] == ours.stress[k < 3 ? k : 8 - k]);
  CHECK(fabs(ours.stress[5]) > 1000);
}

/* ---- MOOSE: no stress at first, F of the whole motion, DROT of this increment or the one before ---- */

struct moose_point {
  struct point at;
  double F[9], stress[9], R[9]; /* of the last accepted step, row-major */
};

static struct moose_point moose_point(double axes) {
  struct moose_point made = {.at = new_point(3, 3, 6, axes)};
  made.at.noel = made.at.npt = 1;
  identity(made.F);
  identity(made.R);
  return made;
}

static void inverse_in_plane(const double* F, double* inverse) {
  const double J = F[0] * F[4] - F[1] * F[3];
  identity(inverse);
  inverse[0] = F[4] / J, inverse[1] = -F[1] / J, inverse[3] = -F[3] / J, inverse[4] = F[0] / J;
}

/* computeQpStress: the state at the end of the step to F, from the accepted one. */
static struct moose_point moose_call(const struct moose_point* old, const double* F, int hughes_winget) {
  struct moose_point now = *old;
  double inverse[9], step[9], transposed[9], turned[9];
  inverse_in_plane(old->F, inverse);
  product(F, inverse, step);
  rotation_in_plane(atan2(step[3] - step[1], step[0] + step[4]), now.R);
  transpose(now.R, transposed);
  turn_back(old->stress, transposed, turned); /* R S R^T */
  to_host(hughes_winget ? turned : old->stress, 3, 3, now.at.stress);
  transpose(old->F, now.at.F0);
  transpose(F, now.at.F1);
  transpose(hughes_winget ? now.R : old->R, now.at.drot);
  now.at.pnewdt = DBL_MAX;
  call_in_full(&now.at);
  for (int k = 0; k < 6; ++k) {
    const int* axes = axes_of_host[k];
    now.stress[3 * axes[0] + axes[1]] = now.stress[3 * axes[1] + axes[0]] = now.at.stress[k];
  }
  if (!hughes_winget) {
    memcpy(turned, now.stress, sizeof turned);
    turn_back(turned, transposed, now.stress);
  }
  memcpy(now.F, F, sizeof now.F);
  return now;
}

/* Shear by eight steps, then a rotation that grows. */
static void moose_path(int step, double* F) {
  double R[9], S[9];
  rotation_in_plane(0.02 * (step > 1 ? (step - 1) * (step - 1) : 0), R);
  identity(S);
  S[1] = (step > 0 ? 8 : 0) * shear_step;
  S[4] = 1 - step * shear_step;
  product(R, S, F);
}

/* Steps until the host sees a stress that is none. Returns how many were made. */
static int moose_steps(struct moose_point at, int hughes_winget, double* difference) {
  struct reference of = reference_of("spheres.h5");
  *difference = 0;
  int step = 1;
  for (; step <= 5; ++step) {
    const struct moose_point start = at;
    double F0[9], F1[9], inverse[9], dH[9], sigma[9], tangent[36], stress[6], expected[6];
    moose_path(step - 1, F0);
    moose_path(step, F1);
    at = moose_call(&start, F0, hughes_winget); /* the first residual: nothing has moved */
    if (isnan(at.stress[0])) break;
    at = moose_call(&start, F1, hughes_winget);
    inverse_in_plane(F0, inverse);
    for (int k = 0; k < 9; ++k) F0[k] = F1[k] - F0[k];
    product(F0, inverse, dH);
    reference_step(&of, dH, 0, sigma, tangent);
    to_host(sigma, 3, 3, expected);
    to_host(at.stress, 3, 3, stress);
    for (int k = 0; k < 6; ++k) *difference = fmax(*difference, fabs(stress[k] - expected[k]) / 1e5);
    double ddsdde[36];
    tangent_to_host(tangent, 3, 3, ddsdde);
    CHECK(near_to(at.at.ddsdde, ddsdde, 36, 1e-6)); /* it is in global axes, however the stress is */
  }
  rvelab_pool_destroy(of.pool);
  return step - 1;
}

void moose_turns(void) {
  const char* words = "the host turns what is returned; give PROPS(2) = 2";
  double difference;
  CHECK(moose_steps(moose_point(2), 0, &difference) == 5 && difference < 1e-6);
  CHECK(moose_steps(moose_point(0), 1, &difference) == 5 && difference < 1e-6);
  CHECK(count_in_log(words) <= 0);
  /* The first step turned, and the next one does not begin so. */
  CHECK(moose_steps(moose_point(0), 0, &difference) == 1);
  CHECK(count_in_log(words) == 1);
}

/* ---- refused increments ---- */

static const char* const lost = "the host has gone on without the increment that PNEWDT below 1 refused";

/* Sheared twice by a step; then by 0.5, which is refused, and once more from where the host then is. */
static struct point after_refusal(int steps, int obeys, int with_gradients, struct point at) {
  first_stress("discs.h5", 3, 1, at.stress);
  for (int step = 0; step < steps + 2; ++step) {
    const double shear = step == steps ? 0.5 : shear_step;
    const struct point start = at;
    if (with_gradients) at.F1[3] = at.F0[3] + shear;
    at.dstran[3] = shear;
    at.pnewdt = DBL_MAX;
    call_in_full(&at);
    CHECK((at.pnewdt < 1) == (step == steps) || isnan(at.stress[0]));
    CHECK(step != steps || memcmp(at.stress, start.stress, sizeof at.stress) == 0);
    if (step == steps && obeys) continue;
    memcpy(at.F0, at.F1, sizeof at.F0);
    at.stran[3] += shear;
  }
  return at;
}

void disobeys(void) {
  const struct point fresh = new_point(3, 1, 1, 0);
  struct point named = fresh;
  named.noel = named.npt = 1;
  for (int steps = 0; steps < 3; ++steps) { /* the first increment too */
    CHECK(isnan(after_refusal(steps, 0, 1, fresh).stress[3]));
    CHECK(isnan(after_refusal(steps, 0, 1, named).stress[3]));
    CHECK(isnan(after_refusal(steps, 0, 0, fresh).stress[3])); /* by STRAN */
  }
  CHECK(count_in_log(lost) == 2);

  /* By the time alone, where the host gives gradients of the step and no strain. */
  struct point at = fresh;
  first_stress("discs.h5", 3, 1, at.stress);
  at.F1[3] = 0.5;
  call_in_full(&at);
  CHECK(at.pnewdt < 1);
  at.time += at.dtime;
  at.F1[3] = shear_step;
  call_in_full(&at);
  CHECK(isnan(at.stress[3]));
}

void obeys(void) {
  for (int steps = 0; steps < 3; ++steps) {
    struct reference of = reference_of("discs.h5");
    double dH[9] = {0}, sigma[9], tangent[36], stress[6];
    dH[1] = shear_step;
    for (int k = 0; k <= steps; ++k) reference_step(&of, dH, 0, sigma, tangent);
    to_host(sigma, 3, 1, stress);
    CHECK(memcmp(after_refusal(steps, 1, 1, new_point(3, 1, 1, 0)).stress, stress, 4 * sizeof *stress) == 0);
    CHECK(isfinite(after_refusal(steps, 1, 0, new_point(3, 1, 1, 0)).stress[3]));
    rvelab_pool_destroy(of.pool);
  }

  /* Gradients from the start of each step on, as a host of an updated mesh has them; a try that was refused, and one
     that was not and is accepted. */
  struct point at = new_point(3, 1, 1, 0);
  first_stress("discs.h5", 3, 1, at.stress);
  for (int step = 0; step < 4; ++step) {
    const struct point start = at;
    at.F1[3] = 0.5;
    call_in_full(&at);
    CHECK(at.pnewdt < 1);
    at = start;
    at.F1[3] = shear_step;
    call_in_full(&at);
    CHECK(isfinite(at.stress[3]) && at.statev[0] != 0);
    at.stran[3] += shear_step;
    at.time += at.dtime;
  }

  /* CalculiX hands in -1 where nothing is asked for, and each point of an element may ask. */
  at.F1[3] = 0.5;
  at.pnewdt = -1;
  call_in_full(&at);
  CHECK(at.pnewdt > 0 && at.pnewdt < 1);
  at.pnewdt = 1e-3;
  call_in_full(&at);
  CHECK(at.pnewdt == 1e-3);
  CHECK(count_in_log("") <= 0);
}

/* ---- state variables that are copied, to another point or another process ---- */

void moves(void) {
  struct point at = new_point(3, 1, 1, 0);
  first_stress("discs.h5", 3, 1, at.stress);
  at.noel = at.npt = 1;
  for (int step = 0; step < 3; ++step) {
    struct point parent = at, child = at; /* an element is split, at rest and later */
    child.noel = 2;
    for (int k = 0; k < 2; ++k) {
      memcpy(parent.F0, parent.F1, sizeof parent.F0);
      memcpy(child.F0, child.F1, sizeof child.F0);
      parent.F1[3] += shear_step;
      child.F1[0] += shear_step;
      call_in_full(&parent);
      call_in_full(&child);
      CHECK(isfinite(parent.stress[0]));
      CHECK(isfinite(child.stress[0]) == (step == 0 || k == 0)); /* at rest both are specimens */
    }
    at = parent;
  }
  CHECK(count_in_log("another point has the same state variables") >= 1);

  const pid_t child = fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    call_in_full(&at);
    _exit(isnan(at.stress[0]) && count_in_log("the RVEs stayed in the parent process") == 1 ? 0 : 1);
  }
  int status = 1;
  CHECK(waitpid(child, &status, 0) == child && status == 0);
}

/* ---- what the host's process is like: traps, rounding, a folder that changes, a log that cannot be written ---- */

void environment(void) {
  struct point up = new_point(3, 1, 1, 0), plain = up, trapped = up;
  first_stress("discs.h5", 3, 1, up.stress);
  memcpy(plain.stress, up.stress, sizeof up.stress);
  up.F1[3] = plain.F1[3] = shear_step / 3;
  up.F1[1] = plain.F1[1] = shear_step / 7;
  REQUIRE(mkdir("elsewhere", 0755) == 0 && mkdir("rvelab_umat.log", 0755) == 0);
  call_in_full(&plain); /* the settings are read, the log's folder is that of now */
  REQUIRE(chdir("elsewhere") == 0);
  fesetround(FE_UPWARD);
  call_in_full(&up);
  CHECK(fegetround() == FE_UPWARD);
  fesetround(FE_TONEAREST);
  CHECK(memcmp(up.stress, plain.stress, sizeof up.stress) == 0);

  struct point spheres = new_point(3, 3, 6, 0); /* its specimen was not read yet */
  call_in_full(&spheres);
  CHECK(isfinite(spheres.stress[0]));

  feenableexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW);
  const int traps = fegetexcept(); /* none on processors that cannot */
  trapped.stress[0] = NAN;
  call_in_full(&trapped);
  CHECK(fegetexcept() == traps);
  fedisableexcept(FE_ALL_EXCEPT);
  CHECK(isnan(trapped.stress[3]));
  CHECK(access("rvelab_umat.log", F_OK) != 0); /* tests/adapters/test_umat.cpp reads standard error */
}

/* ---- no names, and state variables at 0 in each iteration of the first increment ---- */

static double megabytes(void) {
  const struct mallinfo2 info = mallinfo2();
  return 1e-6 * (double)(info.uordblks + info.hblkhd);
}

void unnamed(void) {
  enum { points = 100, iterations = 20 };
  static struct point at[points];
  struct point start = new_point(3, 1, 1, 0);
  first_stress("discs.h5", 3, 1, start.stress);
  double first = 0;
  for (int iteration = 0; iteration < iterations; ++iteration) {
    for (int k = 0; k < 2 * points; ++k) {
      struct point* point = &at[k / 2];
      *point = start;
      point->dstran[3] = (1 + k / 2) * 1e-6;
      call_with_nulls(point);
    }
    if (iteration == 0) first = megabytes();
  }
  CHECK(megabytes() - first < 1);
  for (int k = 0; k < points; ++k) { /* each has its own state */
    struct point again = start;
    again.dstran[3] = 2 * at[k].dstran[3];
    call_with_nulls(&again);
    call_with_nulls(&at[k]);
    CHECK(at[k].statev[0] > 0 && (k == 0 || at[k].statev[0] != at[k - 1].statev[0]));
    CHECK(k < 50 || near_to(at[k].stress, again.stress, 4, 1e-3));
  }
}
