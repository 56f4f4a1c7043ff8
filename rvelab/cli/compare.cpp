// rvelab compare: whether two files hold the same, bit by bit. Declared in command.hpp.
#include <iostream>

#include "rvelab/cli/command.hpp"
#include "rvelab/cli/report.hpp"
#include "rvelab/io/hdf5/specimen_file.hpp"

namespace rvelab::cli {
namespace {

struct CompareArguments {
  std::string a, b;
  bool json = false;
};

void run_compare(const CompareArguments& arguments) {
  const io::Comparison result = io::compare_files(arguments.a, arguments.b);
  if (arguments.json) {
    Listing listing;
    listing.add("equal", !result.difference);
    listing.add("datasets_equal", result.datasets);
    listing.add("difference", result.difference ? Json(*result.difference) : Json());
    listing.print(true);
  } else if (!result.difference) {
    std::cout << "equal: " << result.datasets << " datasets\n";
  } else {
    std::cout << *result.difference << "\n";
  }
  if (result.difference) throw Exit(1);
}

}  // namespace

void add_compare(CLI::App& app) {
  CLI::App& command = *app.add_subcommand("compare", "Tell whether two files hold the same, bit by bit");
  const auto arguments = std::make_shared<CompareArguments>();
  command.add_option("A.h5", arguments->a, "specimen or record file")->required();
  command.add_option("B.h5", arguments->b, "the other file")->required();
  add_json(command, arguments->json);
  command.footer(
      "Every dataset and attribute outside /provenance is compared: name, type, shape, unit and bits. Exit code 0: "
      "the\n"
      "files are equal; 1: they are not, and the first difference is printed. After a run that was killed, use\n"
      "rvelab recover on its file first.\n\n"
      "Example:\n"
      "  rvelab compare whole.h5 resumed.h5");
  command.callback([arguments] { run_compare(*arguments); });
}

}  // namespace rvelab::cli
