#include "rvelab/cli/sheet_setup.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <set>
#include <span>

#include "rvelab/cli/ensemble.hpp"
#include "rvelab/cli/program_path.hpp"
#include "rvelab/cli/protocol_input.hpp"
#include "rvelab/cli/report.hpp"
#include "rvelab/cli/warnings.hpp"
#include "rvelab/error.hpp"
#include "rvelab/io/crc32c.hpp"
#include "rvelab/io/hdf5/schema.hpp"
#include "rvelab/io/hdf5/specimen_file.hpp"
#include "rvelab/io/publish.hpp"
#include "rvelab/keys/regular_file.hpp"
#include "rvelab/keys/table_reader.hpp"
#include "rvelab/sheet/fitted_models.hpp"

namespace rvelab::cli {
namespace {

namespace fs = std::filesystem;

std::string plan_path(const std::string& word) {
  if (is_path(word)) return word;
  if (const std::string path = installed_in("sheets", word); !path.empty()) return path;
  std::vector<std::string> names;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(shared_folder("protocols") / "sheets", ignored))
    names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  throw InputError("no plan \"" + word + "\" is installed" + keys::nearest_in_words(word, names) +
                   "; allowed: " + keys::listed(names) + ", or the path of a file PLAN.toml; give one");
}

/// The plan, with paths in the place of the names of protocols.
sheet::Plan plan_of(const std::string& path, const std::vector<std::string>& settings) {
  sheet::Plan plan = sheet::read_plan(keys::parse_toml_file(path), path, settings);
  const auto found = [&](const sheet::PlanTest& test, const std::string& word) {
    try {
      return protocol_path(is_path(word) ? from_folder_of(path, word) : word);
    } catch (const InputError& error) {
      throw InputError(path + ": test." + test.name + ": " + error.what());
    }
  };
  for (sheet::PlanTest& test : plan.tests) {
    test.protocol = found(test, test.protocol);
    if (!test.protocol_2D.empty()) test.protocol_2D = found(test, test.protocol_2D);
  }
  return plan;
}

SheetSpecimens specimens_of(const SheetArguments& arguments, const sheet::Plan& plan,
                            const std::vector<std::string>& settings) {
  const auto is_recipe = [](const std::string& word) {
    return !word.ends_with(".h5") && word.find_first_of("*?[") == std::string::npos;
  };
  const auto recipe = std::find_if(arguments.what.begin(), arguments.what.end(), is_recipe);
  if (recipe != arguments.what.end() && arguments.what.size() > 1)
    throw InputError("sheet: " + *recipe +
                     " is given beside others; allowed: one recipe, or specimens (*.h5); make a sheet of each soil");
  if (recipe != arguments.what.end())
    return specimens_of_recipe(plan, input_path(arguments.what.front(), InputKind::recipe), settings,
                               arguments.file("specimens"));
  if (!settings.empty())
    throw InputError(
        "--set " + settings.front() +
        " is given with specimens; allowed: keys of the plan (sheet, density, test), and with a recipe its "
        "keys; leave it out");
  return specimens_of_files(plan, files_of(arguments.what));
}

/// What the sheet cannot tell of so few specimens.
void add_remarks(SheetSetup& setup) {
  const auto& specimens = setup.specimens;
  setup.remarks.insert(setup.remarks.end(), specimens.remarks.begin(), specimens.remarks.end());
  std::vector<std::size_t> counts(specimens.groups.size());
  for (const SheetSpecimen& specimen : specimens.all) ++counts[specimen.group];
  std::vector<std::string> single;
  for (std::size_t k = 0; k < counts.size(); ++k)
    if (counts[k] == 1) single.push_back(specimens.groups[k].name);
  const std::string why = keys::listed(single) +
                          (single.size() == 1 ? " has one specimen: its" : " have one specimen each: their") +
                          " numbers have no standard error and no interval";
  if (single.size() == counts.size())
    setup.note = why;  // the numbers say it themselves
  else if (!single.empty())
    setup.remarks.push_back(why);
  if (counts.size() == 1)
    setup.remarks.push_back("there is one density: how numbers depend on the density is not known");
}

std::uint32_t digest_of(const Clump& clump) {
  std::uint32_t digest = 0;
  for (const auto& member : clump.members) {
    const std::array<double, 4> values{member.at[0], member.at[1], member.at[2], member.radius};
    digest = io::crc32c(std::as_bytes(std::span(values)), digest);
  }
  return digest;
}

/// What a folder is made for, so that --resume goes on with nothing else.
Json asked_for(const SheetSetup& setup) {
  Json asked{{"plan", setup.plan.resolved}, {"specimens", Json::array()}, {"protocols", Json::object()}};
  for (const SheetSpecimen& specimen : setup.specimens.all)
    asked["specimens"].push_back(setup.specimens.given ? Json(io::digest(io::read_specimen(specimen.file)))
                                                       : Json(specimen.recipe.resolved));
  // Of a file that a recipe names it says the name alone.
  for (const SheetSpecimen& specimen : setup.specimens.all)
    for (const pack::GrainFraction& fraction : specimen.recipe.recipe.fractions)
      if (fraction.clump && fraction.clump->name.ends_with(".csv"))
        asked["files"][fraction.clump->name] = digest_of(*fraction.clump);
  for (const sheet::TestVariant& variant : setup.variants)
    asked["protocols"][variant.name + variant.suffix] = variant.protocol.resolved;
  return asked;
}

std::string names_in(const Json& object) {
  std::vector<std::string> names;
  for (const auto& each : object.items()) names.push_back(each.key());
  return keys::listed(names);
}

/// InputError unless the folder is of this very sheet.
void expect_same(const std::string& file, const Json& asked) {
  Json there;
  try {
    there = Json::parse(keys::whole_file<std::string>(file, "asked.json"));
  } catch (const Json::exception&) {
    throw InputError(file + ": is damaged; allowed: what `rvelab sheet` wrote; start again with --force");
  }
  for (const auto& [part, value] : asked.items()) {
    if (there.is_object() && there.contains(part) && there[part] == value) continue;
    const std::string names = part == "files" ? " (" + names_in(value) + ")" : "";
    throw InputError(file + ": is of another sheet, whose " + part + names +
                     " differ; allowed: the same plan, recipe or specimens, and settings; give them, or another "
                     "folder, or start again with --force");
  }
}

/// With what was made of them, so that a sheet that stops is not taken for the old one.
void remove_records(const SheetArguments& arguments) {
  std::error_code ignored;
  for (const char* part : {"tests", "specimens"})
    for (const auto& entry : fs::directory_iterator(arguments.file(part), ignored))
      if (const auto ending = entry.path().extension(); ending == ".h5" || ending == ".journal")
        fs::remove(entry.path());
  sheet::remove_models(arguments.folder);
  for (const char* name : {"index.html", "summary.json", "summary.csv"}) fs::remove(arguments.file(name), ignored);
}

}  // namespace

