// Energies of the whole cell (rvelab/measure/measures.hpp).
#pragma once

#include "rvelab/measure/measures.hpp"
#include "rvelab/records/quantity.hpp"

namespace rvelab::records {

struct ElasticEnergy {
  double elastic_energy = 0;
  static constexpr QuantityText text{"elastic_energy_J", "J", "in contact springs"};
  static constexpr auto member = &ElasticEnergy::elastic_energy;
  static double measure(const Rve&, const Network& network) { return rvelab::elastic_energy(network); }
};

struct KineticEnergy {
  double kinetic_energy = 0;
  static constexpr QuantityText text{"kinetic_energy_J", "J",
                                     "of fluctuation velocities and whole spins; 0 when quasi-static"};
  static constexpr auto member = &KineticEnergy::kinetic_energy;
  static double measure(const Rve&, const Network& network) { return rvelab::kinetic_energy(network); }
};

}  // namespace rvelab::records
