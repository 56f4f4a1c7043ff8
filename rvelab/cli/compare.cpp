// rvelab compare: whether two files hold the same, bit by bit. Declared in commands.hpp.
#include <iostream>
#include <memory>

#include "rvelab/cli/commands.hpp"
#include "rvelab/cli/report.hpp"
#include "rvelab/io/hdf5/compare.hpp"

namespace rvelab::cli {

void add_compare(CLI::App& app) {
  struct Arguments {
    std::string a, b;
    bool json = false;
  };
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand("compare", "Tell whether two files hold the same, bit by bit");
  command->add_option("A.h5", arguments->a, "specimen or record file")->required();
  command->add_option("B.h5", arguments->b, "the other one")->required();
  command->add_flag("--json", arguments->json, "print one JSON object");
  command->footer(
      "Every dataset and attribute outside /provenance counts: name, type, shape, units, bits. Exit code 0: equal; 1: "
      "the\n"
      "first difference is printed. Of a run that was killed, rvelab recover the file first.\n\n"
      "Example:\n"
      "  rvelab compare whole.h5 resumed.h5");
  command->callback([arguments] {
    const io::Comparison result = io::compare_files(arguments->a, arguments->b);
    if (arguments->json) {
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
    if (result.difference) throw CLI::RuntimeError(1);
  });
}

}  // namespace rvelab::cli
