#include "tools/mpm/keys/included.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>

#include "rvelab/keys/regular_file.hpp"

namespace mpm {
namespace {

/// Numbers of a CSV file; a first line of words is left out.
toml::array rows_of(const std::filesystem::path& path, const std::string& key) {
  std::istringstream csv(text_of_file(path, key, "rows of numbers"));
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
      if (number == 1 && row.empty()) continue;
      throw InputError(path.string() + ":" + std::to_string(number) + ": holds " + wrong +
                       ", which is no finite number; correct or remove it");
    }
    if (!row.empty()) rows.push_back(std::move(row));
  }
  if (rows.empty()) throw InputError(path.string() + ": holds no rows of numbers; give another " + key);
  return rows;
}

}  // namespace

std::string text_of_file(const std::filesystem::path& path, const std::string& key, const std::string& holds) {
  // A pipe or a device may have no end.
  if (std::error_code none; std::filesystem::is_regular_file(path, none)) {
    try {
      return rvelab::keys::whole_file<std::string>(path.string(), "a CSV file");
    } catch (const rvelab::InputError& error) {
      throw InputError(error.what());
    }
  }
  throw InputError(path.string() + ": cannot be read; " + key + " names a file beside the scene, of " + holds);
}

void include_files(toml::table& file, const std::string& of, const std::string& key, const std::string& scene_path,
                   const std::function<void(toml::table&, const std::filesystem::path&)>& put) {
  auto* all = file[of].as_array();
  for (std::size_t k = 0; all != nullptr && k < all->size(); ++k) {
    auto* table = all->get(k)->as_table();
    const auto name = table == nullptr ? std::optional<std::string>() : (*table)[key].value<std::string>();
    if (!name) continue;
    put(*table, std::filesystem::path(scene_path).parent_path() / *name);
    table->erase(key);
  }
}

void include_rows(toml::table& file, const std::string& of, const std::string& key, const std::string& rows,
                  const std::string& scene_path) {
  include_files(file, of, key, scene_path, [&](toml::table& table, const std::filesystem::path& path) {
    table.insert_or_assign(rows, rows_of(path, of + "." + key));
  });
}

}  // namespace mpm
