// STATEV of one process in another, which umat_processes.c hands on.
#include <filesystem>

#include "tests/cli/program.hpp"

using namespace rvelab::test;

TEST_CASE("umat_ refuses a point that another process made, and its own go on") {
  const Workplace here;
  const Outcome packed = here.run("pack pack_dense -o discs.h5 --set pack.number=64 --set target.void_ratio=0.2");
  INFO(packed.errors);
  REQUIRE(packed.code == 0);
  here.write("rvelab_umat.toml", "[[material]]\nnumber = 1\nspecimen = \"discs.h5\"\n");
  unsetenv("RVELAB_UMAT");
  const Outcome outcome = here.run(".", RVELAB_UMAT_PROCESSES);
  INFO(outcome.errors);
  CHECK(outcome.code == 0);
}
