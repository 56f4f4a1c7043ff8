// rvelab measure: strong and weak contacts, anisotropies and the relation of stress, force and fabric, of a specimen or
// of the last state of a test; of a test also second-order work, loops, and bands of its probes. Declared in
// command.hpp.
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "rvelab/calibrate/mohr.hpp"
#include "rvelab/cli/command.hpp"
#include "rvelab/cli/report.hpp"
#include "rvelab/ensemble/features.hpp"
#include "rvelab/ensemble/loops.hpp"
#include "rvelab/ensemble/measures.hpp"
#include "rvelab/ensemble/second_order_work.hpp"
#include "rvelab/error.hpp"
#include "rvelab/io/hdf5/specimen_file.hpp"
#include "rvelab/io/journal/journal.hpp"
#include "rvelab/io/journal/recorded_test.hpp"
#include "rvelab/keys/table_reader.hpp"
#include "rvelab/measure/acoustic.hpp"
#include "rvelab/measure/anisotropy.hpp"
#include "rvelab/measure/deviator.hpp"
#include "rvelab/measure/force_networks.hpp"
#include "rvelab/measure/measures.hpp"
#include "rvelab/solver/rve.hpp"

namespace rvelab::cli {
namespace {

void add_network(Listing& listing, const std::string& which, const ForceNetwork& part) {
  listing.add(which + "_contacts", part.contacts);
  listing.add(which + "_pressure_share", part.pressure_share);
  listing.add(which + "_deviator_share", part.deviator_share);
  listing.add(which + "_anisotropy", part.anisotropy);
  listing.add(which + "_sliding", part.sliding);
  listing.add_to_json(which + "_fabric", row_major(part.fabric));
  listing.add_to_json(which + "_stress_Pa", row_major(part.stress));
}

void add_anisotropies(Listing& listing, const Network& network) {
  const Anisotropies a = anisotropies(network);
  const StressForceFabric relation = stress_force_fabric(network);
  listing.add("a_c", relation.a_c);
  listing.add("a_n", relation.a_n);
  listing.add("a_t", relation.a_t);
  listing.add("a_l", relation.a_l);
  listing.add("a_lt", relation.a_lt);
  listing.add("q_over_p", relation.measured);
  listing.add("q_over_p_predicted", relation.predicted);
  listing.add("fourth_order_anisotropy", a.fourth_order);
  listing.add("mean_normal_force_N", a.mean_normal_force, "N");
  listing.add("mean_branch_m", a.mean_branch, "m");
  listing.add_or_why("fabric_angle_deg", axes_angle_deg(-contact_stress(network), fabric(network), network.dimension()),
                     "degrees", "stress or fabric has no single major axis");
  listing.add_to_json("normals_tensor", row_major(a.normals));
  listing.add_to_json("normal_forces_tensor", row_major(a.normal_forces));
  listing.add_to_json("tangential_forces_tensor", row_major(a.tangential_forces));
  listing.add_to_json("branches_tensor", row_major(a.branches));
  listing.add_to_json("tangential_branches_tensor", row_major(a.tangential_branches));
}

/// Value of a measure of tests by its name.
double value_of(const std::string& name, const std::vector<double>& values) {
  for (std::size_t k = 0; k < values.size(); ++k)
    if (ensemble::measures()[k].name == name) return values[k];
  throw Error(name + ": no measure of a test has such a name");
}

/// Second-order work of the last stage, and the angles of a band by Coulomb, Arthur and Roscoe.
void add_instability(Listing& listing, const io::RecordedTest& test, int dimension) {
  const auto stage = calibrate::last_stage(test.result);
  const ensemble::Instability found = ensemble::instability_of(stage);
  listing.add("second_order_work_least", found.least);
  listing.add_or_why("unstable_from_strain", found.strain, "", "the second-order work is nowhere negative");
  const auto values = ensemble::measured(
      protocol::parse_recorded_protocol(test.provenance.protocol, "the protocol in the file"), test.result, dimension);
  const double phi = value_of("friction_angle_deg", values), psi = value_of("dilation_angle_deg", values);
  if (std::isnan(phi) || std::isnan(psi)) return;
  listing.add("coulomb_angle_deg", 45 + phi / 2, "degrees");
  listing.add("arthur_angle_deg", 45 + (phi + psi) / 4, "degrees");
  listing.add("roscoe_angle_deg", 45 + psi / 2, "degrees");
}

/// Loops of the last stage.
void add_loops(Listing& listing, const io::RecordedTest& test, const std::vector<ensemble::Loop>& loops,
               int dimension) {
  const ensemble::ReferenceModulus G_max = ensemble::reference_modulus(calibrate::last_stage(test.result), loops,
                                                                       test.result.probes, test.result.axis, dimension);
  listing.add("G_max_Pa", G_max.G, "Pa");
  listing.add("G_max_of", G_max.of);
  Json rows = Json::array();
  for (std::size_t k = 0; k < loops.size(); ++k)
    rows.push_back({{"loop", k + 1},
                    {"gamma", loops[k].gamma},
                    {"G_Pa", loops[k].G},
                    {"G_over_G_max", loops[k].G / G_max.G},
                    {"damping_ratio", loops[k].damping_ratio}});
  listing.add("loops", std::move(rows));
}

/// Weakest bands of the probes, over that of the first.
void add_probes(Listing& listing, const std::vector<records::ProbeResult>& probes) {
  if (probes.empty()) return;
  const double first = weakest_band(probes.front().stiffness).determinant;
  Json rows = Json::array();
  for (const records::ProbeResult& probe : probes) {
    const Band band = weakest_band(probe.stiffness);
    rows.push_back({{"stage", probe.stage},
                    {"acoustic_ratio", band.determinant / first},
                    {"band_normal", std::vector<double>(band.normal.begin(), band.normal.end())}});
  }
  listing.add("probes", std::move(rows));
}

/// Features of a monotonic test that it reaches.
void add_features(Listing& listing, const io::RecordedTest& test, int dimension) {
  ensemble::TestPath path = ensemble::path_of(test.result, dimension, true, keys::infinity);
  const bool oedometer = path.loading.size() > 2;
  if (!oedometer) path = ensemble::path_of(test.result, dimension, false, keys::infinity);
  const auto protocol = protocol::parse_recorded_protocol(test.provenance.protocol, "the protocol in the file");
  Json features = Json::object();
  for (const ensemble::Feature& each : ensemble::usual_features(ensemble::test_kind(protocol, oedometer)))
    if (const double value = ensemble::value_of(each, path); std::isfinite(value)) features[each.name] = value;
  listing.add_to_json("features", features);
}

void add_test(Listing& listing, const io::RecordedTest& test, int dimension) {
  add_probes(listing, test.result.probes);
  if (test.result.records.empty()) return;
  const auto loops = ensemble::loops_of(calibrate::last_stage(test.result), test.result.axis, dimension);
  if (loops.empty()) {
    add_instability(listing, test, dimension);
    add_features(listing, test, dimension);
  } else {
    add_loops(listing, test, loops, dimension);
  }
  std::vector<double> strains;
  for (const records::Record& record : test.result.records) strains.push_back(record.strain);
  listing.add_to_json("strains", strains);
  listing.add_to_json("second_order_work_Pa", ensemble::second_order_work(test.result.records));
  listing.add_to_json("second_order_work_normalised", ensemble::normalised_second_order_work(test.result.records));
}

void add_contacts(Listing& listing, const Network& network) {
  const ForceNetworks networks = force_networks(network);
  listing.add("contacts", network.contacts.size());
  add_anisotropies(listing, network);
  add_network(listing, "strong", networks.strong);
  add_network(listing, "weak", networks.weak);
}

void run_measure(const std::string& path, bool as_json) {
  const bool only_journal = !std::filesystem::exists(path) && std::filesystem::exists(io::journal_of(path));
  Listing listing;
  listing.add("file", path);
  if (only_journal || io::file_kind(path) == io::FileKind::records) {
    const io::RecordedTest test = io::read_recorded_test(path);
    const Network network = Rve(test.checkpoint.specimen).network();
    add_contacts(listing, network);
    add_test(listing, test, network.dimension());
  } else {
    add_contacts(listing, Rve(io::read_specimen(path)).network());
  }
  listing.print(as_json);
}

}  // namespace

void add_measure(CLI::App& app) {
  CLI::App& command = *app.add_subcommand("measure", "Measure the contact network, and stability or loops of a test");
  const auto file = std::make_shared<std::string>();
  const auto json = std::make_shared<bool>();
  command.add_option("file", *file, "specimen or record file, *.h5")->required();
  add_json(command, *json);
  command.footer(
      "a_c, a_n, a_t, a_l, a_lt: anisotropies of contact normals, normal forces, tangential forces, and of branches\n"
      "along and across the normals, along the deviator of the stress. q_over_p_predicted: what they make of q/p\n"
      "(Rothenburg and Bathurst 1989; Guo and Zhao 2013). Strong contacts bear more than the mean normal force\n"
      "(Radjai et al. 1998). Along a test: [output] quantities of its protocol.\n\n"
      "Of a test that drives a strain one way: the least second-order work over 0.5 % of strain, from -1 to 1, the\n"
      "strain from which it is negative, and angles between the normal of a shear band and the major stress. Of a "
      "cyclic\n"
      "one: secant shear modulus and damping ratio of each loop. Of probes: least det of the acoustic tensor over "
      "that\n"
      "of the first.\n\n"
      "Examples:\n  rvelab measure dense.h5\n  rvelab measure R.h5 --json");
  command.callback([file, json] { run_measure(*file, *json); });
}

}  // namespace rvelab::cli
