// Interactions as specimens hold them: a pair of grains and the fields that the law declares, made from it.
#pragma once

#include <cstdint>
#include <iterator>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "rvelab/cell/cell.hpp"
#include "rvelab/interaction/laws.hpp"

namespace rvelab {

/// One field of an interaction.
template <class Law, int n>
struct FieldOf {
  static constexpr bool scalar = Law::fields[n].turning == Turning::scalar;
  std::conditional_t<scalar, double, Vector3> value = [] {
    if constexpr (scalar)
      return 0.0;
    else
      return Vector3(0, 0, 0);
  }();
};

/// i and j index Grains, i <= j; the branch is x_j + L image - x_i. Ordered by (i, j, image). Cell frame.
template <class Law, class = std::make_integer_sequence<int, int(std::size(Law::fields))>>
struct Interaction;
template <class Law, int... n>
struct Interaction<Law, std::integer_sequence<int, n...>> : FieldOf<Law, n>... {
  std::int32_t i = 0, j = 0;
  Image image{};
};

/// What interactions of a law form from, of laws that have such: none or one, for all grains.
template <class Law>
struct SettingsOf {};
template <FormsByItself Law>
struct SettingsOf<Law> {
  std::vector<typename Law::Settings> settings;
};
template <class>
struct AllSettingsOf;
template <class... Laws>
struct AllSettingsOf<TypeList<Laws...>> : SettingsOf<Laws>... {};
using InteractionSettings = AllSettingsOf<InteractionLaws>;

template <class Law>
struct ListOf : SettingsOf<Law> {
  std::vector<Interaction<Law>> items;
};
template <class>
struct ListsOf;
template <class... Laws>
struct ListsOf<TypeList<Laws...>> : ListOf<Laws>... {};
/// All interactions of a specimen other than contacts, by their kind.
using Interactions = ListsOf<InteractionLaws>;

/// visit(std::integral_constant<int, kind>, Law{}) for each kind of interaction.
template <class Visit, class... Laws>
void each_interaction_law(const Visit& visit, TypeList<Laws...>) {
  [&]<int... kind>(std::integer_sequence<int, kind...>) { (visit(std::integral_constant<int, kind>{}, Laws{}), ...); }
  (std::make_integer_sequence<int, int(sizeof...(Laws))>());
}
template <class Visit>
void each_interaction_law(const Visit& visit) {
  each_interaction_law(visit, InteractionLaws{});
}

/// By the number of its law.
inline Family family_of(int kind) {
  Family family{};
  each_interaction_law([&](auto number, auto law) {
    if (number == kind) family = decltype(law)::family;
  });
  return family;
}

/// Whether there are any, or something that they form from.
inline bool has_any(const Interactions& all) {
  bool any = false;
  each_interaction_law([&](auto, auto law) {
    const auto& list = static_cast<const ListOf<decltype(law)>&>(all);
    any |= !list.items.empty();
    if constexpr (FormsByItself<decltype(law)>) any |= !list.settings.empty();
  });
  return any;
}

template <class Law, class Settings>
concept FormsFrom = FormsByItself<Law> && std::is_same_v<typename Law::Settings, Settings>;
template <class Settings, class... Laws>
constexpr bool is_settings_of_any(TypeList<Laws...>) {
  return (FormsFrom<Laws, Settings> || ...);
}

/// Settings of one (InteractionSettings, Interactions) to the other.
template <class To, class From>
void copy_settings(const From& from, To& to) {
  each_interaction_law([&](auto, auto law) {
    using Law = decltype(law);
    if constexpr (FormsByItself<Law>) static_cast<SettingsOf<Law>&>(to) = static_cast<const SettingsOf<Law>&>(from);
  });
}

/// visit(field, value) for each field of an interaction, const or not, in the order of the law.
template <class Law, class Item, class Visit>
void each_field(Item& item, const Visit& visit) {
  [&]<int... n>(std::integer_sequence<int, n...>) {
    (visit(Law::fields[n],
           static_cast<std::conditional_t<std::is_const_v<Item>, const FieldOf<Law, n>, FieldOf<Law, n>>&>(item).value),
     ...);
  }
  (std::make_integer_sequence<int, int(std::size(Law::fields))>());
}

/// Its columns, as the law numbers them.
template <class Law>
void put_columns(const Interaction<Law>& item, double* columns) {
  each_field<Law>(item, [&](const InteractionField&, const auto& value) {
    if constexpr (std::is_same_v<std::decay_t<decltype(value)>, double>)
      *columns++ = value;
    else
      for (int k = 0; k < 3; ++k) *columns++ = value[k];
  });
}
template <class Law>
void take_columns(const double* columns, Interaction<Law>& item) {
  each_field<Law>(item, [&](const InteractionField&, auto& value) {
    if constexpr (std::is_same_v<std::decay_t<decltype(value)>, double>)
      value = *columns++;
    else
      for (int k = 0; k < 3; ++k) value[k] = *columns++;
  });
}

/// The same interaction with j for i and i for j.
template <class Law>
void turn_round(Interaction<Law>& item, int dimension) {
  each_field<Law>(item, [&](const InteractionField& field, auto& value) {
    if constexpr (!std::is_same_v<std::decay_t<decltype(value)>, double>) {
      // In 2D the component along t = (-n_y, n_x) keeps its sign: force and t both turn.
      if (field.turning == Turning::moment || dimension == 3) value = -value;
    }
  });
}

/// After the cell's frame turned: its vectors are turned by `turn`.
template <class Law>
void turn_vectors(Interaction<Law>& item, const Matrix3& turn) {
  each_field<Law>(item, [&](const InteractionField&, auto& value) {
    if constexpr (!std::is_same_v<std::decay_t<decltype(value)>, double>) value = turn * value;
  });
}

/// A vector of an interaction in the laboratory frame; a component along the tangent of the plane stays what it is.
inline Vector3 in_laboratory(const InteractionField& field, const Vector3& value, const Cell& cell) {
  return field.turning == Turning::tangent && cell.dimension == 2 ? value : Vector3(cell.rotation * value);
}

/// By pair: order of lists, and whether two name one.
template <class Item>
auto pair_of(const Item& item) {
  return std::tie(item.i, item.j, item.image);
}

}  // namespace rvelab
