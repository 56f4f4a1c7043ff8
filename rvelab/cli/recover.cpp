// rvelab recover: a record file from the journal of a stopped or killed run. Declared in command.hpp.

#include <filesystem>
#include <memory>
#include <string>

#include "rvelab/cli/command.hpp"
#include "rvelab/cli/report.hpp"
#include "rvelab/error.hpp"
#include "rvelab/io/journal/record_journal.hpp"
#include "rvelab/io/journal/recorded_test.hpp"
#include "rvelab/io/publish.hpp"

namespace rvelab::cli {
namespace {

struct RecoverArguments {
  std::string file, output;
  bool force = false, json = false;
};

void run_recover(const RecoverArguments& arguments) {
  const std::string journal_path = io::journal_of(arguments.file);
  const bool elsewhere = !arguments.output.empty() && io::followed(arguments.output) != io::followed(arguments.file);
  const std::string output = elsewhere ? arguments.output : arguments.file;
  if (elsewhere) io::expect_output(output, arguments.force, {arguments.file, journal_path});
  if (!std::filesystem::exists(arguments.file) && !std::filesystem::exists(journal_path)) {
    throw InputError(arguments.file + ": no such file, and no " + journal_path +
                     "; give the record file of a run, with or without \".journal\" beside it");
  }
  // The lock prevents a run from writing the same file. A copy elsewhere may be made while the test runs.
  std::unique_ptr<io::Journal> lock;
  if (!elsewhere && std::filesystem::exists(journal_path)) lock = std::make_unique<io::Journal>(journal_path);
  const io::RecordJournal journal = io::read_record_journal(journal_path);
  const io::RecordedTest test = io::read_recorded_test(arguments.file);
  if (elsewhere || !test.complete) io::write_recorded_test(test, output);
  if (lock && test.complete) lock->remove();  // left by a run that was killed between its last two steps

  Listing listing;
  listing.add("file", output);
  listing.add("complete", test.complete ? 1 : 0);
  listing.add("records", test.result.records.size());
  listing.add("records_in_journal", journal.test ? journal.test->result.records.size() : 0);
  listing.add("journal_bytes", journal.extent.file_bytes);
  listing.add("journal_bytes_cut_off", journal.extent.file_bytes - journal.extent.valid_bytes);
  listing.print(arguments.json);
}

}  // namespace

void add_recover(CLI::App& app) {
  CLI::App& command = *app.add_subcommand("recover", "Make a record file from what a stopped or killed run left");
  const auto arguments = std::make_shared<RecoverArguments>();
  command.add_option("file", arguments->file, "record file R.h5 of the run, beside its R.h5.journal")->required();
  command.add_option("-o,--output", arguments->output, "record file to write; default: R.h5 itself");
  add_force(command, arguments->force);
  add_json(command, arguments->json);
  command.footer(
      "The journal is kept: `rvelab run --resume` continues from it.\n"
      "Examples:\n  rvelab recover R.h5\n  rvelab recover R.h5 -o so_far.h5");
  command.callback([arguments] { run_recover(*arguments); });
}

}  // namespace rvelab::cli
