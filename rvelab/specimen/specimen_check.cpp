#include "rvelab/specimen/specimen_check.hpp"

#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <type_traits>

#include "rvelab/specimen/body_check.hpp"
#include "rvelab/specimen/checked_specimen.hpp"
#include "rvelab/specimen/interaction_check.hpp"
#include "rvelab/specimen/solids.hpp"
#include "rvelab/specimen/specimen_fields.hpp"

namespace rvelab {

namespace {

using fields::Field;
using fields::InPlane;
using fields::Layout;
using fields::Listed;
using fields::Path;
using fields::Rows;
using fields::Textual;

/// A range with its unit, with a remark if a number is not finite.
std::string words(const Interval& range, const char* unit, double found) {
  if (range.low == -no_bound && range.high == no_bound) return in_words(range);
  return in_words(range) + (unit == std::string("1") ? "" : std::string(" ") + unit) +
         (std::isfinite(found) ? "" : ", finite");
}

/// Whether a component of a vector is 0 in 2D.
constexpr bool is_flat(InPlane plane, std::size_t component) {
  return plane == InPlane::along    ? component == 2
         : plane == InPlane::normal ? component != 2
                                    : plane == InPlane::tangent && component != 0;
}
constexpr const char* flat_words(InPlane plane) {
  return plane == InPlane::along    ? "0: in 2D it lies in the plane z = 0"
         : plane == InPlane::normal ? "0: in 2D it is normal to the plane, along z"
                                    : "0: in 2D its first component is that along the tangent, the others are none";
}

/// Checks the numbers of a specimen against the ranges of its fields, and its lists against the number of grains.
class Ranges : CheckedSpecimen {
 public:
  explicit Ranges(const CheckedSpecimen& checked) : CheckedSpecimen(checked) {}

  template <class Value, class Owner>
  void field(const Path& path, const Value& value, const Field<Owner, Value>& field) const {
    if constexpr (Listed<Value>::is_list) {
      const std::size_t n = s.grains.size();
      if (value.size() != n && (field.rows == Rows::per_grain || !value.empty()))
        refuse(path.text() + " has " + std::to_string(value.size()) + " rows; allowed: " + std::to_string(n) +
               ", one for each grain" + (field.rows == Rows::per_grain ? "" : ", or none"));
      for (std::size_t k = 0; k < value.size(); ++k) entry(path, &k, value[k], field);
    } else {
      entry(path, nullptr, value, field);
    }
  }
  template <class Item, class... Columns>
  void table(const Path& path, const std::vector<Item>& items, const Columns&... columns) const {
    (column(Path(&path, columns.name), items, columns), ...);
  }

 private:
  template <class Item, class Value>
  void column(const Path& path, const std::vector<Item>& items, const Field<Item, Value>& field) const {
    for (std::size_t k = 0; k < items.size(); ++k) {
      entry(path, &k, items[k].*field.member, field);
      if constexpr (std::is_same_v<Item, Material> && std::is_same_v<Value, double>)
        law_constant(path, k, items[k].*field.member, field);
    }
  }

  template <class Entry, class Owner, class Value>
  void entry(const Path& path, const std::size_t* row, const Entry& entry, const Field<Owner, Value>& field) const {
    if constexpr (!Textual<Entry> && !std::is_same_v<Entry, bool>) {
      typename Layout<Entry>::Scalar scalars[Layout<Entry>::size];
      Layout<Entry>::put(entry, scalars);
      const bool flat = s.cell.dimension == 2 && field.plane != InPlane::any;
      for (std::size_t k = 0; k < Layout<Entry>::size; ++k) {
        const double value = double(scalars[k]);
        const bool in_range = std::isfinite(value) && field.allowed.contains(value);
        if (in_range && !(flat && is_flat(field.plane, k) && value != 0)) continue;
        std::string index = row == nullptr ? "" : std::to_string(*row);
        if (Layout<Entry>::size == 3) index += (index.empty() ? "" : ", ") + std::to_string(k);
        if (Layout<Entry>::size == 9) index += std::to_string(k / 3) + ", " + std::to_string(k % 3);
        out_of_range(path, index, row, value,
                     in_range ? flat_words(field.plane) : words(field.allowed, field.units, value));
      }
    }
  }

  [[noreturn]] void out_of_range(const Path& path, const std::string& index, const std::size_t* row, double value,
                                 const std::string& allowed) const {
    const std::string name = path.text();
    std::string who;
    if (row != nullptr && name.starts_with("grains/")) who = " of grain " + std::to_string(s.grains.id[*row]);
    if (row != nullptr && name.starts_with("materials/")) who = " of material \"" + s.materials[*row].name + "\"";
    refuse(name + (index.empty() ? "" : "[" + index + "]") + who + " = " + digits_of(value) +
           " is out of range; allowed: " + allowed);
  }

