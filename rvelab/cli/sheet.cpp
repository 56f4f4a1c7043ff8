// rvelab sheet: the data sheet of a soil, from a recipe or specimens by a plan of tests. Declared in command.hpp.
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <optional>

#include "rvelab/cli/columns.hpp"
#include "rvelab/cli/command.hpp"
#include "rvelab/cli/ensemble.hpp"
#include "rvelab/cli/program_path.hpp"
#include "rvelab/cli/protocol_input.hpp"
#include "rvelab/cli/sharing.hpp"
#include "rvelab/cli/sheet_cost.hpp"
#include "rvelab/cli/sheet_specimens.hpp"
#include "rvelab/cli/warnings.hpp"
#include "rvelab/error.hpp"
#include "rvelab/io/hdf5/schema.hpp"
#include "rvelab/io/hdf5/specimen_file.hpp"
#include "rvelab/io/publish.hpp"
#include "rvelab/keys/regular_file.hpp"
#include "rvelab/sheet/beside.hpp"
#include "rvelab/sheet/numbers.hpp"
#include "rvelab/sheet/write_sheet.hpp"

namespace rvelab::cli {
namespace {

namespace fs = std::filesystem;

struct SheetArguments {
  std::vector<std::string> what;  ///< a recipe, or specimens
  std::string folder, plan = "standard", beside;
  std::vector<std::string> settings;
  unsigned threads = 0;
  bool quick = false, force = false, resume = false, share = false, json = false;

