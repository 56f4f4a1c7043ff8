// Contact of the soil with bodies and rocks. Impulses at points of surfaces that share nodes are found in sweeps
// (projected Gauss-Seidel) over the points of all bodies, then of all rocks, to and fro.
#pragma once

#include <vector>

#include "tools/mpm/bodies/bodies.hpp"
#include "tools/mpm/rocks/rocks.hpp"

namespace mpm {

/// rocks: null where there are none, as for the water.
template <int D>
class SurfaceContact {
 public:
  /// At this time (s): the points that soil touches, and an order in which threads may sweep them.
  void detect(const Grid<D>& grid, const Planes<D>& planes, Bodies<D>& bodies, Rocks<D>* rocks,
              const std::vector<Point<D>>& soil, double time, rvelab::Workers& workers);
  /// Velocities v at the start of the step.
  void hold_start(Grid<D>& grid, Bodies<D>& bodies, Rocks<D>* rocks, double time);
  /// Velocities w at its end; a is still the mapped velocity. May be called again within a step.
  void hold_end(Grid<D>& grid, Bodies<D>& bodies, Rocks<D>* rocks, double time);

 private:
  /// Points [first, last) of one body or rock; those of rocks follow those of bodies.
  struct Run {
    std::size_t first, last;
  };
  void order_runs(const Grid<D>& grid, const Bodies<D>& bodies, const Rocks<D>& rocks);
  void sweep(Grid<D>& grid, Bodies<D>& bodies, Rocks<D>* rocks, double time, bool end);
  /// visit(run) for all points, to or fro; threads share the runs where there are many.
  template <class Visit>
  void each_run(std::size_t points, bool fro, const Visit& visit) {
    if (runs_.empty()) return visit(Run{0, points});
    const std::size_t last = runs_.size() - 1;
    workers_->for_each_after(fro ? fro_ : to_,
                             [&](std::int64_t k) { visit(runs_[fro ? last - std::size_t(k) : std::size_t(k)]); });
  }
  rvelab::Workers* workers_ = nullptr;  ///< those of detect
  /// Of two runs that share a node the later one comes after the other: that is the same as one point after the other,
  /// to the bit. First those that come after none, then those that come after these alone, and so on. None: one run.
  std::vector<Run> runs_;
  rvelab::WorkOrder to_, fro_;   ///< of runs_, and of runs_ from the last to the first
  std::vector<int> visited_by_;  ///< by node: the last run so far
};

}  // namespace mpm
