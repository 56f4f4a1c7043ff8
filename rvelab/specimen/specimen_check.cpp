#include "rvelab/specimen/specimen_check.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <type_traits>
#include <utility>

#include "rvelab/error.hpp"
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

constexpr const char* remedy = "; correct it, or make the specimen again";

/// As many digits as tell it from the end of a range.
std::string digits_of(double value) {
  char digits[32];
  return {digits, std::to_chars(std::begin(digits), std::end(digits), value).ptr};
}

/// A range with its unit, and that it holds finite numbers only where one is not.
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

/// The numbers of one specimen against the ranges of its fields, and its lists against the number of grains.
class Ranges {
 public:
  Ranges(const Specimen& specimen, const std::string& where) : s_(specimen), where_(where) {}

  template <class Value, class Owner>
  void field(const Path& path, const Value& value, const Field<Owner, Value>& field) const {
    if constexpr (Listed<Value>::is_list) {
      const std::size_t n = s_.grains.size();
      if (value.size() != n && (field.rows == Rows::per_grain || !value.empty()))
        refuse(path, " has " + std::to_string(value.size()) + " rows; allowed: " + std::to_string(n) +
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
  [[noreturn]] void refuse(const Path& path, const std::string& what) const {
    throw InputError(where_ + path.text() + what + remedy);
  }

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
      const bool flat = s_.cell.dimension == 2 && field.plane != InPlane::any;
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
    if (row != nullptr && name.starts_with("grains/")) who = " of grain " + std::to_string(s_.grains.id[*row]);
    if (row != nullptr && name.starts_with("materials/")) who = " of material \"" + s_.materials[*row].name + "\"";
    refuse(path, (index.empty() ? "" : "[" + index + "]") + who + " = " + digits_of(value) +
                     " is out of range; allowed: " + allowed);
  }

  /// What a law reads is in the range that the law states; what none of this specimen reads is 0, or in that of
  /// another.
  void law_constant(const Path& path, std::size_t row, double value, const Field<Material, double>& field) const {
    const LawParameter* stated = nullptr;
    for (const LawParameter& each : law_parameters()) {
      if (each.value != field.member) continue;
      const bool read = each.law == s_.contact.law;
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

  const Specimen& s_;
  const std::string& where_;
};

/// What fields must be beside one another.
class Relations {
 public:
  Relations(const Specimen& specimen, const std::string& where) : s(specimen), where_(where) {}

  void check() const {
    check_lists();
    check_grains();
    check_outlines();
    check_bodies();
    check_cell();
    check_places();
    check_masses();
    check_deferred();
    check_contacts();
    check_interactions();
    const long collision_steps = s.solver.collision_steps;
    if (collision_steps > 0 && collision_steps < 5)
      refuse("solver/collision_steps = " + std::to_string(collision_steps) +
             " is out of range; allowed: 0, or 5 to 100000");
  }

 private:
  [[noreturn]] void refuse(const std::string& what) const { advise(what + remedy); }
  /// The same of what has a remedy of its own.
  [[noreturn]] void advise(const std::string& what) const { throw InputError(where_ + what); }

  static std::string at(const std::string& field, std::size_t k) { return field + ("[" + std::to_string(k) + "]"); }
  std::string of_grain(const char* field, std::size_t k) const {
    return at(field, k) + " of grain " + std::to_string(s.grains.id[k]);
  }

  void check_lists() const {
    const SolverState& state = s.state;
    if (state.masses.mass.size() != state.masses.inverse_inertia.size())
      advise("state/masses/mass has " + std::to_string(state.masses.mass.size()) +
             " rows, state/masses/inverse_inertia " + std::to_string(state.masses.inverse_inertia.size()) +
             "; allowed: both one for each grain, or both none, and they are made anew");
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

  /// Lengths and orientation where the grains are not round, and nowhere else.
  void check_outlines() const {
    const std::size_t n = s.grains.size();
    for (int number = 0; number < shape_count; ++number)
      with_shape(Shape(number), [&](auto is) {
        using By = typename decltype(is)::By;
        const bool own = s.shape == decltype(is)::value;
        if constexpr (!By::round) {
          each_column_of<By>(
              [&](const auto& described, const auto& column) {
                expect_rows<By>((std::string("grains/") + described.dataset).c_str(), column.size(), own ? n : 0);
              },
              s.grains);
          expect_rows<By>("grains/orientation", s.grains.orientation.size(), keeps_axis(s.shape) ? n : 0);
          for (std::size_t k = 0; own && k < n; ++k) check_outline<By>(k);
        }
      });
    const std::string plural = name(s.shape) + std::string("s");
    if (!is_round(s.shape) && s.contact.slip != Slip::consistent)
      refuse(std::string("contact/slip = \"") + name(s.contact.slip) + "\" is for round grains; allowed for " + plural +
             ": \"consistent\"");
    if (!has_hertz_curvature(s.shape) && s.contact.hertz_radius != HertzRadius::equivalent)
      refuse(std::string("contact/hertz_radius = \"") + name(s.contact.hertz_radius) + "\" is for " +
             names_of_shapes(has_hertz_curvature, true) + "; allowed for " + plural + ": \"equivalent\"");
  }

  template <class By>
  void expect_rows(const char* field, std::size_t found, std::size_t allowed) const {
    if (found != allowed)
      refuse(std::string(field) + " has " + std::to_string(found) +
             " rows; allowed: one for each grain where shape is " + By::name + ", else none");
  }

  template <class By>
  void check_outline(std::size_t k) const {
    const Grains& g = s.grains;
    const OwnValues own = own_of<By>(g, k);
    if (!By::allowed(own)) {
      std::string lengths;
      each_column_of<By>(
          [&](const auto& described, double value) {
            lengths += (lengths.empty() ? "grains/" : ", ") + at(described.dataset, k) + " = " + in_words(value);
          },
          own);
      refuse(lengths + " of grain " + std::to_string(g.id[k]) + "; allowed: " + By::allowed_lengths);
    }
    if (!(std::abs(g.radius[k] - By::radius(own)) <= 1e-9 * g.radius[k]))
      refuse(of_grain("grains/radius_m", k) + " = " + in_words(g.radius[k]) + "; that of its " + By::name + " is " +
             By::radius_in_words + ", " + in_words(By::radius(own)) + " m here");
    if constexpr (By::rigid) return;
    const double length = g.orientation[k].norm();
    if (!(std::abs(length - 1) <= 1e-9))
      refuse(of_grain("grains/orientation", k) + " has the length " + digits_of(length) +
             "; allowed: 1, a direction in the plane");
  }

  /// Bodies (clumps): each grain in one of them, of one material, where its offset says.
  void check_bodies() const {
    const std::size_t n = s.grains.size();
    if (s.members.size() != (s.bodies.empty() ? 0 : n))
      refuse("members has " + std::to_string(s.members.size()) +
             " rows; allowed: one for each grain where there are bodies, else none");
    if (moves_as_body(s.shape) && s.bodies.size() != n)
      refuse("bodies has " + std::to_string(s.bodies.size()) + " rows; allowed: " + std::to_string(n) +
             ", one for each grain where shape is " + name(s.shape));
    if (s.bodies.empty()) return;
    if (keeps_axis(s.shape))
      refuse(std::string("bodies of ") + name(s.shape) + "s; allowed: of discs, spheres or superellipsoids");
    if (has_any(s))
      advise(
          "bodies beside bonds, bridges or adhesion: interactions other than contacts do not act on clumps or "
          "superellipsoids yet; take "
          "grains that move by themselves, or leave the interactions out");
    if (s.contact.slip != Slip::consistent)
      refuse(std::string("contact/slip = \"") + name(s.contact.slip) + "\" with bodies; allowed: \"consistent\"");
    if (!s.state.memory_order.empty()) advise("state/memory_order with bodies; leave it empty");
    for (std::size_t b = 0; b < s.bodies.size(); ++b) {
      const Body& body = s.bodies[b];
      const auto first = std::size_t(body.first);
      if (b > 0 && body.id <= s.bodies[b - 1].id)
        advise(at("bodies/id", b) + " follows " + std::to_string(s.bodies[b - 1].id) +
               "; ids must ascend, each once: sort the bodies by id, and the grains with them");
      if (b == 0 ? first != 0 : (first <= std::size_t(s.bodies[b - 1].first) || first >= n))
        refuse(at("bodies/first", b) + " = " + std::to_string(body.first) +
               "; allowed: 0 for the first body, then ascending rows of grains");
      const Turn& q = body.orientation;
      const double length = std::sqrt(q.w * q.w + q.v.squaredNorm());
      if (!(std::abs(length - 1) <= 1e-9) || (s.cell.dimension == 2 && (q.v[0] != 0 || q.v[1] != 0)))
        refuse(at("bodies/orientation", b) + " has the length " + digits_of(length) +
               "; allowed: a quaternion of length 1, scalar first, in 2D about z");
      const std::size_t last = b + 1 < s.bodies.size() ? std::size_t(s.bodies[b + 1].first) : n;
      for (std::size_t g = first; g < std::min(last, n); ++g) check_member(body, first, g);
      if (moves_as_body(s.shape)) check_solid(b);
    }
  }
  /// A body of one grain has the volume and the inertia of that.
  void check_solid(std::size_t b) const {
    const Body& body = s.bodies[b];
    const Body right = body_of_solid(s.grains, b);
    if (!s.members[b].offset.isZero(0))
      refuse(at("members/offset_m", b) + " is not 0; allowed: 0 where shape is " + name(s.shape));
    if (!(std::abs(body.volume - right.volume) <= 1e-9 * right.volume))
      refuse(at("bodies/volume_m3", b) + " = " + in_words(body.volume) + "; that of its grain is " +
             in_words(right.volume) + " m^3");
    if (!((body.gyration - right.gyration).norm() <= 1e-9 * right.gyration.norm()))
      refuse(at("bodies/gyration_m2", b) + " is not that of its grain, " + in_words(right.gyration[0]) + " " +
             in_words(right.gyration[1]) + " " + in_words(right.gyration[2]) + " m^2");
  }
  void check_member(const Body& body, std::size_t first, std::size_t g) const {
    if (s.grains.material[g] != s.grains.material[first])
      refuse(of_grain("grains/material", g) + " differs from that of the first member of body " +
             std::to_string(body.id) + "; allowed: one material in a body");
    const Vector3 from = s.grains.position[g] - body.position - axes_of(body.orientation) * s.members[g].offset;
    Vector3 periods = s.cell.lattice.triangularView<Eigen::Upper>().solve(from);
    for (int k = 0; k < 3; ++k) periods[k] -= std::floor(periods[k] + 0.5);
    if (s.cell.dimension == 2) periods[2] = 0;
    const double off = (s.cell.lattice * periods).norm();
    if (!(off <= 1e-6 * s.grains.radius[g]))
      advise(of_grain("grains/position_m", g) + " is " + in_words(off) + " m from where members/offset_m[" +
             std::to_string(g) + "] puts it in body " + std::to_string(body.id) +
             "; give position = body position + axes offset, up to lattice vectors");
  }

  void check_cell() const {
    const Matrix3& l = s.cell.lattice;
    if (s.cell.dimension != dimension_of(s.shape))
      refuse("cell/dimension = " + std::to_string(s.cell.dimension) +
             "; allowed: " + std::to_string(dimension_of(s.shape)) + " where shape is " + name(s.shape));
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 3; ++column) {
        const bool flat = s.cell.dimension == 2 && column == 2;  // the thickness stands alone
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
               "its last row and column: turn cell and grains into that frame first");
      }
    const double from_orthogonal = (s.cell.rotation.transpose() * s.cell.rotation - Matrix3::Identity()).norm();
    if (!(from_orthogonal < 1e-8) || !(s.cell.rotation.determinant() > 0))
      refuse("cell/rotation is " + in_words(from_orthogonal) + " from orthogonal, with determinant " +
             in_words(s.cell.rotation.determinant()) + "; allowed: below 1e-8, and +1");
  }

  /// Far from the cell a coordinate holds no place in it, and the number of periods in between no image.
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

  /// Strain that is left to the next sub-step: less than a hundredth, since no sub-step is longer, and no more than
  /// one of them. A damaged one of many sub-steps would be made by const calls that show grains.
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

  /// A pair in words: "contacts[3], grains 4 and 7 (i = 3, j = 6, image 0, 1, 0)".
  template <class Item>
  std::string pair(const std::string& group, const Item& c, std::size_t k) const {
    const auto id = [&](std::int32_t g) { return std::to_string(s.grains.id[std::size_t(g)]); };
    return at(group, k) + ", grains " + id(c.i) + " and " + id(c.j) + " (i = " + std::to_string(c.i) +
           ", j = " + std::to_string(c.j) + ", image " + std::to_string(c.image[0]) + ", " +
           std::to_string(c.image[1]) + ", " + std::to_string(c.image[2]) + ")";
  }
  std::string pair(std::size_t k) const { return pair("contacts", s.contacts[k], k); }

  /// Pairs of grains that there are, each once and in order. `each`: what one is called.
  template <class Item>
  void check_pairs(const std::string& group, const std::string& each, const std::vector<Item>& items) const {
    const std::size_t n = s.grains.size();
    for (std::size_t k = 0; k < items.size(); ++k) {
      const Item& c = items[k];
      if (c.j < c.i || std::size_t(c.j) >= n)
        refuse(at(group + "/i", k) + " = " + std::to_string(c.i) + ", " + at(group + "/j", k) + " = " +
               std::to_string(c.j) + "; allowed: 0 <= i <= j < " + std::to_string(n));
      if (c.i == c.j && c.image == Image{})
        refuse(pair(group, c, k) + " is a grain that touches itself; allowed: an image of it, in " + group + "/image");
      if (k > 0 && pair_of(c) == pair_of(items[k - 1]))
        refuse(pair(group, c, k) + " stands twice; allowed: each " + each + " once");
      if (k > 0 && pair_of(c) < pair_of(items[k - 1]))
        refuse(pair(group, c, k) + " is out of order; allowed: " + group + " sorted by i, then j, then image");
      for (std::size_t d = 0; d < c.image.size(); ++d)  // cells that are reduced add to it
        if (std::abs(double(c.image[d])) > 1e9)
          refuse(group + "/image[" + std::to_string(k) + ", " + std::to_string(d) +
                 "] = " + std::to_string(c.image[d]) + " is out of range; allowed: -1e9 to 1e9");
    }
  }

  void check_contacts() const {
    check_pairs("contacts", "contact", s.contacts);
    for (std::size_t k = 0; k < s.contacts.size(); ++k) check_history(k);
  }

  void check_interactions() const {
    each_interaction_law([&](auto, auto law) {
      using Law = decltype(law);
      if constexpr (FormsByItself<Law>) check_settings<Law>();
      const auto& items = static_cast<const ListOf<Law>&>(s).items;
      if (!items.empty() && !is_round(s.shape))
        refuse(std::string(Law::name) + " of grains that are not round; allowed: between discs or spheres");
      check_pairs(Law::name, "pair", items);
      for (std::size_t k = 0; k < items.size(); ++k) check_interaction<Law>(items[k], k);
    });
  }

  /// What interactions of a law form from.
  template <class Law>
  void check_settings() const {
    const auto& rows = static_cast<const SettingsOf<Law>&>(s).settings;
    const std::string name = Law::settings_name;
    if (rows.empty() && !static_cast<const ListOf<Law>&>(s).items.empty())
      refuse(std::string(Law::name) + " without " + name + "; allowed: with one row of " + name +
             ", which says what they form from");
    if (rows.size() > 1)
      refuse(name + " has " + std::to_string(rows.size()) + " rows; allowed: none, or one for all grains");
    if (rows.empty()) return;
    if (!is_round(s.shape)) refuse(name + " between grains that are not round; allowed: between discs or spheres");
    const bool hertz = with_law(s.contact.law, [](auto law) { return decltype(law)::Force::needs_root_overlap; });
    const double mean = std::accumulate(s.grains.radius.begin(), s.grains.radius.end(), 0.0) / double(s.grains.size());
    if (const double reach = Law::reach(rows.front()); reach > mean)
      refuse(name + " makes grains act on one another up to a gap of " + in_words(reach) +
             " m; allowed: up to their mean radius, " + in_words(mean) + " m");
    const char* misfit = Law::misfit(rows.front(), {s.cell.dimension, hertz});
    if (misfit == nullptr) return;
    std::string values;
    for (const auto& field : Law::settings_fields)
      values += (values.empty() ? "" : ", ") + name + "/" + field.name + " = " + in_words(rows.front().*field.value);
    refuse(values + "; allowed: " + misfit);
  }

  /// Numbers that stand for a state are whole; what a file has is there; what acts is about as long as when it was
  /// made, or its image is another's and it would tear the grains apart in one step.
  template <class Law>
  void check_interaction(const Interaction<Law>& item, std::size_t k) const {
    double columns[interaction_columns<Law>()];
    put_columns<Law>(item, columns);
    const auto column = [&](int number) { return columns[number]; };
    each_field<Law>(item, [&](const InteractionField& field, const auto& value) {
      if constexpr (std::is_same_v<std::decay_t<decltype(value)>, double>) {
        if (!field.whole) return;
        const bool presence = field.allowed.high == 1;  // a file holds what is there
        if (presence ? value != 1 : value != std::floor(value))
          refuse(at(std::string(Law::name) + "/" + field.name, k) + " = " + in_words(value) +
                 " is out of range; allowed: " + (presence ? "1, of what is there" : "a whole number"));
      }
    });
    const double radii = s.grains.radius[std::size_t(item.i)] + s.grains.radius[std::size_t(item.j)];
    const Vector3 branch = s.grains.position[std::size_t(item.j)] + translation(s.cell, item.image) -
                           s.grains.position[std::size_t(item.i)];
    const double now = branch.stableNorm();
    const auto check_length = [&](const char* field, double value, double made) {
      if (now > 10 * made || made > 10 * now)
        refuse(at(std::string(Law::name) + "/" + field, k) + " = " + in_words(value) + " of a pair whose centres are " +
               in_words(now) +
               " m apart; allowed: a distance as it was made of a tenth to ten times that, of what still acts");
    };
    if (!Law::acts(column, now - radii)) return;
    if constexpr (requires { Law::length; }) check_length("length_m", columns[Law::length], columns[Law::length]);
    if constexpr (requires { Law::first_gap; })
      check_length("gap_m", columns[Law::first_gap], columns[Law::first_gap] + radii);
  }

  /// A spring without stiffness holds no force; one that a file brings would act for ever, and no energy would belong
  /// to it. In space tangential forces and moments lie in the tangent plane: the next step would turn one along the
  /// normal into it, whatever its size. A thousandth is what tables of six digits leave, the rest is round-off.
  void check_history(std::size_t k) const;

  const Specimen& s;
  const std::string& where_;
};

PairParameters parameters_of(const Specimen& s, const Contact& c) {
  const auto i = std::size_t(c.i), j = std::size_t(c.j);
  const auto material = [&](std::size_t g) -> const Material& {
    return s.materials[std::size_t(s.grains.material[g])];
  };
  return mix(s.contact, s.damping, material(i), s.grains.radius[i], 1, material(j), s.grains.radius[j], 1, 0);
}

void Relations::check_history(std::size_t k) const {
  const Contact& c = s.contacts[k];
  if (c.tangential_force.isZero(0) && c.rolling_moment.isZero(0)) return;
  const PairParameters parameters = parameters_of(s, c);
  if (!c.tangential_force.isZero(0) && !(parameters.kt > 0))
    advise(pair(k) + " holds a tangential force of " + in_words(c.tangential_force.stableNorm()) +
           " N, but its tangential stiffness is 0; give a stiffness > 0, or clear the tangential forces");
  // Of other shapes the normal is not along the branch, and a step takes what is tangential alone.
  if (s.cell.dimension == 2 || !is_round(s.shape)) return;
  const Vector3 &xi = s.grains.position[std::size_t(c.i)], &xj = s.grains.position[std::size_t(c.j)];
  const Vector3 shift = translation(s.cell, c.image), branch = xj + shift - xi;
  const double length = branch.stableNorm();
  if (!(length > 0)) return;  // grains at one place: refused where contacts are made
  const double reach = s.grains.radius[std::size_t(c.i)] + s.grains.radius[std::size_t(c.j)];
  const double root = with_law(s.contact.law, [&](auto law) {
    using Force = typename decltype(law)::Force;
    return Force::stores_root_overlap ? std::sqrt(reach) : 1.0;
  });
  constexpr double round_off = std::numeric_limits<double>::epsilon();
  const double share = 1e-3 + 8 * round_off * (xi.stableNorm() + xj.stableNorm() + shift.stableNorm()) / length;
  const auto expect_tangential = [&](const Vector3& vector, double stiffness, const char* field, const char* unit) {
    const double along = std::abs(vector.dot(branch)) / length;
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
}

void check_specimen(const Specimen& s, const std::string& where) {
  const std::size_t n = s.grains.size();
  if (n == 0 || n > 100'000'000)
    throw InputError(where + "grains/id: " + std::to_string(n) + " grains; allowed: 1 to 100000000 in one cell");
  const Ranges ranges(s, where);
  fields::visit(ranges, s);
  try {
    check_parameters(s.contact, s.damping, s.materials);
  } catch (const InputError& error) {
    throw InputError(where + error.what());
  }
  Relations(s, where).check();
}

}  // namespace rvelab