  std::string file(const std::string& name) const { return (fs::path(folder) / name).string(); }
};

struct SheetSetup {
  sheet::Plan plan;
  std::vector<sheet::TestVariant> variants;
  SheetSpecimens specimens;
  std::vector<std::string> remarks;  ///< what is left out, and why
};

/// A test of the sheet: a specimen and what it goes through.
struct SheetTest {
  std::size_t specimen = 0, variant = 0;
  std::string name;
};

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
  if (!single.empty())
    setup.remarks.push_back(keys::listed(single) +
                            (single.size() == 1 ? " has one specimen: its" : " have one specimen each: their") +
                            " numbers have no standard error and no interval");
  if (counts.size() == 1)
    setup.remarks.push_back("there is one density: how numbers depend on the density is not known");
}

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

/// Every test, those of a specimen one after the other.
std::vector<SheetTest> tests_of(const SheetSetup& setup) {
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
  return tests;
}

/// What a folder is made for, so that --resume goes on with nothing else.
Json asked_for(const SheetSetup& setup) {
  Json asked{{"plan", setup.plan.resolved}, {"specimens", Json::array()}, {"protocols", Json::object()}};
  for (const SheetSpecimen& specimen : setup.specimens.all)
    asked["specimens"].push_back(setup.specimens.given ? Json(io::digest(io::read_specimen(specimen.file)))
                                                       : Json(specimen.recipe.resolved));
  for (const sheet::TestVariant& variant : setup.variants)
    asked["protocols"][variant.name + variant.suffix] = variant.protocol.resolved;
  return asked;
}

/// InputError unless the folder is of this very sheet.
void expect_same(const std::string& file, const Json& asked) {
  Json there;
  try {
    there = Json::parse(keys::whole_file<std::string>(file, "asked.json"));
  } catch (const Json::exception&) {
    throw InputError(file + ": is damaged; allowed: what `rvelab sheet` wrote; start again with --force");
  }
  for (const auto& [part, value] : asked.items())
    if (!there.is_object() || !there.contains(part) || there[part] != value)
      throw InputError(file + ": is of another sheet, whose " + part +
                       " differ; allowed: the same plan, recipe or specimens, and settings; give them, or another "
                       "folder, or start again with --force");
}

void remove_records(const SheetArguments& arguments) {
  std::error_code ignored;
  for (const char* part : {"tests", "specimens"})
    for (const auto& entry : fs::directory_iterator(arguments.file(part), ignored))
      if (const auto ending = entry.path().extension(); ending == ".h5" || ending == ".journal")
        fs::remove(entry.path());
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

std::string counted(std::size_t count, const std::string& noun, const std::string& plural = "") {
  return std::to_string(count) + " " + (count == 1 ? noun : plural.empty() ? noun + "s" : plural);
}

void tell_size(const SheetSetup& setup, const std::vector<SheetTest>& tests) {
  const std::size_t densities = setup.specimens.groups.size(), specimens = setup.specimens.all.size();
  std::vector<std::size_t> of_specimen(specimens);
  for (const SheetTest& test : tests) ++of_specimen[test.specimen];
  tell(counted(densities, "density", "densities") + ", " + counted(specimens, "specimen") + ", " +
       counted(tests.size(), "test") + ", up to " +
       std::to_string(*std::max_element(of_specimen.begin(), of_specimen.end())) + " on a specimen");
  for (const std::string& remark : setup.remarks) tell(remark);
}

sheet::Test made_test(const SheetSetup& setup, const SheetTest& planned, protocol::TestRun&& run) {
  const SheetSpecimen& specimen = setup.specimens.all[planned.specimen];
  const SpecimenGroup& group = setup.specimens.groups[specimen.group];
  const sheet::TestVariant& variant = setup.variants[planned.variant];
  sheet::Test test;
  test.name = planned.name;
  test.purpose = setup.plan.tests[variant.row].purpose;
  test.density = specimen.group;
  test.density_name = group.name;
  test.relative_density = group.relative_density;
  test.seed = specimen.seed;
  test.pressure = variant.pressure;
  test.amplitude = variant.amplitude;
  if (!run.result.records.empty()) test.void_ratio = run.result.records.front().void_ratio;
  test.dimension = setup.specimens.dimension;
  test.protocol = variant.protocol;
  test.result = std::move(run.result);
  return test;
}

/// The tests that came to their end; `failures` gets why others did not. None: other processes have the rest in hand.
std::optional<std::vector<sheet::Test>> made_tests(const SheetArguments& arguments, const SheetSetup& setup,
                                                   const std::vector<SheetTest>& planned, unsigned threads,
                                                   std::vector<std::string>& failures) {
  std::vector<SheetCost::Planned> costs;
  std::size_t of_first = 0;
  std::vector<RecordedTest> tests;
  std::optional<SheetCost> cost;
  for (const SheetTest& each : planned) {
    const std::string& specimen = setup.specimens.all[each.specimen].file;
    const std::size_t number = tests.size();
    RecordedTest test{{each.name, &setup.variants[each.variant].protocol,
                       [&cost, &specimen, number] {
                         cost->begins(number);
                         return io::read_specimen(specimen);
                       }},
                      (fs::path(arguments.folder) / "tests" / (each.name + ".h5")).string()};
    costs.push_back({each.variant, test.file});
    of_first += each.specimen == planned.front().specimen ? 1 : 0;
    tests.push_back(std::move(test));
  }
  const Ranks ranks = arguments.share ? launched_ranks() : Ranks{};
  if (ranks.rank > 0) of_first = tests.size() + 1;  // the first rank alone says what the rest takes
  cost.emplace(std::move(costs), of_first, std::min<std::size_t>(threads, tests.size()), ranks.count);
  TestOptions options;
  options.threads = threads;
  options.resume = true;  // the folder is of this sheet
  options.share = arguments.share;
  std::vector<std::optional<sheet::Test>> made(tests.size());
  auto failed = run_tests(tests, options, Opening::one_by_one, [&](std::size_t k, protocol::TestRun&& run) {
    made[k] = made_test(setup, planned[k], std::move(run));
  });
  if (!failed) return std::nullopt;
  std::erase(*failed, "");
  failures.insert(failures.end(), failed->begin(), failed->end());
  std::vector<sheet::Test> complete;
  for (auto& test : made)
    if (test) complete.push_back(std::move(*test));
  return complete;
}

/// Numbers of all pressures together; the others are in the files.
void print(const SheetArguments& arguments, const sheet::Sheet& sheet) {
  if (arguments.json) {
    std::cout << keys::whole_file<std::string>(arguments.file("summary.json"), "summary.json") << std::flush;
    return;
  }
  std::vector<std::vector<std::string>> rows{{"number", "density", "value", "95 % interval", "unit", "tests"}};
  for (const sheet::Number& number : sheet.numbers) {
    if (number.pressure > 0) continue;
    const double half = 0.5 * (number.high - number.low);
    const auto shown = [&](double value) { return in_digits_of(value, half); };
    rows.push_back({number.label, number.density_name.empty() ? "all" : number.density_name, shown(number.mean),
                    half > 0 ? shown(number.low) + " to " + shown(number.high) : "-", number.unit,
                    std::to_string(number.tests.size())});
  }
  if (rows.size() > 1) std::cout << aligned(rows) << "\n";
  std::cout << "files   " << arguments.folder << "/index.html, summary.json, summary.csv, tests/" << std::endl;
}

void run_sheet(const SheetArguments& arguments) {
  if (sheet::Sheet empty; !arguments.beside.empty()) sheet::add_measured(empty, arguments.beside);  // its mistakes
  SheetSetup setup = setup_of(arguments);
  prepare_folder(arguments, setup);
  std::vector<SheetTest> tests = tests_of(setup);
  const Ranks ranks = arguments.share ? launched_ranks() : Ranks{};
  const unsigned threads = arguments.threads > 0 ? arguments.threads : threads_of(ranks);
  if (ranks.rank == 0) tell_size(setup, tests);
  std::vector<std::string> failures;
  const std::size_t planned = tests.size();
  const std::vector<std::string> unpacked = pack_specimens(setup.specimens, threads, arguments.share);
  std::erase_if(tests, [&](const SheetTest& test) { return !unpacked[test.specimen].empty(); });
  std::copy_if(unpacked.begin(), unpacked.end(), std::back_inserter(failures),
               [](const std::string& why) { return !why.empty(); });
  std::optional<std::vector<sheet::Test>> made{std::in_place};
  if (!tests.empty()) made = made_tests(arguments, setup, tests, threads, failures);
  if (!made) return;
  for (const std::string& failure : failures) tell(failure);
  if (made->empty()) throw Error(arguments.folder + ": no test could be carried out, so there is no sheet");
  sheet::Sheet sheet = sheet::numbers_of(*made, setup.specimens.soil);
  sheet.remarks.insert(sheet.remarks.end(), setup.remarks.begin(), setup.remarks.end());
  sheet.remarks.insert(sheet.remarks.end(), failures.begin(), failures.end());
  if (!arguments.beside.empty()) sheet::add_measured(sheet, arguments.beside);
  sheet::write_sheet(sheet, {}, arguments.folder);
  print(arguments, sheet);
  if (made->size() < planned)
    throw Error(std::to_string(planned - made->size()) + " of " + std::to_string(planned) +
                " tests could not be carried out; the sheet is of the others");
}

}  // namespace

void add_sheet(CLI::App& app) {
  CLI::App& command =
      *app.add_subcommand("sheet", "Make the data sheet of a soil: a plan of tests, its numbers on one page");
  const auto arguments = std::make_shared<SheetArguments>();
  command
      .add_option(
          "what", arguments->what,
          "RECIPE.toml, or the name of an installed recipe: toyoura; or specimens,\n\"dense_*.h5\", those whose "
          "names differ by a number at the end are of one density")
      ->required();
  command.add_option("-o,--output", arguments->folder, "folder for index.html, summary.json, summary.csv and tests/")
      ->required();
  command.add_option("--plan", arguments->plan,
                     "PLAN.toml, or the name of an installed one: standard (default), quick");
  command.add_flag("--quick", arguments->quick, "as --plan quick: few grains, within minutes")->excludes("--plan");
  command.add_option("--beside", arguments->beside,
                     "MEASURED.toml: numbers and curves of a laboratory to draw beside those of the sheet");
  add_set(command, arguments->settings, "pack.number=2000 of the recipe, sheet.seeds=5 of the plan");
  add_threads(command, arguments->threads, "specimens or tests at a time; default: one per core");
  command.add_flag("--force", arguments->force, "start again in a folder that holds a sheet; its tests are removed");
  command.add_flag("--resume", arguments->resume, "go on with a sheet that was stopped or killed")->excludes("--force");
  command
      .add_flag("--share", arguments->share,
                "share the tests with other processes that are given the same command: ranks\n"
                "of mpirun, or shells; as --resume, in a folder with locks that all see")
      ->excludes("--force");
  add_json(command, arguments->json);
  command.footer(
      "Specimens of several densities and seeds are packed and go through the tests of a plan: drained and undrained\n"
      "triaxial tests (biaxial in the plane), oedometer, isotropic compression with probes of the stiffness, simple\n"
      "shear, cyclic shear. The page has the numbers that practice asks for, with mean and 95 % interval. --set "
      "changes\n"
      "keys of the plan (sheet., density.NAME., test.NAME.) and, all others, of the recipe. Any number of threads or\n"
      "ranks gives the same bits. Plans: protocols/sheets.\n"
      "Examples:\n"
      "  rvelab sheet toyoura -o SHEET --quick\n"
      "  rvelab sheet sand.toml -o SHEET --set sheet.seeds=5 --set density.dense.relative_density=0.8\n"
      "  rvelab sheet 'dense_*.h5' 'loose_*.h5' -o SHEET --plan mine.toml\n"
      "  mpirun -n 8 rvelab sheet sand.toml -o SHEET --share");
  command.callback([arguments] { run_sheet(*arguments); });
}

}  // namespace rvelab::cli
