// rvelab seal: takes over a file that another program has changed, or one of an earlier version, with a checksum.
// Declared in commands.hpp.
#include <memory>
#include <string>

#include "rvelab/cli/commands.hpp"
#include "rvelab/cli/protocol_input.hpp"
#include "rvelab/cli/report.hpp"
#include "rvelab/io/journal/recorded_test.hpp"
#include "rvelab/io/publish.hpp"

namespace rvelab::cli {
namespace {

struct Arguments {
  std::string file, output;
  bool force = false, json = false;
};

void run_seal(const Arguments& arguments) {
  expect_folder_of(arguments.output);
  io::expect_output(arguments.output, arguments.force, {arguments.file});
  const io::SealedFile sealed = io::seal_file(arguments.file, arguments.output);
  Listing listing;
  listing.add("file", arguments.output);
  listing.add("kind", sealed.kind == io::FileKind::records ? "records" : "specimen");
  listing.add("had_seal", sealed.had_seal);
  listing.add("datasets", sealed.datasets);
  listing.print(arguments.json);
}

}  // namespace

void add_seal(CLI::App& app) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand("seal", "Take over a file that another program changed, with a new checksum");
  command->add_option("file", arguments->file, "specimen or record file, changed or made by another program")
      ->required();
  command->add_option("-o,--output", arguments->output, "file to write, the same with a checksum")->required();
  command->add_flag("--force", arguments->force, "overwrite the output");
  command->add_flag("--json", arguments->json, "print one JSON object");
  command->footer(
      "rvelab's files end in a checksum, and a file whose bytes do not fit it is refused. A program that opens\n"
      "one for writing takes the checksum away. If the change is meant, this command reads the file with care, as\n"
      "far as rvelab knows it, and writes all of it anew. It cannot tell a change that is meant from damage: look\n"
      "at the result.\n"
      "Example:\n"
      "  rvelab seal edited.h5 -o S.h5");
  command->callback([arguments] { run_seal(*arguments); });
}

}  // namespace rvelab::cli
