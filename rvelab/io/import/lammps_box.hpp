// Common to dumps and data files of LAMMPS: boxes (orthogonal, triclinic, and general triclinic), lines and messages.
#pragma once

#include <map>
#include <string>
#include <string_view>

#include "rvelab/io/import/inputs.hpp"

namespace rvelab::io {

/// Lengths and tilts of a box as data files state them, and dumps around them.
struct BoxBounds {
  Vector3 low = Vector3::Zero(), high = Vector3::Zero();
  double xy = 0, xz = 0, yz = 0;
};

/// The cell of bounds xlo xhi, ylo yhi, zlo zhi and tilts.
LammpsBox box_within(const BoxBounds& bounds);

/// The same of the cuboid around the tilted box, which a dump states instead.
LammpsBox box_inside(const BoxBounds& around);

/// Lengths times `metres`.
void scale_box(LammpsBox& box, double metres);

/// Words as numbers, all of them finite; false if they are not.
bool finite_numbers(const std::vector<std::string_view>& words, std::size_t count, double* values);

/// The lines of a file as they are read, what they gave so far, and how a line is refused.
class LammpsLines {
 protected:
  LammpsLines(const std::string& path, const Text& text, const TextLines& lines)
      : path_(path), text_(text), lines_(lines) {}
  [[noreturn]] void fail(long line, const std::string& message) const;
  static std::string shown(std::string_view text);

  const std::string again_ = "the file is cut or damaged: write or copy it again";
  const std::string& path_;
  Text text_;
  TextLines lines_;
  std::map<std::string, long, std::less<>> stated_;  ///< line of each item, or line of a header by its first word
  std::int64_t count_ = 0;                           ///< atoms, as the file says
  LammpsAtoms atoms_{};
};

/// What dumps and data files write besides x, y, z: xu (not wrapped into the box, as any position may be), xs and xsu
/// (in parts of the box). The names get the usual ones, and rows the usual numbers.
class ScaledColumns {
 public:
  ScaledColumns(std::vector<std::string>& names, const LammpsBox& box);
  /// Whether some are in parts of the box and others are not.
  bool mixed() const { return mixed_; }
  /// What is no number stays as it is, and the table tells it with its place.
  void convert(std::vector<std::string_view>& row, CsvTable& table) const;

 private:
  const LammpsBox& box_;
  int scaled_[3] = {-1, -1, -1};
  bool mixed_ = false;
};

}  // namespace rvelab::io
