// What a run tells of its rocks: columns of history.csv, frames rocks_NNNN.h5 with rocks.xdmf, where each stands at the
// last frame, and their part of a checkpoint.
#pragma once

#include <string>
#include <vector>

#include "tools/mpm/files/hdf5.hpp"
#include "tools/mpm/step/solver.hpp"

namespace mpm {

/// Energies of all rocks, contacts, virials, then the path of each rock with a name of its own.
template <int D>
std::string rock_columns(const Solver<D>& solver);
/// `since`: s, from the row before, of which soil forces are means. before: impulses there, renewed here.
template <int D>
void add_rock_values(const Solver<D>& solver, double since, std::vector<double>& before, std::vector<double>& row);
template <int D>
void write_rock_frame(const Solver<D>& solver, const std::string& path);
void write_rock_xdmf(const std::string& folder, const std::vector<double>& times, std::size_t rocks);
/// rocks_NAME.csv of each [[rocks]], in the form that their key table reads.
template <int D>
void write_rock_tables(const Solver<D>& solver, const std::string& folder);

template <int D>
void write_rocks(const Solver<D>& solver, OutputFile& file);
/// InputError if the checkpoint holds another number of rocks.
template <int D>
void read_rocks(Solver<D>& solver, const InputFile& file, const std::string& folder);

}  // namespace mpm
