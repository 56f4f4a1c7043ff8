#include "rvelab/protocol/events.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "rvelab/measure/measures.hpp"

namespace rvelab::protocol {
namespace {

double pressure(const RunningTest& test) { return mean_pressure(test.run.progress.stress, test.dimension()); }
double deviator(const RunningTest& test) { return deviatoric_stress(test.run.progress.stress, test.dimension()); }
template <int i, int j>
double stress(const RunningTest& test) {
  const Matrix3& s = test.run.progress.stress;
  return 0.5 * (s(i, j) + s(j, i));
}

}  // namespace

const std::vector<EventQuantity>& event_quantities() {
  using Test = const RunningTest&;
  static const std::vector<EventQuantity> all{
      {"strain", [](Test test) { return test.run.result.records.back().strain; }},
      {"eps_v", [](Test test) { return 1 - test.run.progress.deformation.determinant(); }},
      {"eps_q",
       [](Test test) {
         return deviatoric_strain(test.run.progress.deformation - Matrix3::Identity(), test.dimension());
       }},
      {"p_Pa", pressure},
      {"p_over_first", [](Test test) { return pressure(test) / test.run.progress.first_pressure; }},
      {"q_Pa", deviator},
      {"q_over_p", [](Test test) { return deviator(test) / pressure(test); }},
      {"stress_xx_Pa", stress<0, 0>},
      {"stress_yy_Pa", stress<1, 1>},
      {"stress_zz_Pa", stress<2, 2>},
      {"stress_yz_Pa", stress<1, 2>},
      {"stress_xz_Pa", stress<0, 2>},
      {"stress_xy_Pa", stress<0, 1>},
      {"void_ratio", [](Test test) { return void_ratio(test.rve.network()); }},
      {"coordination_number", [](Test test) { return coordination_number(test.rve.network()); }},
      {"cycles", [](Test test) { return 0.5 * static_cast<double>(test.run.progress.turns); }},
      {"visits", [](Test test) {
         const Progress& at = test.run.progress;
         return static_cast<double>(at.visits[static_cast<std::size_t>(at.stage)]);
       }}};
  return all;
}

int met_event(RunningTest& test, const Stage& stage) {
  Progress& at = test.run.progress;
  int met = -1;
  for (std::size_t k = 0; k < stage.until.size(); ++k) {
    const Event& event = stage.until[k];
    const auto& all = event_quantities();
    const auto quantity = std::find_if(all.begin(), all.end(), [&](const auto& q) { return q.name == event.quantity; });
    const double value = quantity->value(test);
    at.largest[k] = std::max(at.largest[k], value);
    if (at.step == 0 || met >= 0) continue;
    const bool above = event.when == Event::When::above && value > event.value;
    const bool below = event.when == Event::When::below && value < event.value;
    const bool fallen = event.when == Event::When::falls_by && value < (1 - event.value) * at.largest[k];
    if (above || below || fallen) met = static_cast<int>(k);
  }
  return met;
}

}  // namespace rvelab::protocol
