#include "rvelab/solver/assembly/bodies.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "rvelab/solver/assembly/assembly.hpp"
#include "rvelab/solver/assembly/network.hpp"
#include "rvelab/solver/assembly/pair_geometry.hpp"
#include "rvelab/solver/assembly/superellipsoid_rows.hpp"

namespace rvelab {

namespace {

/// The image n of L n = x, whose entries are whole up to round-off.
Image nearest_image(const Cell& cell, const Vector3& x) {
  const Vector3 n = upper_inverse(cell.lattice) * x;
  Image image{};
  for (int k = 0; k < cell.dimension; ++k) image[std::size_t(k)] = int(std::floor(n[k] + 0.5));
  return image;
}

double radius_of_volume(Shape shape, double volume, double thickness) {
  // Cube root by Newton's steps: the same bits everywhere.
  if (dimension_of(shape) == 2) return std::sqrt(volume / grain_volume(shape, 1, thickness));
  const double cube = volume / grain_volume(shape, 1, thickness);
  int exponent = 0;
  const double part = std::frexp(cube, &exponent);
  const int third = exponent >= 0 ? exponent / 3 : -((2 - exponent) / 3);
  const double target = std::ldexp(part, exponent - 3 * third);
  double root = 1;
  for (int k = 0; k < 60; ++k) root = (2 * root + target / (root * root)) / 3;
  return std::ldexp(root, third);
}

}  // namespace

void BodyMotions::set_arm(std::size_t g, const Vector3& arm) {
  for (int k = 0; k < 3; ++k) arms[k][g] = arm[k];
}
void BodyMotions::set_image(std::size_t g, const Image& image) {
  for (std::size_t k = 0; k < 3; ++k) images[k][g] = image[k];
}

std::size_t bytes_of(const BodyMotions& b) {
  std::size_t sum = b.motion.capacity() * sizeof(BodyMotion) + b.turning.capacity() * sizeof(double);
  for (int k = 0; k < 3; ++k) sum += (b.arms[k].capacity() + b.images[k].capacity()) * sizeof(double);
  return sum;
}

void set_physical_masses(Model& model) {
  const std::size_t n = model.size();
  std::vector<double> mass(n), inertia(n);
  if (model.bodies == nullptr) {
    for (std::size_t g = 0; g < n; ++g) {
      mass[g] = model.materials[std::size_t(model.material[g])].density * model.volume_of(g);
      inertia[g] = model.inertia_of(g, mass[g]);
    }
  } else {
    auto bodies = std::make_shared<BodyModel>(*model.bodies);
    for (std::size_t b = 0; b < bodies->size(); ++b) {
      const auto first = std::size_t(bodies->first[b]), last = std::size_t(bodies->first[b + 1]);
      bodies->mass[b] = model.materials[std::size_t(model.material[first])].density * bodies->volume[b];
      for (std::size_t g = first; g < last; ++g) {
        mass[g] = bodies->share[g] * bodies->mass[b];
        inertia[g] = bodies->mass[b] * bodies->gyration[b].minCoeff();
      }
      for (int k = 0; k < 3; ++k) {
        bodies->moments_about[k][b] = bodies->moments(b)[k];
        bodies->inverse_moments_about[k][b] = 1 / bodies->moments(b)[k];
      }
    }
    model.bodies = std::move(bodies);
  }
  model.mass = std::move(mass);
  model.inertia = std::move(inertia);
}

static_assert(sizeof(BodyMotion) == body_row_length * sizeof(double));

void open_bodies(const Specimen& s, Model& model, Assembly& assembly) {
  if (s.bodies.empty()) return;
  auto bodies = std::make_shared<BodyModel>();
  const std::size_t n = s.grains.size();
  bodies->owner.resize(n);
  bodies->share.resize(n);
  const std::size_t padded = padded_to_lanes(s.bodies.size());
  bodies->row_of_owner.assign(padded_to_lanes(n), std::int32_t(s.bodies.size()) * body_row_length);
  for (int k = 0; k < 3; ++k) {
    for (Buffer* of_bodies : {&bodies->moments_about[k], &bodies->inverse_moments_about[k]})
      of_bodies->assign(padded, 1);
    for (Buffer* of_members : {&bodies->offset_along[k], &assembly.bodies.arms[k], &assembly.bodies.images[k]})
      of_members->assign(padded_to_lanes(n), 0);
  }
  assembly.bodies.turning.assign(4 * padded, 0);
  for (const BodyMember& member : s.members) bodies->offset.push_back(member.offset);
  double radii = 0;
  for (std::size_t b = 0; b < s.bodies.size(); ++b) {
    const Body& body = s.bodies[b];
    const auto first = std::size_t(body.first), last = b + 1 < s.bodies.size() ? std::size_t(s.bodies[b + 1].first) : n;
    bodies->id.push_back(body.id);
    bodies->first.push_back(body.first);
    bodies->volume.push_back(body.volume);
    bodies->gyration.push_back(body.gyration);
    bodies->radius.push_back(radius_of_volume(s.shape, body.volume, model.thickness));
    radii += bodies->radius.back();
    BodyMotion motion;
    motion.position = body.position;
    motion.velocity = body.velocity;
    motion.spin = body.spin;
    motion.orientation = body.orientation;
    assembly.bodies.motion.push_back(motion);
    const Matrix3 axes = axes_of(body.orientation);
    double lever = 0, volumes = 0;
    for (std::size_t g = first; g < last; ++g) {
      bodies->owner[g] = std::int32_t(b);
      lever = std::max(lever, bodies->offset[g].norm() + model.reach()[g]);
      volumes += bodies->share[g] = grain_volume(s.shape, s.grains.radius[g], model.thickness);
      bodies->row_of_owner[g] = std::int32_t(b) * body_row_length;
      for (int k = 0; k < 3; ++k) bodies->offset_along[k][g] = bodies->offset[g][k];
      const Vector3 arm = axes * bodies->offset[g];
      assembly.bodies.set_arm(g, arm);
      assembly.bodies.set_image(g, nearest_image(s.cell, s.grains.position[g] - body.position - arm));
    }
    for (std::size_t g = first; g < last; ++g) bodies->share[g] /= volumes;
    bodies->lever.push_back(lever);
  }
  bodies->first.resize(padded + 1, std::int32_t(n));
  assembly.bodies.motion.resize(padded);
  bodies->mass.resize(bodies->size());
  model.mean_radius = radii / double(bodies->size());
  model.largest_skin = model.options.skin * model.mean_radius;
  if (model.options.min_height == 0)
    model.min_height = 2 * *std::max_element(bodies->lever.begin(), bodies->lever.end());
  model.bodies = std::move(bodies);
}

void close_bodies(const Model& model, const Assembly& assembly, Specimen& s) {
  if (model.bodies == nullptr) return;
  const BodyModel& bodies = *model.bodies;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const BodyMotion& m = assembly.bodies.motion[b];
    s.bodies.push_back({bodies.id[b], bodies.first[b], m.position, m.velocity, m.spin, m.orientation, bodies.volume[b],
                        bodies.gyration[b]});
  }
  for (const Vector3& offset : bodies.offset) s.members.push_back({offset});
}

