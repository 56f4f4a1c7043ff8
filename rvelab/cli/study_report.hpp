// The results of a study as JSON, CSV and tables on a terminal; and its folder: study.toml (the study itself), pieces/
// (finished runs, one JSON file each), study.csv and study.json.
#pragma once

#include <optional>
#include <string>

#include "rvelab/cli/report.hpp"
#include "rvelab/io/journal/record_store.hpp"
#include "rvelab/study/summary.hpp"

namespace rvelab::cli {

/// One object: the study, the measures and their meaning, the reference, and the grid points in order.
Json as_json(const study::Study& study, const study::StudySummary& summary);

/// A header and one line per run, the reference first.
std::string as_csv(const study::Study& study, const study::StudySummary& summary);

/// The errors and costs of the increments, and the measures of the whole paths, one line per run.
std::string as_tables(const study::Study& study, const study::StudySummary& summary);

class StudyFolder {
 public:
  /// Prepares the folder for a study, whose specimens are named relative to the present folder; makes it if missing.
  /// resume: it must hold the same study; overwrite: removes pieces and results. InputError: the folder cannot be used,
  /// holds another study, or a result would replace an input or, with `refuse`, an existing file.
  StudyFolder(const std::string& path, const study::Study& study, io::IfExists existing,
              const std::vector<std::string>& inputs);

  /// A piece that is there. InputError if its file is damaged.
  std::optional<study::Piece> piece(const std::string& name) const;
  void put(const std::string& name, const study::Piece& piece) const;
  std::string file(const std::string& name) const;  ///< "study.csv" and the like

 private:
  std::string path_;
};

}  // namespace rvelab::cli