  /// The constants of the law are in its range; constants of other laws are 0 or in the range of their law.
  void law_constant(const Path& path, std::size_t row, double value, const Field<Material, double>& field) const {
    const LawParameter* stated = nullptr;
    for (const LawParameter& each : law_parameters()) {
      if (each.value != field.member) continue;
      const bool read = each.law == s.contact.law;
      if (each.parameter.allowed.contains(value) || (!read && value == 0)) {
        if (read) return;
        continue;
      }
      if (read || stated == nullptr) stated = &each;
      if (read) break;
    }
    if (stated != nullptr)
      out_of_range(
          path, std::to_string(row), &row, value,
          words(stated->parameter.allowed, stated->parameter.unit, value) + " with contact/law " + name(stated->law));
  }
};

/// Conditions between fields.
class Relations : CheckedSpecimen {
 public:
  explicit Relations(const CheckedSpecimen& checked) : CheckedSpecimen(checked) {}

  void check() const {
    check_lists();
    check_grains();
    check_bodies(*this);
    check_cell();
    check_places();
    check_masses();
    check_deferred();
    check_contacts();
    check_interactions(*this);
    const long collision_steps = s.solver.collision_steps;
    if (collision_steps > 0 && collision_steps < 5)
      refuse("solver/collision_steps = " + std::to_string(collision_steps) +
             " is out of range; allowed: 0, or 5 to 100000");
  }

 private:
  void check_lists() const {
    const SolverState& state = s.state;
    if (state.masses.mass.size() != state.masses.inverse_inertia.size())
      advise("state/masses/mass has " + std::to_string(state.masses.mass.size()) +
             " rows, state/masses/inverse_inertia " + std::to_string(state.masses.inverse_inertia.size()) +
             "; allowed: both one for each grain, or both none, and they are computed again");
    if (const std::size_t rows = state.energy_balance.interactions.size(); rows > 1)
      refuse("state/energy_balance/interactions has " + std::to_string(rows) + " rows; allowed: none, or one");
    const std::size_t n = s.grains.size();
    if (!state.memory_order.empty() && !is_permutation(state.memory_order, n))
      advise("state/memory_order is no permutation of the " + std::to_string(n) + " grains; leave it empty");
  }

  void check_grains() const {
    const Grains& g = s.grains;
    for (std::size_t k = 0; k < g.size(); ++k) {
      if (k > 0 && g.id[k] <= g.id[k - 1])
        advise(of_grain("grains/id", k) + " follows " + std::to_string(g.id[k - 1]) +
               "; ids must ascend, each once: sort the grains by id");
      if (std::size_t(g.material[k]) >= s.materials.size())
        refuse(of_grain("grains/material", k) + " = " + std::to_string(g.material[k]) + "; allowed: 0 to " +
               std::to_string(s.materials.size() - 1) + ", a row of materials");
    }
  }

  void check_cell() const {
    const Matrix3& l = s.cell.lattice;
    if (s.cell.dimension != dimension_of(s.shape))
      refuse("cell/dimension = " + std::to_string(s.cell.dimension) +
             "; allowed: " + std::to_string(dimension_of(s.shape)) + " where shape is " + name(s.shape));
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 3; ++column) {
        const bool flat = s.cell.dimension == 2 && column == 2;  // only the thickness is not 0
        const double value = l(row, column), most = flat ? 0 : largest_tilt * l(row, row);
        const bool right = row == column ? value > 0 : row > column ? value == 0 : std::abs(value) <= most;
        if (right) continue;
        const std::string who =
            "cell/lattice_m[" + std::to_string(row) + ", " + std::to_string(column) + "] = " + digits_of(value);
        if (row < column && !flat)
          advise(who + " m is a tilt of more than " + in_words(largest_tilt) + " times cell/lattice_m[" +
                 std::to_string(row) + ", " + std::to_string(row) + "] = " + in_words(l(row, row)) +
                 " m; give the same lattice by shorter vectors");
        advise(who +
               "; the lattice must be upper triangular with a positive diagonal, in 2D with the thickness alone in "
               "its last row and column: rotate cell and grains into that frame first");
      }
    const double from_orthogonal = (s.cell.rotation.transpose() * s.cell.rotation - Matrix3::Identity()).norm();
    if (!(from_orthogonal < 1e-8) || !(s.cell.rotation.determinant() > 0))
      refuse("cell/rotation is " + in_words(from_orthogonal) + " from orthogonal, with determinant " +
             in_words(s.cell.rotation.determinant()) + "; allowed: below 1e-8, and +1");
  }

