#include "tools/mpm/output/rocks.hpp"

#include "tools/mpm/output/frames.hpp"
#include "tools/mpm/rocks/rocks.hpp"

namespace mpm {
namespace {

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

}  // namespace

template <int D>
void add_rock_values(const Solver<D>& solver, double since, std::vector<double>& before, Row& row) {
  if (!solver.rocks) return;
  const auto& rocks = *solver.rocks;
  const auto e = rocks.energy(solver.options.gravity);
  row.insert(row.end(), {{"rocks.kinetic_J", e.kinetic},
                         {"rocks.potential_J", e.potential},
                         {"rocks.springs_J", e.springs},
                         {"rocks.contact_loss_J", e.contact_loss},
                         {"rocks.soil_work_J", e.soil_work},
                         {"rocks.wall_work_J", e.wall_work},
                         {"rocks.residual_J", e.residual},
                         {"rocks.work_on_soil_J", rocks.work_on_soil},
                         {"rocks.surface_loss_J", rocks.surface_loss},
                         {"rocks.ghost_loss_J", rocks.ghost_loss},
                         {"rocks.ghost_mapping_J", rocks.ghost_mapping},
                         {"rocks.ghost_springs_J", rocks.ghost_springs()},
                         {"rocks.contacts", double(rocks.touching)},
                         {"rocks.soil_contacts", double(rocks.soil_contacts)},
                         {"rocks.sub_steps", double(rocks.sub_steps)},
                         {"rocks.virial_J", rock_virial<D>(rocks)},
                         {"soil.virial_J", soil_virial<D>(solver)}});
  std::size_t at = D * solver.count_driven();
  for (const auto& rock : rocks.all) {
    if (!rock.single) continue;
    before.resize(std::max(before.size(), at + D), 0.0);
    const auto spin = rock.body.spin();
    Vec<D> force;
    for (int i = 0; i < D; ++i, ++at) {
      force[i] = since > 0 ? (rock.soil_impulse[i] - before[at]) / since : 0;
      before[at] = rock.soil_impulse[i];
    }
    add_vector(row, rock.name + ".", "_m", {rock.body.centre.data(), D});
    add_vector(row, rock.name + ".velocity_", "_m_s", {rock.body.velocity.data(), D});
    add_vector(row, rock.name + ".spin_", "_rad_s", {spin.data(), std::size_t(spin.size())});
    add_vector(row, rock.name + ".soil_force_", "_N", {force.data(), D});
  }
}

template <int D>
void write_rock_frame(const Solver<D>& solver, const std::string& folder, const std::vector<double>& times) {
  const auto& rocks = *solver.rocks;
  Frame frame("rocks", rocks.all.size(), folder, times);
  using R = Rock<D>;
  const auto vectors = [&](const char* name, const auto& of) {
    frame.show(name, "Vector", [&](std::size_t k) { return three<D>(of(rocks.all[k])); });
  };
  const auto scalars = [&](const char* name, const auto& of) {
    frame.show(name, "Scalar", [&](std::size_t k) { return std::array{double(of(rocks.all[k]))}; });
  };
  std::vector<double> orientations;
  for (const auto& rock : rocks.all) {
    const auto q = in_space(rock.body.orientation);
    orientations.insert(orientations.end(), {q.w(), q.x(), q.y(), q.z()});
  }
  frame.add("orientation", orientations, {rocks.all.size(), 4});
  vectors("position_m", [](const R& rock) { return rock.body.centre; });
  vectors("velocity_m_s", [](const R& rock) { return rock.body.velocity; });
  frame.show("spin_rad_s", "Vector", [&](std::size_t k) {
    const auto spin = rocks.all[k].body.spin();
    return D == 2 ? std::array{0.0, 0.0, spin[0]} : three<3>(Eigen::Map<const Vec<3>>(spin.data()));
  });
  vectors("soil_force_N", [](const R& rock) { return rock.soil_force; });
  vectors("contact_force_N", [](const R& rock) { return rock.mean_force; });
  // Columns: the turned half axes, as tensor glyphs want them.
  frame.show("turned_half_axes_m", "Tensor", [&](std::size_t k) {
    const auto& shape = rocks.shapes[std::size_t(rocks.all[k].shape)];
    const Mat<3> axes = in_space(rocks.all[k].body.orientation).toRotationMatrix();
    std::array<double, 9> all{};
    for (int j = 0; j < 3; ++j) {
      const double half = j < D ? shape.height(Vec<D>::Unit(std::min(j, D - 1))) : shape.equivalent_radius();
      for (int i = 0; i < 3; ++i) all[std::size_t(3 * i + j)] = axes(i, j) * half;
    }
    return all;
  });
  scalars("radius_m", [&](const R& rock) { return rocks.shapes[std::size_t(rock.shape)].equivalent_radius(); });
  scalars("mass_kg", [](const R& rock) { return rock.body.mass; });
  std::vector<std::string> groups;
  scalars("group", [&](const R& rock) {
    if (groups.empty() || groups.back() != rock.name) groups.push_back(rock.name);
    return groups.size() - 1;
  });
  frame.publish();
}

#define MPM_INSTANTIATE(D)                                                                \
  template void add_rock_values<D>(const Solver<D>&, double, std::vector<double>&, Row&); \
  template void write_rock_frame<D>(const Solver<D>&, const std::string&, const std::vector<double>&);
MPM_INSTANTIATE(2)
MPM_INSTANTIATE(3)
#undef MPM_INSTANTIATE

}  // namespace mpm
