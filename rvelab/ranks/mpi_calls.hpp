// include/rvelab/rvelab_mpi.h as the library itself sees it: what it declares is what librvelab-mpi.so exports. Its one
// function joins the ranks, and makes the pool or serves it.
#pragma once

#pragma GCC visibility push(default)
#include <rvelab/rvelab_mpi.h>
#pragma GCC visibility pop
