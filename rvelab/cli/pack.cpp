// rvelab pack: specimens from a recipe. Declared in command.hpp.
#include <algorithm>
#include <atomic>
#include <charconv>
#include <chrono>
#include <filesystem>
#include <iostream>
#include <mutex>
#include <thread>

#include "rvelab/cli/columns.hpp"
#include "rvelab/cli/command.hpp"
#include "rvelab/cli/grading_sizes.hpp"
#include "rvelab/cli/interrupt.hpp"
#include "rvelab/cli/packing_file.hpp"
#include "rvelab/cli/progress_line.hpp"
#include "rvelab/cli/protocol_input.hpp"
#include "rvelab/cli/report.hpp"
#include "rvelab/cli/warnings.hpp"
#include "rvelab/error.hpp"
#include "rvelab/io/publish.hpp"
#include "rvelab/measure/measures.hpp"
#include "rvelab/pack/plausible.hpp"
#include "rvelab/pack/read_recipe.hpp"
#include "rvelab/pack/search.hpp"
#include "rvelab/solver/rve.hpp"

namespace rvelab::cli {
namespace {

struct PackArguments {
  std::string recipe, output;
  std::vector<std::string> settings;
  std::size_t count = 1;
  unsigned threads = 0;
  bool force = false, json = false;
};

/// One specimen to make, and its results.
struct Job {
  pack::RecipeFile what;
  std::string file;
  Json made;  ///< null: not made
  Sizes sizes;
};

/// "S.h5" with a word before its extension: "S_20000Pa.h5".
std::string with_word(const std::string& file, const std::string& word) {
  const std::filesystem::path path = file;
  return (path.parent_path() / (path.stem().string() + "_" + word + path.extension().string())).string();
}

/// For each pressure of the recipe the wanted number of specimens, with consecutive seeds.
std::vector<Job> jobs_of(const pack::RecipeFile& file, const PackArguments& arguments) {
  std::vector<Job> jobs;
  const std::size_t digits = std::to_string(arguments.count).size();
  const auto add = [&](std::optional<double> pressure, const std::string& name) {
    for (std::size_t k = 0; k < arguments.count; ++k) {
      const std::string number = std::to_string(k + 1);
      const std::string padded = std::string(digits - number.size(), '0') + number;
      jobs.push_back(
          {file.member(file.recipe.seed + k, pressure), arguments.count > 1 ? with_word(name, padded) : name, {}, {}});
    }
  };
  if (file.pressures.empty()) add(std::nullopt, arguments.output);
  for (const double pressure : file.pressures) {
    char digits_of[32];
    const auto end = std::to_chars(digits_of, digits_of + sizeof digits_of, pressure, std::chars_format::fixed).ptr;
    add(pressure, with_word(arguments.output, std::string(digits_of, end) + "Pa"));
  }
  return jobs;
}

Json summary_of(Job& job, const pack::Packing& packing, double seconds) {
  const Rve rve(packing.specimen);
  const Network network = rve.network();
  const int dimension = network.dimension();
  job.sizes = sizes_of(network);
  Json made;
  made["file"] = job.file;
  made["seed"] = job.what.recipe.seed;
  made["void_ratio"] = packing.void_ratio;
  made.update(drawn_sizes(packing.specimen));
  made["stress_Pa"] = row_major(rve.stress().topLeftCorner(dimension, dimension));
  if (network.has_bodies() && !network.has_solids()) made["members"] = network.members.size();
  made["contacts"] = network.contacts.size();
  made["coordination_number"] = coordination_number(network);
  made["mechanical_coordination_number"] = mechanical_coordination_number(network);
  made["fabric_anisotropy"] = network.contacts.empty() ? Json() : Json(fabric_anisotropy(fabric(network), dimension));
  made["fabric"] = network.contacts.empty() ? Json() : row_major(fabric(network).topLeftCorner(dimension, dimension));
  made["unbalanced_force_ratio"] = rve.unbalanced_ratio();
  made["draw"] = packing.draw;
  made["preparation_friction"] = packing.preparation_friction;
  if (packing.agitation) {
    made["expansion"] = packing.agitation->expansion;
    made["strain_difference"] = packing.agitation->strain_difference;
  }
  made["wall_s"] = seconds;
  return made;
}

/// Makes one specimen and writes it; only one file is written at a time.
void make(Job& job, Workers& workers, TerminalLine& line, std::mutex& files, std::atomic<std::size_t>& written) {
  const auto begin = std::chrono::steady_clock::now();
  pack::PackWatch watch;
  watch.stop = &stop_on_signals();
  const auto words = [&](long draw) {
    return "seed " + std::to_string(job.what.recipe.seed) + "  packing " + std::to_string(draw) + "  ";
  };
  watch.on_draw = [&](long draw, double void_ratio) { line.write(words(draw) + "void ratio " + in_words(void_ratio)); };
  if (line.on_terminal())
    watch.on_phase = [&](long draw, const std::string& phase) { line.write_at_times(words(draw) + phase); };
  const pack::Packing packing = pack::pack(job.what.recipe, workers, watch);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
  job.made = summary_of(job, packing, seconds.count());
  const std::lock_guard lock(files);
  write_packing(packing, job.what, job.file);
  ++written;
}

/// One line per specimen; all results are in --json.
std::string table_of(const std::vector<Job>& jobs) {
  std::vector<std::vector<std::string>> rows{{"file", "seed", "packing", "void ratio", "p, Pa", "contacts a grain",
                                              "overlap, %", "friction while packed", "d10, d50, d90, m"}};
  for (const Job& job : jobs) {
    const auto shown = [&](const char* key) { return in_digits(job.made[key].get<double>(), 4); };
    rows.push_back({job.file, job.made["seed"].dump(), job.made["draw"].dump(), shown("void_ratio"),
                    in_digits(job.sizes.pressure, 4), shown("coordination_number"),
                    two_digits(100 * job.sizes.proportions.mean_overlap), shown("preparation_friction"),
                    shown("d10_m") + ", " + shown("d50_m") + ", " + shown("d90_m")});
  }
  return aligned(rows);
}

void report(const pack::RecipeFile& file, const std::vector<Job>& jobs, bool json) {
  Listing listing;
  listing.add("recipe", file.name);
  if (!file.doubts.empty()) listing.add_to_json("unusual", file.doubts);
  const Json asked = asked_sizes(file.recipe);
  for (const auto& [key, value] : asked.items()) listing.add(key, value, unit_of_size(key));
  if (jobs.size() == 1) {
    const auto unit = [](const std::string& key) {
      return key.ends_with("_Pa") ? "Pa" : key == "wall_s" ? "s" : unit_of_size(key);
    };
    for (const auto& [key, value] : jobs.front().made.items()) listing.add(key, value, unit(key));
    add_proportions(listing, jobs.front().sizes);
  } else {
    Json rows = Json::array();
    for (const Job& job : jobs) {
      rows.push_back(job.made);
      rows.back().update(cli::as_json(job.sizes));
    }
    listing.add_to_json("specimens", std::move(rows));
  }
  listing.print(json);
  if (jobs.size() > 1 && !json) std::cout << table_of(jobs) << std::flush;
}

/// Warns before a long packing; the time is that of one core, since each draw runs on one.
void warn_of_cost(const pack::Recipe& recipe) {
  constexpr double long_time = 600;  // s
  const double seconds = pack::expected_seconds(recipe);
  if (!(seconds > long_time)) return;
  const bool searched = recipe.stress && recipe.void_ratio;
  tell(std::string(searched ? "each trial packing" : "this packing") + " takes some " + duration_in_words(seconds) +
       ", by packings of the same shape that were measured; Ctrl-C or SIGTERM stops it" +
       (moves_as_body(recipe.shape) ? "; superellipsoids of smaller exponents or of more equal half axes need less"
                                    : "; fewer grains need less"));
}

void run_pack(const PackArguments& arguments) {
  const std::string recipe = input_path(arguments.recipe, InputKind::recipe);
  const pack::RecipeFile file = pack::read_recipe(recipe, arguments.settings);
  warn_of_units(recipe, file.doubts);
  expect_folder_of(arguments.output);
  std::vector<Job> jobs = jobs_of(file, arguments);
  for (const Job& job : jobs) io::expect_output(job.file, arguments.force, {recipe});
  warn_of_cost(file.recipe);
  const unsigned threads =
      arguments.threads > 0 ? arguments.threads : std::max(1u, std::thread::hardware_concurrency());
  TerminalLine line;
  std::mutex files;
  std::atomic<std::size_t> written{0};
  const auto made = [&] {
    return std::to_string(written) + " of " + std::to_string(jobs.size()) + " specimens are made, and their files kept";
  };
  try {
    const EndInASecond end([&] {
      files.lock();  // for good
      line.write("");
      return "; " + made();
    });
    if (jobs.size() == 1) {
      Workers workers(threads);
      make(jobs.front(), workers, line, files, written);
    } else {
      Workers workers(unsigned(std::min<std::size_t>(threads, jobs.size())));
      workers.for_each_in_turn(jobs.size(), [&](std::size_t k) {
        Workers alone(1);
        try {
          make(jobs[k], alone, line, files, written);
        } catch (const InputError&) {
          throw;
        } catch (const Interrupted&) {
          throw;
        } catch (const Error& error) {
          throw Error(jobs[k].file + ", seed " + std::to_string(jobs[k].what.recipe.seed) + ": " + error.what());
        }
      });
    }
  } catch (const Interrupted&) {
    end_stopped("; " + made());
  } catch (const InputError&) {
    throw;
  } catch (const Error& error) {
    if (jobs.size() == 1) throw;
    throw Error(std::string(error.what()) + "; " + made());
  }
  report(file, jobs, arguments.json);
}

}  // namespace

void add_pack(CLI::App& app) {
  CLI::App& command = *app.add_subcommand("pack", "Make specimens from a recipe in TOML");
  const auto arguments = std::make_shared<PackArguments>();
  command.add_option("recipe", arguments->recipe, "RECIPE.toml, or the name of an installed recipe: pack_dense")
      ->required();
  command.add_option("-o,--output", arguments->output, "specimen file to write, S.h5")->required();
  command.add_option("--count", arguments->count, "number of specimens, S_1.h5, S_2.h5, ..., each with the next seed")
      ->check(CLI::Range(1, 1'000'000));
  add_set(command, arguments->settings, "target.pressure_Pa=50e3");
  add_threads(command, arguments->threads, "specimens or trial packings at a time; default: one per core");
  add_force(command, arguments->force, "existing specimen files");
  add_json(command, arguments->json);
  command.footer(
      "The same recipe gives the same bits on any number of threads. target.pressures_Pa makes one specimen for each\n"
      "pressure, S_20000Pa.h5 and so on. For the keys of a recipe: `rvelab keys pack`, `keys grains`, `keys target`,\n"
      "`keys preparation`.\n"
      "Examples:\n"
      "  rvelab pack pack_dense -o dense.h5\n"
      "  rvelab pack pack_loose -o loose.h5 --count 20 --set pack.number=1000\n"
      "  rvelab pack mine.toml -o S.h5 --set target.void_ratio=0.2 --set pack.seed=7");
  command.callback([arguments] { run_pack(*arguments); });
}

}  // namespace rvelab::cli
