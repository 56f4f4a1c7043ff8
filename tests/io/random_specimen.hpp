// Specimens whose every field holds random bits, and such as may be read; their comparison bit by bit. A specimen is
// filled and compared through its description (specimen_fields.hpp), which names every member; records and progress are
// taken apart by structured bindings: a field that is added to one does not compile here until it is filled and
// compared too.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>
#include <limits>
#include <map>
#include <numeric>
#include <random>
#include <set>
#include <string>
#include <tuple>
#include <type_traits>
#include <vector>

#include "rvelab/records/progress.hpp"
#include "rvelab/records/record.hpp"
#include "rvelab/specimen/specimen.hpp"
#include "rvelab/specimen/specimen_fields.hpp"
#include "tests/folder.hpp"
#include "tests/refusal.hpp"

namespace rvelab::test {

class RandomFill;

/// The bits of every field of a specimen, by its path.
class FieldBits {
 public:
  std::map<std::string, std::string> bits;

  template <class Value, class Described>
  void field(const fields::Path& path, const Value& value, const Described&) {
    add(bits[path.text()], value);
  }
  template <class Item, class... Columns>
  void table(const fields::Path& path, const std::vector<Item>& items, const Columns&... columns) {
    (add_column(bits[fields::Path(&path, columns.name).text()], items, columns), ...);
  }

 private:
  template <class Item, class Value>
  static void add_column(std::string& to, const std::vector<Item>& items, const fields::Field<Item, Value>& column) {
    for (const Item& item : items) add(to, item.*column.member);
  }
  template <class Value>
  static void add(std::string& to, const std::vector<Value>& values) {
    for (const Value& value : values) add(to, value);
  }
  static void add(std::string& to, const std::string& text) { to += text + '\0'; }
  template <class Value>
  static void add(std::string& to, const Value& value) {
    to.append(reinterpret_cast<const char*>(&value), sizeof value);  // no type here has padding
  }
};

/// Paths of the fields in which two specimens differ in a bit or in their number of entries.
inline std::vector<std::string> differing_fields(const Specimen& a, const Specimen& b) {
  FieldBits in_a, in_b;
  fields::visit(in_a, a);
  fields::visit(in_b, b);
  std::vector<std::string> paths;
  for (const auto& [path, bits] : in_a.bits) {
    if (bits != in_b.bits.at(path)) paths.push_back(path);
  }
  return paths;
}

/// Calls visit(a.field, b.field) for every scalar, tensor, text or vector of two values.
template <class Visit>
struct Pairs {
  Visit visit;

  void operator()(Specimen& a, Specimen& b) { visit.specimens(a, b); }
  void operator()(records::TestResult& a, records::TestResult& b) {
    auto& [protocol, axis, pressure, stages, records, probes, wall, steps] = a;
    auto& [protocol2, axis2, pressure2, stages2, records2, probes2, wall2, steps2] = b;
    all(protocol, protocol2, axis, axis2, pressure, pressure2, wall, wall2, steps, steps2);
    visit(stages, stages2);
    lists(records, records2);
    lists(probes, probes2);
  }
  void operator()(records::Checkpoint& a, records::Checkpoint& b) {
    (*this)(a.specimen, b.specimen);
    fields(a.progress, b.progress);
  }

 private:
  template <class Item>
  void lists(std::vector<Item>& a, std::vector<Item>& b) {
    for (std::size_t k = 0; k < std::min(a.size(), b.size()); ++k) fields(a[k], b[k]);
  }
  template <class A, class B, class... Rest>
  void all(A& a, B& b, Rest&... rest) {
    visit(a, b);
    if constexpr (sizeof...(rest) > 0) all(rest...);
  }
  void fields(records::ProbeResult& a, records::ProbeResult& b) {
    auto& [stage, stiffness] = a;
    auto& [stage2, stiffness2] = b;
    visit(stage, stage2);
    for (Eigen::Index k = 0; k < std::min(stiffness.size(), stiffness2.size()); ++k) {
      visit(stiffness.data()[k], stiffness2.data()[k]);
    }
  }
  void fields(records::Progress& a, records::Progress& b) {
    auto& [k, l, m, n, o, p, q, r, s, t, u, v, strains, first, turns, place, visits, largest, w, x, y, z] = a;
    auto& [k2, l2, m2, n2, o2, p2, q2, r2, s2, t2, u2, v2, strains2, first2, turns2, place2, visits2, largest2, w2, x2,
           y2, z2] = b;
    all(k, k2, l, l2, m, m2, n, n2, o, o2, p, p2, q, q2, r, r2, s, s2, t, t2, u, u2, v, v2, w, w2, x, x2, y, y2, z, z2);
    all(strains, strains2, first, first2, turns, turns2, place, place2, visits, visits2, largest, largest2);
  }
  void fields(records::Record& a, records::Record& b) {
    auto& [k, l, m, n, o, p, q, r, s, balanced, estimate, thin, asked] = static_cast<records::RecordedState&>(a);
    auto& [k2, l2, m2, n2, o2, p2, q2, r2, s2, balanced2, estimate2, thin2, asked2] =
        static_cast<records::RecordedState&>(b);
    visit(balanced, balanced2);
    visit(estimate, estimate2);
    visit(thin, thin2);
    all(k, k2, l, l2, m, m2, n, n2, o, o2, p, p2, q, q2, r, r2, s, s2);
    records::Quantities::for_each([&]<class Quantity>(std::type_identity<Quantity>, std::uint64_t) {
      visit(a.*Quantity::member, b.*Quantity::member);
    });
    // What was not asked for is not kept: a record with random bits in all fields has asked for all.
    if constexpr (std::is_same_v<Visit, RandomFill>) {
      asked |= records::all_quantities;
    } else {
      visit(asked, asked2);
    }
  }
};

/// Random bits: any double comes up, infinities, subnormals and NaN with any payload among them.
class RandomFill {
 public:
  explicit RandomFill(unsigned seed) : bits_(seed) {}

