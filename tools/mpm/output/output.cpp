#include "tools/mpm/output/output.hpp"

#include <filesystem>
#include <span>
#include <sstream>

#include "rvelab/io/crc32c.hpp"
#include "tools/mpm/files/hdf5.hpp"
#include "tools/mpm/output/rocks.hpp"
#include "tools/mpm/rocks/rocks.hpp"

namespace mpm {
namespace {

std::string frame_name(long frame, const std::string& what = "points") {
  char name[32];
  std::snprintf(name, sizeof name, "_%04ld.h5", frame);
  return what + name;
}

/// Measures that not all soils have.
bool may_be_undefined(const std::string& column) {
  constexpr const char* names[] = {".void_ratio", ".fabric_anisotropy", ".pore_pressure_ratio"};
  return std::any_of(std::begin(names), std::end(names), [&](const char* name) { return column.ends_with(name); });
}

std::span<const std::byte> bytes_of(const std::string& text) { return std::as_bytes(std::span(text)); }

/// Of watched points in pore water.
constexpr const char* water_columns[] = {"pore_pressure_Pa", "excess_pore_pressure_Pa", "pore_pressure_ratio"};

constexpr const char* checksum_line = "# CRC-32C of the lines above: ";

std::string with_checksum(const std::string& text) {
  char sum[16];
  std::snprintf(sum, sizeof sum, "%08x\n", unsigned(rvelab::io::crc32c(bytes_of(text))));
  return text + checksum_line + sum;
}

}  // namespace

Rows::Rows(const std::string& path, const std::string& header, const WrittenRows& keep) : path_(path), written_(keep) {
  std::istringstream names(header);
  for (std::string name; std::getline(names, name, ',');) columns_.push_back(name);
  if (keep.bytes > 0) {
    const auto bytes = file_bytes(path);
    const auto size = std::size_t(keep.bytes);
    if (bytes.size() < size) {
      throw InputError(path + ": has " + std::to_string(bytes.size()) + " bytes, and " + std::to_string(size) +
                       " when the checkpoint was written; put the whole file back, or start the run anew");
    }
    if (rvelab::io::crc32c(std::span(bytes).first(size)) != keep.checksum) {
      throw InputError(
          path + ": is damaged (its first " + std::to_string(size) +
          " bytes are not those that it had when the checkpoint was written); put the file back from a copy, "
          "or start the run anew");
    }
    std::error_code error;
    std::filesystem::resize_file(path, size, error);
    if (error) throw InputError(path + ": cannot be written; give yourself the right to write to it");
  }
  file_ = std::fopen(path.c_str(), keep.bytes > 0 ? "a" : "w");
  if (file_ == nullptr) throw InputError(path + ": cannot be written; give a folder that you may write to");
  if (keep.bytes <= 0) put(header);
}

Rows::~Rows() { std::fclose(file_); }

void Rows::put(const std::string& line) {
  const std::string text = line + "\n";
  std::fputs(text.c_str(), file_);
  written_ = {written_.bytes + long(text.size()), rvelab::io::crc32c(bytes_of(text), written_.checksum)};
}

void Rows::add(const std::vector<double>& values) {
  std::string line;
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (k > 0) line += ',';
    if (std::isnan(values[k]) && may_be_undefined(columns_.at(k))) continue;
    if (!std::isfinite(values[k])) {
      throw std::runtime_error(
          path_ + ": at " + text_of(values[0]) + " s " + columns_.at(k) + " is " + text_of(values[k]) +
          ": the run is broken, and ends; take a smaller time.cfl, or a load " + "that the soil can carry");
    }
    char number[32];
    std::snprintf(number, sizeof number, "%.9g", values[k]);
    line += number;
  }
  put(line);
  if (std::fflush(file_) != 0) throw std::runtime_error(path_ + ": cannot be written; is the disc full?");
}

bool is_plate(const auto& driven) {
  if constexpr (requires { driven.plate; }) {
    return driven.plate.has_value();
  } else {
    return false;
  }
}

