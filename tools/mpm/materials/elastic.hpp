// Isotropic elasticity in rate form, with the objective rotation of Hughes and Winget, and what plastic laws share.
#pragma once

#include "tools/mpm/materials/continuum.hpp"

namespace mpm {

struct ElasticModuli {
  double young = 0;  ///< Pa
  double poisson = 0;
  double bulk() const { return young / (3 * (1 - 2 * poisson)); }
  double shear() const { return young / (2 * (1 + poisson)); }
  double wave() const { return bulk() + 4 * shear() / 3; }
};

ElasticModuli read_moduli(Keys& keys);
Continuum read_elastic(Keys& keys);

/// Q s Q^T for the spin W of a step: Q = (I - W/2)^-1 (I + W/2) is orthogonal.
template <int D>
Mat<D> turned(const Mat<D>& stress, const Mat<D>& spin) {
  if constexpr (D == 2) {
    const double t = 0.5 * spin(1, 0), d = 1 / (1 + t * t), c = (1 - t * t) * d, s = 2 * t * d;
    const double xx = stress(0, 0), yy = stress(1, 1), xy = stress(0, 1);
    Mat<D> result;
    result(0, 0) = c * c * xx + s * s * yy - 2 * c * s * xy;
    result(1, 1) = s * s * xx + c * c * yy + 2 * c * s * xy;
    result(0, 1) = result(1, 0) = c * s * (xx - yy) + (c * c - s * s) * xy;
    return result;
  } else {
    // The same in closed form (Cayley): Q = I + 2 (W/2 + W^2/4)/(1 + w.w/4), w the axis of W.
    const Mat<D> half = 0.5 * spin;
    const double scale = 2 / (1 + 0.5 * half.squaredNorm());
    const Mat<D> Q = Mat<D>::Identity() + scale * (half + half * half);
    return Q * stress * Q.transpose();
  }
}

/// Elastic stress after Point::gradient, also out of the plane.
template <int D>
inline void elastic_trial(Point<D>& point, double lame, double twice_shear) {
  const Mat<D>& L = point.gradient;
  const Mat<D> spin = 0.5 * (L - L.transpose());
  const double pressure = lame * L.trace();
  point.stress = turned<D>(point.stress, spin) + 0.5 * twice_shear * (L + L.transpose());
  for (int i = 0; i < D; ++i) point.stress(i, i) += pressure;
  if (D == 2) point.stress_zz += pressure;
}

template <int D>
class Elastic : public Material<D> {
 public:
  explicit Elastic(const ElasticModuli& moduli) : moduli_(moduli) {}
  void advance(Point<D>* points, long count, double, rvelab::Workers& workers) override {
    const double lame = moduli_.bulk() - 2 * moduli_.shear() / 3, twice_shear = 2 * moduli_.shear();
    workers.for_each((count + 1023) / 1024, [&](std::int64_t piece) {
      for (long k = piece * 1024; k < std::min(count, long(piece + 1) * 1024); ++k) {
        elastic_trial<D>(points[k], lame, twice_shear);
      }
    });
  }
  double wave_modulus() const override { return moduli_.wave(); }
  Measures measures(long) const override { return {}; }
  void save(Hdf5File&, const std::string&) const override {}  // no state beyond that of the points
  void restore(const Hdf5File&, const std::string&) override {}

 private:
  ElasticModuli moduli_;
};

}  // namespace mpm
