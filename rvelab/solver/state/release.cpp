// What an assembly can make again: the working arrays of its pairs, its masses, its forces. It keeps its list, so that
// rebuilding them searches nothing. Declared in state.hpp.
#include <type_traits>

#include "rvelab/solver/assembly/gather_table.hpp"
#include "rvelab/solver/state/state.hpp"

namespace rvelab {

namespace {

/// each(array) for all that can be made again. `Of`: an Assembly, const or not.
template <class Of, class Each>
void each_working_array(Of& a, const Each& each) {
  auto& t = a.pairs;
  for (auto* buffer : {&t.kn, &t.kt, &t.law_constant, &t.friction, &t.kr, &t.moment_cap, &t.cn, &t.force, &t.radius_i,
                       &t.radius_j, &t.solid, &t.directions, &t.resultants, &t.image_number[0], &t.image_number[1],
                       &t.image_number[2], &a.mass, &a.inverse_mass, &a.inverse_inertia})
    each(*buffer);
  for (auto* list : {&t.row_i, &t.row_j, &t.gathered, &t.slots_beyond}) each(*list);
  for (auto* marks : {&t.touched, &t.shifted}) each(*marks);
  for (auto& interactions : t.interactions) {
    for (auto* list : {&interactions.row_i, &interactions.row_j}) each(*list);
    for (auto* buffers : {&interactions.image_number, &interactions.radius})
      for (auto& buffer : *buffers) each(buffer);
  }
}

template <class Array>
std::size_t bytes_of(const Array& array) {
  return array.capacity() * sizeof(array[0]);
}

}  // namespace

void put_masses_into_rows(const Model& model, Assembly& assembly) {
  const std::size_t length = std::size_t(model.row_length());
  if (!assembly.state.masses.in_use || assembly.mass.empty()) return;
  for (std::size_t g = 0; g < model.size(); ++g) {
    assembly.rows[g * length + released_mass(model.shape)] = assembly.mass[g];
    assembly.rows[g * length + released_inverse_inertia(model.shape)] = assembly.inverse_inertia[g];
  }
}

void release_buffers(Assembly& assembly) {
  each_working_array(assembly, [](auto& array) { array = std::remove_reference_t<decltype(array)>(); });
}

void rebuild_buffers(const Model& model, Assembly& assembly) {
  try {
    derive_pairs(model, assembly.pairs);
    leave_out_pairs_beyond(force_row_length(model.dimension()), assembly.pairs);
    for (Buffer* b : {&assembly.mass, &assembly.inverse_mass, &assembly.inverse_inertia})
      b->assign(padded_to_lanes(model.size()), 0.0);
  } catch (...) {  // no memory: it stays released, the masses in its rows
    release_buffers(assembly);
    throw;
  }
  const std::size_t length = std::size_t(model.row_length());
  if (!assembly.state.masses.in_use) {
    use_physical_inertia(model, assembly);
  } else {
    for (std::size_t g = 0; g < model.size(); ++g) {
      double* row = assembly.rows.data() + g * length;
      assembly.mass[g] = row[released_mass(model.shape)];
      assembly.inverse_mass[g] = 1 / assembly.mass[g];
      assembly.inverse_inertia[g] = row[released_inverse_inertia(model.shape)];
      complete_row(model, g, row);
    }
  }
  evaluate_forces(model, assembly);
}

Memory memory_of(const Assembly& assembly) {
  const PairTable& t = assembly.pairs;
  Memory m;
  m.state += bytes_of(assembly.bodies);
  m.state += bytes_of(assembly.rows) + bytes_of(t.root_overlap) + bytes_of(assembly.state.memory_order);
  for (int k = 0; k < 3; ++k) m.state += bytes_of(t.tangential[k]) + bytes_of(t.moment[k]);
  m.list = bytes_of(t.i) + bytes_of(t.j) + bytes_of(t.image) + bytes_of(t.order) + bytes_of(t.slot_begin) +
           bytes_of(t.slots) + bytes_of(t.tasks) + bytes_of(assembly.state.list.positions);
  for (const InteractionTable& each : t.interactions) {
    for (const Buffer& b : each.column) m.state += bytes_of(b);
    m.list += bytes_of(each.i) + bytes_of(each.j) + bytes_of(each.image);
  }
  each_working_array(assembly, [&m](const auto& array) { m.working += bytes_of(array); });
  return m;
}

}  // namespace rvelab
