// rvelab export: states of a specimen or a test for other programs. Declared in command.hpp.
#include <string>
#include <vector>

#include "rvelab/cli/command.hpp"
#include "rvelab/cli/protocol_input.hpp"
#include "rvelab/cli/report.hpp"
#include "rvelab/io/export/export.hpp"
#include "rvelab/io/journal/journal.hpp"
#include "rvelab/io/journal/recorded_test.hpp"
#include "rvelab/io/publish.hpp"
#include "rvelab/solver/rve.hpp"

namespace rvelab::cli {
namespace {

struct ExportArguments {
  std::string file, format, output;
  bool force = false, json = false;
};

io::ExportState state_of(const io::StoredState& state) {
  Rve rve(state.specimen);
  return {state.record, state.strain, rve.specimen(), rve.network()};
}

std::vector<io::ExportState> all_states(const std::string& path) {
  std::vector<io::ExportState> states;
  for (const io::StoredState& state : io::read_states(path)) states.push_back(state_of(state));
  return states;
}

/// "out/dense.csv" and "out/dense" both name the files out/dense.particles.csv and so on.
std::string stem_of(const std::string& output) {
  return output.ends_with(".csv") ? output.substr(0, output.size() - 4) : output;
}

/// The files that an export writes.
std::vector<std::string> files_to_write(const ExportArguments& arguments) {
  const std::string& output = arguments.output;
  if (arguments.format == "csv") {
    const io::CsvExport files = io::csv_files(stem_of(output));
    return {files.particles, files.contacts, files.meta, files.material};
  }
  if (arguments.format == "xdmf") return {output, output + ".h5"};
  return {output};
}

/// Interactions that a format does not hold, if there are any.
void tell_what_is_left_out(const Specimen& specimen, Listing& listing) {
  std::string kinds;
  each_interaction_law([&](auto, auto law) {
    using Law = decltype(law);
    if (static_cast<const ListOf<Law>&>(specimen).items.empty()) return;
    kinds += (kinds.empty() ? "" : ", ") + std::string(Law::name);
  });
  if (!kinds.empty()) listing.add("left_out", kinds + ": only xdmf and specimen files hold them");
}

/// Writes the files of one format, and adds to the listing what the user may want to know of them.
void write_export(const ExportArguments& arguments, Listing& listing) {
  if (arguments.format == "csv") {
    const Specimen specimen = io::read_states(arguments.file).back().specimen;
    const io::CsvExport files = io::export_csv(specimen, stem_of(arguments.output));
    tell_what_is_left_out(specimen, listing);
    listing.add("import_with", "rvelab import " + files.particles + " " + files.contacts + " " + files.meta +
                                   " --material " + files.material + " -o S.h5");
  } else if (arguments.format == "lammps-data") {
    const io::ExportState state = state_of(io::read_states(arguments.file).back());
    io::export_lammps_data(state, arguments.output);
    tell_what_is_left_out(state.specimen, listing);
  } else {
    const auto states = all_states(arguments.file);
    listing.add("states", states.size());
    (arguments.format == "xdmf" ? io::export_xdmf : io::export_lammps_dump)(states, arguments.output);
    if (arguments.format != "xdmf") tell_what_is_left_out(states.back().specimen, listing);
  }
}

void run_export(const ExportArguments& arguments) {
  expect_folder_of(arguments.output);
  const auto files = files_to_write(arguments);
  for (const auto& file : files) {
    io::expect_output(file, arguments.force, {arguments.file, io::journal_of(arguments.file)});
  }
  Listing listing;
  listing.add("file", arguments.file);
  listing.add("format", arguments.format);
  write_export(arguments, listing);
  listing.add("written", files);
  listing.print(arguments.json);
}

}  // namespace

void add_export(CLI::App& app) {
  CLI::App& command = *app.add_subcommand("export", "Write a specimen or a test for ParaView, OVITO, LAMMPS or YADE");
  const auto arguments = std::make_shared<ExportArguments>();
  command.add_option("file", arguments->file, "specimen or record file, *.h5")->required();
  command
      .add_option("--format", arguments->format,
                  "xdmf: grains, contacts and cell for ParaView\n"
                  "lammps: dump of LAMMPS, which OVITO reads too\n"
                  "lammps-data: data file of LAMMPS\n"
                  "csv: particles, contacts and parameters, as rvelab import reads them")
      ->check(CLI::IsMember({"xdmf", "lammps", "lammps-data", "csv"}))
      ->required();
  command.add_option("-o,--output", arguments->output, "file to write; csv: beginning of the file names")->required();
  add_force(command, arguments->force, "existing files");
  add_json(command, arguments->json);
  command.footer(
      "xdmf and lammps write every snapshot of a record file and its end state; the other formats write the last "
      "state.\n"
      "xdmf and csv are in the laboratory frame, lammps in the cell frame, whose lattice is upper triangular as "
      "LAMMPS\n"
      "wants it.\n\n"
      "Examples:\n"
      "  rvelab export dense.h5 --format csv -o dense\n"
      "  rvelab export R.h5 --format xdmf -o R.xdmf\n"
      "  rvelab export R.h5 --format lammps -o R.dump");
  command.callback([arguments] { run_export(*arguments); });
}

}  // namespace rvelab::cli
