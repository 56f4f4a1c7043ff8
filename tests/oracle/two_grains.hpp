// Two grains alone in a large cell: how they collide, and what is between them on prescribed paths.
#pragma once

#include <memory>

#include "tests/specimens.hpp"

namespace rvelab::test {

/// Two equal grains of diameter 0.2 m on the x axis, `gap` apart (negative: overlapping), at speed `speed` towards each
/// other in sum.
struct Collision {
  double duration = 0, restitution = 0;
};

inline double mass_of(const Specimen& s) {
  return s.materials[0].density * grain_volume(s.shape, s.grains.radius[0], s.cell.lattice(2, 2));
}

inline Specimen two_grains(Shape shape, const Material& material, Law law, double gap) {
  Specimen s = empty_specimen(shape, 5.0, material, law);
  // Off the middle, so that neither coordinate is special.
  const Vector3 middle(0.3, -0.2, shape == Shape::disc ? 0.0 : 0.1);
  add_grain(s, middle - Vector3(0.1 + 0.5 * gap, 0, 0), 0.1);
  add_grain(s, middle + Vector3(0.1 + 0.5 * gap, 0, 0), 0.1);
  return s;
}

inline double gap_of(const Rve& rve) {
  const Specimen s = rve.specimen();
  return (s.grains.position[1] - s.grains.position[0]).norm() - 0.2;
}

/// Time in contact and ratio of speeds: the free flights before and after are straight, so that the instants of
/// touching and parting follow from them exactly.
inline Collision collide(Specimen s, double speed, double expected_duration, int steps_in_contact) {
  const double gap = 0.37 * speed * expected_duration;
  const Specimen placed = two_grains(s.shape, s.materials[0], s.contact.law, gap);
  s.grains = placed.grains;
  s.solver.fixed_time_step = expected_duration / steps_in_contact;
  Rve rve(s);
  rve.set_velocities({Vector3(0.5 * speed, 0, 0), Vector3(-0.5 * speed, 0, 0)}, {Vector3::Zero(), Vector3::Zero()});
  const double time = 2.2 * expected_duration;
  rve.apply(Matrix3::Zero(), time);
  const Specimen after = rve.specimen();
  const double parting = (after.grains.velocity[1] - after.grains.velocity[0]).x();
  REQUIRE(gap_of(rve) > 0);
  return {time - gap_of(rve) / parting - gap / speed, parting / speed};
}

/// Two grains so heavy that no contact force turns or moves them: velocities are prescribed motions.
class Driven {
 public:
  Driven(Shape shape, Material material, Law law, double overlap, bool rolling = false, bool unload_rescale = true) {
    material.density = 1e30;
    Specimen s = two_grains(shape, material, law, -overlap);
    s.contact.rolling = rolling;
    s.contact.unload_rescale = unload_rescale;
    s.solver.fixed_time_step = 1e-3;
    rve_ = std::make_unique<Rve>(s);
  }
  /// Closes the contact by `closing` and turns the grains by `turn_i`, `turn_j` about z (rad), over `steps` steps.
  ContactState drive(double closing, double turn_i, double turn_j, int steps = 200) {
    const double time = steps * 1e-3;
    const Vector3 v(0.5 * closing / time, 0, 0);
    rve_->set_velocities({v, -v}, {Vector3(0, 0, turn_i / time), Vector3(0, 0, turn_j / time)});
    rve_->apply(Matrix3::Zero(), time);
    const Network n = rve_->network();
    REQUIRE(n.contacts.size() == 1);
    return n.contacts[0];
  }

 private:
  std::unique_ptr<Rve> rve_;
};

}  // namespace rvelab::test
