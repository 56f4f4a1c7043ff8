// What the solver asks of its contacts one by one: the network as a value, how many constraints they are, whether they
// hold more than friction allows.
#pragma once

#include "rvelab/solver/assembly/assembly.hpp"
#include "rvelab/solver/assembly/network.hpp"

namespace rvelab {

/// In the order of the specimen.
Network network_of(const Model& model, const Assembly& assembly);

/// Constraints of the contacts over degrees of freedom of the grains that two of them hold at least (1: isostatic). A
/// contact gives 1, d - 1 more if it sticks and d - 1 more if it rolls below its limit, both times grip_of its
/// friction. A grain has d translations, and its rotations times the mean grip (all of them if not round). 0 without
/// contacts.
double constraint_ratio(const Model& model, const Assembly& assembly);

/// What a contact of this friction that sticks holds across its normal, in constraints: mu/(mu + 0.15), none without
/// friction and one for each direction with much of it, so that nothing jumps where friction begins: at rest packings
/// of friction 0.02 to 0.1 answer as frictionless ones do.
double grip_of(double friction);

/// Friction was lowered since the state was kept: some contact gives way at the next sub-step, whatever that is.
bool holds_more_than_friction(const Model& model, const Assembly& assembly);

}  // namespace rvelab
