// rvelab inspect: the content of a specimen or record file, and the measures of its state. Declared in command.hpp.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <type_traits>
#include <utility>

#include "rvelab/cli/command.hpp"
#include "rvelab/cli/grading_sizes.hpp"
#include "rvelab/cli/report.hpp"
#include "rvelab/cli/warnings.hpp"
#include "rvelab/error.hpp"
#include "rvelab/io/hdf5/specimen_file.hpp"
#include "rvelab/io/journal/journal.hpp"
#include "rvelab/io/journal/recorded_test.hpp"
#include "rvelab/measure/measures.hpp"
#include "rvelab/pack/read_recipe.hpp"
#include "rvelab/records/quantities.hpp"
#include "rvelab/solver/rve.hpp"
#include "rvelab/specimen/solids.hpp"

namespace rvelab::cli {
namespace {

void add_measured(Listing& listing, const records::QuantityText& text, double value) {
  const std::string unit = text.unit;
  listing.add(text.name, value, unit == "1" ? "" : unit);
}

/// Means over the grains: shortest over longest half axis, that in between over the longest, and Wadell's sphericity.
/// All are convex.
void add_forms(Listing& listing, const Network& network) {
  double aspect = 0, elongation = 0, sphericity = 0, blockiness = 0;
  Superellipsoid last{};
  double of_last = 0;
  for (const GrainState& grain : network.grains) {
    const Superellipsoid s = superellipsoid_of(grain);
    double half[3] = {s.a, s.b, s.c};
    std::sort(half, half + 3);
    aspect += half[0] / half[2];
    elongation += half[1] / half[2];
    const Superellipsoid unit = {s.a / s.c, s.b / s.c, 1, s.e, s.n};  // many grains have the same shape
    const auto near = [](double x, double y) { return std::abs(x - y) <= 1e-12 * std::abs(y); };
    if (!near(unit.a, last.a) || !near(unit.b, last.b) || unit.e != last.e || unit.n != last.n) {
      last = unit;
      of_last = sphericity_of(unit);
    }
    sphericity += of_last;
    blockiness = std::max({blockiness, s.e, s.n});
  }
  const double n = double(network.grains.size());
  listing.add("aspect_shortest_over_longest", aspect / n);
  listing.add("aspect_middle_over_longest", elongation / n);
  listing.add("largest_exponent", blockiness);
  listing.add("sphericity", sphericity / n);
  listing.add("convexity", 1.0);
}

void add_state(Listing& listing, const Rve& rve, const Json& sizes) {
  const records::MeasuredState state(rve);
  const Network& network = state.network;
  const int dimension = network.dimension();
  const Matrix3 stress = rve.stress();
  listing.add("dimension", dimension);
  listing.add("grains", network.grains.size());
  if (network.has_bodies() && !network.has_solids()) listing.add("members", network.members.size());
  listing.add("contacts", network.contacts.size());
  for (const auto& [key, value] : sizes.items()) listing.add(key, value, unit_of_size(key));
  if (network.has_solids()) add_forms(listing, network);
  const Interactions all = rve.interactions();
  each_interaction_law([&](auto kind, auto law) {
    using Law = decltype(law);
    const std::size_t kept = static_cast<const ListOf<Law>&>(all).items.size();
    if (kept == 0) return;
    const auto acting = std::count_if(network.interactions.begin(), network.interactions.end(),
                                      [&](const InteractionState& each) { return each.kind == kind; });
    listing.add(Law::name, acting);
    if constexpr (Law::family == Family::bonds) listing.add(Law::name + std::string("_broken"), kept - acting);
  });
  listing.add("stress_Pa", row_major(stress), "Pa");
  listing.add("p_Pa", mean_pressure(stress, dimension), "Pa");
  listing.add("q_Pa", deviatoric_stress(stress, dimension), "Pa");
  records::Quantities::for_each([&]<class Quantity>(std::type_identity<Quantity>, std::uint64_t) {
    if constexpr (Quantity::text.usual) add_measured(listing, Quantity::text, Quantity::measure(state));
  });
  listing.add("unbalanced_force_ratio", unbalanced_force_ratio(network));
  listing.add("unbalanced_torque_ratio", unbalanced_torque_ratio(network));
  listing.add("lattice_m", row_major(network.cell.lattice), "m");
  listing.add("rotation", row_major(network.cell.rotation));
  listing.add("volume_m3", network.cell.volume(), "m^3");
  listing.add("cell_thin", rve.cell_thin());
  const double most = 1e4,
               thin_from = shear_until_thin(network.cell, 0, dimension - 1, 4 * mean_diameter(network), most);
  listing.add_or_why("shear_until_thin", std::isfinite(thin_from) ? thin_from : std::nan(""), "",
                     std::string("no height falls below four mean diameters in shear v_x(") +
                         (dimension == 2 ? "y" : "z") + ") up to 1e4");
  add_proportions(listing, sizes_of(network));
}

Json parameters_of(const Material& material, const ContactModel& model) {
  Json json;
  json["name"] = material.name;
  json["density_kg_m3"] = material.density;
  for (const LawParameter& each : law_parameters())
    if (each.law == model.law) json[each.parameter.key] = material.*each.value;
  json["friction"] = material.friction;
  if (model.rolling) {
    json["rolling_stiffness"] = material.rolling_stiffness;
    json["rolling_friction"] = material.rolling_friction;
  }
  return json;
}

void add_model(Listing& listing, const Specimen& specimen) {
  listing.add("contact_law", name(specimen.contact.law));
  listing.add("slip", name(specimen.contact.slip));
  listing.add("rolling", specimen.contact.rolling);
  listing.add("unload_rescale", specimen.contact.unload_rescale);
  if (has_hertz_curvature(specimen.shape)) listing.add("hertz_radius", name(specimen.contact.hertz_radius));
  listing.add("dashpot", name(specimen.damping.dashpot));
  listing.add("local_damping", specimen.damping.local);
  listing.add("reference_pressure_Pa", specimen.state.reference.pressure, "Pa");
  Json materials = Json::array();
  for (const Material& material : specimen.materials) materials.push_back(parameters_of(material, specimen.contact));
  listing.add("materials", std::move(materials));
}

/// Of the recipe that a specimen file holds; nothing of one that is no recipe without other files (clumps of members)
/// or to this version.
Json sizes_asked_by(const io::SpecimenOrigin& origin, const std::string& path) {
  try {
    return asked_sizes(pack::parse_recipe(origin.recipe, path).recipe);
  } catch (const InputError&) {
    return Json::object();
  }
}

void run_inspect(const std::string& path, bool as_json) {
  // A run that has just begun has only its journal.
  const bool only_journal = !std::filesystem::exists(path) && std::filesystem::exists(io::journal_of(path));
  const bool has_records = only_journal || io::file_kind(path) == io::FileKind::records;
  Listing listing;
  listing.add("file", path);
  listing.add("kind", has_records ? "records" : "specimen");
  Specimen specimen;
  Json sizes = Json::object();
  if (has_records) {
    io::RecordedTest test = io::read_recorded_test(path);
    listing.add("protocol", test.result.protocol);
    listing.add("complete", test.complete ? 1 : 0);
    listing.add("records", test.result.records.size());
    listing.add("snapshots", test.snapshots.size());
    listing.add("stages", test.result.stages);
    specimen = std::move(test.checkpoint.specimen);
  } else {
    specimen = io::read_specimen(path);
    if (const auto origin = io::read_origin(path)) {
      listing.add("seed", origin->seed);
      listing.add("draw", origin->draw);
      listing.add("preparation_friction", origin->preparation_friction);
      if (origin->expansion) listing.add("expansion", *origin->expansion);
      if (origin->strain_difference) listing.add("strain_difference", *origin->strain_difference);
      sizes = sizes_asked_by(*origin, path);
    }
  }
  const Rve rve(specimen);
  sizes.update(drawn_sizes(specimen));
  add_state(listing, rve, sizes);
  add_model(listing, specimen);
  listing.print(as_json);
  warn_of_sizes(sizes_of(rve.network()));
  warn_of_largest_grain(path, specimen);
}

}  // namespace

void add_inspect(CLI::App& app) {
  CLI::App& command = *app.add_subcommand("inspect", "Show a specimen, or the last state of a test");
  const auto file = std::make_shared<std::string>();
  const auto json = std::make_shared<bool>();
  command.add_option("file", *file, "specimen or record file, *.h5")->required();
  add_json(command, *json);
  command.footer("Example:\n  rvelab inspect dense.h5 --json");
  command.callback([file, json] { run_inspect(*file, *json); });
}

}  // namespace rvelab::cli
