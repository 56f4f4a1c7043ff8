// Contact forces of an assembly as they stand: evaluation, sums over pairs, balance of the grains. Declared in
// assembly.hpp.
#include <algorithm>
#include <cmath>

#include "rvelab/error.hpp"
#include "rvelab/solver/assembly/assembly.hpp"
#include "rvelab/solver/assembly/gather_table.hpp"
#include "rvelab/solver/assembly/interactions.hpp"
#include "rvelab/solver/assembly/pair_geometry.hpp"

namespace rvelab {

Matrix3 upper_inverse(const Matrix3& m) {
  const double xx = 1 / m(0, 0), yy = 1 / m(1, 1), zz = 1 / m(2, 2);
  const double xy = -m(0, 1) * xx * yy, yz = -m(1, 2) * yy * zz;
  Matrix3 inverse;
  inverse << xx, xy, -(m(0, 1) * yz + m(0, 2) * zz) * xx, 0, yy, yz, 0, 0, zz;
  return inverse;
}

UpperTriangle upper_triangle(const Matrix3& m) { return {m(0, 0), m(0, 1), m(0, 2), m(1, 1), m(1, 2), m(2, 2)}; }

void set_rate(const Matrix3& rate, StepConstants& c) {
  c.rate = upper_triangle(rate);
  c.spin[0] = -0.5 * rate(1, 2);
  c.spin[1] = 0.5 * rate(0, 2);
  c.spin[2] = -0.5 * rate(0, 1);
}

StepConstants base_constants(const Model& model, const Assembly& assembly) {
  StepConstants c;
  c.dt = assembly.state.last_step.length;
  c.lattice = upper_triangle(assembly.cell.lattice);
  set_rate(assembly.state.last_step.rate, c);
  c.global_viscous = model.damping.global_viscous;
  c.tangential_ratio = model.damping.tangential_ratio;
  c.dashpot_quarters = int(4 * dashpot_power(model.contact.law, model.damping.dashpot));
  c.slip = model.contact.slip;
  c.ellipsoids = model.ellipsoids;
  c.no_tension = model.damping.no_tension;
  c.unload_rescale = model.contact.unload_rescale;
  return c;
}

void evaluate_forces(const Model& model, Assembly& assembly) {
  const StepConstants c = base_constants(model, assembly);
  model.kernels_at(assembly.state.last_step.loading)
      .evaluate(c, arrays_of(assembly.pairs), assembly.rows.data(), 0, long(assembly.pairs.padded()), nullptr);
  evaluate_interactions(model, c, assembly);
  gather_pairs_that_touch(assembly.pairs);
}

Vector3 force_of(const Model& model, const PairTable& pairs, std::size_t p) {
  const double* row = pairs.force_row(model.dimension(), p);
  return {row[0], row[1], model.dimension() == 2 ? 0.0 : row[2]};
}

namespace {

/// Moment of the pairs at `order` [first, last).
template <Shape shape>
Matrix3 moment_of(const Assembly& assembly, const PairGeometry<shape>& pair, std::size_t first, std::size_t last) {
  constexpr int D = dimension_of(shape);
  const double* forces = assembly.pairs.force.data();  // read once, which is a tenth of a call
  double m[9] = {};
  for (std::size_t k = first; k < last; ++k) {
    const auto p = std::size_t(assembly.pairs.order[k]);
    const Branch b = pair.branch(p);
    const double* force = forces + std::size_t(force_row_length(D)) * p;
    for (int r = 0; r < D; ++r) {
      m[3 * r] += force[r] * b.x;
      m[3 * r + 1] += force[r] * b.y;
      if constexpr (D == 3) m[3 * r + 2] += force[r] * b.z;
    }
  }
  Matrix3 sum;
  for (int k = 0; k < 9; ++k) sum(k / 3, k % 3) = m[k];
  return sum;
}

template <Shape shape>
Matrix3 moment_in(const Model& model, const Assembly& assembly) {
  const PairGeometry<shape> pair(model, assembly);
  std::vector<Matrix3> of_piece(pieces_in(assembly.pairs.listed));
  in_pieces(assembly.pairs.listed, model.sharing(), [&](std::size_t piece, std::size_t first, std::size_t last) {
    of_piece[piece] = moment_of(assembly, pair, first, last);
  });
  Matrix3 sum = Matrix3::Zero();
  for (const Matrix3& piece : of_piece) sum += piece;
  if (has_interactions(assembly)) sum += interaction_virial(model, assembly);
  return sum;
}

/// Doubles that a grain's resultants take: force, then torque over the radius (N).
template <int D>
constexpr std::size_t resultant_row = D == 2 ? 3 : 6;

/// Adds what contact p gives to one of its grains.
template <int D>
void add_resultant(const Model& model, const PairTable& pairs, std::size_t p, std::size_t g, bool as_j, double* r) {
  const double* row = pairs.force_row(D, p);
  for (std::size_t c = 0; c < D; ++c) r[c] = as_j ? r[c] + row[c] : r[c] - row[c];
  if constexpr (D == 2) {
    r[2] += row[as_j ? 2 : 3] / model.radius[g];
  } else {
    const double arm = row[3] / model.radius[g] - 1;  // torque -(r - delta/2) n x f_t on either grain
    for (std::size_t c = 0; c < 3; ++c) r[3 + c] += arm * row[4 + c];
    if (!model.contact.rolling) return;
    for (std::size_t c = 0; c < 3; ++c) r[3 + c] += (as_j ? 1 : -1) * pairs.moment[c][p] / model.radius[g];
  }
}

/// Adds what the interactions other than contacts give to their grains; the sum of their forces, and their number.
template <int D>
std::pair<double, std::size_t> add_interactions(const Model& model, const Assembly& assembly, double* resultants) {
  if (!has_interactions(assembly)) return {0, 0};
  double forces = 0;
  const std::vector<ActingInteraction> all = acting_interactions(model, assembly);
  for (const ActingInteraction& a : all) {
    forces += a.force.norm();
    for (const bool as_j : {false, true}) {
      const std::size_t g = as_j ? a.j : a.i;
      double* r = resultants + resultant_row<D> * g;
      const Vector3& torque = as_j ? a.moment_j : a.moment_i;
      for (std::size_t c = 0; c < D; ++c) r[c] += (as_j ? 1 : -1) * a.force[Eigen::Index(c)];
      if constexpr (D == 2)
        r[2] += torque[2] / model.radius[g];
      else
        for (std::size_t c = 0; c < 3; ++c) r[3 + c] += torque[Eigen::Index(c)] / model.radius[g];
    }
  }
  return {forces, all.size()};
}

/// Sums over the contacts of a piece of the pairs.
struct ContactSums {
  double force = 0, overlap = 0, largest_overlap_ratio = 0;
  std::size_t touching = 0;
  bool finite = true;
};

/// Adds up the contacts at `order` [first, last), and their forces on each grain unless `resultants` is null.
template <Shape shape>
ContactSums contacts_in(const Model& model, const Assembly& assembly, const PairPlaces<shape>& pair, std::size_t first,
                        std::size_t last, double* resultants) {
  constexpr int D = dimension_of(shape);
  ContactSums sums;
  for (std::size_t k = first; k < last; ++k) {
    const auto p = std::size_t(assembly.pairs.order[k]);
    const auto i = std::size_t(assembly.pairs.i[p]), j = std::size_t(assembly.pairs.j[p]);
    const double overlap = pair(p).overlap;
    if (!std::isfinite(overlap)) sums.finite = false;
    if (!(overlap > 0)) continue;
    const double* on_j = assembly.pairs.force_row(D, p);
    double squared = 0;
    for (std::size_t c = 0; c < D; ++c) squared += on_j[c] * on_j[c];
    if (resultants != nullptr) {
      add_resultant<D>(model, assembly.pairs, p, i, false, resultants + resultant_row<D> * i);
      add_resultant<D>(model, assembly.pairs, p, j, true, resultants + resultant_row<D> * j);
    }
    sums.force += std::sqrt(squared);
    sums.overlap += overlap;
    ++sums.touching;
    sums.largest_overlap_ratio =
        std::max(sums.largest_overlap_ratio, overlap / std::min(model.radius[i], model.radius[j]));
  }
  return sums;
}

/// Resultants of the grains [first, last), added in the same order as above; pairs that do not touch give nothing.
template <Shape shape>
void gather_resultants(const Model& model, const Assembly& assembly, const PairPlaces<shape>& pair, std::size_t first,
                       std::size_t last, double* resultants) {
  constexpr int D = dimension_of(shape);
  each_pair_of_grains<D>(assembly.pairs, first, last, [&](std::size_t g, std::size_t p, bool as_j) {
    // The entry of a pair that opened still holds the moment of rolling until the kernel passes by.
    if (!(pair(p).overlap > 0)) return;
    const bool own_image = assembly.pairs.i[p] == assembly.pairs.j[p];
    if (own_image && as_j) return;  // both at once where the grain is i, as above
    add_resultant<D>(model, assembly.pairs, p, g, as_j, resultants + resultant_row<D> * g);
    if (own_image) add_resultant<D>(model, assembly.pairs, p, g, true, resultants + resultant_row<D> * g);
  });
}

/// Sums over a piece of the grains: |force|, |torque| over radius, and squares of all that their rows hold.
struct GrainFigures {
  double resultants = 0, couples = 0, squares = 0;
};

template <int D>
GrainFigures grains_in(const Model& model, const Assembly& assembly, std::size_t first, std::size_t last,
                       const double* resultants) {
  GrainFigures figures;
  for (std::size_t g = first; g < last; ++g) {
    const double* r = resultants + resultant_row<D> * g;
    double force = 0, couple = 0;
    for (std::size_t c = 0; c < D; ++c) force += r[c] * r[c];
    for (std::size_t c = D; c < resultant_row<D>; ++c) couple += r[c] * r[c];
    figures.resultants += std::sqrt(force) / double(model.size());
    figures.couples += std::sqrt(couple) / double(model.size());
  }
  const auto row = std::size_t(model.row_length());
  for (std::size_t k = first * row; k < last * row; ++k) figures.squares += assembly.rows[k] * assembly.rows[k];
  return figures;
}

template <Shape shape>
OutOfBalance balance_in(const Model& model, const Assembly& assembly) {
  constexpr int D = dimension_of(shape);
  const PairPlaces<shape> pair(model, assembly);
  const bool shared = model.sharing() != nullptr || model.bodies != nullptr;
  std::vector<double> resultants(resultant_row<D> * model.size(), 0.0);
  const auto [forces_between, acting] = add_interactions<D>(model, assembly, resultants.data());
  std::vector<ContactSums> of_pairs(pieces_in(assembly.pairs.listed));
  in_pieces(assembly.pairs.listed, model.sharing(), [&](std::size_t piece, std::size_t first, std::size_t last) {
    of_pairs[piece] = contacts_in(model, assembly, pair, first, last, shared ? nullptr : resultants.data());
  });
  std::vector<GrainFigures> of_grains(pieces_in(model.size()));
  in_pieces(model.size(), model.sharing(), [&](std::size_t piece, std::size_t first, std::size_t last) {
    if (shared && !model.bodies) gather_resultants<shape>(model, assembly, pair, first, last, resultants.data());
    of_grains[piece] = grains_in<D>(model, assembly, first, last, resultants.data());
  });
  OutOfBalance balance;
  double contact_force = 0, overlap_sum = 0, squares = 0;
  for (const ContactSums& piece : of_pairs) {
    contact_force += piece.force;
    overlap_sum += piece.overlap;
    balance.touching += piece.touching;
    balance.largest_overlap_ratio = std::max(balance.largest_overlap_ratio, piece.largest_overlap_ratio);
    balance.finite = balance.finite && piece.finite;
  }
  for (const GrainFigures& piece : of_grains) {
    balance.mean_resultant += piece.resultants;
    balance.mean_couple += piece.couples;
    squares += piece.squares;
  }
  if (model.bodies) {
    std::vector<Resultant> on_bodies;
    gather_on_bodies(model, assembly, on_bodies);
    for (std::size_t b = 0; b < on_bodies.size(); ++b) {
      balance.mean_resultant += on_bodies[b].force.norm() / double(on_bodies.size());
      balance.mean_couple += on_bodies[b].torque.norm() / (model.bodies->radius[b] * double(on_bodies.size()));
    }
  }
  contact_force += forces_between;
  if (balance.touching > 0 || acting > 0)
    balance.mean_contact_force = contact_force / double(std::max(balance.touching, acting));
  if (balance.touching > 0) {
    balance.mean_overlap = overlap_sum / double(balance.touching);
  }
  // A sum is finite only if all its terms are, or if infinities cancel, which sums of squares cannot.
  balance.finite = balance.finite && std::isfinite(balance.mean_resultant + balance.mean_couple) &&
                   std::isfinite(contact_force) && std::isfinite(squares);
  return balance;
}

template <Shape shape>
std::vector<Resultant> resultants_in(const Model& model, const Assembly& assembly) {
  constexpr int D = dimension_of(shape);
  const PairPlaces<shape> pair(model, assembly);
  std::vector<double> rows(resultant_row<D> * model.size(), 0.0);
  add_interactions<D>(model, assembly, rows.data());
  std::vector<Resultant> resultants(model.size());
  in_pieces(model.size(), model.sharing(), [&](std::size_t, std::size_t first, std::size_t last) {
    gather_resultants<shape>(model, assembly, pair, first, last, rows.data());
    for (std::size_t g = first; g < last; ++g) {
      const double* r = rows.data() + resultant_row<D> * g;
      Resultant& of = resultants[g];
      if constexpr (D == 2) {
        of = {{r[0], r[1], 0}, {0, 0, model.radius[g] * r[2]}};
      } else {
        of = {{r[0], r[1], r[2]}, model.radius[g] * Vector3(r[3], r[4], r[5])};
      }
    }
  });
  return resultants;
}

}  // namespace

Matrix3 contact_virial(const Model& model, const Assembly& assembly) {
  if (model.bodies) return virial_of_bodies(model, assembly);
  // Called every few sub-steps under stress control.
  return with_shape(model.shape, [&](auto shape) { return moment_in<shape.value>(model, assembly); });
}

std::vector<Resultant> resultants_of(const Model& model, const Assembly& assembly) {
  return with_shape(model.shape, [&](auto shape) { return resultants_in<shape.value>(model, assembly); });
}

OutOfBalance balance_of(const Model& model, const Assembly& assembly) {
  return with_shape(model.shape, [&](auto shape) { return balance_in<shape.value>(model, assembly); });
}

double unbalanced_ratio(const OutOfBalance& balance, double reference_contact_force) {
  const double scale = std::max(balance.mean_contact_force, 1e-3 * reference_contact_force);
  return scale > 0 ? std::max(balance.mean_resultant, balance.mean_couple) / scale : 0.0;
}

void check_overlaps(const Model& model, const OutOfBalance& balance) {
  if (!balance.finite)
    throw IncrementFailed("the increment led to values that are not finite; apply it in smaller parts");
  if (balance.largest_overlap_ratio > model.options.max_overlap_ratio)
    throw IncrementFailed("grains overlap by " + in_words(balance.largest_overlap_ratio) +
                          " of the smaller radius; solver.max_overlap_ratio allows " +
                          in_words(model.options.max_overlap_ratio) + "; compress less or take stiffer grains");
}

}  // namespace rvelab
