#include "rvelab/solver/assembly/memory_order.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace rvelab {

namespace {

std::vector<std::int32_t> inverse_of(const std::vector<std::int32_t>& order) {
  std::vector<std::int32_t> inverse(order.size());
  for (std::size_t row = 0; row < order.size(); ++row) inverse[std::size_t(order[row])] = std::int32_t(row);
  return inverse;
}

/// values[order[k]] at index k.
template <class Value>
void rearrange(std::vector<Value>& values, const std::vector<std::int32_t>& order) {
  if (values.empty()) return;
  std::vector<Value> moved;
  moved.reserve(values.size());
  for (const std::int32_t from : order) moved.push_back(values[std::size_t(from)]);
  values = std::move(moved);
}

void turn_round(Contact& c, Shape shape) {
  c.rolling_moment = -c.rolling_moment;
  // In 2D the component along t = (-n_y, n_x) keeps its sign: force and t both turn.
  if (dimension_of(shape) == 3) c.tangential_force = -c.tangential_force;
}

template <class Law, int... n>
void turn_round(Interaction<Law, std::integer_sequence<int, n...>>& item, Shape shape) {
  rvelab::turn_round<Law>(item, dimension_of(shape));
}

void turn_round(ContactState& c, Shape) {
  std::swap(c.arm_i, c.arm_j);
  c.branch = -c.branch;
  c.normal = -c.normal;
  c.tangential_force = -c.tangential_force;
  c.rolling_moment = -c.rolling_moment;
}

void turn_round(InteractionState& c, Shape shape) { turn_round(static_cast<ContactState&>(c), shape); }

/// Contacts of grains that went to place_of[i]: indices, sides and order.
template <class AnyContact>
void renumber(std::vector<AnyContact>& contacts, const std::vector<std::int32_t>& place_of, Shape shape) {
  for (AnyContact& c : contacts) {
    c.i = place_of[std::size_t(c.i)];
    c.j = place_of[std::size_t(c.j)];
    if (c.i <= c.j) continue;
    std::swap(c.i, c.j);
    for (int& n : c.image) n = -n;
    turn_round(c, shape);
  }
  std::sort(contacts.begin(), contacts.end(), [](const AnyContact& x, const AnyContact& y) {
    if constexpr (requires { x.kind; })
      if (x.kind != y.kind) return x.kind < y.kind;
    return std::tie(x.i, x.j, x.image) < std::tie(y.i, y.j, y.image);
  });
}

/// `order[row]`: where the grain of that row comes from.
Specimen rearranged(Specimen s, const std::vector<std::int32_t>& order) {
  rearrange(s.grains.id, order);
  rearrange(s.grains.radius, order);
  rearrange(s.grains.material, order);
  rearrange(s.grains.position, order);
  rearrange(s.grains.velocity, order);
  rearrange(s.grains.spin, order);
  each_own_column([&](const auto&, auto& column) { rearrange(column, order); }, s.grains);
  rearrange(s.grains.orientation, order);
  rearrange(s.state.list.positions, order);
  rearrange(s.state.masses.mass, order);
  rearrange(s.state.masses.inverse_inertia, order);
  const std::vector<std::int32_t> place_of = inverse_of(order);
  renumber(s.contacts, place_of, s.shape);
  each_interaction_law(
      [&](auto, auto law) { renumber(static_cast<ListOf<decltype(law)>&>(s).items, place_of, s.shape); });
  return s;
}

/// The bits of v with `gap` zeros after each.
std::uint64_t spread(std::uint64_t v, int gap) {
  std::uint64_t out = 0;
  for (int bit = 0; v >> bit != 0; ++bit) out |= ((v >> bit) & 1) << (bit * (gap + 1));
  return out;
}

}  // namespace

std::vector<std::int32_t> space_filling_order(const Cell& cell, const std::vector<Vector3>& positions) {
  const Matrix3& l = cell.lattice;
  const int d = cell.dimension;
  const double steps = d == 2 ? 65536 : 1024;
  std::vector<std::pair<std::uint64_t, std::int32_t>> keys(positions.size());
  for (std::size_t g = 0; g < positions.size(); ++g) {
    const Vector3& x = positions[g];
    double s[3];
    s[2] = d == 3 ? x[2] / l(2, 2) : 0;
    s[1] = (x[1] - l(1, 2) * s[2]) / l(1, 1);
    s[0] = (x[0] - l(0, 1) * s[1] - l(0, 2) * s[2]) / l(0, 0);
    std::uint64_t key = 0;
    for (int k = 0; k < d; ++k) {
      const double fraction = s[k] - std::floor(s[k]);
      key |= spread(std::uint64_t(std::min(steps - 1, std::floor(fraction * steps))), d - 1) << k;
    }
    keys[g] = {key, std::int32_t(g)};
  }
  std::sort(keys.begin(), keys.end());
  std::vector<std::int32_t> order(keys.size());
  for (std::size_t row = 0; row < keys.size(); ++row) order[row] = keys[row].second;
  return order;
}

Specimen in_memory_order(Specimen specimen, const std::vector<std::int32_t>& order) {
  return order.empty() ? std::move(specimen) : rearranged(std::move(specimen), order);
}

Specimen in_id_order(Specimen specimen, const std::vector<std::int32_t>& order) {
  return order.empty() ? std::move(specimen) : rearranged(std::move(specimen), inverse_of(order));
}

Network in_id_order(Network network, const std::vector<std::int32_t>& order) {
  if (order.empty()) return network;
  rearrange(network.grains, inverse_of(order));
  renumber(network.contacts, order, network.shape);
  renumber(network.interactions, order, network.shape);
  return network;
}

}  // namespace rvelab
