// Boundaries along planes of nodes: fixed (rough), roller (smooth wall, symmetry, gate), absorbing (a roller on a
// half-space that takes shear waves in, dashpots.cpp) and periodic (two planes, of which one continues the other).
//
// A node on the far side of a plane is a mirror node: it has the velocity of its image on the soil's side, mirrored:
// v_mirror = V + S (v_image - V), with V the velocity of the plane and S = -1 for each component that the plane holds,
// +1 for the others. Linear fields are then exact up to the wall with any shape function. Mass, momentum and force that
// points map to a mirror node are added to its image by the transposed map, so that momentum balances.
#pragma once

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "tools/mpm/bodies/histories.hpp"
#include "tools/mpm/grid/grid.hpp"

namespace mpm {

/// What a boundary did to the soil.
template <int D>
struct Reaction {
  Vec<D> impulse = Vec<D>::Zero();  ///< N s, on the soil
  double work = 0;                  ///< J, on the soil
};

template <int D>
struct Plane {
  std::string name;
  int axis = 0;
  int node = 0;    ///< number of its nodes along the axis
  int inside = 1;  ///< +1: the soil is on the upper side
  bool fixed = false;
  int period = 0;               ///< cells to the plane that it is one with; 0: none. It holds nothing
  double impedance = 0;         ///< kg/(m^2 s), rho c_s of the half-space behind an absorbing plane; 0: it reflects
  VelocityHistory<D> incoming;  ///< m/s, of the shear wave that comes up through the half-space
  bool open = false;  ///< to this phase (pore water at a drained plane): it holds nothing, and mirrors as it is
  VelocityHistory<D> velocity;
  double removed_at = std::numeric_limits<double>::infinity();  ///< s
  Reaction<D> reaction;

  Vec<D> velocity_at(double time) const { return velocity.at(time); }                ///< m/s
  Vec<D> displacement_at(double time) const { return velocity.displacement(time); }  ///< m
  bool holds(int component) const { return fixed || (component == axis && !open && period == 0); }
};

/// A node on the far side of planes, and the node whose velocity it mirrors.
template <int D>
struct MirrorNode {
  long node, image;
  Vec<D> sign;
  std::vector<int> planes;  ///< in the order of the reflections
};

template <int D>
class Planes {
 public:
  std::vector<Plane<D>> all;

  /// Finds the mirror nodes and their images: to be called when the box of the grid changes.
  void rebuild(const Grid<D>& grid, double time);
  /// Whether a plane was removed since the last rebuild.
  bool changed(double time) const;

  /// After division by mass: adds mass and velocity v of mirror nodes to their images.
  void fold_momentum(Grid<D>& grid, double time);
  /// At nodes that a plane touches the mapped velocity (a) is that with the mirror nodes added.
  void keep_mapped(Grid<D>& grid) const;
  /// Velocities v on the planes, and of mirror nodes.
  void set_start(Grid<D>& grid, double time) const { set(grid, time, false); }
  /// Before division: adds forces at mirror nodes to their images.
  void fold_force(Grid<D>& grid);
  /// Velocities w at the end of the step.
  void set_end(Grid<D>& grid, double time) const { set(grid, time, true); }
  /// Adds impulse and work of each plane, once a is the change over the step. pic_fraction: the part of the nodal
  /// velocity itself, not of its change, that points take; planes give it too.
  void react(const Grid<D>& grid, double dt, double pic_fraction);
  /// force(node, f): adds to the forces f (N) of the nodes that planes touch, after fold_force, what acts at them
  /// beside those that were folded.
  template <class Force>
  void add_forces(const Force& force) {
    for (auto& each : touched_) force(each.node, each.force.data());
  }
  /// Restores the masses before folding, which the total change of kinetic energy and momentum need.
  void unfold(Grid<D>& grid) const;
  bool absorb() const {
    return std::any_of(all.begin(), all.end(), [](const auto& plane) { return plane.impedance > 0; });
  }
  bool active(int plane, double time) const { return time < all[plane].removed_at; }
  /// Whether a plane that the node lies on holds this component: the plane then sets it, and takes the reaction.
  bool holds(long node, int component) const { return !held_.empty() && (held_[node] >> component & 1) != 0; }
  bool is_mirror(long node) const { return !is_mirror_.empty() && is_mirror_[node] != 0; }
  /// Those whose image lies in the box of the grid.
  const std::vector<MirrorNode<D>>& mirror_nodes() const { return mirrors_; }

 private:
  struct Touched {  ///< a node that a plane touches, with its values before folding
    long node;
    std::vector<int> planes;  ///< that it lies on, then those that it is reflected at
    double mass = 0;
    Vec<D> force = Vec<D>::Zero(), velocity = Vec<D>::Zero();
    Vec<D> folded = Vec<D>::Zero();  ///< N s, from its mirror nodes
  };
  struct OnPlane {
    long node;
    int plane;
  };
  void add_touched(const Grid<D>& grid, long node, int plane);
  MirrorNode<D> reflected(const Grid<D>& grid, long node, typename Grid<D>::Index& image, double time) const;
  void add_on_planes(const Grid<D>& grid, long node, double time);
  Touched& touched(long node) { return touched_[std::size_t(touched_of_[std::size_t(node)])]; }
  int owner(const std::vector<int>& planes, int component) const;
  void book(int plane, int component, const Node<D>& node, double impulse);
  void set(Grid<D>& grid, double time, bool end) const;
  Vec<D> shift(const MirrorNode<D>& mirror, const std::vector<Vec<D>>& speeds) const;
  std::vector<Vec<D>> speeds(double time) const;

  std::vector<MirrorNode<D>> mirrors_;
  std::vector<Touched> touched_;
  std::vector<OnPlane> on_plane_;  ///< rollers first, so that a fixed plane decides
  std::vector<char> is_mirror_;
  std::vector<char> held_;       ///< by node, one bit for each component
  std::vector<int> touched_of_;  ///< by node; -1: none
  double built_ = -1;
};

}  // namespace mpm
