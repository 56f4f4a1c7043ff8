#include "tools/umat/umat.hpp"

#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "tools/umat/host_call.hpp"
#include "tools/umat/refusals.hpp"

namespace umat {

namespace {

/// The arguments of a call, in the host's layout.
struct Call {
  double *stress, *statev, *ddsdde, *pnewdt;
  Components components;
  Properties properties;
  Beginning from{};
  Matrix3 dH{};
  const double* drot = nullptr;                                ///< also null without gradients
  Matrix3 R0 = Matrix3::Identity(), R1 = Matrix3::Identity();  ///< of start and end, if the host's axes rotate
};

Refusals& refusals() {
  static Refusals& made = *new Refusals;
  return made;
}

Components components_of(int direct, int shear, int all, const Material& material, bool gradients) {
  const bool known = (direct == 3 && (shear == 3 || shear == 1)) || (direct == 2 && shear == 1);
  if (!known || all != direct + shear)
    throw std::runtime_error("NDI, NSHR, NTENS are " + std::to_string(direct) + ", " + std::to_string(shear) + ", " +
                             std::to_string(all) + "; allowed: 3, 3, 6; 3, 1, 4; 2, 1, 3 of a 2D specimen");
  if (shear == 3 && !gradients && !material.shear_order)
    throw std::runtime_error(
        "the host gives no DFGRD0, as Kratos, which has shear in the order 12 23 13; write " +
        std::string("shear_order = \"kratos\", or \"abaqus\" for 12 13 23, under the [[material]] ") + "in " +
        points().file());
  return {direct, shear, material.shear_order.value_or(Components{}.order)};
}

void read_increment(const double* dstran, const double* dfgrd0, const double* dfgrd1, Call& call) {
  const Matrix3& strain = call.from.strain_increment;
  if (dfgrd0 == nullptr || dfgrd1 == nullptr) {
    if (dstran == nullptr) throw std::runtime_error("DSTRAN, DFGRD0 and DFGRD1 are null; give one or the others");
    call.dH = exponential_increment(strain);
    call.drot = nullptr;
    return;
  }
  const Matrix3& F0 = call.from.F0 = Eigen::Map<const Matrix3>(dfgrd0);
  const Matrix3& F1 = call.from.F1 = Eigen::Map<const Matrix3>(dfgrd1);
  if (!(F0.determinant() > 0) || !(F1.determinant() > 0))
    throw std::runtime_error("det DFGRD0 is " + std::to_string(F0.determinant()) + ", det DFGRD1 " +
                             std::to_string(F1.determinant()) + "; allowed: > 0; take smaller steps");
  if (call.components.direct == 2 && !(std::abs(F1(2, 2) - F0(2, 2)) <= 1e-9))
    throw std::runtime_error("NDI is 2, and DFGRD0(3,3) and DFGRD1(3,3) are " + std::to_string(F0(2, 2)) + " and " +
                             std::to_string(F1(2, 2)) + ": discs have neither stress nor strain along z; allowed: no " +
                             "change, as plane strain elements have it");
  // Small-strain analyses pass constant gradients.
  call.dH = F0 == F1 && !strain.isZero(0) ? exponential_increment(strain) : increment(F0, F1);
  if (call.properties.axes == Axes::corotational) {
    call.R0 = rotation_of(F0);
    call.R1 = rotation_of(F1);
  } else if (call.properties.axes == Axes::turned_by_host) {
    call.R1 = rotation_of(Matrix3::Identity() + call.dH);
  }
}

/// Abaqus passes the returned stress, rotated by the rotation DROT of the coming increment. A host that rotated it by
/// the last increment passes the DROT of that one; the stress in its equilibrium is then rotated twice.
void expect_not_turned(const Call& call, std::int64_t id) {
  if (call.properties.axes != Axes::global || call.drot == nullptr) return;
  const Eigen::Map<const Matrix3> Q(call.drot);
  const double turn = (Q - Matrix3::Identity()).norm();
  if (turn == 0 || (Q - rotation_of(Matrix3::Identity() + call.dH)).norm() <= 0.5 * turn) return;
  double components[6];
  write_stress(points().stress(id), call.components, components);
  const Matrix3 given = stress_of(call.stress, call.components), own = stress_of(components, call.components);
  const double moved = (given - own).norm();
  if (moved > 1e-9 * own.norm() && (given - Q * own * Q.transpose()).norm() < 1e-3 * moved)
    throw std::runtime_error(
        "STRESS is what was returned, turned by DROT, which is the rotation of another increment: the host turns what "
        "is returned; give PROPS(2) = 2 (MOOSE: or decomposition_method = HughesWinget, with PROPS(2) = 0)");
}

/// Unchanged stress and state, and the request for a smaller increment. Hosts pass 1 or more, or a number below 0
/// (CalculiX), for no request.
void refuse(const Call& call, const Step& step) {
  Beginning refused = call.from;
  if (refused.state.id == 0) {  // the point is identified by its state
    refused.state = points().unmoved(call.properties.material);
    call.statev[0] = double(refused.state.id);
    call.statev[1] = double(refused.state.token);
  }
  refusals().add(refused);
  if (!(*call.pnewdt > 0 && *call.pnewdt < step.dt_scale)) *call.pnewdt = step.dt_scale;
}

void write(const Call& call, const Step& step, bool kirchhoff) {
  const Matrix3 sigma = call.R1.transpose() * step.sigma * call.R1;
  write_stress(sigma, call.components, call.stress);
  call.statev[0] = double(step.end.id);
  call.statev[1] = double(step.end.token);
  if (call.ddsdde == nullptr) return;
  const bool turns = call.properties.axes == Axes::corotational;
  const Matrix6 tangent = turns ? turned(step.tangent, call.R1) : step.tangent;
  const int n = call.components.size();
  double stress[6];  // in the axes of the tangent
  write_stress(turns ? sigma : step.sigma, call.components, stress);
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      call.ddsdde[i + n * j] = tangent(call.components.place(i), call.components.place(j));
      if (kirchhoff && j < call.components.direct) call.ddsdde[i + n * j] += stress[i];
    }
}

void update(const Call& call) {
  Points& all = points();
  const State& from = call.from.state;
  if (from.id == 0)
    expect_first_stress(call.properties.material, call.stress, call.components, call.R0, "STRESS");
  else
    refusals().expect_obeyed(call.from);
  const Step step = all.step(call.properties.material, from, call.dH, call.properties.physical ? call.from.dt : 0,
                             call.ddsdde != nullptr);
  if (step.status == RVELAB_DISCARD && call.pnewdt != nullptr) return refuse(call, step);
  if (step.status < RVELAB_OK) throw std::runtime_error(step.text);
  if (from.id != 0) {
    refusals().forget_others(from);
    expect_not_turned(call, step.end.id);
  }
  write(call, step, all.material(call.properties.material).kirchhoff);
}

}  // namespace

}  // namespace umat

