// Text files for other programs: numbers that come back bit for bit, files that are there whole or not at all.
#pragma once

#include <string>

namespace rvelab::io {

/// The shortest decimal that reads back as the same double (up to 17 digits).
std::string exact(double value);

/// Writes path.tmp and renames it to path. InputError if the place cannot be written to, Error if the writing fails.
void publish_text(const std::string& path, const std::string& text);

}  // namespace rvelab::io
