// Pieces of a study, whole paths, and their measures. Each measure is a number of a test; means over repeats are
// compared, since single paths of dense packings are chaotic.
//
// A new measure is a function in measures.cpp and its line in the table there; tables, files and figures follow.
#pragma once

#include <cstddef>
#include <cstdint>
#include <ctime>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "rvelab/protocol/run.hpp"
#include "rvelab/records/record.hpp"

namespace rvelab::study {

// A piece of a study: what one whole path, or the increments of one grid point on one specimen, gave. Pieces are
// numbers in columns by name, so that whoever keeps them need not know what they mean.

/// A value that could not be found.
inline constexpr double no_value = std::numeric_limits<double>::quiet_NaN();

struct Piece {
  std::map<std::string, std::vector<double>> columns;
  std::string failure;  ///< why something of it could not be carried out, the first reason; empty: all was

  const std::vector<double>& column(const std::string& name) const { return columns.at(name); }
};

// Names of pieces. Point 0 is the reference, grid points count from 1 here; specimens and repeats from 1.
inline std::string path_piece(std::size_t point, std::size_t specimen, std::size_t repeat) {
  return "path_" + std::to_string(point) + "_" + std::to_string(specimen) + "_" + std::to_string(repeat);
}
inline std::string increments_piece(std::size_t point, std::size_t specimen) {
  return "increments_" + std::to_string(point) + "_" + std::to_string(specimen);
}

inline double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

struct Measure {
  std::string name;  ///< ends in its unit
  std::string unit;  ///< "1": none
  std::string meaning;
  double (*of)(const records::TestResult& test, int dimension);  ///< NaN: the test does not give it
};

const std::vector<Measure>& measures();

/// The specimen with every position moved by up to 1e-10 of the grain's radius in each direction of its space: enough
/// for a path of its own, far too little to be another specimen. The first repeat, 1, is the specimen as it is; the
/// same repeat is moved in the same way always.
Specimen perturbed(Specimen specimen, std::uint64_t repeat);

/// What a path gives: each measure by its name, "seconds" of processor time and "grain_steps".
Piece measured_path(const protocol::TestRun& run, double seconds);

/// Runs the path. What cannot be carried out is the piece's failure, and all its measures are NaN; InputError and
/// Interrupted are thrown.
Piece whole_path(const protocol::Protocol& protocol, const Specimen& specimen, const protocol::Watch& watch);

}  // namespace rvelab::study
