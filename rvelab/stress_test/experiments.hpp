// The experiments of the stress test: what can be asked, with which numbers. One line each in the list below; the
// functions stand in the files named above them. Parameters are pure numbers or SI; booleans are 0 and 1.
#pragma once

#include <vector>

#include "rvelab/stress_test/matrix.hpp"
#include "rvelab/stress_test/verdict.hpp"

namespace rvelab::stress_test {

struct Parameter {
  const char* name;
  double initial;  ///< where the case does not give it
};

struct Experiment {
  const char* name;
  void (*run)(const Case&, Verdict&);
  std::vector<Parameter> parameters;
};

// stiffness.cpp: linear springs and Hertz contacts from soft to rigid, at dt = 0
void agrees_with_resolved_run(const Case&, Verdict&);
void hertz_agrees_with_resolved_run(const Case&, Verdict&);
void does_not_see_density(const Case&, Verdict&);
void refuses_orphaned_history(const Case&, Verdict&);
// statics.cpp: what is no equilibrium any more
void made_frictionless(const Case&, Verdict&);
void asked_for_tension(const Case&, Verdict&);
// size.cpp: few grains, many, unlike ones, thin cells
void few_grains(const Case&, Verdict&);
void unlike_radii(const Case&, Verdict&);
void grains_in_pores(const Case&, Verdict&);
void million_grains(const Case&, Verdict&);
void thin_cell(const Case&, Verdict&);
// deformation.cpp: far
void sheared_far(const Case&, Verdict&);
void stretched_far(const Case&, Verdict&);
void compressed_until_refused(const Case&, Verdict&);
void gas_and_back(const Case&, Verdict&);
void one_large_increment(const Case&, Verdict&);
// increments.cpp: many
void rotated_often(const Case&, Verdict&);
void many_small_increments(const Case&, Verdict&);
void there_and_back(const Case&, Verdict&);
// rate.cpp: dt > 0
void sheared_at_rate(const Case&, Verdict&);
void shock_compression(const Case&, Verdict&);
void slow_is_static(const Case&, Verdict&);
void flow_under_stress(const Case&, Verdict&);
// impacts.cpp: two grains
void elastic_rebound(const Case&, Verdict&);
void restitution(const Case&, Verdict&);
void restitution_beside_contact(const Case&, Verdict&);
void impact_too_hard(const Case&, Verdict&);
// gas.cpp: many impacts
void gas_keeps_energy(const Case&, Verdict&);
void gas_cools(const Case&, Verdict&);
// numbers.cpp: units, denormals, what is no number, instruction sets
void powers_of_two(const Case&, Verdict&);
void other_lengths(const Case&, Verdict&);
void denormal_increment(const Case&, Verdict&);
void no_increment(const Case&, Verdict&);
void huge_increment(const Case&, Verdict&);
void kernels_agree(const Case&, Verdict&);
// self.cpp: the runner itself
void self_right(const Case&, Verdict&);
void self_wrong(const Case&, Verdict&);
void self_refuse(const Case&, Verdict&);
void self_crash(const Case&, Verdict&);
void self_hang(const Case&, Verdict&);
void self_sleep(const Case&, Verdict&);
void self_memory(const Case&, Verdict&);

/// All experiments.
inline const std::vector<Experiment>& experiments() {
  static const std::vector<Experiment> list = {
      {"stiffness/linear",
       agrees_with_resolved_run,
       {{"dimension", 2},
        {"grains", 64},
        {"kappa", 1e3},
        {"kt_over_kn", 0.5},
        {"friction", 0.5},
        {"rolling_stiffness", 0},
        {"rolling_friction", 0.1},
        {"local_damping", 0.3},
        {"restitution", 1},
        {"adhesion", 0},
        {"shear", 0},
        {"strain_times_kappa", 0.5},
        {"increments", 10},
        {"aspect_ratio", 1}}},
      {"stiffness/hertz",
       hertz_agrees_with_resolved_run,
       {{"dimension", 3},
        {"grains", 64},
        {"young_modulus", 1e9},
        {"pressure", 1e5},
        {"poisson_ratio", 0.2},
        {"friction", 0.5},
        {"shear", 0},
        {"strain_times_kappa", 0.5},
        {"increments", 10}}},
      {"stiffness/density", does_not_see_density, {{"dimension", 2}, {"hertz", 0}, {"density", 1}}},
      {"stiffness/orphaned_history", refuses_orphaned_history, {}},
      {"statics/frictionless",
       made_frictionless,
       {{"prepared_with", 1}, {"friction", 0}, {"shear", 1}, {"strain", 1e-4}, {"increments", 1}}},
      {"statics/tension", asked_for_tension, {{"dimension", 2}, {"critical_steps", 0}}},
      {"size/few", few_grains, {{"dimension", 2}, {"grains", 3}, {"strain", 1e-3}, {"increments", 20}}},
      {"size/contrast",
       unlike_radii,
       {{"dimension", 2}, {"ratio", 10}, {"large", 4}, {"small", 400}, {"solid_fraction", 0.6}}},
      {"size/pores", grains_in_pores, {{"side", 8}, {"ratio", 50}}},
      {"size/million", million_grains, {{"side", 100}}},
      {"size/thin", thin_cell, {{"dimension", 2}, {"grains", 4}, {"copies", 4}}},
      {"deformation/shear",
       sheared_far,
       {{"dimension", 2}, {"grains", 4}, {"gamma", 100}, {"increment", 0.1}, {"substeps", 0}}},
      {"deformation/stretch",
       stretched_far,
       {{"dimension", 2}, {"grains", 32}, {"hencky", 10}, {"increment", 0.01}, {"oriented", 1}, {"substeps", 0}}},
      {"deformation/compression",
       compressed_until_refused,
       {{"dimension", 2}, {"hertz", 0}, {"increment", 0.01}, {"rate", 0}}},
      {"deformation/gas_and_back",
       gas_and_back,
       {{"dimension", 2}, {"kappa", 1e3}, {"expansion", 0.3}, {"increments", 50}}},
      {"deformation/one_increment",
       one_large_increment,
       {{"dimension", 2}, {"grains", 64}, {"kappa", 100}, {"compression", 0}, {"shear", 0.5}, {"expansion", 0}}},
      {"increments/rotations", rotated_often, {{"dimension", 3}, {"rotations", 1e5}}},
      {"increments/small", many_small_increments, {{"grains", 10}, {"increments", 1e6}, {"strain", 1e-9}}},
      {"increments/there_and_back", there_and_back, {{"grains", 16}, {"strain", 1e-6}, {"cycles", 5000}, {"parts", 1}}},
      {"rate/shear",
       sheared_at_rate,
       {{"dimension", 2},
        {"hertz", 0},
        {"inertial_number", 1e-3},
        {"default_steps", 20000},
        {"friction", 0.5},
        {"kt_over_kn", 0.5},
        {"rolling_stiffness", 0},
        {"local_damping", 0},
        {"restitution", 1},
        {"density", 2650},
        {"kappa", 1e3},
        {"time_step_factor", 0.7},
        {"aspect_ratio", 1}}},
      {"rate/shock",
       shock_compression,
       {{"dimension", 3}, {"hertz", 1}, {"mach", 0.1}, {"strain", 0.06}, {"time_step_factor", 0.7}}},
      {"rate/slow", slow_is_static, {{"local_damping", 0.3}, {"critical_steps", 1e5}}},
      {"rate/flow",
       flow_under_stress,
       {{"dimension", 2}, {"inertial_number", 1e-2}, {"gamma", 4}, {"increments", 800}}},
      {"impact/rebound",
       elastic_rebound,
       {{"dimension", 3}, {"hertz", 0}, {"speed", 0.1}, {"phases", 20}, {"time_step_factor", 0.7}}},
      {"impact/restitution",
       restitution,
       {{"dimension", 3},
        {"hertz", 0},
        {"restitution", 0.5},
        {"speed", 0.1},
        {"phases", 20},
        {"time_step_factor", 0.7}}},
      {"impact/third_contact",
       restitution_beside_contact,
       {{"hertz", 0}, {"restitution", 0.5}, {"phases", 50}, {"time_step_factor", 0.7}}},
      {"impact/too_hard", impact_too_hard, {{"hertz", 1}, {"overlap_over_limit", 2}, {"time_step_factor", 0.7}}},
      {"gas/energy",
       gas_keeps_energy,
       {{"dimension", 2}, {"hertz", 0}, {"grains", 100}, {"collisions", 100}, {"time_step_factor", 0.7}}},
      {"gas/haff",
       gas_cools,
       {{"dimension", 2},
        {"hertz", 0},
        {"grains", 256},
        {"gases", 16},
        {"ledgers", 2},
        {"solid_fraction", 0.1},
        {"restitution", 0.9},
        {"duration", 3},
        {"contact_time", 3e-3},
        {"time_step_factor", 0.7}}},
      {"numbers/units",
       powers_of_two,
       {{"dimension", 2}, {"hertz", 0}, {"length_power", 0}, {"force_power", 0}, {"aspect_ratio", 1}}},
      {"numbers/length", other_lengths, {{"dimension", 2}, {"hertz", 0}, {"radius", 1e-6}}},
      {"numbers/denormal", denormal_increment, {{"dimension", 2}, {"strain", 1e-310}, {"dt", 0}}},
      {"numbers/no_increment", no_increment, {{"dimension", 2}, {"kind", 0}, {"dt", 0}}},
      {"numbers/huge", huge_increment, {{"dimension", 2}, {"shear", 0}, {"expansion", 0}, {"dt", 0}}},
      {"numbers/kernels",
       kernels_agree,
       {{"dimension", 2}, {"hertz", 0}, {"rolling", 0}, {"dt_over_critical", 0}, {"aspect_ratio", 1}}},
      {"self/right", self_right, {{"value", 0}}},
      {"self/wrong", self_wrong, {}},
      {"self/refuse", self_refuse, {}},
      {"self/crash", self_crash, {}},
      {"self/hang", self_hang, {}},
      {"self/sleep", self_sleep, {}},
      {"self/memory", self_memory, {}},
  };
  return list;
}

}  // namespace rvelab::stress_test
