#include "tools/mpm/output/checkpoint.hpp"

#include <algorithm>
#include <filesystem>
#include <set>

#include "tools/mpm/output/archive.hpp"
#include "tools/mpm/output/rocks.hpp"
#include "tools/mpm/rocks/rocks.hpp"

namespace mpm {
namespace {

/// All that a point holds, one by one.
template <int D, class Visit>
void describe(const Visit& visit, Point<D>& p) {
  each_number(visit, p.position, p.velocity, p.stress, p.stress_zz, p.mass, p.volume, p.work, p.affine, p.gradient, p.F,
              p.strain, p.first, p.half);
}

template <int D, class Visit>
void describe(const Visit& visit, FluidPoint<D>& p) {
  each_number(visit, p.velocity, p.affine, p.mass, p.solids, p.first_void_ratio, p.conductivity, p.pressure,
              p.first_pressure, p.first_vertical, p.liquefied);
}

/// A row a point, whose last number may be NaN if `open`.
template <class P>
void archive_points(Archive& archive, const std::string& name, std::vector<P>& points, bool open) {
  std::size_t width = 0;
  P any;
  describe([&](const double&) { ++width; }, any);
  const auto all = [&](const auto& visit) {
    for (P& point : points) describe(visit, point);
  };
  archive.numbers(name, all, width, open ? width - 1 : width);
}

std::string pool_name(const std::string& material, long steps) {
  return "grains_" + material + "_" + std::to_string(steps) + ".h5";
}

/// Whether a file holds RVEs of this material, of any step. One material's name may begin with another's.
bool holds_pool(const std::string& file, const std::string& material) {
  const std::string before = "grains_" + material + "_", after = ".h5";
  if (file.size() <= before.size() + after.size() || !file.starts_with(before) || !file.ends_with(after)) return false;
  return std::all_of(file.begin() + long(before.size()), file.end() - long(after.size()),
                     [](char c) { return c >= '0' && c <= '9'; });
}

/// Files of RVEs of earlier checkpoints are of no use any more.
template <int D>
void remove_old_pools(const Model<D>& model, const std::filesystem::path& directory) {
  std::set<std::string> current;
  for (const auto& [material, pool] : model.pools) current.insert(pool_name(material, model.solver.steps));
  std::vector<std::filesystem::path> old;
  for (const auto& entry : std::filesystem::directory_iterator(directory)) {
    const auto name = entry.path().filename().string();
    const bool ours = std::any_of(model.pools.begin(), model.pools.end(),
                                  [&](const auto& pool) { return holds_pool(name, pool.first); });
    if (ours && !current.contains(name)) old.push_back(entry.path());
  }
  std::error_code ignored;
  for (const auto& path : old) std::filesystem::remove(path, ignored);
}

/// Of each body: 1 at its surface, 0 at nodes.
template <int D>
std::vector<std::int64_t> contacts_of(const Solver<D>& solver) {
  std::vector<std::int64_t> kinds;
  for (const auto& body : solver.bodies.all) kinds.push_back(body.at_surface);
  return kinds;
}

template <int D>
void expect_masses(const Archive& archive, const std::vector<Point<D>>& points) {
  for (std::size_t k = 0; k < points.size(); ++k) {
    const std::string of_point = " of points[" + std::to_string(k) + "]";
    if (!(points[k].mass > 0)) archive.no_state("mass" + of_point, points[k].mass, "> 0 kg");
    if (!(points[k].volume > 0)) archive.no_state("volume" + of_point, points[k].volume, "> 0 m^3");
  }
}

/// Lowest node and number of nodes along each axis, as a list; from it again when reading.
template <class Index>
void archive_box(Archive& archive, const std::string& name, Index& low, Index& count) {
  archive.numbers<std::int64_t>(name, [&](const auto& visit) {
    for (auto& each : low) visit(each);
    for (auto& each : count) visit(each);
  });
}

template <int D>
void archive_water(Archive& archive, Fluid<D>& water) {
  archive_points(archive, "fluid_points", water.points, true);  // `liquefied`: NaN until it has
  archive.numbers("fluid_totals", [&](const auto& visit) {
    each_number(visit, water.nodal_energy, water.gravity_work, water.drag_loss, water.water_work, water.outflow);
    for (auto& each : water.planes.all) each_number(visit, each.reaction.impulse, each.reaction.work);
    for (auto& each : water.bodies.all) each_number(visit, each.reaction.impulse, each.reaction.work);
  });
  auto low = water.pressure.low(), count = water.pressure.count();
  auto values = water.pressure.values;
  archive_box(archive, "nodal_pressure_box", low, count);
  archive.list("nodal_pressure_Pa", values);
  if (!archive.reads()) return;
  std::size_t nodes = 1;
  for (const auto each : count) nodes *= std::size_t(each);
  if (nodes != values.size()) archive.of_another_scene("nodes of the pressure", values.size(), nodes);
  water.pressure.restore(low, count, values);
}

template <int D>
void archive_progress(Archive& archive, Solver<D>& solver, Progress& progress) {
  // A grid that follows a plane was put at the start of the last step; the size of the next one hangs on it.
  archive.numbers("clock", [&](const auto& visit) {
    each_number(visit, progress.start.kinetic, progress.start.potential, progress.start.volume, progress.last_row,
                progress.next_frame, progress.next_row, progress.next_checkpoint, progress.seen.first_step,
                progress.seen.energy, solver.time, solver.nodal_energy, solver.grid.cell);
  });
  archive.numbers<std::int64_t>("counts", [&](const auto& visit) {
    each_number(visit, solver.steps, progress.history.bytes, progress.history.checksum, progress.watched.bytes,
                progress.watched.checksum, progress.seen.warned_step, progress.seen.warned_energy);
  });
  archive.list("impulses", progress.impulses);
  archive.list("frame_times", progress.frame_times);
}

/// Everything but the RVEs.
template <int D>
void archive_model(Archive& archive, Model<D>& model, Progress& progress) {
  auto& solver = model.solver;
  archive_points(archive, "points", solver.points, false);
  if (archive.reads()) expect_masses<D>(archive, solver.points);
  archive.numbers("reactions", [&](const auto& visit) {
    solver.each_driven([&](auto& each) { each_number(visit, each.reaction.impulse, each.reaction.work); });
  });
  archive_progress<D>(archive, solver, progress);
  // Sums over nodes are made in pieces of the box.
  archive_box(archive, "grid_box", solver.grid.low, solver.grid.count);
  if (archive.reads() && !solver.points.empty()) {
    solver.grid.restore();
    solver.planes.rebuild(solver.grid, solver.time);
  }
  archive.list("watched", model.watched);
  const auto contacts = contacts_of(solver);
  auto kept = contacts;
  archive.list("contact_at_surface", kept);
  if (kept != contacts) {
    archive.refuse(
        "its bodies were met by another contact than in this scene; leave out the --set of a body's contact, or start "
        "the run again in another folder");
  }
  const auto& bodies = solver.bodies.all;
  if (std::any_of(bodies.begin(), bodies.end(), [](const auto& body) { return body.plate.has_value(); })) {
    archive.numbers("plates", [&](const auto& visit) {
      for (auto& body : solver.bodies.all) {
        if (!body.plate) continue;
        auto& plate = *body.plate;
        each_number(visit, plate.mass, plate.area, plate.displacement, plate.velocity, plate.rock_force,
                    plate.held_from);
      }
    });
  }
  if (solver.loads.any()) archive.numbers("load_work_J", [&](const auto& visit) { visit(solver.load_work); });
  if (solver.fluid) archive_water<D>(archive, *solver.fluid);
  if (solver.rocks) archive_rocks<D>(archive, solver);
}

}  // namespace

template <int D>
void write_checkpoint(Model<D>& model, Progress& progress, const std::string& folder) {
  const std::filesystem::path directory(folder);
  for (const auto& [name, pool] : model.pools) pool->write((directory / pool_name(name, model.solver.steps)).string());
  const auto path = (directory / "checkpoint.h5").string();
  auto file = Hdf5File::in_memory(path);
  Archive archive(file, folder, false);
  archive_model<D>(archive, model, progress);
  for (const auto& group : model.solver.groups) group.material->save(file, group.name);
  rvelab::io::publish(path, file);
  remove_old_pools<D>(model, directory);
}

template <int D>
void read_checkpoint(Model<D>& model, Progress& progress, const std::string& folder) {
  const std::filesystem::path directory(folder);
  auto file = Hdf5File::open((directory / "checkpoint.h5").string());
  Archive archive(file, folder, true);
  archive_model<D>(archive, model, progress);
  for (auto& [name, pool] : model.pools) {
    const auto path = directory / pool_name(name, model.solver.steps);
    if (!std::filesystem::exists(path)) {
      throw InputError(path.string() +
                       ": the RVEs of the checkpoint are missing; put the file back, or start the run again");
    }
    pool->read(path.string());
  }
  for (auto& group : model.solver.groups) group.material->restore(file, group.name);
}

template void write_checkpoint<2>(Model<2>&, Progress&, const std::string&);
template void write_checkpoint<3>(Model<3>&, Progress&, const std::string&);
template void read_checkpoint<2>(Model<2>&, Progress&, const std::string&);
template void read_checkpoint<3>(Model<3>&, Progress&, const std::string&);

}  // namespace mpm
