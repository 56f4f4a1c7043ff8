#include "rvelab/pool/threaded_pool.hpp"

#include <pthread.h>

#include <string>
#include <thread>

#include "rvelab/measure/measures.hpp"

namespace rvelab::pool {

namespace {

/// Forks that lie before this process, counted from where it was loaded.
std::atomic<std::uint64_t> forks{0};

void count_forks() {
  static const int done = pthread_atfork(nullptr, nullptr, [] { ++forks; });
  if (done != 0) throw std::bad_alloc();
}

/// The part of a template's number that counts those of its pool; its number is exact in a double.
constexpr std::int64_t most_templates = 0xffffffff;

/// Owner of a slot whose RVE is being put to rest.
constexpr std::uint64_t resting = 1;

/// Sub-steps of a call after which an RVE rests at once: waking takes the time of three.
constexpr long long_call = 100;

bool is_drawn(const Options& options) { return (options.flags & RVELAB_POOL_COUNTED_IDS) == 0; }

void override_settings(Specimen& specimen, const Options& options) {
  SolverOptions& solver = specimen.solver;
  if (options.tolerance_rel > 0) solver.relative_tolerance = options.tolerance_rel;
  if (options.tolerance_abs > 0) solver.absolute_tolerance = options.tolerance_abs;
  if (options.max_substeps > 0) solver.max_substeps = long(options.max_substeps);
  if (options.min_height > 0) solver.min_height = options.min_height;
  if (options.damping > 0) specimen.damping.local = specimen.damping.local_quasi_static = options.damping;
}

}  // namespace

ThreadedPool::ThreadedPool(const Options& options)
    : options_((expect_options(options), options)),
      team_(options),
      slots_(is_drawn(options)),
      first_token_(is_drawn(options) ? drawn_below(std::int64_t(1) << 52) : 1),
      next_template_(drawn_below(std::int64_t(1) << 21) << 32 | 1) {
  count_forks();
  process_ = forks;
}

ThreadedPool::~ThreadedPool() = default;

void ThreadedPool::serve(std::string_view name, Unpacker& given, Packer& found) {
  NamedCall::serve(name, *this, given, found);
}

void ThreadedPool::expect_this_process() const {
  if (forks != process_)
    throw Refused(Status::forked, "pool: it belongs to the parent of this process; make one of its own here");
}

void ThreadedPool::close() {
  expect_this_process();
  int none = 0;
  if (!calls_.compare_exchange_strong(none, -1))
    throw Refused(Status::busy, "pool_destroy: a call is under way; destroy the pool after it has returned");
}

Hold ThreadedPool::held(std::int64_t id, std::uint64_t call) {
  Slot& slot = slots_.at(id);
  std::uint64_t owner = 0;
  while (!slot.owner.compare_exchange_weak(owner, call, std::memory_order_acquire)) {
    if (owner == call)
      throw Refused(Status::duplicate, "id " + std::to_string(id) + " stands twice in one call; give each RVE once");
    if (owner > resting)
      throw Refused(Status::busy,
                    "id " + std::to_string(id) + ": another call is at work on it; call again when that has returned");
    if (owner == resting) std::this_thread::yield();
    owner = 0;
  }
  return Hold(slot);
}

std::vector<Hold> ThreadedPool::held(std::span<const std::int64_t> ids, std::uint64_t call) {
  std::vector<Hold> holds(ids.size());
  const auto hold = [&](std::size_t k) { holds[k] = held(ids[k], call); };
  if (team_.share_all(ids.size(), hold)) return holds;
  for (Hold& let_go : holds) let_go = Hold();
  for (std::size_t k = 0; k < ids.size(); ++k) hold(k);  // the first that cannot be held is the one that is named
  return holds;
}

/// An RVE that was called stays allocated for the next call, so that steps of a few sub-steps do not pay for waking. It
/// rests at once after a long call, or when it was not called while two rounds of calls went by; after a long trial
/// that left its start to the others of its committed state, when it is committed.
void ThreadedPool::called(Slot& slot, long substeps) noexcept {
  slot.last_call.store(clock_.fetch_add(1, std::memory_order_relaxed), std::memory_order_relaxed);
  slot.resident->called_long = substeps >= long_call;
  slot.allocated.store(true, std::memory_order_relaxed);
  rest_after_long_call(slot);
  rest_another();
}

void ThreadedPool::rest_after_long_call(Slot& slot) noexcept {
  Rve& rve = slot.resident->rve;
  if (!slot.resident->called_long || rve.has_trial_cache() || rve.released()) return;
  rve.release();
  slot.allocated.store(false, std::memory_order_relaxed);
}

/// Each call checks one other RVE: a round of calls checks all.
void ThreadedPool::rest_another() noexcept {
  Slot& slot = slots_[std::size_t(next_release_.fetch_add(1, std::memory_order_relaxed) % slots_.size())];
  const auto forgotten = [&] {
    return slot.allocated.load(std::memory_order_relaxed) &&
           clock_.load(std::memory_order_relaxed) >
               slot.last_call.load(std::memory_order_relaxed) + 2 * slots_.population();
  };
  std::uint64_t none = 0;
  if (!forgotten() || !slot.owner.compare_exchange_strong(none, resting, std::memory_order_acquire)) return;
  if (forgotten()) {
    slot.resident->rve.release();
    slot.allocated.store(false, std::memory_order_relaxed);
  }
  slot.owner.store(0, std::memory_order_release);
}

/// The options of the pool override settings of the specimen.
Resident ThreadedPool::made_template(Specimen& specimen, std::int64_t first_token) const {
  override_settings(specimen, options_);
  Resident made{Rve(specimen), Tokens(first_token)};
  made.rve.watch(&interrupted_);
  made.initial_void_ratio = void_ratio(made.rve.network());
  made.rve.release();
  return made;
}

std::int64_t ThreadedPool::add_template(Specimen specimen) {
  const Alone alone(*this);
  if ((next_template_ & most_templates) == most_templates)
    throw Refused(Status::no_slot, "pool: " + std::to_string(most_templates - 1) +
                                       " templates were made of it, and no number is left; make another pool");
  templates_.emplace(next_template_, made_template(specimen, first_token_));
  return next_template_++;
}

void ThreadedPool::add_template_as(Specimen specimen, std::int64_t number, std::int64_t first_token) {
  const Alone alone(*this);
  templates_.emplace(number, made_template(specimen, first_token));
}

/// Refused (bad_id).
ThreadedPool::Templates::const_iterator ThreadedPool::template_of(std::int64_t number) const {
  const auto found = templates_.find(number);
  if (found != templates_.end()) return found;
  const bool own = number >> 32 == next_template_ >> 32 && (number & most_templates) > 0 && number < next_template_;
  throw Refused(Status::bad_id, "template " + std::to_string(number) +
                                    (own ? ": it was released; "
                                         : ": this pool has none of that number, another pool or process may; ") +
                                    "give one that template_load or template_from_snapshot of this pool returned");
}

void ThreadedPool::release_template(std::int64_t of_template) {
  const Alone alone(*this);
  templates_.erase(template_of(of_template));
}

/// n RVEs of a template. Refused (bad_id, bad_input, no_slot).
Slots::Residents ThreadedPool::made_of(std::int64_t of_template, std::int64_t n) const {
  const Resident& source = template_of(of_template)->second;
  expect_spawn(n);
  Slots::Residents made;
  made.reserve(std::size_t(n));
  while (std::int64_t(made.size()) < n) {
    expect_not_interrupted();
    made.push_back(std::make_unique<Resident>(source));
  }
  return made;
}

void ThreadedPool::spawn(std::int64_t of_template, std::int64_t n, std::int64_t* ids) {
  const Alone alone(*this);
  Slots::Residents made = made_of(of_template, n);
  if (n > 0) slots_.make_room(made.size());
  for (auto& resident : made) *ids++ = slots_.add(std::move(resident));
}

Id ThreadedPool::first_id() {
  const Alone alone(*this);
  slots_.take_tag();
  return slots_.first();
}

void ThreadedPool::spawn_as(std::int64_t of_template, std::span<const std::int64_t> ids) {
  const Alone alone(*this);
  slots_.claim(ids, made_of(of_template, std::int64_t(ids.size())));
}

/// A second RVE in the committed state of the first.
std::unique_ptr<Resident> ThreadedPool::copy_of(std::int64_t source) {
  Resident& original = *slots_.at(source).resident;
  std::unique_ptr<Resident> made;
  {
    const Committed committed(original.rve);
    made =
        std::make_unique<Resident>(Resident{original.rve, original.tokens, original.initial_void_ratio, original.last});
  }
  made->rve.release();
  return made;
}

std::int64_t ThreadedPool::clone(std::int64_t source) {
  const Alone alone(*this);
  std::unique_ptr<Resident> made = copy_of(source);
  slots_.make_room(1);
  return slots_.add(std::move(made));
}

void ThreadedPool::clone_as(std::int64_t source, std::int64_t id) {
  const Alone alone(*this);
  Slots::Residents made;
  made.push_back(copy_of(source));
  slots_.claim({&id, 1}, std::move(made));
}

void ThreadedPool::release(std::span<const std::int64_t> ids) {
  const Alone alone(*this);
  { const auto holds = held(ids, ++serial_); }  // all are there, each once
  for (const std::int64_t id : ids) slots_.remove(id);
}

void ThreadedPool::give_up(std::span<const std::int64_t> ids) {
  const Alone alone(*this);
  for (const std::int64_t id : ids) slots_.at(id);  // all are there
  for (const std::int64_t id : ids) slots_.give_up(id);
}

std::vector<std::int64_t> ThreadedPool::ids() {
  const Alone alone(*this);
  return slots_.all();
}

}  // namespace rvelab::pool
