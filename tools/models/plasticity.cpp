#include "tools/models/plasticity.hpp"

namespace rvelab::models {
namespace {

double product(const std::array<double, 2>& a, const std::array<double, 2>& b) { return a[0] * b[0] + a[1] * b[1]; }

}  // namespace

PlasticRate plastic_rate(const Elasticity& elastic, const std::array<Mechanism, 2>& mechanisms, StrainRate d) {
  const auto trial = elastic(d.a, d.r);
  double drive[2], matrix[2][2];
  std::array<double, 2> fall[2];
  for (int i = 0; i < 2; ++i) fall[i] = elastic(mechanisms[i].flow[0], mechanisms[i].flow[1]);
  for (int i = 0; i < 2; ++i) {
    drive[i] = mechanisms[i].active ? product(mechanisms[i].normal, trial) + mechanisms[i].drift : -1;
    for (int j = 0; j < 2; ++j) matrix[i][j] = product(mechanisms[i].normal, fall[j]);
    matrix[i][i] += mechanisms[i].hardening;
  }
  const auto result = [&](double first, double second) {
    return PlasticRate{
        {trial[0] - first * fall[0][0] - second * fall[1][0], trial[1] - first * fall[0][1] - second * fall[1][1]},
        {first, second}};
  };
  const bool on[2] = {mechanisms[0].active, mechanisms[1].active};
  if (on[0] && on[1]) {
    const double determinant = matrix[0][0] * matrix[1][1] - matrix[0][1] * matrix[1][0];
    const double first = (drive[0] * matrix[1][1] - drive[1] * matrix[0][1]) / determinant;
    const double second = (drive[1] * matrix[0][0] - drive[0] * matrix[1][0]) / determinant;
    if (first > 0 && second > 0) return result(first, second);
  }
  if (on[0] && drive[0] > 0) {
    const double first = drive[0] / matrix[0][0];
    if (!on[1] || drive[1] - matrix[1][0] * first <= 0) return result(first, 0);
  }
  if (on[1] && drive[1] > 0) return result(0, drive[1] / matrix[1][1]);
  return result(0, 0);
}

}  // namespace rvelab::models
