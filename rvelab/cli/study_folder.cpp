#include "rvelab/cli/study_folder.hpp"

#include <filesystem>
#include <fstream>
#include <limits>

#include "rvelab/cli/protocol_input.hpp"
#include "rvelab/cli/report.hpp"
#include "rvelab/error.hpp"
#include "rvelab/io/publish.hpp"
#include "rvelab/io/text_file.hpp"
#include "rvelab/keys/key.hpp"

namespace rvelab::cli {

namespace fs = std::filesystem;

namespace {

const std::vector<std::string> results{"study.csv", "study.json"};

/// A path as it is called from another folder.
std::string seen_from(const fs::path& folder, const std::string& path) {
  return fs::weakly_canonical(path).lexically_proximate(fs::weakly_canonical(folder)).string();
}

/// InputError unless the folder holds the same study.
void expect_same(const std::string& path, const study::Study& study) {
  const study::Study there = study::read_study(keys::parse_toml_file(path), path);
  const std::string found = study::difference(there, study);
  if (found.empty()) return;
  throw InputError(path + ": is another study: " + found +
                   "; allowed with --resume: the same; give it, or another folder, or start anew with --force");
}

}  // namespace

StudyFolder::StudyFolder(const std::string& path, const study::Study& study, Existing existing,
                         const std::vector<std::string>& inputs)
    : path_(path) {
  const std::string own = file("study.toml");
  const bool there = fs::exists(own);
  for (const std::string& name : results) {
    io::expect_output(file(name), existing != Existing::refuse, inputs, ", --resume to go on with a study");
  }
  if (there && existing == Existing::resume) {
    expect_same(own, study);
    return;
  }
  io::expect_output(own, existing == Existing::overwrite, inputs, ", --resume to go on with the study");
  make_folder((fs::path(path_) / "pieces").string());
  for (const auto& entry : fs::directory_iterator(fs::path(path_) / "pieces")) {
    if (entry.path().extension() == ".json") fs::remove(entry.path());
  }
  for (const std::string& name : results) fs::remove(file(name));
  study::Study kept = study;
  for (std::string& specimen : kept.specimens) specimen = seen_from(path_, specimen);
  io::publish_text(own, study::written(kept));
}

std::string StudyFolder::file(const std::string& name) const { return (fs::path(path_) / name).string(); }

std::optional<study::Piece> StudyFolder::piece(const std::string& name) const {
  const std::string path = file("pieces/" + name + ".json");
  std::ifstream input(path, std::ios::binary);
  if (!input) return std::nullopt;
  try {
    const Json json = Json::parse(input);
    study::Piece piece;
    piece.failure = json.at("failure").get<std::string>();
    for (const auto& [column, values] : json.at("columns").items()) {
      auto& numbers = piece.columns[column];
      for (const Json& value : values) {
        numbers.push_back(value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>());
      }
    }
    return piece;
  } catch (const Json::exception&) {
    throw InputError(path +
                     ": is damaged; allowed: what `rvelab study` wrote; remove the file, and go on with --resume");
  }
}

void StudyFolder::put(const std::string& name, const study::Piece& piece) const {
  Json json;
  json["failure"] = piece.failure;
  json["columns"] = piece.columns;
  io::publish_text(file("pieces/" + name + ".json"), json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
}

}  // namespace rvelab::cli
