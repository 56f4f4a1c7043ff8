// The groups of numbers of a sheet, a file each. Each adds its numbers and figures, and a remark for what the tests do
// not give. Internal to the module.
#pragma once

#include "rvelab/ensemble/critical_state.hpp"
#include "rvelab/sheet/readings.hpp"

namespace rvelab::sheet {

/// strength.cpp: phi_peak, psi, phi_cs, Bolton's relation.
void add_strength(const std::vector<Test>& tests, Sheet& sheet);
/// footing.cpp: bearing capacity factors, wedges and spiral.
void add_footing(const std::vector<Test>& tests, Sheet& sheet);
/// stiffness.cpp: E50, exponent m, R_f; oedometer: E_oed, E_ur, nu_ur, K0.
void add_stiffness(const std::vector<Test>& tests, Sheet& sheet);
/// small_strain.cpp: G0 by probes; modulus and damping over the strain.
void add_small_strain(const std::vector<Test>& tests, Sheet& sheet);
/// critical_line.cpp: critical state line, state parameter, phase transformation.
void add_critical_line(const std::vector<Test>& tests, Sheet& sheet);
/// cyclic_resistance.cpp: stress ratio over cycles.
void add_cyclic_resistance(const std::vector<Test>& tests, Sheet& sheet);
/// grains.cpp: contacts and fabric.
void add_grains(const std::vector<Test>& tests, Sheet& sheet);
/// curves.cpp: the mean curves of the tests.
void add_curves(const std::vector<Test>& tests, Sheet& sheet);

/// A number of the sheet of all densities and pressures; null: it has none.
const Number* number_in(const Sheet& sheet, std::string_view key);

/// The end of a test: means over the last quarter of its strain.
struct EndState {
  const Test* test = nullptr;
  ensemble::CriticalState state;
  double friction_angle = unknown;  ///< degrees
  double angle_error = unknown;     ///< of calculation, degrees
  double pressure_error = unknown;  ///< of p, Pa
  bool steady = false;              ///< mean over seeds: e of drained tests within its bounds, p of undrained tests
  double doubt = 0;                 ///< half of the 95 % interval of the mean change of e
};
inline constexpr double end_strain = 0.12;          ///< a test that does not come so far has no end state
inline constexpr double steady_void_ratio = 0.003;  ///< most that e changes from one half of the window to the other
inline constexpr double scattering_void_ratio = 0.006;  ///< the same where the scatter of tests explains it
inline constexpr double steady_pressure = 0.05;         ///< the same of p, over its mean
/// Of compressions, drained and undrained.
std::vector<EndState> end_states(const std::vector<Test>& tests);

}  // namespace rvelab::sheet
