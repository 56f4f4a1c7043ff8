#include "rvelab/solver/assembly/contact_states.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "rvelab/solver/assembly/contact_stiffness.hpp"
#include "rvelab/solver/assembly/interactions.hpp"
#include "rvelab/solver/assembly/memory_order.hpp"
#include "rvelab/solver/assembly/pair_geometry.hpp"

namespace rvelab {

namespace {

/// Elastic stiffnesses and energies of a touching contact, from its pair parameters and history.
void set_elastic(const Model& model, const PairTable& pairs, std::size_t p, double radius_ratio, ContactState& c) {
  const PairParameters q = parameters_of(model, pairs, p);
  with_force(model, [&](auto force) {
    using Force = decltype(force);
    const ContactStiffness k = stiffness_of<Force>(model, q, c.overlap, radius_ratio);
    c.normal_stiffness = k.normal;
    c.tangential_stiffness = k.tangential;
    c.rolling_stiffness = k.rolling;
    c.pressing_force = Force::pressing_force(c.normal_force, q.law_constant);
    c.stiffness_growth = Force::stiffness_growth(c.overlap, q.law_constant);
    c.elastic_energy =
        Force::normal_energy(q.kn, c.overlap, root_of<Force>(q, c.overlap, radius_ratio), q.law_constant);
  });
  double spring = 0;
  for (int k = 0; k < model.tangential_components(); ++k) spring += pairs.tangential[k][p] * pairs.tangential[k][p];
  if (c.tangential_stiffness > 0) c.elastic_energy += 0.5 * spring / c.tangential_stiffness;
  if (c.rolling_stiffness > 0) c.elastic_energy += 0.5 * c.rolling_moment.squaredNorm() / c.rolling_stiffness;
}

/// Normal and arms: the contact point halves the overlap.
void set_arms(const Model& model, const PairPlace& at, ContactState& c) {
  c.normal = c.branch / at.length;
  c.arm_i = (model.radius[std::size_t(c.i)] - 0.5 * at.overlap) * c.normal;
  c.arm_j = -((model.radius[std::size_t(c.j)] - 0.5 * at.overlap) * c.normal);
}
void set_arms(const Model&, const OutlinePlace& at, ContactState& c) {
  c.normal = {at.normal.x, at.normal.y, 0};
  const Vector3 across(-at.normal.y, at.normal.x, 0);
  c.arm_i = (at.reach_i - 0.5 * at.overlap) * c.normal + at.turn_i * across;
  c.arm_j = -((at.reach_j - 0.5 * at.overlap) * c.normal + at.turn_j * across);
}
void set_arms(const Model&, const SolidPlace& at, ContactState& c) {
  c.normal = {at.normal.x, at.normal.y, at.normal.z};
  c.arm_i = {at.point.x, at.point.y, at.point.z};
  c.arm_j = c.arm_i - c.branch;
}

void add_torques(const Model& model, const ContactState& c, const Vector3& force, Network& net) {
  GrainState &i = net.grains[std::size_t(c.i)], &j = net.grains[std::size_t(c.j)];
  if (!model.round()) {
    i.torque -= c.arm_i.cross(force) + c.rolling_moment;
    j.torque += c.arm_j.cross(force) + c.rolling_moment;
    return;
  }
  const Vector3 turning = c.normal.cross(c.tangential_force);
  i.torque -= (i.radius - 0.5 * c.overlap) * turning + c.rolling_moment;
  j.torque -= (j.radius - 0.5 * c.overlap) * turning - c.rolling_moment;
}

/// A touching contact; `at`: where it touches.
template <class Place>
ContactState state_of(const Model& model, const PairTable& pairs, std::size_t p, const Place& at) {
  ContactState c;
  c.i = pairs.i[p];
  c.j = pairs.j[p];
  c.image = pairs.image[p];
  c.branch = {at.branch.x, at.branch.y, at.branch.z};
  c.length = at.length;
  c.overlap = at.overlap;
  set_arms(model, at, c);
  const Vector3 force = force_of(model, pairs, p);
  c.normal_force = force.dot(c.normal);
  c.tangential_force = force - c.normal_force * c.normal;
  c.rolling_moment.setZero();
  if (model.contact.rolling) {
    if (model.dimension() == 2)
      c.rolling_moment[2] = pairs.moment[0][p];
    else
      c.rolling_moment = {pairs.moment[0][p], pairs.moment[1][p], pairs.moment[2][p]};
    c.moment_cap = pairs.moment_cap[p];
  }
  c.friction = pairs.friction[p];
  set_elastic(model, pairs, p, hertz_radius_ratio(model, pairs, p, at), c);
  return c;
}

template <Shape shape>
void add_contacts(const Model& model, const Assembly& assembly, Network& net) {
  each_touching<shape>(model, assembly, [&](std::size_t p, const auto& at) {
    const ContactState c = state_of(model, assembly.pairs, p, at);
    const Vector3 force = force_of(model, assembly.pairs, p);
    net.grains[std::size_t(c.i)].resultant -= force;
    net.grains[std::size_t(c.j)].resultant += force;
    add_torques(model, c, force, net);
    net.contacts.push_back(c);
  });
}

double spring_energy(double squared, double stiffness) { return stiffness > 0 ? 0.5 * squared / stiffness : 0; }

void add_interactions(const Model& model, const Assembly& assembly, Network& net) {
  for (const ActingInteraction& a : acting_interactions(model, assembly, true)) {
    const InteractionTable& table =
        *std::find_if(assembly.pairs.interactions.begin(), assembly.pairs.interactions.end(),
                      [&](const InteractionTable& t) { return t.kind == a.kind; });
    InteractionState c;
    c.kind = a.kind;
    c.i = std::int32_t(a.i);
    c.j = std::int32_t(a.j);
    c.image = table.image[a.row];
    c.branch = a.branch;
    c.normal = a.normal;
    c.length = a.length;
    c.overlap = model.radius[a.i] + model.radius[a.j] - a.length;
    c.arm_i = a.arm_i * a.normal;
    c.arm_j = -a.arm_j * a.normal;
    c.normal_force = c.pressing_force = a.normal_force;
    c.tangential_force = a.force - a.normal_force * a.normal;
    // T_j = M - a_j n x f_t
    const Vector3 moment = a.moment_j + a.arm_j * a.normal.cross(c.tangential_force);
    c.twisting_moment = model.dimension() == 2 ? 0 : moment.dot(a.normal);
    c.rolling_moment = moment - c.twisting_moment * a.normal;
    c.normal_stiffness = a.stiffness.normal;
    c.tangential_stiffness = a.stiffness.tangential;
    c.rolling_stiffness = a.stiffness.bending;
    c.twisting_stiffness = a.stiffness.twisting;
    c.elastic_energy = a.energy;
    if (!a.has_energy)
      c.elastic_energy = (spring_energy(a.normal_force * a.normal_force, a.stiffness.normal) +
                          spring_energy(c.tangential_force.squaredNorm(), a.stiffness.tangential)) +
                         (spring_energy(c.rolling_moment.squaredNorm(), a.stiffness.bending) +
                          spring_energy(c.twisting_moment * c.twisting_moment, a.stiffness.twisting));
    net.grains[a.i].resultant -= a.force;
    net.grains[a.j].resultant += a.force;
    net.grains[a.i].torque += a.moment_i;
    net.grains[a.j].torque += a.moment_j;
    net.interactions.push_back(c);
  }
}

template <Shape shape>
bool some_contact_must_slip(const Model& model, const Assembly& assembly) {
  constexpr double most = 1 + 1e-6;  // a sliding contact is at its limit, give or take round-off
  const PairPlaces<shape> pair(model, assembly);
  return std::any_of(assembly.pairs.order.begin(), assembly.pairs.order.end(), [&](std::int32_t row) {
    const auto p = std::size_t(row);
    const auto at = pair(p);
    if (!(at.overlap > 0)) return false;
    const ContactState c = state_of(model, assembly.pairs, p, at);
    const double pressing = most * std::abs(c.pressing_force);
    return c.tangential_force.norm() > c.friction * pressing ||
           (model.contact.rolling && c.rolling_moment.norm() > c.moment_cap * pressing);
  });
}

/// Whether a moment or force of this size is at its limit, give or take round-off.
bool at_limit(double size, double limit) { return size >= (1 - 1e-6) * limit; }

/// Length of (x, y, z), summed as Eigen does.
double length_of(double x, double y, double z) { return std::sqrt(x * x + (y * y + z * z)); }

/// What holds a touching contact: whether it slides, and whether it rolls.
struct Held {
  bool slides, rolls;
};
template <Shape shape, class Force, class Place>
Held held_by(const Model& model, const PairTable& pairs, std::size_t p, const Place& at) {
  constexpr int D = dimension_of(shape);
  const double* force = pairs.force_row(D, p);
  const double fz = D == 2 ? 0.0 : force[2], nx = at.along().x / at.along_length(),
               ny = at.along().y / at.along_length(), nz = D == 2 ? 0.0 : at.along().z / at.along_length();
  const double normal = force[0] * nx + (force[1] * ny + fz * nz);
  const double law_constant = pairs.law_constant.empty() ? 0 : pairs.law_constant[p];
  const double pressing = std::abs(Force::pressing_force(normal, law_constant));
  const double tangential = length_of(force[0] - normal * nx, force[1] - normal * ny, fz - normal * nz);
  Held held{at_limit(tangential, pairs.friction[p] * pressing), true};
  if (!model.contact.rolling) return held;
  const double moment = D == 2 ? std::abs(pairs.moment[0][p])
                               : length_of(pairs.moment[0][p], pairs.moment[D - 2][p], pairs.moment[D - 1][p]);
  held.rolls = at_limit(moment, pairs.moment_cap[p] * pressing);
  return held;
}

// A first increment asks for it, which may be of four sub-steps: with whole contact states it took more than two.
template <Shape shape, class Force>
double constraints_over_motions(const Model& model, const Assembly& assembly) {
  const PairPlaces<shape> pair(model, assembly);
  const int d = model.dimension(), turns = d == 2 ? 1 : 3;
  const auto owner = [&](std::int32_t g) {
    return std::size_t(model.bodies ? model.bodies->owner[std::size_t(g)] : g);
  };
  std::vector<int> contacts(model.bodies ? model.bodies->size() : model.size(), 0);
  std::vector<std::int32_t> touching;
  touching.reserve(assembly.pairs.order.size());
  for (const std::int32_t row : assembly.pairs.order) {
    const auto p = std::size_t(row);
    if (pair.is_apart(p) || !(pair(p).overlap > 0)) continue;
    touching.push_back(row);
    ++contacts[owner(assembly.pairs.i[p])];
    ++contacts[owner(assembly.pairs.j[p])];
  }
  double constraints = 0, grip = 0, friction = 0, held = grip_of(friction);
  long counted = 0;
  for (const std::int32_t row : touching) {
    const auto p = std::size_t(row);
    if (contacts[owner(assembly.pairs.i[p])] < 2 || contacts[owner(assembly.pairs.j[p])] < 2) continue;
    const Held by = held_by<shape, Force>(model, assembly.pairs, p, pair(p));
    if (assembly.pairs.friction[p] != friction) {
      friction = assembly.pairs.friction[p];
      held = grip_of(friction);
    }
    constraints += 1 + (by.slides ? 0 : (d - 1) * held) + (by.rolls ? 0 : (d - 1) * held);
    grip += held;
    ++counted;
  }
  if (counted == 0) return 0;
  // Round grains that nothing grips turn as they like.
  const double turning = model.round() && !model.bodies ? grip / double(counted) : 1;
  const auto grains = std::count_if(contacts.begin(), contacts.end(), [](int n) { return n >= 2; });
  return constraints / (double(grains) * (d + turns * turning));
}

}  // namespace

Network network_of(const Model& model, const Assembly& assembly) {
  Network net;
  net.shape = model.shape;
  net.cell = assembly.cell;
  net.model = model.contact;
  net.reference_contact_force = assembly.state.reference.contact_force;
  net.reference_pressure = assembly.state.reference.pressure;
  net.loading = assembly.state.last_step.loading;
  if (net.loading == Loading::at_rate) net.mean_spin = assembly.state.last_step.mean_spin;
  net.grains.resize(model.size());
  for (std::size_t g = 0; g < model.size(); ++g) {
    GrainState& grain = net.grains[g];
    grain.radius = model.radius[g];
    grain.mass = model.mass[g];
    grain.inertia = model.inertia[g];
    grain.position = assembly.position(model, g);
    grain.velocity = assembly.velocity(model, g) - assembly.state.last_step.mean_velocity;
    grain.spin = assembly.spin(model, g);
    grain.resultant.setZero();
    if (model.round()) continue;
    if (keeps_axis(model.shape)) grain.orientation = assembly.orientation(model, g);
    static_cast<OwnValues&>(grain) = own_of(model.shape, model.own, g);
  }
  with_shape(model.shape, [&](auto shape) { add_contacts<shape.value>(model, assembly, net); });
  if (model.bodies) {
    join_members(model, assembly, net);
    return net;
  }
  add_interactions(model, assembly, net);
  return in_id_order(std::move(net), assembly.state.memory_order);
}

double grip_of(double friction) {
  constexpr double half =
      0.15;  // fitted to 21 packings with the ratio of stress error to unbalanced ratio (accuracy.hpp)
  return friction / (friction + half);
}

double constraint_ratio(const Model& model, const Assembly& assembly) {
  return with_force(model, [&](auto force) {
    return with_shape(model.shape, [&](auto shape) {
      return constraints_over_motions<shape.value, decltype(force)>(model, assembly);
    });
  });
}

bool holds_more_than_friction(const Model& model, const Assembly& assembly) {
  return with_shape(model.shape, [&](auto shape) { return some_contact_must_slip<shape.value>(model, assembly); });
}

}  // namespace rvelab
