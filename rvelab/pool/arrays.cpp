#include "rvelab/pool/arrays.hpp"

#include <deque>
#include <functional>
#include <optional>
#include <string>

#include "rvelab/records/quantities.hpp"
#include "rvelab/specimen/clumps.hpp"

namespace rvelab::pool {

namespace {

/// Entries one after another.
class Entries {
 public:
  void put(double value) { add(&value, 1); }
  void put(std::int64_t value) { add(&value, 1); }
  void put(const Vector3& value) { add(value.data(), 3); }
  void put(const Matrix3& value) {
    double rows[9];
    store(value, rows);
    add(rows, 9);
  }
  void put(const Image& value) {
    for (const auto each : value) put(std::int64_t(each));
  }
  std::vector<std::byte> take() { return std::move(bytes_); }

 private:
  template <class Value>
  void add(const Value* values, std::size_t count) {
    static_assert(sizeof(Value) == 8);
    const auto* from = reinterpret_cast<const std::byte*>(values);
    bytes_.insert(bytes_.end(), from, from + 8 * count);
  }
  std::vector<std::byte> bytes_;
};

/// A state as arrays are read from it: vectors turned into the laboratory frame.
struct Read : records::MeasuredState {
  using records::MeasuredState::MeasuredState;
  Vector3 turned(const Vector3& vector) const { return network.cell.rotation * vector; }
  /// Of scaled masses velocities are none.
  Vector3 moving(const Vector3& vector) const {
    return network.loading == Loading::quasi_static ? Vector3::Zero().eval() : turned(vector);
  }
  /// What a network does not hold.
  const Grains& grains() const {
    if (grains_) return *grains_;
    const Specimen specimen = rve.specimen();
    std::vector<double> radii;
    for (const GrainState& grain : network.grains) radii.push_back(grain.radius);
    grains_ = specimen.bodies.empty() ? specimen.grains : bodies_as_grains(specimen, radii);
    return *grains_;
  }

  template <class Law>
  const std::vector<Interaction<Law>>& interactions() const {
    if (!interactions_) interactions_ = rve.interactions();
    return static_cast<const ListOf<Law>&>(*interactions_).items;
  }

