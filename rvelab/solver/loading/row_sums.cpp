// The row sums of stiffness: of grains over their pairs, of bodies over the pairs of their members. Declared in
// inertia.hpp, which has the bound.
#include <algorithm>
#include <cmath>

#include "rvelab/solver/assembly/contact_states.hpp"
#include "rvelab/solver/assembly/contact_stiffness.hpp"
#include "rvelab/solver/assembly/gather_table.hpp"
#include "rvelab/solver/assembly/interactions.hpp"
#include "rvelab/solver/assembly/pair_geometry.hpp"
#include "rvelab/solver/loading/inertia.hpp"
#include "rvelab/solver/loading/median.hpp"
#include "rvelab/solver/loading/symmetric.hpp"
#include "rvelab/solver/loading/typical_answers.hpp"

namespace rvelab {

namespace {

/// What a grain collects from its pairs.
template <int D>
struct GrainSums {
  Symmetric<D> stiffness;
  double rotation = 0, dashpot = 0;
  // A listed pair may touch within the steps to come: a grain that is ready for the stiffest of them stays stable even
  // where that contact is ten thousand times stiffer than those it has.
  double stiffest = 0, stiffest_turn = 0;
};

/// What a pair gives to each of its grains.
template <int D>
struct PairTerms {
  /// Barely touching Hertz contacts are soft but will not stay so: at a quarter of p0's overlap at least.
  ContactStiffness firm;
  double firm_translation = 0;
  bool touching = false;
  ContactStiffness now = {};
  double along = 0, across = 0;
  Vec<double, D> n = {};
  Symmetric<D> stiffness = {};         ///< of round grains, the same for both
  double reach[2] = {}, turn[2] = {};  ///< not round: arms of the tangential and the normal force about i and j, m
};

// Row sums go through all pairs: inline and with what they read at hand, so that what a scene does not need falls out.
template <Shape shape, class Force>
class TermsOfPairs {
 public:
  static constexpr int D = dimension_of(shape);

  TermsOfPairs(const Model& model, const Assembly& assembly)
      : model_(model),
        pairs_(assembly.pairs),
        pair_(model, assembly),
        kn_(assembly.pairs.kn.data()),
        kt_(assembly.pairs.kt.data()),
        kr_(model.contact.rolling ? assembly.pairs.kr.data() : nullptr),
        cn_(model.damping.dashpot != Dashpot::none ? assembly.pairs.cn.data() : nullptr),
        law_constant_(assembly.pairs.law_constant.empty() ? nullptr : assembly.pairs.law_constant.data()),
        firm_overlap_(0.25 * assembly.state.reference.overlap) {}

  inline __attribute__((always_inline)) PairTerms<D> operator()(std::size_t p) const {
    decltype(pair_(p)) geometry{};  // of no overlap
    if (!pair_.is_apart(p)) geometry = pair_(p);
    const double overlap = geometry.overlap;
    double ratio = 1;
    // What may come to touch may do so where its curvature is least.
    if constexpr (!is_round(shape))
      ratio = overlap > 0 ? hertz_radius_ratio(model_, pairs_, p, geometry)
                          : hertz_radius_ratios(model_, pairs_, p).largest;
    const PairParameters q{kn_[p], kt_[p],          law_constant_ ? law_constant_[p] : 0, 0, kr_ ? kr_[p] : 0,
                           0,      cn_ ? cn_[p] : 0};
    PairTerms<D> t{rvelab::stiffness_of<Force>(model_, q, std::max(overlap, firm_overlap_), ratio)};
    t.firm_translation = std::max(2 * t.firm.normal, 4 * t.firm.tangential);
    t.touching = overlap > 0;
    if (!t.touching) return t;
    t.now = rvelab::stiffness_of<Force>(model_, q, overlap, ratio);
    // The force turning with the branch (initial stress) adds f_n / length to the tangential stiffness at most.
    const double kt = t.now.tangential + 0.5 * normal_force_of<Force>(q, overlap, ratio) / geometry.length;
    t.along = 2 * t.now.normal - 4 * kt;
    t.across = 4 * kt;
    const Branch& n = geometry.along();
    t.n.x = n.x / geometry.along_length();
    t.n.y = n.y / geometry.along_length();
    if constexpr (D == 3) t.n.z = n.z / geometry.along_length();
    if constexpr (moves_as_body(shape)) {
      // To the surfaces, half an overlap beyond the contact point: of spheres the radius, as where they move by
      // themselves.
      for (int side = 0; side < 2; ++side) {
        const Branch x = side == 0 ? geometry.point : geometry.point_j();
        const double to_surface = side == 0 ? 0.5 * overlap : -0.5 * overlap;
        const double along = x.x * n.x + (x.y * n.y + x.z * n.z), squared = x.x * x.x + (x.y * x.y + x.z * x.z);
        t.turn[side] = std::sqrt(std::max(0.0, squared - along * along));
        t.reach[side] = std::sqrt(squared - along * along + (along + to_surface) * (along + to_surface));
      }
    } else if constexpr (!is_round(shape)) {
      t.reach[0] = geometry.reach_i;
      t.reach[1] = geometry.reach_j;
      t.turn[0] = std::abs(geometry.turn_i);
      t.turn[1] = std::abs(geometry.turn_j);
    } else {
      t.stiffness = stiffness_along<D>(t.along, t.across, t.n);
    }
    return t;
  }