template <int D>
std::string history_header(const Solver<D>& solver) {
  std::string header =
      "time_s,steps,kinetic_J,potential_J,stress_work_J,pressure_work_J,boundary_work_J,mapping_loss_J,residual_J";
  for (int i = 0; i < D; ++i) header += std::string(",momentum_") + axis_names[i] + "_N_s";
  if (solver.loads.any()) header += ",load_work_J";
  if (solver.fluid) header += ",drag_loss_J,water_work_J,water_gravity_work_J,surface.outflow_m3";
  solver.each_driven([&](const auto& each) {
    for (int i = 0; i < D; ++i)
      header.append(",").append(each.name).append(".force_").append(axis_names[i]).append("_N");
    for (int i = 0; i < D; ++i)
      header.append(",").append(each.name).append(".displacement_").append(axis_names[i]).append("_m");
    if (is_plate(each)) header.append(",").append(each.name).append(".pressure_Pa");
  });
  if (solver.fluid) {
    for (const auto& plane : solver.planes.all) {
      header.append(",").append(plane.name).append(".water_force_N,").append(plane.name).append(".outflow_m3");
    }
  }
  return header + rock_columns<D>(solver);
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
std::vector<double> history_row(const Solver<D>& solver, const EnergyStart& start, double since,
                                std::vector<double>& before) {
  const auto b = energy_balance<D>(solver, start);
  std::vector<double> row{solver.time,     double(solver.steps), b.kinetic,      b.potential, b.stress_work,
                          b.pressure_work, b.boundary_work,      b.mapping_loss, b.residual};
  for (int i = 0; i < D; ++i) row.push_back(b.momentum[i]);
  if (solver.loads.any()) row.push_back(b.load_work);
  if (solver.fluid) {
    row.insert(row.end(), {b.drag_loss, b.water_work, b.water_gravity, solver.fluid->outflow.back()});
  }
  before.resize(std::max(before.size(), D * solver.count_driven()), 0.0);
  const auto further = further_impulses<D>(solver);
  std::size_t at = 0;
  solver.each_driven([&](const auto& each) {
    for (int i = 0; i < D; ++i, ++at) {
      const double impulse = each.reaction.impulse[i] + (further.empty() ? 0 : further[at]);
      // The soil's force on the boundary has the opposite sign.
      row.push_back(since > 0 ? -(impulse - before[at]) / since : 0);
      before[at] = impulse;
    }
    const Vec<D> displacement = each.displacement_at(solver.time);
    for (int i = 0; i < D; ++i) row.push_back(displacement[i]);
    if constexpr (requires { each.plate; }) {
      if (!each.plate) return;
      // Of soil and rocks, whose force on the plate is against its normal.
      double pressure = 0;
      for (int i = 0; i < D; ++i) pressure -= each.plate_normal()[i] * row[row.size() - std::size_t(2 * D - i)];
      row.push_back(pressure / each.plate->area);
    }
  });
  for (std::size_t k = 0; solver.fluid && k < solver.planes.all.size(); ++k) {
    row.insert(row.end(), {solver.fluid->force_on(solver.planes, int(k)), solver.fluid->outflow[k]});
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
std::string watched_header(const Model<D>& model) {
  std::string header = "time_s";
  for (std::size_t k = 0; k < model.watched.size(); ++k) {
    const auto name = "," + std::to_string(k) + ".";
    for (int i = 0; i < D; ++i) header += name + axis_names[i] + "_m";
    for (const char* each : {"p_Pa", "q_Pa", "eps_q", "eps_v", "rotation_deg", "void_ratio", "fabric_anisotropy"}) {
      header += name + each;
    }
    if (!model.solver.fluid) continue;
    for (const char* each : water_columns) header += name + each;
  }
  return header;
}

template <int D>
std::vector<double> watched_row(const Model<D>& model) {
  std::vector<double> row{model.solver.time};
  for (const long k : model.watched) {
    const auto& point = model.solver.points[k];
    const auto measures = measures_of<D>(model.solver, k);
    for (int i = 0; i < D; ++i) row.push_back(point.position[i]);
    row.insert(row.end(),
               {mean_pressure<D>(point.stress), deviatoric_stress<D>(point.stress), deviatoric_strain<D>(point.strain),
                -point.strain.trace(), rotation_degrees<D>(point.F), measures.void_ratio, measures.fabric_anisotropy});
    if (!model.solver.fluid) continue;
    const auto& water = model.solver.fluid->points[k];
    row.insert(row.end(), {water.pressure, water.pressure - water.first_pressure, water.pressure_ratio()});
  }
  return row;
}

template <int D>
void write_frame(const Model<D>& model, const std::string& folder, long frame) {
  const auto& points = model.solver.points;
  const std::size_t n = points.size();
  OutputFile file((std::filesystem::path(folder) / frame_name(frame)).string());
  // Three components in the plane too: ParaView knows no other vectors.
  const auto vectors = [&](const char* name, const auto& of) {
    std::vector<double> values(3 * n, 0.0);
    for (std::size_t k = 0; k < n; ++k) {
      const Vec<D> v = of(points[k]);
      for (int i = 0; i < D; ++i) values[3 * k + i] = v[i];
    }
    file.write(name, values, {n, 3});
  };
  const auto tensors = [&](const char* name, const auto& of) {
    std::vector<double> values(9 * n, 0.0);
    for (std::size_t k = 0; k < n; ++k) {
      const Mat<D> t = of(points[k]);
      for (int i = 0; i < D; ++i) {
        for (int j = 0; j < D; ++j) values[9 * k + 3 * i + j] = t(i, j);
      }
      if (D == 2 && std::string(name) == "stress_Pa") values[9 * k + 8] = points[k].stress_zz;
    }
    file.write(name, values, {n, 9});
  };
  const auto scalars = [&](const char* name, const auto& of) {
    std::vector<double> values(n);
    for (std::size_t k = 0; k < n; ++k) values[k] = of(points[k], long(k));
    file.write(name, values, {n});
  };
  using P = Point<D>;
  file.write("time_s", std::vector<double>{model.solver.time}, {1});
  file.write("grid_cell_m", {model.solver.grid.cell.data(), model.solver.grid.cell.data() + D}, {D});
  vectors("position_m", [](const P& p) { return p.position; });
  vectors("displacement_m", [](const P& p) { return Vec<D>(p.position - p.first); });
  vectors("velocity_m_s", [](const P& p) { return p.velocity; });
  tensors("stress_Pa", [](const P& p) { return p.stress; });
  tensors("deformation_gradient", [](const P& p) { return p.F; });
  scalars("volume_m3", [](const P& p, long) { return p.volume; });
  scalars("p_Pa", [](const P& p, long) { return mean_pressure<D>(p.stress); });
  scalars("q_Pa", [](const P& p, long) { return deviatoric_stress<D>(p.stress); });
  scalars("eps_q", [](const P& p, long) { return deviatoric_strain<D>(p.strain); });
  scalars("eps_v", [](const P& p, long) { return -p.strain.trace(); });
  scalars("rotation_deg", [](const P& p, long) { return rotation_degrees<D>(p.F); });
  std::vector<Measures> all;
  for (std::size_t k = 0; k < n; ++k) all.push_back(measures_of<D>(model.solver, long(k)));
  scalars("void_ratio", [&](const P&, long k) { return all[k].void_ratio; });
  scalars("fabric_anisotropy", [&](const P&, long k) { return all[k].fabric_anisotropy; });
  scalars("coordination_number", [&](const P&, long k) { return all[k].coordination_number; });
  scalars("plastic_strain", [&](const P&, long k) { return all[k].plastic_strain; });
  if (model.solver.fluid) {
    const auto& water = *model.solver.fluid;
    const auto seepage = [&](const P& p) {
      const auto& here = water.points[std::size_t(&p - points.data())];
      return here.solids > 0 ? Vec<D>(here.porosity(p.volume) * (here.velocity - p.velocity)) : Vec<D>(Vec<D>::Zero());
    };
    vectors("seepage_m_s", seepage);
    scalars("pore_pressure_Pa", [&](const P&, long k) { return water.points[k].pressure; });
    scalars("excess_pore_pressure_Pa",
            [&](const P&, long k) { return water.points[k].pressure - water.points[k].first_pressure; });
    scalars("pore_pressure_ratio", [&](const P&, long k) { return water.points[k].pressure_ratio(); });
    scalars("liquefied_at_s", [&](const P&, long k) { return water.points[k].liquefied; });
    scalars("porosity",
            [&](const P& p, long k) { return water.points[k].solids > 0 ? water.points[k].porosity(p.volume) : NAN; });
  }
  if (model.solver.rocks) {
    write_rock_frame<D>(model.solver, (std::filesystem::path(folder) / frame_name(frame, "rocks")).string());
  }
  file.publish();
}

template <int D>
void write_networks(const Model<D>& model, const std::string& folder, long frame) {
  for (std::size_t k = 0; k < model.watched.size(); ++k) {
    const auto& group = model.solver.group_of(model.watched[k]);
    const auto name = frame_name(frame, "network_" + std::to_string(k));
    model.grains.at(group.name)
        ->write_network(model.watched[k] - group.first, (std::filesystem::path(folder) / name).string());
  }
}

void write_scene(const std::string& folder, const std::string& toml) {
  const std::string text = with_checksum(toml + "\n");
  publish_file((std::filesystem::path(folder) / "scene.toml").string(), text.data(), text.size());
}

void expect_whole_scene(const std::string& folder) {
  const auto path = (std::filesystem::path(folder) / "scene.toml").string();
  const auto bytes = file_bytes(path);
  const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const auto last = text.rfind(checksum_line);
  if (last != std::string::npos && text == with_checksum(text.substr(0, last))) return;
  throw InputError(
      path +
      ": is damaged, or was changed by hand (its last line holds another checksum); put the file back from a "
      "copy, change a scene by --resume with --set, or start the run anew");
}

void write_xdmf(const std::string& folder, const std::vector<double>& times, long points, bool saturated) {
  std::ostringstream file;
  file << "<?xml version=\"1.0\"?>\n<Xdmf Version=\"3.0\"><Domain>\n"
          "<Grid Name=\"points\" GridType=\"Collection\" CollectionType=\"Temporal\">\n";
  for (std::size_t k = 0; k < times.size(); ++k) {
    const auto item = [&](const char* name, const std::string& extents) {
      file << "<DataItem Format=\"HDF\" NumberType=\"Float\" Precision=\"8\" Dimensions=\"" << extents << "\">"
           << frame_name(long(k)) << ":/" << name << "</DataItem>";
    };
    const auto n = std::to_string(points);
    file << "<Grid Name=\"points\"><Time Value=\"" << times[k] << "\"/>\n<Topology TopologyType=\"Polyvertex\" "
         << "NumberOfElements=\"" << n << "\"/>\n<Geometry GeometryType=\"XYZ\">";
    item("position_m", n + " 3");
    file << "</Geometry>\n";
    const auto attribute = [&](const char* name, const char* type, const std::string& extents) {
      file << "<Attribute Name=\"" << name << "\" AttributeType=\"" << type << "\" Center=\"Node\">";
      item(name, extents);
      file << "</Attribute>\n";
    };
    for (const char* name : {"displacement_m", "velocity_m_s"}) attribute(name, "Vector", n + " 3");
    for (const char* name : {"stress_Pa", "deformation_gradient"}) attribute(name, "Tensor", n + " 9");
    for (const char* name : {"volume_m3", "p_Pa", "q_Pa", "eps_q", "eps_v", "rotation_deg", "void_ratio",
                             "fabric_anisotropy", "coordination_number", "plastic_strain"}) {
      attribute(name, "Scalar", n);
    }
    if (saturated) {
      attribute("seepage_m_s", "Vector", n + " 3");
      for (const char* name :
           {"pore_pressure_Pa", "excess_pore_pressure_Pa", "pore_pressure_ratio", "liquefied_at_s", "porosity"}) {
        attribute(name, "Scalar", n);
      }
    }
    file << "</Grid>\n";
  }
  file << "</Grid>\n</Domain></Xdmf>\n";
  const std::string text = file.str();
  publish_file((std::filesystem::path(folder) / "points.xdmf").string(), text.data(), text.size());
}

#define MPM_INSTANTIATE(D)                                                                                         \
  template std::string history_header<D>(const Solver<D>&);                                                        \
  template std::vector<double> history_row<D>(const Solver<D>&, const EnergyStart&, double, std::vector<double>&); \
  template std::string watched_header<D>(const Model<D>&);                                                         \
  template std::vector<double> watched_row<D>(const Model<D>&);                                                    \
  template void write_frame<D>(const Model<D>&, const std::string&, long);                                         \
  template void write_networks<D>(const Model<D>&, const std::string&, long);
MPM_INSTANTIATE(2)
MPM_INSTANTIATE(3)
#undef MPM_INSTANTIATE

}  // namespace mpm
