// Driving an Rve through one stage: the targets of each increment, and the bookkeeping of a running test. Internal to
// the room.
#pragma once

#include <vector>

#include "rvelab/error.hpp"
#include "rvelab/protocol/run.hpp"
#include "rvelab/solver/rve.hpp"

namespace rvelab::protocol {

/// A stress component that an increment brings to a target. Laboratory frame, Pa, tension positive.
struct HeldStress {
  int i, j;
  double target;
  double scale;  ///< Pa, > 0: what the tolerance is relative to
};

/// Independent components of a symmetric tensor: xx yy xy in 2D, xx yy zz yz xz xy in 3D.
std::vector<std::pair<int, int>> components(int dimension);

/// The mixed target that brings the held components from `stress` to their targets and gives all others the strain of
/// the displacement gradient dH (dimensionless, relative to the start of the increment). The whole skew part is dH's.
MixedTarget mixed_target(const Matrix3& displacement_gradient, const std::vector<HeldStress>& held,
                         const Matrix3& stress, int dimension);

/// A test under way.
class RunningTest {
 public:
  RunningTest(const Protocol& protocol, const Specimen& specimen, const OnRecord& on_record);

  /// Strains and the stage's first p count from here.
  void begin_stage(const Stage& stage);

  /// One increment: held components to their targets, the rest as dH says. Relative tolerance of the held stresses;
  /// dt in s, 0 for quasi-static.
  Report apply(const Matrix3& displacement_gradient, const std::vector<HeldStress>& held, double dt, double tolerance);
  Report relax(double unbalanced, long max_steps);
  void record(double strain, const Report& report);
  void record_now(double strain);  ///< a state that no increment led to

  /// Scale of a held stress: max(|target|, 1 % of the stage's first p). Error if both vanish.
  double held_scale(double target) const;
  /// Time (s) for an increment of the driving strain (dimensionless); 0 when quasi-static.
  double time_for(double strain_increment) const;

  int dimension() const { return rve.cell().dimension; }
  Error failed(const std::string& text) const;  ///< names the stage

  Rve rve;
  const Loading& loading;
  TestRun run;
  Matrix3 deformation = Matrix3::Identity();  ///< F since the start of the stage
  Matrix3 stress;                             ///< Pa, now
  double first_pressure = 0;                  ///< Pa, p at the start of the stage

 private:
  OnRecord on_record_;
  std::string stage_name_;
  double rate_ = 0;
  long substeps_ = 0;  ///< since the last record
};

void drive(RunningTest& test, const IsotropicStage& stage);
void drive(RunningTest& test, const CompressionStage& stage);
void drive(RunningTest& test, const SimpleShearStage& stage);
void drive(RunningTest& test, const RelaxStage& stage);
void drive(RunningTest& test, const ProbeStage& stage);

}  // namespace rvelab::protocol
