#include "rvelab/pack/draw.hpp"

#include <algorithm>
#include <cmath>

#include "rvelab/error.hpp"
#include "rvelab/measure/measures.hpp"
#include "rvelab/measure/proportions.hpp"
#include "rvelab/pack/consolidation.hpp"
#include "rvelab/pack/regular.hpp"
#include "rvelab/pack/scatter.hpp"

namespace rvelab::pack {

namespace {

/// Solid fraction at which grains of full size are placed at random: most fit at the first tries.
double scattered_fraction(int dimension) { return dimension == 2 ? 0.45 : 0.25; }

/// Contacts per grain from which the assembly jams soon.
double crowded(int dimension) { return 0.25 * dimension; }

constexpr double clearance = 5e-4;  ///< of the radius, left around grains that need not touch

/// Strains by which a cell shrinks, per axis: before grains touch, and until they carry pressure. Every draw starts at
/// a random place within a step: loose grains jam at the end of one, and from a common start their void ratios would be
/// multiples of d (1 + e) press_step.
constexpr double approach_step = 1e-2, press_step = 1e-3;

/// Before grains touch, there is no network whose balance could determine the number of sub-steps: it is fixed.
/// Overlaps are not limited, since a light grain caught between two others is pushed out again.
SolverOptions unsteered() {
  SolverOptions options;
  options.fixed_substeps = 50;
  options.max_overlap_ratio = 1e3;
  return options;
}

Specimen assembly(const Recipe& recipe, double friction, const Grains& grains, const Cell& cell) {
  Specimen s;
  s.shape = recipe.shape;
  s.cell = cell;
  s.materials = preparing(recipe, friction);
  s.contact = recipe.contact;
  s.solver = unsteered();
  s.grains = grains;
  return s;
}

double contacts_per_grain(const Rve& rve) {
  const Network network = rve.network();
  return double(network.contacts.size()) / double(network.grains.size());
}

void shrink(Rve& rve, double strain) {
  Matrix3 gradient = Matrix3::Zero();
  for (int k = 0; k < rve.cell().dimension; ++k) gradient(k, k) = -strain;
  rve.apply(gradient, 0);
}

/// Shrinks the cell until grains that are apart crowd.
void approach(Rve& rve, int d, const DrawWatch& watch) {
  for (int round = 0; contacts_per_grain(rve) < crowded(d); ++round) {
    watch.at("bringing the grains together", contacts_per_grain(rve) / crowded(d));
    shrink(rve, approach_step);
    if (round == 300) throw IncrementFailed("packing: no contacts after 300 compressions by 1 %; check the radii");
  }
}

/// Shrinks until the grains carry a tenth of the pressure in a cell at rest. A step beyond the pressure is undone and
/// repeated shorter, else stiff grains would become too dense.
void press(const Recipe& recipe, Rve& rve, const DrawWatch& watch) {
  const int d = dimension_of(recipe.shape);
  const double pressure = mean_pressure(*recipe.stress, d);
  const auto settled_part = [&] {
    for (int slice = 0; slice < 30; ++slice) {
      if (mean_pressure(rve.stress(), d) < 0.1 * pressure) return 0.0;
      if (rve.relax(1e-2, 100).target_held) break;
    }
    return mean_pressure(rve.stress(), d) / pressure;
  };
  double strain = press_step;
  double part = settled_part();
  for (int round = 0; part < 0.1; ++round) {
    watch.after("pressing the grains", 50L * round);
    const Rve before = rve;
    shrink(rve, strain);
    part = settled_part();
    if (part > 1 && strain > 1e-9) {
      rve = before;
      strain *= 0.25;
      part = 0;
    }
    if (round == 5000)
      throw IncrementFailed("packing: no pressure after 5000 compressions; check radii, stiffness, target.pressure_Pa");
  }
}

std::vector<double> scaled(std::vector<double> lengths, double factor) {
  for (double& length : lengths) length *= factor;
  return lengths;
}

/// Gives grains the sizes of `full`, times `factor`.
void set_sizes(const Grains& full, double factor, Grains& grains) {
  grains.radius = scaled(full.radius, factor);
  each_own_column([&](const auto&, auto& to, const auto& from) { to = scaled(from, factor); }, grains, full);
}

/// The same assembly, at rest, with other sizes; contacts keep their history.
Rve with_sizes(const Rve& rve, const Grains& full, double factor, const DrawWatch& watch) {
  Specimen s = rve.specimen();
  set_sizes(full, factor, s.grains);
  s.state = SolverState{};
  for (auto* v : {&s.grains.velocity, &s.grains.spin}) std::fill(v->begin(), v->end(), Vector3::Zero());
  Rve other(s);
  other.watch(watch.stop);
  return other;
}

/// The cell shrinks around grains that were scattered without contact, until they carry a tenth of the recipe's
/// pressure at rest.
Rve by_compression(const Recipe& recipe, const Grains& graded, double friction, Uniform& uniform,
                   const DrawWatch& watch) {
  const int d = dimension_of(recipe.shape);
  Grains grains = graded;
  double volume = solid_volume(recipe, grains) / scattered_fraction(d) * (1 + d * approach_step * uniform());
  while (!scatter(recipe.shape, cell_of(recipe, volume), 1, grains, uniform, watch)) volume *= 1.1;
  Rve rve(assembly(recipe, friction, grains, cell_of(recipe, volume)));
  rve.watch(watch.stop);
  approach(rve, d, watch);
  press(recipe, rve, watch);
  return rve;
}

/// The same of clumps, which are scattered by the circles (spheres) around them.
Rve clumps_by_compression(const Recipe& recipe, const Grains& graded, double friction, Uniform& uniform,
                          const DrawWatch& watch) {
  const int d = dimension_of(recipe.shape);
  const std::vector<const Clump*> clumps = clumps_of(recipe, graded);
  Grains around = around_clumps(clumps, graded);
  double volume = solid_volume(recipe, around) / scattered_fraction(d) * (1 + d * approach_step * uniform());
  while (!scatter(recipe.shape, cell_of(recipe, volume), 1, around, uniform, watch)) volume *= 1.1;
  Specimen s = assembly(recipe, friction, Grains{}, cell_of(recipe, volume));
  put_clumps(clumps, graded, around, uniform, s);
  Rve rve(s);
  rve.watch(watch.stop);
  approach(rve, d, watch);
  press(recipe, rve, watch);
  return rve;
}

/// The same of superellipsoids, by the spheres around them.
Rve solids_by_compression(const Recipe& recipe, const Grains& graded, double friction, Uniform& uniform,
                          const DrawWatch& watch) {
  Grains grains = graded;
  double volume = 0;
  for (const double reach : reach_of(recipe.shape, grains)) volume += grain_volume(recipe.shape, reach, 1);
  volume *= (1 + 3 * approach_step * uniform()) / scattered_fraction(3);
  while (!scatter(recipe.shape, cell_of(recipe, volume), 1, grains, uniform, watch)) volume *= 1.1;
  Specimen s = assembly(recipe, friction, Grains{}, cell_of(recipe, volume));
  put_solids(recipe, grains, uniform, s);
  Rve rve(s);
  rve.watch(watch.stop);
  approach(rve, 3, watch);
  press(recipe, rve, watch);
  return rve;
}

/// The grains are laid in rows that touch (regular.hpp), and the cell then shrinks as above.
Rve by_rows(const Recipe& recipe, const Grains& graded, double friction, const DrawWatch& watch) {
  Grains grains = graded;
  const Cell cell = lay_rows(recipe, grains);
  Rve rve(assembly(recipe, friction, grains, cell));
  rve.watch(watch.stop);
  press(recipe, rve, watch);
  return rve;
}

/// The grains grow, from first_size of their radii, in a cell that stands still; with a stress the cell then shrinks as
/// above. Without one its void ratio is the recipe's, and grains that can be apart are.
Rve by_growth(const Recipe& recipe, const Grains& graded, double friction, Uniform& uniform, const DrawWatch& watch) {
  const int d = dimension_of(recipe.shape);
  const Preparation& preparation = recipe.preparation;
  double volume = solid_volume(recipe, graded) * (1 + growth_void_ratio(recipe));
  if (recipe.stress) volume *= 1 + d * press_step * uniform();
  const Cell cell = cell_of(recipe, volume);
  Grains grains = graded;
  if (!scatter(recipe.shape, cell, preparation.first_size, grains, uniform, watch))
    throw InputError("preparation.first_size = " + std::to_string(preparation.first_size) +
                     " leaves no room to scatter the grains; allowed: above 0 to below 1; give a smaller one");
  set_sizes(graded, preparation.first_size, grains);
  Rve rve(assembly(recipe, friction, grains, cell));
  rve.watch(watch.stop);
  const double full_size = recipe.stress ? 1 : 1 + clearance;
  for (double size = preparation.first_size; size < full_size;) {
    watch.at("growing the grains", size);
    const bool touching = contacts_per_grain(rve) >= crowded(d);
    size = std::min(full_size, size * (touching ? 1.001 : 1.01));
    rve = with_sizes(rve, graded, size, watch);
    rve.relax(1e-3, 50);
  }
  if (recipe.stress) {
    press(recipe, rve, watch);
    return rve;
  }
  rve.relax(recipe.unbalanced, 50'000);
  return with_sizes(rve, graded, 1, watch);
}

/// The cell of an assembly that has lost its pressure shrinks again, as above.
Rve pressed_again(const Recipe& recipe, const Rve& rve, const DrawWatch& watch) {
  Specimen s = rve.specimen();
  s.solver = unsteered();
  Rve other(s);
  other.watch(watch.stop);
  press(recipe, other, watch);
  return other;
}

}  // namespace

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

}  // namespace

Draw draw(const Recipe& recipe, long number, double friction, const DrawWatch& watch) {
  const int d = dimension_of(recipe.shape);
  Uniform uniform(recipe.seed, std::uint64_t(number));
  const Grains graded = graded_grains(recipe);
  const bool growth = recipe.preparation.method == Preparation::Method::growth || !recipe.stress;
  Rve rve = recipe.preparation.method == Preparation::Method::regular ? by_rows(recipe, graded, friction, watch)
            : moves_as_body(recipe.shape) ? solids_by_compression(recipe, graded, friction, uniform, watch)
            : recipe.clumps               ? clumps_by_compression(recipe, graded, friction, uniform, watch)
            : growth                      ? by_growth(recipe, graded, friction, uniform, watch)
                                          : by_compression(recipe, graded, friction, uniform, watch);

  rve = steered(rve, recipe, watch);
  Draw result;
  result.friction = friction;
  const Matrix3 frame = rve.cell().rotation;  // as it was drawn: what came before shrank it
  Matrix3 deformation = Matrix3::Identity();
  if (recipe.stress) {
    StepsLeft left{0, most_substeps(recipe),
                   [&](long substeps) { watch.after("bringing the grains to rest at the stress", substeps); }};
    StressGoal goal{isotropic_stress(mean_pressure(*recipe.stress, d), recipe.shape), true, d};
    for (int attempt = 0; !consolidate(rve, goal, prepared, deformation, &left) && attempt < most_attempts; ++attempt) {
      rve = steered(pressed_again(recipe, rve, watch), recipe, watch);
    }
    expect_overlaps(recipe, rve, 1.5);  // this far beyond, no later step helps
    rve.set_materials(recipe.materials);
    goal.stress = *recipe.stress;
    consolidate(rve, goal, nearly, deformation, &left);
    expect_overlaps(recipe, rve, 1);
    result.void_ratio = void_ratio(rve.network());
    const double miss = recipe.void_ratio ? std::abs(result.void_ratio - *recipe.void_ratio) : 0;
    if (miss > recipe.void_ratio_tolerance + still_to_come) return result;
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
  result.void_ratio = void_ratio(rve.network());
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
