// Rigid bodies with a prescribed velocity: half-space (a base with friction), box (footing, plate), disc (pipe; in
// space a cylinder along z). Where the soil's velocity approaches that of the body, the two meet: without penetration,
// rough (no slip) or with Coulomb friction, free to part. What the soil gets, the body gets with the other sign.
//
// Contact at nodes: each node inside the body is held by itself. Contact at the surface (half-spaces across an axis):
// over each node of the surface the soil's velocity sum N_I v_I there is held, by an impulse J that the nodes get as
// N_I J. A uniform stress is then in balance at every node, also with shape functions that reach beyond the surface:
// its nodal forces are N_I t, t the traction. At nodes alone the first row outside is left with N_I t (quadratic: t/8).
#pragma once

#include <string>
#include <vector>

#include "tools/mpm/planes.hpp"
#include "tools/mpm/shape.hpp"

namespace mpm {

enum class BodyKind { half_space, box, disc };

template <int D>
struct Body {
  std::string name;
  BodyKind kind = BodyKind::box;
  Vec<D> centre = Vec<D>::Zero();  ///< m, at time 0; half-space: a point of its surface
  Vec<D> half = Vec<D>::Zero();    ///< m, half the sides of the box
  Vec<D> normal = Vec<D>::Zero();  ///< of the half-space, into the soil
  double radius = 0;               ///< m
  bool rough = true;               ///< no slip while it is pressed
  double friction = 0;             ///< coefficient, where it is not rough
  bool at_surface = false;         ///< contact at the surface, not at nodes
  VelocityHistory<D> velocity;
  Reaction<D> reaction;

  /// Distance from the surface, negative inside, and the outward normal there.
  double distance(const Vec<D>& position, double time, Vec<D>& outward) const;
};

template <int D>
class Bodies {
 public:
  std::vector<Body<D>> all;
  Shape shape = Shape::bspline;  ///< that of the grid

  /// Which nodes lie in a body at this time; those behind a plane follow the ones that they mirror.
  void find(const Grid<D>& grid, const Planes<D>& planes, double time);
  /// Velocities v at the start of the step.
  void set_start(Grid<D>& grid, double time);
  /// Velocities w at the end of the step; a still is what the points brought. What a plane holds at a node is the
  /// plane's reaction, not the body's.
  void set_end(Grid<D>& grid, const Planes<D>& planes, double time);

 private:
  struct Contact {
    long node;
    int body;
    Vec<D> normal;
    Vec<D> jump;  ///< m/s, what this body alone changed the soil's velocity by over the step
  };
  /// Over one node of a surface: the nodes across it that reach it, and their weights there, of sum 1.
  struct SurfaceContact {
    long node[3];
    double weight[3];
    int count = 0;
    int body;
    Vec<D> normal, impulse;  ///< N s, of the body on the soil over the step
  };
  void find_surface(const Grid<D>& grid, const Planes<D>& planes, int body, double time);
  /// What the velocity against the body becomes.
  Vec<D> held(int body, const Vec<D>& normal, const Vec<D>& relative) const;
  /// What it changes the velocity by.
  Vec<D> meet(const Contact& contact, const Vec<D>& speed, double* velocity) const;
  /// The impulse; the velocities are v or w of the nodes.
  Vec<D> meet(const SurfaceContact& contact, const Vec<D>& speed, bool end, Grid<D>& grid) const;
  void book(int body, const Node<D>& node, int component, double impulse);
  std::vector<Contact> contacts_;
  std::vector<SurfaceContact> surface_;
};

}  // namespace mpm