 private:
  const Model& model_;
  const PairTable& pairs_;
  PairPlaces<shape> pair_;
  const double *kn_, *kt_, *kr_, *cn_, *law_constant_;
  double firm_overlap_;
};

/// To translation along n and to rotation, of a normal spring that also turns its grains, at the arm `turn` (m):
/// (u + turn w)^2 <= (1 + turn/r) u^2 + (turn^2 + turn r) w^2.
double normal_to_translation(double kn, double turn, double r) { return 2 * kn * (turn / r); }
double normal_to_rotation(double kn, double turn, double r) { return 2 * kn * (turn * turn + turn * r); }

/// Where the forces of a contact act on what moves, m: about a grain, or about the body that it is a member of.
struct Levers {
  double radius;         ///< what its spin is compared by
  double squared, once;  ///< of the tangential force, as the product that it is
  double turn;           ///< of the normal force
  double outer, far;     ///< the largest that both may have
};

/// What a contact gives to a grain or body. `turned`: its normal force turns it too; of round grains that move by
/// themselves that part falls out.
template <bool turned, int D>
inline __attribute__((always_inline)) void add(const Damping& damping, const PairTerms<D>& t, const Levers& at,
                                               GrainSums<D>& sums) {
  double stiffest = t.firm_translation,
         stiffest_turn = 4 * t.firm.tangential * at.outer * at.outer + 2 * t.firm.rolling;
  if constexpr (turned) {
    stiffest += normal_to_translation(t.firm.normal, at.far, at.radius);
    stiffest_turn += normal_to_rotation(t.firm.normal, at.far, at.radius);
  }
  sums.stiffest = std::max(sums.stiffest, stiffest);
  sums.stiffest_turn = std::max(sums.stiffest_turn, stiffest_turn);
  if (!t.touching) return;
  double rotation = 4 * t.now.tangential * at.squared * at.once + 2 * t.now.rolling;
  if constexpr (turned) {
    add_to<D>(sums.stiffness,
              stiffness_along<D>(t.along + normal_to_translation(t.now.normal, at.turn, at.radius), t.across, t.n));
    rotation += normal_to_rotation(t.now.normal, at.turn, at.radius);
  } else {
    add_to<D>(sums.stiffness, t.stiffness);
  }
  sums.rotation += rotation;
  if (damping.dashpot != Dashpot::none) sums.dashpot += 2 * t.now.dashpot * std::max(1.0, 2 * damping.tangential_ratio);
}

/// To grain g.
template <Shape shape>
inline __attribute__((always_inline)) void add(const Model& model, const PairTerms<dimension_of(shape)>& t,
                                               std::size_t g, bool as_j, GrainSums<dimension_of(shape)>& sums) {
  const double r = model.radius.data()[g];
  if constexpr (is_round(shape)) {
    add<false>(model.damping, t, {r, r, r, 0, r, 0}, sums);
  } else {
    // What may come to touch may do so anywhere.
    double outer, far;
    if constexpr (moves_as_body(shape)) {
      outer = model.outer_radius[g], far = model.form[9 * g + 8];
    } else {
      const Extent extent = Description<shape>::extent(own_of<Description<shape>>(model.own, g));
      outer = extent.outer, far = extent.turning;
    }
    add<true>(model.damping, t, {r, t.reach[as_j], t.reach[as_j], t.turn[as_j], outer, far}, sums);
  }
}

/// Adds the interactions other than contacts: as contacts, with arms as they are and with both moments.
template <int D>
void add_interactions(const Model& model, const Assembly& assembly, std::vector<GrainSums<D>>& sums) {
  if (!has_interactions(assembly)) return;
  for (const ActingInteraction& a : acting_interactions(model, assembly)) {
    const double kt = a.stiffness.tangential + 0.5 * std::abs(a.normal_force) / a.length;
    const double turning = 2 * std::max(a.stiffness.bending, a.stiffness.twisting);
    // A branch that a force pulls apart softens: its stiffness is clamped at zero.
    const Symmetric<D> stiffness =
        stiffness_along<D>(2 * std::max(0.0, a.stiffness.normal) - 4 * kt, 4 * kt, first_of<D>(a.normal.data()));
    for (const bool as_j : {false, true}) {
      GrainSums<D>& of = sums[as_j ? a.j : a.i];
      const double arm = as_j ? a.arm_j : a.arm_i;
      add_to<D>(of.stiffness, stiffness);
      of.rotation += 4 * a.stiffness.tangential * arm * arm + turning;
    }
  }
}

/// Sums of bodies (clumps): a contact moves the body at its arm a, u + w x a. Its normal spring turns the body too, at
/// the lever |a x n|, as it does grains that are not round.
template <Shape shape, class Force>
std::vector<GrainSums<dimension_of(shape)>> sums_of_bodies(const Model& model, const Assembly& assembly) {
  constexpr int D = dimension_of(shape);
  const BodyModel& bodies = *model.bodies;
  std::vector<GrainSums<D>> sums(bodies.size());
  if constexpr (is_round(shape)) {
    const TermsOfPairs<shape, Force> terms_of(model, assembly);
    for (const std::int32_t row : assembly.pairs.order) {
      const auto p = std::size_t(row);
      const PairTerms<D> t = terms_of(p);
      for (const bool as_j : {false, true}) {
        const auto g = std::size_t(as_j ? assembly.pairs.j[p] : assembly.pairs.i[p]);
        const auto b = std::size_t(bodies.owner[g]);
        const Vector3 arm = assembly.bodies.arm(g);
        const double r = model.radius[g], far = arm.norm();
        Levers at{bodies.radius[b], 0, 1, 0, far + r, far};
        if (t.touching) {
          Vector3 n(t.n.x, t.n.y, 0);
          if constexpr (D == 3) n[2] = t.n.z;
          const double along = arm.dot(n), reach = as_j ? -r : r;  // as of grains that move by themselves
          at.squared = arm.squaredNorm() + 2 * reach * along + reach * reach;
          at.turn = std::sqrt(std::max(0.0, arm.squaredNorm() - along * along));
        }
        add<true>(model.damping, t, at, sums[b]);
      }
    }
  }
  return sums;
}

/// Stiffnesses of the contacts, of which floors are medians.
struct Firmness {
  std::vector<double> translation, rotation;
  std::size_t count = 0;  ///< of contacts so far

