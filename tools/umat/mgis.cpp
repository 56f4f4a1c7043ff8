#include "tools/umat/mgis.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <string>

#include "tools/umat/host_call.hpp"
#include "tools/umat/stress_measures.hpp"

namespace umat::mgis {

namespace {

/// The request in K[0] to K[2].
struct Wanted {
  bool prediction = false;  ///< the tangent at the start of the step, without a step
  bool tangent = false;
  bool speed = false;  ///< of sound
  StressMeasure measure = StressMeasure::cauchy;
  TangentKind kind = TangentKind::cauchy_gradient;
};

int choice(double value, int largest, const char* name, const char* meaning) {
  const double nearest = std::nearbyint(value);
  if (!(nearest >= 0 && nearest <= largest))
    throw std::runtime_error(std::string(name) + " is " + in_words(value) + "; allowed: " + meaning);
  return int(nearest);
}

Wanted wanted_of(const double* K, Kinematics kinematics) {
  Wanted wanted;
  wanted.speed = K[0] > 50;
  const double task = wanted.speed ? K[0] - 100 : K[0];
  if (!(std::abs(task) < 10)) throw std::runtime_error("K[0] is " + in_words(K[0]) + "; allowed: -3 to 4, or 100 more");
  wanted.prediction = task < -0.5;
  wanted.tangent = wanted.prediction || task > 0.5;
  if (kinematics == Kinematics::small_strain) return wanted;
  const int measure = choice(K[1], 2, "K[1]", "0 (Cauchy stress), 1 (second) or 2 (first Piola-Kirchhoff stress)");
  wanted.measure = StressMeasure(measure);
  if (wanted.tangent)
    wanted.kind = TangentKind(choice(K[2], 3, "K[2]", "0 (d sigma/dF), 1 (dS/dE), 2 (dP/dF) or 3 (d tau/d delta F)"));
  return wanted;
}

int whole_property(double value, const char* name, int largest) {
  if (std::nearbyint(value) == value && value >= 0 && value <= largest) return int(value);
  throw std::runtime_error(std::string("the material property ") + name + " is " + in_words(value) + "; allowed: " +
                           (largest == 1 ? "0 (quasi-static) or 1 (dt is physical time)" : "the number of a material"));
}

Matrix3 gradient(const double* from, int dimension, const char* name) {
  const Matrix3 F = any_tensor(from, dimension);
  if (!(F.determinant() > 0))
    throw std::runtime_error("the determinant of DeformationGradient of " + std::string(name) + " is " +
                             std::to_string(F.determinant()) + "; allowed: > 0; take smaller steps");
  return F;
}

/// One call, its arguments as tensors.
struct Call {
  Kinematics kinematics;
  int dimension;
  PointData& data;
  Wanted wanted;
  int material = 0;
  double dt = 0;
  Matrix3 F0 = Matrix3::Identity(), F1 = Matrix3::Identity(), dH;

