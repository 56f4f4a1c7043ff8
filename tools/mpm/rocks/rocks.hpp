// Free rigid bodies in the soil and on it: discrete elements beside material points (Li et al. 2023). Rocks touch each
// other, boundaries and prescribed bodies by contact.hpp, in sub-steps of their own; forces of the soil are constant
// over them, so that its impulse is exact. Points of soil touch a rock at its surface (touching.cpp, surface.cpp) or as
// balls (ghosts.cpp).
//
// Everything is done in the order of the rocks' numbers. Contacts among rocks run on one thread: rocks are few beside
// the points.
#pragma once

#include <limits>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "tools/mpm/bodies/bodies.hpp"
#include "tools/mpm/rocks/contact.hpp"
#include "tools/mpm/rocks/rigid.hpp"

namespace mpm {

template <int D>
struct Rock {
  std::string name;             ///< its own, or that of its group
  bool single = true;           ///< it has a name of its own
  int material = 0, shape = 0;  ///< numbers in Rocks
  Rigid<D> body;
  /// N s and N m s, of the soil over the step that is made, and its mean force and torque, N and N m.
  Vec<D> impulse = Vec<D>::Zero(), soil_force = Vec<D>::Zero();
  Spin<D> angular_impulse = Spin<D>::Zero(), soil_torque = Spin<D>::Zero();
  Vec<D> mean_velocity = Vec<D>::Zero();  ///< m/s and rad/s, over the step before, beside balls
  Spin<D> mean_spin = Spin<D>::Zero();
  /// N and N m, of rocks and walls: at the end of the sub-step before, and their means over the step before.
  Vec<D> force = Vec<D>::Zero(), mean_force = Vec<D>::Zero();
  Spin<D> torque = Spin<D>::Zero(), mean_torque = Spin<D>::Zero();
  Vec<D> soil_impulse = Vec<D>::Zero();  ///< N s, since the start

  Placed<D> placed(const std::vector<RockShape<D>>& shapes) const {
    return {&shapes[std::size_t(shape)], body.centre, body.orientation};
  }
};

/// What rocks touch that is no rock: boundaries, then prescribed bodies.
template <int D>
struct Wall {
  const Body<D>* body = nullptr;                           ///< none: a plane
  Vec<D> point = Vec<D>::Zero(), normal = Vec<D>::Zero();  ///< of a plane, into the soil
  Vec<D> velocity = Vec<D>::Zero();                        ///< m/s
  bool follows_material = true;                            ///< its friction is the rock's; else:
  double friction = 0;
  double mass = std::numeric_limits<double>::infinity();  ///< kg
  double acceleration = 0;                                ///< m/s^2, that the pressure on a plate gives it alone
  bool there = true;
  int number = 0;  ///< of the body
};

/// Cells between the points of a rock's surface: as many as nodes move them. At half a cell the sweeps do not end, and
/// the soil of a mixture at rest left its rocks: 4 to 9 % of volume in 20 ms, here 0.4 %.
constexpr double outline_spacing = 1;

struct NoPlates {
  template <class Forces>
  void kick(const Forces&, double) const {}
  void drift(double) const {}
};

/// J, of all rocks.
struct RockEnergy {
  double kinetic = 0, potential = 0;
  double springs = 0;                   ///< of contacts of rocks and walls
  double contact_loss = 0;              ///< to friction and dashpots among them
  double soil_work = 0, wall_work = 0;  ///< on the rocks
  double residual = 0;                  ///< error of the time integration
};

template <int D>
class Rocks {
 public:
  std::vector<RockMaterial> materials;
  std::vector<RockShape<D>> shapes;
  struct SurfacePlace {
    Vec<D> at, normal;  ///< m, from the centre, along the principal axes
  };
  /// Points of the surface of a shape, about this far apart (m); kept. Not for several threads.
  const std::vector<SurfacePlace>& outline(int shape, double spacing);
  /// Those that are kept.
  const std::vector<SurfacePlace>& kept_outline(int shape) const { return outlines_[std::size_t(shape)]; }
  std::vector<Rock<D>> all;
  RockSoil soil;
  double thickness = 1;             ///< m, of the plane
  double steps_per_collision = 50;  ///< sub-steps of the shortest collision
  double first_energy = 0;          ///< J, of all rocks at the start
  double contact_loss = 0, soil_work = 0, wall_work = 0;
  double work_on_soil = 0;   ///< J, of rocks on the soil
  double ghost_mapping = 0;  ///< J, of balls: what steps of their forces differ by from the springs' work (ghosts.cpp)
  double surface_loss = 0;   ///< J, of impulses at the surface: friction, and soil that meets a rock
  double wall_power = 0;     ///< W, of moving walls at the end of the sub-step before
  std::vector<Vec<D>> wall_impulse;  ///< N s, of the rocks on each wall
  std::vector<Vec<D>> wall_force;    ///< N, of the rocks on each wall at the end of the sub-step before
  /// Wall time: of rocks among themselves; of soil against them (detection and sweeps, at the surface those over bodies
  /// too).
  double seconds = 0, soil_seconds = 0;
  long sub_steps = 0, touching = 0;  ///< since the start; contacts of rocks and walls now
  long soil_contacts = 0;            ///< with points or surface points of soil, at the last step

