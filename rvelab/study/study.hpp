// A study: a test, the specimens it runs on, the grid of settings it is run with, and the best-resolved settings that
// it is held against. A plain value, which a TOML file holds whole (README.md lists its keys).
#pragma once

#include <toml++/toml.h>
#include <string>
#include <vector>

#include "rvelab/protocol/protocol.hpp"
#include "rvelab/study/increments.hpp"

namespace rvelab::study {

/// A key of a protocol and the values that it takes, as text: TOML, or a word.
struct Variation {
  std::string key;
  std::vector<std::string> values;
};

/// "KEY=v1,v2,...". Commas in brackets, braces and quotation marks belong to a value. InputError: no key, an empty list
/// or value, a value twice.
Variation parsed_variation(const std::string& text);

/// The number of combinations. InputError beyond `most_points`.
std::size_t points_in(const std::vector<Variation>& grid);
inline constexpr std::size_t most_points = 10'000;

/// The values of one combination, one for each variation; the last variation turns fastest. Points count from 0.
std::vector<std::string> values_at(const std::vector<Variation>& grid, std::size_t point);

/// "KEY=value" for each variation.
std::vector<std::string> assignments_at(const std::vector<Variation>& grid, std::size_t point);

/// What messages call a point: "KEY=value, KEY=value"; "the protocol as it is" without a variation.
std::string name_of(const std::vector<std::string>& assignments);

/// The protocol with `settings` and then `assignments`, each of which stands for one word `flag` of the command line.
/// InputError with the point's name in front, naming `flag` where the mistake is in an assignment.
protocol::Protocol protocol_with(const std::string& text, const std::string& path,
                                 const std::vector<std::string>& settings, const std::vector<std::string>& assignments,
                                 const std::string& flag);

struct Study {
  std::string protocol;                ///< path, or name of an installed one; empty where the text is given
  std::string protocol_text;           ///< TOML
  std::vector<std::string> specimens;  ///< files; in a file relative to its folder
  std::vector<std::string> digests;    ///< of the specimens, where known
  std::vector<std::string> settings;   ///< "KEY=value", of every run
  std::vector<Variation> grid;
  std::vector<std::string> reference;  ///< "KEY=value", over the settings: the best-resolved run
  long repeats = 1;                    ///< whole paths a grid point and specimen; 0: none
  long increments = 300;               ///< a grid point and specimen; 0: none
  Relaxation relaxation;
  std::string made_with;  ///< version of the program that wrote it
};

/// True if a parsed file is a study.
bool is_study(const toml::table& file);

/// Reads a study. InputError with every mistake and its line.
Study read_study(const toml::table& file, const std::string& path);

/// The file that read_study reads back as the same.
std::string written(const Study& study);

/// The first difference between two studies, in words: "repeats = 2 there and 3 here"; empty: none. Names of files are
/// not compared where their digests are known.
std::string difference(const Study& there, const Study& here);

/// The protocols of a study, checked against its specimens before anything is run.
struct Prepared {
  protocol::Protocol reference;
  std::vector<protocol::Protocol> points;
  std::vector<Specimen> specimens;
};

/// Reads the protocol at every grid point, puts it on every specimen and opens that. InputError naming the point: a key
/// that is unknown or out of range or does not go with the others; no reference; nothing to run; a point whose
/// loading is not the reference's, although increments are asked for.
Prepared prepared(const Study& study, const std::string& path, std::vector<Specimen> specimens);

}  // namespace rvelab::study
