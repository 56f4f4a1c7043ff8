// rvelab seal: accepts a file that another program has changed, or one of an early version, and adds a checksum.
// Declared in command.hpp.
#include <string>

#include "rvelab/cli/command.hpp"
#include "rvelab/cli/protocol_input.hpp"
#include "rvelab/cli/report.hpp"
#include "rvelab/io/journal/recorded_test.hpp"
#include "rvelab/io/publish.hpp"

namespace rvelab::cli {
namespace {

struct SealArguments {
  std::string file, output;
  bool force = false, json = false;
};

void run_seal(const SealArguments& arguments) {
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
  CLI::App& command =
      *app.add_subcommand("seal", "Accept a file that another program has changed: write it with a new checksum");
  const auto arguments = std::make_shared<SealArguments>();
  command.add_option("file", arguments->file, "specimen or record file, changed or made by another program")
      ->required();
  command.add_option("-o,--output", arguments->output, "file to write, the same with a checksum")->required();
  add_force(command, arguments->force);
  add_json(command, arguments->json);
  command.footer(
      "Files of rvelab end in a checksum; a file whose bytes do not match it is refused. A program that opens such a\n"
      "file for writing removes the checksum. If you meant the change, seal reads what rvelab knows of the file, "
      "checks\n"
      "it and writes it again. It cannot distinguish an intended change from damage, so inspect the result.\n"
      "Example:\n"
      "  rvelab seal edited.h5 -o S.h5");
  command.callback([arguments] { run_seal(*arguments); });
}

}  // namespace rvelab::cli
