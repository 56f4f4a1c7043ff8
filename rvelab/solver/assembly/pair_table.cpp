// What the working arrays of the pairs follow from: list, materials, grains. Declared in assembly.hpp.
#include <algorithm>

#include "rvelab/solver/assembly/assembly.hpp"
#include "rvelab/solver/assembly/interactions.hpp"

namespace rvelab {

std::size_t bytes_of(const PairTable& t) {
  const auto bytes = [](const auto&... arrays) { return ((arrays.capacity() * sizeof(arrays[0])) + ...); };
  std::size_t sum = bytes(t.order, t.touched, t.shifted, t.i, t.j, t.row_i, t.row_j, t.image, t.slot_begin, t.slots,
                          t.tasks, t.gathered, t.slots_beyond) +
                    bytes(t.kn, t.kt, t.law_constant, t.friction, t.kr, t.moment_cap, t.cn, t.root_overlap, t.force,
                          t.radius_i, t.radius_j, t.solid, t.directions, t.resultants, t.on_members);
  for (int k = 0; k < 3; ++k) sum += bytes(t.image_number[k], t.tangential[k], t.moment[k]);
  for (const InteractionTable& each : t.interactions) {
    sum += bytes(each.i, each.j, each.image, each.row_i, each.row_j);
    for (const auto* buffers : {&each.column, &each.image_number, &each.radius})
      for (const Buffer& b : *buffers) sum += bytes(b);
  }
  return sum;
}

void set_pair_parameters(const Model& model, PairTable& pairs) {
  const std::size_t padded = pairs.padded();
  const bool dashpot = model.damping.dashpot != Dashpot::none;
  for (Buffer* b : {&pairs.kn, &pairs.kt, &pairs.friction}) b->assign(padded, 0.0);
  if (model.contact.rolling)
    for (Buffer* b : {&pairs.kr, &pairs.moment_cap}) b->assign(padded, 0.0);
  if (dashpot) pairs.cn.assign(padded, 0.0);
  const bool law_constant =
      with_law(model.contact.law, [](auto law) { return decltype(law)::Force::has_law_constant; });
  if (law_constant) pairs.law_constant.assign(padded, 0.0);
  const auto set = [&](std::size_t p) {
    const auto i = std::size_t(pairs.i[p]), j = std::size_t(pairs.j[p]);
    const PairParameters q =
        mix(model.contact, model.damping, model.materials[std::size_t(model.material[i])], model.radius[i],
            model.moved_mass(i), model.materials[std::size_t(model.material[j])], model.radius[j], model.moved_mass(j),
            grain_section(model.shape, std::min(model.radius[i], model.radius[j]), model.thickness));
    pairs.kn[p] = q.kn;
    pairs.kt[p] = q.kt;
    if (law_constant) pairs.law_constant[p] = q.law_constant;
    pairs.friction[p] = q.friction;
    if (model.contact.rolling) {
      pairs.kr[p] = q.kr;
      pairs.moment_cap[p] = q.moment_cap;
    }
    if (dashpot) pairs.cn[p] = q.cn;
  };
  in_pieces(pairs.listed, model.sharing(), [&](std::size_t, std::size_t first, std::size_t last) {
    for (std::size_t p = first; p < last; ++p) set(p);
  });
}

void derive_pairs(const Model& model, PairTable& pairs) {
  const std::size_t padded = pairs.padded();
  pairs.row_i.resize(padded);
  pairs.row_j.resize(padded);
  for (int k = 0; k < model.dimension(); ++k) pairs.image_number[k].resize(padded);
  const bool radii = pairs_hold_radii(model.shape) || model.radius_from_curvature();
  if (radii) {
    pairs.radius_i.assign(padded, 0.0);
    pairs.radius_j.assign(padded, 0.0);
  }
  in_pieces(padded, model.sharing(), [&](std::size_t, std::size_t first, std::size_t last) {
    for (std::size_t p = first; p < last; ++p) {
      pairs.row_i[p] = pairs.i[p] * model.row_length();
      pairs.row_j[p] = pairs.j[p] * model.row_length();
    }
    for (int k = 0; k < model.dimension(); ++k)
      for (std::size_t p = first; p < last; ++p) pairs.image_number[k][p] = pairs.image[p][std::size_t(k)];
    if (!radii) return;
    for (std::size_t p = first; p < std::min(last, pairs.listed); ++p) {
      pairs.radius_i[p] = model.radius[std::size_t(pairs.i[p])];
      pairs.radius_j[p] = model.radius[std::size_t(pairs.j[p])];
    }
  });
  if (moves_as_body(model.shape))
    for (Buffer* b : {&pairs.solid, &pairs.directions}) b->assign(8 * padded, 0.0);
  if (model.bodies)
    pairs.on_members.resize(std::size_t(force_row_length(model.dimension())) * padded_to_lanes(model.size()));
  pairs.touched.assign(padded / 8, 0);
  pairs.shifted.assign(padded / 8, 0);
  for (std::size_t p = 0; p < padded; ++p) pairs.shifted[p / 8] |= std::uint8_t(is_shifted(pairs.image[p]));
  derive_interactions(model, pairs);  // force rows with them
  set_pair_parameters(model, pairs);
}

}  // namespace rvelab