void umat::umat_(double* stress, double* statev, double* ddsdde, double*, double*, double*, double*, double*, double*,
                 double*, const double* stran, const double* dstran, const double* time, const double* dtime,
                 const double*, const double*, const double*, const double*, const char*, const int* ndi,
                 const int* nshr, const int* ntens, const int* nstatv, const double* props, const int* nprops,
                 const double*, const double* drot, double* pnewdt, const double*, const double* dfgrd0,
                 const double* dfgrd1, const int* noel, const int* npt, const int*, const int*, const int*,
                 const int*) {
  const CallEnvironment environment;
  try {
    remember_folder();
    if (statev == nullptr || or_zero(nstatv) < 2)
      throw std::runtime_error("NSTATV is " + std::to_string(or_zero(nstatv)) +
                               "; give 2 state variables (*DEPVAR): id and token");
    const Properties properties = properties_of(props, or_zero(nprops));
    const Components components = components_of(or_zero(ndi), or_zero(nshr), or_zero(ntens),
                                                points().material(properties.material), dfgrd0 != nullptr);
    Call call{stress, statev, ddsdde, pnewdt, components, properties};
    call.from.state = {whole_state(statev[0], "STATEV(1)"), whole_state(statev[1], "STATEV(2)")};
    if (dstran != nullptr) call.from.strain_increment = strain_of(dstran, components);
    if (stran != nullptr) call.from.strain = strain_of(stran, components);
    if (time != nullptr) call.from.time = *time;  // some hosts pass only one time
    if (dtime != nullptr) call.from.dt = *dtime;
    call.drot = drot;
    read_increment(dstran, dfgrd0, dfgrd1, call);
    update(call);
  } catch (const std::exception& failure) {
    try {
      log_failure("element " + std::to_string(or_zero(noel)) + ", point " + std::to_string(or_zero(npt)) + ": " +
                  failure.what());
    } catch (...) {  // no memory for words
    }
    for (int k = 0; k < or_zero(ntens); ++k) stress[k] = std::numeric_limits<double>::quiet_NaN();
  }
}
