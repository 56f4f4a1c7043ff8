// Dumps of LAMMPS (and OVITO): the cell, and the atoms as a table. Declared in inputs.hpp.
#include "rvelab/io/import/inputs.hpp"

#include <algorithm>
#include <charconv>
#include <iterator>
#include <sstream>
#include <vector>

#include "rvelab/error.hpp"
#include "rvelab/io/publish.hpp"

namespace rvelab::io {
namespace {

constexpr const char* first_item = "ITEM: TIMESTEP";

std::vector<std::string> lines_of(const std::string& text) {
  std::istringstream input(text);
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

struct Box {
  Matrix3 cell;  ///< m, vectors as columns
  Vector3 low;   ///< m, its corner
};

/// ITEM: BOX BOUNDS [xy xz yz] and three lines "low high [tilt]" of the cuboid around the tilted box.
Box box_of(const std::string& path, const std::vector<std::string>& lines, std::size_t at) {
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
  low[0] -= std::min({0.0, xy, xz, xy + xz});
  low[1] -= std::min(0.0, yz);
  cell(0, 0) = (high[0] - std::max({0.0, xy, xz, xy + xz})) - low[0];
  cell(1, 1) = (high[1] - std::max(0.0, yz)) - low[1];
  cell(2, 2) = high[2] - low[2];
  cell(0, 1) = xy;
  cell(0, 2) = xz;
  cell(1, 2) = yz;
  return {cell, Vector3(low[0], low[1], low[2])};
}

std::vector<std::string> words_of(const std::string& line) {
  std::istringstream input(line);
  return {std::istream_iterator<std::string>(input), {}};
}

std::string as_row(const std::vector<std::string>& words) {
  std::string row;
  for (const auto& word : words) row += (row.empty() ? "" : ",") + word;
  return row + "\n";
}

/// What dumps write besides x, y, z and radius: xu (not wrapped into the box, as any position may be), xs and xsu (in
/// parts of the box), diameter. The header gets the usual names, and rows the usual numbers.
class Columns {
 public:
  Columns(std::vector<std::string>& header, const Box& box) : box_(box) {
    const auto find = [&](const std::string& name) {
      const auto at = std::find(header.begin(), header.end(), name);
      return at == header.end() ? -1 : int(at - header.begin());
    };
    if (find("radius") < 0 && find("diameter") >= 0) header[std::size_t(diameter_ = find("diameter"))] = "radius";
    for (int k = 0; k < 3; ++k) {
      const std::string axis(1, "xyz"[k]);
      if (find(axis) >= 0) continue;
      if (const int at = find(axis + "u"); at >= 0) {
        header[std::size_t(at)] = axis;
        continue;
      }
      scaled_[k] = std::max(find(axis + "s"), find(axis + "su"));
      if (scaled_[k] >= 0) header[std::size_t(scaled_[k])] = axis;
    }
  }

  /// Whether some are in parts of the box and others are not.
  bool mixed(const std::vector<std::string>& header) const {
    int in_parts = 0, axes = 0;
    for (int k = 0; k < 3; ++k) {
      in_parts += scaled_[k] >= 0;
      axes += int(std::count(header.begin(), header.end(), std::string(1, "xyz"[k])));
    }
    return in_parts > 0 && in_parts != axes;
  }

  void convert(std::vector<std::string>& row) const {
    double value = 0;
    if (number(row, diameter_, value)) row[std::size_t(diameter_)] = exact(value / 2);
    Vector3 parts = Vector3::Zero();
    for (int k = 0; k < 3; ++k) {
      // What is no number stays as it is, and the table tells it with its place.
      if (scaled_[k] >= 0 && !number(row, scaled_[k], parts[k])) return;
    }
    const Vector3 position = box_.low + box_.cell * parts;
    for (int k = 0; k < 3; ++k) {
      if (scaled_[k] >= 0) row[std::size_t(scaled_[k])] = exact(position[k]);
    }
  }

 private:
  static bool number(const std::vector<std::string>& row, int at, double& value) {
    if (at < 0 || std::size_t(at) >= row.size()) return false;
    const std::string& word = row[std::size_t(at)];
    const char *begin = word.data() + (word.starts_with('+') ? 1 : 0), *end = word.data() + word.size();
    const auto [rest, error] = std::from_chars(begin, end, value);
    return error == std::errc() && rest == end;
  }

  Box box_;
  int diameter_ = -1, scaled_[3] = {-1, -1, -1};
};

}  // namespace

bool is_lammps_dump(const std::string& text) { return text.starts_with(first_item); }

LammpsDump read_lammps_dump(const std::string& path, const std::string& text) {
  const auto lines = lines_of(text);
  std::size_t begin = lines.size();
  while (begin > 0 && !lines[begin - 1].starts_with(first_item)) --begin;
  if (begin == 0) fail(path, 0, "is no text dump of LAMMPS; allowed: ITEM: TIMESTEP first; give a dump");
  const auto box = item(path, lines, begin, "ITEM: BOX BOUNDS"), atoms = item(path, lines, begin, "ITEM: ATOMS");
  const Box bounds = box_of(path, lines, box);
  LammpsDump dump{3, bounds.cell, nullptr};

  std::string table(atoms, '\n');  // so that rows keep the numbers of their lines
  auto header = words_of(lines[atoms].substr(std::string("ITEM: ATOMS").size()));
  const Columns columns(header, bounds);
  if (columns.mixed(header)) {
    fail(path, atoms, "has some coordinates in parts of the box (xs) and others not; allowed: all alike; dump x y z");
  }
  table += as_row(header);
  for (std::size_t k = atoms + 1; k < lines.size(); ++k) {
    auto row = words_of(lines[k]);
    columns.convert(row);
    table += as_row(row);
  }
  dump.atoms = std::make_unique<CsvTable>(path, table);
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
