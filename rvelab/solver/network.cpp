// Rve::network: the contact network as a value. Declared in rve.hpp.
#include <Eigen/Geometry>
#include <cmath>

#include "rvelab/solver/assembly/contact_stiffness.hpp"
#include "rvelab/solver/assembly/memory_order.hpp"
#include "rvelab/solver/assembly/pair_geometry.hpp"
#include "rvelab/solver/resting.hpp"
#include "rvelab/solver/rve.hpp"
#include "rvelab/solver/rve_impl.hpp"

namespace rvelab {

namespace {

/// Elastic stiffnesses and energies of a touching contact, from its pair parameters and history.
void set_elastic(const Fixture& f, const PairTable& pairs, std::size_t p, ContactState& c) {
  const PairParameters q = parameters_of(f, pairs, p);
  with_force(f, [&](auto force) {
    using Force = decltype(force);
    const ContactStiffness k = stiffness_of<Force>(f, q, c.overlap);
    c.normal_stiffness = k.normal;
    c.tangential_stiffness = k.tangential;
    c.rolling_stiffness = k.rolling;
    c.pressing_force = Force::pressing_force(c.normal_force, q.law_constant);
    c.elastic_energy = Force::normal_energy(q.kn, c.overlap, std::sqrt(c.overlap), q.law_constant);
  });
  double spring = 0;
  for (int k = 0; k < f.tangential_components(); ++k) spring += pairs.tangential[k][p] * pairs.tangential[k][p];
  if (c.tangential_stiffness > 0) c.elastic_energy += 0.5 * spring / c.tangential_stiffness;
  if (c.rolling_stiffness > 0) c.elastic_energy += 0.5 * c.rolling_moment.squaredNorm() / c.rolling_stiffness;
}

Network network_of(const Fixture& f, const Assembly& a) {
  Network net;
  net.shape = f.shape;
  net.cell = a.cell;
  net.model = f.contact;
  net.reference_contact_force = a.state.reference_contact_force;
  net.reference_pressure = a.state.reference_pressure;
  net.quasi_static = a.state.quasi_static;
  if (!net.quasi_static) net.mean_spin = a.state.mean_spin;
  net.grains.resize(f.size());
  for (std::size_t g = 0; g < f.size(); ++g)
    net.grains[g] = {
        f.radius[g],  f.mass[g],       f.inertia[g],   a.position(f, g), a.velocity(f, g) - a.state.mean_velocity,
        a.spin(f, g), Vector3::Zero(), Vector3::Zero()};
  const PairGeometry<2> in_plane(f, a);
  const PairGeometry<3> in_space(f, a);
  for (const std::int32_t place : a.pairs.order) {
    const auto p = std::size_t(place);
    const auto i = a.pairs.i[p], j = a.pairs.j[p];
    const auto [branch, length, overlap] = f.shape == Shape::disc ? in_plane(p) : in_space(p);
    if (!(overlap > 0)) continue;
    const Vector3 b(branch.x, branch.y, branch.z);
    ContactState c;
    c.i = i;
    c.j = j;
    c.image = a.pairs.image[p];
    c.branch = b;
    c.length = length;
    c.normal = b / length;
    c.overlap = overlap;
    const Vector3 force = force_of(f, a.pairs, p);
    c.normal_force = force.dot(c.normal);
    c.tangential_force = force - c.normal_force * c.normal;
    c.rolling_moment.setZero();
    if (f.contact.rolling) {
      if (f.shape == Shape::disc)
        c.rolling_moment[2] = a.pairs.moment[0][p];
      else
        c.rolling_moment = {a.pairs.moment[0][p], a.pairs.moment[1][p], a.pairs.moment[2][p]};
      c.moment_cap = a.pairs.moment_cap[p];
    }
    c.friction = a.pairs.friction[p];
    set_elastic(f, a.pairs, p, c);
    net.grains[std::size_t(i)].resultant -= force;
    net.grains[std::size_t(j)].resultant += force;
    const Vector3 turning = c.normal.cross(c.tangential_force);
    net.grains[std::size_t(i)].torque -= (f.radius[i] - 0.5 * overlap) * turning + c.rolling_moment;
    net.grains[std::size_t(j)].torque -= (f.radius[j] - 0.5 * overlap) * turning - c.rolling_moment;
    net.contacts.push_back(c);
  }
  return in_id_order(std::move(net), a.state.memory_order);
}

}  // namespace

Network Rve::network() const {
  return brought_up_to_date(*impl_, [](const Impl& m) { return network_of(m.fixture, m.now); });
}

}  // namespace rvelab
