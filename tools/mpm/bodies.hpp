// Rigid bodies with a prescribed velocity (shapes: body_shapes.hpp), and plates under pressure (plate.hpp). Where the
// soil's velocity approaches that of a body, the body stops it at its surface: rough (no slip) or with Coulomb
// friction, free to part. The reaction on the body is equal and opposite.
//
// Contact at nodes: each node inside the body is held by itself. Contact at the surface: the soil's velocity sum N_I
// v_I is held at points of the surface, a cell apart, by impulses J that the nodes get as N_I J. A uniform stress is
// then in balance at every node, also with shape functions that reach beyond the surface: its nodal forces are N_I t, t
// the traction. At nodes alone the first row outside is left with N_I t (quadratic: t/8), and a body's outline is that
// of the nodes inside it. The impulses of points that share nodes are found in sweeps (projected Gauss-Seidel); points
// that have a column of nodes each need one sweep.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/mpm/body_shapes.hpp"
#include "tools/mpm/planes.hpp"
#include "tools/mpm/plate.hpp"
#include "tools/mpm/point.hpp"
#include "tools/mpm/shape.hpp"
#include "tools/mpm/workers.hpp"

namespace mpm {

template <int D>
struct Body {
  std::string name;
  BodyShape<D> shape;
  Vec<D> centre = Vec<D>::Zero();  ///< m, at time 0
  bool rough = true;               ///< no slip while it is pressed
  double friction = 0;             ///< coefficient, where it is not rough
  bool at_surface = false;         ///< contact at the surface, not at nodes
  VelocityHistory<D> velocity;     ///< prescribed
  std::optional<Plate> plate;      ///< under pressure, up to a time
  Reaction<D> reaction;

  bool pressed() const { return plate && plate->free(); }
  const Vec<D>& plate_normal() const { return std::get<HalfSpace<D>>(shape).normal; }
  int plate_axis() const { return std::get<HalfSpace<D>>(shape).column_axis(); }
  /// m/s and m, at a time in s; of a plate under pressure as they are now.
  Vec<D> velocity_at(double time) const { return pressed() ? plate->velocity * plate_normal() : velocity.at(time); }
  Vec<D> displacement_at(double time) const {
    if (!plate) return velocity.displacement(time);
    const Vec<D> pushed = plate->displacement * plate_normal();
    if (plate->free()) return pushed;
    return pushed + velocity.displacement(time) - velocity.displacement(plate->held_from);
  }
  Vec<D> centre_at(double time) const { return centre + displacement_at(time); }
  /// As the distance of its shape.
  double distance(const Vec<D>& r, Vec<D>& outward, const Vec<D>& unit = Vec<D>::Ones()) const {
    return std::visit([&](const auto& any) { return any.distance(r, outward, unit); }, shape);
  }
};

template <int D>
class Rocks;

template <int D>
class Bodies {
 public:
  std::vector<Body<D>> all;
  Shape shape = Shape::bspline;  ///< that of the grid
  Rocks<D>* rocks = nullptr;     ///< met at their surface as well, where there are any

  /// Detects contact at this time (s): the points of surfaces that soil touches, and the nodes in bodies with contact
  /// at nodes. Mirror nodes are left out: they follow their images.
  void detect_contact(const Grid<D>& grid, const Planes<D>& planes, const std::vector<Point<D>>& soil, double time,
                      Workers& workers);
  /// Velocities v at the start of the step.
  void set_start(Grid<D>& grid, double time);
  /// Rocks with the velocities that they have now; impulses of the start change them.
  void start_rocks();
  /// Rocks as free bodies at the end of the step: their velocities before the soil acts.
  void predict_rocks(const Vec<D>& gravity, double dt);
  /// Velocities w at the end of the step; a is still the mapped velocity. The reaction of a component that a plane
  /// holds at a node is the plane's, not the body's.
  void set_end(Grid<D>& grid, const Planes<D>& planes, double time) {
    hold_end(grid, time);
    book_reactions(grid, planes);
  }
  /// The two halves of it, for steps that hold velocities more than once.
  void hold_end(Grid<D>& grid, double time);
  void book_reactions(const Grid<D>& grid, const Planes<D>& planes);
  // plate.cpp
  /// Areas of the plates under pressure at this time (s), and whether it still acts. Without plates nothing is done.
  void place_plates(const Grid<D>& grid, const Planes<D>& planes, double time);
  /// Their velocities at the end of the step before the soil acts, and the force on them but for the rocks'.
  void predict_plates(double time, double dt);
  void sum_plate_forces(const Grid<D>& grid, double time, double dt);
  /// Leap-frog under that and the forces of rocks on each body (N, from the first one on).
  void kick_plates(const std::vector<Vec<D>>& rock_forces, std::size_t first, double dt);
  void drift_plates(double dt);
  void end_plates(double dt);

