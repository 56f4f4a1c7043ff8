// What a specimen that is read must be: every field in its range, and the fields beside one another. Files whose values
// another program changed, and which were sealed again, are refused by the field, wherever specimens are read.
#include "rvelab/specimen/specimen_check.hpp"

#include <filesystem>
#include <limits>

#include "random_specimen.hpp"
#include "record_files.hpp"
#include "rvelab/io/hdf5/schema.hpp"
#include "rvelab/io/hdf5/specimen_file.hpp"
#include "rvelab/io/journal/record_journal.hpp"
#include "rvelab/solver/rve.hpp"
#include "rvelab/solver/snapshot.hpp"
#include "tests/bodies.hpp"

using namespace rvelab;
using namespace rvelab::test;
using Catch::Matchers::Contains;

namespace {

constexpr double no_number = std::numeric_limits<double>::quiet_NaN();
constexpr double beyond_all = std::numeric_limits<double>::infinity();

/// A random specimen of this dimension that may be read, with interactions of every law (JKR asks for a Hertz law).
Specimen readable(int dimension) {
  for (unsigned seed = 1;; ++seed) {
    Specimen specimen = with_every_interaction(seed);
    if (specimen.cell.dimension == dimension) return specimen;
  }
}

/// Gives one component of the k-th field the next of the values that it must not have, and says so.
class Spoil {
 public:
  Spoil(std::size_t number, int component, double value) : number_(number), component_(component), value_(value) {}

  template <class Value, class Owner>
  void field(const fields::Path& path, Value& value, const fields::Field<Owner, Value>& field) {
    if (at_++ != number_) return;
    if constexpr (fields::Listed<Value>::is_list) {
      if (!value.empty()) spoil(path.text(), "[" + std::to_string(value.size() - 1), value.back(), field);
    } else {
      spoil(path.text(), "", value, field);
    }
  }
  template <class Item, class... Columns>
  void table(const fields::Path& path, std::vector<Item>& items, const Columns&... columns) {
    (column(fields::Path(&path, columns.name), items, columns), ...);
  }
  bool beyond_last() const { return at_ <= number_; }
  const std::string& expected() const { return expected_; }

 private:
  template <class Item, class Value>
  void column(const fields::Path& path, std::vector<Item>& items, const fields::Field<Item, Value>& field) {
    if (at_++ == number_ && !items.empty())
      spoil(path.text(), "[" + std::to_string(items.size() - 1), items.back().*field.member, field);
  }
  template <class Entry, class Described>
  void spoil(const std::string& path, std::string index, Entry& entry, const Described& field) {
    if constexpr (!fields::Textual<Entry> && !std::is_same_v<Entry, bool>) {
      using Layout = fields::Layout<Entry>;
      typename Layout::Scalar scalars[Layout::size];
      if (component_ >= int(Layout::size)) return;
      Layout::put(entry, scalars);
      using Scalar = typename Layout::Scalar;
      if constexpr (std::is_integral_v<Scalar>) {
        if (std::isnan(value_) || std::abs(value_) > 1e9) return;
      }
      if (std::isfinite(value_) && field.allowed.contains(value_)) return;
      scalars[component_] = Scalar(value_);
      Layout::get(scalars, entry);
      const std::string separator = index.empty() ? "[" : ", ";
      if (Layout::size == 3) index += separator + std::to_string(component_);
      if (Layout::size == 9)
        index += separator + std::to_string(component_ / 3) + ", " + std::to_string(component_ % 3);
      expected_ = path + index + (index.empty() ? "" : "]");
    }
  }

