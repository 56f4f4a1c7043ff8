// operator new that fails when it is told to. It replaces that of the whole test executable.
#pragma once

namespace rvelab::test {

/// The n-th request for memory from now on, on this thread, finds none; 0: all find some.
extern thread_local long allocations_left;

/// Called once, at the next request for memory on this thread: in the middle of a call, that is.
extern thread_local void (*meanwhile)();

}  // namespace rvelab::test
