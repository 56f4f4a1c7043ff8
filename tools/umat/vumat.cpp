#include "tools/umat/vumat.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>

#include "tools/umat/host_call.hpp"

namespace umat {

namespace {

/// Axes of the columns of tensors: of symmetric ones the first ndir + nshr, of gradients in three dimensions all.
constexpr int axis_of_block[9][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {2, 0}, {1, 0}, {2, 1}, {0, 2}};

/// The block of points of one call.
struct Block {
  int points, direct, shear, states;
  Properties properties;
  double dt;
  bool elastic;  ///< the call before the first increment, by which the host finds the speed of waves
  Components components() const { return {direct, shear}; }

  double at(const double* array, int point, int column) const { return array[point + points * column]; }

  /// A symmetric tensor, its shear as the tensor has it.
  Matrix3 symmetric(const double* array, int point) const {
    Matrix3 tensor = Matrix3::Zero();
    for (int k = 0; k < direct + shear; ++k) {
      const auto [i, j] = axis_of_block[k];
      tensor(i, j) = tensor(j, i) = at(array, point, k);
    }
    return tensor;
  }
  void write(const Matrix3& tensor, int point, double* array) const {
    for (int k = 0; k < direct + shear; ++k) {
      const auto [i, j] = axis_of_block[k];
      array[point + points * k] = i == j ? tensor(i, i) : 0.5 * (tensor(i, j) + tensor(j, i));
    }
  }
  Matrix3 gradient(const double* array, int point) const {
    Matrix3 F = Matrix3::Identity();
    for (int k = 0; k < direct; ++k) F(k, k) = at(array, point, k);
    if (shear == 1) {
      F(0, 1) = at(array, point, direct);
      F(1, 0) = at(array, point, direct + 1);
    } else {
      for (int k = 3; k < 9; ++k) F(axis_of_block[k][0], axis_of_block[k][1]) = at(array, point, k);
    }
    if (!(F.determinant() > 0))
      throw std::runtime_error("det of defgrad is " + std::to_string(F.determinant()) +
                               "; allowed: > 0; take smaller steps");
    return F;
  }
};

/// The whole increment, in parts where the host's is too large: an explicit host cannot try a smaller one.
Matrix3 advance(const Block& block, Start& start, const Matrix3& F0, const Matrix3& F1, const Matrix3& small) {
  constexpr double smallest_part = 1.0 / 1024;
  Step step;
  double done = 0, part = 1;
  while (done < 1) {
    const double next = std::min(1.0, done + part);
    const Matrix3 from = done > 0 ? Matrix3(F0 + done * (F1 - F0)) : F0;
    const Matrix3 to = next < 1 ? Matrix3(F0 + next * (F1 - F0)) : F1;
    // Analyses of small strain hand in gradients that stand still.
    const Matrix3 dH = F0 == F1 ? exponential_increment((next - done) * small) : increment(from, to);
    step = points().step(start, dH, (next - done) * block.dt, false);
    if (step.status == RVELAB_DISCARD) {
      part *= std::clamp(step.dt_scale, 0.1, 0.5);
      if (part >= smallest_part) continue;
    }
    if (step.status < RVELAB_OK) throw std::runtime_error(step.text);
    start.token = step.token;
    done = next;
  }
  return step.sigma;
}

/// Stress in the axes that turn with the material; the state variables go on in `start`.
Matrix3 new_stress(const Block& block, int point, const double* strain, const double* defgrad_old,
                   const double* defgrad_new, const Matrix3& stress_old, Start& start) {
  const Matrix3 F0 = block.gradient(defgrad_old, point);
  const Matrix3 small = strain == nullptr ? Matrix3(Matrix3::Zero()) : block.symmetric(strain, point);
  const Matrix3 R0 = rotation_of(F0);
  if (start.id == 0) {
    double given[6];
    write_stress(stress_old, block.components(), given);
    expect_first_stress(block.properties.material, given, block.components(), R0, "stressOld (11 22 33 12 13 23)");
  }
  if (block.elastic) {
    const Matrix6 tangent = turned(points().first_tangent(block.properties.material), R0);
    Eigen::Matrix<double, 6, 1> strains, stresses;
    strains << small(0, 0), small(1, 1), small(2, 2), 2 * small(0, 1), 2 * small(0, 2), 2 * small(1, 2);
    stresses = tangent * strains;
    return stress_old + stress_of(stresses.data(), Components{3, 3});
  }
  const Matrix3 F1 = block.gradient(defgrad_new, point), R1 = rotation_of(F1);
  if (start.id == 0) start = points().spawn(block.properties.material, {});
  return R1.transpose() * advance(block, start, F0, F1, small) * R1;
}

Block block_of(const int* nblock, const int* ndir, const int* nshr, const int* nstatev, const int* nprops,
               const int* lanneal, const double* step_time, const double* total_time, const double* dt,
               const double* props) {
  Block block{
      or_zero(nblock), or_zero(ndir), or_zero(nshr), or_zero(nstatev), properties_of(props, or_zero(nprops)), 0, false};
  if (block.direct != 3 || (block.shear != 1 && block.shear != 3))
    throw std::runtime_error("ndir and nshr are " + std::to_string(block.direct) + " and " +
                             std::to_string(block.shear) + "; allowed: 3 and 1 (plane strain), 3 and 3");
  if (block.states < 2)
    throw std::runtime_error("nstatev is " + std::to_string(block.states) +
                             "; give 2 state variables (*DEPVAR): id and token");
  if (or_zero(lanneal) != 0)
    throw std::runtime_error("lanneal is " + std::to_string(*lanneal) +
                             "; allowed: 0; grains cannot be annealed, take the annealing step out");
  if (block.properties.physical && dt != nullptr) block.dt = *dt;
  block.elastic = step_time != nullptr && total_time != nullptr && *step_time == 0 && *total_time == 0;
  return block;
}

void log_of_block(const std::string& what) {
  try {
    log_failure("vumat, " + what);
  } catch (...) {  // no memory for words
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
  const int all = or_zero(nblock), components = or_zero(ndir) + or_zero(nshr);
  const auto no_stress = [&](int point) {
    for (int k = 0; k < components; ++k) stressNew[point + all * k] = std::numeric_limits<double>::quiet_NaN();
  };
  try {
    const Block block = block_of(nblock, ndir, nshr, nstatev, nprops, lanneal, stepTime, totalTime, dt, props);
    for (int point = 0; point < all; ++point) {
      for (int k = 0; k < block.states; ++k) stateNew[point + all * k] = stateOld[point + all * k];
      try {
        Start start{whole_state(stateOld[point], "stateOld(k,1)"), whole_state(stateOld[point + all], "stateOld(k,2)")};
        const Matrix3 old = block.symmetric(stressOld, point);
        const Matrix3 stress = new_stress(block, point, strainInc, defgradOld, defgradNew, old, start);
        block.write(stress, point, stressNew);
        stateNew[point] = double(start.id);
        stateNew[point + all] = double(start.token);
        if (density == nullptr || strainInc == nullptr || enerInternOld == nullptr || enerInternNew == nullptr)
          continue;
        const double work = 0.5 * (old + stress).cwiseProduct(block.symmetric(strainInc, point)).sum();
        enerInternNew[point] = enerInternOld[point] + work / density[point];
        if (enerInelasOld != nullptr && enerInelasNew != nullptr) enerInelasNew[point] = enerInelasOld[point];
      } catch (const std::exception& failure) {
        log_of_block("point " + std::to_string(point + 1) + " of a block: " + failure.what());
        no_stress(point);
      }
    }
  } catch (const std::exception& failure) {
    log_of_block(failure.what());
    for (int point = 0; point < all; ++point) no_stress(point);
  }
}
