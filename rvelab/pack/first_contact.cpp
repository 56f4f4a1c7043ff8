#include "rvelab/pack/first_contact.hpp"

#include <algorithm>

#include "rvelab/cell/cell.hpp"
#include "rvelab/error.hpp"
#include "rvelab/measure/measures.hpp"
#include "rvelab/pack/regular.hpp"
#include "rvelab/pack/scatter.hpp"

namespace rvelab::pack {

SolverOptions unsteered() {
  SolverOptions options;
  options.fixed_substeps = 50;
  options.max_overlap_ratio = 1e3;
  return options;
}

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

void shrink(Rve& rve, double strain, const PressStrains& strains, Matrix3* deformation = nullptr) {
  Matrix3 gradient = Matrix3::Zero();
  for (int k = 0; k < rve.cell().dimension; ++k) gradient(k, k) = -strain * strains[k];
  rve.apply(gradient, 0);
  if (deformation != nullptr) *deformation += gradient * *deformation;
}

/// Shrinks the cell until grains that are apart crowd.
void approach(Rve& rve, int d, const DrawWatch& watch) {
  for (int round = 0; contacts_per_grain(rve) < crowded(d); ++round) {
    watch.at("bringing the grains together", contacts_per_grain(rve) / crowded(d));
    shrink(rve, approach_step, Vector3::Ones());
    if (round == 300) throw IncrementFailed("packing: no contacts after 300 compressions by 1 %; check the radii");
  }
}

/// Shrinks until the grains carry a tenth of the pressure in a cell at rest. A step beyond the pressure is undone and
/// repeated shorter, else stiff grains would become too dense.
void press(const Recipe& recipe, Rve& rve, const DrawWatch& watch, const PressStrains& strains = Vector3::Ones(),
           Matrix3* deformation = nullptr) {
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
    const Matrix3 deformation_before = deformation != nullptr ? *deformation : Matrix3::Identity();
    shrink(rve, strain, strains, deformation);
    part = settled_part();
    if (part > 1 && strain > 1e-9) {
      rve = before;
      if (deformation != nullptr) *deformation = deformation_before;
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

}  // namespace

Rve in_first_contact(const Recipe& recipe, double friction, Uniform& uniform, const DrawWatch& watch) {
  const Grains graded = graded_grains(recipe);
  if (recipe.preparation.method == Preparation::Method::regular) return by_rows(recipe, graded, friction, watch);
  if (moves_as_body(recipe.shape)) return solids_by_compression(recipe, graded, friction, uniform, watch);
  if (recipe.clumps) return clumps_by_compression(recipe, graded, friction, uniform, watch);
  const bool growth = recipe.preparation.method == Preparation::Method::growth || !recipe.stress;
  return growth ? by_growth(recipe, graded, friction, uniform, watch)
                : by_compression(recipe, graded, friction, uniform, watch);
}

Rve pressed(const Recipe& recipe, const Rve& rve, const DrawWatch& watch, const PressStrains& strains,
            Matrix3* deformation) {
  Specimen s = rve.specimen();
  s.solver = unsteered();
  Rve other(s);
  other.watch(watch.stop);
  press(recipe, other, watch, strains, deformation);
  return other;
}

}  // namespace rvelab::pack