  void expect(std::size_t contacts) { translation.resize(contacts), rotation.resize(contacts); }
  template <int D>
  inline __attribute__((always_inline)) void add(const PairTerms<D>& t, double ri, double rj) {
    if (!t.touching) return;
    translation[count] = t.firm_translation;
    rotation[count++] = 4 * t.firm.tangential + 2 * t.firm.rolling / std::min(ri * ri, rj * rj);
  }
};

/// Sums of all grains. Each pair is visited once; by a team once for each of its grains, so that threads share
/// nothing. A grain adds its pairs in the same order either way.
template <Shape shape, class Force>
std::vector<GrainSums<dimension_of(shape)>> sums_of_grains(const Model& model, const Assembly& assembly,
                                                           Firmness& firmness) {
  constexpr int D = dimension_of(shape);
  std::vector<GrainSums<D>> sums(model.size());
  const TermsOfPairs<shape, Force> terms_of(model, assembly);
  const double* radius = model.radius.data();
  const std::int32_t *grain_i = assembly.pairs.i.data(), *grain_j = assembly.pairs.j.data();
  if (model.sharing() == nullptr) {
    firmness.expect(assembly.pairs.listed);
    for (const std::int32_t row : assembly.pairs.order) {
      const auto p = std::size_t(row), i = std::size_t(grain_i[p]), j = std::size_t(grain_j[p]);
      const PairTerms<D> t = terms_of(p);
      add<shape>(model, t, i, false, sums[i]);
      add<shape>(model, t, j, true, sums[j]);
      firmness.add(t, radius[i], radius[j]);
    }
    firmness.expect(firmness.count);
    return sums;
  }
  std::vector<Firmness> of_piece(pieces_in(model.size()));
  in_pieces(model.size(), model.sharing(), [&](std::size_t piece, std::size_t first, std::size_t last) {
    Firmness& own = of_piece[piece];
    each_pair_of_grains<D>(assembly.pairs, first, last, [&](std::size_t g, std::size_t p, bool as_j) {
      const bool own_image = grain_i[p] == grain_j[p];
      if (own_image && as_j) return;  // both at once where the grain is i, as above
      const PairTerms<D> t = terms_of(p);
      add<shape>(model, t, g, as_j, sums[g]);
      if (own_image) add<shape>(model, t, g, true, sums[g]);
      if (as_j) return;
      if (own.count == own.translation.size()) own.expect(2 * own.count + 64);
      own.add(t, radius[std::size_t(grain_i[p])], radius[std::size_t(grain_j[p])]);
    });
    own.expect(own.count);
  });
  for (const Firmness& piece : of_piece) {
    firmness.translation.insert(firmness.translation.end(), piece.translation.begin(), piece.translation.end());
    firmness.rotation.insert(firmness.rotation.end(), piece.rotation.begin(), piece.rotation.end());
  }
  return sums;
}

template <Shape shape, class Force>
RowSums sums_over_pairs(const Model& model, const Assembly& assembly) {
  constexpr int D = dimension_of(shape);
  const std::size_t n = model.size();
  const bool dashpot = model.damping.dashpot != Dashpot::none;
  Firmness firmness;
  std::vector<GrainSums<D>> of_grain = sums_of_grains<shape, Force>(model, assembly, firmness);
  add_interactions<D>(model, assembly, of_grain);
  RowSums sums;
  sums.rotation.resize(n);
  sums.translation.resize(n);
  if (dashpot) sums.dashpot.resize(n);
  in_pieces(n, model.sharing(), [&](std::size_t, std::size_t first, std::size_t last) {
    for (std::size_t g = first; g < last; g += 2) {
      const std::size_t next = std::min(g + 1, last - 1);
      const V2 largest = largest_eigenvalues(of_grain[g].stiffness, of_grain[next].stiffness);
      sums.translation[g] = std::max(largest[0], of_grain[g].stiffest);
      sums.translation[next] = std::max(largest[next - g], of_grain[next].stiffest);
    }
    for (std::size_t g = first; g < last; ++g) {
      sums.rotation[g] = std::max(of_grain[g].rotation, of_grain[g].stiffest_turn);
      if (dashpot) sums.dashpot[g] = of_grain[g].dashpot;
    }
  });
  if (model.bodies && is_round(shape)) {  // of other bodies the sums of their grains are theirs
    const std::vector<GrainSums<D>> of_bodies = sums_of_bodies<shape, Force>(model, assembly);
    for (std::size_t g = 0; g < n; ++g) {
      const GrainSums<D>& of = of_bodies[std::size_t(model.bodies->owner[g])];
      const double share = model.share_of(g);
      sums.translation[g] = share * std::max(largest_eigenvalue(of.stiffness), of.stiffest);
      sums.rotation[g] = std::max(of.rotation, of.stiffest_turn);
      if (dashpot) sums.dashpot[g] = share * of.dashpot;
    }
  }
  if (firmness.translation.empty()) {
    // Nothing touches: what two contacts of typical grains would have at a thousandth of a radius of overlap.
    const auto [k, radius] = typical_contact(model);
    firmness.translation.push_back(std::max(2 * k.normal, 4 * k.tangential));
    firmness.rotation.push_back(4 * k.tangential + 2 * k.rolling / (radius * radius));
  }
  double medians[2];
  const auto find_median = [&](std::size_t which) {
    medians[which] = median(which == 0 ? firmness.translation : firmness.rotation);
  };
  if (model.sharing() != nullptr)
    model.sharing()->for_each(2, find_median);
  else
    for (const std::size_t which : {0, 1}) find_median(which);
  sums.floor_translation = 2 * medians[0];
  sums.floor_rotation = 2 * medians[1];
  // Without tangential and rolling stiffness nothing turns the grains; any inertia serves.
  if (sums.floor_rotation == 0) sums.floor_rotation = sums.floor_translation;
  return sums;
}

}  // namespace

RowSums row_sums(const Model& model, const Assembly& assembly) {
  return with_force(model, [&](auto force) {
    using Force = decltype(force);
    return with_shape(model.shape, [&](auto shape) { return sums_over_pairs<shape.value, Force>(model, assembly); });
  });
}

}  // namespace rvelab
