#include "tools/mpm/output/rocks.hpp"

#include <cstdio>
#include <filesystem>
#include <sstream>

#include "tools/mpm/rocks/rocks.hpp"

namespace mpm {
namespace {

constexpr const char* energies[] = {"kinetic_J",   "potential_J", "springs_J", "contact_loss_J",
                                    "soil_work_J", "wall_work_J", "residual_J"};

/// J: sum of force times branch of all contacts among rocks and with walls, and of stress times volume of the soil: the
/// parts of the mean pressure that each carries.
template <int D>
double rock_virial(const Rocks<D>& rocks) {
  double sum = 0;
  for (const auto& pair : rocks.pairs) {
    if (!(pair.contact.overlap > 0)) continue;
    const auto& a = rocks.all[std::size_t(pair.first)];
    const bool with_rock = pair.second < int(rocks.all.size());
    const double branch = with_rock ? (rocks.all[std::size_t(pair.second)].body.centre - a.body.centre).norm()
                                    : rocks.shapes[std::size_t(a.shape)].equivalent_radius();
    sum += pair.constants.normal_force(pair.contact.overlap) * branch;
  }
  return sum;
}

template <int D>
double soil_virial(const Solver<D>& solver) {
  double sum = 0;
  for (const auto& point : solver.points) sum -= point.volume * point.stress.trace();
  return sum;
}

Eigen::Quaterniond in_space(double angle) { return Eigen::Quaterniond(Eigen::AngleAxisd(angle, Vec<3>::UnitZ())); }
Eigen::Quaterniond in_space(const Eigen::Quaterniond& orientation) { return orientation; }

std::string frame_name(std::size_t frame) {
  char name[32];
  std::snprintf(name, sizeof name, "rocks_%04zu.h5", frame);
  return name;
}

}  // namespace

template <int D>
std::string rock_columns(const Solver<D>& solver) {
  std::string columns;
  if (!solver.rocks) return columns;
  for (const char* name : energies) columns.append(",rocks.").append(name);
  columns +=
      ",rocks.work_on_soil_J,rocks.surface_loss_J,rocks.ghost_loss_J,rocks.ghost_mapping_J,rocks.ghost_springs_J,rocks."
      "contacts,rocks.soil_"
      "contacts,rocks.sub_steps,rocks.virial_J,soil.virial_J";
  for (const auto& rock : solver.rocks->all) {
    if (!rock.single) continue;
    const auto vector = [&](const char* what, const char* unit) {
      for (int i = 0; i < D; ++i) columns.append(",").append(rock.name).append(what).append(axis_names[i]).append(unit);
    };
    vector(".", "_m");
    vector(".velocity_", "_m_s");
    for (int i = D == 2 ? 2 : 0; i < 3; ++i)
      columns.append(",").append(rock.name).append(".spin_").append(axis_names[i]).append("_rad_s");
    vector(".soil_force_", "_N");
  }
  return columns;
}

template <int D>
void add_rock_values(const Solver<D>& solver, double since, std::vector<double>& before, std::vector<double>& row) {
  if (!solver.rocks) return;
  const auto& rocks = *solver.rocks;
  const auto e = rocks.energy(solver.options.gravity);
  row.insert(row.end(), {e.kinetic, e.potential, e.springs, e.contact_loss, e.soil_work, e.wall_work, e.residual,
                         rocks.work_on_soil, rocks.surface_loss, rocks.ghost_loss, rocks.ghost_mapping,
                         rocks.ghost_springs(), double(rocks.touching), double(rocks.soil_contacts),
                         double(rocks.sub_steps), rock_virial<D>(rocks), soil_virial<D>(solver)});
  const std::size_t first = D * solver.count_driven();
  std::size_t at = first;
  for (const auto& rock : rocks.all) {
    if (!rock.single) continue;
    before.resize(std::max(before.size(), at + D), 0.0);
    for (const double x : rock.body.centre) row.push_back(x);
    for (const double x : rock.body.velocity) row.push_back(x);
    for (const double x : rock.body.spin()) row.push_back(x);
    for (int i = 0; i < D; ++i, ++at) {
      row.push_back(since > 0 ? (rock.soil_impulse[i] - before[at]) / since : 0);
      before[at] = rock.soil_impulse[i];
    }
  }
}

template <int D>
void write_rock_frame(const Solver<D>& solver, const std::string& path) {
  const auto& rocks = *solver.rocks;
  const std::size_t n = rocks.all.size();
  OutputFile file(path);
  const auto table = [&](const char* name, std::size_t width, const auto& of) {
    std::vector<double> values;
    for (const auto& rock : rocks.all) of(rock, values);
    file.write(name, values, width == 1 ? Extents{n} : Extents{n, width});
  };
  const auto vector = [&](const char* name, const auto& of) {
    table(name, 3, [&](const Rock<D>& rock, std::vector<double>& values) {
      const Vec<D> v = of(rock);
      for (int i = 0; i < 3; ++i) values.push_back(i < D ? v[std::min(i, D - 1)] : 0);
    });
  };
  using R = Rock<D>;
  file.write("time_s", std::vector<double>{solver.time}, {1});
  vector("position_m", [](const R& rock) { return rock.body.centre; });
  vector("velocity_m_s", [](const R& rock) { return rock.body.velocity; });
  vector("soil_force_N", [](const R& rock) { return rock.soil_force; });
  vector("contact_force_N", [](const R& rock) { return rock.mean_force; });
  table("spin_rad_s", 3, [](const R& rock, std::vector<double>& values) {
    const auto spin = rock.body.spin();
    for (int i = 0; i < 3; ++i)
      values.push_back(D == 3 ? spin[std::min<long>(i, spin.size() - 1)] : i == 2 ? spin[0] : 0);
  });
  table("orientation", 4, [](const R& rock, std::vector<double>& values) {
    const auto q = in_space(rock.body.orientation);
    values.insert(values.end(), {q.w(), q.x(), q.y(), q.z()});
  });
  // Columns: the turned half axes, as tensor glyphs want them.
  table("turned_half_axes_m", 9, [&](const R& rock, std::vector<double>& values) {
    const auto& shape = rocks.shapes[std::size_t(rock.shape)];
    Mat<3> axes = in_space(rock.body.orientation).toRotationMatrix();
    for (int i = 0; i < 3; ++i) {
      axes.col(i) *= i < D ? shape.height(Vec<D>::Unit(std::min(i, D - 1))) : shape.equivalent_radius();
    }
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) values.push_back(axes(i, j));
    }
  });
  table("radius_m", 1, [&](const R& rock, std::vector<double>& values) {
    values.push_back(rocks.shapes[std::size_t(rock.shape)].equivalent_radius());
  });
  table("mass_kg", 1, [](const R& rock, std::vector<double>& values) { values.push_back(rock.body.mass); });
  std::vector<std::string> groups;
  table("group", 1, [&](const R& rock, std::vector<double>& values) {
    if (groups.empty() || groups.back() != rock.name) groups.push_back(rock.name);
    values.push_back(double(groups.size() - 1));
  });
  file.publish();
}

