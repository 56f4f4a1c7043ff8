// What a run writes: rows of histories, and frames of points.
#pragma once

#include <cstdint>
#include <cstdio>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "tools/mpm/setup/setup.hpp"
#include "tools/mpm/step/energy.hpp"

namespace mpm {

/// What has been written of a text file: its bytes and their CRC-32C.
struct WrittenRows {
  long bytes = 0;
  std::uint32_t checksum = 0;
};

/// A row of a table: the name of each column and its value.
using Row = std::vector<std::pair<std::string, double>>;
/// Values along the axes, "NAMEx", "NAMEy", ... with the unit behind; a single one is of the last axis.
void add_vector(Row& row, const std::string& name, const std::string& unit, std::span<const double> values);

/// A text file of rows that can go on where a checkpoint left it. Its first line has the names of the columns.
class Rows {
 public:
  /// `keep`: what stays (no bytes: a new file). InputError if the file is shorter, or was changed there: what stands
  /// behind is left by a kill after the checkpoint, and is made again.
  Rows(const std::string& path, const WrittenRows& keep);
  Rows(const Rows&) = delete;
  Rows& operator=(const Rows&) = delete;
  ~Rows();
  /// A value that is not defined (pore_pressure_ratio without effective stress, void_ratio of a continuum: NaN) is an
  /// empty cell. std::runtime_error: any other that is not finite, or the disc is full.
  void add(const Row& row);
  const WrittenRows& written() const { return written_; }

 private:
  void put(const std::string& line);
  std::string path_;
  WrittenRows written_;
  std::FILE* file_;
};

/// Reactions are means over the time since the row before, N, on the body or plane. `before`: impulses at the row
/// before, renewed here.
template <int D>
Row history_row(const Solver<D>& solver, const EnergyStart& start, double since, std::vector<double>& before);
template <int D>
Row watched_row(const Model<D>& model);

/// All points as arrays in points_NNNN.h5, and points.xdmf. `times`: s, of the frames so far, this one too.
template <int D>
void write_frame(const Model<D>& model, const std::string& folder, const std::vector<double>& times);
/// network_K_NNNN.h5 for each watched point K, as GrainPool::write_alone.
template <int D>
void write_networks(const Model<D>& model, const std::string& folder, long frame);
/// scene.toml, whole or not at all, and its checksum in the last line.
void write_scene(const std::string& folder, const std::string& toml);
/// InputError if scene.toml is not as write_scene left it.
void expect_whole_scene(const std::string& folder);

}  // namespace mpm
