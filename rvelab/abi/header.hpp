// include/rvelab/rvelab.h as the library itself sees it: what it declares is what librvelab.so exports.
#pragma once

#pragma GCC visibility push(default)
#include <rvelab/rvelab.h>
#pragma GCC visibility pop
