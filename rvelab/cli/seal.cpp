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

Command seal_command() {
  Command command{"seal", "Accept a file that another program has changed: write it with a new checksum"};
  auto& arguments = command.runs(run_seal);
  command.add("file", arguments.file, "specimen or record file, changed or made by another program").required();
  command.add("-o,--output", arguments.output, "file to write, the same with a checksum").required();
  command.add_force(arguments.force);
  command.add_json(arguments.json);
  command.notes =
      "Files of rvelab end in a checksum; a file whose bytes do not match it is refused. A program that opens such a\n"
      "file for writing removes the checksum. If you meant the change, seal reads what rvelab knows of the file, "
      "checks\n"
      "it and writes it anew. It cannot tell an intended change from damage, so inspect the result.\n"
      "Example:\n"
      "  rvelab seal edited.h5 -o S.h5";
  return command;
}

}  // namespace rvelab::cli
