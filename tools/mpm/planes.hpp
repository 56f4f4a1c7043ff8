// Boundaries along planes of nodes: fixed (nothing moves against it) and roller (smooth wall, symmetry, gate).
//
// Nodes behind a plane mirror those before it: v_behind = V + S (v_before - V), S = -1 for each component that the
// plane holds and +1 for the others. Linear fields are then exact up to the wall whatever the shape function, and what
// the points bring to nodes behind it is added to the mirrored node with the transposed map, so that momentum balances.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "tools/mpm/grid.hpp"
#include "tools/mpm/velocity_history.hpp"

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
  VelocityHistory<D> velocity;
  double removed_at = std::numeric_limits<double>::infinity();  ///< s
  Reaction<D> reaction;

  bool holds(int component) const { return fixed || component == axis; }
};

template <int D>
class Planes {
 public:
  std::vector<Plane<D>> all;

  /// Which nodes mirror which: to be called when the box of the grid changes.
  void rebuild(const Grid<D>& grid, double time);
  /// Whether a plane was removed since the last rebuild.
  bool changed(double time) const;

  /// After division by mass: mass and velocity v of mirrored nodes, as if images of the points had been mapped too.
  void fold_momentum(Grid<D>& grid, double time);
  /// What the points brought (a) at nodes that a plane touches is what they brought with their images.
  void keep_brought(Grid<D>& grid) const;
  /// Velocities v on the planes, and behind them.
  void set_start(Grid<D>& grid, double time) const { set(grid, time, false); }
  /// Before division: forces of mirrored nodes.
  void fold_force(Grid<D>& grid);
  /// Velocities w at the end of the step.
  void set_end(Grid<D>& grid, double time) const { set(grid, time, true); }
  /// Once a is the change over the step: what each plane did.
  /// pic_fraction: points take this part of the nodal velocity itself, not of its change; walls give it too.
  void react(const Grid<D>& grid, double dt, double pic_fraction);
  /// Total change of kinetic energy and momentum need the masses before folding: puts them back.
  void unfold(Grid<D>& grid) const;
  /// Whether a plane that the node lies on holds this component: it has the last word there, and the reaction.
  bool holds(long node, int component) const { return !held_.empty() && (held_[node] >> component & 1) != 0; }
  /// Whether a node lies behind a plane.
  bool is_behind(long node) const { return !behind_.empty() && behind_[node] != 0; }

 private:
  struct Tie {
    long behind, before;
    Vec<D> sign;
    std::vector<int> planes;  ///< in the order of the reflections
  };
  struct Special {  ///< a node that a plane touches, with what it had before
    long node;
    std::vector<int> planes;  ///< that it lies on, then those that it mirrors at
    double mass = 0;
    Vec<D> force = Vec<D>::Zero(), velocity = Vec<D>::Zero();
    Vec<D> given = Vec<D>::Zero();  ///< N s, by ties
  };
  struct OnPlane {
    long node;
    int plane;
  };
  Special& special(long node) { return specials_[std::size_t(special_of_[std::size_t(node)])]; }
  int owner(const std::vector<int>& planes, int component) const;
  void book(int plane, int component, const Node<D>& node, double impulse);
  void set(Grid<D>& grid, double time, bool end) const;
  Vec<D> shift(const Tie& tie, const std::vector<Vec<D>>& speeds) const;
  std::vector<Vec<D>> speeds(double time) const;
  bool active(int plane, double time) const { return time < all[plane].removed_at; }

  std::vector<Tie> ties_;
  std::vector<Special> specials_;
  std::vector<OnPlane> on_plane_;  ///< rollers first, so that a fixed plane has the last word
  std::vector<char> behind_;
  std::vector<char> held_;       ///< by node, one bit for each component
  std::vector<int> special_of_;  ///< by node; -1: none
  double built_ = -1;
};

}  // namespace mpm
