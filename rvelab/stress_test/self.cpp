// Cases that test the runner: what it makes of each way in which a child can end. The matrix does not hold them.
// Declared in experiments.hpp.
#include <csignal>
#include <memory>
#include <thread>
#include <vector>

#include "rvelab/stress_test/experiments.hpp"
#include "rvelab/stress_test/specimens.hpp"
#include "rvelab/stress_test/tested.hpp"

namespace rvelab::stress_test {

void self_right(const Case& asked, Verdict& verdict) {
  verdict.law("a half", 0.5, 1);
  verdict.bits(std::uint64_t(asked("value")));
}

void self_wrong(const Case&, Verdict& verdict) { verdict.law("two", 2, 1); }

void self_refuse(const Case&, Verdict& verdict) {
  Tested tested(lone_grain(2, 1.95), verdict);
  tested.apply(entry(0, 0, -2), 0);
}

void self_crash(const Case&, Verdict&) { std::raise(SIGSEGV); }

void self_hang(const Case&, Verdict&) {
  for (volatile long turns = 0;;) turns = turns + 1;
}

void self_sleep(const Case&, Verdict&) {
  for (;;) std::this_thread::sleep_for(std::chrono::seconds(1));
}

void self_memory(const Case&, Verdict& verdict) {
  // Written to, so that it is resident; never more than any limit of a test.
  std::vector<std::unique_ptr<std::vector<char>>> blocks;
  for (int k = 0; k < 4096; ++k) blocks.push_back(std::make_unique<std::vector<char>>(std::size_t(1) << 20, char(k)));
  verdict.law("four gibibytes were given", blocks.size() > 0);
}

}  // namespace rvelab::stress_test
