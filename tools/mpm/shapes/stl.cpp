// Triangles of STL files. Declared in shape.hpp.
#include <cstring>
#include <sstream>

#include "rvelab/keys/regular_file.hpp"
#include "tools/mpm/error.hpp"
#include "tools/mpm/shapes/shape.hpp"

namespace mpm {
namespace {

[[noreturn]] void bad_stl(const std::string& path, const std::string& what) {
  throw InputError(path + ": " + what + "; write it again as an STL file, ASCII or binary");
}

/// A binary file has 80 bytes of title, the number of triangles and 50 bytes for each; all little endian.
constexpr std::size_t title_bytes = 84, triangle_bytes = 50;

std::size_t counted(const std::string& bytes) {
  std::uint32_t count = 0;
  for (std::size_t k = 0; k < 4; ++k) count |= std::uint32_t(static_cast<unsigned char>(bytes[80 + k])) << (8 * k);
  return count;
}

std::vector<Triangle> binary_triangles(const std::string& path, const std::string& bytes) {
  const std::size_t count = counted(bytes);
  if (bytes.size() != title_bytes + triangle_bytes * count) {
    bad_stl(path, "it has " + std::to_string(bytes.size()) + " bytes, but " + std::to_string(count) +
                      " triangles in binary take " + std::to_string(title_bytes + triangle_bytes * count));
  }
  std::vector<Triangle> triangles(count);
  for (std::size_t t = 0; t < count; ++t) {
    for (std::size_t k = 0; k < 9; ++k) {
      float value = 0;  // the three numbers before are the normal
      std::memcpy(&value, bytes.data() + title_bytes + triangle_bytes * t + 12 + 4 * k, 4);
      triangles[t][k / 3][Eigen::Index(k % 3)] = double(value);
    }
  }
  return triangles;
}

double number_of(const std::string& path, const std::string& word) {
  char* end = nullptr;
  const double value = std::strtod(word.c_str(), &end);
  if (word.empty() || *end != 0) bad_stl(path, "\"" + word + "\" stands where a coordinate should");
  return value;
}

std::vector<Triangle> ascii_triangles(const std::string& path, const std::string& bytes) {
  std::vector<Triangle> triangles;
  std::istringstream words(bytes);
  std::string word, name;
  std::size_t corners = 3;
  bool ended = false;
  while (words >> word) {
    if (word == "solid" || word == "endsolid") {
      std::getline(words, name);  // it may have any words
      ended = word == "endsolid";
    } else if (word == "facet") {
      triangles.emplace_back();
      corners = 0;
    } else if (word == "vertex") {
      if (corners >= 3) bad_stl(path, "a facet has more than three corners, or a corner stands outside of facets");
      for (int i = 0; i < 3; ++i) {
        if (!(words >> word)) word.clear();
        triangles.back()[corners][i] = number_of(path, word);
      }
      ++corners;
    } else if (word == "endfacet" && corners != 3) {
      bad_stl(path, "a facet has " + std::to_string(corners) + " corners");
    }
  }
  if (!ended) bad_stl(path, "it ends before its last line, endsolid");
  return triangles;
}

}  // namespace

std::vector<Triangle> read_stl(const std::string& path) {
  std::string bytes;
  try {
    bytes = rvelab::keys::whole_file<std::string>(path, "an STL file");
  } catch (const rvelab::InputError& error) {
    throw InputError(error.what());
  }
  // Binary files may begin with "solid" too: then their size tells.
  const bool binary_size = bytes.size() >= title_bytes && bytes.size() == title_bytes + triangle_bytes * counted(bytes);
  const bool ascii = bytes.compare(0, 5, "solid") == 0 && !binary_size;
  if (!ascii && bytes.size() < title_bytes) bad_stl(path, "it is no STL file, or cut off in its first 84 bytes");
  const std::vector<Triangle> triangles = ascii ? ascii_triangles(path, bytes) : binary_triangles(path, bytes);
  if (triangles.empty()) bad_stl(path, "it has no triangles");
  for (const Triangle& triangle : triangles) {
    for (const Vec<3>& corner : triangle) {
      if (!corner.allFinite()) bad_stl(path, "a coordinate is not a finite number");
    }
  }
  return triangles;
}

}  // namespace mpm
