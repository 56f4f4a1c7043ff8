// Checks of bonds, bridges and adhesion against grains and contacts, and of the parameters from which they form.
#pragma once

#include "rvelab/specimen/checked_specimen.hpp"

namespace rvelab {

void check_interactions(const CheckedSpecimen& checked);

}  // namespace rvelab