  std::size_t number_, at_ = 0;
  int component_;
  double value_;
  std::string expected_;
};

std::string refusal(const Specimen& specimen) {
  return input_error([&] { check_specimen(specimen, "x.h5: /"); });
}

/// Refused, by one sentence that names the field.
template <class Edit>
std::string refusal(int dimension, Edit edit) {
  Specimen specimen = readable(dimension);
  REQUIRE(refusal(specimen).empty());
  edit(specimen);
  const std::string said = refusal(specimen);
  CHECK(said.starts_with("x.h5: /"));
  CHECK(said.find('\n') == std::string::npos);
  return said;
}

/// Clumps know no interactions, so that what is read with those has none.
Specimen two_clumps() {
  Specimen s = empty_specimen(Shape::sphere, 0.1, linear_material(1e5, 5e4, 0.5));
  const Clump pair = clump_of("pair", {{{-0.5, 0, 0}, 1}, {{0.5, 0, 0}, 1}}, 3);
  add_clump(s, pair, 0.01, {-0.02, 0.003, 0}, Turn{});
  add_clump(s, pair, 0.012, {0.02, -0.004, 0}, normalised(Turn{0.8, {0, 0.6, 0.1}}));
  return s;
}

/// Sheared, so that contacts hold tangential forces.
Specimen sheared(Rve rve, double strain) {
  rve.apply(gradient(0, strain, 0, 0), 0);
  Specimen specimen = rve.specimen();
  REQUIRE(specimen.contacts.size() > 20);
  return specimen;
}

Specimen sheared_spheres() {
  return sheared(
      at_rest(disordered(Shape::sphere, 4, linear_material(1e5, 5e4, 0.5), Law::linear_stiffness, 0.51, 4), 1e-6),
      1e-3);
}

}  // namespace

TEST_CASE("a number that is none, or beyond the range that its field states, is refused by the field and its index") {
  for (const Specimen& good : {readable(2), readable(3), two_clumps()}) {
    const int dimension = good.cell.dimension;
    REQUIRE(refusal(good).empty());
    std::size_t refused = 0, number = 0;
    for (bool last = false; !last; ++number)
      for (const int component : {0, 1, 2, 5, 8})
        for (const double value : {no_number, beyond_all, -beyond_all, -1.0, 0.0, 1e300}) {
          Specimen bad = good;
          Spoil spoil(number, component, value);
          fields::visit(spoil, bad);
          last = spoil.beyond_last();
          if (spoil.expected().empty()) continue;
          CAPTURE(dimension, spoil.expected(), value);
          const std::string said = refusal(bad);
          CHECK_THAT(said, Contains("x.h5: /" + spoil.expected()) && Contains("allowed: "));
          ++refused;
        }
    CHECK(number > 90);
    CHECK(refused > 400);
  }
}

TEST_CASE("contacts that stand twice, out of order, with themselves or with no grain are refused by their place") {
  for (const int dimension : {2, 3}) {
    CHECK_THAT(refusal(dimension, [](Specimen& s) { s.contacts[4] = s.contacts[3]; }),
               Contains("/contacts[4], grains "));
    CHECK_THAT(refusal(dimension, [](Specimen& s) { std::swap(s.contacts[7], s.contacts[20]); }),
               Contains("out of order"));
    CHECK_THAT(refusal(dimension, [](Specimen& s) { std::swap(s.contacts[0], s.contacts[1]); }),
               Contains("out of order; allowed: contacts sorted by i, then j, then image"));
    CHECK_THAT(refusal(dimension,
                       [](Specimen& s) {
                         s.contacts.resize(1);
                         s.contacts[0] = {2, 2, {}, Vector3::Zero(), Vector3::Zero(), 0};
                       }),
               Contains("/contacts[0]"));
    CHECK_THAT(refusal(dimension, [](Specimen& s) { s.contacts[5].j = 17; }),
               Contains("contacts/j[5] = 17; allowed: 0 <= i <= j < 17"));
    CHECK_THAT(refusal(dimension, [](Specimen& s) { s.contacts[5].i = s.contacts[5].j + 1; }),
               Contains("/contacts/i[5] = "));
  }
}

TEST_CASE("in 2D everything lies in the plane, and spins and moments are normal to it") {
  CHECK_THAT(refusal(2, [](Specimen& s) { s.grains.position[3][2] = 1e-9; }),
             Contains("/grains/position_m[3, 2] of grain"));
  CHECK_THAT(refusal(2, [](Specimen& s) { s.grains.velocity[3][2] = -2; }), Contains("/grains/velocity[3, 2]"));
  CHECK_THAT(refusal(2, [](Specimen& s) { s.grains.spin[3][1] = 1; }), Contains("/grains/spin[3, 1]"));
  CHECK_THAT(refusal(2, [](Specimen& s) { s.contacts[3].image[2] = 1; }), Contains("/contacts/image[3, 2]"));
  CHECK_THAT(refusal(2, [](Specimen& s) { s.contacts[3].tangential_force[1] = 1; }),
             Contains("/contacts/tangential_force_N[3, 1]"));
  CHECK_THAT(refusal(2, [](Specimen& s) { s.contacts[3].rolling_moment[0] = 1; }),
             Contains("/contacts/rolling_moment_N_m[3, 0]"));
  CHECK_THAT(refusal(2, [](Specimen& s) { s.cell.lattice(0, 2) = 0.1; }), Contains("/cell/lattice_m[0, 2]"));
}

