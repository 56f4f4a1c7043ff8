// Chooses the kernels of a configuration: what the build has, what the processor can do, what RVELAB_ISA asks for.
// Declared in configuration.hpp.
#include <cstdlib>
#include <string>
#include <vector>

#include "rvelab/error.hpp"
#include "rvelab/solver/kernels/configuration.hpp"
#include "rvelab/solver/kernels/instruction_sets.hpp"

namespace rvelab {

namespace {

using Setter = void (*)(const KernelConfiguration&, Kernels&);
struct InstructionSet {
  const char* name;
  bool runs_here;
  Setter (*of)(Shape);
  Setter of_bodies;
};

#define RVELAB_SETTERS(isa)                                                                             \
  [](Shape shape) {                                                                                     \
    return with_shape(shape, [](auto is) -> Setter { return &StepKernels<decltype(is)::value>::isa; }); \
  },                                                                                                    \
      &BodyKernels::isa

/// From widest to plainest.
const std::vector<InstructionSet>& instruction_sets() {
  static const std::vector<InstructionSet> sets = [] {
    std::vector<InstructionSet> found;
#ifdef RVELAB_HAVE_V4
    found.push_back({"v4", bool(__builtin_cpu_supports("x86-64-v4")), RVELAB_SETTERS(v4)});
#endif
#ifdef RVELAB_HAVE_V3
    found.push_back({"v3", bool(__builtin_cpu_supports("x86-64-v3")), RVELAB_SETTERS(v3)});
#endif
    found.push_back({"baseline", true, RVELAB_SETTERS(baseline)});
    found.push_back({"scalar", true, RVELAB_SETTERS(scalar)});
    return found;
  }();
  return sets;
}

/// Whether 512-bit arithmetic lowers the clock of this processor so far that four lanes are faster (Cascade Lake,
/// gather of 1000 spheres, the same 256-bit instructions: 41 ns beside four-lane passes, 57 beside eight-lane ones).
bool slows_down_at_512_bits() {
#if defined(__x86_64__)
  return __builtin_cpu_is("skylake-avx512") || __builtin_cpu_is("cascadelake") || __builtin_cpu_is("cooperlake");
#else
  return false;
#endif
}

const InstructionSet& widest_set() {
  const auto& sets = instruction_sets();
  const char* wanted = std::getenv("RVELAB_ISA");
  if (wanted == nullptr && slows_down_at_512_bits())
    for (const auto& set : sets)
      if (set.runs_here && std::string(set.name) == "v3") return set;
  std::string names;
  for (const auto& set : sets) {
    if (set.runs_here) names += std::string(names.empty() ? "" : ", ") + set.name;
    if (wanted ? std::string(wanted) == set.name && set.runs_here : set.runs_here) return set;
  }
  throw InputError(std::string("RVELAB_ISA=") + wanted + " cannot run here; use one of " + names);
}

}  // namespace

Kernels kernels_for(const KernelConfiguration& key) {
  const InstructionSet& set = widest_set();
  Kernels kernels;
  instruction_sets().back().of(key.shape)(key, kernels);
  set.of(key.shape)(key, kernels);
  set.of_bodies(key, kernels);
  if (kernels.pairs == nullptr)
    throw InputError(
        "this build has no kernels of superellipsoids, dashpots, laws other than linear, linear_stiffness and "
        "hertz_mindlin, and the slip of other codes; use the program");
  kernels.instruction_set = set.name;
  return kernels;
}

}  // namespace rvelab
