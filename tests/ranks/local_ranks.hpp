// A pool over ranks of this process, whose messages are answered at once, and batches of it and of a pool in one
// process.
#pragma once

#include <bit>
#include <map>
#include <random>

#include "rvelab/protocol/cementation.hpp"
#include "rvelab/ranks/ranked_pool.hpp"
#include "tests/catch.hpp"
#include "tests/interaction/settings.hpp"
#include "tests/specimens.hpp"

namespace rvelab::test {

using namespace rvelab::ranks;

/// Ranks of this process: each answers at once.
class LocalRanks final : public Link {
 public:
  LocalRanks(int ranks, const pool::Options& options) : answers_(std::size_t(ranks)) {
    for (int rank = 1; rank < ranks; ++rank)
      others_.push_back(std::make_unique<Served>(std::make_unique<pool::ThreadedPool>(options)));
  }
  int ranks() const override { return int(answers_.size()); }
  void send(int rank, std::span<const std::byte> message) override {
    if (Unpacker(message).take<RankCall>() == RankCall::end) return;
    answers_[std::size_t(rank)] = others_[std::size_t(rank) - 1]->answer(message);
  }
  void receive(int rank, Bytes& message) override { message = std::move(answers_[std::size_t(rank)]); }
  void expect_thread() const override {}

 private:
  std::vector<std::unique_ptr<Served>> others_;
  std::vector<Bytes> answers_;
};

inline std::unique_ptr<RankedPool> over(int ranks, const pool::Options& options = {}) {
  return std::make_unique<RankedPool>(std::make_unique<LocalRanks>(ranks, options),
                                      std::make_unique<pool::ThreadedPool>(options));
}

/// Its ids and tokens count, so that they are those of any other such pool, but for the tag.
inline pool::Options one_thread() {
  pool::Options options;
  options.workers = 1;
  options.flags = RVELAB_POOL_COUNTED_IDS;
  return options;
}

inline const Specimen& packed(int side) {
  static std::map<int, Specimen> made;
  if (const auto found = made.find(side); found != made.end()) return found->second;
  Rve rve(disordered(Shape::disc, side, linear_material(2e6, 1e6, 0.4), Law::linear_stiffness, 0.515, 1));
  rve.relax(1e-5, 100'000);
  rve.take_as_reference();
  return made.emplace(side, rve.specimen()).first->second;
}

/// Packed, with a bond at each pair that touches, which break early, and bridges of water.
inline const Specimen& cemented(int side) {
  static std::map<int, Specimen> made;
  if (const auto found = made.find(side); found != made.end()) return found->second;
  Rve rve(packed(side));
  protocol::Cementation cement;
  cement.gap = 0.1;
  cement.young_modulus = 1e6;
  cement.tensile_strength = cement.cohesion = 500;
  cement.strength_scatter = 0.5;
  rve.set_interactions(protocol::cemented(rve, cement));
  Water water;
  water.suction = 10;
  set_settings<CapillaryBridge>(rve, {water});
  rve.relax(1e-5, 100'000);
  REQUIRE(has_any(rve.interactions()));
  return made.emplace(side, rve.specimen()).first->second;
}

/// What a batch led to, all of it.
struct Found {
  pool::Verdict verdict;
  std::vector<double> stress, contact, tangent, estimate, scale;
  std::vector<std::int32_t> status;
  std::vector<std::int64_t> tokens;

  std::vector<std::uint64_t> bits() const {
    std::vector<std::uint64_t> all;
    for (const auto* values : {&stress, &contact, &tangent, &estimate, &scale})
      for (const double value : *values) all.push_back(std::bit_cast<std::uint64_t>(value));
    return all;
  }
  bool operator==(const Found& other) const {
    return verdict.status == other.verdict.status && bits() == other.bits() && status == other.status &&
           tokens == other.tokens;
  }
};

inline Found trial(pool::Pool& pool, const std::vector<std::int64_t>& ids, const std::vector<double>& gradients,
                   const std::vector<std::int64_t>* tokens = nullptr, double dt = 0, bool all = false) {
  const std::size_t n = ids.size();
  Found found;
  found.stress.assign(9 * n, 7);
  found.contact.assign(all ? 9 * n : 0, 7);
  found.tangent.assign(all ? 36 * n : 0, 7);
  found.estimate.assign(n, 7);
  found.scale.assign(n, 7);
  found.status.assign(n, 7);
  found.tokens.assign(n, 7);
  pool::Batch batch;
  batch.n = std::int64_t(n);
  batch.dt = dt;
  batch.ids = ids.data();
  batch.dH = gradients.data();
  batch.tokens_in = tokens == nullptr ? nullptr : tokens->data();
  batch.sigma = found.stress.data();
  batch.contact = all ? found.contact.data() : nullptr;
  batch.tangent = all ? found.tangent.data() : nullptr;
  batch.error_estimate = found.estimate.data();
  batch.dt_scale = found.scale.data();
  batch.status = found.status.data();
  batch.tokens_out = found.tokens.data();
  found.verdict = pool.trial(batch);
  return found;
}

/// Status and text of what is refused; "" for what is not.
template <class Work>
std::string refusal(Work work) {
  try {
    work();
    return {};
  } catch (...) {
    char text[1024];
    const pool::Status status = pool::status_of_exception(text, sizeof text);
    return std::to_string(int(status)) + ": " + text;
  }
}

class Draw {
 public:
  explicit Draw(std::uint64_t seed) : generator_(seed) {}
  double uniform() { return 2 * double(generator_() >> 11) / 9007199254740992.0 - 1; }
  std::size_t below(std::size_t bound) { return std::size_t(generator_() % bound); }
  std::vector<double> gradients(std::size_t n, double size) {
    std::vector<double> all(9 * n, 0.0);
    for (std::size_t k = 0; k < n; ++k)
      for (const std::size_t place : {0, 1, 3, 4}) all[9 * k + place] = size * uniform();
    return all;
  }

 private:
  std::mt19937_64 generator_;
};

inline std::vector<std::int64_t> some(const std::vector<std::int64_t>& of, Draw& draw) {
  std::vector<std::int64_t> chosen;
  for (const std::int64_t each : of)
    if (draw.below(3) > 0) chosen.push_back(each);
  return chosen;
}

}  // namespace rvelab::test
