// rvelab sheet: the data sheet of a soil, from a recipe or specimens by a plan of tests. Declared in command.hpp.
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <optional>

#include "rvelab/cli/columns.hpp"
#include "rvelab/cli/command.hpp"
#include "rvelab/cli/report.hpp"
#include "rvelab/cli/sharing.hpp"
#include "rvelab/cli/sheet_cost.hpp"
#include "rvelab/cli/sheet_setup.hpp"
#include "rvelab/ensemble/statistics.hpp"
#include "rvelab/error.hpp"
#include "rvelab/io/hdf5/specimen_file.hpp"
#include "rvelab/keys/regular_file.hpp"
#include "rvelab/sheet/beside.hpp"
#include "rvelab/sheet/fitted_models.hpp"
#include "rvelab/sheet/numbers.hpp"
#include "rvelab/sheet/write_sheet.hpp"

namespace rvelab::cli {
namespace {

namespace fs = std::filesystem;

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
  if (!setup.note.empty()) tell(setup.note);
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
  test.seed = specimen.number + 1;  // those of a number, over densities, make one estimate
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
    const auto shown = [&](double value) { return ensemble::in_digits_of(value, half); };
    rows.push_back({number.label, number.density_name.empty() ? "all" : number.density_name, shown(number.mean),
                    half > 0 ? shown(number.low) + " to " + shown(number.high) : "-", number.unit,
                    std::to_string(number.tests.size())});
  }
  if (rows.size() > 1) std::cout << aligned(rows) << "\n";
  std::cout << "files   " << arguments.folder << "/index.html, summary.json, summary.csv, models/, tests/" << std::endl;
}

void run_sheet(const SheetArguments& arguments) {
  if (sheet::Sheet empty; !arguments.beside.empty()) sheet::add_measured(empty, arguments.beside);  // its mistakes
  for (const std::string& model : arguments.models) models::of_one_density(model);                  // its spelling
  SheetSetup setup = setup_of(arguments);
  std::vector<SheetTest> tests = sheet_tests(setup);
  prepare_folder(arguments, setup);
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
  for (const auto* each : {&setup.remarks, &failures})
    for (const std::string& remark : *each) sheet.remarks.push_back(remark + ".");
  Workers workers(threads);
  const sheet::FittedModels models = sheet::fitted_models(arguments.models, *made, sheet, workers);
  sheet.remarks.insert(sheet.remarks.end(), models.remarks.begin(), models.remarks.end());
  if (!arguments.beside.empty()) sheet::add_measured(sheet, arguments.beside);
  sheet::write_models(models, arguments.folder);
  sheet::write_sheet(sheet, models.fits, arguments.folder);
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
  command
      .add_option(
          "--models", arguments->models,
          "continuum models to fit: mohr_coulomb, hardening_soil_small, norsand,\nhypoplasticity (default: all)")
      ->delimiter(',');
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
