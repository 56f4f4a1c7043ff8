// What `run`, `calibrate` and `study` share: the protocols that are installed, the specimens that a protocol runs on,
// and the folder that results go to.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "rvelab/protocol/protocol.hpp"

namespace rvelab::cli {

/// What a file of ../share/rvelab/protocols is: a test for `rvelab run`, or a recipe for `rvelab pack`.
enum class InputKind { protocol, recipe };

/// Paths of the installed protocols, or recipes, by their names: those in ../share/rvelab/protocols beside the program,
/// which is where installation and build put them, and in its folder of soils.
std::map<std::string, std::string> installed(InputKind kind);

/// Error that names the folder if it holds no protocols: the installation is broken.
void expect_installed();

/// The path of a protocol or recipe. A word without separator and .toml is the name of an installed one. InputError
/// with the nearest name if there is none, or if it is of the other kind.
std::string input_path(const std::string& name_or_path, InputKind kind);
inline std::string protocol_path(const std::string& name_or_path) {
  return input_path(name_or_path, InputKind::protocol);
}

/// The path of an installed file NAME.toml of a folder of ../share/rvelab/protocols, "studies" or "fits"; "" if there
/// is none.
std::string installed_in(const std::string& folder, const std::string& name);

/// Reads the specimens named on the command line; without any, the protocol's own ([specimen] file, relative to the
/// protocol's folder). InputError if there is none.
std::vector<Specimen> specimens_for(const protocol::Protocol& protocol, const std::vector<std::string>& files);

/// Makes the folder for results if it is missing, and those above it. InputError if it cannot be made.
void make_folder(const std::string& folder);
/// The same; files *.json that are in it are removed.
void make_folder_without_json(const std::string& folder);

/// Whether a word is a path, not the name of something installed.
bool is_path(const std::string& word);
/// A path in a file, relative to the present folder.
std::string from_folder_of(const std::string& file, const std::string& path);

/// InputError if one of these options is given without -o. `noun`: what -o names.
void expect_output_given(const std::string& output, const std::vector<std::pair<const char*, bool>>& options,
                         const char* noun);

/// The files that specimens_for reads.
std::vector<std::string> specimen_files(const protocol::Protocol& protocol, const std::vector<std::string>& files);

/// InputError unless the folder of an output file exists: checked before the work, not after it.
void expect_folder_of(const std::string& file);

}  // namespace rvelab::cli
