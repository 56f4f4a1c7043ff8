// RVEs of one material through rvelab/rvelab.h: their pool, and the specimens that they are made from.
#pragma once

#include <rvelab/rvelab.h>

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "rvelab/threads/workers.hpp"
#include "tools/mpm/tensors.hpp"

namespace mpm {

/// Who works on the RVEs: the threads of this process, or ranks, which serve one pool at a time.
struct PoolSource {
  std::int32_t (*create)(const rvelab_pool_def*, rvelab_pool**) = rvelab_pool_create;
  bool over_ranks = false;
};

struct GrainOptions {
  double tolerance_rel = 0, tolerance_abs = 0;  ///< 0: what the specimen says
  PoolSource source;
};

/// InputError with rvelab's own text if a call failed; warnings are ignored.
void expect_ok(std::int32_t status);

/// A pool of RVEs that work with the threads of the driver.
class GrainPool {
 public:
  GrainPool(rvelab::Workers& workers, const GrainOptions& options);
  GrainPool(const GrainPool&) = delete;
  GrainPool& operator=(const GrainPool&) = delete;
  ~GrainPool();
  rvelab_pool* get() const { return pool_; }
  rvelab_info info(std::int64_t id) const;
  void write(const std::string& path) const;
  void read(const std::string& path);
  /// A copy of an RVE of another pool, with the tolerances of this one.
  std::int64_t copy_from(const GrainPool& other, std::int64_t id) const;
  /// One RVE as a pool file of its own, which `rvelab inspect`, `export` and the like read as a specimen.
  void write_alone(std::int64_t id, const std::string& path) const;

 private:
  rvelab_pool* pool_ = nullptr;
};

/// Specimens of one material, consolidated to each pressure once and then copied.
class SpecimenFamily {
 public:
  /// `paths`: one or more specimen files; that with the pressure nearest to the one asked for (by ratio) is taken,
  /// the next one if it does not come to that pressure.
  SpecimenFamily(std::shared_ptr<GrainPool> pool, const std::vector<std::string>& paths);
  /// An RVE under the isotropic stress -pressure (0: as the file has it). The first call for a pressure consolidates,
  /// drained, by the tangent of the contact network; later ones copy.
  std::int64_t spawn(double pressure);
  /// Of the state that was prepared for that pressure.
  rvelab_info prepared(double pressure);
  /// Pa: of plane waves, in the stiffest of the specimens as their files have them.
  double wave_modulus();
  std::size_t classes() const { return prepared_.size(); }
  /// Releases the prepared states; their copies stay.
  void release();

 private:
  struct Specimen {
    std::int64_t tmpl;
    double pressure;
  };
  /// From the specimen of the nearest pressure that comes there: loose grains may collapse where they are unloaded, and
  /// are only pressed from a lower pressure.
  std::int64_t prepare(double pressure);
  /// Strains an RVE to the isotropic stress -pressure; false if it does not come there.
  bool brought_to(double pressure, std::int64_t id);
  /// Its copy in the pool of the scene.
  std::int64_t moved_to_scene(std::int64_t id);
  std::shared_ptr<GrainPool> pool_;
  rvelab::Workers thread_{1};
  GrainPool preparation_;  ///< with the tolerances of the specimen, whatever those of the scene
  std::vector<Specimen> specimens_;
  std::map<double, std::int64_t> prepared_;
};

/// Stress and tangent of the state as it is, by a trial that is discarded.
void read_state(rvelab_pool* pool, std::int64_t id, double* sigma, double* tangent);

/// Pa: the largest of the moduli of plane waves along the axes, of the contact network.
double wave_modulus_of(const GrainPool& pool, std::int64_t id);

/// Pa: the same measured by quasi-static strains of 1e-5 along the axes, the stiffer side of each; 0 if they cannot be
/// made. Along a biaxial test of dense discs it is within 4 % of the tangent's in a tenth of its time; for 1000 spheres
/// within 1 % in a hundredth.
double measured_modulus_of(const GrainPool& pool, std::int64_t id, int dimension);

}  // namespace mpm
