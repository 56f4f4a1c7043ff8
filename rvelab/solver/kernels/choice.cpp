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

using Setter = void (*)(const KernelConfiguration&, const char*, Kernels&);
struct InstructionSet {
  const char* name;
  bool runs_here;
  Setter disc, ellipse, sphere;
};

/// From widest to plainest.
const std::vector<InstructionSet>& instruction_sets() {
  static const std::vector<InstructionSet> sets = [] {
    std::vector<InstructionSet> found;
#ifdef RVELAB_HAVE_V4
    found.push_back({"v4", bool(__builtin_cpu_supports("x86-64-v4")), set_disc_kernels_v4, set_ellipse_kernels_v4,
                     set_sphere_kernels_v4});
#endif
#ifdef RVELAB_HAVE_V3
    found.push_back({"v3", bool(__builtin_cpu_supports("x86-64-v3")), set_disc_kernels_v3, set_ellipse_kernels_v3,
                     set_sphere_kernels_v3});
#endif
    found.push_back(
        {"baseline", true, set_disc_kernels_baseline, set_ellipse_kernels_baseline, set_sphere_kernels_baseline});
    found.push_back({"scalar", true, set_disc_kernels_scalar, set_ellipse_kernels_scalar, set_sphere_kernels_scalar});
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

/// The slip conventions of other codes are compiled for the baseline and the scalar reference alone (table.hpp).
const InstructionSet& chosen_set(Slip slip) {
  const InstructionSet& widest = widest_set();
  if (slip == Slip::consistent) return widest;
  const auto& sets = instruction_sets();
  const InstructionSet &baseline = sets[sets.size() - 2], &scalar = sets.back();
  return std::string(widest.name) == scalar.name ? scalar : baseline;
}

}  // namespace

Kernels kernels_for(const KernelConfiguration& key) {
  const InstructionSet& set = chosen_set(key.slip);
  Kernels kernels;
  if (key.shape == Shape::disc) {
    set_disc_kernels_shared(key, kernels);
    set.disc(key, set.name, kernels);
  } else if (key.shape == Shape::ellipse) {
    set_ellipse_kernels_shared(key, kernels);
    set.ellipse(key, set.name, kernels);
  } else {
    set_sphere_kernels_shared(key, kernels);
    set.sphere(key, set.name, kernels);
  }
  return kernels;
}

}  // namespace rvelab
