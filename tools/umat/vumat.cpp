#include "tools/umat/vumat.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "tools/umat/host_call.hpp"

namespace umat {

namespace {

/// Axes of the columns of tensors: of symmetric ones the first ndir + nshr, of gradients in space all.
constexpr int axis_of_block[9][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {2, 0}, {1, 0}, {2, 1}, {0, 2}};

/// The block of points of one call, whose arrays are of the host's precision.
template <class Real>
struct Block {
  int points, direct, shear, states;
  const Real *step_time, *total_time, *time_increment, *density, *strain, *F0, *old_stress, *old_state, *old_energy,
      *old_inelastic, *F1;
  Real *stress, *state, *energy, *inelastic;
  Properties properties{};
  double dt = 0;
  bool elastic = false;  ///< the call before the first increment, by which the host determines the wave speed
  Components components() const { return {direct, shear}; }

  std::size_t place(int point, int column) const {
    return std::size_t(point) + std::size_t(points) * std::size_t(column);
  }

  /// A symmetric tensor, with tensor shear.
  Matrix3 symmetric(const Real* array, int point) const {
    Matrix3 tensor = Matrix3::Zero();
    for (int k = 0; k < direct + shear; ++k) {
      const auto [i, j] = axis_of_block[k];
      tensor(i, j) = tensor(j, i) = array[place(point, k)];
    }
    return tensor;
  }
  void write_stress(const Matrix3& tensor, int point) const {
    for (int k = 0; k < direct + shear; ++k) {
      const auto [i, j] = axis_of_block[k];
      stress[place(point, k)] = Real(i == j ? tensor(i, i) : 0.5 * (tensor(i, j) + tensor(j, i)));
    }
  }
  Matrix3 gradient(const Real* array, int point) const {
    Matrix3 F = Matrix3::Identity();
    for (int k = 0; k < direct; ++k) F(k, k) = array[place(point, k)];
    if (shear == 1) {
      F(0, 1) = array[place(point, direct)];
      F(1, 0) = array[place(point, direct + 1)];
    } else {
      for (int k = 3; k < 9; ++k) F(axis_of_block[k][0], axis_of_block[k][1]) = array[place(point, k)];
    }
    if (!(F.determinant() > 0))
      throw std::runtime_error("det of defgrad is " + std::to_string(F.determinant()) +
                               "; allowed: > 0; take smaller steps");
    return F;
  }

  /// State variables of an id or token: one in double precision, in single precision three whole numbers of 18 bits.
  static constexpr int pieces = sizeof(Real) == sizeof(double) ? 1 : 3;
  static constexpr std::int64_t base = 1 << 18;

