// Grains as a material: one RVE for each point, through rvelab/rvelab.h and nothing else of rvelab.
#pragma once

#include <rvelab/rvelab.h>

#include <map>
#include <memory>
#include <vector>

#include "tools/mpm/material.hpp"

namespace mpm {

/// rvelab_pool_create, or what makes a pool over ranks.
using CreatePool = std::int32_t (*)(const rvelab_pool_def*, rvelab_pool**);

struct GrainOptions {
  double tolerance_rel = 0, tolerance_abs = 0;  ///< 0: what the specimen says
  CreatePool create_pool = rvelab_pool_create;
};

/// A pool of RVEs that work with the threads of the driver.
class GrainPool {
 public:
  GrainPool(Workers& workers, const GrainOptions& options);
  GrainPool(const GrainPool&) = delete;
  GrainPool& operator=(const GrainPool&) = delete;
  ~GrainPool();
  rvelab_pool* get() const { return pool_; }
  rvelab_info info(std::int64_t id) const;
  void write(const std::string& path) const;
  void read(const std::string& path);

 private:
  rvelab_pool* pool_ = nullptr;
};

/// Specimens of one material, brought to any pressure once and copied from there.
class SpecimenFamily {
 public:
  /// `paths`: one or more specimen files; that with the pressure nearest to the one asked for (by ratio) is taken.
  SpecimenFamily(std::shared_ptr<GrainPool> pool, const std::vector<std::string>& paths);
  /// An RVE under the isotropic stress -pressure (0: as the file has it). The first call for a pressure consolidates,
  /// drained, by the tangent of the contact network; later ones copy.
  std::int64_t spawn(double pressure);
  /// Of the state that was prepared for that pressure.
  rvelab_info prepared(double pressure);
  std::size_t classes() const { return prepared_.size(); }
  /// Takes the prepared states out of the pool; their copies stay.
  void release();

 private:
  struct Specimen {
    std::int64_t tmpl;
    double pressure;
  };
  std::int64_t prepare(double pressure);
  std::shared_ptr<GrainPool> pool_;
  std::vector<Specimen> specimens_;
  std::map<double, std::int64_t> prepared_;
};

/// Pa: the largest of the moduli of plane waves along the axes, of the contact network.
double wave_modulus_of(const GrainPool& pool, std::int64_t id);

template <int D>
class Grains : public Material<D> {
 public:
  /// physical: the RVEs feel the time step (rate, inertia of grains); else they are quasi-static.
  /// gather: increments whose sum (largest entry of the gradient) is below this wait for those to come; the stress
  /// stays meanwhile. 0: none waits.
  Grains(std::shared_ptr<GrainPool> pool, std::vector<std::int64_t> ids, bool physical, double gather);
  void advance(Point<D>* points, long count, double dt, Workers& workers) override;
  double wave_modulus() const override { return wave_modulus_; }
  Measures measures(long point) const override;
  void save(OutputFile& file, const std::string& name) const override;
  void restore(const InputFile& file, const std::string& name) override;
  double grain_steps() const override;
  /// Stress of each RVE as it is, Pa.
  void read_stress(Point<D>* points);
  const std::vector<std::int64_t>& ids() const { return ids_; }
  /// Increments that could be made in parts only, and those whose estimate was above the tolerance or not quasi-static.
  long split = 0, warned = 0;
  double called = 0, asked = 0;  ///< increments given to RVEs, and all there were

 private:
  void in_parts(Point<D>& point, std::int64_t id, const Mat<D>& gradient, double dt, double scale);
  std::shared_ptr<GrainPool> pool_;
  std::vector<std::int64_t> ids_;
  bool physical_;
  double gather_;
  double wave_modulus_ = 0;
  std::vector<Mat<D>> waiting_;  ///< gradients times steps that were gathered
  std::vector<long> chosen_;     ///< points of the batch
  std::vector<std::int64_t> batch_ids_;
  std::vector<double> dH_, sigma_, scale_;
  std::vector<std::int32_t> status_;
};

}  // namespace mpm
