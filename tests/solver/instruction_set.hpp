// Kernels of a chosen instruction set.
#pragma once

#include <cstdlib>
#include <string>

namespace rvelab::test {

/// Sets RVELAB_ISA for the Rves opened while it lives.
struct InstructionSet {
  std::string before = std::getenv("RVELAB_ISA") ? std::getenv("RVELAB_ISA") : "";
  explicit InstructionSet(const std::string& name) { setenv("RVELAB_ISA", name.c_str(), 1); }
  InstructionSet(const InstructionSet&) = delete;
  InstructionSet& operator=(const InstructionSet&) = delete;
  ~InstructionSet() { before.empty() ? unsetenv("RVELAB_ISA") : setenv("RVELAB_ISA", before.c_str(), 1); }
};

}  // namespace rvelab::test
