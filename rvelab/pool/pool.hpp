// A pool of RVEs: population, trials, states. A host calls it through rvelab/abi; here it has values and exceptions.
//
// Calls that work on RVEs may run at once; each holds its RVEs, and others find these busy. Calls for population and
// files run alone in the pool, or find it busy. All calls throw Refused, add_template and load InputError, apply
// InvalidIncrement and IncrementFailed too; what they change is then as it was.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "rvelab/pool/status.hpp"
#include "rvelab/pool/team.hpp"
#include "rvelab/solver/rve.hpp"

namespace rvelab::pool {

enum class TrialMemory { keep, recompute };

/// Zero: what the specimen says.
struct Options {
  unsigned workers = 0;
  TrialMemory trial_memory = TrialMemory::keep;
  double tolerance_rel = 0, tolerance_abs = 0;
  long max_substeps = 0;
  double damping = 0;
  double min_height = 0;  ///< m
  RunTasks run_tasks = nullptr;
  void* host = nullptr;
};

/// Trials of many RVEs; arrays as in rvelab_batch. Null: not asked for.
struct Batch {
  std::int64_t n = 0;
  double dt = 0;
  const std::int64_t* ids = nullptr;
  const double* displacement_gradients = nullptr;
  const std::int64_t* tokens_in = nullptr;
  double* stress = nullptr;
  double* contact_stress = nullptr;
  double* reynolds_stress = nullptr;
  double* tangent = nullptr;
  double* error_estimate = nullptr;
  double* dt_scale = nullptr;
  std::int32_t* status = nullptr;
  std::int64_t* tokens_out = nullptr;
  const std::int64_t* places = nullptr;  ///< what texts call the entries; null: by their index
};

/// A status with its text, "" for ok.
struct Verdict {
  Status status = Status::ok;
  std::string text;
};

/// Of a committed state; see rvelab_info. Tensors are row-major. It travels as its bytes (calls.hpp).
struct Info {
  std::int64_t dimension = 0;
  std::size_t grains = 0, contacts = 0;
  std::array<double, 9> lattice{}, rotation{};
  double volume = 0, void_ratio = 0, coordination_number = 0;
  std::array<double, 9> fabric{};
  double fabric_anisotropy = 0, sliding_fraction = 0, p = 0, q = 0, unbalanced_force_ratio = 0, inertial_number = 0;
  double permeability_ratio = 0, min_height_ratio = 0;
  std::uint64_t grain_steps = 0;
  Memory memory;
  std::int64_t token = 0;
};

/// All that a pool file keeps beside the states, which go in and out as to_bytes(RveState) makes them.
struct Population {
  std::uint32_t tag = 0;
  std::vector<std::uint32_t> generations;  ///< of each slot
  std::vector<std::int64_t> ids;
};

class Share;
class TravellingCall;

/// Those who implement it decide where the RVEs live. What is declared here they do each in its own way; any other call
/// is a function of Share, which `at` and `everywhere` take to the RVE.
class Pool {
 public:
  using StateOf = std::function<std::vector<std::byte>(std::size_t)>;  ///< of the k-th id of a population
  using TakeState = std::function<void(std::span<const std::byte>)>;

  Pool() = default;
  virtual ~Pool() = default;
  Pool(const Pool&) = delete;
  Pool& operator=(const Pool&) = delete;

  virtual std::int64_t add_template(Specimen specimen) = 0;
  virtual void spawn(std::int64_t of_template, std::int64_t n, std::int64_t* ids) = 0;
  virtual std::int64_t clone(std::int64_t source) = 0;
  virtual void release(std::span<const std::int64_t> ids) = 0;
  virtual std::vector<std::int64_t> ids() = 0;

  /// Trial and commit in one; what to say of it.
  virtual Verdict apply(std::int64_t id, const Matrix3& displacement_gradient, double dt, double* stress) = 0;
  /// The worst status; its text names index and id.
  virtual Verdict trial(const Batch& batch) = 0;
  /// `ids` without data: all that are pending.
  virtual void commit(std::span<const std::int64_t> ids) = 0;
  virtual void revert(std::span<const std::int64_t> ids) = 0;

  virtual void cost(std::span<const std::int64_t> ids, std::int64_t* grain_steps) = 0;

  /// Shows the population, then the bytes of each RVE (to_bytes(RveState)) in the order of its ids.
  virtual void write(const std::function<void(const Population&, const StateOf&)>& writer) = 0;
  /// Takes a population and the bytes of each RVE. The pool must be without RVEs.
  virtual void read(const std::function<Population(const TakeState& take)>& reader) = 0;

  /// Throws Refused (forked) in a child process of the one that made the pool.
  virtual void expect_this_process() const = 0;
  /// The last call before the end: Refused (busy) while another is at work; all later ones are busy.
  virtual void close() = 0;

  /// What `function`(id, arguments...) of the share that holds the RVE returns; the function stands in ShareCalls.
  template <auto function, class... Arguments>
  auto at(std::int64_t id, const Arguments&... arguments);
  /// What `function`(arguments...) of every share returns, the host's own being the last: until then the call can be
  /// made again, and shares where it is made already refuse it with bad_id, which counts as done.
  template <auto function, class... Arguments>
  auto everywhere(const Arguments&... arguments);

 private:
  virtual void make_at(std::int64_t id, TravellingCall& call) = 0;
  virtual void make_everywhere(TravellingCall& call) = 0;
};

}  // namespace rvelab::pool
