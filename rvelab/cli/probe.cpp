// rvelab probe: the stiffness of a specimen at small strain, by increments or from its contact network, or in continued
// loading of a test.
// Declared in command.hpp.
#include <optional>
#include <string>
#include <vector>

#include "rvelab/calibrate/mohr.hpp"
#include "rvelab/cli/command.hpp"
#include "rvelab/cli/report.hpp"
#include "rvelab/error.hpp"
#include "rvelab/io/hdf5/specimen_file.hpp"
#include "rvelab/io/journal/recorded_test.hpp"
#include "rvelab/measure/acoustic.hpp"
#include "rvelab/measure/probe.hpp"
#include "rvelab/measure/tangent.hpp"
#include "rvelab/measure/tensor_order.hpp"
#include "rvelab/protocol/stages.hpp"
#include "rvelab/records/loading_direction.hpp"
#include "rvelab/solver/rve.hpp"

namespace rvelab::cli {
namespace {

struct ProbeArguments {
  std::string file;
  std::optional<std::string> method;
  std::optional<double> size;
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
                   " (smaller ones are lost in the round-off of the stress) to 0.01; give 1e-7 for an elastic probe");
}

/// The probed state, and the last loading direction of its test; zero: unknown.
struct Probed {
  Specimen specimen;
  Matrix3 direction = Matrix3::Zero();
};

Probed read_probed(const std::string& file) {
  if (io::file_kind(file) != io::FileKind::records) return {io::read_specimen(file)};
  const io::RecordedTest test = io::read_recorded_test(file);
  return {test.checkpoint.specimen, records::loading_direction(test.result.records)};
}

/// Where the stiffness allows a band: det Q over its least value for the elastic tangent of the same state, and the
/// angle beside those of Coulomb, Arthur and Roscoe. Second-order work along the direction d: d C d, over the elastic.
void add_bands(Listing& listing, const Rve& rve, const Eigen::MatrixXd& stiffness, const Matrix3& direction) {
  const int dimension = rve.cell().dimension;
  const Eigen::MatrixXd stuck = elastic_tangent(rve.network());
  const Band band = weakest_band(stiffness), elastic = weakest_band(stuck);
  listing.add("acoustic_ratio", band.determinant / elastic.determinant);
  listing.add("acoustic_mean_ratio", band.mean / elastic.mean);
  listing.add("band_normal", std::vector<double>(band.normal.begin(), band.normal.end()));
  listing.add_or_why("band_angle_deg", band_angle_deg(band, rve.stress(), dimension), "degrees",
                     "the stress has no single major axis");
  const double phi = calibrate::friction_angle_deg(calibrate::principal_stresses(rve.stress(), dimension));
  listing.add("coulomb_angle_deg", 45 + 0.5 * phi, "degrees");
  if (direction.isZero(0)) return;
  const double psi = calibrate::dilation_angle_deg(direction, dimension);
  listing.add("arthur_angle_deg", 45 + 0.25 * (phi + psi), "degrees");
  listing.add("roscoe_angle_deg", 45 + 0.5 * psi, "degrees");
  const Eigen::VectorXd strain = strain_components(direction, dimension);
  listing.add("second_order_work_ratio", strain.dot(stiffness * strain) / strain.dot(stuck * strain));
}

/// By increments of both signs, each relaxed.
Eigen::MatrixXd by_both_signs(Listing& listing, const Rve& rve, double size) {
  expect_size(size);
  const Probe probe = probe_stiffness(rve, size);
  listing.add("size", probe.size);
  listing.add("stiffness_Pa", row_major(probe.stiffness), "Pa");
  listing.add("plus_minus_difference", probe.plus_minus_difference);
  listing.add("unbalanced_force_ratio", probe.unbalanced_ratio);
  listing.add("relaxed", probe.relaxed);
  return probe.stiffness;
}

Eigen::MatrixXd by_loading(Listing& listing, const Rve& rve, const Matrix3& direction, double size,
                           const std::string& file) {
  if (direction.isZero(0))
    throw InputError(file +
                     " has no test that strains it, so no direction of continued loading; give the record "
                     "file of a test, or --method dynamic or linear");
  const Eigen::MatrixXd stiffness = loading_stiffness(rve, direction, size);
  listing.add("size", size);
  listing.add("direction", row_major(direction / direction.norm()));
  listing.add("stiffness_Pa", row_major(stiffness), "Pa");
  return stiffness;
}

void run_probe(const ProbeArguments& arguments) {
  const auto [specimen, direction] = read_probed(arguments.file);
  const std::string method = arguments.method.value_or(arguments.bands ? "loading" : "dynamic");
  Rve rve(specimen);
  if (arguments.no_slip) forbid_slip(rve);
  const int dimension = rve.cell().dimension;
  Listing listing;
  listing.add("file", arguments.file);
  listing.add("method", method);
  listing.add("no_slip", arguments.no_slip || method == "linear");
  listing.add("stress_order", labels(dimension, false));
  listing.add("strain_order", labels(dimension, true));
  Eigen::MatrixXd stiffness;
  if (method == "linear") {
    stiffness = elastic_tangent(rve.network());
    listing.add("stiffness_Pa", row_major(stiffness), "Pa");
  } else if (method == "loading") {
    stiffness = by_loading(listing, rve, direction, arguments.size.value_or(usual_loading_probe), arguments.file);
  } else {
    stiffness = by_both_signs(listing, rve, arguments.size.value_or(1e-7));
  }
  if (arguments.bands) add_bands(listing, rve, stiffness, direction);
  listing.print(arguments.json);
}

}  // namespace

void add_probe(CLI::App& app) {
  CLI::App& command = *app.add_subcommand("probe", "Measure the stiffness of a specimen at small strain");
  const auto arguments = std::make_shared<ProbeArguments>();
  command.add_option("file", arguments->file, "specimen file, *.h5")->required();
  command.add_option("--size", arguments->size, "strain of each probe")
      ->default_str("1e-7; method loading: " + in_words(usual_loading_probe));
  command.add_flag("--no-slip", arguments->no_slip, "let no contact slide or roll over (friction 1e6)");
  command.add_flag("--bands", arguments->bands,
                   "add the weakest band: least det Q(n) of the acoustic tensor over that of the\n"
                   "elastic tangent; angle between its normal and the major stress, beside\n"
                   "45 + phi/2 (Coulomb), 45 + psi/2 (Roscoe) and their mean (Arthur)");
  command
      .add_option("--method", arguments->method,
                  "dynamic: small increments, plus and minus, each relaxed\n"
                  "linear: elastic tangent of the contact network, without sliding\n"
                  "loading: increments of continued loading in the direction of the test, the second\n"
                  "half of each; needs a record file")
      ->check(CLI::IsMember({"dynamic", "linear", "loading"}))
      ->default_str("dynamic; with --bands: loading");
  add_json(command, arguments->json);
  command.footer(
      "Examples:\n  rvelab probe dense.h5 --size 1e-7 --no-slip --json\n"
      "  rvelab probe R.h5 --bands");
  command.callback([arguments] { run_probe(*arguments); });
}

}  // namespace rvelab::cli
