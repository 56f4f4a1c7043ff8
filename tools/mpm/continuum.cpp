#include "tools/mpm/continuum.hpp"

#include "tools/mpm/elastic.hpp"
#include "tools/mpm/plastic.hpp"

namespace mpm {

const std::vector<ContinuumKind> continuum_kinds = {
    {"elastic", read_elastic},
    {"mohr_coulomb", read_mohr_coulomb},
    {"drucker_prager", read_drucker_prager},
};

}  // namespace mpm
