// Both phases of saturated soil at the nodes (USF). With lumped mass and drag each node is a system of two:
//
//   H = [m_s + dt d, -dt d; -dt d, m_f + dt d],   (v_s*, v_f*) = H^-1 (m_s v_s + dt F_s, m_f v_f + dt F_f)
//
// Stress of the solid explicit; forces with the pressure of the step before; then L dp = -D(v*), and both velocities
// change by dt H^-1 D^T dp (pore_pressure.hpp). The step is stable for every conductivity: its bound is that of the
// skeleton without water. Declared in solver.hpp.

#include <algorithm>

#include "tools/mpm/grid/transfer.hpp"
#include "tools/mpm/step/solver.hpp"

namespace mpm {

template <int D>
void Solver<D>::map_water_momentum() {
  auto& water = *fluid;
  over_slabs([&](long k) {
    const auto& here = water.points[k];
    if (here.mass > 0)
      give_momentum<D>(water.grid, supports_[k], here.mass, here.velocity, here.affine, options.affine);
  });
}

template <int D>
void Solver<D>::map_saturated_force() {
  auto& water = *fluid;
  const Vec<D> b = options.gravity - frame_acceleration();
  over_slabs([&](long k) {
    const auto& point = points[k];
    const auto& here = water.points[k];
    Vec<D> gradient = Vec<D>::Zero();
    double pressure = 0;
    if (here.mass > 0) {
      pressure = pressure_and_gradient_at<D>(grid, hat_at<D>(grid, point.position), water.pressure.values, gradient);
      gradient *= here.porosity(point.volume) * point.volume;
    }
    Lanes<D> stress[D] = {}, force = {}, none[D] = {}, on_water = {};
    const double outside = options.surface_pressure - pressure;
    for (int i = 0; i < D; ++i) {
      for (int j = 0; j < D; ++j) stress[j][i] = -point.volume * (point.stress(i, j) + (i == j ? outside : 0));
      force[i] = point.mass * b[i] + gradient[i];
      on_water[i] = here.mass * b[i] - gradient[i];
    }
    if (!loads.strips.empty()) stress[D - 1][D - 1] -= point.volume * loads.strip_pressure(point.position[0], time);
    give_force<D>(grid, supports_[k], stress, force);
    if (here.mass > 0) give_force<D>(water.grid, supports_[k], none, on_water);
  });
}

/// D and the drag, of the places and volumes of now.
template <int D>
void Solver<D>::assemble_water() {
  auto& water = *fluid;
  water.pressure.clear(grid);
  water.drag.assign(grid.nodes.size(), 0);
  for (const auto& group : groups) {
    const double shear = 0.25 * group.material->wave_modulus();
    over_slabs([&](long k) {
      if (k < group.first || k >= group.first + group.count || water.points[k].mass == 0) return;
      const auto& point = points[k];
      const double n = water.points[k].porosity(point.volume);
      water.pressure.add(grid, supports_[k], hat_at<D>(grid, point.position), point.volume, n, shear,
                         n / water.options.bulk_modulus);
      const double drag = n * n * water.options.density * FluidOptions::standard_gravity /
                          water.conductivity(k, point.volume) * point.volume;
      each_row<D>(water.drag.data(), grid, supports_[k], [&](double* row, double across, const double*, const double*) {
        for (int r = 0; r < 3; ++r) row[r] += drag * across * supports_[k].weight[0][r];
      });
    });
  }
  water.pressure.gather_repeated(grid);
  water.pressure.fold(grid, planes, water.planes);
  water.set_roles(bodies, time);
}

/// H^-1 and v* of the nodes; held components have the velocity of what holds them.
template <int D>
void Solver<D>::predict_velocities(double dt) {
  auto& water = *fluid;
  const auto held = [&](long node, int i) { return std::pair(planes.holds(node, i), water.planes.holds(node, i)); };
  water.folded_drag = water.drag;
  for (const auto& mirror : planes.mirror_nodes()) water.folded_drag[mirror.image] += water.drag[mirror.node];
  water.mobility.assign(grid.nodes.size() * D, Mobility{-1, 0, 0});
  const auto each_node = [&](const auto& work) {
    over(long(grid.nodes.size()), [&](long at) {
      auto& s = grid.nodes[at];
      if (s.mass > 0 && !planes.is_mirror(at)) work(at, s, water.grid.nodes[at]);
    });
  };
  each_node([&](long at, auto& s, auto& f) {
    const double e = dt * water.folded_drag[at], both = s.mass * f.mass + e * (s.mass + f.mass);
    for (int i = 0; i < D; ++i) {
      auto& m = water.mobility[at * D + i];
      const auto [solid_held, fluid_held] = held(at, i);
      m = {solid_held ? 0 : 1 / (s.mass + e), 0, fluid_held || !(f.mass > 0) ? 0 : 1 / (f.mass + e)};
      if (!solid_held && !fluid_held && f.mass > 0) m = {(f.mass + e) / both, e / both, (s.mass + e) / both};
      const double on_solid = s.mass * s.v[i] + dt * s.w[i], on_fluid = f.mass * f.v[i] + dt * f.w[i];
      s.w[i] = m.solid * on_solid + m.both * on_fluid;
      f.w[i] = m.both * on_solid + m.fluid * on_fluid;
    }
  });
  planes.set_end(grid, time + dt);
  water.planes.set_end(water.grid, time + dt);
  // One phase held, the other drags along it.
  each_node([&](long at, auto& s, auto& f) {
    const double e = dt * water.folded_drag[at];
    for (int i = 0; i < D; ++i) {
      const auto [solid_held, fluid_held] = held(at, i);
      const auto& m = water.mobility[at * D + i];
      if (solid_held && !fluid_held) f.w[i] += m.fluid * e * s.w[i];
      if (fluid_held && !solid_held) s.w[i] += m.solid * e * f.w[i];
    }
  });
  if (planes.absorb()) add_dashpots(dt);
  // What bodies change is no drag: the slip is that of H^-1 alone.
  water.slip.assign(grid.nodes.size() * D, 0);
  add_slip(1);
  hold_velocities(dt);
  add_slip(-1);
}

template <int D>
void Solver<D>::add_slip(double sign) {
  auto& water = *fluid;
  for (std::size_t at = 0; at < grid.nodes.size(); ++at) {
    for (int i = 0; i < D; ++i) {
      water.slip[at * D + i] += sign * (water.grid.nodes[at].w[i] - grid.nodes[at].w[i]);
    }
  }
}

/// Bodies and planes hold both phases.
template <int D>
void Solver<D>::hold_velocities(double dt) {
  contact_.hold_end(grid, bodies, nullptr, time + dt);
  water_contact_.hold_end(fluid->grid, fluid->bodies, nullptr, time + dt);
  planes.set_end(grid, time + dt);
  fluid->planes.set_end(fluid->grid, time + dt);
}

/// Both velocities by dt H^-1 D^T dp.
template <int D>
void Solver<D>::correct_velocities(const std::vector<double>& dp, double dt) {
  auto& water = *fluid;
  over(long(grid.nodes.size()), [&](long at) {
    if (!water.pressure.reaches(at) || water.mobility[at * D].solid < 0) return;
    double solid[D], fluid_force[D];
    water.pressure.force(grid, at, dp, true, solid, fluid_force);
    for (int i = 0; i < D; ++i) {
      const auto& m = water.mobility[at * D + i];
      grid.nodes[at].w[i] += dt * (m.solid * solid[i] + m.both * fluid_force[i]);
      water.grid.nodes[at].w[i] += dt * (m.both * solid[i] + m.fluid * fluid_force[i]);
    }
  });
  planes.set_end(grid, time + dt);
  water.planes.set_end(water.grid, time + dt);
}

template <int D>
void Solver<D>::project(double dt) {
  auto& water = *fluid;
  auto& pressure = water.pressure;
  using Role = typename PorePressure<D>::Role;
  std::vector<double> dp(grid.nodes.size(), 0.0), right(grid.nodes.size(), 0.0), stored(grid.nodes.size(), 0.0);
  for (std::size_t at = 0; at < dp.size(); ++at) {
    if (pressure.roles[at] == Role::given) dp[at] = pressure.targets[at] - pressure.values[at];
    if (pressure.roles[at] == Role::none) pressure.values[at] = 0;
  }
  const bool driven = std::any_of(dp.begin(), dp.end(), [](double each) { return each != 0; });
  if (driven) correct_velocities(dp, dt);
  const auto velocity = [&](long at) {
    return std::pair<const double*, const double*>(grid.nodes[at].w, water.grid.nodes[at].w);
  };
  pressure.divergence(grid, workers, velocity, right);
  if (driven) pressure.stored(grid, dp, dt, workers, stored);
  for (std::size_t at = 0; at < dp.size(); ++at) right[at] = -right[at] - stored[at];
  std::vector<double> change(grid.nodes.size(), 0.0);
  pressure.solve(grid, water.mobility, right, dt, workers, change);
  correct_velocities(change, dt);
  for (std::size_t at = 0; at < dp.size(); ++at) {
    dp[at] += change[at];
    pressure.values[at] += dp[at];
  }
  pressure.copy_repeated(grid);
  add_slip(1);
  hold_velocities(dt);
  // What the step added to the forces that the planes have recorded.
  const auto add = [&](double sign, bool of_solid) {
    return [&, sign, of_solid](long at, double* force) {
      double solid[D], on_water[D];
      pressure.force(grid, at, dp, false, solid, on_water);
      for (int i = 0; i < D; ++i) {
        force[i] += (of_solid ? solid[i] : on_water[i]) + sign * water.drag_at(at) * water.slip[at * D + i];
      }
    };
  };
  planes.add_forces(add(1, true));
  water.planes.add_forces(add(-1, false));
}

/// Energy that the water took and gave, and what flowed out.
template <int D>
void Solver<D>::balance_water(double dt) {
  auto& water = *fluid;
  auto& pressure = water.pressure;
  using Role = typename PorePressure<D>::Role;
  std::vector<double> rate(grid.nodes.size(), 0.0);
  for (long at = 0; at < long(grid.nodes.size()); ++at) {
    const auto& s = grid.nodes[at];
    const auto& f = water.grid.nodes[at];
    if (!(f.mass > 0)) continue;
    for (int i = 0; i < D; ++i) {
      const double solid = 0.5 * (s.w[i] + s.a[i]), fluid_mean = 0.5 * (f.w[i] + f.a[i]);
      water.drag_loss += dt * water.drag_at(at) * water.slip[at * D + i] * (fluid_mean - solid);
    }
  }
  const auto mean = [&](long at) {
    std::pair<Vec<D>, Vec<D>> mean;
    for (int i = 0; i < D; ++i) {
      mean.first[i] = 0.5 * (grid.nodes[at].w[i] + grid.nodes[at].a[i]);
      mean.second[i] = 0.5 * (water.grid.nodes[at].w[i] + water.grid.nodes[at].a[i]);
    }
    return mean;
  };
  pressure.divergence(grid, workers, mean, rate);
  for (std::size_t at = 0; at < rate.size(); ++at) {
    if (pressure.roles[at] != Role::none) water.water_work += dt * pressure.values[at] * rate[at];
  }
  const auto end = [&](long at) {
    return std::pair<const double*, const double*>(grid.nodes[at].w, water.grid.nodes[at].w);
  };
  pressure.divergence(grid, workers, end, rate);
  for (long at = 0; at < long(rate.size()); ++at) {
    if (pressure.roles[at] == Role::given) water.outflow[water.outlet_at(grid.index(at), time)] -= dt * rate[at];
  }
}

template <int D>
void Solver<D>::move_water(double dt) {
  auto& water = *fluid;
  const double pic = options.pic_fraction;
  over(long(points.size()), [&](long k) {
    auto& here = water.points[k];
    if (here.mass == 0) return;
    Taken<D> taken;
    take_velocity<D>(water.grid, supports_[k], taken);
    for (int i = 0; i < D; ++i) {
      here.velocity[i] = pic * taken.w[i] + (1 - pic) * (here.velocity[i] + taken.added[i]);
      for (int j = 0; options.affine && j < D; ++j) here.affine(i, j) = taken.gradient[j][i];
    }
    here.affine = carried_gradient<D>(here.affine, dt);
    Vec<D> gradient;
    here.pressure =
        pressure_and_gradient_at<D>(grid, hat_at<D>(grid, points[k].position), water.pressure.values, gradient);
    if (std::isnan(here.liquefied) && here.first_vertical > 0 && here.pressure_ratio() > 0.9) {
      here.liquefied = time + dt;
    }
  });
}

#define MPM_INSTANTIATE(D)                             \
  template void Solver<D>::map_water_momentum();       \
  template void Solver<D>::map_saturated_force();      \
  template void Solver<D>::assemble_water();           \
  template void Solver<D>::predict_velocities(double); \
  template void Solver<D>::project(double);            \
  template void Solver<D>::balance_water(double);      \
  template void Solver<D>::move_water(double);
MPM_INSTANTIATE(2)
MPM_INSTANTIATE(3)
#undef MPM_INSTANTIATE

}  // namespace mpm
