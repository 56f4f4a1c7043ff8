#include "tools/mpm/keys/included.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <sstream>

#include "rvelab/keys/regular_file.hpp"

namespace mpm {
namespace {

toml::array rows_of(const std::string& path, const std::string& key) {
  std::istringstream csv(rvelab::keys::whole_file<std::string>(path, "a CSV file of rows of numbers for " + key));
  toml::array rows;
  std::string line;
  for (long number = 1; std::getline(csv, line); ++number) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream words(line);
    toml::array row;
    std::string wrong;
    for (std::string word; words >> word;) {
      char* end = nullptr;
      const double value = std::strtod(word.c_str(), &end);
      if (*end != '\0' || !std::isfinite(value)) wrong = word;
      if (*end == '\0') row.push_back(value);
    }
    if (!wrong.empty()) {
      if (rows.empty() && row.empty()) continue;
      throw InputError(path + ":" + std::to_string(number) + ": holds " + wrong +
                       ", which is no finite number; correct or remove it");
    }
    if (!row.empty()) rows.push_back(std::move(row));
  }
  if (rows.empty()) throw InputError(path + ": holds no rows of numbers; give another " + key);
  return rows;
}

void include_file(toml::table& table, const std::string& key, const std::string& scene_path,
                  const std::function<void(toml::table&, const std::string&)>& put) {
  const auto name = table[key].value<std::string>();
  if (!name) return;
  put(table, (std::filesystem::path(scene_path).parent_path() / *name).string());
  table.erase(key);
}

}  // namespace

void include_files(toml::table& file, const std::string& of, const std::string& key, const std::string& scene_path,
                   const std::function<void(toml::table&, const std::string&)>& put) {
  const auto found = file.at_path(of);
  if (auto* table = found.as_table()) include_file(*table, key, scene_path, put);
  auto* all = found.as_array();
  for (std::size_t k = 0; all != nullptr && k < all->size(); ++k) {
    if (auto* table = all->get(k)->as_table()) include_file(*table, key, scene_path, put);
  }
}

void include_rows(toml::table& file, const std::string& of, const std::string& key, const std::string& rows,
                  const std::string& scene_path) {
  include_files(file, of, key, scene_path, [&](toml::table& table, const std::string& path) {
    table.insert_or_assign(rows, rows_of(path, of + "." + key));
  });
}

}  // namespace mpm
