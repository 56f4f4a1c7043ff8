// A study: a test, the specimens it runs on, the grid of settings it is run with, and the best-resolved settings that
// it is held against. A plain value, which a TOML file holds whole (README.md lists its keys).
#pragma once

#include <toml++/toml.h>
#include <cstdint>
#include <string>
#include <vector>

#include "rvelab/protocol/protocol.hpp"
#include "rvelab/study/grid.hpp"
#include "rvelab/study/increments.hpp"

namespace rvelab::study {

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
