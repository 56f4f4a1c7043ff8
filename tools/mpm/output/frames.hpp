// Frames of a run: arrays in HDF5 files, WHAT_NNNN.h5, and the file by which ParaView shows them as a series.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "rvelab/io/hdf5/file.hpp"
#include "tools/mpm/tensors.hpp"

namespace mpm {

/// "points_0012.h5".
std::string frame_name(const std::string& what, std::size_t frame);

/// A vector with three components in the plane too: ParaView knows no others.
template <int D>
std::array<double, 3> three(const Vec<D>& v) {
  std::array<double, 3> all{};
  for (int i = 0; i < D; ++i) all[std::size_t(i)] = v[i];
  return all;
}

class Frame {
 public:
  /// Of `count` things at `times`.back(); times: s, of the frames so far, this one too.
  Frame(const std::string& what, std::size_t count, const std::string& folder, const std::vector<double>& times);
  /// A dataset.
  void add(const std::string& name, std::span<const double> values, const rvelab::io::Shape64& shape);
  /// One that ParaView shows; type: "Scalar", "Vector" or "Tensor"; of(k): the numbers of the thing k as an array. The
  /// one of the name position_m is where they are.
  template <class Of>
  void show(const std::string& name, const std::string& type, const Of& of) {
    std::vector<double> values;
    for (std::size_t k = 0; k < count_; ++k) {
      for (const double x : of(k)) values.push_back(x);
    }
    add(name, values, type == "Scalar" ? rvelab::io::Shape64{count_} : rvelab::io::Shape64{count_, widths(type)});
    if (name != "position_m") shown_.push_back({name, type});
  }
  /// Writes the file, and WHAT.xdmf of all frames so far.
  void publish() const;

 private:
  struct Shown {
    std::string name, type;
  };
  static std::size_t widths(const std::string& type) { return type == "Tensor" ? 9 : type == "Vector" ? 3 : 1; }
  std::string what_, folder_;
  std::size_t count_;
  const std::vector<double>& times_;
  rvelab::io::Hdf5File file_;
  std::vector<Shown> shown_;
};

}  // namespace mpm
