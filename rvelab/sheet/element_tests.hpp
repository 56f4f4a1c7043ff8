// The tests of a sheet as elements of a continuum see them, for models (tools/models).
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "rvelab/sheet/sheet.hpp"
#include "tools/models/models.hpp"

namespace rvelab::sheet {

/// Mean curves over the seeds of each density, pressure and amplitude, in the order of the purposes: isotropic,
/// oedometer, drained, undrained, cyclic shear at a strain. Strains are those of the laboratory, 1 - F_aa and 1 - det
/// F, so that e = e0 - (1 + e0) eps_v. Compressions are brought to common strains, denser at the start; of isotropic,
/// oedometer and cyclic tests records of one number are averaged, as far as all seeds have them.
///
/// Kept back for prediction: every undrained test; of three densities or more the middle one; of three pressures or
/// more the middle ones (that in the middle, of an even number the upper of the two). At least one drained density at
/// two pressures is fitted wherever there are such tests.
///
/// `density`: a row of the plan's densities, for models that know no void ratio: its tests alone, of which the middle
/// pressure is kept back. Empty for discs: the models are axisymmetric.
std::vector<models::ElementTest> element_tests(const std::vector<Test>& tests, std::optional<std::size_t> density = {});

/// Numbers by their keys: one of all densities and pressures by its key; others also by "KEY.DENSITY" and
/// "KEY.DENSITY.PRESSUREkPa", where the key alone is their mean, of `density_name` where that is given. Those with a
/// remark are left out.
std::map<std::string, double> numbers_by_key(const Sheet& sheet, const std::string& density_name = "");

}  // namespace rvelab::sheet