 private:
  mutable std::optional<Grains> grains_;
  mutable std::optional<Interactions> interactions_;
};

struct Array {
  ArrayText text;
  std::function<void(const Read&, Entries&)> write;
  std::function<bool(Shape)> has = [](Shape) { return true; };
  std::function<std::size_t(const Rve&)> rows = nullptr;  ///< of interactions
};

template <class Value>
constexpr std::int64_t columns_of() {
  return std::is_same_v<Value, Matrix3> ? 9 : std::is_same_v<Value, Vector3> || std::is_same_v<Value, Image> ? 3 : 1;
}
template <class Value>
constexpr std::int32_t type_of() {
  return std::is_same_v<Value, std::int64_t> || std::is_same_v<Value, Image> ? RVELAB_INT64 : RVELAB_DOUBLE;
}

/// A column: entry(state, k) of each of `rows`(state).
template <class Rows, class Entry>
Array column(const char* name, const char* unit, const char* meaning, std::int32_t of, Rows rows, Entry entry) {
  using Value = std::decay_t<decltype(entry(std::declval<const Read&>(), std::size_t()))>;
  return {{name, unit, meaning, of, type_of<Value>(), columns_of<Value>()}, [=](const Read& state, Entries& to) {
            for (std::size_t k = 0; k < rows(state); ++k) to.put(entry(state, k));
          }};
}
/// entry(state, grain or contact).
template <class Entry>
Array of_grains(const char* name, const char* unit, const char* meaning, Entry entry) {
  return column(
      name, unit, meaning, RVELAB_OF_GRAINS, [](const Read& state) { return state.network.grains.size(); },
      [=](const Read& state, std::size_t k) { return entry(state, state.network.grains[k]); });
}
template <class Entry>
Array of_contacts(const char* name, const char* unit, const char* meaning, Entry entry) {
  return column(
      name, unit, meaning, RVELAB_OF_CONTACTS, [](const Read& state) { return state.network.contacts.size(); },
      [=](const Read& state, std::size_t k) { return entry(state, state.network.contacts[k]); });
}
template <class Entry>
Array of_grain_rows(const char* name, const char* meaning, Entry entry) {
  return column(
      name, "1", meaning, RVELAB_OF_GRAINS, [](const Read& state) { return state.network.grains.size(); }, entry);
}

void add_measures(std::vector<Array>& to) {
  records::Quantities::for_each([&]<class Quantity>(std::type_identity<Quantity>, std::uint64_t) {
    using Value = records::ValueOf<Quantity>;
    constexpr auto& text = Quantity::text;
    to.push_back({{text.name, text.unit, text.meaning, RVELAB_OF_CELL, RVELAB_DOUBLE, columns_of<Value>()},
                  [](const Read& state, Entries& entries) { entries.put(Quantity::measure(state)); }});
  });
}

void add_grains(std::vector<Array>& to) {
  static std::deque<std::string> names;  // as long as the library is loaded
  const auto is_long = [](Shape shape) { return !is_round(shape); };
  to.push_back(of_grain_rows("grains/id", "as the specimen numbers them",
                             [](const Read& state, std::size_t k) { return state.grains().id[k]; }));
  to.push_back(
      of_grain_rows("grains/material", "row of the specimen's materials",
                    [](const Read& state, std::size_t k) { return std::int64_t(state.grains().material[k]); }));
  to.push_back(of_grains("grains/radius_m", "m", "of the disc of its area, the sphere of its volume",
                         [](const Read&, const GrainState& grain) { return grain.radius; }));
  [&]<int... number>(std::integer_sequence<int, number...>) {
    const auto add_lengths = [&]<class By>(std::type_identity<By>, Shape shape) {
      if constexpr (!By::round) {
        for (const auto& length : By::template columns<One>) {
          to.push_back(of_grains(names.emplace_back(std::string("grains/") + length.dataset).c_str(), length.unit,
                                 length.unit[0] == 'm' ? "length of its shape" : "exponent of its shape",
                                 [entries = length.entries](const Read&, const GrainState& grain) {
                                   return static_cast<const typename By::Own&>(grain).*entries;
                                 }));
          to.back().has = [shape](Shape of) { return of == shape; };
        }
      }
    };
    (add_lengths(std::type_identity<Description<Shape(number)>>{}, Shape(number)), ...);
  }
  (std::make_integer_sequence<int, shape_count>());
  to.push_back(of_grains("grains/mass_kg", "kg", "", [](const Read&, const GrainState& grain) { return grain.mass; }));
  to.push_back(of_grains("grains/moment_of_inertia_kg_m2", "kg m^2", "about its centre",
                         [](const Read&, const GrainState& grain) { return grain.inertia; }));
  to.push_back(column(
      "grains/inertia_tensor_kg_m2", "kg m^2",
      "of bodies (clumps, superellipsoids): about its centre; not there of other grains", RVELAB_OF_GRAINS,
      [](const Read& state) { return state.network.moments.size(); },
      [](const Read& state, std::size_t k) -> Matrix3 {
        const Matrix3& turn = state.network.cell.rotation;
        return turn * state.network.moments[k] * turn.transpose();
      }));
  to.back().rows = [](const Rve& rve) {
    const std::size_t bodies = rve.network().moments.size();
    return bodies > 0 ? bodies : std::size_t(-1);  // -1: not there
  };
  to.push_back(column(
      "grains/axes", "1", "of bodies (clumps, superellipsoids): their axes as columns; not there of other grains",
      RVELAB_OF_GRAINS, [](const Read& state) { return state.network.axes.size(); },
      [](const Read& state, std::size_t k) -> Matrix3 { return state.network.cell.rotation * state.network.axes[k]; }));
  to.back().rows = [](const Rve& rve) {
    const std::size_t bodies = rve.network().axes.size();
    return bodies > 0 ? bodies : std::size_t(-1);  // -1: not there
  };
  to.push_back(of_grains("grains/position_m", "m", "of its centre; its images stand lattice columns apart",
                         [](const Read& state, const GrainState& grain) { return state.turned(grain.position); }));
  to.push_back(of_grains("grains/orientation", "1", "along its long axis, of length 1",
                         [](const Read& state, const GrainState& grain) { return state.turned(grain.orientation); }));
  to.back().has = is_long;
  to.push_back(of_grains("grains/velocity_m_s", "m/s", "less that of the homogeneous deformation",
                         [](const Read& state, const GrainState& grain) { return state.moving(grain.velocity); }));
  to.push_back(of_grains("grains/spin_rad_s", "rad/s", "less that of the cell",
                         [](const Read& state, const GrainState& grain) { return state.moving(grain.spin); }));
  to.push_back(of_grains("grains/resultant_N", "N", "sum of its contact forces",
                         [](const Read& state, const GrainState& grain) { return state.turned(grain.resultant); }));
  to.push_back(of_grains("grains/torque_N_m", "N m", "sum of its contact torques",
                         [](const Read& state, const GrainState& grain) { return state.turned(grain.torque); }));
}

void add_contacts(std::vector<Array>& to) {
  using C = ContactState;
  to.push_back(of_contacts("contacts/i", "1", "row of the first grain",
                           [](const Read&, const C& contact) { return std::int64_t(contact.i); }));
  to.push_back(of_contacts("contacts/j", "1", "row of the second grain",
                           [](const Read&, const C& contact) { return std::int64_t(contact.j); }));
  to.push_back(of_contacts("contacts/image", "1", "lattice columns by which j is shifted",
                           [](const Read&, const C& contact) { return contact.image; }));
  to.push_back(of_contacts("contacts/branch_m", "m", "from the centre of i to that of j",
                           [](const Read& state, const C& contact) { return state.turned(contact.branch); }));
  to.push_back(of_contacts("contacts/normal", "1", "from i to j",
                           [](const Read& state, const C& contact) { return state.turned(contact.normal); }));
  to.push_back(
      of_contacts("contacts/overlap_m", "m", "", [](const Read&, const C& contact) { return contact.overlap; }));
  to.push_back(of_contacts("contacts/force_N", "N", "on j, damping included",
                           [](const Read& state, const C& contact) { return state.turned(contact.force()); }));
  to.push_back(of_contacts("contacts/normal_force_N", "N", "repulsion positive, damping included",
                           [](const Read&, const C& contact) { return contact.normal_force; }));
  to.push_back(of_contacts("contacts/tangential_force_N", "N", "on j, damping included",
                           [](const Read& state, const C& contact) { return state.turned(contact.tangential_force); }));
  to.push_back(of_contacts("contacts/rolling_moment_N_m", "N m", "on j",
                           [](const Read& state, const C& contact) { return state.turned(contact.rolling_moment); }));
  to.push_back(of_contacts("contacts/normal_stiffness_N_m", "N/m", "of a further overlap",
                           [](const Read&, const C& contact) { return contact.normal_stiffness; }));
  to.push_back(of_contacts("contacts/tangential_stiffness_N_m", "N/m", "",
                           [](const Read&, const C& contact) { return contact.tangential_stiffness; }));
  to.push_back(of_contacts("contacts/friction", "1", "coefficient",
                           [](const Read&, const C& contact) { return contact.friction; }));
  to.push_back(of_contacts("contacts/elastic_energy_J", "J", "normal, tangential and rolling springs",
                           [](const Read&, const C& contact) { return contact.elastic_energy; }));
}

/// Of a kind of interaction: its pair, its branch and what its law keeps.
template <class Law>
void add_interactions(std::vector<Array>& to) {
  static std::deque<std::string> names;  // as long as the library is loaded
  using Item = Interaction<Law>;
  const auto add = [&](const std::string& field, const char* unit, const char* meaning, auto entry) {
    to.push_back(column(
        names.emplace_back(std::string(Law::name) + "/" + field).c_str(), unit, meaning, RVELAB_OF_INTERACTIONS,
        [](const Read& state) { return state.template interactions<Law>().size(); },
        [=](const Read& state, std::size_t k) { return entry(state, state.template interactions<Law>()[k]); }));
    to.back().rows = [](const Rve& rve) {
      const Interactions all = rve.interactions();
      return static_cast<const ListOf<Law>&>(all).items.size();
    };
  };
  add("i", "1", "row of the first grain", [](const Read&, const Item& item) { return std::int64_t(item.i); });
  add("j", "1", "row of the second grain", [](const Read&, const Item& item) { return std::int64_t(item.j); });
  add("image", "1", "lattice columns by which j is shifted", [](const Read&, const Item& item) { return item.image; });
  [&]<int... n>(std::integer_sequence<int, n...>) {
    (add(Law::fields[n].name, Law::fields[n].unit, "",
         [](const Read& state, const Item& item) {
           const auto& value = static_cast<const FieldOf<Law, n>&>(item).value;
           if constexpr (FieldOf<Law, n>::scalar)
             return value;
           else
             return in_laboratory(Law::fields[n], value, state.network.cell);
         }),
     ...);
  }
  (std::make_integer_sequence<int, int(std::size(Law::fields))>());
}

const std::vector<Array>& arrays() {
  static const std::vector<Array> all = [] {
    std::vector<Array> made;
    add_measures(made);
    add_grains(made);
    add_contacts(made);
    each_interaction_law([&](auto, auto law) { add_interactions<decltype(law)>(made); });
    return made;
  }();
  return all;
}

}  // namespace

std::span<const ArrayText> array_texts() {
  static const std::vector<ArrayText> texts = [] {
    std::vector<ArrayText> made;
    for (const Array& array : arrays()) made.push_back(array.text);
    return made;
  }();
  return texts;
}

std::vector<std::int64_t> array_rows(const Rve& rve) {
  const Network network = rve.network();
  std::vector<std::int64_t> rows;
  for (const Array& array : arrays()) {
    const std::size_t count = array.rows                          ? array.rows(rve)
                              : array.text.of == RVELAB_OF_CELL   ? 1
                              : array.text.of == RVELAB_OF_GRAINS ? network.grains.size()
                                                                  : network.contacts.size();
    rows.push_back(array.has(network.shape) ? std::int64_t(count) : -1);
  }
  return rows;
}

std::vector<std::byte> array_of(const Rve& rve, std::size_t k) {
  Entries entries;
  arrays()[k].write(Read(rve), entries);
  return entries.take();
}

}  // namespace rvelab::pool
