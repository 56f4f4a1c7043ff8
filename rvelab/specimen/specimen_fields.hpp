// The fields of a specimen, each described once: snapshots, files and comparisons of specimens go through fields::visit
// (described.hpp). Those of the state of the solver are with their owners. Names, units and order are those of the file
// (rvelab/io/README.md); a member of a struct that has no entry does not compile.
//
// Each field states the range of its numbers unless all finite ones are allowed (Field::within); constants of a law
// have theirs in the law (contact/parameter.hpp). check_specimen checks them (specimen_check.hpp).
//
// Adding, removing or renaming a field makes a new version of the file format (io/hdf5/schema.hpp), but for one that is
// left out of the files of specimens without it.
#pragma once

#include <iterator>
#include <tuple>
#include <utility>

#include "rvelab/specimen/described.hpp"
#include "rvelab/specimen/specimen.hpp"

namespace rvelab::fields {

template <>
inline constexpr auto members_of<Cell> = std::tuple{
    Field{"dimension", &Cell::dimension, "1"}.within({2, 3}),
    Field{"lattice_m", &Cell::lattice, "m"},
    Field{"rotation", &Cell::rotation, "1"},
    Field{"increments", &Cell::increments, "1"}.within(number_from_zero),
};

/// The columns of one shape, and of all.
template <class By>
constexpr auto fields_of_shape() {
  if constexpr (By::round) {
    return std::tuple{};
  } else {
    constexpr auto& columns = By::template columns<List>;
    return []<std::size_t... k>(std::index_sequence<k...>) {
      return std::tuple{Field<Grains, List<double>>{columns[k].dataset, columns[k].entries, columns[k].unit,
                                                    By::rigid ? Rows::per_grain_or_left_out : Rows::per_grain_or_none}
                            .within(positive_number)...};
    }
    (std::make_index_sequence<std::size(columns)>());
  }
}
template <int... number>
constexpr auto fields_of_shapes(std::integer_sequence<int, number...>) {
  return std::tuple_cat(fields_of_shape<Description<Shape(number)>>()...);
}
constexpr auto own_fields() { return fields_of_shapes(std::make_integer_sequence<int, shape_count>()); }

template <>
inline constexpr auto members_of<Grains> = std::tuple_cat(
    std::tuple{Field{"id", &Grains::id, "1", Rows::per_grain},
               Field{"radius_m", &Grains::radius, "m", Rows::per_grain}.within(positive_number),
               Field{"material", &Grains::material, "1", Rows::per_grain}.within(number_from_zero),
               Field{"position_m", &Grains::position, "m", Rows::per_grain}.lying(InPlane::along),
               Field{"velocity", &Grains::velocity, "m/s or m/step", Rows::per_grain}.lying(InPlane::along),
               Field{"spin", &Grains::spin, "rad/s or rad/step", Rows::per_grain}.lying(InPlane::normal)},
    own_fields(),
    std::tuple{Field{"orientation", &Grains::orientation, "1", Rows::per_grain_or_none}.lying(InPlane::along)});

/// The columns of shapes are a base of Grains, one initialiser for all of them.
template <>
inline constexpr std::size_t inherited_members<Grains> = std::tuple_size_v<decltype(own_fields())> - 1;

template <>
inline constexpr auto members_of<Contact> = std::tuple{
    Field{"i", &Contact::i, "1"}.within(number_from_zero),
    Field{"j", &Contact::j, "1"}.within(number_from_zero),
    Field{"image", &Contact::image, "1"}.lying(InPlane::along),
    Field{"tangential_force_N", &Contact::tangential_force, "N"}.lying(InPlane::tangent),
    Field{"rolling_moment_N_m", &Contact::rolling_moment, "N m"}.lying(InPlane::normal),
    Field{"last_root_overlap_m0_5", &Contact::last_root_overlap, "m^0.5"}.within(number_from_zero),
};

template <>
inline constexpr auto members_of<Body> = std::tuple{
    Field{"id", &Body::id, "1"},
    Field{"first", &Body::first, "1"}.within(number_from_zero),
    Field{"position_m", &Body::position, "m"}.lying(InPlane::along),
    Field{"velocity", &Body::velocity, "m/s or m/step"}.lying(InPlane::along),
    Field{"spin", &Body::spin, "rad/s or rad/step"}.lying(InPlane::normal),
    Field{"orientation", &Body::orientation, "1"},
    Field{"volume_m3", &Body::volume, "m^3"}.within(positive_number),
    Field{"gyration_m2", &Body::gyration, "m^2"}.within(positive_number),
};
template <>
inline constexpr auto members_of<BodyMember> =
    std::tuple{Field{"offset_m", &BodyMember::offset, "m"}.lying(InPlane::along)};
template <>
inline constexpr bool left_out_where_empty<Body> = true;
template <>
inline constexpr bool left_out_where_empty<BodyMember> = true;

/// The constants of one group, as its law file lists them.
template <class Group>
constexpr auto stored_fields() {
  static_assert(std::size(Group::stored) == member_count<Group>(), "a constant of a law is not in its list `stored`");
  return []<std::size_t... k>(std::index_sequence<k...>) {
    return std::tuple{Field<Material, double>{.name = Group::stored[k].dataset,
                                              .member = Group::stored[k].value,
                                              .units = Group::stored[k].unit,
                                              .left_out_at_zero = Group::stored[k].left_out_at_zero}...};
  }
  (std::make_index_sequence<std::size(Group::stored)>());
}
template <class... Groups>
constexpr auto fields_of_laws(TypeList<Groups...>) {
  return std::tuple_cat(stored_fields<Groups>()...);
}

/// Density, the constants of the laws, friction and rolling.
constexpr auto material_fields() {
  return std::tuple_cat(
      std::tuple{Field{"name", &Material::name, "-"},
                 Field{"density_kg_m3", &Material::density, "kg/m^3"}.within(ranges::density)},
      fields_of_laws(ConstantGroups{}),
      std::tuple{Field{"friction", &Material::friction, "1"}.within(ranges::friction),
                 Field{"rolling_stiffness", &Material::rolling_stiffness, "1"}.within(number_from_zero),
                 Field{"rolling_friction", &Material::rolling_friction, "1"}.within(number_from_zero)});
}

/// The laws' constants are a base of Material, one initialiser for all of them.
template <>
inline constexpr std::size_t inherited_members<Material> =
    std::tuple_size_v<decltype(fields_of_laws(ConstantGroups{}))> - 1;

template <>
inline constexpr auto members_of<Material> = material_fields();

template <>
inline constexpr auto members_of<ContactModel> = std::tuple{
    Field{"law", &ContactModel::law, "-"},
    Field{"slip", &ContactModel::slip, "-"},
    Field{"rolling", &ContactModel::rolling, "1"},
    Field{"unload_rescale", &ContactModel::unload_rescale, "1"},
    Field{"hertz_radius", &ContactModel::hertz_radius, "-"},
};

template <>
inline constexpr auto members_of<Damping> = std::tuple{
    Field{"local", &Damping::local, "1"}.within(ranges::local_damping),
    Field{"local_quasi_static", &Damping::local_quasi_static, "1"}.within(ranges::local_damping_quasi_static),
    Field{"local_form", &Damping::local_form, "-"},
    Field{"dashpot", &Damping::dashpot, "-"},
    Field{"normal_coefficient", &Damping::normal_coefficient, "N s/m or 1/(m s)"}.within(number_from_zero),
    Field{"restitution", &Damping::restitution, "1"}.within(ranges::restitution),
    Field{"tangential_ratio", &Damping::tangential_ratio, "1"}.within(number_from_zero),
    Field{"no_tension", &Damping::no_tension, "1"},
    Field{"global_viscous_N_s_m", &Damping::global_viscous, "N s/m"}.within(number_from_zero),
};

template <>
inline constexpr auto members_of<SolverOptions> = std::tuple{
    Field{"skin", &SolverOptions::skin, "1"}.within({0, largest_skin_ratio, true, false}),
    Field{"time_step_factor", &SolverOptions::time_step_factor, "1"}.within({0, 1, true, true}),
    Field{"fixed_time_step_s", &SolverOptions::fixed_time_step, "s"}.within(number_from_zero),
    Field{"collision_steps", &SolverOptions::collision_steps, "1"}.within({0, 100'000}),
    Field{"relative_tolerance", &SolverOptions::relative_tolerance, "1"}.within({0, 1, true, false}),
    Field{"absolute_tolerance", &SolverOptions::absolute_tolerance, "1"}.within({0, 1, true, false}),
    Field{"target_unbalanced", &SolverOptions::target_unbalanced, "1"}.within(number_from_zero),
    Field{"fixed_substeps", &SolverOptions::fixed_substeps, "1"}.within(number_from_zero),
    Field{"max_substeps", &SolverOptions::max_substeps, "1"}.within(positive_number),
    Field{"min_height_m", &SolverOptions::min_height, "m"}.within(number_from_zero),
    Field{"max_overlap_ratio", &SolverOptions::max_overlap_ratio, "1"}.within(positive_number),
    Field{"energy_balance", &SolverOptions::energy_balance, "1"},
};

template <>
inline constexpr auto members_of<SolverState> = std::tuple{
    Part{"list", &SolverState::list},
    Part{"last_step", &SolverState::last_step},
    Part{"masses", &SolverState::masses},
    Part{"control", &SolverState::control},
    Part{"servo", &SolverState::servo},
    Part{"reference", &SolverState::reference},
    Field{"grain_steps", &SolverState::grain_steps, "1"},
    Field{"memory_order", &SolverState::memory_order, "1", Rows::per_grain_or_none},
    Part{"energy_balance", &SolverState::energy_balance},
};

/// A field of an interaction, as its law declares it.
template <class Law, int n>
constexpr auto field_of_interaction() {
  using Item = Interaction<Law>;
  using Value = decltype(FieldOf<Law, n>::value);
  constexpr const InteractionField& declared = Law::fields[n];
  const Field<Item, Value> field =
      Field<Item, Value>{declared.name, &FieldOf<Law, n>::value, declared.unit}.within(declared.allowed);
  return declared.turning == Turning::scalar
             ? field
             : field.lying(declared.turning == Turning::tangent ? InPlane::tangent : InPlane::normal);
}
template <class Law, int... n>
inline constexpr auto members_of<Interaction<Law, std::integer_sequence<int, n...>>> =
    std::tuple{Field<Interaction<Law>, std::int32_t>{"i", &Interaction<Law>::i, "1"}.within(number_from_zero),
               Field<Interaction<Law>, std::int32_t>{"j", &Interaction<Law>::j, "1"}.within(number_from_zero),
               Field<Interaction<Law>, Image>{"image", &Interaction<Law>::image, "1"}.lying(InPlane::along),
               field_of_interaction<Law, n>()...};

template <class Law>
inline constexpr bool left_out_where_empty<Interaction<Law>> = true;

/// The parameters from which interactions of a law form, as the law declares them.
template <FormsByItself Law>
constexpr auto fields_of_settings() {
  using Settings = typename Law::Settings;
  return []<std::size_t... k>(std::index_sequence<k...>) {
    return std::tuple{Field<Settings, double>{Law::settings_fields[k].name, Law::settings_fields[k].value,
                                              Law::settings_fields[k].unit}
                          .within(Law::settings_fields[k].allowed)...};
  }
  (std::make_index_sequence<std::size(Law::settings_fields)>());
}
template <class Law>
constexpr auto settings_table() {
  if constexpr (FormsByItself<Law>)
    return std::tuple{Table<Specimen, typename Law::Settings>{Law::settings_name, &SettingsOf<Law>::settings}};
  else
    return std::tuple{};
}
template <class... Laws>
constexpr auto interaction_tables(TypeList<Laws...>) {
  return std::tuple_cat(std::tuple{Table<Specimen, Interaction<Laws>>{Laws::name, &ListOf<Laws>::items}...},
                        settings_table<Laws>()...);
}
template <class Settings, class First, class... Rest>
constexpr auto fields_of_settings_in(TypeList<First, Rest...>) {
  if constexpr (FormsFrom<First, Settings>)
    return fields_of_settings<First>();
  else
    return fields_of_settings_in<Settings>(TypeList<Rest...>{});
}
/// Settings of any law of the list.
template <class Settings>
concept IsSettings = is_settings_of_any<Settings>(InteractionLaws{});
template <IsSettings Settings>
inline constexpr auto members_of<Settings> = fields_of_settings_in<Settings>(InteractionLaws{});
template <IsSettings Settings>
inline constexpr bool left_out_where_empty<Settings> = true;

template <>
inline constexpr auto members_of<Specimen> = std::tuple_cat(std::tuple{Field{"shape", &Specimen::shape, "-"},  //
                                                                       Part{"cell", &Specimen::cell},          //
                                                                       Part{"grains", &Specimen::grains},      //
                                                                       Table{"bodies", &Specimen::bodies},     //
                                                                       Table{"members", &Specimen::members},   //
                                                                       Table{"contacts", &Specimen::contacts}},
                                                            interaction_tables(InteractionLaws{}),
                                                            std::tuple{Table{"materials", &Specimen::materials},  //
                                                                       Part{"contact", &Specimen::contact},       //
                                                                       Part{"damping", &Specimen::damping},       //
                                                                       Part{"solver", &Specimen::solver},         //
                                                                       Part{"state", &Specimen::state}});

/// The lists of interactions are a base of Specimen, one initialiser for all of them.
template <>
inline constexpr std::size_t inherited_members<Specimen> =
    std::tuple_size_v<decltype(interaction_tables(InteractionLaws{}))> - 1;

}  // namespace rvelab::fields
