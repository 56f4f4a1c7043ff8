#include "rvelab/solver/assembly/specimen_check.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <type_traits>

#include "rvelab/error.hpp"
#include "rvelab/solver/assembly/list_size.hpp"
#include "rvelab/solver/assembly/memory_order.hpp"
#include "rvelab/specimen/specimen_fields.hpp"

namespace rvelab {

namespace {

[[noreturn]] void refuse(const std::string& what) { throw InputError(what); }

void check_grains(const Specimen& s) {
  const Grains& g = s.grains;
  const std::size_t n = g.size();
  if (n == 0) refuse("specimen: 0 grains; at least 1 is needed");
  if (n > 100'000'000) refuse("specimen: " + std::to_string(n) + " grains; at most 100000000 fit one cell");
  if (g.radius.size() != n || g.material.size() != n || g.position.size() != n || g.velocity.size() != n ||
      g.spin.size() != n)
    refuse("specimen: the grain arrays differ in length; each needs " + std::to_string(n) + " entries");
  const std::size_t listed = s.state.list_positions.size();
  if (listed != 0 && listed != n)
    refuse("specimen: the state has positions of " + std::to_string(listed) +
           " grains for the neighbour list; it needs " + std::to_string(n) + ", or none");
  const auto &mass = s.state.scaled_mass, &inverse = s.state.scaled_inverse_inertia;
  const auto positive = [](double x) { return x > 0 && std::isfinite(x); };
  if (mass.size() != inverse.size() || (!mass.empty() && mass.size() != n) ||
      !std::all_of(mass.begin(), mass.end(), positive) || !std::all_of(inverse.begin(), inverse.end(), positive))
    refuse(
        "specimen: scaled_mass and scaled_inverse_inertia of the state must be finite, above 0 and one for each of " +
        std::to_string(n) + " grains; leave both empty, and they are made anew");
  for (std::size_t k = 0; k < n; ++k) {
    const std::string who = "grain " + std::to_string(g.id[k]) + ": ";
    if (k > 0 && g.id[k] <= g.id[k - 1]) refuse(who + "ids must ascend; sort the grains by id, each id once");
    if (!(g.radius[k] > 0) || !std::isfinite(g.radius[k]))
      refuse(who + "radius " + in_words(g.radius[k]) + " m; it must be > 0 and finite");
    if (g.material[k] < 0 || std::size_t(g.material[k]) >= s.materials.size())
      refuse(who + "material " + std::to_string(g.material[k]) + "; there are " + std::to_string(s.materials.size()));
    if (!g.position[k].allFinite() || !g.velocity[k].allFinite() || !g.spin[k].allFinite())
      refuse(who + "a position, velocity or spin is not finite");
  }
}

/// The columns of the shape: one entry for each grain; none in those of other shapes.
template <class By>
void check_columns(const Grains& g, std::size_t entries, std::size_t axes) {
  std::string names, found;
  bool right = g.orientation.size() == axes;
  each_column_of<By>(
      [&](const auto& described, const auto& column) {
        names += std::string(described.dataset) + ", ";
        found += std::to_string(column.size()) + ", ";
        right = right && column.size() == entries;
      },
      g);
  if (!right)
    refuse("specimen: " + names + "orientation have " + found + std::to_string(g.orientation.size()) +
           " entries; allowed: one for each grain where the shape is " + By::name + ", else none");
}

template <class By>
void check_outline(const Grains& g, std::size_t k) {
  const OwnValues own = own_of<By>(g, k);
  const std::string who = "grain " + std::to_string(g.id[k]) + ": ";
  const double length = g.orientation[k].norm();
  if (!By::allowed(own)) {
    std::string lengths;
    each_column_of<By>(
        [&](const auto& described, double value) {
          lengths += (lengths.empty() ? "" : ", ") + std::string(described.dataset) + " " + in_words(value);
        },
        own);
    refuse(who + lengths + "; allowed: " + By::allowed_lengths);
  }
  if (!(std::abs(g.radius[k] - By::radius(own)) <= 1e-9 * g.radius[k]))
    refuse(who + "radius " + in_words(g.radius[k]) + " m; that of its " + By::name + " is " + By::radius_in_words +
           ", " + in_words(By::radius(own)) + " m here");
  if (!(std::abs(length - 1) <= 1e-9) || g.orientation[k][2] != 0)
    refuse(who + "orientation of length " + in_words(length) + "; it must be a vector of length 1 in the plane");
}

/// Lengths and orientation where the grains are not round, and nowhere else.
void check_outlines(const Specimen& s) {
  const std::size_t n = s.grains.size();
  for (int number = 0; number < shape_count; ++number)
    with_shape(Shape(number), [&](auto is) {
      using By = typename decltype(is)::By;
      const bool own = s.shape == decltype(is)::value;
      if constexpr (!By::round) {
        check_columns<By>(s.grains, own ? n : 0, is_round(s.shape) ? 0 : n);
        for (std::size_t k = 0; own && k < n; ++k) check_outline<By>(s.grains, k);
      }
    });
  const std::string plural = name(s.shape) + std::string("s");
  if (!is_round(s.shape) && s.contact.slip != Slip::consistent)
    refuse(std::string("contact.slip = \"") + name(s.contact.slip) + "\" is for round grains; allowed for " + plural +
           ": \"consistent\"");
  if (!has_hertz_curvature(s.shape) && s.contact.hertz_radius != HertzRadius::equivalent)
    refuse(std::string("contact.hertz_radius = \"") + name(s.contact.hertz_radius) + "\" is for " +
           names_of_shapes(has_hertz_curvature, true) + "; allowed for " + plural + ": \"equivalent\"");
}

void check_cell(const Specimen& s) {
  const Matrix3& l = s.cell.lattice;
  if (s.cell.dimension != dimension_of(s.shape))
    refuse("specimen: the cell has dimension " + std::to_string(s.cell.dimension) + ", the grains " +
           std::to_string(dimension_of(s.shape)));
  if (!l.allFinite() || !(l(0, 0) > 0) || !(l(1, 1) > 0) || !(l(2, 2) > 0) || l(1, 0) != 0 || l(2, 0) != 0 ||
      l(2, 1) != 0)
    refuse(
        "specimen: the lattice must be upper triangular with a positive diagonal; turn cell and grains into that "
        "frame first");
  // Far from the cell a coordinate holds no place in it, and the number of periods in between no image.
  constexpr double most_periods = double(1 << 30);
  for (std::size_t k = 0; k < s.grains.size(); ++k) {
    const Vector3 periods = l.triangularView<Eigen::Upper>().solve(s.grains.position[k]);
    if (periods.head(s.cell.dimension).cwiseAbs().maxCoeff() <= most_periods) continue;
    refuse("grain " + std::to_string(s.grains.id[k]) + ": position " + in_words(s.grains.position[k].norm()) +
           " m from the origin, more than 2^30 cell widths; give coordinates and cell in m, both of the same packing");
  }
  const double from_orthogonal = (s.cell.rotation.transpose() * s.cell.rotation - Matrix3::Identity()).norm();
  if (!(from_orthogonal < 1e-8) || !(s.cell.rotation.determinant() > 0))
    refuse("specimen: the rotation of the cell frame must be orthogonal with determinant +1");
}

/// Every number of the state is finite, and those that steps follow from are not negative. Lists are left out: those of
/// the grains have checks of their own.
struct NumbersOfState {
  template <class Value, class Described>
  void field(const fields::Path& path, const Value& value, const Described&) const {
    bool finite = true;
    if constexpr (std::is_same_v<Value, double>)
      finite = std::isfinite(value);
    else if constexpr (std::is_same_v<Value, Matrix3> || std::is_same_v<Value, Vector3>)
      finite = value.allFinite();
    if (!finite) refuse("specimen: " + path.text() + " of the state is not finite; leave it 0");
    if constexpr (std::is_same_v<Described, fields::Field<SolverState, Value>> && std::is_signed_v<Value>)
      if (value < 0 && path.text() != "look_steps" && !path.text().starts_with("reference"))
        refuse("specimen: " + path.text() + " of the state is " + in_words(double(value)) +
               "; it must not be negative; leave it 0");
  }
};

/// Strain that is left to the next sub-step: less than a hundredth, since no sub-step is longer, and no more than
/// one of them. A damaged one of many sub-steps would be made by const calls that show grains.
void check_deferred(const Specimen& s) {
  const SolverState& state = s.state;
  const Matrix3& u = state.deferred_stretch;
  const bool upper = u(1, 0) == 0 && u(2, 0) == 0 && u(2, 1) == 0;
  const bool in_plane = s.cell.dimension == 3 || (u(0, 2) == 0 && u(1, 2) == 0 && u(2, 2) == 1);
  const double strain = (u - Matrix3::Identity()).norm();
  if (!upper || !in_plane || !(strain < 0.01))
    refuse(
        "specimen: deferred_stretch of the state must be an upper triangular stretch within 0.01 of the identity, and "
        "in 2D leave z alone; leave it the identity");
  if (!(strain <= (1 + 1e-9) * state.strain_per_step))
    refuse("specimen: deferred_stretch of the state is a strain of " + in_words(strain) +
           ", more than a sub-step's, strain_per_step = " + in_words(state.strain_per_step) +
           "; leave it the identity");
}

void check_volumes(const Specimen& s) {
  double solid = 0;
  for (const double radius : s.grains.radius) solid += grain_volume(s.shape, radius, s.cell.lattice(2, 2));
  const double volume = s.cell.volume();
  if (!(solid > 0) || !(volume > 0) || !std::isfinite(volume / solid))
    refuse("specimen: grains of " + in_words(solid) + " m^3 in a cell of " + in_words(volume) +
           " m^3; both must be above 0, and their ratio finite; give all lengths in m");
}

/// A spring without stiffness holds no force; one that a file brings would act for ever, and no energy would belong to
/// it.
bool holds_force_without_stiffness(const Specimen& s, const Contact& c) {
  if (c.tangential_force.isZero(0)) return false;
  const auto i = std::size_t(c.i), j = std::size_t(c.j);
  const Material &a = s.materials[std::size_t(s.grains.material[i])],
                 &b = s.materials[std::size_t(s.grains.material[j])];
  return !(mix(s.contact, s.damping, a, s.grains.radius[i], 1, b, s.grains.radius[j], 1, 0).kt > 0);
}

void check_contacts(const Specimen& s) {
  const std::size_t n = s.grains.size();
  for (const Contact& c : s.contacts) {
    if (c.i < 0 || c.j < c.i || std::size_t(c.j) >= n)
      refuse("specimen: contact of grains " + std::to_string(c.i) + " and " + std::to_string(c.j) +
             "; indices must be 0 <= i <= j < " + std::to_string(n));
    const auto who = [&] {
      return "specimen: contact of grains " + std::to_string(s.grains.id[std::size_t(c.i)]) + " and " +
             std::to_string(s.grains.id[std::size_t(c.j)]);
    };
    if (!c.tangential_force.allFinite() || !c.rolling_moment.allFinite() || !std::isfinite(c.last_root_overlap))
      refuse(who() + ": its history is not finite");
    if (holds_force_without_stiffness(s, c))
      refuse(who() + " holds a tangential force of " + in_words(c.tangential_force.norm()) +
             " N, but its tangential stiffness is 0; give a stiffness > 0, or clear the tangential forces");
  }
}

void check_options(const SolverOptions& o) {
  const auto expect = [](bool allowed, const char* key, double value, const char* range) {
    if (!allowed || !std::isfinite(value))
      refuse(std::string("solver.") + key + " = " + in_words(value) + " is out of range; allowed: " + range);
  };
  expect(o.skin > 0 && o.skin <= largest_skin_ratio, "skin", o.skin, "above 0 to 10");
  expect(o.time_step_factor > 0 && o.time_step_factor < 1, "time_step_factor", o.time_step_factor,
         "above 0 to below 1");
  expect(o.fixed_time_step >= 0, "fixed_time_step_s", o.fixed_time_step, ">= 0 s");
  expect(o.collision_steps == 0 || (o.collision_steps >= 5 && o.collision_steps <= 100'000), "collision_steps",
         double(o.collision_steps), "0, or 5 to 100000");
  expect(o.relative_tolerance > 0 && o.relative_tolerance <= 1, "relative_tolerance", o.relative_tolerance,
         "above 0 to 1");
  expect(o.absolute_tolerance > 0 && o.absolute_tolerance <= 1, "absolute_tolerance", o.absolute_tolerance,
         "above 0 to 1");
  expect(o.target_unbalanced >= 0, "target_unbalanced", o.target_unbalanced, ">= 0");
  expect(o.fixed_substeps >= 0, "fixed_substeps", double(o.fixed_substeps), ">= 0");
  expect(o.max_substeps > 0, "max_substeps", double(o.max_substeps), "> 0");
  expect(o.min_height >= 0, "min_height_m", o.min_height, ">= 0 m");
  expect(o.max_overlap_ratio > 0, "max_overlap_ratio", o.max_overlap_ratio, "> 0");
}

}  // namespace

void clear_forces_without_stiffness(Specimen& s) {
  for (Contact& c : s.contacts)
    if (holds_force_without_stiffness(s, c)) c.tangential_force.setZero();
}

void check_specimen(const Specimen& s) {
  check_parameters(s.contact, s.damping, s.materials);
  check_options(s.solver);
  check_grains(s);
  check_outlines(s);
  check_cell(s);
  check_volumes(s);
  const NumbersOfState numbers_of_state;
  fields::visit(numbers_of_state, s.state);
  check_deferred(s);
  check_contacts(s);
  const std::vector<std::int32_t>& order = s.state.memory_order;
  if (!order.empty() && !is_permutation(order, s.grains.size()))
    refuse("specimen: the memory order of the state is no permutation of the " + std::to_string(s.grains.size()) +
           " grains; leave it empty");
}

}  // namespace rvelab
