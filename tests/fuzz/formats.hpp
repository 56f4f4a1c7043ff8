// What rvelab reads, one check for each format. An input is taken, or refused with an rvelab::Error; everything else is
// a finding: another exception, a crash, an endless run, a state whose stress is not finite, something lost on the way.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "tests/fuzz/choices.hpp"

namespace rvelab::fuzz {

using Bytes = std::vector<std::byte>;

enum class Answer { taken, refused };

struct Format {
  std::string name;
  bool is_text;  ///< mutated line by line, too
  /// Throws what is no rvelab::Error, and std::logic_error where a promise is not kept.
  Answer (*check)(View input);
  std::vector<Bytes> (*seeds)();
};

/// protocol, recipe, material, csv (particles, contacts and META.json, with a line "====" between them; LAMMPS too),
/// dump, data (of LAMMPS), text (tables of YADE and spreadsheets), gz (any of the three, packed, and the packed bytes
/// changed), curve, specimen and records (the files as they are), specimen_values and records_values (choices of what
/// to change through HDF5's own writer, then sealed), journal, journal_values, snapshot, crafted (the bytes of a
/// specimen file, sealed after they were changed).
const std::vector<Format>& formats();

}  // namespace rvelab::fuzz
