// Data files of LAMMPS, as read_data takes them: atom_style sphere. Declared in inputs.hpp.
#include <algorithm>

#include "rvelab/io/import/inputs.hpp"
#include "rvelab/io/import/lammps_box.hpp"
#include "rvelab/io/publish.hpp"

namespace rvelab::io {
namespace {

/// A line of a data file without its comment.
std::string_view before_comment(std::string_view line) { return without_blanks(line.substr(0, line.find('#'))); }

bool begins_section(const std::vector<std::string_view>& words) {
  const char first = words[0][0];
  return (first >= 'A' && first <= 'Z') || (first >= 'a' && first <= 'z');
}

class DataFile : LammpsLines {
 public:
  DataFile(const std::string& path, const Text& text) : LammpsLines(path, text, TextLines(*text)) {}

  LammpsAtoms read(const Tell& tell) {
    lines_.next();
    read_title(tell);
    std::vector<std::string_view> words;
    while (lines_.next()) {
      split_words(before_comment(lines_.line()), words);
      if (words.empty()) continue;
      if (begins_section(words)) {
        end_section();
        begin_section(words);
      } else if (section_.empty()) {
        read_header(words);
      } else {
        ++rows_;
        if (section_ == "Atoms") read_atom(words);
        if (section_ == "Velocities") expect_words(words, {4, 7}, "id vx vy vz [wx wy wz]");
        if (section_ == "Atom Type Labels") read_label(words);
      }
      if (!lines_.ended()) expect_ended();
    }
    end_section();
    if (!atoms_.table)
      fail(lines_.number(), "there is no section Atoms; allowed: one, of atom_style sphere; " + again_);
    atoms_.table->lengths_in(metres_);
    scale_box(atoms_.box, metres_);
    return std::move(atoms_);
  }

 private:
  /// LAMMPS skips the first line; write_data says its units there.
  void read_title(const Tell& tell) {
    const std::string_view line = lines_.line(), key = "units = ";
    if (line.starts_with("LIGGGHTS Description"))  // the title of YADE's export.textExt(format='liggghts_in')
      fail(1,
           "YADE's liggghts_in has the radius for the diameter and a box around the grains for the cell; allowed: a "
           "file with diameters and a periodic cell; write it by export.text, and give --cell");
    const auto at = line.find(key);
    if (!line.starts_with("LAMMPS data file") || at == std::string_view::npos) return;
    const auto units = line.substr(at + key.size());
    const std::string name(units.substr(0, units.find_first_of(" \t\r,")));
    metres_ = metres_of(name, path_ + ":1");
    if (metres_ != 1) tell(path_ + " is in units " + name + ": its lengths are times " + exact(metres_) + " m");
  }

  void read_header(const std::vector<std::string_view>& words) {
    struct Bounds {
      std::vector<std::string_view> names;
      std::vector<double*> values;
    };
    Vector3 &low = bounds_.low, &high = bounds_.high;
    const auto vector = [&](int column) {
      return std::vector<double*>{&general_(0, column), &general_(1, column), &general_(2, column)};
    };
    for (const Bounds& known :
         {Bounds{{"xlo", "xhi"}, {&low[0], &high[0]}}, Bounds{{"ylo", "yhi"}, {&low[1], &high[1]}},
          Bounds{{"zlo", "zhi"}, {&low[2], &high[2]}},
          Bounds{{"xy", "xz", "yz"}, {&bounds_.xy, &bounds_.xz, &bounds_.yz}}, Bounds{{"avec"}, vector(0)},
          Bounds{{"bvec"}, vector(1)}, Bounds{{"cvec"}, vector(2)},
          Bounds{{"abc", "origin"}, {&origin_[0], &origin_[1], &origin_[2]}}}) {
      const auto numbers = known.values.size();
      if (words.size() < known.names.size() || !std::equal(known.names.rbegin(), known.names.rend(), words.rbegin()))
        continue;
      double values[3];
      if (words.size() != numbers + known.names.size() || !finite_numbers(words, numbers, values))
        fail(lines_.number(), shown(lines_.line()) + " is no such line of the box; allowed: " +
                                  std::to_string(numbers) + " numbers before these words; " + again_);
      for (std::size_t k = 0; k < numbers; ++k) *known.values[k] = values[k];
      state_once(std::string(known.names[0]));
      return;
    }
    if (words.size() != 2) return;
    std::int64_t number = 0;
    const bool whole = parsed(words[0], number) && number >= 0;
    if (words[1] == "atoms") {
      if (!whole) fail(lines_.number(), shown(lines_.line()) + " is no number of atoms; allowed: from 0; " + again_);
      state_once("atoms");
      count_ = number;
    }
    for (const char* other : {"ellipsoids", "lines", "triangles", "bodies"}) {
      if (words[1] == other && number > 0) other_style(other);
    }
    for (const char* other : {"bonds", "angles", "dihedrals", "impropers"})
      molecules_ |= words[1] == other && number > 0;
  }

  void state_once(const std::string& name) {
    if (!stated_.emplace(name, lines_.number()).second)
      fail(lines_.number(), shown(lines_.line()) + " stands twice; allowed: once; remove one");
  }

