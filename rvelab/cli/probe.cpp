// rvelab probe: the stiffness of a specimen at small strain, by increments or from its contact network.
// Declared in command.hpp.
#include <string>

#include "rvelab/cli/command.hpp"
#include "rvelab/cli/report.hpp"
#include "rvelab/error.hpp"
#include "rvelab/io/hdf5/specimen_file.hpp"
#include "rvelab/measure/probe.hpp"
#include "rvelab/measure/tangent.hpp"
#include "rvelab/protocol/stages.hpp"
#include "rvelab/solver/rve.hpp"

namespace rvelab::cli {
namespace {

struct ProbeArguments {
  std::string file;
  std::string method = "dynamic";
  double size = 1e-7;
  bool no_slip = false;
  bool json = false;
};

/// "sxx" and so on for rows; "exx" for columns, "gxy" for engineering shear.
Json labels(int dimension, bool strain) {
  Json list = Json::array();
  for (const std::string& axes : component_names(dimension)) {
    list.push_back((!strain ? "s" : axes[0] == axes[1] ? "e" : "g") + axes);
  }
  return list;
}

void expect_size(double size) {
  if (size >= protocol::smallest_probe && size <= 0.01) return;
  throw InputError("--size " + in_words(size) + " is out of range; allowed: " + in_words(protocol::smallest_probe) +
                   " (what is smaller drowns in the round-off of the stress) to 0.01; give 1e-7 for an elastic probe");
}

void run_probe(const ProbeArguments& arguments) {
  Rve rve(io::read_specimen(arguments.file));
  if (arguments.no_slip) forbid_slip(rve);
  const int dimension = rve.cell().dimension;
  Listing listing;
  listing.add("file", arguments.file);
  listing.add("method", arguments.method);
  listing.add("no_slip", arguments.no_slip || arguments.method == "linear");
  listing.add("stress_order", labels(dimension, false));
  listing.add("strain_order", labels(dimension, true));
  if (arguments.method == "linear") {
    listing.add("stiffness_Pa", row_major(elastic_tangent(rve.network())), "Pa");
  } else {
    expect_size(arguments.size);
    const Probe probe = probe_stiffness(rve, arguments.size);
    listing.add("size", probe.size);
    listing.add("stiffness_Pa", row_major(probe.stiffness), "Pa");
    listing.add("plus_minus_difference", probe.plus_minus_difference);
    listing.add("unbalanced_force_ratio", probe.unbalanced_ratio);
    listing.add("relaxed", probe.relaxed);
  }
  listing.print(arguments.json);
}

}  // namespace

Command probe_command() {
  Command command{"probe", "Measure the stiffness of a specimen at small strain"};
  auto& arguments = command.runs(run_probe);
  command.add("file", arguments.file, "specimen file, *.h5").required();
  command.add("--size", arguments.size, "strain of each probe, made in both directions")
      .shows_default(in_words(arguments.size));
  command.add("--no-slip", arguments.no_slip, "let no contact slide or roll over (friction 1e6)");
  command
      .add("--method", arguments.method,
           "dynamic: small increments, each relaxed\n"
           "linear: elastic tangent of the contact network, without sliding")
      .one_of({"dynamic", "linear"})
      .shows_default(arguments.method);
  command.add_json(arguments.json);
  command.notes = "Example:\n  rvelab probe dense.h5 --size 1e-7 --no-slip --json";
  return command;
}

}  // namespace rvelab::cli
