// What each part of a step costs, a grain: pairs, gather and integration, a list rebuild, the checks of equilibrium and
// stress.
//
//   build/release/bin/rvelab-bench --benchmark_repetitions=5 --benchmark_report_aggregates_only=true
//   build/release/bin/rvelab-bench --widths     # AVX-512 beside AVX2; fails where it takes 1.25 times as long
//
// Each case is a packing of `rvelab bench` in slow shear. The clock of grain-steps is left alone: nothing moves between
// two calls, so that every call does the same work.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>
#include <vector>

#include "rvelab/pack/repeated.hpp"
#include "rvelab/pack/search.hpp"
#include "rvelab/solver/assembly/assembly.hpp"
#include "rvelab/solver/loading/inertia.hpp"
#include "rvelab/solver/loading/sweep.hpp"
#include "rvelab/solver/rve.hpp"
#include "rvelab/solver/state/state.hpp"

namespace {

using namespace rvelab;

struct Opened {
  Model model;
  Assembly assembly;
  StepConstants constants;
};

pack::Recipe recipe_of(Shape shape) {
  pack::Recipe r;
  r.shape = shape;
  r.materials[0].friction = 0.5;
  r.stress = pack::isotropic_stress(1e5, shape);
  if (shape == Shape::disc) {
    r.materials[0].young_modulus = 8e8;
    r.materials[0].stiffness_ratio = 0.5;
    r.preparation.friction = 0.02;
    return r;
  }
  r.number = 1000;
  r.fractions[0].grading.smallest_radius = 1e-3;
  r.fractions[0].grading.largest_radius = 2e-3;
  r.materials[0].young_modulus = 7e9;
  r.materials[0].poisson_ratio = 0.25;
  r.contact.law = Law::hertz_mindlin;
  r.preparation.friction = 0.1;
  return r;
}

/// A packing sheared by 0.1 %, opened.
Opened opened(Shape shape, const Image& times) {
  Workers alone(1);
  Specimen specimen = pack::repeated(pack::pack(recipe_of(shape), alone).specimen, times);
  specimen.damping.local = 0.1;
  Rve rve(specimen);
  Matrix3 shear = Matrix3::Zero();
  shear(0, dimension_of(shape) - 1) = 1e-3;
  rve.apply(shear, 500 * rve.critical_time_step());
  Opened o;
  open_assembly(rve.specimen(), o.model, o.assembly);
  o.constants = base_constants(o.model, o.assembly);
  o.constants.map = {1, 0, 0, 1, 0, 1};
  o.constants.local_damping = 0.1;
  // Physical masses, and a step so short that thousands of them move nothing.
  use_physical_inertia(o.model, o.assembly);
  o.constants.dt = 1e-20;
  o.constants.velocity_map = {1e-20, 0, 0, 1e-20, 0, 1e-20};
  for (int k = 0; k < 3; ++k)
    o.constants.momentum_map[4 * k] = o.constants.force_map[4 * k] = o.constants.spin_map[4 * k] = 1;
  return o;
}

/// Packings are made when a benchmark first asks for one.
Opened& packing(const std::string& name) {
  static std::map<std::string, Opened> made;
  const auto found = made.find(name);
  if (found != made.end()) return found->second;
  const Shape shape = name.starts_with("disc") ? Shape::disc : Shape::sphere;
  const Image times = name == "disc_10000" ? Image{5, 5, 1} : name == "sphere_32000" ? Image{4, 4, 2} : Image{1, 1, 1};
  return made.emplace(name, opened(shape, times)).first->second;
}

/// Seconds a call, shown for each grain.
void per_grain(benchmark::State& state, const Opened& o) {
  using benchmark::Counter;
  state.counters["s/grain"] = Counter(double(o.model.size()), Counter::kIsIterationInvariantRate | Counter::kInvert);
  state.counters["pairs/grain"] = double(o.assembly.pairs.listed) / double(o.model.size());
}

void pairs(benchmark::State& state, const std::string& name) {
  Opened& o = packing(name);
  const PairArrays arrays = arrays_of(o.assembly.pairs);
  for (auto _ : state)
    sweep_pairs(o.model.kernels.pairs, o.constants, arrays, o.assembly.rows.data(), long(o.assembly.pairs.padded()),
                nullptr);
  per_grain(state, o);
}

void gather_and_integrate(benchmark::State& state, const std::string& name, KernelDamping damping) {
  Opened& o = packing(name);
  const Buffer rows = o.assembly.rows;
  const PairArrays arrays = arrays_of(o.assembly.pairs);
  const GrainArrays grains = arrays_of(o.model, o.assembly);
  StepSums sums;
  for (auto _ : state)
    sweep_grains(o.model.kernels.at_rate[std::size_t(damping)], o.constants, grains, arrays,
                 long(o.assembly.mass.size()), nullptr, sums);
  o.assembly.rows = rows;
  per_grain(state, o);
}

void list_rebuild(benchmark::State& state, const std::string& name) {
  Opened& o = packing(name);
  Assembly copy;
  for (auto _ : state) {
    state.PauseTiming();
    copy = o.assembly;
    state.ResumeTiming();
    rebuild(o.model, copy);
    benchmark::DoNotOptimize(copy.pairs.listed);
  }
  per_grain(state, o);
}

void waking(benchmark::State& state, const std::string& name) {
  Opened& o = packing(name);
  for (auto _ : state) {
    state.PauseTiming();
    Assembly copy = o.assembly;
    put_masses_into_rows(o.model, copy);
    release_buffers(copy);
    state.ResumeTiming();
    rebuild_buffers(o.model, copy);
    benchmark::DoNotOptimize(copy.pairs.listed);
  }
  per_grain(state, o);
}

void look_at_balance(benchmark::State& state, const std::string& name) {
  Opened& o = packing(name);
  for (auto _ : state) benchmark::DoNotOptimize(balance_of(o.model, o.assembly));
  per_grain(state, o);
}

void look_at_stress(benchmark::State& state, const std::string& name) {
  Opened& o = packing(name);
  for (auto _ : state) benchmark::DoNotOptimize(contact_virial(o.model, o.assembly));
  per_grain(state, o);
}

/// Eight lanes beside four: time of the AVX-512 kernels over that of the AVX2 ones, median over slices of a millisecond
/// in turn, so that both see the same clock. Callgrind cannot count AVX-512 (tools/bench/count), and a vector taken
/// apart lane by lane would cost several times as much. Processors that lower their clock for 512-bit arithmetic come
/// near 1, and use AVX2 of themselves. Returns the exit code.
int compare_widths() {
#if defined(__x86_64__)
  if (!__builtin_cpu_supports("avx512dq")) {
    std::puts("widths: this processor has no AVX-512, nothing to compare");
    return 0;
  }
  constexpr double most = 1.25;
  bool good = true;
  for (const std::string name : {"disc_400", "sphere_1000"}) {
    Opened& o = packing(name);
    const KernelConfiguration key{
        o.model.shape, o.model.contact.law,         o.model.contact.rolling, o.model.contact.slip,
        false,         o.model.contact.hertz_radius};
    Kernels kernels[2];
    for (const int k : {0, 1}) {
      setenv("RVELAB_ISA", k == 0 ? "v3" : "v4", 1);
      kernels[k] = kernels_for(key);
    }
    const PairArrays pairs = arrays_of(o.assembly.pairs);
    const GrainArrays grains = arrays_of(o.model, o.assembly);
    const Buffer rows = o.assembly.rows;
    StepSums sums;
    const auto slice = [&](const Kernels& of, bool of_pairs) {
      const auto begin = std::chrono::steady_clock::now();
      for (int call = 0; call < (o.model.size() > 500 ? 15 : 100); ++call) {
        if (of_pairs)
          sweep_pairs(of.pairs, o.constants, pairs, o.assembly.rows.data(), long(o.assembly.pairs.padded()), nullptr);
        else
          sweep_grains(of.at_rate[std::size_t(KernelDamping::vector)], o.constants, grains, pairs,
                       long(o.assembly.mass.size()), nullptr, sums);
      }
      return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    };
    for (const bool of_pairs : {true, false}) {
      std::vector<double> ratios(301);
      for (double& ratio : ratios) {
        const double four = slice(kernels[0], of_pairs);
        ratio = slice(kernels[1], of_pairs) / four;
      }
      std::nth_element(ratios.begin(), ratios.begin() + 150, ratios.end());
      const bool held = ratios[150] <= most;
      good = good && held;
      std::printf("%-12s %-22s AVX-512 over AVX2 %.2f%s\n", name.c_str(), of_pairs ? "pairs" : "gather_and_integrate",
                  ratios[150], held ? "" : "  more than 1.25");
      o.assembly.rows = rows;
    }
  }
  return good ? 0 : 1;
#else
  std::puts("widths: no x86-64, nothing to compare");
  return 0;
#endif
}

}  // namespace

int main(int count, char** arguments) {
  if (count == 2 && std::string(arguments[1]) == "--widths") return compare_widths();
  for (const std::string name : {"disc_400", "disc_10000", "sphere_1000", "sphere_32000"}) {
    const auto add = [&](const std::string& part, auto... arguments_of_part) {
      benchmark::RegisterBenchmark((name + "/" + part).c_str(), arguments_of_part..., name);
    };
    add("pairs", pairs);
    benchmark::RegisterBenchmark((name + "/gather_and_integrate").c_str(), gather_and_integrate, name,
                                 KernelDamping::vector);
    benchmark::RegisterBenchmark((name + "/gather_and_integrate_undamped").c_str(), gather_and_integrate, name,
                                 KernelDamping::none);
    add("list_rebuild", list_rebuild);
    add("waking", waking);
    add("look_at_balance", look_at_balance);
    add("look_at_stress", look_at_stress);
  }
  benchmark::Initialize(&count, arguments);
  if (benchmark::ReportUnrecognizedArguments(count, arguments)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
