// What interactions form from, given to an RVE.
#pragma once

#include <cstddef>
#include <vector>

#include "rvelab/solver/rve.hpp"
#include "tests/specimens.hpp"

namespace rvelab::test {

/// Gives the specimen what interactions of a law form from; nothing: takes it away, with them.
template <class Law>
void set_settings(Rve& rve, const std::vector<typename Law::Settings>& settings) {
  Interactions all = rve.interactions();
  auto& list = static_cast<ListOf<Law>&>(all);
  list.settings = settings;
  if (settings.empty()) list.items.clear();
  rve.set_interactions(all);
}

/// Where a path ends, over which a copy that is restarted, one that is saved and restored and one that is disturbed by
/// trials and releases have the same bits.
inline Rve after_path_bit_by_bit(const Rve& start, const Matrix3& step, double dt, int steps) {
  INFO("dt " << dt);
  Rve undisturbed(start), restarted(start), saved(start), tried(start);
  for (int k = 0; k < steps; ++k) {
    const Matrix3 sigma = undisturbed.apply(step, dt).stress;
    restarted = Rve(restarted.specimen());
    CHECK(same_bits(restarted.apply(step, dt).stress, sigma));
    const std::vector<std::byte> bytes = saved.save();
    Rve other = start;
    other.restore(bytes);
    saved = other;
    CHECK(same_bits(saved.apply(step, dt).stress, sigma));
    tried.attempt(-0.5 * step, dt);
    tried.revert();
    tried.attempt(0.5 * step, dt);
    tried.exchange();
    tried.exchange();
    if (k % 2 == 0) tried.release();
    CHECK(same_bits(tried.apply(step, dt).stress, sigma));
  }
  CHECK(tried.save() == undisturbed.save());
  return undisturbed;
}

}  // namespace rvelab::test