  /// Far from the cell the precision of a coordinate is insufficient, and the number of periods in between exceeds an
  /// image.
  void check_places() const {
    constexpr double most_periods = double(1 << 30);
    for (std::size_t k = 0; k < s.grains.size(); ++k) {
      const Vector3 periods = s.cell.lattice.triangularView<Eigen::Upper>().solve(s.grains.position[k]);
      if (periods.head(s.cell.dimension).cwiseAbs().maxCoeff() <= most_periods) continue;
      advise(
          of_grain("grains/position_m", k) + " is " + in_words(s.grains.position[k].stableNorm()) +
          " m from the origin, more than 2^30 cell widths; give coordinates and cell in m, both of the same packing");
    }
  }

  void check_masses() const {
    double solid = 0;
    for (const double radius : s.grains.radius) solid += grain_volume(s.shape, radius, s.cell.lattice(2, 2));
    const double volume = s.cell.volume();
    if (!(solid > 0) || !(volume > 0) || !std::isfinite(volume / solid))
      advise("grains/radius_m, cell/lattice_m: grains of " + in_words(solid) + " m^3 in a cell of " + in_words(volume) +
             " m^3; both must be above 0, and their ratio finite; give all lengths in m");
    for (std::size_t k = 0; k < s.grains.size(); ++k) {
      const double radius = s.grains.radius[k], density = s.materials[std::size_t(s.grains.material[k])].density;
      const double mass = density * grain_volume(s.shape, radius, s.cell.lattice(2, 2));
      const OwnValues own = is_round(s.shape) ? OwnValues{} : own_of(s.shape, s.grains, k);
      const double inertia = moment_of_inertia(s.shape, mass, radius, own);
      if (std::isnormal(mass) && std::isnormal(inertia)) continue;
      refuse(of_grain("grains/radius_m", k) + " = " + in_words(radius) + " m and materials/density_kg_m3 = " +
             in_words(density) + " make a mass of " + in_words(mass) + " kg and an inertia of " + in_words(inertia) +
             " kg m^2; allowed: numbers of double precision, 1e-307 to 1e307; are lengths in mm? give all in m");
    }
  }

  /// Strain deferred to the next sub-step: less than a hundredth, the longest sub-step, and at most one sub-step.
  /// Const calls that return grains apply it; a damaged value would make them do many sub-steps.
  void check_deferred() const {
    const Matrix3& u = s.state.control.deferred.stretch;
    const bool upper = u(1, 0) == 0 && u(2, 0) == 0 && u(2, 1) == 0;
    const bool in_plane = s.cell.dimension == 3 || (u(0, 2) == 0 && u(1, 2) == 0 && u(2, 2) == 1);
    const double strain = (u - Matrix3::Identity()).norm();
    if (!upper || !in_plane || !(strain < 0.01))
      advise(
          "state/control/deferred/stretch must be an upper triangular stretch within 0.01 of the identity, and in 2D "
          "leave z "
          "alone; leave it the identity");
    if (!(strain <= (1 + 1e-9) * s.state.control.strain_per_step))
      advise("state/control/deferred/stretch is a strain of " + in_words(strain) +
             ", more than a sub-step's, state/control/strain_per_step = " + in_words(s.state.control.strain_per_step) +
             "; leave it the identity");
  }

  void check_contacts() const {
    check_pairs("contacts", "contact", s.contacts);
    const std::vector<double> rolling = moves_as_body(s.shape) ? rolling_radii_of(s.grains) : std::vector<double>{};
    for (std::size_t k = 0; k < s.contacts.size(); ++k) check_history(k, rolling);
  }

