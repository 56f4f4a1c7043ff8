#include "tools/umat/umat.hpp"

#include <Eigen/LU>
#include <limits>
#include <stdexcept>
#include <string>

#include "tools/umat/host_call.hpp"

namespace umat {

namespace {

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

void update(const Call& call) {
  Points& all = points();
  const Material& material = all.material(call.properties.material);
  Start start{whole_state(call.statev[0], "STATEV(1)"), whole_state(call.statev[1], "STATEV(2)")};
  if (start.id == 0) {
    expect_first_stress(call.properties.material, call.stress, call.components, call.R0, "STRESS");
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
