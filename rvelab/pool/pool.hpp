// A pool of RVEs: population, trials, states. What a host calls by way of rvelab/abi, as values and exceptions.
//
// Calls that work on RVEs may run at once; each holds the RVEs that it works on, and one that is held is busy to all
// others. Calls for population and files are alone in the pool, or busy. All calls throw Refused, add_template
// and load InputError, apply InvalidIncrement and IncrementFailed too; what they change is then as it was.
#pragma once

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

/// Of a committed state; see rvelab_info.
struct Info {
  Cell cell;
  std::size_t grains = 0, contacts = 0;
  double void_ratio = 0, coordination_number = 0;
  Matrix3 fabric = Matrix3::Zero();
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

/// Where the RVEs live is the matter of those who implement it.
class Pool {
 public:
  using StateOf = std::function<std::vector<std::byte>(std::size_t)>;  ///< of the k-th id of a population
  using TakeState = std::function<void(std::span<const std::byte>)>;

  Pool() = default;
  virtual ~Pool() = default;
  Pool(const Pool&) = delete;
  Pool& operator=(const Pool&) = delete;

  virtual std::int64_t add_template(Specimen specimen) = 0;
  virtual void release_template(std::int64_t of_template) = 0;
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

  virtual Info info(std::int64_t id) = 0;
  virtual void cost(std::span<const std::int64_t> ids, std::int64_t* grain_steps) = 0;

  virtual std::vector<std::byte> save(std::int64_t id) = 0;
  virtual void load(std::int64_t id, std::span<const std::byte> snapshot) = 0;
  /// Shows the population, then the bytes of each RVE (to_bytes(RveState)) in the order of its ids.
  virtual void write(const std::function<void(const Population&, const StateOf&)>& writer) = 0;
  /// Takes a population and the bytes of each RVE. The pool must be without RVEs.
  virtual void read(const std::function<Population(const TakeState& take)>& reader) = 0;

  /// Throws Refused (forked) in a child process of the one that made the pool.
  virtual void expect_this_process() const = 0;
  /// The last call before the end: Refused (busy) while another is at work; all later ones are busy.
  virtual void close() = 0;
};

}  // namespace rvelab::pool
