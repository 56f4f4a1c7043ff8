// A pool whose RVEs are spread over ranks. It lives on the first rank, which the host calls; each of the others serves
// its share (serve). Ids and costs are kept here; the rank of an RVE changes neither its id nor a bit of its state.
#pragma once

#include <functional>
#include <mutex>

#include "rvelab/ranks/perform.hpp"

namespace rvelab::ranks {

/// Calls of several threads follow one another; those for population and files are Refused (busy) meanwhile.
class RankedPool final : public pool::Pool {
 public:
  /// `own`: share of the first rank.
  RankedPool(std::unique_ptr<Link> link, std::unique_ptr<pool::Share> own);
  /// Ends the service of the other ranks.
  ~RankedPool() override;

  std::int64_t add_template(Specimen specimen) override;
  void spawn(std::int64_t of_template, std::int64_t n, std::int64_t* ids) override;
  std::int64_t clone(std::int64_t source) override;
  void release(std::span<const std::int64_t> ids) override;
  std::vector<std::int64_t> ids() override;
  pool::Verdict apply(std::int64_t id, const Matrix3& displacement_gradient, double dt, double* stress) override;
  pool::Verdict trial(const pool::Batch& batch) override;
  void commit(std::span<const std::int64_t> ids) override;
  void revert(std::span<const std::int64_t> ids) override;
  void run_each(std::size_t count, const std::function<void(std::size_t)>& piece) override;
  void cost(std::span<const std::int64_t> ids, std::int64_t* grain_steps) override;
  void write(const std::function<void(const pool::Population&, const StateOf&)>& writer) override;
  void read(const std::function<pool::Population(const TakeState& take)>& reader) override;
  void expect_this_process() const override;
  void close() override;
  void interrupt(bool on) noexcept override { own_.share().interrupt(on); }
  const std::atomic<bool>& interrupted() const noexcept override { return own_.share().interrupted(); }

  /// RVEs that have changed their rank so far.
  std::size_t moved() const { return moved_; }

 private:
  struct Place {
    int rank = 0;
    std::uint64_t call = 0;        ///< the last that named it
    std::int64_t cost_before = 0;  ///< grain-steps at the ranks it was at before
    std::int64_t cost = 0;         ///< grain-steps in all, at its last trial
    double expected = 0;           ///< grain-steps of the next call: half the last, a quarter of that before, ...
  };
  /// Messages by rank; empty: none for that rank.
  using Messages = std::vector<Bytes>;
  using Lock = std::unique_lock<std::mutex>;

  void make_at(std::int64_t id, pool::TravellingCall& call) override;
  void make_everywhere(pool::TravellingCall& call) override;
  Lock at_work();
  Lock alone();
  Place& place_of(std::int64_t id) { return places_[ids_.slot_of(id)]; }
  Messages no_messages() const { return Messages(std::size_t(link_->ranks())); }
  using Answers = std::vector<std::pair<int, Answer>>;
  struct Room;
  Answers exchange(const Messages& messages);
  Answers exchange(const Messages& messages, Room room);
  void expect_all_done(const Messages& messages);
  Answer answer_of(int rank, const Bytes& message);
  Answer ask(int rank, const Bytes& message);
  Messages to_others(const Bytes& message) const;
  std::vector<std::int64_t> costs_at(int rank, std::span<const std::int64_t> ids);
  void make_room(std::size_t n);
  std::vector<std::vector<std::size_t>> by_rank(std::span<const std::int64_t> ids);
  Messages to_prepare(pool::Settling what, std::span<const std::int64_t> ids);
  void settle(pool::Settling what, std::span<const std::int64_t> ids);
  void balance(std::span<const std::int64_t> ids);
  void move(int from, int to, std::span<const std::int64_t> ids);
  void worked(Place& place, std::int64_t cost_at_rank) noexcept;

  std::unique_ptr<Link> link_;
  Served own_;
  mutable std::mutex mutex_;
  pool::IdTable ids_;
  std::vector<Place> places_;            ///< by slot
  std::vector<std::size_t> population_;  ///< RVEs by rank
  std::uint64_t call_ = 0;
  std::size_t moved_ = 0;
  bool broken_ = false;  ///< a rank could not be asked: its share is lost
};

/// Service of the other ranks: answers what comes from the first one until the pool ends.
void serve(Link& link, std::unique_ptr<pool::Share> share);

// Which RVEs change their rank so that all ranks have the same work (balance.cpp).

struct Move {
  std::size_t index = 0;  ///< of the RVE in what was given
  int from = 0, to = 0;
};

/// `cost[k]`: expected work of an RVE, grain-steps, at rank `rank[k]` of `ranks`. None if the busiest rank has at most
/// `allowed` (0.1: 10 %) more than the mean. Else from the busiest rank to the idlest, again and again, the RVE that
/// takes most of what they differ by: half of it at most, and not below a hundredth of the mean. Longest processing
/// time first (Graham 1969), but that what is in its place stays.
std::vector<Move> moves_to_balance(std::span<const double> cost, std::span<const int> rank, int ranks, double allowed);

}  // namespace rvelab::ranks
