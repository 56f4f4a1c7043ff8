#include "tools/umat/points.hpp"

#include <random>
#include <stdexcept>

namespace umat {

namespace {

/// Remedy of the user of a host for an error of a trial.
std::string remedy(std::int32_t status) {
  switch (status) {
    case RVELAB_E_ID:
      return "; RVEs live in the process that made them: a restart file of the host or another process (MPI) does not "
             "have them; begin with state variables 0, leave each point in its process, and keep its state variables "
             "unchanged and in double precision";
    case RVELAB_E_STALE:
      return "; the RVE has gone on from that state: another point has the same state variables (a copy: an element "
             "was split, refined or mapped), or the host went back by more than 16 calls; each point needs state "
             "variables of its own, 0 at first";
    case RVELAB_E_FORKED:
      return "; the RVEs stayed in the parent process: let the host start its processes before the first increment";
    default:
      return "";
  }
}

void expect_done(std::int32_t status) {
  if (status < RVELAB_OK)
    throw std::runtime_error(std::string(rvelab_status_name(status)) + ": " + rvelab_last_error() + remedy(status));
}

rvelab_batch batch_of_one(const std::int64_t& id, const RowMajor3& dH, double dt, RowMajor3& sigma) {
  rvelab_batch batch{};
  expect_done(rvelab_batch_init(&batch, sizeof batch));
  batch.n = 1;
  batch.dt = dt;
  batch.ids = &id;
  batch.dH = dH.data();
  batch.sigma = sigma.data();
  return batch;
}

rvelab_info info_of(rvelab_pool* pool, std::int64_t id) {
  rvelab_info info{};
  expect_done(rvelab_info_init(&info, sizeof info));
  expect_done(rvelab_get_info(pool, id, &info));
  return info;
}

/// First increments that can be accepted: some 100 MB. RVEs of as many points take a thousand times that.
constexpr std::int64_t most_tries = 1 << 20;

}  // namespace

Points::Points(const Settings& settings) : settings_(settings) {
  std::random_device random;
  tag_ = std::int64_t(random()) << 20 | (random() >> 12);
  expect_done(rvelab_pool_create(&settings_.pool, &pool_));
}

const Material& Points::material(int number, const char* property) const {
  const auto found = settings_.materials.find(number);
  if (found != settings_.materials.end()) return found->second;
  std::string allowed;
  for (const auto& [known, material] : settings_.materials)
    allowed += (allowed.empty() ? "" : ", ") + std::to_string(known);
  throw std::runtime_error(property + (" is " + std::to_string(number)) + "; " + settings_.path +
                           " has the materials " + allowed +
                           "; correct it, or add [[material]] with number = " + std::to_string(number));
}

/// The caller holds population_ exclusively.
Points::Loaded& Points::loaded(int number) {
  const auto found = templates_.find(number);
  if (found != templates_.end()) return found->second;
  Loaded made;
  std::int64_t id = 0;
  try {
    expect_done(rvelab_template_load(pool_, material(number).specimen.c_str(), &made.number));
    expect_done(rvelab_spawn(pool_, made.number, 1, &id));
    made.stress = Eigen::Map<const RowMajor3>(info_of(pool_, id).sigma);
    expect_done(rvelab_release(pool_, 1, &id));
    id = 0;
    return templates_.emplace(number, made).first->second;
  } catch (...) {  // the next call begins again
    if (id != 0) rvelab_release(pool_, 1, &id);
    if (made.number != 0) rvelab_template_release(pool_, made.number);
    throw;
  }
}

Matrix3 Points::first_stress(int number) {
  const std::unique_lock alone(population_);
  return loaded(number).stress;
}

Matrix6 Points::first_tangent(int number) {
  const std::unique_lock alone(population_);
  Loaded& specimen = loaded(number);
  if (specimen.tangent) return *specimen.tangent;
  std::int64_t id = 0;
  expect_done(rvelab_spawn(pool_, specimen.number, 1, &id));
  RowMajor3 sigma;
  RowMajor6 tangent;
  const RowMajor3 no_increment = RowMajor3::Zero();
  rvelab_batch batch = batch_of_one(id, no_increment, 0, sigma);
  batch.tangent = tangent.data();
  const std::int32_t status = rvelab_trial(pool_, &batch);
  const std::string text = status < RVELAB_OK ? rvelab_last_error() : "";
  rvelab_release(pool_, 1, &id);
  if (status < RVELAB_OK) throw std::runtime_error(std::string(rvelab_status_name(status)) + ": " + text);
  specimen.tangent = in_order_of_hosts(tangent);
  return *specimen.tangent;
}

Matrix3 Points::stress(std::int64_t id) {
  const std::shared_lock beside_others(population_);
  return Eigen::Map<const RowMajor3>(info_of(pool_, id).sigma);
}

State Points::spawn(int number) {
  const std::unique_lock alone(population_);
  State made;
  expect_done(rvelab_spawn(pool_, loaded(number).number, 1, &made.id));
  try {
    made.token = info_of(pool_, made.id).token;
  } catch (...) {
    rvelab_release(pool_, 1, &made.id);
    throw;
  }
  return made;
}

void Points::release(const State& state) noexcept {
  const std::unique_lock alone(population_);
  rvelab_release(pool_, 1, &state.id);
}

/// An RVE in the state of the specimen, for one trial.
struct Points::Borrowed {
  Points& all;
  int material;
  State rve;
  Borrowed(Points& all, int material) : all(all), material(material) {
    {
      const std::lock_guard lock(all.first_);
      std::vector<State>& shared = all.shared_[material];
      if (!shared.empty()) {
        rve = shared.back();
        shared.pop_back();
        return;
      }
    }
    rve = all.spawn(material);
  }
  ~Borrowed() {
    try {
      const std::lock_guard lock(all.first_);
      all.shared_[material].push_back(rve);
    } catch (...) {  // no memory for its name
      all.release(rve);
    }
  }
  Borrowed(const Borrowed&) = delete;
  Borrowed& operator=(const Borrowed&) = delete;
};

Step Points::step(int number, const State& from, const Matrix3& dH, double dt, bool with_tangent) {
  if (from.id < 0) return trial(claimed(from), dH, dt, with_tangent);
  if (from.id > 0) return trial(from, dH, dt, with_tangent);
  const Borrowed borrowed(*this, number);
  Step step = trial(borrowed.rve, dH, dt, with_tangent);
  if (step.status >= RVELAB_OK) step.end = remembered({number, dt, dH, true});
  return step;
}

State Points::remembered(const Try& made) {
  const std::lock_guard lock(first_);
  tries_.push_back(made);
  if (std::int64_t(tries_.size()) > most_tries) {
    tries_.pop_front();
    ++forgotten_;
  }
  return {-(forgotten_ + std::int64_t(tries_.size())), tag_};
}

/// The RVE of a first increment, which is repeated with the same bits.
State Points::claimed(const State& first) {
  Try made;
  {
    const std::lock_guard lock(first_);
    if (const auto found = claimed_.find(first.id); first.token == tag_ && found != claimed_.end())
      return found->second;
    const std::int64_t place = -first.id - 1 - forgotten_;
    if (first.token != tag_ || place >= std::int64_t(tries_.size()))
      throw std::runtime_error("the state variables name a first increment that this process did not make" +
                               remedy(RVELAB_E_ID));
    if (place < 0)
      throw std::runtime_error("the state variables name a first increment that was made more than " +
                               std::to_string(most_tries) +
                               " calls ago; begin that point again, with state variables 0, or use fewer points");
    made = tries_[std::size_t(place)];
  }
  State own = spawn(made.material);
  try {
    if (made.moved) {
      const Step step = trial(own, made.dH, made.dt, false);
      if (step.status < RVELAB_OK) throw std::runtime_error(step.text);
      own = step.end;
    }
    std::unique_lock lock(first_);
    const auto [kept, fresh] = claimed_.emplace(first.id, own);
    if (fresh) return own;
    const State before = kept->second;  // another thread was faster
    lock.unlock();
    release(own);
    return before;
  } catch (...) {
    release(own);
    throw;
  }
}

Step Points::trial(const State& from, const Matrix3& dH, double dt, bool with_tangent) {
  const std::shared_lock beside_others(population_);
  Step step;
  RowMajor3 sigma;
  RowMajor6 tangent;
  const RowMajor3 gradient = dH;
  rvelab_batch batch = batch_of_one(from.id, gradient, dt, sigma);
  batch.tokens_in = &from.token;
  batch.tokens_out = &step.end.token;
  batch.dt_scale = &step.dt_scale;
  batch.tangent = with_tangent ? tangent.data() : nullptr;
  step.status = rvelab_trial(pool_, &batch);
  if (step.status != RVELAB_OK)
    step.text = std::string(rvelab_status_name(step.status)) + ": " + rvelab_last_error() + remedy(step.status);
  if (step.status < RVELAB_OK) return step;
  step.end.id = from.id;
  step.sigma = sigma;
  if (with_tangent) step.tangent = in_order_of_hosts(tangent);
  return step;
}

}  // namespace umat
