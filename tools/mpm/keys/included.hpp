// Files that a scene names become a part of it, so that a run's folder is whole.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "tools/mpm/keys/keys.hpp"

namespace mpm {

/// For each table under [[of]] whose `key` names a file beside the scene: put(table, path), and the key goes.
void include_files(toml::table& file, const std::string& of, const std::string& key, const std::string& scene_path,
                   const std::function<void(toml::table&, const std::filesystem::path&)>& put);
/// The same of CSV files: their rows of numbers become the key `rows`. A first line of words is left out. InputError
/// with the line that holds something else.
void include_rows(toml::table& file, const std::string& of, const std::string& key, const std::string& rows,
                  const std::string& scene_path);

/// The text of a file that a key names: a regular one, read once. InputError: there is none.
std::string text_of_file(const std::filesystem::path& path, const std::string& key, const std::string& holds);

}  // namespace mpm
