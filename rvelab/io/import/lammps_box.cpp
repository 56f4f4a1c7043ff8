// Declared in lammps_box.hpp; units: inputs.hpp.
#include "rvelab/io/import/lammps_box.hpp"

#include <algorithm>
#include <cmath>

#include "rvelab/error.hpp"
#include "rvelab/io/publish.hpp"
#include "rvelab/io/utf8.hpp"
#include "rvelab/keys/shortened.hpp"

namespace rvelab::io {

double metres_of(const std::string& units, const std::string& location) {
  if (units == "si") return 1;
  if (units == "cgs") return 1e-2;
  if (units == "micro") return 1e-6;
  if (units == "nano") return 1e-9;
  const bool known = units == "lj" || units == "real" || units == "metal" || units == "electron";
  throw InputError(
      location + ": the units are " + keys::shortened(printable(units)) +
      (units == "lj" ? ", which have no metre"
       : known       ? ", those of atoms"
                     : ", which LAMMPS does not know") +
      "; allowed: si, or cgs, micro, nano, which are converted; run with units si, or bring the lengths to "
      "m and state si");
}

LammpsBox box_within(const BoxBounds& bounds) {
  LammpsBox box{Matrix3::Zero(), bounds.low};
  box.cell.diagonal() = bounds.high - bounds.low;
  box.cell(0, 1) = bounds.xy;
  box.cell(0, 2) = bounds.xz;
  box.cell(1, 2) = bounds.yz;
  return box;
}

LammpsBox box_inside(const BoxBounds& around) {
  const auto [low, high, xy, xz, yz] = around;
  BoxBounds bounds = around;
  bounds.low[0] = low[0] - std::min({0.0, xy, xz, xy + xz});
  bounds.low[1] = low[1] - std::min(0.0, yz);
  bounds.high[0] = high[0] - std::max({0.0, xy, xz, xy + xz});
  bounds.high[1] = high[1] - std::max(0.0, yz);
  return box_within(bounds);
}

void scale_box(LammpsBox& box, double metres) {
  if (metres == 1) return;
  box.cell *= metres;
  box.low *= metres;
}

bool finite_numbers(const std::vector<std::string_view>& words, std::size_t count, double* values) {
  if (words.size() < count) return false;
  for (std::size_t k = 0; k < count; ++k) {
    if (!parsed(words[k], values[k]) || !std::isfinite(values[k])) return false;
  }
  return true;
}

void LammpsLines::fail(long line, const std::string& message) const {
  throw InputError(path_ + ":" + std::to_string(line) + ": " + message);
}

std::string LammpsLines::shown(std::string_view text) { return keys::shortened(printable(without_blanks(text))); }

ScaledColumns::ScaledColumns(std::vector<std::string>& names, const LammpsBox& box) : box_(box) {
  const auto find = [&](const std::string& name) {
    const auto at = std::find(names.begin(), names.end(), name);
    return at == names.end() ? -1 : int(at - names.begin());
  };
  int axes = 0, in_parts = 0;
  for (int k = 0; k < 3; ++k) {
    const std::string axis(1, "xyz"[k]);
    int at = find(axis);
    if (at < 0) at = find(axis + "u");
    if (at < 0) at = scaled_[k] = std::max(find(axis + "s"), find(axis + "su"));
    if (at < 0) continue;
    names[std::size_t(at)] = axis;
    ++axes;
    in_parts += scaled_[k] >= 0;
  }
  mixed_ = in_parts > 0 && in_parts != axes;
}

void ScaledColumns::convert(std::vector<std::string_view>& row, CsvTable& table) const {
  Vector3 parts = Vector3::Zero();
  for (int k = 0; k < 3; ++k) {
    if (scaled_[k] >= 0 && !parsed(row[std::size_t(scaled_[k])], parts[k])) return;
  }
  const Vector3 position = box_.low + box_.cell * parts;
  for (int k = 0; k < 3; ++k) {
    if (scaled_[k] >= 0) row[std::size_t(scaled_[k])] = table.keep(exact(position[k]));
  }
}

}  // namespace rvelab::io
