#include "rvelab/cli/sheet_specimens.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <map>
#include <optional>
#include <thread>

#include "rvelab/cli/ensemble.hpp"
#include "rvelab/cli/interrupt.hpp"
#include "rvelab/cli/packing_file.hpp"
#include "rvelab/cli/progress_line.hpp"
#include "rvelab/cli/sharing.hpp"
#include "rvelab/cli/warnings.hpp"
#include "rvelab/error.hpp"
#include "rvelab/io/hdf5/schema.hpp"
#include "rvelab/io/hdf5/specimen_file.hpp"
#include "rvelab/io/journal/journal.hpp"
#include "rvelab/keys/table_reader.hpp"
#include "rvelab/pack/search.hpp"

namespace rvelab::cli {
namespace {

namespace fs = std::filesystem;

/// "dense" of "folder/S_dense_07.h5".
std::string group_of(const std::string& file) {
  std::string stem = fs::path(file).stem().string();
  if (stem.starts_with("S_")) stem.erase(0, 2);
  const auto last = stem.find_last_not_of("0123456789");
  if (last == std::string::npos) return "given";  // nothing but a number
  if (last + 1 < stem.size() && (stem[last] == '_' || stem[last] == '-')) stem.erase(last);
  return stem.empty() ? "given" : stem;
}

/// First ones of all groups, then second ones: a sheet that is stopped has something of each density.
void sort_by_number(SheetSpecimens& specimens) {
  std::stable_sort(specimens.all.begin(), specimens.all.end(),
                   [](const SheetSpecimen& a, const SheetSpecimen& b) { return a.number < b.number; });
}

/// InputError for a setting of the recipe that says what the plan says of each density.
void expect_density_of_plan(const sheet::Plan& plan, const std::vector<std::string>& settings) {
  for (const std::string& setting : settings)
    for (const char* key : {"target.relative_density", "target.void_ratio", "target.porosity"})
      for (const sheet::PlanDensity& density : plan.densities) {
        if (setting.substr(0, setting.find_first_of(" =")) != key || (!density.relative_density && !density.void_ratio))
          continue;
        const std::string own =
            "density." + density.name + (density.relative_density ? ".relative_density" : ".void_ratio");
        throw InputError("--set " + setting + " contradicts " + own + " of " + plan.path +
                         "; allowed: the density of each group of specimens; give --set " + own +
                         "=VALUE in its place");
      }
}

/// The recipe for specimens of a density, in the place of that of the recipe.
pack::RecipeFile recipe_for(const sheet::Plan& plan, const sheet::PlanDensity& density, const std::string& path,
                            const std::vector<std::string>& settings) {
  toml::table file = keys::parse_toml_file(path);
  if (toml::table* const target = file["target"].as_table(); target != nullptr) {
    if (density.relative_density || density.void_ratio)
      for (const char* name : {"void_ratio", "porosity", "relative_density"}) target->erase(name);
    if (plan.pressure)
      for (const char* name : {"stress_Pa", "pressures_Pa", "pressure_Pa"}) target->erase(name);
  }
  std::vector<std::string> assignments = plan.recipe_settings(density);
  assignments.insert(assignments.end(), settings.begin(), settings.end());
  try {
    return pack::parse_recipe(keys::written_file(file), path, assignments);
  } catch (const InputError& error) {
    throw InputError("density." + density.name + " of " + plan.path + ": " + error.what());
  }
}

enum class PackState { open, elsewhere, there, failed };

/// Makes the specimen; none: it was stopped, or cannot be packed, and `failure` says why.
std::optional<pack::Packing> packing_of(const SheetSpecimen& specimen, TerminalLine& line, std::string& failure) {
  pack::PackWatch watch;
  watch.stop = &stop_on_signals();
  const std::string name = fs::path(specimen.file).stem().string();
  watch.on_draw = [&](long draw, double void_ratio) {
    line.write(name + "  packing " + std::to_string(draw) + "  void ratio " + in_words(void_ratio));
  };
  Workers alone(1);
  try {
    return pack::pack(specimen.recipe.recipe, alone, watch);
  } catch (const InputError&) {
    throw;
  } catch (const Interrupted&) {
  } catch (const Error& error) {
    failure = name + " could not be packed: " + error.what();
  }
  return std::nullopt;
}

/// Packs one, unless another process has it in hand.
PackState packed(const SheetSpecimen& specimen, TerminalLine& line, std::string& failure) {
  if (fs::exists(specimen.file)) return PackState::there;
  try {
    const io::Journal lock(specimen.file + ".journal");  // never begun: it vanishes with the lock
    if (fs::exists(specimen.file)) return PackState::there;
    const auto packing = packing_of(specimen, line, failure);
    if (!packing) return failure.empty() ? PackState::open : PackState::failed;
    write_packing(*packing, specimen.recipe, specimen.file);
    return PackState::there;
  } catch (const io::Busy&) {
    return PackState::elsewhere;
  }
}

}  // namespace

SheetSpecimens specimens_of_recipe(const sheet::Plan& plan, const std::string& recipe,
                                   const std::vector<std::string>& settings, const std::string& folder) {
  SheetSpecimens specimens;
  pack::read_recipe(recipe);  // its mistakes, with their lines
  expect_density_of_plan(plan, settings);
  for (const sheet::PlanDensity& density : plan.densities) {
    const pack::RecipeFile file = recipe_for(plan, density, recipe, settings);
    if (specimens.groups.empty()) warn_of_units(recipe, file.doubts);
    specimens.soil = file.name;
    specimens.dimension = dimension_of(file.recipe.shape);
    for (std::size_t number = 0; number < std::size_t(plan.seeds); ++number) {
      const std::uint64_t seed = file.recipe.seed + number;
      const std::string name = "S_" + density.name + "_" + std::to_string(number + 1) + ".h5";
      specimens.all.push_back(
          {(fs::path(folder) / name).string(), specimens.groups.size(), number, seed, file.member(seed)});
    }
    specimens.groups.push_back({density.name, density.relative_density.value_or(sheet::unknown)});
  }
  sort_by_number(specimens);
  return specimens;
}

SheetSpecimens specimens_of_files(const sheet::Plan& plan, const std::vector<std::string>& files) {
  SheetSpecimens specimens;
  specimens.given = true;
  specimens.soil = fs::path(files.front()).stem().string();
  std::map<std::string, std::size_t> numbers;
  std::vector<std::uint32_t> digests;
  for (const std::string& file : files) {
    const Specimen specimen = io::read_specimen(file);
    digests.push_back(io::digest(specimen));
    expect_another(files, digests);
    if (digests.size() > 1 && specimen.cell.dimension != specimens.dimension)
      throw InputError(file + " is " + std::to_string(specimen.cell.dimension) + "D and " + files.front() + " is " +
                       std::to_string(specimens.dimension) + "D; allowed: specimens of one dimension; leave one out");
    specimens.dimension = specimen.cell.dimension;
    warn_of_largest_grain(file, specimen);
    const std::string name = group_of(file);
    auto group = std::find_if(specimens.groups.begin(), specimens.groups.end(),
                              [&](const SpecimenGroup& each) { return each.name == name; });
    if (group == specimens.groups.end()) {
      const auto planned = std::find_if(plan.densities.begin(), plan.densities.end(),
                                        [&](const sheet::PlanDensity& each) { return each.name == name; });
      const bool known = planned != plan.densities.end();
      if (!known)
        specimens.remarks.push_back("the relative density of " + name +
                                    " is not known: no density of the plan has this name, which is that of its files");
      specimens.groups.push_back({name, known ? planned->relative_density.value_or(sheet::unknown) : sheet::unknown});
      group = specimens.groups.end() - 1;
    }
    const std::size_t number = numbers[name]++;
    specimens.all.push_back(
        {file, std::size_t(group - specimens.groups.begin()), number, std::uint64_t(number + 1), {}});
  }
  sort_by_number(specimens);
  return specimens;
}

std::vector<std::string> pack_specimens(const SheetSpecimens& specimens, unsigned threads, bool share) {
  const auto& all = specimens.all;
  std::vector<std::string> failures(all.size());
  if (specimens.given) return failures;
  std::vector<PackState> states(all.size(), PackState::open);
  std::atomic<std::size_t> there{0};
  const auto some = [&](PackState state) { return std::find(states.begin(), states.end(), state) != states.end(); };
  const auto made = [&] {
    return " with " + std::to_string(there) + " of " + std::to_string(all.size()) +
           " specimens packed; continue with --resume";
  };
  const std::atomic<bool>& stop = stop_on_signals();
  const Ranks ranks = share ? launched_ranks() : Ranks{};
  const std::size_t first = all.size() * ranks.rank / ranks.count;  // ranks begin apart
  TerminalLine line;
  Workers workers(unsigned(std::min<std::size_t>(threads, all.size())));
  {
    const EndInASecond end(made);
    while ((some(PackState::open) || some(PackState::elsewhere)) && !stop.load()) {
      workers.for_each_in_turn(all.size(), [&](std::size_t turn) {
        const std::size_t k = (first + turn) % all.size();
        if ((states[k] != PackState::open && states[k] != PackState::elsewhere) || stop.load()) return;
        states[k] = packed(all[k], line, failures[k]);
        if (states[k] == PackState::there) ++there;
      });
      if (!some(PackState::elsewhere)) continue;
      if (!share)
        throw InputError(fs::path(all.front().file).parent_path().string() +
                         ": another rvelab packs specimens there; allowed: --share for both; wait for it, or give "
                         "another folder");
      std::this_thread::sleep_for(std::chrono::milliseconds(200));
    }
    line.write("");
  }
  if (stop.load()) end_stopped(made());
  return failures;
}

}  // namespace rvelab::cli
