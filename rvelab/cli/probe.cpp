// rvelab probe: the stiffness of a specimen at small strain, by increments or from its contact network.
// Declared in command.hpp.
#include <string>
#include <vector>

#include "rvelab/calibrate/mohr.hpp"
#include "rvelab/cli/command.hpp"
#include "rvelab/cli/report.hpp"
#include "rvelab/error.hpp"
#include "rvelab/io/hdf5/specimen_file.hpp"
#include "rvelab/measure/acoustic.hpp"
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
  bool bands = false;
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

/// Where the stiffness allows a band: det Q over its least value for the elastic tangent of the same state, and the
/// angle beside that of Coulomb.
void add_bands(Listing& listing, const Rve& rve, const Eigen::MatrixXd& stiffness) {
  const int dimension = rve.cell().dimension;
  const Band band = weakest_band(stiffness), elastic = weakest_band(elastic_tangent(rve.network()));
  listing.add("acoustic_ratio", band.determinant / elastic.determinant);
  listing.add("acoustic_mean_ratio", band.mean / elastic.mean);
  listing.add("band_normal", std::vector<double>(band.normal.begin(), band.normal.end()));
  listing.add_or_why("band_angle_deg", band_angle_deg(band, rve.stress(), dimension), "degrees",
                     "the stress has no single major axis");
  listing.add("coulomb_angle_deg",
              45 + 0.5 * calibrate::friction_angle_deg(calibrate::principal_stresses(rve.stress(), dimension)),
              "degrees");
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
    const Eigen::MatrixXd stiffness = elastic_tangent(rve.network());
    listing.add("stiffness_Pa", row_major(stiffness), "Pa");
    if (arguments.bands) add_bands(listing, rve, stiffness);
  } else {
    expect_size(arguments.size);
    const Probe probe = probe_stiffness(rve, arguments.size);
    listing.add("size", probe.size);
    listing.add("stiffness_Pa", row_major(probe.stiffness), "Pa");
    listing.add("plus_minus_difference", probe.plus_minus_difference);
    listing.add("unbalanced_force_ratio", probe.unbalanced_ratio);
    listing.add("relaxed", probe.relaxed);
    if (arguments.bands) add_bands(listing, rve, probe.stiffness);
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
  command.add("--bands", arguments.bands,
              "add the weakest band: least det Q(n) of the acoustic tensor over that of the\n"
              "elastic tangent, angle between its normal and the major stress, 45 + phi/2");
  command
      .add("--method", arguments.method,
           "dynamic: small increments, each relaxed\n"
           "linear: elastic tangent of the contact network, without sliding")
      .one_of({"dynamic", "linear"})
      .shows_default(arguments.method);
  command.add_json(arguments.json);
  command.notes =
      "Examples:\n  rvelab probe dense.h5 --size 1e-7 --no-slip --json\n"
      "  rvelab probe R.h5 --size 1e-4 --bands";
  return command;
}

}  // namespace rvelab::cli
