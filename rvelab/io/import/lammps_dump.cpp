// Dumps of LAMMPS, LIGGGHTS and OVITO: one of the timesteps, whole. Declared in inputs.hpp.
#include <algorithm>

#include "rvelab/error.hpp"
#include "rvelab/io/import/inputs.hpp"
#include "rvelab/io/import/lammps_box.hpp"
#include "rvelab/io/publish.hpp"
#include "rvelab/keys/shortened.hpp"

namespace rvelab::io {
namespace {

constexpr std::string_view item = "ITEM:";

/// Where a timestep stands in the text, with what the items around it say.
struct Timestep {
  std::size_t begin, end;
  long line;                             ///< number of the first one
  std::optional<std::int64_t> timestep;  ///< none: cut or no number
  std::string units;                     ///< LAMMPS states them once, before the first timestep
  std::string units_place;
};

/// The timesteps of a dump: each begins with the first item after the atoms of the one before it. A last line that is
/// cut within "ITEM:" begins one too.
std::vector<Timestep> frames_of(const std::string& path, std::string_view text) {
  std::vector<Timestep> frames;
  std::string units, units_place;
  bool atoms_before = true;
  for (TextLines lines(text); lines.next();) {
    const std::string_view line = lines.line();
    const bool cut_item = !lines.ended() && !line.empty() && item.starts_with(line);
    if (!line.starts_with(item) && !cut_item) continue;
    const std::string_view what = without_blanks(line.substr(std::min(line.size(), item.size())));
    const bool again = what == "TIMESTEP" && !frames.empty() && frames.back().timestep;
    if (atoms_before || again) {
      const auto offset = std::size_t(line.data() - text.data());
      if (!frames.empty()) frames.back().end = offset;
      frames.push_back({offset, text.size(), lines.number(), std::nullopt, units, units_place});
    }
    atoms_before = what.starts_with("ATOMS");
    TextLines next(lines.rest(), lines.number() + 1);
    if (what == "TIMESTEP" && next.next()) {
      std::int64_t step = 0;
      if (next.ended() && parsed(without_blanks(next.line()), step)) frames.back().timestep = step;
    } else if (what == "UNITS" && next.next()) {
      units = without_blanks(next.line());
      units_place = path + ":" + std::to_string(next.number());
      frames.back().units = units;
      frames.back().units_place = units_place;
    }
  }
  return frames;
}

/// Reads one timestep and believes nothing that is not whole.
class FrameReader : LammpsLines {
 public:
  FrameReader(const std::string& path, const Text& text, const Timestep& frame)
      : LammpsLines(path, text,
                    TextLines(std::string_view(*text).substr(0, frame.end).substr(frame.begin), frame.line)) {}

  LammpsAtoms read(double metres) {
    read_items(metres);
    for (const char* needed : {"TIMESTEP", "NUMBER OF ATOMS", "BOX BOUNDS", "ATOMS"}) {
      if (stated_.count(needed) == 0) {
        fail(lines_.number(), std::string("the timestep has no ITEM: ") + needed +
                                  "; allowed: a whole text dump of LAMMPS; the file is cut, write or copy it again");
      }
    }
    scale_box(atoms_.box, metres);
    return std::move(atoms_);
  }

 private:
  void read_items(double metres) {
    bool more = lines_.next();
    while (more) {
      const std::string_view line = without_blanks(lines_.line());
      if (line.empty()) {
        more = lines_.next();
        continue;
      }
      if (!line.starts_with(item)) fail(lines_.number(), shown(line) + " is no ITEM; allowed: those of a dump");
      const std::string_view what = without_blanks(line.substr(item.size()));
      const auto is = [&](std::string_view name) {
        const bool found =
            what == name || (what.starts_with(name) && what.size() > name.size() && what[name.size()] == ' ');
        if (found && !stated_.emplace(name, lines_.number()).second)
          fail(lines_.number(), "ITEM: " + std::string(name) + " stands twice in a timestep; allowed: once");
        return found;
      };
      if (is("ATOMS")) {
        read_atoms(what, metres);
        return;
      }
      if (is("NUMBER OF ATOMS")) {
        count_ = whole_number("a number of atoms");
        if (count_ < 0) fail(lines_.number(), shown(lines_.line()) + " is no number of atoms; allowed: from 0");
      } else if (is("TIMESTEP")) {
        whole_number("a timestep");
      } else if (is("BOX BOUNDS")) {
        read_box(line);
      } else if (is("ENTRIES") || is("GRID CELLS") || is("NUMBER OF ENTRIES")) {
        fail(lines_.number(), shown(line) +
                                  " is not of atoms; allowed: a dump of style custom, id type x y z radius; "
                                  "dump the atoms");
      }
      do more = lines_.next();
      while (more && !lines_.line().starts_with(item));
    }
  }

