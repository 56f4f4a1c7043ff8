#include "rvelab/cli/ensemble.hpp"

#include <glob.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <thread>

#include "rvelab/calibrate/calibrate.hpp"
#include "rvelab/cli/interrupt.hpp"
#include "rvelab/cli/progress_line.hpp"
#include "rvelab/cli/protocol_input.hpp"
#include "rvelab/cli/sharing.hpp"
#include "rvelab/cli/warnings.hpp"
#include "rvelab/error.hpp"
#include "rvelab/io/hdf5/schema.hpp"
#include "rvelab/io/hdf5/specimen_file.hpp"
#include "rvelab/io/publish.hpp"

namespace rvelab::cli {

namespace fs = std::filesystem;

namespace {

/// A test of the ensemble.
struct Planned {
  std::size_t protocol, specimen;
  std::string file;  ///< of its records; "": not kept
  std::string name;  ///< in messages
};

/// R_ and the specimen's file name without S_ and extension; names that are not unique get their number.
std::vector<std::string> record_stems(const std::vector<std::string>& files) {
  std::map<std::string, int> uses;
  std::vector<std::string> stems;
  for (const std::string& file : files) {
    std::string stem = fs::path(file).stem().string();
    if (stem.starts_with("S_")) stem.erase(0, 2);
    ++uses[stem];
    stems.push_back("R_" + stem);
  }
  for (std::size_t k = 0; k < stems.size(); ++k)
    if (uses[stems[k].substr(2)] > 1) stems[k] += "_no" + std::to_string(k + 1);
  return stems;
}

std::vector<Planned> planned(const Ensemble& ensemble, const std::string& folder) {
  const std::vector<std::string> stems = record_stems(ensemble.files);
  std::vector<Planned> tests;
  for (std::size_t s = 0; s < ensemble.files.size(); ++s) {
    for (std::size_t p = 0; p < ensemble.protocols.size(); ++p) {
      Planned test{p, s, "", ensemble.files[s]};
      std::string stem = stems[s];
      if (ensemble.protocols.size() > 1) {
        const double pressure = ensemble.protocols[p].pressure;
        stem += "_" + std::to_string(std::llround(pressure)) + "Pa";
        test.name += ", p = " + in_words(pressure) + " Pa";
      }
      if (!folder.empty()) test.file = (fs::path(folder) / (stem + ".h5")).string();
      tests.push_back(test);
    }
  }
  return tests;
}

/// Reads every specimen once, so that mistakes are told before the first test runs. InputError if two files hold the
/// same specimen, which would count twice, or if one does not go with the protocol.
int expect_specimens(const Ensemble& ensemble) {
  std::map<std::uint32_t, std::size_t> first;
  int dimension = 0;
  for (std::size_t k = 0; k < ensemble.files.size(); ++k) {
    const Specimen specimen = io::read_specimen(ensemble.files[k]);
    for (const protocol::Protocol& protocol : ensemble.protocols)
      warn_of_units(protocol.path, protocol::unusual_in(protocol, specimen));
    const auto [found, is_new] = first.emplace(io::digest(specimen), k);
    if (!is_new)
      throw InputError(ensemble.files[k] + " holds the same specimen as " + ensemble.files[found->second] +
                       "; allowed: specimens that differ; leave one out, or pack one with another seed");
    if (k > 0 && specimen.cell.dimension != dimension)
      throw InputError(ensemble.files[k] + " is " + std::to_string(specimen.cell.dimension) + "D and " +
                       ensemble.files[0] + " is " + std::to_string(dimension) +
                       "D; allowed: specimens of one dimension; leave one out");
    dimension = specimen.cell.dimension;
  }
  return dimension;
}

void expect_places(const Ensemble& ensemble, const std::vector<Planned>& tests, const std::string& folder,
                   const TestOptions& options) {
  std::vector<std::string> inputs = ensemble.files;
  inputs.push_back(ensemble.protocols.front().path);
  make_folder(folder);
  for (const Planned& test : tests) {
    io::expect_output(test.file, options.force || options.resume, inputs, ", --resume to go on with the tests");
    const std::string journal = io::journal_of(test.file);
    if (!options.force && !options.resume && fs::exists(journal))
      throw InputError(journal + ": a test was stopped there; allowed: --resume to go on with it, or --force");
  }
  for (const char* name : {"summary.json", "summary.csv"})
    io::expect_output((fs::path(folder) / name).string(), options.force || options.resume, inputs,
                      ", --resume to go on with the tests");
}

/// This process's share of the tests; true if what is left to do is its own.
bool shared_out(const Ensemble& ensemble, const std::vector<Planned>& tests, const TestOptions& options) {
  std::vector<KeptTest> shared;
  for (const Planned& test : tests)
    shared.push_back({&ensemble.protocols[test.protocol],
                      [&, k = test.specimen] { return io::read_specimen(ensemble.files[k]); }, test.file});
  return shared_out(shared, options);
}

/// What came of the tests.
struct Outcome {
  std::vector<std::optional<ensemble::TestOf>> tests;
  std::vector<std::string> failures;  ///< of each; "": none
};

Outcome carried_out(const Ensemble& ensemble, const std::vector<Planned>& tests, int dimension,
                    const TestOptions& options) {
  const unsigned cores = std::max(1u, std::thread::hardware_concurrency());
  const unsigned threads = options.threads > 0 ? options.threads : cores;
  Outcome outcome{std::vector<std::optional<ensemble::TestOf>>(tests.size()), std::vector<std::string>(tests.size())};
  ProgressLine progress(tests.size());
  const auto one = [&](std::size_t k) {
    const Planned& test = tests[k];
    const protocol::Protocol& protocol = ensemble.protocols[test.protocol];
    if (stop_on_signals().load()) return;
    try {
      const Specimen specimen = io::read_specimen(ensemble.files[test.specimen]);
      std::unique_ptr<io::RecordStore> store;
      if (!test.file.empty()) store = open_shared_store(test.file, protocol, specimen, options);
      protocol::Watch watch;
      watch.stop = &stop_on_signals();
      watch.on_path_point = [&](const protocol::PathPoint& reached) { progress.show(k, test.name, reached); };
      const protocol::TestRun run = run_recorded(protocol, specimen, store.get(), watch);
      if (!run.complete) return;
      progress.done(k);
      outcome.tests[k] = {ensemble.groups[test.specimen],
                          test.specimen,
                          protocol.pressure,
                          ensemble::measured(protocol, run.result, dimension),
                          ensemble::strength_of(protocol, run.result, dimension),
                          calibrate::grains_stick(run.end_state)};
    } catch (const InputError& error) {
      throw InputError(test.name + ": " + error.what());
    } catch (const Error& error) {
      outcome.failures[k] = test.name + ": " + error.what();
    }
  };
  Workers(unsigned(std::min<std::size_t>(threads, tests.size()))).for_each_in_turn(tests.size(), one);
  return outcome;
}

}  // namespace

std::vector<std::string> files_of(const std::vector<std::string>& words) {
  std::vector<std::string> files;
  for (const std::string& word : words) {
    std::error_code ignored;
    if (word.find_first_of("*?[") == std::string::npos || fs::exists(word, ignored)) {
      files.push_back(word);
      continue;
    }
    glob_t found{};
    const bool any = ::glob(word.c_str(), 0, nullptr, &found) == 0;
    for (std::size_t k = 0; any && k < found.gl_pathc; ++k) files.emplace_back(found.gl_pathv[k]);
    ::globfree(&found);
    if (!any) throw InputError(word + ": no file has such a name; allowed: specimen files; pack some first");
  }
  return files;
}

void run_ensemble(const Ensemble& ensemble, const std::string& folder, TestOptions options) {
  const auto begin = std::chrono::steady_clock::now();
  const std::vector<Planned> tests = planned(ensemble, folder);
  const int dimension = expect_specimens(ensemble);
  options.resume = options.resume || options.share;  // another process may have begun
  if (!folder.empty()) expect_places(ensemble, tests, folder, options);
  if (!shared_out(ensemble, tests, options)) return;
  const Outcome outcome = carried_out(ensemble, tests, dimension, options);
  std::vector<ensemble::TestOf> finished;
  std::vector<std::string> failures;
  for (std::size_t k = 0; k < tests.size(); ++k) {
    if (outcome.tests[k]) finished.push_back(*outcome.tests[k]);
    if (!outcome.failures[k].empty()) failures.push_back(outcome.failures[k]);
  }
  if (finished.size() + failures.size() < tests.size()) {
    end_stopped(" with " + std::to_string(finished.size()) + " of " + std::to_string(tests.size()) +
                " tests complete; " +
                (folder.empty() ? "their records are not kept without -o" : "continue with --resume"));
  }
  const ensemble::Summary summary = ensemble::summary_of(finished);
  for (const std::string& failure : failures) tell(failure);  // before the summary, which a full disk refuses too
  if (!folder.empty()) write_summary(folder, ensemble, finished, summary, failures);
  if (options.json) {
    std::cout << as_json(ensemble, finished, summary, failures).dump(1, ' ', false, Json::error_handler_t::replace)
              << std::endl;
  } else {
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - begin;
    std::cout << as_table(ensemble, summary);
    if (!folder.empty()) std::cout << "files   " << folder << "/R_*.h5, summary.json, summary.csv\n";
    std::cout << "wall_s  " << in_words(wall.count()) << std::endl;
  }
  if (failures.empty()) return;
  throw Error(std::to_string(failures.size()) + " of " + std::to_string(tests.size()) +
              " tests could not be carried out; the summary is of the others");
}

}  // namespace rvelab::cli
