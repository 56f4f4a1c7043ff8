// rvelab-voids: local void ratios, pore sizes and an estimate of the permeability of a specimen. It is a separate
// program because CGAL's triangulations are under the GPL; rvelab and its libraries do not contain them.
#include <rvelab/rvelab.h>
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <string>

#include "rvelab/error.hpp"
#include "rvelab/io/publish.hpp"
#include "rvelab/io/utf8.hpp"
#include "tools/voids/listing.hpp"
#include "tools/voids/pores.hpp"
#include "tools/voids/specimen.hpp"

namespace rvelab::voids {
namespace {

struct Options {
  std::string file, output;
  double kozeny_constant = 5;
  bool force = false, json = false;
};

/// Quantile of the values, linear between neighbours in their order. NaN for no values.
double quantile(std::vector<double> values, double share) {
  if (values.empty()) return std::nan("");
  std::sort(values.begin(), values.end());
  const double at = share * double(values.size() - 1);
  const auto below = std::size_t(at);
  const double next = values[std::min(below + 1, values.size() - 1)];
  return values[below] + (at - double(below)) * (next - values[below]);
}

/// Number, 10 %, 50 % and 90 % values; `unit` ends the keys.
void add_distribution(Listing& listing, const std::string& name, const std::vector<double>& values,
                      const std::string& unit) {
  const std::string end = unit.empty() ? "" : "_" + unit;
  for (const int percent : {10, 50, 90})
    listing.add(name + "_" + std::to_string(percent) + "_percent" + end, quantile(values, 0.01 * percent), unit);
}

std::vector<double> radii(const std::vector<Pore>& pores) {
  std::vector<double> all;
  for (const Pore& pore : pores) all.push_back(pore.radius);
  return all;
}

std::string line_of(const Vector3& place) {
  return io::exact(place[0]) + "," + io::exact(place[1]) + "," + io::exact(place[2]);
}

std::string pores_table(const Matrix3& rotation, const std::vector<Pore>& pores) {
  std::string text = "x_m,y_m,z_m,radius_m\n";
  for (const Pore& pore : pores) text += line_of(rotation * pore.centre) + "," + io::exact(pore.radius) + "\n";
  return text;
}

std::string cells_table(const PackedGrains& grains, const PowerCells& cells, const std::vector<double>& ratios) {
  std::string text = "id,x_m,y_m,z_m,radius_m,cell_volume_m3,void_ratio\n";
  for (std::size_t k = 0; k < ratios.size(); ++k) {
    const Ball& ball = grains.balls[k];
    text += std::to_string(grains.id[k]) + "," + line_of(grains.rotation * ball.position) + "," +
            io::exact(ball.radius) + "," + io::exact(cells.volume[k]) + "," + io::exact(ratios[k]) + "\n";
  }
  return text;
}

void add_permeability(Listing& listing, const std::vector<Ball>& balls, int dimension, double void_ratio,
                      double constant) {
  const double surface = specific_surface(balls, dimension), k = kozeny_carman(void_ratio, surface, constant);
  const double water = 9.81e6;  // rho g/mu of water at 20 degrees, 1/(m s)
  listing.add("specific_surface_1_m", surface, "1/m");
  listing.add("kozeny_constant", constant);
  listing.add("permeability_m2", k, "m^2");
  listing.add("conductivity_of_water_m_s", water * k, "m/s");
}

int run(const Options& options) {
  const std::vector<std::string> names{options.output + ".cells.csv", options.output + ".bodies.csv",
                                       options.output + ".throats.csv"};
  if (!options.output.empty())
    for (const std::string& name : names)
      io::expect_output(name, options.force, {options.file, io::journal_of(options.file)});
  const PackedGrains grains = read_grains(options.file);
  const std::vector<Ball>& balls = grains.balls;
  const PeriodicCell& cell = grains.cell;
  const PowerCells cells = power_cells(cell, balls);
  const std::vector<double> ratios = local_void_ratios(cell, balls, cells);
  const Pores found = pores(cell, balls, cells);
  double sum = 0, solid = 0;
  for (std::size_t k = 0; k < balls.size(); ++k) {
    sum += cells.volume[k];
    solid += cells.volume[k] / (1 + ratios[k]);
  }
  Listing listing;
  listing.add("file", options.file);
  listing.add("grains", balls.size());
  listing.add("void_ratio", cell.volume() / solid - 1);
  add_distribution(listing, "local_void_ratio", ratios, "");
  listing.add("cells_over_volume_less_1", sum / cell.volume() - 1);
  listing.add("bodies", found.bodies.size());
  add_distribution(listing, "body_radius", radii(found.bodies), "m");
  listing.add("throats", found.throats.size());
  add_distribution(listing, "throat_radius", radii(found.throats), "m");
  add_permeability(listing, balls, cell.dimension, cell.volume() / solid - 1, options.kozeny_constant);
  if (!options.output.empty()) {
    io::publish_text(names[0], cells_table(grains, cells, ratios));
    io::publish_text(names[1], pores_table(grains.rotation, found.bodies));
    io::publish_text(names[2], pores_table(grains.rotation, found.throats));
    listing.add("written", names);
  }
  listing.print(options.json);
  return 0;
}

}  // namespace
}  // namespace rvelab::voids

int main(int argc, char** argv) {
  CLI::App app{
      "rvelab-voids: local void ratios, pore sizes and permeability of a specimen of discs or spheres\n\n"
      "  rvelab-voids dense.h5\n"
      "  rvelab-voids R.h5 -o voids      # voids.cells.csv, voids.bodies.csv, voids.throats.csv\n",
      "rvelab-voids"};
  app.set_version_flag("--version", std::string("rvelab-voids ") + rvelab_version());
  rvelab::voids::Options options;
  app.add_option("file", options.file, "Specimen file, or record file: its last state")->required();
  app.add_option("-o,--output", options.output, "What the names of the tables begin with; without: no tables");
  app.add_option("--kozeny", options.kozeny_constant, "Constant c of Kozeny and Carman, 5")->check(CLI::PositiveNumber);
  app.add_flag("--force", options.force, "Overwrite existing tables");
  app.add_flag("--json", options.json, "Print one JSON object");
  const auto fail = [&](int code, const std::string& message) {
    std::cerr << "rvelab-voids: " << rvelab::io::message_line(message, {argv + std::min(argc, 1), argv + argc}) << "\n";
    return code;
  };
  try {
    app.parse(argc, argv);
    return rvelab::voids::run(options);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);
    return fail(2, error.what() + std::string("; rvelab-voids --help explains the options"));
  } catch (const rvelab::InputError& error) {
    return fail(2, error.what());
  } catch (const std::filesystem::filesystem_error& error) {
    return fail(2, error.path1().string() + ": cannot be used (" + error.code().message() +
                       "); give the path of a file in a folder that you may use");
  } catch (const std::exception& failure) {
    return fail(1, failure.what());
  }
}
