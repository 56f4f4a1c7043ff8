// Errors of single increments: each from a state of the best-resolved path, with the deformation that the path made.
//
// The error of an increment is |sigma - sigma_r|, Frobenius norm, where sigma_r is the reference's answer: the same
// increment from the same state with the reference settings, at dt = 0 then relaxed at fixed cell.
#pragma once

#include <atomic>

#include "rvelab/protocol/protocol.hpp"
#include "rvelab/study/piece.hpp"
#include "rvelab/study/reference_path.hpp"

namespace rvelab::study {

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
  double estimate = 0;               ///< Pa, of the error, as the last call gives it (Report); dt > 0: NaN
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
