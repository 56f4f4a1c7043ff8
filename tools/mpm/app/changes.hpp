// Changes of a scene at their times: stages of a test that the RVEs of a material go through.
#pragma once

#include <ostream>

#include "tools/mpm/setup/setup.hpp"

namespace mpm {

/// InputError with rvelab's own text where the stages of one are wrong in themselves, before any step is made.
template <int D>
void expect_good_changes(const Scene& scene, const Model<D>& model);

/// Makes those whose time has come and which are not made yet. Says so, a line each. runtime_error where one fails.
template <int D>
void make_changes(const Scene& scene, Model<D>& model, std::ostream& report);

}  // namespace mpm
