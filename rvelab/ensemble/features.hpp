// Features of a monotonic test: numbers that tell a soil and scatter little from test to test, read in one way off a
// test and off a measured curve. Compression positive, SI; q = sigma_1 - sigma_3, p the mean effective stress; strains
// and q of an extension are sizes. "at X percent": at this axial strain, linear between rows.
//
//   drained and undrained shear
//     q_at_X_percent_Pa, p_at_X_percent_Pa      q, p
//     E50_Pa                                    secant from the start to half of the largest increase of q
//     strain_at_95_percent_of_q                 where q first reaches 95 % of its largest value
//     largest_q_Pa, last_q_Pa                   q, up to the end of the curve
//   the largest value is that of the mean over 2 % of strain (within a quarter of the strain), since some hundred
//   grains fluctuate
//   drained
//     eps_v_at_X_percent                        volumetric strain 1 - V/V0 since the start
//   undrained
//     q_/p_at_phase_transformation_Pa           where p is least: contraction turns to dilation (Ishihara, Tatsuoka and
//                                               Yasuda 1975, Soils and Foundations 15(1), 29-44)
//   oedometer, over the axial stress, linear in its logarithm; strains since the first row
//     loading_strain_at_X_kPa, unloading_strain_at_X_kPa
//
// `relative` and `absolute` are the standard deviation of single tests about the mean of a soil, hypot(relative value,
// absolute), where no repeated tests give it. It is an assumption: what errors of 0.01 in the void ratio, 0.015 % in
// the strain (seating) and 4 % in the stress do to drained tests of Karlsruhe fine sand, by the differences between its
// tests at void ratios of 0.86 and 0.74; of undrained ones, which follow the density more closely, 10 % at least.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "rvelab/protocol/protocol.hpp"
#include "rvelab/records/record.hpp"

namespace rvelab::ensemble {

struct Feature {
  enum class Kind { at_strain, secant, near_largest, largest, last, transformation, loading, unloading };
  std::string name;  ///< ends in its unit
  Kind kind = Kind::at_strain;
  std::string quantity;  ///< "deviator", "strain_of_deviator", "p", "volumetric_strain"; "strain" of an oedometer
  double at = 0;         ///< axial strain, or axial stress in Pa
  double relative = 0, absolute = 0;

  double scatter_of(double value) const;  ///< of single tests, in the unit of the feature
  bool over_stress() const { return kind == Kind::loading || kind == Kind::unloading; }
};

enum class TestKind { drained, undrained, oedometer };

/// By its name; none: it names no feature.
std::optional<Feature> feature_of(const std::string& name, TestKind kind = TestKind::drained);
/// The forms of names, for messages.
const std::vector<std::string>& feature_names();

/// Those that are compared where no others are named.
std::vector<Feature> usual_features(TestKind kind);
/// Of the last stage that records: undrained where it keeps the volume.
TestKind test_kind(const protocol::Protocol& protocol, bool over_stress);

/// A test as features see it. Columns that it lacks are empty.
struct TestPath {
  std::vector<double> strain, q, p, eps_v;  ///< strain rises
  /// Oedometer, rows in their order; unloading begins where loading ends.
  std::vector<double> loading, loading_strain, unloading, unloading_strain;
  bool flows = false;  ///< it ended early without effective stress: it stays as at its end
};

/// Of the last stage of a test up to an axial strain; of an oedometer test (`over_stress`) all stages at its end whose
/// lateral strains are zero.
TestPath path_of(const records::TestResult& test, int dimension, bool over_stress, double to_strain);

/// NaN: the path does not give it (too short, a column is missing).
double value_of(const Feature& feature, const TestPath& path);

}  // namespace rvelab::ensemble
