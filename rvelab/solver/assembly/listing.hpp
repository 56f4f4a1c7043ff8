// The list of an assembly with the histories of its contacts: made when it is opened, made anew while it steps.
#pragma once

#include "rvelab/solver/assembly/assembly.hpp"

namespace rvelab {

/// Lists the pairs of an assembly that is being opened and gives them their histories, in any order. Throws InputError
/// if a contact is none of the pairs listed, IncrementFailed if the list would be too long (list_size.hpp).
void list_with(const Model& model, std::vector<Contact> contacts, const Interactions& interactions, Assembly& assembly);

/// Pairs closer than `skin`, m, as the grains lie now.
std::vector<ListedPair> near_pairs(const Model& model, const Assembly& assembly, double skin);

/// The pairs that have a history, ordered by (i, j, image).
std::vector<Contact> contacts_of(const Model& model, const PairTable& pairs);

}  // namespace rvelab
