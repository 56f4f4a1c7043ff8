// Trials, their commitment and tokens. Declared in threaded_pool.hpp.
//
// Order of work: the ids of a batch are checked and held first, by the workers where they are many; then each RVE is
// one piece, the costliest of the last call first, taken from one shared count. All pieces are known at the start and
// take ten microseconds or more, so that a count is as good as stealing: the last thread ends at most one piece after
// the first (Graham 1969).
#include <algorithm>
#include <string>

#include "rvelab/measure/tangent.hpp"
#include "rvelab/pool/threaded_pool.hpp"
#include "rvelab/pool/warnings.hpp"

namespace rvelab::pool {

namespace {

constexpr double scale_after_discard = 0.5;

StepFigures figures_of(const Report& report) { return {report.inertial_number, report.error_estimate}; }

/// The trial is made again; it is pending then.
void make_again(Slot& slot, const TrialRecord& record) {
  const Cost cost(slot);
  Resident& resident = *slot.resident;
  const Response response = resident.rve.attempt(record.displacement_gradient, record.dt);
  resident.trial = figures_of(response.report);
}

/// The pending trial of that token is the state. Its RVE holds it.
void commit_trial(Resident& resident, std::int64_t token) noexcept {
  resident.rve.commit();
  resident.last = resident.trial;
  resident.tokens.commit(token);
  resident.pending = false;
}

/// Throws Refused (stale_token). Tokens count up: one that is far from the last, or above it, was never given out here.
void expect_known(const Tokens& tokens, std::int64_t token) {
  if (token == tokens.committed() || tokens.find(token) != nullptr) return;
  constexpr std::int64_t never_counted = std::int64_t(1) << 32;
  const bool own = token > 0 && token < tokens.next() && tokens.next() - token < never_counted;
  throw Refused(Status::stale_token, "token " + std::to_string(token) +
                                         (own ? " names no state of this RVE any more"
                                              : " was made by another pool or process, or for another RVE; hand in the "
                                                "id and the token that the same trial returned") +
                                         "; valid: " + tokens.in_words());
}

std::int64_t last_token(const Tokens& tokens) { return tokens.trial(tokens.trials() - 1).token; }

/// Row-major, xx yy zz yz xz xy whatever the dimension.
using Tangent = std::array<double, 36>;

/// RVELAB_W_TANGENT_AFFINE: a warning that stands already keeps its place, and its text is extended.
void add_affine_warning(Verdict& verdict) {
  const char* const text =
      "the contact network has no elastic tangent that balances its grains; the affine one, which is stiffer, was "
      "written";
  if (verdict.status == Status::ok)
    verdict = {Status::tangent_affine, text};
  else
    verdict.text += std::string("; and ") + text;
}

/// Writes the elastic tangent, or, where the network has none, the affine one and returns false.
bool write_tangent(const Network& network, Tangent& tangent) {
  Eigen::MatrixXd found;
  bool condensed = true;
  try {
    found = elastic_tangent(network);
  } catch (const Interrupted&) {
    throw;
  } catch (const Error&) {
    found = affine_tangent(network);
    condensed = false;
  }
  tangent.fill(0);
  const int plane[3] = {0, 1, 5};
  for (int i = 0; i < found.rows(); ++i)
    for (int j = 0; j < found.cols(); ++j) {
      const int row = found.rows() == 3 ? plane[i] : i, column = found.rows() == 3 ? plane[j] : j;
      tangent[std::size_t(6 * row + column)] = found(i, j);
    }
  return condensed;
}

}  // namespace

struct ThreadedPool::Outcome {
  Response response;
  Tangent tangent;
  std::int64_t token = 0;
  Verdict verdict;
};

struct ThreadedPool::Entry {
  std::size_t index = 0;
  Slot* slot = nullptr;    ///< null: refused, as `verdict` says
  std::uint64_t cost = 0;  ///< grain-steps of the last call
  Verdict verdict;
};

/// Makes a trial from the committed state; it is pending then.
ThreadedPool::Outcome ThreadedPool::attempt(Slot& slot, const Matrix3& displacement_gradient, double dt,
                                            bool with_tangent) {
  Resident& resident = *slot.resident;
  Rve& rve = resident.rve;
  resident.pending = false;
  slot.allocated.store(true, std::memory_order_relaxed);
  const Cost cost(slot);
  Outcome outcome;
  outcome.response = rve.attempt(displacement_gradient, dt);
  try {
    const Report& report = outcome.response.report;
    if (has_warning(report, dt)) outcome.verdict = warning_of(report, dt);
    if (with_tangent && !write_tangent(rve.network(), outcome.tangent)) add_affine_warning(outcome.verdict);
  } catch (...) {
    rve.revert();
    throw;
  }
  outcome.token = resident.tokens.add(displacement_gradient, dt);
  resident.trial = figures_of(outcome.response.report);
  resident.pending = true;
  called(slot, outcome.response.report.substeps);
  return outcome;
}

/// The state that a token names becomes the committed one, for an increment that can be applied to it.
void ThreadedPool::accept(Slot& slot, std::int64_t token, const Matrix3& displacement_gradient) {
  Resident& resident = *slot.resident;
  if (token == resident.tokens.committed()) return;
  split_increment(resident.rve.cell(), displacement_gradient);  // refused before anything is committed
  const TrialRecord* const record = resident.tokens.find(token);
  if (!resident.rve.pending() || last_token(resident.tokens) != token || !resident.pending) {
    resident.pending = false;
    slot.allocated.store(true, std::memory_order_relaxed);
    make_again(slot, *record);
  }
  commit_trial(resident, token);
}

Verdict ThreadedPool::apply(std::int64_t id, const Matrix3& displacement_gradient, double dt, double* stress) {
  const AtWork working(*this);
  expect_time(dt);
  const Hold hold = held(id, ++serial_);
  Outcome outcome = attempt(hold.slot(), displacement_gradient, dt, false);
  commit_trial(hold.resident(), outcome.token);
  rest_after_long_call(hold.slot());
  store(outcome.response.stress, stress);
  return std::move(outcome.verdict);
}

void ThreadedPool::run_entry(Entry& entry, const Batch& batch) noexcept {
  const std::size_t k = entry.index;
  try {
    const Matrix3 gradient = tensor_at(batch.dH + 9 * k);
    if (batch.tokens_in != nullptr) accept(*entry.slot, batch.tokens_in[k], gradient);
    Outcome outcome = attempt(*entry.slot, gradient, batch.dt, batch.tangent != nullptr);
    if (options_.trial_memory == RVELAB_TRIAL_RECOMPUTE) entry.slot->resident->rve.revert();
    const Response& response = outcome.response;
    store(response.stress, batch.sigma + 9 * k);
    if (batch.contact != nullptr) store(response.contact_stress, batch.contact + 9 * k);
    if (batch.reynolds != nullptr) store(response.reynolds_stress, batch.reynolds + 9 * k);
    if (batch.tangent != nullptr) std::copy(outcome.tangent.begin(), outcome.tangent.end(), batch.tangent + 36 * k);
    if (batch.error_estimate != nullptr) batch.error_estimate[k] = response.report.error_estimate;
    if (batch.tokens_out != nullptr) batch.tokens_out[k] = outcome.token;
    entry.verdict = std::move(outcome.verdict);
  } catch (...) {
    entry.verdict = verdict_of_failure();
  }
}

Verdict ThreadedPool::trial(const Batch& batch) {
  const AtWork working(*this);
  if (is_empty(batch)) return {};
  const auto n = std::size_t(batch.n);
  const std::uint64_t call = ++serial_;
  std::vector<Hold> holds(n);
  std::vector<Entry> entries(n);
  const auto hold = [&](std::size_t k) {
    holds[k] = held(batch.ids[k], call);  // to the end of the call, so that the same id again is a duplicate
    const Tokens& tokens = holds[k].resident().tokens;
    if (batch.tokens_in != nullptr) expect_known(tokens, batch.tokens_in[k]);
    entries[k] = {k, &holds[k].slot(), holds[k].slot().last_grain_steps, {}};
  };
  if (!team_.share_all(n, hold)) {  // one by one then: the same entry is refused on any number of threads
    for (Hold& let_go : holds) let_go = Hold();
    for (std::size_t k = 0; k < n; ++k) {
      entries[k] = {};
      try {
        hold(k);
      } catch (const Refused& refused) {
        if (refused.status == Status::duplicate) throw;
        entries[k].verdict = verdict_of_failure();
      }
    }
  }
  std::vector<Entry*> order;
  order.reserve(n);
  for (Entry& entry : entries)
    if (entry.slot != nullptr) order.push_back(&entry);
  std::stable_sort(order.begin(), order.end(), [](const Entry* a, const Entry* b) { return a->cost > b->cost; });
  if (!order.empty()) team_.run(order.size(), [&](std::size_t k) { run_entry(*order[k], batch); });

  std::size_t worst = 0;
  for (std::size_t k = 0; k < n; ++k) {
    const Status status = entries[k].verdict.status;
    if (batch.status != nullptr) batch.status[k] = std::int32_t(status);
    if (batch.dt_scale != nullptr)
      batch.dt_scale[k] = is_error(status) ? 0 : status == Status::discard ? scale_after_discard : 1;
    if (severity(status) > severity(entries[worst].verdict.status)) worst = k;
  }
  return of_entry(std::move(entries[worst].verdict),
                  batch.places != nullptr ? batch.places[worst] : std::int64_t(worst), batch.ids[worst]);
}

std::vector<Hold> ThreadedPool::all_pending(std::uint64_t call) {
  std::vector<Hold> holds = held(slots_.all(), call);
  team_.share(holds.size(), [&](std::size_t k) {
    if (!holds[k].resident().pending) holds[k] = Hold();
  });
  std::erase_if(holds, [](const Hold& hold) { return hold.empty(); });
  return holds;
}

/// The trial of each is pending and its state at hand, or Refused and nothing has changed. `places`: what the text
/// calls the ids; without: by their index.
void ThreadedPool::expect_trials(std::span<const Hold> holds, std::span<const std::int64_t> ids,
                                 std::span<const std::int64_t> places) {
  enum Pending : char { none, let_go, at_hand };
  std::vector<Pending> found(holds.size());
  team_.share(holds.size(), [&](std::size_t k) {
    const Resident& resident = holds[k].resident();
    found[k] = !resident.pending ? none : resident.rve.pending() ? at_hand : let_go;
  });
  for (std::size_t k = 0; k < holds.size(); ++k)
    if (found[k] == none)
      throw Refused(Status::no_trial, "commit: entry " + std::to_string(places.empty() ? std::int64_t(k) : places[k]) +
                                          " (id " + std::to_string(ids[k]) +
                                          ") has no pending trial; nothing was committed. Make a trial first");
  std::vector<Slot*> again;
  for (std::size_t k = 0; k < holds.size(); ++k)
    if (found[k] == let_go) again.push_back(&holds[k].slot());
  if (again.empty()) return;
  std::vector<Verdict> verdicts(again.size());
  team_.run(again.size(), [&](std::size_t k) {
    try {
      const Tokens& tokens = again[k]->resident->tokens;
      make_again(*again[k], tokens.trial(tokens.trials() - 1));
    } catch (...) {
      verdicts[k] = verdict_of_failure();
    }
  });
  for (const Verdict& verdict : verdicts) {
    if (verdict.status == Status::ok) continue;
    for (Slot* slot : again) slot->resident->rve.revert();
    throw Refused(verdict.status, "commit: " + verdict.text);
  }
}

void ThreadedPool::commit(std::span<const std::int64_t> ids) {
  const AtWork working(*this);
  const std::uint64_t call = ++serial_;
  const std::vector<Hold> holds = ids.data() == nullptr ? all_pending(call) : held(ids, call);
  expect_trials(holds, ids, {});
  team_.share(holds.size(), [&](std::size_t k) {
    Resident& resident = holds[k].resident();
    commit_trial(resident, last_token(resident.tokens));
    rest_after_long_call(holds[k].slot());
  });
}

void ThreadedPool::prepare(Settling what, std::span<const std::int64_t> ids, std::span<const std::int64_t> places) {
  const AtWork working(*this);
  const std::uint64_t call = ++serial_;
  prepared_for_ = what;
  prepared_.assign(ids.begin(), ids.end());
  const std::vector<Hold> holds = ids.data() == nullptr ? all_pending(call) : held(ids, call);
  if (ids.data() == nullptr)
    for (std::size_t k = 0; k < slots_.size(); ++k)
      if (slots_[k].resident && slots_[k].resident->pending) prepared_.push_back(slots_.id_of(k));
  if (what == Settling::commit) expect_trials(holds, prepared_, places);
}

void ThreadedPool::settle() noexcept {
  if (prepared_for_ == Settling::give_up)
    for (const std::int64_t id : prepared_) slots_.give_up(id);
  else
    team_.share(prepared_.size(), [this](std::size_t k) {
      Slot& slot = slots_[Id::of(prepared_[k]).slot];
      Resident& resident = *slot.resident;
      if (prepared_for_ == Settling::commit) {
        commit_trial(resident, last_token(resident.tokens));
        return rest_after_long_call(slot);
      }
      resident.rve.revert();
      resident.pending = false;
    });
  prepared_.clear();
}

void ThreadedPool::revert(std::span<const std::int64_t> ids) {
  const AtWork working(*this);
  const std::uint64_t call = ++serial_;
  for (const Hold& hold : ids.data() == nullptr ? all_pending(call) : held(ids, call)) {
    hold.resident().rve.revert();
    hold.resident().pending = false;
  }
}

}  // namespace rvelab::pool
