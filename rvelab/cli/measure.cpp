// rvelab measure: strong and weak contacts, anisotropies and the relation of stress, force and fabric, of a specimen or
// of the last state of a test. Declared in command.hpp.
#include <filesystem>
#include <string>

#include "rvelab/cli/command.hpp"
#include "rvelab/cli/report.hpp"
#include "rvelab/io/hdf5/specimen_file.hpp"
#include "rvelab/io/journal/journal.hpp"
#include "rvelab/io/journal/recorded_test.hpp"
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

Specimen last_state(const std::string& path) {
  const bool only_journal = !std::filesystem::exists(path) && std::filesystem::exists(io::journal_of(path));
  if (only_journal || io::file_kind(path) == io::FileKind::records)
    return io::read_recorded_test(path).checkpoint.specimen;
  return io::read_specimen(path);
}

void run_measure(const std::string& path, bool as_json) {
  const Network network = Rve(last_state(path)).network();
  const ForceNetworks networks = force_networks(network);
  Listing listing;
  listing.add("file", path);
  listing.add("contacts", network.contacts.size());
  add_anisotropies(listing, network);
  add_network(listing, "strong", networks.strong);
  add_network(listing, "weak", networks.weak);
  listing.print(as_json);
}

}  // namespace

Command measure_command() {
  return command_of_one_word(
      "measure", "Measure anisotropies, strong and weak contacts", "file", "specimen or record file, *.h5", true,
      "a_c, a_n, a_t, a_l, a_lt: anisotropies of contact normals, normal forces, tangential forces, and of branches\n"
      "along and across the normals, along the deviator of the stress. q_over_p_predicted: what they make of q/p\n"
      "(Rothenburg and Bathurst 1989; Guo and Zhao 2013). Strong contacts bear more than the mean normal force\n"
      "(Radjai et al. 1998). Along a test: [output] quantities of its protocol.\n\n"
      "Examples:\n  rvelab measure dense.h5\n  rvelab measure R.h5 --json",
      run_measure);
}

}  // namespace rvelab::cli
