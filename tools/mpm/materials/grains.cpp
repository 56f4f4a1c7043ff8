#include "tools/mpm/materials/grains.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <sstream>

#include "rvelab/io/hdf5/file.hpp"

namespace mpm {
namespace {

template <int D>
void to_nine(const Mat<D>& matrix, double* nine) {
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) nine[3 * i + j] = i < D && j < D ? matrix(i, j) : 0;
  }
}

/// Pa, the largest compression along an axis.
template <int D>
double compression_of(const Point<D>& point) {
  return -point.stress.diagonal().minCoeff();
}

template <int D>
Mat<D> from_nine(const double* nine) {
  Mat<D> matrix;
  for (int i = 0; i < D; ++i) {
    for (int j = 0; j < D; ++j) matrix(i, j) = nine[3 * i + j];
  }
  return matrix;
}

}  // namespace

template <int D>
Grains<D>::Grains(std::shared_ptr<GrainPool> pool, std::vector<std::int64_t> ids, bool at_rate, double gather)
    : pool_(std::move(pool)), ids_(std::move(ids)), at_rate_(at_rate), gather_(at_rate ? 0 : gather) {}

template <int D>
void Grains<D>::read_stress(Point<D>* points) {
  double last = -1;
  for (std::size_t k = 0; k < ids_.size(); ++k) {
    const auto info = pool_->info(ids_[k]);
    if (info.p != last) wave_modulus_ = std::max(wave_modulus_, wave_modulus_of(*pool_, ids_[k]));
    last = info.p;
    points[k].stress = from_nine<D>(info.sigma);
    found_.compression = std::max(found_.compression, compression_of<D>(points[k]));
  }
  found_.first = found_.modulus = wave_modulus_;
}

/// The stable step needs the modulus of the stiffest RVE, taken to be the most compressed one. It is measured again
/// once the largest compression has doubled, and every 75,000 increments, which costs 1 % at most. Between, the modulus
/// is scaled by the root of the compression: contacts of Hertz stiffen with its cube root, and new ones add to that
/// (Goddard 1990, Proc. R. Soc. A 430). It never falls below a quarter of the first, so that soil that lands gets no
/// too long step.
template <int D>
void Grains<D>::follow_stiffness(const Point<D>* points, long count) {
  constexpr double between_checks = 75'000, least = 0.25;
  const auto* most = std::max_element(points, points + count, [](const Point<D>& a, const Point<D>& b) {
    return compression_of<D>(a) < compression_of<D>(b);
  });
  const double compression = count > 0 ? compression_of<D>(*most) : 0;
  if (compression > 2 * found_.compression || called - found_.called >= between_checks) {
    const auto id = ids_[std::size_t(most - points)];
    const double now = at_rate_ ? wave_modulus_of(*pool_, id) : measured_modulus_of(*pool_, id, D);
    if (now > 0) found_.modulus = std::max(now, least * found_.first);
    // By a factor of 100 at most: a material in flight, almost without stress, would double it at every step.
    found_.compression = std::max(compression, 0.01 * found_.compression);
    found_.called = called;
  }
  wave_modulus_ = found_.modulus * std::sqrt(std::max(1.0, compression / found_.compression));
}

template <int D>
void Grains<D>::apply_in_parts(Point<D>& point, std::int64_t id, const Mat<D>& gradient, double dt, double scale) {
  ++split;
  double sigma[9], dH[9];
  long parts = long(std::ceil(1 / std::max(scale, 1e-3)));
  for (long done = 0; done < parts;) {
    to_nine<D>(finite_increment<D>(gradient / double(parts)), dH);
    const auto status = rvelab_apply(pool_->get(), id, dH, dt / double(parts), sigma);
    if (status == RVELAB_DISCARD && parts < 100'000) {
      parts *= 4;  // what is done stays done: the parts of the rest become finer
      done *= 4;
      continue;
    }
    if (status < RVELAB_OK) {
      std::ostringstream position;
      position << point.position.transpose();
      throw std::runtime_error(std::string(rvelab_status_name(status)) + ", at the material point at " +
                               position.str() + " m: " + rvelab_last_error());
    }
    ++done;
  }
  point.stress = from_nine<D>(sigma);
}

