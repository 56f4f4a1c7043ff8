// The headers alone, as C++17; compiled with that standard (tests/CMakeLists.txt).
#include <rvelab/rvelab_mpi.h>

static_assert(__cplusplus == 201703L, "this file shows that the headers need no later standard");
