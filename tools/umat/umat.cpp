#include "tools/umat/umat.hpp"

#include <Eigen/LU>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <stdexcept>
#include <string>

#include "tools/umat/points.hpp"

namespace umat {

namespace {

/// What PROPS says.
struct Properties {
  int material = 0;
  bool corotational = false;  ///< stresses of the host are R^T sigma R, R of the polar decomposition of F
  bool physical = false;      ///< DTIME is time; else it is ignored
};

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

/// STATEV(1) or (2) as an integer.
std::int64_t whole(double value, const char* name) {
  if (std::nearbyint(value) == value && std::abs(value) <= 9007199254740992.0) return std::int64_t(value);
  throw std::runtime_error(std::string(name) + " is " + in_words(value) +
                           ", no whole number; keep state variables in double precision, unchanged between calls");
}

int or_zero(const int* value) { return value == nullptr ? 0 : *value; }

/// Host and library share one pool for the life of the process.
Points& points() {
  static Points& made = *[] {
    const char* const named = std::getenv("RVELAB_UMAT");
    return new Points(read_settings(named == nullptr ? "rvelab_umat.toml" : named));
  }();
  return made;
}

/// What a call says of its point, in the host's layout.
struct Call {
  double *stress, *statev, *ddsdde, *pnewdt;
  Components components;
  Properties properties;
  PointName name;
  double dt = 0;
  Matrix3 dH;
  Matrix3 R0 = Matrix3::Identity(), R1 = Matrix3::Identity();  ///< of start and end, where the host turns with it
};

Matrix3 increment_of(const double* dstran, const double* dfgrd0, const double* dfgrd1, Call& call) {
  const Matrix3 strain = dstran == nullptr ? Matrix3(Matrix3::Zero()) : strain_of(dstran, call.components);
  if (dfgrd0 == nullptr || dfgrd1 == nullptr) {
    if (dstran == nullptr) throw std::runtime_error("DSTRAN, DFGRD0 and DFGRD1 are null; give one or the others");
    return exponential_increment(strain);
  }
  const Eigen::Map<const Matrix3> F0(dfgrd0), F1(dfgrd1);
  if (!(F0.determinant() > 0) || !(F1.determinant() > 0))
    throw std::runtime_error("det DFGRD0 is " + std::to_string(F0.determinant()) + ", det DFGRD1 " +
                             std::to_string(F1.determinant()) + "; allowed: > 0; take smaller steps");
  if (call.properties.corotational) {
    call.R0 = rotation_of(F0);
    call.R1 = rotation_of(F1);
  }
  // Small-strain analyses hand in gradients that stand still.
  if (F0 == F1 && !strain.isZero(0)) return exponential_increment(strain);
  return increment(F0, F1);
}

/// The specimen is in equilibrium with its own stress; a host that starts from another one would see a jump.
void expect_first_stress(const Call& call) {
  const Matrix3 own = call.R0.transpose() * points().first_stress(call.properties.material) * call.R0;
  if (call.components.direct == 2 && own(2, 2) != 0)
    throw std::runtime_error("NDI is 2 and the specimen is 3D; allowed: NDI = 3; use plane strain or solid elements");
  double expected[6];
  write_stress(own, call.components, expected);
  const Matrix3 given = stress_of(call.stress, call.components);
  if ((given - stress_of(expected, call.components)).norm() <= 0.01 * own.norm()) return;
  std::string found, wanted;
  for (int k = 0; k < call.components.size(); ++k) {
    found += " " + in_words(call.stress[k]);
    wanted += " " + in_words(expected[k]);
  }
  throw std::runtime_error("STRESS of the first call is" + found + " Pa; the specimen has" + wanted +
                           " Pa; give that as initial stress (allowed: within 1 %), or a specimen packed to yours");
}

void update(const Call& call) {
  Points& all = points();
  const Material& material = all.material(call.properties.material);
  Start start{whole(call.statev[0], "STATEV(1)"), whole(call.statev[1], "STATEV(2)")};
  if (start.id == 0) {
    expect_first_stress(call);
    start = all.spawn(call.properties.material, call.name);
  }
  const Step step = all.step(start, call.dH, call.dt, call.ddsdde != nullptr);
  if (step.status == RVELAB_DISCARD && call.pnewdt != nullptr) {
    *call.pnewdt = std::min(*call.pnewdt, step.dt_scale);
    return;
  }
  if (step.status < RVELAB_OK) throw std::runtime_error(step.text);
  const Matrix3 sigma = call.R1.transpose() * step.sigma * call.R1;
  write_stress(sigma, call.components, call.stress);
  call.statev[0] = double(start.id);
  call.statev[1] = double(step.token);
  if (call.ddsdde == nullptr) return;
  const Matrix6 tangent = call.properties.corotational ? turned(step.tangent, call.R1) : step.tangent;
  const int n = call.components.size();
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      call.ddsdde[i + n * j] = tangent(call.components.place(i), call.components.place(j));
      if (material.kirchhoff && j < call.components.direct) call.ddsdde[i + n * j] += call.stress[i];
    }
}

}  // namespace

}  // namespace umat

void umat::umat_(double* stress, double* statev, double* ddsdde, double*, double*, double*, double*, double*, double*,
                 double*, const double*, const double* dstran, const double*, const double* dtime, const double*,
                 const double*, const double*, const double*, const char*, const int* ndi, const int* nshr,
                 const int* ntens, const int* nstatv, const double* props, const int* nprops, const double*,
                 const double*, double* pnewdt, const double*, const double* dfgrd0, const double* dfgrd1,
                 const int* noel, const int* npt, const int* layer, const int* kspt, const int*, const int*) {
  const PointName name{or_zero(noel), or_zero(npt), or_zero(layer), or_zero(kspt)};
  try {
    const Components components{or_zero(ndi), or_zero(nshr)};
    if (components.size() != or_zero(ntens) || components.direct < 2 || components.direct > 3 || components.shear < 1 ||
        components.shear > 3)
      throw std::runtime_error("NDI, NSHR, NTENS are " + std::to_string(components.direct) + ", " +
                               std::to_string(components.shear) + ", " + std::to_string(or_zero(ntens)) +
                               "; allowed: 3, 3, 6; 3, 1, 4; 2, 1, 3 of a 2D specimen");
    if (statev == nullptr || or_zero(nstatv) < 2)
      throw std::runtime_error("NSTATV is " + std::to_string(or_zero(nstatv)) +
                               "; give 2 state variables (*DEPVAR): id and token");
    Call call{stress, statev, ddsdde, pnewdt, components, properties_of(props, or_zero(nprops)), name, 0, {}};
    if (call.properties.physical && dtime != nullptr) call.dt = *dtime;
    call.dH = increment_of(dstran, dfgrd0, dfgrd1, call);
    update(call);
  } catch (const std::exception& failure) {
    try {
      log_failure("element " + std::to_string(name[0]) + ", point " + std::to_string(name[1]) + ": " + failure.what());
    } catch (...) {  // no memory for words
    }
    for (int k = 0; k < or_zero(ntens); ++k) stress[k] = std::numeric_limits<double>::quiet_NaN();
  }
}
