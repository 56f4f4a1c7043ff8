// Elastic, perfectly plastic, hardening and softening soils: Mohr-Coulomb and Drucker-Prager, not associated.
//
// The angle of friction and the cohesion follow the accumulated deviatoric plastic strain (sum of sqrt(2/3 de:de)), as
// it was at the start of the step. Hardening of Li et al. (2023, eq. 43): residual angle while it is zero, a cubic up
// to the peak, exponential decay to the residual angle after it; or linear (their table 8).
#pragma once

#include <vector>

#include "tools/mpm/materials/elastic.hpp"

namespace mpm {

struct Strength {
  enum class Law { constant, linear, cubic_exponential } law = Law::constant;
  double friction = 0;                            ///< rad; of the first state (constant, linear)
  double cohesion = 0;                            ///< Pa
  double dilatancy = 0;                           ///< rad
  double friction_slope = 0, cohesion_slope = 0;  ///< rad, Pa a unit of plastic strain (linear)
  double a = 0, b = 0, c = 0, d = 0;              ///< rad, of the cubic
  double peak_strain = 0, decay = 0, peak = 0, residual = 0;

  static constexpr double steepest = 1.5533430342749532;  ///< rad, 89 degrees
  /// rad, kept from 0 to the steepest whatever the law says.
  double friction_at(double plastic) const;
  double cohesion_at(double plastic) const;
};

enum class Cone { outer, inner, plane_strain };

/// Back to the surface from a trial stress (Pa, tension positive, 3 x 3, symmetric); returns the increment of
/// deviatoric plastic strain, 0 if the trial was admissible.
double return_to_mohr_coulomb(Mat<3>& stress, const ElasticModuli& moduli, double friction, double cohesion,
                              double dilatancy);
/// sqrt(J2) + alpha I1 = k, through the outer or inner edges of Mohr-Coulomb, or matched in plane strain.
double return_to_drucker_prager(Mat<3>& stress, const ElasticModuli& moduli, double friction, double cohesion,
                                double dilatancy, Cone cone);
double cone_slope(double friction, Cone cone);
double cone_size(double friction, double cohesion, Cone cone);

enum class YieldSurface { mohr_coulomb, drucker_prager };

Continuum read_mohr_coulomb(Keys& keys);
Continuum read_drucker_prager(Keys& keys);

template <int D>
class Plastic : public Material<D> {
 public:
  Plastic(const ElasticModuli& moduli, const Strength& strength, YieldSurface surface, Cone cone)
      : moduli_(moduli), strength_(strength), surface_(surface), cone_(cone) {}
  void advance(Point<D>* points, long count, double dt, rvelab::Workers& workers) override;
  double wave_modulus() const override { return moduli_.wave(); }
  Measures measures(long point) const override;
  void save(Hdf5File& file, const std::string& name) const override;
  void restore(const Hdf5File& file, const std::string& name) override;

 private:
  ElasticModuli moduli_;
  Strength strength_;
  YieldSurface surface_;
  Cone cone_;
  std::vector<double> plastic_;
};

}  // namespace mpm
