#include "rvelab/pack/draw.hpp"

#include <algorithm>
#include <cmath>

#include "rvelab/error.hpp"
#include "rvelab/measure/measures.hpp"
#include "rvelab/measure/proportions.hpp"
#include "rvelab/pack/agitation.hpp"
#include "rvelab/pack/consolidation.hpp"
#include "rvelab/pack/first_contact.hpp"

namespace rvelab::pack {

namespace {

/// With the preparation friction only the density counts, not the balance.
constexpr Rest prepared{5e-2, 1e-2, 0.5, 10, 200};

/// Times that the cell shrinks again after grains have collapsed and lost their pressure.
constexpr int most_attempts = 5;

/// With the final friction: the void ratio is there to a few 1e-4.
constexpr Rest nearly{5e-3, 1e-3, 0.5, 10, 2000};

/// Sub-steps that a draw may make once its grains bear the pressure: a multiple of what packings need, which
/// grows with the edge of the cell.
long most_substeps(const Recipe& recipe) {
  constexpr double of_small_cells = 3e6, grains_of_small_cells = 400;
  const double edge = std::pow(double(recipe.number) / grains_of_small_cells, 1.0 / dimension_of(recipe.shape));
  return long(of_small_cells * std::max(1.0, edge));
}

/// Change of the void ratio by coming to rest; a draw further from the target is given up.
constexpr double still_to_come = 5e-4;

/// The assembly with the number of sub-steps by its balance. The overlaps at the final pressure set the scale of the
/// strain per sub-step; with those of the start it would be far too small. The density does not depend on that balance.
Rve steered(const Rve& rve, const Recipe& recipe, const DrawWatch& watch) {
  Specimen s = rve.specimen();
  s.solver = SolverOptions{};
  s.solver.target_unbalanced = 1e-2;
  s.solver.max_overlap_ratio = 1e3;  // on the way; the end is checked
  s.state = SolverState{};
  if (recipe.stress) {
    const Network network = rve.network();
    double overlap = 0;
    for (const ContactState& contact : network.contacts) overlap += contact.overlap;
    overlap /= std::max(1.0, double(network.contacts.size()));
    const int d = network.dimension();
    const double rise = mean_pressure(*recipe.stress, d) / mean_pressure(contact_stress(network), d);
    s.state.reference.overlap = 3 * overlap * std::clamp(rise, 1.0, 10.0);
  }
  Rve other(s);
  other.watch(watch.stop);
  return other;
}

/// Throws OverlapBeyondLimit if the largest overlap is more than `share` of what the recipe allows.
void expect_overlaps(const Recipe& recipe, const Rve& rve, double share) {
  const Network network = rve.network();
  const double largest = largest_overlap_ratio(network), limit = recipe.solver.max_overlap_ratio;
  if (largest <= share * limit) return;
  std::string text = "packing: grains overlap by " + in_words(largest) +
                     " of the smaller radius; solver.max_overlap_ratio allows " + in_words(limit) + "; ";
  if (!recipe.stress) throw OverlapBeyondLimit(text + "the cell is too small for its grains: raise target.void_ratio");
  const double diameter = mean_diameter(network);
  text += "take stiffer grains or a lower pressure (" + in_words(proportions_of(network)) + ")";
  if (dimension_of(recipe.shape) == 2 && recipe.thickness > 2 * diameter)
    text += ", or a slab about as thick as a grain: pack.thickness_m = " + in_words(recipe.thickness) + " m is " +
            in_words(recipe.thickness / diameter) + " mean diameters, and the force on a grain grows with it";
  throw OverlapBeyondLimit(text + "; check the units of radii and stiffness");
}

/// Consolidates, and turns the cell back upright. A stress that is not isotropic turns with it and is corrected, by
/// less each time.
bool consolidated_upright(Rve& rve, const StressGoal& goal, const Rest& rest, const Matrix3& frame,
                          Matrix3& deformation, StepsLeft& left) {
  for (long round = 0; round < rest.max_rounds; ++round) {
    if (!consolidate(rve, goal, rest, deformation, &left)) return false;
    const Matrix3 turn = upright_again(deformation, frame);
    rve.apply(turn, 0);
    deformation += turn * deformation;
    if (largest_gap(goal, rve.stress()) <= rest.stress_tolerance * goal.pressure()) return true;
  }
  return false;
}

/// Strains of the cell while agitated grains are compressed (Agitation), over the larger one.
PressStrains press_strains(const Recipe& recipe, double difference) {
  PressStrains strains = Vector3::Constant(difference > 0 ? 1 - difference : 1);
  strains[fabric_axis(recipe)] = difference > 0 ? 1 : 1 + difference;
  return strains;
}

/// Agitates grains that are under the stress with their preparation friction, and compresses them with their own, until
/// their contacts are as wanted or the search for that ends.
Rve agitated_and_compressed(const Recipe& recipe, const Rve& prepared, const StressGoal& goal, const Agitation& first,
                            Uniform& uniform, const DrawWatch& watch, Matrix3& deformation, StepsLeft& left,
                            Draw& result) {
  const Matrix3 deformation_before = deformation;
  ContactSearch search(recipe, first);
  while (true) {
    const Agitation by = search.next();
    Rve rve = agitated(prepared, by.expansion, uniform, watch);
    rve.set_materials(recipe.materials);
    deformation = deformation_before;
    rve =
        steered(pressed(recipe, rve, watch, press_strains(recipe, by.strain_difference), &deformation), recipe, watch);
    consolidate(rve, goal, nearly, deformation, &left);
    const Network network = rve.network();
    if (network.contacts.empty()) throw IncrementFailed("packing: the agitated grains came apart under the stress");
    search.add(compressed_state(recipe, by, network));
    if (!search.met() && !search.given_up()) continue;
    result.compressed = search.made();
    result.contacts_in_vain = search.in_vain();
    result.next_agitation = search.next();
    return rve;
  }
}

}  // namespace

Draw draw(const Recipe& recipe, long number, double friction, const DrawWatch& watch, const Agitation& agitation) {
  const int d = dimension_of(recipe.shape);
  Uniform uniform(recipe.seed, std::uint64_t(number));
  Rve rve = steered(in_first_contact(recipe, friction, uniform, watch), recipe, watch);
  Draw result;
  result.friction = friction;
  const Matrix3 frame = rve.cell().rotation;  // as it was drawn: what came before shrank it
  Matrix3 deformation = Matrix3::Identity();
  if (recipe.stress) {
    StepsLeft left{0, most_substeps(recipe),
                   [&](long substeps) { watch.after("bringing the grains to rest at the stress", substeps); }};
    StressGoal goal{isotropic_stress(mean_pressure(*recipe.stress, d), recipe.shape), true, d};
    for (int attempt = 0; !consolidate(rve, goal, prepared, deformation, &left) && attempt < most_attempts; ++attempt) {
      rve = steered(pressed(recipe, rve, watch), recipe, watch);
    }
    expect_overlaps(recipe, rve, 1.5);  // this far beyond, no later step helps
    goal.stress = *recipe.stress;
    if (is_agitated(recipe)) {
      rve = agitated_and_compressed(recipe, rve, goal, agitation, uniform, watch, deformation, left, result);
    } else {
      rve.set_materials(recipe.materials);
      consolidate(rve, goal, nearly, deformation, &left);
    }
    expect_overlaps(recipe, rve, 1);
    result.void_ratio = void_ratio(rve.network());
    const double miss = recipe.void_ratio ? std::abs(result.void_ratio - *recipe.void_ratio) : 0;
    const bool contacts = result.compressed.empty() || result.compressed.back().meets(recipe.contacts);
    if (!contacts) result.void_ratio = result.compressed.back().void_ratio_at(recipe.contacts);
    if (miss > recipe.void_ratio_tolerance + still_to_come || !contacts) return result;
    Rest rest;
    rest.stress_tolerance = recipe.stress_tolerance;
    rest.unbalanced = recipe.unbalanced;
    result.at_rest = consolidated_upright(rve, goal, rest, frame, deformation, left);
    if (!result.at_rest) result.why_not = rest_in_words(rve, goal, left.made);
  } else {
    rve.set_materials(recipe.materials);
    result.at_rest = rve.relax(recipe.unbalanced, 100'000).target_held;
  }
  expect_overlaps(recipe, rve, 1);
  const Network network = rve.network();
  result.void_ratio = void_ratio(network);
  if (!result.compressed.empty())
    result.compressed.push_back(compressed_state(recipe, result.compressed.back().by, network));
  result.specimen = rve.specimen();
  result.specimen.damping = recipe.damping;
  result.specimen.solver = recipe.solver;
  result.specimen.state = SolverState{};
  for (Body& body : result.specimen.bodies) body.velocity = body.spin = Vector3::Zero();
  auto& grains = result.specimen.grains;
  for (auto* v : {&grains.velocity, &grains.spin}) std::fill(v->begin(), v->end(), Vector3::Zero());
  return result;
}

}  // namespace rvelab::pack
