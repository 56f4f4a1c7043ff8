// Power (Laguerre) cells of the grains of a periodic cell, from the regular triangulation of their centres with the
// weights r^2: a point belongs to the grain i with the least |x - x_i|^2 - r_i^2. The plane through the contact point
// of two touching grains separates their cells (Aurenhammer 1987).
//
// CGAL's periodic triangulations support only cubes; the lattice here is any upper triangular one. So the grains are
// repeated by lattice vectors up to a margin around them, and the margin grows until no grain beyond it can affect a
// simplex at a grain of the cell. These are then the simplices of the infinite periodic triangulation.
#pragma once

#include <vector>

#include "tools/voids/cell.hpp"

namespace rvelab::voids {

/// A disc or sphere. m, cell frame.
struct Ball {
  Vector3 position;
  double radius = 0;
};

/// The copy of a ball by a lattice translation.
struct Corner {
  int ball = 0;
  Image image{};
  auto operator<=>(const Corner&) const = default;
};

/// A triangle of three corners (2D) or tetrahedron of four; sorted.
using Simplex = std::vector<Corner>;

/// Corners of a simplex, face or edge of the same balls, shifted such that all its translates are one: the least of the
/// sorted lists that have a corner in the cell.
Simplex canonical(Simplex corners);

struct PowerCells {
  std::vector<double> volume;      ///< of each ball's cell, m^3 (2D: of the slab); 0: no cell, covered by others
  std::vector<Simplex> simplices;  ///< canonical, each once; the order depends only on the input
  double margin = 0;               ///< m, the sufficient one
};

/// Throws Error without a ball.
PowerCells power_cells(const PeriodicCell& cell, const std::vector<Ball>& balls);

// Common parts of plane and space.

/// Balls and their copies within a box around the balls, larger by `margin`.
struct Copies {
  Vector3 low, high;  ///< of the box, margin included
  std::vector<Corner> corners;
  std::vector<Ball> balls;
  double largest_radius = 0;
};
Copies copies_within(const PeriodicCell& cell, const std::vector<Ball>& balls, double margin);

/// Distance by which a ball about the orthocentre that a missing copy might reach exceeds the box, m; <= 0: inside.
double beyond(const Copies& copies, int dimension, const Vector3& orthocentre, const Ball& corner);

/// The point of equal power to all corners, by exact arithmetic if the simplex is flat. Cell frame, m.
Vector3 orthocentre_of(const std::vector<Ball>& corners);

/// One attempt: cells and simplices at the balls of the cell; `lacking`: missing margin, m.
struct Attempt {
  PowerCells cells;
  double lacking = 0;
};
Attempt attempt_in_plane(const Copies& copies, std::size_t balls, double thickness);
Attempt attempt_in_space(const Copies& copies, std::size_t balls);

}  // namespace rvelab::voids
