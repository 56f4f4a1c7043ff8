// What the contacts of two of the largest grains tell of a specimen: scales where none touches another, and how its
// grains answer.
#pragma once

#include "rvelab/solver/assembly/assembly.hpp"
#include "rvelab/solver/assembly/contact_stiffness.hpp"

namespace rvelab {

/// Normal force of two of the largest grains at an overlap (m), N: a scale for specimens without any contact.
double typical_normal_force(const Model& model, double overlap);

/// Their stiffnesses at an overlap of a thousandth of their radius (m).
struct TypicalContact {
  ContactStiffness stiffness;
  double radius = 0;
};
TypicalContact typical_contact(const Model& model);

/// Sets slip_frequency_ratio, rolling_constraint_factor, alike_contacts and hardening of the model.
void set_typical_answers(Model& model);

}  // namespace rvelab
