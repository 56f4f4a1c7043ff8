// rvelab bench: grain-steps per second of Rve::apply in simple shear, with integration, list rebuilds and control, on
// one thread unless --threads is given.
//
// The packings come from fixed recipes: 400 discs, 400 ellipses of the same areas (aspect ratio 0.743, Liang et al.
// 2023) and 1000 spheres at 100 kPa; larger cases repeat them periodically. Each case shears at constant volume with
// physical masses at inertial number 1e-3 for a fixed number of steps, several times; the median is reported.
// Declared in command.hpp.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>

#include "rvelab/cli/command.hpp"
#include "rvelab/cli/protocol_input.hpp"
#include "rvelab/cli/report.hpp"
#include "rvelab/error.hpp"
#include "rvelab/io/hdf5/specimen_file.hpp"
#include "rvelab/keys/key.hpp"
#include "rvelab/pack/repeated.hpp"
#include "rvelab/pack/search.hpp"
#include "rvelab/solver/kernels/configuration.hpp"
#include "rvelab/solver/rve.hpp"
#include "rvelab/threads/workers.hpp"

namespace rvelab::cli {

namespace {

pack::Recipe discs(bool rolling) {
  pack::Recipe r;
  Material& material = r.materials[0];
  material.young_modulus = 8e8;
  material.stiffness_ratio = 0.5;
  material.friction = 0.4245;  // tan 23 degrees (Liang and Zhao 2019, table 2)
  r.contact.rolling = rolling;
  if (rolling) {
    material.rolling_stiffness = 1;
    material.rolling_friction = 0.05;
  }
  r.stress = pack::isotropic_stress(1e5, r.shape);
  r.preparation.friction = 0.02;
  return r;
}

pack::Recipe ellipses() {
  pack::Recipe r = discs(false);
  r.shape = Shape::ellipse;
  r.fractions[0].smallest_aspect_ratio = r.fractions[0].largest_aspect_ratio = 0.743;
  r.preparation.friction = 0.3;  // looser: dense ellipses at constant volume were pressed together beyond the limit
  return r;
}

pack::Recipe spheres() {
  pack::Recipe r;
  r.shape = Shape::sphere;
  r.number = 1000;
  r.fractions[0].grading.smallest_radius = 1e-3;
  r.fractions[0].grading.largest_radius = 2e-3;
  r.materials[0].young_modulus = 7e9;
  r.materials[0].poisson_ratio = 0.25;
  r.materials[0].friction = 0.5;
  r.contact.law = Law::hertz_mindlin;
  r.stress = pack::isotropic_stress(1e5, r.shape);
  r.preparation.friction = 0.1;
  return r;
}

Specimen packed(const pack::Recipe& recipe) {
  Workers alone(1);
  return pack::pack(recipe, alone).specimen;
}

/// Grain-steps per second of `work`, which is done `repeats` times, in ascending order. `prepare`: before each.
template <class Steps, class Prepare, class Work>
std::vector<double> speeds_of(int repeats, Steps steps_made, Prepare prepare, Work work) {
  std::vector<double> speeds;
  for (int k = 0; k < repeats; ++k) {
    prepare();
    const std::uint64_t before = steps_made();
    const auto begin = std::chrono::steady_clock::now();
    work();
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    speeds.push_back(double(steps_made() - before) / seconds);
  }
  std::sort(speeds.begin(), speeds.end());
  return speeds;
}

/// Rate of simple shear at inertial number 1e-3, 1/s.
double shear_rate(const Rve& rve, const Specimen& specimen) {
  double diameters = 0;
  for (double r : specimen.grains.radius) diameters += 2 * r;
  const double diameter = diameters / double(specimen.grains.size());
  const double pressure = std::max(1.0, -rve.stress()(0, 0));
  return 1e-3 / (diameter * std::sqrt(specimen.materials[0].density / pressure));
}

/// Times simple shear of the specimen.
Json entry(const Specimen& specimen, double grain_steps, bool quick, Workers& team) {
  const double n = double(specimen.grains.size());
  const long steps = std::max(20L, long(grain_steps / n));  // sub-steps per repeat
  Specimen start = specimen;
  start.damping.local = 0.1;  // as published (Liang and Zhao 2019, table 2)
  Rve rve(start);
  rve.share(&team);
  const double rate = shear_rate(rve, specimen);
  const double dt = 0.7 * rve.critical_time_step() * double(steps);
  Matrix3 dh = Matrix3::Zero();
  dh(0, rve.cell().dimension - 1) = rate * dt;
  rve.apply(dh, dt);                // warms up: caches, clock, the flow itself
  const auto flowing = rve.save();  // every repeat does the same work
  const auto speeds = speeds_of(
      quick ? 3 : 7, [&] { return rve.grain_steps(); }, [&] { rve.restore(flowing); }, [&] { rve.apply(dh, dt); });
  const SolverState state = rve.specimen().state;
  const Memory memory = rve.memory();
  Json out;
  out["grain_steps_per_second"] = speeds[speeds.size() / 2];
  out["least"] = speeds.front();
  out["most"] = speeds.back();
  out["grains"] = specimen.grains.size();
  out["contacts_per_grain"] = double(rve.network().contacts.size()) / n;
  out["steps_per_list"] = double(state.grain_steps) / n / double(std::max<std::uint64_t>(1, state.list.builds));
  out["bytes_per_grain"] = {
      {"state", double(memory.state) / n}, {"list", double(memory.list) / n}, {"working", double(memory.working) / n}};
  return out;
}

/// A packing, how often it is repeated along each lattice vector, and how many grain-steps are timed.
struct Case {
  const char* name;
  pack::Recipe recipe;
  Image times;
  double grain_steps, quick_grain_steps;
};

std::vector<Case> cases() {
  return {{"disc_400_linear", discs(false), {1, 1, 1}, 8e6, 1.6e6},
          {"disc_400_rolling", discs(true), {1, 1, 1}, 8e6, 1.6e6},
          {"ellipse_400_linear", ellipses(), {1, 1, 1}, 8e6, 1.6e6},
          {"disc_10000_linear", discs(false), {5, 5, 1}, 8e6, 1.6e6},
          {"sphere_1000_hertz", spheres(), {1, 1, 1}, 3e6, 6e5},
          {"sphere_32000_hertz", spheres(), {4, 4, 2}, 6.4e6, 3.2e6},
          {"sphere_256000_hertz", spheres(), {8, 8, 4}, 2.56e7, 2.56e7}};
}

std::vector<std::string> case_names() {
  std::vector<std::string> names;
  for (const Case& c : cases()) names.emplace_back(c.name);
  return names;
}

void expect_cases(const std::vector<std::string>& wanted) {
  const std::vector<std::string> names = case_names();
  for (const std::string& name : wanted)
    if (std::find(names.begin(), names.end(), name) == names.end())
      throw InputError("bench: no case \"" + name + "\"; the nearest is " + keys::nearest(name, names) +
                       "; see rvelab bench --help");
}

/// A specimen of about so many grains: a packing, or, above the number of the recipe, its packing repeated.
Specimen of_size(Shape shape, std::size_t grains) {
  pack::Recipe recipe = shape == Shape::disc ? discs(false) : spheres();
  if (grains <= std::size_t(recipe.number)) {
    recipe.number = decltype(recipe.number)(grains);
    return packed(recipe);
  }
  // Repeated k or k + 1 times along each lattice vector, whichever comes nearest.
  const double ratio = double(grains) / double(recipe.number);
  const int d = dimension_of(shape);
  const int k = std::max(1, int(std::floor(d == 2 ? std::sqrt(ratio) : std::cbrt(ratio))));
  Image best{k, k, d == 2 ? 1 : k};
  const auto off = [&](const Image& n) { return std::abs(std::log(double(n[0]) * n[1] * n[2] / ratio)); };
  for (Image n = best; n[std::size_t(d - 1)] == k;) {
    ++n[n[0] == k ? 0 : n[1] == k ? 1 : 2];
    if (off(n) < off(best)) best = n;
  }
  return pack::repeated(packed(recipe), best);
}

struct BenchArguments {
  std::size_t grains = 0;  ///< 0: the cases
  std::string shape = "disc";
  bool quick = false, json = false;
  std::size_t batch = 0;  ///< cells; 0: the cases
  unsigned threads = 1;
  std::vector<std::string> wanted;
  std::string folder;  ///< empty: time the cases; else: write their packings there
};

/// Times many cells of 400 discs with increments of 20 sub-steps, as a continuum code makes them.
void run_batch(const BenchArguments& arguments) {
  const Specimen specimen = packed(discs(false));
  std::vector<Rve> rves(arguments.batch, Rve(specimen));
  const double dt = 20 * 0.7 * rves[0].critical_time_step();
  std::vector<Matrix3> gradients(rves.size(), Matrix3::Zero());
  for (std::size_t k = 0; k < rves.size(); ++k)  // each cell has its own rate
    gradients[k](0, 1) = shear_rate(rves[0], specimen) * dt * (1 + double(k) / double(rves.size()));
  Workers workers(arguments.threads);
  const auto steps_made = [&] {
    std::uint64_t steps = 0;
    for (const Rve& rve : rves) steps += rve.grain_steps();
    return steps;
  };
  const auto increments = [&] {
    for (int increment = 0; increment < 4; ++increment)
      workers.for_each_in_turn(rves.size(), [&](std::size_t k) { rves[k].apply(gradients[k], dt); });
  };
  increments();  // warms up
  const auto speeds = speeds_of(
      arguments.quick ? 3 : 7, steps_made, [] {}, increments);
  Listing listing;
  listing.add("cells", rves.size());
  listing.add("threads", workers.count());
  listing.add("grain_steps_per_second", speeds[speeds.size() / 2]);
  listing.print(arguments.json);
}

void run_bench(const BenchArguments& arguments) {
  expect_cases(arguments.wanted);
  if (!arguments.folder.empty()) expect_folder_of(arguments.folder + "/packing.h5");
  if (arguments.batch > 0) return run_batch(arguments);
  Workers team(arguments.threads);
  Listing listing;
  listing.add("instruction_set", kernels_for(KernelConfiguration{}).instruction_set);
  if (arguments.grains > 0) {
    const Specimen specimen = of_size(arguments.shape == "disc" ? Shape::disc : Shape::sphere, arguments.grains);
    const double work = std::max(arguments.quick ? 1e6 : 5e6, 60.0 * double(specimen.grains.size()));
    listing.add(arguments.shape, entry(specimen, work, arguments.quick, team));
    listing.print(arguments.json);
    return;
  }
  for (const Case& c : cases()) {
    const auto& wanted = arguments.wanted;
    if (!wanted.empty() && std::find(wanted.begin(), wanted.end(), c.name) == wanted.end()) continue;
    const Specimen specimen = pack::repeated(packed(c.recipe), c.times);
    if (arguments.folder.empty()) {
      listing.add(c.name,
                  entry(specimen, arguments.quick ? c.quick_grain_steps : c.grain_steps, arguments.quick, team));
      continue;
    }
    const std::string path = (std::filesystem::path(arguments.folder) / (std::string(c.name) + ".h5")).string();
    io::write_specimen(specimen, path);
    const Rve rve(specimen);
    Json packing;
    packing["file"] = path;
    packing["critical_time_step_s"] = rve.critical_time_step();
    packing["shear_rate_1_s"] = shear_rate(rve, specimen);
    listing.add(c.name, packing);
  }
  listing.print(arguments.json);
}

}  // namespace

void add_bench(CLI::App& app) {
  CLI::App& command = *app.add_subcommand("bench", "Grain-steps per second of fixed cases");
  const auto arguments = std::make_shared<BenchArguments>();
  command.add_option("--case", arguments->wanted, "run this case only; give it again for more")
      ->allow_extra_args(false);
  command.add_option("--batch", arguments->batch, "time a batch of so many cells of 400 discs instead of the cases")
      ->check(CLI::Range(1, 1'000'000));
  command.add_option("--grains", arguments->grains, "time a cell of about so many grains instead of the cases")
      ->check(CLI::Range(20, 2'000'000));
  command.add_option("--shape", arguments->shape, "of the grains of --grains")
      ->check(CLI::IsMember({"disc", "sphere"}));
  add_threads(command, arguments->threads, "for a batch, and for cells of 30,000 grains or more");
  command.add_flag("--quick", arguments->quick, "a fifth of the work, three repeats");
  command.add_option("--packings", arguments->folder, "folder: write the packings of the cases there, time nothing");
  add_json(command, arguments->json);
  std::string names;
  for (const std::string& name : case_names()) names += "  " + name + "\n";
  command.footer("Cases:\n" + names +
                 "Examples:\n"
                 "  rvelab bench --quick --json\n"
                 "  rvelab bench --case disc_400_linear --packings .");
  command.callback([arguments] { run_bench(*arguments); });
}

}  // namespace rvelab::cli