  /// The next line, which must be ended.
  void next_line(const std::string& wanted) {
    const long before = lines_.number();
    if (!lines_.next()) fail(before, "the file ends here; allowed: " + wanted + " in the next line; " + again_);
    if (!lines_.ended())
      fail(lines_.number(),
           shown(lines_.line()) + " is not ended by a line break and may be cut; allowed: " + wanted + "; " + again_);
  }

  std::int64_t whole_number(const std::string& wanted) {
    next_line(wanted);
    std::int64_t value = 0;
    if (!parsed(without_blanks(lines_.line()), value))
      fail(lines_.number(), shown(lines_.line()) + " is no whole number; allowed: " + wanted + "; " + again_);
    return value;
  }

  /// ITEM: BOX BOUNDS [xy xz yz | abc origin] pp pp pp and three lines.
  void read_box(std::string_view line) {
    atoms_.box_place = path_ + ":" + std::to_string(lines_.number()) + ": " + shown(line);
    std::vector<std::string_view> words;
    split_words(line, words);
    words.erase(words.begin(), words.begin() + std::min<long>(3, long(words.size())));
    const auto begins = [&](std::initializer_list<std::string_view> names) {
      if (words.size() < names.size() || !std::equal(names.begin(), names.end(), words.begin())) return false;
      words.erase(words.begin(), words.begin() + long(names.size()));
      return true;
    };
    const bool general = begins({"abc", "origin"}), tilted = !general && begins({"xy", "xz", "yz"});
    const auto is_boundary = [](std::string_view word) {
      return word.size() == 2 && word.find_first_not_of("pfsm") == std::string_view::npos;
    };
    if (words.size() != 3 || !std::all_of(words.begin(), words.end(), is_boundary)) {
      throw InputError(atoms_.box_place +
                       " does not say which boundaries are periodic; allowed: ITEM: BOX BOUNDS [xy xz yz, or abc "
                       "origin] pp pp pp; give a dump that says it");
    }
    bool periodic[3];
    for (std::size_t k = 0; k < 3; ++k) periodic[k] = words[k] == "pp";
    const std::size_t count = general ? 4 : tilted ? 3 : 2;
    double rows[3][4] = {};
    for (auto& row : rows) {
      const std::string wanted = general  ? "a vector and a coordinate of the origin, four numbers"
                                 : tilted ? "low high tilt"
                                          : "low high";
      next_line(wanted);
      split_words(lines_.line(), words);
      if (words.size() != count || !finite_numbers(words, count, row))
        fail(lines_.number(), shown(lines_.line()) + " is no line of box bounds; allowed: " + wanted + "; " + again_);
    }
    if (general) {
      for (int k = 0; k < 3; ++k) {
        for (int i = 0; i < 3; ++i) atoms_.box.cell(i, k) = rows[k][i];
        atoms_.box.low[k] = rows[k][3];
      }
    } else {
      atoms_.box = box_inside({{rows[0][0], rows[1][0], rows[2][0]},
                               {rows[0][1], rows[1][1], rows[2][1]},
                               rows[0][2],
                               rows[1][2],
                               rows[2][2]});
    }
    std::copy(std::begin(periodic), std::end(periodic), atoms_.box.periodic);
  }