TEST_CASE("tangential forces and moments in space lie in the tangent plane, to round-off") {
  const double strain = 5e-5;  // bodies under 5 kPa overlap by little more
  for (const Specimen& good :
       {sheared_spheres(), sheared(Rve(pressed_clumps(Shape::sphere, 3, "pair", 5)), strain),
        sheared(Rve(pressed_solids(3, ellipsoid, 5)), strain), sheared(Rve(pressed_solids(3, blocky, 5)), strain)}) {
    CAPTURE(int(good.shape), good.bodies.size());
    CHECK(refusal(good).empty());
    const Network network = Rve(good).network();
    REQUIRE(network.contacts.size() == good.contacts.size());
    std::size_t turned = 0;
    for (std::size_t k = 0; k < good.contacts.size(); ++k) {
      Specimen bad = good;
      Contact& c = bad.contacts[k];
      const double force = c.tangential_force.norm();
      if (!(force > 0)) continue;
      const Vector3 normal = network.contacts[k].normal;
      c.tangential_force = force * normal;
      CHECK_THAT(refusal(bad), Contains("/contacts/tangential_force_N[" + std::to_string(k) + "] has "));
      c = good.contacts[k];
      c.tangential_force += 0.1 * force * normal;
      CHECK_THAT(refusal(bad), Contains("/contacts/tangential_force_N[" + std::to_string(k) + "]"));
      c.tangential_force = good.contacts[k].tangential_force + 1e-5 * force * normal;  // six digits of a table
      CHECK(refusal(bad).empty());
      ++turned;
    }
    CHECK(turned > 10);
  }
}

TEST_CASE("a lattice is upper triangular with a positive diagonal and bounded tilt, its frame a rotation") {
  for (const int dimension : {2, 3}) {
    CHECK_THAT(refusal(dimension, [](Specimen& s) { s.cell.lattice(1, 1) *= -1; }), Contains("/cell/lattice_m[1, 1]"));
    CHECK_THAT(refusal(dimension, [](Specimen& s) { s.cell.lattice(2, 0) = 1e-12; }),
               Contains("/cell/lattice_m[2, 0]"));
    CHECK_THAT(refusal(dimension, [](Specimen& s) { s.cell.lattice(0, 1) = 1e6; }),
               Contains("/cell/lattice_m[0, 1] = 1e+06 m is a tilt"));
    CHECK_THAT(refusal(dimension, [](Specimen& s) { s.cell.rotation(0, 0) += 1e-3; }), Contains("/cell/rotation"));
    CHECK_THAT(refusal(dimension, [](Specimen& s) { s.cell.rotation *= -1; }), Contains("/cell/rotation"));
  }
  CHECK_THAT(refusal(3, [](Specimen& s) { s.cell.lattice(1, 2) = -1e6; }), Contains("/cell/lattice_m[1, 2]"));
  Specimen sheared = readable(3);  // far from reduced, as after a strain of 300
  sheared.contacts.clear();
  static_cast<Interactions&>(sheared) = {};
  sheared.cell.lattice(0, 1) = 300 * sheared.cell.lattice(1, 1);
  sheared.cell.lattice(0, 0) = sheared.cell.lattice(1, 1);
  CHECK(refusal(sheared).empty());
}

