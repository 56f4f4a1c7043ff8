// Grains as a material: one RVE for each point, through rvelab/rvelab.h and nothing else of rvelab.
#pragma once

#include <memory>
#include <vector>

#include "tools/mpm/materials/grain_pool.hpp"
#include "tools/mpm/materials/material.hpp"

namespace mpm {

template <int D>
class Grains : public Material<D> {
 public:
  /// at_rate: the RVEs feel the time step (rate, inertia of grains); else they are quasi-static.
  /// gather: increments are summed until the largest entry of the gradient reaches this; the stress stays meanwhile. 0:
  /// each is applied at once.
  Grains(std::shared_ptr<GrainPool> pool, std::vector<std::int64_t> ids, bool at_rate, double gather);
  void advance(Point<D>* points, long count, double dt, rvelab::Workers& workers) override;
  double wave_modulus() const override { return wave_modulus_; }
  Measures measures(long point) const override;
  void save(Hdf5File& file, const std::string& name) const override;
  void restore(const Hdf5File& file, const std::string& name) override;
  double grain_steps() const override;
  /// Stress of each RVE as it is, Pa.
  void read_stress(Point<D>* points);
  /// Stages of a test, as text of TOML, on the RVEs of these points (rvelab_run_stages), whose stress and stiffness
  /// then are those of the new states. runtime_error with rvelab's own text if one of them fails.
  void run_stages(Point<D>* points, const std::vector<long>& chosen, const std::string& stages);
  /// The RVE of a point in a file of its own: grains, contacts and their history.
  void write_network(long point, const std::string& path) const { pool_->write_alone(ids_[std::size_t(point)], path); }
  const std::vector<std::int64_t>& ids() const { return ids_; }
  /// Increments that had to be cut, and those with a warning of the tolerance or of missing equilibrium.
  long split = 0, warned = 0;
  double called = 0, asked = 0;  ///< increments that RVEs got, and all of the points
  long changes_made = 0;         ///< of the scene, those that came to this material

 private:
  void follow_stiffness(const Point<D>* points, long count);
  void apply_in_parts(Point<D>& point, std::int64_t id, const Mat<D>& gradient, double dt, double scale);
  std::shared_ptr<GrainPool> pool_;
  std::vector<std::int64_t> ids_;
  bool at_rate_;
  double gather_;
  double wave_modulus_ = 0;
  double earlier_ = 0;  ///< grain-steps before the run was resumed
  /// The last measured wave modulus, the largest compression along an axis then, and the count of increments.
  struct Found {
    double first = 0, modulus = 0, compression = 0, called = 0;  ///< first: at the start, Pa
  } found_;
  std::vector<Mat<D>> gathered_;  ///< gradients times steps, not applied yet
  std::vector<long> chosen_;      ///< points of the batch
  std::vector<std::int64_t> batch_ids_;
  std::vector<double> dH_, sigma_, scale_;
  std::vector<std::int32_t> status_;
};

}  // namespace mpm
