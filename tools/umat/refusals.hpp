// Increments that were refused (PNEWDT below 1). A host that does not obey goes on from where the refused increment
// would have ended, with an RVE that has not made it: its next call tells.
#pragma once

#include <map>
#include <mutex>

#include "tools/umat/points.hpp"

namespace umat {

/// Where a call begins, in what the host says of it.
struct Beginning {
  State state;
  Matrix3 F0 = Matrix3::Identity(), F1 = Matrix3::Identity();  ///< unit matrices where the host gives none
  Matrix3 strain = Matrix3::Zero(), strain_increment = Matrix3::Zero();
  double time = 0, dt = 0;  ///< s
};

class Refusals {
 public:
  /// The increment from that beginning was refused.
  void add(const Beginning& refused);

  /// Throws where an increment was refused from the state of `next`, and `next` begins elsewhere: with another DFGRD0;
  /// where that is the unit matrix with other principal values of STRAN; or later.
  void expect_obeyed(const Beginning& next);

  /// A step was made from that state: refusals from another state of its RVE are over.
  void forget_others(const State& from);

 private:
  std::mutex mutex_;
  std::map<std::int64_t, Beginning> refused_;  ///< the last one of each RVE
};

}  // namespace umat