  long left_out = 0;           ///< points that would have stood in rocks at the start
  double left_out_volume = 0;  ///< m^3, of soil, with what was cut from others

  /// Shapes of bodies as rocks need them; after any change of bodies.
  void prepare_walls(const Bodies<D>& bodies);
  /// m, of a position from the surface of a rock; where it is more than `reach`, some distance beyond that.
  double distance(const Rock<D>& rock, const Vec<D>& position, double reach) const;
  /// Pairs of rocks whose bounding spheres are this near (m) or nearer, in order.
  std::vector<std::pair<int, int>> rocks_within(double margin) const;
  /// Finds what may touch within a step of dt (s). `walls`: those at the time now.
  void find_candidates(const std::vector<Wall<D>>& walls, const Vec<D>& gravity, double dt);
  /// A step under gravity (m/s^2), the soil's forces and contacts; `walls(t)`: those at a time in s. `plates`: the
  /// walls that rocks move, which take part in the sub-steps.
  template <class Walls, class Plates = NoPlates>
  void advance(const Walls& walls, const Vec<D>& gravity, double time, double dt, const Plates& plates = {}) {
    const std::vector<Wall<D>> now = walls(time);
    find_candidates(now, gravity, dt);
    const long n = sub_steps_for(now, gravity, dt);
    take_impulses(dt);
    if (soil.ghosts) clear_means();
    for (long k = 0; k < n; ++k) {
      kick(gravity, 0.5 * dt / double(n));
      plates.kick(wall_force, 0.5 * dt / double(n));
      if (soil.ghosts) add_to_means(1.0 / double(n));
      for (auto& rock : all) rock.body.drift(dt / double(n));
      plates.drift(dt / double(n));
      book_soil_work(dt / double(n));
      contact_forces(walls(time + dt * double(k + 1) / double(n)), dt / double(n), 1.0 / double(n));
      kick(gravity, 0.5 * dt / double(n));
      plates.kick(wall_force, 0.5 * dt / double(n));
    }
    if (soil.ghosts) book_ghosts(dt);
    sub_steps += n;
  }
  RockEnergy energy(const Vec<D>& gravity) const;
  /// m/s, of the fastest point of a rock, and of all.
  double surface_speed(const Rock<D>& rock) const;
  double fastest() const;

  /// A point of a rock's surface that soil touches, or may within a step.
  struct Touched {
    SurfacePoint<D> soil;  ///< its owner: the number of the rock
    Vec<D> r;              ///< m, from the centre of the rock
    Mat<D> mobility;       ///< m/s of N s, of soil and rock together
    Mat<D> resistance;     ///< its inverse
    double gap;            ///< m, to the soil
    std::size_t index;     ///< number in the outline of the rock; at_node: it is a node in the rock
  };
  static constexpr std::size_t at_node = std::size_t(-1);
  /// N, of each rock at each point of its outline on the soil, at the end of the step before, along its principal
  /// axes: what the sweeps over surface points start from.
  std::vector<std::vector<Vec<D>>> pressed;
  std::vector<Touched> surface;  ///< rock by rock
  int sweeps = 0;                ///< that it asks for
  /// Velocities of a rock as impulses of the soil change them over the step.
  struct Motion {
    Vec<D> velocity;
    Spin<D> spin;
  };
  std::vector<Motion> motion;
  double step = 0;  ///< s, of the step that is made
  // touching.cpp
  /// Finds `surface`; none with ghosts. shape: that of the grid.
  void detect_soil(const Grid<D>& grid, const Planes<D>& planes, Shape shape, const std::vector<Point<D>>& soil,
                   rvelab::Workers& workers);
  // surface.cpp
  /// Velocities that rocks have now; impulses of the start change them.
  void start_motion();
  /// As free bodies at the end of the step, before the soil acts.
  void predict_motion(const Vec<D>& gravity, double dt);
  /// Gives a point of `surface` the impulse of the step before.
  void press(std::size_t point, Grid<D>& grid);
  /// What was given is forgotten; what the sweeps found is kept.
  void forget_pressed();
  void keep_pressed();
  /// Holds the soil at a point of `surface`, with the impulses at the others as they are now.
  void hold(std::size_t point, Grid<D>& grid, bool end);
  /// Impulse and work on the soil, and what the rocks get of it.
  void book_surface(const Grid<D>& grid, const Planes<D>& planes);