TEST_CASE("constants of materials are in the range of the law that reads them, read or not") {
  const auto with = [](Law law, double Material::*constant, double value) {
    return refusal(3, [&](Specimen& s) {
      s.contact.law = law;
      s.materials[1].*constant = value;
    });
  };
  for (const Law law : {Law::linear, Law::hertz_mindlin, Law::linear_adhesive}) {
    CHECK_THAT(with(law, &Material::adhesion_pressure, -5), Contains("/materials/"));
    CHECK_THAT(with(law, &Material::poisson_ratio, 25), Contains("/materials/"));
  }
  Specimen s = readable(3);
  static_cast<ListOf<JkrAdhesion>&>(s) = {};
  s.contact.law = Law::linear;
  for (Material& material : s.materials) {
    for (const LawParameter& each : law_parameters()) material.*each.value = 0;
    material.young_modulus = 1e8;
    material.stiffness_ratio = 0.5;
  }
  CHECK(refusal(s).empty());
  s.materials[1].pull_off_force = -1e-3;
  CHECK_THAT(refusal(s), Contains("/materials/adhesion_N[1]"));
  s.materials[1].pull_off_force = 0;
  s.materials[1].young_modulus = 0;
  CHECK_THAT(refusal(s), Contains("/materials/young_modulus_Pa[1]"));
  s.materials[1].young_modulus = 1e8;
  s.damping.dashpot = Dashpot::none;
  s.damping.restitution = 0;  // not read now, and divided by its logarithm where it is
  CHECK_THAT(refusal(s), Contains("/damping/restitution = 0"));
}

TEST_CASE("grains have masses, ids that ascend and a place in the cell; lists have a row for each") {
  CHECK_THAT(refusal(3, [](Specimen& s) { s.grains.id[5] = s.grains.id[4]; }), Contains("/grains/id[5]"));
  CHECK_THAT(refusal(3, [](Specimen& s) { s.grains.material[5] = 3; }), Contains("/grains/material[5]"));
  CHECK_THAT(refusal(3, [](Specimen& s) { s.grains.radius[5] = 1e-150; }), Contains("/grains/radius_m[5]"));
  CHECK_THAT(refusal(2, [](Specimen& s) { s.grains.position[5][0] = 1e12; }), Contains("/grains/position_m[5]"));
  CHECK_THAT(refusal(2, [](Specimen& s) { s.grains.spin.pop_back(); }), Contains("/grains/spin has 16 rows"));
  CHECK_THAT(refusal(2, [](Specimen& s) { s.grains.orientation.resize(17, Vector3::UnitX()); }),
             Contains("/grains/orientation has 17 rows"));
  CHECK_THAT(refusal(2, [](Specimen& s) { s.state.list.positions.pop_back(); }),
             Contains("/state/list/positions_m has 16 rows"));
  CHECK_THAT(refusal(2, [](Specimen& s) { s.state.masses.mass.clear(); }), Contains("/state/masses/mass has 0 rows"));
  CHECK_THAT(refusal(2, [](Specimen& s) { s.state.memory_order[0] = s.state.memory_order[1]; }),
             Contains("/state/memory_order is no permutation"));
}

TEST_CASE("the same refusal meets a specimen file, a record file, its snapshots, a journal and a snapshot in memory") {
  const Folder folder;
  Specimen bad = readable(2);
  bad.materials[0].density = 1e300;
  const std::string field = "materials/density_kg_m3[0]";
  io::write_specimen(bad, folder / "s.h5");
  CHECK_THAT(input_error([&] { io::read_specimen(folder / "s.h5"); }), Contains("s.h5: /" + field));
  CHECK_THAT(input_error([&] { io::read_states(folder / "s.h5"); }), Contains("s.h5: /" + field));
  CHECK_THAT(input_error([&] { io::seal_file(folder / "s.h5", folder / "t.h5"); }), Contains("s.h5: /" + field));
  write_records(random_result(1), bad, "", folder / "r.h5");
  CHECK_THAT(input_error([&] { io::read_recorded_test(folder / "r.h5"); }), Contains("r.h5: /specimen/" + field));
  const auto payload = io::encode_snapshot(2, bad);
  CHECK_THAT(input_error([&] { io::decode_snapshot("run.h5.journal", payload); }),
             Contains("run.h5.journal: /specimen/" + field));
  CHECK_THAT(input_error([&] { Rve{bad}; }), Contains("specimen: " + field));
  const Specimen start = readable(2);
  CHECK_THAT(input_error([&] { Rve{from_bytes(to_bytes(bad))}; }), Contains(field));
}
