// What a run tells of its rocks: columns of history.csv, frames rocks_NNNN.h5 with rocks.xdmf, where each stands at the
// last frame, and their part of a checkpoint.
#pragma once

#include <string>
#include <vector>

#include "tools/mpm/output/archive.hpp"
#include "tools/mpm/output/output.hpp"
#include "tools/mpm/step/solver.hpp"

namespace mpm {

/// Columns of history.csv: energies of all rocks, contacts, virials, then the path of each rock with a name of its own.
/// `since`: s, from the row before, of which soil forces are means. before: impulses there, renewed here.
template <int D>
void add_rock_values(const Solver<D>& solver, double since, std::vector<double>& before, Row& row);
template <int D>
void write_rock_frame(const Solver<D>& solver, const std::string& folder, const std::vector<double>& times);
/// rocks_NAME.csv of each [[rocks]], in the form that their key table reads.
template <int D>
void write_rock_tables(const Solver<D>& solver, const std::string& folder);

/// InputError if the checkpoint that is read holds another number of rocks.
template <int D>
void archive_rocks(Archive& archive, Solver<D>& solver);

}  // namespace mpm