  [[noreturn]] void other_style(const std::string& what) const {
    fail(lines_.number(), what +
                              " are of another atom_style; allowed: Atoms of atom_style sphere (id type diameter "
                              "density x y z), which have a radius; write the file with atom_style sphere");
  }

  void begin_section(const std::vector<std::string_view>& words) {
    const std::string_view line = lines_.line();
    if (!lines_.ended()) expect_ended();
    section_.clear();
    for (const auto word : words) section_ += (section_.empty() ? "" : " ") + std::string(word);
    section_line_ = lines_.number();
    rows_ = 0;
    for (const char* other : {"Ellipsoids", "Lines", "Triangles", "Bodies"})
      if (section_ == other) other_style(other);
    if (section_ != "Atoms") return;
    if (atoms_.table) fail(section_line_, "the section Atoms stands twice; allowed: once; remove one");
    const auto hint = line.find('#');
    const std::string style(hint == std::string_view::npos ? "" : without_blanks(line.substr(hint + 1)));
    if (!style.empty() && style != "sphere" && style != "granular") other_style("Atoms # " + shown(style));
    if (style.empty() && molecules_) other_style("atoms with bonds and no hint `Atoms # sphere`");
    if (stated_.count("atoms") == 0)
      fail(section_line_,
           "no line \"N atoms\" stands before the atoms (the first line is a title, which is skipped); "
           "allowed: one; add it");
    set_box();
  }

  void set_box() {
    atoms_.box_place = path_ + ": its box";
    const bool general = stated_.count("avec") + stated_.count("bvec") + stated_.count("cvec") > 0;
    const auto need = [&](std::initializer_list<std::pair<const char*, const char*>> lines) {
      for (const auto& [key, name] : lines)
        if (stated_.count(key) == 0)
          fail(section_line_,
               std::string("no line of ") + name + " stands before the atoms; allowed: a whole box; " + again_);
    };
    if (!general) {
      need({{"xlo", "xlo xhi"}, {"ylo", "ylo yhi"}, {"zlo", "zlo zhi"}});
      atoms_.box = box_within(bounds_);
      return;
    }
    need({{"avec", "avec"}, {"bvec", "bvec"}, {"cvec", "cvec"}});
    if (stated_.count("xlo") + stated_.count("ylo") + stated_.count("zlo") + stated_.count("xy") > 0)
      fail(section_line_, "the box has both avec, bvec, cvec and xlo xhi; allowed: one of the two; remove one");
    atoms_.box.cell = general_;
    atoms_.box.low = origin_;
  }

  void end_section() {
    if (section_ != "Atoms" && section_ != "Velocities") return;
    if (rows_ != count_)
      fail(section_line_, "the section " + section_ + " has " + std::to_string(rows_) + " rows, and the file says " +
                              std::to_string(count_) + " atoms; allowed: as many rows as atoms; " + again_);
  }

  void expect_words(const std::vector<std::string_view>& words, std::initializer_list<std::size_t> allowed,
                    const std::string& columns) const {
    if (std::find(allowed.begin(), allowed.end(), words.size()) != allowed.end()) return;
    fail(lines_.number(), "the row of " + section_ + " has " + std::to_string(words.size()) + " columns; allowed: " +
                              columns + " of atom_style sphere; " + again_ + ", or write it with that style");
  }

  void read_atom(std::vector<std::string_view>& words) {
    if (rows_ > count_) return;
    expect_words(words, {7, 10}, "id type diameter density x y z [ix iy iz]");
    words.resize(7);  // images of the box: any position will do
    if (!atoms_.table)
      atoms_.table = std::make_unique<CsvTable>(
          path_, text_, std::vector<std::string>{"id", "type", "diameter", "density", "x", "y", "z"});
    if (const auto label = labels_.find(words[1]); label != labels_.end()) words[1] = label->second;
    atoms_.table->add_row(lines_.number(), words);
  }

  void read_label(const std::vector<std::string_view>& words) {
    if (words.size() == 2) labels_.emplace(words[1], words[0]);
  }

  void expect_ended() const {
    fail(lines_.number(),
         "the last line is not ended by a line break, so its last number may be cut; allowed: whole "
         "lines; " +
             again_ + ", or end the line if the number is whole");
  }

  double metres_ = 1;
  BoxBounds bounds_;
  Matrix3 general_ = Matrix3::Zero();
  Vector3 origin_ = Vector3::Zero();
  std::map<std::string_view, std::string_view> labels_;
  std::int64_t rows_ = 0;
  bool molecules_ = false;
  std::string section_;
  long section_line_ = 0;
};

}  // namespace

bool is_lammps_data(std::string_view text) {
  std::vector<std::string_view> words;
  TextLines lines(text);
  lines.next();
  while (lines.next()) {
    split_words(before_comment(lines.line()), words);
    if (words.empty()) continue;
    std::int64_t number = 0;
    if (words.size() == 2 && words[1] == "atoms" && parsed(words[0], number)) return true;
    if (lines.number() > 200 || begins_section(words)) return words[0] == "Atoms" && words.size() == 1;
  }
  return false;
}

LammpsAtoms read_lammps_data(const std::string& path, const Text& text, const Tell& tell) {
  return DataFile(path, text).read(tell);
}

}  // namespace rvelab::io
