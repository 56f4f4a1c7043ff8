#include "tools/mpm/output/checkpoint.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include "tools/mpm/files/hdf5.hpp"
#include "tools/mpm/output/rocks.hpp"
#include "tools/mpm/rocks/rocks.hpp"

namespace mpm {
namespace {

/// All that a point holds, as one row of doubles.
template <int D, class Field>
void each_field(Point<D>& point, const Field& field) {
  field(point.position.data(), D);
  field(point.velocity.data(), D);
  field(point.stress.data(), D * D);
  field(&point.stress_zz, 1);
  field(&point.mass, 1);
  field(&point.volume, 1);
  field(&point.work, 1);
  field(point.affine.data(), D * D);
  field(point.gradient.data(), D * D);
  field(point.F.data(), D * D);
  field(point.strain.data(), D * D);
  field(point.first.data(), D);
  field(point.half.data(), D);
}

template <int D, class Field>
void each_field(FluidPoint<D>& point, const Field& field) {
  field(point.velocity.data(), D);
  field(point.affine.data(), D * D);
  for (double* value : {&point.mass, &point.solids, &point.first_void_ratio, &point.conductivity, &point.pressure,
                        &point.first_pressure, &point.first_vertical, &point.liquefied}) {
    field(value, 1);
  }
}

/// What the water has beside its points and the pressure, one by one.
template <int D, class Visit>
void each_total(Fluid<D>& water, Visit visit) {
  for (double* value : {&water.nodal_energy, &water.gravity_work, &water.drag_loss, &water.water_work}) visit(*value);
  for (double& value : water.outflow) visit(value);
  const auto reactions = [&](auto& all) {
    for (auto& each : all) {
      for (double& value : each.reaction.impulse) visit(value);
      visit(each.reaction.work);
    }
  };
  reactions(water.planes.all);
  reactions(water.bodies.all);
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

/// What plates under pressure have come to, one by one.
template <int D, class Visit>
void each_plate(Bodies<D>& bodies, Visit visit) {
  for (auto& body : bodies.all) {
    if (!body.plate) continue;
    auto& plate = *body.plate;
    for (double* value :
         {&plate.mass, &plate.area, &plate.displacement, &plate.velocity, &plate.rock_force, &plate.held_from}) {
      visit(*value);
    }
  }
}

template <int D>
std::vector<double> plates_of(Bodies<D> bodies) {
  std::vector<double> values;
  each_plate<D>(bodies, [&](double value) { values.push_back(value); });
  return values;
}

/// Lowest node and number of nodes along each axis.
template <int D>
std::vector<std::int64_t> box_of(const Grid<D>& grid) {
  std::vector<std::int64_t> box(grid.low.begin(), grid.low.end());
  box.insert(box.end(), grid.count.begin(), grid.count.end());
  return box;
}

/// The times and energies of a run's progress, one by one.
template <class Visit>
void each_clock(Progress& progress, Visit visit) {
  for (double* value : {&progress.start.kinetic, &progress.start.potential, &progress.start.volume, &progress.last_row,
                        &progress.next_frame, &progress.next_row, &progress.next_checkpoint, &progress.seen.first_step,
                        &progress.seen.energy}) {
    visit(*value);
  }
}

std::vector<double> clock_of(Progress progress) {
  std::vector<double> values;
  each_clock(progress, [&](double value) { values.push_back(value); });
  return values;
}

[[noreturn]] void of_another_scene(const std::string& folder, const std::string& what, std::size_t found,
                                   std::size_t wanted) {
  throw InputError(folder + ": its checkpoint holds " + std::to_string(found) + " " + what + ", this scene needs " +
                   std::to_string(wanted) +
                   "; leave out the --set that changes their number, or start the run anew in another folder");
}

/// A checkpoint that was edited and sealed again.
[[noreturn]] void not_a_state(const std::string& folder, const std::string& what, double value,
                              const std::string& allowed) {
  throw InputError(folder + "/checkpoint.h5: " + what + " = " + text_of(value) + "; allowed: " + allowed +
                   "; put the file back from a copy, or start the run anew");
}

/// Rows of `width` numbers. `undefined`: the column that may be NaN, where there is one.
void expect_finite(const std::vector<double>& values, const std::string& name, std::size_t width,
                   const std::string& folder, std::size_t undefined = std::size_t(-1)) {
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (std::isfinite(values[k]) || (k % width == undefined && std::isnan(values[k]))) continue;
    const std::string column = width == 1 ? "" : ", " + std::to_string(k % width);
    not_a_state(folder, name + "[" + std::to_string(k / width) + column + "]", values[k], "a finite number");
  }
}

template <int D>
void expect_masses(const std::vector<Point<D>>& points, const std::string& folder) {
  for (std::size_t k = 0; k < points.size(); ++k) {
    const std::string of_point = " of points[" + std::to_string(k) + "]";
    if (!(points[k].mass > 0)) not_a_state(folder, "mass" + of_point, points[k].mass, "> 0 kg");
    if (!(points[k].volume > 0)) not_a_state(folder, "volume" + of_point, points[k].volume, "> 0 m^3");
  }
}

}  // namespace

namespace {

template <int D>
void write_water(Fluid<D>& water, OutputFile& file) {
  std::vector<double> rows, totals;
  for (auto& point : water.points) {
    each_field<D>(point, [&](const double* values, int count) { rows.insert(rows.end(), values, values + count); });
  }
  file.write("fluid_points", rows, {water.points.size(), rows.size() / water.points.size()});
  each_total<D>(water, [&](double value) { totals.push_back(value); });
  file.write("fluid_totals", totals, {totals.size()});
  const auto& pressure = water.pressure;
  std::vector<std::int64_t> box(pressure.low().begin(), pressure.low().end());
  box.insert(box.end(), pressure.count().begin(), pressure.count().end());
  file.write("nodal_pressure_box", box);
  file.write("nodal_pressure_Pa", pressure.values, {pressure.values.size()});
}

template <int D>
void read_water(Fluid<D>& water, const InputFile& file, const std::string& folder) {
  const auto rows = file.read("fluid_points");
  std::size_t at = 0, width = 0, count = 0;
  FluidPoint<D> any;
  each_field<D>(any, [&](const double*, int each) { width += std::size_t(each); });
  if (rows.size() != width * water.points.size()) {
    of_another_scene(folder, "saturated points", rows.size() / width, water.points.size());
  }
  expect_finite(rows, "fluid_points", width, folder, width - 1);  // `liquefied`: NaN until it has
  for (auto& point : water.points) {
    each_field<D>(point, [&](double* values, int each) {
      for (int i = 0; i < each; ++i) values[i] = rows[at++];
    });
  }
  const auto totals = file.read("fluid_totals");
  each_total<D>(water, [&](double&) { ++count; });
  if (totals.size() != count) of_another_scene(folder, "totals of the water", totals.size(), count);
  each_total<D>(water, [&, k = std::size_t(0)](double& value) mutable { value = totals[k++]; });
  const auto box = file.read_whole("nodal_pressure_box");
  const auto values = file.read("nodal_pressure_Pa");
  typename Grid<D>::Index low, size;
  std::int64_t nodes = 1;
  for (std::size_t i = 0; i < D && box.size() == 2 * D; ++i) {
    low[i] = int(box[i]);
    size[i] = int(box[D + i]);
    nodes *= box[D + i];
  }
  if (box.size() != 2 * D || nodes != std::int64_t(values.size())) {
    of_another_scene(folder, "nodes of the pressure", values.size(), std::size_t(nodes));
  }
  water.pressure.restore(low, size, values);
}

}  // namespace

template <int D>
void write_checkpoint(const Model<D>& model, const Progress& progress, const std::string& folder) {
  const std::filesystem::path directory(folder);
  const auto& solver = model.solver;
  for (const auto& [name, pool] : model.pools) pool->write((directory / pool_name(name, solver.steps)).string());
  OutputFile file((directory / "checkpoint.h5").string());
  std::vector<double> rows;
  for (auto point : solver.points) {
    each_field<D>(point, [&](const double* values, int count) { rows.insert(rows.end(), values, values + count); });
  }
  const std::size_t n = solver.points.size();
  file.write("points", rows, {n, n == 0 ? 0 : rows.size() / n});
  std::vector<double> reactions;
  solver.each_driven([&](const auto& each) {
    reactions.insert(reactions.end(), each.reaction.impulse.data(), each.reaction.impulse.data() + D);
    reactions.push_back(each.reaction.work);
  });
  file.write("reactions", reactions, {reactions.size()});
  auto clock = clock_of(progress);
  clock.insert(clock.end(), {solver.time, solver.nodal_energy});
  // A grid that follows a plane was placed at the start of the last step; the size of the next one hangs on it.
  clock.insert(clock.end(), solver.grid.cell.data(), solver.grid.cell.data() + D);
  file.write("clock", clock, {clock.size()});
  file.write("counts", std::vector<std::int64_t>{solver.steps, progress.history.bytes, progress.history.checksum,
                                                 progress.watched.bytes, progress.watched.checksum,
                                                 progress.seen.warned_step, progress.seen.warned_energy});
  // Sums over nodes are made in pieces of the box.
  file.write("grid_box", box_of<D>(solver.grid));
  file.write("impulses", progress.impulses, {progress.impulses.size()});
  file.write("frame_times", progress.frame_times, {progress.frame_times.size()});
  file.write("watched", std::vector<std::int64_t>(model.watched.begin(), model.watched.end()));
  file.write("contact_at_surface", contacts_of(solver));
  if (const auto plates = plates_of<D>(solver.bodies); !plates.empty()) file.write("plates", plates, {plates.size()});
  if (solver.loads.any()) file.write("load_work_J", {solver.load_work}, {1});
  if (solver.fluid) write_water<D>(*solver.fluid, file);
  if (solver.rocks) write_rocks<D>(solver, file);
  for (const auto& group : solver.groups) group.material->save(file, group.name);
  file.publish(true);
  remove_old_pools<D>(model, directory);
}

template <int D>
void read_checkpoint(Model<D>& model, Progress& progress, const std::string& folder) {
  const std::filesystem::path directory(folder);
  auto& solver = model.solver;
  const InputFile file((directory / "checkpoint.h5").string());
  const auto rows = file.read("points");
  std::size_t at = 0, width = 0;
  Point<D> any;
  each_field<D>(any, [&](const double*, int count) { width += std::size_t(count); });
  if (rows.size() != width * solver.points.size()) {
    of_another_scene(folder, "material points", rows.size() / width, solver.points.size());
  }
  expect_finite(rows, "points", width, folder);
  for (auto& point : solver.points) {
    each_field<D>(point, [&](double* values, int count) {
      for (int i = 0; i < count; ++i) values[i] = rows[at++];
    });
  }
  expect_masses<D>(solver.points, folder);
  const auto reactions = file.read("reactions");
  if (reactions.size() != (D + 1) * solver.count_driven()) {
    of_another_scene(folder, "boundaries and bodies", reactions.size() / (D + 1), solver.count_driven());
  }
  at = 0;
  solver.each_driven([&](auto& each) {
    for (int i = 0; i < D; ++i) each.reaction.impulse[i] = reactions[at++];
    each.reaction.work = reactions[at++];
  });
  expect_finite(reactions, "reactions", D + 1, folder);
  auto clock = file.read("clock");
  const std::size_t own = clock_of(progress).size();
  if (clock.size() != own + 2 + D) of_another_scene(folder, "times", clock.size(), own + 2 + D);
  std::copy_n(clock.begin() + long(own) + 2, D, solver.grid.cell.data());
  solver.time = clock[own];
  solver.nodal_energy = clock[own + 1];
  each_clock(progress, [&, k = std::size_t(0)](double& value) mutable { value = clock[k++]; });
  const auto counts = file.read_whole("counts");
  if (counts.size() != 7) of_another_scene(folder, "counts", counts.size(), 7);
  solver.steps = long(counts[0]);
  progress.history = {long(counts[1]), std::uint32_t(counts[2])};
  progress.watched = {long(counts[3]), std::uint32_t(counts[4])};
  progress.seen.warned_step = counts[5] != 0;
  progress.seen.warned_energy = counts[6] != 0;
  const auto box = file.read_whole("grid_box");
  if (box.size() != 2 * D) of_another_scene(folder, "ends of the grid", box.size(), 2 * D);
  if (!solver.points.empty()) {
    solver.grid.restore(box.data());
    solver.planes.rebuild(solver.grid, solver.time);
  }
  progress.impulses = file.read("impulses");
  progress.frame_times = file.read("frame_times");
  const auto watched = file.read_whole("watched");
  model.watched.assign(watched.begin(), watched.end());
  for (auto& [name, pool] : model.pools) {
    const auto path = directory / pool_name(name, solver.steps);
    if (!std::filesystem::exists(path)) {
      throw InputError(path.string() +
                       ": the RVEs of the checkpoint are missing; put the file back, or start the run anew");
    }
    pool->read(path.string());
  }
  if (file.read_whole("contact_at_surface") != contacts_of(solver)) {
    throw InputError(folder +
                     ": its bodies were met by another contact than in this scene; leave out the --set of a body's "
                     "contact, or start the run anew in another folder");
  }
  if (const std::size_t own = plates_of<D>(solver.bodies).size(); own > 0) {
    const auto plates = file.read("plates");
    if (plates.size() != own) of_another_scene(folder, "plates", plates.size(), own);
    each_plate<D>(solver.bodies, [&, k = std::size_t(0)](double& value) mutable { value = plates[k++]; });
  }
  if (solver.loads.any()) solver.load_work = file.read("load_work_J").at(0);
  if (solver.fluid) read_water<D>(*solver.fluid, file, folder);
  if (solver.rocks) read_rocks<D>(solver, file, folder);
  for (auto& group : solver.groups) group.material->restore(file, group.name);
}

template void write_checkpoint<2>(const Model<2>&, const Progress&, const std::string&);
template void write_checkpoint<3>(const Model<3>&, const Progress&, const std::string&);
template void read_checkpoint<2>(Model<2>&, Progress&, const std::string&);
template void read_checkpoint<3>(Model<3>&, Progress&, const std::string&);

}  // namespace mpm
