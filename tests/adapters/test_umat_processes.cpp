// STATEV of one process in another, which umat_processes.c hands on.
#include <filesystem>

#include "tests/program.hpp"

using namespace rvelab::test;

TEST_CASE("umat_ refuses a point that another process made, and its own go on") {
  const Workplace here;
  here.succeeds("pack pack_dense -o discs.h5 --set pack.number=64 --set target.void_ratio=0.2");
  here.write("rvelab_umat.toml", "[[material]]\nnumber = 1\nspecimen = \"discs.h5\"\n");
  unsetenv("RVELAB_UMAT");
  here.succeeds(".", RVELAB_UMAT_PROCESSES);
}