  template <class Value>
  void operator()(Value& value, Value&) {
    put(value);
  }
  void specimens(Specimen& specimen, Specimen&) { fields::visit(*this, specimen); }
  template <class Value, class Described>
  void field(const fields::Path&, Value& value, const Described&) {
    put(value);
  }
  template <class Item, class... Columns>
  void table(const fields::Path&, std::vector<Item>& items, const Columns&... columns) {
    for (Item& item : items) (put(item.*columns.member), ...);
  }
  /// A finite number of this range: evenly in a narrow one, of any size in a wide one.
  double within(const Interval& range) {
    for (;;) {
      double value = range.low + (range.high - range.low) * std::ldexp(double(bits_() >> 11), -53);
      if (!(range.high - range.low < 1e9)) put(value);
      if (std::isfinite(value) && range.contains(value)) return value;
    }
  }

 private:
  void put(bool& value) { value = bits_() % 2 == 1; }
  void put(std::string& value) {
    value = "grès ";
    for (int k = 0; k < 8; ++k) value += static_cast<char>('a' + bits_() % 26);
  }
  void put(Shape& value) { value = Shape(bits_() % 2); }
  void put(Law& value) { value = Law(bits_() % 4); }
  template <class Choice>
  requires std::is_enum_v<Choice>
  void put(Choice& value) { value = Choice(bits_() % std::size(Named<Choice>::names)); }
  void put(Vector3& value) {
    for (int k = 0; k < 3; ++k) put(value[k]);
  }
  void put(Matrix3& value) {
    for (int k = 0; k < 9; ++k) put(value(k / 3, k % 3));
  }
  void put(Image& value) {
    for (int& entry : value) put(entry);
  }
  void put(Turn& value) {
    put(value.w);
    put(value.v);
  }
  template <class Value>
  void put(std::vector<Value>& values) {
    for (Value& value : values) put(value);
  }
  template <class Value>
  requires std::is_arithmetic_v<Value>
  void put(Value& value) {
    const auto random = bits_();
    std::memcpy(&value, &random, sizeof value);
  }

  std::mt19937_64 bits_;
};

/// Draws the numbers of a specimen again that are out of the range of their field.
class Mend {
 public:
  Mend(unsigned seed, int dimension) : random_(seed), plane_(dimension == 2) {}

  template <class Value, class Owner>
  void field(const fields::Path&, Value& value, const fields::Field<Owner, Value>& field) {
    if constexpr (fields::Listed<Value>::is_list) {
      for (auto& entry : value) mend(entry, field);
    } else {
      mend(value, field);
    }
  }
  template <class Item, class... Columns>
  void table(const fields::Path&, std::vector<Item>& items, const Columns&... columns) {
    for (Item& item : items) (mend(item.*columns.member, columns), ...);
  }

 private:
  template <class Entry, class Described>
  void mend(Entry& entry, const Described& field) {
    if constexpr (!fields::Textual<Entry> && !std::is_same_v<Entry, bool>) {
      typename fields::Layout<Entry>::Scalar scalars[fields::Layout<Entry>::size];
      fields::Layout<Entry>::put(entry, scalars);
      for (std::size_t k = 0; k < std::size(scalars); ++k) {
        auto& value = scalars[k];
        using Scalar = std::remove_reference_t<decltype(value)>;
        const Interval range{std::max(field.allowed.low, double(std::numeric_limits<Scalar>::lowest())),
                             std::min(field.allowed.high, double(std::numeric_limits<Scalar>::max() / 2)),
                             field.allowed.low_open, field.allowed.high_open};
        if (!std::isfinite(double(value)) || !field.allowed.contains(double(value)))
          value = Scalar(random_.within(range)) + Scalar(std::is_integral_v<Scalar> && range.low_open);
        const bool flat = field.plane == fields::InPlane::along     ? k == 2
                          : field.plane == fields::InPlane::normal  ? k != 2
                          : field.plane == fields::InPlane::tangent ? k != 0
                                                                    : false;
        if (plane_ && flat) value = 0;
      }
      fields::Layout<Entry>::get(scalars, entry);
    }
  }

