#include "rvelab/cli/protocol_input.hpp"

#include <filesystem>

#include "rvelab/cli/program_path.hpp"
#include "rvelab/error.hpp"
#include "rvelab/io/hdf5/specimen_file.hpp"
#include "rvelab/keys/table_reader.hpp"
#include "rvelab/pack/read_recipe.hpp"

namespace rvelab::cli {

namespace fs = std::filesystem;

namespace {

InputKind kind_of(const std::string& path) { return pack::is_recipe(path) ? InputKind::recipe : InputKind::protocol; }

fs::path installed_folder() { return shared_folder("protocols"); }

std::map<std::string, std::string> all_installed() {
  std::map<std::string, std::string> paths;
  std::error_code ignored;
  for (const fs::path& folder : {installed_folder(), installed_folder() / "soils"}) {
    for (const auto& entry : fs::directory_iterator(folder, ignored)) {
      if (entry.path().extension() == ".toml") paths[entry.path().stem().string()] = entry.path().string();
    }
  }
  return paths;
}

/// The path, if the file is of the kind.
std::string expect_kind(const std::string& path, InputKind kind) {
  if (kind_of(path) == kind) return path;
  throw InputError(path + (kind == InputKind::protocol
                               ? ": is a recipe and no test, it has [pack]; allowed: a protocol with [test]; make "
                                 "specimens of it with rvelab pack"
                               : ": is no recipe, it has no [pack]; allowed: a recipe; see rvelab protocols"));
}

}  // namespace

std::map<std::string, std::string> installed(InputKind kind) {
  auto paths = all_installed();
  std::erase_if(paths, [&](const auto& item) { return kind_of(item.second) != kind; });
  return paths;
}

void expect_installed() {
  if (!all_installed().empty()) return;
  throw Error(
      installed_folder().string() +
      ": no protocols are installed there, where this program looks for them; install it again (cmake --install), "
      "or link to the program rather than copy it");
}

std::string input_path(const std::string& name_or_path, InputKind kind) {
  const bool recipe = kind == InputKind::recipe;
  const std::string noun = recipe ? "recipe" : "protocol";
  if (name_or_path.ends_with(".h5"))
    throw InputError(name_or_path + " is a specimen or record file and no " + noun +
                     "; allowed: the name or the file of a " + noun +
                     (recipe ? "" : ", and --specimen " + name_or_path + " beside it") + "; see rvelab protocols");
  if (is_path(name_or_path)) return expect_kind(name_or_path, kind);
  const auto all = all_installed();
  if (const auto found = all.find(name_or_path); found != all.end()) return expect_kind(found->second, kind);
  std::vector<std::string> names;
  for (const auto& [name, path] : installed(kind)) names.push_back(name);
  constexpr std::size_t longest_name = 80;  // what is longer is no misspelt name
  if (name_or_path.size() > longest_name)
    throw InputError("no " + noun + " \"" + name_or_path +
                     "\" is installed; allowed: one of rvelab protocols, or the " + "path of a file " +
                     (recipe ? "RECIPE" : "PROTOCOL") + ".toml");
  throw InputError("no " + noun + " \"" + name_or_path + "\" is installed" +
                   keys::nearest_in_words(name_or_path, names) + "; allowed: " +
                   (all.empty() ? "none in " + installed_folder().string() + ", which is not there or empty; install it"
                                : keys::listed(names)) +
                   ", or the path of a file " + (recipe ? "RECIPE" : "PROTOCOL") + ".toml; see rvelab protocols");
}

std::string installed_in(const std::string& folder, const std::string& name) {
  const fs::path path = installed_folder() / folder / (name + ".toml");
  std::error_code ignored;
  return fs::is_regular_file(path, ignored) ? path.string() : "";
}

std::vector<std::string> specimen_files(const protocol::Protocol& protocol, const std::vector<std::string>& files) {
  if (files.empty() && protocol.specimen_file.empty()) {
    throw InputError(protocol.path +
                     ": no specimen is given; allowed: --specimen S.h5 or [specimen] file = \"S.h5\"; name one");
  }
  if (!files.empty()) return files;
  return {(fs::path(protocol.path).parent_path() / protocol.specimen_file).string()};
}

std::vector<Specimen> specimens_for(const protocol::Protocol& protocol, const std::vector<std::string>& files) {
  std::vector<Specimen> specimens;
  for (const auto& file : specimen_files(protocol, files)) specimens.push_back(io::read_specimen(file));
  return specimens;
}

void make_folder(const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  std::error_code ignored;
  if (std::filesystem::is_directory(folder, ignored)) return;
  throw InputError(folder + ": the folder cannot be made (" +
                   (error ? error.message() : std::string("a file has this name")) +
                   "); give one in a writable folder");
}

void expect_folder_of(const std::string& file) {
  const auto folder = std::filesystem::path(file).parent_path();
  if (!folder.empty() && !std::filesystem::is_directory(folder)) {
    throw InputError(file + ": the folder " + folder.string() +
                     " does not exist; allowed: an existing folder; make it first");
  }
}

void make_folder_without_json(const std::string& folder) {
  make_folder(folder);
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == ".json") fs::remove(entry.path());
}

bool is_path(const std::string& word) { return word.find('/') != std::string::npos || word.ends_with(".toml"); }

std::string from_folder_of(const std::string& file, const std::string& path) {
  return (fs::path(file).parent_path() / path).string();
}

void expect_output_given(const std::string& output, const std::vector<std::pair<const char*, bool>>& options,
                         const char* noun) {
  if (!output.empty()) return;
  for (const auto& [name, given] : options)
    if (given) throw InputError(std::string(name) + " is given without -o; allowed: with -o; name the " + noun);
}

}  // namespace rvelab::cli
