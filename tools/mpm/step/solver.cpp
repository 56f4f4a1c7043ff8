#include "tools/mpm/step/solver.hpp"

#include <algorithm>
#include <cmath>

namespace mpm {

template <int D>
const MaterialGroup<D>& Solver<D>::group_of(long point) const {
  return *std::find_if(groups.begin(), groups.end(),
                       [&](const auto& group) { return point < group.first + group.count; });
}

template <int D>
double Solver<D>::stable_step() const {
  struct Extremes {
    double lightest = 1e300, fastest = 0;
    void add(double density, double square) {
      lightest = std::min(lightest, density);
      fastest = std::max(fastest, square);
    }
  };
  double wave = 0, fastest = 0;
  for (const auto& group : groups) {
    std::vector<Extremes> pieces((group.count + chunk - 1) / chunk);
    workers.for_each(std::int64_t(pieces.size()), [&](std::int64_t piece) {
      Extremes here;  // not in place: neighbours share cache lines
      for (long k = piece * chunk; k < std::min(group.count, long(piece + 1) * chunk); ++k) {
        const auto& point = points[group.first + k];
        here.add(point.mass / point.volume, point.velocity.squaredNorm());
      }
      pieces[piece] = here;
    });
    Extremes all;
    for (const auto& piece : pieces) all.add(piece.lightest, piece.fastest);
    fastest = std::max(fastest, all.fastest);
    if (group.count > 0) wave = std::max(wave, group.material->wave_modulus() / all.lightest);
  }
  // Rocks and plates alone move by no more than a hundredth of a cell a step from rest.
  double pull = std::max(1e-9, options.gravity.norm());
  for (const auto& body : bodies.all) {
    if (body.pressed()) pull = std::max(pull, body.plate->acceleration());
  }
  const double alone = std::sqrt(0.02 * grid.cell.minCoeff() / pull);
  const double dt =
      points.empty() ? alone : options.cfl * grid.cell.minCoeff() / (std::sqrt(wave) + std::sqrt(fastest));
  // A boundary or body faster than any wave must not jump over the soil: a fifth of a cell a step at most.
  double driven = 0;
  for (const double then : {time, time + dt}) {
    each_driven([&](const auto& each) { driven = std::max(driven, each.velocity_at(then).norm()); });
  }
  if (!rocks) return driven > 0 ? std::min(dt, 0.2 * grid.cell.minCoeff() / driven) : dt;
  driven = std::max(driven, rocks->fastest());
  const double until = std::min(dt, options.cfl / std::max(1e-300, rocks->ghost_frequency));
  return driven > 0 ? std::min(until, 0.2 * grid.cell.minCoeff() / driven) : until;
}

#define MPM_INSTANTIATE(D)                                          \
  template const MaterialGroup<D>& Solver<D>::group_of(long) const; \
  template double Solver<D>::stable_step() const;
MPM_INSTANTIATE(2)
MPM_INSTANTIATE(3)
#undef MPM_INSTANTIATE

}  // namespace mpm
