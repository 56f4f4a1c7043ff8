// Rigid bodies with a prescribed velocity (shapes.hpp), and plates under pressure (plate.hpp). Where the
// soil's velocity approaches that of a body, the body stops it at its surface: rough (no slip) or with Coulomb
// friction, free to part. The reaction on the body is equal and opposite.
//
// Contact at nodes: each node inside the body is held by itself. Contact at the surface: the soil's velocity sum N_I
// v_I is held at points of the surface, a cell apart, by impulses J that the nodes get as N_I J. A uniform stress is
// then in balance at every node, also with shape functions that reach beyond the surface: its nodal forces are N_I t, t
// the traction. At nodes alone the first row outside is left with N_I t (quadratic: t/8), and a body's outline is that
// of the nodes inside it. The impulses of points that share nodes are found in sweeps (projected Gauss-Seidel); points
// that have a column of nodes each need one sweep. The sweeps are those of the step, over rocks too
// (step/contact.hpp); a body holds the soil at one of its points.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "rvelab/threads/workers.hpp"
#include "tools/mpm/bodies/planes.hpp"
#include "tools/mpm/bodies/plate.hpp"
#include "tools/mpm/bodies/shapes.hpp"
#include "tools/mpm/bodies/surface_point.hpp"
#include "tools/mpm/grid/point.hpp"

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
class Bodies {
 public:
  std::vector<Body<D>> all;
  Shape shape = Shape::bspline;          ///< that of the grid
  std::vector<SurfacePoint<D>> surface;  ///< that soil touches, body by body
  int sweeps = 1;                        ///< over them: more where they share nodes

  /// Detects contact at this time (s): the points of surfaces that soil touches, and the nodes in bodies with contact
  /// at nodes. Mirror nodes are left out: they follow their images.
  void detect_contact(const Grid<D>& grid, const Planes<D>& planes, const std::vector<Point<D>>& soil, double time,
                      rvelab::Workers& workers);
  /// Holds the nodes: velocities v at the start of the step, w at its end; a is still the mapped velocity.
  void hold_nodes(Grid<D>& grid, double time, bool end);
  /// Holds the soil at one point of a surface, with the impulses at the others as they are now. Plates are left to
  /// hold_plates.
  void hold(SurfacePoint<D>& point, Grid<D>& grid, double time, bool end) const;
  /// The reaction of a component that a plane holds at a node is the plane's, not the body's.
  void book_reactions(const Grid<D>& grid, const Planes<D>& planes);
  // plate.cpp
  /// Areas of the plates under pressure at this time (s), and whether it still acts. Without plates nothing is done.
  void place_plates(const Grid<D>& grid, const Planes<D>& planes, double time);
  /// Their velocities at the end of the step before the soil acts, and the force on them but for the rocks'.
  void predict_plates(double time, double dt);
  /// All points of the plates under pressure together.
  void hold_plates(Grid<D>& grid, bool end);
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
  static constexpr long chunk = 1024;  ///< points or nodes of one piece of work
  template <class Outline>
  void detect_soil(const Grid<D>& grid, const Outline& outline, const Vec<D>& centre, const std::vector<Point<D>>& soil,
                   rvelab::Workers& workers);
  void detect_surface(const Grid<D>& grid, const Planes<D>& planes, const std::vector<Point<D>>& soil, int body,
                      double time, rvelab::Workers& workers);
  void detect_nodes(const Grid<D>& grid, const Planes<D>& planes, double time, rvelab::Workers& workers);
  bool has_soil_near(const Grid<D>& grid, const typename Grid<D>::Index& node, unsigned char face) const;
  void hold_point(const Grid<D>& grid, const Planes<D>& planes, SurfacePoint<D>& point, double time, const Vec<D>& at,
                  unsigned char face);
  void hold_in_column(const Grid<D>& grid, const Planes<D>& planes, SurfacePoint<D>& point, double time,
                      const Vec<D>& at, unsigned char face, int axis);
  void keep(SurfacePoint<D>& point, const Grid<D>& grid, double time);
  /// N s along the surface, as much as friction gives for that across it.
  static Vec<D> along_surface(const Body<D>& body, const SurfacePoint<D>& point, const Vec<D>& wanted, double across);
  void start_plates();
  void hold_plate(Body<D>& body, Grid<D>& grid, bool end);
  /// Stops the soil at a node; the change of its velocity.
  Vec<D> stop(const Contact& contact, double time, double* velocity) const;
  void book(int body, const Node<D>& node, int component, double at_start, double at_end);
  std::vector<Contact> contacts_;
  std::vector<SurfaceMobility> met_;    ///< of one plate at a time
  std::vector<unsigned char> soil_at_;  ///< by node, for one body at a time: its faces that soil near the node touches
};

}  // namespace mpm
