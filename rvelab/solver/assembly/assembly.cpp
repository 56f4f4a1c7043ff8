#include "rvelab/solver/assembly/assembly.hpp"

#include <algorithm>
#include <numeric>

#include "rvelab/error.hpp"
#include "rvelab/solver/assembly/interactions.hpp"
#include "rvelab/solver/assembly/listing.hpp"
#include "rvelab/solver/assembly/memory_order.hpp"
#include "rvelab/solver/assembly/outline.hpp"
#include "rvelab/solver/assembly/superellipsoid_rows.hpp"
#include "rvelab/specimen/specimen_check.hpp"

namespace rvelab {

Vector3 Assembly::position(const Model& model, std::size_t g) const {
  const double* row = rows.data() + g * model.row_length();
  return {row[0], row[1], model.dimension() == 2 ? 0.0 : row[2]};
}

Vector3 Assembly::velocity(const Model& model, std::size_t g) const {
  const double* v = rows.data() + g * model.row_length() + model.velocity_offset();
  return {v[0], v[1], model.dimension() == 2 ? 0.0 : v[2]};
}

Vector3 Assembly::spin(const Model& model, std::size_t g) const {
  const double* row = rows.data() + g * model.row_length();
  return model.dimension() == 2 ? Vector3(0, 0, row[4]) : Vector3(row[8], row[9], row[10]);
}

void Assembly::set_velocity(const Model& model, std::size_t g, const Vector3& v, const Vector3& w) {
  double* row = rows.data() + g * model.row_length();
  for (int k = 0; k < model.dimension(); ++k) row[model.velocity_offset() + k] = v[k];
  if (model.dimension() == 2) {
    row[4] = w[2];
  } else {
    for (int k = 0; k < 3; ++k) row[8 + k] = w[k];
  }
}

Vector3 Assembly::orientation(const Model& model, std::size_t g) const {
  const double* row = rows.data() + g * model.row_length();
  return {row[5], row[6], 0};
}

void complete_row(const Model& model, std::size_t g, double* row) {
  with_shape(model.shape, [&](auto is) {
    using By = typename decltype(is)::By;
    if constexpr (By::round) {
      By::complete_row(model.radius[g], row);
    } else if constexpr (By::rigid) {
      const double* form = model.form.data() + 9 * g;
      row[3] = form[0];
      row[7] = row[11] = 0;
      std::copy_n(form + 1, 8, row + 16);
    } else {
      Outline<decltype(is)::value>::complete_row(own_of<By>(model.own, g), row);
    }
  });
}

namespace {

template <class By>
void take_turn_values(const Grains& grains, Model& model) {
  std::vector<double> first(padded_to_lanes(grains.size()), 0.0), second = first;
  for (std::size_t g = 0; g < grains.size(); ++g) {
    const TurnValues values = By::turn_values(own_of<By>(grains, g));
    first[g] = values.first;
    second[g] = values.second;
  }
  model.turn_first = std::move(first);
  model.turn_second = std::move(second);
}

/// The lengths of grains that are not round, and what the grain loop makes of them.
template <class By>
void take_lengths(const Grains& grains, Model& model) {
  each_own_column([](const auto&, auto& to, const auto& from) { to = from; }, model.own, grains);
  model.outer_radius = reach_of(model.shape, grains);
  if constexpr (By::rigid) {
    model.form = forms_of(grains);
  } else {
    take_turn_values<By>(grains, model);
  }
}

/// The scaled masses that a specimen brings; the arrays of the state are empty while it is open.
void take_scaled_inertia(Assembly& assembly) {
  ScaledMasses& masses = assembly.state.masses;
  if (assembly.state.last_step.loading == Loading::at_rate || !masses.in_use || masses.mass.empty()) masses = {};
  for (std::size_t g = 0; masses.in_use && g < masses.mass.size(); ++g) {
    assembly.mass[g] = masses.mass[g];
    assembly.inverse_mass[g] = 1 / masses.mass[g];
    assembly.inverse_inertia[g] = masses.inverse_inertia[g];
  }
  masses.mass = masses.inverse_inertia = {};
}

}  // namespace

void open_assembly(const Specimen& specimen, Model& model, Assembly& assembly) {
  check_specimen(specimen);
  const std::size_t n = specimen.grains.size(), padded = padded_to_lanes(n);
  std::vector<std::int32_t> order = specimen.state.memory_order;
  // Members of a body follow each other.
  if (order.empty() && n >= least_ordered_grains && specimen.bodies.empty())
    order = space_filling_order(specimen.cell, specimen.grains.position);
  const Specimen arranged = order.empty() ? Specimen() : in_memory_order(specimen, order);
  const Specimen& s = order.empty() ? specimen : arranged;
  model.shape = s.shape;
  model.materials = s.materials;
  model.contact = s.contact;
  model.damping = s.damping;
  model.options = s.solver;
  copy_settings(s, model.interaction_settings);
  model.id = s.grains.id;
  model.material = s.grains.material;
  model.radius = s.grains.radius;
  model.thickness = s.cell.lattice(2, 2);
  model.ellipsoids = all_ellipsoids(s.grains);
  const auto kernels_with = [&](bool dashpot) {
    return kernels_for({model.shape, model.contact.law, model.contact.rolling, model.contact.slip, dashpot,
                        model.contact.hertz_radius, model.ellipsoids});
  };
  model.kernels = kernels_with(model.damping.dashpot != Dashpot::none);
  model.quasi_static_kernels = model.damping.dashpot == Dashpot::none ? model.kernels : kernels_with(false);
  with_shape(model.shape, [&](auto is) {
    using By = typename decltype(is)::By;
    if constexpr (!By::round) take_lengths<By>(s.grains, model);
  });
  model.largest_reach = *std::max_element(model.reach().begin(), model.reach().end());
  model.mean_radius = std::accumulate(model.radius.begin(), model.radius.end(), 0.0) / double(n);
  model.largest_skin = model.options.skin * model.mean_radius;
  model.min_height = model.options.min_height > 0 ? model.options.min_height : 2 * model.largest_reach;
  assembly.cell = s.cell;
  assembly.state = s.state;
  assembly.state.memory_order = std::move(order);
  open_bodies(s, model, assembly);
  if (!(assembly.state.list.skin > 0 && assembly.state.list.skin < model.largest_skin))
    assembly.state.list.skin = model.largest_skin;
  assembly.rows.assign(padded * model.row_length(), 0.0);
  for (Buffer* b : {&assembly.mass, &assembly.inverse_mass, &assembly.inverse_inertia}) b->assign(padded, 0.0);
  for (std::size_t g = 0; g < n; ++g) {
    double* row = assembly.rows.data() + g * model.row_length();
    for (int k = 0; k < model.dimension(); ++k) row[k] = s.grains.position[g][k];
    if (keeps_axis(model.shape)) {
      row[5] = s.grains.orientation[g][0];
      row[6] = s.grains.orientation[g][1];
    }
    complete_row(model, g, row);
    if (moves_as_body(model.shape)) put_orientation(assembly.bodies.motion[g].orientation, row);
    assembly.set_velocity(model, g, s.grains.velocity[g], s.grains.spin[g]);
  }
  set_physical_masses(model);
  take_scaled_inertia(assembly);

  try {
    list_with(model, s.contacts, s, assembly);
    if (!assembly.state.list.built) rebuild(model, assembly);
  } catch (const IncrementFailed& error) {
    throw InputError(std::string("specimen: ") + error.what());
  } catch (const CellError& error) {
    throw InputError(std::string("specimen: ") + error.what());
  }
}

Specimen close_assembly(const Model& model, const Assembly& assembly) {
  Specimen s;
  s.shape = model.shape;
  s.cell = assembly.cell;
  s.materials = model.materials;
  s.contact = model.contact;
  s.damping = model.damping;
  s.solver = model.options;
  s.state = assembly.state;
  s.grains.id = model.id;
  s.grains.radius = model.radius;
  s.grains.material = model.material;
  for (std::size_t g = 0; g < model.size(); ++g) {
    s.grains.position.push_back(assembly.position(model, g));
    s.grains.velocity.push_back(assembly.velocity(model, g));
    s.grains.spin.push_back(assembly.spin(model, g));
  }
  if (!model.round()) {
    each_own_column([](const auto&, auto& to, const auto& from) { to = from; }, s.grains, model.own);
    if (keeps_axis(model.shape))
      for (std::size_t g = 0; g < model.size(); ++g) s.grains.orientation.push_back(assembly.orientation(model, g));
  }
  if (assembly.state.masses.in_use) {
    const bool released = assembly.mass.empty();
    for (std::size_t g = 0; g < model.size(); ++g) {
      const double* row = assembly.rows.data() + g * std::size_t(model.row_length());
      s.state.masses.mass.push_back(released ? row[released_mass(model.shape)] : assembly.mass[g]);
      s.state.masses.inverse_inertia.push_back(released ? row[released_inverse_inertia(model.shape)]
                                                        : assembly.inverse_inertia[g]);
    }
  }
  close_bodies(model, assembly, s);
  s.contacts = contacts_of(model, assembly.pairs);
  static_cast<Interactions&>(s) = interactions_of(assembly.pairs);
  copy_settings(model.interaction_settings, s);
  return in_id_order(std::move(s), assembly.state.memory_order);
}

PairArrays arrays_of(PairTable& t) {
  PairArrays p;
  p.near = long(t.near);
  p.touched = t.touched.data();
  p.shifted = t.shifted.data();
  p.row_i = t.row_i.data();
  p.row_j = t.row_j.data();
  for (int k = 0; k < 3; ++k) {
    p.image[k] = t.image_number[k].data();
    p.tangential[k] = t.tangential[k].data();
    p.moment[k] = t.moment[k].data();
  }
  p.kn = t.kn.data();
  p.kt = t.kt.data();
  p.friction = t.friction.data();
  p.law_constant = t.law_constant.data();
  p.kr = t.kr.data();
  p.moment_cap = t.moment_cap.data();
  p.cn = t.cn.data();
  p.root_overlap = t.root_overlap.data();
  p.radius_i = t.radius_i.data();
  p.radius_j = t.radius_j.data();
  p.force = t.force.data();
  p.solid = t.solid.data();
  p.directions = t.directions.data();
  return p;
}

GrainArrays arrays_of(const Model& model, Assembly& assembly) {
  return {assembly.rows.data(),
          assembly.mass.data(),
          assembly.inverse_mass.data(),
          assembly.inverse_inertia.data(),
          assembly.pairs.slot_begin.data(),
          assembly.pairs.gathered.data(),
          assembly.pairs.tasks.data(),
          model.turn_first.data(),
          model.turn_second.data(),
          model.contact.rolling,
          assembly.pairs.interactions.empty() ? nullptr : assembly.pairs.resultants.data()};
}

}  // namespace rvelab