  struct Pair {
    int first, second;  ///< second: a rock, or the number of rocks and that of the wall
    RockPair<D> constants;
    RockContact<D> contact;
    double clearance = 0;  ///< m, that the two must move before they can touch
  };
  std::vector<Pair> pairs;  ///< in the order of (first, second)
  /// A point of soil as a ball that touches a rock.
  struct Ghost {
    long point = 0;
    int rock = 0;
    Vec<D> normal, arm;  ///< from the rock to the point; m, from the point to the contact
    double overlap = 0;  ///< m
    Vec<D> force;        ///< N, on the soil
    /// m/s, of the soil at the contact, at the start and then at the end of a step: what moved it since the step
    /// before.
    Vec<D> velocity;
    Vec<D> from_centre, moved;  ///< of the rock at the contact: m, and m/s, its mean velocity over the step before
    bool lasts = false;         ///< touched in the step before
    RockContact<D> contact;
  };
  std::vector<Ghost> ghosts;  ///< in the order of (point, rock)
  std::vector<double> balls;  ///< m, radius of each point as a ball
  /// Of the next point. One that would overlap a rock is made so small that it touches it; a grain may by a twentieth.
  void add_ball(const Point<D>& point, double radius, bool grain);
  /// While points are placed: rocks that took the place of some, and balls with no other between them and a rock, that
  /// rock, and m from their middle to it.
  struct Beside {
    std::size_t ball;
    int rock;
    double gap;
  };
  std::set<int> displacing;
  std::vector<Beside> beside;
  // ghosts.cpp
  /// Finds `ghosts` and their forces, and gives the rocks their part. supports: of the points on the grid.
  void touch_ghosts(const Grid<D>& grid, const std::vector<Point<D>>& points, const std::vector<Support<D>>& supports,
                    double dt);
  /// The part of the soil, to its nodes.
  void give_ghost_forces(Grid<D>& grid, const std::vector<Support<D>>& supports) const;
  /// J, on the soil over a step: of the forces over the mean velocities of the step. The soil at contacts then has the
  /// velocity of its end.
  double ghost_work(const Grid<D>& grid, const std::vector<Support<D>>& supports, double dt);
  double ghost_loss = 0;         ///< J, to friction with ghosts
  double ghost_springs() const;  ///< J, in the contacts with ghosts now
  double ghost_frequency = 0;    ///< 1/s, of the stiffest contact with a ghost that is or may come within a step
  /// Contacts that go on take their memory along from `ghosts`.
  void keep_ghosts(std::vector<Ghost>& now);
  RockPair<D> ghost_constants(int rock, double radius) const;

  /// Gap (m) of a rock and a wall, normal from the rock to the wall.
  Gap<D> gap_to(const Rock<D>& rock, const Wall<D>& wall) const;
  RockPair<D> constants_of(int first, int second, const Wall<D>* wall) const;

 private:
  long sub_steps_for(const std::vector<Wall<D>>& walls, const Vec<D>& gravity, double dt) const;
  void take_impulses(double dt);
  void kick(const Vec<D>& gravity, double dt);
  void book_soil_work(double dt);
  void clear_means();
  void book_ghosts(double dt);
  void add_to_means(double share);
  void contact_forces(const std::vector<Wall<D>>& walls, double dt, double share);
  struct FoundOnRock;
  void push(std::size_t point, const Vec<D>& impulse, Grid<D>& grid, bool end);

  std::vector<Spin<D>> spins_;                           ///< rad/s, and
  std::vector<double> speeds_;                           ///< m/s of the surface, in this sub-step
  std::vector<std::optional<RockShape<D>>> box_shapes_;  ///< of bodies that are boxes, in space
  std::vector<std::vector<SurfacePlace>> outlines_;      ///< by shape
};

/// m, of a point as a ball: of its solids, and no larger than its domain. A ball of all of a domain's volume would
/// stand out of a flat surface by an eighth of the distance between points.
template <int D>
double ghost_radius(const Point<D>& point, double porosity) {
  const double solids = (1 - porosity) * point.half.prod() * (D == 2 ? 4 : 8);
  const double radius = D == 2 ? std::sqrt(solids / std::numbers::pi) : std::cbrt(0.75 / std::numbers::pi * solids);
  return std::min(radius, point.half.minCoeff());
}

/// Boundaries, then bodies, as rocks meet them at a time (s).
template <int D>
std::vector<Wall<D>> walls_at(const Grid<D>& grid, const Planes<D>& planes, const Bodies<D>& bodies, double time);

}  // namespace mpm
