// Two HDF5 files dataset by dataset, outside /provenance.
#pragma once

#include <cstring>
#include <string>

#include "rvelab/io/hdf5/file.hpp"

namespace rvelab::test {

template <class Scalar>
bool same_values(const io::Hdf5File& a, const io::Hdf5File& b, const std::string& name) {
  const auto left = a.read<Scalar>(name), right = b.read<Scalar>(name);
  return left.size() == right.size() &&
         (left.empty() || std::memcmp(left.data(), right.data(), left.size() * sizeof(Scalar)) == 0);
}

/// The first dataset that differs; "" if none does.
inline std::string first_different_dataset(const std::string& path_a, const std::string& path_b) {
  const auto a = io::Hdf5File::open(path_a), b = io::Hdf5File::open(path_b);
  const auto outside = [](const io::Hdf5File& file) {
    auto entries = file.entries();
    std::erase_if(entries, [](const io::Hdf5Entry& entry) { return entry.name.starts_with("/provenance/"); });
    return entries;
  };
  const auto left = outside(a), right = outside(b);
  for (std::size_t k = 0; k < std::max(left.size(), right.size()); ++k) {
    if (k >= left.size()) return right[k].name;
    const io::Hdf5Entry& entry = left[k];
    if (k >= right.size() || entry.name != right[k].name || entry.type != right[k].type ||
        entry.shape != right[k].shape || entry.units != right[k].units) {
      return entry.name;
    }
    const bool same = entry.type == "text"      ? a.read_text(entry.name) == b.read_text(entry.name)
                      : entry.type == "float64" ? same_values<double>(a, b, entry.name)
                      : entry.type == "uint64"  ? same_values<std::uint64_t>(a, b, entry.name)
                                                : same_values<std::int64_t>(a, b, entry.name);
    if (!same) return entry.name;
  }
  return "";
}

}  // namespace rvelab::test