  std::int64_t state_number(int point, int first) const {
    std::int64_t number = 0;
    for (int k = first; k < first + pieces; ++k) {
      const std::string name = "stateOld(k," + std::to_string(k + 1) + ")";
      const std::int64_t piece = whole_state(old_state[place(point, k)], name.c_str());
      if (pieces > 1 && (piece < 0 || piece >= base))
        throw std::runtime_error(name + " is " + std::to_string(piece) +
                                 "; keep state variables unchanged between calls");
      number = pieces > 1 ? number * base + piece : piece;
    }
    return number;
  }
  void write_state_number(int point, int first, std::int64_t number) const {
    for (int k = first + pieces - 1; k >= first; --k, number /= base)
      state[place(point, k)] = Real(pieces > 1 ? number % base : number);
  }
  State old_state_of(int point) const { return {state_number(point, 0), state_number(point, pieces)}; }
  void write_state(int point, const State& made) const {
    write_state_number(point, 0, made.id);
    write_state_number(point, pieces, made.token);
  }
};

/// Single precision is detected by the number of the material: for whole numbers below two millions the first half of a
/// double is zero, and that of a float is the number.
bool in_single_precision(const void* props, int n) {
  if (props == nullptr || n < 1) return false;
  float first = 0;
  std::memcpy(&first, props, sizeof first);
  return std::abs(first) >= 0.5f && std::abs(first) < 1e9f;
}

/// The whole increment, divided if it is too large: an explicit host cannot repeat it with a smaller one. `small`: the
/// strain, if the host gives no gradient.
Matrix3 advance(int material, double dt, State& state, const Matrix3& F0, const Matrix3& F1,
                const std::optional<Matrix3>& small) {
  constexpr double smallest_part = 1.0 / 1024;
  Step step;
  double done = 0, part = 1;
  while (done < 1) {
    const double next = std::min(1.0, done + part);
    const Matrix3 from = done > 0 ? Matrix3(F0 + done * (F1 - F0)) : F0;
    const Matrix3 to = next < 1 ? Matrix3(F0 + next * (F1 - F0)) : F1;
    const Matrix3 dH = small ? exponential_increment((next - done) * *small) : increment(from, to);
    step = points().step(material, state, dH, (next - done) * dt, false);
    if (step.status == RVELAB_DISCARD) {
      part *= std::clamp(step.dt_scale, 0.1, 0.5);
      if (part >= smallest_part) continue;
    }
    if (step.status < RVELAB_OK) throw std::runtime_error(step.text);
    state = step.end;
    done = next;
  }
  return step.sigma;
}

/// Stress in the axes that rotate with the material; `state` is that at the end.
template <class Real>
Matrix3 new_stress(const Block<Real>& block, int point, State& state) {
  const int material = block.properties.material;
  const Matrix3 F0 = block.gradient(block.F0, point);
  const Matrix3 small = block.strain == nullptr ? Matrix3(Matrix3::Zero()) : block.symmetric(block.strain, point);
  const Matrix3 R0 = rotation_of(F0), old = block.symmetric(block.old_stress, point);
  if (block.elastic) {
    const Matrix6 tangent = turned(points().first_tangent(material), R0);
    Eigen::Matrix<double, 6, 1> strains, stresses;
    strains << small(0, 0), small(1, 1), small(2, 2), 2 * small(0, 1), 2 * small(0, 2), 2 * small(1, 2);
    stresses = tangent * strains;
    return old + stress_of(stresses.data(), Components{3, 3});
  }
  const Matrix3 F1 = block.gradient(block.F1, point), R1 = rotation_of(F1);
  // Small-strain analyses pass constant gradients. In single precision other gradients may also stay constant until
  // small increments exceed round-off; the next gradient then includes them.
  const bool still = F0 == F1 && (sizeof(Real) == sizeof(double) || F0 == Matrix3::Identity());
  const std::optional<Matrix3> alone = still ? std::optional(small) : std::nullopt;
  if (state.id != 0) return R1.transpose() * advance(material, block.dt, state, F0, F1, alone) * R1;
  double given[6];
  write_stress(old, block.components(), given);
  expect_first_stress(material, given, block.components(), R0, "stressOld (11 22 33 12 13 23)");
  const State made = state = points().spawn(material);
  try {
    return R1.transpose() * advance(material, block.dt, state, F0, F1, alone) * R1;
  } catch (...) {
    points().release(made);
    throw;
  }
}

template <class Real>
void expect_allowed(const Block<Real>& block, const int* lanneal) {
  if (block.direct != 3 || (block.shear != 1 && block.shear != 3))
    throw std::runtime_error("ndir and nshr are " + std::to_string(block.direct) + " and " +
                             std::to_string(block.shear) + "; allowed: 3 and 1 (plane strain), 3 and 3");
  if (block.states < 2 * block.pieces)
    throw std::runtime_error("nstatev is " + std::to_string(block.states) +
                             (block.pieces == 1 ? "; give 2 state variables (*DEPVAR): id and token"
                                                : "; the job is in single precision: give 6 state variables (*DEPVAR), "
                                                  "three each for id and token, or run it with double=both"));
  if (or_zero(lanneal) != 0)
    throw std::runtime_error("lanneal is " + std::to_string(*lanneal) +
                             "; allowed: 0; grains cannot be annealed, take the annealing step out");
}

void log_of_block(const std::string& what) {
  try {
    log_failure("vumat, " + what);
  } catch (...) {  // no memory for words
  }
}

template <class Real>
void no_stress(const Block<Real>& block, int point) {
  for (int k = 0; k < block.direct + block.shear; ++k)
    block.stress[block.place(point, k)] = std::numeric_limits<Real>::quiet_NaN();
}

template <class Real>
void update(const Block<Real>& block, int point) {
  for (int k = 0; k < block.states; ++k) block.state[block.place(point, k)] = block.old_state[block.place(point, k)];
  try {
    State state = block.old_state_of(point);
    const Matrix3 stress = new_stress(block, point, state);
    block.write_stress(stress, point);
    block.write_state(point, state);
    if (block.density == nullptr || block.strain == nullptr || block.old_energy == nullptr || block.energy == nullptr)
      return;
    const Matrix3 mean = 0.5 * (block.symmetric(block.old_stress, point) + stress);
    const double work = mean.cwiseProduct(block.symmetric(block.strain, point)).sum();
    block.energy[point] = Real(block.old_energy[point] + work / block.density[point]);
    if (block.old_inelastic != nullptr && block.inelastic != nullptr)
      block.inelastic[point] = block.old_inelastic[point];
  } catch (const std::exception& failure) {
    log_of_block("point " + std::to_string(point + 1) + " of a block: " + failure.what());
    no_stress(block, point);
  }
}

template <class Real>
void update_all(Block<Real> block, const Real* props, const int* nprops, const int* lanneal) {
  try {
    const int n = std::clamp(or_zero(nprops), 0, 3);
    const std::vector<double> properties(props, props + (props == nullptr ? 0 : n));
    block.properties = properties_of(properties.empty() ? nullptr : properties.data(), n);
    expect_allowed(block, lanneal);
    if (block.properties.physical && block.time_increment != nullptr) block.dt = *block.time_increment;
    block.elastic =
        block.step_time != nullptr && block.total_time != nullptr && *block.step_time == 0 && *block.total_time == 0;
    for (int point = 0; point < block.points; ++point) update(block, point);
  } catch (const std::exception& failure) {
    log_of_block(failure.what());
    for (int point = 0; point < block.points; ++point) no_stress(block, point);
  }
}

}  // namespace

}  // namespace umat

