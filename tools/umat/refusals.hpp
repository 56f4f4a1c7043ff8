// Failed increments (PNEWDT below 1). A host that ignores PNEWDT continues from the end of the failed increment, while
// the RVE is still at its start; the next call of the host reveals this.
#pragma once

#include <map>
#include <mutex>

#include "tools/umat/points.hpp"

namespace umat {

/// The start of a call, from the arguments of the host.
struct Beginning {
  State state;
  Matrix3 F0 = Matrix3::Identity(), F1 = Matrix3::Identity();  ///< unit matrices if the host gives none
  Matrix3 strain = Matrix3::Zero(), strain_increment = Matrix3::Zero();
  double time = 0, dt = 0;  ///< s
};

class Refusals {
 public:
  /// The increment from this start has failed.
  void add(const Beginning& refused);

  /// Throws if an increment from the state of `next` has failed and `next` has another start: another DFGRD0; if that
  /// is the unit matrix, other principal values of STRAN; or a later time.
  void expect_obeyed(const Beginning& next);

  /// A step was made from this state: failures from another state of its RVE are removed.
  void forget_others(const State& from);

 private:
  std::mutex mutex_;
  std::map<std::int64_t, Beginning> refused_;  ///< the last one of each RVE
};

}  // namespace umat
