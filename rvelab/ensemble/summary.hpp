// The summary of an ensemble: tests on many specimens, in one group or two, at one pressure or several.
#pragma once

#include <string>
#include <vector>

#include "rvelab/ensemble/measures.hpp"
#include "rvelab/ensemble/statistics.hpp"

namespace rvelab::ensemble {

/// One finished test.
struct TestOf {
  std::size_t group = 0;                  ///< from 0
  std::size_t specimen = 0;               ///< its number over all groups, from 0
  double pressure = 0;                    ///< Pa
  std::vector<double> values;             ///< of measures()
  calibrate::PrincipalStresses strength;  ///< strength_of(); Pa
  bool grains_stick = false;              ///< calibrate::grains_stick of the specimen
};

/// One measure over the specimens of a group.
struct Row {
  std::size_t group = 0;
  double pressure = 0;  ///< Pa; NaN: from the tests at all pressures together
  std::string name, unit;
  Spread spread;
};

/// A measure of the first group less that of the second.
struct Comparison {
  double pressure = 0;
  std::string name, unit;
  Difference difference;
};

struct Summary {
  std::vector<Row> rows;
  std::vector<Comparison> comparisons;               ///< of two groups; else empty
  std::vector<calibrate::Cohesive> cohesive_groups;  ///< of each group
};

/// Every measure that a test gives, pressure by pressure; then what each specimen's strengths together give: the
/// secant friction angle (least squares through the origin), tangent angle and cohesion of the straight envelope where
/// there are two pressures or more, factors of a footing and geometry of its failure mechanism: by the first angle, of
/// a cohesive group (calibrate::cohesive, over all of its tests) by the tangent angle.
Summary summary_of(const std::vector<TestOf>& tests);

}  // namespace rvelab::ensemble
