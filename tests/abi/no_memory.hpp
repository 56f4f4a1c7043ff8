// operator new that fails when it is told to. It replaces that of the whole test executable.
#pragma once

namespace rvelab::test {

/// The n-th request for memory from now on, on this thread, finds none; 0: all find some.
extern thread_local long allocations_left;

}  // namespace rvelab::test
