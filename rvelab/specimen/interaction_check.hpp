// Bonds, bridges and adhesion beside grains and contacts, and what they form from.
#pragma once

#include "rvelab/specimen/checked_specimen.hpp"

namespace rvelab {

void check_interactions(const CheckedSpecimen& checked);

}  // namespace rvelab
