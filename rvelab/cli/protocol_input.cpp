#include "rvelab/cli/protocol_input.hpp"

#include <filesystem>

#include "rvelab/error.hpp"
#include "rvelab/io/specimen_file.hpp"

namespace rvelab::cli {

std::vector<Specimen> specimens_for(const Protocol& protocol, const std::vector<std::string>& files) {
  if (files.empty() && protocol.specimen_file.empty()) {
    throw InputError(protocol.path +
                     ": no specimen is given; allowed: --specimen S.h5 or [specimen] file = \"S.h5\"; name one");
  }
  std::vector<Specimen> specimens;
  for (const auto& file : files) specimens.push_back(read_specimen(file));
  if (files.empty()) {
    const auto folder = std::filesystem::path(protocol.path).parent_path();
    specimens.push_back(read_specimen((folder / protocol.specimen_file).string()));
  }
  return specimens;
}

void expect_folder_of(const std::string& file) {
  const auto folder = std::filesystem::path(file).parent_path();
  if (!folder.empty() && !std::filesystem::is_directory(folder)) {
    throw InputError(file + ": the folder " + folder.string() +
                     " does not exist; allowed: an existing folder; make it first");
  }
}

}  // namespace rvelab::cli