  /// A spring without stiffness has no force; a force read from a file would act permanently, without an energy. In
  /// space tangential forces and moments lie in the tangent plane: the next step would rotate a normal component of any
  /// size into it. A deviation of a thousandth is the error of tables with six digits.
  void check_history(std::size_t k, const std::vector<double>& rolling) const;
};

PairParameters parameters_of(const Specimen& s, const Contact& c) {
  const auto i = std::size_t(c.i), j = std::size_t(c.j);
  const auto material = [&](std::size_t g) -> const Material& {
    return s.materials[std::size_t(s.grains.material[g])];
  };
  return mix(s.contact, s.damping, material(i), s.grains.radius[i], 1, material(j), s.grains.radius[j], 1, 0);
}

void Relations::check_history(std::size_t k, const std::vector<double>& rolling) const {
  const Contact& c = s.contacts[k];
  if (c.tangential_force.isZero(0) && c.rolling_moment.isZero(0)) return;
  const PairParameters parameters = parameters_of(s, c);
  if (!c.tangential_force.isZero(0) && !(parameters.kt > 0))
    advise(pair("contacts", c, k) + " holds a tangential force of " + in_words(c.tangential_force.stableNorm()) +
           " N, but its tangential stiffness is 0; give a stiffness > 0, or clear the tangential forces");
  if (s.cell.dimension == 2) return;  // one component, along the tangent
  const Vector3 &xi = s.grains.position[std::size_t(c.i)], &xj = s.grains.position[std::size_t(c.j)];
  const Vector3 shift = translation(s.cell, c.image), branch = xj + shift - xi;
  const double length = branch.stableNorm();
  if (!(length > 0)) return;  // grains at one position: an error when contacts are made
  const Vector3 normal = moves_as_body(s.shape) ? normal_of_solids(s, c, rolling) : Vector3(branch / length);
  const double reach = s.grains.radius[std::size_t(c.i)] + s.grains.radius[std::size_t(c.j)];
  const double root = with_law(s.contact.law, [&](auto law) {
    using Force = typename decltype(law)::Force;
    return Force::stores_root_overlap ? Force::root(reach, parameters.law_constant) : 1.0;
  });
  constexpr double round_off = std::numeric_limits<double>::epsilon();
  const double share = 1e-3 + 8 * round_off * (xi.stableNorm() + xj.stableNorm() + shift.stableNorm()) / length;
  const auto expect_tangential = [&](const Vector3& vector, double stiffness, const char* field, const char* unit) {
    const double along = std::abs(vector.dot(normal));
    if (along <= share * vector.stableNorm() + 1e4 * round_off * stiffness) return;
    refuse(at(field, k) + " has " + in_words(along) + " of its " + in_words(vector.stableNorm()) + " " + unit +
           " along the normal of the contact of grains " + std::to_string(s.grains.id[std::size_t(c.i)]) + " and " +
           std::to_string(s.grains.id[std::size_t(c.j)]) + "; allowed: in the tangent plane");
  };
  expect_tangential(c.tangential_force, parameters.kt * root * reach, "contacts/tangential_force_N", "N");
  if (s.contact.rolling)
    expect_tangential(c.rolling_moment, parameters.kr * root, "contacts/rolling_moment_N_m", "N m");
}

/// Whether contacts of this specimen are as stiff as by another model and other materials.
bool have_stiffness_of(const Specimen& s, const ContactModel& contact, const std::vector<Material>& materials) {
  if (s.contact.law != contact.law || s.contact.rolling != contact.rolling ||
      s.contact.hertz_radius != contact.hertz_radius || s.materials.size() != materials.size())
    return false;
  for (std::size_t m = 0; m < materials.size(); ++m) {
    if (s.materials[m].rolling_stiffness != materials[m].rolling_stiffness) return false;
    for (const LawParameter& each : law_parameters())
      if (each.law == contact.law && s.materials[m].*each.value != materials[m].*each.value) return false;
  }
  return true;
}

}  // namespace

bool is_permutation(const std::vector<std::int32_t>& order, std::size_t grains) {
  if (order.size() != grains) return false;
  std::vector<bool> seen(grains, false);
  for (const std::int32_t g : order) {
    if (g < 0 || std::size_t(g) >= grains || seen[std::size_t(g)]) return false;
    seen[std::size_t(g)] = true;
  }
  return true;
}

void fit_state_to_parameters(Specimen& s, const ContactModel& contact, const std::vector<Material>& materials) {
  for (Contact& c : s.contacts)
    if (!c.tangential_force.isZero(0) && !(parameters_of(s, c).kt > 0)) c.tangential_force.setZero();
  if (have_stiffness_of(s, contact, materials)) return;
  s.state.masses = {};
  // Roots of another law, or of another roughness, are not those that the stored forces go with from now on.
  const bool has_constant = with_law(s.contact.law, [](auto law) { return decltype(law)::Force::root_has_constant; });
  if (s.contact.law != contact.law || has_constant)
    for (Contact& c : s.contacts) c.last_root_overlap = 0;
}

void check_specimen(const Specimen& s, const std::string& where) {
  const std::size_t n = s.grains.size();
  if (n == 0 || n > 100'000'000)
    throw InputError(where + "grains/id: " + std::to_string(n) + " grains; allowed: 1 to 100000000 in one cell");
  const CheckedSpecimen checked{s, where};
  const Ranges ranges(checked);
  fields::visit(ranges, s);
  try {
    check_parameters(s.contact, s.damping, s.materials);
  } catch (const InputError& error) {
    throw InputError(where + error.what());
  }
  Relations(checked).check();
}

}  // namespace rvelab
