// rvelab import: specimens from tables, as YADE scripts and spreadsheets write them, from dumps and data files of
// LAMMPS, and from snapshots. Declared in command.hpp.
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "rvelab/cli/command.hpp"
#include "rvelab/cli/protocol_input.hpp"
#include "rvelab/cli/report.hpp"
#include "rvelab/cli/warnings.hpp"
#include "rvelab/error.hpp"
#include "rvelab/io/hdf5/specimen_file.hpp"
#include "rvelab/io/import/csv.hpp"
#include "rvelab/io/import/snapshot_file.hpp"
#include "rvelab/io/publish.hpp"
#include "rvelab/measure/proportions.hpp"
#include "rvelab/pack/plausible.hpp"
#include "rvelab/solver/rve.hpp"

namespace rvelab::cli {
namespace {

struct ImportArguments {
  std::string inputs[3];
  std::optional<Vector3> cell;
  std::string material, output;
  std::optional<long> timestep, dimension;
  std::vector<std::string> settings;
  bool force = false, json = false;
};

/// A file that ends in .json is META.json; of the others the first holds particles, the second contacts.
struct Inputs {
  std::string particles;
  std::optional<std::string> contacts, meta;
};

Inputs sorted(const std::string (&files)[3]) {
  std::vector<std::string> tables, metas;
  for (const auto& file : files) {
    if (!file.empty()) (file.ends_with(".json") ? metas : tables).push_back(file);
  }
  if (tables.empty() || tables.size() > 2 || metas.size() > 1) {
    throw InputError("import was given " + std::to_string(tables.size()) + " CSV and " + std::to_string(metas.size()) +
                     " JSON files; allowed: PARTICLES.csv [CONTACTS.csv] [META.json]; name these");
  }
  Inputs inputs{tables[0], std::nullopt, std::nullopt};
  if (tables.size() == 2) inputs.contacts = tables[1];
  if (!metas.empty()) inputs.meta = metas[0];
  return inputs;
}

Vector3 edges_in(const std::string& text) {
  Vector3 edges;
  char beyond;
  if (std::sscanf(text.c_str(), "%lf,%lf,%lf%c", &edges[0], &edges[1], &edges[2], &beyond) != 3)
    throw CLI::ValidationError("--cell", text + " is not three numbers with commas between, as in 1,1,0.5");
  return edges;
}

/// A snapshot contains its complete specimen.
Specimen from_snapshot(const ImportArguments& arguments) {
  const std::string& file = arguments.inputs[0];
  const auto refuse = [&](const std::string& given) {
    throw InputError(file + " was given with " + given +
                     "; a snapshot holds its cell, materials and contacts already; leave it out");
  };
  if (!arguments.inputs[1].empty()) refuse(arguments.inputs[1]);
  if (!arguments.material.empty()) refuse("--material");
  if (!arguments.settings.empty()) refuse("--set");
  if (arguments.cell) refuse("--cell");
  if (arguments.timestep) refuse("--timestep");
  if (arguments.dimension) refuse("--dimension");
  return io::read_snapshot(file);
}

Specimen from_tables(const ImportArguments& arguments) {
  const Inputs inputs = sorted(arguments.inputs);
  io::ImportOptions options;
  options.cell = arguments.cell;
  if (!arguments.material.empty()) options.material_path = arguments.material;
  options.settings = arguments.settings;
  if (arguments.timestep) options.timestep = *arguments.timestep;
  if (arguments.dimension) options.dimension = int(*arguments.dimension);
  options.tell = tell;
  return io::import_csv(inputs.particles, inputs.contacts, inputs.meta, options);
}

void run_import(const ImportArguments& arguments) {
  expect_folder_of(arguments.output);
  std::vector<std::string> files{arguments.material};
  for (const auto& file : arguments.inputs) files.push_back(file);
  io::expect_output(arguments.output, arguments.force, files);
  const std::string& first = arguments.inputs[0];
  const Specimen specimen = first.ends_with(io::snapshot_ending) ? from_snapshot(arguments) : from_tables(arguments);
  // Opens it before writing it, so that an invalid specimen is an error here.
  const Sizes sizes = sizes_of(Rve(specimen).network());
  io::write_specimen(specimen, arguments.output);

  Listing listing;
  listing.add("file", arguments.output);
  listing.add("dimension", specimen.cell.dimension);
  listing.add("grains", specimen.grains.size());
  listing.add("contacts_read", specimen.contacts.size());
  listing.add("contact_law", name(specimen.contact.law));
  listing.add("slip", name(specimen.contact.slip));
  listing.add("rolling", specimen.contact.rolling);
  listing.add("lattice_m", row_major(specimen.cell.lattice), "m");
  add_proportions(listing, sizes);
  listing.print(arguments.json);
  warn_of_sizes(sizes);
  warn_of_units(first, pack::unusual_in(specimen));
}

}  // namespace

void add_import(CLI::App& app) {
  CLI::App& command =
      *app.add_subcommand("import", "Make a specimen from tables, a dump or data file of LAMMPS, or a snapshot");
  const auto arguments = std::make_shared<ImportArguments>();
  command
      .add_option("PARTICLES.csv", arguments->inputs[0],
                  "columns [id,]x,y[,z] and r, radius or diameter, for ellipses a,b,angle; YADE's export.text; or a\n"
                  "text dump or data file (atom_style sphere) of LAMMPS in SI units; packed by gzip or not; or alone\n"
                  "S.rvesnap, the state that the laboratory in the browser saved")
      ->required();
  command.add_option("CONTACTS.csv", arguments->inputs[1], "columns id1,id2,sx,sy[,sz],fn,fsx,fsy[,fsz],mz");
  command.add_option("META.json", arguments->inputs[2], "parameters and cell of the packing");
  command.add_option("--timestep", arguments->timestep, "of a dump; without it the last one");
  command
      .add_option("--dimension", arguments->dimension,
                  "2 reads discs, 3 spheres; without it, centres at one z are discs in files of LAMMPS, and\n"
                  "a layer of spheres in tables")
      ->check(CLI::Range(2, 3));
  const auto read_cell = [arguments](const std::string& text) { arguments->cell = edges_in(text); };
  command
      .add_option_function<std::string>("--cell", read_cell,
                                        "Lxx,Lyy,Lzz of a rectangular cell in m; in 2D Lzz is the thickness")
      ->type_name("NUMBER,NUMBER,NUMBER");
  command.add_option("--material", arguments->material,
                     "TOML file with [[material]], [contact], [damping], [solver]; of several\n"
                     "materials, a column `material` of PARTICLES.csv names that of each grain");
  add_set(command, arguments->settings, "contact.slip=full_radius_ratcheting");
  command.add_option("-o,--output", arguments->output, "specimen file to write, S.h5")->required();
  add_force(command, arguments->force);
  add_json(command, arguments->json);
  command.footer(
      "Examples:\n"
      "  rvelab import dense.particles.csv dense.contacts.csv dense.json -o dense.h5\n"
      "  rvelab import E.particles.csv E.contacts.csv E.json --material E.material.toml -o E.h5   (of rvelab export)\n"
      "  rvelab import init.csv --cell 2,2,2 --material sand.toml -o loose.h5\n"
      "  rvelab import relaxed.dump.gz --timestep 20000 --material sand.toml -o relaxed.h5\n"
      "  rvelab import sphere.data --material sand.toml -o sphere.h5\n"
      "  rvelab import packing.txt --cell 0.01,0.01,0.02 --material sand.toml -o packing.h5   (of YADE's export.text)\n"
      "  rvelab import sheared.rvesnap -o sheared.h5   (of the laboratory in the browser)");
  command.callback([arguments] { run_import(*arguments); });
}

}  // namespace rvelab::cli