 private:
  struct Contact {
    long node;
    int body;
    Vec<D> normal;
    /// m/s, what this body alone changed the soil's velocity by: at the start, at the end of the step.
    Vec<D> at_start, at_end;
  };
  static constexpr int reach = D == 2 ? 9 : 27;
  static constexpr long chunk = 1024;  ///< points or nodes of one piece of work
  /// A point of a surface: the nodes that reach it, and their weights there, of sum 1.
  struct SurfacePoint {
    int body;  ///< from the number of bodies on: a rock
    Vec<D> normal;
    long node[reach];
    double weight[reach];
    int count = 0;
    double mobility = 0;  ///< m/s of N s: sum of weight^2/mass
    /// N s, of the body on the soil: while the sweeps go on, at the start, at the end of the step.
    Vec<D> now, at_start, at_end;
  };
  template <class Outline>
  void detect_soil(const Grid<D>& grid, const Outline& outline, const Vec<D>& centre, const std::vector<Point<D>>& soil,
                   Workers& workers);
  void detect_surface(const Grid<D>& grid, const Planes<D>& planes, const std::vector<Point<D>>& soil, int body,
                      double time, Workers& workers);
  void detect_nodes(const Grid<D>& grid, const Planes<D>& planes, double time, Workers& workers);
  bool has_soil_near(const Grid<D>& grid, const typename Grid<D>::Index& node, unsigned char face) const;
  int surface_weights(double xi, double* weight) const;
  void hold_point(const Grid<D>& grid, const Planes<D>& planes, SurfacePoint& point, double time, const Vec<D>& at,
                  unsigned char face);
  bool hold_at(const Grid<D>& grid, const Planes<D>& planes, SurfacePoint& point, double time, const Vec<D>& at);
  void hold_in_column(const Grid<D>& grid, const Planes<D>& planes, SurfacePoint& point, double time, const Vec<D>& at,
                      unsigned char face, int axis);
  static void add_node(const Grid<D>& grid, const Planes<D>& planes, const typename Grid<D>::Index& node, double weight,
                       SurfacePoint& point);
  bool hold(SurfacePoint& point, const Grid<D>& grid, double time);
  void hold_surface(Grid<D>& grid, double time, bool end);
  void hold_here(std::size_t k, Grid<D>& grid, double time, bool end);
  /// Points [first, last) of surface_, of one body.
  struct Run {
    std::size_t first, last;
  };
  void order_runs(const Grid<D>& grid);
  /// visit(run) for all points, to or fro; threads share the runs where there are many.
  template <class Visit>
  void each_run(bool fro, const Visit& visit) {
    if (runs_.empty()) return visit(Run{0, surface_.size()});
    const std::size_t last = runs_.size() - 1;
    workers_->for_each_after(fro ? fro_ : to_,
                             [&](std::int64_t k) { visit(runs_[fro ? last - std::size_t(k) : std::size_t(k)]); });
  }
  Vec<D> velocity_at(const Grid<D>& grid, const SurfacePoint& point, bool end) const;
  /// N s along the surface, as much as friction gives for that across it.
  static Vec<D> along_surface(const Body<D>& body, const SurfacePoint& point, const Vec<D>& wanted, double across);
  void push(Grid<D>& grid, SurfacePoint& point, const Vec<D>& impulse, bool end) const;
  // plate.cpp
  void start_plates();
  void hold_plate(Body<D>& body, Grid<D>& grid, bool end);
  // rock_surface.cpp
  struct RockFound;
  void detect_rocks(const Grid<D>& grid, const Planes<D>& planes, const std::vector<Point<D>>& soil);
  void press_rocks(Grid<D>& grid);
  void keep_pressed();
  void push_rock(std::size_t k, const Vec<D>& impulse, Grid<D>& grid, bool end);
  void hold_rock(std::size_t k, Grid<D>& grid, bool end);
  void book_rocks(const Grid<D>& grid, const Planes<D>& planes);
  /// Stops the soil at a node; the change of its velocity.
  Vec<D> stop(const Contact& contact, double time, double* velocity) const;
  /// J, of impulses (N s) of one component at the start and at the end of the step, over the changes of the velocity
  /// there.
  static double work_at(const Node<D>& node, int i, double at_start, double at_end) {
    return 0.5 * (at_start * (node.a[i] + node.v[i]) + at_end * (node.v[i] + node.w[i]));
  }
  void book(int body, const Node<D>& node, int component, double at_start, double at_end);
  std::vector<Contact> contacts_;
  std::vector<SurfacePoint> surface_;
  std::vector<SurfaceMobility> met_;    ///< of one plate at a time
  std::vector<unsigned char> soil_at_;  ///< by node, for one body at a time: its faces that soil near the node touches
  int sweeps_ = 1;
  Workers* workers_ = nullptr;  ///< those of detect_contact
  /// Of two runs that share a node the later one comes after the other: that is the same as one point after the other,
  /// to the bit. First those that come after none, then those that come after these alone, and so on. None: one run.
  std::vector<Run> runs_;
  WorkOrder to_, fro_;           ///< of runs_, and of runs_ from the last to the first
  std::vector<int> visited_by_;  ///< by node: the last run so far
};

}  // namespace mpm
