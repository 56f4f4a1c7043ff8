// Second-order work of a test, d2W = d sigma : d eps between neighbouring records (Hill 1958): where it is negative,
// the specimen may fail without further load (Darve et al. 2004; Nicot and Darve 2007).
//
// d eps is the symmetric part of l = dF F^-1 at the middle of the increment, d sigma the increment of the Cauchy stress
// less its turn with the spin of l. Per volume of the increment. Terms sigma d eps d eps, by which other measures of
// stress differ, are left out.
#pragma once

#include <span>
#include <vector>

#include "rvelab/records/record.hpp"

namespace rvelab::ensemble {

/// Of the increment that ends at record k, in Pa; 0 at the first record and where a stage begins.
std::vector<double> second_order_work(std::span<const records::Record> records);

/// d2W/(|d sigma| |d eps|) of the same increments, from -1 to 1; 0 where one of them vanishes.
std::vector<double> normalised_second_order_work(std::span<const records::Record> records);

/// Work over a window of strain, as its records scatter.
struct Instability {
  double least =
      0;  ///< least d2W of increments from one end of a window to the other, normalised; NaN: too few records
  double strain = 0;  ///< driving strain in the middle of the first window with d2W < 0; NaN: none
};

/// Of one stage whose driving strain goes one way. `window`: of the driving strain; at least three records.
Instability instability_of(std::span<const records::Record> stage, double window = 0.005);

}  // namespace rvelab::ensemble
