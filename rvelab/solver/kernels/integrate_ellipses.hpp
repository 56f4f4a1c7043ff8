// What turns with an ellipse: the axis e by the whole spin seen in the cell frame, w' + axial(W), and with it M.
//
// The turn is Cayley's, of the angle 2 atan(dt w/2): of second order as the step is. Rounding would make e longer or
// shorter in the course of 1e8 steps; 1/|e| = 3/2 - |e|^2/2 to first order keeps it.
//
// Lists have to know how far surfaces come, not centres: a turn by theta moves the support h of an ellipse by at most
// (a - b) |sin theta| (assembly/oriented_bounds.hpp).
#pragma once

#include "rvelab/solver/kernels/ellipse_overlap.hpp"
#include "rvelab/solver/kernels/integrate_discs.hpp"

namespace rvelab {
namespace {

struct EllipseRows {
  static constexpr int length = 12;
  static constexpr bool turns = true;

  /// `fastest`: (|v'| + (a - b) |w|)^2, the largest so far.
  template <class T, class Fastest>
  static inline __attribute__((always_inline)) void turn(const StepConstants& c, const GrainArrays& g, long first,
                                                         long count, const DiscColumns& s, Fastest& fastest) {
    constexpr int W = T::W < 4 ? T::W : 4;
    using V = typename Lanes<W>::V;
    const double half_dt = 0.5 * c.dt, cell_spin = c.spin[2];
    for (long k = 0; k < count; k += W) {
      double* row = g.rows + length * (first + k);
      const V x = Lanes<W>::collected([=](int lane) { return row[length * lane + 5]; });
      const V y = Lanes<W>::collected([=](int lane) { return row[length * lane + 6]; });
      const V w = load_as<V>(s.w.at + k) + cell_spin, u = load_as<V>(s.u.at + k), v = load_as<V>(s.v.at + k);
      const V axes_gap = Lanes<W>::collected([=](int lane) { return row[length * lane + 7]; });
      const V speed = square_root(u * u + v * v) + axes_gap * magnitude_of(w), squared = speed * speed;
      fastest = (squared > fastest) ? squared : fastest;
      const V q = half_dt * w;
      const V inverse = 1.0 / (1.0 + q * q), cosine = (1.0 - q * q) * inverse, sine = (q + q) * inverse;
      const V tx = cosine * x - sine * y, ty = cosine * y + sine * x;
      const V shorter = 1.5 - 0.5 * (tx * tx + ty * ty);
      const Direction<V> e = {tx * shorter, ty * shorter};
      const V minor = load_as<V>(g.minor_squared + first + k), difference = load_as<V>(g.axes_difference + first + k);
      const EllipseMatrix<V> m = ellipse_matrix(e, minor, difference, V{});
      const V columns[5] = {e.x, e.y, m.xx, m.xy, m.yy};
      constexpr int at[5] = {5, 6, 8, 9, 10};
      for (int column = 0; column < 5; ++column) {
        double values[W];
        std::memcpy(values, &columns[column], sizeof(V));
        for (int lane = 0; lane < W; ++lane) row[length * lane + at[column]] = values[lane];
      }
    }
  }
};

}  // namespace
}  // namespace rvelab
