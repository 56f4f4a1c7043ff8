// The whole state of a run in files, bitwise: points, reactions and energies in checkpoint.h5, RVEs beside it.
#pragma once

#include "tools/mpm/output/output.hpp"
#include "tools/mpm/step/energy.hpp"
#include "tools/mpm/step/watch.hpp"

namespace mpm {

/// Where the outputs of a run stand.
struct Progress {
  EnergyStart start;
  std::vector<double> impulses;  ///< at the last row of the history
  std::vector<double> frame_times;
  double last_row = 0;
  double next_frame = 0, next_row = 0, next_checkpoint = 0;
  WrittenRows history, watched;
  Watched seen;
};

template <int D>
void write_checkpoint(Model<D>& model, Progress& progress, const std::string& folder);
template <int D>
void read_checkpoint(Model<D>& model, Progress& progress, const std::string& folder);

}  // namespace mpm
