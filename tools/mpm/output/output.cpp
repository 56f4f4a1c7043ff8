#include "tools/mpm/output/output.hpp"

#include <filesystem>
#include <span>

#include "rvelab/io/crc32c.hpp"
#include "rvelab/io/publish.hpp"
#include "rvelab/keys/regular_file.hpp"
#include "tools/mpm/output/frames.hpp"
#include "tools/mpm/output/rocks.hpp"
#include "tools/mpm/rocks/rocks.hpp"

namespace mpm {
namespace {

/// Measures that not all soils have.
bool may_be_undefined(const std::string& column) {
  constexpr const char* names[] = {".void_ratio", ".fabric_anisotropy", ".pore_pressure_ratio"};
  return std::any_of(std::begin(names), std::end(names), [&](const char* name) { return column.ends_with(name); });
}

std::span<const std::byte> bytes_of(const std::string& text) { return std::as_bytes(std::span(text)); }

constexpr const char* checksum_line = "# CRC-32C of the lines above: ";

std::string with_checksum(const std::string& text) {
  char sum[16];
  std::snprintf(sum, sizeof sum, "%08x\n", unsigned(rvelab::io::crc32c(bytes_of(text))));
  return text + checksum_line + sum;
}

}  // namespace

void add_vector(Row& row, const std::string& name, const std::string& unit, std::span<const double> values) {
  const std::size_t first = values.size() == 1 ? 2 : 0;  // a spin in the plane
  for (std::size_t i = 0; i < values.size(); ++i) row.emplace_back(name + axis_names[first + i] + unit, values[i]);
}

Rows::Rows(const std::string& path, const WrittenRows& keep) : path_(path), written_(keep) {
  if (keep.bytes > 0) {
    const auto bytes = rvelab::keys::whole_file<std::vector<std::byte>>(path, "a file of this run");
    const auto size = std::size_t(keep.bytes);
    if (bytes.size() < size) {
      throw InputError(path + ": has " + std::to_string(bytes.size()) + " bytes, and " + std::to_string(size) +
                       " when the checkpoint was written; put the whole file back, or start the run again");
    }
    if (rvelab::io::crc32c(std::span(bytes).first(size)) != keep.checksum) {
      throw InputError(
          path + ": is damaged (its first " + std::to_string(size) +
          " bytes are not those that it had when the checkpoint was written); put the file back from a copy, "
          "or start the run again");
    }
    std::error_code error;
    std::filesystem::resize_file(path, size, error);
    if (error) throw InputError(path + ": cannot be written; give yourself the right to write to it");
  }
  file_ = std::fopen(path.c_str(), keep.bytes > 0 ? "a" : "w");
  if (file_ == nullptr) throw InputError(path + ": cannot be written; give a folder that you may write to");
}

Rows::~Rows() { std::fclose(file_); }

void Rows::put(const std::string& line) {
  const std::string text = line + "\n";
  std::fputs(text.c_str(), file_);
  written_ = {written_.bytes + long(text.size()), rvelab::io::crc32c(bytes_of(text), written_.checksum)};
}

void Rows::add(const Row& row) {
  std::string names, line;
  for (const auto& [name, value] : row) {
    names += (names.empty() ? "" : ",") + name;
    if (!line.empty()) line += ',';
    if (std::isnan(value) && may_be_undefined(name)) continue;
    if (!std::isfinite(value)) {
      throw std::runtime_error(path_ + ": at " + in_words(row.front().second) + " s " + name + " is " +
                               in_words(value) + ": the run is broken, and ends; take a smaller time.cfl, or a load " +
                               "that the soil can carry");
    }
    char number[32];
    std::snprintf(number, sizeof number, "%.9g", value);
    line += number;
  }
  if (written_.bytes == 0) put(names);
  put(line);
  if (std::fflush(file_) != 0) throw std::runtime_error(path_ + ": cannot be written; is the disc full?");
}

/// N s, of planes and bodies on the water, or on rocks; empty without.
template <int D>
std::vector<double> further_impulses(const Solver<D>& solver) {
  std::vector<double> impulses;
  if (solver.rocks) {
    for (const auto& impulse : solver.rocks->wall_impulse) {
      for (const double x : impulse) impulses.push_back(-x);
    }
    impulses.resize(D * solver.count_driven(), 0.0);
  }
  const auto add = [&](const auto& all) {
    for (const auto& each : all) {
      impulses.insert(impulses.end(), each.reaction.impulse.data(), each.reaction.impulse.data() + D);
    }
  };
  if (solver.fluid) {
    add(solver.fluid->planes.all);
    add(solver.fluid->bodies.all);
  }
  return impulses;
}

template <int D>
Row history_row(const Solver<D>& solver, const EnergyStart& start, double since, std::vector<double>& before) {
  const auto b = energy_balance<D>(solver, start);
  const auto* water = solver.fluid.get();
  Row row{{"time_s", solver.time},
          {"steps", double(solver.steps)},
          {"kinetic_J", b.kinetic},
          {"potential_J", b.potential},
          {"stress_work_J", b.stress_work},
          {"pressure_work_J", b.pressure_work},
          {"boundary_work_J", b.boundary_work},
          {"mapping_loss_J", b.mapping_loss},
          {"residual_J", b.residual}};
  add_vector(row, "momentum_", "_N_s", {b.momentum.data(), D});
  if (solver.loads.any()) row.emplace_back("load_work_J", b.load_work);
  if (water != nullptr) {
    row.insert(row.end(), {{"drag_loss_J", b.drag_loss},
                           {"water_work_J", b.water_work},
                           {"water_gravity_work_J", b.water_gravity},
                           {"surface.outflow_m3", water->outflow.back()}});
  }
  before.resize(std::max(before.size(), D * solver.count_driven()), 0.0);
  const auto further = further_impulses<D>(solver);
  std::size_t at = 0;
  solver.each_driven([&](const auto& each) {
    Vec<D> force;
    for (int i = 0; i < D; ++i, ++at) {
      const double impulse = each.reaction.impulse[i] + (further.empty() ? 0 : further[at]);
      // The soil's force on the boundary has the opposite sign.
      force[i] = since > 0 ? -(impulse - before[at]) / since : 0;
      before[at] = impulse;
    }
    add_vector(row, each.name + ".force_", "_N", {force.data(), D});
    const Vec<D> displacement = each.displacement_at(solver.time);
    add_vector(row, each.name + ".displacement_", "_m", {displacement.data(), D});
    if constexpr (requires { each.plate; }) {
      if (!each.plate) return;
      // Of soil and rocks, whose force on the plate is against its normal.
      double pressure = 0;
      for (int i = 0; i < D; ++i) pressure -= each.plate_normal()[i] * force[i];
      row.emplace_back(each.name + ".pressure_Pa", pressure / each.plate->area);
    }
  });
  for (std::size_t k = 0; water != nullptr && k < solver.planes.all.size(); ++k) {
    const auto& name = solver.planes.all[k].name;
    row.emplace_back(name + ".water_force_N", water->force_on(solver.planes, int(k)));
    row.emplace_back(name + ".outflow_m3", water->outflow[k]);
  }
  add_rock_values<D>(solver, since, before, row);
  return row;
}

template <int D>
Measures measures_of(const Solver<D>& solver, long point) {
  const auto& group = solver.group_of(point);
  return group.material->measures(point - group.first);
}

template <int D>
Row watched_row(const Model<D>& model) {
  Row row{{"time_s", model.solver.time}};
  for (std::size_t n = 0; n < model.watched.size(); ++n) {
    const long k = model.watched[n];
    const auto name = std::to_string(n) + ".";
    const auto& point = model.solver.points[k];
    const auto measures = measures_of<D>(model.solver, k);
    add_vector(row, name, "_m", {point.position.data(), D});
    row.insert(row.end(), {{name + "p_Pa", mean_pressure<D>(point.stress)},
                           {name + "q_Pa", deviatoric_stress<D>(point.stress)},
                           {name + "eps_q", deviatoric_strain<D>(point.strain)},
                           {name + "eps_v", -point.strain.trace()},
                           {name + "rotation_deg", rotation_degrees<D>(point.F)},
                           {name + "void_ratio", measures.void_ratio},
                           {name + "fabric_anisotropy", measures.fabric_anisotropy}});
    if (!model.solver.fluid) continue;
    const auto& water = model.solver.fluid->points[k];
    row.insert(row.end(), {{name + "pore_pressure_Pa", water.pressure},
                           {name + "excess_pore_pressure_Pa", water.pressure - water.first_pressure},
                           {name + "pore_pressure_ratio", water.pressure_ratio()}});
  }
  return row;
}

template <int D>
void write_frame(const Model<D>& model, const std::string& folder, const std::vector<double>& times) {
  const auto& points = model.solver.points;
  const auto& cell = model.solver.grid.cell;
  Frame frame("points", points.size(), folder, times);
  frame.add("grid_cell_m", {cell.data(), D}, {D});
  const auto scalars = [&](const char* name, const auto& of) {
    frame.show(name, "Scalar", [&](std::size_t k) { return std::array{double(of(points[k], long(k)))}; });
  };
  const auto vectors = [&](const char* name, const auto& of) {
    frame.show(name, "Vector", [&](std::size_t k) { return three<D>(of(points[k])); });
  };
  const auto tensors = [&](const char* name, const auto& of, const auto& zz) {
    frame.show(name, "Tensor", [&](std::size_t k) {
      std::array<double, 9> all{};
      const Mat<D> t = of(points[k]);
      for (int i = 0; i < D; ++i) {
        for (int j = 0; j < D; ++j) all[std::size_t(3 * i + j)] = t(i, j);
      }
      if (D == 2) all[8] = zz(points[k]);
      return all;
    });
  };
  using P = Point<D>;
  vectors("position_m", [](const P& p) { return p.position; });
  vectors("displacement_m", [](const P& p) { return Vec<D>(p.position - p.first); });
  vectors("velocity_m_s", [](const P& p) { return p.velocity; });
  tensors(
      "stress_Pa", [](const P& p) { return p.stress; }, [](const P& p) { return p.stress_zz; });
  tensors(
      "deformation_gradient", [](const P& p) { return p.F; }, [](const P&) { return 0.0; });
  scalars("volume_m3", [](const P& p, long) { return p.volume; });
  scalars("p_Pa", [](const P& p, long) { return mean_pressure<D>(p.stress); });
  scalars("q_Pa", [](const P& p, long) { return deviatoric_stress<D>(p.stress); });
  scalars("eps_q", [](const P& p, long) { return deviatoric_strain<D>(p.strain); });
  scalars("eps_v", [](const P& p, long) { return -p.strain.trace(); });
  scalars("rotation_deg", [](const P& p, long) { return rotation_degrees<D>(p.F); });
  std::vector<Measures> all;
  for (std::size_t k = 0; k < points.size(); ++k) all.push_back(measures_of<D>(model.solver, long(k)));
  scalars("void_ratio", [&](const P&, long k) { return all[k].void_ratio; });
  scalars("fabric_anisotropy", [&](const P&, long k) { return all[k].fabric_anisotropy; });
  scalars("coordination_number", [&](const P&, long k) { return all[k].coordination_number; });
  scalars("plastic_strain", [&](const P&, long k) { return all[k].plastic_strain; });
  if (model.solver.fluid) {
    const auto& water = *model.solver.fluid;
    vectors("seepage_m_s", [&](const P& p) {
      const auto& here = water.points[std::size_t(&p - points.data())];
      return here.solids > 0 ? Vec<D>(here.porosity(p.volume) * (here.velocity - p.velocity)) : Vec<D>(Vec<D>::Zero());
    });
    scalars("pore_pressure_Pa", [&](const P&, long k) { return water.points[k].pressure; });
    scalars("excess_pore_pressure_Pa",
            [&](const P&, long k) { return water.points[k].pressure - water.points[k].first_pressure; });
    scalars("pore_pressure_ratio", [&](const P&, long k) { return water.points[k].pressure_ratio(); });
    scalars("liquefied_at_s", [&](const P&, long k) { return water.points[k].liquefied; });
    scalars("porosity",
            [&](const P& p, long k) { return water.points[k].solids > 0 ? water.points[k].porosity(p.volume) : NAN; });
  }
  frame.publish();
}

template <int D>
void write_networks(const Model<D>& model, const std::string& folder, long frame) {
  for (std::size_t k = 0; k < model.watched.size(); ++k) {
    const auto& group = model.solver.group_of(model.watched[k]);
    const auto name = frame_name("network_" + std::to_string(k), std::size_t(frame));
    model.grains.at(group.name)
        ->write_network(model.watched[k] - group.first, (std::filesystem::path(folder) / name).string());
  }
}

void write_scene(const std::string& folder, const std::string& toml) {
  const std::string text = with_checksum(toml + "\n");
  rvelab::io::publish_text((std::filesystem::path(folder) / "scene.toml").string(), text);
}

void expect_whole_scene(const std::string& folder) {
  const auto path = (std::filesystem::path(folder) / "scene.toml").string();
  const auto text = rvelab::keys::whole_file<std::string>(path, "a scene of a run");
  const auto last = text.rfind(checksum_line);
  if (last != std::string::npos && text == with_checksum(text.substr(0, last))) return;
  throw InputError(
      path +
      ": is damaged, or was changed by hand (its last line holds another checksum); put the file back from a "
      "copy, change a scene by --resume with --set, or start the run again");
}

#define MPM_INSTANTIATE(D)                                                                         \
  template Row history_row<D>(const Solver<D>&, const EnergyStart&, double, std::vector<double>&); \
  template Row watched_row<D>(const Model<D>&);                                                    \
  template void write_frame<D>(const Model<D>&, const std::string&, const std::vector<double>&);   \
  template void write_networks<D>(const Model<D>&, const std::string&, long);
MPM_INSTANTIATE(2)
MPM_INSTANTIATE(3)
#undef MPM_INSTANTIATE

}  // namespace mpm
