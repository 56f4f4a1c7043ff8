// The header alone, as C++17; compiled with that standard (tests/CMakeLists.txt).
#include <rvelab/rvelab.h>

static_assert(__cplusplus == 201703L, "this file shows that the header needs no later standard");
