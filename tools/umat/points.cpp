#include "tools/umat/points.hpp"

#include <fstream>
#include <stdexcept>

#include "rvelab/io/utf8.hpp"

namespace umat {

namespace {

void expect_done(std::int32_t status) {
  if (status < RVELAB_OK)
    throw std::runtime_error(std::string(rvelab_status_name(status)) + ": " + rvelab_last_error());
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

}  // namespace

Points::Points(const Settings& settings) : settings_(settings) {
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

/// The caller holds population_ alone.
Points::Loaded& Points::loaded(int number) {
  const auto found = templates_.find(number);
  if (found != templates_.end()) return found->second;
  Loaded made;
  std::int64_t id = 0;
  try {
    expect_done(rvelab_template_load(pool_, material(number).specimen.c_str(), &made.number));
    expect_done(rvelab_spawn(pool_, made.number, 1, &id));
    rvelab_info info{};
    expect_done(rvelab_info_init(&info, sizeof info));
    expect_done(rvelab_get_info(pool_, id, &info));
    made.stress = Eigen::Map<const RowMajor3>(info.sigma);
    expect_done(rvelab_release(pool_, 1, &id));
    id = 0;
    return templates_.emplace(number, made).first->second;
  } catch (...) {  // the next call begins anew
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

std::int64_t Points::token_of(std::int64_t id) {
  rvelab_info info{};
  expect_done(rvelab_info_init(&info, sizeof info));
  expect_done(rvelab_get_info(pool_, id, &info));
  return info.token;
}

Start Points::spawn(int number, const PointName& name) {
  const std::unique_lock alone(population_);
  const bool named = name[0] != 0 && name[1] != 0;
  const std::pair key{number, name};
  if (const auto found = first_steps_.find(key); named && found != first_steps_.end()) {
    if (token_of(found->second.id) == found->second.token) return found->second;
    first_steps_.erase(found);  // it has gone on: the host begins anew
  }
  Start start;
  expect_done(rvelab_spawn(pool_, loaded(number).number, 1, &start.id));
  try {
    start.token = token_of(start.id);
    if (named) first_steps_.emplace(key, start);
  } catch (...) {
    rvelab_release(pool_, 1, &start.id);
    throw;
  }
  return start;
}

Start Points::spawn_again(int number, std::int64_t tried) {
  {
    const std::unique_lock alone(population_);
    const auto found = unnamed_.find({number, tried});
    if (found != unnamed_.end()) {
      if (token_of(tried) == found->second.token) return found->second;
      unnamed_.erase(found);  // it has gone on
    }
  }
  const Start start = spawn(number, {});
  const std::unique_lock alone(population_);
  unnamed_.emplace(std::pair{number, start.id}, start);
  return start;
}

Step Points::step(const Start& start, const Matrix3& dH, double dt, bool with_tangent) {
  const std::shared_lock beside_others(population_);
  Step step;
  RowMajor3 sigma;
  RowMajor6 tangent;
  const RowMajor3 gradient = dH;
  rvelab_batch batch = batch_of_one(start.id, gradient, dt, sigma);
  batch.tokens_in = &start.token;
  batch.tokens_out = &step.token;
  batch.dt_scale = &step.dt_scale;
  batch.tangent = with_tangent ? tangent.data() : nullptr;
  step.status = rvelab_trial(pool_, &batch);
  if (step.status != RVELAB_OK) step.text = std::string(rvelab_status_name(step.status)) + ": " + rvelab_last_error();
  if (step.status < RVELAB_OK) return step;
  step.sigma = sigma;
  if (with_tangent) step.tangent = in_order_of_hosts(tangent);
  return step;
}

void log_failure(const std::string& text) {
  static std::mutex mutex;
  static std::set<std::string> written;
  const std::string line = rvelab::io::message_line(text);  // paths and keys may be long, and of any bytes
  const std::lock_guard lock(mutex);
  if (written.size() >= 100 || !written.insert(line).second) return;
  std::ofstream("rvelab_umat.log", std::ios::app) << line << '\n';
}

}  // namespace umat