void write_rock_xdmf(const std::string& folder, const std::vector<double>& times, std::size_t rocks) {
  std::ostringstream file;
  file << "<?xml version=\"1.0\"?>\n<Xdmf Version=\"3.0\"><Domain>\n"
          "<Grid Name=\"rocks\" GridType=\"Collection\" CollectionType=\"Temporal\">\n";
  for (std::size_t k = 0; k < times.size(); ++k) {
    const auto item = [&](const std::string& name, const std::string& extents) {
      return "<DataItem Format=\"HDF\" NumberType=\"Float\" Precision=\"8\" Dimensions=\"" + extents + "\">" +
             frame_name(k) + ":/" + name + "</DataItem>";
    };
    const auto n = std::to_string(rocks);
    file << "<Grid Name=\"rocks\"><Time Value=\"" << times[k] << "\"/>\n<Topology TopologyType=\"Polyvertex\" "
         << "NumberOfElements=\"" << n << "\"/>\n<Geometry GeometryType=\"XYZ\">" << item("position_m", n + " 3")
         << "</Geometry>\n";
    const struct {
      const char *name, *type, *width;
    } fields[] = {{"velocity_m_s", "Vector", " 3"},
                  {"spin_rad_s", "Vector", " 3"},
                  {"soil_force_N", "Vector", " 3"},
                  {"contact_force_N", "Vector", " 3"},
                  {"turned_half_axes_m", "Tensor", " 9"},
                  {"radius_m", "Scalar", ""},
                  {"mass_kg", "Scalar", ""},
                  {"group", "Scalar", ""}};
    for (const auto& field : fields) {
      file << "<Attribute Name=\"" << field.name << "\" AttributeType=\"" << field.type << "\" Center=\"Node\">"
           << item(field.name, n + field.width) << "</Attribute>\n";
    }
    file << "</Grid>\n";
  }
  file << "</Grid>\n</Domain></Xdmf>\n";
  const std::string text = file.str();
  publish_file((std::filesystem::path(folder) / "rocks.xdmf").string(), text.data(), text.size());
}

#define MPM_INSTANTIATE(D)                                                                                \
  template std::string rock_columns<D>(const Solver<D>&);                                                 \
  template void add_rock_values<D>(const Solver<D>&, double, std::vector<double>&, std::vector<double>&); \
  template void write_rock_frame<D>(const Solver<D>&, const std::string&);
MPM_INSTANTIATE(2)
MPM_INSTANTIATE(3)
#undef MPM_INSTANTIATE

}  // namespace mpm
