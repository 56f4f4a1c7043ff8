#include "rvelab/solver/assembly/oriented_bounds.hpp"

#include "rvelab/solver/assembly/outline.hpp"

namespace rvelab {

namespace {

template <Shape shape>
void keep_near(const Model& model, const Assembly& assembly, double skin, std::vector<ListedPair>& pairs) {
  const UpperTriangle l = upper_triangle(assembly.cell.lattice);
  std::vector<std::uint8_t> near(pairs.size());
  in_pieces(pairs.size(), model.sharing(), [&](std::size_t, std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) {
      const double *xi = assembly.rows.data() + std::size_t(pairs[k].i) * std::size_t(model.row_length()),
                   *xj = assembly.rows.data() + std::size_t(pairs[k].j) * std::size_t(model.row_length());
      const Image& n = pairs[k].image;
      Branch b = {xj[0] - xi[0] + (l.xx * n[0] + l.xy * n[1]), xj[1] - xi[1] + l.yy * n[1], 0};
      if constexpr (dimension_of(shape) == 3) {
        b.x += l.xz * n[2];
        b.y += l.yz * n[2];
        b.z = xj[2] - xi[2] + l.zz * n[2];
      }
      near[k] = !Outline<shape>::farther_apart_than(skin, b, xi, xj);
    }
  });
  std::size_t kept = 0;
  for (std::size_t k = 0; k < pairs.size(); ++k)
    if (near[k]) pairs[kept++] = pairs[k];
  pairs.resize(kept);
}

}  // namespace

void keep_near_outlines(const Model& model, const Assembly& assembly, double skin, std::vector<ListedPair>& pairs) {
  with_shape(model.shape, [&](auto is) {
    if constexpr (!decltype(is)::By::round) keep_near<decltype(is)::value>(model, assembly, skin, pairs);
  });
}

}  // namespace rvelab
