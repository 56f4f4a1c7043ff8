// What an Rve holds. Shared by the files that implement it and by nothing else.
#pragma once

#include "rvelab/solver/assembly.hpp"
#include "rvelab/solver/inertia.hpp"
#include "rvelab/solver/rve.hpp"
#include "rvelab/solver/stepping.hpp"

namespace rvelab {

struct Rve::Impl {
  Fixture fixture;
  Assembly now;
  Assembly before;  ///< scratch: the state at the start of the increment

  Matrix3 to_lab(const Matrix3& cell_frame) const {
    return now.cell.rotation * cell_frame * now.cell.rotation.transpose();
  }
  Matrix3 contact_stress() const;
  Matrix3 reynolds_stress() const;
  Response respond(const Report& report, const Matrix3& gradient, double dt, const Want& want) const;

  /// Runs `work`; if it throws, the state is put back and the exception goes on.
  template <class Work>
  auto guarded(Work work) {
    before = now;
    try {
      return work();
    } catch (...) {
      std::swap(now, before);
      throw;
    }
  }

  /// Balance after a stretch of steps; throws IncrementFailed on overlap beyond the limit or values not finite.
  Balance checked_balance() const;
  void steer_pace(const Balance& balance);
  double initial_pace() const;

  Report load(const Matrix3& displacement_gradient, double dt);
  Report load(const MixedTarget& target, double dt, Matrix3& gradient);
};

/// Rotation matrix of a rotation vector (rad), by series: no libm in what touches state.
Matrix3 rotation_matrix(const Vector3& rotation_vector);

/// Bytes of a specimen and back; layout of this build.
std::vector<std::byte> to_bytes(const Specimen& specimen);
Specimen from_bytes(std::span<const std::byte> bytes);

}  // namespace rvelab