template <int D>
void Grains<D>::advance(Point<D>* points, long count, double dt, rvelab::Workers&) {
  const auto begin = std::chrono::steady_clock::now();
  gathered_.resize(std::size_t(count), Mat<D>::Zero());
  chosen_.clear();
  batch_ids_.clear();
  dH_.clear();
  for (long k = 0; k < count; ++k) {
    Mat<D>& sum = gathered_[std::size_t(k)];
    sum += points[k].gradient;
    if (sum.cwiseAbs().maxCoeff() < gather_) continue;
    chosen_.push_back(k);
    batch_ids_.push_back(ids_[std::size_t(k)]);
    dH_.resize(9 * chosen_.size());
    to_nine<D>(finite_increment<D>(sum), dH_.data() + dH_.size() - 9);
  }
  const std::size_t n = chosen_.size();
  asked += double(count);
  called += double(n);
  sigma_.resize(9 * n);
  scale_.resize(n);
  status_.resize(n);
  rvelab_batch batch;
  expect_ok(rvelab_batch_init(&batch, sizeof batch));
  batch.n = std::int64_t(n);
  batch.dt = at_rate_ ? dt : 0;
  batch.ids = batch_ids_.data();
  batch.dH = dH_.data();
  batch.sigma = sigma_.data();
  batch.dt_scale = scale_.data();
  batch.status = status_.data();
  const auto worst = n == 0 ? RVELAB_OK : rvelab_trial(pool_->get(), &batch);
  if (worst < RVELAB_DISCARD) expect_ok(worst);
  std::vector<std::int64_t> good;
  good.reserve(n);
  for (std::size_t k = 0; k < n; ++k) {
    if (status_[k] >= RVELAB_OK) good.push_back(batch_ids_[k]);
    warned += status_[k] == RVELAB_W_TOLERANCE || status_[k] == RVELAB_W_NOT_QUASI_STATIC;
  }
  if (!good.empty()) expect_ok(rvelab_commit(pool_->get(), std::int64_t(good.size()), good.data()));
  for (std::size_t k = 0; k < n; ++k) {
    auto& point = points[chosen_[k]];
    Mat<D>& sum = gathered_[std::size_t(chosen_[k])];
    if (status_[k] >= RVELAB_OK) {
      point.stress = from_nine<D>(sigma_.data() + 9 * k);
    } else {
      apply_in_parts(point, batch_ids_[k], sum, batch.dt, scale_[k]);
    }
    sum.setZero();
  }
  follow_stiffness(points, count);
  this->seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

template <int D>
void Grains<D>::run_stages(Point<D>* points, const std::vector<long>& chosen, const std::string& stages) {
  const auto begin = std::chrono::steady_clock::now();
  batch_ids_.clear();
  for (const long k : chosen) batch_ids_.push_back(ids_[std::size_t(k)]);
  sigma_.resize(9 * chosen.size());
  const auto status = rvelab_run_stages(pool_->get(), std::int64_t(chosen.size()), batch_ids_.data(), stages.c_str(),
                                        sigma_.data(), nullptr);
  if (status < RVELAB_OK)
    throw std::runtime_error(std::string(rvelab_status_name(status)) + ": " + rvelab_last_error());
  for (std::size_t k = 0; k < chosen.size(); ++k) points[chosen[k]].stress = from_nine<D>(sigma_.data() + 9 * k);
  // A tangent takes the time of some hundred sub-steps: of points that share a state once, of many of a sample.
  constexpr std::size_t sample = 32;
  const std::size_t stride = std::max<std::size_t>(1, chosen.size() / sample);
  double modulus = 0, last = -1;
  for (std::size_t k = 0; k < chosen.size(); k += stride) {
    const double p = pool_->info(batch_ids_[k]).p;
    if (p != last) modulus = std::max(modulus, wave_modulus_of(*pool_, batch_ids_[k]));
    last = p;
  }
  // Others may be as stiff as they were.
  found_.modulus = chosen.size() == ids_.size() ? modulus : std::max(modulus, found_.modulus);
  found_.first = std::max(found_.first, modulus);
  wave_modulus_ = found_.modulus;
  this->seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

template <int D>
Measures Grains<D>::measures(long point) const {
  const auto info = pool_->info(ids_[std::size_t(point)]);
  return {info.void_ratio, info.fabric_anisotropy, info.coordination_number, NAN};
}

template <int D>
double Grains<D>::grain_steps() const {
  std::vector<std::int64_t> steps(ids_.size());
  expect_ok(rvelab_cost(pool_->get(), std::int64_t(ids_.size()), ids_.data(), steps.data()));
  double sum = earlier_;
  for (const auto each : steps) sum += double(each);
  return sum;
}

template <int D>
void Grains<D>::save(Hdf5File& file, const std::string& name) const {
  file.write<std::int64_t>("/materials/" + name + "/ids", ids_, {ids_.size()});
  file.write<double>(
      "/materials/" + name + "/state",
      std::vector<double>{wave_modulus_, double(split), double(warned), called, asked, found_.first, found_.modulus,
                          found_.compression, found_.called, grain_steps(), double(changes_made)},
      {11});
  std::vector<double> waiting;
  for (const auto& each : gathered_) waiting.insert(waiting.end(), each.data(), each.data() + D * D);
  file.write<double>("/materials/" + name + "/waiting", waiting, {waiting.size()});
}

template <int D>
void Grains<D>::restore(const Hdf5File& file, const std::string& name) {
  ids_ = file.read<std::int64_t>("/materials/" + name + "/ids");
  const auto state = file.read<double>("/materials/" + name + "/state");
  wave_modulus_ = state[0];
  split = long(state[1]);
  warned = long(state[2]);
  called = state[3];
  asked = state[4];
  // The pool counts anew from what it reads.
  earlier_ = 0;
  earlier_ = state[9] - grain_steps();
  found_ = {state[5], state[6], state[7], state[8]};
  changes_made = state.size() > 10 ? long(state[10]) : 0;  // runs of 2.0 had none
  const auto waiting = file.read<double>("/materials/" + name + "/waiting");
  gathered_.clear();
  for (std::size_t k = 0; k + D * D <= waiting.size(); k += D * D) {
    gathered_.push_back(Eigen::Map<const Mat<D>>(waiting.data() + k));
  }
}

template class Grains<2>;
template class Grains<3>;

}  // namespace mpm
