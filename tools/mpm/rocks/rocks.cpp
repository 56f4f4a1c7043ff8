#include "tools/mpm/rocks/rocks.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <sstream>

namespace mpm {
namespace {

constexpr double flat = std::numeric_limits<double>::infinity();  // radius of a plane

template <int D>
double radius_of(const Rocks<D>& rocks, const Rock<D>& rock) {
  return rocks.shapes[std::size_t(rock.shape)].bounding_radius();
}

/// Of two bodies, the second of which may be infinitely heavy.
double reduced_mass(double a, double b) { return std::isinf(b) ? a : a * b / (a + b); }

}  // namespace

template <int D>
RockPair<D> Rocks<D>::constants_of(int first, int second, const Wall<D>* wall) const {
  const auto& a = all[std::size_t(first)];
  const auto& of_a = materials[std::size_t(a.material)];
  const double ra = shapes[std::size_t(a.shape)].equivalent_radius();
  if (wall == nullptr) {
    const auto& b = all[std::size_t(second)];
    const double mass = reduced_mass(a.body.mass, b.body.mass);
    return {of_a, ra,       materials[std::size_t(b.material)], shapes[std::size_t(b.shape)].equivalent_radius(),
            mass, thickness};
  }
  double rw = flat;
  if (wall->body != nullptr) {
    if (const auto* disc = std::get_if<Disc<D>>(&wall->body->shape)) rw = disc->radius;
  }
  RockPair<D> pair(of_a, ra, of_a, rw, reduced_mass(a.body.mass, wall->mass), thickness);
  if (!wall->follows_material) pair.friction = wall->friction;
  return pair;
}

/// Rocks by the lower ends of their extents along x: two may touch while these overlap.
template <int D>
std::vector<std::pair<int, int>> Rocks<D>::rocks_within(double margin) const {
  std::vector<int> order(all.size());
  for (std::size_t k = 0; k < all.size(); ++k) order[k] = int(k);
  const auto low = [&](int k) { return all[std::size_t(k)].body.centre[0] - radius_of(*this, all[std::size_t(k)]); };
  std::sort(order.begin(), order.end(), [&](int a, int b) { return low(a) != low(b) ? low(a) < low(b) : a < b; });
  std::vector<std::pair<int, int>> found;
  for (std::size_t m = 0; m < order.size(); ++m) {
    const auto& a = all[std::size_t(order[m])];
    const double ra = radius_of(*this, a), end = a.body.centre[0] + ra + margin;
    for (std::size_t n = m + 1; n < order.size() && low(order[n]) <= end; ++n) {
      const auto& b = all[std::size_t(order[n])];
      const double reach = ra + radius_of(*this, b) + margin;
      if ((a.body.centre - b.body.centre).squaredNorm() <= reach * reach) {
        found.emplace_back(std::min(order[m], order[n]), std::max(order[m], order[n]));
      }
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

/// Contacts that go on take their memory along.
template <int D>
void Rocks<D>::find_candidates(const std::vector<Wall<D>>& walls, const Vec<D>& gravity, double dt) {
  const double margin = (fastest() + gravity.norm() * dt) * dt;  // of each of the two
  auto found = rocks_within(2 * margin);
  for (std::size_t k = 0; k < all.size(); ++k) {
    for (std::size_t w = 0; w < walls.size(); ++w) {
      const double moved = (walls[w].velocity.norm() + walls[w].acceleration * dt) * dt;
      if (walls[w].there && gap_to(all[k], walls[w]).gap < margin + moved)
        found.emplace_back(int(k), int(all.size() + w));
    }
  }
  std::sort(found.begin(), found.end());
  std::vector<Pair> next;
  auto old = pairs.begin();
  // Of a wall that is removed: what its springs hold goes with it.
  const auto leave = [&](const Pair& pair) { contact_loss += pair.contact.energy(pair.constants); };
  for (const auto& [i, j] : found) {
    for (; old != pairs.end() && std::pair(old->first, old->second) < std::pair(i, j); ++old) leave(*old);
    if (old != pairs.end() && old->first == i && old->second == j) {
      next.push_back(*old++);
      continue;
    }
    const Wall<D>* wall = j < int(all.size()) ? nullptr : &walls[std::size_t(j) - all.size()];
    next.push_back({i, j, constants_of(i, j, wall), {}});
  }
  for (; old != pairs.end(); ++old) leave(*old);
  pairs = std::move(next);
  wall_impulse.resize(walls.size(), Vec<D>::Zero());
  wall_force.resize(walls.size(), Vec<D>::Zero());
}

/// So many that the shortest collision that may come within the step has steps_per_collision of them.
template <int D>
long Rocks<D>::sub_steps_for(const std::vector<Wall<D>>& walls, const Vec<D>& gravity, double dt) const {
  // By a spin w a surface nears along its normal n at w |r x n| or less, and r.n is the inner radius at least: of a
  // sphere it does not.
  const auto speed_of = [&](const Rock<D>& rock) {
    const auto& shape = shapes[std::size_t(rock.shape)];
    const double outer = shape.bounding_radius(), inner = shape.inner_radius();
    return rock.body.velocity.norm() +
           rock.body.spin().norm() * std::sqrt(std::max(0.0, (outer - inner) * (outer + inner)));
  };
  double highest = 0;  // 1/s^2, square of the frequency of a contact, and of a plate on all of its own
  std::vector<double> on_plate(walls.size(), 0.0);
  for (const auto& pair : pairs) {
    const auto& a = all[std::size_t(pair.first)];
    const Rock<D>* b = pair.second < int(all.size()) ? &all[std::size_t(pair.second)] : nullptr;
    const Wall<D>* wall = b != nullptr ? nullptr : &walls[std::size_t(pair.second) - all.size()];
    const double mass = reduced_mass(a.body.mass, b != nullptr ? b->body.mass : wall->mass);
    const double other = b != nullptr ? speed_of(*b) : wall->velocity.norm() + wall->acceleration * dt;
    const double speed = speed_of(a) + other + gravity.norm() * dt;
    const double overlap = std::max(pair.contact.overlap, pair.constants.reach(mass, speed));
    // Along the contact a sphere turns too: 2/7 of its mass is in the way.
    const double stiffness =
        std::max(pair.constants.normal_stiffness(overlap), 3.5 * pair.constants.tangential_stiffness(overlap));
    highest = std::max(highest, stiffness / mass);
    if (wall != nullptr) on_plate[std::size_t(pair.second) - all.size()] += stiffness / wall->mass;
  }
  for (const double each : on_plate) highest = std::max(highest, each);
  if (highest == 0) return 1;
  const double count = std::ceil(dt * std::sqrt(highest) / std::numbers::pi * steps_per_collision);
  constexpr double most = 1e8;
  if (count <= most) return std::max(1L, long(count));
  std::ostringstream words;
  words << "the contacts of rocks would need " << count << " sub-steps in a step of " << dt << " s; allowed: up to "
        << most << "; make rocks larger, slower or softer (young_modulus_Pa)";
  if (sub_steps == 0) throw InputError(words.str());
  throw std::runtime_error(words.str());
}

template <int D>
void Rocks<D>::take_impulses(double dt) {
  for (auto& rock : all) {
    rock.soil_force = rock.impulse / dt;
    rock.soil_torque = rock.angular_impulse / dt;
    rock.soil_impulse += rock.impulse;
    rock.impulse.setZero();
    rock.angular_impulse.setZero();
    rock.mean_force.setZero();
    rock.mean_torque.setZero();
  }
}

template <int D>
void Rocks<D>::kick(const Vec<D>& gravity, double dt) {
  for (auto& rock : all) {
    const Vec<D> force = rock.force + rock.soil_force + rock.body.mass * gravity;
    const Vec<D> held = (Vec<D>::Ones() - rock.body.free).cwiseProduct(force);
    wall_work -= dt * held.dot(rock.body.velocity);
    if (!rock.body.turns) wall_work -= dt * (rock.torque + rock.soil_torque).dot(rock.body.spin());
    rock.body.kick(force, rock.torque + rock.soil_torque, dt);
  }
}

template <int D>
void Rocks<D>::clear_means() {
  for (auto& rock : all) {
    rock.mean_velocity.setZero();
    rock.mean_spin.setZero();
  }
}

template <int D>
void Rocks<D>::add_to_means(double share) {
  for (auto& rock : all) {
    rock.mean_velocity += share * rock.body.velocity;
    rock.mean_spin += share * rock.body.spin();
  }
}

/// Of velocities half a sub-step on.
template <int D>
void Rocks<D>::book_soil_work(double dt) {
  for (auto& rock : all) {
    soil_work += dt * rock.soil_force.dot(rock.body.velocity);
    soil_work += dt * rock.soil_torque.dot(rock.body.spin());
  }
}

template <int D>
void Rocks<D>::contact_forces(const std::vector<Wall<D>>& walls, double dt, double share) {
  // Once for each rock, not for each of its pairs: of 8,000 spheres a third of the time.
  spins_.resize(all.size());
  speeds_.resize(all.size());
  for (std::size_t k = 0; k < all.size(); ++k) {
    auto& rock = all[k];
    rock.force.setZero();
    rock.torque.setZero();
    spins_[k] = rock.body.spin();
    speeds_[k] = rock.body.velocity.norm() + spins_[k].norm() * radius_of(*this, rock);
  }
  const auto velocity_at = [&](int k, const Vec<D>& position) -> Vec<D> {
    const auto& body = all[std::size_t(k)].body;
    return body.velocity + spun<D>(spins_[std::size_t(k)], position - body.centre);
  };
  touching = 0;
  double power = 0;
  // A force acts over half a sub-step on both sides of its moment, and sub-steps may differ.
  const auto book_walls = [&] {
    for (std::size_t k = 0; k < wall_force.size(); ++k) wall_impulse[k] += 0.5 * dt * wall_force[k];
  };
  book_walls();
  for (auto& force : wall_force) force.setZero();
  for (auto& pair : pairs) {
    auto& a = all[std::size_t(pair.first)];
    const bool with_rock = pair.second < int(all.size());
    const Wall<D>* wall = with_rock ? nullptr : &walls[std::size_t(pair.second) - all.size()];
    Rock<D>* b = with_rock ? &all[std::size_t(pair.second)] : nullptr;
    // A gap shrinks by no more than the two move.
    const double other_speed = with_rock ? speeds_[std::size_t(pair.second)] : wall->velocity.norm();
    pair.clearance -= dt * (speeds_[std::size_t(pair.first)] + other_speed);
    if (pair.clearance > 0) continue;
    const Gap<D> gap = with_rock ? gap_between<D>(a.placed(shapes), b->placed(shapes)) : gap_to(a, *wall);
    if (!(gap.gap < 0) || (wall != nullptr && !wall->there)) {
      const Vec<D> second = with_rock ? velocity_at(pair.second, gap.place) : wall->velocity;
      const bool gone = wall != nullptr && !wall->there;
      contact_loss += gone ? pair.contact.energy(pair.constants)
                           : pair.contact.end_loss(pair.constants, second - velocity_at(pair.first, gap.place), dt);
      pair.contact = {};
      pair.clearance = 0.99 * gap.gap;
      continue;
    }
    ++touching;
    pair.clearance = 0;
    const Vec<D> ra = gap.place - a.body.centre;
    const Vec<D> other = with_rock ? velocity_at(pair.second, gap.place) : wall->velocity;
    const Vec<D> relative = other - velocity_at(pair.first, gap.place);
    const Vec<D> force = pair.contact.advance(pair.constants, -gap.gap, gap.normal, relative, dt, contact_loss);
    a.force -= force;
    a.torque -= moment<D>(ra, force);
    if (with_rock) {
      b->force += force;
      b->torque += moment<D>(gap.place - b->body.centre, force);
    } else {
      wall_force[std::size_t(pair.second) - all.size()] += force;
      power -= force.dot(wall->velocity);
    }
  }
  for (auto& rock : all) {
    rock.mean_force += share * rock.force;
    rock.mean_torque += share * rock.torque;
  }
  book_walls();
  wall_work += 0.5 * dt * (power + wall_power);
  wall_power = power;
}

template <int D>
void Rocks<D>::keep_ghosts(std::vector<Ghost>& now) {
  auto next = now.begin();
  for (auto& old : ghosts) {
    const auto key = std::pair(old.point, old.rock);
    while (next != now.end() && std::pair(next->point, next->rock) < key) ++next;
    if (next != now.end() && std::pair(next->point, next->rock) == key)
      next->contact = old.contact, next->velocity = old.velocity, next->lasts = true;
    else
      ghost_loss += old.contact.tangential_energy(ghost_constants(old.rock, balls[std::size_t(old.point)]));
  }
}

template <int D>
double Rocks<D>::ghost_springs() const {
  double sum = 0;
  for (const auto& ghost : ghosts)
    sum += ghost.contact.energy(ghost_constants(ghost.rock, balls[std::size_t(ghost.point)]));
  return sum;
}

/// Without a dashpot: what soil takes up is its own.
template <int D>
RockPair<D> Rocks<D>::ghost_constants(int number, double radius) const {
  const auto& rock = all[std::size_t(number)];
  auto of_rock = materials[std::size_t(rock.material)];
  auto ball = soil.ball.young_modulus > 0 ? soil.ball : of_rock;
  of_rock.restitution = ball.restitution = 1;
  RockPair<D> pair(of_rock, shapes[std::size_t(rock.shape)].equivalent_radius(), ball, radius, 1, thickness);
  pair.friction = soil.rough ? 1e300 : soil.friction;
  return pair;
}

template <int D>
RockEnergy Rocks<D>::energy(const Vec<D>& gravity) const {
  RockEnergy energy;
  for (const auto& rock : all) {
    energy.kinetic += rock.body.kinetic();
    energy.potential -= rock.body.mass * gravity.dot(rock.body.centre);
  }
  for (const auto& pair : pairs) energy.springs += pair.contact.energy(pair.constants);
  energy.contact_loss = contact_loss;
  energy.soil_work = soil_work;
  energy.wall_work = wall_work;
  energy.residual =
      energy.kinetic + energy.potential + energy.springs + contact_loss - first_energy - soil_work - wall_work;
  return energy;
}

template <int D>
double Rocks<D>::surface_speed(const Rock<D>& rock) const {
  return rock.body.velocity.norm() + rock.body.spin().norm() * radius_of(*this, rock);
}

template <int D>
double Rocks<D>::fastest() const {
  double fastest = 0;
  for (const auto& rock : all) fastest = std::max(fastest, surface_speed(rock));
  return fastest;
}

template <int D>
double Rocks<D>::distance(const Rock<D>& rock, const Vec<D>& position, double reach) const {
  const auto& shape = shapes[std::size_t(rock.shape)];
  const Vec<D> r = position - rock.body.centre;
  const double beyond = r.norm() - shape.bounding_radius();
  if (shape.is_sphere() || beyond > reach) return beyond;
  Vec<D> outward;
  return shape.distance(to_body<D>(rock.body.orientation, r), outward);
}

template <int D>
void Rocks<D>::add_ball(const Point<D>& point, double radius, bool grain) {
  double room = radius;
  for (const auto& rock : all) room = std::min(room, distance(rock, point.position, radius));
  balls.push_back(grain && room > 0.95 * radius ? radius : room);
}

template <int D>
const std::vector<typename Rocks<D>::SurfacePlace>& Rocks<D>::outline(int shape, double spacing) {
  outlines_.resize(shapes.size());
  auto& outline = outlines_[std::size_t(shape)];
  if (outline.empty()) {
    shapes[std::size_t(shape)].each_surface_point(spacing, [&](const Vec<D>& at, const Vec<D>& normal, double) {
      outline.push_back({at, normal});
    });
  }
  return outline;
}

template class Rocks<2>;
template class Rocks<3>;

}  // namespace mpm
