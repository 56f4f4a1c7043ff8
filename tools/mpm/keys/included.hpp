// Files that a scene names become a part of it, so that a run's folder is whole.
#pragma once

#include <functional>
#include <string>

#include "tools/mpm/keys/keys.hpp"

namespace mpm {

/// For each table of [of] or [[of]], a dotted name, whose `key` names a file beside the scene: put(table, path), and
/// the key goes.
void include_files(toml::table& file, const std::string& of, const std::string& key, const std::string& scene_path,
                   const std::function<void(toml::table&, const std::string&)>& put);
/// The same of CSV files, of which the lines of numbers become the key `rows`. Lines of words before them are left out.
/// InputError with the line that holds something else.
void include_rows(toml::table& file, const std::string& of, const std::string& key, const std::string& rows,
                  const std::string& scene_path);

}  // namespace mpm