  void read_atoms(std::string_view what, double metres) {
    const long header_line = lines_.number();
    for (const char* needed : {"NUMBER OF ATOMS", "BOX BOUNDS"}) {
      if (stated_.count(needed) == 0)
        fail(header_line, std::string("the timestep has no ITEM: ") + needed +
                              " before its atoms; allowed: a whole dump; " + again_);
    }
    if (!lines_.ended())
      fail(header_line, "the file ends in the line of ITEM: ATOMS; allowed: a whole dump; " + again_);
    std::vector<std::string_view> words;
    split_words(what, words);
    std::vector<std::string> names(words.begin() + 1, words.end());
    std::vector<std::pair<std::size_t, std::size_t>> twice;  // LIGGGHTS' tutorials dump `type type`
    for (std::size_t k = 0; k < names.size(); ++k) {
      const auto first = std::find(names.begin(), names.begin() + long(k), names[k]);
      if (first != names.begin() + long(k)) twice.emplace_back(first - names.begin(), k);
    }
    const std::vector<std::string> named = names;
    for (const auto& [first, second] : twice) names[second].clear();
    const ScaledColumns scaled(names, atoms_.box);
    if (scaled.mixed())
      fail(header_line, "has some coordinates in parts of the box (xs) and others not; allowed: all alike; dump x y z");
    atoms_.table = std::make_unique<CsvTable>(path_, text_, names);
    atoms_.table->lengths_in(metres);
    // Parts of the box give lengths in the dump's unit, too: the box is brought to metres at the end.
    std::int64_t rows = 0;
    while (lines_.next()) {
      split_words(lines_.line(), words);
      if (words.empty()) continue;
      if (++rows > count_) continue;
      if (words.size() != names.size())
        fail(lines_.number(), "the row has " + std::to_string(words.size()) + " cells; allowed: one for each of the " +
                                  std::to_string(names.size()) + " columns of ITEM: ATOMS; " + again_);
      if (!lines_.ended())
        fail(lines_.number(),
             "the last row is not ended by a line break, so its last number may be cut; allowed: "
             "whole rows; " +
                 again_ + ", or end the line if the number is whole");
      for (const auto& [first, second] : twice) expect_same(named[first], words[first], words[second]);
      scaled.convert(words, *atoms_.table);
      atoms_.table->add_row(lines_.number(), words);
    }
    if (rows != count_)
      fail(header_line, "ITEM: NUMBER OF ATOMS says " + std::to_string(count_) + ", and " + std::to_string(rows) +
                            " rows follow; allowed: as many rows as it says; " + again_);
  }

  void expect_same(const std::string& name, std::string_view first, std::string_view second) const {
    double one = 0, other = 0;
    if (first == second || (parsed(first, one) && parsed(second, other) && one == other)) return;
    fail(lines_.number(), "the column " + keys::shortened(name) + " stands twice, here with " + shown(first) + " and " +
                              shown(second) + "; allowed: once, or twice with equal values; dump it once");
  }
};

LammpsAtoms whole_frame(const std::string& path, const Text& text, const Timestep& frame) {
  const double metres = frame.units.empty() ? 1 : metres_of(frame.units, frame.units_place);
  return FrameReader(path, text, frame).read(metres);
}

/// The last frame of a timestep; a run that went on from an earlier state has it twice.
std::size_t frame_of(const std::string& path, const std::vector<Timestep>& frames, std::int64_t timestep) {
  for (std::size_t k = frames.size(); k-- > 0;) {
    if (frames[k].timestep == timestep) return k;
  }
  std::string there;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    if (frames.size() > 10 && k >= 4 && k + 4 < frames.size()) {
      if (k == 4) there += ", ...";
      continue;
    }
    if (frames[k].timestep) there += (there.empty() ? "" : ", ") + std::to_string(*frames[k].timestep);
  }
  throw InputError(path + ": has no timestep " + std::to_string(timestep) + "; allowed: " + there +
                   "; give one of these by --timestep, or none for the last");
}

/// The end of a refusal: which timestep before a broken one can be had.
std::string offer_before(const std::string& path, const Text& text, const std::vector<Timestep>& frames,
                         std::size_t broken) {
  for (std::size_t k = broken; k-- > 0;) {
    if (!frames[k].timestep || frame_of(path, frames, *frames[k].timestep) != k) continue;
    try {
      whole_frame(path, text, frames[k]);
      const std::string step = std::to_string(*frames[k].timestep);
      return "; the last whole timestep before it is " + step + ": --timestep " + step + " reads it";
    } catch (const InputError&) {
      continue;
    }
  }
  return frames.size() > 1 ? "; no timestep before it is whole" : "";
}

}  // namespace

bool is_lammps_dump(std::string_view text) { return text.starts_with(item); }

LammpsAtoms read_lammps_dump(const std::string& path, const Text& text, const std::optional<std::int64_t>& timestep,
                             const Tell& tell) {
  const auto frames = frames_of(path, *text);
  const std::size_t chosen = timestep ? frame_of(path, frames, *timestep) : frames.size() - 1;
  const Timestep& frame = frames[chosen];
  if (!frame.units.empty()) metres_of(frame.units, frame.units_place);
  try {
    auto atoms = whole_frame(path, text, frame);
    if (!timestep && frames.size() > 1 && frame.timestep && frames.front().timestep) {
      tell(path + " holds " + std::to_string(frames.size()) + " timesteps, " +
           std::to_string(*frames.front().timestep) + " to " + std::to_string(*frame.timestep) +
           "; the last is read, --timestep N reads another");
    }
    if (!frame.units.empty() && frame.units != "si")
      tell(path + " is in units " + frame.units + ": its lengths are times " + exact(metres_of(frame.units, "")) +
           " m");
    return atoms;
  } catch (const InputError& error) {
    throw InputError(error.what() + offer_before(path, text, frames, chosen));
  }
}

}  // namespace rvelab::io