void leave_out_inner_pairs(const Model& model, const Assembly& assembly, std::vector<ListedPair>& pairs) {
  if (model.bodies == nullptr) return;
  const auto& owner = model.bodies->owner;
  std::erase_if(pairs, [&](const ListedPair& pair) {
    const auto i = std::size_t(pair.i), j = std::size_t(pair.j);
    if (owner[i] != owner[j]) return false;
    const Image of_i = assembly.bodies.image(i), of_j = assembly.bodies.image(j);
    for (std::size_t k = 0; k < 3; ++k)
      if (pair.image[k] != of_i[k] - of_j[k]) return false;
    return true;
  });
}

void reduce_bodies(const Reduction& reduction, const Model& model, Assembly& assembly) {
  if (model.bodies == nullptr) return;
  const Matrix3 back = reduction.rotation.transpose();
  const Turn turn = turn_of(back);
  for (BodyMotion& m : assembly.bodies.motion) {
    m.position = back * m.position;
    m.velocity = back * m.velocity;
    if (model.dimension() == 3) m.spin = back * m.spin;
    m.orientation = normalised(after(turn, m.orientation));
    if (model.dimension() == 2) m.position[2] = m.velocity[2] = 0;
  }
  if (moves_as_body(model.shape))
    for (std::size_t g = 0; g < model.size(); ++g)
      put_orientation(assembly.bodies.motion[g].orientation,
                      assembly.rows.data() + g * std::size_t(model.row_length()));
  for (std::size_t g = 0; g < model.size(); ++g) {
    // From the orientation, as a state that is opened finds them.
    const Turn& orientation = assembly.bodies.motion[std::size_t(model.bodies->owner[g])].orientation;
    assembly.bodies.set_arm(g, axes_of(orientation) * model.bodies->offset[g]);
    const Image image = assembly.bodies.image(g);
    const Eigen::Vector3i n = reduction.inverse_basis * Eigen::Vector3i(image[0], image[1], image[2]);
    assembly.bodies.set_image(g, {n[0], n[1], n[2]});
  }
}

