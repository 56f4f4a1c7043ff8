#include "rvelab/solver/batch.hpp"

#include <string>

#include "rvelab/error.hpp"

namespace rvelab {

std::vector<BatchEntry> apply_to_all(std::span<Rve> rves, std::span<const Matrix3> displacement_gradients, double dt,
                                     Workers& workers, const Want& want) {
  if (rves.size() != displacement_gradients.size())
    throw InputError("apply_to_all: " + std::to_string(displacement_gradients.size()) + " displacement gradients for " +
                     std::to_string(rves.size()) + " RVEs; give one for each");
  std::vector<BatchEntry> entries(rves.size());
  workers.run(rves.size(), [&](std::size_t k) {
    try {
      entries[k].response = rves[k].apply(displacement_gradients[k], dt, want);
    } catch (...) {
      entries[k].failure = std::current_exception();
    }
  });
  return entries;
}

}  // namespace rvelab
