#include "tools/mpm/materials/continuum.hpp"

#include "tools/mpm/materials/elastic.hpp"
#include "tools/mpm/materials/plastic.hpp"

namespace mpm {

const std::vector<ContinuumKind> continuum_kinds = {
    {"elastic", read_elastic},
    {"mohr_coulomb", read_mohr_coulomb},
    {"drucker_prager", read_drucker_prager},
};

}  // namespace mpm
