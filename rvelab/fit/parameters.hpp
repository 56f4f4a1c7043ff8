// The parameters of a fit or a sweep, and the scalar targets, as the command line gives them.
#pragma once

#include <string>

#include "rvelab/fit/search.hpp"

namespace rvelab::fit {

/// A key of a protocol or recipe that is varied between two values.
struct Parameter {
  std::string key;
  double low = 0, high = 0;
  bool logarithmic = false;  ///< evenly in the logarithm
  long grid = 0;             ///< values of a sweep; 0: none is asked for

  double value(double point) const;            ///< of a point from 0 to 1
  std::string assignment(double value) const;  ///< "key=value", every bit of the value
};

/// "material.friction=0.1:1.0", "material.young_modulus_Pa=1e7:1e9:log", "material.friction=0.1:0.9:5" and
/// "...:5:log". InputError naming the mistake.
Parameter parsed_parameter(const std::string& text);

/// A scalar target; `measure` is one of ensemble::measures(), or a feature (ensemble/features.hpp).
struct ScalarTarget {
  std::string measure;
  double value = 0, error = 0;
  double pressure = 0;  ///< Pa; 0: that of the protocol
};

/// "friction_angle_deg=30", "friction_angle_deg=30+-0.5", "friction_angle_deg@50e3=38". InputError naming the mistake.
ScalarTarget parsed_target(const std::string& text);

}  // namespace rvelab::fit
