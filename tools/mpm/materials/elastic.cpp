#include "tools/mpm/materials/elastic.hpp"

namespace mpm {

ElasticModuli read_moduli(Keys& keys) {
  ElasticModuli moduli;
  moduli.young = keys.positive("young_modulus_Pa");
  moduli.poisson = keys.number("poisson_ratio", 0.3, -0.99, 0.499);
  return moduli;
}

Continuum read_elastic(Keys& keys) {
  const auto moduli = read_moduli(keys);
  return continuum_of<Elastic>(moduli.wave(), moduli);
}

}  // namespace mpm
