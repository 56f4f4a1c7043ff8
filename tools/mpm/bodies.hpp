// Rigid bodies with a prescribed velocity: half-space (a base with friction), box (footing, plate), disc (pipe; in
// space a cylinder along z). Each has a velocity field of its own at the nodes inside it; where the soil's field
// approaches it, the two meet: without penetration, rough (no slip) or with Coulomb friction, free to part. What the
// soil gets, the body gets with the other sign.
#pragma once

#include <string>
#include <vector>

#include "tools/mpm/planes.hpp"

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
  VelocityHistory<D> velocity;
  Reaction<D> reaction;

  /// Distance from the surface, negative inside, and the outward normal there.
  double distance(const Vec<D>& position, double time, Vec<D>& outward) const;
};

template <int D>
class Bodies {
 public:
  std::vector<Body<D>> all;

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
  /// What it changes the velocity by.
  Vec<D> meet(const Contact& contact, const Vec<D>& speed, double* velocity) const;
  std::vector<Contact> contacts_;
};

}  // namespace mpm
