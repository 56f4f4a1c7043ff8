// What the law of an assembly makes of a contact at an overlap, outside the step kernels.
#pragma once

#include "rvelab/solver/assembly/assembly.hpp"
#include "rvelab/solver/assembly/pair_place.hpp"

namespace rvelab {

/// Parameters of a listed pair.
inline PairParameters parameters_of(const Model& model, const PairTable& pairs, std::size_t p) {
  const bool rolling = model.contact.rolling;
  return {pairs.kn[p],
          pairs.kt[p],
          pairs.law_constant.empty() ? 0 : pairs.law_constant[p],
          pairs.friction[p],
          rolling ? pairs.kr[p] : 0,
          rolling ? pairs.moment_cap[p] : 0,
          model.damping.dashpot != Dashpot::none ? pairs.cn[p] : 0};
}

/// Of one contact now: d f_n/d overlap, N/m; k_t, N/m; k_r, N m; normal dashpot coefficient, N s/m.
struct ContactStiffness {
  double normal, tangential, rolling, dashpot;
};

/// R*/r* of a listed pair that lies there: 1, but for Hertz's radius from curvature (contact/hertz_curvature.hpp).
inline double hertz_radius_ratio(const Model&, const PairTable&, std::size_t, const PairPlace&) { return 1; }
inline double hertz_radius_ratio(const Model& model, const PairTable& pairs, std::size_t p, const OutlinePlace& at) {
  if (!model.radius_from_curvature()) return 1;
  return at.hertz_radius_ratio(model.radius[std::size_t(pairs.i[p])], model.radius[std::size_t(pairs.j[p])]);
}
inline double hertz_radius_ratio(const Model& model, const PairTable& pairs, std::size_t p, const SolidPlace& at) {
  if (!model.radius_from_curvature()) return 1;
  return radius_ratio_of(at.hertz_radius, model.radius[std::size_t(pairs.i[p])], model.radius[std::size_t(pairs.j[p])]);
}
/// The least and the largest that it can be, however the grains turn: tip to tip and flank to flank.
struct RadiusRatios {
  double least = 1, largest = 1;
};
inline RadiusRatios hertz_radius_ratios(const Model& model, const PairTable& pairs, std::size_t p) {
  if (!model.radius_from_curvature()) return {};
  const auto i = std::size_t(pairs.i[p]), j = std::size_t(pairs.j[p]);
  if (moves_as_body(model.shape)) {
    const auto radii = [&](std::size_t g) {
      return SuperellipsoidGrain::radii_of_curvature(own_of<SuperellipsoidGrain>(model.own, g));
    };
    const auto at_i = radii(i), at_j = radii(j);
    const auto ratio = [&](double ri, double rj) {
      return radius_ratio_of(ri * rj / (ri + rj), model.radius[i], model.radius[j]);
    };
    return {ratio(at_i.least, at_j.least), ratio(at_i.largest, at_j.largest)};
  }
  const Extent at_i = model.extent_of(i), at_j = model.extent_of(j);
  return {hertz_radius_ratio(model.radius[i], at_i.outer, model.radius[j], at_j.outer),
          hertz_radius_ratio(model.radius[i], at_i.inner, model.radius[j], at_j.inner)};
}

/// What the stiffnesses of a law go with, m^0.5: sqrt(overlap) of most.
template <class Force>
double root_of(const PairParameters& q, double overlap, double radius_ratio) {
  return Force::root(overlap * radius_ratio, q.law_constant);
}

/// c_n at an overlap and its root, N s/m.
template <class Force>
double dashpot_now(const Model& model, const PairParameters& q, double overlap, double root) {
  const double power = dashpot_power(model.contact.law, model.damping.dashpot);
  return Force::dashpot(q.cn, overlap, root, q.law_constant, int(4 * power));
}

/// `Force`: that of the specimen's law (contact/laws.hpp). The overlap is > 0, m.
template <class Force>
ContactStiffness stiffness_of(const Model& model, const PairParameters& q, double overlap, double radius_ratio = 1) {
  const bool dashpot = model.damping.dashpot != Dashpot::none;
  const double root = Force::needs_root_overlap || dashpot ? root_of<Force>(q, overlap, radius_ratio) : 0;
  return {Force::normal_stiffness(q.kn, root), Force::tangential_stiffness(q.kt, root),
          Force::tangential_stiffness(q.kr, root), dashpot ? dashpot_now<Force>(model, q, overlap, root) : 0};
}
template <class Force>
double normal_force_of(const PairParameters& q, double overlap, double radius_ratio = 1) {
  const double root = Force::needs_root_overlap ? root_of<Force>(q, overlap, radius_ratio) : 0;
  return Force::normal_force(q.kn, overlap, root, q.law_constant);
}

/// call(Force{}) with the Force of the specimen's law.
template <class Call>
auto with_force(const Model& model, const Call& call) {
  return with_law(model.contact.law, [&](auto law) { return call(typename decltype(law)::Force{}); });
}

}  // namespace rvelab
