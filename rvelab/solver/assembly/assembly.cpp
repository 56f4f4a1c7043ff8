#include "rvelab/solver/assembly/assembly.hpp"

#include <algorithm>
#include <numeric>

#include "rvelab/error.hpp"
#include "rvelab/solver/assembly/listing.hpp"
#include "rvelab/solver/assembly/memory_order.hpp"
#include "rvelab/solver/assembly/outline.hpp"
#include "rvelab/specimen/specimen_check.hpp"

namespace rvelab {

Vector3 Assembly::position(const Model& f, std::size_t g) const {
  const double* row = rows.data() + g * f.row_length();
  return {row[0], row[1], f.dimension() == 2 ? 0.0 : row[2]};
}

Vector3 Assembly::velocity(const Model& f, std::size_t g) const {
  const double* v = rows.data() + g * f.row_length() + f.velocity_offset();
  return {v[0], v[1], f.dimension() == 2 ? 0.0 : v[2]};
}

Vector3 Assembly::spin(const Model& f, std::size_t g) const {
  const double* row = rows.data() + g * f.row_length();
  return f.dimension() == 2 ? Vector3(0, 0, row[4]) : Vector3(row[8], row[9], row[10]);
}

void Assembly::set_velocity(const Model& f, std::size_t g, const Vector3& v, const Vector3& w) {
  double* row = rows.data() + g * f.row_length();
  for (int k = 0; k < f.dimension(); ++k) row[f.velocity_offset() + k] = v[k];
  if (f.dimension() == 2) {
    row[4] = w[2];
  } else {
    for (int k = 0; k < 3; ++k) row[8 + k] = w[k];
  }
}

Vector3 Assembly::orientation(const Model& f, std::size_t g) const {
  const double* row = rows.data() + g * f.row_length();
  return {row[5], row[6], 0};
}

void complete_row(const Model& f, std::size_t g, double* row) {
  with_shape(f.shape, [&](auto is) {
    using By = typename decltype(is)::By;
    if constexpr (By::round)
      By::complete_row(f.radius[g], row);
    else
      Outline<decltype(is)::value>::complete_row(own_of<By>(f.own, g), row);
  });
}

namespace {

/// The lengths of grains that are not round, and what the grain loop makes of them.
template <class By>
void take_lengths(const Grains& grains, Model& f) {
  each_own_column([](const auto&, auto& to, const auto& from) { to = from; }, f.own, grains);
  f.outer_radius = reach_of(f.shape, grains);
  std::vector<double> first(padded_to_lanes(grains.size()), 0.0), second = first;
  for (std::size_t g = 0; g < grains.size(); ++g) {
    const TurnValues values = By::turn_values(own_of<By>(grains, g));
    first[g] = values.first;
    second[g] = values.second;
  }
  f.turn_first = std::move(first);
  f.turn_second = std::move(second);
}

/// The masses that a specimen at dt = 0 brings; the arrays of the state are empty while it is open.
void take_scaled_inertia(Assembly& a) {
  SolverState& state = a.state;
  const std::size_t n = state.scaled_mass.size();
  if (!state.quasi_static || n == 0) state.steps_since_scaling = -1;  // a file of an earlier version, or dt > 0
  if (state.steps_since_scaling >= 0) {
    for (std::size_t g = 0; g < n; ++g) {
      a.mass[g] = state.scaled_mass[g];
      a.inverse_mass[g] = 1 / state.scaled_mass[g];
      a.inverse_inertia[g] = state.scaled_inverse_inertia[g];
    }
  }
  state.scaled_mass = state.scaled_inverse_inertia = {};
}

}  // namespace

void open_assembly(const Specimen& specimen, Model& f, Assembly& a) {
  check_specimen(specimen);
  const std::size_t n = specimen.grains.size(), padded = padded_to_lanes(n);
  std::vector<std::int32_t> order = specimen.state.memory_order;
  if (order.empty() && n >= least_ordered_grains) order = space_filling_order(specimen.cell, specimen.grains.position);
  const Specimen arranged = order.empty() ? Specimen() : in_memory_order(specimen, order);
  const Specimen& s = order.empty() ? specimen : arranged;
  f.shape = s.shape;
  f.materials = s.materials;
  f.contact = s.contact;
  f.damping = s.damping;
  f.options = s.solver;
  f.id = s.grains.id;
  f.material = s.grains.material;
  f.radius = s.grains.radius;
  f.thickness = s.cell.lattice(2, 2);
  const auto kernels_with = [&](bool dashpot) {
    return kernels_for({f.shape, f.contact.law, f.contact.rolling, f.contact.slip, dashpot, f.contact.hertz_radius});
  };
  f.kernels = kernels_with(f.damping.dashpot != Dashpot::none);
  f.quasi_static_kernels = f.damping.dashpot == Dashpot::none ? f.kernels : kernels_with(false);
  with_shape(f.shape, [&](auto is) {
    using By = typename decltype(is)::By;
    if constexpr (!By::round) take_lengths<By>(s.grains, f);
  });
  f.largest_reach = *std::max_element(f.reach().begin(), f.reach().end());
  f.mean_radius = std::accumulate(f.radius.begin(), f.radius.end(), 0.0) / double(n);
  f.largest_skin = f.options.skin * f.mean_radius;
  f.min_height = f.options.min_height > 0 ? f.options.min_height : 2 * f.largest_reach;
  std::vector<double> mass(n), inertia(n);
  a.cell = s.cell;
  a.state = s.state;
  a.state.memory_order = std::move(order);
  if (!(a.state.list_skin > 0 && a.state.list_skin < f.largest_skin)) a.state.list_skin = f.largest_skin;
  a.rows.assign(padded * f.row_length(), 0.0);
  for (Buffer* b : {&a.mass, &a.inverse_mass, &a.inverse_inertia}) b->assign(padded, 0.0);
  for (std::size_t g = 0; g < n; ++g) {
    const Material& m = f.materials[f.material[g]];
    mass[g] = m.density * f.volume_of(g);
    inertia[g] = f.inertia_of(g, mass[g]);
    double* row = a.rows.data() + g * f.row_length();
    for (int k = 0; k < f.dimension(); ++k) row[k] = s.grains.position[g][k];
    if (!f.round()) {
      row[5] = s.grains.orientation[g][0];
      row[6] = s.grains.orientation[g][1];
    }
    complete_row(f, g, row);
    a.set_velocity(f, g, s.grains.velocity[g], s.grains.spin[g]);
  }
  f.mass = std::move(mass);
  f.inertia = std::move(inertia);
  take_scaled_inertia(a);

  try {
    list_with(f, s.contacts, a);
    if (!a.state.has_reference) rebuild(f, a);
  } catch (const IncrementFailed& error) {
    throw InputError(std::string("specimen: ") + error.what());
  } catch (const CellError& error) {
    throw InputError(std::string("specimen: ") + error.what());
  }
}

Specimen close_assembly(const Model& f, const Assembly& a) {
  Specimen s;
  s.shape = f.shape;
  s.cell = a.cell;
  s.materials = f.materials;
  s.contact = f.contact;
  s.damping = f.damping;
  s.solver = f.options;
  s.state = a.state;
  s.grains.id = f.id;
  s.grains.radius = f.radius;
  s.grains.material = f.material;
  for (std::size_t g = 0; g < f.size(); ++g) {
    s.grains.position.push_back(a.position(f, g));
    s.grains.velocity.push_back(a.velocity(f, g));
    s.grains.spin.push_back(a.spin(f, g));
  }
  if (!f.round()) {
    each_own_column([](const auto&, auto& to, const auto& from) { to = from; }, s.grains, f.own);
    for (std::size_t g = 0; g < f.size(); ++g) s.grains.orientation.push_back(a.orientation(f, g));
  }
  if (a.state.steps_since_scaling >= 0) {
    const bool released = a.mass.empty();
    for (std::size_t g = 0; g < f.size(); ++g) {
      const double* row = a.rows.data() + g * std::size_t(f.row_length());
      s.state.scaled_mass.push_back(released ? row[released_mass(f.shape)] : a.mass[g]);
      s.state.scaled_inverse_inertia.push_back(released ? row[released_inverse_inertia(f.shape)]
                                                        : a.inverse_inertia[g]);
    }
  }
  s.contacts = contacts_of(f, a.pairs);
  return in_id_order(std::move(s), a.state.memory_order);
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
  return p;
}

GrainArrays arrays_of(const Model& f, Assembly& a) {
  return {a.rows.data(),
          a.mass.data(),
          a.inverse_mass.data(),
          a.inverse_inertia.data(),
          a.pairs.slot_begin.data(),
          a.pairs.gathered.data(),
          a.pairs.tasks.data(),
          f.turn_first.data(),
          f.turn_second.data()};
}

}  // namespace rvelab
