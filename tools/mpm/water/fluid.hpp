// Pore water of saturated soil: a second phase at the same material points, on a grid of its own.
//
//   mixture   rho_1 a_s + rho_2 a_f = div(sigma' - p I) + rho b,    rho_1 = (1 - n) rho_s, rho_2 = n rho_f
//   water     rho_2 a_f = -n grad p + rho_2 b - d (v_f - v_s),      d = n^2 rho_f g/k
//   mass      div(v_s + n (v_f - v_s)) + (n/K_f) dp/dt = 0
//   k = k_0 [e^3/(1 + e)]/[e_0^3/(1 + e_0)]                         (Kozeny-Carman)
//
// (Liang, Zhao, Wu, Zhao and Wang 2023, eq. 1 to 3 and 28.) Points move with the solid; the stress that RVEs and laws
// give is the effective one.
#pragma once

#include <functional>
#include <vector>

#include "tools/mpm/bodies/bodies.hpp"
#include "tools/mpm/water/options.hpp"
#include "tools/mpm/water/pore_pressure.hpp"

namespace mpm {

template <int D>
struct FluidPoint {
  Vec<D> velocity = Vec<D>::Zero();  ///< m/s
  Mat<D> affine = Mat<D>::Zero();    ///< 1/s, as that of the solid
  double mass = 0;                   ///< kg of water at the start of the step; 0: the point is dry
  double solids = 0;                 ///< m^3 of grains; 0: the point is dry
  double first_void_ratio = 0;
  double conductivity = 0;    ///< m/s, at the first void ratio
  double pressure = 0;        ///< Pa, compression positive
  double first_pressure = 0;  ///< Pa, at the start
  double first_vertical = 0;  ///< Pa, effective stress along the last axis at the start, compression positive
  double liquefied = NAN;     ///< s, when (p - p_0)/first_vertical first went above 0.9; NaN: it did not

  double porosity(double volume) const { return 1 - solids / volume; }
  double void_ratio(double volume) const { return volume / solids - 1; }
  /// Excess pore pressure over the initial effective vertical stress; NaN where there was none but round-off.
  double pressure_ratio() const {
    return first_vertical > 1e-9 * std::abs(first_pressure) ? (pressure - first_pressure) / first_vertical : NAN;
  }
};

template <int D>
struct Fluid {
  FluidOptions options;
  std::vector<FluidPoint<D>> points;  ///< one a material point
  Grid<D> grid;                       ///< the box of the solid's
  Planes<D> planes;                   ///< those of the solid, smooth, open where they are drained
  Bodies<D> bodies;                   ///< those of the solid, smooth
  PorePressure<D> pressure;
  std::function<double(double)> first_pressure;  ///< Pa of a height (m); empty: none at the start
  double nodal_energy = 0;
  double gravity_work = 0;      ///< J, of gravity on the water
  double drag_loss = 0;         ///< J, between the phases
  double water_work = 0;        ///< J, of the pressure on both phases: what came in at given pressures, or was stored
  std::vector<double> outflow;  ///< m^3, through each plane, then through free surfaces
  double seconds = 0;           ///< of the pressure: assembled and solved

  /// m/s, at the void ratio of now.
  double conductivity(long point, double volume) const {
    const auto& at = points[point];
    if (!options.follows_void_ratio) return at.conductivity;
    const auto carman = [](double e) { return e * e * e / (1 + e); };
    return at.conductivity * carman(at.void_ratio(volume)) / carman(at.first_void_ratio);
  }
  /// Box and planes as those of the solid; what follows the void ratio. first: the pressure of the start is set.
  void begin_step(const Grid<D>& solid, const std::vector<Point<D>>& soil, double time, bool first);
  /// What each node of the pressure is at this time; hats reach into bodies.
  void set_roles(const Bodies<D>& solid, double time);
  /// Of `outflow`: the open plane that a node lies on, or the free surfaces.
  std::size_t outlet_at(const typename Grid<D>::Index& node, double time) const {
    const int plane = open_plane_at(node, time);
    return plane < 0 ? planes.all.size() : std::size_t(plane);
  }
  /// N, of the pressure on a plane, along its axis.
  double force_on(const Planes<D>& all, int plane) const;

  /// kg/s, as H has it: that of mirror nodes acts at their images.
  double drag_at(long node) const { return planes.is_mirror(node) ? 0 : folded_drag[node]; }

  // Within a step, by node.
  std::vector<double> drag;         ///< kg/s, sum of N V d
  std::vector<double> folded_drag;  ///< with that of mirror nodes
  std::vector<double> slip;         ///< node * D + axis, m/s: v_f - v_s that the drag of the step came from
  std::vector<Mobility> mobility;   ///< node * D + axis; of nodes that mirror none

 private:
  double whole_hat(const Bodies<D>& solid, double time, long node) const;
  int open_plane_at(const typename Grid<D>::Index& node, double time) const;
};

/// Planes and bodies of the solid become those of the water.
template <int D>
void make_water_boundaries(const Planes<D>& planes, const Bodies<D>& bodies, Fluid<D>& fluid);

}  // namespace mpm
