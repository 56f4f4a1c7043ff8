// A pool in one process: RVEs spread over threads, one RVE a piece of work. By itself, or as the share of one rank in a
// pool over many.
#pragma once

#include <map>
#include <utility>

#include "rvelab/pool/calls.hpp"
#include "rvelab/pool/mixed.hpp"
#include "rvelab/pool/pool.hpp"
#include "rvelab/pool/slots.hpp"
#include "rvelab/pool/team.hpp"

namespace rvelab::pool {

/// What all ranks do or none: commit or revert trials, or end RVEs whose ids the first rank gives out again.
enum class Settling : std::int32_t { commit, revert, give_up };

/// An RVE that a call is at work on; let go of at the end.
class Hold {
 public:
  Hold() = default;
  explicit Hold(Slot& slot) : slot_(&slot) {}
  Hold(Hold&& other) noexcept : slot_(std::exchange(other.slot_, nullptr)) {}
  Hold& operator=(Hold&& other) noexcept {
    let_go();
    slot_ = std::exchange(other.slot_, nullptr);
    return *this;
  }
  ~Hold() { let_go(); }
  bool empty() const { return slot_ == nullptr; }
  Slot& slot() const { return *slot_; }
  Resident& resident() const { return *slot_->resident; }

 private:
  void let_go() noexcept {
    if (slot_ != nullptr) slot_->owner.store(0, std::memory_order_release);
  }
  Slot* slot_ = nullptr;
};

/// The committed state in the place of a pending trial, for as long as it is read.
class Committed {
 public:
  explicit Committed(Rve& rve) : rve_(rve) { rve.exchange(); }
  ~Committed() { rve_.exchange(); }
  Committed(const Committed&) = delete;
  Committed& operator=(const Committed&) = delete;

 private:
  Rve& rve_;
};

/// The RVEs of one process: all of a pool, or the share of a rank, where they come and go under ids and numbers of
/// templates that the first rank gives out. All that librvelab-mpi.so calls is virtual: the code is in librvelab.so.
class ThreadedPool : public Pool {
 public:
  explicit ThreadedPool(const Options& options);
  ~ThreadedPool() override;

  std::int64_t add_template(Specimen specimen) override;
  void spawn(std::int64_t of_template, std::int64_t n, std::int64_t* ids) override;
  std::int64_t clone(std::int64_t source) override;
  void release(std::span<const std::int64_t> ids) override;
  std::vector<std::int64_t> ids() override;
  Verdict apply(std::int64_t id, const Matrix3& displacement_gradient, double dt, double* stress) override;
  Verdict trial(const Batch& batch) override;
  void commit(std::span<const std::int64_t> ids) override;
  void revert(std::span<const std::int64_t> ids) override;
  void run_each(std::size_t count, const std::function<void(std::size_t)>& piece) override { team_.run(count, piece); }
  void cost(std::span<const std::int64_t> ids, std::int64_t* grain_steps) override;
  void write(const std::function<void(const Population&, const StateOf&)>& writer) override;
  void read(const std::function<Population(const TakeState& take)>& reader) override;
  void expect_this_process() const override;
  void close() override;
  void interrupt(bool on) noexcept override { interrupted_ = on; }
  const std::atomic<bool>& interrupted() const noexcept override { return interrupted_; }

  /// Makes the call of that name (calls.hpp).
  virtual void serve(std::string_view name, Unpacker& given, Packer& found);
  /// read(resident) of an RVE in its committed state, which no other call works on meanwhile.
  template <class Read>
  auto of_committed(std::int64_t id, const Read& read) {
    const AtWork working(*this);
    const Hold hold = held(id, ++serial_);
    const Committed committed(hold.resident().rve);
    return read(std::as_const(hold.resident()));
  }

  /// Ends a template.
  virtual void release_template(std::int64_t of_template);
  rvelab_info info(std::int64_t id);
  /// mixed.hpp.
  MixedDone apply_mixed(std::int64_t id, const MixedSetting& setting, const std::vector<MixedRow>& rows);
  RelaxDone relax(std::int64_t id, double unbalanced, std::int64_t max_substeps);
  /// Of the committed state (arrays.hpp).
  std::vector<std::int64_t> array_rows(std::int64_t id);
  std::vector<std::byte> array(std::int64_t id, std::int64_t k);
  /// The committed state with its tokens, as to_bytes(RveState), and back.
  virtual std::vector<std::byte> save(std::int64_t id);
  void load(std::int64_t id, std::span<const std::byte> snapshot);
  /// The same, where the committed state is still that of `token`: Refused (busy) if another call has changed it since.
  /// `grain_steps` were made to get there.
  void replace(std::int64_t id, std::span<const std::byte> snapshot, std::int64_t token, std::int64_t grain_steps);

  std::vector<std::int64_t> costs(std::span<const std::int64_t> ids) {
    std::vector<std::int64_t> made(ids.size());
    cost(ids, made.data());
    return made;
  }

