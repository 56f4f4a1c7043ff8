// The folder of a study: study.toml (the study itself), pieces/ (what was run, one JSON file each), study.csv and
// study.json (what came out).
#pragma once

#include <optional>
#include <string>

#include "rvelab/study/summary.hpp"

namespace rvelab::cli {

class StudyFolder {
 public:
  enum class Existing { refuse, overwrite, resume };

  /// Prepares the folder for a study, whose specimens are named relative to the present folder; makes it if missing.
  /// resume: it must hold the same study; overwrite: removes pieces and results. InputError: the folder cannot be used,
  /// holds another study, or a result would replace an input or, with `refuse`, an existing file.
  StudyFolder(const std::string& path, const study::Study& study, Existing existing,
              const std::vector<std::string>& inputs);

  /// A piece that is there. InputError if its file is damaged.
  std::optional<study::Piece> piece(const std::string& name) const;
  void put(const std::string& name, const study::Piece& piece) const;
  std::string file(const std::string& name) const;  ///< "study.csv" and the like

 private:
  std::string path_;
};

}  // namespace rvelab::cli
