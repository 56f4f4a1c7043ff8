// Geometry of listed pairs, inline: checks go through all pairs every few dozen sub-steps.
#pragma once

#include <memory>

#include "rvelab/solver/assembly/assembly.hpp"
#include "rvelab/solver/assembly/outline.hpp"
#include "rvelab/solver/kernels/motion.hpp"

namespace rvelab {

/// Pairs of grains of a shape from the arrays of an assembly, looked at one by one.
template <Shape shape>
class PairGeometry {
 public:
  static constexpr int D = dimension_of(shape);

  PairGeometry(const Model& model, const Assembly& assembly)
      : rows_(assembly.rows.data()),
        radius_(model.radius.data()),
        i_(assembly.pairs.row_i.data()),
        j_(assembly.pairs.row_j.data()),
        grain_i_(assembly.pairs.i.data()),
        grain_j_(assembly.pairs.j.data()),
        near_(assembly.pairs.near),
        touched_(assembly.pairs.touched.data()),
        lattice_(upper_triangle(assembly.cell.lattice)) {
    for (int k = 0; k < D; ++k) image_[k] = assembly.pairs.image_number[k].data();
  }

  /// Of round grains.
  PairPlace round_place(std::size_t p) const {
    const Branch b = branch(p);
    const double length = b.length();
    return {b, length, (radius_[grain_i_[p]] + radius_[grain_j_[p]]) - length};
  }
  /// Known not to touch, and without force: so were all eight pairs of its block when forces were
  /// computed last, for these positions of the grains (at a rate 400 discs and 1,000 spheres 1.01 times as fast).
  bool is_apart(std::size_t p) const { return p >= near_ && touched_[p / 8] == 0; }
  /// Of outlines that are apart, by the direction of their distance.
  PlaceOf<shape> nearest(std::size_t p, const PlaceOf<shape>& apart) const {
    return Outline<shape>::nearest_place(apart, rows_ + i_[p], rows_ + j_[p]);
  }
  Branch branch(std::size_t p) const {
    const Vec<double, D> d = first_of<D>(rows_ + j_[p]) - first_of<D>(rows_ + i_[p]);
    const Vec<double, D> b = branch_with_image(lattice_, d, load_vec<double, D>(image_, long(p)));
    if constexpr (D == 2)
      return {b.x, b.y, 0};
    else
      return {b.x, b.y, b.z};
  }

 private:
  const double *rows_, *radius_;
  const std::int32_t *i_, *j_, *grain_i_, *grain_j_;
  const double* image_[D];
  std::size_t near_;
  const std::uint8_t* touched_;
  UpperTriangle lattice_;
};

/// Where the pairs lie. Those of outlines are found side by side, by the lanes of the step kernels, when this is made
/// (one by one they took a fifth of the time of ellipses at a rate).
template <Shape shape>
class PairPlaces : public PairGeometry<shape> {
 public:
  PairPlaces(const Model& model, const Assembly& assembly) : PairGeometry<shape>(model, assembly) {
    if constexpr (!is_round(shape)) find(model, assembly);
  }

  auto operator()(std::size_t p) const {
    if constexpr (is_round(shape)) {
      return this->round_place(p);
    } else {
      const double* row = places_.get() + place_row_length * p;
      const Branch b = this->branch(p);
      if constexpr (moves_as_body(shape))
        return SolidPlace{b, b.length(), row[3], {row[0], row[1], row[2]}, {row[4], row[5], row[6]}, row[7]};
      else
        return OutlinePlace{b, b.length(), row[2], {row[0], row[1], 0}, row[3], row[4], row[5], row[6]};
    }
  }
  /// Of outlines that are apart by less than `gap` (m) by the direction of the distance: an overlap < 0 else shows that
  /// they are apart, not how far.
  auto within(std::size_t p, double gap) const {
    auto at = (*this)(p);
    if constexpr (!is_round(shape))
      if (at.overlap < 0 && -at.overlap < gap) at = this->nearest(p, at);
    return at;
  }

 private:
  void find(const Model& model, const Assembly& assembly);

  std::unique_ptr<double[]> places_;
};

template <Shape shape>
void PairPlaces<shape>::find(const Model& model, const Assembly& assembly) {
  const std::size_t padded = assembly.pairs.padded();
  places_ = std::make_unique_for_overwrite<double[]>(place_row_length * padded);
  StepConstants c;
  c.lattice = upper_triangle(assembly.cell.lattice);
  PairArrays pairs;
  pairs.row_i = assembly.pairs.row_i.data();
  pairs.row_j = assembly.pairs.row_j.data();
  for (int k = 0; k < dimension_of(shape); ++k) pairs.image[k] = assembly.pairs.image_number[k].data();
  pairs.shifted = assembly.pairs.shifted.data();
  pairs.directions = const_cast<double*>(assembly.pairs.directions.data());  // read alone
  const PlaceKernel find_places = model.kernels_at(assembly.state.last_step.loading).places;
  in_pieces(padded, model.sharing(), [&](std::size_t, std::size_t first, std::size_t last) {
    find_places(c, pairs, assembly.rows.data(), long(first), long(last), places_.get());
  });
}

/// visit(p, where it touches) for each listed pair that touches, in the order of every sum.
template <Shape shape, class Visit>
void each_touching(const Model& model, const Assembly& assembly, const Visit& visit) {
  const PairPlaces<shape> pair(model, assembly);
  for (const std::int32_t listed : assembly.pairs.order) {
    const auto p = std::size_t(listed);
    if (pair.is_apart(p)) continue;
    if (const auto at = pair(p); at.overlap > 0) visit(p, at);
  }
}

}  // namespace rvelab
