// What a material does: the velocity gradients of its points over a step become their stresses.
#pragma once

#include <string>

#include "rvelab/threads/workers.hpp"
#include "tools/mpm/grid/point.hpp"

namespace rvelab::io {
class Hdf5File;
}

namespace mpm {

using rvelab::io::Hdf5File;

/// Measures of a point that only some materials have; NaN: none.
struct Measures {
  double void_ratio = NAN, fabric_anisotropy = NAN, coordination_number = NAN, plastic_strain = NAN;
};

/// Of one material group: a contiguous range of points.
template <int D>
class Material {
 public:
  virtual ~Material() = default;

  /// Point::gradient is the velocity gradient times dt; writes stress and stress_zz.
  virtual void advance(Point<D>* points, long count, double dt, rvelab::Workers& workers) = 0;
  /// Pa, the largest modulus of a plane wave, for the time step.
  virtual double wave_modulus() const = 0;
  virtual Measures measures(long point) const = 0;
  /// State beyond that of the points, for checkpoints; `name` is that of the material.
  virtual void save(Hdf5File& file, const std::string& name) const = 0;
  virtual void restore(const Hdf5File& file, const std::string& name) = 0;
  /// Grains times sub-steps so far; 0 for a material without grains.
  virtual double grain_steps() const { return 0; }
  /// s of wall time that was spent in grains.
  double seconds = 0;
};

}  // namespace mpm
