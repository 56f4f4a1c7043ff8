/* What the hosts of earlier versions share: a condition that fails ends main with its line and the last error. */
#include <rvelab/rvelab.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define EXPECT(condition)                                                     \
  do {                                                                        \
    if (!(condition)) {                                                       \
      printf("line %d: %s: %s\n", __LINE__, #condition, rvelab_last_error()); \
      return 1;                                                               \
    }                                                                         \
  } while (0)
