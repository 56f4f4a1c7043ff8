// Errors of the library. Each message names the value found, the value allowed and what to do.
#pragma once

#include <locale>
#include <sstream>
#include <stdexcept>
#include <string>

namespace rvelab {

/// A stream for text with numbers, as C writes them: a locale that a host has made the global one may group digits.
struct TextStream : std::ostringstream {
  TextStream() { imbue(std::locale::classic()); }
};

/// A number in a message, to six digits.
inline std::string in_words(double value) {
  TextStream text;
  text << value;
  return text.str();
}

/// Base of all errors that rvelab throws on purpose.
struct Error : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// What the caller handed in cannot be used: a file, a key, a parameter (exit code 2 of the program).
struct InputError : Error {
  using Error::Error;
};

/// An increment that is refused before any work: not finite, det(I + dH) <= 0, out of plane.
struct InvalidIncrement : InputError {
  using InputError::InputError;
};

/// An increment that could not be carried out; the RVE is as it was before it (exit code 1 of the program).
struct IncrementFailed : Error {
  using Error::Error;
};

/// A cell or a place in it that double precision cannot carry: a lattice too skewed to be reduced, a grain beyond 2^31
/// cells. Of what is read it becomes an InputError, of an increment an IncrementFailed.
struct CellError : Error {
  using Error::Error;
};

/// Work that was asked to stop (Rve::watch). The RVE is as it was before the call.
struct Interrupted : Error {
  Interrupted() : Error("stopped on request") {}
};

}  // namespace rvelab
