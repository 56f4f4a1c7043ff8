#include "tools/umat/host_call.hpp"

#include <cmath>
#include <cstdlib>
#include <stdexcept>

namespace umat {

std::string in_words(double value) {
  std::string words = std::to_string(value);
  if (std::nearbyint(value) == value && std::abs(value) < 1e15) words.resize(words.find_first_of(".,"));
  return words;
}

Properties properties_of(const double* props, int n) {
  if (props == nullptr || n < 1)
    throw std::runtime_error("NPROPS is " + std::to_string(n) + "; give PROPS(1), the number of the material");
  const auto option = [&](int k, const std::string& meaning) {
    const double value = n > k ? props[k] : 0;
    if (value != 0 && value != 1)
      throw std::runtime_error("PROPS(" + std::to_string(k + 1) + ") is " + in_words(value) + "; allowed: " + meaning);
    return value == 1;
  };
  if (!(props[0] >= 1 && props[0] < 1e9 && std::nearbyint(props[0]) == props[0]))
    throw std::runtime_error("PROPS(1) is " + in_words(props[0]) + "; give the whole number of a material");
  return {int(props[0]), option(1, "0 (global Cauchy stress, as Abaqus has it) or 1 (R^T sigma R, as CalculiX has it)"),
          option(2, "0 (quasi-static) or 1 (DTIME is physical time)")};
}

std::int64_t whole_state(double value, const char* name) {
  if (std::nearbyint(value) == value && std::abs(value) <= 9007199254740992.0) return std::int64_t(value);
  throw std::runtime_error(std::string(name) + " is " + in_words(value) +
                           ", no whole number; keep state variables in double precision, unchanged between calls");
}

Points& points() {
  static Points& made = *[] {
    const char* const named = std::getenv("RVELAB_UMAT");
    return new Points(read_settings(named == nullptr ? "rvelab_umat.toml" : named));
  }();
  return made;
}

void expect_first_stress(int material, const double* given, const Components& components, const Matrix3& R0,
                         const char* name) {
  const Matrix3 own = R0.transpose() * points().first_stress(material) * R0;
  if (components.direct == 2 && own(2, 2) != 0)
    throw std::runtime_error("NDI is 2 and the specimen is 3D; allowed: NDI = 3; use plane strain or solid elements");
  double expected[6];
  write_stress(own, components, expected);
  if ((stress_of(given, components) - stress_of(expected, components)).norm() <= 0.01 * own.norm()) return;
  std::string found, wanted;
  for (int k = 0; k < components.size(); ++k) {
    found += " " + in_words(given[k]);
    wanted += " " + in_words(expected[k]);
  }
  throw std::runtime_error(name + std::string(" of the first call is") + found + " Pa; the specimen has" + wanted +
                           " Pa; give that as initial stress (allowed: within 1 %), or a specimen packed to yours");
}

}  // namespace umat
