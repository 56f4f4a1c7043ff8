#include "rvelab/cli/ensemble.hpp"

#include <glob.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <map>
#include <optional>

#include "rvelab/calibrate/calibrate.hpp"
#include "rvelab/cli/grading_sizes.hpp"
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

/// Every protocol on every specimen, those of a specimen one after the other.
std::vector<RecordedTest> planned(const Ensemble& ensemble, const std::string& folder) {
  const std::vector<std::string> stems = record_stems(ensemble.files);
  std::vector<RecordedTest> tests;
  for (std::size_t s = 0; s < ensemble.files.size(); ++s) {
    for (const protocol::Protocol& protocol : ensemble.protocols) {
      RecordedTest test{{ensemble.files[s], &protocol, [&, s] { return io::read_specimen(ensemble.files[s]); }}, ""};
      std::string stem = stems[s];
      if (ensemble.protocols.size() > 1) {
        stem += "_" + std::to_string(std::llround(protocol.pressure)) + "Pa";
        test.name += ", p = " + in_words(protocol.pressure) + " Pa";
      }
      if (!folder.empty()) test.file = (fs::path(folder) / (stem + ".h5")).string();
      tests.push_back(test);
    }
  }
  return tests;
}

/// Reads every specimen once, so that mistakes are reported before the first test runs. InputError if two files hold
/// the same specimen, which would count twice, or if one does not go with the protocol.
int expect_specimens(const Ensemble& ensemble) {
  std::vector<std::uint32_t> digests;
  int dimension = 0;
  for (std::size_t k = 0; k < ensemble.files.size(); ++k) {
    const Specimen specimen = io::read_specimen(ensemble.files[k]);
    for (const protocol::Protocol& protocol : ensemble.protocols)
      warn_of_units(protocol.path, protocol::unusual_in(protocol, specimen));
    warn_of_largest_grain(ensemble.files[k], specimen);
    digests.push_back(io::digest(specimen));
    expect_another(ensemble.files, digests);
    if (k > 0 && specimen.cell.dimension != dimension)
      throw InputError(ensemble.files[k] + " is " + std::to_string(specimen.cell.dimension) + "D and " +
                       ensemble.files[0] + " is " + std::to_string(dimension) +
                       "D; allowed: specimens of one dimension; leave one out");
    dimension = specimen.cell.dimension;
  }
  return dimension;
}

void expect_places(const Ensemble& ensemble, const std::vector<RecordedTest>& tests, const std::string& folder,
                   const TestOptions& options) {
  std::vector<std::string> inputs = ensemble.files;
  inputs.push_back(ensemble.protocols.front().path);
  make_folder(folder);
  for (const RecordedTest& test : tests) {
    io::expect_output(test.file, options.force || options.resume, inputs, ", --resume to go on with the tests");
    const std::string journal = io::journal_of(test.file);
    if (!options.force && !options.resume && fs::exists(journal))
      throw InputError(journal + ": a test was stopped there; allowed: --resume to go on with it, or --force");
  }
  for (const char* name : {"summary.json", "summary.csv"})
    io::expect_output((fs::path(folder) / name).string(), options.force || options.resume, inputs,
                      ", --resume to go on with the tests");
}

}  // namespace

ensemble::TestOf test_of(const protocol::Protocol& protocol, const records::TestResult& result, int dimension,
                         std::size_t group, std::size_t specimen, bool sticks) {
  return {group,
          specimen,
          protocol.pressure,
          ensemble::measured(protocol, result, dimension),
          ensemble::strength_of(protocol, result, dimension),
          sticks};
}

void expect_another(const std::vector<std::string>& files, const std::vector<std::uint32_t>& digests) {
  const std::size_t last = digests.size() - 1;
  const auto same = std::size_t(std::find(digests.begin(), digests.end(), digests.back()) - digests.begin());
  if (same < last)
    throw InputError(files[last] + " holds the same specimen as " + files[same] +
                     "; allowed: specimens that differ; leave one out, or pack one with another seed");
}

std::vector<std::string> files_of(std::vector<std::string> words, const std::vector<std::string>& more) {
  words.insert(words.end(), more.begin(), more.end());
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
  const std::vector<RecordedTest> tests = planned(ensemble, folder);
  const int dimension = expect_specimens(ensemble);
  options.resume = options.resume || options.share;  // another process may have begun
  if (!folder.empty()) expect_places(ensemble, tests, folder, options);
  std::vector<std::optional<ensemble::TestOf>> measured(tests.size());
  auto failures = run_tests(tests, options, Opening::one_by_one, [&](std::size_t k, protocol::TestRun&& run) {
    const std::size_t specimen = k / ensemble.protocols.size();
    measured[k] = test_of(*tests[k].protocol, run.result, dimension, ensemble.groups[specimen], specimen,
                          calibrate::grains_stick(run.end_state));
  });
  if (!failures) return;
  std::erase(*failures, "");
  std::vector<ensemble::TestOf> finished;
  for (const auto& test : measured)
    if (test) finished.push_back(*test);
  const ensemble::Summary summary = ensemble::summary_of(finished);
  for (const std::string& failure : *failures) tell(failure);  // before the summary, which a full disk refuses too
  if (!folder.empty()) write_summary(folder, ensemble, finished, summary, *failures);
  if (options.json) {
    std::cout << json_text(as_json(ensemble, finished, summary, *failures)) << std::flush;
  } else {
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - begin;
    std::cout << as_table(ensemble, summary);
    if (!folder.empty()) std::cout << "files   " << folder << "/R_*.h5, summary.json, summary.csv\n";
    std::cout << "wall_s  " << in_words(wall.count()) << std::endl;
  }
  if (failures->empty()) return;
  throw Error(std::to_string(failures->size()) + " of " + std::to_string(tests.size()) +
              " tests could not be carried out; the summary is of the others");
}

}  // namespace rvelab::cli
