#include "rvelab/solver/loading/collisions.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "rvelab/solver/assembly/contact_stiffness.hpp"
#include "rvelab/solver/assembly/gather_table.hpp"
#include "rvelab/solver/assembly/oriented_bounds.hpp"
#include "rvelab/solver/assembly/pair_geometry.hpp"

namespace rvelab {

namespace {

/// Half of the 2 % allowed of the velocity after a collision with a dashpot of rate gamma = c/m*. The force knows the
/// velocity of half a step before: ln e comes out larger by gamma dt/2 of itself. A dashpot that acts at once, at zero
/// overlap, does so up to half a step too long or too short at either end: +- gamma dt; one that grows with the fourth
/// root of the overlap is nearly as abrupt (without this, restitution 0.05 came out 3.6 % off).
constexpr double restitution_error = 0.01;

/// What a piece of the pairs shows. Sums in the order of the pairs, so that they are the same on any team.
struct PairExtremes {
  double elastic = 0, approach = 0;  ///< J
  double stiffness = 0;              ///< largest Impact::measure
  double impact = 0;                 ///< the same of the speed alone, without what a spring already holds
  double least_kn = std::numeric_limits<double>::infinity();
  /// Dashpots: largest c/m* (of power 0), c/sqrt(m* k) (restitution), c/k (viscoelastic).
  double damping = 0;
  double closing = 0, closed = 0;  ///< m/s, fastest approach by the cell; m, largest overlap that the increment makes
  bool deep = false, beyond = false;

