/* The headers alone, as C11. */
#include <rvelab/rvelab_mpi.h>

int header_as_c11(void);

int header_as_c11(void) {
  rvelab_pool_def def = {0};
  (void)def;
  return RVELAB_ABI_MAJOR << 16 | RVELAB_ABI_MINOR;
}
