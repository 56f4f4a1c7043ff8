// Rigid bodies with a prescribed velocity: half-space (a base with friction), box (footing, plate), disc (pipe; in
// space a cylinder along z). Where the soil's velocity approaches that of the body, the two meet: without penetration,
// rough (no slip) or with Coulomb friction, free to part. What the soil gets, the body gets with the other sign.
//
// Contact at nodes: each node inside the body is held by itself. Contact at the surface: the soil's velocity sum N_I
// v_I is held at points of the surface, a cell apart, by impulses J that the nodes get as N_I J. A uniform stress is
// then in balance at every node, also with shape functions that reach beyond the surface: its nodal forces are N_I t, t
// the traction. At nodes alone the first row outside is left with N_I t (quadratic: t/8), and a body's outline is that
// of the nodes inside it. Points that share nodes have their impulses found in sweeps (projected Gauss-Seidel); those
// of a half-space across an axis lie over single columns of nodes and need one.
#pragma once

#include <string>
#include <vector>

#include "tools/mpm/planes.hpp"
#include "tools/mpm/point.hpp"
#include "tools/mpm/shape.hpp"
#include "tools/mpm/workers.hpp"

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

  /// m, at a time in s.
  Vec<D> centre_at(double time) const { return centre + velocity.way(time); }
  /// Distance from the surface (m), negative inside, and the outward unit normal there; r (m): from the centre. The
  /// nearest face of a box is told by distances over `unit`, such as the sides of what is at r.
  double distance(const Vec<D>& r, Vec<D>& outward, const Vec<D>& unit = Vec<D>::Ones()) const;
};

template <int D>
class Bodies {
 public:
  std::vector<Body<D>> all;
  Shape shape = Shape::bspline;  ///< that of the grid

  /// Which points of surfaces soil is against at this time (s), and which nodes lie in a body with contact at nodes;
  /// nodes behind a plane follow the ones that they mirror.
  void find(const Grid<D>& grid, const Planes<D>& planes, const std::vector<Point<D>>& soil, double time,
            Workers& workers);
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
  static constexpr int reach = D == 2 ? 9 : 27;
  static constexpr long chunk = 1024;  ///< points or nodes of one piece of work
  /// A point of a surface: the nodes that reach it, and their weights there, of sum 1.
  struct SurfacePoint {
    int body;
    Vec<D> normal;
    long node[reach];
    double weight[reach];
    int count = 0;
    double mobility = 0;  ///< m/s of N s: sum of weight^2/mass
    Vec<D> now, impulse;  ///< N s, of the body on the soil: of this start or end, of the step
  };
  void find_touched(const Grid<D>& grid, const std::vector<Point<D>>& soil, int body, double time, Workers& workers);
  void find_inside(const Grid<D>& grid, const Planes<D>& planes, double time, Workers& workers);
  /// The body's bits of what a point of the soil is against, and the node it is nearest to; no bits: nothing.
  unsigned char touch_of(const Grid<D>& grid, const Body<D>& body, const Vec<D>& centre, const Point<D>& point,
                         typename Grid<D>::Index& node) const;
  bool is_touched(const Grid<D>& grid, const typename Grid<D>::Index& node, unsigned char face) const;
  /// False outside the grid.
  static bool nearest_node(const Grid<D>& grid, const Vec<D>& at, typename Grid<D>::Index& node);
  static unsigned char face_of(const Body<D>& body, const Vec<D>& normal);
  int surface_weights(double xi, double* weight) const;
  void find_half_space(const Grid<D>& grid, const Planes<D>& planes, int body, double time);
  void find_outline(const Grid<D>& grid, const Planes<D>& planes, int body, double time);
  void add_point(const Grid<D>& grid, const Planes<D>& planes, int body, double time, const Vec<D>& at,
                 const Vec<D>& normal);
  static void add_node(const Grid<D>& grid, const Planes<D>& planes, const typename Grid<D>::Index& node, double weight,
                       SurfacePoint& point);
  void hold(SurfacePoint& point, const Grid<D>& grid, double time);
  void hold_surface(Grid<D>& grid, double time, bool end);
  /// What it changes the velocity by.
  Vec<D> meet(const Contact& contact, const Vec<D>& speed, double* velocity) const;
  void book(int body, const Node<D>& node, int component, double impulse);
  std::vector<Contact> contacts_;
  std::vector<SurfacePoint> surface_;
  std::vector<unsigned char> touched_;  ///< by node, of the body that is looked at: its faces with soil against them
  int sweeps_ = 1;
};

}  // namespace mpm