void umat::vumat_(const int* nblock, const int* ndir, const int* nshr, const int* nstatev, const int*,
                  const int* nprops, const int* lanneal, const double* stepTime, const double* totalTime,
                  const double* dt, const char*, const double*, const double*, const double* props,
                  const double* density, const double* strainInc, const double*, const double*, const double*,
                  const double* defgradOld, const double*, const double* stressOld, const double* stateOld,
                  const double* enerInternOld, const double* enerInelasOld, const double*, const double*,
                  const double* defgradNew, const double*, double* stressNew, double* stateNew, double* enerInternNew,
                  double* enerInelasNew) {
  const CallEnvironment environment;
  const auto serve = [&]<class Real>(Real) {
    const auto in = [](const double* array) { return reinterpret_cast<const Real*>(array); };
    const auto out = [](double* array) { return reinterpret_cast<Real*>(array); };
    update_all(Block<Real>{or_zero(nblock), or_zero(ndir), or_zero(nshr), or_zero(nstatev), in(stepTime), in(totalTime),
                           in(dt), in(density), in(strainInc), in(defgradOld), in(stressOld), in(stateOld),
                           in(enerInternOld), in(enerInelasOld), in(defgradNew), out(stressNew), out(stateNew),
                           out(enerInternNew), out(enerInelasNew)},
               in(props), nprops, lanneal);
  };
  try {
    remember_folder();
  } catch (const std::exception&) {  // no memory for its name; it is determined again
  }
  in_single_precision(props, or_zero(nprops)) ? serve(float{}) : serve(double{});
}
