/* Points that a host moves from one process to another, as one that parts its mesh anew does: with STRESS, STATEV and
 * F, while the RVE stays where it was made. Both processes make the same calls, so that their points would be taken for
 * each other's if ids and tokens did not tell them apart.
 *
 * umat_processes FOLDER */
#include <sys/wait.h>

#include "tests/adapters/umat_hosts.h"

int failures = 0;

static void step(struct point* at, int component, double by) {
  at->F1[component] += by;
  call_in_full(at);
  memcpy(at->F0, at->F1, sizeof at->F0);
}

/* A point after five steps. */
static struct point loaded(int element, int component, double by) {
  struct point at = new_point(3, 1, 1, 0);
  first_stress("discs.h5", 3, 1, at.stress);
  at.noel = element;
  at.npt = 1;
  for (int k = 0; k < 5; ++k) step(&at, component, by);
  REQUIRE(isfinite(at.stress[0]) && at.statev[0] > 0);
  return at;
}

static void expect_refused(struct point at, const char* words) {
  const struct point before = at;
  step(&at, 3, shear_step);
  for (int k = 0; k < at.ntens; ++k) CHECK(isnan(at.stress[k]));
  CHECK(memcmp(at.statev, before.statev, sizeof at.statev) == 0);
  CHECK(count_in_log(words) == 1);
}

int main(int argc, char** argv) {
  int ends[2], status = -1;
  struct point moved;
  REQUIRE(argc == 2 && chdir(argv[1]) == 0 && pipe(ends) == 0);
  const pid_t other = fork(); /* before the first call: each process has a pool of its own */
  REQUIRE(other >= 0);
  if (other == 0) {
    moved = loaded(1, 3, shear_step);
    return write(ends[1], &moved, sizeof moved) != sizeof moved;
  }
  REQUIRE(waitpid(other, &status, 0) == other && status == 0);
  REQUIRE(read(ends[0], &moved, sizeof moved) == sizeof moved);

  expect_refused(moved, "another pool or process made it"); /* where no point is yet */
  remove("rvelab_umat.log");
  struct point own = loaded(11, 4, -shear_step), twin = own;
  expect_refused(moved, "another pool or process made it");
  twin.statev[1] = moved.statev[1]; /* half of STATEV */
  expect_refused(twin, "made by another pool or process, or for another RVE");

  /* The point that is there goes on as if nothing had been tried. */
  struct reference of = reference_of("discs.h5");
  double dH[9] = {0}, height = 1, sigma[9], tangent[36], expected[4];
  for (int k = 0; k < 6; ++k) {
    dH[4] = -shear_step / height;
    height -= shear_step;
    reference_step(&of, dH, 0, sigma, tangent);
  }
  to_host(sigma, 3, 1, expected);
  step(&own, 4, -shear_step);
  CHECK(near_to(own.stress, expected, 4, 1e-9));
  if (failures > 0) print_log(stderr);
  return failures > 0;
}
