// A pool in one process: RVEs spread over threads, one RVE a piece of work. By itself, or as the share of one rank in a
// pool over many.
#pragma once

#include <atomic>
#include <map>
#include <memory>

#include "rvelab/pool/calls.hpp"
#include "rvelab/pool/pool.hpp"
#include "rvelab/pool/slots.hpp"

namespace rvelab::pool {

/// What all ranks do or none: commit or revert trials, or end RVEs whose ids the first rank gives out again.
enum class Settling : std::int32_t { commit, revert, give_up };

/// The RVEs of one process: all of a pool, or the share of a rank, where they come and go under ids and numbers of
/// templates that the first rank gives out.
class Share : public Pool {
 public:
  /// Ends a template.
  virtual void release_template(std::int64_t of_template) = 0;
  virtual Info info(std::int64_t id) = 0;
  /// The committed state with its tokens, as to_bytes(RveState), and back.
  virtual std::vector<std::byte> save(std::int64_t id) = 0;
  virtual void load(std::int64_t id, std::span<const std::byte> snapshot) = 0;

  /// Tag of the ids, taken from those of this process if there is none yet.
  virtual std::uint32_t tag() = 0;
  virtual void add_template_as(Specimen specimen, std::int64_t number) = 0;
  /// RVEs of a template under these ids; all or none.
  virtual void spawn_as(std::int64_t of_template, std::span<const std::int64_t> ids) = 0;
  virtual void clone_as(std::int64_t source, std::int64_t id) = 0;
  /// RVEs that come as bytes (to_bytes(RveState)) wait until `place` gives them ids, in their order and all at once.
  /// `pending`: so is the last trial of its tokens, which is made again when it is needed.
  virtual void receive(std::span<const std::byte> state, bool pending) = 0;
  virtual void place(std::span<const std::int64_t> ids) = 0;
  virtual void forget_received() noexcept = 0;
  /// Ends RVEs whose ids the first rank gives out again.
  virtual void give_up(std::span<const std::int64_t> ids) = 0;

  virtual bool is_pending(std::int64_t id) = 0;
  /// Checks that `settle` can be done and brings what it needs. `ids` without data: all with a pending trial. Refused
  /// (no_trial, no_memory): nothing has changed; the text of a commit names the `places` of the ids in what the host
  /// gave.
  virtual void prepare(Settling what, std::span<const std::int64_t> ids, std::span<const std::int64_t> places) = 0;
  /// Does what was prepared last, without a request for memory. No other call may come between.
  virtual void settle() noexcept = 0;
};

/// What hosts and other ranks may call of a share. A new function is added here.
using ShareCalls = CallList<&Share::release_template, &Share::info, &Share::save, &Share::load, &Share::add_template_as,
                            &Share::spawn_as, &Share::clone_as, &Share::place, &Share::forget_received, &Share::give_up,
                            &Share::prepare, &Share::settle>;

template <auto function, class... Arguments>
auto Pool::at(std::int64_t id, const Arguments&... arguments) {
  CallOf<ShareCalls, function> call(id, arguments...);
  make_at(id, call);
  return call.result();
}

template <auto function, class... Arguments>
auto Pool::everywhere(const Arguments&... arguments) {
  CallOf<ShareCalls, function> call(arguments...);
  make_everywhere(call);
  return call.result();
}

class Hold;

class ThreadedPool final : public Share {
 public:
  explicit ThreadedPool(const Options& options);
  ~ThreadedPool() override;

  std::int64_t add_template(Specimen specimen) override;
  void release_template(std::int64_t of_template) override;
  void spawn(std::int64_t of_template, std::int64_t n, std::int64_t* ids) override;
  std::int64_t clone(std::int64_t source) override;
  void release(std::span<const std::int64_t> ids) override;
  std::vector<std::int64_t> ids() override;
  Verdict apply(std::int64_t id, const Matrix3& displacement_gradient, double dt, double* stress) override;
  Verdict trial(const Batch& batch) override;
  void commit(std::span<const std::int64_t> ids) override;
  void revert(std::span<const std::int64_t> ids) override;
  Info info(std::int64_t id) override;
  void cost(std::span<const std::int64_t> ids, std::int64_t* grain_steps) override;
  std::vector<std::byte> save(std::int64_t id) override;
  void load(std::int64_t id, std::span<const std::byte> snapshot) override;
  void write(const std::function<void(const Population&, const StateOf&)>& writer) override;
  void read(const std::function<Population(const TakeState& take)>& reader) override;
  void expect_this_process() const override;
  void close() override;

  std::uint32_t tag() override;
  void add_template_as(Specimen specimen, std::int64_t number) override;
  void spawn_as(std::int64_t of_template, std::span<const std::int64_t> ids) override;
  void clone_as(std::int64_t source, std::int64_t id) override;
  void receive(std::span<const std::byte> state, bool pending) override;
  void place(std::span<const std::int64_t> ids) override;
  void forget_received() noexcept override;
  void give_up(std::span<const std::int64_t> ids) override;
  bool is_pending(std::int64_t id) override;
  void prepare(Settling what, std::span<const std::int64_t> ids, std::span<const std::int64_t> places) override;
  void settle() noexcept override;

 private:
  class AtWork;
  class Alone;
  struct Entry;
  struct Outcome;

  struct Template {
    Rve rve;
    double void_ratio;
  };
  using Templates = std::map<std::int64_t, Template>;  ///< by their numbers, none of which is given out twice

  void make_at(std::int64_t, TravellingCall& call) override { call.make(*this); }
  void make_everywhere(TravellingCall& call) override { call.make(*this); }
  Template made_template(Specimen& specimen) const;
  Templates::const_iterator template_of(std::int64_t number) const;
  Slots::Residents made_of(std::int64_t of_template, std::int64_t n) const;
  std::unique_ptr<Resident> copy_of(std::int64_t source);
  Hold held(std::int64_t id, std::uint64_t call);
  std::vector<Hold> held(std::span<const std::int64_t> ids, std::uint64_t call);
  std::vector<Hold> all_pending(std::uint64_t call);
  void called(Slot& slot, long substeps) noexcept;
  void rest_another() noexcept;
  Outcome attempt(Slot& slot, const Matrix3& displacement_gradient, double dt, const Batch& wanted);
  void accept(Slot& slot, std::int64_t token, const Matrix3& displacement_gradient);
  void run_entry(Entry& entry, const Batch& batch) noexcept;
  void expect_trials(std::span<const Hold> holds, std::span<const std::int64_t> ids,
                     std::span<const std::int64_t> places);

  Options options_;
  Team team_;
  Slots slots_;
  Slots::Residents received_;
  Settling prepared_for_ = Settling::revert;
  std::vector<std::int64_t> prepared_;  ///< ids
  Templates templates_;
  std::int64_t next_template_;            ///< number of this pool in the process << 32, and a count from 1
  std::uint64_t process_;                 ///< forks before this process
  std::atomic<int> calls_{0};             ///< at work; -1: one is alone
  std::atomic<std::uint64_t> serial_{1};  ///< of calls
  std::atomic<std::uint64_t> clock_{0};   ///< calls on RVEs
  std::atomic<std::uint64_t> hand_{0};    ///< of the look for RVEs that are to rest
};

}  // namespace rvelab::pool
