// Pore sizes and an estimate of the permeability, from the power cells of discs or spheres.
//
// Body: a sphere (disc) that touches the four (three) grains of a simplex from outside and intersects none. Throat: in
// space the circle in the plane of three grains that touches them (Reboul, Vincens and Cambou 2008), in the plane half
// of the gap of two discs; it also intersects none. Bodies may overlap: those of one wide pore are not merged.
//
// Kozeny (1927), Carman (1937): k = e^3/(c S^2 (1 + e)), S the surface of the grains over their volume, c = 5. Spheres
// of one diameter d: d^2 n^3/(180 (1 - n)^2). Overlaps are not subtracted. Discs count as long rods; contacts close the
// pores of a plane, so k is at best that of flow along the rods.
#pragma once

#include "tools/voids/power_cells.hpp"

namespace rvelab::voids {

struct Pore {
  Vector3 centre;     ///< m, cell frame; not wrapped into the cell
  double radius = 0;  ///< m, > 0
};

/// Each once per cell. The order depends only on the input.
struct Pores {
  std::vector<Pore> bodies, throats;
};
Pores pores(const PeriodicCell& cell, const std::vector<Ball>& balls, const PowerCells& cells);

/// Centre and radius of the sphere that touches spheres from outside: d + 1 of them in a space of `dimension` d = 1, 2
/// or 3 (of points in the plane, z is the same; on the line, any direction). Of two the smaller one outside of all.
/// False if there is none.
bool touching_ball(const std::vector<Ball>& balls, Pore& found);

/// (V_i - v_i)/v_i of each cell; -1 for a grain without a cell.
std::vector<double> local_void_ratios(const PeriodicCell& cell, const std::vector<Ball>& balls,
                                      const PowerCells& cells);

/// Surface of the grains over their volume, 1/m.
double specific_surface(const std::vector<Ball>& balls, int dimension);

/// k, m^2.
double kozeny_carman(double void_ratio, double specific_surface, double constant = 5);

}  // namespace rvelab::voids