void wrap_bodies(const Model& model, Assembly& assembly) {
  if (model.bodies == nullptr) return;
  const BodyModel& bodies = *model.bodies;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const Image moved = wrap(assembly.cell, assembly.bodies.motion[b].position);
    for (auto g = std::size_t(bodies.first[b]); g < std::size_t(bodies.first[b + 1]); ++g)
      for (std::size_t k = 0; k < 3; ++k) assembly.bodies.images[k][g] -= moved[k];
  }
}

void follow_wrapping(const std::vector<Image>& moved, Assembly& assembly) {
  if (assembly.bodies.motion.empty()) return;
  for (std::size_t g = 0; g < moved.size(); ++g)
    for (std::size_t k = 0; k < 3; ++k) assembly.bodies.images[k][g] += moved[g][k];
}

namespace {

/// Forces and torques of the pairs, in the order of every sum over them.
template <int D, bool Rolling>
void gather(const BodyModel& bodies, const PairTable& pairs, const double* radius, const BodyMotions& motions,
            Resultant* resultants) {
  const std::int32_t *owner = bodies.owner.data(), *grain_i = pairs.i.data(), *grain_j = pairs.j.data();
  const std::uint8_t* touched = pairs.touched.data();
  const std::size_t near = pairs.near;
  for (const std::int32_t listed : pairs.order) {
    const auto p = std::size_t(listed);
    if (p >= near && touched[p / 8] == 0) continue;
    const double* row = pairs.force_row(D, p);
    const auto i = std::size_t(grain_i[p]), j = std::size_t(grain_j[p]);
    Resultant &on_i = resultants[owner[i]], &on_j = resultants[owner[j]];
    const Vector3 ai = motions.arm(i), aj = motions.arm(j);
    const double fx = row[0], fy = row[1];
    if constexpr (D == 2) {
      on_i.force[0] -= fx;
      on_i.force[1] -= fy;
      on_i.torque[2] += row[3] - (ai[0] * fy - ai[1] * fx);
      on_j.force[0] += fx;
      on_j.force[1] += fy;
      on_j.torque[2] += row[2] + (aj[0] * fy - aj[1] * fx);
    } else {
      const double fz = row[2], si = row[3] - radius[i], sj = row[3] - radius[j];
      double m[3] = {};
      if constexpr (Rolling)
        for (std::size_t k = 0; k < 3; ++k) m[k] = pairs.moment[k][p];
      on_i.force[0] -= fx;
      on_i.force[1] -= fy;
      on_i.force[2] -= fz;
      on_i.torque[0] += (si * row[4] - m[0]) - (ai[1] * fz - ai[2] * fy);
      on_i.torque[1] += (si * row[5] - m[1]) - (ai[2] * fx - ai[0] * fz);
      on_i.torque[2] += (si * row[6] - m[2]) - (ai[0] * fy - ai[1] * fx);
      on_j.force[0] += fx;
      on_j.force[1] += fy;
      on_j.force[2] += fz;
      on_j.torque[0] += (sj * row[4] + m[0]) + (aj[1] * fz - aj[2] * fy);
      on_j.torque[1] += (sj * row[5] + m[1]) + (aj[2] * fx - aj[0] * fz);
      on_j.torque[2] += (sj * row[6] + m[2]) + (aj[0] * fy - aj[1] * fx);
    }
  }
}

/// The same of bodies of one grain each that is not round: the kernels give force and torques about the centres.
template <bool Rolling>
void gather_solids(const PairTable& pairs, Resultant* resultants) {
  for (const std::int32_t listed : pairs.order) {
    const auto p = std::size_t(listed);
    if (p >= pairs.near && pairs.touched[p / 8] == 0) continue;
    const double *row = pairs.force_row(3, p), *torque_i = pairs.solid.data() + force_row_length(3) * p + 4;
    Resultant &on_i = resultants[pairs.i[p]], &on_j = resultants[pairs.j[p]];
    for (int k = 0; k < 3; ++k) {
      double m = 0;
      if constexpr (Rolling) m = pairs.moment[k][p];
      on_i.force[k] -= row[k];
      on_i.torque[k] += torque_i[k] - m;
      on_j.force[k] += row[k];
      on_j.torque[k] += row[4 + k] + m;
    }
  }
}

}  // namespace

