// rvelab clump: members of a clump for the surface of a grain. Declared in command.hpp.
#include <sstream>
#include <string>

#include "rvelab/cli/command.hpp"
#include "rvelab/cli/protocol_input.hpp"
#include "rvelab/cli/report.hpp"
#include "rvelab/grains/filling.hpp"
#include "rvelab/io/publish.hpp"
#include "rvelab/keys/regular_file.hpp"

namespace rvelab::cli {
namespace {

struct ClumpArguments {
  std::string surface, output;
  int members = 20;
  bool force = false, json = false;
};

std::string as_members(const Filling& filling, const std::string& surface) {
  std::ostringstream text;
  text << "# " << filling.spheres.size() << " spheres in " << surface << "\nx,y,z,r\n";
  for (const Ball& ball : filling.spheres)
    text << io::exact(ball.at.x()) << ',' << io::exact(ball.at.y()) << ',' << io::exact(ball.at.z()) << ','
         << io::exact(ball.radius) << '\n';
  return text.str();
}

void run_clump(const ClumpArguments& arguments) {
  expect_folder_of(arguments.output);
  io::expect_output(arguments.output, arguments.force, {arguments.surface});
  const Mesh mesh = read_stl(keys::whole_file<std::string>(arguments.surface, "an STL file", std::uint64_t{1} << 30),
                             arguments.surface);
  const Filling filling = filled(mesh, arguments.members);
  io::publish_text(arguments.output, as_members(filling, arguments.surface));
  Listing listing;
  listing.add("file", arguments.output);
  listing.add("triangles", mesh.triangles.size());
  listing.add("members", filling.spheres.size());
  listing.add("mean_distance", filling.mean_distance, "radii, surface to spheres");
  listing.add("largest_distance", filling.largest_distance, "radii");
  listing.add("volume_ratio", filling.volume_ratio, "of the grain's");
  listing.add("least_inertia_ratio", filling.inertia_ratio, "at equal volume");
  listing.add("largest_inertia_ratio", filling.largest_inertia_ratio);
  listing.print(arguments.json);
}

}  // namespace

void add_clump(CLI::App& app) {
  CLI::App& command = *app.add_subcommand("clump", "Fill the surface of a grain (STL) with the spheres of a clump");
  const auto arguments = std::make_shared<ClumpArguments>();
  command.add_option("surface", arguments->surface, "STL file, ASCII or binary: a closed surface, in any unit")
      ->required();
  command.add_option("-o,--output", arguments->output, "members to write: CSV with columns x, y, z, r")->required();
  command.add_option("--members", arguments->members, "spheres at most; more follow the surface more closely")
      ->check(CLI::Range(1, 200))
      ->capture_default_str();
  add_force(command, arguments->force);
  add_json(command, arguments->json);
  command.footer(
      "Spheres lie within the surface and touch it. The program prints deviations of the clump: distances over the\n"
      "radius of the sphere of the grain's volume, the volume of the spheres' union, principal moments of inertia of\n"
      "clump over grain at equal volume. A packed clump has the size of its grading, whatever the unit here.\n"
      "Example:\n"
      "  rvelab clump grain.stl -o grain.csv --members 12\n"
      "  rvelab pack pack_clumps -o S.h5 --set grains.pairs.clump=grain.csv");
  command.callback([arguments] { run_clump(*arguments); });
}

}  // namespace rvelab::cli
