// A pool of RVEs: population, trials, states. What a host calls by way of rvelab/abi, as values and exceptions.
//
// Calls that work on RVEs may run at once; each holds the RVEs that it works on, and one that is held is busy to all
// others. Calls for population and files are alone in the pool, or busy. All calls throw Refused; what they change is
// then as it was.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "rvelab/pool/rve_state.hpp"
#include "rvelab/pool/slots.hpp"
#include "rvelab/pool/status.hpp"
#include "rvelab/pool/team.hpp"

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

/// All that a pool file keeps. The specimen of a resident goes in and out as to_bytes(RveState) makes it.
struct Population {
  std::uint32_t tag = 0;
  std::vector<std::uint32_t> generations;  ///< of each slot
  std::vector<std::int64_t> ids;
};

class Hold;

class Pool {
 public:
  explicit Pool(const Options& options);
  ~Pool();
  Pool(const Pool&) = delete;
  Pool& operator=(const Pool&) = delete;

  std::int64_t add_template(Specimen specimen);
  void spawn(std::int64_t of_template, std::int64_t n, std::int64_t* ids);
  std::int64_t clone(std::int64_t source);
  void release(std::span<const std::int64_t> ids);
  std::vector<std::int64_t> ids();

  /// Trial and commit in one; what to say of it.
  Verdict apply(std::int64_t id, const Matrix3& displacement_gradient, double dt, double* stress);
  /// The worst status; its text names index and id.
  Verdict trial(const Batch& batch);
  /// `ids` without data: all that are pending.
  void commit(std::span<const std::int64_t> ids);
  void revert(std::span<const std::int64_t> ids);

  Info info(std::int64_t id);
  void cost(std::span<const std::int64_t> ids, std::int64_t* grain_steps);

  std::vector<std::byte> save(std::int64_t id);
  void load(std::int64_t id, std::span<const std::byte> snapshot);
  /// Shows the population, then the bytes of each RVE (to_bytes(RveState)) in the order of its ids.
  void write(
      const std::function<void(const Population&, const std::function<std::vector<std::byte>(std::size_t)>&)>& writer);
  /// Takes a population and the bytes of each RVE. The pool must be without RVEs.
  void read(const std::function<Population(const std::function<void(std::span<const std::byte>)>& take)>& reader);

  /// Throws Refused (forked) in a child process of the one that made the pool.
  void expect_this_process() const;
  /// The last call before the end: Refused (busy) while another is at work; all later ones are busy.
  void close();

 private:
  class AtWork;
  class Alone;
  struct Entry;
  struct Outcome;

  Hold held(std::int64_t id, std::uint64_t call);
  std::vector<Hold> held(std::span<const std::int64_t> ids, std::uint64_t call);
  std::vector<Hold> all_pending(std::uint64_t call);
  void called(Slot& slot, std::uint64_t grain_steps, long substeps) noexcept;
  void rest_another() noexcept;
  Outcome attempt(Slot& slot, const Matrix3& displacement_gradient, double dt, const Batch& wanted);
  void accept(Slot& slot, std::int64_t token, const Matrix3& displacement_gradient);
  void run_entry(Entry& entry, const Batch& batch) noexcept;

  struct Template {
    Rve rve;
    double void_ratio;
  };

  Options options_;
  Team team_;
  Slots slots_;
  std::vector<std::unique_ptr<Template>> templates_;
  std::uint32_t number_;                  ///< of this pool in the process, for its templates
  std::uint64_t process_;                 ///< forks before this process
  std::atomic<int> calls_{0};             ///< at work; -1: one is alone
  std::atomic<std::uint64_t> serial_{1};  ///< of calls
  std::atomic<std::uint64_t> clock_{0};   ///< calls on RVEs
  std::atomic<std::uint64_t> hand_{0};    ///< of the look for RVEs that are to rest
};

}  // namespace rvelab::pool
