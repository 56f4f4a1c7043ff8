// Two bonded grains, so heavy that forces do not move them: what they do is prescribed, to the last bit.
#pragma once

#include "tests/interaction/bonded.hpp"

namespace rvelab::test::bonded {

constexpr double ri = 0.5, rj = 0.4, l0 = 1.0, bond_radius = 0.3, kn = 2e6, ks = 0.7e6, step = 1e-3;

inline const Vector3 none(0, 0, 0);

/// Branch along x; the gap of 0.1 keeps the grains apart, so that nothing but the bond acts.
template <class Law>
Rve pair_with(Shape shape, const std::vector<double>& columns, double friction = 0.5) {
  Material heavy = linear_material(1e6, 1e6, friction);
  heavy.density = 1e40;
  Specimen s = empty_specimen(shape, 10, heavy);
  s.solver.fixed_time_step = step;
  add_grain(s, {-0.5 * l0, 0, 0}, ri);
  add_grain(s, {0.5 * l0, 0, 0}, rj);
  Interaction<Law> bond;
  bond.i = 0;
  bond.j = 1;
  take_columns<Law>(columns.data(), bond);
  static_cast<ListOf<Law>&>(s).items.push_back(bond);
  return Rve(s);
}
/// An elastic beam; its strengths are 0.
template <class Law>
std::vector<double> beam_columns() {
  std::vector<double> columns(interaction_columns<Law>());
  columns[Law::length] = l0;
  columns[Law::radius] = bond_radius;
  columns[Law::normal_stiffness] = kn;
  columns[Law::shear_stiffness] = ks;
  return columns;
}
/// Of the only bond.
template <class Law>
double column_of(const Rve& rve, int k) {
  const Interactions all = rve.interactions();
  double columns[interaction_columns<Law>()];
  put_columns<Law>(static_cast<const ListOf<Law>&>(all).items.at(0), columns);
  return columns[k];
}

struct Motion {
  Vector3 velocity = Vector3::Zero();  ///< half of that of j against i
  Vector3 spin_i = Vector3::Zero(), spin_j = Vector3::Zero();
};

inline void move(Rve& rve, const Motion& m, long steps) {
  // Equal masses but for the radii: the mean velocity, which is taken out, must be zero.
  const double wi = std::pow(ri, rve.cell().dimension), wj = std::pow(rj, rve.cell().dimension);
  const Vector3 vi = -2 * wj / (wi + wj) * m.velocity, vj = 2 * wi / (wi + wj) * m.velocity;
  rve.set_velocities({vi, vj}, {m.spin_i, m.spin_j});
  rve.apply(Matrix3::Zero(), double(steps) * step);
}

inline double branch_of(const Rve& rve) {
  const Specimen s = rve.specimen();
  return (s.grains.position[1] - s.grains.position[0]).norm();
}

}  // namespace rvelab::test::bonded
