// Continuum models of soils, fitted to tests of a specimen: one file a model with formulas and source. Compression
// positive, Pa.
#pragma once

#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace rvelab::models {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

enum class Loading { isotropic, oedometer, drained, undrained, cyclic_shear };

/// A test as an element of a continuum sees it, mean over specimens. Rows in the order of the test. Axisymmetric:
/// q = sigma_a - sigma_r, p = (sigma_a + 2 sigma_r)/3. Strains of a laboratory: eps_a = 1 - F_aa, eps_v = 1 - det F, so
/// that e = e0 - (1 + e0) eps_v.
struct ElementTest {
  std::string name;
  Loading loading = Loading::drained;
  double p0 = unknown;              ///< Pa, isotropic at the start
  double e0 = unknown;              ///< void ratio at the start
  std::vector<double> strain;       ///< axial; of cyclic_shear: shear strain
  std::vector<double> q, p, eps_v;  ///< Pa, Pa, 1; of cyclic_shear q is the shear stress
  bool fitted = true;               ///< false: it is kept back, and predicted
};

/// Where the value of a parameter comes from: the fit, a number of the data sheet, or neither: a usual value, or a
/// relation to other parameters.
enum class Origin { fitted, sheet, changed, assumed };  ///< changed: of the sheet, to go with other parameters
/// "fitted", "sheet", "sheet (changed)", "assumed".
const char* name_of(Origin origin);

struct Parameter {
  std::string name, unit, meaning;
  double value = unknown;
  double low = unknown, high = unknown;  ///< 95 % interval; NaN: not fitted
  Origin origin = Origin::fitted;
};

/// How well a model stands for one test.
struct Misfit {
  std::string test;
  bool fitted = true;
  double stress = unknown;  ///< root of the mean square of q (undrained: and p) off, over the largest q of the test
  double strain =
      unknown;         ///< the same of eps_v, in units of strain; oedometer: of the axial strain; NaN: kept at zero
  std::string remark;  ///< "": none; else why it could not be calculated
};

struct Fit {
  std::string model;  ///< "Mohr-Coulomb", ...
  std::vector<Parameter> parameters;
  std::vector<Misfit> misfits;          ///< in the order of the tests
  std::vector<ElementTest> calculated;  ///< the same tests by the model, without rows that are not finite
  std::vector<std::string> remarks;     ///< what a user of the parameters has to know, a sentence each
};

/// Names of models: "mohr_coulomb", "hardening_soil_small", "norsand", "hypoplasticity".
const std::vector<std::string>& names();
/// Whether a model knows no void ratio, so that it stands for one density alone. InputError: no such model.
bool of_one_density(std::string_view model);

/// `numbers`: of the data sheet by their keys, where it has them ("phi_cs_deg", "critical_line_e_G", ...): first
/// guesses, and what a model takes from them as it is (README.md lists them). Mohr-Coulomb and Hardening Soil know no
/// void ratio: give them tests of one density. InputError: no such model (names the nearest), or tests that do not
/// suffice.
Fit fit(std::string_view model, const std::vector<ElementTest>& tests, const std::map<std::string, double>& numbers);

/// Input to paste. Host "calculix" or "abaqus": its material, "" where it does not have the model; "table": the
/// parameters of any model under the names of codes that have it, in kPa. InputError: no such host.
std::string card(const Fit& fit, std::string_view host);

}  // namespace rvelab::models
