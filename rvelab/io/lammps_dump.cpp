#include "rvelab/io/lammps_dump.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <sstream>
#include <vector>

#include "rvelab/error.hpp"

namespace rvelab::io {
namespace {

constexpr const char* first_item = "ITEM: TIMESTEP";

std::vector<std::string> lines_of(const std::string& path) {
  std::ifstream input(path, std::ios::binary);
  std::vector<std::string> lines;
  for (std::string line; std::getline(input, line);) lines.push_back(line);
  return lines;
}

[[noreturn]] void fail(const std::string& path, std::size_t line, const std::string& message) {
  throw InputError(path + ":" + std::to_string(line + 1) + ": " + message);
}

/// The line of an item of the last timestep.
std::size_t item(const std::string& path, const std::vector<std::string>& lines, std::size_t begin,
                 const std::string& start) {
  for (std::size_t k = begin; k < lines.size(); ++k) {
    if (lines[k].starts_with(start)) return k;
  }
  fail(path, begin, "the timestep has no " + start + "; allowed: a whole text dump of LAMMPS; write it again");
}

/// ITEM: BOX BOUNDS [xy xz yz] and three lines "low high [tilt]" of the cuboid around the tilted box.
Matrix3 cell_of(const std::string& path, const std::vector<std::string>& lines, std::size_t at) {
  const std::string& header = lines[at];
  const bool tilted = header.find("xy xz yz") != std::string::npos;
  if (header.find("pp pp pp") == std::string::npos) {
    fail(path, at, header + ": the box is not periodic; allowed: pp pp pp; give a periodic packing");
  }
  double low[3], high[3], tilt[3] = {0, 0, 0};
  for (std::size_t k = 0; k < 3; ++k) {
    std::istringstream numbers(at + 1 + k < lines.size() ? lines[at + 1 + k] : "");
    numbers >> low[k] >> high[k];
    if (tilted) numbers >> tilt[k];
    if (!numbers) {
      fail(path, std::min(at + 1 + k, lines.size() - 1),
           std::string("is no line of box bounds; allowed: ") + (tilted ? "low high tilt" : "low high") +
               "; write the dump again");
    }
  }
  const double xy = tilt[0], xz = tilt[1], yz = tilt[2];
  Matrix3 cell = Matrix3::Zero();
  cell(0, 0) = (high[0] - std::max({0.0, xy, xz, xy + xz})) - (low[0] - std::min({0.0, xy, xz, xy + xz}));
  cell(1, 1) = (high[1] - std::max(0.0, yz)) - (low[1] - std::min(0.0, yz));
  cell(2, 2) = high[2] - low[2];
  cell(0, 1) = xy;
  cell(0, 2) = xz;
  cell(1, 2) = yz;
  return cell;
}

/// Words apart by spaces as cells of a CSV row.
std::string as_row(const std::string& line) {
  std::istringstream words(line);
  std::string row;
  for (std::string word; words >> word;) row += (row.empty() ? "" : ",") + word;
  return row + "\n";
}

}  // namespace

bool is_lammps_dump(const std::string& path) {
  std::ifstream input(path, std::ios::binary);
  std::string line;
  return std::getline(input, line) && line.starts_with(first_item);
}

LammpsDump read_lammps_dump(const std::string& path) {
  const auto lines = lines_of(path);
  std::size_t begin = lines.size();
  while (begin > 0 && !lines[begin - 1].starts_with(first_item)) --begin;
  if (begin == 0) fail(path, 0, "is no text dump of LAMMPS; allowed: ITEM: TIMESTEP first; give a dump");
  const auto box = item(path, lines, begin, "ITEM: BOX BOUNDS"), atoms = item(path, lines, begin, "ITEM: ATOMS");
  LammpsDump dump{3, cell_of(path, lines, box), nullptr};

  std::string text(atoms, '\n');  // so that rows keep the numbers of their lines
  text += as_row(lines[atoms].substr(std::string("ITEM: ATOMS").size()));
  for (std::size_t k = atoms + 1; k < lines.size(); ++k) text += as_row(lines[k]);
  dump.atoms = std::make_unique<CsvTable>(path, text);
  if (dump.atoms->has("z") && dump.atoms->rows() > 0) {
    const auto z = dump.atoms->column({"z"});
    bool flat = true;
    for (std::size_t row = 1; row < dump.atoms->rows(); ++row) {
      flat = flat && dump.atoms->number(row, z) == dump.atoms->number(0, z);
    }
    if (flat) dump.dimension = 2;
  } else if (!dump.atoms->has("z")) {
    dump.dimension = 2;
  }
  if (dump.dimension == 2) dump.cell(0, 2) = dump.cell(1, 2) = 0;
  return dump;
}

}  // namespace rvelab::io
