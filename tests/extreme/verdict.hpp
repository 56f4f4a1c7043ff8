// What one case found: the worst of all that was measured against what is allowed, and what became of it.
//
// Two kinds of criterion. A law (energy, volume, symmetry, an unchanged state) holds whatever the solver says of
// itself. An agreement (with a resolved run, with a theory) may be excused by a flag of the solver where the case
// allows it.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "rvelab/solver/rve.hpp"

namespace rvelab::test {

enum class Outcome {
  right,    ///< did what is asked
  refused,  ///< refused with a remedy and an unchanged state, where that is asked or allowed
  wrong
};

/// "right", "refused", "WRONG".
const char* name(Outcome);

/// What a case came to.
struct Answer {
  Outcome outcome = Outcome::wrong;
  std::string status = "ok";          ///< "ok", the criterion that failed, a refusal's text, "time limit", "signal 11"
  std::optional<double> error;        ///< largest measured value over what is allowed; none: nothing was measured
  std::optional<std::uint64_t> hash;  ///< of the stress after every increment, or of what a case gives
};

/// A call that the RVE refused in an experiment that did not ask for it.
struct Refused {
  std::string text;
  bool unchanged = false;  ///< Rve::save() before and after are the same
};

/// A hash and the next number (FNV-1a, 64 bits).
constexpr std::uint64_t empty_hash = 14695981039346656037u;
std::uint64_t hashed(std::uint64_t hash, std::uint64_t bits);

/// Collects what an experiment measures.
class Verdict {
 public:
  /// A law: 0 <= measured <= allowed. NaN does not hold.
  void law(const std::string& what, double measured, double allowed);
  void law(const std::string& what, bool holds) { law(what, holds ? 0 : 2, 1); }
  /// An agreement, which a flag may excuse.
  void agreement(const std::string& what, double measured, double allowed);
  /// A required refusal: its message, or none if the call was carried out; `unchanged` as in Refused.
  void refusal(const std::string& what, const std::optional<Refused>& found);

  /// Whether the solver says of itself that what it returns is not what was asked for.
  void note(const Report& report) { flagged_ = flagged_ || !report.target_held || !report.in_equilibrium; }
  /// The bits of a number that two builds must agree on are taken into the hash of the answer.
  void bits(std::uint64_t value);
  void bits(const Matrix3& value);

  /// The answer of an experiment that came to its end.
  Answer answer(bool may_flag) const;
  /// The answer of one that a refusal ended.
  Answer answer(const Refused& refused, bool may_refuse) const;

 private:
  struct Worst {
    double error = -1;
    std::string what;
    void take(const std::string& what, double measured, double allowed);
  };
  Worst laws_, agreements_;
  bool flagged_ = false;
  std::string refusal_;
  std::optional<std::uint64_t> hash_;
};

/// Runs a call that must be refused: the refusal, or none if it was carried out. What is no rvelab::Error goes on.
std::optional<Refused> refused(Rve& rve, const std::function<void(Rve&)>& call);

/// An RVE under test: every increment must keep what no loading may change.
class Tested {
 public:
  Tested(const Specimen& specimen, Verdict& verdict);

  /// Rve::apply. Throws Refused if the RVE refuses. The volume that the increment asks for is noted.
  Response apply(const Matrix3& displacement_gradient, double dt);
  Response apply(const MixedTarget& target, double dt);

  /// The laws of any loading so far: volume = V0 det F (round-off of `increments` products), no grain lost, every place
  /// and stress a number, overlaps within the limit, and |sigma - sigma^T| <= 1.5 unbalanced p + 1e-9 p at dt = 0.
  void check_laws();
  /// The net momentum is zero, of sum m |v'|.
  void check_momentum();

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