SheetSetup setup_of(const SheetArguments& arguments) {
  std::vector<std::string> of_plan, of_recipe;
  for (const std::string& setting : arguments.settings) {
    for (const char* table : {"stage.", "loading.", "output."})
      if (setting.starts_with(table))
        throw InputError("--set " + setting +
                         " is a key of a protocol; allowed: keys of the plan (sheet, density, test) or of the recipe; "
                         "write for example --set 'test.drained.settings=[\"" +
                         setting + "\"]'");
    (sheet::is_of_plan(setting) ? of_plan : of_recipe).push_back(setting);
  }
  SheetSetup setup;
  setup.plan = plan_of(plan_path(arguments.quick ? "quick" : arguments.plan), of_plan);
  setup.specimens = specimens_of(arguments, setup.plan, of_recipe);
  setup.variants = sheet::variants_of(setup.plan, setup.specimens.dimension, setup.remarks);
  for (const sheet::TestVariant& variant : setup.variants)
    warn_of_units(variant.protocol.path, variant.protocol.doubts);
  add_remarks(setup);
  return setup;
}

std::vector<SheetTest> sheet_tests(const SheetSetup& setup) {
  std::vector<SheetTest> tests;
  const auto& all = setup.specimens.all;
  for (std::size_t s = 0; s < all.size(); ++s) {
    const std::string& density = setup.specimens.groups[all[s].group].name;
    for (std::size_t l = 0; l < setup.variants.size(); ++l) {
      const sheet::TestVariant& variant = setup.variants[l];
      if (sheet::goes_through(setup.plan, setup.plan.tests[variant.row], density, all[s].number))
        tests.push_back({s, l, variant.name_with(density, all[s].number)});
    }
  }
  std::set<std::string> names;
  for (const SheetTest& test : tests)
    if (!names.insert(test.name).second)
      throw InputError(
          setup.plan.path + ": two tests are called " + test.name +
          "; allowed: names of their own; rename a test or a density, or give pressures and amplitudes that "
          "differ in six digits");
  return tests;
}

void prepare_folder(const SheetArguments& arguments, const SheetSetup& setup) {
  const std::string own = arguments.file("asked.json");
  const Json asked = asked_for(setup);
  if ((arguments.resume || arguments.share) && fs::exists(own)) return expect_same(own, asked);
  make_folder(arguments.folder);
  std::vector<std::string> inputs{setup.plan.path};
  for (const SheetSpecimen& specimen : setup.specimens.all)
    if (setup.specimens.given) inputs.push_back(specimen.file);
  for (const char* name : {"asked.json", "index.html", "summary.json", "summary.csv"})
    io::expect_output(arguments.file(name), arguments.force || arguments.resume || arguments.share, inputs,
                      ", --resume to go on with the sheet");
  if (arguments.force && fs::exists(own)) remove_records(arguments);
  for (const char* part : {"tests", "specimens"}) make_folder(arguments.file(part));
  io::publish_text(own, json_text(asked));
}

}  // namespace rvelab::cli
