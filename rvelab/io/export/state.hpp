// A state as other programs are shown it: a specimen, its contact forces, and the box that its grains are drawn in.
#pragma once

#include <string>
#include <vector>

#include "rvelab/solver/assembly/network.hpp"
#include "rvelab/specimen/specimen.hpp"

namespace rvelab::io {

/// One state for export. Network and specimen are of the same state: grain k of the one is grain k of the other.
struct ExportState {
  long record = 0;    ///< number of the record that it belongs to; the number of records for an end state
  double strain = 0;  ///< driving strain of that record; 0 without records
  Specimen specimen;
  Network network;
};

/// The parallelepiped of the cell vectors, its centre in the origin of the cell frame. Grains are stored in a cuboid of
/// the same volume (rvelab/cell); other programs want them in the parallelepiped.
class Box {
 public:
  /// `lattice`: m, upper triangular, as columns.
  explicit Box(const Matrix3& lattice);
  const Matrix3& lattice() const { return lattice_; }
  Vector3 corner() const { return -0.5 * (lattice_.col(0) + lattice_.col(1) + lattice_.col(2)); }
  /// The image of a point that lies in the box, up to round-off; the point itself if it does.
  Vector3 wrapped(const Vector3& point) const;

 private:
  Matrix3 lattice_, inverse_;
};

/// The same lattice by other vectors: |xy| and |xz| at most Lxx/2, |yz| at most Lyy/2, still upper triangular. (The
/// reduced basis of a 3D cell may lean further in yz than LAMMPS allows.)
Matrix3 within_tilt_limits(const Matrix3& lattice);

/// Mean stress of each grain, Pa, laboratory frame, tension positive: (1/Vg) sum f (x) (x_c - x_g) over its contacts.
/// sum Vg sigma_g / V is the contact stress.
std::vector<Matrix3> grain_stresses(const Network& network);

}  // namespace rvelab::io
