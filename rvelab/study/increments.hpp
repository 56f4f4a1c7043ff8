// The best-resolved path: the test once with the reference settings, states of it kept at even distances, each with the
// deformation that the path made from there.
//
// Two runs that differ in one bit differ by per cents of the stress after some strain, so whole paths cannot be
// compared. Increments can: each starts from a state of this path.
#pragma once

#include <atomic>
#include <cstdint>
#include <vector>

#include "rvelab/protocol/protocol.hpp"
#include "rvelab/protocol/run.hpp"
#include "rvelab/study/measures.hpp"

namespace rvelab::study {

/// A state of the path, and what the path did next.
struct PathState {
  Specimen state;
  std::int32_t stage = 0;                           ///< row of the protocol's stages
  double strain = 0;                                ///< the stage's driving strain at the state
  Matrix3 displacement_gradient = Matrix3::Zero();  ///< that the path made from here, over `records` of its records
  double time = 0;                                  ///< s, that it took; 0: quasi-static
  long records = 1;
};

struct ReferencePath {
  protocol::TestRun run;
  std::vector<PathState> states;
};

/// Records of the reference that one increment of the coarsest of the protocols spans, for each stage (1 or more).
std::vector<long> longest_increments(const protocol::Protocol& reference,
                                     const std::vector<protocol::Protocol>& protocols);

/// Increments that a protocol makes while the reference makes `records` of its own in a stage, 1 or more.
long parts_of(const protocol::Protocol& protocol, const protocol::Protocol& reference, std::int32_t stage,
              long records);

/// Runs the path and keeps `count` states of it, or as many as there are; 0: none. `spans`: records from a state to the
/// end of its increment, for each stage. The states do not depend on what watches. Error if the path cannot be run, or
/// has no increment although one is asked for.
ReferencePath reference_path(const protocol::Protocol& protocol, const Specimen& specimen, std::size_t count,
                             const std::vector<long>& spans, protocol::Watch watch);

// Errors of single increments: each from a state of the best-resolved path, with the deformation that the path made.
//
// The error of an increment is |sigma - sigma_r|, Frobenius norm, where sigma_r is the reference's answer: the same
// increment from the same state with the reference settings, in quasi-static loading then relaxed at fixed cell.

/// How far the reference's answers are relaxed.
struct Relaxation {
  double unbalanced = 1e-6;  ///< unbalanced force ratio
  long max_steps = 200'000;  ///< of one answer; one that is not there yet is counted
};

/// What the settings under test are put on: `specimen` as it was given, whose parameters a kept state takes back.
struct Opening {
  const protocol::Protocol& protocol;
  const Specimen& specimen;
  long parts = 1;  ///< increments that the deformation is made in
  const std::atomic<bool>* stop = nullptr;
};

/// One increment from a state.
struct Made {
  Matrix3 stress = Matrix3::Zero();  ///< Cauchy, Pa
  double estimate = 0;               ///< Pa, of the error, as the last call gives it (Report); at a rate: NaN
  double allowed = 0;                ///< Pa, the same of the error that the tolerances allow
  double seconds = 0;                ///< processor time of the calls, opening and relaxation left out
  double grain_steps = 0;            ///< of them
};

/// The reference's answer.
struct Answer {
  Made made;                         ///< as the calls left it
  Matrix3 stress = Matrix3::Zero();  ///< relaxed, Pa
  double pressure = 0;               ///< Pa, |p| of that stress
  double increment = 0;              ///< Pa, norm of the change of stress from the state
  bool at_rest = true;               ///< the relaxation came as far as was asked for
};

/// Opens the state with the settings and makes the increment.
Made made_increment(const PathState& from, const Opening& opening);

Answer reference_answer(const PathState& from, const Opening& opening, const Relaxation& relaxation);

/// Columns of the increments of one grid point on one specimen. NaN: could not be made.
inline const std::vector<std::string> increment_columns{"error_Pa",   "pressure_Pa", "increment_Pa", "estimate_Pa",
                                                        "allowed_Pa", "seconds",     "grain_steps"};

}  // namespace rvelab::study
