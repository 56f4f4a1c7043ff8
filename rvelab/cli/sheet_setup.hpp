// What a data sheet is made of: the plan, the specimens, the tests, and the folder that keeps them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "rvelab/cli/sheet_specimens.hpp"
#include "rvelab/sheet/plan.hpp"
#include "tools/models/models.hpp"

namespace rvelab::cli {

struct SheetArguments {
  std::vector<std::string> what;  ///< a recipe, or specimens
  std::string folder, plan = "standard", beside;
  std::vector<std::string> settings, models = models::names();
  unsigned threads = 0;
  bool quick = false, force = false, resume = false, share = false, json = false;

  std::string file(const std::string& name) const { return (std::filesystem::path(folder) / name).string(); }
};

struct SheetSetup {
  sheet::Plan plan;
  std::vector<sheet::TestVariant> variants;
  SheetSpecimens specimens;
  std::vector<std::string> remarks;  ///< what is left out, and why; on the sheet too
  std::string note;                  ///< the same, for the terminal alone; "": none
};

/// A test of the sheet: a specimen and what it goes through.
struct SheetTest {
  std::size_t specimen = 0, variant = 0;
  std::string name;
};

/// The plan with its protocols, and the specimens as they are to be packed or were given. InputError for every mistake
/// of plan, recipe, specimens and settings.
SheetSetup setup_of(const SheetArguments& arguments);

/// Every test, those of a specimen one after the other. InputError: two have one name.
std::vector<SheetTest> sheet_tests(const SheetSetup& setup);

/// Makes the folder, or finds in it that it is of this very sheet. InputError: it is of another one, or has one already
/// and neither --resume nor --force is given.
void prepare_folder(const SheetArguments& arguments, const SheetSetup& setup);

}  // namespace rvelab::cli
