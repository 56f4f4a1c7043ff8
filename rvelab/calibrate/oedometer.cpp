#include "rvelab/calibrate/oedometer.hpp"

#include <cmath>
#include <limits>

namespace rvelab::calibrate {

OedometerStiffness oedometer_stiffness(std::span<const records::Record> stage, const std::string& axis, int dimension,
                                       double up_to) {
  const int a = axis[0] - 'x';
  double squares = 0, axial = 0, lateral = 0;
  for (const records::Record& record : stage) {
    if (std::abs(record.strain) > up_to * (1 + 1e-9)) break;
    // Compression positive in both.
    const Matrix3 change = stage.front().stress - record.stress;
    const double strain = record.strain - stage.front().strain;
    squares += strain * strain;
    axial += strain * change(a, a);
    for (int k = 0; k < dimension; ++k) {
      if (k != a) lateral += strain * change(k, k) / (dimension - 1);
    }
  }
  constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
  if (squares == 0) return {nothing, nothing, nothing, nothing, nothing};
  const double c11 = axial / squares, c12 = lateral / squares, g = 0.5 * (c11 - c12);
  return {c11, c12, g, c12 + 2 * g / 3, 0.5 * (c11 + c12)};
}

}  // namespace rvelab::calibrate
