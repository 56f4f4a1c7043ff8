// Tests on many specimens: what `run` and `calibrate` share of them. The tests run one to a core; their records and
// the summary lie in one folder.
#pragma once

#include <string>
#include <vector>

#include "rvelab/cli/recording.hpp"
#include "rvelab/cli/report.hpp"
#include "rvelab/ensemble/summary.hpp"

namespace rvelab::cli {

/// Files that the words name: a word with *, ? or [ names every file that fits it, in alphabetical order. InputError if
/// none does.
std::vector<std::string> files_of(std::vector<std::string> words, const std::vector<std::string>& more = {});
/// InputError if the specimen of the last digest (io::digest) is that of a file before: it would count twice.
void expect_another(const std::vector<std::string>& files, const std::vector<std::uint32_t>& digests);

/// Tests as they are planned: one protocol or several (of several pressures), on specimens in one group or two.
struct Ensemble {
  std::vector<protocol::Protocol> protocols;
  std::vector<std::string> files;   ///< of the specimens, all groups one after the other
  std::vector<std::size_t> groups;  ///< of each specimen
  std::vector<std::string> names;   ///< of the groups
  bool several_groups() const { return names.size() > 1; }
};

/// A finished test for the summary.
ensemble::TestOf test_of(const protocol::Protocol& protocol, const records::TestResult& result, int dimension,
                         std::size_t group, std::size_t specimen, bool sticks);

/// Summary of finished tests; `failures` name the tests that could not be carried out.
Json as_json(const Ensemble& ensemble, const std::vector<ensemble::TestOf>& tests, const ensemble::Summary& summary,
             const std::vector<std::string>& failures);
std::string as_csv(const Ensemble& ensemble, const ensemble::Summary& summary);
std::string as_table(const Ensemble& ensemble, const ensemble::Summary& summary);

/// Writes summary.json and summary.csv.
void write_summary(const std::string& folder, const Ensemble& ensemble, const std::vector<ensemble::TestOf>& tests,
                   const ensemble::Summary& summary, const std::vector<std::string>& failures);

/// Runs every protocol on every specimen and prints the summary; with an output folder, records and summary go there.
/// Processes may share the tests (sharing.hpp); the first rank prints. Exit code 1 through Error if a test fails; the
/// others are finished first.
void run_ensemble(const Ensemble& ensemble, const std::string& folder, TestOptions options);

}  // namespace rvelab::cli
