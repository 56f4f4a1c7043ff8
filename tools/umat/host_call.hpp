// What the calls of a host have in common, whatever their arguments: properties, state variables, the first stress.
#pragma once

#include <cstdint>
#include <string>

#include "rvelab/pool/floating_point.hpp"
#include "rvelab/threads/classic_locale.hpp"
#include "tools/umat/points.hpp"

namespace umat {

/// What stresses of the host are: sigma; R^T sigma R with R of the polar decomposition of F; or sigma before a step and
/// R^T sigma R after it with R of the increment, which the host turns by R itself.
enum class Axes { global, corotational, turned_by_host };

/// While a call lasts: the default floating-point environment and the locale of C, whatever the host has set.
struct CallEnvironment {
  rvelab::pool::FloatingPoint numbers{};
  rvelab::ClassicLocale text{};
};

/// What PROPS says.
struct Properties {
  int material = 0;
  Axes axes = Axes::global;
  bool physical = false;  ///< the host's time is time; else it is ignored
};

inline int or_zero(const int* value) { return value == nullptr ? 0 : *value; }

/// Throws std::runtime_error that names the property, its value and what is allowed.
Properties properties_of(const double* props, int n);

/// A state variable as an integer; throws if it is none.
std::int64_t whole_state(double value, const char* name);

/// A number as a message tells it.
std::string in_words(double value);

/// The RVEs of this process: host and library share one pool for the life of it.
Points& points();

/// The specimen is in equilibrium with its own stress; a host that starts from another one would see a jump: throws
/// unless `given`, in the host's components and axes, is within 1 % of it, or zero where the settings say that zero
/// stands for it. R0: rotation of these axes. name: of the argument.
void expect_first_stress(int material, const double* given, const Components& components, const Matrix3& R0,
                         const char* name);

/// Appends a text to rvelab_umat.log in the folder where the host made its first call: each once, a hundred at most. To
/// standard error where that cannot be written.
void log_failure(const std::string& text);

/// The working directory is looked up, for the log. Every call of a host begins with it.
void remember_folder();

}  // namespace umat
