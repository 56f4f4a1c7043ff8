#include "rvelab/pack/approach.hpp"

#include <algorithm>
#include <cmath>

#include "rvelab/error.hpp"
#include "rvelab/measure/measures.hpp"
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

double contacts_per_grain(const Rve& rve) { return double(rve.network().contacts.size()) / double(rve.size()); }

void shrink(Rve& rve, double strain) {
  Matrix3 gradient = Matrix3::Zero();
  for (int k = 0; k < rve.cell().dimension; ++k) gradient(k, k) = -strain;
  rve.apply(gradient, 0);
}

/// Shrinks until the grains carry a tenth of the pressure in a cell at rest. A step beyond the pressure is undone and
/// repeated shorter, else stiff grains would become too dense.
void press(const Recipe& recipe, Rve& rve) {
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
Rve with_sizes(const Rve& rve, const Grains& full, double factor, const std::atomic<bool>* stop) {
  Specimen s = rve.specimen();
  set_sizes(full, factor, s.grains);
  s.state = SolverState{};
  for (auto* v : {&s.grains.velocity, &s.grains.spin}) std::fill(v->begin(), v->end(), Vector3::Zero());
  Rve other(s);
  other.watch(stop);
  return other;
}

}  // namespace

Rve by_compression(const Recipe& recipe, const Grains& graded, double friction, Uniform& uniform,
                   const std::atomic<bool>* stop) {
  const int d = dimension_of(recipe.shape);
  Grains grains = graded;
  double volume = solid_volume(recipe, grains) / scattered_fraction(d) * (1 + d * approach_step * uniform());
  while (!scatter(recipe.shape, cell_of(recipe, volume), 1, grains, uniform)) volume *= 1.1;
  Rve rve(assembly(recipe, friction, grains, cell_of(recipe, volume)));
  rve.watch(stop);
  for (int round = 0; contacts_per_grain(rve) < crowded(d); ++round) {
    shrink(rve, approach_step);
    if (round == 300) throw IncrementFailed("packing: no contacts after 300 compressions by 1 %; check the radii");
  }
  press(recipe, rve);
  return rve;
}

Rve pressed_again(const Recipe& recipe, const Rve& rve, const std::atomic<bool>* stop) {
  Specimen s = rve.specimen();
  s.solver = unsteered();
  Rve other(s);
  other.watch(stop);
  press(recipe, other);
  return other;
}

Rve by_rows(const Recipe& recipe, const Grains& graded, double friction, const std::atomic<bool>* stop) {
  Grains grains = graded;
  const Cell cell = lay_rows(recipe, grains);
  Rve rve(assembly(recipe, friction, grains, cell));
  rve.watch(stop);
  press(recipe, rve);
  return rve;
}

Rve by_growth(const Recipe& recipe, const Grains& graded, double friction, Uniform& uniform,
              const std::atomic<bool>* stop) {
  const int d = dimension_of(recipe.shape);
  const Preparation& preparation = recipe.preparation;
  double volume = solid_volume(recipe, graded) * (1 + growth_void_ratio(recipe));
  if (recipe.stress) volume *= 1 + d * press_step * uniform();
  const Cell cell = cell_of(recipe, volume);
  Grains grains = graded;
  if (!scatter(recipe.shape, cell, preparation.first_size, grains, uniform))
    throw InputError("preparation.first_size = " + std::to_string(preparation.first_size) +
                     " leaves no room to scatter the grains; allowed: above 0 to below 1; give a smaller one");
  set_sizes(graded, preparation.first_size, grains);
  Rve rve(assembly(recipe, friction, grains, cell));
  rve.watch(stop);
  const double full_size = recipe.stress ? 1 : 1 + clearance;
  for (double size = preparation.first_size; size < full_size;) {
    const bool touching = contacts_per_grain(rve) >= crowded(d);
    size = std::min(full_size, size * (touching ? 1.001 : 1.01));
    rve = with_sizes(rve, graded, size, stop);
    rve.relax(1e-3, 50);
  }
  if (recipe.stress) {
    press(recipe, rve);
    return rve;
  }
  rve.relax(recipe.unbalanced, 50'000);
  return with_sizes(rve, graded, 1, stop);
}

}  // namespace rvelab::pack
