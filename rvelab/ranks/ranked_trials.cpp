// Trials over ranks, their commitment, and the balance of work. Declared in ranked_pool.hpp.
#include <algorithm>
#include <array>
#include <iterator>
#include <string>
#include <string_view>
#include <utility>

#include "rvelab/ranks/ranked_pool.hpp"

namespace rvelab::ranks {

using pool::Refused;
using pool::Row;
using pool::Status;
using pool::Verdict;

namespace {

/// More work at the busiest rank than this share beyond the mean: RVEs are moved.
constexpr double allowed_imbalance = 0.1;
/// RVEs that move in one message: some 10 MB of them.
constexpr std::size_t moved_at_once = 64;

/// Room for the text of a verdict, asked for before anything is done.
constexpr std::size_t text_room = 2048;

/// A verdict whose text is already there. One that finds no room is cut.
Verdict verdict_of(Status status, std::string_view from, std::string text) {
  return {status, std::move(text.assign(from.substr(0, text.capacity())))};
}

std::string room_for_text() {
  std::string text;
  text.reserve(text_room);
  return text;
}

/// The status of a batch so far: the worst entry, the first of equals. The texts lie in the answers.
struct Worst {
  Status status = Status::ok;
  std::string_view text;
  std::size_t entry = 0;

  void take(Status other, std::string_view of_other, std::size_t at) {
    const int has = severity(status), given = severity(other);
    if (given > has || (given == has && given > 0 && at < entry)) *this = {other, of_other, at};
  }
};

/// What a share found of its entries, and the way of each into the arrays of the host.
struct Results {
  std::string_view text;
  Row<std::int32_t> status;
  Row<std::int64_t> costs, tokens;
  Row<double> values[std::size(pool::batch_outputs)];

  explicit Results(Unpacker& found) : text(found.take_text()), status(found.take_row<std::int32_t>()) {
    costs = found.take_row<std::int64_t>();
    for (auto& row : values) row = found.take_row<double>();
    tokens = found.take_row<std::int64_t>();
  }

