// rvelab recover: a record file from the journal that a stopped or killed run left. Declared in commands.hpp.
#include <unistd.h>

#include <filesystem>
#include <memory>
#include <string>

#include "rvelab/cli/commands.hpp"
#include "rvelab/cli/report.hpp"
#include "rvelab/error.hpp"
#include "rvelab/io/journal/record_journal.hpp"
#include "rvelab/io/journal/recorded_test.hpp"
#include "rvelab/io/publish.hpp"

namespace rvelab::cli {
namespace {

struct Arguments {
  std::string file, output;
  bool force = false, json = false;
};

void run_recover(const Arguments& arguments) {
  const std::string journal_path = io::journal_of(arguments.file);
  const bool elsewhere = !arguments.output.empty() && io::followed(arguments.output) != io::followed(arguments.file);
  const std::string output = elsewhere ? arguments.output : arguments.file;
  if (elsewhere) io::expect_output(output, arguments.force, {arguments.file, journal_path});
  if (!std::filesystem::exists(arguments.file) && !std::filesystem::exists(journal_path)) {
    throw InputError(arguments.file + ": no such file, and no " + journal_path +
                     "; give the record file of a run, with or without \".journal\" beside it");
  }
  // The lock keeps a run away from the file that is written here; elsewhere a running test may be copied.
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
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand("recover", "Make a record file from what a stopped or killed run left");
  command->add_option("file", arguments->file, "record file R.h5 of the run; R.h5.journal stands beside it")
      ->required();
  command->add_option("-o,--output", arguments->output, "record file to write; else R.h5 itself");
  command->add_flag("--force", arguments->force, "overwrite the output");
  command->add_flag("--json", arguments->json, "print one JSON object");
  command->footer(
      "The journal stays: `rvelab run --resume` goes on from it.\n"
      "Examples:\n  rvelab recover R.h5\n  rvelab recover R.h5 -o so_far.h5");
  command->callback([arguments] { run_recover(*arguments); });
}

}  // namespace rvelab::cli
