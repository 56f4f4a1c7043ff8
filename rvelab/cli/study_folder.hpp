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

  /// Takes the folder, made if it is not there, for a study, whose names of specimens count from the present folder.
  /// resume: what is there must be the same study; overwrite: its pieces and results go. InputError: the folder cannot
  /// be used, a result would replace an input or, refused, is there already, or another study is.
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