void gather_on_bodies(const Model& model, const Assembly& assembly, std::vector<Resultant>& forces) {
  const BodyModel& bodies = *model.bodies;
  forces.assign(bodies.size(), Resultant{});
  if (moves_as_body(model.shape)) {
    if (model.contact.rolling)
      gather_solids<true>(assembly.pairs, forces.data());
    else
      gather_solids<false>(assembly.pairs, forces.data());
    return;
  }
  const auto by = [&](auto work) { work(bodies, assembly.pairs, model.radius.data(), assembly.bodies, forces.data()); };
  if (model.dimension() == 2)
    by(gather<2, false>);
  else if (model.contact.rolling)
    by(gather<3, true>);
  else
    by(gather<3, false>);
}

Matrix3 virial_of_bodies(const Model& model, const Assembly& assembly) {
  return with_shape(model.shape, [&](auto shape) -> Matrix3 {
    const PairGeometry<shape.value> pair(model, assembly);
    const PairTable& pairs = assembly.pairs;
    Matrix3 sum = Matrix3::Zero();
    for (const std::int32_t listed : pairs.order) {
      const auto p = std::size_t(listed);
      if (p >= pairs.near && pairs.touched[p / 8] == 0) continue;
      const Branch b = pair.branch(p);
      const Vector3 branch = Vector3(b.x, b.y, b.z) + assembly.bodies.arm(std::size_t(pairs.i[p])) -
                             assembly.bodies.arm(std::size_t(pairs.j[p]));
      sum += force_of(model, pairs, p) * branch.transpose();
    }
    return sum;
  });
}

void join_members(const Model& model, const Assembly& assembly, Network& net) {
  const BodyModel& bodies = *model.bodies;
  net.members = std::move(net.grains);
  net.grains.assign(bodies.size(), GrainState{});
  net.owner = bodies.owner;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    GrainState& grain = net.grains[b];
    const BodyMotion& m = assembly.bodies.motion[b];
    const Matrix3 axes = axes_of(m.orientation);
    if (moves_as_body(model.shape))
      static_cast<OwnValues&>(grain) = static_cast<const OwnValues&>(net.members[std::size_t(bodies.first[b])]);
    grain.radius = bodies.radius[b];
    grain.mass = bodies.mass[b];
    grain.inertia = grain.mass * bodies.gyration[b].maxCoeff();
    grain.position = m.position;
    grain.velocity = m.velocity - assembly.state.last_step.mean_velocity;
    grain.spin = m.spin;
    grain.resultant = Vector3::Zero();
    Eigen::Index least = 0;
    bodies.gyration[b].minCoeff(&least);
    grain.orientation = axes.col(least);
    net.axes.push_back(axes);
    net.moments.push_back(axes * bodies.moments(b).asDiagonal() * axes.transpose());
  }
  for (ContactState& c : net.contacts) {
    const auto i = std::size_t(c.i), j = std::size_t(c.j);
    c.member_i = c.i;
    c.member_j = c.j;
    c.i = bodies.owner[i];
    c.j = bodies.owner[j];
    c.member_branch = c.branch;
    c.offset_i = assembly.bodies.arm(i);
    c.offset_j = assembly.bodies.arm(j);
    c.branch += c.offset_i - c.offset_j;
    c.arm_i += c.offset_i;
    c.arm_j += c.offset_j;
    const Image of_i = assembly.bodies.image(i), of_j = assembly.bodies.image(j);
    for (std::size_t k = 0; k < 3; ++k) c.image[k] += of_j[k] - of_i[k];
    const Vector3 force = c.force();
    // About the body's centre; the contact point is where both arms end.
    net.grains[std::size_t(c.i)].resultant -= force;
    net.grains[std::size_t(c.j)].resultant += force;
    net.grains[std::size_t(c.i)].torque -= c.arm_i.cross(force) + c.rolling_moment;
    net.grains[std::size_t(c.j)].torque += c.arm_j.cross(force) + c.rolling_moment;
  }
}

}  // namespace rvelab