  RandomFill random_;
  bool plane_;
};

/// Counts the fields that differ in a bit.
struct BitComparison {
  int* differences;

  template <class Value>
  void operator()(const Value& a, const Value& b) {
    if (!same(a, b)) ++*differences;
  }
  void specimens(const Specimen& a, const Specimen& b) { *differences += int(differing_fields(a, b).size()); }

  static bool same(const std::string& a, const std::string& b) { return a == b; }
  template <class Value>
  static bool same(const std::vector<Value>& a, const std::vector<Value>& b) {
    bool equal = a.size() == b.size();
    for (std::size_t k = 0; equal && k < a.size(); ++k) equal = same(a[k], b[k]);
    return equal;
  }
  template <class Value>
  static bool same(const Value& a, const Value& b) {
    return std::memcmp(&a, &b, sizeof(Value)) == 0;  // no type here has padding
  }
};

template <class Value>
int differences(Value a, Value b) {
  int count = 0;
  Pairs<BitComparison>{BitComparison{&count}}(a, b);
  return count;
}

/// Random bits in every field.
inline Specimen random_bits(unsigned seed, std::size_t grain_count = 17, std::size_t contact_count = 31) {
  Specimen specimen;
  Grains& grains = specimen.grains;
  grains.id.resize(grain_count);
  grains.radius.resize(grain_count);
  grains.material.resize(grain_count);
  grains.semi_major.resize(grain_count);
  grains.semi_minor.resize(grain_count);
  for (auto* column : {&grains.half_x, &grains.half_y, &grains.half_z, &grains.exponent_xy, &grains.exponent_z})
    column->resize(grain_count);
  specimen.state.list.orientations.resize(grain_count);
  for (auto* vectors : {&grains.position, &grains.velocity, &grains.spin, &grains.orientation})
    vectors->resize(grain_count);
  specimen.state.list.positions.resize(grain_count);
  specimen.state.masses.mass.resize(grain_count);
  specimen.state.masses.inverse_inertia.resize(grain_count);
  specimen.state.memory_order.resize(grain_count);
  specimen.bodies.resize(9);
  specimen.members.resize(grain_count);
  specimen.contacts.resize(contact_count);
  specimen.materials.resize(3);
  specimen.state.energy_balance.interactions.resize(1);
  each_interaction_law([&](auto, auto law) {
    auto& list = static_cast<ListOf<decltype(law)>&>(specimen);
    list.items.resize(contact_count);
    if constexpr (FormsByItself<decltype(law)>) list.settings.resize(1);
  });
  Pairs<RandomFill>{RandomFill(seed)}(specimen, specimen);
  return specimen;
}

/// Random in every field within what the field may be, so that it may be read; no state that could be.
inline Specimen random_specimen(unsigned seed, std::size_t grain_count = 17, std::size_t contact_count = 31) {
  Specimen s = random_bits(seed, grain_count, contact_count);
  s.cell.dimension = dimension_of(s.shape);
  Mend mend(seed, s.cell.dimension);
  fields::visit(mend, s);
  RandomFill random(seed + 1);
  const auto below = [&](std::size_t limit) { return std::int32_t(random.within({0, double(limit), false, true})); };

  Grains& grains = s.grains;
  grains.semi_major = grains.semi_minor = {};
  grains.half_x = grains.half_y = grains.half_z = grains.exponent_xy = grains.exponent_z = {};
  s.state.list.orientations = {};
  grains.orientation = {};
  s.bodies = {};  // they know no interactions
  s.members = {};
  for (std::size_t k = 0; k < grain_count; ++k) {
    grains.id[k] = std::int64_t(7 * k) + below(7);
    grains.material[k] = below(3);
    grains.radius[k] = random.within({0.001, 0.01});
    for (int i = 0; i < s.cell.dimension; ++i) grains.position[k][i] = random.within({-0.5, 0.5});
  }
  s.cell.lattice << random.within({0.5, 2}), random.within({-1, 1}), random.within({-1, 1}), 0, random.within({0.5, 2}),
      random.within({-1, 1}), 0, 0, random.within({0.5, 2});
  if (s.cell.dimension == 2) s.cell.lattice(0, 2) = s.cell.lattice(1, 2) = 0;
  const double cosine = random.within({-1, 1}), sine = std::sqrt(1 - cosine * cosine);
  s.cell.rotation << cosine, -sine, 0, sine, cosine, 0, 0, 0, 1;

  s.contact.hertz_radius = HertzRadius::equivalent;
  s.damping.dashpot = Dashpot(below(3));
  for (Material& material : s.materials) {
    material.density = random.within({1, 1e4});
    for (const LawParameter& each : law_parameters()) material.*each.value = 0;
    for (const LawParameter& each : law_parameters())
      if (each.law == s.contact.law)
        material.*each.value = std::min(each.parameter.allowed.high, random.within({0.1, 1e9}));
  }
  s.solver.collision_steps = 5 + below(100);
  s.state.control.deferred.stretch = Matrix3::Identity();
  std::iota(s.state.memory_order.rbegin(), s.state.memory_order.rend(), 0);

  std::set<std::tuple<std::int32_t, std::int32_t, Image>> pairs;
  while (pairs.size() < contact_count) {
    const std::int32_t j = below(grain_count), i = below(std::size_t(j) + 1);
    pairs.insert({i, j, Image{1, below(3), s.cell.dimension == 2 ? 0 : below(3)}});
  }
  auto pair = pairs.begin();
  for (Contact& c : s.contacts) {
    std::tie(c.i, c.j, c.image) = *pair++;
    if (s.cell.dimension == 2) continue;
    const Vector3 branch =
        grains.position[std::size_t(c.j)] + translation(s.cell, c.image) - grains.position[std::size_t(c.i)];
    for (Vector3* history : {&c.tangential_force, &c.rolling_moment})
      *history = branch.cross(Vector3(random.within({-1, 1}), random.within({-1, 1}), random.within({-1, 1})));
  }
  Water& water = static_cast<ListOf<CapillaryBridge>&>(s).settings.front();
  water.suction = random.within({1, 1e5});
  water.volume_ratio = 0;
  static_cast<ListOf<DmtAdhesion>&>(s).settings.front().range = random.within({1e-6, 1e-5});
  each_interaction_law([&](auto, auto law) {
    using Law = decltype(law);
    auto& items = static_cast<ListOf<Law>&>(s).items;
    if constexpr (FormsByItself<Law>) {
      auto& settings = static_cast<ListOf<Law>&>(s).settings;
      const bool hertz = with_law(s.contact.law, [](auto of) { return decltype(of)::Force::needs_root_overlap; });
      if (Law::misfit(settings.front(), {s.cell.dimension, hertz}) != nullptr) settings.clear(), items.clear();
    }
    for (std::size_t k = 0; k < items.size(); ++k) {
      auto& item = items[k];
      item.i = s.contacts[k].i;
      item.j = s.contacts[k].j;
      item.image = s.contacts[k].image;
      // States are whole numbers, and what acts is about as long as when it was made.
      double columns[interaction_columns<Law>()];
      put_columns(item, columns);
      if constexpr (requires { Law::broken; }) columns[Law::broken] = below(3);
      if constexpr (requires { Law::present; }) columns[Law::present] = 1;
      if constexpr (requires { Law::touching; }) columns[Law::touching] = 1;
      const double length = (grains.position[std::size_t(item.j)] + translation(s.cell, item.image) -
                             grains.position[std::size_t(item.i)])
                                .norm();
      if constexpr (requires { Law::length; }) columns[Law::length] = length;
      if constexpr (requires { Law::first_gap; })
        columns[Law::first_gap] = length - grains.radius[std::size_t(item.i)] - grains.radius[std::size_t(item.j)];
      take_columns(columns, item);
    }
  });
  return s;
}

/// The first one from this seed on that has interactions of every law: JKR asks for a Hertz law.
inline Specimen with_every_interaction(unsigned seed) {
  for (;; ++seed) {
    Specimen s = random_specimen(seed);
    bool all = true;
    each_interaction_law([&](auto, auto law) { all &= !static_cast<const ListOf<decltype(law)>&>(s).items.empty(); });
    if (all) return s;
  }
}

inline records::TestResult random_result(unsigned seed, std::size_t record_count = 23) {
  records::TestResult result;
  result.stages = {"isotropic", "shear"};
  result.records.resize(record_count);
  result.probes.resize(5);
  for (records::ProbeResult& probe : result.probes) probe.stiffness.setZero(6, 6);
  Pairs<RandomFill>{RandomFill(seed)}(result, result);
  return result;
}

inline records::Checkpoint random_checkpoint(unsigned seed) {
  records::Checkpoint checkpoint{{}, random_specimen(seed)};
  checkpoint.progress.visits.resize(2);
  checkpoint.progress.largest.resize(7);
  records::Checkpoint filled = checkpoint;
  Pairs<RandomFill>{RandomFill(seed + 1)}(filled, filled);
  return {filled.progress, checkpoint.specimen};
}

}  // namespace rvelab::test