  void write(std::size_t k, std::size_t entry, const pool::Batch& to) const {
    const bool made = Status(status[k]) >= Status::ok;
    if (to.status != nullptr) to.status[entry] = status[k];
    for (std::size_t of = 0; of < std::size(values); ++of) {
      const auto [member, each] = pool::batch_outputs[of];
      if (to.*member != nullptr && (made || member == &rvelab_batch::dt_scale))
        values[of].copy(each * k, each, to.*member + each * entry);
    }
    if (made && to.tokens_out != nullptr) to.tokens_out[entry] = tokens[k];
  }
};

/// The trials of a batch for one rank: of the entries `of` of ids.
Bytes trial_message(const pool::Batch& batch, std::span<const std::int64_t> ids, std::span<const std::int64_t> entries,
                    const std::vector<std::size_t>& of) {
  Wanted wanted{0, batch.tokens_in != nullptr, batch.tokens_out != nullptr};
  for (std::size_t k = 0; k < std::size(pool::batch_outputs); ++k)
    if (batch.*pool::batch_outputs[k].values != nullptr) wanted.outputs |= 1u << k;
  std::vector<std::int64_t> own, places, tokens;
  std::vector<double> gradients;
  for (const std::size_t k : of) {
    const auto entry = std::size_t(entries[k]);
    own.push_back(ids[k]);
    places.push_back(entries[k]);
    if (wanted.tokens_in) tokens.push_back(batch.tokens_in[entry]);
    gradients.insert(gradients.end(), batch.dH + 9 * entry, batch.dH + 9 * entry + 9);
  }
  Packer packer = message(RankCall::trial);
  packer.put(batch.dt).put(wanted);
  for (const auto* each : {&own, &places, &tokens}) packer.put_all(std::span<const std::int64_t>(*each));
  return packer.put_all(std::span<const double>(gradients)).take();
}

/// Of an entry whose trial was not made.
void write_failure(const pool::Batch& batch, std::size_t entry, Status status) {
  if (batch.status != nullptr) batch.status[entry] = std::int32_t(status);
  if (batch.dt_scale != nullptr) batch.dt_scale[entry] = 0;
}

}  // namespace

/// An RVE made `cost_at_rank` grain-steps since it came to its rank.
void RankedPool::worked(Place& place, std::int64_t cost_at_rank) noexcept {
  const std::int64_t cost = place.cost_before + cost_at_rank;
  const auto made = double(cost - place.cost);
  place.expected = place.cost == 0 ? made : (place.expected + made) / 2;
  place.cost = cost;
}

Verdict RankedPool::apply(std::int64_t id, const Matrix3& displacement_gradient, double dt, double* stress) {
  const Lock lock = at_work();
  Place& place = place_of(id);
  Packer packer = message(RankCall::apply);
  std::array<double, 9> rows;
  pool::store(displacement_gradient, rows.data());
  packer.put(id).put(dt).put(rows);
  std::string text = room_for_text();
  Answer answer = ask(place.rank, packer.take());
  const auto status = answer.found().take<Status>();
  Verdict verdict = verdict_of(status, answer.found().take_text(), std::move(text));
  worked(place, answer.found().take<std::int64_t>());
  std::ranges::copy(answer.found().take<std::array<double, 9>>(), stress);
  return verdict;
}

Verdict RankedPool::trial(const pool::Batch& batch) {
  const Lock lock = at_work();
  if (is_empty(batch)) return {};
  const auto n = std::size_t(batch.n);
  Worst worst;
  std::string text = room_for_text(), text_of_refused;
  std::vector<std::int64_t> ids, entries;  // those that are ids
  std::vector<std::size_t> refused;
  for (std::size_t k = 0; k < n; ++k) try {
      ids_.slot_of(batch.ids[k]);
      ids.push_back(batch.ids[k]);
      entries.push_back(std::int64_t(k));
    } catch (const Refused& reason) {
      if (refused.empty()) {
        text_of_refused = "entry " + std::to_string(k) + " (id " + std::to_string(batch.ids[k]) + "): " + reason.what();
        worst.take(reason.status, text_of_refused, k);
      }
      refused.push_back(k);
    }
  by_rank(ids);  // refused if one stands twice, before any is moved
  balance(ids);
  const auto indices = by_rank(ids);

  Messages messages = no_messages();
  for (std::size_t rank = 0; rank < messages.size(); ++rank)
    if (!indices[rank].empty()) messages[rank] = trial_message(batch, ids, entries, indices[rank]);
  for (const std::size_t k : refused) write_failure(batch, k, Status::bad_id);
  auto answers = exchange(messages);
  for (auto& [rank, answer] : answers) {
    const std::vector<std::size_t>& of = indices[std::size_t(rank)];
    if (answer.failed()) {  // the share as a whole, for want of memory: none of its trials was made
      for (const std::size_t k : of) {
        const auto entry = std::size_t(entries[k]);
        worst.take(answer.status(), answer.text(), entry);
        write_failure(batch, entry, answer.status());
      }
      continue;
    }
    const Results results(answer.found());
    for (std::size_t k = 0; k < of.size(); ++k) {
      const auto entry = std::size_t(entries[of[k]]);
      results.write(k, entry, batch);
      worked(place_of(ids[of[k]]), results.costs[k]);
      worst.take(Status(results.status[k]), results.text, entry);  // the text is that of the worst of its share
    }
  }
  return verdict_of(worst.status, worst.text, std::move(text));
}

void RankedPool::commit(std::span<const std::int64_t> ids) {
  const Lock lock = at_work();
  settle(pool::Settling::commit, ids);
}

void RankedPool::revert(std::span<const std::int64_t> ids) {
  const Lock lock = at_work();
  settle(pool::Settling::revert, ids);
}

/// Moves RVEs of a batch to other ranks if their work is uneven. One that cannot be moved stays.
void RankedPool::balance(std::span<const std::int64_t> ids) {
  if (link_->ranks() == 1) return;
  std::vector<double> costs;
  std::vector<int> ranks;
  for (const std::int64_t id : ids) {
    costs.push_back(place_of(id).expected);
    ranks.push_back(place_of(id).rank);
  }
  std::map<std::pair<int, int>, std::vector<std::int64_t>> moves;
  for (const Move& each : moves_to_balance(costs, ranks, link_->ranks(), allowed_imbalance))
    moves[{each.from, each.to}].push_back(ids[each.index]);
  for (const auto& [way, moved] : moves)
    for (std::size_t k = 0; k < moved.size(); k += moved_at_once)
      move(way.first, way.second, std::span(moved).subspan(k, std::min(moved_at_once, moved.size() - k)));
}

void RankedPool::move(int from, int to, std::span<const std::int64_t> ids) {
  const Bytes forget = message<&pool::Share::forget_received>(), place = message<&pool::Share::place>(ids),
              give_up = message<&pool::Share::give_up>(ids);
  std::vector<std::int64_t> costs;
  try {
    costs = costs_at(from, ids);
    Answer packed = ask(from, message<&pool::Share::pack>(ids));
    ask(to, message<&pool::Share::receive>(packed.found().take_bytes()));
    ask(to, place);
  } catch (...) {  // no memory there, or here
    if (broken_) throw;
    answer_of(to, forget);
    return;
  }
  if (answer_of(from, give_up).failed()) {  // it stays there alone
    if (answer_of(to, give_up).failed()) broken_ = true;
    return;
  }
  for (std::size_t k = 0; k < ids.size(); ++k) {
    Place& place = place_of(ids[k]);
    place.rank = to;
    place.cost_before += costs[k];
    place.cost = place.cost_before;
    --population_[std::size_t(from)];
    ++population_[std::size_t(to)];
  }
  moved_ += ids.size();
}

}  // namespace rvelab::ranks
