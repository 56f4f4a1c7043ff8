// An RVE under test: each call that it refuses must leave it as it was, and every increment must keep what no loading
// may change.
#pragma once

#include <functional>
#include <optional>

#include "rvelab/solver/rve.hpp"
#include "tests/extreme/verdict.hpp"

namespace rvelab::test {

/// Runs a call that must be refused: the refusal, or none if it was carried out. What is no rvelab::Error goes on.
std::optional<Refused> refused(Rve& rve, const std::function<void(Rve&)>& call);

class Tested {
 public:
  Tested(const Specimen& specimen, Verdict& verdict);

  /// Rve::apply. Throws Refused if the RVE refuses. The volume that the increment asks for is noted.
  Response apply(const Matrix3& displacement_gradient, double dt);
  Response apply(const MixedTarget& target, double dt);

  /// The laws of any loading so far: volume = V0 det F (round-off of `increments` products), no grain lost, every place
  /// and stress a number, overlaps within the limit, and |sigma - sigma^T| <= 1.5 unbalanced p + 1e-9 p at dt = 0.
  void check_laws();

  Rve& rve() { return rve_; }
  const Rve& rve() const { return rve_; }
  double pressure() const;

 private:
  template <class Increment>
  Response made(const Increment& increment, double dt);

  Rve rve_;
  Verdict* verdict_;
  double volume_, overlap_limit_;
  std::size_t grains_;
  long increments_ = 0, substeps_ = 0;
  bool quasi_static_ = true;
  Response last_;
};

}  // namespace rvelab::test