  Call(Kinematics kinematics, int dimension, PointData& data)
      : kinematics(kinematics), dimension(dimension), data(data), wanted(wanted_of(data.K, kinematics)) {
    const double* const properties = data.s1.material_properties;
    material = whole_property(properties[0], "Material", 1'000'000'000);
    if (whole_property(properties[1], "PhysicalTime", 1) == 1) dt = data.dt;
    if (kinematics == Kinematics::small_strain) {
      dH = exponential_increment(symmetric_tensor(data.s1.gradients, dimension) -
                                 symmetric_tensor(data.s0.gradients, dimension));
    } else {
      F0 = gradient(data.s0.gradients, dimension, "s0");
      F1 = gradient(data.s1.gradients, dimension, "s1");
      dH = increment(F0, F1);
    }
  }

  Matrix3 first_stress() const {
    const double* const forces = data.s0.thermodynamic_forces;
    const Matrix3 stress = wanted.measure == StressMeasure::first_piola ? any_tensor(forces, dimension)
                                                                        : symmetric_tensor(forces, dimension);
    return to_cauchy(wanted.measure, stress, F0);
  }

  void write_stress(const Matrix3& sigma) const {
    const Matrix3 stress = from_cauchy(wanted.measure, sigma, F1);
    if (wanted.measure == StressMeasure::first_piola)
      write_any(stress, dimension, data.s1.thermodynamic_forces);
    else
      write_symmetric(stress, dimension, data.s1.thermodynamic_forces);
  }

  /// from, to: start of the step and the state of the tangent.
  void write_tangent(const Matrix6& tangent, const Matrix3& sigma, const Matrix3& from, const Matrix3& to) const {
    const std::vector<double> rows = kinematics == Kinematics::small_strain
                                         ? small_strain_tangent(tangent, dimension)
                                         : finite_strain_tangent(wanted.kind, tangent, sigma, from, to, dimension);
    std::copy(rows.begin(), rows.end(), data.K);
  }

  void write_speed(const Matrix6& tangent, const double* density, const Matrix3& F) const {
    if (data.speed_of_sound == nullptr || density == nullptr || !(*density > 0))
      throw std::runtime_error("the speed of sound is requested, and mass_density is " +
                               (density == nullptr ? "null" : in_words(*density)) +
                               "; give the density of the material, above 0");
    *data.speed_of_sound = std::sqrt(std::max(wave_modulus(tangent), 0.0) * F.determinant() / *density);
  }
};

void tell(PointData& data, const std::string& text) {
  if (data.error_message == nullptr) return;
  constexpr std::size_t room = 511;
  const std::size_t length = std::min(room, text.size());
  std::memcpy(data.error_message, text.data(), length);
  data.error_message[length] = '\0';
}

/// Unbalanced moments of the grains cause a small skew part, which the other measures would mix into all components.
Matrix3 symmetric_part(const Matrix3& sigma) { return 0.5 * (sigma + sigma.transpose()); }

State state_of(const double* states) { return {whole_state(states[0], "RveId"), whole_state(states[1], "RveToken")}; }

int predict(const Call& call) {
  const State start = state_of(call.data.s0.internal_state_variables);
  Step step;
  if (start.id == 0) {
    step.tangent = points().first_tangent(call.material);
    step.sigma = points().first_stress(call.material);
  } else {
    step = points().step(call.material, start, Matrix3::Zero(), 0, true);
    if (step.status < RVELAB_OK) throw std::runtime_error(step.text);
  }
  if (call.wanted.speed) call.write_speed(step.tangent, call.data.s0.mass_density, call.F0);
  call.write_tangent(step.tangent, symmetric_part(step.sigma), call.F0, call.F0);
  return 1;
}

int advance(const Call& call) {
  PointData& data = call.data;
  points().material(call.material, "the material property Material");
  const State start = state_of(data.s0.internal_state_variables);
  if (start.id == 0) {
    const Components components{3, call.dimension == 2 ? 1 : 3};
    double given[6];
    umat::write_stress(call.first_stress(), components, given);
    expect_first_stress(
        call.material, given, components, Matrix3::Identity(),
        call.dimension == 2 ? "the Cauchy stress of s0 (11 22 33 12)" : "the Cauchy stress of s0 (11 22 33 12 13 23)");
  }
  Step step = points().step(call.material, start, call.dH, call.dt, call.wanted.tangent || call.wanted.speed);
  if (step.status == RVELAB_DISCARD) {
    if (data.rdt != nullptr) *data.rdt = std::min(*data.rdt, step.dt_scale);
    tell(data, step.text);
    return -1;
  }
  if (step.status < RVELAB_OK) throw std::runtime_error(step.text);
  step.sigma = symmetric_part(step.sigma);
  if (call.wanted.speed) call.write_speed(step.tangent, data.s1.mass_density, call.F1);
  call.write_stress(step.sigma);
  data.s1.internal_state_variables[0] = double(step.end.id);
  data.s1.internal_state_variables[1] = double(step.end.token);
  if (call.wanted.tangent) call.write_tangent(step.tangent, step.sigma, call.F0, call.F1);
  if (step.status != RVELAB_W_NOT_QUASI_STATIC) return 1;
  tell(data, step.text);
  return 0;
}

}  // namespace

int integrate(Kinematics kinematics, int dimension, PointData* data) noexcept {
  if (data == nullptr) return -1;
  const CallEnvironment environment;
  try {
    remember_folder();
    const auto needed = [](const void* pointer, const char* name) {
      if (pointer == nullptr) throw std::runtime_error(std::string(name) + " is null; the host has to give it");
    };
    needed(data->K, "K");
    needed(data->s0.gradients, "s0.gradients");
    needed(data->s1.gradients, "s1.gradients");
    needed(data->s0.thermodynamic_forces, "s0.thermodynamic_forces");
    needed(data->s1.thermodynamic_forces, "s1.thermodynamic_forces");
    needed(data->s1.material_properties, "s1.material_properties");
    needed(data->s0.internal_state_variables, "s0.internal_state_variables");
    needed(data->s1.internal_state_variables, "s1.internal_state_variables");
    const Call call(kinematics, dimension, *data);
    return call.wanted.prediction ? predict(call) : advance(call);
  } catch (const std::exception& failure) {
    try {
      tell(*data, failure.what());
      log_failure(std::string("mgis: ") + failure.what());
    } catch (...) {  // no memory for words
    }
    return -1;
  }
}

}  // namespace umat::mgis