  void add(const PairExtremes& other) {
    elastic += other.elastic;
    approach += other.approach;
    stiffness = std::max(stiffness, other.stiffness);
    impact = std::max(impact, other.impact);
    least_kn = std::min(least_kn, other.least_kn);
    damping = std::max(damping, other.damping);
    closing = std::max(closing, other.closing);
    closed = std::max(closed, other.closed);
    deep = deep || other.deep;
    beyond = beyond || other.beyond;
  }
};

/// Sub-steps in which the deformation of the cell alone may make the largest overlap: the boundary work of a shock from
/// a gas is then right to 1 % (in one step it was wrong by half).
constexpr double increment_steps = 32;

/// Part of the skin that a sub-step may cross in flight, and part of it after which collisions are sought anew.
constexpr double flight_per_step = 0.05, flight_per_look = 0.5;

using std::numbers::pi;

double square(double x) { return x * x; }

/// `Impact`: how the law's springs collide (contact/impact.hpp). What differs from pair to pair without a pattern is
/// masked, not branched on (time at a rate over that with branches and a balance at each look: 1,000 spheres 0.95, 400
/// discs 0.96).
template <Shape shape, class Impact>
PairExtremes pairs_in(const Model& model, const Assembly& assembly, const PairPlaces<shape>& pair,
                      const Outlook& outlook, std::size_t first, std::size_t last) {
  constexpr int D = dimension_of(shape);
  PairExtremes found;
  const UpperTriangle rate = upper_triangle(outlook.rate);
  const double horizon = outlook.horizon, increment = outlook.increment, known_gap = listed_gap(model, assembly);
  const double* velocities = assembly.rows.data() + model.velocity_offset();
  const double *masses = model.mass.data(), *radii = model.radius.data(), *kn = assembly.pairs.kn.data();
  const std::int32_t *order = assembly.pairs.order.data(), *grain_i = assembly.pairs.i.data(),
                     *grain_j = assembly.pairs.j.data();
  const std::int32_t *row_i = assembly.pairs.row_i.data(), *row_j = assembly.pairs.row_j.data();
  const bool curvature = model.radius_from_curvature(), dashpot = model.damping.dashpot != Dashpot::none;
  const double power = dashpot_power(model.contact.law, model.damping.dashpot),
               allowed = model.options.max_overlap_ratio;
  const bool viscoelastic = model.damping.dashpot == Dashpot::viscoelastic;
  const double* constants = assembly.pairs.law_constant.empty() ? nullptr : assembly.pairs.law_constant.data();
  for (std::size_t q = first; q < last; ++q) {
    const auto p = std::size_t(order[q]), i = std::size_t(grain_i[p]), j = std::size_t(grain_j[p]);
    const auto geometry = pair.within(p, known_gap);
    const Branch &b = geometry.branch, &n = geometry.along();
    const double overlap = geometry.overlap, gap = -overlap, limit = allowed * std::min(radii[i], radii[j]);
    found.beyond |= !(overlap <= limit);
    found.least_kn = std::min(found.least_kn, kn[p]);
    if (gap >= 0 && gap >= known_gap) continue;  // seen when it is listed: what a restart lists must not matter
    const double *vi = velocities + row_i[p], *vj = velocities + row_j[p];
    double by_cell = n.x * (rate.xx * b.x + rate.xy * b.y) + n.y * (rate.yy * b.y);
    double by_grains = n.x * (vj[0] - vi[0]) + n.y * (vj[1] - vi[1]);
    if constexpr (D == 3) {
      by_cell += (n.x * rate.xz + n.y * rate.yz + n.z * rate.zz) * b.z;
      by_grains += n.z * (vj[2] - vi[2]);
    }
    if constexpr (keeps_axis(shape)) by_grains += geometry.opening_by(vi[2], vj[2]);
    if constexpr (moves_as_body(shape)) by_grains += geometry.opening_by(vi + 4, vj + 4);
    const double opening = (by_cell + by_grains) / geometry.along_length(),
                 closing = -by_cell / geometry.along_length();
    const double shrinks = double((closing * increment > gap) & (closing > 0));
    found.closing = std::max(found.closing, shrinks * closing);
    found.closed = std::max(found.closed, shrinks * (closing * increment - gap));
    const double travel = -opening * horizon;
    if (gap >= 0 && !(travel > gap)) continue;
    const double mass = masses[i] * masses[j] / (masses[i] + masses[j]);
    // Where grains will meet is not known: as stiff for the step as they can be, as soft for the depth.
    double k = kn[p], softest = k;
    if (curvature) {
      const RadiusRatios ratios = hertz_radius_ratios(model, assembly.pairs, p);
      k *= std::sqrt(overlap > 0 ? hertz_radius_ratio(model, assembly.pairs, p, geometry) : ratios.largest);
      softest *= std::sqrt(ratios.least);
    }
    found.approach += 0.5 * mass * opening * opening;
    const double pressed = std::max(0.0, overlap), ratio = k / mass;
    const double own = constants == nullptr ? 0 : constants[p];
    found.elastic += Impact::spring_energy(k, pressed, own);
    // A Hertz collision under way has given part of its speed to the spring.
    const double speed = opening * opening + Impact::held_speed_squared(ratio, pressed, own);
    found.stiffness = std::max(found.stiffness, Impact::measure(ratio, speed));
    if (Impact::stiffens) found.impact = std::max(found.impact, Impact::measure(ratio, opening * opening));
    if (dashpot) {
      const double over = power == 0 ? mass : (viscoelastic ? k : std::sqrt(mass * k));
      found.damping = std::max(found.damping, assembly.pairs.cn[p] / over);
    }
    if (travel - gap > limit)
      found.deep =
          found.deep || std::min(travel, Impact::reach(softest, mass, std::abs(opening), own)) + pressed > 0.9 * limit;
  }
  found.beyond |= !std::isfinite(found.elastic + found.approach);
  return found;
}

/// What a piece of the grains shows.
struct GrainMotion {
  double resultants = 0;  ///< J, sum R^2 / 2k: what they can still turn into motion
  double kinetic = 0;     ///< J
  double fastest = 0;     ///< m/s, squared; not round: with what their turn adds, as listed_gap counts it
};

/// Adds the forces of a pair to those of its grains, D numbers each.
template <int D>
inline void add_pair(const PairTable& pairs, std::size_t p, double* on_i, double* on_j) {
  const double* row = pairs.force_row(D, p);
  for (std::size_t c = 0; c < D; ++c) {
    if (on_j != nullptr) on_j[c] += row[c];
    if (on_i != nullptr) on_i[c] -= row[c];
  }
}

/// Resultant forces of all grains; on a team a piece of grains gathers its own, in the same order.
template <int D>
std::vector<double> resultants_in(const Model& model, const Assembly& assembly) {
  std::vector<double> force(D * model.size(), 0.0);
  const PairTable& pairs = assembly.pairs;
  if (model.sharing() == nullptr) {
    for (const std::int32_t row : pairs.order) {
      const auto p = std::size_t(row), i = std::size_t(pairs.i[p]), j = std::size_t(pairs.j[p]);
      if (i != j) add_pair<D>(pairs, p, force.data() + D * i, force.data() + D * j);
    }
    return force;
  }
  in_pieces(model.size(), model.sharing(), [&](std::size_t, std::size_t first, std::size_t last) {
    each_pair_of_grains<D>(pairs, first, last, [&](std::size_t g, std::size_t p, bool as_j) {
      double* on_g = force.data() + D * g;
      if (pairs.i[p] != pairs.j[p]) add_pair<D>(pairs, p, as_j ? nullptr : on_g, as_j ? on_g : nullptr);
    });
  });
  return force;
}

/// `stiffness`: the row sum of a grain, N/m.
template <Shape shape, class Stiffness>
GrainMotion grains_in(const Model& model, const Assembly& assembly, const Stiffness& stiffness,
                      const std::vector<double>& force, std::size_t first, std::size_t last) {
  constexpr int D = dimension_of(shape);
  GrainMotion motion;
  for (std::size_t g = first; g < last; ++g) {
    const double* v = assembly.rows.data() + g * std::size_t(model.row_length()) + std::size_t(model.velocity_offset());
    double resultant = 0, speed = 0;
    for (std::size_t c = 0; c < D; ++c) {
      resultant += square(force[D * g + c]);
      speed += square(v[c]);
    }
    if (resultant > 0) motion.resultants += resultant / stiffness(g);  // row sums count kn twice
    motion.kinetic += 0.5 * model.mass[g] * speed;
    if constexpr (moves_as_body(shape)) {
      const double* w = v + 4;
      speed = square(std::sqrt(speed) + v[23 - 4] * std::sqrt(square(w[0]) + square(w[1]) + square(w[2])));
    }
    if constexpr (keeps_axis(shape))
      speed = square(std::sqrt(speed) + outline_speed_by_turn(v - model.velocity_offset()));
    motion.fastest = std::max(motion.fastest, speed);
  }
  return motion;
}

template <Shape shape, class Stiffness>
GrainMotion motion_of(const Model& model, const Assembly& assembly, const Stiffness& stiffness,
                      const std::vector<double>& force) {
  std::vector<GrainMotion> of_grains(pieces_in(model.size()));
  in_pieces(model.size(), model.sharing(), [&](std::size_t piece, std::size_t first, std::size_t last) {
    of_grains[piece] = grains_in<shape>(model, assembly, stiffness, force, first, last);
  });
  GrainMotion motion;
  for (const GrainMotion& piece : of_grains) {
    motion.resultants += piece.resultants;
    motion.kinetic += piece.kinetic;
    motion.fastest = std::max(motion.fastest, piece.fastest);
  }
  return motion;
}

/// No more than the row sum of any grain with contacts, N/m (inertia.cpp: its stiffest listed pair counts at a quarter
/// of p0's overlap at least); 0: not known.
double least_row_sum(const Model& model, const Assembly& assembly, double least_kn) {
  if (model.radius_from_curvature() || with_force(model, [](auto force) { return decltype(force)::root_has_constant; }))
    return 0;
  const double root = std::sqrt(0.25 * assembly.state.reference.overlap);
  return 2 * with_force(model, [&](auto force) { return decltype(force)::normal_stiffness(least_kn, root); });
}

/// Longest sub-step that meets the restitution, s, of collisions of frequency omega.
template <class Impact>
double dashpot_step(const Model& model, double damping, double omega) {
  // At the overlap where omega^2 = n (k/m*) delta^(n - 1), n the exponent of the spring.
  const double power = dashpot_power(model.contact.law, model.damping.dashpot);
  const bool viscoelastic = model.damping.dashpot == Dashpot::viscoelastic, one_ratio = power > 0 && !viscoelastic;
  double gamma = damping;
  if (one_ratio) gamma = damping * omega / std::sqrt(Impact::exponent);
  if (viscoelastic) gamma = damping * omega * omega / Impact::exponent;
  // Power (n - 1)/2 keeps one restitution at all speeds: ln e = -pi zeta / sqrt(1 - zeta^2), zeta = c / (factor sqrt(m*
  // k)).
  const double share = one_ratio ? std::sqrt(Impact::exponent / Impact::factor_squared) : 0.5;
  const double zeta = std::min(0.85, share * gamma / omega);
  const double half_logarithm = 0.5 * pi * zeta / std::sqrt(1 - zeta * zeta);
  return restitution_error / (gamma * (half_logarithm + (power < 0.5 ? 1 : 0)));
}

/// Square root of the part of the energy that moves, 0 to 1.
double dynamic_share(double moving, double elastic) { return moving < elastic ? std::sqrt(moving / elastic) : 1; }

/// Steps that what the pairs and grains show asks for.
template <class Impact>
Collisions limited(const Model& model, const Assembly& assembly, const PairExtremes& all, const GrainMotion& motion,
                   const Outlook& outlook, Collisions found) {
  found.beyond = found.beyond || !std::isfinite(motion.kinetic + motion.resultants);
  const double skin = assembly.state.list.skin;
  const double speed = 2 * std::sqrt(motion.fastest) + outlook.rate.norm() * (2 * model.largest_reach + skin);
  const double flight = dynamic_share(motion.kinetic, all.elastic);
  if (speed * flight > 0) {
    // Nor may it cross what is left of the list's reach, beyond which nothing is known.
    const double known = std::max(0.25 * listed_gap(model, assembly), 0.005 * skin);
    found.step = std::min(flight_per_step * skin, known) / speed / flight;
    found.look = flight_per_look * skin / speed / flight;
  }
  if (all.closing > 0) found.step = std::min(found.step, all.closed / all.closing / increment_steps);
  const double share = dynamic_share(all.approach + motion.resultants, all.elastic);
  const double omega = Impact::frequency(all.stiffness);
  if (!(omega * share > 0)) return found;
  const double steps = double(model.options.collision_steps) * Impact::steps;
  found.step = std::min(found.step, pi / steps / omega / share);
  // A few fast grains among many at rest: half of the step at which the stiffest of their impacts would be unstable.
  if (all.impact > 0) found.step = std::min(found.step, 1 / Impact::frequency(all.impact));
  if (all.damping > 0)
    found.step = std::min(found.step, dashpot_step<Impact>(model, all.damping, omega) / (share * share));
  return found;
}

template <Shape shape, class Impact>
Collisions ahead(const Model& model, const Assembly& assembly, const RowSums* known, bool find_step,
                 const Outlook& outlook) {
  const PairPlaces<shape> pair(model, assembly);
  std::vector<PairExtremes> of_pairs(pieces_in(assembly.pairs.listed));
  in_pieces(assembly.pairs.listed, model.sharing(), [&](std::size_t piece, std::size_t first, std::size_t last) {
    of_pairs[piece] = pairs_in<shape, Impact>(model, assembly, pair, outlook, first, last);
  });
  PairExtremes all;
  for (const PairExtremes& piece : of_pairs) all.add(piece);
  Collisions found;
  found.step = found.look = std::numeric_limits<double>::infinity();
  found.deep = all.deep;
  found.beyond = all.beyond;
  if (!find_step || model.options.collision_steps == 0) return found;

  const std::vector<double> force = resultants_in<dimension_of(shape)>(model, assembly);
  // With the least sum that a grain can have the step comes out no longer: where even that one is not shorter than the
  // step in use, no sums are needed (400 discs 1.02, 1,000 spheres 1.04 times as fast).
  const double least = known == nullptr && outlook.step > 0 ? least_row_sum(model, assembly, all.least_kn) : 0;
  if (least > 0) {
    const GrainMotion motion = motion_of<shape>(
        model, assembly, [&](std::size_t) { return least; }, force);
    const Collisions sooner = limited<Impact>(model, assembly, all, motion, outlook, found);
    if (!(sooner.step < outlook.step)) return sooner;
  }
  RowSums fresh;
  if (known == nullptr) fresh = row_sums(model, assembly);
  const double* stiffness = (known == nullptr ? fresh : *known).translation.data();
  const GrainMotion motion = motion_of<shape>(
      model, assembly, [&](std::size_t g) { return stiffness[g]; }, force);
  return limited<Impact>(model, assembly, all, motion, outlook, found);
}

}  // namespace

Collisions collisions_ahead(const Model& model, const Assembly& assembly, const RowSums* sums, bool find_step,
                            const Outlook& outlook) {
  return with_law(model.contact.law, [&](auto law) {
    using Impact = typename decltype(law)::Force::Impact;
    return with_shape(
        model.shape, [&](auto shape) { return ahead<shape.value, Impact>(model, assembly, sums, find_step, outlook); });
  });
}

}  // namespace rvelab
