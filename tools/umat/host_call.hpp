// Common parts of the calls of all hosts: properties, state variables, the first stress.
#pragma once

#include <cstdint>
#include <string>

#include "rvelab/pool/floating_point.hpp"
#include "rvelab/threads/classic_locale.hpp"
#include "tools/umat/points.hpp"

namespace umat {

/// Stress measure of the host: sigma; R^T sigma R with R of the polar decomposition of F; or sigma before a step and
/// R^T sigma R after it with R of the increment, by which the host then rotates it.
enum class Axes { global, corotational, turned_by_host };

/// During a call: the default floating-point environment and the C locale, independent of the host's settings.
struct CallEnvironment {
  rvelab::pool::FloatingPoint numbers{};
  rvelab::ClassicLocale text{};
};

/// The content of PROPS.
struct Properties {
  int material = 0;
  Axes axes = Axes::global;
  bool physical = false;  ///< the host's time is physical; otherwise it is ignored
};

inline int or_zero(const int* value) { return value == nullptr ? 0 : *value; }

/// Throws std::runtime_error with the property, its value and the allowed values.
Properties properties_of(const double* props, int n);

/// A state variable as an integer; throws if it is not a whole number.
std::int64_t whole_state(double value, const char* name);

/// A number in a message.
std::string in_words(double value);

/// The RVEs of this process: host and library share one pool for the life of it.
Points& points();

/// The specimen is in equilibrium with its own stress; with a different initial stress the host would get a jump.
/// Throws unless `given`, in the host's components and axes, is within 1 % of it, or zero if the settings define zero
/// as that stress. R0: rotation of these axes. name: of the argument.
void expect_first_stress(int material, const double* given, const Components& components, const Matrix3& R0,
                         const char* name);

/// Appends a text to rvelab_umat.log in the folder of the host's first call: each once, at most a hundred. Writes to
/// standard error if that fails.
void log_failure(const std::string& text);

/// Stores the working directory for the log. Every call of a host begins with it.
void remember_folder();

}  // namespace umat
