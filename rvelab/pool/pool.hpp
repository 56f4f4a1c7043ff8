// A pool of RVEs: population, trials, states. A host calls it through rvelab/abi; here it has values and exceptions.
//
// Calls that work on RVEs may run at once; each holds its RVEs, and others find these busy. Calls for population and
// files run alone in the pool, or find it busy. All calls throw Refused, add_template and load InputError, apply
// InvalidIncrement and IncrementFailed too; what they change is then as it was.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "rvelab/pool/status.hpp"
#include "rvelab/solver/rve.hpp"

namespace rvelab::pool {

struct Options : rvelab_pool_def {
  Options(const rvelab_pool_def& def = {}) : rvelab_pool_def(def) {}
};

/// Trials of many RVEs.
struct Batch : rvelab_batch {
  Batch(const rvelab_batch& batch = {}) : rvelab_batch(batch) {}
  const std::int64_t* places = nullptr;  ///< what texts call the entries; null: by their index
};

/// The results of a batch that are numbers, and how many of each an RVE has.
struct BatchOutput {
  double* rvelab_batch::*values;
  std::size_t each;
};
inline constexpr BatchOutput batch_outputs[] = {{&rvelab_batch::sigma, 9},          {&rvelab_batch::contact, 9},
                                                {&rvelab_batch::reynolds, 9},       {&rvelab_batch::tangent, 36},
                                                {&rvelab_batch::error_estimate, 1}, {&rvelab_batch::dt_scale, 1}};

/// A tensor as the interface has it.
using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
inline void store(const Matrix3& tensor, double* to) { Eigen::Map<RowMajor>(to, 3, 3) = tensor; }
inline Matrix3 tensor_at(const double* from) { return Eigen::Map<const RowMajor>(from); }

/// All that a pool file keeps beside the states, which go in and out as to_bytes(RveState) makes them.
struct Population {
  std::uint32_t tag = 0;
  std::vector<std::uint32_t> generations;  ///< of each slot
  std::vector<std::int64_t> ids;
};

class TravellingCall;

/// Those who implement it decide where the RVEs live. What is declared here they do each in its own way; any other call
/// is a function of Share (calls.hpp), which `at` and `everywhere` take to the RVE.
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

  /// Trial and commit in one. Writes the Cauchy stress (9 doubles, row-major, Pa) to `stress`; returns status and text.
  virtual Verdict apply(std::int64_t id, const Matrix3& displacement_gradient, double dt, double* stress) = 0;
  /// The worst status; its text names index and id.
  virtual Verdict trial(const Batch& batch) = 0;
  /// `ids` without data: all that are pending.
  virtual void commit(std::span<const std::int64_t> ids) = 0;
  virtual void revert(std::span<const std::int64_t> ids) = 0;

  /// piece(k) for k below count, each once, on the threads of this process that there are. `piece` must not throw.
  virtual void run_each(std::size_t count, const std::function<void(std::size_t)>& piece) = 0;

  virtual void cost(std::span<const std::int64_t> ids, std::int64_t* grain_steps) = 0;

  /// Shows the population, then the bytes of each RVE (to_bytes(RveState)) in the order of its ids.
  virtual void write(const std::function<void(const Population&, const StateOf&)>& writer) = 0;
  /// Takes a population and the bytes of each RVE. The pool must be without RVEs.
  virtual void read(const std::function<Population(const TakeState& take)>& reader) = 0;

  /// Throws Refused (forked) in a child process of the one that made the pool.
  virtual void expect_this_process() const = 0;
  /// The last call before the end: Refused (busy) while another is at work; all later ones are busy.
  virtual void close() = 0;
  /// True: the sub-steps of this process end with Interrupted, until it is false again. For signal handlers too.
  virtual void interrupt(bool on) noexcept = 0;
  virtual const std::atomic<bool>& interrupted() const noexcept = 0;

  /// What `function`(id, arguments...) of the share that holds the RVE returns.
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

// What every kind of pool refuses.

/// Throws Refused (bad_input, unsupported).
void expect_options(const Options& options);
/// Whether a batch has no entries. Throws Refused (bad_input), InvalidIncrement.
bool is_empty(const Batch& batch);
/// Throws Refused (bad_input, no_slot) unless n RVEs can be asked for.
void expect_spawn(std::int64_t n);
/// Throws Refused (bad_file) unless ids, generations and tag belong together, for that many states.
void expect_whole(const Population& population, std::size_t states);
/// Throws Refused (bad_input) if the pool that is to take a file has RVEs.
void expect_empty(std::size_t population);

}  // namespace rvelab::pool