  /// What ids begin with; the tag is taken from those of this process if there is none yet.
  virtual Id first_id();
  /// Of RVEs that are spawned; that of the first rank on all.
  virtual std::int64_t first_token() const { return first_token_; }
  virtual void add_template_as(Specimen specimen, std::int64_t number, std::int64_t first_token);
  /// RVEs of a template under these ids; all or none.
  virtual void spawn_as(std::int64_t of_template, std::span<const std::int64_t> ids);
  virtual void clone_as(std::int64_t source, std::int64_t id);
  /// RVEs as bytes: of each whether a trial is pending, which is made again when it is needed, and to_bytes(RveState).
  virtual std::vector<std::byte> pack(std::span<const std::int64_t> ids);
  /// Such RVEs wait until `place` gives them ids, in their order and all at once.
  virtual void receive(std::span<const std::byte> packed);
  virtual void place(std::span<const std::int64_t> ids);
  virtual void forget_received() noexcept;
  /// Ends RVEs whose ids the first rank gives out again.
  virtual void give_up(std::span<const std::int64_t> ids);

  /// Checks that `settle` can be done and brings what it needs. `ids` without data: all with a pending trial. Refused
  /// (no_trial, no_memory): nothing has changed; the text of a commit names the `places` of the ids in what the host
  /// gave.
  virtual void prepare(Settling what, std::span<const std::int64_t> ids, std::span<const std::int64_t> places);
  /// Does what was prepared last, without a request for memory. No other call may come between.
  virtual void settle() noexcept;

 private:
  /// A call that works on RVEs, beside others; or one that no other may run beside.
  class AtWork {
   public:
    explicit AtWork(ThreadedPool& pool, bool alone = false) : pool_(pool), alone_(alone) {
      pool.expect_this_process();
      int calls = pool.calls_.load(std::memory_order_relaxed);
      do {
        if (calls < 0)
          throw Refused(Status::busy, "pool: a call for population or files is under way; call again after");
        if (alone && calls > 0)
          throw Refused(Status::busy, "pool: another call is under way; population and files are for one call alone");
      } while (!pool.calls_.compare_exchange_weak(calls, alone ? -1 : calls + 1, std::memory_order_acquire));
    }
    ~AtWork() { pool_.calls_.fetch_add(alone_ ? 1 : -1, std::memory_order_release); }
    AtWork(const AtWork&) = delete;
    AtWork& operator=(const AtWork&) = delete;

   private:
    ThreadedPool& pool_;
    bool alone_;
  };
  struct Alone : AtWork {
    explicit Alone(ThreadedPool& pool) : AtWork(pool, true) {}
  };
  struct Entry;
  struct Outcome;

  using Templates = std::map<std::int64_t, Resident>;  ///< by their numbers, none of which is given out twice

  void make_at(std::int64_t, TravellingCall& call) override { call.make(*this); }
  void make_everywhere(TravellingCall& call) override { call.make(*this); }
  Resident made_template(Specimen& specimen, std::int64_t first_token) const;
  Templates::const_iterator template_of(std::int64_t number) const;
  Slots::Residents made_of(std::int64_t of_template, std::int64_t n) const;
  std::unique_ptr<Resident> copy_of(std::int64_t source);
  Hold held(std::int64_t id, std::uint64_t call);
  std::vector<Hold> held(std::span<const std::int64_t> ids, std::uint64_t call);
  void take_state(const Hold& hold, std::span<const std::byte> snapshot);
  std::vector<Hold> all_pending(std::uint64_t call);
  void called(Slot& slot, long substeps) noexcept;
  void rest_after_long_call(Slot& slot) noexcept;
  void rest_another() noexcept;
  template <class Change>
  std::int64_t go_on(std::int64_t id, const Change& change);
  Outcome attempt(Slot& slot, const Matrix3& displacement_gradient, double dt, bool with_tangent);
  void accept(Slot& slot, std::int64_t token, const Matrix3& displacement_gradient);
  void run_entry(Entry& entry, const Batch& batch) noexcept;
  void expect_trials(std::span<const Hold> holds, std::span<const std::int64_t> ids,
                     std::span<const std::int64_t> places);

  std::unique_ptr<Resident> opened(const RveState& state) const;
  void expect_not_interrupted() const {
    if (interrupted_) throw Interrupted();
  }

  Options options_;
  std::atomic<bool> interrupted_{false};  ///< that every RVE watches
  Team team_;
  Slots slots_;
  Slots::Residents received_;
  Settling prepared_for_ = Settling::revert;
  std::vector<std::int64_t> prepared_;  ///< ids
  Templates templates_;
  std::int64_t first_token_, next_template_;    ///< drawn; the next template: drawn << 32, and a count from 1
  std::uint64_t process_;                       ///< forks before this process
  std::atomic<int> calls_{0};                   ///< at work; -1: one is alone
  std::atomic<std::uint64_t> serial_{1};        ///< of calls
  std::atomic<std::uint64_t> clock_{0};         ///< calls on RVEs
  std::atomic<std::uint64_t> next_release_{0};  ///< the next slot whose memory may be released
};

template <auto function, class... Arguments>
auto Pool::at(std::int64_t id, const Arguments&... arguments) {
  CallOf<function, std::int64_t, Arguments...> call(id, arguments...);
  make_at(id, call);
  return call.result();
}

template <auto function, class... Arguments>
auto Pool::everywhere(const Arguments&... arguments) {
  CallOf<function, Arguments...> call(arguments...);
  make_everywhere(call);
  return call.result();
}

}  // namespace rvelab::pool
